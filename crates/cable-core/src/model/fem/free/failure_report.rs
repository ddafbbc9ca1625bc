//! This module reports a failure of the solver in terms of the scene: the pulley that runs out, or
//! the place where the forces do not balance.

use crate::error::{NoEquilibrium, Place, SolveError};
use crate::math::Vec2;
use crate::model::Model;
use crate::model::fem::free::pulley_balance::{PulleyFailure, PulleyNetwork};
use crate::problem::Problem;

/// The error for the user that a failure of a network at a time (s) means.
pub(super) fn solve_error(problem: &Problem, network: &PulleyNetwork, time: f64, failure: PulleyFailure) -> SolveError {
    let name = |k: usize| {
        let support = network.layout.stations.get(k).and_then(|s| s.support).and_then(|i| problem.supports.get(i));
        support.map_or_else(|| "?".to_owned(), |s| s.name.clone())
    };
    let not_converged = |k: usize, residual_n: f64| SolveError::NotConverged {
        model: Model::Fem,
        iterations: network.steps,
        residual_n,
        place: network.layout.stations.get(k).map_or_else(Box::<Place>::default, |s| {
            problem.place(s.arc_length, s.point(0).unwrap_or(Vec2::repeat(f64::NAN)), time)
        }),
    };
    match failure {
        PulleyFailure::Span(k, residual) | PulleyFailure::Unbalanced(k, residual) => not_converged(k, residual),
        PulleyFailure::RunsOut(k) => {
            SolveError::NoRestingPlace { why: NoEquilibrium::RunsOut { pulley: name(k).to_owned() } }
        }
        PulleyFailure::LeavesWheel(k) => {
            SolveError::NoRestingPlace { why: NoEquilibrium::LeavesWheel { pulley: name(k).to_owned() } }
        }
    }
}
