//! The geometry holds the features of all obstacles in search trees; no other file imports parry2d.
//!
//! parry2d's own contact calls are two-sided for polylines, so only its bounding volume tree is
//! used, for candidates; distances and signs are worked out here. A *body* is one obstacle,
//! a *feature* one of its edges, corners or circles. Polygons are wound so that the solid lies
//! right of travel, as with terrain drawn left to right; the outward normal is then always left of
//! an edge.
//!
//! The sign of a distance follows from the nearest feature: left or right of an edge; at a corner,
//! outside if the corner is convex and inside if it is not. (The angle-weighted pseudo-normal of
//! Bærentzen and Aanæs, "Signed distance computation using the angle weighted pseudonormal", IEEE
//! TVCG 2005, says the same in 2D.)

use std::ops::Range;
use std::sync::Arc;

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

use super::Gap;
use super::distance::nearest_fraction;
use super::moving_outline::Outline;
use crate::math::{Point, RigidPose, Vec2, cross, perp, vec2};
use crate::scene::{LineEnds, Obstacle, Shape};

/// Two edges that turn by less than this angle (rad) are merged: a corner that the cable cannot
/// feel would only cost time.
const MIN_EDGE_TURN: f64 = 1e-12;

/// The obstacles of a scene with their trees.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    bodies: Vec<Body>,
}

/// One obstacle.
#[derive(Clone, Debug)]
pub struct Body {
    /// Index in the scene.
    pub obstacle: usize,
    /// Name in the scene.
    pub name: String,
    /// Coulomb friction coefficient with the cable.
    pub friction: f64,
    /// Distance of the cable's centre line from the edges when they touch, m.
    pub offset: f64,
    /// Edges, in order; empty for a circle. Shared by all copies: maps are large.
    pub edges: Arc<Vec<Edge>>,
    /// Centre of a circle; `offset` then includes its radius.
    pub center: Option<Vec2>,
    /// Number of this body's first feature: edge k is feature first + 2k, the corner at its start
    /// first + 2k + 1, a circle first + 1.
    pub first: usize,
    solid: bool,
    closed: bool,
    /// `None` for an outline that moves: then all of its few edges are searched.
    bvh: Option<Arc<Bvh>>,
    moves: bool,
}

/// A straight piece of a boundary; outside is left of it.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Start, m.
    pub from: Vec2,
    /// End, m.
    pub to: Vec2,
    /// Unit vector from start to end.
    pub tangent: Vec2,
}

/// A corner of a body or a circle: a point with an offset.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Place, m.
    pub at: Vec2,
    /// Feature number.
    pub feature: usize,
    /// Unit tangents of the edges before and after it, if there are such.
    pub before: Option<Vec2>,
    /// See `before`.
    pub after: Option<Vec2>,
}

/// A part of an obstacle for distance queries: an edge (with the corners that are assigned to it)
/// or a circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObstaclePart {
    /// Index of the body.
    pub body: usize,
    /// Index of the edge; `None` if the body is a circle.
    pub edge: Option<usize>,
}

impl Corner {
    /// Returns whether the boundary turns away from the outside here (an open end counts).
    #[must_use]
    pub(crate) fn is_convex(&self) -> bool {
        match (self.before, self.after) {
            (Some(t1), Some(t2)) => cross(t1, t2) < 0.0 || (cross(t1, t2) == 0.0 && t1.dot(&t2) < 0.0),
            _ => true,
        }
    }

    /// Direction outwards: the sum of the normals that meet here (not a unit vector; 0 at the tip
    /// of a spike).
    #[must_use]
    pub(crate) fn outward(&self) -> Vec2 {
        perp(self.before.unwrap_or_default() + self.after.unwrap_or_default())
    }

    /// Returns how many of the edges that meet here have this corner as their nearest point to `p`,
    /// and how many meet.
    #[inline]
    #[must_use]
    pub fn clamped(&self, p: Vec2) -> (usize, usize) {
        let d = p - self.at;
        let before = self.before.map(|t| d.dot(&t) >= 0.0);
        let after = self.after.map(|t| d.dot(&t) <= 0.0);
        (
            usize::from(before == Some(true)) + usize::from(after == Some(true)),
            usize::from(before.is_some()) + usize::from(after.is_some()),
        )
    }
}

impl Edge {
    /// The edge between two points that are not the same, m.
    #[must_use]
    pub fn between(from: Vec2, to: Vec2) -> Self {
        Self { from, to, tangent: (to - from) / (to - from).norm() }
    }

