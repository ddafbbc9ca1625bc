//! This bench times contact queries against terrain of 1000 edges.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;

use cable_core::Vec2;
use cable_core::contact::World;
use cable_core::scene::{Obstacle, Shape};
use criterion::{Criterion, criterion_group, criterion_main};

const EDGES: u32 = 1000;
const CABLE_RADIUS_M: f64 = 0.014;

/// Waves of 2 m with stones of 0.3 m on them.
fn terrain() -> World {
    let points_m = (0..=EDGES)
        .map(|k| {
            let x = 0.1 * f64::from(k);
            [x, 0.3 * (3.1 * x).sin() + 0.05 * (21.0 * x).cos()]
        })
        .collect();
    let ground = Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.5) };
    World::new(&[ground], 0.5, CABLE_RADIUS_M)
}

fn queries(c: &mut Criterion) {
    let world = terrain();
    let mut group = c.benchmark_group("contact");
    let mut k = 0u32;
    // Walks over the terrain so that no one place stays in cache.
    let mut next = move || {
        k = (k + 7919) % 99_000;
        0.5 + 0.001 * f64::from(k)
    };
    group.bench_function("signed gap of a point", |b| {
        b.iter(|| black_box(world.signed_gap(black_box(Vec2::new(next(), 0.4)), 1.0)));
    });
    let mut gaps = Vec::new();
    group.bench_function("gaps of a segment", |b| {
        b.iter(|| {
            gaps.clear();
            let a = Vec2::new(next(), 0.36);
            world.segment_gaps(black_box(a), a + Vec2::new(0.1, 0.01), 0.05, &mut gaps);
            black_box(gaps.len())
        });
    });
    group.bench_function("free fraction of a moving segment", |b| {
        b.iter(|| {
            let a = Vec2::new(next(), 0.5);
            let d = Vec2::new(0.1, 0.0);
            black_box(world.free_fraction([a, a + d], [a - Vec2::y(), a + d - Vec2::y()], 0.2))
        });
    });
    group.finish();
}

criterion_group!(benches, queries);
criterion_main!(benches);
