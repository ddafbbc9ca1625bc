//! These modules take one explicit sub-step: forces, impacts, limits, rollback, momentum and hands.

pub(in crate::model::mass_spring) mod hands;
pub(in crate::model::mass_spring) mod impacts;
pub(in crate::model::mass_spring) mod momentum;
pub(in crate::model::mass_spring) mod rollback;
pub(in crate::model::mass_spring) mod runaway_guard;
pub(in crate::model::mass_spring) mod sub_step;
