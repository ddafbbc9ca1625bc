//! This check proves that no cable of an answer is inside an obstacle; it shares nothing with the
//! search for contacts (`changes/obstacle_search.rs`).
//!
//! A stretch of a catenary or of an arc that turns by at most a right angle is convex: with its
//! ends a, b and its tangents there it lies in the triangle of a, b and the point where the
//! tangents meet. If an obstacle is nowhere nearer to that triangle than the cable's radius, it is
//! nowhere nearer to the stretch; otherwise the stretch is halved. Distances are unsigned distances
//! of points from lines: every way into an obstacle crosses its boundary.

use crate::contact::World;
use crate::contact::geometry::{Body, Edge};
use crate::error::EquilibriumFault;
use crate::math::{Vec2, cross, perp, smaller};
use crate::model::spans::section::{CableSection, Contact, Failure, SolveContext};

/// Most of the offset of a body that the accepted depth may take. Smaller: thin cables are refused
/// for round-off; larger: they may pass through.
const ACCEPTED_DEPTH_OFFSET_FRACTION: f64 = 0.1;

/// Depth inside an obstacle that every answer may have, m.
const ACCEPTED_DEPTH_M: f64 = 1e-6;
/// Maximum number of halvings: 2⁻⁴⁰ of any cable is a point.
const MOST_HALVINGS: u32 = 40;
/// Longest stretch of an arc that is checked at once, rad.
const LONGEST_ARC_RAD: f64 = 1.0;

/// A triangle that holds a stretch of cable: its corners, and its sides as (point, unit vector
/// inwards).
struct BoundingTriangle {
    corners: [Vec2; 3],
    sides: [(Vec2, Vec2); 3],
}

impl BoundingTriangle {
    /// The triangle of a stretch from a to b with these directions of travel there (of any length;
    /// 0 for a straight stretch).
    fn of([a, b]: [Vec2; 2], along: [Vec2; 2]) -> Self {
        let d = b - a;
        let far = d.norm();
        let straight = if far > 0.0 { d / far } else { Vec2::x() };
        let [t, u] = along.map(|v| if v.norm() > 0.0 { v / v.norm() } else { straight });
        // a + x t = b − y u; neither side is longer than the chord.
        let turn = cross(t, u);
        let x = cross(d, u) / turn;
        let apex = a + t * if x > 0.0 && x < far { x } else { 0.5 * far };
        let inwards = |n: Vec2, v: Vec2| if n.dot(&v) < 0.0 { -n } else { n };
        let first = inwards(perp(t), d);
        let chord = perp(straight) * -perp(straight).dot(&first).signum();
        Self { corners: [a, apex, b], sides: [(a, first), (b, inwards(perp(u), -d)), (a, chord)] }
    }

    /// Its bounding box, widened by r.
    fn bounds(&self, r: f64) -> (Vec2, Vec2) {
        let [a, apex, b] = &self.corners;
        (a.inf(apex).inf(b) - Vec2::repeat(r), a.sup(apex).sup(b) + Vec2::repeat(r))
    }

    /// True if its sides do not prove that a box is farther than r from it.
    fn may_reach_box(&self, low: Vec2, high: Vec2, r: f64) -> bool {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        self.sides.iter().all(|(at, n)| (middle - at).dot(n) + half.x * n.x.abs() + half.y * n.y.abs() > -r)
    }

    /// True if the sides, the edge itself or the directions from its ends prove that an edge is
    /// nowhere nearer than r.
    fn misses_edge(&self, e: &Edge, r: f64) -> bool {
        let (n, t) = (e.normal(), e.tangent);
        self.sides.iter().any(|(at, n)| (e.from - at).dot(n) <= -r && (e.to - at).dot(n) <= -r)
            || self.beyond(e.from, n, r)
            || self.beyond(e.from, -n, r)
            || self.beyond(e.from, -t, r)
            || self.beyond(e.to, t, r)
            || self.aside(e.from, |n| n.dot(&t) <= 0.0, r)
            || self.aside(e.to, |n| n.dot(&t) >= 0.0, r)
    }

    /// True if the sides or the directions to the corners prove that a point is nowhere nearer than
    /// r.
    fn misses_point(&self, v: Vec2, r: f64) -> bool {
        self.sides.iter().any(|(at, n)| (v - at).dot(n) <= -r) || self.aside(v, |_| true, r)
    }

    /// True if all of the triangle is at least r from a point in a direction (a unit vector).
    fn beyond(&self, v: Vec2, n: Vec2, r: f64) -> bool {
        self.corners.iter().all(|c| (c - v).dot(&n) >= r)
    }

