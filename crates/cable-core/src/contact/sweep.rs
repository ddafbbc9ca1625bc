//! Conservative advancement bounds how far a moving segment can go without crossing anything.
//!
//! Let n be the unit vector along the shortest line from a feature F to the moving segment (a, b)
//! at t. Both are convex, so for every later t′
//! ```text
//! D(t′) ≥ min(n·a(t′), n·b(t′)) − max over F of n·x,      with equality at t′ = t
//! ```
//! and the right side is linear in t′: t may grow to where it passes D_keep, again and again from
//! there (Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996, with the
//! directed bound of Zhang, Lee, Kim, "Interactive continuous collision detection for non-convex
//! polyhedra", The Visual Computer 22, 2006; D_keep as in Li et al., "Codimensional incremental
//! potential contact", ACM TOG 2021). A segment that slides along an edge is not stopped by it,
//! however near it is.

use super::distance::{between_segments, from_segment, point_segment, segment_segment};
use super::geometry::{Geometry, ObstaclePart};
use crate::math::{Vec2, cross, larger, smaller};

/// Steps of advancement per feature. Fewer steps return a shorter free fraction at a glancing
/// approach, which is still safe. The remaining distance shrinks geometrically, and 1e5 random
/// sweeps never used more than 40.
const MAX_ADVANCES: usize = 48;

/// Advancement ends when the remaining advance is this fraction of the gap. A smaller value costs
/// steps, a larger value shortens the free fraction.
const CONVERGED_FRACTION: f64 = 0.02;

/// Distances are taken to be accurate to this many units in the last place of the coordinates.
const ROUNDING_ULPS: f64 = 16.0;

/// A gap below this (m) counts as touching: then only the centre line is kept from crossing.
/// Supports are often drawn exactly on the ground, with a gap of a rounding error, and if a
/// fraction of that had to be kept they could never move. The barrier never lets a free node come
/// so near.
const TOUCHING_GAP: f64 = 1e-9;

/// Largest fraction of a gap that a caller can ask to keep.
const MAX_KEEP: f64 = 0.9;

/// An end of a straight way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WayEnd {
    /// A support, which may touch a body.
    Support,
    /// A bend of the way, which is clear of all bodies if the way is.
    Bend,
}

impl Geometry {
    /// See [`super::World::free_fraction`].
    #[must_use]
    pub fn free_fraction(&self, from: [Vec2; 2], to: [Vec2; 2], keep: f64) -> f64 {
        self.free_fraction_round(&Sweep::new(from, to, keep), [None, None])
    }

    /// Does the same as [`Self::free_fraction`] for a segment that is tangent, at one or both ends,
    /// to the rounds of the corners or circles `round`: to these only the other end of the segment
    /// can come too close.
    #[must_use]
    pub(crate) fn free_fraction_round(&self, sweep: &Sweep, round: [Option<usize>; 2]) -> f64 {
        self.free_fraction_among(self.parts(sweep.low, sweep.high, sweep.margin), sweep, round)
    }

    /// Returns the bodies that are in the way between two places (m), in order. A support that
    /// touches a body is not in its way there; a bend of the way has to be clear of all.
    #[must_use]
    pub(crate) fn bodies_between(&self, [a, b]: [Vec2; 2], ends: [WayEnd; 2]) -> Vec<usize> {
        // A move may leave what it touches at its start, and is stopped by what it would touch at
        // its end.
        let (there, back) = (Sweep::new([a; 2], [b; 2], 0.0), Sweep::new([b; 2], [a; 2], 0.0));
        let stops = |sweep: &Sweep, part: ObstaclePart| {
            self.free_fraction_among(std::iter::once(part), sweep, [None, None]) < 1.0
        };
        let blocks = |part: &ObstaclePart| match ends {
            [WayEnd::Support, WayEnd::Support] => stops(&there, *part) && stops(&back, *part),
            [WayEnd::Support, WayEnd::Bend] => stops(&there, *part),
            [WayEnd::Bend, WayEnd::Support] => stops(&back, *part),
            [WayEnd::Bend, WayEnd::Bend] => stops(&there, *part) || stops(&back, *part),
        };
        let blocking = self.parts(there.low, there.high, there.margin).filter(blocks);
        let mut found: Vec<usize> = blocking.map(|part| part.body).collect();
        found.dedup();
        found
    }

    /// True if a segment of the centre line crosses an edge. Ends that lie on one do not.
    #[must_use]
    pub(crate) fn is_crossed(&self, [a, b]: [Vec2; 2]) -> bool {
        let (low, high) = (a.inf(&b), a.sup(&b));
        let apart = |[p, q]: [Vec2; 2], [c, d]: [Vec2; 2]| cross(q - p, c - p) * cross(q - p, d - p) < 0.0;
        self.parts(low, high, 0.0).any(|part| {
            let edge = self.bodies().get(part.body).and_then(|body| body.edges.get(part.edge?));
            edge.is_some_and(|e| apart([a, b], [e.from, e.to]) && apart([e.from, e.to], [a, b]))
        })
    }

