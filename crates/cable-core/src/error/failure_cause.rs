//! This file lists the reasons for which a step, or the search for an equilibrium, fails.

/// The reasons for which a step, or the search for an equilibrium, fails.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FailureCause {
    /// The energy or its gradient is not finite.
    EnergyNotFinite,
    /// A position or velocity after the step is not finite.
    StateNotFinite,
    /// The iteration has not converged in as many iterations as it may take.
    TooManyIterations,
    /// All the work that one equilibrium may take is done: no other way is tried.
    WorkSpent,
    /// No shift makes the tangent stiffness positive definite.
    TangentIndefinite,
    /// A sliding node holds a corner that would have to pull: the step is tried again without it.
    CornerPulls,
    /// No consistent set of sliding nodes that stick and that slip was found.
    StickSlipUndecided,
    /// A bar would pass through a corner.
    CornerCrossed,
    /// The cable does not come clear of an obstacle that moves.
    BodyInTheWay,
    /// The relaxation ends with nodes that still move.
    StillMoves,
    /// The relaxation carries the cable away without end.
    SlidesAway,
    /// A held node stays short of its target.
    SupportShort,
    /// No step length lowers the energy.
    NoDescent,
    /// The working memory cannot be had.
    OutOfMemory,
    /// Nodes move faster than the model follows.
    RunawaySpeed {
        /// The greatest speed, m/s.
        speed_m_per_s: f64,
    },
    /// The equilibrium of the instant was not found.
    NoBalance {
        /// Iterations done.
        iterations: usize,
    },
}

impl FailureCause {
    /// The same, its speed brought back from a similar copy of the scene.
    pub(crate) fn with_speed(self, speed: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::RunawaySpeed { speed_m_per_s } => Self::RunawaySpeed { speed_m_per_s: speed(speed_m_per_s) },
            same => same,
        }
    }
}
