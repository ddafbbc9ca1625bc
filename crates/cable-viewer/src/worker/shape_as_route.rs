//! The present shape of a cable becomes a route of the scene, by which an edit can lay it anew.

use cable_core::Simulation;
use cable_core::contact::World;
use cable_core::math::{Point, Vec2};

/// Least distance of neighbouring points of a route, as a part of the cable's length. Smaller: the
/// route has as many points as the mesh; larger: it cuts through obstacles that the cable goes
/// round.
const MIN_POINT_SPACING_FRACTION: f64 = 0.01;
/// Radius round a point within which obstacles are sought, m.
const SEARCH_RADIUS_M: f64 = 1e3;

/// The present shape of a cable as a route of the scene: points far enough apart, none inside an
/// obstacle. None if fewer than two points are left.
#[must_use]
pub fn cable_route(old: &Simulation, cable: usize) -> Option<Vec<Point>> {
    let of = old.scene().cables.get(cable)?;
    let states = old.states();
    let points = &states.get(cable)?.position_m;
    let radius = 0.5 * of.diameter_m;
    let world = World::new(&old.scene().obstacles, of.friction, radius);
    let clear = |p: Vec2| match world.signed_gap(p, SEARCH_RADIUS_M) {
        Some(gap) if gap.gap_m < 0.0 => p - gap.normal * gap.gap_m,
        _ => p,
    };
    let spacing = MIN_POINT_SPACING_FRACTION * of.length_m;
    let last = points.len().saturating_sub(1);
    let mut way: Vec<Vec2> = Vec::new();
    for (k, p) in points.iter().enumerate() {
        let far = way.last().is_none_or(|before| (p - before).norm() >= spacing);
        if far || (k == last && way.last().is_some_and(|before| (p - before).norm() > 1e-6)) {
            way.push(clear(*p));
        }
    }
    (way.len() >= 2).then(|| way.into_iter().map(|p| [p.x, p.y]).collect())
}
