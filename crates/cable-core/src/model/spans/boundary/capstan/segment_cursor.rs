//! A segment cursor holds one piece of a contact path and a point of it: other places on the piece
//! need no search, and their directions are that of the point turned by a small angle. It also
//! finds where two tensions become equal on a piece.

use std::cell::Cell;

use crate::math::{Vec2, sin_cos};
use crate::model::spans::boundary::capstan::arc::{ArcPath, SHORT_ARC};
use crate::model::spans::boundary::capstan::cable_law::{CableLaw, LocalLoad, SlideResult};
use crate::model::spans::boundary::capstan::piece_slide::slide_on_piece;
use crate::model::spans::boundary::curve::{BoundaryPoint, ChainRange, Curve};
use crate::model::spans::bracketed_root::{TENSION_ROUNDING, crossing};

/// Fraction of a piece up to which no second meeting of two tensions is searched on it. Larger:
/// unneeded searches happen more often.
const MEETING_SKIP_FRACTION: f64 = 0.9;

/// Number of evaluations of both tensions before their meeting is sought within bounds.
const FREE_SEARCH_LOOKS: usize = 3;

/// A point of a piece, with the extent of the piece.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct CachedPiece {
    /// Boundary coordinate.
    coordinate: f64,
    pub at: BoundaryPoint,
    /// b·t and b·n there, N/m.
    load: [f64; 2],
    /// Start and end of the piece; beyond the ends of its chain it continues.
    ends: [f64; 2],
}

impl CachedPiece {
    /// The piece at p.
    pub fn new(curve: &Curve, chain_range: ChainRange, law: &CableLaw, p: f64) -> Self {
        let i = curve.locate(p, chain_range);
        let origin = curve.origin(i);
        let at = curve.place_on(i, p - origin);
        let first = if i > chain_range.first { origin } else { f64::NEG_INFINITY };
        let last = if i < chain_range.last { curve.origin(i + 1) } else { f64::INFINITY };
        Self { coordinate: p, at, load: law.local_load(&at).load, ends: [first, last] }
    }

    /// The places of both ends of a contact, and the piece of the first.
    pub fn of_ends(
        curve: &Curve,
        chain_range: ChainRange,
        law: &CableLaw,
        [first, last]: [f64; 2],
    ) -> ([BoundaryPoint; 2], Self) {
        let cached_piece = Self::new(curve, chain_range, law, first);
        (
            [
                cached_piece.at,
                if cached_piece.holds(last) { cached_piece.place(last) } else { curve.place(last, chain_range) },
            ],
            cached_piece,
        )
    }

    /// True if p is on this piece.
    pub fn holds(&self, p: f64) -> bool {
        p >= self.ends[0] && p < self.ends[1]
    }

    /// True if p is on this piece or at its end.
    pub fn reaches(&self, p: f64) -> bool {
        p >= self.ends[0] && p <= self.ends[1]
    }

    /// True on an arc.
    pub fn turns(&self) -> bool {
        self.at.turn != 0.0
    }

    /// The point at p.
    pub fn place(&self, p: f64) -> BoundaryPoint {
        let (at, x) = (&self.at, p - self.coordinate);
        if x == 0.0 {
            return *at;
        }
        if !self.turns() {
            return BoundaryPoint { at: at.at + at.tangent * x, ..*at };
        }
        // dt/dp = −n, dn/dp = t.
        let (sin, cos) = sin_cos(x);
        let tangent: Vec2 = at.tangent * cos - at.normal * sin;
        let normal: Vec2 = at.normal * cos + at.tangent * sin;
        BoundaryPoint { at: at.at + (normal - at.normal) * at.stretch, tangent, normal, ..*at }
    }

    /// The values at p that the law needs.
    pub fn local_load(&self, p: f64) -> LocalLoad {
        let local_load = LocalLoad { stretch: self.at.stretch, turns: self.turns(), load: self.load };
        local_load.at_distance(p - self.coordinate)
    }
}

/// A tension that changes by sliding with m.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct Sliding {
    /// Tension, N.
    pub tension: f64,
    /// The mobilised friction coefficient, with its sign.
    pub mobilised: f64,
}

/// One piece of a contact path, from a point on it.
pub(in crate::model::spans) struct SegmentCursor<'a> {
    pub law: &'a CableLaw,
    pub from: LocalLoad,
    pub p0: f64,
}

