//! This module computes the energy that the nodes and bars of a cable store, including lumped
//! masses and sliding material.

use crate::math::Vec2;
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::system::{Weight, bar_energy, bends_energy};
use crate::solution::Energy;

/// The whole stored energy.
pub(in crate::model::fem) fn stored_energy(cable: &CableState) -> Energy {
    let (problem, mesh, x) = (&cable.problem, &cable.mesh, &cable.motion.positions);
    let (mut moment, mut stretch_j) = (Vec2::zeros(), 0.0);
    for e in 0..mesh.rest_length.len() {
        let path = mesh.path(e, x);
        let slides = mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some();
        let center = match slides {
            true => Weight::of(mesh, e, &path, problem.weight).center,
            false => (x[e] + x[e + 1]) * 0.5,
        };
        moment += center * (mesh.arc_length[e + 1] - mesh.arc_length[e]);
        if mesh.is_break(e) {
            continue;
        }
        stretch_j += bar_energy::stretch_energy(mesh, [path.length, mesh.rest_length[e]]);
    }
    let (kinetic_j, bending_j) = (kinetic_energy(cable), bending_energy(cable, x));
    Energy { kinetic_j, gravity_j: gravity_energy(cable, moment, x), stretch_j, bending_j }
}

/// Bending energy at positions `x` (m), J.
pub(in crate::model::fem) fn bending_energy(cable: &CableState, x: &[Vec2]) -> f64 {
    if cable.mesh.is_flexible() { 0.0 } else { bends_energy(&cable.mesh, x) }
}

/// Energy of height at positions `x` (m), J; `bars` is the sum of length times centre of the bars
/// (m²).
pub(in crate::model::fem) fn gravity_energy(cable: &CableState, bars: Vec2, x: &[Vec2]) -> f64 {
    let problem = &cable.problem;
    let moment = cable.mesh.spread.more.iter().zip(x).fold(bars, |sum, (more, x)| sum + x * *more);
    let mut energy = -problem.weight.dot(&moment);
    for (s, node) in problem.supports.iter().zip(&cable.meshing.support_node) {
        if let Some(x) = node.and_then(|k| x.get(k)).filter(|_| s.mass > 0.0) {
            energy -= problem.gravity().dot(x) * s.mass;
        }
    }
    energy
}

/// Kinetic energy after a step with velocities `rate` (1/s) times differences, J, from the inertia
/// of the step; for meshes without sliding nodes.
pub(in crate::model::fem) fn kinetic_energy_of_step(cable: &CableState, rate: f64) -> f64 {
    let (input, v) = (&cable.input, &cable.motion.velocities);
    let mut sum: f64 = input.inertial.stiffness.iter().zip(v).map(|(inertia, v)| inertia * v.norm_squared()).sum();
    for ((coupling, _), pair) in input.inertial.coupling.iter().zip(v.windows(2)) {
        if let [a, b] = pair {
            sum -= coupling * (b - a).norm_squared();
        }
    }
    // The springs of hands are included in that inertia.
    for hand in &input.inertial.hands {
        sum -= hand.stiffness * v[hand.node].norm_squared();
    }
    0.5 * sum / (rate * rate)
}

/// Kinetic energy, J.
pub(in crate::model::fem) fn kinetic_energy(cable: &CableState) -> f64 {
    let (mesh, v) = (&cable.mesh, &cable.motion.velocities);
    let mut sum = 0.0;
    for (k, v) in v.iter().enumerate() {
        sum += match mesh.sliding[k] {
            // Half of its material moves along each of its bars, and all of it with its round.
            Some(_) => [k - 1, k]
                .into_iter()
                .map(|e| {
                    let along = mesh.direction(e, &cable.motion.positions) * cable.motion.slide_rates[k];
                    0.5 * mesh.material_between(e, e + 1) * (v - along).norm_squared()
                })
                .sum(),
            None => mesh.tributary_length(k) * v.norm_squared(),
        };
    }
    for (e, length) in mesh.spread.coupling.iter().enumerate() {
        sum -= length * (v[e + 1] - v[e]).norm_squared();
    }
    sum *= cable.problem.linear_density;
    for (s, node) in cable.problem.supports.iter().zip(&cable.meshing.support_node) {
        if let Some(v) = node.and_then(|k| v.get(k)) {
            sum += s.mass * v.norm_squared();
        }
    }
    0.5 * sum
}
