//! This bench times every scene of the catalogue, a group each: `fem`, `mass-spring` and `spans`
//! side by side, settling and stepping a frame, with the error against a reference printed before
//! the times (of friction, after its motion: see `cable_benches::compare`).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;
use std::time::Duration;

use cable_benches::compare::{self, Reference};
use cable_benches::{fresh, settled};
use cable_core::{Model, scene::catalog};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};

const SEGMENTS: usize = 100;
/// Elements of the reference: `docs/charts/scenes.csv` has finer ones.
const FINEST: usize = 200;
/// One frame at 60 per second.
const FRAME_S: f64 = 1.0 / 60.0;

fn scenes(c: &mut Criterion) {
    for (id, scene) in catalog::all() {
        let reference = Reference::of(&scene, FINEST);
        let mut group = c.benchmark_group(id);
        group.sample_size(10).measurement_time(Duration::from_secs(1)).warm_up_time(Duration::from_millis(200));
        for model in [Model::Fem, Model::MassSpring, Model::Spans] {
            let segments = (model != Model::Spans).then_some(SEGMENTS);
            let (Some(start), Some(rest)) = (fresh(&scene, model, segments), settled(&scene, model, segments)) else {
                continue;
            };
            if let Some(r) = &reference
                && let Some(row) = compare::once(id, &scene, r, (model, segments))
            {
                let (by, unsure) = (&r.by, r.uncertainty);
                println!(
                    "{id}, {model}: error {:.1e} against {by} (uncertain by {unsure:.0e}), {:.1e} s",
                    row.error, row.cost_s
                );
            }
            group.bench_function(format!("{model} settles"), |b| {
                b.iter_batched_ref(|| start.clone(), |s| black_box(s.settle()), BatchSize::LargeInput);
            });
            let mut moving = rest;
            if let Err(e) = moving.step(FRAME_S) {
                eprintln!("skipped: a step of {model} on \"{id}\": {e}");
                continue;
            }
            group.bench_function(format!("{model} steps a frame"), |b| {
                b.iter_batched_ref(|| moving.clone(), |s| black_box(s.step(FRAME_S)), BatchSize::LargeInput);
            });
        }
        group.finish();
    }
}

criterion_group!(benches, scenes);
criterion_main!(benches);