impl SegmentCursor<'_> {
    /// Slides with m from its point, where the tension is `t`, to p.
    pub fn slide(&self, p: f64, t: f64, m: f64) -> SlideResult {
        slide_on_piece(self.law, &self.from, p - self.p0, t, m)
    }

    /// The place before p₁ where two different tensions, each with its m, become equal, and both
    /// integrations up to there; None if there is no such place before p₁, with both integrations
    /// up to p₁. On an edge both Θ are linear, round a sharp corner both T are exponential, and
    /// elsewhere approximately so.
    pub fn crossing(
        &self,
        p1: f64,
        [Sliding { tension: t, mobilised: m }, Sliding { tension: u, mobilised: n }]: [Sliding; 2],
    ) -> (Option<f64>, [SlideResult; 2]) {
        let law = self.law;
        let whole = p1 - self.p0;
        let both = |p: f64| [self.slide(p, t, m), self.slide(p, u, n)];
        let about = if !self.from.turns {
            (law.theta(u) - law.theta(t)) / (law.edge_rate(&self.from, m) - law.edge_rate(&self.from, n))
        } else {
            // This estimate takes the load at the start for the whole piece.
            let friction_load = |t: f64, m: f64| {
                let g = self.from.stretch / (law.stretch(t) * (1.0 + m * m));
                let [bt, bn] = self.from.load;
                t - g * (2.0 * m * bt + (m * m - 1.0) * bn)
            };
            (friction_load(u, n) / friction_load(t, m)).ln() / (m - n)
        };
        // Parallel tensions meet nowhere; NaN counts as outside, too.
        let part = about / whole;
        let exact = !self.from.turns || self.from.stretch == 0.0;
        if exact {
            let at = (0.0..=1.0).contains(&part).then_some(self.p0 + about);
            return (at, both(at.unwrap_or(p1)));
        }
        if part > 0.0
            && part < MEETING_SKIP_FRACTION
            && let Some((at, ways)) =
                self.closing(about, whole, [Sliding { tension: t, mobilised: m }, Sliding { tension: u, mobilised: n }])
        {
            return (Some(at), ways);
        }
        let sign = (t - u).signum();
        let [a, b] = both(p1);
        let end = (a.tension - b.tension) * sign;
        if end > 0.0 {
            return (None, [a, b]);
        }
        // This occurs if a contact slides back and forth over the same stretch.
        if end.abs() <= TENSION_ROUNDING * t.abs() {
            return (Some(p1), [a, b]);
        }
        let (at, ways) =
            self.meeting(p1, [Sliding { tension: t, mobilised: m }, Sliding { tension: u, mobilised: n }], end);
        (Some(at), ways)
    }

    /// As [`Self::crossing`] round an arc, from an estimate `about` of the place: Newton's method,
    /// with the last step from the derivatives alone.
    fn closing(
        &self,
        about: f64,
        whole: f64,
        [Sliding { tension: t, mobilised: m }, Sliding { tension: u, mobilised: n }]: [Sliding; 2],
    ) -> Option<(f64, [SlideResult; 2])> {
        let mut way = about;
        for _ in 0..FREE_SEARCH_LOOKS {
            let there = ArcPath::new(&self.from, way);
            let [(a, one), (b, two)] = [(t, m), (u, n)].map(|(t, m)| there.slide(self.law, t, m));
            let apart = a.tension - b.tension;
            let [first, second, third] = [0, 1, 2].map(|k| one.tension[k] - two.tension[k]);
            // Halley's step, followed by a Newton step with values known to third order.
            let by = -apart / (first - 0.5 * second * apart / first);
            let rest = apart + by * (first + 0.5 * by * (second + by / 3.0 * third));
            let by = by - rest / (first + by * (second + 0.5 * by * third));
            let next = way + by;
            if !(next / whole > 0.0 && next / whole < 1.0) {
                return None;
            }
            if by.abs() <= SHORT_ARC {
                return Some((self.p0 + next, [one.extend(&a, by), two.extend(&b, by)]));
            }
            way = next;
        }
        None
    }

    /// As [`Self::crossing`] round an arc; `end`: the difference at p₁.
    fn meeting(
        &self,
        p1: f64,
        [Sliding { tension: t, mobilised: m }, Sliding { tension: u, mobilised: n }]: [Sliding; 2],
        end: f64,
    ) -> (f64, [SlideResult; 2]) {
        let sign = (t - u).signum();
        let both = |p: f64| [self.slide(p, t, m), self.slide(p, u, n)];
        let last = Cell::new((f64::NAN, [SlideResult::none(t); 2]));
        let ends = ((t - u) * sign, end);
        let x = crossing(self.p0, p1, TENSION_ROUNDING * t.abs(), Some(ends), |x| {
            let [a, b] = both(x);
            last.set((x, [a, b]));
            let local_load = self.from.at_distance(x - self.p0);
            let slope = |t: f64, m: f64| self.law.slope_at(&local_load, t, m);
            ((a.tension - b.tension) * sign, (slope(a.tension, m) - slope(b.tension, n)) * sign)
        });
        let (at, ways) = last.get();
        (x, if at == x { ways } else { both(x) })
    }
}
