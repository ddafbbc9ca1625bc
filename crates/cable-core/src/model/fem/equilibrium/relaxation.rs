//! This module relaxes a cable to its equilibrium against a viscous resistance that fades
//! (pseudo-transient continuation: C. T. Kelley, D. E. Keyes, *SIAM Journal on Numerical Analysis*
//! 35(2), 1998).
//!
//! Each round is a step of implicit Euler without mass, solved loosely at first. When the cable
//! hardly moves any more, its equilibrium is sought without resistance. If that fails, the rounds
//! continue, solved exactly, until the force of the resistance is negligible.

use crate::math::{Vec2, larger};
use crate::model::fem::equilibrium::lagged_friction::Lagged;
use crate::model::fem::obstacle::prepare_way;
use crate::model::fem::state::{CableState, prepare_input};
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::{Converged, Failure, FailureCause, Unknowns, load_scale};

/// Length of cable (m) whose dead loads set the first resistance.
const DEAD_LOAD_LENGTH_M: f64 = 0.1;

/// Factor of the resistance after a round in which no node moved by more than `SHORT_MOVE_M`; after
/// a longer one it stays.
const RESISTANCE_FALL: f64 = 0.6;
/// See `RESISTANCE_FALL`.
const SHORT_MOVE_M: f64 = 0.3;

/// Factor of the resistance after a round that was not solved, and the multiple of the first
/// resistance at which the relaxation is given up.
const RESISTANCE_RISE: f64 = 8.0;
/// See `RESISTANCE_RISE`.
const MAX_RESISTANCE: f64 = 1e9;

/// Factor of the resistance after a search without it that failed.
const RETURNED_RESISTANCE: f64 = 30.0;

/// Resistance, as a fraction of the first one, below which the equilibrium is sought without it.
const LEAST_RESISTANCE: f64 = 1e-5;

/// Greatest move (m) of a node in a round after which the equilibrium is sought without resistance:
/// every `SLOW_ROUNDS` rounds below the first value, and at once below the second.
const SLOW_MOVE_M: f64 = 1e-4;
/// See `SLOW_MOVE_M`.
const NO_MOVE_M: f64 = 1e-7;
/// See `SLOW_MOVE_M`.
const SLOW_ROUNDS: usize = 8;

/// Move (m) that a change of the mesh counts as.
const REMESHED_MOVE_M: f64 = 0.1;

/// Tolerance of a loosely solved round, as a multiple of that of an equilibrium.
const LOOSE_TOLERANCE: f64 = 1e2;

/// Least distance (m) that both ends move from `now` to `sought`, if it exceeds the length (m) of
/// the cable.
pub(super) fn moved_away(length: f64, now: &[Vec2], sought: &[Vec2]) -> Option<f64> {
    let moved = |a: Option<&Vec2>, b: Option<&Vec2>| Some((a? - b?).norm());
    let way = moved(sought.first(), now.first())?.min(moved(sought.last(), now.last())?);
    (way > length).then_some(way)
}

/// The motion in a round, and the force of the resistance to it.
struct RoundMotion {
    /// Greatest move of a node, m.
    moved: f64,
    /// Greatest force of the resistance, N, which adds up along a creeping stretch.
    resists: f64,
    /// The node where that force is greatest.
    slowest: usize,
}

/// The progress of a relaxation.
struct Relaxation {
    resistance: f64,
    /// The first resistance, N/m.
    first: f64,
    /// True once the search without resistance has failed: then rounds are solved exactly.
    exact_rounds: bool,
    /// Newton iterations so far.
    iterations: usize,
}

impl Relaxation {
    /// The resistance that a relaxation begins with, N/m: the weight of a bar over its sag, or dead
    /// loads where these are greater. With the weight alone a cable of 5 g/m under 100 N whose
    /// route led through a post was thrown about and did not come to rest.
    fn first_resistance(cable: &CableState) -> f64 {
        let whole = load_scale(&cable.problem).1 / cable.meshing.even_bars as f64;
        if whole > cable.mesh.tuning.equilibrium.dead_load_weights * cable.meshing.bar_weight {
            whole / DEAD_LOAD_LENGTH_M
        } else {
            cable.meshing.soft_shift()
        }
    }

    fn begin(cable: &CableState) -> Self {
        let first = Self::first_resistance(cable);
        Self { resistance: first, first, exact_rounds: false, iterations: 0 }
    }

    /// True if the equilibrium is to be sought without resistance after this round.
    fn is_nearly_over(&self, round: usize, moved: f64) -> bool {
        self.resistance < LEAST_RESISTANCE * self.first
            || (moved < SLOW_MOVE_M && round % SLOW_ROUNDS == SLOW_ROUNDS - 1)
            || moved < NO_MOVE_M
    }

    /// Goes on, with exact rounds, after a search without resistance that failed.
    fn go_on_exactly(&mut self) {
        self.exact_rounds = true;
        self.resistance = (self.resistance.max(LEAST_RESISTANCE * self.first) * RETURNED_RESISTANCE).min(self.first);
    }
}

impl Stepper {
    /// Relaxes the cable, then finds its equilibrium. During relaxation any contact force may be
    /// lost in round-off, because a cable that is laid in contact begins like that. If no
    /// equilibrium is found, the limit on that force is lowered.
    pub(in crate::model::fem) fn relax(&mut self, to: f64, dragged: &[Option<Vec2>]) -> Result<Converged, Failure> {
        let outer_rollback = self.rollback.with_saved();
        self.rollback.save(&self.cable);
        let squeezed = self.cable.mesh.tuning.equilibrium.squeezed_residual;
        let mut found = self.relax_within(f64::INFINITY, to, dragged);
        if found.is_err_and(|f| {
            f.cause != FailureCause::WorkSpent && f.residual > squeezed * self.cable.input.stopping.tolerance
        }) {
            self.rollback.restore(&mut self.cable);
            found = self.relax_within(squeezed, to, dragged);
        }
        self.rollback = outer_rollback;
        found
    }

