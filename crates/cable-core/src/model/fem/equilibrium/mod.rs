//! These modules find equilibria in contact and steps without inertia.

pub(in crate::model::fem) mod lagged_friction;
pub(in crate::model::fem) mod quasi_static;
pub(in crate::model::fem) mod relaxation;