    /// Outward unit normal.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> Vec2 {
        perp(self.tangent)
    }

    /// Length, m.
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }
}

/// The edges that a search of a body finds: those of its tree, or of a body that moves.
struct Candidates<L, M> {
    leaves: Option<L>,
    moving: M,
}

impl<L: Iterator<Item = u32>, M: Iterator<Item = usize>> Iterator for Candidates<L, M> {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        match &mut self.leaves {
            Some(leaves) => leaves.next().map(|leaf| leaf as usize),
            None => self.moving.next(),
        }
    }
}

impl Body {
    /// Returns whether both have the same boundary in the same place, as the cable meets it.
    #[must_use]
    pub(crate) fn is_where(&self, other: &Self) -> bool {
        let same = |(a, b): (&Edge, &Edge)| (a.from, a.to) == (b.from, b.to);
        (self.center, self.offset, self.edges.len()) == (other.center, other.offset, other.edges.len())
            && self.edges.iter().zip(other.edges.iter()).all(same)
    }

    /// Indices of the edges whose boxes meet the given box.
    pub fn candidates(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = usize> {
        self.candidates_where(move |n, x| n.x <= high.x && n.y <= high.y && x.x >= low.x && x.y >= low.y)
    }

    /// Indices of the edges whose boxes, given by their lowest and highest corners, satisfy
    /// `meets`. A box that contains one for which `meets` holds has to satisfy it, too.
    pub(crate) fn candidates_where(&self, meets: impl Fn(Vec2, Vec2) -> bool + Copy) -> impl Iterator<Item = usize> {
        let near = move |low: Vector, high: Vector| meets(Vec2::new(low.x, low.y), Vec2::new(high.x, high.y));
        let all = if self.bvh.is_none() { self.edges.as_slice() } else { &[] };
        let moving =
            all.iter().enumerate().filter(move |(_, e)| meets(e.from.inf(&e.to), e.from.sup(&e.to))).map(|(k, _)| k);
        let leaves = self.bvh.as_ref().map(|bvh| bvh.leaves(move |node| near(node.mins(), node.maxs())));
        Candidates { leaves, moving }.filter(|&k| k < self.edges.len())
    }

    /// Returns whether the box round all edges meets the given box; true of a body that moves.
    fn is_near(&self, low: Vec2, high: Vec2) -> bool {
        let Some(bvh) = &self.bvh else { return true };
        let whole = bvh.root_aabb();
        let (n, x) = (whole.mins, whole.maxs);
        n.x <= high.x && n.y <= high.y && x.x >= low.x && x.y >= low.y
    }

    /// The corner at the start of edge `k`; `k` = number of edges asks for the end of an open line.
    #[must_use]
    pub fn corner(&self, k: usize) -> Option<Corner> {
        let n = self.edges.len();
        let tangent = |k: usize| self.edges.get(k).map(|e| e.tangent);
        let (before, after, at) = match k {
            _ if n == 0 || k > n || (k == n && self.closed) => return None,
            0 if self.closed => (tangent(n - 1), tangent(0), self.edges.first()?.from),
            0 => (None, tangent(0), self.edges.first()?.from),
            k if k == n => (tangent(n - 1), None, self.edges.last()?.to),
            k => (tangent(k - 1), tangent(k), self.edges.get(k)?.from),
        };
        Some(Corner { at, feature: self.first + 2 * k + 1, before, after })
    }

    /// Corners that are assigned to an edge: its start, and for the last edge of an open line its
    /// end, too.
    pub(crate) fn corners_of(&self, k: usize) -> impl Iterator<Item = Corner> {
        let last = (k + 1 == self.edges.len() && !self.closed).then_some(k + 1);
        std::iter::once(k).chain(last).filter_map(|k| self.corner(k))
    }

    /// Returns whether an edge ends at the corner or circle `feature`.
    #[inline]
    #[must_use]
    pub(crate) fn is_beside(&self, edge: usize, feature: usize) -> bool {
        let n = self.edges.len();
        let Some(local) = feature.checked_sub(self.first).map(|f| f / 2).filter(|&k| k <= n) else { return false };
        local == edge || local == edge + 1 || (self.closed && local == 0 && edge + 1 == n)
    }

    /// Returns whether the body is an outline or a post that moves.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// Returns whether the body is ground: solid below an open line, so that nothing can pass round
    /// it.
    #[must_use]
    pub(crate) fn is_ground(&self) -> bool {
        self.solid && !self.closed && self.center.is_none()
    }

    /// Returns whether a straight segment can touch the corner: it cannot where the corner of a
    /// solid is concave.
    #[inline]
    #[must_use]
    pub(crate) fn is_exposed(&self, corner: &Corner) -> bool {
        !self.solid || corner.is_convex()
    }

    /// The gap to this body of a centre line at `distance` (m), along `normal`.
    #[inline]
    #[must_use]
    pub fn gap(&self, feature: usize, distance: f64, normal: Vec2, point: Vec2) -> Gap {
        Gap {
            gap_m: distance - self.offset,
            normal,
            point,
            fraction: 0.0,
            friction: self.friction,
            obstacle: self.obstacle,
            feature,
        }
    }

    /// The gap of a point to this body alone, if no larger than `reach` (m).
    #[must_use]
    pub fn signed_gap(&self, p: Vec2, reach: f64) -> Option<Gap> {
        if let Some(c) = self.center {
            let gap = self.gap(self.first + 1, (p - c).norm(), unit_or(p - c, Vec2::y()), c);
            return (gap.gap_m <= reach).then_some(gap);
        }
        let NearestEdge { distance: d, edge: k, fraction: f } = self.nearest(p, reach + self.offset)?;
        let e = self.edges[k];
        let at = e.from + (e.to - e.from) * f;
        let corner = if f == 0.0 {
            self.corner(k)
        } else if f == 1.0 {
            self.corner(if k + 1 == self.edges.len() && self.closed { 0 } else { k + 1 })
        } else {
            None
        };
        let side = match corner {
            _ if !self.solid => 1.0,
            // Points below the end of an open ground line are inside, points beyond it are outside.
            Some(Corner { before: None, .. }) if p.x >= at.x => (p - at).dot(&e.normal()).signum(),
            Some(Corner { after: None, .. }) if p.x <= at.x => (p - at).dot(&e.normal()).signum(),
            Some(c) if c.is_convex() => 1.0,
            Some(_) => -1.0,
            None => (p - e.from).dot(&e.normal()).signum(),
        };
        // Beside an edge the normal is that of the edge: for a point on the edge, p − at would be
        // only rounding.
        let normal = match corner {
            Some(_) => unit_or((p - at) * side, e.normal()),
            None if self.solid || (p - e.from).dot(&e.normal()) >= 0.0 => e.normal(),
            None => -e.normal(),
        };
        let gap = self.gap(corner.map_or(self.first + 2 * k, |c| c.feature), d * side, normal, at);
        Some(gap)
    }

    /// The edge nearest to a point within `most` (m).
    fn nearest(&self, p: Vec2, most: f64) -> Option<NearestEdge> {
        let to_box = |node: &BvhNode, _: f64| {
            let (low, high) = (node.mins(), node.maxs());
            let out = |x: f64, low: f64, high: f64| {
                if x < low {
                    low - x
                } else if x > high {
                    x - high
                } else {
                    0.0
                }
            };
            out(p.x, low.x, high.x).hypot(out(p.y, low.y, high.y))
        };
        let to_edge = |k: u32, _: f64| {
            let e = self.edges.get(k as usize)?;
            let f = nearest_fraction(p, e.from, e.to);
            Some(((p - (e.from + (e.to - e.from) * f)).norm(), f))
        };
        let Some(bvh) = &self.bvh else {
            let of = |edge: usize| {
                let (distance, fraction) = to_edge(u32::try_from(edge).ok()?, 0.0)?;
                Some(NearestEdge { distance, edge, fraction })
            };
            let nearer = |a: NearestEdge, b: NearestEdge| if b.distance < a.distance { b } else { a };
            return (0..self.edges.len()).filter_map(of).reduce(nearer).filter(|n| n.distance <= most);
        };
        let (k, (distance, f)) = bvh.find_best(most.next_up(), to_box, to_edge)?;
        // Of two edges that share the nearest corner, the one with the lower index is taken,
        // whatever the order of the tree.
        let k = k as usize;
        let (edge, fraction) = match f {
            0.0 if k > 0 => (k - 1, 1.0),
            1.0 if self.closed && k + 1 == self.edges.len() => (0, 0.0),
            _ => (k, f),
        };
        Some(NearestEdge { distance, edge, fraction })
    }
}

/// An edge of a body beside a point.
#[derive(Clone, Copy)]
struct NearestEdge {
    /// Distance of the point, m.
    distance: f64,
    /// Index of the edge.
    edge: usize,
    /// Position along the edge, 0 to 1.
    fraction: f64,
}

/// The direction of a vector, or another where it has none.
fn unit_or(v: Vec2, fallback: Vec2) -> Vec2 {
    let n = v.norm();
    if n == 0.0 { fallback } else { v / n }
}

impl Geometry {
    /// Compiles obstacles for a cable of the given friction and radius (m).
    #[must_use]
    pub fn new(obstacles: &[Obstacle], cable_friction: f64, cable_radius: f64) -> Self {
        let mut bodies: Vec<Body> = Vec::with_capacity(obstacles.len());
        for (obstacle, o) in obstacles.iter().enumerate() {
            let (points, ends, center, grow) = match &o.shape {
                Shape::Terrain { points_m } => {
                    (left_to_right(clean(points_m, LineEnds::Open)), LineEnds::Open, None, 0.0)
                }
                Shape::Polygon { points_m } => {
                    (clockwise(clean(points_m, LineEnds::Joined)), LineEnds::Joined, None, 0.0)
                }
                Shape::Polyline { points_m, thickness_m } => {
                    (clean(points_m, LineEnds::Open), LineEnds::Open, None, thickness_m / 2.0)
                }
                Shape::Circle { center_m, radius_m } => (Vec::new(), LineEnds::Open, Some(vec2(*center_m)), *radius_m),
            };
            let edges = edges_of(&points, ends);
            if edges.is_empty() && center.is_none() {
                continue;
            }
            let first = bodies.last().map_or(0, |b| b.features().end);
            let leaves = edges.iter().map(|e| {
                let (low, high) = (e.from.inf(&e.to), e.from.sup(&e.to));
                Aabb::new(Vector::new(low.x, low.y), Vector::new(high.x, high.y))
            });
            let bvh = Some(Arc::new(Bvh::from_iter(BvhBuildStrategy::Binned, leaves.enumerate())));
            bodies.push(Body {
                obstacle,
                name: o.name.clone(),
                friction: o.friction.unwrap_or(cable_friction),
                offset: cable_radius + grow,
                edges: Arc::new(edges),
                center,
                first,
                solid: !matches!(o.shape, Shape::Polyline { .. }),
                closed: ends == LineEnds::Joined,
                bvh,
                moves: false,
            });
        }
        Self { bodies }
    }

