//! These tests give the warning monitor answers whose warnings are known.

use super::SharpestBends;
use super::monitor::HOLD_TIME_S;
use super::{Observed, WarningMonitor};
use crate::breakage::Break;
use crate::contact::self_crossings::{crossings, meet};
use crate::math::{Point, Vec2};
use crate::model::Model;
use crate::problem::{Problem, problems};
use crate::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use crate::simulation::Simulation;
use crate::solution::{
    CableSolution, ContactReport, ContactState, Energy, Node, SupportReaction, TensionPeak, TensionPeaks, Warning,
    WarningKind,
};
use proptest::prelude::*;
use std::f64::consts::PI;

/// A cable of 10 m, 28 mm thick, smallest bend 0.14 m, service 800 N, breaking 10 kN.
fn scene() -> Scene {
    let mut scene = catalog::hanging_span();
    scene.obstacles.clear();
    let c = &mut scene.cables[0];
    (c.length_m, c.diameter_m, c.min_bend_radius_m) = (10.0, 0.028, 0.14);
    (c.service_tension_n, c.breaking_tension_n) = (800.0, 1e4);
    c.bending_stiffness_n_m2 = 0.0;
    // Of this kind no bending stiffness is likely.
    c.preset = None;
    c.supports = vec![Support::fixed("left", [0.0, 5.0]), Support::fixed("right", [6.0, 5.0])];
    scene
}

fn problem(scene: &Scene) -> Problem {
    (*problems(scene).unwrap()[0]).clone()
}

/// An answer along points, pulled with `tension_n`, arc length by its own length, curvature from
/// its turns.
fn along(points: &[Point], tension_n: f64) -> CableSolution {
    let mut s = 0.0;
    let mut nodes: Vec<Node> = Vec::new();
    for p in points {
        if let Some(last) = nodes.last() {
            s += (p[0] - last.x_m).hypot(p[1] - last.y_m);
        }
        nodes.push(Node { arc_length_m: s, x_m: p[0], y_m: p[1], tension_n, ..Node::default() });
    }
    let turns = super::tangle::turns(&nodes);
    for k in 1..nodes.len().saturating_sub(1) {
        nodes[k].curvature_per_m = turns[k] / (0.5 * (nodes[k + 1].arc_length_m - nodes[k - 1].arc_length_m));
    }
    CableSolution { nodes: nodes.into(), ..CableSolution::default() }
}

/// Points on a circle from angle `from` to `to` (rad).
fn arc(center: Point, radius: f64, from: f64, to: f64, count: usize) -> Vec<Point> {
    let at = |k: usize| from + (to - from) * k as f64 / (count - 1) as f64;
    (0..count).map(|k| [center[0] + radius * at(k).cos(), center[1] + radius * at(k).sin()]).collect()
}

fn found(problem: &Problem, answer: &CableSolution) -> Vec<Warning> {
    super::monitor::instantaneous(&observed(problem, answer))
}

fn observed<'a>(problem: &'a Problem, answer: &'a CableSolution) -> Observed<'a> {
    let (energy, bends) = (Energy::of(problem, answer), SharpestBends::of(problem, answer));
    Observed { problem, answer, energy, bends, breaks: &[] }
}

fn kinds(problem: &Problem, answer: &CableSolution) -> Vec<WarningKind> {
    found(problem, answer).iter().map(|w| w.kind).collect()
}

#[test]
fn a_loop_is_named_where_it_crosses() {
    let p = problem(&scene());
    // Out and back along itself: strands that cross at a slight angle are no loop.
    let back = along(&[[0.0, 0.0], [3.0, 0.0], [3.2, 0.1], [3.0, 0.02], [0.0, -0.02]], 100.0);
    assert!(!kinds(&p, &back).contains(&WarningKind::Loop));
    let crossing: Vec<Point> = vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    let w = found(&p, &along(&crossing, 100.0));
    let w = w.iter().find(|w| w.kind == WarningKind::Loop).unwrap();
    assert_eq!(w.at_m, Some([1.0, 1.0]));
    assert!((w.arc_length_m - 2f64.sqrt()).abs() < 1e-12 && (w.value - (2.0 * 2f64.sqrt() + 2.0)).abs() < 1e-12);
    // Loops of less than four diameters are folds of single elements.
    let small = |side: f64| along(&[[0.0, 0.0], [side, 0.0], [side, side], [0.5 * side, -side]], 1.0);
    assert!(kinds(&p, &small(0.1)).contains(&WarningKind::Loop));
    assert!(!kinds(&p, &small(0.03)).contains(&WarningKind::Loop));
    // Pieces of a broken cable are apart where the break is.
    let mut broken = along(&[[0.0, 0.0], [2.0, 0.0], [1.0, -1.0], [1.0, 1.0]], 1.0);
    assert!(kinds(&p, &broken).contains(&WarningKind::Loop));
    broken = along(&[[0.0, 0.0], [2.0, 1.0], [1.0, -1.0], [1.0, 0.4]], 1.0);
    broken.breaks = vec![3];
    assert!(!kinds(&p, &broken).contains(&WarningKind::Loop));
}

