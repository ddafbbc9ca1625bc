//! Supports follow the targets to which a user drags or pulls them, whichever piece they hold, and
//! the robot's outline its pose.

use crate::breakage::CablePart;
use crate::math::{RigidPose, Vec2};
use crate::model::smoothed_target::EDIT_SPEED;
use crate::model::{Inertia, Mechanics};

/// The place to which a support is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupportTarget {
    pub place_m: Vec2,
    pub grip: SupportGrip,
}

/// The connection of a support with the target that draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SupportGrip {
    /// The support goes where it is sent.
    Rigid,
    /// An edit placed the support elsewhere: it is sent ever nearer to there.
    Placed { to_m: Vec2 },
    /// A spring pulls it there.
    Spring,
}

impl SupportTarget {
    /// Has a model draw one of its supports there.
    pub fn draw(self, mechanics: &mut dyn Mechanics, support: usize) {
        match self.grip {
            SupportGrip::Rigid | SupportGrip::Placed { .. } => mechanics.drag_support(support, self.place_m),
            SupportGrip::Spring => mechanics.pull_support(support, self.place_m),
        }
    }

    /// The target of a support that an edit placed elsewhere, `dt_s` later: without inertia it is
    /// there at once. None if it stays.
    pub fn after(self, dt_s: f64, inertia: Inertia) -> Option<Self> {
        let SupportGrip::Placed { to_m } = self.grip else { return None };
        let (way, most) = (to_m - self.place_m, EDIT_SPEED * dt_s);
        let arrives = inertia == Inertia::QuasiStatic || way.norm() <= most;
        let grip = if arrives { SupportGrip::Rigid } else { self.grip };
        Some(Self { place_m: if arrives { to_m } else { self.place_m + way * (most / way.norm()) }, grip })
    }
}

/// The targets of a cable.
#[derive(Clone, Debug)]
pub(super) struct Targets {
    /// Of each support of the scene; None where nothing draws it.
    pub supports: Vec<Option<SupportTarget>>,
    /// Pose to which the outline of the robot was led.
    pub robot_pose: Option<RigidPose>,
}

impl Targets {
    /// Tells the model of a part where its supports are drawn to, and where the robot is.
    pub fn tell(&self, part: &CablePart, mechanics: &mut dyn Mechanics) {
        for (own, k) in part.supports.iter().enumerate() {
            if let Some(target) = k.and_then(|k| self.supports.get(k).copied().flatten()) {
                target.draw(mechanics, own);
            }
        }
        if let Some(pose) = self.robot_pose {
            mechanics.set_robot_pose(pose);
        }
    }
}
