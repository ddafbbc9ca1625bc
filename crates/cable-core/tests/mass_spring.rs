//! These tests solve every scene of the catalogue by `mass-spring`, and compare it with the
//! catenary over pulleys and with closed forms of stiffness and motion.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::{CableSolution, WarningKind};
use cable_core::{Load, Model, Settings, Simulation, SolveError};
use serde_json::Value;

fn solve(scene: &Scene, model: Model, segments: usize) -> CableSolution {
    let settings = Settings { segments: Some(segments), tolerance: 1e-9, ..Settings::default() };
    let mut sim = Simulation::with_settings(scene.clone(), model, settings).unwrap();
    sim.settle().unwrap_or_else(|e| panic!("{} with {segments}: {e}", scene.name)).cables.remove(0)
}

/// Newton steps of the catalogue: a change for the worse must be explained.
const MOST_STEPS: usize = 700;

#[test]
fn the_catalogue_settles() {
    for (id, scene) in catalog::all() {
        let touches_itself = scene.cables.iter().any(|c| c.self_contact);
        let Ok(mut sim) = Simulation::new(scene, Model::MassSpring) else {
            assert!(touches_itself, "{id} is refused");
            continue;
        };
        let s = sim.settle().unwrap_or_else(|e| panic!("{id}: {e}"));
        println!("{id}: {} steps, {:.1e} N", s.cost.iterations, s.cost.residual_n);
        assert!(s.cost.iterations < MOST_STEPS, "{id}: {} steps", s.cost.iterations);
    }
}

#[test]
fn a_taut_rope_of_many_elements_settles() {
    let scene = catalog::near_taut();
    let exact = solve(&scene, Model::Catenary, 1).nodes[0].tension_n;
    for segments in [160, 640, 1280] {
        let found = solve(&scene, Model::MassSpring, segments).nodes[0].tension_n;
        assert!((found / exact - 1.0).abs() < 1e-4, "{segments}: {found} against {exact}");
    }
}

/// Errors of ever finer meshes fall with the square of the element.
fn second_order(name: &str, found: &[f64], bound: f64) {
    println!("{name}: {found:?}");
    let last = found[found.len() - 1];
    assert!(last < bound, "{name}: {found:?}");
    let order = (found[0] / last).log2() / (found.len() - 1) as f64;
    assert!(order > 1.7, "{name}: order {order:.2} in {found:?}");
}

/// Two waypoints: a point and a wheel, both smooth.
fn waypoints(radius_m: f64, friction: f64) -> Scene {
    let mut scene = catalog::pulley_waypoints();
    let c = &mut scene.cables[0];
    c.bending_stiffness_n_m2 = 0.0;
    for s in &mut c.supports[1..3] {
        s.friction = Some(friction);
    }
    c.supports[1].radius_m = Some(radius_m);
    scene
}

#[test]
fn smooth_pulleys_rest_where_the_catenary_says() {
    for radius in [0.0, 0.15] {
        let scene = waypoints(radius, 0.0);
        let exact = solve(&scene, Model::Catenary, 1);
        let largest = exact.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max);
        let mut errors = [Vec::new(), Vec::new(), Vec::new()];
        for segments in [33, 66, 132, 264] {
            let found = solve(&scene, Model::MassSpring, segments);
            let mut worst = [0.0f64; 3];
            for (a, b) in found.supports.iter().zip(&exact.supports) {
                let force = (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n);
                let sides = [(a.tension_before_n, b.tension_before_n), (a.tension_after_n, b.tension_after_n)];
                let tension = sides.iter().map(|(a, b)| (a.unwrap_or(0.0) - b.unwrap_or(0.0)).abs());
                worst[0] = worst[0].max(force / largest);
                worst[1] = worst[1].max(tension.fold(0.0, f64::max) / largest);
                worst[2] = worst[2].max((a.arc_length_m - b.arc_length_m).abs());
            }
            for (list, w) in errors.iter_mut().zip(worst) {
                list.push(w);
            }
        }
        for (what, list) in ["reaction", "tension", "arc length"].iter().zip(&errors) {
            second_order(&format!("R {radius} {what}"), list, 1e-3);
        }
    }
}

