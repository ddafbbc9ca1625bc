//! The energy that a cable stores, as its nodes and bars have it: lumped masses and what slides
//! included.

use crate::math::Vec2;
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::system::{Weight, bar_energy, bends_energy};
use crate::solution::Energy;

/// All of it.
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
        stretch_j += bar_energy::stretch_energy(mesh, [path.length, mesh.rest_length[e]]);
    }
    let (kinetic_j, bending_j) = (kinetic_energy(cable), bending_energy(cable, x));
    Energy { kinetic_j, gravity_j: gravity_energy(cable, moment, x), stretch_j, bending_j }
}

/// That of bending at positions `x` (m), J.
pub(in crate::model::fem) fn bending_energy(cable: &CableState, x: &[Vec2]) -> f64 {
    if cable.mesh.is_flexible() { 0.0 } else { bends_energy(&cable.mesh, x) }
}

/// That of height at positions `x` (m), where the bars have this sum of length times centre (m²),
/// J.
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

/// That of motion after a step whose rates were `rate` (1/s) times differences, by the inertia of
/// the step on whose mesh nothing slides, J.
pub(in crate::model::fem) fn kinetic_energy_of_step(cable: &CableState, rate: f64) -> f64 {
    let (input, v) = (&cable.input, &cable.motion.velocities);
    let mut sum: f64 = input.inertial.stiffness.iter().zip(v).map(|(inertia, v)| inertia * v.norm_squared()).sum();
    for ((coupling, _), pair) in input.inertial.coupling.iter().zip(v.windows(2)) {
        if let [a, b] = pair {
            sum -= coupling * (b - a).norm_squared();
        }
    }
    // The springs of hands are a part of that inertia.
    for &(k, stiffness, _) in &input.inertial.hands {
        sum -= stiffness * v[k].norm_squared();
    }
    0.5 * sum / (rate * rate)
}

/// That of motion, J.
pub(in crate::model::fem) fn kinetic_energy(cable: &CableState) -> f64 {
    let (mesh, v) = (&cable.mesh, &cable.motion.velocities);
    let mut sum = 0.0;
    for (k, v) in v.iter().enumerate() {
        let rate = cable.motion.slide_rates[k];
        let square = if mesh.sliding[k].is_some() { rate * rate } else { v.norm_squared() };
        sum += mesh.tributary_length(k) * square;
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
