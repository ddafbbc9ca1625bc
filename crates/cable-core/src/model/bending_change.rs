//! A moving cable of which the bending stiffness is edited gets or loses it in time.
//!
//! At once, ten times the stiffness made a cable over a beam pull with 165 N for 90 N, one round a
//! post with 168 N for 92 N, and one that was drawn over posts with 349 N for 163 N.

use crate::math::larger;

/// Part of a change, short of the whole, within which it is the whole: the rounding of a sum of
/// parts. Smaller: a change ends a rounding short of its goal; larger: its end is a jump.
pub(in crate::model) const WHOLE_ROUNDING: f64 = 1e-9;

/// Time with which the stiffness changes, s: half of it has changed after 1.7 times as long.
/// Smaller: the tension changes like a blow; larger: the cable is stiffer or softer than its scene
/// says. A choice, tuned on no campaign.
const TIME_S: f64 = 0.1;
/// Part of the change that is made at once at its end, after 1.2 s. Larger: moments jump by it;
/// smaller: the end comes later.
const LAST_CHANGE_FRACTION: f64 = 1e-4;
/// Part of the stiffness of its scene with which a cable begins that had none. Larger: its bends
/// have a moment at once; smaller: rounding. A choice, tuned on no campaign.
const FIRST_STIFFNESS_FRACTION: f64 = 1e-9;

/// The bending stiffness of a cable on its way to that of its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BendingChange {
    from_n_m2: f64,
    to_n_m2: f64,
    since_s: f64,
}

impl BendingChange {
    /// Begins at a stiffness, N·m².
    #[must_use]
    pub fn between(from_n_m2: f64, to_n_m2: f64) -> Self {
        Self { from_n_m2: larger(from_n_m2, FIRST_STIFFNESS_FRACTION * to_n_m2), to_n_m2, since_s: 0.0 }
    }

    /// The stiffness now, N·m².
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        let u = self.since_s / TIME_S;
        let left = (1.0 + u) * (-u).exp();
        if left > LAST_CHANGE_FRACTION { self.to_n_m2 + (self.from_n_m2 - self.to_n_m2) * left } else { self.to_n_m2 }
    }

    /// Goes on for `dt_s`. The moments of a bend that is short beside the cable are as the root of
    /// the stiffness, so it begins with the square of the time: then they grow evenly.
    pub fn follow(&mut self, dt_s: f64) {
        self.since_s += dt_s;
    }

    /// Changes the stiffness by a part of what is left.
    pub fn approach(&mut self, part: f64) {
        let now = self.stiffness();
        let to = if part < 1.0 - WHOLE_ROUNDING { now + (self.to_n_m2 - now) * part } else { self.to_n_m2 };
        (self.from_n_m2, self.since_s) = (to, 0.0);
    }

    /// The factor by which the stiffness can still grow; 1 if it falls.
    #[must_use]
    pub fn greatest_growth(&self) -> f64 {
        larger(self.to_n_m2 / self.stiffness(), 1.0)
    }

    /// True if the stiffness is that of the scene.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.stiffness() == self.to_n_m2
    }
}
