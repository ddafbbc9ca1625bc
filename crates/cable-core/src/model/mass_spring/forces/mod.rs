//! These modules compute the forces on nodes: springs, bending, weight, wind and loads, the force
//! on material that slides over pulleys, and what supports carry.

pub(in crate::model::mass_spring) mod bending;
pub(in crate::model::mass_spring) mod nodal;
pub(in crate::model::mass_spring) mod pulley;
pub(in crate::model::mass_spring) mod reactions;
pub(in crate::model::mass_spring) mod tension;
