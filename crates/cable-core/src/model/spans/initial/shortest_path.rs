//! The shortest path keeps the same obstacles on the same sides as a route, turns round posts
//! included.
//!
//! The route's end is drawn along it, the string from the last corner it bends round to the end
//! sweeping a triangle. Two things can happen first: a corner comes on to the string, which then
//! bends round it; or the string at its last corner becomes straight and leaves it. Corners are
//! points here, posts a few points well inside them: it is the order and the side that is sought,
//! not the place.

use crate::contact::World;
use crate::contact::swept_corners::ImpassableCorner;
use crate::math::{Vec2, cross};

/// Points that stand for a post.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct PostPolygon {
    pub points: usize,
    /// Part of its radius on which they lie: inside it, as routes drawn as polygons cut into a
    /// post.
    pub part: f64,
}

/// Resolutions of posts: coarse at first, finer where the coarse one shows nothing to lie on and
/// nothing else holds the cable: a string that hardly bends round a post passes between few points
/// far inside it. Nearer at once: routes drawn roughly pass on the wrong side.
pub(in crate::model::spans) const POST_POLYGONS: [PostPolygon; 3] = [
    PostPolygon { points: 12, part: 0.5 },
    PostPolygon { points: 24, part: 0.9 },
    PostPolygon { points: 96, part: 0.99 },
];
/// A move of the end smaller than this part of a leg is no move: the corner just left is not met
/// again by rounding.
const SAME: f64 = 1e-12;
/// Corners met or left along one leg at most, times the number of corners.
const MOST: usize = 8;

/// A corner the string bends round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct PathCorner {
    pub corner: ImpassableCorner,
    index: usize,
    /// +1 where the string turns right round it (it lies on the right), −1 left.
    pub sense: f64,
    /// Leg of the route on which it was met.
    pub leg: usize,
}

/// Convex corners and posts.
pub(in crate::model::spans) fn corners(world: &World, ring: PostPolygon) -> Vec<ImpassableCorner> {
    let mut out = Vec::new();
    for (body, b) in world.geometry().bodies().iter().enumerate() {
        if let Some(center) = b.center {
            for k in 0..ring.points {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / ring.points as f64).sin_cos();
                let at = center + Vec2::new(cos, sin) * (ring.part * b.offset);
                out.push(ImpassableCorner { at, body, feature: b.first + 1 });
            }
        }
        for c in (0..=b.edges.len()).filter_map(|k| b.corner(k)) {
            if b.is_exposed(&c) {
                out.push(ImpassableCorner { at: c.at, body, feature: c.feature });
            }
        }
    }
    out
}

/// The bodies that the string bends round, in order. None where it finds no end.
pub(in crate::model::spans) fn taut_string(route: &[Vec2], corners: &[ImpassableCorner]) -> Option<Vec<PathCorner>> {
    let start = *route.first()?;
    let mut bends: Vec<PathCorner> = Vec::new();
    for (leg, w) in route.windows(2).enumerate() {
        let (from, way) = (w[0], w[1] - w[0]);
        if way.norm() == 0.0 {
            continue;
        }
        let (mut done, mut skip) = (0.0, None);
        for round in 0.. {
            if round > MOST * (corners.len() + bends.len() + 8) {
                return None;
            }
            let pivot = bends.last().map_or(start, |b| b.corner.at);
            let left = leaves(start, &bends, from, way, done);
            let met = meets(corners, pivot, bends.last().map(|b| b.index), from, way, done, skip);
            match (left, met) {
                (Some(u), met) if met.is_none_or(|(v, _)| u <= v) => {
                    skip = bends.pop().map(|b| b.index);
                    done = u;
                }
                (_, Some((u, index))) => {
                    // It turns the way the end goes round the corner.
                    let sense = -cross(from + way * u - pivot, way).signum();
                    bends.push(PathCorner { corner: corners[index], index, sense, leg });
                    (done, skip) = (u, None);
                }
                _ => break,
            }
        }
    }
    Some(bends)
}

/// Returns when the string leaves its last corner: the end crosses the line from the corner before
/// through it.
fn leaves(start: Vec2, bends: &[PathCorner], from: Vec2, way: Vec2, done: f64) -> Option<f64> {
    let last = bends.last()?;
    let before = bends.len().checked_sub(2).and_then(|k| bends.get(k)).map_or(start, |b| b.corner.at);
    let along = last.corner.at - before;
    // Turned to the right: the cross product is negative while it bends.
    let turned = |u: f64| -last.sense * cross(along, from + way * u - last.corner.at);
    let rate = -last.sense * cross(along, way);
    if rate >= 0.0 {
        return None;
    }
    let u = -turned(0.0) / rate;
    let u = if u > done { u } else { done };
    (u <= 1.0).then_some(u)
}

/// The first corner the string meets: how far along the leg, and which.
fn meets(
    corners: &[ImpassableCorner],
    pivot: Vec2,
    own: Option<usize>,
    from: Vec2,
    way: Vec2,
    done: f64,
    skip: Option<usize>,
) -> Option<(f64, usize)> {
    let mut best: Option<(f64, f64, usize)> = None;
    for (k, c) in corners.iter().enumerate() {
        if Some(k) == own {
            continue;
        }
        let to = c.at - pivot;
        let rate = cross(to, way);
        if rate == 0.0 || to.norm_squared() == 0.0 {
            continue;
        }
        let u = -cross(to, from - pivot) / rate;
        let early = if skip == Some(k) { done + SAME } else { done };
        if !(u >= early && u <= 1.0) {
            continue;
        }
        let end = from + way * u - pivot;
        // Between the pivot and the end.
        let share = to.dot(&end) / end.norm_squared();
        if share > 0.0 && share < 1.0 && best.is_none_or(|b| (u, share) < (b.0, b.1)) {
            best = Some((u, share, k));
        }
    }
    best.map(|b| (b.0, b.2))
}