    /// Returns the free fraction with respect to `parts`, which hold all parts within the margin of
    /// the sweep from its box.
    pub(crate) fn free_fraction_among(
        &self,
        parts: impl Iterator<Item = ObstaclePart>,
        sweep: &Sweep,
        round: [Option<usize>; 2],
    ) -> f64 {
        let Sweep { from: [a, b], go: [da, db], .. } = *sweep;
        if !(da.norm_squared() + db.norm_squared()).is_finite() {
            return 0.0;
        }
        if sweep.speed == 0.0 {
            return 1.0;
        }
        let how = [sweep.keep, sweep.most, sweep.noise];
        let [start, end] = [MovingPoint { at: a, go: da }, MovingPoint { at: b, go: db }];
        let (whole, first, last) = ([start, end], [start; 2], [end; 2]);
        let mut free = 1.0;
        for part in parts {
            let Some(body) = self.bodies().get(part.body) else { continue };
            let beside =
                round.map(|f| f.is_some_and(|f| part.edge.map_or(f == body.first + 1, |k| body.is_beside(k, f))));
            let moving = match beside {
                [false, false] => whole,
                [true, false] => last,
                [false, true] => first,
                [true, true] => continue,
            };
            match (part.edge.and_then(|k| body.edges.get(k)), body.center) {
                // If both ends are on one side of the line through the edge and far enough from it,
                // the segment cannot meet the edge.
                (Some(e), _) if way_off([a, b], e.from, e.normal()) - body.offset > sweep.clear(free) => {}
                (Some(e), _) => {
                    let way = |[a, b]: [Vec2; 2]| between_segments(a, b, e.from, e.to);
                    free = advance(moving, way, [e.from, e.to], body.offset, how, free);
                }
                (None, Some(c)) => {
                    let way = |[a, b]: [Vec2; 2]| -from_segment(c, a, b);
                    free = advance(moving, way, [c; 2], body.offset, how, free);
                }
                (None, None) => {}
            }
        }
        free
    }
}

/// A segment that moves.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    /// Ends of the segment at the start, m.
    pub from: [Vec2; 2],
    /// Displacements of the ends, m.
    pub go: [Vec2; 2],
    /// Lowest corner of the box that contains the segment during the whole move, m.
    pub low: Vec2,
    /// Highest corner of that box, m.
    pub high: Vec2,
    /// Distance from the box beyond which the required fraction of every gap is kept anyway, m.
    pub margin: f64,
    speed: f64,
    keep: f64,
    most: f64,
    noise: f64,
}

impl Sweep {
    /// The move `from` → `to` (m) that is to leave the fraction `keep` of each gap.
    #[must_use]
    pub fn new(from: [Vec2; 2], to: [Vec2; 2], keep: f64) -> Self {
        let [a, b] = from;
        let go = [to[0] - a, to[1] - b];
        let keep = keep.clamp(0.0, MAX_KEEP);
        let squares = [go[0].norm_squared(), go[1].norm_squared()];
        let speed = if squares[0] > squares[1] { squares[0].sqrt() } else { squares[1].sqrt() };
        let (low, high) = (a.inf(&b).inf(&to[0]).inf(&to[1]), a.sup(&b).sup(&to[0]).sup(&to[1]));
        let noise = ROUNDING_ULPS * f64::EPSILON * (low.abs().max() + high.abs().max());
        Self {
            from,
            go,
            low,
            high,
            margin: speed * keep / (1.0 - keep) + noise,
            speed,
            keep,
            most: f64::INFINITY,
            noise,
        }
    }

    /// Returns the same sweep, in which at most `most` (m) of a gap has to be left, however wide
    /// the gap was.
    #[must_use]
    pub(crate) fn at_most(self, most: f64) -> Self {
        let whole = most + self.noise;
        Self { most, margin: if whole < self.margin { whole } else { self.margin }, ..self }
    }
}

impl Sweep {
    /// The gap (m) beyond which the fraction `limit` of the move is free, whatever the direction.
    fn clear(&self, limit: f64) -> f64 {
        let way = self.speed * limit + 2.0 * self.noise + TOUCHING_GAP;
        smaller(way / (1.0 - self.keep), way + self.most)
    }
}

/// Least distance of a segment from the line through `p` with the unit normal `n`, m; 0 if the
/// segment crosses the line.
fn way_off([a, b]: [Vec2; 2], p: Vec2, n: Vec2) -> f64 {
    let (a, b) = ((a - p).dot(&n), (b - p).dot(&n));
    if a > 0.0 && b > 0.0 {
        smaller(a, b)
    } else if a < 0.0 && b < 0.0 {
        -larger(a, b)
    } else {
        0.0
    }
}

