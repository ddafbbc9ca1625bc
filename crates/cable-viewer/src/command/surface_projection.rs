//! A support that is moved into a solid obstacle is projected to one cable radius off the surface.

use cable_core::Scene;
use cable_core::contact::World;
use cable_core::math::{Point, vec2};
use cable_core::scene::{Shape, SupportKind};

/// Most corners of obstacles that a moved support is kept clear of. More: each edit of a drag over
/// a map of a million points waits for their tree.
const MAX_CORNERS: usize = 20_000;
/// Times a support is pushed out of one obstacle and into the next; in a corner of 30° twenty leave
/// a millionth of the way.
const MAX_PUSHES: usize = 40;
/// Distance from a permitted place below which a point is there, m: rounding.
const CLEAR_M: f64 = 1e-12;

/// Returns the place of a support that is moved to a point (m): if that is inside an obstacle, one
/// cable radius off its surface.
pub fn clear_of_obstacles(scene: &Scene, cable: usize, support: usize, to_m: Point) -> Point {
    let corners: usize = scene.obstacles.iter().map(|o| corner_count(&o.shape)).sum();
    let Some(of) = scene.cables.get(cable).filter(|_| (1..=MAX_CORNERS).contains(&corners)) else { return to_m };
    // A wheel may be mounted on the obstacle around it, and the hitch goes with the robot.
    let point_support =
        of.supports.get(support).filter(|s| s.kind != SupportKind::Robot && s.radius_m.is_none_or(|r| r == 0.0));
    if point_support.is_none() {
        return to_m;
    }
    let world = World::new(&scene.obstacles, of.friction, 0.5 * of.diameter_m);
    let mut at = vec2(to_m);
    for _ in 0..MAX_PUSHES {
        match world.signed_gap(at, f64::INFINITY) {
            Some(gap) if gap.gap_m < -CLEAR_M => at -= gap.normal * gap.gap_m,
            _ => return [at.x, at.y],
        }
    }
    to_m
}

fn corner_count(shape: &Shape) -> usize {
    match shape {
        Shape::Circle { .. } => 1,
        Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => points_m.len(),
    }
}
