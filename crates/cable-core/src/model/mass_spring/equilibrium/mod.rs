//! These modules find equilibria and steps without inertia, and estimate the errors of their
//! figures.

pub(in crate::model::mass_spring) mod assembly;
pub(in crate::model::mass_spring) mod contact_energy;
pub(in crate::model::mass_spring) mod error_estimate;
pub(in crate::model::mass_spring) mod newton;
pub(in crate::model::mass_spring) mod quasi_static;
pub(in crate::model::mass_spring) mod system;
