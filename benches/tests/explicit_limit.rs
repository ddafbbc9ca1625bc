//! The stability limit of explicit steps of `mass-spring` is what theory says.

#![allow(clippy::expect_used)] // a failing test is meant to panic

use cable_benches::explicit::{Bar, limit_by_theory, limit_measured};
use cable_core::Model;

/// Without damping, with the least that the program has, and with much: within 2 % of
/// 2(√(1+ζ²) − ζ), which halves of the limit without damping are not.
#[test]
fn the_measured_limit_is_that_of_theory() {
    for damping in [0.0, 0.1, 0.5] {
        let [measured, theory] = [limit_measured(damping).expect("a bar at rest"), limit_by_theory(damping)];
        println!("damping {damping}: {measured:.4} measured, {theory:.4} by theory");
        assert!((measured / theory - 1.0).abs() < 0.02, "damping {damping}: {measured} and {theory}");
    }
}

/// Steps are those asked for: 0.8 of the limit, as the program takes them, and beyond it.
#[test]
fn the_model_takes_the_steps_of_the_measurement() {
    for (damping, part) in [(0.0, 0.8), (0.1, 0.8), (0.5, 1.2)] {
        let mut bar = Bar::new(Model::MassSpring, part * limit_by_theory(damping), damping).expect("a bar at rest");
        assert_eq!(bar.grows(), part > 1.0, "damping {damping}, {part} of the limit");
        assert!((bar.step_taken() - 1.0).abs() < 1e-6, "{} of the step asked for", bar.step_taken());
    }
}
