//! This module makes the route of a section: that of the scene, or a route from support to support
//! and over obstacles.

use crate::contact::World;
use crate::contact::sweep::WayEnd;
use crate::math::{Vec2, bounded};
use crate::model::spans::section::BoundaryConditions;
use crate::model::spans::section_layout::{SectionBounds, SectionLayout};
use crate::problem::way_over::bodies_in_the_way;

/// Relative difference, and difference in m, by which a distance must be less than an earlier one
/// to count as less. Smaller: round-off chooses among turns that are alike; larger: a later turn
/// that is nearer is passed over.
const NEARER_FRACTION: f64 = 1e-6;
const NEARER_M: f64 = 1e-12;
/// Least material that dangling ends get, as a fraction of the stretch. Smaller: an end that pays
/// out from nothing; larger: stretches that begin tauter than they are. A choice, tuned on no
/// campaign.
const LEAST_SPARE_FRACTION: f64 = 0.05;

/// Clearance of a route over obstacles, as a fraction of the distance between its ends. Smaller:
/// round-off may let it touch. Larger: it goes round more obstacles than necessary.
const ROUTE_CLEARANCE_FRACTION: f64 = 1e-4;

/// A route with the length along it.
pub(in crate::model::spans) struct RoutePolyline {
    pub points: Vec<Vec2>,
    pub along: Vec<f64>,
}

impl RoutePolyline {
    fn new(points: Vec<Vec2>) -> Self {
        let mut along = vec![0.0; points.len()];
        for k in 1..points.len() {
            along[k] = along[k - 1] + (points[k] - points[k - 1]).norm();
        }
        Self { points, along }
    }

