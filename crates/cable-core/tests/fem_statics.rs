//! These tests are of FEM statics of cables that touch nothing but their supports: accuracy ladders
//! against closed forms, every start, equilibrium, symmetry.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::CableSolution;
use cable_core::{Load, Model, Settings, Simulation, SolveError};
use serde_json::Value;

/// A cable of weight `w` (N/m) from (0, 0) to `end`.
fn span(length: f64, end: [f64; 2], w: f64, ea: f64) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 10.0;
    let cable = &mut scene.cables[0];
    cable.length_m = length;
    cable.linear_density_kg_per_m = w / 10.0;
    cable.axial_stiffness_n = ea;
    cable.bending_stiffness_n_m2 = 0.0;
    cable.thermal_expansion_per_k = 0.0;
    cable.breaking_tension_n = 1e15;
    cable.service_tension_n = 1e15;
    cable.segments = None;
    cable.route_m.clear();
    cable.supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", end)];
    scene.loads.clear();
    scene
}

fn solve(scene: &Scene, segments: usize) -> Result<(CableSolution, usize), SolveError> {
    let settings = Settings { segments: Some(segments), ..Settings::default() };
    let mut simulation = Simulation::with_settings(scene.clone(), Model::Fem, settings).unwrap();
    let mut answer = simulation.settle()?;
    Ok((answer.cables.remove(0), answer.cost.iterations))
}

/// Irvine's elastic catenary: position at `s` for the end force (H, VA).
fn catenary(h: f64, va: f64, w: f64, ea: f64, s: f64) -> [f64; 2] {
    let v = va + w * s;
    let x = h * s / ea + h / w * ((v / h).asinh() - (va / h).asinh());
    let z = s / ea * (va + 0.5 * w * s) + (h.hypot(v) - h.hypot(va)) / w;
    [x, z]
}

/// (H, VA) of the exact catenary by Newton with differences, from a start.
fn exact(length: f64, end: [f64; 2], w: f64, ea: f64, start: [f64; 2]) -> [f64; 2] {
    let mut u = start;
    for _ in 0..60 {
        let gap = |u: [f64; 2]| {
            let p = catenary(u[0], u[1], w, ea, length);
            [p[0] - end[0], p[1] - end[1]]
        };
        let g = gap(u);
        let step = [1e-6 * u[0], 1e-6 * u[0]];
        let (a, b) = (gap([u[0] + step[0], u[1]]), gap([u[0], u[1] + step[1]]));
        let m = nalgebra::Matrix2::new(
            (a[0] - g[0]) / step[0],
            (b[0] - g[0]) / step[1],
            (a[1] - g[1]) / step[0],
            (b[1] - g[1]) / step[1],
        );
        let d = m.try_inverse().unwrap() * nalgebra::Vector2::new(g[0], g[1]);
        u = [u[0] - d.x, u[1] - d.y];
    }
    u
}

/// Largest errors of node positions (in parts of the length) and node tensions (in parts of the
/// largest).
fn errors(cable: &CableSolution, u: [f64; 2], w: f64, ea: f64) -> [f64; 2] {
    let length = cable.nodes.last().unwrap().arc_length_m;
    let largest = u[0].hypot(u[1].abs().max((u[1] + w * length).abs()));
    let (mut position, mut tension) = (0.0f64, 0.0f64);
    for n in &cable.nodes {
        let p = catenary(u[0], u[1], w, ea, n.arc_length_m);
        position = position.max((n.x_m - p[0]).hypot(n.y_m - p[1]) / length);
        tension = tension.max((n.tension_n - u[0].hypot(u[1] + w * n.arc_length_m)).abs() / largest);
    }
    [position, tension]
}

