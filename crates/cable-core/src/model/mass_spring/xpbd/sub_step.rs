//! The preview moves stiff cables in real time: compliant constraints in fixed small sub-steps
//! instead of stable explicit ones.
//!
//! A spring is the constraint C = length − l₀ with compliance l₀/EA (M. Macklin, M. Müller, N.
//! Chentanez, "XPBD: position-based simulation of compliant constrained dynamics", Motion in Games,
//! 2016), one iteration in each of many sub-steps (M. Macklin et al., "Small steps in physics
//! simulation", Symposium on Computer Animation, 2019). Unlike the papers the constraints of a
//! chain are not taken one after the other but solved together (`chain`). It is a picture, not a
//! measurement: implicit in time, so fast motion is damped, and contacts act a sub-step late.
//!
//! Directions are those of the predicted place x* = 2xₙ − xₙ₋₁, so swings across a taut cable, of
//! frequency ω, obey xₙ₊₁ = (1 − ω²h²) x*, whose roots have modulus √(1 − ω²h²) up to ωh = 1 and
//! leave the unit circle at ω²h² = 4/3: taut cables take shorter sub-steps, still longer than
//! explicit ones by √(EA/T).

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::gauge::TensionGauge;
use crate::model::mass_spring::MassSpringModel;
use crate::model::mass_spring::integrator::MOST_SUB_STEPS;
use crate::model::mass_spring::xpbd::constraint_solve::Chain;
use crate::model::settings::Stepping;
use crate::solution::{Warning, WarningCause};

/// Longest sub-step, s. Longer damps motion and softens contacts visibly, shorter costs in
/// proportion.
const LONGEST_SUB_STEP_S: f64 = 1.0 / 600.0;
/// And shortest: a snap that asks for less is damped instead, for a sub-step or two.
const SHORTEST_SUB_STEP_S: f64 = LONGEST_SUB_STEP_S / 64.0;
/// Greatest ω²h² of swings across the cable: 4/3 is unstable, less costs more.
const SWING_STEP_LIMIT: f64 = 1.0;

impl MassSpringModel {
    /// Advances by `dt_s` in sub-steps.
    pub(in crate::model::mass_spring) fn preview(
        &mut self,
        dt_s: f64,
        gauge: &mut TensionGauge,
    ) -> Result<(), SolveError> {
        let end = self.clock.time_s + dt_s;
        let mut chain = Chain::default();
        let mut trouble = self.no_trouble();
        let (mut left, mut count, mut longest) = (dt_s, 0, 0.0);
        while left > 0.0 {
            let stable = (SWING_STEP_LIMIT / self.sway()).sqrt();
            let limit = if stable < LONGEST_SUB_STEP_S { stable } else { LONGEST_SUB_STEP_S };
            let parts =
                (left / if limit > SHORTEST_SUB_STEP_S { limit } else { SHORTEST_SUB_STEP_S } - 1e-9).ceil().max(1.0);
            let h = left / parts;
            left = if parts > 1.0 { left - h } else { 0.0 };
            self.clock.time_s = end - left;
            self.preview_step(h, &mut chain);
            gauge.note(self.clock.time_s, &self.chain.s, |i| self.gauged_inside(i));
            gauge.keep();
            self.calm(&mut trouble);
            self.floor_friction(h);
            self.contacts(h);
            for (x, v) in self.chain.x.iter_mut().zip(&self.chain.v) {
                *x += v * h;
            }
            if !self.wheels.pulleys.is_empty() {
                self.weigh();
                self.load_pulleys();
            }
            if let Some(e) = self.non_finite() {
                return Err(e);
            }
            count += 1;
            longest = if h > longest { h } else { longest };
        }
        self.read_forces();
        self.clock.behind_s = 0.0;
        self.report.cost.iterations = count;
        self.report.cost.inner_step_s = longest;
        self.report.cost.residual_n = 0.0;
        self.warn_of(&trouble);
        self.warn_of_preview(longest);
        Ok(())
    }

    /// ω² of the fastest swing across the cable, 1/s², by Gershgorin's circles: 2(T_b/l_b +
    /// T_a/l_a)/m at a node.
    fn sway(&self) -> f64 {
        let (mut fastest, mut before) = (0.0, 0.0);
        let held = self.drives.held.iter().zip(&self.chain.mass);
        let after = self.chain.tension.iter().zip(&self.chain.rest).map(|(tension, rest)| tension / rest).chain([0.0]);
        for ((held, mass), after) in held.zip(after) {
            let square = 2.0 * (before + after) / mass;
            if square > fastest && !held {
                fastest = square;
            }
            before = after;
        }
        fastest
    }

    /// The velocities of a sub-step, but for contacts.
    fn preview_step(&mut self, h: f64, chain: &mut Chain) {
        if !self.wheels.pulleys.is_empty() {
            self.release_pulleys();
            self.remesh();
        }
        self.supports(h);
        self.pull_of_loads();
        self.predict(h, chain);
        let hands = self.predict_hands(h, chain);
        self.project(h, chain);
        let per_step = h.recip();
        for (((v, x), to), held) in self.chain.v.iter_mut().zip(&self.chain.x).zip(&chain.x).zip(&self.drives.held) {
            if !held {
                *v = (to - x) * per_step;
            }
        }
        for (node, before) in hands {
            let v = (chain.x[node] - self.chain.x[node]) * per_step;
            self.drives.held_acceleration[node] = (v - before) * per_step;
            self.chain.v[node] = v;
        }
    }

    /// Where nodes and material go without springs.
    fn predict(&mut self, h: f64, chain: &mut Chain) {
        let count = self.chain.x.len();
        chain.x.resize(count, Vec2::zeros());
        chain.inverse.resize(count, 0.0);
        let nodes =
            self.chain.x.iter().zip(&mut self.chain.v).zip(&self.chain.f).zip(&self.chain.mass).zip(&self.drives.held);
        for (((((x, v), f), mass), held), (to, inverse)) in nodes.zip(chain.x.iter_mut().zip(&mut chain.inverse)) {
            *inverse = if *held { 0.0 } else { mass.recip() };
            if !held {
                *v += f * (h * *inverse);
            }
            *to = x + *v * h;
        }
        let body = self.problem.body_force(self.clock.time_s);
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            let weight = body.dot(&(self.reach(i - 1).middle - self.reach(i).middle));
            let p = &mut self.wheels.pulleys[k];
            p.rate += weight * h / p.mass;
        }
    }

    fn warn_of_preview(&mut self, h: f64) {
        if self.settings.stepping != Stepping::Auto {
            return;
        }
        let name = &self.problem.cable.name;
        let stable = 1.0 / 60.0 / MOST_SUB_STEPS;
        self.report.warnings.push(Warning::new(WarningCause::StiffPreview, name, 0.0, [h, stable]));
    }
}
