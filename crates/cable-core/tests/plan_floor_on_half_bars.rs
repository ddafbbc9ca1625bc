//! The floor of a plan view rubs on half a bar between a node and the middle of the bar, where
//! `fem` reads the tension: a node beside a post that has a long bar on one side was called unsound
//! by 4 mN (`plan-posts` with 500 bars, at 4.28 s).

#![allow(clippy::expect_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::catalog;
use cable_core::{Model, Settings, Simulation};

#[test]
fn friction_of_the_floor_on_half_a_bar_is_no_fault() {
    let settings = Settings { tolerance: 1e-2, segments: Some(500), ..Settings::default() };
    let mut simulation = Simulation::with_settings(catalog::plan_posts(), Model::Fem, settings).expect("a simulation");
    simulation.settle().expect("a rest");
    for frame in 1..=270 {
        simulation.step_quasi_static(1.0 / 60.0).unwrap_or_else(|e| panic!("frame {frame}: {e}"));
    }
}
