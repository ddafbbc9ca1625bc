//! This module takes quasi-static steps: a step without inertia ends where the cable balances.

use crate::math::Vec2;
use crate::model::Inertia;
use crate::model::fem::obstacle::{IntersectionCheck, prepare_way};
use crate::model::fem::remesh::{remesh, remesh_after_step};
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::{Converged, Failure, FailureCause, Unknowns};

impl Stepper {
    /// Takes a step without inertia to the time `to` (s); friction keeps its memory.
    pub(in crate::model::fem) fn quasi_static_step(
        &mut self,
        to: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<Converged, Failure> {
        self.rest_rounds(to, dragged, f64::INFINITY)
    }

    /// Takes a quasi-static step of a cable with friction.
    ///
    /// # Errors `CornerPulls` if a corner would have to pull, before anything is accepted:
    /// otherwise the friction memory would keep the slip of that state.
    pub(in crate::model::fem) fn step_without_pull(
        &mut self,
        to: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<Converged, Failure> {
        self.rest_rounds(to, dragged, self.cable.mesh.tuning.equilibrium.max_corner_pull_rad)
    }

    /// Solves for the equilibrium at the time `to` (s), again while sliding nodes, loads or
    /// friction change.
    fn rest_rounds(&mut self, to: f64, dragged: &[Option<Vec2>], pull: f64) -> Result<Converged, Failure> {
        let (mut total, mut settled) = (Converged::default(), false);
        // A cable that is brought to rest where it is draws no load over a round.
        let advances = to > self.cable.motion.time;
        for round in 0..self.cable.mesh.tuning.equilibrium.corner_rounds {
            prepare_way(&mut self.cable, [to, to], Some(dragged))?;
            self.cable.adapt_slip();
            self.cable.adapt_stiffness([f64::INFINITY, 0.0], 1.0);
            self.cable.input.stopping.max_iterations = self.cable.mesh.tuning.equilibrium.max_iterations;
            self.cable.input.stopping.max_noise =
                self.cable.mesh.tuning.equilibrium.squeezed_residual * self.cable.input.stopping.tolerance;
            let mut unknowns = self.solver.present_unknowns(&self.cable);
            let mut done = self.solver.solve_lawfully(&mut self.cable, &mut unknowns);
            if done.is_err_and(|f| f.cause != FailureCause::WorkSpent)
                && self.cable.contacts.slip < self.cable.contacts.tuning.slip_m
            {
                // A cable whose friction changes all along it, as at the first shape, comes to rest
                // more easily with a larger elastic slip.
                self.cable.contacts.set_slip(self.cable.contacts.tuning.slip_m);
                unknowns = self.solver.present_unknowns(&self.cable);
                done = self.solver.solve_lawfully(&mut self.cable, &mut unknowns);
            }
            if round == 0
                && pull.is_finite()
                && let Some(node) = IntersectionCheck::at(&self.cable, &unknowns.positions).pulled_corner(pull)
            {
                let residual = done.map_or_else(|f| f.residual, |d| d.residual);
                return Err(Failure { node, residual, cause: FailureCause::CornerPulls });
            }
            let done = done?;
            total = Converged { iterations: total.iterations + done.iterations, ..done };
            self.accept_unknowns(&unknowns, to);
            // If corners are met and left by turns up to the last round, the mesh stays as it is in
            // balance.
            if settled || round + 1 == self.cable.mesh.tuning.equilibrium.corner_rounds {
                break;
            }
            let found = match advances {
                true => remesh_after_step(&mut self.cable, Inertia::QuasiStatic),
                false => remesh(&mut self.cable, Inertia::QuasiStatic),
            };
            // Moving marks moves strain from bar to bar, so the cable has to be balanced once more.
            settled = !found.bars;
            if settled && !found.marks {
                break;
            }
        }
        Ok(total)
    }

    /// Accepts unknowns as the state at rest at the time `to`; returns whether the corners and
    /// posts that the cable runs over changed.
    pub(super) fn accept_rest(&mut self, unknowns: &Unknowns, to: f64) -> bool {
        self.accept_unknowns(unknowns, to);
        remesh(&mut self.cable, Inertia::QuasiStatic).sliding_nodes
    }

    /// Accepts unknowns with the corners as they are.
    pub(super) fn accept_unknowns(&mut self, unknowns: &Unknowns, to: f64) {
        self.cable.commit_contacts(unknowns);
        self.cable.contacts.body_motions.clear();
        self.cable.motion.positions.clone_from(&unknowns.positions);
        self.cable.motion.velocities.fill(Vec2::zeros());
        self.cable.motion.slide_rates.fill(0.0);
        self.cable.motion.time = to;
        self.cable.mesh.slide(&unknowns.slides);
        self.cable.mesh.sliding.iter_mut().flatten().for_each(|s| s.balanced = None);
        self.forget_history();
    }
}