    /// Adds a movable outline for a cable of this radius (m); `obstacle` is its number as a body.
    pub(crate) fn add_outline(&mut self, outline: &Outline, obstacle: usize, cable_radius: f64) {
        self.bodies.push(Body {
            obstacle,
            name: outline.name.clone(),
            friction: outline.friction,
            offset: cable_radius,
            edges: Arc::new(outline.edges(outline.placement).map(|[p, q]| Edge::between(p, q)).collect()),
            center: None,
            first: self.bodies.last().map_or(0, |b| b.features().end),
            solid: true,
            closed: true,
            bvh: None,
            moves: true,
        });
    }

    /// Moves the outline that was added last to its present pose.
    pub(crate) fn place_outline(&mut self, outline: &Outline, placement: RigidPose) {
        let Some(body) = self.bodies.last_mut().filter(|b| b.bvh.is_none()) else { return };
        for (edge, [p, q]) in Arc::make_mut(&mut body.edges).iter_mut().zip(outline.edges(placement)) {
            *edge = Edge::between(p, q);
        }
    }

    /// Lets a circle, given by its index in the scene, move.
    pub(crate) fn let_move(&mut self, obstacle: usize) {
        self.bodies.iter_mut().filter(|b| b.obstacle == obstacle).for_each(|b| b.moves = true);
    }

