//! Stiff cables in real time: compliant constraints in fixed small sub-steps instead of stable explicit ones.
//!
//! A spring is the constraint C = length − l₀ with compliance l₀/EA (M. Macklin, M. Müller, N. Chentanez, "XPBD:
//! position-based simulation of compliant constrained dynamics", Motion in Games, 2016), one iteration in each of many
//! sub-steps (M. Macklin et al., "Small steps in physics simulation", Symposium on Computer Animation, 2019). Unlike the
//! papers the constraints of a chain are not taken one after the other: with w the inverse masses, h the sub-step,
//!
//! ```text
//! A λ = −C,   A_ee = w_e + w_{e+1} + l₀/(EA h²),   A_{e,e+1} = −w_{e+1} t_e·t_{e+1},   Δx = w ∇C λ,   T = −λ/h²
//! ```
//!
//! is tridiagonal and solved directly, elements that would push are let go. A pulley's σ enters with its own inverse mass.
//! It is a picture, not a measurement: implicit in time, so fast motion is damped, and contacts act a sub-step late.

use super::MassSpringModel;
use super::pulley::NONE;
use crate::error::SolveError;
use crate::math::Vec2;
use crate::solution::{Warning, WarningKind};

/// Sub-step, s. Longer damps motion and softens contacts visibly, shorter costs in proportion.
const SUB_STEP: f64 = 1.0 / 600.0;
/// Fastest a node may move, m/s: no cable scene is faster, a blown-up one is.
const FASTEST: f64 = 300.0;
/// Kinetic energy over what supports and loads can have given beyond which the motion is not believed. Less damps real
/// whips, more shows the explosion first.
const MOST_ENERGY: f64 = 10.0;
/// What is left of velocities in such a sub-step.
const BRAKE: f64 = 0.7;
/// Rounds of letting go of elements that would push.
const ROUNDS: usize = 3;
/// Explicit sub-steps in a display frame of 1/60 s beyond which a step is a preview, unless asked otherwise. At 100
/// elements they take some 100 ms a simulated second.
pub(super) const MOST_SUB_STEPS: f64 = 1000.0;

/// How dynamic steps are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stepping {
    /// Explicit, or a preview where that would take more than 1000 sub-steps in 1/60 s.
    #[default]
    Auto,
    /// Always explicit.
    Explicit,
    /// Always a preview (cables with bending stiffness excepted).
    Preview,
}

/// Buffers of a sub-step.
#[derive(Default)]
struct Buffers {
    x: Vec<Vec2>,
    direction: Vec<Vec2>,
    gap: Vec<f64>,
    active: Vec<bool>,
    inverse: Vec<f64>,
    diagonal: Vec<f64>,
    lambda: Vec<f64>,
    sigma: Vec<f64>,
    stuck: Vec<bool>,
}

/// What went wrong in a step.
#[derive(Default)]
struct Trouble {
    fastest: f64,
    energy: f64,
    energy_limit: f64,
    node: usize,
}

impl MassSpringModel {
    /// Whether a dynamic step is to be a preview.
    pub(super) fn previews(&self) -> bool {
        !(self.problem.bending_stiffness > 0.0)
            && match self.stepping {
                Stepping::Explicit => false,
                Stepping::Preview => true,
                // Of even elements: a short one beside a pulley comes and goes, and a run must not change its ways.
                Stepping::Auto => {
                    let swing = (self.problem.axial_stiffness / self.problem.linear_density).sqrt();
                    self.even / swing * MOST_SUB_STEPS < 1.0 / 60.0
                }
            }
    }

    /// Advances by `dt_s` in equal sub-steps.
    pub(super) fn preview(&mut self, dt_s: f64) -> Result<(), SolveError> {
        let count = (dt_s / SUB_STEP - 1e-9).ceil().max(1.0);
        let (h, end) = (dt_s / count, self.time_s + dt_s);
        let mut buffers = Buffers::default();
        let mut trouble = Trouble::default();
        for k in 1..=count as usize {
            self.time_s = end - h * (count - k as f64);
            self.preview_step(h, &mut buffers, &mut trouble);
            if let Some(e) = self.non_finite() {
                return Err(e);
            }
        }
        self.read_forces();
        self.cost.iterations = count as usize;
        self.cost.inner_step_s = h;
        self.cost.residual_n = 0.0;
        self.warn(h, &trouble);
        Ok(())
    }

