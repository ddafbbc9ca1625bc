//! This module integrates the tension of a cable that slides along a boundary, and the material
//! that lies there.
//!
//! Let b be the load per unstretched metre, t the direction of travel, n the outward normal, λ =
//! τ(1 + T/EA) the stretch, τ = 1 + αΔT, and c the radius (∞ on an edge). A piece of cable with the
//! normal force N n and the friction −mN t (both per unstretched metre; m = +μ if it slides along
//! t, −μ if it slides back, 0 without friction) is in equilibrium if
//!
//! ```text
//! N = Tλ/c − b·n,      dT/ds = −b·t + mN,      ds/dp = (dℓ/dp)/λ
//! ```
//!
//! Edge (ℓ = p): with Θ = T + T²/2EA, λ dT = τ dΘ, so τ dΘ/dp = −b·t − m b·n: Θ is exactly linear.
//! The material is ΔT/(τ dΘ/dp), which is Δp/(τ(1 + T̄/EA)) with T̄ the mean of the two end
//! tensions: no digits cancel on a level edge.
//!
//! Arc (ℓ = cψ, p = ψ): dT/dψ = mT − (c/λ)(b·t + m b·n), and dt/dψ = −n, dn/dψ = t. With λ = λ₀
//! frozen it is solved by
//!
//! ```text
//! T⁰ = α b·t + β b·n + C e^{mψ},   α = 2gm/(1+m²),   β = g(m²−1)/(1+m²),   g = c/λ₀
//! ```
//!
//! and the exact T differs by −c ∫ e^{m(ψ−ξ)} (b·t + m b·n)(1/λ(T⁰) − 1/λ₀) dξ, which is small (of
//! order cb·ΔT/EA); the remaining error is of the order of its square over T. The material is c ∫
//! dψ/λ. Both are in `arc`.

use crate::math::{Vec2, bounded, exp, perp};
use crate::model::spans::boundary::arc::{ArcPath, MOST_TURN};
use crate::model::spans::boundary::curve::{BoundaryPoint, ChainRange, Curve};
use crate::model::spans::boundary::segment_cursor::{CachedPiece, SegmentCursor};

/// Load and stiffness of a cable at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct CableLaw {
    /// Load per unstretched metre, N/m.
    pub load: Vec2,
    /// τ = 1 + αΔT.
    pub thermal: f64,
    /// EA, N.
    pub stiffness: f64,
    /// 1/EA, 1/N.
    pub compliance: f64,
}

/// The values of a boundary point that the law needs.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct LocalLoad {
    /// d(length)/dp, m.
    pub stretch: f64,
    /// True on an arc.
    pub turns: bool,
    /// b·t and b·n, N/m.
    pub load: [f64; 2],
}

/// Result of an integration along the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct SlideResult {
    /// Tension at its end, N.
    pub tension: f64,
    /// Unstretched material on it, m (negative for a backward path).
    pub material: f64,
    /// ∂tension/∂(tension at its start).
    pub by_tension: f64,
    /// ∂material/∂(tension at its start), m/N.
    pub material_by_tension: f64,
}

impl CableLaw {
    /// The law with a load per metre (N/m), τ and EA (N).
    pub fn new(load: Vec2, thermal: f64, stiffness: f64) -> Self {
        Self { load, thermal, stiffness, compliance: 1.0 / stiffness }
    }

    /// The stretch λ of a tension.
    pub fn stretch(&self, t: f64) -> f64 {
        self.thermal * (1.0 + t * self.compliance)
    }

    /// Θ = T + T²/2EA of a tension.
    pub fn theta(&self, t: f64) -> f64 {
        t + 0.5 * t * t * self.compliance
    }

    /// The tension for Θ; −EA (a length of zero) if there is none.
    pub fn tension(&self, theta: f64) -> f64 {
        let square = 1.0 + 2.0 * theta * self.compliance;
        2.0 * theta / (1.0 + if square > 0.0 { square.sqrt() } else { 0.0 })
    }

    /// The values of a place that the law needs.
    pub fn local_load(&self, place: &BoundaryPoint) -> LocalLoad {
        let load = [self.load.dot(&place.tangent), self.load.dot(&place.normal)];
        LocalLoad { stretch: place.stretch, turns: place.turn != 0.0, load }
    }

