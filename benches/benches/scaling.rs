//! This bench measures the cost of `fem`: a Newton iteration and a step of a free span by the
//! number of bars, the swing of a chain, and contact with the ground as a part of real time.
//! Printed beside criterion's own lines; on one core.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;
use std::time::{Duration, Instant};

use cable_core::model::fem::FemModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::{State, Vec2};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};

/// Inner step of `fem`, s.
const STEP_S: f64 = 1.0 / 240.0;

/// Returns whether every bench is only to be tried once (`cargo bench -- --test`).
fn only_tried() -> bool {
    std::env::args().any(|a| a == "--test")
}

fn sizes() -> &'static [usize] {
    if only_tried() { &[100, 1000] } else { &[100, 1000, 10_000, 100_000] }
}

fn model(scene: &Scene, bars: usize) -> FemModel {
    let settings = Settings { segments: Some(bars), ..Settings::default() };
    FemModel::new(problems(scene).expect("valid").remove(0), settings).expect("a model")
}

/// A flexible span whose far support goes to and fro by 0.2 m in 2 s.
fn swinging(bars: usize) -> FemModel {
    let mut scene = catalog::hanging_span();
    scene.cables[0].bending_stiffness_n_m2 = 0.0;
    let far = &mut scene.cables[0].supports[1];
    let at = far.at_m.expect("a place");
    let near = [at[0] - 0.2, at[1]];
    far.motion = Some(Motion { times_s: vec![0.0, 1.0, 2.0, 3.0, 4.0], points_m: vec![at, near, at, near, at] });
    model(&scene, bars)
}

/// A chain of 10 m, horizontal and about to fall.
fn horizontal_chain() -> FemModel {
    const LENGTH: f64 = 10.0;
    const LINKS: usize = 50;
    let mut scene = catalog::hanging_span();
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.linear_density_kg_per_m, cable.axial_stiffness_n) = (LENGTH, 1.0, 1e8);
    (cable.bending_stiffness_n_m2, cable.damping_ratio) = (0.0, 0.0);
    cable.route_m.clear();
    cable.supports = vec![Support::fixed("wall", [0.0, 0.0]), Support::new("tip", SupportKind::Free)];
    scene.loads.clear();
    let mut chain = model(&scene, LINKS);
    chain.settle().expect("a resting place");
    let state = chain.state();
    let along: Vec<Vec2> = state.arc_length_m.iter().map(|&s| Vec2::new(s, 0.0)).collect();
    // As good as at rest: a state that moves is taken over as it is.
    let speed = vec![Vec2::new(0.0, -1e-12); along.len()];
    chain.set_state(&State { position_m: along, velocity_m_per_s: speed, ..state }).expect("a state");
    chain
}

/// A cable of 10 m let go at both ends 1 m above a floor.
fn dropped(bars: usize) -> FemModel {
    let mut scene = catalog::hanging_span();
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.bending_stiffness_n_m2) = (10.0, 0.0);
    cable.route_m.clear();
    let hook = |name: &str, x: f64| Support { release_s: Some(0.5 * STEP_S), ..Support::fixed(name, [x, 1.0]) };
    cable.supports = vec![hook("A", 0.0), hook("B", 9.95)];
    scene.loads.clear();
    let points_m = vec![[-5.0, 0.0], [15.0, 0.0]];
    scene.obstacles =
        vec![Obstacle { name: "floor".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.5) }];
    let mut cable = model(&scene, bars);
    cable.settle().expect("a resting place");
    cable
}

/// Seconds that `work` takes, the least of a few runs on copies of `start`.
fn least<T: Clone, R>(start: &T, mut work: impl FnMut(&mut T) -> R) -> f64 {
    let runs = if only_tried() { 1 } else { 5 };
    let time = |_| {
        let mut copy = start.clone();
        let begin = Instant::now();
        black_box(work(&mut copy));
        begin.elapsed().as_secs_f64()
    };
    (0..runs).map(time).fold(f64::INFINITY, f64::min)
}

