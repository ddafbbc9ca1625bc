//! An edit of an obstacle or of a route may lead the route through the obstacle; such routes are
//! removed.

use cable_core::Scene;
use cable_core::contact::World;
use cable_core::math::{Point, vec2};

/// Number of points that are checked on each piece of a route. Fewer: a thin beam is missed, and
/// the scene is refused.
const SAMPLES_PER_LEG: usize = 64;
/// Radius round a point within which obstacles are sought, m.
const SEARCH_RADIUS_M: f64 = 1e3;

/// Removes routes that lead through an obstacle: from then on the cable is laid straight and lifted
/// over obstacles. A route that was drawn round other obstacles has no meaning among these, and no
/// model finds an equilibrium from inside the ground.
pub fn remove_penetrating_routes(scene: &mut Scene) {
    let Scene { cables, obstacles, .. } = scene;
    for cable in cables.iter_mut().filter(|c| c.route_m.len() >= 2) {
        let radius = 0.5 * cable.diameter_m;
        let world = World::new(obstacles, cable.friction, radius);
        let inside = |p: Point| world.signed_gap(vec2(p), SEARCH_RADIUS_M).is_some_and(|gap| gap.gap_m < -radius);
        let buried = cable.route_m.windows(2).any(|w| {
            (1..SAMPLES_PER_LEG)
                .map(|k| k as f64 / SAMPLES_PER_LEG as f64)
                .any(|f| inside([0, 1].map(|i| w[0][i] + (w[1][i] - w[0][i]) * f)))
        });
        if buried {
            cable.route_m.clear();
        }
    }
}
