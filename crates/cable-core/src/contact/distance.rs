//! These functions measure unsigned distances between points and segments, degenerate ones
//! included.

use crate::math::{Vec2, cross};

/// Position (0 to 1) along the segment `a`–`b` of the point nearest to `p`; 0 for a segment of no
/// length.
#[must_use]
pub(crate) fn nearest_fraction(p: Vec2, a: Vec2, b: Vec2) -> f64 {
    let d = b - a;
    let dd = d.norm_squared();
    // The test is written so that a segment of no length (0/0) lands on `a`, while NaN input
    // propagates.
    if dd == 0.0 { 0.0 } else { ((p - a).dot(&d) / dd).clamp(0.0, 1.0) }
}

/// The vector from the nearest point of a segment to a point, m.
#[must_use]
pub(crate) fn from_segment(p: Vec2, a: Vec2, b: Vec2) -> Vec2 {
    p - (a + (b - a) * nearest_fraction(p, a, b))
}

/// Distance of a point from a segment, m.
#[must_use]
pub(crate) fn point_segment(p: Vec2, a: Vec2, b: Vec2) -> f64 {
    from_segment(p, a, b).norm()
}

/// The shortest vector from the segment `p`–`q` to the segment `a`–`b`, m; zero when they cross or
/// touch.
#[must_use]
pub(crate) fn between_segments(a: Vec2, b: Vec2, p: Vec2, q: Vec2) -> Vec2 {
    if cross_properly(a, b, p, q) {
        return Vec2::zeros();
    }
    // Segments that do not cross are nearest at an end of one of them.
    let mut way = from_segment(a, p, q);
    let mut least = way.norm_squared();
    for other in [from_segment(b, p, q), -from_segment(p, a, b), -from_segment(q, a, b)] {
        let square = other.norm_squared();
        // NaN is kept.
        if !(square >= least) && !least.is_nan() {
            (way, least) = (other, square);
        }
    }
    way
}

/// Distance between two segments, m; 0 when they cross or touch.
#[must_use]
pub(crate) fn segment_segment(a: Vec2, b: Vec2, p: Vec2, q: Vec2) -> f64 {
    between_segments(a, b, p, q).norm()
}

/// Returns whether the open segments `a`–`b` and `p`–`q` cross in one point.
#[must_use]
pub fn cross_properly(a: Vec2, b: Vec2, p: Vec2, q: Vec2) -> bool {
    let side = |u: Vec2, v: Vec2, w: Vec2| cross(v - u, w - u);
    side(a, b, p) * side(a, b, q) < 0.0 && side(p, q, a) * side(p, q, b) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degenerate_segments_have_point_distances() {
        let (o, x) = (Vec2::zeros(), Vec2::new(3.0, 0.0));
        assert_eq!(point_segment(Vec2::new(0.0, 4.0), o, o), 4.0);
        assert_eq!(segment_segment(o, o, x, x), 3.0);
        assert_eq!(segment_segment(o, x, Vec2::new(1.0, -1.0), Vec2::new(1.0, 1.0)), 0.0);
        assert_eq!(segment_segment(o, x, Vec2::new(1.0, 0.0), Vec2::new(2.0, 0.0)), 0.0);
        assert_eq!(segment_segment(o, x, Vec2::new(1.0, 2.0), Vec2::new(5.0, 2.0)), 2.0);
    }

    #[test]
    fn nan_propagates() {
        assert!(point_segment(Vec2::new(f64::NAN, 0.0), Vec2::zeros(), Vec2::new(1.0, 0.0)).is_nan());
    }
}
