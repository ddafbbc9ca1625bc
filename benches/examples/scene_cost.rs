//! This example does one rest of a scene, or one second of its motion after that, and nothing else,
//! to count instructions.
//!
//! `cargo build --release -p cable-benches --example scene_cost`, then `valgrind --tool=callgrind
//! --toggle-collect='*::measured_*' target/release/examples/scene_cost assets/scenes/tank.toml fem
//! rest`: a scene, a model or `auto`, and `rest`, `motion` or `slow`. A model is asked alone, as
//! `cable_core::model` has it; `auto` through `Simulation`, without a search of other histories.

#![allow(clippy::expect_used)] // a tool for a developer: it may stop

use cable_core::model::catenary::CatenaryModel;
use cable_core::model::fem::FemModel;
use cable_core::model::mass_spring::MassSpringModel;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::{Model, Scene, Simulation};

/// Frames of the motion, and the length of one, s.
const FRAMES: usize = 60;
const FRAME_S: f64 = 1.0 / 60.0;

fn build(scene: &Scene, model: Model, settings: Settings) -> Vec<Box<dyn Mechanics>> {
    let of = |problem| -> Result<Box<dyn Mechanics>, cable_core::SolveError> {
        Ok(match model {
            Model::Fem => Box::new(FemModel::new(problem, settings)?),
            Model::Spans => Box::new(SpansModel::new(problem, settings)?),
            Model::Catenary => Box::new(CatenaryModel::new(problem, settings)?),
            _ => Box::new(MassSpringModel::new(problem, settings)?),
        })
    };
    problems(scene).expect("valid").into_iter().map(|p| of(p).expect("a model")).collect()
}

#[inline(never)]
fn measured_rest(models: &mut [Box<dyn Mechanics>]) -> usize {
    models.iter_mut().map(|m| m.settle().expect("a rest").cost.iterations).sum()
}

#[inline(never)]
fn measured_motion(models: &mut [Box<dyn Mechanics>], inertia: Inertia) -> usize {
    let step = |m: &mut Box<dyn Mechanics>| m.advance(FRAME_S, inertia).expect("a step").cost.iterations;
    models.iter_mut().map(|m| (0..FRAMES).map(|_| step(m)).sum::<usize>()).sum()
}

#[inline(never)]
fn measured_whole_rest(simulation: &mut Simulation) -> f64 {
    simulation.settle().expect("a rest").max_tension().tension_n
}

#[inline(never)]
fn measured_whole_motion(simulation: &mut Simulation, inertia: Inertia) -> f64 {
    for _ in 0..FRAMES {
        match inertia {
            Inertia::Dynamic => simulation.step(FRAME_S),
            Inertia::QuasiStatic => simulation.step_quasi_static(FRAME_S),
        }
        .expect("a step");
    }
    simulation.max_tension().tension_n
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let text = std::fs::read_to_string(args.first().expect("a scene")).expect("a file");
    let scene = Scene::from_toml(&text).expect("a scene");
    let model = args.get(1).and_then(|a| Model::from_name(a)).unwrap_or(Model::Auto);
    let asked = args.get(2).map_or("rest", String::as_str);
    let settings = Settings { histories: false, ..Settings::default() };
    let inertia = if asked == "slow" { Inertia::QuasiStatic } else { Inertia::Dynamic };
    if model == Model::Auto {
        let mut simulation = Simulation::with_settings(scene, model, settings).expect("a simulation");
        if asked == "rest" {
            println!("{} N", measured_whole_rest(&mut simulation));
        } else {
            simulation.settle().expect("a rest");
            println!("{} N", measured_whole_motion(&mut simulation, inertia));
        }
        return;
    }
    let mut models = build(&scene, model, settings);
    if asked == "rest" {
        println!("{} iterations", measured_rest(&mut models));
    } else {
        models.iter_mut().for_each(|m| drop(m.settle().expect("a rest")));
        println!("{} iterations", measured_motion(&mut models, inertia));
    }
}
