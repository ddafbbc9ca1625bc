//! A scene is a plain document: every part of it is public, and may be half typed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cable::Cable;
use super::environment::{Environment, View};
use super::ground::Ground;
use super::library::preset::robot_preset;
use super::load::Load;
use super::obstacle::Obstacle;
use super::robot::{Pose, Robot};
use crate::math::Point;

/// The file version this build writes, and the newest it reads.
pub(crate) const VERSION: u32 = 1;

/// A whole scene, as a scene file holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// File format version; always 1.
    pub version: u32,
    /// Shown in title bars and reports.
    #[serde(default)]
    pub name: String,
    /// Side view or plan view.
    #[serde(default)]
    pub view: View,
    /// Gravity, wind, temperature.
    #[serde(default)]
    pub environment: Environment,
    /// The cables; at least one.
    pub cables: Vec<Cable>,
    /// Terrain, beams, posts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Obstacle>,
    /// Point loads on cables.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// The tracked vehicle (robot), if the scene has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<Robot>,
}

impl Scene {
    /// Returns the pose of the robot at the start: on its ground, or as given where the terrain
    /// ends below its tracks.
    #[must_use]
    pub fn robot_pose(&self) -> Option<Pose> {
        let robot = self.robot.as_ref()?;
        let as_put = Pose { at_m: robot.at_m, pitch: 0.0, heading: robot.heading };
        let preset = robot_preset(&robot.preset)?;
        Some(robot.pose_on(&self.robot_ground(), preset, robot.at_m[0]).unwrap_or(as_put))
    }

    /// Returns where a cable hangs on the robot at the start, m.
    #[must_use]
    pub fn hitch_m(&self) -> Option<Point> {
        Some(self.robot_pose()?.hitch_m(robot_preset(&self.robot.as_ref()?.preset)?, self.view))
    }

    /// Returns the ground on which the robot drives: the terrains of a side view; level ground at
    /// the robot's own place where the scene has none, and in a plan view, whose floor is the page.
    #[must_use]
    pub fn robot_ground(&self) -> Ground {
        let terrains = Ground::of(self);
        match &self.robot {
            Some(robot) if self.view == View::Plan || terrains.is_empty() => Ground::level(robot.at_m[1]),
            _ => terrains,
        }
    }
}

impl Ground {
    /// Of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        Self::of_obstacles(&scene.obstacles)
    }
}
