//! These modules solve one step: its initial guess, three Newton iterations, what bounds them, and
//! their memory.

pub(in crate::model::fem) mod active_set;
pub(in crate::model::fem) mod gap_constraint;
pub mod initial_guess;
pub mod minimize;
pub(in crate::model::fem) mod mixed_contact;
pub(in crate::model::fem) mod mixed_free;
pub(in crate::model::fem) mod solver_memory;
pub(in crate::model::fem) mod step_bound;
