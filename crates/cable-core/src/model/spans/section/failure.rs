//! A failure says why a cable section has no answer here, before it becomes a
//! [`SolveError`](crate::SolveError).

use crate::error::EquilibriumFault;
use crate::math::Vec2;

/// Reason of a failure.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model::spans) enum Failure {
    /// Newton stopped short: iterations, scaled residual, material point of the worst equation, m.
    Stalled { iterations: usize, residual: f64, s: f64 },
    /// Events went on and on.
    ContactCycling { s: f64 },
    /// The cable would have to push: material point, place, tension (N, negative).
    Compressed { s: f64, at: Vec2, tension: f64 },
    /// The cable lifts off the wheel of a support.
    OffWheel { support: usize },
    /// The cable would have passed through a corner.
    Tunnelled { at: Vec2 },
    /// A support is inside an obstacle.
    SupportInside { at: Vec2 },
    /// A point load lies on an obstacle.
    LoadInContact { s: f64 },
    /// An obstacle is met where this model cannot lay the cable.
    ContactImpossible { s: f64, at: Vec2 },
    /// A cable that lies loose is drawn along: material point, m.
    SlackDragged { s: f64 },
    /// The answer does not pass the check that does not use the solver.
    Unsound { what: EquilibriumFault, s: f64, at: Vec2 },
}
