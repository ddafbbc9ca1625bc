//! A curve is the boundary of an obstacle as the centre line of the cable runs along it, with a
//! coordinate p that grows along the cable.
//!
//! The centre line runs at the offset c (cable radius plus the obstacle's own offset) from the
//! obstacle. On an edge p counts metres, on an arc (a convex corner, a post, a wheel) radians, so a
//! sharp corner needs no special case. With the sense σ = +1 where the solid lies right of travel
//! and −1 where it lies left, t the direction of travel and n the outward normal,
//!
//! ```text
//! n = σ perp t        edge: x = x₀ + t p        arc: x = C + c n,  dt/dp = −n,  dn/dp = t
//! ```
//!
//! A concave kink is a break: a cable in tension bridges it by a free span. So is an edge on to
//! which the load does not press the cable (b·n ≥ 0: walls, undersides): the cable hangs beside it
//! by a free span from corner to corner. The pieces between two breaks are a chain; a contact never
//! leaves its chain. Beyond the ends of its chain the curve continues straight or round, so that
//! Newton's method may evaluate it there; the search for penetration finds obstacles that this
//! would cut.

use std::sync::Arc;

use crate::contact::geometry::{Body, Edge};
use crate::math::{Vec2, bounded, cross, perp, sin_cos};

/// Distance (m) from a boundary within which a support lies on it.
pub(in crate::model::spans) const SUPPORT_CONTACT_DISTANCE_M: f64 = 1e-9;
/// Normal component of the load, as a fraction of it, above which an edge holds the cable. Smaller:
/// a wall tilted by round-off would hold a cable that hangs beside it. Larger: floors steeper than
/// 89.99° would not hold.
const PRESSING_FRACTION: f64 = 1e-9;

/// Angle (rad) by which a direction may be beyond the end of an arc (round-off).
const ARC_END_TOLERANCE: f64 = 1e-9;

/// The form of a piece of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) enum PieceShape {
    /// A straight piece.
    Edge {
        /// Start, m.
        from: Vec2,
        /// Direction of travel, a unit vector.
        tangent: Vec2,
    },
    /// A round piece, always convex.
    Arc {
        /// Centre, m.
        center: Vec2,
        /// Radius of the centre line, m; 0 = a point.
        radius: f64,
        /// Direction of the tangent at its start, a unit vector.
        from: Vec2,
    },
}

/// A piece of the curve.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct BoundaryPiece {
    pub form: PieceShape,
    /// Extent: m on an edge, rad on an arc.
    pub extent: f64,
    /// True if a concave kink lies before it.
    pub kink_before: bool,
    /// Index of the obstacle's feature to which it belongs; None for a wheel.
    pub feature: Option<usize>,
}

/// A boundary, in one sense of travel.
#[derive(Clone, Debug)]
pub(in crate::model::spans) struct Curve {
    /// Index of the obstacle in the scene; None for a wheel.
    pub obstacle: Option<usize>,
    /// Coulomb friction coefficient.
    pub friction: f64,
    /// +1 if the solid is right of the direction of travel, −1 if it is left of it.
    pub sense: f64,
    /// Displacement from the scene's position, m (of a moving wheel).
    pub shift: Vec2,
    /// Shared by all copies, because scanned ground has a million pieces.
    pieces: Arc<[BoundaryPiece]>,
    starts: Arc<[f64]>,
    /// One turn of a closed boundary in p.
    period: Option<f64>,
}

/// Index range of the pieces of a chain, counted over the turns of a closed boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) struct ChainRange {
    pub first: i64,
    pub last: i64,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct BoundaryPoint {
    pub at: Vec2,
    pub tangent: Vec2,
    pub normal: Vec2,
    /// d(length)/dp, m: 1 on an edge, c on an arc.
    pub stretch: f64,
    /// d(angle of the tangent)/dp.
    pub turn: f64,
}

/// The direction of an angle.
fn direction(angle: f64) -> Vec2 {
    turned(Vec2::x(), angle)
}

