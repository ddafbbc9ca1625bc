//! How tension changes along a boundary while the cable slides, and how much material lies there.
//!
//! With b the load per unstretched metre, t the direction of travel, n the outward normal, λ = τ(1 + T/EA) the stretch,
//! τ = 1 + αΔT, c the radius (∞ on an edge), equilibrium of a piece of cable that is pressed by N n and rubbed by −mN t
//! (both per unstretched metre; m = +μ where it slides on along t, −μ where it slides back, 0 where it is smooth) gives
//!
//! ```text
//! N = Tλ/c − b·n,      dT/ds = −b·t + mN,      ds/dp = (dℓ/dp)/λ
//! ```
//!
//! Edge (ℓ = p): with Θ = T + T²/2EA, λ dT = τ dΘ, so τ dΘ/dp = −b·t − m b·n: Θ is exactly linear. The material is
//! ΔT/(τ dΘ/dp), which is Δp/(τ(1 + T̄/EA)) with T̄ the mean of the two end tensions: nothing cancels on a level edge.
//!
//! Arc (ℓ = cψ, p = ψ): dT/dψ = mT − (c/λ)(b·t + m b·n), and dt/dψ = −n, dn/dψ = t. With λ = λ₀ frozen it is solved by
//!
//! ```text
//! T⁰ = α b·t + β b·n + C e^{mψ},   α = 2gm/(1+m²),   β = g(m²−1)/(1+m²),   g = c/λ₀
//! ```
//!
//! and the exact T differs by −c ∫ e^{m(ψ−ξ)} (b·t + m b·n)(1/λ(T⁰) − 1/λ₀) dξ, a small part (of order cb·ΔT/EA) of a
//! small part; what this leaves out is of the order of its square over T. Material is c ∫ dψ/λ. Both by Gauss.

use super::curve::{Curve, Form, Home, Place};
use super::root::{FLOOR, crossing};
use crate::math::{GAUSS, Vec2};

/// Longest stretch of an arc taken by one rule of 5 Gauss points, rad. At 0.8 a full turn at μ = 0.5 is exact to 1e-13.
const PANEL: f64 = 0.8;

/// Load and stiffness of a cable at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Law {
    /// Load per unstretched metre, N/m.
    pub load: Vec2,
    /// τ = 1 + αΔT.
    pub thermal: f64,
    /// EA, N.
    pub stiffness: f64,
}

/// What came of a way along the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// Tension at its end, N.
    pub tension: f64,
    /// Unstretched material on it, m (negative for a way back).
    pub material: f64,
    /// ∂tension/∂(tension at its start).
    pub by_tension: f64,
    /// ∂material/∂(tension at its start), m/N.
    pub material_by_tension: f64,
}

impl Law {
    /// λ of a tension.
    pub fn stretch(&self, t: f64) -> f64 {
        self.thermal * (1.0 + t / self.stiffness)
    }

    /// Θ = T + T²/2EA of a tension.
    pub fn theta(&self, t: f64) -> f64 {
        t + 0.5 * t * t / self.stiffness
    }

    /// The tension of Θ; −EA (crushed to nothing) where there is none.
    pub fn tension(&self, theta: f64) -> f64 {
        let square = 1.0 + 2.0 * theta / self.stiffness;
        2.0 * theta / (1.0 + if square > 0.0 { square.sqrt() } else { 0.0 })
    }

    /// dT/dp at a place where it slides with m.
    pub fn slope(&self, place: &Place, t: f64, m: f64) -> f64 {
        let along = self.load.dot(&place.tangent) + m * self.load.dot(&place.normal);
        let turned = if place.turn == 0.0 { 0.0 } else { m * t };
        turned - place.stretch * along / self.stretch(t)
    }

    /// dΘ/dp on an edge.
    pub fn edge_rate(&self, place: &Place, m: f64) -> f64 {
        -(self.load.dot(&place.tangent) + m * self.load.dot(&place.normal)) / self.thermal
    }

    /// Normal force per unstretched metre times its stretch, per dp: N ds/dp, N (per metre of an edge, per radian of an
    /// arc).
    pub fn press(&self, place: &Place, t: f64) -> f64 {
        let turned = if place.turn == 0.0 { 0.0 } else { t };
        turned - self.load.dot(&place.normal) * place.stretch / self.stretch(t)
    }