/// A weight over a rubbing pulley, drawn slowly up and let down: the capstan's ratio either way.
fn capstan(radius_m: f64) -> Scene {
    let mut scene = waypoints(0.0, 0.3);
    let c = &mut scene.cables[0];
    c.length_m = 8.0;
    c.segments = Some(80);
    (c.linear_density_kg_per_m, c.axial_stiffness_n) = (0.05, 5e4);
    let mut wheel = Support { friction: Some(0.3), ..Support::pulley("wheel", [0.0, 5.0]) };
    wheel.radius_m = Some(radius_m);
    let hand = Support {
        motion: Some(Motion { times_s: vec![0.0, 1.0, 2.0], points_m: vec![[2.0, 1.0], [2.0, 0.2], [2.0, 1.0]] }),
        ..Support::fixed("hand", [2.0, 1.0])
    };
    let load = Support { force_n: Some([0.0, -100.0]), mass_kg: Some(10.0), ..Support::new("load", SupportKind::Load) };
    c.supports = vec![load, wheel, hand];
    scene
}

#[test]
fn a_rubbing_pulley_takes_the_capstans_ratio() {
    for radius in [0.0, 0.2] {
        let mut sim = Simulation::new(capstan(radius), Model::MassSpring).unwrap();
        sim.settle().unwrap();
        for sign in [1.0, -1.0] {
            for _ in 0..10 {
                sim.step_quasi_static(0.1).unwrap();
            }
            let wheel = sim.solution().cables[0].supports[1].clone();
            let (before, after) = (wheel.tension_before_n.unwrap(), wheel.tension_after_n.unwrap());
            // The way down is (2, −4.8) or (2, −4) from the middle of a small wheel.
            let down: f64 = if sign > 0.0 { 4.8 } else { 4.0 };
            let out = radius + if radius > 0.0 { 0.5 * sim.scene().cables[0].diameter_m } else { 0.0 };
            let turn = std::f64::consts::FRAC_PI_2 + down.atan2(2.0) + (out / down.hypot(2.0)).asin();
            let ratio = (after / before).ln() / (0.3 * turn * sign);
            println!("R {radius}: {ratio}");
            assert!((ratio - 1.0).abs() < 0.01, "R {radius}: {ratio}");
        }
    }
}

