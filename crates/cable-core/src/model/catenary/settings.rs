//! The settings of `catenary` are its tuned constants in one place.
//!
//! Tolerances that rounding fixes stand beside the code that they belong to. The program
//! `tuned-settings` halves and doubles each setting and prints what moves.

use serde::{Deserialize, Serialize};

/// All settings of the model. What they were tuned on is not recorded, beside the figures given;
/// halved and doubled, none moves an answer (`docs/notes/settings.md`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CatenarySettings {
    /// Most iterations of a loop that ends by itself: Newton's method for one set of modes (60
    /// pulleys from a cold start took 25), rounds of wheel geometry (κR = 0.5 takes 12),
    /// corrections of the friction that a wheel is found to use (measured: 3 to 6). Smaller: long
    /// rows of pulleys fail. Larger: a failure costs more.
    pub max_iterations: usize,
    /// Part of every stretch that an iteration keeps. Smaller: stretches shrink to nothing in a bad
    /// step. Larger: more iterations.
    pub kept_stretch_fraction: f64,
    /// Sets of modes that are changed together; after that one pulley at a time, which cannot cycle
    /// so easily. Smaller: more solves. Larger: cycles last longer.
    pub joint_mode_rounds: usize,
    /// Least divisor of a step of a touch point, where cable and wheel bend almost alike. Smaller:
    /// the touch point jumps to and fro. Larger: more rounds.
    pub least_touch_gain: f64,
}

impl Default for CatenarySettings {
    fn default() -> Self {
        Self { max_iterations: 200, kept_stretch_fraction: 0.2, joint_mode_rounds: 12, least_touch_gain: 0.2 }
    }
}
