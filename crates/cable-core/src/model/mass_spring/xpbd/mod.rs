//! These modules take the preview's sub-steps of compliant constraints.

pub(in crate::model::mass_spring) mod constraint_solve;
pub(in crate::model::mass_spring) mod sub_step;
