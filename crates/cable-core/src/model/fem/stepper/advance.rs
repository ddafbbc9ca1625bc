//! This module divides an `advance` into inner steps, with or without inertia, and reports it.

use super::{StepRequest, Stepper};
use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::fem::mesh::SlideOver;
use crate::model::fem::results;
use crate::model::fem::state::{Energies, MovingMass, open_collinear_folds, stored_energy};
use crate::model::fem::system::{Converged, WorkBudget};
use crate::model::smoothed_target::lag_warning;
use crate::model::tension_gauge::{TensionBefore, TensionGauge};
use crate::model::{Inertia, StepReport};
use crate::solution::{Cost, Warning, WarningCause};

/// Part of a step by which a time may exceed a whole number of steps: round-off. Smaller: one more
/// step of nearly no length; larger: steps longer than the longest.
const STEP_COUNT_ROUNDING: f64 = 1e-9;

impl Stepper {
    /// Advances time.
    ///
    /// # Errors
    /// As `Mechanics::advance`.
    pub fn advance(&mut self, dt_s: f64, inertia: Inertia, dragged: &[Option<Vec2>]) -> Result<StepReport, SolveError> {
        self.advance_gauged(dt_s, inertia, dragged, &mut TensionGauge::off())
    }

    /// As [`Self::advance`]; every inner step with inertia passes its tensions to `tension_gauge`.
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
        self.cable.check_supported()?;
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(SolveError::TimeStep { dt_s, longest_s: f64::INFINITY });
        }
        if !self.rested {
            self.settle(dragged)?;
        }
        let end = self.begin_advance(dt_s, inertia);
        if inertia == Inertia::Dynamic {
            self.begin_gauge(gauge);
            if self.time_control.sleep.lasts_until(&mut self.cable, &self.hand_drive.pulled, end, dragged) {
                self.cable.motion.time = end;
                gauge.stay(end);
                return Ok(self.report(Converged::default(), 0, 0.0));
            }
            if self.cable.motion.step_before == 0.0 && self.cable.meets_nothing() {
                open_collinear_folds(&self.cable.mesh, &mut self.cable.motion.positions);
            }
        }
        let steps = match inertia {
            Inertia::Dynamic => {
                (dt_s / self.time_control.step_size.longest_step() - STEP_COUNT_ROUNDING).ceil().max(1.0)
            }
            Inertia::QuasiStatic => self.cable.static_steps(end, dragged),
        };
        let h = dt_s / steps;
        let request = StepRequest { due: end, inertia, dragged };
        if inertia == Inertia::QuasiStatic {
            self.solver.work_left = self.solver.work_of_advance;
        }
        let mut halved = 0;
        let stepped = (0..steps as usize).try_fold(Converged::default(), |before, _| {
            let done = self.step_in_halves(h, request, &mut halved, gauge)?;
            Ok::<_, SolveError>(Converged { iterations: before.iterations + done.iterations, ..done })
        });
        self.solver.work_left = WorkBudget::Unlimited;
        let mut total = stepped?;
        self.cable.motion.time = end;
        match inertia {
            Inertia::Dynamic => total.iterations += self.end_motion(dt_s, dragged),
            Inertia::QuasiStatic => {
                total = self.polish(total, dragged);
                self.time_control.sleep.wake();
            }
        }
        Ok(self.report(total, halved, h))
    }

    /// Begins an `advance` of `dt_s` (s); returns its end time, s.
    fn begin_advance(&mut self, dt_s: f64, inertia: Inertia) -> f64 {
        self.cable.answers.lagging_supports.clear();
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
            // Without inertia supports are at the points to which they are dragged.
            Inertia::QuasiStatic => {
                self.cable.motion.hands.fill(None);
                self.cable.motion.energies = Energies::default();
            }
        }
        end
    }

    /// Gives the gauge the tensions at the start of an `advance` if it needs them.
    fn begin_gauge(&mut self, gauge: &mut TensionGauge) {
        if gauge.asks(self.cable.motion.time) {
            results::gauge_tension(&mut self.cable);
            let before = TensionBefore::of_motion(&self.cable.motion.velocities);
            gauge.begin(self.cable.motion.time, before, &self.cable.answers.gauged.arc_length, |k| {
                self.cable.answers.gauged.tension[k]
            });
        }
    }

    /// Ends an `advance` of `dt_s` (s) with inertia: chooses the size of the next steps, and puts a
    /// cable at rest to sleep. Returns the iterations that this took.
    fn end_motion(&mut self, dt_s: f64, dragged: &[Option<Vec2>]) -> usize {
        self.cable.motion.account.ends_at(self.cable.motion.time);
        self.time_control.step_size.choose(
            &self.cable.mesh.tuning.step,
            self.time_control.tolerance,
            self.cable.problem.length,
            dt_s,
        );
        if !self.time_control.sleep.falls_asleep(&self.cable) {
            return 0;
        }
        self.cable.motion.velocities.fill(Vec2::zeros());
        self.cable.motion.slide_rates.fill(0.0);
        let mut energies = self.cable.motion.energies;
        self.forget_history();
        // A trembling cable stands still in the balance about which it trembles.
        let done = self.polish(Converged::default(), dragged);
        self.time_control.sleep.note_balance(&mut self.cable, dragged);
        if self.accounts_energy {
            energies.fall_asleep(stored_energy(&self.cable));
        }
        self.cable.motion.energies = energies;
        done.iterations
    }

    /// The report of an `advance` or of a search for the equilibrium.
    pub(in crate::model::fem) fn report(&self, done: Converged, halved_steps: usize, inner_step_s: f64) -> StepReport {
        let cost = Cost { iterations: done.iterations, halved_steps, residual_n: done.residual, inner_step_s };
        let blocked = self.cable.answers.lagging_supports.iter().filter_map(|&support| self.blocked_warning(support));
        let drawn = self.cable.motion.followers.iter().enumerate().filter_map(|(k, f)| {
            let (f, node) = (f.as_ref().filter(|f| f.behind_m() > 0.0)?, self.node_of_support(k)?);
            Some(lag_warning(&self.cable.problem, k, self.cable.mesh.arc_length[node], f, self.hand_drive.hand_speed))
        });
        let warnings = blocked.chain(drawn).chain(self.hand_drive.warnings(&self.cable)).collect();
        StepReport { cost, warnings }
    }

    /// The node at a support: for a pulley the sliding node on it.
    fn node_of_support(&self, support: usize) -> Option<usize> {
        let slide_over = SlideOver::Pulley(support);
        let sliding = || self.cable.mesh.sliding.iter().position(|s| s.is_some_and(|s| s.slide_over == slide_over));
        self.cable.meshing.support_node.get(support).copied().flatten().or_else(sliding)
    }

    /// A warning of a support that an obstacle holds back from its target.
    fn blocked_warning(&self, support: usize) -> Option<Warning> {
        let (node, s) = (self.node_of_support(support)?, self.cable.problem.supports.get(support)?);
        let (problem, at) = (&self.cable.problem, self.cable.motion.positions[node]);
        let short = self.cable.input.supports.target.get(node)? - at;
        let by = problem.world.signed_gap(at, problem.length);
        let obstacle = by.map_or_else(String::new, |gap| problem.world.obstacle_name(gap.obstacle).to_owned());
        let cause = WarningCause::Blocked { support: s.name.clone(), obstacle, short_m: short.into() };
        let place = self.cable.mesh.arc_length[node];
        Some(Warning::new(cause, &problem.cable.name, place, [short.norm(), 0.0]).at(at.into()))
    }
}
