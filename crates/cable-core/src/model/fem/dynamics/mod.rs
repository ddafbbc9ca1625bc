//! `Dynamics` advances the state of a cable in contact: its motion, quasi-static steps and
//! equilibria.
//!
//! An advance is divided into inner steps ([`Dynamics::advance`]); one that fails is halved
//! (`halving`); a step with inertia is [`Dynamics::dynamic_step`]. Steps without inertia are in
//! `equilibrium`.

mod halving;

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::fem::mesh::SlideOver;
use crate::model::fem::newton::SolverMemory;
use crate::model::fem::obstacle::{IntersectionCheck, prepare_way};
use crate::model::fem::remesh::{Remeshed, remesh};
use crate::model::fem::results;
use crate::model::fem::state::{
    CableState, Energies, MovingMass, kinetic_energy, kinetic_energy_of_step, open_collinear_folds, stored_energy,
};
use crate::model::fem::system::{Converged, Failure, FailureCause, Unknowns, WorkBudget};
use crate::model::fem::time::{
    HandDrive, Rollback, TimeControl, Weights, account_for_step, forces_in_step, hands, keep_balanced_tensions,
    loss_memory, plastic_impact, set_inertia, work_in_step,
};
use crate::model::gauge::TensionGauge;
use crate::model::smoothed_target::held_warning;
use crate::model::{Inertia, StepReport};
use crate::solution::{CableSolution, Cost, Energy, Warning, WarningCause};

/// The request that the steps of an advance have in common.
#[derive(Clone, Copy, Debug)]
struct StepRequest<'a> {
    /// End of the advance, s: without inertia hands draw supports evenly to where they are to be
    /// then.
    due: f64,
    inertia: Inertia,
    /// The places to which supports are dragged, m.
    dragged: &'a [Option<Vec2>],
}

/// The moving cable, or the resting one where it can touch something.
#[derive(Clone, Debug)]
pub struct Dynamics {
    pub(super) cable: CableState,
    pub(super) hand_drive: HandDrive,
    pub(super) time_control: TimeControl,
    pub(super) solver: SolverMemory,
    pub(super) rollback: Rollback,
    /// True if it has come to rest, or moves from a state that did.
    pub(super) rested: bool,
    /// True if an energy account is kept.
    pub(super) accounts_energy: bool,
}

impl Dynamics {
    /// Forgets the steps before the present instant, and the frequency that was seen in them.
    pub(super) fn forget_history(&mut self) {
        self.cable.forget_history();
        self.time_control.step_size.forget();
    }