#[test]
fn loops_in_each_other_are_one_tangle_named_by_its_tightest() {
    let p = problem(&scene());
    let named = |points: &[Point]| -> Vec<f64> {
        let all = found(&p, &along(points, 100.0));
        all.iter().filter(|w| w.kind == WarningKind::Loop).map(|w| w.value).collect()
    };
    // Out along y = 0, back to and fro across it: three crossings, the nearest by the shortest
    // loop.
    let heap = [[0.0, 0.0], [4.0, 0.0], [3.5, 1.0], [3.0, -1.0], [2.0, 1.0], [1.0, -1.0]];
    let one = named(&heap);
    assert_eq!(one.len(), 1, "{one:?}");
    let tightest = 0.75 + 1.25_f64.sqrt() + 0.5 * 4.25_f64.sqrt();
    assert!((one[0] - tightest).abs() < 1e-9, "{one:?}, {tightest}");
    let message =
        &found(&p, &along(&heap, 100.0)).into_iter().find(|w| w.kind == WarningKind::Loop).unwrap().to_string();
    assert!(message.contains("(3 in all)"), "{message}");
    // Two loops one after the other are two.
    let bow = |x: f64| [[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x + 0.5, 1.0], [x + 0.5, -1.0]];
    let both: Vec<Point> = bow(0.0).into_iter().chain(bow(5.0)).collect();
    assert_eq!(named(&both).len(), 2);
}

#[test]
fn a_curl_is_a_free_turn_of_270_degrees_in_a_tight_space() {
    let p = problem(&scene());
    let turned = |radius: f64, turn: f64| along(&arc([0.0, 0.0], radius, 0.0, turn, 60), 100.0);
    assert!(kinds(&p, &turned(0.5, 1.7 * PI)).contains(&WarningKind::Curl));
    assert!(!kinds(&p, &turned(0.5, 1.4 * PI)).contains(&WarningKind::Curl), "not far enough");
    assert!(!kinds(&p, &turned(3.0, 1.7 * PI)).contains(&WarningKind::Curl), "a wide bow");
    // The same turn round a post is due to the post.
    let mut with_post = scene();
    // It reaches everything.
    with_post.cables[0].breaking_tension_n = 1e12;
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: 0.486 };
    with_post.obstacles.push(Obstacle { name: "post".into(), shape, friction: None });
    assert!(!kinds(&problem(&with_post), &turned(0.5, 1.7 * PI)).contains(&WarningKind::Curl));
}

#[test]
fn wraps_are_counted_over_all_contacts_of_an_obstacle() {
    let mut s = scene();
    let post = Shape::Circle { center_m: [3.0, 1.0], radius_m: 0.2 };
    let ground = Shape::Terrain { points_m: vec![[-9.0, -9.0], [19.0, -9.0]] };
    s.obstacles = vec![
        Obstacle { name: "post".into(), shape: post, friction: None },
        Obstacle { name: "ground".into(), shape: ground, friction: None },
    ];
    let p = problem(&s);
    let contact = |obstacle: &str, turn_deg: f64| ContactReport {
        obstacle: obstacle.into(),
        turn_deg,
        normal_n: turn_deg.abs(),
        ..ContactReport::default()
    };
    let mut answer = along(&[[0.0, 5.0], [6.0, 5.0]], 100.0);
    for (turns, wrapped) in
        [(vec![200.0, 150.0], false), (vec![-200.0, -170.0], true), (vec![300.0, -200.0, 100.0], false)]
    {
        answer.contacts = turns.iter().map(|t| contact("post", *t)).collect();
        let w: Vec<_> = found(&p, &answer).into_iter().filter(|w| w.kind == WarningKind::Wrapped).collect();
        assert_eq!(w.len(), usize::from(wrapped), "{turns:?}");
        if let [w] = w.as_slice() {
            assert!((w.value - 370.0 / 360.0).abs() < 1e-12);
        }
    }
    answer.contacts = vec![contact("ground", 400.0)];
    assert!(!kinds(&p, &answer).contains(&WarningKind::Wrapped), "nothing goes round the ground");
}

