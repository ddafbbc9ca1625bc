//! This solver balances the preview's springs for the whole chain at once.
//!
//! With λ = −T h² (T tension, h the sub-step), w the inverse masses, t the directions and C =
//! length − l₀ at the predicted place, Δx = w ∇C λ and C + λ l₀/(EA h²) = 0 make
//!
//! ```text
//! A λ = −C,   A_ee = w_e + w_{e+1} + l₀/(EA h²),   A_{e,e+1} = −w_{e+1} t_e·t_{e+1}
//! ```
//!
//! tridiagonal; elements that would push are let go. Between the elements b before and a after a
//! pulley the material σ (mass m, thermal stretch θ) takes the place of the node: C_b = C_b⁰ − θΔσ,
//! C_a = C_a⁰ + θΔσ. Friction is Coulomb's on a round, |T_b − T_a| ≤ g (T_b + T_a), g = tanh(μφ/2),
//! sliding in the sense s = ±1 or stuck:
//!
//! ```text
//! stuck:  Δσ = 0                                  as long as |θ(T_b − T_a) + mΔσ⁰/h²| ≤ θ g (T_b + T_a)
//! slides: Δσ = Δσ⁰ + θ/m (−(λ_b − λ_a) + s g (λ_b + λ_a))   as long as s Δσ > 0
//! A_bb += θ²/m (1 − s g),  A_ba = −θ²/m (1 + s g),  A_aa += θ²/m (1 + s g),  A_ab = −θ²/m (1 − s g)
//! ```
//!
//! so the ratio of the capstan, (1 + g)/(1 − g) = e^{μφ}, holds at the end of the sub-step and not
//! a sub-step late. The tensions in g's law are those at the wheel: half an element's weight, taken
//! from the last sub-step, is added.

use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;
use crate::model::mass_spring::pulleys::pulley::Pulley;

/// Rounds of letting go of elements that would push, and of pulleys that hold or slide. In most
/// sub-steps one does; the last round stands as it is, its error is that of one sub-step.
const ROUNDS: usize = 8;

/// What the material on a pulley does in a sub-step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Grip {
    /// Friction holds it.
    #[default]
    Stuck,
    /// It slides, +1 to the side before the pulley, −1 to the side after it.
    Slides(f64),
    /// No material is left that could run through.
    Blocked,
}

/// Buffers of a sub-step.
#[derive(Default)]
pub(in crate::model::mass_spring) struct Chain {
    /// Where the nodes go.
    pub x: Vec<Vec2>,
    /// Inverse masses of the nodes, 1/kg; 0 where held.
    pub inverse: Vec<f64>,
    direction: Vec<Vec2>,
    gap: Vec<f64>,
    active: Vec<bool>,
    /// The matrix: `lower[e]` is A between rows e and e − 1, `upper[e]` between rows e − 1 and e.
    diagonal: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// The same while it is eliminated.
    pivot: Vec<f64>,
    lambda: Vec<f64>,
    grip: Vec<Grip>,
}

impl MassSpringModel {
    /// Moves the predicted nodes, and the material on pulleys, so that the springs balance;
    /// tensions are those that do it.
    pub(in crate::model::mass_spring) fn project(&mut self, h: f64, b: &mut Chain) {
        self.chain_rows(h, b);
        for _ in 0..ROUNDS {
            self.pulley_rows(h, b);
            b.solve();
            let mut changed = false;
            for e in 0..b.lambda.len() {
                if b.active[e] && b.lambda[e] > 0.0 {
                    (b.active[e], b.lambda[e], changed) = (false, 0.0, true);
                }
            }
            if !(changed | self.regrip(h, b)) {
                break;
            }
        }
        for k in 0..self.wheels.pulleys.len() {
            let p = self.wheels.pulleys[k];
            let by = self.slid(&p, b.grip[k], h, b);
            // The last round may leave one that slides against its friction: it stops.
            let by = if matches!(b.grip[k], Grip::Slides(s) if p.friction > 0.0 && s * by < 0.0) { 0.0 } else { by };
            self.chain.s[p.node] += by;
            self.wheels.pulleys[k].rate = by / h;
        }
        let per_square = -1.0 / (h * h);
        let mut before = Vec2::zeros();
        for ((((lambda, tension), direction), x), inverse) in
            b.lambda.iter().zip(&mut self.chain.tension).zip(&b.direction).zip(&mut b.x).zip(&b.inverse)
        {
            // NaN goes through to where it is found.
            let lambda = if *lambda > 0.0 { 0.0 } else { *lambda };
            *tension = lambda * per_square;
            let push = direction * lambda;
            *x += (before - push) * *inverse;
            before = push;
        }
        if let (Some(x), Some(inverse)) = (b.x.last_mut(), b.inverse.last()) {
            *x += before * *inverse;
        }
    }