    fn preview_step(&mut self, h: f64, b: &mut Buffers, trouble: &mut Trouble) {
        if !self.pulleys.is_empty() {
            self.release_pulleys();
            self.remesh();
        }
        self.supports(h);
        self.pull_of_loads();
        let n = self.x.len();
        b.x.clear();
        b.sigma.clear();
        b.stuck.clear();
        b.sigma.extend(self.pulleys.iter().map(|p| self.s[p.node]));
        for i in 0..n {
            if !self.held[i] {
                self.v[i] += self.f[i] * (h / self.mass[i]);
            }
            b.x.push(self.x[i] + self.v[i] * h);
        }
        let body = self.problem.body_force(self.time_s);
        for k in 0..self.pulleys.len() {
            let i = self.pulleys[k].node;
            let weight = body.dot(&(self.reach(i - 1).middle - self.reach(i).middle));
            let p = &mut self.pulleys[k];
            p.rate += weight * h / p.mass;
            // What rubs holds until the tensions say otherwise.
            b.stuck.push(p.friction > 0.0);
            if p.friction == 0.0 {
                self.s[i] += p.rate * h;
            }
        }
        self.weigh_at(&b.x);
        self.project(h, b);
        for i in 0..n {
            if !self.held[i] {
                self.v[i] = (b.x[i] - self.x[i]) / h;
            }
        }
        for k in 0..self.pulleys.len() {
            let p = &mut self.pulleys[k];
            p.rate = (self.s[p.node] - b.sigma[k]) / h;
        }
        self.calm(trouble);
        self.floor_friction(h);
        self.contacts(h);
        for i in 0..n {
            self.x[i] += self.v[i] * h;
        }
        if !self.pulleys.is_empty() {
            self.weigh();
            self.load_pulleys();
        }
    }

    /// Moves the predicted nodes so that the springs balance; tensions are those that do it.
    fn project(&mut self, h: f64, b: &mut Buffers) {
        let elements = self.rest.len();
        b.direction.clear();
        b.gap.clear();
        b.active.clear();
        for e in 0..elements {
            let r = self.reach_at(e, &b.x);
            b.direction.push(r.direction);
            b.gap.push(r.length - self.rest[e]);
            b.active.push(true);
        }
        for _ in 0..ROUNDS {
            self.solve_chain(h, b);
            let mut pushing = false;
            for e in 0..elements {
                if b.active[e] && b.lambda[e] > 0.0 {
                    (b.active[e], b.lambda[e], pushing) = (false, 0.0, true);
                }
            }
            if !(pushing | self.let_slip(h, b)) {
                break;
            }
        }
        let thermal = self.problem.thermal_stretch;
        for e in 0..elements {
            let lambda = if b.lambda[e] < 0.0 || b.lambda[e].is_nan() { b.lambda[e] } else { 0.0 };
            self.tension[e] = -lambda / (h * h);
            for (i, sign) in [(e, -1.0), (e + 1, 1.0)] {
                if self.pulley_at[i] != NONE && b.stuck[self.pulley_at[i]] {
                    continue;
                }
                if self.pulley_at[i] != NONE {
                    self.s[i] -= sign * thermal * lambda / self.pulleys[self.pulley_at[i]].mass;
                } else if !self.held[i] {
                    b.x[i] += b.direction[e] * (sign * lambda / self.mass[i]);
                }
            }
        }
    }

    /// Pulleys whose tensions leave the capstan's cone slide, with its force against them; whether there are any.
    fn let_slip(&mut self, h: f64, b: &mut Buffers) -> bool {
        let mut any = false;
        for k in 0..self.pulleys.len() {
            let (p, i) = (self.pulleys[k], self.pulleys[k].node);
            let (before, after) = (-b.lambda[i - 1] / (h * h), -b.lambda[i] / (h * h));
            let most = p.grip() * (before + after);
            let pull = before - after + p.rate * p.mass / h;
            if !b.stuck[k] || pull.abs() <= most {
                continue;
            }
            (b.stuck[k], any) = (false, true);
            self.s[i] += p.rate * h - most * pull.signum() * h * h / p.mass;
            let thermal = self.problem.thermal_stretch;
            for (e, sign) in [(i - 1, 1.0), (i, -1.0)] {
                b.gap[e] -= sign * thermal * (self.s[i] - b.sigma[k]);
            }
        }
        any
    }

