//! Scalar and vector names of the core: f64 everywhere, x to the right, y up.

/// A plane vector or point, in the unit the field says.
pub type Vec2 = nalgebra::Vector2<f64>;
/// A 2×2 matrix.
pub type Mat2 = nalgebra::Matrix2<f64>;
/// A point as a scene file writes it: `[x, y]`.
pub type Point = [f64; 2];

/// A file's point as a vector.
#[must_use]
pub fn vec2(p: Point) -> Vec2 {
    Vec2::new(p[0], p[1])
}

/// The vector turned by +90° (counter-clockwise).
#[must_use]
pub fn perp(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// The z component of the cross product `a × b`.
#[must_use]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}
