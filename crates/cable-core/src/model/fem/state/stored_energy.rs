//! The energy that a cable stores, as its nodes and bars have it: lumped masses and what slides
//! included.

use crate::math::Vec2;
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::system::assembly::bends_energy;
use crate::model::fem::system::bar_energy;
use crate::model::fem::system::bar_weight::Weight;
use crate::solution::Energy;

/// All of it.
pub(in crate::model::fem) fn stored_energy(cable: &CableState) -> Energy {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let length = |e: usize| mesh.path(e, x).length;
    let stretch_j =
        (0..mesh.rest_length.len()).map(|e| bar_energy::stretch_energy(mesh, [length(e), mesh.rest_length[e]])).sum();
    stored_with_stretch(cable, stretch_j)
}

/// The same where the energy of stretch is known, J.
pub(in crate::model::fem) fn stored_with_stretch(cable: &CableState, stretch_j: f64) -> Energy {
    let bending_j = if cable.mesh.is_flexible() { 0.0 } else { bends_energy(&cable.mesh, &cable.motion.positions) };
    Energy { kinetic_j: kinetic_energy(cable), gravity_j: gravity_energy(cable), stretch_j, bending_j }
}

/// That of height, J.
fn gravity_energy(cable: &CableState) -> f64 {
    let (problem, mesh, x) = (&cable.problem, &cable.mesh, &cable.motion.positions);
    let mut moment = Vec2::zeros();
    for e in 0..mesh.rest_length.len() {
        let material = mesh.arc_length[e + 1] - mesh.arc_length[e];
        let slides = mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some();
        moment += match slides {
            true => Weight::of(mesh, e, &mesh.path(e, x), problem.weight).center * material,
            false => (x[e] + x[e + 1]) * (0.5 * material),
        };
    }
    for (more, x) in mesh.spread.more.iter().zip(x) {
        moment += x * *more;
    }
    let mut energy = -problem.weight.dot(&moment);
    for (s, node) in problem.supports.iter().zip(&cable.meshing.support_node) {
        if let Some(x) = node.and_then(|k| x.get(k)).filter(|_| s.mass > 0.0) {
            energy -= problem.gravity().dot(x) * s.mass;
        }
    }
    energy
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
