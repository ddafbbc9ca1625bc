//! A flexible cable that hangs plumb pushes nothing, whether it is lowered on a floor or let go
//! above it: what comes down is taken up sideways.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};
use cable_core::{Model, Simulation};

const STEP_S: f64 = 1.0 / 240.0;

/// A power cable of 3 m that hangs from 3.1 m above a floor.
fn plumb(bending_stiffness_n_m2: f64) -> Scene {
    let mut scene = catalog::hanging_span();
    let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [8.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".into(), shape, friction: Some(0.5) }];
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.linear_density_kg_per_m, cable.axial_stiffness_n) = (3.0, 1.246, 2e6);
    (cable.breaking_tension_n, cable.service_tension_n) = (1e4, 1e3);
    (cable.diameter_m, cable.bending_stiffness_n_m2) = (0.0256, bending_stiffness_n_m2);
    cable.supports = vec![Support::fixed("riser", [0.0, 3.1]), Support::free("tail")];
    scene
}

/// Lowered within some seconds to 1 m: the greatest push on the riser on the way, and what it pulls
/// with in the end, N.
fn lowered(bending_stiffness_n_m2: f64, within_s: f64) -> [f64; 2] {
    let mut scene = plumb(bending_stiffness_n_m2);
    scene.cables[0].supports[0].motion =
        Some(Motion { times_s: vec![0.0, within_s], points_m: vec![[0.0, 3.1], [0.0, 1.0]] });
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    sim.settle().unwrap();
    let (mut push, mut holds) = (0.0f64, 0.0);
    for _ in 0..((within_s + 2.0) / STEP_S) as usize {
        sim.step(STEP_S).unwrap();
        holds = -sim.answers()[0].supports[0].reaction_y_n;
        push = push.max(-holds);
    }
    [push, holds]
}

/// It pushed with 1294 N when lowered in 2 s, with 244 N in 10 s.
#[test]
fn a_cable_that_is_lowered_on_a_floor_does_not_push_its_riser() {
    for within_s in [2.0, 10.0] {
        let [push, holds] = lowered(0.0, within_s);
        println!("in {within_s} s: pushes {push:.3} N, then hangs with {holds:.3} N");
        assert!(push < 1.0, "lowered in {within_s} s it pushes {push} N");
        // A metre of it hangs.
        assert!((holds - 12.2).abs() < 0.5, "lowered in {within_s} s it holds {holds} N");
    }
}

/// It stood on its tail, 2.98 m high, for seconds.
#[test]
fn a_cable_that_is_let_go_falls_in_a_heap() {
    let mut scene = plumb(0.0);
    scene.cables[0].supports[0].release_s = Some(0.1);
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    sim.settle().unwrap();
    let top = |sim: &Simulation| sim.answers()[0].nodes.iter().map(|n| n.y_m).fold(f64::NEG_INFINITY, f64::max);
    for _ in 0..216 {
        sim.step(STEP_S).unwrap();
        // Nothing holds its top: it falls freely.
        let fallen = 0.5 * 9.80665 * (sim.time_s() - 0.1).max(0.0).powi(2);
        let (is, free) = (top(&sim), (3.1 - fallen).max(0.0));
        assert!(is < free + 0.15, "at {} s its top is {is} m high, {free} m in free fall", sim.time_s());
    }
}
