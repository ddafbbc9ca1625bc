//! A moving cable of which the length is edited, or the temperature, grows or shrinks to its new
//! unstretched length in time.
//!
//! At once, a span of 20 m let out by 1 % fell free and pulled with 1762 N for 93 N when it was
//! caught; hauled in by 1 % it broke, with 20 kN. A winch does neither.

use super::smoothed_target::{EDIT_SPEED, SmoothedTarget};
use crate::math::{Vec2, larger};
use crate::problem::Problem;

/// Time in which the excess of unstretched lengths fades by a factor e, s, or longer where the
/// cable would change its length faster than by [`EDIT_SPEED`]. Smaller: the tension changes like a
/// blow; larger: the cable is longer or shorter than its scene says. A choice, tuned on no
/// campaign.
const EXCESS_TIME_S: f64 = 0.2;
/// Excess of an unstretched length, as a fraction of it, below which it is that of the material.
/// Larger: tensions jump by EA times as much where an excess ends; smaller: it takes longer to end.
pub(crate) const LEAST_EXCESS: f64 = 1e-9;

/// Least length with which a slack bar or spring begins to push, of its unstretched length.
/// Smaller: it grows from a point; larger: it pushes at once. A choice, tuned on no campaign.
pub(crate) const MIN_UNSTRESSED_FRACTION: f64 = 0.01;

/// The part of the excess of unstretched lengths, of which the sizes add up to `whole_m` (m), that
/// is left after `dt_s` (s).
pub(crate) fn excess_left(whole_m: f64, dt_s: f64) -> f64 {
    (-dt_s / larger(EXCESS_TIME_S, whole_m / EDIT_SPEED)).exp()
}

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
