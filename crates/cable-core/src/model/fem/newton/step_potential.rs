//! The potential of one implicit step is summed here with its gradient and Hessian, and its
//! unbalanced force is compared with the accepted one.
//!
//! ```text
//! Φ(x) = ½ Σ mᵢ a² |xᵢ − x̃ᵢ|² + E(x) − Σ fᵢ·xᵢ + Σ w B(g(x)) + Σ D(y(x))
//! ```
//! with a = α₀/h of the integrator and x̃ predicted by its history (a = 0 for a step without
//! inertia). If the cable can touch nothing, each bar adds −½ mₑ a² |(x₂ − x₁) − (x̃₂ − x̃₁)|² (see
//! `mass_matrix`). Damping of a bar with time constant τ is a second bar of stiffness EA τ a whose
//! rest length is the predicted length.

use crate::contact::barrier::Barrier;
use crate::contact::self_contact_pairs::{SelfPair, SortedNodes};
use crate::energy::Curvature;
use crate::linalg::{BandFactor, FactorError};
use crate::math::{Vec2, larger, smaller};
use crate::model::fem::mesh::{Mesh, SlidingNode};
use crate::model::fem::newton::active_set::PredictedContacts;
use crate::model::fem::newton::mixed_iterate::MixedIterate;
use crate::model::fem::system::contact::self_contact;
use crate::model::fem::system::{
    Bends, ContactPair, Coupling, SelfContactLaws, StepContext, StepInput, System, Unknowns, WORK_MAGNITUDE_FRACTION,
    WorkBudget, add_barrier, add_floor, add_friction, bar_energy, node_scale,
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

/// The unbalanced force at the worst node.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Residual {
    /// Its magnitude, N.
    pub(in crate::model::fem) force: f64,
    pub(in crate::model::fem) node: usize,
    /// Its magnitude relative to the accepted force there.
    pub(in crate::model::fem) excess: f64,
    /// The greatest sum (N) of unbalanced forces along a stretch, relative to the accepted sum.
    pub(in crate::model::fem) drift: f64,
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
        let (mut value, size) = bar_energy::add_all(s, mesh, input, unknowns, curvature, &self.mixed.carried);
        self.magnitude = size;
        if !input.inertial.coupling.is_empty() {
            value += add_coupling(s, input, x);
        }
        if mesh.bending_stiffness > 0.0 {
            let bends = Bends { stiffness: mesh.bending_stiffness, scale: &input.scale, from: None };
            value += s.add_bends(mesh, bends, x, curvature);
            let ([stiffness, _], [_, unbent]) = (input.losses.bending, &input.losses.turns);
            if stiffness > 0.0 {
                value += s.add_bends(mesh, Bends { stiffness, from: Some(unbent), ..bends }, x, curvature);
            }
        }
        self.magnitude += value.abs();
        value = self.add_inertia_and_loads(step, unknowns, value);
        for touch in &touches {
            let scale = input.scale.get(touch.node).copied().unwrap_or(node_scale(input, touch.node));
            let (energy, stiffness) = add_barrier(&mut self.system, mesh, touch, scale, contacts, x, curvature);
            value += energy;
            let rounding = GAP_ROUNDING * x[touch.node].norm();
            round.add(&contacts.barrier, touch.pair.gap.gap_m, stiffness, rounding);
        }
        value += add_friction(&mut self.system, mesh, input, contacts, &self.mixed.branches, x);
        value += add_floor(&mut self.system, mesh, input, contacts, unknowns);
        self.touches = touches;
        if contacts.self_contacts.shape.is_on() {
            value += self.add_self_contact(step, x, curvature, &mut round);
        }
        self.rounding = round;
        value
    }

    /// Adds inertia and external loads of all nodes to `value` (J), gradient and Hessian; returns
    /// the sum, J.
    fn add_inertia_and_loads(&mut self, step: &StepContext<'_>, unknowns: &Unknowns, mut value: f64) -> f64 {
        let StepContext { mesh, input, .. } = *step;
        let x = &unknowns.positions;
        // The undamped Newton method does not use the energy, so its round-off is not estimated.
        let measured = self.mixed.carried.is_empty();
        for i in 0..x.len() {
            let (k, scale) = (input.inertial.stiffness[i], node_scale(input, i));
            let (kinetic, work) = if let Some(node) = &mesh.sliding[i] {
                let away = unknowns.slides[i] - input.inertial.predicted_slide[i];
                let lightens = input.inertial.momentum_flux[i] * (node.factor - 1.0);
                // Friction acts on what pulls after the mark.
                let [before, after] = input.loads.on_slide(i);
                let pull = lightens + before + after * node.factor;
                self.system.gradient[2 * i] += scale * (k * away - pull);
                self.system.hessian.add(2 * i, 2 * i, scale * k);
                (0.5 * k * away * away, pull * unknowns.slides[i])
            } else {
                let away = x[i] - input.inertial.predicted[i];
                if measured {
                    self.magnitude +=
                        scale * WORK_MAGNITUDE_FRACTION * (k * away.norm() + input.loads.force[i].norm()) * x[i].norm();
                }
                self.system.add_gradient(i, (away * k - input.loads.force[i]) * scale);
                self.system.hessian.add_diagonal(2 * i, k * scale);
                // Work is measured from the start of the step, so that round-off is relative to its
                // change.
                (0.5 * k * away.norm_squared(), input.loads.force[i].dot(&(x[i] - input.supports.start[i])))
            };
            value += scale * (kinetic - work);
            self.magnitude += scale * (kinetic + work.abs());
        }
        value
    }

    /// Adds barrier and friction of the cable on itself at `x` (m), and counts the round-off of
    /// these contacts in `round`; returns their energy, J.
    fn add_self_contact(
        &mut self,
        step: &StepContext<'_>,
        x: &[Vec2],
        curvature: Curvature,
        round: &mut Rounding,
    ) -> f64 {
        let StepContext { mesh, contacts, .. } = *step;
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
        self.magnitude += size;
        for pair in &self.self_contact.pairs {
            let stiffness = contacts.barrier.at(pair.gap_m).curvature;
            round.add(&contacts.barrier, pair.gap_m, stiffness, GAP_ROUNDING * x[pair.node].norm());
        }
        energy
    }

    /// The unbalanced force (N) with the largest ratio to the accepted force, its node and that
    /// ratio. Accepted is the tolerance, or the round-off of contact forces if that is larger. At
    /// rest the unbalanced forces along a stretch are summed as well.
    pub(in crate::model::fem) fn residual(&self, mesh: &Mesh, input: &StepInput) -> Residual {
        let mut worst = Residual { force: 0.0, node: 0, excess: 0.0, drift: 0.0 };
        // During relaxation any force may be lost in round-off, because a cable laid in contact
        // begins like that; so may the force of an outline that squeezes the cable.
        let hidden = if input.inertial.moves && !input.supports.has_moving_bodies {
            self.rounding.relief
        } else {
            self.rounding.noise
        };
        let known = smaller(hidden, input.stopping.max_noise);
        let accepted = larger(input.stopping.tolerance, known);
        let mut drift = Vec2::zeros();
        for node in 0..mesh.nodes() {
            if mesh.fixity[node] || mesh.sliding[node].as_ref().is_some_and(SlidingNode::sticks) {
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
}

/// Adds gradient and Hessian of the inertia that couples nodes over the bars (see `mass_matrix`);
/// returns its energy, J.
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