/// A vector turned by an angle, rad.
fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = sin_cos(angle);
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

impl Curve {
    /// Both senses of a body's boundary: solid right of travel, then left.
    pub fn both(body: &Body) -> [Self; 2] {
        let c = body.offset;
        let (pieces, closed) = match body.center {
            Some(center) => {
                let arc = PieceShape::Arc { center, radius: c, from: Vec2::x() };
                let extent = f64::INFINITY;
                (vec![BoundaryPiece { form: arc, extent, kink_before: false, feature: Some(body.first + 1) }], false)
            }
            None => boundary(body, c),
        };
        let forward = Self::new(pieces, closed, Some(body.obstacle), body.friction, 1.0);
        let back = forward.reversed();
        [forward, back]
    }

    /// A wheel of a radius (of the centre line, m) about the origin; shift it to its place.
    pub fn wheel(radius: f64, friction: f64, sense: f64) -> Self {
        let form = PieceShape::Arc { center: Vec2::zeros(), radius, from: Vec2::x() };
        let piece = BoundaryPiece { form, extent: f64::INFINITY, kink_before: false, feature: None };
        let closed = false;
        Self::new(vec![piece], closed, None, friction, sense)
    }

    /// A boundary of these pieces in order.
    fn new(pieces: Vec<BoundaryPiece>, closed: bool, obstacle: Option<usize>, friction: f64, sense: f64) -> Self {
        let mut starts = Vec::with_capacity(pieces.len());
        let mut sum = 0.0;
        for p in &pieces {
            starts.push(sum);
            sum += p.extent;
        }
        let period = closed.then_some(sum);
        let (pieces, starts) = (pieces.into(), starts.into());
        Self { obstacle, friction, sense, shift: Vec2::zeros(), pieces, starts, period }
    }

    /// The same boundary travelled the other way.
    fn reversed(&self) -> Self {
        let n = self.pieces.len();
        let back = |k: usize| {
            let p = self.pieces[n - 1 - k];
            let form = match p.form {
                PieceShape::Edge { from, tangent } => {
                    PieceShape::Edge { from: from + tangent * p.extent, tangent: -tangent }
                }
                PieceShape::Arc { center, radius, from } if p.extent.is_infinite() => {
                    PieceShape::Arc { center, radius, from }
                }
                PieceShape::Arc { center, radius, from } => {
                    PieceShape::Arc { center, radius, from: -turned(from, -self.sense * p.extent) }
                }
            };
            // The kink after a piece is now the kink before it.
            let kink_before = self.pieces.get(n - k).or(self.pieces.first()).is_some_and(|next| next.kink_before);
            BoundaryPiece { form, kink_before, ..p }
        };
        let pieces = (0..n).map(back).collect();
        Self::new(pieces, self.period.is_some(), self.obstacle, self.friction, -self.sense)
    }

    /// True if it is round all the way: a post or a wheel.
    pub fn is_round(&self) -> bool {
        matches!(self.pieces[..], [BoundaryPiece { form: PieceShape::Arc { .. }, .. }])
    }

    /// The indices of its pieces in the first turn.
    pub fn pieces(&self) -> impl Iterator<Item = i64> + use<> {
        0..self.pieces.len() as i64
    }

    /// The piece of an index that is counted over the turns.
    pub fn piece(&self, i: i64) -> &BoundaryPiece {
        // The first turn needs no division.
        let k = i as usize;
        if k < self.pieces.len() {
            &self.pieces[k]
        } else {
            &self.pieces[i.rem_euclid(self.pieces.len() as i64) as usize]
        }
    }

    /// True if a piece is an arc.
    pub fn is_arc(&self, i: i64) -> bool {
        matches!(self.piece(i).form, PieceShape::Arc { .. })
    }

    /// Start of a piece in p.
    pub fn origin(&self, i: i64) -> f64 {
        if let Some(start) = self.starts.get(i as usize) {
            return *start;
        }
        let n = self.pieces.len() as i64;
        let turns = i.div_euclid(n);
        self.starts[i.rem_euclid(n) as usize] + if turns == 0 { 0.0 } else { turns as f64 * self.period.unwrap_or(0.0) }
    }

