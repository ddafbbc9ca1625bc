//! The outline of the robot is an obstacle for a cable.

use crate::contact::moving_outline::Outline;
use crate::math::vec2;
use crate::scene::preset::robot_preset;
use crate::scene::robot::Pose;
use crate::scene::{Scene, View};

/// Name of the outline among the obstacles of a cable.
pub const OUTLINE_NAME: &str = "robot";

/// The outline of the robot that a cable of this friction meets; None where there is no robot, and
/// in a plan view.
#[must_use]
pub fn robot_outline(scene: &Scene, cable_friction: f64) -> Option<Outline> {
    let (robot, pose) = (scene.robot.as_ref()?, scene.robot_pose()?);
    let preset = robot_preset(&robot.preset)?;
    let corners = preset.meets_cable_m(robot.heading);
    let hitch = vec2(Pose { heading: robot.heading, ..Pose::default() }.hitch_m(preset, View::Elevation));
    let outline = Outline::new(&corners, hitch, pose.placement(), cable_friction, OUTLINE_NAME.to_owned());
    outline.filter(|_| scene.view == View::Elevation)
}
