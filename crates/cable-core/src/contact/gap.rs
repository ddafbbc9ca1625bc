//! A gap is the distance between a cable and one feature of an obstacle.

use crate::math::Vec2;

/// One feature of an obstacle, and the place where the cable is nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Distance between cable surface and obstacle surface, m; negative = penetration where a sign
    /// exists.
    pub gap_m: f64,
    /// Unit normal, from the obstacle to the cable.
    pub normal: Vec2,
    /// Nearest point of the obstacle, m.
    pub point: Vec2,
    /// Position of the nearest point along the queried cable segment, 0 to 1 (0 for a point query).
    pub fraction: f64,
    /// Coulomb friction coefficient with this cable.
    pub friction: f64,
    /// Index of the obstacle in the scene.
    pub obstacle: usize,
    /// Index of the feature (edge or circle) in the world.
    pub feature: usize,
}
