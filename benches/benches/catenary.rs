//! This bench times the elastic catenary over its whole range of shapes, stiffness and slack.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;

use cable_benches::span_grid;
use cable_core::catenary::{Catenary, Chain, PointForce};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn solve(c: &mut Criterion) {
    let grid = span_grid();
    // A time of refusals would be a lie.
    assert_eq!(grid.len(), 150);
    for span in &grid {
        assert!(Catenary::solve(span).is_ok(), "not answered: {span:?}");
    }
    let mut group = c.benchmark_group("catenary");
    // Time per element is time per solve.
    group.throughput(Throughput::Elements(grid.len() as u64));
    group.bench_function("grid", |b| {
        b.iter(|| {
            for span in &grid {
                let _ = black_box(Catenary::solve(black_box(span)));
            }
        });
    });
    group.throughput(Throughput::Elements(1));
    let level = grid[14];
    group.bench_function("one span", |b| b.iter(|| black_box(Catenary::solve(black_box(&level)))));
    let loads: Vec<PointForce> = (1..5)
        .map(|k| PointForce { arc_length: 0.2 * f64::from(k) * level.length, force: level.weight * 20.0 })
        .collect();
    let chain = Chain {
        from: 0.0,
        to: level.length,
        weight: level.weight,
        axial_stiffness: level.axial_stiffness,
        thermal_stretch: 1.0,
        loads: &loads,
    };
    group.bench_function("four loads", |b| b.iter(|| black_box(chain.solve(black_box(level.chord), None))));
    group.finish();
}

criterion_group!(benches, solve);
criterion_main!(benches);