    /// dT/dp at a place where the cable slides with m.
    pub fn slope(&self, place: &BoundaryPoint, t: f64, m: f64) -> f64 {
        self.slope_at(&self.local_load(place), t, m)
    }

    /// As [`Self::slope`].
    pub fn slope_at(&self, local_load: &LocalLoad, t: f64, m: f64) -> f64 {
        let turned = if local_load.turns { m * t } else { 0.0 };
        turned - local_load.stretch * (local_load.load[0] + m * local_load.load[1]) / self.stretch(t)
    }

    /// dΘ/dp on an edge.
    pub fn edge_rate(&self, local_load: &LocalLoad, m: f64) -> f64 {
        -(local_load.load[0] + m * local_load.load[1]) / self.thermal
    }

    /// Normal force per unstretched metre times its stretch, per dp: N ds/dp, N (per metre of an
    /// edge, per radian of an arc).
    pub fn press(&self, place: &BoundaryPoint, t: f64) -> f64 {
        let turned = if place.turn == 0.0 { 0.0 } else { t };
        turned - self.load.dot(&place.normal) * place.stretch / self.stretch(t)
    }

    /// The result of sliding by a distance `way` along the piece of a place, from the tension `t`.
    pub fn along(&self, from: &LocalLoad, way: f64, t: f64, m: f64) -> SlideResult {
        if !from.turns {
            return self.on_edge(self.edge_rate(from, m), way, t);
        }
        if from.stretch == 0.0 {
            let grown = exp(m * way);
            return SlideResult { tension: t * grown, material: 0.0, by_tension: grown, material_by_tension: 0.0 };
        }
        ArcPath::new(from, way).slide(self, t, m).0
    }

    fn on_edge(&self, rate: f64, x: f64, t: f64) -> SlideResult {
        let tension = self.tension(self.theta(t) + rate * x);
        let (a, b) = (1.0 + t * self.compliance, 1.0 + tension * self.compliance);
        let by_tension = a / b;
        let mean = 0.5 * (a + b);
        let material = x / (self.thermal * mean);
        let material_by_tension = -material / mean * (1.0 + by_tension) * (0.5 * self.compliance);
        SlideResult { tension, material, by_tension, material_by_tension }
    }
}

impl SlideResult {
    /// This result followed by another that starts at its end.
    pub fn then(self, next: Self) -> Self {
        Self {
            tension: next.tension,
            material: self.material + next.material,
            by_tension: self.by_tension * next.by_tension,
            material_by_tension: self.material_by_tension + next.material_by_tension * self.by_tension,
        }
    }

    /// The result of a path of length zero with tension `t`.
    pub fn none(t: f64) -> Self {
        Self { tension: t, material: 0.0, by_tension: 1.0, material_by_tension: 0.0 }
    }
}

/// The border between cable in tension and loose cable: its place, the material (m) to it from the
/// drawn end, and the tension there (N).
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct SlackEnd {
    pub coordinate: f64,
    pub material: f64,
    pub tension: f64,
}

/// A chain of a boundary and the laws of the cable on it.
#[derive(Clone, Copy)]
pub(in crate::model::spans) struct ContactPath<'a> {
    pub curve: &'a Curve,
    pub chain_range: ChainRange,
    pub law: CableLaw,
    /// μ.
    pub friction: f64,
    /// See [`SolveContext`](crate::model::spans::section::SolveContext).
    pub drag: f64,
    /// True if all of it slides away from the drawn end, as far as there is tension, and lies loose
    /// beyond that.
    pub floored: bool,
    /// The friction coefficient μ of loose cable.
    pub friction_of_loose: f64,
    /// A cached piece, from whose point other places on the same piece are computed.
    pub cached_piece: Option<CachedPiece>,
}

