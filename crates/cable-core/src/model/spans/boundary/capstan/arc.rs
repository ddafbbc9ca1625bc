//! This module has closed forms of tension and material along a stretch of an arc.
//!
//! With λ = λ₀ frozen, dT/dψ = mT − (c/λ)(b·t + m b·n) is solved by T⁰, see
//! [`capstan`](crate::model::spans::boundary::capstan). The remainder and the material are
//! integrals of functions that hardly change along a stretch, and whose derivatives at both ends
//! are known: with f = 1/λ, k = τ/EA, q = b·t + m b·n and r = dq/dψ = m b·t − b·n (dr/dψ = −q),
//!
//! ```text
//! T' = mT − c f q            T'' = mT' − c(f' q + f r)         T''' = mT'' − c(f'' q + 2 f' r − f q)
//! f' = −k f² T'              f'' = −k f² T'' + 2 f'²/f
//!
//! T = T⁰ − c ∫ G dξ,         G = e^{m(h−ξ)} q (f − f₀)         material = c ∫ f dξ
//! ```
//!
//! Both integrals use the Hermite rule that is exact to the fifth power, ∫ g = h/2 (g₀ + g₁) +
//! h²/10 (g₀' − g₁') + h³/120 (g₀'' + g₁''): a stretch costs one exponential and one rotation,
//! without points in between.

use crate::math::{exp, sin_cos};
use crate::model::spans::boundary::capstan::cable_law::{CableLaw, LocalLoad, SlideResult};

/// Longest stretch of one rule, rad: its error is h⁶/100 800 of the change of 1/λ along it, which
/// is of the order of T/EA.
const PANEL: f64 = 0.3;

/// Length (rad) up to which changes along an arc follow from its start to third order: the error is
/// its fourth power times a fraction of the tension. Larger: errors of material. Smaller: one more
/// evaluation where two tensions become equal.
pub(in crate::model::spans) const SHORT_ARC: f64 = 1e-3;

/// A path along an arc, in as many stretches as it needs.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct ArcPath {
    /// Radius, m.
    c: f64,
    count: usize,
    /// Angle of each stretch, rad, with its sine and cosine.
    h: f64,
    turn: (f64, f64),
    /// b·t and b·n at the start, N/m.
    load: [f64; 2],
}

/// Longest path along an arc, rad: 1600 turns. Smaller: drums are refused; larger: a diverging
/// Newton step takes a minute.
pub(in crate::model::spans) const MOST_TURN: f64 = 1e4;

/// Derivatives of tension and material by the angle at a point of an arc.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct Rates {
    /// dT/dψ, d²T/dψ², d³T/dψ³, N.
    pub tension: [f64; 3],
    /// Material per radian and its first two derivatives, m.
    material: [f64; 3],
    /// Derivative of the first of these by the tension at the start, m/N.
    by_tension: f64,
    m: f64,
}

impl ArcPath {
    /// The path from a place along its arc, by an angle in either direction.
    pub fn new(from: &LocalLoad, way: f64) -> Self {
        let (h, count) = if way.abs() <= PANEL {
            (way, 1)
        } else if !(way.abs() <= MOST_TURN) {
            // No cable is wound so far: Newton's method rejects the step.
            (f64::NAN, 1)
        } else {
            let panels = (way.abs() / PANEL).ceil().max(1.0);
            (way / panels, panels as usize)
        };
        let turn = if h.abs() <= SHORT_ARC { (h, 1.0) } else { sin_cos(h) };
        Self { c: from.stretch, count, h, turn, load: from.load }
    }

    /// The result of sliding along it with m from the tension `t`, and the derivatives at its end.
    pub fn slide(&self, law: &CableLaw, t: f64, m: f64) -> (SlideResult, Rates) {
        if self.h.abs() <= SHORT_ARC {
            return self.slide_short(law, t, m);
        }
        let ((sin, cos), mut load) = (self.turn, self.load);
        let grown = if m == 0.0 { 1.0 } else { exp(m * self.h) };
        let mut next_panel = |t: f64| {
            let [bt, bn] = load;
            let end = [bt * cos - bn * sin, bn * cos + bt * sin];
            let found = self.slide_panel(law, [load, end], t, m, grown);
            load = end;
            found
        };
        let (mut sum, mut rates) = next_panel(t);
        for _ in 1..self.count {
            let (step, next) = next_panel(sum.tension);
            rates = Rates { by_tension: next.by_tension * sum.by_tension, ..next };
            sum = sum.then(step);
        }
        (sum, rates)
    }

    /// As [`Self::slide`] for a path of at most `SHORT_ARC`.
    fn slide_short(&self, law: &CableLaw, t: f64, m: f64) -> (SlideResult, Rates) {
        let ((c, h), [bt, bn]) = ((self.c, self.h), self.load);
        let start = ArcPoint::new(law, c, law.thermal * law.compliance, bt + m * bn, m * bt - bn, t, m);
        let rates = start.rates(c, law.thermal * law.compliance, 1.0, m);
        let step = rates.extend(&SlideResult::none(t), h);
        let shifted = |[a, b, d]: [f64; 3]| [a + h * (b + 0.5 * h * d), b + h * d, d];
        (step, Rates { tension: shifted(rates.tension), material: shifted(rates.material), ..rates })
    }

