//! This module takes a step with inertia: it predicts, minimises, accepts and accounts for it.

use super::Stepper;
use crate::math::Vec2;
use crate::model::Inertia;
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::{Remeshed, StretchedBars, remesh_after_step};
use crate::model::fem::results;
use crate::model::fem::state::{MovingMass, kinetic_energy, kinetic_energy_of_step, stored_energy};
use crate::model::fem::system::{Converged, Failure, FailureCause, Unknowns};
use crate::model::fem::time::{
    Weights, account_for_step, forces_in_step, forget_slack_impulses, hands, keep_balanced_tensions, loss_memory,
    plastic_impact, remember_impulses, set_inertia, work_in_step,
};
use crate::solution::Energy;

/// The start of a step, for the accounts of energy and momentum.
struct AtStart {
    /// Its energy, if an account of energy is kept.
    energy: Option<Energy>,
    /// Momentum of the material on pulleys and on rounds of obstacles, kg m/s.
    slid: [Vec2; 2],
}

impl Stepper {
    /// Takes one step of `h` (s) with inertia.
    pub(in crate::model::fem) fn dynamic_step(
        &mut self,
        h: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<Converged, Failure> {
        self.cable.follow_edit(h);
        let before = self.accounts_energy.then(|| self.begin_energy_account());
        // Taken before `begin_step`, which puts pulleys that move at the end of the step.
        let slid = MovingMass::of(&self.cable).sliding_momentum();
        let weights = self.begin_step(h, dragged)?;
        let predicted = self.solver.predicted_unknowns(&self.cable, h);
        let (mut unknowns, mut done) = self.minimise_step(predicted)?;
        if forget_slack_impulses(&mut self.cable, weights, &unknowns.positions) {
            set_inertia(&mut self.cable, weights, h, &mut self.solver.decay);
            let first = done.iterations;
            (unknowns, done) = self.minimise_step(unknowns)?;
            done.iterations += first;
        }
        self.accept_step(unknowns, weights, h, AtStart { energy: before, slid });
        self.remove_rebounds(weights, h);
        self.remesh_after_step(done.residual)?;
        Ok(done)
    }

    /// Minimises the incremental potential of a step, from the unknowns that are predicted.
    ///
    /// # Errors The reason why no minimum was found, or `CornerPulls` if a corner or a wheel would
    /// have to pull.
    fn minimise_step(&mut self, mut unknowns: Unknowns) -> Result<(Unknowns, Converged), Failure> {
        let exact = self.cable.input.stopping.tolerance;
        self.cable.contacts.prepare_step(
            &self.cable.problem,
            &self.cable.mesh,
            &unknowns.positions,
            &self.cable.motion.positions,
        );
        self.cable.input.stopping.tolerance = self.cable.input.rounded_tolerance(&self.cable.motion.positions);
        let done = self.solver.minimise_with_friction(&mut self.cable, &mut unknowns);
        self.cable.input.stopping.tolerance = exact;
        let done = done?;
        let most = self.cable.mesh.tuning.remesh.max_reverse_turn_rad;
        let check = IntersectionCheck::at(&self.cable, &unknowns.positions);
        if let Some(node) = check.pulled_corner(most).or_else(|| check.pulled_wheel(most)) {
            return Err(Failure { node, residual: done.residual, cause: FailureCause::CornerPulls });
        }
        Ok((unknowns, done))
    }

    /// Accepts the unknowns of a step of `h` (s) as the state of the cable, and accounts for
    /// momentum and energy.
    fn accept_step(&mut self, unknowns: Unknowns, weights: Weights, h: f64, start: AtStart) {
        hands::report_lagging_supports(&mut self.cable, &unknowns);
        hands::keep_forces(&mut self.cable, &unknowns);
        keep_balanced_tensions(&mut self.cable, &unknowns);
        let given = forces_in_step(&self.cable, &unknowns, self.solver.contacts());
        let work = start.energy.map(|before| {
            self.solver.ways.end(&unknowns.positions);
            (before, work_in_step(&self.cable, &unknowns, &self.solver))
        });
        loss_memory::relax(&mut self.cable, h, &unknowns);
        self.cable.commit_contacts(&unknowns);
        self.move_to(&unknowns, weights);
        self.cable.mesh.slide(&unknowns.slides);
        account_for_step(&mut self.cable, weights, given, start.slid, &unknowns.slides);
        self.solver.unknowns = unknowns;
        self.cable.motion.time += h;
        if let Some((before, work)) = &work {
            let after = match work.stored() {
                Some(rest) => Energy { kinetic_j: kinetic_energy_of_step(&self.cable, weights.rate), ..rest },
                None => stored_energy(&self.cable),
            };
            self.cable.motion.energies.add(&work.between(*before, after), after);
        }
        results::gauge_tension(&mut self.cable);
        remember_impulses(&mut self.cable, weights);
        let cable = &self.cable;
        let smooth = !cable.mesh.spread.is_lumped() && cable.answers.gauged.bars.iter().all(|tension| *tension > 0.0);
        self.cable.motion.note_step(h, smooth);
        self.time_control.step_size.observe(&self.cable, h);
    }

    /// Makes the collisions of a step of `h` (s) perfectly inelastic, and closes its accounts.
    fn remove_rebounds(&mut self, weights: Weights, h: f64) {
        plastic_impact::land_on_obstacles(&mut self.cable, h, weights.rate, &self.solver.ways);
        plastic_impact::land_on_itself(&mut self.cable, h, weights.rate, &self.solver.ways);
        if self.accounts_energy {
            if !self.cable.meshing.was_contact_free {
                self.cable.motion.energies.land(kinetic_energy(&self.cable));
            }
            self.cable.motion.energies.end_step();
        }
        let momentum = MovingMass::of(&self.cable).momentum();
        self.cable.motion.account.close(self.cable.motion.time, momentum);
        self.cable.contacts.body_motions.clear();
    }

    /// Adapts the mesh after a step of a cable that can have sliding nodes.
    ///
    /// # Errors `CornerCrossed` if the changed mesh runs through an obstacle.
    fn remesh_after_step(&mut self, residual: f64) -> Result<(), Failure> {
        if self.cable.meshing.never_slides {
            return Ok(());
        }
        self.cable.answers.keeps = self.cable.motion.time >= self.time_control.due * (1.0 - f64::EPSILON);
        // A stiff cable is never slack: where nodes come and go, its bars keep their tension.
        let before = (!self.cable.mesh.is_flexible()).then(|| StretchedBars::of(&self.cable));
        let changed = remesh_after_step(&mut self.cable, Inertia::Dynamic);
        if let Some(before) = before.filter(|_| changed != Remeshed::default()) {
            before.restore(&mut self.cable);
        }
        if self.accounts_energy && changed != Remeshed::default() {
            self.cable.motion.energies.edit(stored_energy(&self.cable));
            self.cable.motion.energies.end_step();
        }
        self.cable.answers.keeps = false;
        self.cable.answers.stepped = self.cable.answers.stored_answer.take();
        match IntersectionCheck::of(&self.cable).crossing() {
            Some(node) => Err(Failure { node, residual, cause: FailureCause::CornerCrossed }),
            None => Ok(()),
        }
    }

    /// Moves the cable to the unknowns of a step, and its history by that step.
    fn move_to(&mut self, unknowns: &Unknowns, weights: Weights) {
        let Weights { now, past, rate: a, .. } = weights;
        let (m, mesh) = (&mut self.cable.motion, &self.cable.mesh);
        for k in 0..unknowns.positions.len() {
            let v = (unknowns.positions[k] - weights.place(m, k)) * a;
            let s = mesh.arc_length[k];
            let w = (s + unknowns.slides[k] - s * now + m.previous_arc_length[k] * past) * a;
            if let (Some(x), Some(v)) = (m.older_positions.get_mut(k), m.older_velocities.get_mut(k)) {
                (*x, *v) = (m.previous_positions[k], m.previous_velocities[k]);
            }
            m.previous_positions[k] = m.positions[k];
            m.previous_velocities[k] = m.velocities[k];
            m.previous_arc_length[k] = s;
            m.previous_slide_rates[k] = m.slide_rates[k];
            m.positions[k] = unknowns.positions[k];
            m.velocities[k] = if mesh.sliding[k].is_some() { Vec2::zeros() } else { v };
            m.slide_rates[k] = if mesh.sliding[k].is_some() { w } else { 0.0 };
        }
        for &(k, velocity) in &self.cable.input.supports.wheel_velocities {
            m.velocities[k] = velocity;
        }
    }

    /// Begins a step of the energy account; returns the energy of the cable.
    fn begin_energy_account(&mut self) -> Energy {
        let motion = &self.cable.motion;
        let may_differ = motion.step_before == 0.0 || self.cable.changes() || !self.cable.meshing.never_slides;
        let mut energies = self.cable.motion.energies;
        let before = energies.begin_step(self.cable.motion.time, may_differ, || stored_energy(&self.cable));
        self.cable.motion.energies = energies;
        let motion = &self.cable.motion;
        self.solver.ways.begin(&motion.positions, &motion.velocities, &self.cable.answers.reaction);
        before
    }
}
