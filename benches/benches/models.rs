//! This bench times `settle` and `step` of every model on the same catalogue scenes at N = 20, 100,
//! 1000 elements.
//!
//! A model that cannot answer a scene is skipped with a note.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;
use std::time::Duration;

use cable_benches::{fresh, settled};
use cable_core::{Model, Scene, scene::catalog};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

const MESHES: [usize; 3] = [20, 100, 1000];
/// One frame at 60 per second.
const FRAME_S: f64 = 1.0 / 60.0;

/// One scene of each kind, so that a bench run stays short.
fn scenes() -> [(&'static str, Scene); 5] {
    [
        ("hanging-span", catalog::hanging_span()),
        ("near-taut", catalog::near_taut()),
        ("pulley-waypoints", catalog::pulley_waypoints()),
        ("slack-to-floor", catalog::slack_to_floor()),
        ("over-beam", catalog::over_beam()),
    ]
}

fn settle(c: &mut Criterion) {
    let mut group = c.benchmark_group("settle");
    group.sample_size(10).measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_millis(500));
    for (id, scene) in scenes() {
        if let Some(start) = fresh(&scene, Model::Catenary, None)
            && settled(&scene, Model::Catenary, None).is_some()
        {
            group.bench_function(BenchmarkId::new("catenary", id), |b| b.iter(|| black_box(start.clone().settle())));
        }
        for model in [Model::Fem, Model::MassSpring] {
            for n in MESHES {
                let Some(start) = fresh(&scene, model, Some(n)) else { continue };
                if settled(&scene, model, Some(n)).is_none() {
                    continue;
                }
                group.bench_with_input(BenchmarkId::new(format!("{model}-{n}"), id), &start, |b, start| {
                    b.iter(|| black_box(start.clone().settle()));
                });
            }
        }
    }
    group.finish();
}

/// A free span on bars, the copy of the simulation left out of the time.
fn free_span(c: &mut Criterion) {
    let mut group = c.benchmark_group("fem free span");
    group.sample_size(20).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(500));
    for n in MESHES {
        let start = fresh(&catalog::hanging_span(), Model::Fem, Some(n)).expect("a free span");
        assert!(start.clone().settle().is_ok());
        group.bench_function(format!("N = {n} settle"), |b| {
            b.iter_batched_ref(|| start.clone(), |s| black_box(s.settle()), criterion::BatchSize::SmallInput);
        });
    }
    let start = fresh(&catalog::hanging_span(), Model::Catenary, None).expect("a free span");
    group.bench_function("catenary settle", |b| {
        b.iter_batched_ref(|| start.clone(), |s| black_box(s.settle()), criterion::BatchSize::SmallInput);
    });
    group.finish();
}

fn step(c: &mut Criterion) {
    let mut group = c.benchmark_group("step");
    group.sample_size(10).measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_millis(500));
    for (id, scene) in scenes() {
        for model in [Model::Fem, Model::MassSpring] {
            for n in MESHES.into_iter().filter(|n| model != Model::MassSpring || *n <= 100) {
                let Some(mut s) = settled(&scene, model, Some(n)) else { continue };
                if let Err(e) = s.step(FRAME_S) {
                    eprintln!("skipped: step of {model} on \"{}\": {e}", scene.name);
                    continue;
                }
                group.bench_with_input(BenchmarkId::new(format!("{model}-{n}"), id), &s, |b, s| {
                    b.iter_batched_ref(|| s.clone(), |s| black_box(s.step(FRAME_S)), criterion::BatchSize::LargeInput);
                });
            }
        }
    }
    group.finish();
}

/// A span, and a rope over a rubbing wheel, so stiff that mass-spring previews them: time of a
/// simulated second. The aim is 5 ms at N = 100.
fn preview(c: &mut Criterion) {
    let mut group = c.benchmark_group("preview of a stiff cable, one simulated second");
    group.sample_size(10).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(500));
    for (id, mut scene) in
        [("hanging-span", catalog::hanging_span()), ("pulley-waypoints", catalog::pulley_waypoints())]
    {
        scene.cables[0].axial_stiffness_n = 1e9;
        scene.cables[0].bending_stiffness_n_m2 = 0.0;
        for n in MESHES.into_iter().take(2) {
            let Some(start) = settled(&scene, Model::MassSpring, Some(n)) else { continue };
            group.bench_function(BenchmarkId::new(format!("N = {n}"), id), |b| {
                b.iter_batched_ref(
                    || start.clone(),
                    |s| (0..60).for_each(|_| assert!(black_box(s.step(FRAME_S)).is_ok())),
                    criterion::BatchSize::LargeInput,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, settle, free_span, step, preview);
criterion_main!(benches);