#[test]
fn free_bends_are_kinks_and_led_ones_are_too_tight_rounds() {
    let mut s = scene();
    s.cables[0].sidewall_limit_n_per_m = Some(4380.0);
    let bow = |radius: f64| along(&arc([3.0, 2.0], radius, 0.0, PI, 40), 700.0);
    assert_eq!(kinds(&problem(&s), &bow(0.16)), []);
    assert_eq!(kinds(&problem(&s), &bow(0.12)), [WarningKind::Kink]);
    // If no smallest radius is stated, the diameter of the cable takes its place.
    let mut unstated = s.clone();
    unstated.cables[0].min_bend_radius_m = 0.0;
    for (radius, kinked) in [(0.12, false), (0.03, false), (0.025, true)] {
        assert_eq!(kinds(&problem(&unstated), &bow(radius)).contains(&WarningKind::Kink), kinked, "{radius}");
    }
    // The same bow round a post: led. 700 N on a radius of 0.12 m press with 5.8 kN/m.
    let post = |s: &Scene, radius_m: f64| {
        let mut s = s.clone();
        let shape = Shape::Circle { center_m: [3.0, 2.0], radius_m };
        s.obstacles.push(Obstacle { name: "post".into(), shape, friction: None });
        problem(&s)
    };
    let p = post(&s, 0.106);
    assert_eq!(kinds(&p, &bow(0.12)), [WarningKind::BendRadius, WarningKind::SidewallPressure]);
    let w = found(&p, &bow(0.12));
    assert!((w[0].value - 0.12).abs() < 1e-9 && (w[1].value - 700.0 / 0.12).abs() < 1e-6);
    assert_eq!(kinds(&post(&s, 0.146), &bow(0.16)), []);
    // A sharp corner is an arc of the cable's own radius; a slight one is spread by its stiffness.
    let roof = |rise: f64| {
        let mut s = s.clone();
        let points_m = vec![[0.0, 0.0], [3.0, rise], [6.0, 0.0]];
        s.obstacles.push(Obstacle { name: "roof".into(), shape: Shape::Terrain { points_m }, friction: None });
        let top = [3.0, rise + 0.014];
        (
            problem(&s),
            along(&[[0.0, 0.015], [1.5, 0.5 * rise + 0.016], top, [4.5, 0.5 * rise + 0.016], [6.0, 0.015]], 100.0),
        )
    };
    let (p, answer) = roof(1.0);
    let w: Vec<_> = found(&p, &answer).into_iter().filter(|w| w.kind == WarningKind::BendRadius).collect();
    assert!(w.len() == 1 && (w[0].value - 0.014).abs() < 1e-12, "{w:?}");
    let (p, answer) = roof(0.2);
    assert!(!kinds(&p, &answer).contains(&WarningKind::BendRadius));
    // A wheel, and the point where a support holds a flexible cable.
    let mut wheel = Support::pulley("eye", [3.0, 2.0]);
    wheel.radius_m = Some(0.106);
    s.cables[0].supports.insert(1, wheel);
    let mut answer = bow(0.12);
    let at = |x_m: f64, y_m: f64| SupportReaction { x_m, y_m, ..SupportReaction::default() };
    answer.supports = vec![at(0.0, 5.0), at(3.0, 2.0), at(6.0, 5.0)];
    assert!(kinds(&problem(&s), &answer).contains(&WarningKind::BendRadius));
    assert!(!kinds(&problem(&s), &answer).contains(&WarningKind::Kink));
}

/// EI φ'' = T sin φ from far away, where the cable is straight, to φ = θ/2: κ there by Runge and
/// Kutta's method, and T cos φ + EI κ²/2 on the way.
#[test]
fn the_bend_at_a_corner_is_that_of_an_elastica_by_shooting() {
    for (stiffness, tension) in [(1.4, 17.26), (0.05, 3.0), (500.0, 1200.0)] {
        let pull: f64 = tension / stiffness;
        let slope = |[angle, bend]: [f64; 2]| [bend, pull * f64::sin(angle)];
        let step = 1e-3 / pull.sqrt();
        // The way in which it leaves the straight line: φ' = √(T/EI) φ where φ is small.
        let mut at = [1e-6, pull.sqrt() * 1e-6];
        let mut wanted = [0.1, 0.5, 1.0, 2.0, 3.0].into_iter().peekable();
        while let Some(&turn) = wanted.peek() {
            let after = |k: [f64; 2], h: f64| [at[0] + h * k[0], at[1] + h * k[1]];
            let k1 = slope(at);
            let k2 = slope(after(k1, 0.5 * step));
            let k3 = slope(after(k2, 0.5 * step));
            let k4 = slope(after(k3, step));
            let next = [0, 1].map(|i| at[i] + step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
            if next[0] >= 0.5 * turn {
                let f = (0.5 * turn - at[0]) / (next[0] - at[0]);
                let bend = at[1] + f * (next[1] - at[1]);
                let radius = super::bend::corner_radius(stiffness, tension, turn);
                assert!((bend * radius - 1.0).abs() < 1e-5, "{turn}: {bend} against 1/{radius}");
                wanted.next();
            }
            at = next;
            let conserved = tension * at[0].cos() + 0.5 * stiffness * at[1] * at[1];
            assert!((conserved / tension - 1.0).abs() < 1e-9, "{conserved} N");
        }
    }
}

#[test]
fn a_corner_bends_a_cable_as_its_stiffness_lets_it() {
    let mut s = scene();
    let points_m = vec![[0.0, 0.0], [3.0, 1.0], [6.0, 0.0]];
    s.obstacles.push(Obstacle { name: "roof".into(), shape: Shape::Terrain { points_m }, friction: None });
    let answer = |tension: f64| along(&[[0.0, 0.015], [1.5, 0.516], [3.0, 1.014], [4.5, 0.516], [6.0, 0.015]], tension);
    let led = |s: &Scene, tension: f64| {
        let bends = SharpestBends::of(&problem(s), &answer(tension));
        assert!((bends.tightest().unwrap().radius_m - 0.014).abs() < 1e-12, "the line itself is what it was");
        let judged = bends.judged().unwrap();
        (judged.bending_stiffness_n_m2, judged.bend.radius_m)
    };
    assert_eq!(led(&s, 100.0), (0.0, 0.014));
    // As this preset is likely to be: 1.4 N·m².
    s.cables[0].preset = Some("soow-6-4".into());
    let turn = 2.0 * (0.498_f64 / 1.5).atan();
    let (stiffness, radius) = led(&s, 100.0);
    assert!((radius - 0.5 * (stiffness / 100.0).sqrt() / (0.25 * turn).sin()).abs() < 5e-3 * radius, "{radius}");
    assert_eq!(stiffness, 1.4);
    assert!(!kinds(&problem(&s), &answer(100.0)).contains(&WarningKind::BendRadius));
    assert!(kinds(&problem(&s), &answer(790.0)).contains(&WarningKind::BendRadius), "0.13 m");
    // Never sharper than the corner's arc.
    assert_eq!(led(&s, 1e6).1, 0.014);
    // A greater pull bends it sharper, without a jump.
    let radii: Vec<f64> = (1..60).map(|k| led(&s, 10.0 * f64::from(k)).1).collect();
    assert!(radii.windows(2).all(|w| w[1] < w[0] && w[1] > 0.7 * w[0]), "{radii:?}");
}

#[test]
fn the_tightest_bend_is_the_greatest_curvature_of_the_nodes() {
    for (id, scene) in [("hanging-span", catalog::hanging_span()), ("steep-span", catalog::steep_span())] {
        let answer = crate::Simulation::new(scene, crate::Model::Auto).unwrap().settle().unwrap();
        let cable = &answer.cables[0];
        let greatest = cable.nodes.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, f64::max);
        let bend = cable.tightest_bend.unwrap();
        assert_eq!(bend.radius_m, 1.0 / greatest, "{id}");
        if id == "hanging-span" {
            // H/w at the lowest point.
            assert!((bend.radius_m - 57.366_100_828 / (1.246 * 9.80665)).abs() < 1e-3, "{bend:?}");
        }
    }
}

