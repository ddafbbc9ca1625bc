//! A warm step takes no memory: counted by an allocator that counts.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use allocation_counter::measure;
use cable_core::model::fem::FemModel;
use cable_core::model::mass_spring::MassSpringModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::{Problem, problems};
use cable_core::scene::{Scene, catalog};
use std::sync::Arc;

fn problem(scene: &Scene) -> Arc<Problem> {
    problems(scene).unwrap().remove(0)
}

/// Allocations in 24 steps after as many.
fn warm_steps(model: &mut dyn Mechanics, dt_s: f64) -> u64 {
    for _ in 0..24 {
        model.advance(dt_s, Inertia::Dynamic).unwrap();
    }
    measure(|| {
        for _ in 0..24 {
            model.advance(dt_s, Inertia::Dynamic).unwrap();
        }
    })
    .count_total
}

#[test]
fn a_free_step_of_fem_takes_no_memory() {
    let mut model = FemModel::new(problem(&catalog::swinging_span()), Settings::default()).unwrap();
    assert_eq!(warm_steps(&mut model, 1.0 / 240.0), 0);
}

#[test]
fn a_free_step_of_a_stiff_cable_takes_no_memory() {
    let mut scene = catalog::swinging_span();
    scene.cables[0].bending_stiffness_n_m2 = 2.0;
    let mut model = FemModel::new(problem(&scene), Settings::default()).unwrap();
    assert_eq!(warm_steps(&mut model, 1.0 / 240.0), 0);
}

#[test]
fn a_step_of_mass_spring_takes_no_memory() {
    let mut model = MassSpringModel::new(problem(&catalog::swinging_span()), Settings::default()).unwrap();
    assert_eq!(warm_steps(&mut model, 1.0 / 240.0), 0);
}

/// Layout, spans and answer are made anew by each rest: a handful of lists, however fine the mesh.
#[test]
fn a_warm_rest_of_fem_takes_a_handful_of_lists() {
    for segments in [20, 2000] {
        let settings = Settings { segments: Some(segments), ..Settings::default() };
        let mut model = FemModel::new(problem(&catalog::swinging_span()), settings).unwrap();
        let mut step = || drop(model.advance(1.0 / 60.0, Inertia::QuasiStatic).unwrap());
        step();
        step();
        let count = measure(step).count_total;
        assert!(count <= 12, "{segments} bars: {count} lists");
    }
}

#[test]
fn a_step_of_fem_on_the_floor_takes_few() {
    let mut model = FemModel::new(problem(&catalog::slack_to_floor()), Settings::default()).unwrap();
    model.settle().unwrap();
    let count = warm_steps(&mut model, 1.0 / 240.0);
    assert!(count <= 24 * 10, "{count} in 24 steps");
}
