//! A motion begins at the rest that is shown for its scene, also where the model of the motion
//! finds none of its own.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::model::Inertia;
use cable_core::model::auto::Question;
use cable_core::scene::catalog;
use cable_core::{Model, Settings, Simulation};

/// With so much cable in the tank `fem` found a rest that broke a law, and the motion ended before
/// it began.
#[test]
fn issue_016_slack_cables_in_a_tank_begin_to_move() {
    for length_m in [25.0, 30.0, 50.0] {
        let mut scene = catalog::tank();
        scene.cables[0].length_m = length_m;
        let mut at_rest = Simulation::new(scene.clone(), Model::Auto).unwrap();
        let shown_n = at_rest.settle().unwrap().max_tension().tension_n;
        let question = Question::History(Inertia::Dynamic);
        let mut sim = Simulation::for_question(scene, Model::Auto, Settings::default(), question).unwrap();
        let begins_n = sim.settle().unwrap().max_tension().tension_n;
        for _ in 0..60 {
            sim.step(1.0 / 240.0).unwrap();
        }
        let moved_n = sim.solution().max_tension().tension_n;
        println!("{length_m} m: {shown_n:.2} N at rest, {begins_n:.2} and {moved_n:.2} N in motion");
        assert_eq!(sim.solution().model, Model::Fem);
        for n in [begins_n, moved_n] {
            assert!((n / shown_n - 1.0).abs() < 0.03, "{length_m} m: {n} and {shown_n} N");
        }
    }
}
