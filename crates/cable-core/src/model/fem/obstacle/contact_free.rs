//! This module recognises a cable that can touch nothing but its supports: it is solved without
//! contact, and its mass is spread over its bars.

use crate::problem::Problem;
use crate::scene::SupportKind;

/// True if the cable can touch nothing but its supports.
pub(in crate::model::fem) fn touches_nothing(problem: &Problem) -> bool {
    problem.world.is_empty()
        && !problem.has_moving_bodies()
        && problem.floor_friction.is_none()
        && !problem.cable.self_contact
        && !(problem.bending_stiffness > 0.0 && problem.supports.iter().any(|s| s.kind == SupportKind::Pulley))
}