    /// From x₀ on a piece, with tension `t`, to x₁.
    pub fn on_piece(&self, curve: &Curve, i: i64, (x0, x1): (f64, f64), t: f64, m: f64) -> Step {
        match curve.piece(i).form {
            Form::Edge { .. } => {
                let place = curve.place_on(i, x0);
                self.on_edge(self.edge_rate(&place, m), x1 - x0, t)
            }
            Form::Arc { radius: 0.0, .. } => {
                let grown = (m * (x1 - x0)).exp();
                Step { tension: t * grown, material: 0.0, by_tension: grown, material_by_tension: 0.0 }
            }
            Form::Arc { .. } => {
                let panels = ((x1 - x0).abs() / PANEL).ceil().max(1.0);
                let h = (x1 - x0) / panels;
                let mut sum = Step { tension: t, material: 0.0, by_tension: 1.0, material_by_tension: 0.0 };
                for k in 0..panels as usize {
                    let from = curve.place_on(i, x0 + k as f64 * h);
                    sum = sum.then(self.on_arc(&from, h, sum.tension, m));
                }
                sum
            }
        }
    }

    fn on_edge(&self, rate: f64, x: f64, t: f64) -> Step {
        let tension = self.tension(self.theta(t) + rate * x);
        let (a, b) = (1.0 + t / self.stiffness, 1.0 + tension / self.stiffness);
        let by_tension = a / b;
        let mean = 0.5 * (a + b);
        let material = x / (self.thermal * mean);
        let material_by_tension = -material / mean * (1.0 + by_tension) / (2.0 * self.stiffness);
        Step { tension, material, by_tension, material_by_tension }
    }

    fn on_arc(&self, from: &Place, h: f64, t: f64, m: f64) -> Step {
        let c = from.stretch;
        let (bt, bn) = (self.load.dot(&from.tangent), self.load.dot(&from.normal));
        let stretch0 = self.stretch(t);
        let g = c / stretch0;
        let (alpha, beta) = (2.0 * g * m / (1.0 + m * m), g * (m * m - 1.0) / (1.0 + m * m));
        let own = t - alpha * bt - beta * bn;
        // b·t, b·n, e^{mψ} and T⁰ after a turn of which (sin ψ, cos ψ, e^{mψ}) is given: t turns by −n, n by t.
        let at = |(sin, cos, grown): (f64, f64, f64)| {
            let (bt, bn) = (bt * cos - bn * sin, bn * cos + bt * sin);
            (bt, bn, grown, alpha * bt + beta * bn + own * grown)
        };
        // The nodes lie alike on both sides of the middle: three turns by themselves make all of them, and the end.
        let turn = |psi: f64| {
            let (sin, cos) = psi.sin_cos();
            (sin, cos, if m == 0.0 { 1.0 } else { (m * psi).exp() })
        };
        let on = |a: (f64, f64, f64), b: (f64, f64, f64)| (a.0 * b.1 + a.1 * b.0, a.1 * b.1 - a.0 * b.0, a.2 * b.2);
        let back = |a: (f64, f64, f64)| (-a.0, a.1, 1.0 / a.2);
        let (middle, far, near) = (turn(0.5 * h), turn((0.5 - GAUSS[0].0) * h), turn((0.5 - GAUSS[1].0) * h));
        let turns = [on(middle, back(far)), on(middle, back(near)), middle, on(middle, near), on(middle, far)];
        let (mut correction, mut material, mut by) = (0.0, 0.0, 0.0);
        for (turn, (_, weight)) in turns.into_iter().zip(GAUSS) {
            let (bt, bn, grown, t0) = at(turn);
            let stretch = self.stretch(t0);
            correction += weight * (bt + m * bn) / grown * (1.0 / stretch - 1.0 / stretch0);
            material += weight / stretch;
            by += weight * grown / (stretch * stretch);
        }
        let (_, _, grown, t0) = at(on(middle, middle));
        Step {
            tension: t0 - c * h * grown * correction,
            material: c * h * material,
            by_tension: grown,
            material_by_tension: -c * h * by * self.thermal / self.stiffness,
        }
    }
}

impl Step {
    /// This way and then another that started from where it ended.
    pub fn then(self, next: Self) -> Self {
        Self {
            tension: next.tension,
            material: self.material + next.material,
            by_tension: self.by_tension * next.by_tension,
            material_by_tension: self.material_by_tension + next.material_by_tension * self.by_tension,
        }
    }

    /// No way at all, with tension `t`.
    pub fn none(t: f64) -> Self {
        Self { tension: t, material: 0.0, by_tension: 1.0, material_by_tension: 0.0 }
    }
}

/// A chain of a boundary and what the cable on it obeys.
#[derive(Clone, Copy)]
pub(super) struct Track<'a> {
    pub curve: &'a Curve,
    pub home: Home,
    pub law: Law,
    /// μ.
    pub friction: f64,
    /// See [`Course`](super::strand::Course).
    pub drag: f64,
}

