//! A cable that lies still stays still: nothing creeps, rattles or gains energy once nothing moves.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::error::{FailureCause, SolveError};
use cable_core::scene::{Motion, Obstacle, STANDARD_GRAVITY, Scene, Shape, Support, SupportKind, View, catalog};
use cable_core::{Model, Settings, Simulation};

use self::dice::Dice;

const STEP_S: f64 = 1.0 / 240.0;

fn fastest(sim: &Simulation) -> f64 {
    let nodes = sim.solution().cables.into_iter().flat_map(|c| c.nodes);
    nodes.map(|n| n.vx_m_per_s.hypot(n.vy_m_per_s)).fold(0.0, f64::max)
}

fn begin(scene: Scene, model: Model) -> Simulation {
    let mut sim = Simulation::with_settings(scene, model, Settings::default()).expect("a sound scene");
    sim.settle().expect("a rest");
    sim
}

/// By how much tensions of neighbouring nodes of a cable that lies still differ at most beyond the
/// weight of what is between them, N, and beyond friction on level ground where that is given.
/// Without it nodes are left out that are nearer to a contact than twice the longest bar.
fn contradicted_by_neighbours(sim: &Simulation, level_friction: Option<f64>) -> f64 {
    let cable = &sim.scene().cables[0];
    let answer = &sim.solution().cables[0];
    let weight = cable.linear_density_kg_per_m * STANDARD_GRAVITY * (1.0 + level_friction.unwrap_or(0.0));
    let bars: Vec<_> = answer.nodes.windows(2).collect();
    let longest = bars.iter().map(|b| b[1].arc_length_m - b[0].arc_length_m).fold(0.0, f64::max);
    let touches = |s: f64| {
        level_friction.is_none()
            && answer.contacts.iter().any(|c| (c.begins_m - 2.0 * longest..c.ends_m + 2.0 * longest).contains(&s))
    };
    let mut most = 0.0_f64;
    for bar in bars.iter().filter(|b| !touches(b[0].arc_length_m) && !touches(b[1].arc_length_m)) {
        let between = weight * (bar[1].arc_length_m - bar[0].arc_length_m);
        most = most.max((bar[1].tension_n - bar[0].tension_n).abs() - between);
    }
    most
}

/// A cable on level ground, one end drawn a way along it and stopped.
fn drawn_over_ground(number: u64) -> (Scene, f64) {
    let mut dice = Dice(number.wrapping_mul(0x1000_0001) + 11);
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    let ground = Shape::Terrain { points_m: vec![[-5.0, 0.0], [25.0, 0.0]] };
    scene.obstacles =
        vec![Obstacle { name: "ground".to_owned(), shape: ground, friction: Some(dice.within(0.2, 0.8)) }];
    let c = &mut scene.cables[0];
    (c.length_m, c.segments, c.route_m) = (8.0, Some(dice.within(40.0, 160.0) as usize), Vec::new());
    c.bending_stiffness_n_m2 = 0.0;
    c.axial_stiffness_n = 10f64.powf(dice.within(4.5, 6.5));
    let above = 0.5 * c.diameter_m + 1e-4;
    let at = [8.0, above];
    let mut end = Support::fixed("end", at);
    let (far, quick) = (dice.within(0.2, 2.0), dice.within(0.2, 1.5));
    let stop = far / quick;
    end.motion = Some(Motion { times_s: vec![0.0, stop], points_m: vec![at, [8.0 + far, above]] });
    c.supports = vec![Support::free("tail"), end];
    c.route_m = vec![[0.0, above], at];
    (scene, stop)
}

#[test]
fn a_cable_on_the_ground_is_at_rest_five_seconds_after_it_was_drawn() {
    for number in 0..6 {
        let (scene, stop) = drawn_over_ground(number);
        let weight = scene.cables[0].linear_density_kg_per_m * STANDARD_GRAVITY * scene.cables[0].length_m;
        let friction = scene.obstacles[0].friction;
        let mut sim = begin(scene, Model::Fem);
        for _ in 0..((stop + 5.0) / STEP_S).ceil() as usize {
            sim.step(STEP_S).expect("a step");
        }
        let (speed, before) = (fastest(&sim), sim.max_tension().tension_n);
        for _ in 0..240 {
            sim.step(STEP_S).expect("a step");
        }
        let change = (sim.max_tension().tension_n - before).abs() / weight;
        println!("{number}: {speed:.1e} m/s, {change:.1e} of its weight in a second");
        assert!(speed < 1e-4 && change < 1e-2, "{number}: {speed} m/s, {change} of its weight");
        let contradicted = contradicted_by_neighbours(&sim, friction);
        println!("    {contradicted:.1e} N more than neighbours explain");
        assert!(contradicted < 1e-3 * weight, "{number}: {contradicted} N more than its neighbours explain");
        let moving = sim.max_tension().tension_n;
        sim.settle().expect("a rest from where it lies");
        let apart = (sim.max_tension().tension_n - moving).abs() / weight;
        println!("    {apart:.1e} of its weight from the tension at rest");
        assert!(apart < 1e-2, "{number}: {apart} of its weight from the tension at rest");
    }
}

