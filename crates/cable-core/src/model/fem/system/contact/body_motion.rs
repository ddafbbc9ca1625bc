//! In a step a body that moves, the outline of the robot or a post, goes from one rigid pose to
//! another; this module gives the displacements of points that move with it.

use crate::math::{RigidPose, Vec2};

/// The motion of a body in the present step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    /// Its index among the obstacles.
    pub obstacle: usize,
    /// Pose at the start.
    pub from: RigidPose,
    /// Pose at the end.
    pub to: RigidPose,
    /// The greatest displacement of a point of it, m.
    pub way_m: f64,
    /// True if it stands in for a support.
    pub is_support: bool,
}

impl BodyMotion {
    /// Position at the end of a point at `p` (m) that moves with the body.
    #[must_use]
    pub fn carried(&self, p: Vec2) -> Vec2 {
        self.from.carried(&self.to, p)
    }

    /// Displacement of the point of the body that is at `p` (m).
    #[must_use]
    pub fn way(&self, p: Vec2) -> Vec2 {
        p - self.to.carried(&self.from, p)
    }
}
