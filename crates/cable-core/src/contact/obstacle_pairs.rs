//! Contact pairs join a chain of cable segments with the obstacles and are smooth in the chain's
//! position.
//!
//! There are two families, each complete for one kind of contact, as in Li et al., "Incremental
//! Potential Contact", ACM TOG 2020: cable node against boundary edges, and boundary corner (or
//! circle) against cable segments. Where two edges meet, both can have the corner as the point
//! nearest to a node. If both were counted, a node that passes a flat joint would feel a bump. So
//! corners enter by inclusion and exclusion (Li, Ferguson, Schneider et al., "Convergent
//! incremental potential contact", 2023):
//!
//!   Σ over edges b(d(p, edge)) − Σ over inner corners b(d(p, corner)),
//!
//! which leaves b once on a flat or convex boundary and is continuous across a concave one. Terms
//! that cancel are not emitted; what remains has weight +1 or, at a shallow concave corner, −1.

use super::Gap;
use super::geometry::{Body, Geometry, ObstaclePart};
use crate::math::Vec2;

/// A pair is discarded only if its distance exceeds the reach by this factor, so that rounding does
/// not decide which pairs touch.
const CULLING_MARGIN: f64 = 1.0 + 1e-9;

/// A contact pair with its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Gap between the two; `fraction` lies strictly inside (0, 1) for a corner against a segment.
    pub gap: Gap,
    /// +1 or −1.
    pub weight: f64,
}

impl Geometry {
    /// Pairs of one node: against edges and corners within `reach`, and against the corners that
    /// lie in the wedge between its two segments. `before` and `after` are its neighbours in the
    /// chain.
    pub(crate) fn node_pairs(
        &self,
        before: Option<Vec2>,
        p: Vec2,
        after: Option<Vec2>,
        reach: f64,
        out: &mut impl FnMut(Pair),
    ) {
        self.node_pairs_among(self.parts(p, p, reach), &[before, Some(p), after], reach, out);
    }

    /// Finds the pairs of a node among `parts`, which hold all parts within reach. The chain is the
    /// node between its neighbours.
    pub(crate) fn node_pairs_among(
        &self,
        parts: impl Iterator<Item = ObstaclePart>,
        chain: &[Option<Vec2>; 3],
        reach: f64,
        out: &mut impl FnMut(Pair),
    ) {
        let Some(p) = chain[1] else { return };
        for part in parts {
            let Some(body) = self.bodies().get(part.body) else { continue };
            let Some(k) = part.edge else {
                if let Some(c) = body.center {
                    push_wedge(body, body.first + 1, c, chain, reach, out);
                }
                continue;
            };
            let (e, within) = (&body.edges[k], CULLING_MARGIN * (reach + body.offset));
            // No point of an edge is nearer than the straight line through the edge.
            if (p - e.from).dot(&e.normal()).abs() > within {
                continue;
            }
            push_edge(body, k, p, reach, out);
            let far = |at: Vec2| (p - at).norm_squared() > within * within;
            if far(e.from) && far(e.to) {
                continue;
            }
            for corner in body.corners_of(k) {
                push_corner(body, &corner, p, reach, out);
                if body.is_exposed(&corner) {
                    push_wedge(body, corner.feature, corner.at, chain, reach, out);
                }
            }
        }
    }

    /// Pairs of the inside of one segment with the corners and circles within `reach` (m).
    pub(crate) fn segment_pairs(&self, a: Vec2, b: Vec2, reach: f64, out: &mut impl FnMut(Pair)) {
        self.segment_pairs_among(self.parts(a.inf(&b), a.sup(&b), reach), [a, b], reach, out);
    }

    /// Finds the pairs of a segment among `parts`, which hold all parts within reach.
    pub(crate) fn segment_pairs_among(
        &self,
        parts: impl Iterator<Item = ObstaclePart>,
        ends: [Vec2; 2],
        reach: f64,
        out: &mut impl FnMut(Pair),
    ) {
        let (low, high) = (ends[0].inf(&ends[1]), ends[0].sup(&ends[1]));
        for part in parts {
            let Some(body) = self.bodies().get(part.body) else { continue };
            match part.edge {
                None => {
                    if let Some(c) = body.center {
                        push_segment(body, body.first + 1, c, ends, reach, out);
                    }
                }
                Some(k) => {
                    let (e, within) = (&body.edges[k], CULLING_MARGIN * (reach + body.offset));
                    let far = |at: Vec2| {
                        at.x < low.x - within
                            || at.x > high.x + within
                            || at.y < low.y - within
                            || at.y > high.y + within
                    };
                    if far(e.from) && far(e.to) {
                        continue;
                    }
                    for corner in body.corners_of(k).filter(|c| body.is_exposed(c)) {
                        push_segment(body, corner.feature, corner.at, ends, reach, out);
                    }
                }
            }
        }
    }

