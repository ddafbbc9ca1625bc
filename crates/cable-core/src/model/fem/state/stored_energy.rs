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
    let (problem, mesh, x) = (&cable.problem, &cable.mesh, &cable.motion.positions);
    let (mut moment, mut stretch_j) = (Vec2::zeros(), 0.0);
    for e in 0..mesh.rest_length.len() {
        let material = mesh.arc_length[e + 1] - mesh.arc_length[e];
        let slides = mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some();
        let (length, center) = if slides {
            let path = mesh.path(e, x);
            (path.length, Weight::of(mesh, e, &path, problem.weight).center)
        } else {
            ((x[e + 1] - x[e]).norm(), (x[e] + x[e + 1]) * 0.5)
        };
        moment += center * material;
        stretch_j += bar_energy::stretch_energy(mesh, [length, mesh.rest_length[e]]);
    }
    for (more, x) in mesh.spread.more.iter().zip(x) {
        moment += x * *more;
    }
    let mut gravity_j = -problem.weight.dot(&moment);
    for (s, node) in problem.supports.iter().zip(&cable.meshing.support_node) {
        if let Some(x) = node.and_then(|k| x.get(k)).filter(|_| s.mass > 0.0) {
            gravity_j -= problem.gravity().dot(x) * s.mass;
        }
    }
    let bending_j = if mesh.is_flexible() { 0.0 } else { bends_energy(mesh, x) };
    Energy { kinetic_j: kinetic_energy(cable), gravity_j, stretch_j, bending_j }
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
