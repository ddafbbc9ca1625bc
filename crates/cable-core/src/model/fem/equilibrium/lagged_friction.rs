//! This module finds equilibria with lagged friction: it minimises the energy with frozen normal
//! forces, renews these, and repeats until nothing changes.

use crate::math::{larger, smaller};
use crate::model::fem::newton::SolverMemory;
use crate::model::fem::state::{CableState, ChangedNodes, StickSlipChanges, update_stick_slip};
use crate::model::fem::system::{Converged, Failure, FailureCause, FrictionLimits, Unknowns};

/// Tolerance of a round in which friction limits are sought, as a fraction of that of the
/// equilibrium. Larger: the search follows noise; smaller: every round seeks what round-off hides.
const SEARCH_TOLERANCE: f64 = 0.1;

/// Error of the lengths of the two bars beside a node, in units of the round-off of a coordinate.
/// Smaller: a polish of many short bars spends all of its iterations on what round-off hides (for
/// 10 000 bars on a floor that was 0.7 of the work); larger: less accurate equilibria.
const LENGTH_ROUNDINGS: f64 = 2.0;

/// Force that the round-off of coordinates causes at a node between even bars, N. It grows with the
/// number of bars.
pub(super) fn rounding_of_bars(cable: &CableState) -> f64 {
    let farthest = cable.motion.positions.iter().map(|x| x.norm()).fold(0.0, larger);
    LENGTH_ROUNDINGS * f64::EPSILON * farthest * cable.problem.axial_stiffness / cable.even()
}

/// A solution whose normal forces and stick-slip states are up to date.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Lagged {
    pub(in crate::model::fem) done: Converged,
    changes: StickSlipChanges,
    /// Change of the friction of a contact in the last round, N.
    off: f64,
}

impl Lagged {
    /// True if friction lies within the friction cone, at sliding nodes and elsewhere.
    pub(in crate::model::fem) fn is_lawful(&self, cable: &CableState) -> bool {
        self.changes.are_lawful()
            && self.off <= cable.mesh.tuning.newton.stretch_residual * cable.input.stopping.tolerance
    }
}

impl SolverMemory {
    /// Minimises in rounds, with normal forces and stick-slip states renewed after each, until
    /// nothing changes; whether what was found when the rounds were used up is lawful remains to be
    /// asked.
    pub(in crate::model::fem) fn solve_rounds(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
        rounds: usize,
    ) -> Result<Lagged, Failure> {
        let tuning = cable.mesh.tuning.equilibrium;
        let (mut total, mut changes) = (Converged::default(), StickSlipChanges::NONE);
        let (mut fewest, mut spare) = (usize::MAX, tuning.whole_lag_rounds);
        let (mut off, mut limits) = (0.0, FrictionLimits::default());
        let mut before = Vec::with_capacity(cable.contacts.friction_contacts.capacity());
        for round in 0..rounds {
            let is_searched = round >= tuning.whole_lag_rounds;
            cable.contacts.list_neighbours(&cable.problem, &cable.mesh, &unknowns.positions, |_| 0.0);
            std::mem::swap(&mut before, &mut cable.contacts.friction_contacts);
            cable.contacts.prepare(&cable.problem, &cable.mesh, &unknowns.positions, &cable.motion.positions);
            if round > 0 {
                let next = if is_searched { FrictionLimits::false_position } else { FrictionLimits::substitute };
                off = next(&mut limits, &mut cable.contacts.friction_contacts, &before);
            }
            cable.input.stopping.shift = cable.meshing.soft_shift();
            // False position uses differences of forces, which need a tighter tolerance.
            let exact = cable.input.stopping.tolerance;
            if is_searched {
                let least = larger(SEARCH_TOLERANCE * exact, rounding_of_bars(cable));
                cable.input.stopping.tolerance = smaller(exact, least);
            }
            let done = self.minimise(cable, unknowns);
            cable.input.stopping.tolerance = exact;
            let done = done?;
            total = Converged { iterations: total.iterations + done.iterations, ..done };
            let nodes = if spare == 0 { ChangedNodes::One } else { ChangedNodes::All };
            changes = update_stick_slip(cable, unknowns, nodes, None);
            if changes.wrong < fewest {
                (fewest, spare) = (changes.wrong, tuning.whole_lag_rounds);
            } else {
                spare = spare.saturating_sub(1);
            }
            // A round that needed no iteration confirms the normal forces that it used.
            let found = done.iterations == 0 && off <= cable.input.stopping.tolerance;
            if (found || cable.contacts.friction_contacts.is_empty()) && changes.wrong == 0 && changes.same {
                return Ok(Lagged { done: total, changes, off: 0.0 });
            }
            let lagged = Lagged { done: total, changes, off };
            if is_searched && changes.same && lagged.is_lawful(cable) {
                return Ok(lagged);
            }
        }
        Ok(Lagged { done: total, changes, off })
    }

    /// Solves in such rounds until the law of friction holds at every sliding node.
    pub(in crate::model::fem) fn solve_lawfully(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        let sliding = cable.mesh.sliding.iter().flatten().count();
        let found = self.solve_rounds(
            cable,
            unknowns,
            cable.mesh.tuning.equilibrium.lag_rounds + cable.mesh.tuning.step.grip_rounds_each * sliding,
        )?;
        if found.is_lawful(cable) {
            return Ok(found.done);
        }
        let node = cable.mesh.sliding.iter().position(Option::is_some).unwrap_or(0);
        Err(Failure { node, residual: found.done.residual, cause: FailureCause::StickSlipUndecided })
    }
}