impl ContactPath<'_> {
    /// This path with the piece at p cached.
    pub fn with_cached_piece(self, p: f64) -> Self {
        Self { cached_piece: Some(CachedPiece::new(self.curve, self.chain_range, &self.law, p)), ..self }
    }

    /// The point at p.
    pub fn place(&self, p: f64) -> BoundaryPoint {
        match &self.cached_piece {
            Some(cached_piece) if cached_piece.holds(p) => cached_piece.place(p),
            _ => self.curve.place(p, self.chain_range),
        }
    }

    /// True if p is on an arc.
    pub fn turns(&self, p: f64) -> bool {
        match &self.cached_piece {
            Some(cached_piece) if cached_piece.holds(p) => cached_piece.turns(),
            _ => self.curve.is_arc(self.curve.locate(p, self.chain_range)),
        }
    }

    /// The piece that contains both p₀ and p₁.
    pub fn on(&self, p0: f64, p1: f64) -> SegmentCursor<'_> {
        let from = match &self.cached_piece {
            Some(cached_piece) if cached_piece.reaches(p0) && cached_piece.reaches(p1) => cached_piece.local_load(p0),
            _ => {
                let i = self.curve.locate(0.5 * (p0 + p1), self.chain_range);
                self.law.local_load(&self.curve.place_on(i, p0 - self.curve.origin(i)))
            }
        };
        SegmentCursor { law: &self.law, from, p0 }
    }

    /// Slides with m from p₀, where the tension is `t`, to p₁ (in either direction).
    pub fn slide(&self, p0: f64, p1: f64, t: f64, m: f64) -> SlideResult {
        if p0 == p1 {
            return SlideResult::none(t);
        }
        if let Some(cached_piece) = &self.cached_piece
            && cached_piece.reaches(p0)
            && cached_piece.reaches(p1)
        {
            return self.law.along(&cached_piece.local_load(p0), p1 - p0, t, m);
        }
        let (mut i, last) = (self.curve.locate(p0, self.chain_range), self.curve.locate(p1, self.chain_range));
        let (mut at, mut sum) = (p0, SlideResult::none(t));
        loop {
            let origin = self.curve.origin(i);
            let to = match i.cmp(&last) {
                std::cmp::Ordering::Equal => p1,
                std::cmp::Ordering::Less => self.curve.origin(i + 1),
                std::cmp::Ordering::Greater => origin,
            };
            let from = self.law.local_load(&self.curve.place_on(i, at - origin));
            sum = sum.then(self.law.along(&from, to - at, sum.tension, m));
            if i == last {
                return sum;
            }
            i += if i < last { 1 } else { -1 };
            at = to;
        }
    }

    /// Slides with m from p₀, the drawn end, to p₁. Where the tension on an edge falls to that of
    /// loose cable, the cable lies loose from there to p₁. Also returns the place where that
    /// begins.
    pub fn slide_floored(&self, p0: f64, p1: f64, t: f64, m: f64) -> (SlideResult, Option<SlackEnd>) {
        let bed = Self { friction: self.friction_of_loose, ..*self };
        let lying = bed.lying(p1, p0);
        let (mut sum, mut loose) = (SlideResult::none(t), None);
        for ends in lying.windows(2).rev() {
            let [(next, under), (at, under_here)] = [ends[0], ends[1]];
            let edge = !self.turns(0.5 * (at + next));
            let way = self.slide(at, next, sum.tension, m);
            if !(edge && way.tension < under) {
                sum = sum.then(way);
                // Cable drawn down a slope has tension again.
                loose = loose.filter(|_| !(sum.tension > under));
            } else {
                // Along an edge Θ is linear.
                let above = |t: f64, under: f64| self.law.theta(t) - self.law.theta(under);
                let [here, there] = [above(sum.tension, under_here), above(way.tension, under)];
                let q = at + (next - at) * (here / (here - there)).clamp(0.0, 1.0);
                sum = sum.then(self.slide(at, q, sum.tension, m));
                let even = bed.even(0.5 * (q + next));
                let tension = bed.slide(next, q, under, even).tension;
                loose = loose.or(Some(SlackEnd { coordinate: q, material: sum.material, tension }));
                let material = bed.slide(q, next, tension, even).material;
                sum = sum.then(SlideResult { material, by_tension: 0.0, ..SlideResult::none(under) });
            }
        }
        (sum, loose)
    }

    /// Returns the borders between stretches of one law, with the tensions there, of loose cable
    /// from p₁, where the tension is zero, to p₀. The tension is constant where friction holds the
    /// cable, and grows on slopes beyond the friction cone.
    fn lying(&self, p1: f64, p0: f64) -> Vec<(f64, f64)> {
        let mut out = vec![(p1, 0.0)];
        let (mut at, mut tension) = (p1, 0.0);
        while at != p0 {
            let next = self.next_border(at, p0);
            let m = self.even(0.5 * (at + next));
            // Within the friction cone the tension is constant.
            if !(m.abs() < self.friction) {
                tension = self.slide(at, next, tension, m).tension;
            }
            out.push((next, tension));
            at = next;
        }
        out
    }

    /// The m with which the tension is constant at p, as far as friction allows: −b·t − m b·n = 0
    /// on an edge; 0 on an arc.
    pub fn even(&self, p: f64) -> f64 {
        if self.turns(p) {
            return 0.0;
        }
        let place = self.place(p);
        let out_of = self.law.load.dot(&place.normal);
        if out_of == 0.0 {
            return 0.0;
        }
        bounded(-self.law.load.dot(&place.tangent) / out_of, -self.friction, self.friction)
    }

    /// From p₀ to p₁ (in either direction) with the tension as constant as friction allows, as for
    /// cable that is laid down.
    pub fn lay(&self, p0: f64, p1: f64, t: f64) -> SlideResult {
        let (mut at, mut sum) = (p0, SlideResult::none(t));
        while at != p1 {
            let next = self.next_border(at, p1);
            sum = sum.then(self.slide(at, next, sum.tension, self.even(0.5 * (at + next))));
            at = next;
        }
        sum
    }

    /// Calls back with the places inside an arc from p to q at which tension or pressure may have a
    /// minimum while the cable slides with m.
    ///
    /// With P the [`CableLaw::press`] of a place, P' = mP − 2(c/λ) b·t and T' = mT − (c/λ)(b·t + m
    /// b·n), both apart from the change of λ: P e^{−mψ} is least where b·t = 0 with the load out of
    /// the arc, below it, and T e^{−mψ} where b·t + m b·n = 0. If neither is negative there and at
    /// the ends, it is nowhere negative.
    pub fn minimum_candidates(&self, p: f64, q: f64, m: f64, mut each: impl FnMut(f64)) {
        let middle = self.curve.locate(0.5 * (p + q), self.chain_range);
        if !self.curve.is_arc(middle) {
            return;
        }
        let least = self.law.load - perp(self.law.load) * (m * self.curve.sense);
        for out in [self.law.load, least] {
            self.facing(middle, out, p, q, &mut each);
        }
    }

    /// Calls back with the places between p and q at which a round boundary faces the load: its
    /// bottoms.
    pub fn bottoms(&self, p: f64, q: f64, each: impl FnMut(f64)) {
        self.facing(self.chain_range.first, self.law.load, p, q, each);
    }

    /// The places between p and q, on arc i, whose outward normal is along `out`.
    fn facing(&self, i: i64, out: Vec2, p: f64, q: f64, each: impl FnMut(f64)) {
        // No cable is wound farther.
        if out.norm() > 0.0 && q - p <= MOST_TURN {
            // n = σ perp t.
            self.curve.running(i, perp(out) * -self.curve.sense, p, q, each);
        }
    }

    /// The middle of the length between two places.
    pub fn middle(&self, [first, last]: [f64; 2]) -> f64 {
        let long = |a: f64, b: f64| self.curve.length(a, b, self.chain_range);
        let (mut low, mut high) = (first, last);
        // The bisection goes down to round-off; a point, which has no length, is halved by its
        // turn.
        for _ in 0..64 {
            let p = 0.5 * (low + high);
            let [before, after] = [long(first, p), long(p, last)];
            if before == after {
                return p;
            }
            if before < after { low = p } else { high = p }
        }
        0.5 * (low + high)
    }

    /// The next place from p towards `to` where the boundary changes from edge to arc or back; `to`
    /// if there is none between.
    pub fn next_border(&self, p: f64, to: f64) -> f64 {
        if self.cached_piece.as_ref().is_some_and(|v| v.reaches(p) && v.reaches(to)) {
            return to;
        }
        let mut i = self.curve.locate(p, self.chain_range);
        if to > p {
            // A border that was reached up to round-off counts as passed.
            while i < self.chain_range.last {
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
            while i > self.chain_range.first {
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

#[cfg(test)]
mod tests;