    /// As [`Self::slide`] for one of its panels, with the loads at its start and end; `grown` =
    /// e^{mh}.
    fn slide_panel(&self, law: &CableLaw, load: [[f64; 2]; 2], t: f64, m: f64, grown: f64) -> (SlideResult, Rates) {
        let (c, h, [[bt, bn], [bt1, bn1]]) = (self.c, self.h, load);
        let k = law.thermal * law.compliance;
        let start = ArcPoint::new(law, c, k, bt + m * bn, m * bt - bn, t, m);
        let (q, r, [f, f1, f2]) = (start.q, start.r, start.f);
        // This is T⁰ at the end.
        let divided = c * f / (1.0 + m * m);
        let (alpha, beta) = (2.0 * divided * m, divided * (m * m - 1.0));
        let tension = alpha * bt1 + beta * bn1 + (t - alpha * bt - beta * bn) * grown;
        let mut end = ArcPoint::new(law, c, k, bt1 + m * bn1, m * bt1 - bn1, tension, m);
        // These are G and its derivatives at both ends.
        let (more, q1, r1) = (end.f[0] - f, end.q, end.r);
        let first = grown * q * f1;
        let first2 = grown * (2.0 * (r - m * q) * f1 + q * f2);
        let drift = r1 - m * q1;
        let last1 = drift * more + q1 * end.f[1];
        let last2 = (m * m * q1 - q1 - 2.0 * m * r1) * more + 2.0 * drift * end.f[1] + q1 * end.f[2];
        let off = -c * h * (0.5 * q1 * more + h * (0.1 * (first - last1) + h / 120.0 * (first2 + last2)));
        end.shift(off, k);
        let [g, g1, g2] = end.f;
        let material = h * (0.5 * (f + g) + h * (0.1 * (f1 - g1) + h / 120.0 * (f2 + g2)));
        // ∫ e^{mξ} f² dξ only enters the derivative for Newton's method, so the rule of the third
        // power suffices.
        let squares = [f * f, grown * g * g];
        let change = m * (squares[0] - squares[1]) + 2.0 * (f * f1 - grown * g * g1);
        let by = h * (0.5 * (squares[0] + squares[1]) + h / 12.0 * change);
        let step = SlideResult {
            tension: end.tension,
            material: c * material,
            by_tension: grown,
            material_by_tension: -c * k * by,
        };
        (step, end.rates(c, k, grown, m))
    }
}

/// A point of the path.
struct ArcPoint {
    tension: f64,
    q: f64,
    r: f64,
    /// The values f, f', f''.
    f: [f64; 3],
    /// The derivatives T', T'', T'''.
    slopes: [f64; 3],
}

impl ArcPoint {
    /// The derivatives of the tension by the angle at a point, to the third, for a tension (N) and
    /// mobilised friction `m`.
    fn new(law: &CableLaw, c: f64, k: f64, q: f64, r: f64, tension: f64, m: f64) -> Self {
        let stretch = law.stretch(tension);
        let f = 1.0 / stretch;
        let slope = m * tension - c * f * q;
        let f1 = -k * f * f * slope;
        let bend = m * slope - c * (f1 * q + f * r);
        let f2 = -k * f * f * bend + 2.0 * f1 * f1 * stretch;
        let third = m * bend - c * (f2 * q + 2.0 * f1 * r - f * q);
        Self { tension, q, r, f: [f, f1, f2], slopes: [slope, bend, third] }
    }

    /// The derivatives at this point; `grown` is the derivative of its tension by that at the
    /// start.
    fn rates(&self, c: f64, k: f64, grown: f64, m: f64) -> Rates {
        let [f, f1, f2] = self.f;
        Rates { tension: self.slopes, material: [c * f, c * f1, c * f2], by_tension: -c * k * f * f * grown, m }
    }

    /// Adds a change of tension whose square is negligible.
    fn shift(&mut self, by: f64, k: f64) {
        self.tension += by;
        self.f[0] -= k * self.f[0] * self.f[0] * by;
    }
}

impl Rates {
    /// The result extended by a short angle.
    pub fn extend(&self, way: &SlideResult, by: f64) -> SlideResult {
        let ([first, second, third], [per, change, again]) = (self.tension, self.material);
        let turn = self.m * by;
        SlideResult {
            tension: way.tension + by * (first + 0.5 * by * (second + by / 3.0 * third)),
            material: way.material + by * (per + 0.5 * by * (change + by / 3.0 * again)),
            by_tension: way.by_tension * (1.0 + turn * (1.0 + 0.5 * turn * (1.0 + turn / 3.0))),
            material_by_tension: way.material_by_tension + by * self.by_tension,
        }
    }
}
