//! In a step the outline of the robot moves from one rigid pose to another; this module gives the
//! displacements of points that move with it.

use crate::math::{RigidPose, Vec2};

/// The motion of the outline in the present step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineMotion {
    /// Its index among the obstacles.
    pub obstacle: usize,
    /// Pose at the start.
    pub from: RigidPose,
    /// Pose at the end.
    pub to: RigidPose,
}

impl OutlineMotion {
    /// Position at the end of a point at `p` (m) that moves with the outline.
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
