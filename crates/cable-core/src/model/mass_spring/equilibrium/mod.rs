//! These modules find equilibria and steps without inertia, and how wrong their figures are.

pub(in crate::model::mass_spring) mod contact_energy;
pub(in crate::model::mass_spring) mod error_estimate;
pub(in crate::model::mass_spring) mod newton;
pub(in crate::model::mass_spring) mod quasi_static;
