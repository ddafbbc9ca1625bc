//! The stability limit of explicit steps of `mass-spring` is what theory says.

#![allow(clippy::expect_used)] // a failing test is meant to panic

use cable_benches::explicit::{Bar, limit_by_theory, limit_measured, limit_of_model};
use cable_core::Model;

/// Without loss and with more and more: within 2 % of what the stiffness of the fastest motion
/// gives, which is less than without loss by 9 % at 0.02.
#[test]
fn the_measured_limit_is_that_of_theory() {
    for damping in [0.0, 0.005, 0.01, 0.02] {
        let [measured, theory] = [limit_measured(damping).expect("a bar at rest"), limit_by_theory(damping)];
        println!("damping {damping}: {measured:.4} measured, {theory:.4} by theory");
        assert!((measured / theory - 1.0).abs() < 0.02, "damping {damping}: {measured} and {theory}");
    }
}

/// The model takes steps for stable that are, and few others for unstable.
#[test]
fn the_limit_of_the_model_is_safe() {
    for damping in [0.0, 0.005, 0.02, 0.05, 0.1] {
        let [measured, own] = [limit_measured(damping), limit_of_model(damping)].map(|limit| limit.expect("a bar"));
        println!("damping {damping}: {measured:.4} measured, {own:.4} by the model");
        assert!(own < 1.001 * measured && own > 0.95 * measured, "damping {damping}: {measured} and {own}");
    }
}

/// Steps are those asked for: 0.8 of the limit, as the program takes them, and beyond it.
#[test]
fn the_model_takes_the_steps_of_the_measurement() {
    for (damping, part) in [(0.0, 0.8), (0.02, 0.8), (0.02, 1.2)] {
        let mut bar = Bar::new(Model::MassSpring, part * limit_by_theory(damping), damping).expect("a bar at rest");
        assert_eq!(bar.grows(), part > 1.0, "damping {damping}, {part} of the limit");
        assert!((bar.step_taken() - 1.0).abs() < 1e-6, "{} of the step asked for", bar.step_taken());
    }
}