/// The tank as it is at rest, and played: its rest in motion has straight bars where that without
/// inertia had them, too.
#[test]
fn the_tank_at_rest_does_not_ripple() {
    for model in [Model::Auto, Model::Fem] {
        let mut scene = catalog::tank();
        for s in scene.cables.iter_mut().flat_map(|c| &mut c.supports) {
            s.motion = None;
        }
        let mut sim = begin(scene, model);
        let (mut least, mut most, mut energy) = (f64::INFINITY, 0.0f64, 0.0f64);
        for _ in 0..(5.0 / STEP_S) as usize {
            sim.step(STEP_S).expect("a step");
            let tension = sim.max_tension().tension_n;
            (least, most) = (least.min(tension), most.max(tension));
            energy = energy.max(sim.solution().energy.kinetic_j);
        }
        let contradicted = contradicted_by_neighbours(&sim, None);
        assert!(contradicted < 1e-3 * most, "{model}: {contradicted} N more than its neighbours explain");
        println!(
            "{model}: {least:.4} to {most:.4} N, at most {energy:.1e} J of motion, {:.1e} m/s at last",
            fastest(&sim)
        );
        assert!(most / least - 1.0 < 1e-3, "{model}: {least} to {most} N");
    }
}

/// An end that stood on the ground had no gap there when it was let go, and no step was found: the
/// cable lies where it lay, and on a slope it slides as a body does.
#[test]
fn an_end_let_go_on_the_ground_lies_there() {
    const LET_GO: f64 = 0.1;
    let radius = 0.01;
    for (slope, friction) in [(0.0f64, 0.3), (30f64.to_radians(), 0.2)] {
        let along = |s: f64, up: f64| [s * slope.cos() - up * slope.sin(), s * slope.sin() + up * slope.cos()];
        let ends = [along(0.0, radius), along(3.0, radius)];
        let supports = vec![
            if slope > 0.0 { Support::new("a", SupportKind::Free) } else { Support::fixed("a", ends[0]) },
            Support { release_s: Some(LET_GO), ..Support::fixed("b", ends[1]) },
        ];
        let mut scene = catalog::cable_alone([3.0, 0.5, 1e5], supports);
        let c = &mut scene.cables[0];
        (c.preset, c.diameter_m, c.segments, c.bending_stiffness_n_m2) = (None, 2.0 * radius, None, 0.0);
        c.route_m = ends.to_vec();
        let shape = Shape::Terrain { points_m: vec![along(-30.0, 0.0), along(40.0, 0.0)] };
        scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: Some(friction) }];
        let mut sim = Simulation::new(scene, Model::Auto).unwrap();
        sim.settle().unwrap();
        let before = *sim.solution().cables[0].nodes.last().unwrap();
        for _ in 0..120 {
            sim.step(1.0 / 240.0).unwrap_or_else(|e| panic!("{:.1}°: {e}", slope.to_degrees()));
        }
        let after = *sim.solution().cables[0].nodes.last().unwrap();
        let slid = (before.at() - after.at()).norm();
        let pull = 9.80665 * (slope.sin() - friction * slope.cos());
        let expected = if pull > 0.0 { 0.5 * pull * (0.5f64 - LET_GO).powi(2) } else { 0.0 };
        println!("{:.0}°: slid {slid:.4} m, a body {expected:.4} m", slope.to_degrees());
        assert!((slid - expected).abs() < 0.02 * expected + 2e-3, "{slid} m for {expected} m");
    }
}

/// Without inertia such an end was given the normal force of a contact without a gap, 1e14 N: on a
/// floor each step with the release failed, and down a slope minutes went by before it did.
#[test]
fn issue_016_an_end_let_go_without_inertia_lies_there_or_slides_away() {
    const LET_GO: f64 = 0.1;
    for (slope, friction) in [(0.0f64, 0.3), (30f64.to_radians(), 0.2), (30f64.to_radians(), 0.0)] {
        let radius = 0.01;
        let along = |s: f64, up: f64| [s * slope.cos() - up * slope.sin(), s * slope.sin() + up * slope.cos()];
        let supports = vec![
            Support::new("a", SupportKind::Free),
            Support { release_s: Some(LET_GO), ..Support::fixed("b", along(3.0, radius)) },
        ];
        let mut scene = catalog::cable_alone([3.0, 0.5, 1e5], supports);
        let c = &mut scene.cables[0];
        (c.preset, c.diameter_m, c.segments, c.bending_stiffness_n_m2) = (None, 2.0 * radius, None, 0.0);
        c.route_m = vec![along(0.0, radius), along(3.0, radius)];
        let shape = Shape::Terrain { points_m: vec![along(-30.0, 0.0), along(40.0, 0.0)] };
        scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: Some(friction) }];
        let mut sim = Simulation::new(scene, Model::Auto).unwrap();
        sim.settle().unwrap();
        let before = sim.solution().cables[0].nodes.last().unwrap().at();
        let advanced = (0..10).try_for_each(|_| sim.step_quasi_static(0.05));
        let moved = (before - sim.solution().cables[0].nodes.last().unwrap().at()).norm();
        println!("{:.0}°, friction {friction}: {advanced:?}, moved {moved:.4} m", slope.to_degrees());
        if friction >= slope.tan() {
            advanced.unwrap();
            assert!(moved < 2e-3, "{moved} m");
        } else {
            let why = advanced.unwrap_err();
            let slides = matches!(why, SolveError::StepFailed { cause: FailureCause::SlidesAway, .. });
            assert!(slides, "{why}");
        }
    }
}

