//! A warm step takes no memory: counted by an allocator that counts.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use allocation_counter::measure;
use cable_core::Vec2;
use cable_core::model::fem::FemModel;
use cable_core::model::mass_spring::MassSpringModel;
use cable_core::model::spans::SpansModel;
use cable_core::model::tension_gauge::{Limit, TensionGauge};
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::{Problem, problems};
use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};
use std::sync::Arc;

fn problem(scene: &Scene) -> Arc<Problem> {
    problems(scene).unwrap().remove(0)
}

/// Allocations in 24 steps after as many, their tension gauged.
fn warm_steps(model: &mut dyn Mechanics, dt_s: f64) -> u64 {
    let mut gauge = TensionGauge::over(4e-3);
    let mut steps = || {
        for _ in 0..24 {
            gauge.watch([Limit::default()]);
            model.advance_gauged(dt_s, Inertia::Dynamic, &mut gauge).unwrap();
            assert!(gauge.peaks().is_some());
        }
    };
    steps();
    measure(steps).count_total
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
        assert!(count <= 16, "{segments} bars: {count} lists");
    }
}

#[test]
fn a_step_of_fem_on_the_floor_takes_no_memory() {
    let mut model = FemModel::new(problem(&catalog::slack_to_floor()), Settings::default()).unwrap();
    model.settle().unwrap();
    assert_eq!(warm_steps(&mut model, 1.0 / 240.0), 0);
}

/// A cable let go above a floor; the steps counted are those in which it comes down.
#[test]
fn a_step_of_fem_that_lands_takes_no_memory() {
    let mut scene = catalog::hanging_span();
    let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [15.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.5) }];
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.bending_stiffness_n_m2) = (10.0, 0.0);
    let hook = |name: &str, x| Support { release_s: Some(1e-3), ..Support::fixed(name, [x, 0.6]) };
    cable.supports = vec![hook("a", 0.0), hook("b", 9.95)];
    let settings = Settings { segments: Some(100), ..Settings::default() };
    let mut model = FemModel::new(problem(&scene), settings).unwrap();
    model.settle().unwrap();
    // It touches the floor from step 41 on and lies on it all along after 84.
    for _ in 0..36 {
        model.advance(1.0 / 240.0, Inertia::Dynamic).unwrap();
    }
    assert_eq!(warm_steps(&mut model, 1.0 / 240.0), 0);
}

/// Over a beam with friction, an end to and fro: neither unknowns, histories nor shapes take memory
/// anew.
#[test]
fn a_warm_step_of_spans_takes_no_memory() {
    let mut scene = catalog::over_beam();
    scene.cables[0].bending_stiffness_n_m2 = 0.0;
    let problem = problem(&scene);
    let mut model = SpansModel::new(problem.clone(), Settings::default()).unwrap();
    model.settle().unwrap();
    let last = problem.supports.len() - 1;
    let (at, _) = problem.supports[last].position_at(0.0).unwrap();
    let mut step = |k: u32| {
        let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        model.drag_support(last, at + Vec2::new(0.0, 0.01 * side));
        model.advance(1.0 / 60.0, Inertia::QuasiStatic).unwrap();
    };
    (0..24).for_each(&mut step);
    let count = measure(|| (0..24).for_each(&mut step)).count_total;
    assert_eq!(count, 0);
}