/// Halving the bars: errors below the given ones at 8, 16, 32 and 64 bars, of fourth order at last,
/// estimated within a factor.
fn ladder(length: f64, end: [f64; 2], ea: f64, bounds: [[f64; 2]; 4], estimate_within: f64) {
    let w = 20.0;
    let scene = span(length, end, w, ea);
    let fine = solve(&scene, 2000).unwrap().0;
    let u = exact(length, end, w, ea, [fine.supports[0].reaction_x_n, fine.supports[0].reaction_y_n]);
    let mut found = Vec::new();
    for n in [8, 16, 32, 64] {
        let cable = solve(&scene, n).unwrap().0;
        let e = errors(&cable, u, w, ea);
        let force = [cable.supports[0].reaction_x_n, cable.supports[0].reaction_y_n];
        let largest = u[0].hypot(u[1].abs().max((u[1] + w * length).abs()));
        // The whole force on the ends, which differ by the weight alone.
        let ends = (force[0] - u[0]).hypot(force[1] - u[1]) / largest;
        let estimate = cable.error_estimate.unwrap();
        println!(
            "L {length} n {n}: position {:.2e}, tension {:.2e}, end {ends:.2e}, estimate {estimate:.2e}",
            e[0], e[1]
        );
        if ends > 1e-10 {
            let quality = estimate / ends;
            let within = (1.0 / estimate_within..estimate_within).contains(&quality);
            assert!(within, "n = {n}: estimate {estimate:.2e} against {ends:.2e}");
        }
        found.push(e);
    }
    for (k, (e, bound)) in found.iter().zip(bounds).enumerate() {
        for i in 0..2 {
            assert!(e[i] < bound[i], "rung {k}: {:.2e} is not below {:.2e}", e[i], bound[i]);
        }
    }
    // The forces of a slack span converge faster: its local errors change sign along it and cancel.
    let slack = length > 2.0 * end[0].hypot(end[1]);
    for i in 0..2 {
        let order = (found[2][i] / found[3][i]).log2();
        assert!(order > 3.6 && (order < 4.4 || slack && i == 1), "order {order:.2} in {found:?}");
    }
}

#[test]
fn corrected_bars_are_of_fourth_order_in_a_sagging_span() {
    ladder(110.0, [100.0, 0.0], 1e6, [[2e-6, 2e-6], [1e-7, 1.5e-7], [7e-9, 1e-8], [5e-10, 6e-10]], 1.1);
}

#[test]
fn corrected_bars_are_of_fourth_order_in_an_inclined_span() {
    ladder(110.0, [60.0, 80.0], 1e5, [[4e-5, 3e-5], [3e-6, 2e-6], [2e-7, 1.5e-7], [1.5e-8, 1e-8]], 1.3);
}

#[test]
fn corrected_bars_are_of_fourth_order_in_a_slack_span() {
    ladder(300.0, [100.0, 10.0], 1e6, [[1e-3, 2e-3], [1e-4, 1e-4], [4e-6, 1e-7], [3e-7, 1e-10]], 3.0);
}

#[test]
fn every_start_converges_to_tension() {
    let (mut most, mut folded) = (0, 0);
    for ratio in [0.999, 0.9999, 1.0, 1.0001, 1.001, 1.01, 1.1, 1.5, 3.0] {
        for ea in [1e3, 1e4, 1e6, 1e8, 1e9] {
            for segments in [20, 100, 1000] {
                for angle in [0.0f64, 37.0, 90.0, 135.0, 180.0, 213.0, 270.0, 318.0] {
                    let (sin, cos) = angle.to_radians().sin_cos();
                    let end = [100.0 * cos, 100.0 * sin];
                    let scene = span(100.0 * ratio, end, 20.0, ea);
                    let case = format!("L/chord {ratio}, EA {ea:e}, N {segments}, {angle}°");
                    let (cable, iterations) = solve(&scene, segments).unwrap_or_else(|e| panic!("{case}: {e}"));
                    // Straight up and down the tension goes through zero inside the cable: the
                    // solver rounds the fold off first.
                    let count = if angle % 180.0 == 90.0 { &mut folded } else { &mut most };
                    *count = iterations.max(*count);
                    balanced(&scene, &cable, [0.0, -20.0], &case);
                    let last = cable.nodes.last().unwrap();
                    let gap = (last.x_m - end[0]).hypot(last.y_m - end[1]);
                    assert!(gap < 1e-9, "{case}: ends {gap:.2e} m off");
                    for pair in cable.nodes.windows(2) {
                        let stretch = (pair[1].x_m - pair[0].x_m).hypot(pair[1].y_m - pair[0].y_m);
                        let rest = pair[1].arc_length_m - pair[0].arc_length_m;
                        let tension = pair[0].tension_n.max(pair[1].tension_n);
                        assert!(tension >= 0.0, "{case}: compression");
                        assert!(
                            stretch <= rest * (1.0 + tension / ea) * (1.0 + 1e-9),
                            "{case}: longer than its tension"
                        );
                    }
                }
            }
        }
    }
    println!("most Newton steps: {most}, folded {folded}");
    assert!(most <= 8 && folded <= 200, "{most} and {folded} Newton steps");
}

