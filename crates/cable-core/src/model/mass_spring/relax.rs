//! Where it rests: dynamic relaxation with adaptive damping.

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
        let mut last = self.f.clone();
        for sweep in 1..=MAX_SWEEPS {
            old.copy_from_slice(&self.v);
            last.copy_from_slice(&self.f);
            self.forces();
            let drag = self.critical(&last);
            for i in 0..self.x.len() {
                if !self.held[i] {
                    self.v[i] = (self.v[i] * (1.0 - drag) + self.f[i] / self.mass[i]) / (1.0 + drag);
                }
            }
            self.floor_friction(1.0);
            self.contacts(1.0);
            let (mut worst, mut node) = (0.0, 0);
            for i in 0..self.x.len() {
                self.x[i] += self.v[i];
                // With a step of 1 momentum is the force that would stop it in a sweep, and its change the force that
                // is not balanced, contacts included.
                let change = (self.v[i] - old[i]).norm();
                let speed = self.v[i].norm();
                let force = self.mass[i] * if speed > change { speed } else { change };
                if !self.held[i] && (force > worst || force.is_nan()) {
                    (worst, node) = (force, i);
                }
            }
            self.cost.iterations = sweep;
            self.cost.residual_n = worst;
            if sweep % LOOK_EVERY == 0
                && let Some(e) = self.non_finite()
            {
                return Err(e);
            }
            if worst <= tolerance {
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
        }
        Ok(())
    }

    /// Half the critical damping of the motion that is going on, a sweep: ω² = −Σ v·Δf / Σ m v² (Rayleigh's quotient with
    /// the forces' change Δf = −K v).
    fn critical(&self, last: &[Vec2]) -> f64 {
        let (mut stiff, mut inertia) = (0.0, 0.0);
        for i in 0..self.x.len() {
            if !self.held[i] {
                stiff -= self.v[i].dot(&(self.f[i] - last[i]));
                inertia += self.mass[i] * self.v[i].norm_squared();
            }
        }
        let squared = stiff / inertia;
        if squared > 0.0 { squared.min(1.0).sqrt() } else { 0.0 }
    }
}
