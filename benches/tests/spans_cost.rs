//! A warm step and a first rest of `spans` cost a pinned number of Newton iterations: a change of
//! the method that costs more is seen without a clock. One iteration is one evaluation of all
//! equations and one elimination (`benches/benches/spans.rs` has the same scenes, and times).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_benches::ridges::ridges;
use cable_core::Vec2;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;

/// A held end goes to and fro by 2 mm: every step reverses all friction that acts. Most iterations
/// of a step, and of the rest.
fn cost(count: usize) -> (usize, usize) {
    let scene = ridges(count, 1);
    let last = scene.cables[0].supports[1].at_m.expect("a place");
    let mut model = SpansModel::new(problems(&scene).expect("valid").remove(0), Settings::default()).expect("a model");
    let rest = model.settle().expect("a rest").cost.iterations;
    assert_eq!(model.solution().contacts.len(), count);
    let mut most = 0;
    for k in 0..40 {
        let side = if k % 2 == 0 { 1e-3 } else { -1e-3 };
        model.drag_support(1, Vec2::new(last[0], last[1] + side));
        let taken = model.advance(0.1, Inertia::QuasiStatic).expect("a step").cost;
        assert_eq!(taken.halved_steps, 0, "step {k}");
        most = most.max(taken.iterations);
    }
    println!("{count} contacts: first rest {rest} iterations, warm step at most {most}");
    (rest, most)
}

/// Measured: 1 in every warm step; 3, 3 and 6 in a first rest.
#[test]
fn a_step_that_reverses_friction_takes_a_handful_of_iterations_whatever_the_number_of_contacts() {
    for (count, rest, warm) in [(1, 6, 2), (10, 6, 2), (36, 12, 3)] {
        let found = cost(count);
        assert!(found.0 <= rest && found.1 <= warm, "{count} contacts: {found:?}, {rest} and {warm} allowed");
    }
}
