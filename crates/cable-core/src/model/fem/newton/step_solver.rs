//! This module solves a step that is set up: without contact if the cable can touch nothing, else
//! with contact, until friction and normal forces agree.

use crate::contact::self_contact_pairs::SelfPair;
use crate::math::larger;
use crate::model::fem::newton::{SolverMemory, Workspace};
use crate::model::fem::state::{CableState, ChangedNodes, TriedExponents, update_stick_slip};
use crate::model::fem::system::{ContactPair, Converged, Failure, FailureCause, Unknowns};

impl SolverMemory {
    /// The contacts of the last step that was solved with contact.
    pub(in crate::model::fem) fn contacts(&self) -> &[ContactPair] {
        self.memory.0.as_ref().map_or(&[], |memory| &memory.touches)
    }

    /// The contacts of the cable with itself in that step.
    pub(in crate::model::fem) fn own_contacts(&self) -> &[SelfPair] {
        self.memory.0.as_ref().map_or(&[], |memory| &memory.self_contact.pairs)
    }

    /// The present unknowns extrapolated with the velocities by `h` (s), if nothing can be in the
    /// way. Newton's method then starts nearer to the solution by a factor of the step, and its
    /// remaining error is smaller and not always of the same sign.
    pub(in crate::model::fem) fn predicted_unknowns(&mut self, cable: &CableState, h: f64) -> Unknowns {
        let mut unknowns = self.present_unknowns(cable);
        for (k, (x, v)) in unknowns.positions.iter_mut().zip(&cable.motion.velocities).enumerate() {
            if cable.mesh.is_free(k) {
                *x += v * h;
            } else if cable.mesh.fixity[k] {
                // If a support stayed behind, short bars beside it would have to turn by large
                // angles.
                *x = cable.input.supports.target[k];
            }
        }
        if cable.step_context().is_out_of_reach(&unknowns.positions) {
            unknowns
        } else {
            self.unknowns = unknowns;
            self.present_unknowns(cable)
        }
    }

    /// Minimises until friction follows the normal forces of this step. With the normal forces at
    /// its start, the friction of an impact would act one step late, by a force that no longer
    /// exists: up to nine times the friction cone, along the cable.
    pub(in crate::model::fem) fn minimise_with_friction(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        let mut done = self.minimise_with_stick_slip(cable, unknowns)?;
        for _ in 0..cable.mesh.tuning.step.friction_rounds {
            let same = |change: f64, most: f64| {
                change <= larger(cable.mesh.tuning.step.friction_change * most, cable.meshing.bar_weight)
            };
            if !cable.contacts.renew_normal_forces(
                &cable.problem,
                &cable.mesh,
                [&unknowns.positions, &cable.motion.positions],
                same,
            ) {
                break;
            }
            let more = self.minimise_with_stick_slip(cable, unknowns)?;
            done = Converged { iterations: done.iterations + more.iterations, ..more };
        }
        Ok(done)
    }

    /// Minimises until the law of friction holds at every sliding node: stick-slip states and
    /// friction are part of the step's solution, not updated after it.
    ///
    /// All wrong stick-slip states are changed at once as long as their number falls; then one at a
    /// time (J. Júdice, F. Pires, "A block principal pivoting algorithm for large-scale strictly
    /// monotone linear complementarity problems", Computers & Operations Research 21, 1994).
    fn minimise_with_stick_slip(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        let mut done = self.minimise(cable, unknowns)?;
        let sliding = cable.mesh.sliding.iter().flatten().count();
        let mut tried = TriedExponents::default();
        let (mut fewest, mut spare) = (usize::MAX, cable.mesh.tuning.step.grip_rounds);
        for _ in 0..cable.mesh.tuning.step.grip_rounds + cable.mesh.tuning.step.grip_rounds_each * sliding {
            let nodes = if spare == 0 { ChangedNodes::One } else { ChangedNodes::All };
            let changes = update_stick_slip(cable, unknowns, nodes, Some(&mut tried));
            if changes.are_lawful() {
                return Ok(done);
            }
            if changes.wrong < fewest {
                (fewest, spare) = (changes.wrong, cable.mesh.tuning.step.grip_rounds);
            } else {
                spare = spare.saturating_sub(1);
            }
            let more = self.minimise(cable, unknowns)?;
            done = Converged { iterations: done.iterations + more.iterations, ..more };
        }
        let node = cable.mesh.sliding.iter().position(Option::is_some).unwrap_or(0);
        Err(Failure { node, residual: done.residual, cause: FailureCause::StickSlipUndecided })
    }

    /// The present unknowns.
    pub(in crate::model::fem) fn present_unknowns(&mut self, cable: &CableState) -> Unknowns {
        let mut unknowns = std::mem::take(&mut self.unknowns);
        unknowns.positions.clear();
        unknowns.positions.extend_from_slice(cable.input.begins());
        unknowns.slides.clear();
        unknowns.slides.resize(cable.mesh.nodes(), 0.0);
        unknowns
    }

    /// Minimises the potential of the step that is set up, starting from `unknowns`.
    pub(in crate::model::fem) fn minimise(
        &mut self,
        cable: &mut CableState,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        if cable.step_context().moves_freely(&unknowns.positions)
            && let Some(done) = self.free.solve(&cable.mesh, &cable.input, unknowns)
        {
            if cable.step_context().is_out_of_reach(&unknowns.positions) {
                for (k, reaction) in cable.answers.reaction.iter_mut().enumerate() {
                    *reaction = -self.free.gradient_at(k);
                }
                cable.meshing.was_contact_free = true;
                return Ok(done);
            }
            // The cable would have met something: solve again from the start, with contact.
            *unknowns = self.present_unknowns(cable);
        }
        let mut memory = match self.memory.0.take() {
            Some(m) if m.nodes() == cable.mesh.nodes() => m,
            _ => Box::new(Workspace::new(&cable.mesh).map_err(|_| Failure {
                node: 0,
                residual: f64::NAN,
                cause: FailureCause::OutOfMemory,
            })?),
        };
        memory.work_left = self.work_left;
        cable.meshing.was_contact_free = false;
        let done = memory.minimise(&cable.step_context(), unknowns);
        self.work_left = memory.work_left;
        for k in 0..cable.mesh.nodes() {
            let scale = cable.input.scale.get(k.saturating_sub(1)).copied().unwrap_or(1.0);
            cable.answers.reaction[k] = -memory.gradient_at(k) / scale;
        }
        self.memory.0 = Some(memory);
        done
    }
}
