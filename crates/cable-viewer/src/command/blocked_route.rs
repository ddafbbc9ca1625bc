//! Ways that a cable was to be laid along and that now lead through something.

use cable_core::Scene;
use cable_core::contact::World;
use cable_core::math::{Point, vec2};

/// Points looked at on each piece of a way. Fewer: a thin beam is passed unseen, and the scene is
/// refused as before.
const SAMPLES_PER_LEG: usize = 64;
/// How far round a point obstacles are asked for, m.
const SEARCH_RADIUS_M: f64 = 1e3;

/// Forgets ways that lead through an obstacle: from then on the cable is laid straight, lifted over
/// what is in the way. What was drawn round other obstacles is worth nothing among these, and no
/// model finds a rest from inside the ground.
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