/// The reactions carry weight, wind and loads.
fn balanced(scene: &Scene, cable: &CableSolution, body: [f64; 2], case: &str) {
    let length = scene.cables[0].length_m;
    let loads = |i: usize| scene.loads.iter().filter_map(|l| l.force_n).map(|f| f[i]).sum::<f64>();
    let sum = |f: fn(&cable_core::solution::SupportReaction) -> f64| cable.supports.iter().map(f).sum::<f64>();
    let largest = cable.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max);
    let off = (sum(|s| s.reaction_x_n) - body[0] * length - loads(0))
        .hypot(sum(|s| s.reaction_y_n) - body[1] * length - loads(1));
    assert!(off < 1e-6 * (body[0].hypot(body[1]) * length).max(1e-6 * largest), "{case}: reactions off by {off:.2e} N");
    assert!(largest.is_finite(), "{case}");
}

#[test]
fn iterations_stay_as_they_are() {
    let cases = [(1.0, 1e9), (1.001, 1e6), (1.1, 1e6), (3.0, 1e9)];
    let found: Vec<usize> =
        cases.iter().map(|&(ratio, ea)| solve(&span(100.0 * ratio, [100.0, 0.0], 20.0, ea), 20).unwrap().1).collect();
    assert_eq!(found, PINNED, "Newton steps of {cases:?}");
}

/// Newton steps of the spans above: a change for the worse must be explained.
const PINNED: [usize; 4] = [2, 3, 4, 4];

#[test]
fn mirrored_moved_and_scaled_scenes_give_the_same_answer() {
    let base = solve(&span(12.0, [9.0, 3.0], 8.0, 1e5), 24).unwrap().0;
    let mirrored = solve(&span(12.0, [-9.0, 3.0], 8.0, 1e5), 24).unwrap().0;
    let mut moved = span(12.0, [9.0, 3.0], 8.0, 1e5);
    for support in &mut moved.cables[0].supports {
        support.at_m = support.at_m.map(|p| [p[0] + 1000.0, p[1] - 500.0]);
    }
    let moved = solve(&moved, 24).unwrap().0;
    // Ten times as long, forces ten times as large: the same shape and strain.
    let scaled = solve(&span(120.0, [90.0, 30.0], 8.0, 1e6), 24).unwrap().0;
    for (k, n) in base.nodes.iter().enumerate() {
        let (m, t, s) = (&mirrored.nodes[k], &moved.nodes[k], &scaled.nodes[k]);
        assert!((n.x_m + m.x_m).hypot(n.y_m - m.y_m) < 1e-11);
        assert!((n.x_m + 1000.0 - t.x_m).hypot(n.y_m - 500.0 - t.y_m) < 1e-9);
        assert!((10.0 * n.x_m - s.x_m).hypot(10.0 * n.y_m - s.y_m) < 1e-9);
        assert!((10.0 * n.tension_n - s.tension_n).abs() < 1e-8);
        assert!((n.tension_n - m.tension_n).abs() < 1e-9 && (n.tension_n - t.tension_n).abs() < 1e-6);
    }
}

#[test]
fn a_cable_turned_round_has_the_same_shape() {
    let mut scene = span(12.0, [9.0, 3.0], 8.0, 1e5);
    scene.loads.push(Load {
        cable: scene.cables[0].name.clone(),
        arc_length_m: 4.0,
        force_n: Some([3.0, -20.0]),
        times_s: Vec::new(),
        forces_n: Vec::new(),
    });
    let there = solve(&scene, 24).unwrap().0;
    scene.cables[0].supports.reverse();
    scene.loads[0].arc_length_m = 8.0;
    let back = solve(&scene, 24).unwrap().0;
    for (a, b) in there.nodes.iter().zip(back.nodes.iter().rev()) {
        assert!((a.x_m - b.x_m).hypot(a.y_m - b.y_m) < 1e-10);
    }
    balanced(&scene, &back, [0.0, -8.0], "turned round");
}

fn support(name: &str, kind: SupportKind) -> Support {
    Support::new(name, kind)
}

#[test]
fn nothing_holds_it() {
    let mut scene = span(12.0, [9.0, 3.0], 8.0, 1e5);
    scene.cables[0].supports = vec![Support::free("A"), Support::free("B")];
    assert!(matches!(solve(&scene, 20), Err(SolveError::NoRestingPlace { .. })));
    // Two dead loads over one frictionless pulley: the heavier one runs away with the cable.
    let load = |name: &str, n: f64| Support { force_n: Some([0.0, -n]), ..support(name, SupportKind::Load) };
    scene.cables[0].supports = vec![load("A", 100.0), Support::pulley("P", [0.0, 10.0]), load("B", 140.0)];
    assert!(matches!(solve(&scene, 20), Err(SolveError::NoRestingPlace { .. })));
    // Enough friction holds them.
    scene.cables[0].supports[1].friction = Some(0.2);
    let held = solve(&scene, 20).unwrap().0;
    let pulley = &held.supports[1];
    assert!((pulley.reaction_y_n + 240.0 + 12.0 * 8.0).abs() < 1e-9);
}

