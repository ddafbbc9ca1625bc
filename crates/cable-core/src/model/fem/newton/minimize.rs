//! This solver minimises the potential of one implicit step by Newton's method, with a banded
//! factor and steps that cross no obstacle.
//!
//! ```text
//! Φ(x) = ½ Σ mᵢ a² |xᵢ − x̃ᵢ|² + E(x) − Σ fᵢ·xᵢ + Σ w B(g(x)) + Σ D(y(x))
//! ``` with a = α₀/h of the integrator and x̃ predicted by its history
//! (a = 0 for a step without inertia). If the cable can touch nothing,
//! each bar adds −½ mₑ a² |(x₂ − x₁) − (x̃₂ − x̃₁)|² (see `mass`).
//! Damping of a bar with time constant τ is a second bar of stiffness
//! EA τ a whose rest length is the predicted length.

use crate::contact::barrier::Barrier;
use crate::contact::self_contact_pairs::{SelfPair, SortedNodes};
use crate::energy::Curvature;
use crate::linalg::{BandFactor, FactorError, solve_coupled};
use crate::math::{Mat2, Vec2, larger, smaller};
use crate::model::fem::mesh::{Mesh, SlidingNode};
use crate::model::fem::newton::active_set::{Equations, PredictedContacts};
use crate::model::fem::newton::mixed_iterate::MixedIterate;
use crate::model::fem::system::contact::self_contact;
use crate::model::fem::system::{
    ContactPair, Converged, Coupling, Failure, FailureCause, SelfContactLaws, StepContext, StepInput, System, Unknowns,
    WORK_MAGNITUDE_FRACTION, WorkBudget, add_barrier, add_floor, add_friction, bar_energy, node_scale,
};

/// Round-off of the energy, relative to the sum of the magnitudes of its terms.
pub(in crate::model::fem) const ENERGY_NOISE: f64 = 1e-13;

/// Round-off of a gap, relative to the coordinates from which it is computed. Smaller: a cable
/// squeezed to a gap of 1e-7 m fails for 0.01 N in 1e6; larger: the stated accuracy of contact
/// forces is worse than the real one.
const GAP_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Relative round-off of a gap above which its force is unknown: the force of a barrier grows like
/// 1/gap. Smaller: cables squeezed by 1e6 N fail; larger: steps count as balanced by a force that
/// is round-off alone (1e13 N in one of 600 violent scenes).
const MAX_GAP_ROUNDING_FRACTION: f64 = 1e-3;

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

/// The unbalanced force at the worst node.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Residual {
    /// N.
    pub(in crate::model::fem) force: f64,
    pub(in crate::model::fem) node: usize,
    /// Its magnitude relative to the accepted force there.
    pub(in crate::model::fem) excess: f64,
    /// The greatest sum (N) of unbalanced forces along a stretch, relative to the accepted sum.
    drift: f64,
}

/// Round-off of contact forces: a gap is known only to the round-off of coordinates.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::fem) struct Rounding {
    /// Round-off of the largest force by its stiffness, N.
    pub(in crate::model::fem) noise: f64,
    /// The force (N) that opening the gap by its round-off relieves, if that exceeds the tolerance.
    /// It is zero if a gap is lost in round-off: a moving step with such a gap counted as balanced
    /// with 2e11 N of contact and nothing to hold them.
    relief: f64,
    /// True if a gap is lost in round-off.
    gap_is_lost: bool,
    /// Unbalanced force that is always accepted, N.
    tolerance: f64,
}

impl Rounding {
    /// Counts a contact with a gap (m), its stiffness (N/m), and the round-off of its gap (m).
    fn add(&mut self, barrier: &Barrier, gap: f64, stiffness: f64, rounding: f64) {
        let noise = stiffness * rounding;
        self.noise = larger(self.noise, noise);
        self.gap_is_lost |= rounding > MAX_GAP_ROUNDING_FRACTION * gap;
        if self.gap_is_lost {
            self.relief = 0.0;
        } else if noise > self.tolerance {
            // The barrier is convex, so the relief is at most this.
            self.relief = larger(self.relief, barrier.relief(gap, rounding));
        }
    }
}

