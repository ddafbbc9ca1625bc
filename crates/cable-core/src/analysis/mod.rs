//! Analyses compare several answers of one scene; all of them run through
//! [`Simulation`](crate::Simulation).
//!
//! | room | question |
//! |---|---|
//! | `tension_budget.rs` | which part of a tension comes from the end, from weight, from wind, from friction of each contact? |
//! | `friction_range.rs` | how far do the tensions move when every friction coefficient is scaled down and up? |
//! | `stiffness.rs` | by how much does the force change per metre that an end is moved? |
//! | `neglected_bending.rs` | what would the neglected bending stiffness change? |
//! | `settings_comparison.rs` | what would other models and meshes answer? |
//! | `safe_reach/` | where can an end, or a robot, be taken before the tension exceeds a limit? |

pub mod friction_range;
mod neglected_bending;
pub mod safe_reach;
mod settings_comparison;
mod stiffness;
pub mod tension_budget;

pub use neglected_bending::{Bending, NeglectedBending, neglected_bending, scene_with_bending, settle_with_bending};
pub use settings_comparison::{Compared, Setting, answer_with};
pub use stiffness::{EndStiffness, end_stiffness};
