//! The bounds are the rectangle of the world that things take up.

use cable_core::math::Point;
use cable_core::scene::Shape;

use crate::state::AppState;

/// Grows with each point put in; points that are not finite are left out.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Point,
    high: Point,
}

impl Bounds {
    const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn add(&mut self, p: Point) {
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

fn add_cables(state: &AppState, bounds: &mut Bounds) {
    if let Some(solution) = &state.live.snapshot.solution {
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
    bounds.or_unit()
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

/// The part of a rectangle that lies between the ends of the ground, where there is ground, and holds
/// a point: beyond the wall of a tank there is nothing to stand on. Corners and point in m.
#[must_use]
pub fn above_ground(state: &AppState, point: Option<Point>, [mut low, mut high]: [Point; 2]) -> [Point; 2] {
    let mut bounds = Bounds::EMPTY;
    for obstacle in &state.document.scene.obstacles {
        if let Shape::Terrain { points_m } = &obstacle.shape {
            points_m.iter().for_each(|&p| bounds.add(p));
        }
    }
    if bounds.low[0] < bounds.high[0] {
        point.into_iter().for_each(|p| bounds.add(p));
        (low[0], high[0]) = (low[0].max(bounds.low[0]), high[0].min(bounds.high[0]));
    }
    [low, high]
}

/// Left and right end of the ground, where there is some, within what a robot could be led to by
/// its cable, m.
#[must_use]
pub fn ground(state: &AppState) -> [f64; 2] {
    let mut bounds = Bounds::EMPTY;
    for obstacle in &state.document.scene.obstacles {
        if let Shape::Terrain { points_m } = &obstacle.shape {
            points_m.iter().for_each(|&p| bounds.add(p));
        }
    }
    let [low, high] = bounds.or_unit();
    let from = state.document.scene.robot.as_ref().map_or(0.0, |r| r.at_m[0]);
    let longest = state.document.scene.cables.iter().map(|c| c.length_m).fold(0.0, f64::max);
    let starts = state.document.scene.cables.iter().filter_map(|c| c.supports.first()?.at_m).map(|p| p[0]);
    let (near, far) = starts.fold((from, from), |(a, b), x| (a.min(x), b.max(x)));
    [low[0].max(near - longest), high[0].min(far + longest)]
}
