//! This test tells whether a cable has passed through something between two shapes.
//!
//! The old shape and back along the new one is a closed way; what it goes round was passed through.
//! Corners and posts are looked at: nothing thinner is an obstacle.

use super::World;
use crate::math::{Vec2, cross};

/// A point no cable passes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpassableCorner {
    /// Its place, m.
    pub at: Vec2,
    /// Index of the body.
    pub body: usize,
    /// Its feature; that of the whole post for all its points.
    pub feature: usize,
}

/// Convex corners and the middles of posts, in order of x.
#[must_use]
pub fn corners(world: &World) -> Vec<ImpassableCorner> {
    let mut out = Vec::new();
    for (body, b) in world.geometry().bodies().iter().enumerate() {
        out.extend(b.center.map(|at| ImpassableCorner { at, body, feature: b.first + 1 }));
        let jutting = (0..=b.edges.len()).filter_map(|k| b.corner(k)).filter(|c| b.is_exposed(c));
        out.extend(jutting.map(|c| ImpassableCorner { at: c.at, body, feature: c.feature }));
    }
    out.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
    out
}

/// A corner that lies between the old shape and the new one, the farthest from the new one.
/// `corners`: in order of x; `turns`: memory.
///
/// The winding number of the closed way round a corner is the number of its passes above it to the
/// right, less those to the left.
pub fn through(
    corners: &[ImpassableCorner],
    old: &[Vec2],
    new: &[Vec2],
    turns: &mut Vec<i32>,
) -> Option<ImpassableCorner> {
    let (low, high) = old.iter().chain(new).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
        (if p.x < low { p.x } else { low }, if p.x > high { p.x } else { high })
    });
    let first = corners.partition_point(|c| c.at.x < low);
    let corners = corners.get(first..corners.partition_point(|c| c.at.x <= high))?;
    turns.clear();
    turns.resize(corners.len(), 0);
    let mut pass = |a: Vec2, b: Vec2| {
        let (left, right, sign) = if a.x <= b.x { (a, b, 1) } else { (b, a, -1) };
        let from = corners.partition_point(|c| c.at.x < left.x);
        for (c, turns) in corners.iter().zip(turns.iter_mut()).skip(from).take_while(|(c, _)| c.at.x < right.x) {
            if cross(right - left, c.at - left) < 0.0 {
                *turns += sign;
            }
        }
    };
    let (Some(&start), Some(&end)) = (old.first(), old.last()) else { return None };
    old.windows(2).for_each(|w| pass(w[0], w[1]));
    new.windows(2).for_each(|w| pass(w[1], w[0]));
    // The ends, where they moved.
    if let (Some(&a), Some(&b)) = (new.first(), new.last()) {
        pass(end, b);
        pass(a, start);
    }
    let mut best: Option<(f64, ImpassableCorner)> = None;
    for (c, _) in corners.iter().zip(turns.iter()).filter(|(_, t)| **t != 0) {
        let far = new.iter().map(|p| (p - c.at).norm()).fold(f64::INFINITY, |a, b| if b < a { b } else { a });
        if best.is_none_or(|b| far > b.0) {
            best = Some((far, *c));
        }
    }
    best.map(|b| b.1)
}