    /// See [`super::World::segment_gaps`].
    pub fn segment_gaps(&self, a: Vec2, b: Vec2, reach: f64, out: &mut Vec<Gap>) {
        let mut keep = |pair: Pair, fraction: f64| {
            if pair.weight > 0.0 {
                out.push(Gap { fraction, ..pair.gap });
            }
        };
        self.node_pairs(None, a, Some(b), reach, &mut |p| keep(p, 0.0));
        self.segment_pairs(a, b, reach, &mut |p| keep(p, p.gap.fraction));
        self.node_pairs(Some(a), b, None, reach, &mut |p| keep(p, 1.0));
    }
}

/// Node against the inside of an edge.
#[inline]
fn push_edge(body: &Body, k: usize, p: Vec2, reach: f64, out: &mut impl FnMut(Pair)) {
    let e = &body.edges[k];
    let along = (p - e.from).dot(&e.tangent);
    if !(along > 0.0 && (p - e.to).dot(&e.tangent) < 0.0) {
        return;
    }
    let height = (p - e.from).dot(&e.normal());
    let side = if height < 0.0 { -1.0 } else { 1.0 };
    let gap = body.gap(body.first + 2 * k, height.abs(), e.normal() * side, e.from + e.tangent * along);
    if gap.gap_m < reach {
        out(Pair { gap, weight: 1.0 });
    }
}

/// Node against a corner, with the weight that inclusion and exclusion leave.
#[inline]
fn push_corner(body: &Body, corner: &super::geometry::Corner, p: Vec2, reach: f64, out: &mut impl FnMut(Pair)) {
    let (clamped, edges) = corner.clamped(p);
    let weight = if edges == 2 { clamped as f64 - 1.0 } else { clamped as f64 };
    push_point(body, corner.feature, [p, corner.at], weight, reach, out);
}

/// Corner or circle against a node, with the weight that inclusion and exclusion over the node's
/// segments leave.
#[inline]
fn push_wedge(body: &Body, feature: usize, v: Vec2, chain: &[Option<Vec2>; 3], reach: f64, out: &mut impl FnMut(Pair)) {
    let [before, Some(p), after] = *chain else { return };
    let beyond = |other: Option<Vec2>| other.map(|o| (v - p).dot(&(o - p)) <= 0.0);
    // The segments that meet the corner with their inside take this node's part.
    let inside = [beyond(before), beyond(after)].into_iter().filter(|b| *b == Some(false)).count();
    let weight = 1.0 - inside as f64;
    push_point(body, feature, [p, v], weight, reach, out);
}

#[inline]
fn push_point(body: &Body, feature: usize, [p, v]: [Vec2; 2], weight: f64, reach: f64, out: &mut impl FnMut(Pair)) {
    let d = (p - v).norm();
    if weight != 0.0 && d > 0.0 && d - body.offset < reach {
        out(Pair { gap: body.gap(feature, d, (p - v) / d, v), weight });
    }
}

/// Corner or circle against the inside of a segment.
#[inline]
fn push_segment(body: &Body, feature: usize, v: Vec2, [a, b]: [Vec2; 2], reach: f64, out: &mut impl FnMut(Pair)) {
    let (d, l2) = (b - a, (b - a).norm_squared());
    let along = (v - a).dot(&d);
    if !(along > 0.0 && along < l2) {
        return;
    }
    let fraction = along / l2;
    let away = a + d * fraction - v;
    let distance = away.norm();
    if distance > 0.0 && distance - body.offset < reach {
        let mut gap = body.gap(feature, distance, away / distance, v);
        gap.fraction = fraction;
        out(Pair { gap, weight: 1.0 });
    }
}
