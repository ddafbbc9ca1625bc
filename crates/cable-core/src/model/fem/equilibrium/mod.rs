//! These modules find equilibria in contact and steps without inertia.

pub mod initial_guess;
pub(in crate::model::fem) mod quasi_static;