    /// Moves the centre of a circle, given by its index in the scene, to a place (m).
    pub(crate) fn place_circle(&mut self, obstacle: usize, center: Vec2) {
        if let Some(at) = self.bodies.iter_mut().find(|b| b.obstacle == obstacle).and_then(|b| b.center.as_mut()) {
            *at = center;
        }
    }

    /// Returns whether the geometry has no feature.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The bodies, in the order of the scene.
    #[inline]
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// All parts that can be nearer than `reach` (m) to a cable inside the box from `low` to `high`
    /// (m), and some more.
    pub fn parts(&self, low: Vec2, high: Vec2, reach: f64) -> impl Iterator<Item = ObstaclePart> {
        let mut bodies = self.bodies.iter().enumerate();
        let mut edges = None;
        // Adaptors that flatten would move the search of a tree, a third of a kilobyte, several
        // times a body.
        std::iter::from_fn(move || {
            loop {
                if let Some((body, found)) = &mut edges
                    && let Some(k) = Iterator::next(found)
                {
                    return Some(ObstaclePart { body: *body, edge: Some(k) });
                }
                let (body, b) = bodies.next()?;
                let r = Vec2::repeat(reach + b.offset);
                let (from, to) = (low - r, high + r);
                if let Some(c) = b.center {
                    edges = None;
                    if (0..2).all(|k| c[k] + r[k] >= low[k] && c[k] - r[k] <= high[k]) {
                        return Some(ObstaclePart { body, edge: None });
                    }
                } else if b.is_near(from, to) {
                    edges = Some((body, b.candidates(from, to)));
                } else {
                    edges = None;
                }
            }
        })
    }

