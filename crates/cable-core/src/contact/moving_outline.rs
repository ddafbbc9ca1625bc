//! The outline of a robot is an obstacle that moves as a whole.
//!
//! In a `Geometry` it is an additional body, the last one. It is moved to its pose before every
//! step, and stands still while the step is solved.

use super::distance::{cross_properly, point_segment, segment_segment};
use crate::math::{Point, RigidPose, Vec2, cross, larger, vec2};
use crate::scene::Shape;

/// Distance of a point that is outside for certain, in greatest distances of a corner from the
/// origin (at least 1 m). Smaller, below 1: it may lie inside; larger: rounding.
const OUTSIDE_DISTANCE_FACTOR: f64 = 4.0;
/// Slope of the ray to that point. Zero would lead along the edges of most outlines, and a ray
/// through a corner may count it twice; any other slope will do.
const RAY_SLOPE: f64 = 0.6;

/// Depth to which a round or thick obstacle may reach into an outline that it touches, m. Smaller:
/// rounding of what stands on it counts; larger: shallow overlaps are not spoken of.
const TOUCHING_DEPTH_M: f64 = 1e-3;

/// A closed outline, solid inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    corners: Vec<Vec2>,
    /// Pose at the start.
    pub placement: RigidPose,
    /// Coulomb friction coefficient with the cable.
    pub friction: f64,
    /// Point at which the cable hangs on it, in its own axes, m.
    pub hitch: Vec2,
    /// Name of the robot that it belongs to.
    pub name: String,
}

impl Outline {
    /// Returns whether both start at the same pose with the same corners and the same hitch.
    #[must_use]
    pub(crate) fn is_shaped_like(&self, other: &Self) -> bool {
        self.corners == other.corners && self.hitch == other.hitch && self.placement == other.placement
    }

    /// An outline, given by its corners and its hitch in its own axes (m); `None` if the corners
    /// enclose no area.
    #[must_use]
    pub fn new(corners: &[Vec2], hitch: Vec2, placement: RigidPose, friction: f64, name: String) -> Option<Self> {
        let mut outline: Vec<Vec2> = Vec::with_capacity(corners.len());
        for c in corners.iter().filter(|c| c.iter().all(|v| v.is_finite())) {
            if outline.last() != Some(c) {
                outline.push(*c);
            }
        }
        while outline.len() > 1 && outline.first() == outline.last() {
            outline.pop();
        }
        let origin = outline.first().copied()?;
        let area: f64 = outline.windows(2).map(|w| cross(w[0] - origin, w[1] - origin)).sum();
        if !(area.abs() > 0.0) {
            return None;
        }
        if area > 0.0 {
            outline.reverse();
        }
        Some(Self { corners: outline, placement, friction, hitch, name })
    }

    /// The edges at a placement, clockwise, m.
    pub fn edges(&self, placement: RigidPose) -> impl Iterator<Item = [Vec2; 2]> {
        let n = self.corners.len();
        (0..n).map(move |k| [self.corners[k], self.corners[(k + 1) % n]].map(|p| placement.place(p)))
    }

    /// Returns whether a chain of points (m) is farther than `least` (m) from the outline at a
    /// placement.
    #[must_use]
    pub(crate) fn is_clear(&self, placement: RigidPose, chain: impl Iterator<Item = Vec2>, least: f64) -> bool {
        let far = self.corners.iter().map(|c| c.norm()).fold(0.0, larger) + least;
        let mut before: Option<Vec2> = None;
        for p in chain {
            let from = before.replace(p).unwrap_or(p);
            let distance = point_segment(placement.at, from, p);
            if !(distance > far) && self.edges(placement).any(|[a, b]| !(segment_segment(from, p, a, b) > least)) {
                return false;
            }
        }
        true
    }

    /// Returns whether an obstacle other than terrain reaches into the outline at a placement.
    #[must_use]
    pub(crate) fn overlaps(&self, placement: RigidPose, shape: &Shape) -> bool {
        let line = |points: &[Point]| points.iter().map(|p| vec2(*p)).collect::<Vec<_>>();
        let (ring, radius) = match shape {
            Shape::Terrain { .. } => return false,
            Shape::Polygon { points_m } => {
                let mut ring = line(points_m);
                ring.extend(points_m.first().map(|p| vec2(*p)));
                (ring, 0.0)
            }
            Shape::Polyline { points_m, thickness_m } => (line(points_m), 0.5 * thickness_m),
            Shape::Circle { center_m, radius_m } => (line(&[*center_m]), *radius_m),
        };
        let crosses = |a: Vec2, b: Vec2| self.edges(placement).filter(|[p, q]| cross_properly(a, b, *p, *q)).count();
        // A ray from a point inside leaves the outline once more than it enters it.
        let beyond = self.corners.iter().map(|c| c.norm()).fold(1.0, larger) * OUTSIDE_DISTANCE_FACTOR;
        let is_inside = |p: Vec2| crosses(p, placement.at + Vec2::new(beyond, RAY_SLOPE * beyond)) % 2 == 1;
        ring.first().is_some_and(|p| is_inside(*p))
            || ring.windows(2).any(|w| crosses(w[0], w[1]) > 0)
            || (radius > TOUCHING_DEPTH_M && !self.is_clear(placement, ring.into_iter(), radius - TOUCHING_DEPTH_M))
    }

    /// The largest distance that a point of the outline moves between two placements, m.
    #[must_use]
    pub(crate) fn max_displacement(&self, from: &RigidPose, to: &RigidPose) -> f64 {
        let ways = self.corners.iter().map(|c| (to.place(*c) - from.place(*c)).norm());
        ways.fold(0.0, larger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_encloses_nothing_is_no_outline() {
        let line = [Vec2::zeros(), Vec2::x(), Vec2::x() * 2.0];
        assert_eq!(Outline::new(&line, Vec2::zeros(), RigidPose::default(), 0.5, String::new()), None);
        assert_eq!(Outline::new(&[], Vec2::zeros(), RigidPose::default(), 0.5, String::new()), None);
    }
}
