//! This solver minimises the potential of one implicit step by Newton's method, with a banded
//! factor and steps that cross no obstacle.
//! The potential itself is summed in `step_potential`.

use crate::energy::Curvature;
use crate::linalg::solve_coupled;
use crate::math::{Mat2, Vec2, larger};
use crate::model::fem::mesh::Mesh;
use crate::model::fem::newton::active_set::Equations;
use crate::model::fem::newton::step_potential::{ENERGY_NOISE, Residual, Workspace};
use crate::model::fem::system::{Converged, Failure, FailureCause, StepContext, StepInput, Unknowns, node_scale};
use crate::numerics::backtrack;

/// Fraction of a Newton step above which the shift falls. Smaller: it falls after steps that were
/// cut, and the next steps are cut more; larger: it is kept too long, and iterations creep. A
/// choice, tuned on no campaign, as are the five below.
const LONG_STEP_FRACTION: f64 = 0.5;

/// Fraction of a Newton step below which an existing shift grows. Smaller: iterations are spent on
/// short steps; larger: good steps are made short.
const SHORT_STEP_FRACTION: f64 = 0.1;

/// Factor of the shift after a long step. Smaller: the shift is lost at once and has to be found
/// again; larger: more iterations until the steps are Newton's.
const SHIFT_DECREASE: f64 = 0.25;

/// Factor of the shift after a short step, and where the matrix is not definite. Smaller: more
/// factorisations until it is; larger: steps shorter than they need to be.
const SHIFT_INCREASE: f64 = 4.0;

/// Fraction of the first shift below which the shift becomes 0. Smaller: a few more iterations with
/// a shift that has no effect; larger: the last iterations lose the shift while they need it.
const MIN_SHIFT_FRACTION: f64 = 1e-3;

/// Growth of the shift over the first one at which the search for a descent direction is given up.
/// Smaller: cables fail that would have found one; larger: more assemblies before a failure.
const MAX_SHIFT_GROWTH: f64 = 1e12;

/// Least first shift (N/m, times the scale of a node) from which that growth counts. Smaller and
/// larger: as for the growth.
const MIN_FIRST_SHIFT: f64 = 1e-6;

/// Maximum number of times that the shift grows until the matrix is definite: 4^40 covers all of
/// double precision. Smaller: folded cables fail; larger: nothing.
const MAX_SHIFT_TRIES: usize = 40;

/// Fraction of a step below which the push of a support counts as failed. Smaller: a stuck support
/// is pushed longer; larger: a support that still advances counts as stuck.
const SHORT_PUSH_FRACTION: f64 = 0.5;

/// The start of a line search.
#[derive(Clone, Copy, Debug)]
struct Descent {
    /// Value of Φ, J.
    value: f64,
    /// Slope of Φ along the direction, J.
    slope: f64,
    /// True if held nodes are still moving to their targets, which may raise the energy.
    supports_move: bool,
}

impl Workspace {
    /// Sets `direction` to the Newton step; false if the matrix is not positive definite.
    pub(in crate::model::fem) fn solve(&mut self, mesh: &Mesh, input: &StepInput, x: &[Vec2], shift: f64) -> bool {
        let s = &mut self.system;
        for (d, g) in self.direction.iter_mut().zip(&s.gradient) {
            *d = -g;
        }
        let (rows, band) = (s.hessian.rows(), s.hessian.half_bandwidth());
        for node in 0..mesh.nodes() {
            if mesh.fixity[node] {
                let go = self.goal[node] - x[node];
                for (k, go) in [(2 * node, go.x), (2 * node + 1, go.y)] {
                    for i in k.saturating_sub(band)..(k + band + 1).min(rows) {
                        self.direction[i] -= s.hessian.get(i, k) * go;
                    }
                    for &(i, j, v) in self.self_contact.coupling.iter().filter(|c| c.0 == k || c.1 == k) {
                        self.direction[i + j - k] -= v * go;
                    }
                }
            } else if shift > 0.0 {
                s.add_block(node, node, &(Mat2::identity() * (shift * node_scale(input, node))));
            }
        }
        for node in 0..mesh.nodes() {
            if mesh.fixity[node] {
                let go = self.goal[node] - x[node];
                for (k, go) in [(2 * node, go.x), (2 * node + 1, go.y)] {
                    s.hessian.pin(k);
                    self.direction[k] = go;
                }
            } else if let Some(sliding) = &mesh.sliding[node] {
                let first = if sliding.sticks() { 0 } else { 1 };
                for k in 2 * node + first..2 * node + 2 {
                    s.hessian.pin(k);
                    self.direction[k] = 0.0;
                }
            }
        }
        if !self.self_contact.coupling.is_empty() {
            self.self_contact.coupling.retain(|&(i, j, _)| !mesh.fixity[i / 2] && !mesh.fixity[j / 2]);
            self.predicted_contacts.keep(&self.direction);
            return solve_coupled(&s.hessian, &self.self_contact.coupling, &mut self.direction).is_ok()
                && self.direction.iter().all(|d| d.is_finite());
        }
        self.predicted_contacts.keep(&self.direction);
        if self.factor.factor_and_solve(&s.hessian, &mut self.direction).is_err() {
            self.direction.copy_from_slice(self.predicted_contacts.right_hand_side());
            return false;
        }
        self.direction.iter().all(|d| d.is_finite())
    }