/// Half a turn round a post: e^{μπ} is 2.57 for a friction of 0.3.
#[test]
fn a_post_whose_friction_does_not_hold_lets_the_cable_go() {
    let mut scene = span(4.5, [0.0, 0.0], 5.0, 2e5);
    let cable = &mut scene.cables[0];
    cable.diameter_m = 0.004;
    let half_turn =
        (0..=12).map(|k| f64::from(k) * std::f64::consts::PI / 12.0).map(|a| [-0.152 * a.cos(), 0.152 * a.sin()]);
    cable.route_m = [[-0.152, -2.0]].into_iter().chain(half_turn).chain([[0.152, -2.0]]).collect();
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: 0.15 };
    scene.obstacles = vec![Obstacle { name: "post".to_owned(), shape, friction: Some(0.3) }];
    let load = |name: &str, n: f64| Support { force_n: Some([0.0, -n]), ..support(name, SupportKind::Load) };
    scene.cables[0].supports = vec![load("A", 100.0), load("B", 240.0)];
    solve(&scene, 60).unwrap();
    scene.cables[0].supports = vec![load("A", 100.0), load("B", 300.0)];
    assert!(matches!(solve(&scene, 60), Err(SolveError::NoRestingPlace { .. })));
}

#[test]
fn hanging_free_stretches_by_its_own_weight() {
    let (length, w, ea) = (100.0, 20.0, 2e4);
    let mut scene = span(length, [0.0, 0.0], w, ea);
    scene.cables[0].supports[1] = Support::free("B");
    let cable = solve(&scene, 40).unwrap().0;
    let tip = cable.nodes.last().unwrap();
    assert!((tip.y_m + length + w * length * length / (2.0 * ea)).abs() < 1e-9 && tip.x_m.abs() < 1e-9);
    assert!((cable.nodes[0].tension_n - w * length).abs() < 1e-9 && tip.tension_n.abs() < 1e-9);
}

#[test]
fn a_fold_on_one_point_hangs_straight_down() {
    let scene = span(100.0, [0.0, 0.0], 20.0, 2e4);
    let cable = solve(&scene, 40).unwrap().0;
    let lowest = cable.nodes.iter().map(|n| n.y_m).fold(0.0, f64::min);
    assert!((lowest + 51.25).abs() < 1e-6, "{lowest}");
    assert!((cable.nodes[0].tension_n - 1000.0).abs() < 1e-6);
}

fn statics() -> Value {
    serde_json::from_str(include_str!("../../../tests/data/statics.json")).unwrap()
}

fn number(v: &Value, group: &str, key: &str) -> f64 {
    v[group][key].as_f64().unwrap_or(f64::NAN)
}

#[test]
fn published_spans_hold() {
    let cases = statics();
    let mut worst: f64 = 0.0;
    for (name, case) in cases["cases"]["catenary"].as_object().unwrap() {
        let (x, z, l, w) =
            (number(case, "in", "X"), number(case, "in", "Z"), number(case, "in", "L"), number(case, "in", "w"));
        let ea = case["in"]["EA"].as_f64().unwrap_or(1e12);
        let cable = solve(&span(l, [x, z], w, ea), 400).unwrap_or_else(|e| panic!("{name}: {e}")).0;
        // Of the size of the force: the estimate is of tensions, its direction may be off by more.
        let force = cable.supports[0].reaction_x_n.hypot(cable.supports[0].reaction_y_n);
        let off =
            (force - number(case, "out", "H").hypot(number(case, "out", "VA"))).abs() / number(case, "out", "Tmax");
        worst = worst.max(off);
        // An inextensible cable is one of the greatest EA here; it stretches by T/EA, which tells
        // against the slack.
        let slack = l / x.hypot(z) - 1.0;
        let stretch = if case["in"]["EA"].is_null() { number(case, "out", "Tmax") / ea / slack.abs() } else { 0.0 };
        let bound = 1e-8 + stretch + 2.0 * cable.error_estimate.unwrap();
        assert!(off < bound, "{name}: {off:.2e}");
    }
    println!("worst {worst:.2e}");
}