    /// End of a piece in p.
    pub fn end(&self, i: i64) -> f64 {
        self.origin(i) + self.piece(i).extent
    }

    /// The index of the piece of a chain at p; beyond its ends the first or last piece.
    pub fn locate(&self, p: f64, chain_range: ChainRange) -> i64 {
        let (mut i, mut last) = (chain_range.first, chain_range.last);
        while i < last {
            let middle = i + (last - i + 1) / 2;
            if self.origin(middle) <= p {
                i = middle;
            } else {
                last = middle - 1;
            }
        }
        i
    }

    /// The point at p.
    pub fn place(&self, p: f64, chain_range: ChainRange) -> BoundaryPoint {
        let i = self.locate(p, chain_range);
        self.place_on(i, p - self.origin(i))
    }

    /// The point at x on piece i.
    pub fn place_on(&self, i: i64, x: f64) -> BoundaryPoint {
        match self.piece(i).form {
            PieceShape::Edge { from, tangent } => BoundaryPoint {
                at: self.shift + from + tangent * x,
                tangent,
                normal: perp(tangent) * self.sense,
                stretch: 1.0,
                turn: 0.0,
            },
            PieceShape::Arc { center, radius, from } => {
                let tangent = turned(from, -self.sense * x);
                let normal = perp(tangent) * self.sense;
                BoundaryPoint {
                    at: self.shift + center + normal * radius,
                    tangent,
                    normal,
                    stretch: radius,
                    turn: -self.sense,
                }
            }
        }
    }

    /// Length from `a` to `b` along the curve, m.
    pub fn length(&self, a: f64, b: f64, chain_range: ChainRange) -> f64 {
        let (i, j) = (self.locate(a, chain_range), self.locate(b, chain_range));
        let weight = |k: i64| match self.piece(k).form {
            PieceShape::Edge { .. } => 1.0,
            PieceShape::Arc { radius, .. } => radius,
        };
        if i == j {
            return (b - a) * weight(i);
        }
        if i > j {
            return -self.length(b, a, chain_range);
        }
        let inner: f64 = (i + 1..j).map(|k| self.piece(k).extent * weight(k)).sum();
        (self.origin(i + 1) - a) * weight(i) + inner + (b - self.origin(j)) * weight(j)
    }

    /// True if the cable can lie on a piece under a load per metre.
    fn supports_cable(&self, i: i64, load: Vec2) -> bool {
        let piece = self.piece(i);
        match piece.form {
            PieceShape::Edge { tangent, .. } => {
                piece.extent > 0.0 && -load.dot(&perp(tangent)) * self.sense > PRESSING_FRACTION * load.norm()
            }
            PieceShape::Arc { .. } => true,
        }
    }

    /// The chain to which a piece belongs and the index of the piece in it; None if it cannot hold
    /// a cable. A chain of a closed boundary is always counted from the same turn.
    pub fn chain(&self, i: i64, load: Vec2) -> Option<(i64, ChainRange)> {
        if !self.supports_cable(i, load) {
            return None;
        }
        let n = self.pieces.len() as i64;
        let open = self.period.is_none();
        let (mut first, mut last) = (i, i);
        while last - first < n
            && !(open && first == 0)
            && !self.piece(first).kink_before
            && self.supports_cable(first - 1, load)
        {
            first -= 1;
        }
        while last - first < n
            && !(open && last == n - 1)
            && !self.piece(last + 1).kink_before
            && self.supports_cable(last + 1, load)
        {
            last += 1;
        }
        let turn = first.rem_euclid(n) - first;
        Some((i + turn, ChainRange { first: first + turn, last: last + turn }))
    }

