//! Analyses ask a scene more than one question and compare the answers; all of them run through
//! [`Simulation`](crate::Simulation).
//!
//! | room | question |
//! |---|---|
//! | `tension_budget.rs` | which part of a tension comes from the end, from weight, from wind, from friction of each contact? |
//! | `friction_range.rs` | how far do the tensions move when every friction coefficient is scaled down and up? |
//! | `safe_reach/` | where can an end, or a robot, be taken before the tension exceeds a limit? |

pub mod friction_range;
pub mod safe_reach;
pub mod tension_budget;
