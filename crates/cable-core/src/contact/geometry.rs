//! The only file that imports parry2d. Placeholder until the contact engine lands.

use super::Gap;
use crate::math::Vec2;
use crate::scene::Obstacle;

/// Compiled obstacle features with their tree.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    count: usize,
}

impl Geometry {
    /// Compiles obstacles.
    #[must_use]
    pub fn new(obstacles: &[Obstacle], _cable_friction: f64, _cable_radius: f64) -> Self {
        Self { count: obstacles.len() }
    }
    /// Whether there is no feature.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
    /// See [`super::World::signed_gap`].
    #[must_use]
    pub fn signed_gap(&self, _p: Vec2, _reach: f64) -> Option<Gap> {
        None
    }
    /// See [`super::World::segment_gaps`].
    pub fn segment_gaps(&self, _a: Vec2, _b: Vec2, _reach: f64, _out: &mut Vec<Gap>) {}
    /// See [`super::World::free_fraction`].
    #[must_use]
    pub fn free_fraction(&self, _from: [Vec2; 2], _to: [Vec2; 2], _keep: f64) -> f64 {
        1.0
    }
}
