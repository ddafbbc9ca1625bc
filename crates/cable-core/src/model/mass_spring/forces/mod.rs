//! These modules compute the forces on nodes: springs, bending, weight, wind and loads, the force
//! on material that slides over pulleys, and what supports carry.
//!
//! | room | content |
//! |---|---|
//! | `nodal.rs` | all forces on nodes but supports and contacts: springs, weight, wind |
//! | `bending.rs` | bending and clamp forces on nodes |
//! | `pulley.rs` | tensions beside pulleys and the force that slides material over them |
//! | `reactions.rs` | force of the cable on supports; share of the ground under a supported end |
//! | `tension.rs` | tension at a node, as a gauge reads it in every sub-step |

pub(in crate::model::mass_spring) mod bending;
pub(in crate::model::mass_spring) mod nodal;
pub(in crate::model::mass_spring) mod pulley;
pub(in crate::model::mass_spring) mod reactions;
pub(in crate::model::mass_spring) mod tension;
