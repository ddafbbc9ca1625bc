//! This module takes a failed step again from its start, as two steps of half the size.
//!
//! Before a step is halved, the cause of its failure may be removed: a corner that would have to
//! pull loses its sliding node, and the outline of a robot waits for a cable that cannot get out of
//! its way. A step without inertia that was halved often enough relaxes the cable to its
//! equilibrium instead.

use crate::error::{SolveError, Unsupported};
use crate::model::fem::remesh::{lifted_wheel, load_at_pulley, make_material_at_tangents};
use crate::model::fem::state::{CableState, place_released_supports, renew_input};
use crate::model::fem::stepper::{StepRequest, Stepper};
use crate::model::fem::system::{Converged, Failure, FailureCause};
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Model};

/// Remaining fraction of a step below which it is complete (round-off).
const DONE_FRACTION: f64 = 1e-9;

/// The progress of a step; times are in s.
struct HalvingProgress {
    /// The whole step.
    whole: f64,
    left: f64,
    /// Size of the next piece.
    size: f64,
    /// Number of times that it was halved.
    depth: usize,
    /// Remaining time when a motion without history began.
    began: Option<f64>,
}

impl HalvingProgress {
    /// Shortens the first piece of a motion without history.
    fn begin_motion(&mut self, first_fraction: f64) {
        if self.depth == 0 && self.left > first_fraction * self.whole {
            (self.began, self.size) = (Some(self.left), first_fraction * self.left);
        }
    }

    /// Records a completed piece; returns true if it was the last. After the first piece of a
    /// motion, each piece is as long as all before it.
    fn finish(&mut self, piece: f64) -> bool {
        self.left -= piece;
        if self.left <= DONE_FRACTION * self.whole {
            return true;
        }
        self.size = self.began.filter(|_| self.depth == 0).map_or(self.size, |b| b - self.left).min(self.left);
        false
    }
}

/// Lets the outline of the robot wait where it is; returns whether it was moving.
fn outline_waits(cable: &mut CableState) -> bool {
    let at = cable.motion.placement;
    cable.outline.as_mut().is_some_and(|outline| outline.wait_at(at))
}

impl Stepper {
    /// Takes a step of `h` (s), halved if it fails; `halved` counts the halvings.
    pub(super) fn step_in_halves(
        &mut self,
        h: f64,
        request: StepRequest<'_>,
        halved: &mut usize,
        gauge: &mut TensionGauge,
    ) -> Result<Converged, SolveError> {
        let is_dynamic = request.inertia == Inertia::Dynamic;
        let mut progress = HalvingProgress { whole: h, left: h, size: h, depth: 0, began: None };
        let mut total = Converged::default();
        loop {
            if self.cable.motion.step_before == 0.0 && is_dynamic && self.cable.meets_nothing() {
                progress.begin_motion(self.cable.mesh.tuning.step.first_fraction);
            }
            if let Some(wheel) = lifted_wheel(&self.cable).filter(|_| is_dynamic) {
                let feature = Unsupported::OffWheel { support: wheel.name.clone() };
                return Err(SolveError::Unsupported { model: Model::Fem, feature });
            }
            self.rollback.save(&self.cable);
            let start = self.cable.motion.time;
            let piece = if is_dynamic { self.cable.until_release(progress.size) } else { progress.size };
            let to = start + piece;
            let tried = match request.inertia {
                Inertia::Dynamic => self.dynamic_step(piece, request.dragged),
                Inertia::QuasiStatic => self.static_step(piece, request, progress.depth),
            };
            match tried {
                Ok(done) if self.is_finite() => {
                    if let Some((pulley, arc_length_m)) = load_at_pulley(&self.cable) {
                        let feature = Unsupported::LoadAtPulley { support: pulley.name.clone(), arc_length_m };
                        self.rollback.restore(&mut self.cable);
                        return Err(SolveError::Unsupported { model: Model::Fem, feature });
                    }
                    total = Converged { iterations: total.iterations + done.iterations, ..done };
                    if is_dynamic {
                        self.time_control.step_size.note_solved(done.iterations);
                        gauge.note(to, &self.cable.answers.gauged.arc_length, |k| self.cable.answers.gauged.tension[k]);
                        gauge.keep();
                    }
                    // Forces jump when a support releases the cable: with the history from before,
                    // BDF2 would take them into account half a step late.
                    if self.cable.problem.supports.iter().any(|s| s.holds_from(start) != s.holds_from(to)) {
                        self.cable.motion.step_before = 0.0;
                        if is_dynamic {
                            place_released_supports(&mut self.cable, [start, to]);
                        }
                    }
                    if progress.finish(piece) {
                        return Ok(total);
                    }
                }
                other => {
                    let failure = other.err().unwrap_or(Failure {
                        node: 0,
                        residual: f64::NAN,
                        cause: FailureCause::StateNotFinite,
                    });
                    self.rollback.restore(&mut self.cable);
                    if !self.recover(failure, &mut progress, request.inertia) {
                        *halved += 1;
                        self.halve(failure, &mut progress, request.inertia)?;
                    }
                }
            }
        }
    }