    /// Minimises Φ from `unknowns`, which becomes the answer; on failure it holds the last iterate.
    ///
    /// # Errors
    /// The worst node and its unbalanced force.
    pub(in crate::model::fem) fn minimise_by_line_search(
        &mut self,
        step: &StepContext<'_>,
        unknowns: &mut Unknowns,
    ) -> Result<Converged, Failure> {
        let StepContext { mesh, input, .. } = *step;
        self.goal.clone_from(&input.supports.target);
        let mut shift = input.stopping.shift;
        let mut pushes = 0;
        let mut done = Converged::default();
        let mut value = self.assemble(step, unknowns, Curvature::Exact);
        loop {
            let Residual { force: residual, node, excess, drift } = self.residual(mesh, input);
            let failed = |cause| Err(Failure { node, residual, cause });
            if !value.is_finite() || !residual.is_finite() {
                return failed(FailureCause::EnergyNotFinite);
            }
            let supports_move = self.supports_move(mesh, input, unknowns);
            done.residual = residual;
            let stalled_residual = mesh.tuning.newton.stalled_residual * input.stopping.tolerance;
            let enough = larger(residual, drift) <= stalled_residual && !supports_move;
            let last = done.iterations >= input.stopping.max_iterations;
            if excess <= 1.0 && !supports_move || last && enough {
                return Ok(done);
            }
            if last || self.work_left.is_spent() {
                return failed(if last { FailureCause::TooManyIterations } else { FailureCause::WorkSpent });
            }
            self.work_left.spend(mesh.nodes());
            done.iterations += 1;
            if !self.find_direction(step, unknowns, &mut shift) {
                return failed(FailureCause::TangentIndefinite);
            }
            let slope = self.slope();
            let slope = if slope < 0.0 || supports_move { slope } else { 0.0 };
            match self.search(step, unknowns, Descent { value, slope, supports_move }) {
                Some((new_value, fraction)) => {
                    value = new_value;
                    shift = shift_after(fraction, shift, input);
                    if supports_move && fraction < SHORT_PUSH_FRACTION {
                        pushes += 1;
                        if pushes > mesh.tuning.newton.max_pushes && !self.stop_supports(input, unknowns) {
                            return failed(FailureCause::SupportShort);
                        }
                    }
                }
                None => {
                    // Below the round-off of the energy no step can be judged.
                    if enough {
                        return Ok(done);
                    }
                    if shift > MAX_SHIFT_GROWTH * input.stopping.shift.max(MIN_FIRST_SHIFT) {
                        return failed(FailureCause::NoDescent);
                    }
                    shift = grow(shift, input);
                    value = self.assemble(step, unknowns, Curvature::Clipped);
                }
            }
        }
    }

    /// True if held nodes are still on their way to their targets. A support that squeezes the
    /// cable beyond round-off has come as far as it can: it stops here if it may lag.
    fn supports_move(&mut self, mesh: &Mesh, input: &StepInput, unknowns: &Unknowns) -> bool {
        let moves = (0..mesh.nodes()).any(|k| mesh.fixity[k] && self.goal[k] != unknowns.positions[k]);
        let squeezed = self.rounding.noise > input.stopping.tolerance;
        moves && !(squeezed && self.stop_supports(input, unknowns))
    }

    /// Lets held nodes stay where they are if they may lag; returns whether they may.
    fn stop_supports(&mut self, input: &StepInput, unknowns: &Unknowns) -> bool {
        if input.supports.may_lag {
            self.goal.clone_from(&unknowns.positions);
        }
        input.supports.may_lag
    }

    /// Sets `direction` to a Newton step, with a greater `shift` if it needs one; false if the
    /// matrix does not become positive definite.
    fn find_direction(&mut self, step: &StepContext<'_>, unknowns: &Unknowns, shift: &mut f64) -> bool {
        // Fixing the held nodes overwrites the Hessian only, so the gradient stays valid.
        let found =
            self.solve(step.mesh, step.input, &unknowns.positions, *shift) || self.solve_shifted(step, unknowns, shift);
        if found && step.input.inertial.moves {
            self.predict_contacts(step, unknowns);
        }
        found
    }

