//! A failure is the reason why a section has no answer, before it becomes a
//! [`SolveError`](crate::SolveError).

use crate::error::EquilibriumFault;
use crate::math::Vec2;

/// The reason of a failure.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::model::spans) enum Failure {
    /// Newton's method did not converge: iterations, scaled residual, material point of the worst
    /// equation, m.
    Stalled { iterations: usize, residual: f64, s: f64 },
    /// The changes of contacts did not end.
    ContactCycling { s: f64 },
    /// The cable would be compressed: material point, place, tension (N, negative).
    Compressed { s: f64, at: Vec2, tension: f64 },
    /// The cable lifts off the wheel of a support.
    OffWheel { support: usize },
    /// The cable would have passed through a corner.
    Tunnelled { at: Vec2 },
    /// A support is inside an obstacle.
    SupportInside { at: Vec2 },
    /// A point load lies on an obstacle.
    LoadInContact { s: f64 },
    /// The cable meets an obstacle at a place where this model cannot lay it.
    ContactImpossible { s: f64, at: Vec2 },
    /// A loose cable is dragged along: material point, m.
    SlackDragged { s: f64 },
    /// The answer fails the check that does not use the solver.
    Unsound { what: EquilibriumFault, s: f64, at: Vec2 },
}
