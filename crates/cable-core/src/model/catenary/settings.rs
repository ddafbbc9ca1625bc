//! The settings of `catenary` are its tuned constants in one place.
//!
//! Tolerances that rounding fixes stand beside the code that they belong to. The program
//! `tuned-settings` halves and doubles each setting and prints what moves.

use serde::{Deserialize, Serialize};

/// All settings of the model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CatenarySettings {
    /// Greatest move of a support in one solve of a slow motion, of the cable's length. Smaller:
    /// more solves for the same answer. Larger: slip that starts and reverses inside a step is
    /// missed. 1 % halved changed the drags of the reference scenes by less than 1e-6.
    pub max_move_fraction: f64,
    /// Most halvings of a slow step. Smaller: steps fail. Larger: a failure costs more.
    pub max_step_halvings: u32,
    /// Most iterations of Newton's method for one set of modes; 60 pulleys from a cold start took
    /// 25. Smaller: long rows of pulleys fail. Larger: a failure costs more.
    pub max_iterations: usize,
    /// Most rounds of wheel geometry; κR = 0.5 takes 12. Smaller: wheels as round as the cable
    /// beside them fail. Larger: a failure costs more.
    pub max_wheel_rounds: usize,
    /// Part of every stretch that an iteration keeps. Smaller: stretches shrink to nothing in a bad
    /// step. Larger: more iterations.
    pub kept_stretch_fraction: f64,
    /// Sets of modes that are changed together; after that one pulley at a time, which cannot cycle
    /// so easily. Smaller: more solves. Larger: cycles last longer.
    pub joint_mode_rounds: usize,
    /// Most corrections of the friction that a wheel is found to use; measured: 3 to 6. Smaller: it
    /// is off by what the weight on the wheel does to it. Larger: a wheel that is all weight costs
    /// more.
    pub max_friction_corrections: usize,
    /// Most rises of friction from none to what it is, failed ones included; as many halve the rise
    /// to 1e-6. One has done for every scene tried (400 random dead loads over a rubbing wheel, EA
    /// 3e4 to 1e9). Smaller: a rise that fails is not halved far. Larger: a failure costs more.
    pub max_friction_rises: usize,
    /// Least divisor of a step of a touch point, where cable and wheel bend almost alike. Smaller:
    /// the touch point jumps to and fro. Larger: more rounds.
    pub least_touch_gain: f64,
}

impl Default for CatenarySettings {
    fn default() -> Self {
        Self {
            max_move_fraction: 0.01,
            max_step_halvings: 10,
            max_iterations: 200,
            max_wheel_rounds: 60,
            kept_stretch_fraction: 0.2,
            joint_mode_rounds: 12,
            max_friction_corrections: 20,
            max_friction_rises: 20,
            least_touch_gain: 0.2,
        }
    }
}
