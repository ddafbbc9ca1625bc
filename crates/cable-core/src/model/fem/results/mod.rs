//! These modules make the answer from a state.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | the answer as a whole, and the tension of inner steps |
//! | `forces.rs` | tensions of bars, forces on ends and nodes, moments |
//! | `nodes.rs`, `supports.rs`, `contact_reports.rs`, `self_contact.rs` | those parts of the answer |
//! | `points_on_round.rs` | the points that draw the cable round a corner, post or pulley |
//! | `weighted_capstan.rs` | the tension along a round between those at its ends |
//! | `bending_error.rs` | the error of tension by neglected moments at rounds |

pub(in crate::model::fem) mod bending_error;
mod contact_reports;
pub(in crate::model::fem) mod forces;
mod nodes;
mod points_on_round;
mod self_contact;
mod supports;
mod weighted_capstan;

pub(in crate::model::fem) use bending_error::bending_error;

use self::forces::{
    bar_tension, bar_tensions, end_forces, end_tensions, force_at_break, signed_tension, tension_at_node,
};
use crate::math::larger;
use crate::model::fem::state::CableState;
use crate::solution::{Assumptions, CableSolution};

/// The answer of a cable at this instant: that of the last step on the mesh on which it was
/// balanced, else that of the present mesh.
#[must_use]
pub fn solution(cable: &CableState) -> CableSolution {
    cable.answers.stepped.as_ref().map_or_else(|| solution_now(cable), |s| CableSolution::clone(s))
}

/// The answer on the present mesh.
fn solution_now(d: &CableState) -> CableSolution {
    let (problem, x, v) = (&d.problem, &d.motion.positions, &d.motion.velocities);
    let tension = bar_tensions(d, x);
    let (ends, lying_ends) = end_forces(d, x, &tension);
    CableSolution {
        name: problem.cable.name.clone(),
        nodes: nodes::nodes(d, x, v, &tension, &ends).into(),
        supports: supports::supports(d, x, &ends, &tension),
        contacts: contact_reports::contacts(d, x, &tension, &lying_ends),
        assumptions: Assumptions {
            bending_stiffness_n_m2: d.mesh.bending_stiffness,
            self_contact: problem.cable.self_contact,
            inertia: d.motion.inertia_counts(),
        },
        momentum: d.motion.account.report().filter(|_| d.motion.inertia_counts()),
        energy_account: d.motion.energies.report(d.motion.time),
        breaks: d.mesh.breaks().map(|e| e + 1).collect(),
        unstretched_length_m: d.changes_length().then(|| d.mesh.rest_length.iter().sum()),
        ..CableSolution::default()
    }
}

/// Stores the answer of a step before the first change of its mesh.
pub(in crate::model::fem) fn keep_answer(cable: &mut CableState) {
    if cable.answers.keeps && cable.answers.stored_answer.is_none() {
        cable.answers.stored_answer = Some(Box::new(solution_now(cable)));
    }
}

/// Stores the tension at each node, with the values of [`nodes::nodes`].
pub(in crate::model::fem) fn gauge_tension(cable: &mut CableState) {
    let mut gauged = std::mem::take(&mut cable.answers.gauged);
    let x = &cable.motion.positions;
    gauged.arc_length.clone_from(&cable.mesh.arc_length);
    gauged.bars.clear();
    if cable.meshing.never_slides {
        let mesh = &cable.mesh;
        gauged.bars.extend(x.windows(2).enumerate().map(|(e, pair)| mesh.tension(e, (pair[1] - pair[0]).norm())));
    } else {
        gauged.bars.extend((0..cable.mesh.rest_length.len()).map(|e| bar_tension(cable, x, e)));
    }
    let ends = end_tensions(&cable.mesh, x, end_forces(cable, x, &gauged.bars).0);
    gauged.tension.clear();
    gauged.tension.push(ends[0]);
    let inner = 1..gauged.bars.len().max(1);
    gauged.tension.extend(inner.map(|k| tension_at_node(cable, x, &gauged.bars, k)));
    gauged.tension.push(ends[1]);
    for e in cable.mesh.breaks() {
        for (k, side) in [(e, 0), (e + 1, 1)] {
            if let Some(t) = gauged.tension.get_mut(k) {
                *t = signed_tension(&cable.mesh, k + side - 1, x, force_at_break(cable, x, &gauged.bars, k, side));
            }
        }
    }
    for (k, _) in cable.mesh.sliding.iter().enumerate().filter(|(_, s)| s.is_some()) {
        if let (Some(t), Some(load)) = (gauged.tension.get_mut(k), cable.load(k)) {
            *t = larger(load.tension[0], load.tension[1]);
        }
    }
    cable.answers.gauged = gauged;
}