/// Contacts of the cable with itself, in the minimisation.
#[derive(Debug, Default)]
pub struct SelfContactWork {
    /// Pairs of the last assembly.
    pub(in crate::model::fem) pairs: Vec<SelfPair>,
    pub(in crate::model::fem) order: SortedNodes,
    /// Entries of the Hessian outside its band.
    pub(in crate::model::fem) coupling: Coupling,
}

/// Working memory of the minimisation.
#[derive(Debug)]
pub struct Workspace {
    pub(in crate::model::fem) system: System,
    pub(in crate::model::fem) factor: BandFactor,
    pub(in crate::model::fem) direction: Vec<f64>,
    pub(in crate::model::fem) trial: Unknowns,
    /// The contacts of the last assembly.
    pub(in crate::model::fem) touches: Vec<ContactPair>,
    pub(in crate::model::fem) magnitude: f64,
    /// Round-off of contact forces in the last assembly.
    pub(in crate::model::fem) rounding: Rounding,
    /// Targets of held nodes, or the points where they were stopped, m.
    pub(in crate::model::fem) goal: Vec<Vec2>,
    pub(in crate::model::fem) self_contact: SelfContactWork,
    pub(in crate::model::fem) predicted_contacts: PredictedContacts,
    pub(in crate::model::fem) mixed: MixedIterate,
    /// Work that may still be spent, in iterations times nodes.
    pub(in crate::model::fem) work_left: WorkBudget,
}

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
    /// Allocates the memory for a mesh.
    ///
    /// # Errors `TooLarge` if there is not enough memory.
    pub fn new(mesh: &Mesh) -> Result<Self, FactorError> {
        let system = System::new(mesh);
        let factor = BandFactor::new(2 * mesh.nodes(), mesh.half_bandwidth())?;
        Ok(Self {
            direction: vec![0.0; 2 * mesh.nodes()],
            trial: Unknowns { positions: vec![Vec2::zeros(); mesh.nodes()], slides: vec![0.0; mesh.nodes()] },
            touches: Vec::with_capacity(mesh.nodes()),
            magnitude: 0.0,
            rounding: Rounding::default(),
            goal: Vec::new(),
            self_contact: SelfContactWork::default(),
            predicted_contacts: PredictedContacts::new(mesh.nodes()),
            mixed: MixedIterate::new(mesh.nodes()),
            work_left: WorkBudget::Unlimited,
            system,
            factor,
        })
    }

    /// Gradient of the last assembly, N; at a held node it is minus the force of the cable on its
    /// support.
    #[must_use]
    pub fn gradient_at(&self, node: usize) -> Vec2 {
        self.system.gradient_at(node)
    }

    /// Number of nodes for which it has memory.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.trial.positions.len()
    }

    /// Assembles Φ with its gradient and Hessian at `unknowns`; returns Φ, J.
    pub(in crate::model::fem) fn assemble(
        &mut self,
        step: &StepContext<'_>,
        unknowns: &Unknowns,
        curvature: Curvature,
    ) -> f64 {
        let StepContext { problem, mesh, contacts, input } = *step;
        let x = &unknowns.positions;
        let mut touches = std::mem::take(&mut self.touches);
        contacts.find(problem, mesh, x, &mut touches);
        let s = &mut self.system;
        s.hessian.clear();
        s.gradient.fill(0.0);
        let mut round = Rounding { tolerance: input.stopping.tolerance, ..Rounding::default() };
        // The undamped Newton does not use the energy, so its round-off is not estimated.
        let measured = self.mixed.carried.is_empty();
        let (mut value, size) = bar_energy::add_all(s, mesh, input, unknowns, curvature, &self.mixed.carried);
        self.magnitude = size;
        if !input.inertial.coupling.is_empty() {
            value += add_coupling(s, input, x);
        }
        if mesh.bending_stiffness > 0.0 {
            value += s.add_bending(mesh, x, curvature);
            if input.losses.bending > 0.0 {
                value += s.add_bends(mesh, input.losses.bending, Some(&input.supports.start), x, curvature);
            }
        }
        self.magnitude += value.abs();
        for i in 0..x.len() {
            let (k, scale) = (input.inertial.stiffness[i], node_scale(input, i));
            let (kinetic, work) = if let Some(node) = &mesh.sliding[i] {
                let away = unknowns.slides[i] - input.inertial.predicted_slide[i];
                let lightens = input.inertial.momentum_flux[i] * (node.factor - 1.0);
                s.gradient[2 * i] += scale * (k * away - lightens);
                s.hessian.add(2 * i, 2 * i, scale * k);
                (0.5 * k * away * away, lightens * unknowns.slides[i])
            } else {
                let away = x[i] - input.inertial.predicted[i];
                if measured {
                    self.magnitude +=
                        scale * WORK_MAGNITUDE_FRACTION * (k * away.norm() + input.loads.force[i].norm()) * x[i].norm();
                }
                s.add_gradient(i, (away * k - input.loads.force[i]) * scale);
                s.hessian.add_diagonal(2 * i, k * scale);
                // Work is measured from the start of the step, so that round-off is relative to its
                // change.
                (0.5 * k * away.norm_squared(), input.loads.force[i].dot(&(x[i] - input.supports.start[i])))
            };
            value += scale * (kinetic - work);
            self.magnitude += scale * (kinetic + work.abs());
        }
        for touch in &touches {
            let scale = input.scale.get(touch.node).copied().unwrap_or(node_scale(input, touch.node));
            let (energy, stiffness) = add_barrier(s, mesh, touch, scale, contacts, x, curvature);
            value += energy;
            let rounding = GAP_ROUNDING * x[touch.node].norm();
            round.add(&contacts.barrier, touch.pair.gap.gap_m, stiffness, rounding);
        }
        value += add_friction(s, mesh, input, contacts, &self.mixed.branches, x);
        value += add_floor(s, mesh, input, contacts, unknowns);
        self.touches = touches;
        if contacts.self_contacts.shape.is_on() {
            contacts.self_contacts.shape.pairs(
                x,
                &mesh.arc_length,
                contacts.barrier.reach,
                &mut self.self_contact.order,
                &mut self.self_contact.pairs,
            );
            self.self_contact.coupling.clear();
            let laws = SelfContactLaws {
                self_contacts: &contacts.self_contacts,
                barrier: &contacts.barrier,
                slip: contacts.tuning.slip_m,
            };
            let (energy, size) = self_contact::add(
                &mut self.system,
                &mut self.self_contact.coupling,
                laws,
                &self.self_contact.pairs,
                x,
                curvature,
            );
            value += energy;
            self.magnitude += size;
            for pair in &self.self_contact.pairs {
                let stiffness = contacts.barrier.at(pair.gap_m).curvature;
                round.add(&contacts.barrier, pair.gap_m, stiffness, GAP_ROUNDING * x[pair.node].norm());
            }
        }
        self.rounding = round;
        value
    }

    /// The unbalanced force (N) with the largest ratio to the accepted force, its node and that
    /// ratio. Accepted is the tolerance, or the round-off of contact forces if that is larger. At
    /// rest the unbalanced forces along a stretch are summed as well.
    pub(in crate::model::fem) fn residual(&self, mesh: &Mesh, input: &StepInput) -> Residual {
        let mut worst = Residual { force: 0.0, node: 0, excess: 0.0, drift: 0.0 };
        // During relaxation any force may be lost in round-off, because a cable laid in contact
        // begins like that; so may the force of an outline that squeezes the cable.
        let hidden = if input.inertial.moves && !input.supports.has_moving_outline {
            self.rounding.relief
        } else {
            self.rounding.noise
        };
        let known = smaller(hidden, input.stopping.max_noise);
        let accepted = larger(input.stopping.tolerance, known);
        let mut drift = Vec2::zeros();
        for node in 0..mesh.nodes() {
            if mesh.held[node] || mesh.sliding[node].as_ref().is_some_and(SlidingNode::sticks) {
                drift = Vec2::zeros();
                continue;
            }
            let left = self.system.gradient_at(node) / node_scale(input, node);
            let slides = mesh.sliding[node].is_some();
            let r = if slides { left.x.abs() } else { left.norm() };
            let mut most = worst.drift;
            let mut counts = r;
            if !input.inertial.moves {
                drift = if slides { Vec2::zeros() } else { drift + left };
                let adds_up = drift.norm() / mesh.tuning.newton.stretch_residual;
                (most, counts) = (larger(adds_up, most), larger(r, adds_up));
            }
            let excess = counts / accepted;
            if !(excess <= worst.excess) && !worst.excess.is_nan() {
                worst = Residual { force: r, node, excess, drift: most };
            }
            worst.drift = most;
        }
        worst
    }

    /// Sets `direction` to the Newton step; false if the matrix is not positive definite.
    pub(in crate::model::fem) fn solve(&mut self, mesh: &Mesh, input: &StepInput, x: &[Vec2], shift: f64) -> bool {
        let s = &mut self.system;
        for (d, g) in self.direction.iter_mut().zip(&s.gradient) {
            *d = -g;
        }
        let (rows, band) = (s.hessian.rows(), s.hessian.half_bandwidth());
        for node in 0..mesh.nodes() {
            if mesh.held[node] {
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
            if mesh.held[node] {
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
            self.self_contact.coupling.retain(|&(i, j, _)| !mesh.held[i / 2] && !mesh.held[j / 2]);
            self.predicted_contacts.keep(&self.direction);
            return solve_coupled(&s.hessian, &self.self_contact.coupling, &mut self.direction).is_ok()
                && self.direction.iter().all(|d| d.is_finite());
        }
        self.predicted_contacts.keep(&self.direction);
        if self.factor.factor_and_solve(&s.hessian, &mut self.direction).is_err() {
            self.direction.copy_from_slice(self.predicted_contacts.kept());
            return false;
        }
        self.direction.iter().all(|d| d.is_finite())
    }

    /// Minimises Φ from `unknowns`, which becomes the answer; on failure it holds the last iterate.
    ///
    /// # Errors The worst node and its unbalanced force.
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
            let left = (0..mesh.nodes()).any(|k| mesh.held[k] && self.goal[k] != unknowns.positions[k]);
            // A support that squeezes the cable beyond round-off has come as far as it can.
            let squeezed = left && input.supports.may_lag && self.rounding.noise > input.stopping.tolerance;
            if squeezed {
                self.goal.clone_from(&unknowns.positions);
            }
            let left = left && !squeezed;
            done.residual = residual;
            if excess <= 1.0 && !left {
                return Ok(done);
            }
            let enough =
                larger(residual, drift) <= mesh.tuning.newton.stalled_residual * input.stopping.tolerance && !left;
            if done.iterations >= input.stopping.max_iterations && enough {
                return Ok(done);
            }
            if done.iterations >= input.stopping.max_iterations {
                return failed(FailureCause::TooManyIterations);
            }
            if self.work_left.is_spent() {
                return failed(FailureCause::WorkSpent);
            }
            self.work_left.spend(mesh.nodes());
            done.iterations += 1;
            // Fixing the held nodes overwrites the Hessian only, so the gradient stays valid.
            if !self.solve(mesh, input, &unknowns.positions, shift) {
                let mut tries = 0;
                loop {
                    self.assemble(step, unknowns, Curvature::Clipped);
                    if self.solve(mesh, input, &unknowns.positions, shift) {
                        break;
                    }
                    shift = grow(shift, input);
                    tries += 1;
                    if tries > MAX_SHIFT_TRIES {
                        return failed(FailureCause::TangentIndefinite);
                    }
                }
            }
            if input.inertial.moves {
                self.predict_contacts(step, unknowns);
            }
            let mut slope = self.slope();
            if !(slope < 0.0) && !left {
                slope = 0.0;
            }
            match self.search(step, unknowns, Descent { value, slope, supports_move: left }) {
                Some((new_value, fraction)) => {
                    value = new_value;
                    if fraction > LONG_STEP_FRACTION {
                        shift *= SHIFT_DECREASE;
                        if shift < MIN_SHIFT_FRACTION * input.stopping.shift {
                            shift = 0.0;
                        }
                    } else if fraction < SHORT_STEP_FRACTION && input.stopping.shift > 0.0 {
                        shift = grow(shift, input);
                    }
                    if left && fraction < SHORT_PUSH_FRACTION {
                        pushes += 1;
                        if pushes > mesh.tuning.newton.max_pushes && !input.supports.may_lag {
                            return failed(FailureCause::SupportShort);
                        } else if pushes > mesh.tuning.newton.max_pushes {
                            self.goal.clone_from(&unknowns.positions);
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
        let mut fraction = self.step_bound_from_assembly(step, unknowns, whole);
        let noise = ENERGY_NOISE * (self.magnitude.abs() + value.abs());
        for _ in 0..mesh.tuning.newton.max_halvings {
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
                if mesh.held[k] && fraction == 1.0 {
                    trial.positions[k] = self.goal[k];
                }
            }
            let new_value = self.assemble(step, &trial, Curvature::Exact);
            self.trial = trial;
            let lower = new_value <= value + mesh.tuning.newton.decrease * fraction * slope + noise;
            if new_value.is_finite() && (supports_move || lower) {
                std::mem::swap(unknowns, &mut self.trial);
                return Some((new_value, fraction));
            }
            fraction *= 0.5;
        }
        None
    }
}

/// Adds gradient and Hessian of the inertia that couples nodes over the bars (see `mass`); returns
/// its energy, J.
#[inline(never)]
fn add_coupling(s: &mut System, input: &StepInput, x: &[Vec2]) -> f64 {
    let mut value = 0.0;
    for (e, (coupling, chord)) in input.inertial.coupling.iter().enumerate() {
        let (late, k) = (x[e + 1] - x[e] - chord, coupling * input.scale[e]);
        s.add_gradient(e, late * k);
        s.add_gradient(e + 1, late * -k);
        s.hessian.add_spring(2 * e, [-k, 0.0, -k]);
        value -= 0.5 * k * late.norm_squared();
    }
    value
}

fn grow(shift: f64, input: &StepInput) -> f64 {
    let least = if input.stopping.shift > 0.0 { input.stopping.shift } else { 1.0 };
    if shift > 0.0 { SHIFT_INCREASE * shift } else { least }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps counted as balanced by 1e13 N of contact at gaps of 1e-16 m.
    #[test]
    fn issue_016_a_gap_lost_in_its_rounding_hides_no_force() {
        let barrier = Barrier { reach: 1e-4, stiffness: 10.0 };
        let of = |gap: f64| {
            let mut rounding = Rounding { tolerance: 1e-4, ..Rounding::default() };
            rounding.add(&barrier, gap, barrier.at(gap).curvature, 1e-15);
            rounding
        };
        let (narrow, lost) = (of(1e-10), of(1e-13));
        assert!(narrow.relief > 0.0 && !narrow.gap_is_lost, "{narrow:?}");
        assert!(lost.gap_is_lost && lost.relief == 0.0, "{lost:?}");
    }
}
