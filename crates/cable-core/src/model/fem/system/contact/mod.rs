//! These modules hold the contacts of a mesh in a step: their search, the barrier and its
//! stiffness, and friction with its memory, also on a floor and of the cable with itself.

pub(in crate::model::fem) mod barrier_stiffness;
pub(in crate::model::fem) mod contact_energy;
pub(in crate::model::fem) mod contact_pair;
pub(in crate::model::fem) mod contact_search;
pub(in crate::model::fem) mod contact_set;
pub(in crate::model::fem) mod floor_friction;
pub(in crate::model::fem) mod friction_contact;
pub(in crate::model::fem) mod friction_memory;
pub(in crate::model::fem) mod outline_motion;
pub(in crate::model::fem) mod self_contact;
