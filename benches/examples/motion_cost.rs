//! This example measures the cost of a motion: processor time as a part of the time that passes in
//! the scene, Newton iterations and halved steps, interval by interval.
//!
//! `cargo run --release -p cable-benches --example motion_cost rubble 1000 4`: `rubble` and `floor`
//! are a cable let go above uneven and above flat ground, anything else is a scene file; how many
//! elements; for how many seconds; and `sum` for one line only.

#![allow(clippy::expect_used)] // a tool for a developer: it may stop

use std::time::Instant;

use cable_core::model::fem::FemModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};

/// Inner step of `fem`, s.
const STEP_S: f64 = 1.0 / 240.0;
/// Steps of an interval that is told of.
const INTERVAL: usize = 48;

/// A cable of 10 m let go at both ends 1 m above a floor.
fn floor() -> Scene {
    let mut scene = catalog::hanging_span();
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.bending_stiffness_n_m2) = (10.0, 0.0);
    cable.route_m.clear();
    let hook = |name: &str, x: f64| Support { release_s: Some(0.5 * STEP_S), ..Support::fixed(name, [x, 1.0]) };
    cable.supports = vec![hook("A", 0.0), hook("B", 9.95)];
    scene.loads.clear();
    let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [15.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.5) }];
    scene
}

/// Processor time of this thread, s; the time of the clock where the system does not say.
fn processor_s(since: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds: Option<f64> = text.split_whitespace().next().and_then(|n| n.parse().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |n| 1e-9 * n)
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let scene = match args.first().map(String::as_str) {
        Some("rubble") => catalog::rubble_drop(),
        Some("floor") => floor(),
        path => Scene::from_toml(&std::fs::read_to_string(path.expect("a scene")).expect("a file")).expect("a scene"),
    };
    let elements = args.get(1).and_then(|a| a.parse().ok());
    let seconds: f64 = args.get(2).and_then(|a| a.parse().ok()).unwrap_or(2.0);
    let each = args.get(3).is_none_or(|a| a != "sum");
    let settings = Settings { segments: elements, histories: false, ..Settings::default() };
    let mut model = FemModel::new(problems(&scene).expect("valid").remove(0), settings).expect("a model");
    model.settle().expect("a rest");
    let clock = Instant::now();
    let (start, mut last) = (processor_s(clock), processor_s(clock));
    let (mut steps, mut iterations, mut halved) = ([0; 2], [0; 2], [0; 2]);
    while (steps[1] as f64) * STEP_S < seconds {
        for _ in 0..INTERVAL {
            let report = model.advance(STEP_S, Inertia::Dynamic).expect("a step");
            steps[0] += 1;
            iterations[0] += report.cost.iterations;
            halved[0] += report.cost.halved_steps;
        }
        let now = processor_s(clock);
        if each {
            println!(
                "to {:.2} s: {:.1} % of real time, {} iterations in {} steps, {} halved",
                (steps[0] + steps[1]) as f64 * STEP_S,
                1e2 * (now - last) / (steps[0] as f64 * STEP_S),
                iterations[0],
                steps[0],
                halved[0]
            );
        }
        last = now;
        for all in [&mut steps, &mut iterations, &mut halved] {
            all[1] += all[0];
            all[0] = 0;
        }
    }
    let real_s = steps[1] as f64 * STEP_S;
    println!(
        "{real_s:.2} s: {:.1} % of real time, {} iterations in {} steps, {} halved",
        1e2 * (last - start) / real_s,
        iterations[1],
        steps[1],
        halved[1]
    );
}