/// Corners of beams and an eye are too sharp for a cable of which nothing says that it is stiff.
#[test]
fn corners_of_the_catalogue_bend_a_flexible_cable_too_sharply() {
    for (id, mut scene) in [
        ("tank", catalog::tank()),
        ("over-beam", catalog::over_beam()),
        ("pulley-waypoints", catalog::pulley_waypoints()),
    ] {
        let warned = |scene: &Scene| {
            let answer = crate::Simulation::new(scene.clone(), crate::Model::Auto).unwrap().settle().unwrap();
            (answer.warnings.iter().find(|w| w.kind == WarningKind::BendRadius).map(|w| w.value), answer)
        };
        let (judged, answer) = warned(&scene);
        assert_eq!(judged, None, "{id}");
        let bend = answer.cables[0].judged_bend.unwrap();
        assert!(bend.bending_stiffness_n_m2 == 1.4 && bend.bend.radius_m > 0.14, "{id}: {bend:?}");
        scene.cables[0].preset = None;
        let (flexible, radius) = (warned(&scene).0.unwrap(), 0.5 * scene.cables[0].diameter_m);
        assert!((flexible / radius - 1.0).abs() < 1e-4, "{id}: {flexible}");
    }
}

#[test]
fn a_long_part_without_tension_is_slack() {
    let p = problem(&scene());
    let part = |share: f64| {
        let mut answer = along(&[[0.0, 5.0], [2.0, 4.0], [2.0 + 10.0 * share, 4.0], [9.0, 5.0]], 50.0);
        answer.nodes[1].tension_n = 0.1;
        answer.nodes[2].tension_n = 0.1;
        answer
    };
    assert!(kinds(&p, &part(0.1)).contains(&WarningKind::Slack));
    assert!(!kinds(&p, &part(0.03)).contains(&WarningKind::Slack));
}

/// Slack for a hundredth of a second the cable has not fallen by its own diameter.
#[test]
fn a_part_that_is_slack_for_a_moment_is_no_warning() {
    let p = problem(&scene());
    let slack = |tension_n: f64| {
        let mut answer = along(&[[0.0, 5.0], [2.0, 4.0], [3.0, 4.0], [9.0, 5.0]], 50.0);
        answer.nodes[1].tension_n = tension_n;
        answer.nodes[2].tension_n = tension_n;
        answer
    };
    let fall_s = (2.0 * p.cable.diameter_m / 9.80665).sqrt();
    let mut watch = WarningMonitor::default();
    watch.at_rest(&[observed(&p, &slack(50.0))], 0.0);
    let mut warned = |tension_n: f64, time_s: f64| {
        watch.moving(&[observed(&p, &slack(tension_n))], time_s);
        watch.warnings().any(|w| w.kind == WarningKind::Slack)
    };
    assert!(!warned(0.1, 1.0) && !warned(0.1, 1.0 + 0.9 * fall_s) && !warned(50.0, 1.2));
    assert!(!warned(0.1, 2.0) && warned(0.1, 2.0 + 1.1 * fall_s));
}