    /// The system without pulleys, and the first guess of what these do.
    fn chain_rows(&mut self, h: f64, b: &mut Chain) {
        let elements = self.chain.rest.len();
        let compliance = 1.0 / (self.problem.axial_stiffness * h * h);
        b.active.clear();
        b.active.resize(elements, true);
        for list in [&mut b.gap, &mut b.diagonal, &mut b.upper] {
            list.resize(elements, 0.0);
        }
        b.direction.resize(elements, Vec2::zeros());
        let mut before = Vec2::zeros();
        let rows = b.x.windows(2).zip(b.inverse.windows(2)).zip(&self.chain.rest).zip(b.direction.iter_mut());
        let rows = rows.zip(b.gap.iter_mut()).zip(b.diagonal.iter_mut()).zip(b.upper.iter_mut());
        for ((((((x, inverse), rest), direction), gap), diagonal), upper) in rows {
            let d = x[1] - x[0];
            let length = d.norm();
            *direction = if length > 0.0 { d * length.recip() } else { Vec2::zeros() };
            *upper = -inverse[0] * before.dot(direction);
            *gap = length - rest;
            *diagonal = inverse[0] + inverse[1] + rest * compliance;
            before = *direction;
        }
        for p in &self.wheels.pulleys {
            for e in [p.node - 1, p.node] {
                b.direction[e] = self.reach_at(e, &b.x).direction;
            }
            for i in [p.node - 1, p.node + 1].into_iter().filter(|&i| i > 0 && i < elements) {
                b.upper[i] = -b.inverse[i] * b.direction[i - 1].dot(&b.direction[i]);
            }
        }
        b.lower.clone_from(&b.upper);
        b.grip.clear();
        b.grip.extend(self.wheels.pulleys.iter().map(|p| match p.rate {
            _ if p.friction == 0.0 => Grip::Slides(1.0),
            r if r > 0.0 => Grip::Slides(1.0),
            r if r < 0.0 => Grip::Slides(-1.0),
            _ => Grip::Stuck,
        }));
    }

    /// Puts what pulleys do into their rows.
    fn pulley_rows(&self, h: f64, b: &mut Chain) {
        let (theta, ea) = (self.problem.thermal_stretch, self.problem.axial_stiffness);
        for p in &self.wheels.pulleys {
            for e in [p.node - 1, p.node] {
                // Its other node, unless that is a pulley too: then what it does is added below.
                let other = if e < p.node { e } else { e + 1 };
                let inverse = if self.wheels.pulley_at[other].is_none() { b.inverse[other] } else { 0.0 };
                b.diagonal[e] = inverse + self.chain.rest[e] / (ea * h * h);
                b.gap[e] = self.reach_at(e, &b.x).length - self.chain.rest[e];
            }
        }
        for (k, p) in self.wheels.pulleys.iter().enumerate() {
            let i = p.node;
            (b.lower[i], b.upper[i]) = (0.0, 0.0);
            if let Grip::Slides(sense) = b.grip[k] {
                let (w, g) = (theta * theta / p.mass, sense * p.grip());
                b.diagonal[i - 1] += w * (1.0 - g);
                b.diagonal[i] += w * (1.0 + g);
                b.upper[i] = -w * (1.0 + g);
                b.lower[i] = -w * (1.0 - g);
                let free = self.free_way(p, sense, h);
                b.gap[i - 1] -= theta * free;
                b.gap[i] += theta * free;
            }
        }
    }

