//! Where it rests: dynamic relaxation with kinetic damping.

use super::MassSpringModel;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::Model;

/// Unbalanced force at rest, of the force scale.
const RESIDUAL: f64 = 1e-6;
/// Most sweeps: 60 elements of a stiff cable take 2e4 to 2e5, about 1 µs an element each 10.
const MAX_SWEEPS: usize = 400_000;
/// Sweeps between two looks at the whole state.
const LOOK_EVERY: usize = 64;
/// Fictitious mass over the stable one: 1 is the limit for springs that neither slacken nor turn. With 1.3 springs going
/// slack and taut every few sweeps pumped the motion up without end; more is slower.
const MASS_FACTOR: f64 = 4.0;

impl MassSpringModel {
    /// Time is fictitious, with a step of 1: a node of stiffness k is stable with mass above k/4; a chain's greatest
    /// eigenvalue is at most twice the sum of its two springs, so m = ½·(k₁ + k₂)·factor.
    pub(super) fn relax(&mut self) -> Result<(), SolveError> {
        let real = self.mass.clone();
        let damping = std::mem::replace(&mut self.damping_time_s, 0.0);
        let ea = self.problem.axial_stiffness;
        for i in 0..self.mass.len() {
            let stiffness = |e: Option<usize>| e.and_then(|e| self.rest.get(e)).map_or(0.0, |l| ea / l);
            self.mass[i] = 0.5 * MASS_FACTOR * (stiffness(i.checked_sub(1)) + stiffness(Some(i)));
        }
        self.v.fill(Vec2::zeros());
        self.place_supports();
        let found = self.sweeps();
        self.mass = real;
        self.damping_time_s = damping;
        self.v.fill(Vec2::zeros());
        self.forces();
        found
    }

    fn sweeps(&mut self) -> Result<(), SolveError> {
        let tolerance = RESIDUAL * self.problem.force_scale();
        let mut old = self.v.clone();
        let mut energy = 0.0;
        for sweep in 1..=MAX_SWEEPS {
            old.copy_from_slice(&self.v);
            self.forces();
            for i in 0..self.x.len() {
                if !self.held[i] {
                    self.v[i] += self.f[i] / self.mass[i];
                }
            }
            self.floor_friction(1.0);
            self.contacts(1.0);
            let (mut worst, mut node, mut now, mut fastest) = (0.0, 0, 0.0, 0.0);
            for i in 0..self.x.len() {
                // The unbalanced force is what changed the momentum, contact impulses included.
                let force = (self.v[i] - old[i]).norm() * self.mass[i];
                if !self.held[i] && (force > worst || force.is_nan()) {
                    (worst, node) = (force, i);
                }
                now += 0.5 * self.mass[i] * self.v[i].norm_squared();
                // With a step of 1 momentum is the force that would stop it in a sweep.
                let momentum = self.mass[i] * self.v[i].norm();
                if !self.held[i] && (momentum > fastest || momentum.is_nan()) {
                    fastest = momentum;
                }
                self.x[i] += self.v[i];
            }
            self.cost.iterations = sweep;
            self.cost.residual_n = worst;
            if sweep % LOOK_EVERY == 0
                && let Some(e) = self.non_finite()
            {
                return Err(e);
            }
            if worst <= tolerance && fastest <= tolerance {
                self.cost.inner_step_s = 0.0;
                return self.non_finite().map_or(Ok(()), Err);
            }
            if sweep == MAX_SWEEPS {
                return Err(SolveError::NotConverged {
                    model: Model::MassSpring,
                    iterations: sweep,
                    residual_n: worst,
                    node,
                    at_m: self.x[node],
                });
            }
            // Past a peak of the kinetic energy the motion goes uphill: stop it there.
            if now < energy {
                self.v.fill(Vec2::zeros());
                now = 0.0;
            }
            energy = now;
        }
        Ok(())
    }
}
