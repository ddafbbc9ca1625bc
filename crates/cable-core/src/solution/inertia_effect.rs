//! The effect of inertia on a motion: how fast it is, and what it would be without.

use super::NextCheaper;

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
    /// The greatest error of the run's own forces so far, in parts of its greatest tension; None
    /// where it is not known.
    pub run_error: Option<f64>,
    /// Relative accuracy asked for.
    pub tolerance: f64,
}

impl InertiaEffect {
    /// Returns whether forces without inertia differ by more than the tolerance, or are not known;
    /// None where no run without inertia goes beside this one, or where the error of this one hides
    /// it.
    #[must_use]
    pub fn matters(&self) -> Option<bool> {
        let Some(apart) = self.without?.force_error else { return Some(true) };
        let hidden = apart - self.run_error.unwrap_or(0.0) <= self.tolerance;
        if apart <= self.tolerance { Some(false) } else { (!hidden).then_some(true) }
    }
}