fn toggles(
    watch: &mut WarningMonitor,
    p: &Problem,
    tension: impl Fn(f64) -> f64,
    kind: WarningKind,
    for_s: f64,
) -> Vec<f64> {
    let (mut on, mut out) = (false, Vec::new());
    for k in 0..(for_s * 240.0) as usize {
        let t = k as f64 / 240.0;
        let answer = along(&[[0.0, 5.0], [6.0, 5.0]], tension(t));
        watch.moving(&[observed(p, &answer)], t);
        let now = watch.warnings().any(|w| w.kind == kind);
        if now != on {
            out.push(t);
            on = now;
        }
    }
    out
}

/// Tension that swings about a level at any rate: the warning begins at once, and comes and goes at
/// most once a second.
#[test]
fn tension_warnings_do_not_flicker() {
    let p = problem(&scene());
    for (kind, level) in [(WarningKind::ServiceTension, 800.0), (WarningKind::BreakingTension, 1e4)] {
        for hertz in [0.3, 0.7, 1.3, 5.0, 30.0, 60.0] {
            for swing in [0.01, 0.2, 0.9] {
                let tension = |t: f64| level * (1.0 + swing * (2.0 * PI * hertz * t).sin());
                let times = toggles(&mut WarningMonitor::default(), &p, tension, kind, 8.0);
                assert!(times[0] < 1.0 / hertz, "{times:?}");
                // From one beginning to the next.
                for w in times.windows(3).step_by(2) {
                    assert!(w[2] - w[0] >= 1.0, "{kind:?} {hertz} Hz {swing}: {times:?}");
                }
            }
        }
        // A tension just below its limit keeps a present warning, and does not begin a new one.
        let hovers = |t: f64| {
            level
                * if t < 0.1 {
                    1.1
                } else if t < 4.0 {
                    0.97
                } else {
                    0.9
                }
        };
        let times = toggles(&mut WarningMonitor::default(), &p, hovers, kind, 8.0);
        assert!(times.len() == 2 && (times[1] - 4.0 - HOLD_TIME_S).abs() < 0.02, "{times:?}");
        assert!(toggles(&mut WarningMonitor::default(), &p, |_| 0.97 * level, kind, 1.0).is_empty());
        // A single peak is said for a second.
        let times =
            toggles(&mut WarningMonitor::default(), &p, |t| if t < 0.1 { 1.1 * level } else { 10.0 }, kind, 3.0);
        assert!(times.len() == 2 && (times[1] - times[0] - HOLD_TIME_S - 0.1).abs() < 0.02, "{times:?}");
    }
}

#[test]
fn at_rest_the_past_does_not_count_and_times_are_kept_in_motion() {
    let p = problem(&scene());
    let mut watch = WarningMonitor::default();
    let see = |watch: &mut WarningMonitor, tension: f64, t: f64| {
        let answer = along(&[[0.0, 5.0], [6.0, 5.0]], tension);
        watch.moving(&[observed(&p, &answer)], t);
    };
    for k in 0..10 {
        see(&mut watch, 900.0 + f64::from(k), 0.1 * f64::from(k + 1));
    }
    let w: Vec<_> = watch.warnings().cloned().collect();
    assert_eq!((w.len(), w[0].since_s, w[0].value), (1, Some(0.1), 909.0));
    let calm = along(&[[0.0, 5.0], [6.0, 5.0]], 100.0);
    watch.at_rest(&[observed(&p, &calm)], 1.1);
    assert_eq!(watch.warnings().count(), 0);
}

/// Held by a post and pulled from 100 N to 400 N while the other side keeps 80 N: a snag; slipping,
/// or evenly pulled, not.
#[test]
fn a_contact_that_holds_against_a_growing_pull_is_a_snag() {
    let p = problem(&scene());
    let run_at = |state: ContactState, at: fn(f64) -> f64, before: fn(f64) -> f64, after: fn(f64) -> f64| {
        let mut watch = WarningMonitor::default();
        for k in 0..60 {
            let t = f64::from(k) / 30.0;
            let mut answer = along(&[[0.0, 5.0], [6.0, 5.0]], 100.0);
            answer.contacts = vec![ContactReport {
                obstacle: "post".into(),
                arc_length_m: at(t),
                x_m: 1.0,
                state,
                tension_before_n: before(t),
                tension_after_n: after(t),
                ..ContactReport::default()
            }];
            watch.moving(&[observed(&p, &answer)], t);
        }
        watch.warnings().find(|w| w.kind == WarningKind::Snag).cloned()
    };
    let run = |state, before, after| run_at(state, |_| 4.0, before, after);
    let w = run(ContactState::Stick, |_| 80.0, |t| 100.0 + 150.0 * t).unwrap();
    // The ratio reaches 1.5 · 100/80 at 150 N, t = 1/3 s.
    assert!((w.since_s.unwrap() - 1.0 / 3.0).abs() < 0.07 && w.at_m == Some([1.0, 0.0]), "{w:?}");
    assert!(run(ContactState::Slip, |_| 80.0, |t| 100.0 + 150.0 * t).is_none());
    assert!(run(ContactState::Stick, |t| 80.0 + 120.0 * t, |t| 100.0 + 150.0 * t).is_none());
    assert!(run(ContactState::Stick, |t| 80.0 - 39.0 * t, |_| 100.0).is_none(), "the slack side empties");
    // A contact that holds for less than 0.3 s is a landing.
    let w = run(ContactState::Stick, |_| 80.0, |t| if t < 0.05 { 100.0 } else { 200.0 }).unwrap();
    assert!((w.since_s.unwrap() - 0.3).abs() < 0.04, "{w:?}");
    // 28 cm from one look to the next is the same contact; farther, another one each time.
    assert!(run_at(ContactState::Stick, |t| 4.0 + t, |_| 80.0, |t| 100.0 + 150.0 * t).is_some());
    assert!(run_at(ContactState::Stick, |t| 4.0 + 9.0 * t, |_| 80.0, |t| 100.0 + 150.0 * t).is_none());
}

