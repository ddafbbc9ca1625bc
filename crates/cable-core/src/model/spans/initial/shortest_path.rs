//! This module finds the shortest path that keeps the same obstacles on the same sides as a route,
//! including turns round posts.
//!
//! The string's end is moved along the route, and the string between its last corner and the end
//! sweeps a triangle. Two events can happen: the string meets a corner, and then bends round it; or
//! it becomes straight at its last corner, and leaves it. Corners are points here, and posts are a
//! few points well inside them: only the order and the sides are sought, not the places.

use crate::contact::World;
use crate::contact::swept_corners::ImpassableCorner;
use crate::math::{Vec2, cross};

/// Number of points that represent a post. Fewer: a string that turns round it passes between them;
/// more: a search takes longer.
const POST_POINTS: usize = 12;
/// Distance of these points from the centre of the post, as a fraction of its radius: inside it,
/// because routes drawn as polygons cut into it. Smaller: a string that hardly bends round the post
/// misses it; larger: roughly drawn routes pass on the wrong side.
const POST_POINTS_RADIUS_FRACTION: f64 = 0.5;
/// Displacement of the end, as a fraction of a leg, below which nothing is met: otherwise round-off
/// could meet the corner just left again.
const LEAST_DISPLACEMENT_FRACTION: f64 = 1e-12;
/// Maximum number of events along one leg, in multiples of the number of corners.
const MAX_EVENTS_PER_CORNER: usize = 8;

/// A corner the string bends round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct PathCorner {
    pub corner: ImpassableCorner,
    index: usize,
    /// +1 if the string turns right round it (it lies on the right), −1 if left.
    pub sense: f64,
    /// Leg of the route on which it was met.
    pub leg: usize,
}

/// Convex corners and posts.
pub(in crate::model::spans) fn corners(world: &World) -> Vec<ImpassableCorner> {
    let mut out = Vec::new();
    for (body, b) in world.geometry().bodies().iter().enumerate() {
        if let Some(center) = b.center {
            for k in 0..POST_POINTS {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / POST_POINTS as f64).sin_cos();
                let at = center + Vec2::new(cos, sin) * (POST_POINTS_RADIUS_FRACTION * b.offset);
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

/// The corners that the string bends round, in order. None if the search does not end.
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
            if round > MAX_EVENTS_PER_CORNER * (corners.len() + bends.len() + 8) {
                return None;
            }
            let pivot = bends.last().map_or(start, |b| b.corner.at);
            let left = leaves(start, &bends, from, way, done);
            let met = first_corner_met(corners, pivot, bends.last().map(|b| b.index), from, way, done, skip);
            match (left, met) {
                (Some(u), met) if met.as_ref().is_none_or(|m| u <= m.leg_fraction) => {
                    skip = bends.pop().map(|b| b.index);
                    done = u;
                }
                (_, Some(MetCorner { index, leg_fraction: u, .. })) => {
                    // The string turns in the sense in which its end moves round the corner.
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

/// Returns the fraction of the leg at which the string leaves its last corner: its end crosses the
/// line from the corner before through the last one.
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

/// A corner that the string meets.
struct MetCorner {
    index: usize,
    /// Fraction of the leg at which its end is then.
    leg_fraction: f64,
    /// Place of the corner between the pivot (0) and the end (1).
    share: f64,
}

/// The first corner that the string meets: its end goes from `from` along `way`, from the fraction
/// `done` of that on, and it turns about `pivot`, the corner `own`. The corner `skip` was just
/// left.
fn first_corner_met(
    corners: &[ImpassableCorner],
    pivot: Vec2,
    own: Option<usize>,
    from: Vec2,
    way: Vec2,
    done: f64,
    skip: Option<usize>,
) -> Option<MetCorner> {
    let mut first: Option<MetCorner> = None;
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
        let early = if skip == Some(k) { done + LEAST_DISPLACEMENT_FRACTION } else { done };
        if !(u >= early && u <= 1.0) {
            continue;
        }
        let end = from + way * u - pivot;
        // Between the pivot and the end.
        let share = to.dot(&end) / end.norm_squared();
        let is_first = |f: &MetCorner| (u, share) < (f.leg_fraction, f.share);
        if share > 0.0 && share < 1.0 && first.as_ref().is_none_or(is_first) {
            first = Some(MetCorner { index: k, leg_fraction: u, share });
        }
    }
    first
}
