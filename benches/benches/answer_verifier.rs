//! This bench measures the cost to check an answer against the laws, beside that to find it: in
//! nanoseconds a node and as a part of the first rest. Both in one run; the least of some
//! repetitions.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic
#![allow(missing_docs)] // criterion's macros

use std::hint::black_box;
use std::time::{Duration, Instant};

use cable_core::answer_verifier::{Depth, Verifier};
use cable_core::scene::{Scene, catalog};
use cable_core::{Model, Simulation};
use criterion::{Criterion, criterion_group, criterion_main};

/// Repetitions of which the least counts.
const TIMES: usize = 20;

fn least(mut what: impl FnMut()) -> Duration {
    let once = |what: &mut dyn FnMut()| {
        let begin = Instant::now();
        what();
        begin.elapsed()
    };
    (0..TIMES).map(|_| once(&mut what)).min().unwrap_or_default()
}

fn checks(c: &mut Criterion) {
    let mut group = c.benchmark_group("verify");
    println!("scene, model, nodes: check in us, ns a node, % of the first rest (with building and checking it)");
    for (name, scene) in catalog::all() {
        let scene: Scene = scene;
        let Ok(solution) = Simulation::new(scene.clone(), Model::Auto).and_then(|mut s| Ok(s.settle()?)) else {
            continue;
        };
        let verifier = Verifier::new(&scene);
        let check = least(|| {
            black_box(verifier.check(&scene, &solution, Depth::Always));
        });
        let rest = least(|| {
            black_box(Simulation::new(scene.clone(), Model::Auto).and_then(|mut s| Ok(s.settle()?)).is_ok());
        });
        let nodes: usize = solution.cables.iter().map(|c| c.nodes.len()).sum();
        let [check_us, rest_us] = [check, rest].map(|t| t.as_secs_f64() * 1e6);
        println!(
            "{name}, {}, {nodes}: {check_us:.1} us, {:.0} ns, {:.1} %",
            solution.model,
            1e3 * check_us / nodes as f64,
            100.0 * check_us / rest_us
        );
        group.bench_function(name, |b| b.iter(|| verifier.check(&scene, &solution, Depth::Always)));
    }
    group.finish();
}

criterion_group!(benches, checks);
criterion_main!(benches);
