//! The cost of `fem` on free cables grows with the number of bars and not faster: iterations do not depend on the mesh.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::model::fem::FemModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::catalog;

/// A flexible hanging span whose far support goes to and fro, at rest.
fn swinging(bars: usize) -> FemModel {
    let scene = catalog::swinging_span();
    let settings = Settings { segments: Some(bars), ..Settings::default() };
    let mut model = FemModel::new(problems(&scene).unwrap().remove(0), settings).unwrap();
    model.settle().unwrap();
    model
}

#[test]
fn iterations_of_a_resting_span_do_not_grow_with_the_mesh() {
    let found = [100, 1000, 10_000].map(|n| {
        let mut scene = catalog::hanging_span();
        scene.cables[0].bending_stiffness_n_m2 = 0.0;
        let settings = Settings { segments: Some(n), ..Settings::default() };
        let mut model = FemModel::new(problems(&scene).unwrap().remove(0), settings).unwrap();
        model.settle().unwrap().cost.iterations
    });
    println!("{found:?}");
    assert!(found.iter().all(|&n| n <= 6), "{found:?}");
}

#[test]
fn iterations_of_a_swinging_span_do_not_grow_with_the_mesh() {
    for bars in [100, 1000, 10_000] {
        let mut model = swinging(bars);
        let steps = if bars > 1000 { 24 } else { 120 };
        let (mut whole, mut most, mut halved) = (0, 0, 0);
        for _ in 0..steps {
            let cost = model.advance(1.0 / 240.0, Inertia::Dynamic).unwrap().cost;
            whole += cost.iterations;
            most = cost.iterations.max(most);
            halved += cost.halved_steps;
        }
        println!(
            "{bars} bars: {:.2} iterations a step, at most {most}, {halved} steps halved",
            whole as f64 / steps as f64
        );
        assert!(whole <= 5 * steps && most <= 8 && halved == 0, "{bars} bars: {whole} in {steps}, {most}, {halved}");
    }
}
