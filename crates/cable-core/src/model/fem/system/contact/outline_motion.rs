//! The outline of the robot moves in a step from one rigid pose to another; what touches it is
//! carried with it.

use crate::math::{RigidPose, Vec2};

/// The motion of the outline in the present step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineMotion {
    /// Its number among the obstacles.
    pub obstacle: usize,
    /// From where.
    pub from: RigidPose,
    /// To where.
    pub to: RigidPose,
}

impl OutlineMotion {
    /// Position now of a point at `p` (m) if it had gone with the outline.
    #[must_use]
    pub fn carried(&self, p: Vec2) -> Vec2 {
        self.from.carried(&self.to, p)
    }

    /// Displacement of the point of the outline that is at `p` (m).
    #[must_use]
    pub fn way(&self, p: Vec2) -> Vec2 {
        p - self.to.carried(&self.from, p)
    }
}
