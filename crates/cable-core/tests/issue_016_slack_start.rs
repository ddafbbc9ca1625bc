//! A motion begins at the rest that is shown for its scene, also where the model of the motion
//! finds none of its own.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::model::{Inertia, Question};
use cable_core::scene::catalog;
use cable_core::timeline::{Instant, Timeline};
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
        sim.settle().unwrap();
        let mut timeline = Timeline::new(sim, Inertia::Dynamic, None).unwrap().with_errors();
        let mut moved = (Model::Auto, 0.0);
        let at = |sim: &Simulation| moved = (sim.solution().model, sim.max_tension().tension_n);
        timeline.at(Instant::nearest(0.25), at).unwrap();
        println!("{length_m} m: {shown_n:.2} N at rest, {:.2} N in motion", moved.1);
        assert!(moved.0 == Model::Fem && (moved.1 / shown_n - 1.0).abs() < 0.03, "{length_m} m: {moved:?}");
        let peaks = timeline.monitor().peaks();
        let ranges: Vec<_> = peaks.iter().filter_map(|p| p.ranges.as_ref()).collect();
        assert_eq!(ranges.len(), 1, "{length_m} m: {ranges:?}");
    }
}
