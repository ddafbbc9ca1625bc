//! A section is a part of a cable between two supports or ends: a row of free spans and contacts.
//!
//! | room | what it holds |
//! |---|---|
//! | `cable_section.rs` | free spans and contacts between two end conditions: the unknowns |
//! | `boundary_conditions.rs` | supports, loads and temperature at an instant |
//! | `failure.rs` | why a section has no equilibrium |
//! | `tension_loss.rs` | the place where the cable lost its tension, if a step failed by that |

pub(in crate::model::spans) mod boundary_conditions;
pub(in crate::model::spans) mod cable_section;
pub(in crate::model::spans) mod failure;
pub(in crate::model::spans) mod tension_loss;

pub(in crate::model::spans) use boundary_conditions::BoundaryConditions;
pub(in crate::model::spans) use cable_section::{
    CableEquilibrium, CableSection, Connection, Contact, EndCondition, Kink, RestingLoad, SolveContext,
};
pub(in crate::model::spans) use failure::Failure;