#[test]
fn sliding_in_time_keeps_the_capstans_ratio() {
    let mut scene = capstan(0.0);
    scene.cables[0].supports[0].mass_kg = None;
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    sim.settle().unwrap();
    let (mut sum, mut count) = (0.0, 0.0);
    for k in 0..40 {
        sim.step(1.0 / 60.0).unwrap();
        let s = sim.solution();
        let wheel = &s.cables[0].supports[1];
        if k >= 20 {
            let hand = &s.cables[0].supports[2];
            let turn = std::f64::consts::FRAC_PI_2 + (5.0 - hand.y_m).atan2(2.0);
            sum += (wheel.tension_after_n.unwrap() / wheel.tension_before_n.unwrap()).ln() / (0.3 * turn);
            count += 1.0;
        }
    }
    let ratio = sum / count;
    println!("in time {ratio}");
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

/// G. Atwood's machine with a heavy rope: M ẍ = ((m₂ − m₁) + ρ(l₂ − l₁)) g with l₂ − l₁ = 2x + l₀,
/// so x + c = c·cosh(√(2ρg/M) t), c = ((m₂ − m₁)/ρ + l₀)/2.
#[test]
fn two_weights_on_a_pulley_move_as_atwood_says() {
    let mut scene = waypoints(0.0, 0.0);
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (10.0, 0.4, 1e5);
    c.damping_ratio = 0.05;
    let load = |name: &str, mass| Support {
        mass_kg: Some(mass),
        force_n: Some([0.0, 0.0]),
        ..Support::new(name, SupportKind::Load)
    };
    c.supports = vec![load("lighter", 5.0), Support::pulley("pulley", [0.0, 0.0]), load("heavier", 5.5)];
    c.route_m = vec![[0.0, -5.0], [0.0, 0.0], [0.0, -5.0]];
    let mut errors = Vec::new();
    for segments in [20, 80] {
        c_segments(&mut scene, segments);
        let mut sim = Simulation::new(scene.clone(), Model::MassSpring).unwrap();
        for _ in 0..60 {
            sim.step(1.0 / 60.0).unwrap();
        }
        let s = sim.solution();
        let g = 9.80665;
        let (rho, mass): (f64, f64) = (0.4, 5.0 + 5.5 + 4.0);
        let c: f64 = 0.5 * (0.5 / rho);
        let x = c * ((2.0 * rho * g / mass).sqrt().cosh() - 1.0);
        let found = 5.0 - s.cables[0].supports[1].arc_length_m;
        println!("{segments}: slid {found} of {x}");
        errors.push((found / x - 1.0).abs());
    }
    assert!(errors[1] < 0.01, "{errors:?}");
}

fn c_segments(scene: &mut Scene, segments: usize) {
    scene.cables[0].segments = Some(segments);
}

fn statics() -> Value {
    serde_json::from_str(include_str!("../../../tests/data/statics.json")).unwrap()
}

fn number(v: &Value, group: &str, key: &str) -> f64 {
    v[group][key].as_f64().unwrap_or(f64::NAN)
}

/// A clamped cable of weight `w` (N/m); without an end the far end is free.
fn clamped(length: f64, end: Option<[f64; 2]>, w: f64, ea: f64, ei: f64) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 10.0;
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (length, w / 10.0, ea);
    (c.bending_stiffness_n_m2, c.thermal_expansion_per_k) = (ei, 0.0);
    (c.breaking_tension_n, c.service_tension_n) = (1e15, 1e15);
    let clamp =
        |name: &str, at| Support { at_m: Some(at), angle_deg: Some(0.0), ..Support::new(name, SupportKind::Clamped) };
    c.supports = vec![clamp("A", [0.0, 0.0]), end.map_or(Support::free("B"), |p| clamp("B", p))];
    scene
}

#[test]
fn stiff_catenaries_converge() {
    for (name, case) in statics()["cases"]["stiff_catenary"].as_object().unwrap() {
        let input = |key| number(case, "in", key);
        if input("EI") < 500.0 {
            continue; // layers thinner than an even mesh can show
        }
        let ea = case["in"]["EA"].as_f64().unwrap_or(1e10);
        let scene = clamped(input("L"), Some([input("X"), input("Z")]), input("w"), ea, input("EI"));
        let error =
            |n| (solve(&scene, Model::MassSpring, n).supports[0].reaction_x_n / number(case, "out", "H") - 1.0).abs();
        second_order(name, &[50, 100, 200].map(error), 3e-3);
        let moment = |n| {
            let curvature = solve(&scene, Model::MassSpring, n).nodes[0].curvature_per_m;
            (input("EI") * curvature / number(case, "out", "M_A") - 1.0).abs()
        };
        second_order(&format!("{name}, moment"), &[200, 400, 800].map(moment), 1e-2);
    }
}

#[test]
fn heavy_cantilevers_converge() {
    for (name, case) in statics()["cases"]["elastica"].as_object().unwrap() {
        let Some(k) = case["in"]["k"].as_f64().filter(|k| *k <= 600.0) else { continue };
        let error = |n| {
            let cable = solve(&clamped(1.0, None, k, 1e9, 1.0), Model::MassSpring, n);
            let tip = cable.nodes.last().unwrap();
            (tip.x_m - number(case, "out", "x_tip")).hypot(tip.y_m - number(case, "out", "z_tip"))
        };
        second_order(name, &[25, 50, 100].map(error), 2e-3);
    }
}

