//! This module adds the relaxation branches of material damping to a step, and updates the forces
//! in them after it.

use crate::math::Vec2;
use crate::model::fem::state::CableState;
use crate::model::fem::system::{Unknowns, bar_energy};

/// Engineering strain of bar `e` at positions `x` (m) with an unstretched length (m).
fn strain(cable: &CableState, e: usize, x: &[Vec2], rest_length: f64) -> f64 {
    cable.mesh.path(e, x).length / rest_length - 1.0
}

/// True if bar `e` with this strain at the start of a step has the damping of its branches in it.
fn relaxes(cable: &CableState, e: usize, strain: f64) -> bool {
    (strain >= 0.0 || !cable.mesh.is_flexible()) && !cable.mesh.is_break(e)
}

/// Updates the branches by a step of `h` (s) to the unknowns at its end, before the motion itself is
/// updated.
pub(in crate::model::fem) fn relax(cable: &mut CableState, h: f64, unknowns: &Unknowns) {
    if cable.loss.branches.is_empty() {
        return;
    }
    let (count, bars, ea) = (cable.loss.branches.len(), cable.mesh.rest_length.len(), cable.problem.axial_stiffness);
    let mut memory = std::mem::take(&mut cable.mesh.branch_forces);
    let forces = memory.of_all(bars, count);
    for e in 0..bars {
        let before = strain(cable, e, &cable.motion.positions, cable.mesh.rest_length[e]);
        let change = if relaxes(cable, e, before) {
            let now = strain(cable, e, &unknowns.positions, bar_energy::rest_length(&cable.mesh, e, &unknowns.slides));
            if relaxes(cable, e, now) { now - before } else { -before }
        } else {
            0.0
        };
        for (q, b) in forces[e * count..].iter_mut().zip(&cable.loss.branches) {
            let [decay, part] = b.in_step(h);
            *q = *q * decay + ea * part * change;
        }
    }
    cable.mesh.branch_forces = memory;
}

/// Adds the damping of the branches in a step of `h` (s) to the viscous damping, with velocities
/// `rate` (1/s) times differences.
pub(in crate::model::fem) fn add(cable: &mut CableState, h: f64, rate: f64, decay: &mut Vec<f64>) {
    if cable.loss.branches.is_empty() {
        return;
    }
    let ea = cable.problem.axial_stiffness;
    let viscous = ea * cable.loss.viscous * rate;
    let mut stiffness = viscous;
    decay.clear();
    decay.extend(cable.loss.branches.iter().map(|b| b.in_step(h)[0]));
    stiffness += cable.loss.branches.iter().map(|b| ea * b.in_step(h)[1]).sum::<f64>();
    for e in 0..cable.mesh.rest_length.len() {
        let l = cable.mesh.rest_length[e];
        let before = strain(cable, e, &cable.motion.positions, l);
        if !relaxes(cable, e, before) {
            continue;
        }
        let kept: f64 = cable.mesh.branch_forces.of_bar(e).iter().zip(&*decay).map(|(q, d)| q * d).sum();
        let late = cable.input.losses.predicted_length[e];
        let part = viscous / stiffness;
        cable.input.losses.predicted_length[e] = part * late + (1.0 - part) * l * (1.0 + before) - l * kept / stiffness;
        cable.input.losses.bars[e][0] = stiffness;
    }
}
