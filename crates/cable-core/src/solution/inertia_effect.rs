//! These types state the effect of inertia on a motion: its speed, and the error of leaving inertia
//! out.

use super::NextCheaper;

/// Differences of up to so many tolerances may be those of meshes: of 100 random motions 66
/// verdicts are those of finer runs then, 5 are near the tolerance and 29 open; with 1, four are
/// wrong.
const MAX_OPEN_TOLERANCES: f64 = 3.0;
/// Differences at rest above this multiple of the tolerance hide the effect of inertia. Larger: 2
/// of 2200 motions from rests that differ by 4 % are said not to need inertia; smaller: with 1,
/// more verdicts are open.
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
    /// Returns whether forces without inertia differ by more than the tolerance, or have no answer;
    /// `None` if no run without inertia accompanies this one, if it was given up as not cheaper, or
    /// if the difference is not clear.
    #[must_use]
    pub fn matters(&self) -> Option<bool> {
        let without = self.without?;
        let Some(apart) = without.force_error else { return (!without.costs_more).then_some(true) };
        if apart <= self.tolerance && self.hidden_by().is_none() {
            return Some(false);
        }
        (apart > MAX_OPEN_TOLERANCES * self.tolerance).then_some(true)
    }

    /// The difference at rest, if it hides smaller effects of inertia.
    pub(crate) fn hidden_by(&self) -> Option<f64> {
        self.error_at_rest.filter(|error| *error > MAX_TOLERANCES_AT_REST * self.tolerance)
    }
}