    /// The tridiagonal system of the active elements (L. H. Thomas' elimination).
    fn solve_chain(&self, h: f64, b: &mut Buffers) {
        let (ea, elements) = (self.problem.axial_stiffness, self.rest.len());
        let thermal = self.problem.thermal_stretch * self.problem.thermal_stretch;
        b.inverse.clear();
        for i in 0..=elements {
            b.inverse.push(match self.pulley_of(i) {
                Some(_) if b.stuck[self.pulley_at[i]] => 0.0,
                Some(p) => thermal / p.mass,
                None if self.held[i] => 0.0,
                None => 1.0 / self.mass[i],
            });
        }
        b.diagonal.clear();
        b.lambda.clear();
        for e in 0..elements {
            if !b.active[e] {
                b.diagonal.push(1.0);
                b.lambda.push(0.0);
                continue;
            }
            let (mut d, mut r) = (b.inverse[e] + b.inverse[e + 1] + self.rest[e] / (ea * h * h), -b.gap[e]);
            if e > 0 && b.active[e - 1] {
                let c = self.coupling(e, b);
                let factor = c / b.diagonal[e - 1];
                d -= factor * c;
                r -= factor * b.lambda[e - 1];
            }
            b.diagonal.push(d);
            b.lambda.push(r);
        }
        for e in (0..elements).rev() {
            if !b.active[e] {
                continue;
            }
            if e + 1 < elements && b.active[e + 1] {
                let c = self.coupling(e + 1, b);
                b.lambda[e] -= c * b.lambda[e + 1];
            }
            b.lambda[e] /= b.diagonal[e];
        }
    }

    /// A between elements `e − 1` and `e`.
    fn coupling(&self, e: usize, b: &Buffers) -> f64 {
        let turn = if self.pulley_at[e] == NONE { b.direction[e - 1].dot(&b.direction[e]) } else { 1.0 };
        -b.inverse[e] * turn
    }

    /// Holds back what runs away.
    fn calm(&mut self, trouble: &mut Trouble) {
        let (mut energy, mut mass, mut support) = (0.0, 0.0, 0.0);
        for i in 0..self.x.len() {
            let speed = self.v[i].norm();
            if speed > trouble.fastest {
                (trouble.fastest, trouble.node) = (speed, i);
            }
            if self.held[i] {
                support = if speed > support { speed } else { support };
                continue;
            }
            if speed > FASTEST {
                self.v[i] *= FASTEST / speed;
            }
            mass += self.mass[i];
            energy += 0.5 * self.mass[i] * self.v[i].norm_squared();
        }
        // What falling the whole length, being pulled as far by the loads, and twice the supports' speed can give.
        let pull = self.problem.force_scale() + self.problem.weight.norm() * self.problem.length;
        let limit = MOST_ENERGY * (pull * self.problem.length + 2.0 * mass * support * support);
        if energy > trouble.energy {
            (trouble.energy, trouble.energy_limit) = (energy, limit);
        }
        if energy > limit {
            for i in 0..self.x.len() {
                if !self.held[i] {
                    self.v[i] *= BRAKE;
                }
            }
        }
    }

    fn warn(&mut self, h: f64, trouble: &Trouble) {
        let name = &self.problem.cable.name;
        let arc_length_m = self.s.get(trouble.node).copied().unwrap_or(0.0);
        let mut say = |value: f64, limit: f64, message: String| {
            self.warnings.push(Warning::new(WarningKind::Stabilised, name, arc_length_m, [value, limit], message));
        };
        let stable = 1.0 / 60.0 / MOST_SUB_STEPS;
        if self.stepping == Stepping::Auto {
            say(
                h,
                stable,
                format!(
                    "`{name}` is too stiff for explicit steps in real time: this is a preview in steps of {h:.2e} s that damps fast motion; use fem, fewer segments or a smaller axial stiffness for figures"
                ),
            );
        }
        if trouble.fastest > FASTEST {
            say(
                trouble.fastest,
                FASTEST,
                format!("`{name}` moved at {:.0} m/s: its velocity was cut to {FASTEST} m/s", trouble.fastest),
            );
        }
        if trouble.energy > trouble.energy_limit {
            say(
                trouble.energy,
                trouble.energy_limit,
                format!(
                    "the kinetic energy of `{name}` reached {:.3e} J where supports and loads can give {:.3e} J: the motion was braked and is not to be believed",
                    trouble.energy, trouble.energy_limit
                ),
            );
        }
    }
}
