//! This file lists the reasons for which a cable has no equilibrium, and those for which a step
//! fails.

use super::span::SpanError;
use crate::math::Vec2;

/// The reason why nothing can hold the loads.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoEquilibrium {
    /// No support or obstacle holds the cable.
    NothingHolds,
    /// No support holds it, and nothing is below it.
    NothingBelow,
    /// A cable that nothing but friction holds slides farther than it is long.
    SlidesOff,
    /// The cable slides, and nothing has friction.
    NoFriction,
    /// The cable slides; with more friction it would be held.
    TooLittleFriction {
        /// The friction that holds it, as a part of what there is.
        friction_ratio: f64,
    },
    /// The cable slides: forces on its whole are left over.
    UnheldForce {
        /// The unbalanced force, N.
        left_n: f64,
        /// All loads, N.
        loads_n: f64,
    },
    /// The cable begins inside an obstacle that it cannot leave.
    ThroughObstacle {
        /// The obstacle's name.
        obstacle: String,
        /// Its place, m.
        at_m: Vec2,
        /// Place on the cable, m.
        arc_length_m: f64,
    },
    /// The cable runs out through a pulley.
    RunsOut {
        /// The pulley's name.
        pulley: String,
    },
    /// A free end runs off through a pulley.
    RunsOff {
        /// The pulley's name.
        pulley: String,
    },
    /// The cable would have to lie on the other side of a wheel.
    LeavesWheel {
        /// The pulley's name.
        pulley: String,
    },
    /// A free span has no shape.
    Span(SpanError),
}

impl NoEquilibrium {
    /// The same, its place brought back from a similar copy of the scene.
    pub(crate) fn with_places(self, length: impl Fn(f64) -> f64, place: impl Fn(Vec2) -> Vec2) -> Self {
        match self {
            Self::ThroughObstacle { obstacle, at_m, arc_length_m } => {
                Self::ThroughObstacle { obstacle, at_m: place(at_m), arc_length_m: length(arc_length_m) }
            }
            same => same,
        }
    }
}

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
