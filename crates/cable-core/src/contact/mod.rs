//! The contact module gives all models the place, distance and friction of obstacles.
//!
//! | room | content |
//! |---|---|
//! | `gap.rs` | the gap between a cable and one feature of an obstacle |
//! | `geometry.rs`, `distance.rs` | obstacles as features in search trees; distances |
//! | `sweep.rs` | continuous collision detection by conservative advancement |
//! | `obstacle_pairs.rs`, `neighbour_lists.rs` | contact pairs of a chain; what each segment can come near to |
//! | `self_contact_pairs.rs`, `self_crossings.rs` | contact of a cable with itself; crossings of its line |
//! | `barrier.rs`, `friction.rs` | contact potential and friction potential |
//! | `moving_outline.rs` | the moving outline of a robot |
//! | `nearest_corner.rs`, `swept_corners.rs` | the body that a cable wraps; corners that it has passed through |
//!
//! [`World`] compiles a scene's obstacles once. Gaps are measured from the cable's *surface*: the
//! distance of the centre line from the obstacle less the cable radius (and half the thickness of a
//! thin polyline). Terrain is solid below, polygons inside, circles inside; thin polylines have two
//! sides.

pub(crate) mod barrier;
pub(crate) mod distance;
pub(crate) mod friction;
mod gap;
pub(crate) mod geometry;
pub(crate) mod moving_outline;
pub(crate) mod nearest_corner;
pub(crate) mod neighbour_lists;
pub(crate) mod obstacle_pairs;
pub(crate) mod self_contact_pairs;
pub(crate) mod self_crossings;
pub(crate) mod sweep;
pub(crate) mod swept_corners;
#[cfg(test)]
mod tests;

use crate::math::{RigidPose, Vec2};
use crate::scene::Obstacle;

pub use gap::Gap;
pub use moving_outline::Outline;

/// The obstacles of a scene, ready for queries by one cable.
#[derive(Clone, Debug, Default)]
pub struct World {
    geometry: geometry::Geometry,
}

impl World {
    /// Compiles obstacles for a cable of the given friction and radius (m). Degenerate edges are
    /// dropped.
    #[must_use]
    pub fn new(obstacles: &[Obstacle], cable_friction: f64, cable_radius: f64) -> Self {
        Self { geometry: geometry::Geometry::new(obstacles, cable_friction, cable_radius) }
    }

    /// Returns the same obstacles with a movable outline, for a cable of this radius (m).
    #[must_use]
    pub(crate) fn with_outline(&self, outline: &moving_outline::Outline, cable_radius: f64) -> Self {
        let mut geometry = self.geometry.clone();
        let obstacle = geometry.bodies().iter().map(|b| b.obstacle + 1).max().unwrap_or(0);
        geometry.add_outline(outline, obstacle, cable_radius);
        Self { geometry }
    }

    /// Moves the outline to its present pose.
    pub(crate) fn place_outline(&mut self, outline: &moving_outline::Outline, placement: RigidPose) {
        self.geometry.place_outline(outline, placement);
    }

    /// Lets a circle, given by its index in the scene, move.
    pub(crate) fn let_move(&mut self, obstacle: usize) {
        self.geometry.let_move(obstacle);
    }

    /// Moves the centre of a circle, given by its index in the scene, to a place (m).
    pub(crate) fn place_circle(&mut self, obstacle: usize, center: Vec2) {
        self.geometry.place_circle(obstacle, center);
    }

    /// Returns whether the world holds no obstacle.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.geometry.is_empty()
    }

    /// Signed gap of the cable's centre-line point `p` to the nearest obstacle within `reach` (m),
    /// solid sides counted as negative. A point more than `reach` plus the cable radius inside a
    /// solid is not found.
    #[must_use]
    pub fn signed_gap(&self, p: Vec2, reach: f64) -> Option<Gap> {
        self.geometry.signed_gap(p, reach)
    }

    /// Every feature within `reach` (m) of the centre-line segment `a`–`b`, unsigned, appended to
    /// `out`: edges and corners seen from its ends (`fraction` exactly 0 or 1), corners and circles
    /// seen from its inside.
    pub fn segment_gaps(&self, a: Vec2, b: Vec2, reach: f64, out: &mut Vec<Gap>) {
        self.geometry.segment_gaps(a, b, reach, out);
    }

    /// The largest fraction of the move `a0→a1, b0→b1` for which a centre-line segment keeps at
    /// least `keep` (0 to 1) of each gap that it had; 1 if the whole move is free. The bound is
    /// conservative: the segment never crosses a feature.
    #[must_use]
    pub fn free_fraction(&self, from: [Vec2; 2], to: [Vec2; 2], keep: f64) -> f64 {
        self.geometry.free_fraction(from, to, keep)
    }

    /// Name of an obstacle by its index in the scene; empty if it was dropped.
    #[must_use]
    pub fn obstacle_name(&self, obstacle: usize) -> &str {
        self.geometry.bodies().iter().find(|b| b.obstacle == obstacle).map_or("", |b| &b.name)
    }

    /// The compiled obstacles, for models that build their own contact pairs.
    #[must_use]
    pub(crate) fn geometry(&self) -> &geometry::Geometry {
        &self.geometry
    }
}
