//! A contact path integrates tension and material of a cable that slides, or is laid down, along a
//! chain of pieces of a boundary.

use crate::math::{Vec2, bounded, perp};
use crate::model::spans::boundary::capstan::arc::MOST_TURN;
use crate::model::spans::boundary::capstan::cable_law::{CableLaw, SlideResult};
use crate::model::spans::boundary::capstan::piece_slide::slide_on_piece;
use crate::model::spans::boundary::capstan::segment_cursor::{CachedPiece, SegmentCursor};
use crate::model::spans::boundary::curve::{BoundaryPoint, ChainRange, Curve};

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
    pub fn segment(&self, p0: f64, p1: f64) -> SegmentCursor<'_> {
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
            return slide_on_piece(&self.law, &cached_piece.local_load(p0), p1 - p0, t, m);
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
            sum = sum.then(slide_on_piece(&self.law, &from, to - at, sum.tension, m));
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
    pub fn flattest_slide(&self, p0: f64, p1: f64, t: f64) -> SlideResult {
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
