//! The reasons for which a cable has no equilibrium, and those for which a step fails.

use thiserror::Error;

use crate::math::Vec2;

/// Why nothing can hold the loads.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoEquilibrium {
    /// No support or obstacle holds the cable.
    #[error("nothing holds the cable")]
    NothingHolds,
    /// No support holds it, and nothing is below it.
    #[error("no support holds the cable and there is nothing that it could lie on")]
    NothingBelow,
    /// A cable that nothing but friction holds slides farther than it is long.
    #[error("nothing holds the cable where it is laid: it slides away by more than its length")]
    SlidesOff,
    /// The cable slides, and nothing has friction.
    #[error("it slides: nothing rubs that would hold it where it is laid")]
    NoFriction,
    /// The cable slides; with more friction it would be held.
    #[error("{}", missing_friction(*.friction_ratio))]
    TooLittleFriction {
        /// The friction that holds it, as a part of what there is.
        friction_ratio: f64,
    },
    /// The cable slides: forces on its whole are left over.
    #[error("it slides: {left_n:.3e} N of {loads_n:.3e} N are held by nothing")]
    UnheldForce {
        /// What is left over, N.
        left_n: f64,
        /// All loads, N.
        loads_n: f64,
    },
    /// The cable begins inside an obstacle that it cannot leave.
    #[error(
        "the cable is laid through `{obstacle}`, at ({:.3} m, {:.3} m), {arc_length_m:.3} m along it, and nothing leads it out: draw a route_m round it, or leave a way to where its ends are held", .at_m.x, .at_m.y
    )]
    ThroughObstacle {
        /// The obstacle's name.
        obstacle: String,
        /// Where that is, m.
        at_m: Vec2,
        /// Where on the cable, m.
        arc_length_m: f64,
    },
    /// The cable runs out through a pulley.
    #[error("the cable runs out through pulley `{pulley}`")]
    RunsOut {
        /// The pulley's name.
        pulley: String,
    },
    /// A free end runs off through a pulley.
    #[error("the cable runs off through pulley `{pulley}`, which nothing holds back")]
    RunsOff {
        /// The pulley's name.
        pulley: String,
    },
    /// The cable would have to lie on the other side of a wheel.
    #[error("the cable does not press on the wheel of pulley `{pulley}` on the side it runs on")]
    LeavesWheel {
        /// The pulley's name.
        pulley: String,
    },
    /// A free span has no shape.
    #[error("{reason}")]
    Span {
        /// What the catenary's solver says of it.
        reason: String,
    },
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

/// How much more friction holds a cable: three digits, the last one rounded up, so that it does.
fn missing_friction(friction_ratio: f64) -> String {
    let more = 100.0 * (friction_ratio - 1.0);
    let digits = (2.0 - more.log10().floor()).clamp(0.0, 9.0);
    let unit = 10f64.powi(-(digits as i32));
    let shown = (more / unit).ceil() * unit;
    format!("it slides: {shown:.0$} % more friction would hold it where it is laid", digits as usize)
}

/// The reasons for which a step, or the search for an equilibrium, fails.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FailureCause {
    /// The energy or its gradient is not finite.
    #[error("the energy is not finite")]
    EnergyNotFinite,
    /// A position or velocity after the step is not finite.
    #[error("not finite")]
    StateNotFinite,
    /// The iteration has not converged in as many iterations as it may take.
    #[error("too many iterations")]
    TooManyIterations,
    /// All the work that one equilibrium may take is done: no other way is tried.
    #[error("the work for one resting place is spent")]
    WorkSpent,
    /// No shift makes the tangent stiffness positive definite.
    #[error("the tangent is not positive definite")]
    TangentIndefinite,
    /// A sliding node holds a corner that would have to pull: the step is tried again without it.
    #[error("a corner would have to pull")]
    CornerPulls,
    /// No consistent set of sliding nodes that stick and that slip was found.
    #[error("it was not found which corners hold the cable and over which it slips")]
    StickSlipUndecided,
    /// A bar would pass through a corner.
    #[error("the cable would run through a corner")]
    CornerCrossed,
    /// The relaxation ends with nodes that still move.
    #[error("it never came to rest")]
    StillMoves,
    /// The relaxation carries the cable away without end.
    #[error("it slides away")]
    SlidesAway,
    /// A held node stays short of its target.
    #[error("a support cannot reach its place")]
    SupportShort,
    /// No step length lowers the energy.
    #[error("no descent")]
    NoDescent,
    /// The working memory cannot be had.
    #[error("there is no memory for it")]
    OutOfMemory,
    /// Nodes move faster than the model follows.
    #[error("it moves at {speed_m_per_s:.3e} m/s there")]
    RunawaySpeed {
        /// The greatest speed, m/s.
        speed_m_per_s: f64,
    },
    /// The equilibrium of the instant was not found.
    #[error("no balance in {iterations} iterations")]
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