/// A cable that lies on level ground is drawn: its friction is mobilised from there on, and nothing
/// catches it.
#[test]
fn issue_016_level_ground_catches_nothing() {
    let mut s = scene();
    s.obstacles.clear();
    let points_m = vec![[-9.0, 0.0], [40.0, 0.0]];
    s.obstacles.push(Obstacle { name: "floor".into(), shape: Shape::Terrain { points_m }, friction: Some(0.5) });
    let c = &mut s.cables[0];
    c.length_m = 12.0;
    c.supports = vec![Support::fixed("a", [0.0, 3.0]), Support::fixed("b", [10.0, 0.3])];
    c.supports[1].motion = Some(Motion { times_s: vec![0.0, 5.0], points_m: vec![[10.0, 0.3], [11.0, 0.3]] });
    let mut sim = Simulation::new(s, Model::Auto).unwrap();
    sim.settle().unwrap();
    for _ in 0..50 {
        sim.step_quasi_static(0.1).unwrap();
        let caught = sim.solution().warnings.iter().any(|w| w.kind == WarningKind::Snag);
        assert!(!caught, "{} s", sim.time_s());
    }
}

proptest! {
    /// The tree finds the same crossings as a test of all pairs.
    #[test]
    fn crossings_are_those_of_brute_force(
        steps in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 2..120), drift in 0.0..1.0f64, gap in 0usize..120,
    ) {
        let mut at = Vec2::zeros();
        let mut points = vec![at];
        for (x, y) in steps {
            at += Vec2::new(x + drift, y);
            points.push(at);
        }
        let joined = |k: usize| k != gap;
        let mut brute = Vec::new();
        for i in 0..points.len() - 1 {
            for j in i + 2..points.len() - 1 {
                if joined(i) && joined(j) {
                    brute.extend(meet(&points, i, j));
                }
            }
        }
        let found = crossings(&points, joined);
        prop_assert_eq!(&found, &brute);
        // Each lies on both strands.
        for c in &found {
            let on = |k: usize, f: f64| points[k] + (points[k + 1] - points[k]) * f;
            prop_assert!((on(c.first, c.fractions[0]) - on(c.second, c.fractions[1])).norm() < 1e-9);
        }
        prop_assert_eq!(crossings(&points, joined), found);
    }
}

#[test]
fn degenerate_lines_have_no_crossings() {
    assert!(crossings(&[], |_| true).is_empty());
    assert!(crossings(&[Vec2::zeros()], |_| true).is_empty());
    assert!(crossings(&[Vec2::zeros(); 9], |_| true).is_empty());
    assert!(crossings(&[Vec2::repeat(f64::NAN); 9], |_| true).is_empty());
    // 1e5 segments of a spiral that never crosses: looked at in a moment, where all pairs would be
    // 5e9.
    let spiral: Vec<Vec2> = (0..100_000)
        .map(|k| {
            let a = 0.01 * f64::from(k);
            Vec2::new(a.cos(), a.sin()) * (1.0 + 0.01 * a)
        })
        .collect();
    assert!(crossings(&spiral, |_| true).is_empty());
}

/// Warnings of the catalogue at rest: slack on floors, the corners in which the cable between the
/// posts was laid, the folds of the pile, and nothing else.
const NAMED: [(&str, &[WarningKind]); 7] = [
    ("tank", &[]),
    ("slack-to-floor", &[]),
    ("floor-drag", &[WarningKind::Slack]),
    ("plan-posts", &[WarningKind::Kink]),
    ("near-taut", &[]),
    ("pile", &[WarningKind::Kink]),
    ("robot-drive", &[]),
];