/// A stiff cantilever swings with its first frequency 3.516 √(EI/(ρ L⁴)): after half a period it is
/// as far below its balance as it began above.
#[test]
fn a_cantilever_swings_at_its_frequency() {
    let (ei, rho, length): (f64, f64, f64) = (100.0, 0.5, 2.0);
    let mut scene = clamped(length, None, 10.0 * rho, 1e5, ei);
    scene.environment.gravity_m_per_s2 = 0.05;
    scene.cables[0].linear_density_kg_per_m = rho;
    scene.cables[0].damping_ratio = 0.0;
    scene.cables[0].segments = Some(40);
    scene.cables[0].route_m = vec![[0.0, 0.0], [length, 0.0]];
    let still = solve(&scene, Model::MassSpring, 40).nodes.last().unwrap().y_m;
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    let period = std::f64::consts::TAU / (3.51602 * (ei / rho / length.powi(4)).sqrt());
    let (mut last, mut turn) = (0.0, 0.0);
    // It starts straight: the lowest place is half a period later.
    for k in 1..400 {
        sim.step(period / 400.0).unwrap();
        let y = sim.solution().cables[0].nodes.last().unwrap().y_m;
        if y > last && turn == 0.0 && k > 100 {
            turn = (f64::from(k) - 0.5) / 400.0;
        }
        last = y;
    }
    println!("turns after {turn} periods, balance {still}");
    assert!((turn - 0.5).abs() < 0.02, "{turn}");
}

/// Let go at 0.1 s under wind that rises and a pull on a lump at its end: the middle of its mass
/// moves by the sum of the forces over the mass, whatever the cable does.
#[test]
fn forces_in_time_move_the_middle_of_mass() {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 9.80665;
    scene.environment.wind_times_s = vec![0.0, 0.1, 0.9];
    scene.environment.winds_n_per_m = vec![[0.0, 0.0], [0.0, 0.0], [8.0, 2.0]];
    scene.environment.wind_n_per_m = [0.0, 0.0];
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (4.0, 0.5, 2e6);
    c.bending_stiffness_n_m2 = 0.0;
    c.segments = Some(20);
    let top = Support { release_s: Some(0.1), ..Support::fixed("top", [0.0, 0.0]) };
    let lump = Support {
        mass_kg: Some(1.5),
        times_s: vec![0.0, 0.1, 0.6],
        forces_n: vec![[0.0, 0.0], [0.0, 0.0], [5.0, 0.0]],
        ..Support::new("lump", SupportKind::Load)
    };
    c.supports = vec![top, lump];
    let name = c.name.clone();
    scene.loads = vec![Load {
        cable: name,
        arc_length_m: 1.0,
        force_n: None,
        times_s: vec![0.0, 0.1, 0.3],
        forces_n: vec![[0.0, 0.0], [0.0, 0.0], [0.0, 6.0]],
    }];
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    sim.settle().unwrap();
    let middle = |sim: &Simulation| {
        let n = &sim.solution().cables[0].nodes;
        let mut sum = [1.5 * n[n.len() - 1].x_m, 1.5 * n[n.len() - 1].y_m];
        for w in n.windows(2) {
            let m = 0.5 * (w[1].arc_length_m - w[0].arc_length_m) * 0.5;
            sum[0] += m * (w[0].x_m + w[1].x_m);
            sum[1] += m * (w[0].y_m + w[1].y_m);
        }
        sum.map(|s| s / 3.5)
    };
    let start = middle(&sim);
    for _ in 0..40 {
        sim.step(0.02).unwrap();
    }
    let now = middle(&sim);
    // A force that rises for a time T to F and stays: after t ≥ T it has moved a mass by F/m ((t −
    // T)²/2 + T(t − T)/2 + T²/6).
    let moved = |force: f64, rise: f64, t: f64| {
        if t < rise {
            force / rise * t.powi(3) / 6.0
        } else {
            force * (0.5 * (t - rise).powi(2) + 0.5 * rise * (t - rise) + rise * rise / 6.0)
        }
    };
    let t = 0.7;
    let x = (moved(32.0, 0.8, t) + moved(5.0, 0.5, t)) / 3.5;
    let y = -0.5 * 9.80665 * t * t + (moved(8.0, 0.8, t) + moved(6.0, 0.2, t)) / 3.5;
    let off = (now[0] - start[0] - x).hypot(now[1] - start[1] - y);
    println!("middle of mass off by {off:.2e} m of {x:.3}, {y:.3}");
    assert!(off < 1e-3 * x.hypot(y), "{off} m of {x}, {y}");
}

