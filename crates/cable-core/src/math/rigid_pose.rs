//! A rigid body has a position and a rotation.

use super::Vec2;

/// Position and rotation of a rigid body.
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
    pub(crate) fn to_local(self, p: Vec2) -> Vec2 {
        let (sin, cos) = self.angle.sin_cos();
        let d = p - self.at;
        Vec2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x)
    }

    /// Returns where a point of the body goes when it moves from here to `to`, m.
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
}