/// A cable of likely 1.4 N·m² (its preset's) round a pipe and over an edge in the same place has
/// one bend, and in a narrow loop that hangs it has no kink.
#[test]
fn issue_016_bends_of_flexible_lines_are_those_of_their_likely_stiffness() {
    let judged = |shape: Shape, ends: [[f64; 2]; 2], length_m: f64| {
        let mut scene = catalog::hanging_span();
        scene.obstacles = vec![Obstacle { name: "guide".into(), shape, friction: Some(0.3) }];
        let cable = &mut scene.cables[0];
        (cable.length_m, cable.bending_stiffness_n_m2, cable.min_bend_radius_m) = (length_m, 0.0, 0.14);
        assert!((cable.likely_bending_stiffness_n_m2() - 1.4).abs() < 1e-12);
        cable.supports = vec![Support::fixed("a", ends[0]), Support::fixed("b", ends[1])];
        cable.route_m = if length_m > 6.0 { vec![ends[0], [0.0, 0.7], ends[1]] } else { Vec::new() };
        Simulation::new(scene, Model::Spans).unwrap().settle().unwrap()
    };
    let over = [[-3.0, 0.0], [3.0, 0.0]];
    let pipe = judged(Shape::Circle { center_m: [0.0, 0.45], radius_m: 0.05 }, over, 6.2);
    let wedge = Shape::Polygon { points_m: vec![[-0.4, -0.5], [0.4, -0.5], [0.0, 0.5]] };
    let edge = judged(wedge, over, 6.2);
    let [pipe_m, edge_m] = [&pipe, &edge].map(|a| a.cables[0].judged_bend.unwrap().bend.radius_m);
    assert!(pipe_m > 0.3 && (pipe_m / edge_m - 1.0).abs() < 0.15, "{pipe_m} round a pipe, {edge_m} over an edge");
    assert!(pipe.warnings.iter().all(|w| w.kind != WarningKind::BendRadius), "{:?}", pipe.warnings);
    let far = Shape::Circle { center_m: [50.0, 0.0], radius_m: 0.1 };
    let narrow = judged(far, [[0.0, 2.0], [0.2, 2.0]], 3.0);
    let cable = &narrow.cables[0];
    let [line, free] = [cable.tightest_bend, cable.free_bend].map(|b| b.unwrap().radius_m);
    assert!(line < 0.05 && free > 0.3, "{line} m of the line, {free} m of the cable");
    assert!(narrow.warnings.iter().all(|w| w.kind != WarningKind::Kink), "{:?}", narrow.warnings);
}

