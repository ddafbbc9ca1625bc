//! These modules guide a newcomer: hints on the canvas, the welcome dialog, and tutorials.
//!
//! - `first_step_hints`: the hints of the first minute, at the foot of the canvas
//! - `welcome_dialog`: scenes and tutorials to begin with
//! - `tutorials`, `tutorial_bar`: the guided scenes with their steps, and the bar that leads
//!   through one

pub(super) mod first_step_hints;
pub(super) mod tutorial_bar;
pub mod tutorials;
pub(super) mod welcome_dialog;
