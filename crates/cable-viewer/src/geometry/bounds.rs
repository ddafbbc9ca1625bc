//! The bounds are the rectangle of the world that things take up.

use cable_core::math::Point;
use cable_core::scene::Shape;

use crate::geometry::terrain_extent::walls;
use crate::state::AppState;

/// Grows with each point put in; points that are not finite are left out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    /// Includes a point (m).
    pub(super) fn add(&mut self, p: Point) {
        if p.iter().all(|v| v.is_finite()) {
            for (k, v) in p.into_iter().enumerate() {
                self.low[k] = self.low[k].min(v);
                self.high[k] = self.high[k].max(v);
            }
        }
    }

    fn or_unit(self) -> [Point; 2] {
        if self.low[0] <= self.high[0] { [self.low, self.high] } else { [[-1.0; 2], [1.0; 2]] }
    }
}

/// Includes the cables of the answer, and the places of supports.
fn add_cables(state: &AppState, bounds: &mut Bounds) {
    // The cable of a scene that was there before says nothing of where this one will be.
    if let Some(solution) = state.live.snapshot.solution.as_ref().filter(|_| state.is_answered()) {
        for n in solution.cables.iter().flat_map(|c| &c.nodes) {
            bounds.add([n.x_m, n.y_m]);
        }
    }
    for s in state.document.scene.cables.iter().flat_map(|c| &c.supports) {
        if let Some(p) = s.at_m {
            bounds.add(p);
        }
    }
}

/// Least and greatest corner of the cables and their supports, m.
#[must_use]
pub fn cables(state: &AppState) -> [Point; 2] {
    let mut bounds = Bounds::EMPTY;
    add_cables(state, &mut bounds);
    bounds.or_unit()
}

/// Least and greatest corner of cables and robot where they are in the answer on screen, m.
#[must_use]
pub fn moving(state: &AppState) -> [Point; 2] {
    let mut bounds = Bounds::EMPTY;
    for n in state.live.snapshot.solution.iter().flat_map(|s| &s.cables).flat_map(|c| &c.nodes) {
        bounds.add([n.x_m, n.y_m]);
    }
    crate::geometry::robot::robot_outline(state).into_iter().for_each(|p| bounds.add(p));
    bounds.or_unit()
}

/// Least and greatest corner of cables, obstacles and robot, with the ground below them, m.
#[must_use]
pub fn scene(state: &AppState) -> [Point; 2] {
    let mut bounds = Bounds::EMPTY;
    add_cables(state, &mut bounds);
    for obstacle in &state.document.scene.obstacles {
        match &obstacle.shape {
            Shape::Terrain { .. } => {}
            Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                points_m.iter().for_each(|&p| bounds.add(p));
            }
            Shape::Circle { center_m, radius_m } => {
                bounds.add([center_m[0] - radius_m, center_m[1] - radius_m]);
                bounds.add([center_m[0] + radius_m, center_m[1] + radius_m]);
            }
        }
    }
    crate::geometry::robot::robot_outline(state).into_iter().for_each(|p| bounds.add(p));
    crate::geometry::robot::path_flags(state).into_iter().for_each(|(_, p, _)| bounds.add(p));
    add_ground(state, &mut bounds);
    add_walls(state, &mut bounds);
    bounds.or_unit()
}

/// A wall is fitted with what is between the walls where the picture gets wider by this factor at
/// most. Smaller: a tank has no wall where its cable is in the middle; larger: what is looked at
/// becomes small.
const WIDENING_FOR_WALLS: f64 = 1.3;

/// Adds the places of walls that stand near what is there already.
fn add_walls(state: &AppState, bounds: &mut Bounds) {
    let [left, right] = [bounds.low[0], bounds.high[0]];
    let beyond = (WIDENING_FOR_WALLS - 1.0) * (right - left);
    if !beyond.is_finite() {
        return;
    }
    for obstacle in &state.document.scene.obstacles {
        let Shape::Terrain { points_m } = &obstacle.shape else { continue };
        let [wall_left, wall_right] = walls(points_m);
        let near = |x: &f64| (left - beyond..=right + beyond).contains(x);
        for x in [wall_left, wall_right].into_iter().flatten().filter(near) {
            bounds.add([x, bounds.low[1]]);
        }
    }
}

/// Returns whether the scene has ground.
#[must_use]
pub fn has_ground(state: &AppState) -> bool {
    state.document.scene.obstacles.iter().any(|o| matches!(o.shape, Shape::Terrain { .. }))
}

/// Adds the ground below what is there already: the whole of it may be a hundred times as long.
fn add_ground(state: &AppState, bounds: &mut Bounds) {
    let others = *bounds;
    let found = others.low[0] <= others.high[0];
    for obstacle in &state.document.scene.obstacles {
        if let Shape::Terrain { points_m } = &obstacle.shape {
            let beside = |p: &&Point| !found || (others.low[0]..=others.high[0]).contains(&p[0]);
            points_m.iter().filter(beside).for_each(|&p| bounds.add(p));
        }
    }
}
