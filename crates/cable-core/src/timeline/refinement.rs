//! A run is made anew on half the elements and in half the steps until its errors are as asked.

use super::{Instant, Timeline};
use crate::error::SolveError;
use crate::model::Inertia;
use crate::simulation::Simulation;

/// The accuracy that a run is to reach, and the largest effort that it may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Length of the run, s.
    pub duration_s: f64,
    /// Step to begin with, s; the [usual](super::usual_step) one where that is None.
    pub step_s: Option<f64>,
    /// Greatest error of forces that is accepted, in parts of the greatest tension.
    pub tolerance: f64,
    /// Number of times that elements and steps may be halved; each takes four times as long.
    pub max_halvings: u32,
}

/// A run without outputs for every time it is to be finer, until errors are as asked: the
/// simulation to begin with, settled, and its step (s). A finer one that finds no first rest, or
/// does not come to the end where it is tried, is not taken.
///
/// # Errors
/// As [`Timeline::new`].
pub fn refine_until_accurate(
    simulation: Simulation,
    inertia: Inertia,
    asked: &Refinement,
) -> Result<(Simulation, Option<f64>), SolveError> {
    let mut taken = (simulation, asked.step_s);
    let mut coarser = (taken.clone(), f64::INFINITY);
    for _ in 0..asked.max_halvings {
        let mut timeline = Timeline::new(taken.0.clone(), inertia, taken.1)?.with_errors();
        if timeline.at(Instant::nearest(asked.duration_s), |_| ()).is_err() {
            return Ok(coarser.0);
        }
        let Some(error) = timeline.monitor().relative_error() else { break };
        // Paths are chaotic if a finer run is no nearer: still finer ones are not either.
        if error <= asked.tolerance || error > coarser.1 {
            break;
        }
        let Ok(Some(mut finer)) = taken.0.resolved(2.0) else { break };
        if finer.settle().is_err() {
            break;
        }
        coarser = (std::mem::replace(&mut taken, (finer, Some(0.5 * timeline.step_s()))), error);
    }
    Ok(taken)
}