impl Track<'_> {
    /// The point at p.
    pub fn place(&self, p: f64) -> Place {
        self.curve.place(p, self.home)
    }

    /// The piece between p₀ and p₁, which lie on one.
    pub fn on(&self, p0: f64, p1: f64) -> OnPiece<'_> {
        let i = self.curve.locate(0.5 * (p0 + p1), self.home);
        OnPiece { track: self, i, origin: self.curve.origin(i), p0 }
    }

    /// Slides with m from p₀, where the tension is `t`, to p₁ (either way).
    pub fn slide(&self, p0: f64, p1: f64, t: f64, m: f64) -> Step {
        let (mut i, last) = (self.curve.locate(p0, self.home), self.curve.locate(p1, self.home));
        let (mut at, mut sum) = (p0, Step::none(t));
        loop {
            let origin = self.curve.origin(i);
            let to = match i.cmp(&last) {
                std::cmp::Ordering::Equal => p1,
                std::cmp::Ordering::Less => self.curve.origin(i + 1),
                std::cmp::Ordering::Greater => origin,
            };
            sum = sum.then(self.law.on_piece(self.curve, i, (at - origin, to - origin), sum.tension, m));
            if i == last {
                return sum;
            }
            i += if i < last { 1 } else { -1 };
            at = to;
        }
    }

    /// The m that keeps tension even where p is, as far as friction can: −b·t − m b·n = 0 on an edge; 0 on an arc.
    pub fn even(&self, p: f64) -> f64 {
        let place = self.place(p);
        let out_of = self.law.load.dot(&place.normal);
        if place.turn != 0.0 || out_of == 0.0 {
            return 0.0;
        }
        (-self.law.load.dot(&place.tangent) / out_of).clamp(-self.friction, self.friction)
    }

    /// From p₀ to p₁ (either way) with the tension as even as friction can keep it: as cable is laid down.
    pub fn lay(&self, p0: f64, p1: f64, t: f64) -> Step {
        let (mut at, mut sum) = (p0, Step::none(t));
        while at != p1 {
            let next = self.next_border(at, p1);
            sum = sum.then(self.slide(at, next, sum.tension, self.even(0.5 * (at + next))));
            at = next;
        }
        sum
    }

    /// The next place from p towards `to` where the boundary changes from edge to arc or back; `to` if none lies between.
    pub fn next_border(&self, p: f64, to: f64) -> f64 {
        let mut i = self.curve.locate(p, self.home);
        if to > p {
            // A border reached by rounding lies behind.
            while i < self.home.last {
                let border = self.curve.origin(i + 1);
                if border >= to {
                    return to;
                }
                if border > p {
                    return border;
                }
                i += 1;
            }
        } else {
            while i > self.home.first {
                let border = self.curve.origin(i);
                if border <= to {
                    return to;
                }
                if border < p {
                    return border;
                }
                i -= 1;
            }
        }
        to
    }
}

/// One piece of a track, from a point on it.
pub(super) struct OnPiece<'a> {
    track: &'a Track<'a>,
    i: i64,
    origin: f64,
    p0: f64,
}

impl OnPiece<'_> {
    /// Slides with m from its point, where the tension is `t`, to p.
    pub fn slide(&self, p: f64, t: f64, m: f64) -> Step {
        self.track.law.on_piece(self.track.curve, self.i, (self.p0 - self.origin, p - self.origin), t, m)
    }

    /// Where on the way to p₁ two tensions, each with its m, that differ at its point come to be one: on an edge both Θ are
    /// linear, round a sharp corner both T are exponential.
    pub fn crossing(&self, p1: f64, [(t, m), (u, n)]: [(f64, f64); 2]) -> f64 {
        let law = &self.track.law;
        let within = |x: f64| {
            let way = (p1 - self.p0).abs();
            // Parallel: anywhere.
            let x = if x.is_finite() { x } else { p1 - self.p0 };
            self.p0 + if x.abs() < way { x } else { p1 - self.p0 }
        };
        match self.track.curve.piece(self.i).form {
            Form::Edge { .. } => {
                let place = self.track.curve.place_on(self.i, self.p0 - self.origin);
                within((law.theta(u) - law.theta(t)) / (law.edge_rate(&place, m) - law.edge_rate(&place, n)))
            }
            Form::Arc { radius: 0.0, .. } if t * u > 0.0 => within((u / t).ln() / (m - n)),
            Form::Arc { .. } => {
                let sign = (t - u).signum();
                let end = (self.slide(p1, t, m).tension - self.slide(p1, u, n).tension) * sign;
                crossing((self.p0, p1), FLOOR * t.abs(), Some(((t - u) * sign, end)), |x| {
                    let (a, b) = (self.slide(x, t, m).tension, self.slide(x, u, n).tension);
                    let place = self.track.curve.place_on(self.i, x - self.origin);
                    ((a - b) * sign, (law.slope(&place, a, m) - law.slope(&place, b, n)) * sign)
                })
            }
        }
    }
}

#[cfg(test)]
mod tests;