#[test]
fn heat_lengthens_a_hanging_cable() {
    let mut scene = clamped(10.0, None, 20.0, 2e4, 0.0);
    scene.cables[0].supports = vec![Support::fixed("top", [0.0, 0.0]), Support::free("end")];
    scene.cables[0].thermal_expansion_per_k = 2e-5;
    scene.environment.temperature_change_k = 100.0;
    let tip = solve(&scene, Model::MassSpring, 16).nodes.last().unwrap().y_m;
    let exact = -1.002 * (10.0 + 20.0 * 100.0 / (2.0 * 2e4));
    assert!((tip / exact - 1.0).abs() < 1e-9, "{tip} against {exact}");
}

/// From above, on a rough floor and round rough posts: friction of both is remembered from step to
/// step. (It stopped the program: anchors on posts were taken for nodes on the floor.)
#[test]
fn a_floor_and_posts_rub_at_once() {
    let mut scene = catalog::plan_posts();
    scene.cables[0].segments = Some(40);
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    let mut last = sim.settle().unwrap().cables[0].supports[1].reaction_x_n;
    let start = last;
    for _ in 0..35 {
        sim.step_quasi_static(0.2).unwrap();
        last = sim.solution().cables[0].supports[1].reaction_x_n;
        assert!(last.is_finite());
    }
    // Drawn away from the posts, the hand feels more than before.
    assert!(last.abs() > start.abs(), "{last} N after {start} N");
}

/// Drawn slowly over a corner or a round by hand against a dead load: how far the ratio of tensions
/// is from e^{μφ} in the worst frame, and what the answer says of itself.
fn drawn_over(radius_m: Option<f64>, turn_deg: f64, segments: usize) -> (f64, f64) {
    let half = 0.5 * turn_deg.to_radians();
    let (sin, cos) = half.sin_cos();
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 1e-3;
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (6.0, 1.0, 1e6);
    (c.bending_stiffness_n_m2, c.diameter_m) = (0.0, 0.028);
    c.segments = Some(segments);
    let (near, far) = ([2.6 * cos, -2.6 * sin], [2.9 * cos, -2.9 * sin]);
    c.route_m = vec![[-3.4 * cos, -3.4 * sin], [0.0, 0.014 / cos + 1e-4], near];
    let load = Support { force_n: Some([-100.0 * cos, -100.0 * sin]), ..Support::new("load", SupportKind::Load) };
    let motion = Some(Motion { times_s: vec![0.0, 3.0], points_m: vec![near, far] });
    c.supports = vec![load, Support { motion, ..Support::fixed("hand", near) }];
    let flank = half + 0.35;
    let shape = match radius_m {
        Some(radius_m) => Shape::Circle { center_m: [0.0, -radius_m], radius_m },
        None => Shape::Polygon {
            points_m: vec![
                [0.0, 0.0],
                [-3.0 * flank.cos(), -3.0 * flank.sin()],
                [3.0 * flank.cos(), -3.0 * flank.sin()],
            ],
        },
    };
    scene.obstacles = vec![Obstacle { name: "beam".to_owned(), shape, friction: Some(0.3) }];
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    sim.settle().unwrap();
    let (mut worst, mut said) = (0.0f64, 0.0f64);
    for k in 0..150 {
        sim.step_quasi_static(0.02).unwrap();
        if k >= 60 {
            let s = sim.solution();
            let hand = &s.cables[0].supports[1];
            // A round is left later than a corner where its route turns: 61.2° for 60°, 0.6 % of
            // tension.
            let turn = half + hand.reaction_y_n.abs().atan2(hand.reaction_x_n.abs());
            let exact = 100.0 * (0.3 * turn).exp();
            worst = worst.max((hand.reaction_x_n.hypot(hand.reaction_y_n) / exact - 1.0).abs());
            said = said.max(s.cables[0].error_estimate.unwrap_or(0.0));
            let warned = s.warnings.iter().any(|w| w.kind == WarningKind::Accuracy && w.to_string().contains("`beam`"));
            assert!(warned, "nothing is said at {} s", s.time_s);
        }
    }
    (worst, said)
}

