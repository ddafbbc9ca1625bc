//! This example takes so many steps of `spans` and nothing else, to count instructions: those of
//! 300 steps less those of 100, over 200, are those of one, whatever the start took.
//!
//! `cargo build --release -p cable-benches --example spans_steps`, then
//! `valgrind --tool=callgrind target/release/examples/spans_steps 10 1 solver 300`: ridges, corners
//! on each flank, `solver`, `whole` or `rest`, how many.

#![allow(clippy::expect_used, clippy::panic)] // a tool for a developer: it may stop

use cable_benches::ridges::ridges;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::{Model, Simulation, Vec2};

fn main() {
    let mut args = std::env::args().skip(1);
    let mut number = || args.next().and_then(|a| a.parse::<usize>().ok());
    let (count, fine) = (number().unwrap_or(10), number().unwrap_or(1));
    let what = args.next().unwrap_or_default();
    let times = args.next().and_then(|a| a.parse::<usize>().ok()).unwrap_or(100);
    let scene = ridges(count, fine);
    let last = scene.cables[0].supports[1].at_m.expect("a place");
    let aside = |k: usize| Vec2::new(last[0], last[1] + if k.is_multiple_of(2) { 1e-3 } else { -1e-3 });
    let model = || SpansModel::new(problems(&scene).expect("valid").remove(0), Settings::default()).expect("a model");
    match what.as_str() {
        "rest" => {
            let cold = model();
            for _ in 0..times {
                println!("{} iterations", cold.clone().settle().expect("a rest").cost.iterations);
            }
        }
        "whole" => {
            let mut simulation = Simulation::new(scene.clone(), Model::Spans).expect("a simulation");
            simulation.settle().expect("a rest");
            for k in 0..times {
                simulation.drag_support(0, 1, aside(k));
                simulation.step_quasi_static(0.1).expect("a step");
            }
        }
        _ => {
            let mut model = model();
            model.settle().expect("a rest");
            let mut iterations = 0;
            for k in 0..times {
                model.drag_support(1, aside(k));
                iterations += model.advance(0.1, Inertia::QuasiStatic).expect("a step").cost.iterations;
            }
            println!("{iterations} iterations");
        }
    }
}
