//! The arrows of loads have a tail, a head that can be dragged, and a length that says how large
//! the force is.

use cable_core::math::Point;
use egui::{Vec2, vec2};

use crate::state::AppState;

/// Length of a load's arrow of 1 N, points; it grows with the square root. Loads have a scale of
/// their own that does not depend on the answer, so that the head of an arrow can be dragged: 100 N
/// are 48 points.
pub const LOAD_POINTS: f64 = 4.8;

/// Shortest and longest arrow of a load, points.
pub const LOAD_LENGTH: [f64; 2] = [18.0, 220.0];

/// Returns where a load acts now and its force, N.
pub fn load_at(state: &AppState, load: usize) -> Option<(Point, Point)> {
    let load = state.document.scene.loads.get(load)?;
    let solution = state.live.snapshot.solution.as_ref()?;
    let cable = solution.cables.iter().find(|c| c.name == load.cable)?;
    let force = load.force_n.or_else(|| load.forces_n.first().copied())?;
    let k = cable.nodes.partition_point(|n| n.arc_length_m < load.arc_length_m).min(cable.nodes.len().checked_sub(1)?);
    let node = cable.nodes.get(k)?;
    let Some(before) = k.checked_sub(1).and_then(|j| cable.nodes.get(j)) else {
        return Some(([node.x_m, node.y_m], force));
    };
    let f = ((load.arc_length_m - before.arc_length_m) / (node.arc_length_m - before.arc_length_m)).clamp(0.0, 1.0);
    Some(([before.x_m + (node.x_m - before.x_m) * f, before.y_m + (node.y_m - before.y_m) * f], force))
}

/// The arrow of a load on screen, points (y down).
pub fn load_arrow(force: Point) -> Vec2 {
    let size = force[0].hypot(force[1]);
    if !(size > 0.0 && size.is_finite()) {
        return Vec2::ZERO;
    }
    let length = (LOAD_POINTS * size.sqrt()).clamp(LOAD_LENGTH[0], LOAD_LENGTH[1]);
    vec2((force[0] / size * length) as f32, (-force[1] / size * length) as f32)
}

/// Returns where the head of a load's arrow is, m.
#[must_use]
pub fn head_at(state: &AppState, load: usize) -> Option<Point> {
    let (tail, force) = load_at(state, load)?;
    let along = load_arrow(force);
    let scale = state.view.camera.points_per_m;
    Some([tail[0] + f64::from(along.x) / scale, tail[1] - f64::from(along.y) / scale])
}

/// The force whose arrow goes along a vector of the world (m), N: the inverse of how it is drawn.
#[must_use]
pub fn force_of_arrow(along_m: Point, camera: &crate::state::camera::Camera) -> Point {
    let points = along_m[0].hypot(along_m[1]) * camera.points_per_m;
    if !(points > 0.0 && points.is_finite()) {
        return [0.0; 2];
    }
    let size = (points / LOAD_POINTS).powi(2);
    let metres = points / camera.points_per_m;
    along_m.map(|v| v / metres * size)
}
