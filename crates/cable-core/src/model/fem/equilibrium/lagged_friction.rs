//! This module finds equilibria with lagged friction: it minimises the energy with frozen normal
//! forces, renews these, and repeats until nothing changes.

use crate::math::{bounded, larger};
use crate::model::fem::newton::SolverMemory;
use crate::model::fem::state::{CableState, ChangedNodes, StickSlipChanges, update_stick_slip};
use crate::model::fem::system::{Converged, Failure, FailureCause, Unknowns};

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
    /// nothing changes.
    pub(in crate::model::fem) fn solve_with_lag(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
        rounds: usize,
    ) -> Result<Converged, Failure> {
        self.solve_rounds(cable, unknowns, rounds).map(|found| found.done)
    }

    /// As [`Self::solve_with_lag`]; returns the state of friction, too.
    pub(in crate::model::fem) fn solve_rounds(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
        rounds: usize,
    ) -> Result<Lagged, Failure> {
        let tuning = cable.mesh.tuning.equilibrium;
        let (mut total, mut changes) = (Converged::default(), StickSlipChanges::NONE);
        let (mut fewest, mut spare) = (usize::MAX, tuning.whole_lag_rounds);
        let (mut off, mut part) = (0.0, 1.0);
        let mut before = Vec::with_capacity(cable.contacts.friction_contacts.capacity());
        for round in 0..rounds {
            cable.contacts.list_neighbours(&cable.problem, &cable.mesh, &unknowns.positions, |_| 0.0);
            std::mem::swap(&mut before, &mut cable.contacts.friction_contacts);
            cable.contacts.prepare(&cable.problem, &cable.mesh, &unknowns.positions, &cable.motion.positions);
            if round > 0 {
                let now = cable.contacts.blend_friction(&before, part);
                // Forces that oscillate do not converge with whole steps.
                if round >= tuning.whole_lag_rounds {
                    part = if now < (1.0 - 0.5 * part) * off {
                        bounded(tuning.lag_growth * part, 0.0, 1.0)
                    } else {
                        larger(tuning.lag_shrinkage * part, tuning.min_lag_fraction)
                    };
                }
                off = now;
            }
            cable.input.stopping.shift = cable.meshing.soft_shift();
            let done = self.minimise(cable, unknowns)?;
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
