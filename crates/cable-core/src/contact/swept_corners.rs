//! This test tells whether a cable has passed through an obstacle between two shapes.
//!
//! The old shape, followed by the new shape backwards, is a closed curve, and the cable has passed
//! through every obstacle that the curve encloses. Corners and posts are tested; there are no
//! thinner obstacles.

use super::World;
use crate::math::{Vec2, cross};

/// A point that no cable can pass through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpassableCorner {
    /// Its position, m.
    pub at: Vec2,
    /// Index of the body.
    pub body: usize,
    /// Its feature; all points of a post have the feature of the post.
    pub feature: usize,
}

/// Convex corners and the centres of posts, in order of x.
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

/// The corner between the old and the new shape that is farthest from the new one. `corners` are in
/// order of x; `turns` is reused memory.
///
/// The winding number of the closed curve about a corner is the number of times that it passes
/// above the corner to the right, minus the number of times to the left.
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
    // The ends are joined where they have moved.
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
