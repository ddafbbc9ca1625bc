//! The hitch of the robot holds a support, which changes with the robot.

use cable_core::math::Point;
use cable_core::scene::{Support, SupportKind};
use cable_core::{Robot, Scene};

/// The support that the robot holds, and its place.
pub fn hitched_support(scene: &Scene) -> Option<(usize, usize, Point)> {
    let hitch = scene.hitch_m()?;
    scene.cables.iter().enumerate().find_map(|(cable, c)| {
        let support = c.supports.iter().position(|s| s.kind == SupportKind::Robot)?;
        Some((cable, support, hitch))
    })
}

/// Sets another robot, or none: the support that the robot held is then fixed at its place.
pub fn set_robot(scene: &mut Scene, robot: Option<Robot>) {
    if robot.is_none()
        && let Some((cable, support, hitch)) = hitched_support(scene)
        && let Some(s) = scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
    {
        *s = Support::fixed(s.name.clone(), hitch);
    }
    scene.robot = robot;
}
