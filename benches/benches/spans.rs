//! What `spans` costs: a warm step by the number of contacts, over ground of any number of corners, and a first rest. "solver"
//! is the step of the model alone, "whole step" that of a simulation with its answer, warnings and energies.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;
use std::time::Duration;

use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};
use cable_core::{Model, Simulation, Vec2};
use criterion::{Criterion, criterion_group, criterion_main};

/// Height at which the route passes over all ridges, m.
const ABOVE_M: f64 = 9.0;

/// A flexible cable with friction over ground.
fn over(points_m: Vec<[f64; 2]>, (a, b): ([f64; 2], [f64; 2]), length_m: f64) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    scene.obstacles =
        vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.3) }];
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, 1e6, 0.02);
    (c.service_tension_n, c.breaking_tension_n, c.length_m) = (1e15, 1e15, length_m);
    c.route_m = vec![a, [a[0], ABOVE_M], [b[0], ABOVE_M], b];
    c.supports = vec![Support::fixed("A", a), Support::fixed("B", b)];
    scene
}

/// So many ridges a metre apart, on a rise, so that a taut cable bends at each; with `fine` more corners on each flank.
fn ridges(count: usize, fine: usize) -> Scene {
    let height = |x: f64| 0.02 * x * (count as f64 + 1.0 - x);
    let mut points = vec![[-5.0, -1.0], [0.5, -1.0]];
    for k in 1..=count {
        let x = k as f64;
        points.push([x, height(x)]);
        // A hollow of many corners between two ridges.
        for i in 1..fine {
            let u = i as f64 / fine as f64;
            let sag = 0.4 + 0.4 * (1.0 - (2.0 * u - 1.0).powi(2));
            if k < count {
                points.push([x + u, height(x) + u * (height(x + 1.0) - height(x)) - sag]);
            }
        }
        if k < count && fine <= 1 {
            points.push([x + 0.5, height(x + 0.5) - 0.5]);
        }
    }
    let end = count as f64 + 1.0;
    points.extend([[end - 0.5, -1.0], [end + 5.0, -1.0]]);
    let way: f64 = (0..=count).map(|k| (height(k as f64 + 1.0) - height(k as f64)).hypot(1.0)).sum();
    over(points, ([0.0, 0.0], [end, 0.0]), way * 1.0005)
}

/// A step to and fro.
fn step(model: &mut SpansModel, at: Vec2, k: &mut u64) {
    *k += 1;
    let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    model.drag_support(1, at + Vec2::new(0.0, 1e-3 * side));
    black_box(model.advance(0.1, Inertia::QuasiStatic).expect("a step"));
}

fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("spans");
    group.sample_size(20).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(500));
    let cases =
        [("1 corner", 1, 1), ("10 corners", 10, 1), ("36 corners", 36, 1), ("10 corners, 1000 in the ground", 10, 110)];
    for (id, count, fine) in cases {
        let scene = ridges(count, fine);
        let last = scene.cables[0].supports[1].at_m.expect("a place");
        let at = Vec2::new(last[0], last[1]);
        let mut model =
            SpansModel::new(problems(&scene).expect("valid").remove(0), Settings::default()).expect("a model");
        let cold = model.clone();
        if let Err(e) = model.settle() {
            eprintln!("skipped: {id}: {e}");
            continue;
        }
        println!("{id}: {} contacts", model.solution().contacts.len());
        let mut k = 0;
        group.bench_function(format!("{id}: solver"), |b| b.iter(|| step(&mut model, at, &mut k)));
        group.bench_function(format!("{id}: first rest"), |b| b.iter(|| black_box(cold.clone().settle())));
        let mut simulation = Simulation::new(scene, Model::Spans).expect("a simulation");
        simulation.settle().expect("a rest");
        group.bench_function(format!("{id}: whole step"), |b| {
            b.iter(|| {
                k += 1;
                let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
                simulation.drag_support(0, 1, at + Vec2::new(0.0, 1e-3 * side));
                simulation.step_quasi_static(0.1).expect("a step");
            });
        });
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