    /// True if all positions and velocities are finite.
    fn is_finite(&self) -> bool {
        let motion = &self.cable.motion;
        motion.positions.iter().chain(&motion.velocities).all(|p| p.iter().all(|c| c.is_finite()))
    }

    /// Takes a piece (s) of a step without inertia. After enough halvings (`depth`) it relaxes the
    /// cable, unless a corner would have to pull.
    fn static_step(&mut self, piece: f64, request: StepRequest<'_>, depth: usize) -> Result<Converged, Failure> {
        let start = self.cable.motion.time;
        let to = start + piece;
        let mut hand_targets = std::mem::take(&mut self.hand_drive.hand_targets);
        let part = piece / (request.due - start);
        self.cable.interpolate_targets(&mut hand_targets, request.dragged, part);
        self.cable.approach_edit(part);
        // The cable balances at the end of the piece, without the supports that release it on the
        // way.
        place_released_supports(&mut self.cable, [start, to]);
        let tried = self.step_without_pull(to, &hand_targets).or_else(|failure| {
            let tuning = &self.cable.mesh.tuning.equilibrium;
            if failure.cause == FailureCause::CornerPulls || depth < tuning.halvings_before_relaxation {
                return Err(failure);
            }
            self.rollback.restore(&mut self.cable);
            self.rollback.save(&self.cable);
            self.cable.approach_edit(part);
            self.cable.motion.time = start;
            place_released_supports(&mut self.cable, [start, to]);
            self.relax(to, &hand_targets)
        });
        self.hand_drive.hand_targets = hand_targets;
        tried
    }

    /// Removes the cause of a failure if that is possible without halving; returns whether it was.
    fn recover(&mut self, failure: Failure, progress: &mut HalvingProgress, inertia: Inertia) -> bool {
        let on_obstacle =
            self.cable.mesh.sliding.get(failure.node).is_some_and(|s| s.is_some_and(|s| s.feature().is_some()));
        if failure.cause == FailureCause::CornerPulls
            && on_obstacle
            && make_material_at_tangents(&mut self.cable, failure.node)
        {
            renew_input(&mut self.cable);
            return true;
        }
        // A cable that cannot get out of the robot's way stops it. Without inertia a cable that
        // finds no equilibrium may slide to one first: loose cable stopped a robot.
        let tuning = &self.cable.mesh.tuning;
        let tried = match inertia {
            Inertia::Dynamic => tuning.step.halvings_before_robot_waits,
            Inertia::QuasiStatic => tuning.equilibrium.halvings_before_relaxation,
        };
        let waits = progress.depth >= tried && outline_waits(&mut self.cable);
        if waits {
            (progress.depth, progress.size) = (0, progress.left);
        }
        waits
    }

    /// Halves the next piece, with a stiffer barrier.
    ///
    /// # Errors The failure, if the piece was halved often enough.
    fn halve(&mut self, failure: Failure, progress: &mut HalvingProgress, inertia: Inertia) -> Result<(), SolveError> {
        // The barrier may be too soft for this step.
        self.cable.adapt_stiffness([2.0, 1.0], self.cable.mesh.tuning.contact.retry_stiffening);
        progress.depth += 1;
        progress.size *= 0.5;
        if inertia == Inertia::Dynamic {
            self.time_control.step_size.note_refused(&self.cable.mesh.tuning.step, progress.size);
        } else if progress.depth == self.cable.mesh.tuning.equilibrium.halvings_before_relaxation {
            // The cable is relaxed over all the remaining time at once.
            progress.size = progress.left;
        }
        self.cable.motion.step_before = 0.0;
        let is_final = matches!(failure.cause, FailureCause::WorkSpent | FailureCause::SlidesAway);
        if !is_final && progress.depth <= self.cable.mesh.tuning.step.max_halvings {
            return Ok(());
        }
        Err(SolveError::StepFailed {
            model: Model::Fem,
            time_s: self.cable.motion.time,
            dt_s: progress.size,
            residual_n: failure.residual,
            place: self.cable.place(failure.node),
            cause: failure.cause,
        })
    }
}
