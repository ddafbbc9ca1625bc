//! This search finds where a free span runs into an obstacle.
//!
//! Under a constant load a catenary is deepest in an edge where it is parallel to it, F × t = 0,
//! which costs one division, and nearest to a corner or a centre v where (x − v)·F = 0, a root of
//! one variable. At these points the obstacle's signed distance is evaluated, which takes the
//! nearest feature into account.

use crate::catenary::Catenary;
use crate::contact::geometry::Body;
use crate::contact::{Gap, World};
use crate::math::{Vec2, cross, larger, perp};
use crate::model::spans::acceptance::{Side, tangent};
use crate::model::spans::section::{CableSection, SolveContext};

/// Number of stretches of a catenary that are searched for points nearest to a corner. Smaller: a
/// corner near both branches of a deep catenary is found from one only.
const SAMPLES: usize = 8;
/// Maximum number of bisections of a root.
const MAX_HALVINGS: usize = 60;
/// Accuracy of roots, as a fraction of the catenary.
const ROOT_TOLERANCE_FRACTION: f64 = 1e-12;

/// A point of a span inside an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Penetration {
    /// Material point, m.
    pub arc_length: f64,
    pub at: Vec2,
    /// Direction of the cable there.
    pub tangent: Vec2,
    /// The gap to the obstacle that contains it; `gap_m` < 0.
    pub gap: Gap,
    /// Index of the body.
    pub body: usize,
}

/// One catenary at its position.
struct SpanArc<'a> {
    s0: f64,
    at: Vec2,
    shape: &'a Catenary,
    load: Vec2,
    /// Its tangents at both ends: it bends away from the load, and so lies beyond each of them.
    /// None if it hangs along the load.
    sides: [Option<Side>; 2],
}

impl<'a> SpanArc<'a> {
    fn new(s0: f64, at: Vec2, shape: &'a Catenary, load: Vec2) -> Self {
        let (start, end) = (shape.start_force(), shape.end_force());
        let sides = [tangent(at, start, load), tangent(at + shape.span().chord, end, load)];
        Self { s0, at, shape, load, sides }
    }

    /// True if the tangents at its ends prove that a point is at least so far from it.
    fn misses(&self, v: Vec2, by: f64) -> bool {
        self.sides.iter().flatten().any(|(at, normal)| (at - v).dot(normal) >= by)
    }

    /// True if one of those tangents proves that all of edge k and of the one before it face it
    /// from at least so far.
    fn misses_edges(&self, body: &Body, k: usize, by: f64) -> bool {
        let before = k.checked_sub(1).or(body.edges.len().checked_sub(1));
        let edges = [Some(k), before].map(|k| k.and_then(|k| body.edges.get(k)));
        self.sides.iter().flatten().any(|(at, normal)| {
            edges.iter().flatten().all(|e| {
                let far = |v: Vec2| (at - v).dot(normal) >= by;
                far(e.from) && far(e.to) && perp(e.tangent).dot(normal) > 0.0
            })
        })
    }

    fn length(&self) -> f64 {
        self.shape.span().length
    }

    fn point(&self, s: f64) -> Vec2 {
        self.at + self.shape.position_at(s)
    }

    /// Its bounding box: the extremes are at its ends and where it is parallel to an axis.
    fn bounds(&self) -> (Vec2, Vec2) {
        let (a, b) = (self.at, self.at + self.shape.span().chord);
        let (mut low, mut high) = (a.inf(&b), a.sup(&b));
        let f = self.shape.force_at(0.0);
        for s in [f.x / self.load.x, f.y / self.load.y] {
            if s > 0.0 && s < self.length() {
                let p = self.point(s);
                (low, high) = (low.inf(&p), high.sup(&p));
            }
        }
        (low, high)
    }

    /// The material point where it is parallel to a direction.
    fn along(&self, t: Vec2) -> Option<f64> {
        let s = cross(self.shape.force_at(0.0), t) / cross(self.load, t);
        (s > 0.0 && s < self.length()).then_some(s)
    }

