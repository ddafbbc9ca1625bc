//! A cable that was let out seemed to pass through the corners on which it lies: its shape before a
//! step was drawn with the lengths after it, so that spans ended beside their contacts. The first
//! rest of the tank took 132 halved steps and 497 iterations.

#![allow(clippy::expect_used, clippy::panic)] // a failing test is meant to panic

use cable_core::{Model, Scene, Simulation};

#[test]
fn the_tank_is_let_out_in_long_steps() {
    let scene = Scene::from_toml(include_str!("../../../assets/scenes/tank.toml")).expect("a scene");
    let mut simulation = Simulation::new(scene, Model::Spans).expect("a simulation");
    let cost = simulation.settle().expect("a rest").cost;
    assert!(cost.halved_steps <= 5, "{} halved steps", cost.halved_steps);
    assert!(cost.iterations <= 160, "{} iterations", cost.iterations);
}
