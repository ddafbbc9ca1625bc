//! A stiff cable over a wheel that moves is the same cable over a wheel that stands, seen by
//! someone who moves: at a constant velocity no law can tell the two apart, and with an
//! acceleration it is as if a force of −ρa per metre acted on the cable (d'Alembert).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::model::{Inertia, Question};
use cable_core::scene::{Motion, PulleySide, Scene, Support, catalog};
use cable_core::solution::CableSolution;
use cable_core::{Model, Settings, Simulation};

/// Time for which the end is drawn, s.
const DRAWN_S: f64 = 3.0;
/// Time for which all is accelerated, s, in so many steps.
const SHAKEN_S: f64 = 1.0;
const SHAKEN_STEPS: usize = 960;

/// A stiff cable over a wheel, drawn along by 0.4 m in [`DRAWN_S`]; all of it moves at `velocity`.
fn scene(bending_stiffness_n_m2: f64, friction: f64, velocity: [f64; 2]) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    let mut c = scene.cables[0].clone();
    (c.length_m, c.axial_stiffness_n, c.linear_density_kg_per_m) = (5.65, 1e6, 0.6);
    (c.bending_stiffness_n_m2, c.segments) = (bending_stiffness_n_m2, Some(120));
    (c.service_tension_n, c.breaking_tension_n) = (1e12, 1e12);
    let moving = |name: &str, from: [f64; 2], drawn: [f64; 2]| {
        let to = [0, 1].map(|k| from[k] + drawn[k] + velocity[k] * DRAWN_S);
        let mut support = Support::fixed(name, from);
        if to != from {
            support.motion = Some(Motion { times_s: vec![0.0, DRAWN_S], points_m: vec![from, to] });
        }
        support
    };
    let mut wheel = moving("wheel", [0.0, 3.4], [0.0; 2]);
    wheel = Support {
        radius_m: Some(0.2),
        side: Some(PulleySide::Over),
        friction: Some(friction),
        motion: wheel.motion,
        ..Support::pulley("wheel", [0.0, 3.4])
    };
    c.supports = vec![moving("left", [-2.0, 2.0], [0.0; 2]), wheel, moving("right", [2.0, 2.0], [0.2, -0.35])];
    scene.cables = vec![c];
    scene
}

/// Such a scene of which all moves with an acceleration from rest (m/s²), or of which all stands
/// while the opposite inertia acts on the cable.
fn accelerated(acceleration: [f64; 2], stands: bool) -> Scene {
    let mut scene = scene(2.0, 0.2, [0.0; 2]);
    let times_s: Vec<f64> = (0..=SHAKEN_STEPS).map(|k| k as f64 * SHAKEN_S / SHAKEN_STEPS as f64).collect();
    if stands {
        let force = acceleration.map(|a| -a * scene.cables[0].linear_density_kg_per_m);
        scene.environment.wind_times_s = vec![0.0, 1e-6];
        scene.environment.winds_n_per_m = vec![[0.0; 2], force];
        return scene;
    }
    for support in &mut scene.cables[0].supports {
        let at = support.at_m.unwrap();
        let own = |t: f64| support.motion.as_ref().map_or(at, |motion| motion.at(t).0.into());
        let place = |t: &f64| [0, 1].map(|k| own(*t)[k] + 0.5 * acceleration[k] * t * t);
        let points_m = times_s.iter().map(place).collect();
        support.motion = Some(Motion { times_s: times_s.clone(), points_m });
    }
    scene
}

/// The answer at the end of such a motion.
fn answer(scene: &Scene, inertia: Inertia, whole_s: f64, steps: usize) -> CableSolution {
    let question = Question::History(inertia);
    let mut run =
        Simulation::for_question(scene.clone(), Model::Fem, Settings::default(), question).expect("a problem");
    run.settle().expect("a first rest");
    for k in 0..steps {
        let dt = whole_s / steps as f64;
        let done = match inertia {
            Inertia::QuasiStatic => run.step_quasi_static(dt),
            Inertia::Dynamic => run.step(dt),
        };
        done.unwrap_or_else(|error| panic!("step {k}: {error}"));
    }
    run.solution().cables[0].clone()
}

/// Forces of the supports on the cable, N.
fn reactions(answer: &CableSolution) -> Vec<[f64; 2]> {
    answer.supports.iter().map(|s| [s.reaction_x_n, s.reaction_y_n]).collect()
}

/// Asserts that forces over a wheel that stands are those over one that moves, to a part of the
/// greatest.
fn assert_alike(stands: &[[f64; 2]], moves: &[[f64; 2]], part: f64) {
    let scale = stands.iter().flatten().fold(0.0_f64, |most, force| most.max(force.abs()));
    for (a, b) in stands.iter().zip(moves) {
        let off = (a[0] - b[0]).hypot(a[1] - b[1]);
        assert!(off < part * scale, "{a:?} N standing, {b:?} N moving");
    }
}

#[test]
fn issue_016_a_stiff_cable_over_a_wheel_that_moves_is_as_over_one_that_stands() {
    for (stiffness, friction) in [(0.3, 0.0), (2.0, 0.0), (2.0, 0.2)] {
        let [stands, moves] = [[0.0; 2], [0.3, 0.1]].map(|velocity| {
            reactions(&answer(&scene(stiffness, friction, velocity), Inertia::QuasiStatic, DRAWN_S, 90))
        });
        println!("EI {stiffness} mu {friction}: {stands:.3?} {moves:.3?}");
        assert_alike(&stands, &moves, 1e-3);
    }
}

#[test]
fn issue_016_a_stiff_cable_over_an_accelerated_wheel_feels_its_own_inertia() {
    for acceleration in [[0.0, 3.0], [1.5, -2.0]] {
        let [stands, moves] = [true, false].map(|stands| {
            reactions(&answer(&accelerated(acceleration, stands), Inertia::Dynamic, SHAKEN_S, SHAKEN_STEPS))
        });
        println!("{acceleration:?} m/s²: {stands:.3?} {moves:.3?}");
        assert_alike(&stands, &moves, 1e-3);
    }
}

/// The force at the end of a cable that pushes was reported as a tension of its size, beside nodes
/// in compression: 10.8 N for −10.8 N, as the greatest tension.
#[test]
fn issue_016_a_stiff_cable_that_pushes_on_its_end_is_in_compression_there() {
    // An arch whose ends are pinned 2 m apart.
    let mut scene = scene(20.0, 0.0, [0.0; 2]);
    scene.cables[0].length_m = 2.2;
    scene.cables[0].segments = Some(60);
    scene.cables[0].supports = [-1.0, 1.0].map(|x| Support::fixed(format!("at {x}"), [x, 2.0])).to_vec();
    let histories = [Inertia::QuasiStatic, Inertia::Dynamic];
    for (model, inertia) in [(Model::Fem, histories[0]), (Model::Fem, histories[1]), (Model::MassSpring, histories[1])]
    {
        let question = Question::History(inertia);
        let mut run = Simulation::for_question(scene.clone(), model, Settings::default(), question).unwrap();
        let rest = run.settle().unwrap().cables[0].nodes[0].tension_n;
        match inertia {
            Inertia::QuasiStatic => run.step_quasi_static(1e-3).unwrap(),
            Inertia::Dynamic => run.step(1e-3).unwrap(),
        };
        let answer = run.solution();
        let [end, beside] = [0, 1].map(|k| answer.cables[0].nodes[k].tension_n);
        assert!(
            rest < -5.0 && (end - rest).abs() < 0.5 && (end - beside).abs() < 1.0,
            "{model:?}: {rest} {end} {beside}"
        );
    }
}