    /// As [`Self::relax`]; `noise` is the greatest force, in tolerances, that may be lost in
    /// round-off during relaxation.
    fn relax_within(&mut self, noise: f64, to: f64, dragged: &[Option<Vec2>]) -> Result<Converged, Failure> {
        // Stretches of cable in the way of the moving outline are moved aside before anything
        // slides.
        prepare_way(&mut self.cable, [to, to], Some(dragged))?;
        self.cable.motion.positions.clone_from_slice(self.cable.input.begins());
        self.cable.contacts.body_motions.clear();
        let begun_at = self.cable.motion.positions.clone();
        let mut relaxation = Relaxation::begin(&self.cable);
        let mut last = Failure { node: 0, residual: f64::NAN, cause: FailureCause::StillMoves };
        for round in 0..self.cable.mesh.tuning.equilibrium.max_relaxation_steps {
            let (unknowns, solved) = self.solve_round(&relaxation, noise, to, dragged);
            let found = match solved {
                Ok(found) => found,
                Err(failure) if failure.cause == FailureCause::WorkSpent => return Err(failure),
                Err(failure) => {
                    last = failure;
                    relaxation.resistance *= RESISTANCE_RISE;
                    if relaxation.resistance > MAX_RESISTANCE * relaxation.first {
                        return Err(failure);
                    }
                    continue;
                }
            };
            relaxation.iterations += found.done.iterations;
            let RoundMotion { mut moved, resists, slowest } = self.motion_in_round(&unknowns);
            let residual = found.done.residual + resists;
            last = Failure { node: slowest, residual, cause: FailureCause::StillMoves };
            let remeshed = self.accept_rest(&unknowns, self.cable.motion.time);
            if moved_away(self.cable.problem.length, &self.cable.motion.positions, &begun_at).is_some() {
                return Err(Failure { node: 0, residual: f64::NAN, cause: FailureCause::SlidesAway });
            }
            let exact = self.cable.input.stopping.tolerance;
            let squeezed = self.cable.mesh.tuning.equilibrium.squeezed_residual;
            if remeshed {
                moved = moved.max(REMESHED_MOVE_M);
            } else if relaxation.exact_rounds
                && found.is_lawful(&self.cable)
                && resists <= exact
                && found.done.residual <= squeezed * exact
            {
                self.cable.motion.time = to;
                return Ok(Converged { iterations: relaxation.iterations, residual });
            }
            relaxation.resistance *= if moved < SHORT_MOVE_M { RESISTANCE_FALL } else { 1.0 };
            if relaxation.is_nearly_over(round, moved) {
                match self.quasi_static_step(to, dragged) {
                    Ok(done) => {
                        return Ok(Converged { iterations: relaxation.iterations + done.iterations, ..done });
                    }
                    Err(failure) if failure.cause == FailureCause::WorkSpent => return Err(failure),
                    Err(failure) => {
                        last = failure;
                        relaxation.go_on_exactly();
                    }
                }
            }
        }
        Err(last)
    }

    /// Solves a round; returns the unknowns at its end, whether or not they are a solution.
    fn solve_round(
        &mut self,
        relaxation: &Relaxation,
        noise: f64,
        to: f64,
        dragged: &[Option<Vec2>],
    ) -> (Unknowns, Result<Lagged, Failure>) {
        prepare_input(&mut self.cable, to, Some(dragged));
        self.cable.adapt_slip();
        let even = self.cable.problem.length / self.cable.meshing.even_bars as f64;
        self.cable.input.inertial.stiffness.fill(relaxation.resistance);
        for k in 0..self.cable.mesh.nodes() {
            self.cable.input.inertial.stiffness[k] *= self.cable.mesh.tributary_length(k) / even;
        }
        let exact = self.cable.input.stopping.tolerance;
        self.cable.input.stopping.tolerance = if relaxation.exact_rounds { exact } else { LOOSE_TOLERANCE * exact };
        self.cable.input.stopping.max_noise = noise * exact;
        // The contacts of a first shape carry no normal force yet. Without renewing it, the cable
        // would slide without friction.
        let mut unknowns = self.solver.present_unknowns(&self.cable);
        let rounds = self.cable.mesh.tuning.equilibrium.whole_lag_rounds;
        let solved = self.solver.solve_rounds(&mut self.cable, &mut unknowns, rounds);
        self.cable.input.stopping.tolerance = exact;
        (unknowns, solved)
    }

    /// The motion from the present positions to the unknowns of a round.
    fn motion_in_round(&self, unknowns: &Unknowns) -> RoundMotion {
        let mut motion = RoundMotion { moved: 0.0, resists: 0.0, slowest: 0 };
        let mut drift = Vec2::zeros();
        for (k, (a, b)) in unknowns.positions.iter().zip(&self.cable.motion.positions).enumerate() {
            let moved = (a - b).norm().max(unknowns.slides[k].abs());
            motion.moved = motion.moved.max(moved);
            let free = if self.cable.mesh.fixity[k] { 0.0 } else { self.cable.input.inertial.stiffness[k] };
            drift = if free > 0.0 { drift + (a - b) * free } else { Vec2::zeros() };
            let force = larger(moved * free, drift.norm() / self.cable.mesh.tuning.newton.stretch_residual);
            if force > motion.resists {
                (motion.resists, motion.slowest) = (force, k);
            }
        }
        motion
    }
}
