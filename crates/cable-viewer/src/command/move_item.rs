//! Every kind of item of the scene can be moved to a point.

use cable_core::math::Point;
use cable_core::scene::{Ground, RobotTask, Shape};

use crate::command::surface_projection::clear_of_obstacles;
use crate::state::{AppState, Item};

/// Moves an item to a point, m.
pub fn move_item(state: &mut AppState, item: Item, to_m: Point) {
    if !to_m.iter().all(|v| v.is_finite()) {
        return;
    }
    let scene = &mut state.document.scene;
    match item {
        Item::Support { cable, support } => {
            let to_m = clear_of_obstacles(scene, cable, support, to_m);
            let Some(s) = scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support)) else { return };
            let Some(at) = s.at_m.replace(to_m) else {
                s.at_m = None; // a load or a free end has no place of its own
                return;
            };
            if let Some(motion) = &mut s.motion {
                for p in &mut motion.points_m {
                    *p = shifted(*p, at, to_m);
                }
            }
        }
        Item::Obstacle(index) => {
            let Some(o) = scene.obstacles.get_mut(index) else { return };
            match &mut o.shape {
                Shape::Circle { center_m, .. } => *center_m = to_m,
                Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                    let Some(&first) = points_m.first() else { return };
                    for p in points_m {
                        *p = shifted(*p, first, to_m);
                    }
                }
            }
        }
        Item::Corner { obstacle, corner } => {
            let Some(o) = scene.obstacles.get_mut(obstacle) else { return };
            if let Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } =
                &mut o.shape
            {
                set(points_m, corner, to_m);
            }
        }
        Item::Robot => {
            let y = Ground::of(scene).height(to_m[0]).unwrap_or(to_m[1]);
            if let Some(robot) = &mut scene.robot {
                robot.at_m = [to_m[0], y];
            }
        }
        Item::LoadHead(index) => {
            let Some((tail, _)) = crate::geometry::arrows::load_at(state, index) else { return };
            let force =
                crate::geometry::arrows::force_of_arrow([to_m[0] - tail[0], to_m[1] - tail[1]], &state.view.camera);
            if let Some(load) = state.document.scene.loads.get_mut(index).filter(|l| l.force_n.is_some()) {
                load.force_n = Some(force);
            }
        }
        Item::PathLeg(index) => {
            let legs = scene.robot.iter_mut().flat_map(|r| r.path.get_mut(index));
            for task in legs {
                if let RobotTask::Drive { to_x_m, .. } = task {
                    *to_x_m = to_m[0];
                }
            }
        }
        Item::Cable(_) | Item::Load(_) | Item::Scene | Item::Environment | Item::Solver => {}
    }
}

/// A point, displaced by as much as another one.
pub fn shifted(p: Point, from: Point, to: Point) -> Point {
    [p[0] + to[0] - from[0], p[1] + to[1] - from[1]]
}

pub fn set<T>(list: &mut [T], index: usize, value: T) {
    if let Some(slot) = list.get_mut(index) {
        *slot = value;
    }
}
