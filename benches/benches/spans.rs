//! This bench measures the cost of `spans`: a warm step by the number of contacts, over ground of
//! any number of corners, and a first rest. "solver" is the step of the model alone, "whole step"
//! that of a simulation with its answer, warnings and energies.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;
use std::time::Duration;

use cable_benches::ridges::ridges;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::{Model, Simulation, Vec2};
use criterion::{Criterion, criterion_group, criterion_main};

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
