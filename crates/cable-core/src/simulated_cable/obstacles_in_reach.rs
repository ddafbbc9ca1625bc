//! Obstacles out of a cable's reach are left out of its problem, and put back before it comes to
//! them.
//!
//! Every model reads the obstacles of a [`Problem`](crate::problem::Problem); those that the cable
//! cannot come to, stretched by up to a stated tension, are left out of it. A cable that is drawn,
//! or stretched beyond that, may come to them.

use super::SimulatedCable;
use super::handover::continues;
use crate::error::SolveError;
use crate::math::larger;

impl SimulatedCable {
    /// Notes whether the cable is stretched beyond the tension for which its reach was computed.
    pub(super) fn note_reach(&mut self) {
        let Some(most_n) = self.problem.max_tension_within_reach_n() else { return };
        let tensions = self.pieces.iter().flat_map(|p| p.answer.nodes.iter().map(|n| n.tension_n));
        let peak_n = self.peaks.map_or(0.0, |p| p.greatest.tension_n);
        self.leaves_reach |= tensions.fold(peak_n, larger) > most_n;
    }

    /// Gives a cable that may leave its reach all obstacles of the scene. It touches none of the
    /// new ones yet, so that a new model continues where the old one is.
    pub(super) fn add_obstacles_in_reach(&mut self) -> Result<(), SolveError> {
        if !self.leaves_reach {
            return Ok(());
        }
        let Some(problem) = self.problem.with_all_obstacles() else {
            self.leaves_reach = false;
            return Ok(());
        };
        for k in 0..self.pieces.len() {
            let mut mechanics = self.source.build(problem.clone(), self.settings)?;
            self.targets.tell(&self.pieces[k].part, mechanics.as_mut());
            if !continues(mechanics.as_mut(), self.pieces[k].mechanics.as_ref()) {
                mechanics.set_state(&self.pieces[k].mechanics.state())?;
            }
            self.pieces[k].mechanics = mechanics;
        }
        // Not before: a cable that could not go on among them is asked again.
        (self.problem, self.leaves_reach) = (problem, false);
        Ok(())
    }
}
