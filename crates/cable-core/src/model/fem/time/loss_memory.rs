//! This module adds the relaxation branches of material damping to a step, and updates the forces
//! in them after it.
//!
//! The material of a bar has the strain of the bar, ε = P/L − 1. A flexible bar that is shorter
//! gives way sideways. Its material then has the strain at which its tension ends, EA ε + Σ q = 0:
//! just after a stretch it is a little longer than at rest, and recovers with the times of the
//! branches.
//!
//! The material of a bend has its curvature ψ/l̄. In a step of h its loss is a bend of the
//! stiffness C = EI (τ/h + Σ y g) that has no moment at the turn ψ₀ − Q l̄/C.

use crate::math::larger;
use crate::model::fem::state::CableState;
use crate::model::fem::system::{Unknowns, bar_energy, visit_turns};

/// Updates the branches by a step of `h` (s) to the unknowns at its end, before the motion itself
/// is updated.
pub(in crate::model::fem) fn relax(cable: &mut CableState, h: f64, unknowns: &Unknowns) {
    relax_bars(cable, h, unknowns);
    relax_bends(cable, h, unknowns);
}

/// Brings the forces of the relaxation branches of bars to the end of a step of `h` (s).
fn relax_bars(cable: &mut CableState, h: f64, unknowns: &Unknowns) {
    let branches = &cable.loss.stretching.branches;
    if branches.is_empty() {
        return;
    }
    let (count, bars, ea) = (branches.len(), cable.mesh.rest_length.len(), cable.problem.axial_stiffness);
    let stiffness: f64 = branches.iter().map(|b| ea * b.in_step(h)[1]).sum();
    let mut memory = std::mem::take(&mut cable.mesh.branch_forces);
    let mesh = &cable.mesh;
    for (e, forces) in memory.of_all(bars, count).chunks_exact_mut(count).enumerate() {
        if mesh.is_break(e) {
            continue;
        }
        let before = cable.input.losses.material_strain[e];
        let length = bar_energy::rest_length(mesh, e, &unknowns.slides);
        let strain = mesh.path(e, &unknowns.positions).length / length - 1.0;
        let remainder: f64 = forces.iter().zip(branches).map(|(q, b)| q * b.in_step(h)[0]).sum();
        let slack_strain = (stiffness * before - remainder) / (ea + stiffness);
        let change = if mesh.is_flexible() { larger(strain, slack_strain) } else { strain } - before;
        for (q, b) in forces.iter_mut().zip(branches) {
            let [decay, part] = b.in_step(h);
            *q = *q * decay + ea * part * change;
        }
    }
    cable.mesh.branch_forces = memory;
}

/// Brings the moments of the relaxation branches of bends to the end of a step of `h` (s).
fn relax_bends(cable: &mut CableState, h: f64, unknowns: &Unknowns) {
    let branches = &cable.loss.bending.branches;
    let ei = cable.mesh.bending_stiffness;
    let mesh = &mut cable.mesh;
    if branches.is_empty() || ei == 0.0 {
        return;
    }
    let count = branches.len();
    let mut memory = std::mem::take(&mut mesh.branch_moments);
    let moments = memory.of_all(mesh.nodes(), count);
    let [start, _] = &cable.input.losses.turns;
    let mut next = 0;
    visit_turns(mesh, &unknowns.positions, |bend| {
        let [first, last] = bend.slots;
        moments[next * count..first * count].fill(0.0);
        let change = ei * (bend.turn - start[first]) / bend.length;
        for slot in first..=last {
            for (m, b) in moments[slot * count..(slot + 1) * count].iter_mut().zip(branches) {
                let [decay, part] = b.in_step(h);
                *m = *m * decay + part * change;
            }
        }
        next = last + 1;
    });
    moments[next * count..].fill(0.0);
    mesh.branch_moments = memory;
}

/// Adds the damping of the branches of bars in a step of `h` (s) to the viscous damping, with
/// velocities `rate` (1/s) times differences.
pub(in crate::model::fem) fn add(cable: &mut CableState, h: f64, rate: f64, decay: &mut Vec<f64>) {
    let (mesh, losses, ea) = (&cable.mesh, &mut cable.input.losses, cable.problem.axial_stiffness);
    let slides = |e: usize| mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some();
    losses.damped_from.clone_from(&losses.predicted_length);
    if mesh.is_flexible() {
        for (from, length) in losses.damped_from.iter_mut().zip(&mesh.rest_length) {
            *from = larger(*from, *length);
        }
    }
    let loss = &cable.loss.stretching;
    if loss.branches.is_empty() {
        return;
    }
    decay.clear();
    decay.extend(loss.branches.iter().map(|b| b.in_step(h)[0]));
    let viscous = ea * loss.viscous * rate;
    let stiffness = viscous + loss.branches.iter().map(|b| ea * b.in_step(h)[1]).sum::<f64>();
    let part = viscous / stiffness;
    losses.material_strain.clear();
    for (e, &length) in mesh.rest_length.iter().enumerate() {
        if mesh.is_break(e) {
            losses.material_strain.push(0.0);
            continue;
        }
        // The path at the start of the step, before wheels move.
        let path = if slides(e) {
            losses.predicted_length[e]
        } else {
            (cable.motion.positions[e + 1] - cable.motion.positions[e]).norm() * cable.motion.growth(mesh, e)[0]
        };
        let forces = mesh.branch_forces.of_bar(e);
        let slack_strain = -forces.iter().sum::<f64>() / ea;
        let strain = path / length - 1.0;
        let is_slack = mesh.is_flexible() && strain < slack_strain;
        let strain = if is_slack { slack_strain } else { strain };
        losses.material_strain.push(strain);
        let remainder: f64 = forces.iter().zip(&*decay).map(|(q, d)| q * d).sum();
        let material = length * (1.0 + strain);
        let late = if is_slack { material } else { losses.predicted_length[e] };
        let from = part * late + (1.0 - part) * material - length * remainder / stiffness;
        losses.damped_from[e] = if mesh.is_flexible() { larger(from, length) } else { from };
        losses.bars[e][0] = stiffness;
    }
}

/// Sets the damping of bends in a step of `h` (s).
pub(in crate::model::fem) fn add_to_bends(cable: &mut CableState, h: f64, decay: &mut Vec<f64>) {
    let (mesh, losses, loss) = (&cable.mesh, &mut cable.input.losses, &cable.loss.bending);
    let ei = mesh.bending_stiffness;
    let viscous = ei * loss.viscous / h;
    let stiffness = viscous + loss.branches.iter().map(|b| ei * b.in_step(h)[1]).sum::<f64>();
    losses.bending = [stiffness, viscous];
    if !(stiffness > 0.0) {
        return;
    }
    decay.clear();
    decay.extend(loss.branches.iter().map(|b| b.in_step(h)[0]));
    let [start, unbent] = &mut losses.turns;
    for turns in [&mut *start, &mut *unbent] {
        turns.clear();
        turns.resize(2 * mesh.nodes(), 0.0);
    }
    visit_turns(mesh, &cable.motion.positions, |bend| {
        let from = bend.turn - mesh.branch_moments.remainder(bend.slots, decay) * bend.length / stiffness;
        for slot in bend.slots {
            (start[slot], unbent[slot]) = (bend.turn, from);
        }
    });
}