    /// Δσ⁰, m: how far the material would slide without springs, but with friction in the given
    /// sense (0: without).
    fn free_way(&self, p: &Pulley, sense: f64, h: f64) -> f64 {
        p.rate * h - sense * self.problem.thermal_stretch * p.grip() * self.beyond(p) * h * h / p.mass
    }

    /// Returns how much more the tensions at the wheel sum up to than those of the elements, N, in
    /// the last sub-step.
    fn beyond(&self, p: &Pulley) -> f64 {
        p.tension[0] + p.tension[1] - self.chain.tension[p.node - 1] - self.chain.tension[p.node]
    }

    /// Δσ, m.
    fn slid(&self, p: &Pulley, grip: Grip, h: f64, b: &Chain) -> f64 {
        let Grip::Slides(sense) = grip else { return 0.0 };
        let (before, after) = (b.lambda[p.node - 1], b.lambda[p.node]);
        let pull = (after - before) + sense * p.grip() * (before + after);
        self.free_way(p, sense, h) + self.problem.thermal_stretch / p.mass * pull
    }

    /// Lets pulleys hold or slide as their tensions say; whether any changed.
    fn regrip(&self, h: f64, b: &mut Chain) -> bool {
        let (theta, least) = (self.problem.thermal_stretch, self.least_span());
        let mut any = false;
        for (k, p) in self.wheels.pulleys.iter().enumerate() {
            let i = p.node;
            let next = match b.grip[k] {
                Grip::Stuck => {
                    let (before, after) = (-b.lambda[i - 1] / (h * h), -b.lambda[i] / (h * h));
                    let pull = theta * (before - after) + p.rate * p.mass / h;
                    let most = theta * p.grip() * (before + after + self.beyond(p));
                    if pull.abs() > most { Grip::Slides(pull.signum()) } else { Grip::Stuck }
                }
                Grip::Slides(sense) => {
                    let by = self.slid(p, b.grip[k], h, b);
                    let blocked =
                        by < 0.0 && self.chain.share[i - 1] < least || by > 0.0 && self.chain.share[i] < least;
                    if blocked {
                        Grip::Blocked
                    } else if p.friction > 0.0 && sense * by < 0.0 {
                        Grip::Stuck
                    } else {
                        b.grip[k]
                    }
                }
                Grip::Blocked => Grip::Blocked,
            };
            any |= next != b.grip[k];
            b.grip[k] = next;
        }
        any
    }
}

impl Chain {
    /// A λ = −C of the active elements (L. H. Thomas' elimination; A is diagonally dominant but for
    /// friction, whose columns sum to more than zero as g < 1).
    fn solve(&mut self) {
        let elements = self.diagonal.len();
        self.pivot.resize(elements, 0.0);
        self.lambda.resize(elements, 0.0);
        // Those let go are 0, and so is what they pass on: 1/pivot = 0.
        let (mut inverse, mut right) = (0.0, 0.0);
        let rows = self.diagonal.iter().zip(&self.lower).zip(&self.upper).zip(&self.gap).zip(&self.active);
        for (((((diagonal, lower), upper), gap), active), (pivot, lambda)) in
            rows.zip(self.pivot.iter_mut().zip(&mut self.lambda))
        {
            let factor = lower * inverse;
            (inverse, right) =
                if *active { ((diagonal - factor * upper).recip(), -gap - factor * right) } else { (0.0, 0.0) };
            (*pivot, *lambda) = (inverse, right);
        }
        let (mut after, mut next) = (0.0, 0.0);
        for ((lambda, inverse), upper) in self.lambda.iter_mut().zip(&self.pivot).zip(&self.upper).rev() {
            after = (*lambda - next * after) * inverse;
            next = *upper;
            *lambda = after;
        }
    }
}
