//! A moving cable of which the length is edited, or the temperature, grows or shrinks to its new
//! unstretched length in time.
//!
//! At once, a span of 20 m let out by 1 % fell free and pulled with 1762 N for 93 N when it was
//! caught; hauled in by 1 % it broke, with 20 kN. A winch does neither.

use super::smoothed_target::{EDIT_SPEED, SmoothedTarget};
use crate::math::Vec2;
use crate::problem::Problem;

/// The unstretched length of a cable on its way to that of its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthChange {
    length: SmoothedTarget,
    /// The unstretched length at the end of the present step, and of the three before, m.
    lengths_m: [f64; 4],
}

impl LengthChange {
    /// Begins at an unstretched length, m.
    #[must_use]
    pub fn from(length_m: f64) -> Self {
        Self { length: SmoothedTarget::at_rest(Vec2::new(length_m, 0.0)), lengths_m: [length_m; 4] }
    }

    /// Changes towards the unstretched length of a problem for `dt_s`; returns that of a metre of
    /// arc length, which is the very one of the problem once it is there.
    pub fn follow(&mut self, problem: &Problem, dt_s: f64) -> f64 {
        let to_m = problem.thermal_stretch * problem.length;
        self.length.follow(Vec2::new(to_m, 0.0), dt_s, EDIT_SPEED);
        let [now, before, older, _] = self.lengths_m;
        self.lengths_m = [self.length.position().x, now, before, older];
        if self.lengths_m[0] == to_m { problem.thermal_stretch } else { self.lengths_m[0] / problem.length }
    }

    /// The unstretched length at the end of the present step, of that at its start and at those of
    /// the two steps before.
    #[must_use]
    pub fn growth(&self) -> [f64; 3] {
        let [now, earlier @ ..] = self.lengths_m;
        earlier.map(|length| now / length)
    }
}