#[test]
fn a_lump_that_lies_presses_on_the_ground() {
    let floor = |tilt: f64| Shape::Terrain { points_m: vec![[-50.0, -50.0 * tilt], [50.0, 50.0 * tilt]] };
    for (tilt, high, mass, force) in [
        (0.0, 1.0, 3.0, None),
        (0.1, 0.0, 20.0, None),
        (0.0, 0.0, 0.5, Some([1.0, -4.0])),
        (-0.2, 1.0, 7.0, Some([0.0, 9.0])),
    ] {
        let mut scene = span(4.0, [0.0; 2], 8.0, 1e6);
        scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape: floor(tilt), friction: Some(0.6) }];
        let c = &mut scene.cables[0];
        c.diameter_m = 0.02;
        let off = 0.01 * 1.0f64.hypot(tilt);
        c.route_m = vec![[0.0, off + high], [3.8, 3.8 * tilt + off]];
        let kind = if force.is_some() { SupportKind::Load } else { SupportKind::Free };
        let lump = Support { mass_kg: Some(mass), force_n: force, ..Support::new("B", kind) };
        let start = if high > 0.0 { Support::fixed("A", c.route_m[0]) } else { Support::free("A") };
        c.supports = vec![start, lump];
        let (answer, _) = solve(&scene, 40).unwrap();
        let force = force.unwrap_or_default();
        let held = if high > 0.0 { &answer.supports[..1] } else { &[] };
        let carried: f64 = answer.contacts.iter().map(|c| c.force_n[1]).sum::<f64>()
            - held.iter().map(|s| s.reaction_y_n).sum::<f64>();
        let along: f64 = answer.contacts.iter().map(|c| c.force_n[0]).sum::<f64>()
            - held.iter().map(|s| s.reaction_x_n).sum::<f64>();
        let weight = 32.0 + 10.0 * mass - force[1];
        assert!((carried - weight).abs() < 1e-4 * weight, "{tilt} {mass}: {carried} of {weight} N");
        assert!((along + force[0]).abs() < 1e-4 * weight, "{tilt} {mass}: {along} of {} N", -force[0]);
    }
}

#[test]
fn what_friction_holds_of_a_lying_load_does_not_push() {
    for end_first in [true, false] {
        let mut scene = span(4.0, [0.0; 2], 8.0, 1e6);
        let points_m = vec![[-50.0, 0.0], [50.0, 0.0]];
        scene.obstacles =
            vec![Obstacle { name: "floor".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.6) }];
        let c = &mut scene.cables[0];
        c.diameter_m = 0.02;
        c.route_m = vec![[0.0, 1.01], [0.5, 0.01], [3.3, 0.01]];
        let force_n = Some([-3.0, -10.0]);
        c.supports =
            vec![Support::fixed("A", [0.0, 1.01]), Support { force_n, ..Support::new("B", SupportKind::Load) }];
        if end_first {
            c.supports.reverse();
            c.route_m.reverse();
        }
        let (answer, _) = solve(&scene, 40).unwrap();
        let tip = if end_first { answer.nodes[0] } else { answer.nodes[answer.nodes.len() - 1] };
        assert!(tip.tension_n < 0.5, "{end_first}: {} N", tip.tension_n);
    }
}

/// A stretched bar weighs less by the metre: read without that, a cable that hangs plumb past a
/// corner had friction there without any normal force, and one over a post more than its cone.
#[test]
fn friction_of_a_stretched_cable_is_within_its_cone() {
    for stiffness in [1e3, 1e4, 1e6] {
        let mut scene = span(11.0, [10.0, -1.0], 20.0, stiffness);
        let shape = Shape::Circle { center_m: [5.0, 0.0], radius_m: 0.5 };
        scene.obstacles = vec![Obstacle { name: "post".to_owned(), shape, friction: Some(1e-6) }];
        scene.cables[0].route_m = vec![[0.0, 0.0], [5.0, 0.6], [10.0, -1.0]];
        let (cable, _) = solve(&scene, 20).unwrap();
        let [contact] = &cable.contacts[..] else { panic!("{:?}", cable.contacts) };
        let (cone, scale) = (1e-6 * contact.normal_n, cable.supports[0].reaction_y_n.abs());
        println!("{stiffness:e}: {:.1e} of {:.1} N", contact.friction_n, contact.normal_n);
        assert!(contact.friction_n.abs() <= 1.001 * cone + 1e-6 * scale, "{stiffness:e}: {contact:?}");
    }
}