impl Geometry {
    /// Returns whether every gap of a segment is above `least` (m); `round` as in
    /// [`Self::free_fraction_round`].
    #[must_use]
    pub(crate) fn is_clear(&self, [a, b]: [Vec2; 2], least: f64, round: [Option<usize>; 2]) -> bool {
        let (low, high) = (a.inf(&b), a.sup(&b));
        self.bodies().iter().all(|body| {
            let reach = body.offset + least;
            let r = Vec2::repeat(reach);
            let from = |beside: [bool; 2], whole: f64, points: [f64; 2]| match beside {
                [false, false] => whole > reach,
                [true, false] => points[1] > reach,
                [false, true] => points[0] > reach,
                [true, true] => true,
            };
            let circle = body.center.is_none_or(|c| {
                let beside = round.map(|f| f == Some(body.first + 1));
                from(beside, point_segment(c, a, b), [(a - c).norm(), (b - c).norm()])
            });
            circle
                && body.candidates(low - r, high + r).all(|k| {
                    let e = &body.edges[k];
                    let beside = round.map(|f| f.is_some_and(|f| body.is_beside(k, f)));
                    let points = [point_segment(a, e.from, e.to), point_segment(b, e.from, e.to)];
                    from(beside, segment_segment(a, b, e.from, e.to), points)
                })
        })
    }
}

/// The free fraction (up to `limit`) of the move of a segment, given by its ends and their
/// displacements (m), with respect to the feature between two points. `way` is the shortest vector
/// (m) from the feature to the segment between given ends. The fraction `keep` of the gap is left,
/// or `most` (m) if that is less.
pub(super) fn advance(
    moving: [MovingPoint; 2],
    way: impl Fn([Vec2; 2]) -> Vec2,
    feature: [Vec2; 2],
    offset: f64,
    [keep, most, noise]: [f64; 3],
    limit: f64,
) -> f64 {
    let farthest = |n: Vec2| larger(n.dot(&feature[0]), n.dot(&feature[1]));
    let at = |t: f64| moving.map(|point| point.at + point.go * t);
    let mut away = way(at(0.0));
    let mut d = away.norm();
    // If the cable overlaps already (this model does not do that), its centre line still must not
    // cross. If the centre line is across already, it cannot cross again, and stopping it there
    // would trap it.
    if d <= 0.0 {
        return limit;
    }
    let surface = if d - offset > noise + TOUCHING_GAP { offset } else { 0.0 };
    let gap = d - surface;
    let floor = surface + if keep * gap > most { most } else { keep * gap } + noise;
    let close = CONVERGED_FRACTION * gap;
    let mut t = 0.0;
    for _ in 0..MAX_ADVANCES {
        let room = d - floor;
        if !(room > 0.0) {
            return t;
        }
        let n = away / d;
        let least = farthest(n) + floor;
        let mut next = limit;
        for point in moving {
            let (height, rate) = (n.dot(&point.at), n.dot(&point.go));
            // The comparison is negated so that NaN ends the loop here.
            if !(height + rate * next >= least) {
                next = (least - height) / rate;
            }
        }
        if next < limit {
            let beside = beside_line(moving, feature, floor, [t, limit]);
            next = if beside > next { beside } else { next };
        }
        if next >= limit {
            return limit;
        }
        if !(next > t) {
            return t;
        }
        t = next;
        away = way(at(t));
        d = away.norm();
        if room <= close {
            return t;
        }
    }
    t
}

/// A point that moves uniformly.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingPoint {
    /// Position at the start, m.
    pub at: Vec2,
    /// Displacement by the end, m.
    pub go: Vec2,
}

/// The latest time (after `t`, at most `limit`) up to which the line through two moving points
/// keeps a feature on one side, at least `least` (m) away.
///
/// With e = b − a, r = p − a for a point p of the feature and τ = t′ − t, the line is at least K
/// away from p while
/// ```text
/// ± e(τ) × r(τ) ≥ K |e(τ)|,      |e(τ)| ≤ L + Λ τ  up to the limit, as |e| is convex
/// ```
/// which is quadratic. A segment that turns about a corner it is near to is free by the root of its
/// gap here, by a part of it above.
fn beside_line([a, b]: [MovingPoint; 2], feature: [Vec2; 2], least: f64, [t, limit]: [f64; 2]) -> f64 {
    let (MovingPoint { at: a, go: da }, MovingPoint { at: b, go: db }) = (a, b);
    let from = a + da * t;
    let (e, turn, left) = (b + db * t - from, db - da, limit - t);
    let length = e.norm();
    let growth = ((e + turn * left).norm() - length) / left;
    let side = if cross(e, feature[0] - from) < 0.0 { -1.0 } else { 1.0 };
    let mut free = left;
    for p in feature {
        let r = p - from;
        let room = side * cross(e, r) - least * length;
        let slope = side * (cross(turn, r) - cross(e, da)) - least * growth;
        let bend = -side * cross(turn, da);
        let root = slope * slope - 4.0 * bend * room;
        if !(room > 0.0) {
            return t;
        }
        if root >= 0.0 {
            let under = root.sqrt() - slope;
            if under * free > 2.0 * room {
                free = 2.0 * room / under;
            }
        } else if root.is_nan() {
            return t;
        }
    }
    t + free
}