    /// The piece beyond the kink at the start (side 0) or the end of a chain; None if there is
    /// none.
    pub fn beyond_kink(&self, chain_range: ChainRange, side: usize) -> Option<i64> {
        let (i, after) = if side == 0 {
            (chain_range.first - 1, chain_range.first)
        } else {
            (chain_range.last + 1, chain_range.last + 1)
        };
        let there = self.period.is_some() || (i >= 0 && i < self.pieces.len() as i64);
        (there && !self.is_round() && self.piece(after).kink_before).then_some(i)
    }

    /// The piece of one turn that belongs to a feature of the obstacle; if there are several, the
    /// nearest to a point.
    pub fn piece_of(&self, feature: usize, at: Vec2) -> Option<i64> {
        let mut best: Option<(f64, i64)> = None;
        for k in (0..self.pieces.len()).filter(|&k| self.pieces[k].feature == Some(feature)) {
            let i = k as i64;
            let d = (self.place_on(i, self.project(i, at) - self.origin(i)).at - at).norm();
            if best.is_none_or(|(b, _)| d < b) {
                best = Some((d, i));
            }
        }
        best.map(|b| b.1)
    }

    /// The corner at an end of edge i that is nearer to a point.
    pub fn corner_beside(&self, i: i64, at: Vec2) -> Option<i64> {
        let n = self.pieces.len() as i64;
        let beside = [i - 1, i + 1].into_iter().filter(|&k| self.period.is_some() || (k >= 0 && k < n));
        let corner = |k: &i64| matches!(self.piece(*k).form, PieceShape::Arc { .. });
        let far = |k: &i64| (self.place_on(*k, 0.5 * self.piece(*k).extent).at - at).norm();
        beside.filter(corner).min_by(|a, b| far(a).total_cmp(&far(b))).map(|k| k.rem_euclid(n))
    }

    /// p of a point that lies on a chain, within a distance (m).
    pub fn on_chain(&self, chain_range: ChainRange, at: Vec2, within: f64) -> Option<f64> {
        (chain_range.first..=chain_range.last).find_map(|i| {
            let p = self.project(i, at);
            ((self.place_on(i, p - self.origin(i)).at - at).norm() <= within).then_some(p)
        })
    }

    /// p of the point of piece i nearest to `at`.
    pub fn project(&self, i: i64, at: Vec2) -> f64 {
        let piece = self.piece(i);
        let x = match piece.form {
            PieceShape::Edge { from, tangent } => bounded((at - self.shift - from).dot(&tangent), 0.0, piece.extent),
            PieceShape::Arc { center, from, .. } => {
                // n = σ perp t, with t measured as an angle from −σ x.
                let n = at - self.shift - center;
                let tangent = -perp(n) * self.sense;
                self.arc_at(from, piece.extent, tangent)
            }
        };
        self.origin(i) + x
    }

    /// p on arc i at which its tangent has the direction `along`, limited to the arc (on a post:
    /// within half a turn of 0).
    pub fn with_tangent(&self, i: i64, along: Vec2) -> f64 {
        let piece = self.piece(i);
        let x = match piece.form {
            PieceShape::Edge { .. } => 0.0,
            PieceShape::Arc { from, .. } => self.arc_at(from, piece.extent, along),
        };
        self.origin(i) + x
    }

    /// Calls back with each place between p and q on arc i at which its tangent has the direction
    /// `along`.
    pub fn running(&self, i: i64, along: Vec2, p: f64, q: f64, mut each: impl FnMut(f64)) {
        let PieceShape::Arc { from, .. } = self.piece(i).form else { return };
        let turn = std::f64::consts::TAU;
        let mut x = self.origin(i) - self.sense * cross(from, along).atan2(from.dot(&along));
        x += ((p - x) / turn).ceil() * turn;
        while x < q {
            each(x);
            x += turn;
        }
    }

