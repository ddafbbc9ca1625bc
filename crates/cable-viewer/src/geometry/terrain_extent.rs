//! The extent of the terrain ends at the inner faces of a tank's walls.

use cable_core::math::Point;
use cable_core::scene::Shape;

use crate::state::AppState;

/// The part of a rectangle that lies between the ends of the ground, where there is ground, and
/// holds a point: beyond the wall of a tank, and above it, there is nothing to stand on. Corners
/// and point in m.
#[must_use]
pub fn within_terrain(state: &AppState, point: Option<Point>, [mut low, mut high]: [Point; 2]) -> [Point; 2] {
    if let Some([left, right]) = terrain_ends(state) {
        let at = point.map(|p| p[0]);
        low[0] = low[0].max(at.map_or(left, |x| left.min(x)));
        high[0] = high[0].min(at.map_or(right, |x| right.max(x)));
    }
    [low, high]
}

/// Least slope of a wall, height over width: 1 in 10 off the vertical.
const WALL_SLOPE: f64 = 10.0;
/// Widest top of a wall, as a part of the ground. Wider: it is ground that ends in a step down.
const WALL_WIDTH: f64 = 0.1;

/// Left and right end of all ground without what is above and behind the walls at its ends, m; None
/// where there is no ground.
fn terrain_ends(state: &AppState) -> Option<[f64; 2]> {
    let terrains = state.document.scene.obstacles.iter().filter_map(|o| match &o.shape {
        Shape::Terrain { points_m } => Some(points_m),
        _ => None,
    });
    let ends = terrains.filter_map(|points_m| {
        let width = points_m.last()?[0] - points_m.first()?[0];
        let [left, right] = [inner_face(points_m.iter(), width), inner_face(points_m.iter().rev(), width)];
        Some([left?, right?])
    });
    ends.reduce(|[a, b], [left, right]| [a.min(left), b.max(right)]).filter(|[left, right]| left < right)
}

/// Left and right wall of a piece of ground, where it has them: the places of their inner faces, m.
#[must_use]
pub fn walls(points_m: &[Point]) -> [Option<f64>; 2] {
    let ends = points_m.first().zip(points_m.last());
    let width = ends.map_or(0.0, |(first, last)| last[0] - first[0]);
    [wall_face(points_m.iter(), width), wall_face(points_m.iter().rev(), width)]
}

/// The place at which ground of a width (m) begins, seen from one of its ends, m: at that end, or
/// at the face of a wall.
fn inner_face<'a>(points_m: impl Iterator<Item = &'a Point> + Clone, width: f64) -> Option<f64> {
    let end = points_m.clone().next()?[0];
    Some(wall_face(points_m, width).unwrap_or(end))
}

/// The inner face of a wall at the end from which ground of a width (m) is seen, m; None where it
/// has none there.
fn wall_face<'a>(points_m: impl Iterator<Item = &'a Point>, width: f64) -> Option<f64> {
    let mut points = points_m.copied().peekable();
    let first = points.next()?;
    let mut last = first;
    while let Some(next) = points.next_if(|p| p[1] >= first[1]) {
        last = next;
    }
    let wall = points.next().is_some_and(|p| last[1] - p[1] > WALL_SLOPE * (p[0] - last[0]).abs());
    let narrow = (last[0] - first[0]).abs() < WALL_WIDTH * width;
    (wall && narrow).then_some(last[0])
}

/// Left and right end of the ground, where there is some, within what a robot could be led to by
/// its cable, m.
#[must_use]
pub fn ground(state: &AppState) -> [f64; 2] {
    let [left, right] = terrain_ends(state).unwrap_or([-1.0, 1.0]);
    let from = state.document.scene.robot.as_ref().map_or(0.0, |r| r.at_m[0]);
    let longest = state.document.scene.cables.iter().map(|c| c.length_m).fold(0.0, f64::max);
    let starts = state.document.scene.cables.iter().filter_map(|c| c.supports.first()?.at_m).map(|p| p[0]);
    let (near, far) = starts.fold((from, from), |(a, b), x| (a.min(x), b.max(x)));
    [left.max(near - longest), right.min(far + longest)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_begins_at_the_faces_of_its_walls() {
        let face = |points: &[Point], width| inner_face(points.iter(), width);
        let tank = [[-12.4, 9.5], [-11.4, 9.5], [-11.4, 1.7], [0.0, 0.5], [11.4, 1.8], [11.4, 9.5], [12.4, 9.5]];
        assert_eq!(face(&tank, 24.8), Some(-11.4));
        assert_eq!(inner_face(tank.iter().rev(), 24.8), Some(11.4));
        // Level ground, a slope down, and a step down in the middle are no walls.
        assert_eq!(face(&[[-2.0, 0.0], [20.0, 0.0]], 22.0), Some(-2.0));
        assert_eq!(face(&[[-2.0, 1.0], [0.0, 0.5], [20.0, 0.0]], 22.0), Some(-2.0));
        assert_eq!(face(&[[-2.0, 0.0], [9.0, 0.0], [9.0, -3.0], [20.0, -3.0]], 22.0), Some(-2.0));
        assert_eq!(face(&[], 0.0), None);
    }
}