#[test]
fn the_catalogue_is_named_for_what_it_shows() {
    let mut wrong = Vec::new();
    for (id, scene) in catalog::all() {
        let Some(mut answer) = crate::Simulation::new(scene, crate::Model::Auto).ok().and_then(|mut s| s.settle().ok())
        else {
            continue;
        };
        answer.warnings.retain(|w| !matches!(w.kind, WarningKind::NotUnique | WarningKind::Accuracy));
        let kinds: Vec<_> = answer.warnings.iter().map(|w| w.kind).collect();
        let expected = NAMED.iter().find(|n| n.0 == id).map_or(&[][..], |n| n.1);
        if kinds != expected {
            wrong.push(format!("{id} by {}: {:#?}", answer.model, answer.warnings));
        }
        assert!(answer.warnings.iter().all(|w| w.at_m.is_some() && w.since_s.is_none()));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// An explicit integrator.
#[derive(Clone, Copy, PartialEq)]
enum Euler {
    /// It gives an undamped spring energy in every step.
    Forward,
    /// It is stable up to twice the inverse of the greatest frequency.
    Symplectic,
}

/// A hanging chain by an explicit integrator: what is told of it, and when, s.
fn explicit(dt_s: f64, integrator: Euler) -> Option<(Warning, f64)> {
    let mut scene = scene();
    scene.cables[0].supports = vec![Support::fixed("top", [0.0, 0.0]), Support::free("tip")];
    let mut p = problem(&scene);
    p.axial_stiffness = 1e3;
    let (count, ds) = (20, 0.5);
    let mass = p.linear_density * ds;
    let mut x: Vec<Vec2> = (0..=count).map(|k| Vec2::new(ds * f64::from(k), 0.0)).collect();
    let mut v = vec![Vec2::zeros(); x.len()];
    let mut watch = WarningMonitor::default();
    for step in 0..(2.0 / dt_s) as usize {
        let pulls: Vec<Vec2> = x
            .windows(2)
            .map(|w| (w[1] - w[0]).normalize() * (p.axial_stiffness * ((w[1] - w[0]).norm() / ds - 1.0)))
            .collect();
        let mut answer = along(&[[0.0, 0.0], [1.0, 0.0]], 0.0);
        let tension = |k: usize| {
            let beside = [k.checked_sub(1), Some(k)].map(|e| e.and_then(|e| pulls.get(e)).map(|f| f.norm()));
            beside.iter().flatten().sum::<f64>() / beside.iter().flatten().count() as f64
        };
        let node = |k: usize| Node {
            arc_length_m: ds * k as f64,
            x_m: x[k].x,
            y_m: x[k].y,
            vx_m_per_s: v[k].x,
            vy_m_per_s: v[k].y,
            tension_n: tension(k),
            ..Node::default()
        };
        answer.nodes = (0..x.len()).map(node).collect();
        let at = |k: usize| SupportReaction {
            x_m: x[k].x,
            y_m: x[k].y,
            arc_length_m: ds * k as f64,
            ..SupportReaction::default()
        };
        answer.supports = vec![at(0), at(x.len() - 1)];
        answer.peaks = (step > 0).then(TensionPeaks::default);
        watch.moving(&[observed(&p, &answer)], dt_s * step as f64);
        if let Some(w) = watch.warnings().find(|w| w.kind == WarningKind::EnergyGrows) {
            return Some((w.clone(), dt_s * step as f64));
        }
        let old = v.clone();
        for k in 1..x.len() {
            let share = if k == x.len() - 1 { 0.5 } else { 1.0 };
            let force = pulls.get(k).copied().unwrap_or_default() - pulls[k - 1] + p.weight * ds * share;
            v[k] += force * (dt_s / (mass * share));
        }
        for k in 1..x.len() {
            x[k] += if integrator == Euler::Forward { old[k] } else { v[k] } * dt_s;
        }
    }
    None
}

#[test]
fn energy_of_an_unstable_integrator_is_told_and_of_a_stable_one_is_not() {
    assert_eq!(explicit(1e-4, Euler::Symplectic), None);
    for dt_s in [3e-3, 6e-3] {
        let (warning, when) = explicit(dt_s, Euler::Forward).expect("forward Euler gains energy");
        println!("{dt_s} s: {when} s: {warning:?}");
        assert!(warning.value > warning.limit && warning.since_s.is_some() && when > 0.0, "{warning:?}");
        assert!(warning.to_string().contains("that nothing explains") && warning.value.is_finite(), "{warning:?}");
    }
    // Beyond its limit the stable one is not.
    assert!(explicit(2e-2, Euler::Symplectic).is_some());
}

/// A model whose velocities a fault multiplies after each step.
#[test]
fn a_model_that_gains_speed_from_nowhere_is_told() {
    for model in [crate::Model::Fem, crate::Model::MassSpring] {
        let growth_warning = |gain: f64| {
            let mut s = scene();
            s.cables[0].supports[1].release_s = Some(0.05);
            let mut sim = crate::Simulation::new(s, model).unwrap();
            sim.settle().unwrap();
            for step in 0..90 {
                sim.step(1.0 / 60.0).unwrap();
                if let Some(w) = sim.solution().warnings.iter().find(|w| w.kind == WarningKind::EnergyGrows) {
                    return Some((step, w.clone()));
                }
                let strand = &mut sim.cables_mut()[0];
                let mut state = strand.state();
                state.velocity_m_per_s.iter_mut().for_each(|v| *v *= gain);
                strand.set_state(&state).unwrap();
            }
            None
        };
        assert_eq!(growth_warning(1.0), None, "{model}");
        let (step, warning) = growth_warning(1.05).expect("a twentieth of its speed more in every step");
        println!("{model}: step {step}: {warning}");
        assert!(step < 30, "{model}: {step}");
    }
}

/// Energy from supports, loads and wind is accounted for.
#[test]
fn work_is_not_energy_from_nowhere() {
    let mut s = scene();
    let times_s = vec![0.0, 0.1, 0.6];
    let forces_n = vec![[200.0, 300.0], [-900.0, 500.0], [900.0, -500.0]];
    s.cables[0].supports[1] = Support { kind: SupportKind::Load, times_s, forces_n, ..Support::free("tip") };
    s.environment.wind_times_s = vec![0.0, 0.1];
    s.environment.winds_n_per_m = vec![[20.0, 0.0], [-60.0, 30.0]];
    let mut sim = crate::Simulation::new(s, crate::Model::Fem).unwrap();
    sim.settle().unwrap();
    let mut most = 0.0;
    for _ in 0..60 {
        sim.step(1.0 / 60.0).unwrap();
        most = f64::max(most, sim.solution().energy.kinetic_j);
        let warnings: Vec<Warning> = sim.solution().warnings;
        assert!(warnings.iter().all(|w| w.kind != WarningKind::EnergyGrows), "{warnings:?}");
    }
    assert!(most > 100.0, "it is thrown about: {most} J");
}

/// A piece beside a new end was said not to break.
#[test]
fn tension_above_breaking_after_a_break_is_not_said_to_hold() {
    let p = problem(&scene());
    let mut answer = along(&[[0.0, 5.0], [3.0, 4.0], [6.0, 5.0]], 100.0);
    let top = TensionPeak { tension_n: 1.2e4, arc_length_m: 3.0, time_s: 2.0 };
    answer.peaks = Some(TensionPeaks { greatest: top, held: top, over_s: 0.004 });
    let whole = observed(&p, &answer);
    let at = Break { time_s: 1.999, arc_length_m: 5.0, at: Vec2::zeros(), detached_from: None, over_s: 0.004 };
    let broken = Observed { breaks: &[at], ..observed(&p, &answer) };
    let said = |observed: &Observed<'_>| {
        let warnings = super::monitor::instantaneous(observed);
        let of = warnings.iter().find(|w| w.kind == WarningKind::BreakingTension).unwrap();
        of.to_string()
    };
    let assumes = "the figures assume that it does not";
    assert!(said(&whole).contains(assumes), "{}", said(&whole));
    assert!(
        !said(&broken).contains(assumes) && said(&broken).contains("not tested for further breaks"),
        "{}",
        said(&broken)
    );
}