    /// Side of arc i, before its start (−1) or after its end (+1), on which its tangent would have
    /// the direction `along`; 0 if it has it on the arc.
    pub fn beyond_arc(&self, i: i64, along: Vec2) -> i64 {
        let piece = self.piece(i);
        let PieceShape::Arc { from, .. } = piece.form else { return 0 };
        let x = -self.sense * cross(from, along).atan2(from.dot(&along));
        match piece.extent.is_finite() {
            true if x < -ARC_END_TOLERANCE => -1,
            true if x > piece.extent + ARC_END_TOLERANCE => 1,
            _ => 0,
        }
    }

    /// The angle (rad) on an arc at which its tangent is `tangent`, limited to the arc.
    fn arc_at(&self, start: Vec2, extent: f64, tangent: Vec2) -> f64 {
        let x = -self.sense * cross(start, tangent).atan2(start.dot(&tangent));
        if extent.is_infinite() {
            x
        } else if x < -0.5 * (std::f64::consts::TAU - extent) {
            // The far side of the arc is nearer to its end.
            extent
        } else {
            bounded(x, 0.0, extent)
        }
    }
}

/// The pieces of a polygon, ground or thin line at an offset, with the solid right of the direction
/// of travel; and true if it is closed.
fn boundary(body: &Body, c: f64) -> (Vec<BoundaryPiece>, bool) {
    let mut edges: Vec<(Edge, usize)> = Vec::with_capacity(2 * body.edges.len());
    edges.extend(body.edges.iter().enumerate().map(|(k, e)| (*e, k)));
    let loops = body.edges.first().zip(body.edges.last()).is_some_and(|(a, b)| a.from == b.to);
    let closed = !body.is_ground();
    if closed && !loops {
        // A thin line is traversed on both sides: there and back.
        let back = body.edges.iter().enumerate().rev();
        edges.extend(back.map(|(k, e)| (Edge { from: e.to, to: e.from, tangent: -e.tangent }, k)));
    }
    let n = edges.len();
    // The turn at the start of edge k, negative if convex.
    let turn = |k: usize| {
        let (before, after) = (edges[(k + n - 1) % n].0.tangent, edges[k % n].0.tangent);
        let turn = cross(before, after).atan2(before.dot(&after));
        if turn == std::f64::consts::PI { -turn } else { turn }
    };
    let kink = |k: usize| if closed || (k > 0 && k < n) { turn(k).max(0.0) } else { 0.0 };
    let corner_feature = |k: usize| {
        let (e, index) = &edges[k % n];
        body.first + 2 * if e.tangent == body.edges[*index].tangent { *index } else { *index + 1 } + 1
    };
    let mut out = Vec::with_capacity(2 * n + 1);
    for (k, (e, index)) in edges.iter().enumerate() {
        let angle = e.tangent.y.atan2(e.tangent.x);
        let up = std::f64::consts::FRAC_PI_2;
        let (arc_from, arc) =
            if closed || k > 0 { (angle - turn(k).min(0.0), -turn(k).min(0.0)) } else { (up, up - angle) };
        let kink_before = kink(k) > 0.0;
        let first = out.len();
        if arc > 0.0 {
            let form = PieceShape::Arc { center: e.from, radius: c, from: direction(arc_from) };
            out.push(BoundaryPiece { form, extent: arc, kink_before, feature: Some(corner_feature(k)) });
        }
        // A kink shortens both its edges by c tan(δ/2).
        let cut = [kink(k), kink(k + 1)].map(|d| c * (0.5 * d).tan());
        let form = PieceShape::Edge { from: e.from + e.normal() * c + e.tangent * cut[0], tangent: e.tangent };
        let extent = e.length() - cut[0] - cut[1];
        let extent = if extent > 0.0 { extent } else { 0.0 };
        let kink_before = kink_before && out.len() == first;
        out.push(BoundaryPiece { form, extent, kink_before, feature: Some(body.first + 2 * index) });
        if !closed && k + 1 == n && angle > -up {
            let form = PieceShape::Arc { center: e.to, radius: c, from: direction(angle) };
            out.push(BoundaryPiece {
                form,
                extent: angle + up,
                kink_before: false,
                feature: Some(body.first + 2 * n + 1),
            });
        }
    }
    (out, closed)
}
