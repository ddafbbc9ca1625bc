//! These tests draw a cable on a floor at one end, let it back and draw it again, beside the closed
//! form: however stiff it is, and however little the hand moves for that, what holding ground gives
//! way by must be less.

#![allow(clippy::unwrap_used)] // a failing test is meant to panic

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};
use cable_core::{Model, Simulation};

const G: f64 = 9.80665;
/// Length, m, mass per metre, kg/m, and friction.
const LENGTH: f64 = 10.0;
const MASS: f64 = 0.8;
const FRICTION: f64 = 0.4;
/// Height of the centre line, m.
const LOW: f64 = 5e-3;
/// Fronts of sliding, measured from the drawn end: how far the first pull reached, the way back and
/// the second pull, m.
const FRONTS: [f64; 3] = [8.0, 3.0, 1.8];

/// Tension at `s` (m) after stage 0, 1 or 2. On ground that holds its steepest, T falls away from
/// the hand by r = μw per metre; where it was let back, T rises by r as far as the front, which
/// ends where both meet.
fn tension(stage: usize, s: f64) -> f64 {
    let (r, u) = (FRICTION * MASS * G, LENGTH - s);
    let drawn = (r * (FRONTS[0] - u)).max(0.0);
    let back = drawn.min(r * (FRONTS[0] - 2.0 * FRONTS[1] + u));
    let again = back.max(r * (FRONTS[0] - 2.0 * FRONTS[1] + 2.0 * FRONTS[2] - u));
    [drawn, back, again][stage]
}

/// Returns how far the hand has moved after each stage, m: the change of tension, a triangle over
/// the front, over EA.
fn moves(stiffness: f64) -> [f64; 3] {
    let r = FRICTION * MASS * G;
    let stretch = |k: usize, slope: f64| 0.5 * slope * r * FRONTS[k] * FRONTS[k] / stiffness;
    let (drawn, back, again) = (stretch(0, 1.0), stretch(1, 2.0), stretch(2, 2.0));
    [drawn, drawn - back, drawn - back + again]
}

fn scene(stiffness: f64) -> Scene {
    let at = |x: f64| [x, LOW];
    let mut points_m = vec![at(LENGTH)];
    points_m.extend(moves(stiffness).map(|d| at(LENGTH + d)));
    let motion = Some(Motion { times_s: vec![0.0, 1.0, 2.0, 3.0], points_m });
    let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [15.0, 0.0]] };
    let mut scene = catalog::hanging_span();
    scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(FRICTION) }];
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.axial_stiffness_n) = (LENGTH, MASS, stiffness);
    (c.diameter_m, c.route_m) = (2.0 * LOW, vec![at(0.0), at(LENGTH)]);
    c.supports = vec![Support::fixed("anchor", at(0.0)), Support { motion, ..Support::fixed("hand", at(LENGTH)) }];
    scene
}

/// Greatest error of the tension along the cable and at the hand after each stage, in parts of the
/// greatest tension. The stretch that no pull reaches is left out: the barrier carries the cable
/// 9e-5 m above the floor and the anchor is on it, so that the first bar of a stiff cable is
/// stretched (4.5 N at EA 1e8 N).
fn errors(stiffness: f64) -> [f64; 3] {
    let mut sim = Simulation::new(scene(stiffness), Model::Fem).unwrap();
    sim.settle().unwrap();
    let most = tension(0, LENGTH);
    [0, 1, 2].map(|stage| {
        for _ in 0..5 {
            sim.step_quasi_static(0.2).unwrap();
        }
        let answer = sim.solution();
        let cable = &answer.cables[0];
        let at_hand = (-cable.supports[1].reaction_x_n - tension(stage, LENGTH)).abs();
        let reached = cable.nodes.iter().filter(|n| n.arc_length_m >= LENGTH - FRONTS[0]);
        let along = reached.map(|n| (n.tension_n - tension(stage, n.arc_length_m)).abs());
        along.fold(at_hand, f64::max) / most
    })
}

#[test]
fn a_pull_turned_round_is_held_as_well_by_a_stiff_cable() {
    for stiffness in [1e5, 1e6, 1e7, 1e8] {
        let errors = errors(stiffness);
        println!("EA {stiffness:e} N: drawn {:.4}, back {:.4}, again {:.4}", errors[0], errors[1], errors[2]);
        assert!(errors.iter().all(|e| *e < 0.03), "EA {stiffness:e} N: {errors:?}");
    }
}
