//! A cable is cut into sections between its grips; each has free spans and contacts in a row.
//!
//! | room | what it holds |
//! |---|---|
//! | `section_layout.rs` | how supports and loads cut the cable |
//! | `boundary_conditions.rs` | what holds and pulls at an instant |
//! | `cable_section.rs` | free spans and contacts between two end conditions: the unknowns |
//! | `failure.rs` | why a section has no equilibrium |

pub(in crate::model::spans) mod boundary_conditions;
pub(in crate::model::spans) mod cable_section;
pub(in crate::model::spans) mod failure;
pub(in crate::model::spans) mod section_layout;
