//! This module sets masses, predicted positions and damping of a step with inertia from its weights
//! in time.

use crate::math::{Vec2, larger, smaller};
use crate::model::fem::state::CableState;
use crate::model::fem::system::HandSpring;
use crate::model::fem::time::bdf2::Weights;
use crate::model::fem::time::loss_memory;
use crate::model::material_loss::damping_time;

/// Damping coefficient of a slack bar of length l (force over rate of length), in units of √(ρ b
/// l), with b its weight and wind per metre: that of a fold as high as the bar is long which comes
/// to rest as it falls. Smaller: slack bars in heaps swing for long; larger: cable that falls in a
/// heap pushes with more than a small fraction of its weight.
const FOLD_DAMPING: f64 = 10.0;

/// Sets inertia and damping of a step of `h` (s).
///
/// If velocities jump between two steps (by a plastic impulse or a change of the mesh), the rate of
/// a length must not use the history: it would extrapolate through the jump and add ½ EA τ Δv/l₀ to
/// the damping, 150 kN for nodes 3 cm apart. So the damping of a cable that may touch something
/// uses the step itself, EA τ (P − P₀)/(L h). This is a first-order error of a small force, ¾ τ/h
/// of the error of BDF2 in a vibration.
pub(in crate::model::fem) fn set_inertia(cable: &mut CableState, weights: Weights, h: f64, decay: &mut Vec<f64>) {
    let Weights { now, past, rate: a, .. } = weights;
    let rubbing = cable.rubbing();
    let jumps = !cable.meets_nothing();
    let (m, input, mesh) = (&cable.motion, &mut cable.input, &cable.mesh);
    input.inertial.coupling.clear();
    input.inertial.hands.clear();
    for k in 0..m.positions.len() {
        input.inertial.predicted[k] = weights.place(m, k) + weights.velocity(m, k) / a;
        input.inertial.stiffness[k] = cable.problem.linear_density * mesh.tributary_length(k) * a * a;
        if mesh.sliding[k].is_some() {
            input.inertial.momentum_flux[k] = cable.problem.linear_density * m.slide_rates[k] * m.slide_rates[k];
            let w_hat = m.slide_rates[k] * now - m.previous_slide_rates[k] * past;
            let s = mesh.arc_length[k];
            input.inertial.predicted_slide[k] = s * now - m.previous_arc_length[k] * past + w_hat / a - s;
        }
    }
    // Material on a wheel moves with it: its slide lacks the wheel's acceleration along the cable.
    for &(k, velocity) in &input.supports.wheel_velocities {
        let s = &mesh.arc_length;
        let ways = [k - 1, k].map(|e| mesh.direction(e, &m.positions) * (s[e + 1] - s[e]));
        let along = (ways[0] + ways[1]) / (s[k + 1] - s[k - 1]);
        input.inertial.predicted_slide[k] += (velocity - weights.velocity(m, k)).dot(&along) / a;
    }
    // The coupling concerns the masses alone: hands pull at their own nodes only.
    let predicted = &input.inertial.predicted;
    input.inertial.coupling.extend(mesh.spread.coupling.iter().enumerate().map(|(e, length)| {
        let chord = predicted[e + 1] - predicted[e];
        (cable.problem.linear_density * length * a * a, chord)
    }));
    for (s, node) in cable.problem.supports.iter().zip(&cable.meshing.support_node) {
        if let Some(k) = node {
            input.inertial.stiffness[*k] += s.mass * a * a;
        }
    }
    for (hand, node) in m.hands.iter().zip(&cable.meshing.support_node) {
        let (Some(hand), Some(k)) = (hand, *node) else { continue };
        let (stiffness, at) = hand.pull(h, m.positions[k]);
        let (inertia, both) = (input.inertial.stiffness[k], input.inertial.stiffness[k] + stiffness);
        input.inertial.predicted[k] = (input.inertial.predicted[k] * inertia + at * stiffness) / both;
        input.inertial.stiffness[k] = both;
        input.inertial.hands.push(HandSpring { node: k, stiffness, at });
    }
    input.inertial.moves = true;
    let (rate, time) = (if jumps { 1.0 / h } else { a }, damping_time(&cable.problem, rubbing));
    let taut = cable.problem.axial_stiffness * time * rate;
    let folds = FOLD_DAMPING * rate * (cable.problem.linear_density * input.loads.body.norm()).sqrt();
    for (loss, l) in input.losses.bars.iter_mut().zip(&mesh.rest_length) {
        *loss = [taut, folds * l * l.sqrt()];
    }
    // Lengths of earlier steps count as those of a bar that was as long unstretched as now.
    for e in 0..mesh.rest_length.len() {
        let growth = m.growth(mesh, e);
        input.losses.predicted_length[e] = if jumps || mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some() {
            mesh.path(e, &m.positions).length * growth[0]
        } else {
            let length = |x: &[Vec2], growth: f64| (x[e + 1] - x[e]).norm() * growth;
            // The material of a slack bar has its own length. A bar that has just become taut did
            // not come from its folded length, and one that is slack is not yet stretched.
            let (own, flexible) = (mesh.rest_length[e], mesh.is_flexible());
            let present = length(&m.positions, growth[0]);
            let slack = flexible && present < own;
            let past_length = |x: &[Vec2], growth: f64| {
                let length = length(x, growth);
                if flexible && !slack { larger(length, own) } else { length }
            };
            let older =
                if weights.older > 0.0 { past_length(&m.older_positions, growth[2]) * weights.older } else { 0.0 };
            let predicted = present * now - past_length(&m.previous_positions, growth[1]) * past + older;
            if slack { smaller(predicted, own) } else { predicted }
        };
    }
    for &(bar, length) in &input.losses.lengths_at_wheels {
        input.losses.predicted_length[bar] = length * m.growth(mesh, bar)[0];
    }
    loss_memory::add(cable, h, rate, decay);
    loss_memory::add_to_bends(cable, h, decay);
}
