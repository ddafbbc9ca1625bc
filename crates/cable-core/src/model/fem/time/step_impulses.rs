//! This module computes the impulse of each kind of force in a step, for the momentum account.
//!
//! With p the momentum and F a force at the end of a step, its history gives (see `bdf2`)
//! ```text
//! Δp = F/a + (past − older) Δp₋ − older Δp₌
//! ```
//! so the impulse of each kind of force is filtered like their sum. The force of a round on the
//! cable that runs over it turns the cable: it is the sum of the pulls of the bars beside it and
//! the change of momentum of the material on it and moving over it.

use crate::contact::friction;
use crate::math::Vec2;
use crate::model::fem::state::{CONTACTS, CableState, Kinds, LOADS, MovingMass, SUPPORTS, WEIGHT, kind_of};
use crate::model::fem::system::{ContactPair, Unknowns, bar_energy, bar_weight};
use crate::model::fem::time::bdf2::Weights;
use crate::scene::SupportKind;

/// Adds the impulses of a step with these weights and balanced forces (N), after the step and
/// before contacts are made plastic. `slid` is the momentum of the material on rounds before (kg
/// m/s), `slide` its slide (m).
pub(in crate::model::fem) fn account_for_step(
    cable: &mut CableState,
    weights: Weights,
    forces: Kinds,
    slid: [Vec2; 2],
    slide: &[f64],
) {
    let now = MovingMass::of(cable).sliding_momentum();
    let mut over = [now[0] - slid[0], now[1] - slid[1]];
    let mut history = [Vec2::zeros(); 2];
    if !cable.meshing.never_slides {
        let (mesh, m) = (&cable.mesh, &cable.motion);
        for (k, node) in mesh.sliding.iter().enumerate() {
            let Some(node) = node else { continue };
            // Material that moves over to a node moves like the material there, and has its
            // history.
            let of = |v: &[Vec2]| {
                let at = |j: usize| if mesh.sliding[j].is_none() { v[j] } else { Vec2::zeros() };
                (at(k - 1) - at(k + 1)) * (0.5 * cable.problem.linear_density * slide[k])
            };
            let kind = kind_of(node.slide_over) - SUPPORTS;
            over[kind] += of(&m.velocities);
            history[kind] += of(&m.velocities) - of(&m.previous_velocities);
        }
    }
    let account = &mut cable.motion.account;
    for (k, force) in forces.into_iter().enumerate() {
        let Weights { past, older, rate: a, .. } = weights;
        let given = force / a + account.last[k] * (past - older) - account.older[k] * older;
        account.older[k] = account.last[k];
        account.last[k] = given;
        account.add(k, given);
    }
    for (k, kind) in [SUPPORTS, CONTACTS].into_iter().enumerate() {
        account.add(kind, over[k]);
        account.last[kind] += history[k];
    }
    account.late = [Vec2::zeros(); 4];
}

/// The balanced forces of a step, N: on material nodes, and the weight on sliding nodes less the
/// forces that carry it. `touches` are the contacts of the solver.
pub(in crate::model::fem) fn forces_in_step(cable: &CableState, unknowns: &Unknowns, touches: &[ContactPair]) -> Kinds {
    let (problem, mesh, input, x) = (&cable.problem, &cable.mesh, &cable.input, &unknowns.positions);
    let gravity = problem.gravity();
    let mut sum = [Vec2::zeros(); 4];
    sum[WEIGHT] = problem.weight * problem.length;
    sum[LOADS] = (input.loads.body - problem.weight) * problem.length;
    let to = input.loads.time_s;
    for (s, _) in problem.supports.iter().zip(&cable.meshing.support_node).filter(|(_, node)| node.is_some()) {
        sum[WEIGHT] += gravity * s.mass;
        if s.kind == SupportKind::Load {
            sum[LOADS] += s.force.at(to);
        }
    }
    for load in &cable.meshing.loads {
        sum[LOADS] += load.force.at(to);
    }
    for (k, _) in mesh.fixity.iter().enumerate().filter(|(_, is_fixed)| **is_fixed) {
        sum[SUPPORTS] -= cable.answers.reaction[k];
    }
    for hand in &input.inertial.hands {
        sum[SUPPORTS] += (hand.at - x[hand.node]) * hand.stiffness;
    }
    if cable.meshing.was_contact_free {
        return sum;
    }
    let moves = |k: usize| mesh.sliding[k].is_none();
    for touch in touches {
        sum[CONTACTS] += touch.pair.gap.normal * (touch.load(&cable.contacts.barrier) * touch.material_share(moves));
    }
    for contact in &cable.contacts.friction_contacts {
        let (_, slope, _) = friction::at(contact.sliding(x), contact.limit, cable.contacts.slip);
        sum[CONTACTS] -= contact.tangent * (slope * contact.touch.material_share(moves));
    }
    for (k, &limit) in input.loads.floor_limit.iter().enumerate().filter(|(k, _)| moves(*k)) {
        let slid = cable.contacts.floor_slip[k] + (x[k] - input.supports.start[k]);
        sum[CONTACTS] -= friction::at_plane(slid, limit, cable.contacts.slip).1;
    }
    for k in 1..mesh.nodes().saturating_sub(1) {
        let Some(node) = &mesh.sliding[k] else { continue };
        let round = &mut sum[kind_of(node.slide_over)];
        *round -= input.loads.on_round(k);
        let l = |e: usize| bar_energy::rest_length(mesh, e, &unknowns.slides);
        if moves(k - 1) {
            *round += mesh.direction(k - 1, x) * bar_energy::pull_on(mesh, input, k - 1, x, l(k - 1));
        }
        if moves(k + 1) {
            *round -= mesh.direction(k, x) * bar_energy::pull_on(mesh, input, k, x, l(k));
        }
        for (e, side) in [(k - 1, 1), (k, 0)] {
            *round -= bar_weight::force_on_ends(mesh, e, x, Some(&unknowns.slides), input.loads.body)[side];
        }
    }
    sum
}
