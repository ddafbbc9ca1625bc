//! The floor of a plan view rubs on half a bar between a node and the middle of the bar, where
//! `fem` reads the tension: a node beside a post that has a long bar on one side was called unsound
//! by 4 mN (`plan-posts` with 500 bars, at 4.28 s).

#![allow(clippy::expect_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Motion, Support, SupportKind, View, catalog};
use cable_core::{Model, Settings, Simulation};

#[test]
fn friction_of_the_floor_on_half_a_bar_is_no_fault() {
    let settings = Settings { tolerance: 1e-2, segments: Some(500), ..Settings::default() };
    let mut simulation = Simulation::with_settings(catalog::plan_posts(), Model::Fem, settings).expect("a simulation");
    simulation.settle().expect("a rest");
    for frame in 1..=270 {
        simulation.step_quasi_static(1.0 / 60.0).unwrap_or_else(|e| panic!("frame {frame}: {e}"));
    }
}

/// A lump on the floor of a plan view rubs as it does in a side view: towed behind a straight cable
/// it added nothing to the pull (21.5 N for 99.9 N).
#[test]
fn issue_016_a_towed_lump_rubs_on_the_floor_of_a_plan_view() {
    let (length, density, friction, mass) = (4.0, 1.25, 0.4, 20.0);
    for (loaded, load) in [(SupportKind::Free, 0.0), (SupportKind::Load, 10.0)] {
        let force_n = (load > 0.0).then_some([-load, 0.0]);
        let lump = Support { mass_kg: Some(mass), force_n, ..Support::new("lump", loaded) };
        let hand = Motion { times_s: vec![0.0, 4.0], points_m: vec![[length, 0.0], [length + 1.0, 0.0]] };
        let hand = Support { motion: Some(hand), ..Support::fixed("hand", [length, 0.0]) };
        let mut scene = catalog::cable_alone([length, density, 2e5], vec![lump, hand]);
        scene.view = View::Plan;
        scene.cables[0].friction = friction;
        scene.cables[0].route_m = vec![[0.0, 0.0], [length, 0.0]];
        scene.cables[0].segments = Some(40);
        let expected = friction * 9.80665 * (density * length + mass) + load;
        for model in [Model::Auto, Model::Fem, Model::MassSpring] {
            let mut sim = Simulation::new(scene.clone(), model).expect("a simulation");
            sim.settle().unwrap_or_else(|e| panic!("{model:?}: {e}"));
            for _ in 0..40 {
                sim.step_quasi_static(0.1).unwrap_or_else(|e| panic!("{model:?}: {e}"));
            }
            let pull = -sim.answers()[0].supports[1].reaction_x_n;
            println!("{loaded:?} {model:?}: {pull:.4} N of {expected:.4} N");
            assert!((pull / expected - 1.0).abs() < 3e-3, "{loaded:?} {model:?}: {pull} N for {expected} N");
        }
        let mut sim = Simulation::new(scene.clone(), Model::Fem).expect("a simulation");
        sim.settle().unwrap_or_else(|e| panic!("{e}"));
        for _ in 0..480 {
            sim.step(1.0 / 240.0).unwrap_or_else(|e| panic!("{e}"));
        }
        // The hand moves evenly in the middle of its way.
        let pull = -sim.answers()[0].supports[1].reaction_x_n;
        println!("{loaded:?} with inertia: {pull:.2} N");
        assert!((pull / expected - 1.0).abs() < 0.05, "{loaded:?}: {pull} N for {expected} N");
    }
}
