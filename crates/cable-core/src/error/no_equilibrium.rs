//! This file lists the reasons for which a cable has no equilibrium.

use super::span_error::SpanError;
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