/// On a round the sawtooth falls with the element, on a sharp corner it stays: the answer says how
/// uncertain it is, and that is no less than what is found and no more than a few times of it.
#[test]
fn what_corners_leave_uncertain_is_said() {
    for (radius, turn) in [(Some(0.3), 60.0), (None, 30.0)] {
        let mut errors = Vec::new();
        for segments in [60, 240] {
            let (worst, said) = drawn_over(radius, turn, segments);
            println!("radius {radius:?}, {turn}°, {segments} elements: off by {worst:.3} at worst, said {said:.3}");
            assert!(worst <= 1.1 * said, "{worst} is more than the {said} it says");
            assert!(said < 6.0 * worst + 0.01, "{said} is far more than {worst}");
            errors.push(worst);
        }
        if radius.is_some() {
            assert!(errors[1] < 0.5 * errors[0], "a finer mesh must help on a round: {errors:?}");
        } else {
            assert!(errors[1] > 0.4 * errors[0], "no mesh helps on a corner: {errors:?}");
        }
    }
}

#[test]
fn a_state_inside_an_obstacle_is_refused() {
    let mut scene = catalog::hanging_span();
    let shape = Shape::Terrain { points_m: vec![[-20.0, -3.0], [20.0, -3.0]] };
    scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: Some(0.5) }];
    let c = &mut scene.cables[0];
    (c.length_m, c.segments, c.bending_stiffness_n_m2) = (11.0, Some(40), 0.0);
    (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
    let radius = 0.5 * c.diameter_m;
    c.supports = vec![Support::fixed("left", [-4.0, 0.0]), Support::fixed("right", [4.0, 0.0])];
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    sim.settle().unwrap();
    let before = sim.states();
    // All of the cable but its ends, its lowest point so deep (m) in the ground.
    let lowered = |depth: f64| {
        let mut states = before.clone();
        let inner = &mut states[0].position_m[1..40];
        let lowest = inner.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        for p in inner {
            p.y += -3.0 + radius - depth - lowest;
        }
        states
    };
    sim.set_states(&before).unwrap();
    // Not as deep as its radius it is pushed out.
    sim.set_states(&lowered(0.8 * radius)).unwrap();
    sim.step(0.1).unwrap();
    let lowest = sim.states()[0].position_m.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    assert!(lowest > -3.0 + 0.99 * radius, "{lowest}");
    // Deeper it would be held in: refused, and where it was.
    sim.set_states(&before).unwrap();
    for depth in [1.2 * radius, 0.5, 40.0] {
        let refused = sim.set_states(&lowered(depth)).unwrap_err();
        let named = matches!(&refused, SolveError::Buried { obstacle, depth_m, .. }
            if obstacle == "ground" && (depth_m - depth).abs() < 1e-9);
        assert!(named, "{refused}");
        assert_eq!(sim.states(), before);
    }
}

/// The tension at a node that bears a point load was that of the mean of both sides: 72 N for 157 N
/// before it and 188 N beyond it.
#[test]
fn issue_016_the_tension_at_a_point_load_is_that_of_its_tauter_side() {
    let supports = vec![Support::fixed("a", [0.0, 0.0]), Support::fixed("b", [5.278, 0.0])];
    let mut scene = catalog::cable_alone([8.31, 3.0, 1e6], supports);
    let at = 4.86;
    for (segments, force_n) in [(20, [0.0, 315.0]), (41, [40.0, -100.0]), (200, [0.0, 20.0])] {
        scene.cables[0].segments = Some(segments);
        let cable = scene.cables[0].name.clone();
        let constant = Load { cable, arc_length_m: at, force_n: Some(force_n), times_s: vec![], forces_n: vec![] };
        scene.loads = vec![constant];
        let tension = |model: Model| {
            let mut sim = Simulation::new(scene.clone(), model).unwrap();
            sim.settle().unwrap();
            let nodes = &sim.solution().cables[0].nodes;
            let here = nodes.iter().filter(|n| (n.arc_length_m - at).abs() < 1e-9);
            here.map(|n| n.tension_n).fold(0.0, f64::max)
        };
        let (found, expected) = (tension(Model::MassSpring), tension(Model::Catenary));
        println!("{segments} segments: {found:.3} N of {expected:.3} N");
        assert!((found / expected - 1.0).abs() < 5e-3, "{segments}: {found} N for {expected} N");
    }
}
