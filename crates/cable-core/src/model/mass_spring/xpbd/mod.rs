//! These modules take the preview's sub-steps of compliant constraints.
//!
//! | room | content |
//! |---|---|
//! | `sub_step.rs` | XPBD sub-steps of the real-time preview: prediction, contacts, warning |
//! | `constraint_solve.rs` | tridiagonal solve of all spring constraints at once, with pulley friction |

pub(in crate::model::mass_spring) mod constraint_solve;
pub(in crate::model::mass_spring) mod sub_step;

pub(in crate::model::mass_spring) use sub_step::preview;
