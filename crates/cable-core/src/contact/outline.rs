//! An obstacle that moves as a whole: the outline of a robot.
//!
//! In a [`Geometry`](super::geometry::Geometry) it is one body more, the last one, put where it is before every step.
//! While a step is worked out it stands still.

use super::distance::{point_segment, segment_segment};
use crate::math::{Vec2, cross, larger};

/// Where a rigid body is and how it is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidPose {
    /// Its own origin, m.
    pub at: Vec2,
    /// Its turn, rad, anticlockwise.
    pub angle: f64,
}

impl RigidPose {
    /// From the body's own axes to the plane, m.
    #[must_use]
    pub fn place(&self, p: Vec2) -> Vec2 {
        let (sin, cos) = self.angle.sin_cos();
        self.at + Vec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)
    }

    /// From the plane to the body's own axes, m.
    #[must_use]
    pub fn to_local(&self, p: Vec2) -> Vec2 {
        let (sin, cos) = self.angle.sin_cos();
        let d = p - self.at;
        Vec2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x)
    }

    /// Where a point of the body goes when it moves from here to `to`, m.
    #[must_use]
    pub fn carried(&self, to: &Self, p: Vec2) -> Vec2 {
        to.place(self.to_local(p))
    }

    /// The placement at a part of the way to another (0 to 1); exactly that one at 1.
    #[must_use]
    pub fn towards(&self, to: &Self, part: f64) -> Self {
        if part >= 1.0 {
            return *to;
        }
        Self { at: self.at + (to.at - self.at) * part, angle: self.angle + (to.angle - self.angle) * part }
    }
}

/// A closed outline, solid inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    corners: Vec<Vec2>,
    /// Where it is at the start.
    pub placement: RigidPose,
    /// Coulomb friction coefficient with the cable.
    pub friction: f64,
    /// Where the cable hangs on it, in its own axes, m.
    pub hitch: Vec2,
    /// Name of what it belongs to.
    pub name: String,
}

impl Outline {
    /// An outline by its corners and its hitch in its own axes, m; None if they enclose nothing.
    #[must_use]
    pub fn new((corners, hitch): (&[Vec2], Vec2), placement: RigidPose, friction: f64, name: String) -> Option<Self> {
        let mut kept: Vec<Vec2> = Vec::with_capacity(corners.len());
        for c in corners.iter().filter(|c| c.iter().all(|v| v.is_finite())) {
            if kept.last() != Some(c) {
                kept.push(*c);
            }
        }
        while kept.len() > 1 && kept.first() == kept.last() {
            kept.pop();
        }
        let origin = kept.first().copied()?;
        let area: f64 = kept.windows(2).map(|w| cross(w[0] - origin, w[1] - origin)).sum();
        if !(area.abs() > 0.0) {
            return None;
        }
        if area > 0.0 {
            kept.reverse();
        }
        Some(Self { corners: kept, placement, friction, hitch, name })
    }

    /// Its edges at a placement, clockwise, m.
    pub fn edges(&self, placement: RigidPose) -> impl Iterator<Item = [Vec2; 2]> {
        let n = self.corners.len();
        (0..n).map(move |k| [self.corners[k], self.corners[(k + 1) % n]].map(|p| placement.place(p)))
    }

    /// Whether a chain of points (m) stays farther away than `least` (m) from the outline at a placement.
    #[must_use]
    pub fn is_clear(&self, placement: RigidPose, chain: impl Iterator<Item = Vec2>, least: f64) -> bool {
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

    /// The longest way that a point of it goes between two placements, m.
    #[must_use]
    pub fn max_displacement(&self, from: &RigidPose, to: &RigidPose) -> f64 {
        let ways = self.corners.iter().map(|c| (to.place(*c) - from.place(*c)).norm());
        ways.fold(0.0, larger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_comes_back_to_where_it_was() {
        let (a, b) =
            (RigidPose { at: Vec2::new(3.0, -1.0), angle: 0.4 }, RigidPose { at: Vec2::new(3.5, -1.2), angle: -0.1 });
        let p = Vec2::new(0.7, 2.0);
        assert!((a.to_local(a.place(p)) - p).norm() < 1e-15);
        assert!((b.carried(&a, a.carried(&b, p)) - p).norm() < 1e-14);
        assert_eq!(a.towards(&b, 1.0), b);
        assert_eq!(a.towards(&b, 0.0), a);
    }

    #[test]
    fn what_encloses_nothing_is_no_outline() {
        let line = [Vec2::zeros(), Vec2::x(), Vec2::x() * 2.0];
        assert_eq!(Outline::new((&line, Vec2::zeros()), RigidPose::default(), 0.5, String::new()), None);
        assert_eq!(Outline::new((&[], Vec2::zeros()), RigidPose::default(), 0.5, String::new()), None);
    }
}
