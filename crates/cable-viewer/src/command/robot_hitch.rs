//! The hitch of the robot holds a support, which changes with the robot.

use cable_core::math::Point;
use cable_core::scene::{Support, SupportKind};
use cable_core::{Robot, Scene};

/// A support of a cable, and the place to which it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportMove {
    /// Index of the cable.
    pub cable: usize,
    /// Index of the support on it.
    pub support: usize,
    /// The place, m.
    pub to_m: Point,
}

/// The support that the robot holds, with its place.
pub fn hitched_support(scene: &Scene) -> Option<SupportMove> {
    let to_m = scene.hitch_m()?;
    scene.cables.iter().enumerate().find_map(|(cable, c)| {
        let support = c.supports.iter().position(|s| s.kind == SupportKind::Robot)?;
        Some(SupportMove { cable, support, to_m })
    })
}

/// Sets another robot, or none: the support that the robot held is then fixed at its place.
pub fn set_robot(scene: &mut Scene, robot: Option<Robot>) {
    if robot.is_none()
        && let Some(SupportMove { cable, support, to_m }) = hitched_support(scene)
        && let Some(s) = scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
    {
        *s = Support::fixed(s.name.clone(), to_m);
    }
    scene.robot = robot;
}