    /// Calls back with each material point inside it that is nearer to `v` than its neighbours.
    fn nearest(&self, v: Vec2, mut found: impl FnMut(f64)) {
        let g = |s: f64| (self.point(s) - v).dot(&self.shape.force_at(s));
        let h = self.length() / SAMPLES as f64;
        let mut before = g(0.0);
        for k in 0..SAMPLES {
            let (mut a, mut b) = (k as f64 * h, (k + 1) as f64 * h);
            let after = g(b);
            if before < 0.0 && after >= 0.0 {
                let (mut ga, mut gb) = (before, after);
                for round in 0..MAX_HALVINGS {
                    if b - a <= ROOT_TOLERANCE_FRACTION * self.length() {
                        break;
                    }
                    let s = if round % 3 == 2 { 0.5 * (a + b) } else { a + (b - a) * (ga / (ga - gb)) };
                    let gs = g(s);
                    if gs < 0.0 {
                        (a, ga) = (s, gs);
                    } else {
                        (b, gb) = (s, gs);
                    }
                    if gs == 0.0 {
                        break;
                    }
                }
                found(0.5 * (a + b));
            }
            before = after;
        }
    }
}

/// The deepest point of span k inside an obstacle, if deeper than `tolerance` (m).
pub(super) fn deepest(
    section: &CableSection,
    context: &SolveContext,
    world: &World,
    k: usize,
    tolerance: f64,
) -> Option<Penetration> {
    if world.is_empty() || !section.has_span(k) {
        return None;
    }
    let mut best: Option<Penetration> = None;
    section.shapes(context, k, |s0, at, shape| {
        let arc = SpanArc::new(s0, at, shape, context.law.load);
        let (low, high) = arc.bounds();
        for (index, body) in world.geometry().bodies().iter().enumerate() {
            search(&arc, body, low, high, tolerance, |s| {
                let at = arc.point(s);
                let reach = (high - low).norm() + body.offset;
                let Some(gap) = world.signed_gap(at, reach) else { return };
                let here = world.geometry().body_of(gap.feature).map(|b| b.obstacle);
                if gap.gap_m < -tolerance && here == Some(body.obstacle) && best.is_none_or(|b| gap.gap_m < b.gap.gap_m)
                {
                    let force = arc.shape.force_at(s);
                    let tangent = force / force.norm();
                    best = Some(Penetration { arc_length: arc.s0 + s, at, tangent, gap, body: index });
                }
            });
        }
    });
    best
}

/// Calls back with the points of a catenary that may be deepest in a body.
fn search(arc: &SpanArc<'_>, body: &Body, low: Vec2, high: Vec2, tolerance: f64, mut found: impl FnMut(f64)) {
    if let Some(center) = body.center {
        if arc.misses(center, body.offset - tolerance) {
            return;
        }
        let near = |p: Vec2| (p - center).norm() < body.offset - tolerance;
        let clear = Vec2::repeat(body.offset);
        if (low - clear).iter().zip(center.iter()).all(|(a, b)| a < b)
            && (high + clear).iter().zip(center.iter()).all(|(a, b)| a > b)
        {
            arc.nearest(center, |s| {
                if near(arc.point(s)) {
                    found(s);
                }
            });
        }
        return;
    }
    let r = Vec2::repeat(body.offset);
    for k in body.candidates(low - r, high + r) {
        let Some(e) = body.edges.get(k) else { continue };
        if arc.misses_edges(body, k, body.offset - tolerance) {
            continue;
        }
        if let Some(s) = arc.along(e.tangent) {
            let d = arc.point(s) - e.from;
            let (x, height) = (d.dot(&e.tangent), d.dot(&perp(e.tangent)));
            // A deep point may be nearest to an edge, or to a kink beside it, that is not directly
            // above it.
            let aside = larger(body.offset, -height);
            if height < body.offset - tolerance && x > -aside && x < e.length() + aside {
                found(s);
            }
        }
        for corner in body.corners_of(k) {
            if body.is_exposed(&corner) {
                let outward = corner.outward();
                arc.nearest(corner.at, |s| {
                    let d = arc.point(s) - corner.at;
                    if d.norm() < body.offset - tolerance || d.dot(&outward) < 0.0 {
                        found(s);
                    }
                });
            }
        }
    }
}
