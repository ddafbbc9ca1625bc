//! This check finds whether an equilibrium is stable.

use crate::model::spans::boundary::Mode;
use crate::model::spans::newton::{Workspace, assemble, has_tension_unknown};
use crate::model::spans::section::{CableSection, Connection, EndCondition, SolveContext};

/// True if an equilibrium without friction is stable: it returns after a disturbance.
///
/// A sticking contact keeps its material; a sliding one has T₂ − T₁ = 0 instead, and that
/// difference must rise with the material s that comes to it. With s₁ = s₂ = s the two rows are
/// [−1, 1] and [−∂T₁, ∂T₂], of determinant −∂(T₂ − T₁)/∂s, in place of 1. So the determinant of the
/// Jacobian with the first k contacts sliding and the others held is that with all held times (−1)ᵏ
/// times the kth leading minor of ∂(T₂ − T₁)/∂s, and all of these are positive if the matrix is
/// positive definite (J. J. Sylvester): each released contact changes the sign once (except one
/// that lies up to its start, where T₁ replaces s₁). Contacts held by friction are not judged: the
/// cable came there by its own motion.
pub(in crate::model::spans) fn stable(
    section: &CableSection,
    context: &SolveContext,
    workspace: &mut Workspace,
) -> bool {
    let rubs = section.contacts.iter().any(|c| context.friction(c) > 0.0);
    let pockets = section.contacts.iter().any(|c| c.next == Connection::Pocket || c.is_load());
    if rubs
        || pockets
        || section.contacts.is_empty()
        || section.end_conditions.iter().any(|t| matches!(t, EndCondition::Loose(_)))
    {
        return true;
    }
    let mut stuck = section.clone();
    for c in &mut stuck.contacts {
        let contact_path = context.contact_path(c);
        c.history.commit(&contact_path, &c.ends, c.mode, c.stick_zone, &mut workspace.past);
        c.mode = Mode::Stick;
    }
    let mut is_negative = |section: &mut CableSection| {
        assemble(section, context, &mut workspace.system);
        workspace.rhs.clear();
        workspace.rhs.resize(workspace.system.residual.len(), 1.0);
        workspace.system.band.scale(&mut workspace.rhs);
        workspace.system.band.solve(&mut workspace.rhs).then(|| workspace.system.band.is_negative())
    };
    let Some(mut before) = is_negative(&mut stuck) else { return false };
    (0..section.contacts.len()).all(|j| {
        stuck.contacts[j].clone_from(&section.contacts[j]);
        let turns = !has_tension_unknown(section, j, 0);
        let Some(after) = is_negative(&mut stuck) else { return false };
        let right = (after != before) == turns;
        before = after;
        right
    })
}