    /// Solves without the terms of the Hessian that can be negative, and with a growing `shift`;
    /// false if the matrix does not become positive definite.
    fn solve_shifted(&mut self, step: &StepContext<'_>, unknowns: &Unknowns, shift: &mut f64) -> bool {
        let StepContext { mesh, input, .. } = *step;
        for _ in 0..=MAX_SHIFT_TRIES {
            self.assemble(step, unknowns, Curvature::Clipped);
            if self.solve(mesh, input, &unknowns.positions, *shift) {
                return true;
            }
            *shift = grow(*shift, input);
        }
        false
    }

    /// Slope of Φ along the direction, J.
    pub(in crate::model::fem) fn slope(&self) -> f64 {
        self.direction.iter().zip(&self.system.gradient).map(|(d, g)| d * g).sum()
    }

    /// Computes the direction again with predicted contacts if obstacles are in its way; returns
    /// the free fraction of it.
    pub(in crate::model::fem) fn predict_contacts(&mut self, step: &StepContext<'_>, unknowns: &Unknowns) -> f64 {
        let free = self.step_bound_from_assembly(step, unknowns, 1.0);
        if free >= step.mesh.tuning.newton.free_step_fraction {
            return free;
        }
        // The undamped Newton does not use the energy.
        let needs_descent = self.mixed.carried.is_empty();
        let downhill = if needs_descent { self.slope() } else { 0.0 };
        if needs_descent {
            self.predicted_contacts.plain.clone_from(&self.direction);
        }
        let equations =
            Equations { system: &mut self.system, factor: &mut self.factor, coupling: &mut self.self_contact.coupling };
        self.predicted_contacts.solve(step, equations, &unknowns.positions, &mut self.direction);
        if needs_descent && !(self.slope() <= step.mesh.tuning.newton.min_descent_fraction * downhill) {
            self.direction.clone_from(&self.predicted_contacts.plain);
            return free;
        }
        self.step_bound_from_assembly(step, unknowns, 1.0)
    }

    /// Moves `unknowns` along the direction as far as it is free and lowers Φ. Returns Φ and the
    /// fraction taken, where the system is assembled; None if no fraction lowers Φ.
    fn search(&mut self, step: &StepContext<'_>, unknowns: &mut Unknowns, descent: Descent) -> Option<(f64, f64)> {
        let StepContext { mesh, input, .. } = *step;
        let Descent { value, slope, supports_move } = descent;
        let n = mesh.nodes();
        let whole = self.max_step_fraction(input);
        let longest = self.step_bound_from_assembly(step, unknowns, whole);
        let noise = ENERGY_NOISE * (self.magnitude.abs() + value.abs());
        backtrack(longest, mesh.tuning.newton.max_halvings, |fraction| {
            let mut trial = std::mem::take(&mut self.trial);
            for k in 0..n {
                let moves = Vec2::new(self.direction[2 * k], self.direction[2 * k + 1]) * fraction;
                if mesh.sliding[k].is_some() {
                    trial.slides[k] = unknowns.slides[k] + moves.x;
                    trial.positions[k] = unknowns.positions[k];
                    continue;
                }
                trial.slides[k] = 0.0;
                trial.positions[k] = unknowns.positions[k] + moves;
                // A full step ends exactly on target.
                if mesh.fixity[k] && fraction == 1.0 {
                    trial.positions[k] = self.goal[k];
                }
            }
            let new_value = self.assemble(step, &trial, Curvature::Exact);
            self.trial = trial;
            let lower = new_value <= value + mesh.tuning.newton.decrease * fraction * slope + noise;
            let accepted = new_value.is_finite() && (supports_move || lower);
            accepted.then(|| {
                std::mem::swap(unknowns, &mut self.trial);
                (new_value, fraction)
            })
        })
    }
}

/// The shift after a step of which a fraction was taken: it falls after a long one, and grows after
/// a short one.
fn shift_after(fraction: f64, shift: f64, input: &StepInput) -> f64 {
    if fraction > LONG_STEP_FRACTION {
        let fallen = shift * SHIFT_DECREASE;
        if fallen < MIN_SHIFT_FRACTION * input.stopping.shift { 0.0 } else { fallen }
    } else if fraction < SHORT_STEP_FRACTION && input.stopping.shift > 0.0 {
        grow(shift, input)
    } else {
        shift
    }
}

fn grow(shift: f64, input: &StepInput) -> f64 {
    let least = if input.stopping.shift > 0.0 { input.stopping.shift } else { 1.0 };
    if shift > 0.0 { SHIFT_INCREASE * shift } else { least }
}