/// Friction acted by the normal forces of a barrier that followed the tension, so it rose with the
/// rate of the tension and fed vibrations: a pull of 122 N swung between 72 and 174 N.
#[test]
fn issue_016_a_cable_drawn_slowly_does_not_chatter() {
    const DIAMETER_M: f64 = 0.02;
    let at = [9.41, 0.5 * DIAMETER_M];
    let mut end = Support::fixed("end", at);
    end.motion = Some(Motion { times_s: vec![0.0, 20.0], points_m: vec![at, [at[0] + 1.05, at[1]]] });
    let mut scene = catalog::cable_alone([11.0, 1.8, 2.34e5], vec![Support::fixed("riser", [0.0, 1.51]), end]);
    let ground = Shape::Terrain { points_m: vec![[-9.0, 0.0], [30.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape: ground, friction: Some(0.72) }];
    let c = &mut scene.cables[0];
    (c.preset, c.diameter_m, c.damping_ratio, c.segments) = (None, DIAMETER_M, 0.02, Some(737));
    let mut sim = begin(scene, Model::Fem);
    let mut pulls = Vec::new();
    while sim.time_s() < 6.3 {
        sim.step(STEP_S).expect("it is drawn");
        let reaction = sim.solution().cables[0].supports[1].reaction_x_n;
        pulls.extend((sim.time_s() > 5.5).then_some(-reaction));
    }
    let (least, most) = pulls.iter().fold((f64::INFINITY, 0.0f64), |(a, b), p| (a.min(*p), b.max(*p)));
    println!("the pull is {least:.2} to {most:.2} N");
    assert!(most - least < 0.05 * most, "{least} to {most} N");
}

/// In a plan view one end of a slack cable is pushed back past its neighbours and drawn out again,
/// and never taut. All that could pull is the floor's friction and the momentum of the cable that
/// is caught: 2015 N were reported for some 10 N, because the damping of a bar that had just become
/// taut was taken from how fast it had grown while it was folded.
#[test]
fn issue_016_folded_cable_in_a_plan_view_is_caught_softly() {
    for number in 0..4 {
        let mut dice = Dice(number + 71);
        let mut scene = catalog::hanging_span();
        scene.loads.clear();
        (scene.view, scene.obstacles) = (View::Plan, Vec::new());
        let c = &mut scene.cables[0];
        (c.length_m, c.linear_density_kg_per_m, c.segments) = (7.03, 0.5, Some(dice.within(20.0, 100.0) as usize));
        (c.axial_stiffness_n, c.bending_stiffness_n_m2) = (10f64.powf(dice.within(5.5, 6.5)), 0.0);
        (c.friction, c.preset) = (dice.within(0.3, 0.8), None);
        let (back, speed) = (dice.within(0.5, 1.2), 0.3);
        let mut end = Support::fixed("end", [7.0, 0.0]);
        let times_s = vec![0.0, back / speed, back / speed + 1.0, 2.0 * back / speed + 1.0];
        let points_m = vec![[7.0, 0.0], [7.0 - back, 0.0], [7.0 - back, 0.0], [7.0, 0.0]];
        end.motion = Some(Motion { times_s: times_s.clone(), points_m });
        c.supports = vec![Support::fixed("start", [0.0, 0.0]), end];
        let friction = c.friction * c.linear_density_kg_per_m * STANDARD_GRAVITY * c.length_m;
        // Four bars caught at once at the greatest speed of the eased motion, within the 4 ms of
        // the mean.
        let bar = c.linear_density_kg_per_m * c.length_m / c.segments.unwrap_or(1) as f64;
        let caught = 4.0 * bar * 2.0 * speed / 0.004;
        let mut sim = begin(scene, Model::Fem);
        let (mut held, mut material): (f64, f64) = (0.0, 0.0);
        for _ in 0..(times_s[3] / STEP_S).ceil() as usize {
            sim.step(STEP_S).expect("a step");
            held = held.max(sim.solution().peaks().held.tension_n);
            material = material.max(sim.solution().energy_account().map_or(0.0, |a| a.material_j));
        }
        println!("{number}: {held} N held, {friction} N of friction, {caught} N for four bars caught");
        assert!(held <= friction + caught, "{number}: {held} N, friction {friction} N");
        assert!(material <= 1e-6, "{number}: a loss gave {material} J");
    }
}
