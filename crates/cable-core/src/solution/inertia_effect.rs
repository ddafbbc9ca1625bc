//! These types state the effect of inertia on a motion: its speed, and the error of leaving inertia
//! out.

use super::NextCheaper;

/// Differences between these multiples of the tolerance may be those of meshes and steps: the
/// verdict is open. Of 2200 random motions none has a wrong verdict and 31 in 100 an open one; with
/// 1 in place of 0.5, 2 are wrong.
const OPEN_TOLERANCES: [f64; 2] = [0.5, 3.0];
/// Differences at rest above this multiple of the tolerance hide the effect of inertia. Larger: 2
/// of 2200 motions from rests that differ by 4 % are said not to need inertia; smaller: with 1, 40
/// in 100 verdicts are open.
const MAX_TOLERANCES_AT_REST: f64 = 10.0;

/// Speeds of a run beside those at which inertia shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionNumbers {
    /// The greatest speed of any point of a cable so far, m/s.
    pub greatest_speed_m_per_s: f64,
    /// Mach number: the greatest speed of a cable over that of waves of stretch along it, √(EA/m).
    pub mach: f64,
    /// Froude number: the greatest speed of a cable over √(g L), L being its length; None without
    /// gravity.
    pub froude: Option<f64>,
}

/// The numbers of a motion, and what it would be without inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertiaEffect {
    /// The numbers of the motion.
    pub numbers: MotionNumbers,
    /// The run without inertia and the most by which it has differed so far, beyond what it did at
    /// rest: forces in parts of the greatest tension of the run. None where there is none beside
    /// it.
    pub without: Option<NextCheaper>,
    /// The most by which the two differed at rest, before anything moved: forces in parts of the
    /// greatest tension of the run. Smaller effects of inertia are hidden by it.
    pub error_at_rest: Option<f64>,
    /// Relative accuracy asked for.
    pub tolerance: f64,
}

impl InertiaEffect {
    /// Returns whether forces without inertia differ by more than the tolerance, or are not known;
    /// `None` if no run without inertia accompanies this one, or if the difference is not clear.
    #[must_use]
    pub fn matters(&self) -> Option<bool> {
        let Some(apart) = self.without?.force_error else { return Some(true) };
        let [open_from, open_to] = OPEN_TOLERANCES.map(|times| times * self.tolerance);
        let is_hidden = self.error_at_rest.is_none_or(|error| error > MAX_TOLERANCES_AT_REST * self.tolerance);
        match apart {
            _ if apart > open_to => Some(true),
            _ if apart <= open_from && !is_hidden => Some(false),
            _ => None,
        }
    }
}
