//! These functions find crossings of segments without code of the models.

use cable_core::Vec2;

/// Returns whether the open segments `a`–`b` and `p`–`q` cross in one point.
pub fn cross_properly(a: Vec2, b: Vec2, p: Vec2, q: Vec2) -> bool {
    let side = |u: Vec2, v: Vec2, w: Vec2| (v - u).perp(&(w - u));
    side(a, b, p) * side(a, b, q) < 0.0 && side(p, q, a) * side(p, q, b) < 0.0
}
