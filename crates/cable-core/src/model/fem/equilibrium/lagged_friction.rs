//! Equilibria with lagged friction: the energy is minimised with frozen normal forces, which are
//! then renewed, until nothing changes.

use crate::math::{bounded, larger};
use crate::model::fem::newton::minimize::DRIFT;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::state::control::SolverMemory;
use crate::model::fem::system::step_input::{Converged, Failure, FailureCause, StepInput, Unknowns};
use crate::model::fem::time::step_setup::StickSlipChanges;
use crate::model::fem::time::step_solver::ROUNDS_EACH;

/// Rounds of refreshing the normal forces that friction uses, in a step without inertia.
pub(in crate::model::fem) const LAG_ROUNDS: usize = 25;

/// Rounds after which normal forces are taken halfway to the new ones only: where a contact that
/// rubs more lifts its neighbour, which then rubs less, they go round and round. Fewer: what
/// converges by itself takes longer; more: fewer rounds are left to halve what is off.
const PLAIN_ROUNDS: usize = 8;

/// Least part of the way that friction is taken towards its new normal forces, and by what that
/// part changes from round to round.
const LEAST_PART: f64 = 0.03;
const RESISTANCE_GROWTH: f64 = 1.1;
const RESISTANCE_SHRINKAGE: f64 = 0.6;

/// A solution with refreshed normal forces, grips and factors.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Lagged {
    pub(in crate::model::fem) done: Converged,
    grips: StickSlipChanges,
    /// Change of the friction of a contact in the last round, N.
    off: f64,
}

impl Lagged {
    /// True if friction is what the normal forces allow, at sliding nodes and elsewhere.
    pub(in crate::model::fem) fn is_lawful(&self, input: &StepInput) -> bool {
        self.grips.hold() && self.off <= DRIFT * input.tolerance
    }
}

impl SolverMemory {
    /// Minimises again and again with refreshed normal forces, grips and factors until nothing
    /// changes.
    pub(in crate::model::fem) fn lag(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
        rounds: usize,
    ) -> Result<Converged, Failure> {
        self.lag_until(cable, unknowns, rounds).map(|found| found.done)
    }

    /// The same; says what was found.
    pub(in crate::model::fem) fn lag_until(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
        rounds: usize,
    ) -> Result<Lagged, Failure> {
        let (mut total, mut grips) = (Converged::default(), StickSlipChanges::FOUND);
        let (mut fewest, mut spare) = (usize::MAX, PLAIN_ROUNDS);
        let (mut off, mut part) = (0.0, 1.0);
        let mut before = Vec::with_capacity(cable.contacts.rubs.capacity());
        for round in 0..rounds {
            cable.contacts.look_around(&cable.problem, &cable.mesh, &unknowns.x, |_| 0.0);
            std::mem::swap(&mut before, &mut cable.contacts.rubs);
            cable.contacts.prepare(&cable.problem, &cable.mesh, &unknowns.x, &cable.motion.x);
            if round > 0 {
                let now = cable.contacts.ease(&before, part);
                // Forces that go to and fro get no nearer by steps as long as before.
                if round >= PLAIN_ROUNDS {
                    part = if now < (1.0 - 0.5 * part) * off {
                        bounded(RESISTANCE_GROWTH * part, 0.0, 1.0)
                    } else {
                        larger(RESISTANCE_SHRINKAGE * part, LEAST_PART)
                    };
                }
                off = now;
            }
            cable.input.shift = cable.soft_shift();
            let done = self.minimise(cable, unknowns)?;
            total = Converged { iterations: total.iterations + done.iterations, ..done };
            grips = cable.update_grips(unknowns, spare == 0);
            if grips.wrong < fewest {
                (fewest, spare) = (grips.wrong, PLAIN_ROUNDS);
            } else {
                spare = spare.saturating_sub(1);
            }
            // A round that needed no iteration found the normal forces it had used.
            let found = done.iterations == 0 && off <= cable.input.tolerance;
            if (found || cable.contacts.rubs.is_empty()) && grips.wrong == 0 && grips.same {
                return Ok(Lagged { done: total, grips, off: 0.0 });
            }
        }
        Ok(Lagged { done: total, grips, off })
    }

    /// The same, until the law holds at every sliding node.
    pub(in crate::model::fem) fn lag_wholly(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        let sliding = cable.mesh.sliding.iter().flatten().count();
        let found = self.lag_until(cable, unknowns, LAG_ROUNDS + ROUNDS_EACH * sliding)?;
        if found.is_lawful(&cable.input) {
            return Ok(found.done);
        }
        let node = cable.mesh.sliding.iter().position(Option::is_some).unwrap_or(0);
        Err(Failure { node, residual: found.done.residual, cause: FailureCause::StickSlipUndecided })
    }
}