    /// The body that a feature belongs to.
    #[must_use]
    pub(crate) fn body_of(&self, feature: usize) -> Option<&Body> {
        self.bodies.iter().find(|b| b.features().contains(&feature))
    }

    /// Outward direction of the corner that a gap leads to; `None` if it does not lead to a corner
    /// of a solid.
    #[must_use]
    pub(crate) fn outward_of(&self, gap: &Gap) -> Option<Vec2> {
        let body = self.body_of(gap.feature).filter(|b| b.solid)?;
        let local = gap.feature - body.first;
        (local % 2 == 1).then(|| body.corner(local / 2)).flatten().map(|c| c.outward())
    }

    /// See [`super::World::signed_gap`].
    #[must_use]
    pub fn signed_gap(&self, p: Vec2, reach: f64) -> Option<Gap> {
        let mut best: Option<Gap> = None;
        for g in self.bodies.iter().filter_map(|b| b.signed_gap(p, reach)) {
            if best.is_none_or(|b| g.gap_m < b.gap_m) {
                best = Some(g);
            }
        }
        best
    }
}

impl Body {
    fn features(&self) -> Range<usize> {
        self.first..self.first + 2 * self.edges.len() + 2
    }
}

/// The points as vectors, without repeated points, non-finite points and corners that do not turn.
fn clean(points: &[Point], ends: LineEnds) -> Vec<Vec2> {
    let closed = ends == LineEnds::Joined;
    let mut out: Vec<Vec2> = Vec::with_capacity(points.len());
    for p in points.iter().map(|p| vec2(*p)).filter(|p| p.iter().all(|c| c.is_finite())) {
        if out.last() != Some(&p) {
            out.push(p);
        }
    }
    while closed && out.len() > 1 && out.first() == out.last() {
        out.pop();
    }
    let n = out.len();
    let turns = |i: usize| {
        if !closed && (i == 0 || i + 1 == n) {
            return true;
        }
        let (u, v) = (out[i] - out[(i + n - 1) % n], out[(i + 1) % n] - out[i]);
        !(cross(u, v).abs() <= MIN_EDGE_TURN * u.norm() * v.norm() && u.dot(&v) > 0.0)
    };
    (0..n).filter(|&i| turns(i)).map(|i| out[i]).collect()
}

fn left_to_right(mut points: Vec<Vec2>) -> Vec<Vec2> {
    if points.first().zip(points.last()).is_some_and(|(a, b)| a.x > b.x) {
        points.reverse();
    }
    points
}

/// The corners in clockwise order.
fn clockwise(mut points: Vec<Vec2>) -> Vec<Vec2> {
    // Twice the area about the first corner, so that a polygon far from the origin keeps its
    // digits.
    let Some(&o) = points.first() else { return points };
    let area: f64 = points.windows(2).map(|w| cross(w[0] - o, w[1] - o)).sum();
    if area > 0.0 {
        points.reverse();
    }
    points
}

/// The edges of a line of points; none if it is too short.
fn edges_of(points: &[Vec2], ends: LineEnds) -> Vec<Edge> {
    let closed = ends == LineEnds::Joined;
    let n = points.len();
    if n < 2 || (closed && n < 3) {
        return Vec::new();
    }
    let count = if closed { n } else { n - 1 };
    (0..count)
        .map(|i| {
            let (p, q) = (points[i], points[(i + 1) % n]);
            Edge::between(p, q)
        })
        .collect()
}
