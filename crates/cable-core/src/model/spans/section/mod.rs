//! A section is a part of a cable between two grips: free spans and contacts in a row.
//!
//! | room | what it holds |
//! |---|---|
//! | `cable_section.rs` | free spans and contacts between two end conditions: the unknowns |
//! | `boundary_conditions.rs` | what holds and pulls at an instant |
//! | `failure.rs` | why a section has no equilibrium |
//! | `tension_loss.rs` | did a step fail because the cable lost its tension, and where? |

pub(in crate::model::spans) mod boundary_conditions;
pub(in crate::model::spans) mod cable_section;
pub(in crate::model::spans) mod failure;
pub(in crate::model::spans) mod tension_loss;

pub(in crate::model::spans) use boundary_conditions::BoundaryConditions;
pub(in crate::model::spans) use cable_section::{
    CableEquilibrium, CableSection, Connection, Contact, EndCondition, Kink, RestingLoad, SolveContext,
};
pub(in crate::model::spans) use failure::Failure;