/// Exponent p of cost ~ Nᵖ by least squares of the logarithms.
fn exponent(points: &[(usize, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|&(n, t)| ((n as f64).ln(), t.ln())).collect();
    let count = logs.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / logs.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>()
}

fn statics(c: &mut Criterion) {
    let mut points = Vec::new();
    for &n in sizes() {
        let start = swinging(n);
        let mut iterations = 0;
        let seconds = least(&start, |m| iterations = m.settle().expect("a resting place").cost.iterations);
        println!(
            "rest of a free span, N = {n}: {:.3} ms, {iterations} Newton iterations of {:.3} ms",
            1e3 * seconds,
            1e3 * seconds / iterations as f64
        );
        points.push((n, seconds));
    }
    println!("rest of a free span: cost ~ N^{:.2} (asked: at most 1.1)", exponent(&points));
    let start = swinging(10_000);
    let mut group = c.benchmark_group("fem rest");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    group.bench_function("N = 10000", |b| {
        b.iter_batched_ref(|| start.clone(), |m| black_box(m.settle()), BatchSize::LargeInput)
    });
    group.finish();
}

fn steps(c: &mut Criterion) {
    let (mut points, mut work) = (Vec::new(), Vec::new());
    for &n in sizes() {
        let mut start = swinging(n);
        start.settle().expect("a resting place");
        // The first steps still bring the bars' waves to rest.
        for _ in 0..if only_tried() { 4 } else { 48 } {
            start.advance(STEP_S, Inertia::Dynamic).expect("a step");
        }
        let steps = 8;
        let mut iterations = 0;
        let seconds = least(&start, |m| {
            iterations = 0;
            for _ in 0..steps {
                iterations += m.advance(STEP_S, Inertia::Dynamic).expect("a step").cost.iterations;
            }
        });
        let (step, each) = (seconds / steps as f64, seconds / iterations as f64);
        println!(
            "step of a swinging span, N = {n}: {:.3} ms, {:.1} Newton iterations of {:.3} ms",
            1e3 * step,
            iterations as f64 / steps as f64,
            1e3 * each
        );
        points.push((n, step));
        work.push((n, (n * iterations) as f64));
    }
    println!(
        "step of a swinging span: cost ~ N^{:.2} by the clock, N^{:.2} by bars times iterations (asked: at most 1.1)",
        exponent(&points),
        exponent(&work)
    );
    let mut start = swinging(10_000);
    start.settle().expect("a resting place");
    for _ in 0..4 {
        start.advance(STEP_S, Inertia::Dynamic).expect("a step");
    }
    let mut group = c.benchmark_group("fem step");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    group.bench_function("N = 10000", |b| {
        b.iter_batched_ref(|| start.clone(), |m| black_box(m.advance(STEP_S, Inertia::Dynamic)), BatchSize::LargeInput);
    });
    group.finish();
}

fn chain(c: &mut Criterion) {
    let start = horizontal_chain();
    // In its first second the tip is off by up to 4.0e-4 m at 240 Hz and 3.5e-4 m here
    // (`crates/cable-core/tests/dynamics/falling_chain.rs`).
    const STEPS: u32 = 480;
    let second = |m: &mut FemModel| {
        for _ in 0..STEPS {
            m.advance(1.0 / f64::from(STEPS), Inertia::Dynamic).expect("a step");
        }
    };
    println!(
        "10 m chain from the horizontal, N = 50, {STEPS} Hz (tip within 3.5e-4 m): {:.2} ms per simulated second (asked: 5e-4 m in 5)",
        1e3 * least(&start, second)
    );
    let mut group = c.benchmark_group("fem chain from the horizontal");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    group.bench_function("N = 50, a simulated second", |b| {
        b.iter_batched_ref(|| start.clone(), second, BatchSize::LargeInput)
    });
    group.finish();
}

fn contact(c: &mut Criterion) {
    let mut group = c.benchmark_group("fem on the ground");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    for (n, asked) in [(100, "5 % in impact, 1 % at rest"), (1000, "50 % in impact")] {
        if n > 100 && only_tried() {
            continue;
        }
        let mut falling = dropped(n);
        // Free fall from 1 m takes 0.45 s: the second after 0.4 s has the whole impact.
        for _ in 0..96 {
            falling.advance(STEP_S, Inertia::Dynamic).expect("a step");
        }
        let second = |m: &mut FemModel| {
            for _ in 0..240 {
                m.advance(STEP_S, Inertia::Dynamic).expect("a step");
            }
        };
        let impact = least(&falling, second);
        let mut resting = falling.clone();
        for _ in 0..if only_tried() { 0 } else { 4 } {
            second(&mut resting);
        }
        let rest = least(&resting, second);
        println!(
            "dropped cable, N = {n}, 240 Hz: {:.1} % of real time in impact, {:.2} % at rest (asked: {asked})",
            1e2 * impact,
            1e2 * rest
        );
        group.bench_function(format!("N = {n}, a second of impact"), |b| {
            b.iter_batched_ref(|| falling.clone(), second, BatchSize::LargeInput);
        });
    }
    group.finish();
}

criterion_group!(benches, statics, steps, chain, contact);
criterion_main!(benches);