    /// Advances time.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.advance_gauged(dt_s, inertia, dragged, &mut TensionGauge::off())
    }

    /// As [`Self::advance`]; every inner step with inertia passes its tension to `gauge`.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance_gauged(
        &mut self,
        dt_s: f64,
        inertia: Inertia,
        dragged: &[Option<Vec2>],
        gauge: &mut TensionGauge,
    ) -> Result<StepReport, SolveError> {
        self.cable.refuse()?;
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(SolveError::TimeStep { dt_s, longest_s: f64::INFINITY });
        }
        if !self.rested {
            self.settle(dragged)?;
        }
        self.cable.answers.held_back.clear();
        let end = self.cable.motion.time + dt_s;
        self.time_control.due = end;
        if let (Some(outline), Some(at)) = (&mut self.cable.outline, self.cable.motion.placement) {
            outline.begin_way(self.cable.motion.time, at, end);
        }
        match inertia {
            Inertia::Dynamic => {
                let begun =
                    self.cable.motion.account.begun(self.cable.motion.time, || MovingMass::of(&self.cable).momentum());
                self.cable.motion.account = begun;
            }
            // Without inertia supports are where they are drawn to.
            Inertia::QuasiStatic => {
                self.cable.motion.hands.fill(None);
                self.cable.motion.energies = Energies::default();
            }
        }
        if inertia == Inertia::Dynamic && gauge.asks(self.cable.motion.time) {
            results::gauge_tension(&mut self.cable);
            let at_rest = self.cable.motion.velocities.iter().all(|v| *v == Vec2::zeros());
            gauge.begin(self.cable.motion.time, at_rest, &self.cable.answers.gauged.arc_length, |k| {
                self.cable.answers.gauged.tension[k]
            });
        }
        if inertia == Inertia::Dynamic
            && self.time_control.sleep.lasts_until(&mut self.cable, &self.hand_drive.pulled, end, dragged)
        {
            self.cable.motion.time = end;
            gauge.stay(end);
            return Ok(self.report(Converged::default(), 0, 0.0));
        }
        if inertia == Inertia::Dynamic && self.cable.motion.step_before == 0.0 && self.cable.meets_nothing() {
            open_collinear_folds(&self.cable.mesh, &mut self.cable.motion.positions);
        }
        let pieces = match inertia {
            Inertia::Dynamic => (dt_s / self.time_control.step_size.longest_step() - 1e-9).ceil().max(1.0),
            Inertia::QuasiStatic => self.cable.static_steps(end, dragged),
        };
        let h = dt_s / pieces;
        let request = StepRequest { due: end, inertia, dragged };
        if inertia == Inertia::QuasiStatic {
            self.solver.work_left = self.solver.work_of_advance;
        }
        let mut halved = 0;
        let stepped = (0..pieces as usize).try_fold(Converged::default(), |before, _| {
            let done = self.step_in_halves(h, request, &mut halved, gauge)?;
            Ok::<_, SolveError>(Converged { iterations: before.iterations + done.iterations, ..done })
        });
        self.solver.work_left = WorkBudget::Unlimited;
        let mut total = stepped?;
        self.cable.motion.time = end;
        if inertia == Inertia::Dynamic {
            self.cable.motion.account.ends_at(end);
            self.time_control.step_size.choose(
                &self.cable.mesh.tuning.step,
                self.time_control.tolerance,
                self.cable.problem.length,
                dt_s,
            );
            if self.time_control.sleep.falls_asleep(&self.cable) {
                self.cable.motion.velocities.fill(Vec2::zeros());
                self.cable.motion.slide_rates.fill(0.0);
                let mut energies = self.cable.motion.energies;
                energies.fall_asleep();
                self.forget_history();
                self.cable.motion.energies = energies;
            }
        } else {
            total = self.polish(total, dragged);
            self.time_control.sleep.wake();
        }
        Ok(self.report(total, halved, h))
    }

    pub(super) fn report(&self, done: Converged, halved_steps: usize, inner_step_s: f64) -> StepReport {
        let cost = Cost { iterations: done.iterations, halved_steps, residual_n: done.residual, inner_step_s };
        let node_of = |k: usize| {
            let slide_over = SlideOver::Pulley(k);
            let sliding = || self.cable.mesh.sliding.iter().position(|s| s.is_some_and(|s| s.slide_over == slide_over));
            self.cable.meshing.support_node.get(k).copied().flatten().or_else(sliding)
        };
        let held = self.cable.answers.held_back.iter().filter_map(|&k| {
            let (node, s) = (node_of(k)?, self.cable.problem.supports.get(k)?);
            let (problem, at) = (&self.cable.problem, self.cable.motion.positions[node]);
            let short = self.cable.input.supports.target.get(node)? - at;
            let by = problem.world.signed_gap(at, problem.length);
            let obstacle = by.map_or_else(String::new, |gap| problem.world.obstacle_name(gap.obstacle).to_owned());
            let cause = WarningCause::Blocked { support: s.name.clone(), obstacle, short_m: short.into() };
            let place = self.cable.mesh.arc_length[node];
            Some(Warning::new(cause, &problem.cable.name, place, [short.norm(), 0.0]).at(at.into()))
        });
        let drawn = self.cable.motion.followers.iter().enumerate().filter_map(|(k, f)| {
            let (f, node) = (f.as_ref().filter(|f| f.behind_m() > 0.0)?, node_of(k)?);
            Some(held_warning(&self.cable.problem, k, self.cable.mesh.arc_length[node], f, self.hand_drive.hand_speed))
        });
        let warnings = held.chain(drawn).chain(self.hand_drive.warnings(&self.cable)).collect();
        StepReport { cost, warnings }
    }

    /// The answer at this instant.
    #[must_use]
    pub fn solution(&self) -> CableSolution {
        results::solution(&self.cable)
    }

    /// Sets the input of a step of `h` (s); returns the weights of its history.
    pub(in crate::model::fem) fn begin_step(&mut self, h: f64, dragged: &[Option<Vec2>]) -> Weights {
        self.hand_drive.follow(&mut self.cable, self.time_control.due, h, dragged);
        let now = self.cable.motion.time;
        prepare_way(&mut self.cable, [now, now + h], Some(dragged));
        self.cable.contacts.set_slip(self.cable.contacts.tuning.slip_m);
        let contact = self.cable.contacts.tuning;
        self.cable.adapt_stiffness([contact.stiffness_rise, contact.stiffness_fall], 1.0);
        let weights = Weights::of_step(&self.cable.motion, h);
        set_inertia(&mut self.cable, weights, h, &mut self.solver.decay);
        let (m, input, mesh) = (&self.cable.motion, &self.cable.input, &self.cable.mesh);
        self.cable.contacts.list_neighbours(&self.cable.problem, mesh, &m.positions, |k| {
            if mesh.held[k] { (input.supports.target[k] - m.positions[k]).norm() } else { m.velocities[k].norm() * h }
        });
        weights
    }

    /// Moves the cable to the unknowns of a step, and its history on by that step.
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
            m.velocities[k] = v;
            m.slide_rates[k] = if mesh.sliding[k].is_some() { w } else { 0.0 };
        }
    }

    /// Begins a step of the energy account; returns the energy that the cable has.
    fn begin_energy_account(&mut self) -> Energy {
        let may_differ = self.cable.motion.step_before == 0.0 || !self.cable.meshing.never_slides;
        let mut energies = self.cable.motion.energies;
        let before = energies.begin_step(self.cable.motion.time, may_differ, || stored_energy(&self.cable));
        self.cable.motion.energies = energies;
        let motion = &self.cable.motion;
        self.solver.ways.begin(&motion.positions, &motion.velocities, &self.cable.answers.reaction);
        before
    }

    /// One step of `h` (s) with inertia.
    pub(in crate::model::fem) fn dynamic_step(
        &mut self,
        h: f64,
        dragged: &[Option<Vec2>],
    ) -> Result<Converged, Failure> {
        let before = self.accounts_energy.then(|| self.begin_energy_account());
        let weights = self.begin_step(h, dragged);
        let a = weights.rate;
        let (mut unknowns, exact) =
            (self.solver.predicted_unknowns(&self.cable, h), self.cable.input.stopping.tolerance);
        self.cable.contacts.prepare(
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
        if let Some(node) = IntersectionCheck::at(&self.cable, &unknowns.positions).pulled_corner(most) {
            return Err(Failure { node, residual: done.residual, cause: FailureCause::CornerPulls });
        }
        hands::report_held_back(&mut self.cable, &unknowns);
        hands::keep_forces(&mut self.cable, &unknowns);
        keep_balanced_tensions(&mut self.cable, &unknowns);
        let given = forces_in_step(&self.cable, &unknowns, self.solver.contacts());
        let slid = MovingMass::of(&self.cable).sliding_momentum();
        let work = before.map(|before| {
            self.solver.ways.end(&unknowns.positions);
            (before, work_in_step(&self.cable, &unknowns, &self.solver))
        });
        loss_memory::relax(&mut self.cable, h, &unknowns.positions);
        self.cable.commit_contacts(&unknowns);
        self.move_to(&unknowns, weights);
        self.cable.mesh.slide(&unknowns.slides);
        account_for_step(&mut self.cable, weights, given, slid, &unknowns.slides);
        self.solver.unknowns = unknowns;
        self.cable.motion.time += h;
        if let Some((before, work)) = &work {
            let after = match work.stored() {
                Some(rest) => Energy { kinetic_j: kinetic_energy_of_step(&self.cable, a), ..rest },
                None => stored_energy(&self.cable),
            };
            self.cable.motion.energies.add(&work.between(*before, after), after);
        }
        results::gauge_tension(&mut self.cable);
        let cable = &self.cable;
        let smooth = !cable.mesh.spread.is_lumped() && cable.answers.gauged.bars.iter().all(|tension| *tension > 0.0);
        self.cable.motion.note_step(h, smooth);
        self.time_control.step_size.observe(&self.cable, h);
        plastic_impact::land_on_obstacles(&mut self.cable, h, a, &self.solver.ways);
        plastic_impact::land_on_itself(&mut self.cable, h, a, &self.solver.ways);
        if self.accounts_energy {
            if !self.cable.meshing.was_contact_free {
                self.cable.motion.energies.land(kinetic_energy(&self.cable));
            }
            self.cable.motion.energies.end_step();
        }
        let momentum = MovingMass::of(&self.cable).momentum();
        self.cable.motion.account.close(self.cable.motion.time, momentum);
        self.cable.contacts.outline_motion = None;
        if !self.cable.meshing.never_slides {
            self.cable.answers.keeps = self.cable.motion.time >= self.time_control.due * (1.0 - f64::EPSILON);
            let changed = remesh(&mut self.cable, Inertia::Dynamic);
            if self.accounts_energy && changed != Remeshed::default() {
                self.cable.motion.energies.edit(stored_energy(&self.cable));
                self.cable.motion.energies.end_step();
            }
            self.cable.answers.keeps = false;
            self.cable.answers.stepped = self.cable.answers.kept.take();
            if let Some(node) = IntersectionCheck::of(&self.cable).crossing() {
                return Err(Failure { node, residual: done.residual, cause: FailureCause::CornerCrossed });
            }
        }
        Ok(done)
    }
}
