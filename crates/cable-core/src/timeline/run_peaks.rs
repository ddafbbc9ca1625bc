//! The greatest tensions of a run have ranges, and these say whether mesh and step resolve them.

use crate::solution::TensionPeaks;

/// Ends of a range of tensions that are no more than so many times each other are those of one
/// tension that is known, if roughly. Less: peaks that any finer run has as well are called
/// uncertain; more: a cable is chosen by a peak that another mesh does not have.
const SMALL_DIFFERENCES_RATIO: f64 = 1.5;

/// From what to what tensions of a cable may be, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TensionRanges {
    /// The greatest of any inner step.
    pub greatest_n: [f64; 2],
    /// The greatest mean over the cable's `breaking_time_s`.
    pub held_n: [f64; 2],
}

impl TensionRanges {
    /// True if twice the elements and half the step change both by no more than this part of them,
    /// as far as the coarser runs tell.
    #[must_use]
    pub fn are_resolved(&self, tolerance: f64) -> bool {
        [self.greatest_n, self.held_n].iter().all(|[from, to]| to - from <= tolerance * to)
    }

    /// True if the runs beside this one part from it so far that its greatest tension depends on
    /// small differences, of mesh and step and so of how it began: the ends of a range are more
    /// than `SMALL_DIFFERENCES_RATIO` times apart.
    #[must_use]
    pub fn depend_on_small_differences(&self) -> bool {
        [self.greatest_n, self.held_n].iter().any(|[from, to]| *to > SMALL_DIFFERENCES_RATIO * from)
    }
}

/// The greatest tensions of a cable in a run so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunPeaks {
    /// The peaks, with place and time.
    pub peaks: TensionPeaks,
    /// The ranges; `None` if they are not known.
    pub ranges: Option<TensionRanges>,
}