    /// True if all of the triangle is at least r from a point in the direction of one of its
    /// corners; `will_do` selects the directions.
    fn aside(&self, v: Vec2, will_do: impl Fn(Vec2) -> bool, r: f64) -> bool {
        let unit = self.corners.iter().map(|c| (c - v, (c - v).norm())).filter(|(_, far)| *far >= r && *far > 0.0);
        unit.map(|(way, far)| way / far).any(|n| will_do(n) && self.beyond(v, n, r))
    }

    /// True if it is clear of a body. `beside` is a corner or circle round which its stretch runs
    /// at the right distance.
    fn misses(&self, body: &Body, beside: Option<usize>) -> bool {
        let r = body.offset - smaller(ACCEPTED_DEPTH_M, ACCEPTED_DEPTH_OFFSET_FRACTION * body.offset);
        if let Some(center) = body.center {
            return beside == Some(body.first + 1) || self.misses_point(center, r);
        }
        let (first, last) = self.bounds(r);
        let beside_box =
            |low: Vec2, high: Vec2| low.x > last.x || low.y > last.y || high.x < first.x || high.y < first.y;
        let near = |low: Vec2, high: Vec2| !beside_box(low, high) && self.may_reach_box(low, high, r);
        body.candidates_where(near)
            .filter(|&k| !beside.is_some_and(|feature| body.is_beside(k, feature)))
            .filter_map(|k| body.edges.get(k))
            .all(|e| self.misses_edge(e, r))
    }
}

/// Checks that a section is clear of all obstacles.
pub(in crate::model::spans) fn verify(
    section: &CableSection,
    context: &SolveContext,
    world: &World,
) -> Result<(), Failure> {
    let mut inside = None;
    for k in 0..section.spans() {
        if section.has_span(k) {
            section.shapes(context, k, |s0, at, shape| {
                let length = shape.span().length;
                let point = |s: f64| (at + shape.position_at(s), shape.force_at(s));
                let fold = shape.lowest_s();
                let parts = [[0.0, fold], [fold, length]];
                let found =
                    parts.into_iter().filter(|[a, b]| b > a).find_map(|part| inside_on(world, &point, part, None));
                inside = inside.or(found.map(|(s, at)| (s0 + s, at)));
            });
        }
        if let Some(c) = section.contacts.get(k) {
            inside = inside.or_else(|| contact(c, context, world));
        }
        if let Some((s, at)) = inside {
            return Err(Failure::Unsound { what: EquilibriumFault::InsideObstacle, s, at });
        }
    }
    Ok(())
}

/// The place at which a contact is inside an obstacle.
fn contact(c: &Contact, context: &SolveContext, world: &World) -> Option<(f64, Vec2)> {
    let contact_path = context.contact_path(c).with_cached_piece(c.ends.place[0]);
    let mut p = c.ends.place[0];
    while p < c.ends.place[1] {
        let border = contact_path.next_border(p, c.ends.place[1]);
        let arc = contact_path.turns(0.5 * (p + border));
        let q = if arc && border > p + LONGEST_ARC_RAD { p + LONGEST_ARC_RAD } else { border };
        let piece = contact_path.curve.piece(contact_path.curve.locate(0.5 * (p + q), c.chain_range));
        let point = |p: f64| {
            let place = contact_path.place(p);
            (place.at, place.tangent)
        };
        let found = inside_on(world, &point, [p, q], piece.feature.filter(|_| arc));
        if let Some((_, at)) = found {
            return Some((c.ends.material[0], at));
        }
        p = q;
    }
    None
}

/// The place at which a stretch is inside an obstacle.
fn inside_on(
    world: &World,
    point: &dyn Fn(f64) -> (Vec2, Vec2),
    part: [f64; 2],
    beside: Option<usize>,
) -> Option<(f64, Vec2)> {
    let ends = part.map(|s| (s, point(s)));
    world.geometry().bodies().iter().find_map(|body| search(body, point, ends, beside, 0))
}

/// The place at which a stretch is inside a body. The stretch is halved until it is clear or has no
/// length.
fn search(
    body: &Body,
    point: &dyn Fn(f64) -> (Vec2, Vec2),
    part: [(f64, (Vec2, Vec2)); 2],
    beside: Option<usize>,
    depth: u32,
) -> Option<(f64, Vec2)> {
    let [(from, a), (to, b)] = part;
    if BoundingTriangle::of([a.0, b.0], [a.1, b.1]).misses(body, beside) {
        return None;
    }
    let s = 0.5 * (from + to);
    let middle = point(s);
    if depth >= MOST_HALVINGS || (b.0 - a.0).norm() <= ACCEPTED_DEPTH_M * ACCEPTED_DEPTH_M {
        return Some((s, middle.0));
    }
    search(body, point, [(from, a), (s, middle)], beside, depth + 1)
        .or_else(|| search(body, point, [(s, middle), (to, b)], beside, depth + 1))
}