    pub fn total(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    /// Length along it (m) at which it is nearest to a point, not before `from`, up to the end of
    /// leg `last`.
    pub fn nearest(&self, at: Vec2, from: f64, last: Option<usize>) -> f64 {
        let (mut best, mut found) = (f64::INFINITY, from);
        let pieces = self.points.len().saturating_sub(1);
        for k in 0..last.map_or(pieces, |last| pieces.min(last + 1)) {
            let d = self.points[k + 1] - self.points[k];
            let l = d.norm();
            if l == 0.0 || self.along[k + 1] < from {
                continue;
            }
            let u = bounded((at - self.points[k]).dot(&d) / l, 0.0, l);
            let u = if self.along[k] + u < from { from - self.along[k] } else { u };
            let distance = (self.points[k] + d * (u / l) - at).norm();
            // Of equal distances the first counts, because several turns round a post are alike.
            if distance < best * (1.0 - NEARER_FRACTION) - NEARER_M {
                (best, found) = (distance, self.along[k] + u);
            }
        }
        found
    }

    /// Length along it (m) at which it is nearest to a point, within a distance of `around`.
    pub fn close(&self, at: Vec2, around: f64, within: f64) -> f64 {
        let (mut best, mut found) = (f64::INFINITY, around);
        for k in 0..self.points.len().saturating_sub(1) {
            let d = self.points[k + 1] - self.points[k];
            let l = d.norm();
            let (low, high) = (self.along[k].max(around - within), self.along[k + 1].min(around + within));
            if l == 0.0 || high <= low {
                continue;
            }
            let w = bounded(self.along[k] + (at - self.points[k]).dot(&d) / l, low, high);
            let distance = (self.points[k] + d * ((w - self.along[k]) / l) - at).norm();
            if distance < best {
                (best, found) = (distance, w);
            }
        }
        found
    }

    /// The stretch about the length `w` along it that is no farther than `within` (m) from a point:
    /// the lengths along it at which it begins and ends, m.
    pub fn stretch_within(&self, center: Vec2, w: f64, within: f64) -> [f64; 2] {
        let leg = self.leg(w);
        let Some(at) = self.point(w) else { return [w; 2] };
        let before = (0..=leg).rev().map(|k| (self.along[k], self.points[k]));
        let after = (leg + 1..self.points.len()).map(|k| (self.along[k], self.points[k]));
        let last_within = |way: &mut dyn Iterator<Item = (f64, Vec2)>| {
            let mut last = (w, at);
            for next in way {
                if (next.1 - center).norm() > within {
                    return last.0 + (next.0 - last.0) * leaves(last.1 - center, next.1 - last.1, within);
                }
                last = next;
            }
            last.0
        };
        [last_within(&mut before.into_iter()), last_within(&mut after.into_iter())]
    }

    /// Distance of the point at a length along it from another, m.
    pub fn distance(&self, from: Vec2, w: f64) -> f64 {
        self.point(w).map_or(0.0, |at| (at - from).norm())
    }

    /// The point at a length along it, m.
    fn point(&self, w: f64) -> Option<Vec2> {
        let k = self.leg(w);
        let (a, b) = (self.points.get(k)?, self.points.get(k + 1)?);
        let length = self.along[k + 1] - self.along[k];
        Some(if length > 0.0 { a + (b - a) * ((w - self.along[k]) / length) } else { *a })
    }

    /// Leg at a length along it.
    pub fn leg(&self, w: f64) -> usize {
        self.along.partition_point(|a| *a <= w).clamp(1, self.points.len().max(2) - 1) - 1
    }
}

/// Fraction of the displacement d from the point a (relative to a centre) at which it leaves a
/// circle of this radius.
fn leaves(a: Vec2, d: Vec2, radius: f64) -> f64 {
    let (square, along) = (d.norm_squared(), a.dot(&d));
    let root = along * along - square * (a.norm_squared() - radius * radius);
    if !(square > 0.0 && root >= 0.0) {
        return 0.0;
    }
    bounded((root.sqrt() - along) / square, 0.0, 1.0)
}

/// The route of a section, and the places of its pulleys on it.
pub(in crate::model::spans) fn section_route(
    layout: &SectionLayout,
    part: &SectionBounds,
    instant: &BoundaryConditions,
) -> RoutePolyline {
    let p = &layout.problem;
    let place = |k: usize| instant.places[k];
    let ends = part.supports.map(|s| s.map(place));
    let stops: Vec<Vec2> =
        ends[0].into_iter().chain(part.pulleys.iter().map(|q| place(q.support))).chain(ends[1]).collect();
    if p.route.len() > 1 {
        let whole = RoutePolyline::new(p.route.clone());
        // The part of the route between the grips.
        let a = ends[0].filter(|_| part.material[0] > 0.0).map_or(0.0, |at| whole.nearest(at, 0.0, None));
        let b = ends[1].filter(|_| part.material[1] < p.length).map_or(whole.total(), |at| whole.nearest(at, a, None));
        let mut points: Vec<Vec2> = Vec::with_capacity(whole.points.len() + 2);
        points.extend(ends[0].or(whole.points.first().copied()));
        for (k, q) in whole.points.iter().enumerate() {
            if whole.along[k] > a && whole.along[k] < b {
                points.push(*q);
            }
        }
        points.extend(ends[1].or(whole.points.last().copied()));
        return RoutePolyline::new(points);
    }
    let mut points: Vec<Vec2> = Vec::new();
    let used: f64 = stops.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let spare =
        (part.material[1] - part.material[0] - used).max(LEAST_SPARE_FRACTION * (part.material[1] - part.material[0]));
    let loose = part.supports.iter().filter(|s| s.is_none()).count().max(1) as f64;
    let tail = |side: usize| {
        let force = layout.end_force(instant, part.material[side]) + instant.load * (0.5 * spare);
        if force.norm() > 0.0 { force.normalize() * (spare / loose) } else { Vec2::zeros() }
    };
    if let (None, Some(first)) = (part.supports[0], stops.first()) {
        points.push(first + tail(0));
    }
    for (k, at) in stops.iter().enumerate() {
        if k > 0 {
            points.extend(way_round_blockage(&p.world, stops[k - 1], *at));
        }
        points.push(*at);
    }
    if let (None, Some(last)) = (part.supports[1], stops.last()) {
        points.push(last + tail(1));
    }
    RoutePolyline::new(points)
}

/// A way from `a` to `b` if the straight one is blocked: out from under obstacles above either end,
/// then above everything that is in the way.
fn way_round_blockage(world: &World, a: Vec2, b: Vec2) -> Vec<Vec2> {
    let bodies = bodies_in_the_way(world, a, b);
    if bodies.is_empty() {
        return Vec::new();
    }
    let free = |p: Vec2, q: Vec2| world.geometry().bodies_between([p, q], [WayEnd::Support; 2]).is_empty();
    let (low, high) = (a.x.min(b.x), a.x.max(b.x));
    let clear = ROUTE_CLEARANCE_FRACTION * (b - a).norm();
    let mut top = a.y.max(b.y);
    for body in bodies.into_iter().filter_map(|k| world.geometry().bodies().get(k)) {
        let points = body.edges.iter().flat_map(|e| [e.from, e.to]).chain(body.center);
        for q in points.filter(|q| q.x > low - body.offset && q.x < high + body.offset) {
            top = top.max(q.y + 2.0 * body.offset + clear);
        }
    }
    let above = |p: Vec2| Vec2::new(p.x, top);
    let out = |p: Vec2, to: Vec2| match free(p, above(p)) {
        true => None,
        false => aside(world, p, to),
    };
    let [from, to] = [out(a, b), out(b, a)];
    let [c, d] = [from.unwrap_or(a), to.unwrap_or(b)];
    let mut way: Vec<Vec2> = from.into_iter().collect();
    if (from.is_none() && to.is_none()) || !free(c, d) {
        way.extend([above(c), above(d)]);
    }
    way.extend(to);
    way
}

/// A point beside the obstacle above p and a little below its edge, on the side of `to`.
fn aside(world: &World, p: Vec2, to: Vec2) -> Option<Vec2> {
    let side = if to.x < p.x { -1.0 } else { 1.0 };
    let mut far: Option<(f64, f64)> = None;
    for body in world.geometry().bodies().iter().filter(|b| !b.is_ground()) {
        let reach = body.offset + if body.center.is_some() { 0.0 } else { ROUTE_CLEARANCE_FRACTION * (to - p).norm() };
        let points = || body.edges.iter().flat_map(|e| [e.from, e.to]).chain(body.center);
        let [least, most] = points().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, m], q| [l.min(q.x), m.max(q.x)]);
        let above = points().any(|q| q.y > p.y);
        if above && p.x > least - reach && p.x < most + reach {
            let edge = if side < 0.0 { least - 2.0 * reach } else { most + 2.0 * reach };
            let (x, below) = far.unwrap_or((edge, reach));
            far = Some((if side * (edge - x) > 0.0 { edge } else { x }, if reach > below { reach } else { below }));
        }
    }
    far.map(|(x, below)| Vec2::new(x, p.y - below))
}
