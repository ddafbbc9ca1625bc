//! Any thing of the scene can be moved and taken out, whatever it is.

use cable_core::contact::World;
use cable_core::math::{Point, vec2};
use cable_core::scene::ground::Ground;
use cable_core::scene::{RobotTask, Shape, Support, SupportKind};
use cable_core::{Robot, Scene};

use crate::state::{AppState, Item};

/// Puts a thing at a point, m.
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
        Item::Head(index) => {
            let Some((tail, _)) = crate::geometry::arrows::load_at(state, index) else { return };
            let force =
                crate::geometry::arrows::force_of_arrow([to_m[0] - tail[0], to_m[1] - tail[1]], &state.view.camera);
            if let Some(load) = state.document.scene.loads.get_mut(index).filter(|l| l.force_n.is_some()) {
                load.force_n = Some(force);
            }
        }
        Item::Leg(index) => {
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

/// Most corners of obstacles that a moved support is kept clear of. More: each edit of a drag over
/// a map of a million points waits for their tree.
const MAX_CORNERS: usize = 20_000;
/// Times a support is pushed out of one obstacle and into the next; in a corner of 30° twenty leave
/// a millionth of the way.
const MAX_PUSHES: usize = 40;
/// What is nearer than this to where it may be is there, m: rounding.
const CLEAR_M: f64 = 1e-12;

/// Where a support that is moved to a point (m) comes to stand: on the surface of what it would be
/// in, the cable's radius off it.
fn clear_of_obstacles(scene: &Scene, cable: usize, support: usize, to_m: Point) -> Point {
    let corners: usize = scene.obstacles.iter().map(|o| corner_count(&o.shape)).sum();
    let Some(of) = scene.cables.get(cable).filter(|_| (1..=MAX_CORNERS).contains(&corners)) else { return to_m };
    // A wheel may be mounted on what it stands in; the hitch goes with the robot.
    let held = of.supports.get(support).filter(|s| s.kind != SupportKind::Robot && s.radius_m.is_none_or(|r| r == 0.0));
    if held.is_none() {
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

/// The support that hangs on the robot, and where.
pub fn hitched(scene: &Scene) -> Option<(usize, usize, Point)> {
    let hitch = scene.hitch_m()?;
    scene.cables.iter().enumerate().find_map(|(cable, c)| {
        let support = c.supports.iter().position(|s| s.kind == SupportKind::Robot)?;
        Some((cable, support, hitch))
    })
}

/// Another robot, or none: what hung on it is then fixed where it hung.
pub fn set_robot(scene: &mut Scene, robot: Option<Robot>) {
    if robot.is_none()
        && let Some((cable, support, hitch)) = hitched(scene)
        && let Some(s) = scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
    {
        *s = Support::fixed(s.name.clone(), hitch);
    }
    scene.robot = robot;
}

/// A point moved as another was.
pub fn shifted(p: Point, from: Point, to: Point) -> Point {
    [p[0] + to[0] - from[0], p[1] + to[1] - from[1]]
}

/// Takes things out, none of them twice.
pub fn remove_all(state: &mut AppState, mut items: Vec<Item>) {
    // From the last to the first of each kind, corners and supports before what they are of: an
    // index stays what it was.
    let rank = |item: &Item| match *item {
        Item::Corner { obstacle, corner } => (0, obstacle, corner),
        Item::Support { cable, support } => (1, cable, support),
        Item::Load(k) | Item::Head(k) => (2, k, 0),
        Item::Leg(k) => (3, k, 0),
        Item::Obstacle(k) => (4, k, 0),
        Item::Cable(k) => (5, k, 0),
        Item::Robot => (6, 0, 0),
        Item::Scene | Item::Environment | Item::Solver => (7, 0, 0),
    };
    items.sort_by_key(|item| std::cmp::Reverse(rank(item)));
    items.dedup_by_key(|item| rank(item));
    items.sort_by_key(|item| rank(item).0);
    for item in items {
        remove(&mut state.document.scene, item);
    }
    (state.selection.selected, state.selection.also) = (None, Vec::new());
}

fn remove(scene: &mut Scene, item: Item) {
    match item {
        Item::Cable(k) if scene.cables.len() > 1 && k < scene.cables.len() => {
            let gone = scene.cables.remove(k);
            scene.loads.retain(|l| l.cable != gone.name);
        }
        Item::Cable(_) | Item::Scene | Item::Environment | Item::Solver => {}
        Item::Robot => set_robot(scene, None),
        Item::Support { cable, support } => {
            let Some(c) = scene.cables.get_mut(cable) else { return };
            let last = c.supports.len().saturating_sub(1);
            if support == 0 || support == last {
                if let Some(s) = c.supports.get_mut(support) {
                    *s = Support::free(s.name.clone());
                }
            } else if support < last {
                c.supports.remove(support);
            }
        }
        Item::Obstacle(k) => {
            if k < scene.obstacles.len() {
                scene.obstacles.remove(k);
            }
        }
        Item::Corner { obstacle, corner } => {
            let Some(o) = scene.obstacles.get_mut(obstacle) else { return };
            let (points, least) = match &mut o.shape {
                Shape::Polygon { points_m } => (points_m, 3),
                Shape::Terrain { points_m } | Shape::Polyline { points_m, .. } => (points_m, 2),
                Shape::Circle { .. } => return,
            };
            if points.len() > least && corner < points.len() {
                points.remove(corner);
            }
        }
        Item::Leg(k) => {
            if let Some(robot) = scene.robot.as_mut().filter(|r| k < r.path.len()) {
                robot.path.remove(k);
            }
        }
        Item::Load(k) | Item::Head(k) => {
            if k < scene.loads.len() {
                scene.loads.remove(k);
            }
        }
    }
}

/// A selection that no longer exists must not point at its neighbour's panel.
pub fn drop_lost_selection(state: &mut AppState) {
    if state.selection.selected.is_some_and(|item| !exists(state, item)) {
        state.selection.selected = None;
    }
    let mut also = std::mem::take(&mut state.selection.also);
    also.retain(|item| exists(state, *item));
    state.selection.also = also;
}

fn exists(state: &AppState, item: Item) -> bool {
    let scene = &state.document.scene;
    match item {
        Item::Cable(k) => k < scene.cables.len(),
        Item::Support { cable, support } => scene.cables.get(cable).is_some_and(|c| support < c.supports.len()),
        Item::Obstacle(k) => k < scene.obstacles.len(),
        Item::Corner { obstacle, corner } => scene.obstacles.get(obstacle).is_some_and(|o| match &o.shape {
            Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => {
                corner < points_m.len()
            }
            Shape::Circle { .. } => false,
        }),
        Item::Load(k) | Item::Head(k) => k < scene.loads.len(),
        Item::Robot => scene.robot.is_some(),
        Item::Leg(k) => scene.robot.as_ref().is_some_and(|r| k < r.path.len()),
        Item::Scene | Item::Environment | Item::Solver => true,
    }
}

pub fn set<T>(list: &mut [T], index: usize, value: T) {
    if let Some(slot) = list.get_mut(index) {
        *slot = value;
    }
}

/// The name, with the first free number appended if it is taken.
pub fn unique(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.to_owned();
    }
    (2..).map(|k| format!("{name} {k}")).find(|n| !taken(n)).unwrap_or_default()
}

pub fn add_waypoint(state: &mut AppState, cable: usize, arc_length_m: f64, at_m: Point) {
    let place = waypoint_place(state, cable, arc_length_m);
    let Some(c) = state.document.scene.cables.get_mut(cable) else { return };
    if c.supports.len() < 2 {
        return;
    }
    let place = place.clamp(1, c.supports.len() - 1);
    let name = unique("waypoint", |n| c.supports.iter().any(|s| s.name == n));
    c.supports.insert(place, Support::pulley(name, at_m));
    // A route laid before the waypoint existed may pass it on the wrong side.
    c.route_m.clear();
    state.selection.selected = Some(Item::Support { cable, support: place });
}

/// Which place among the supports a point of the cable falls into: after those that sit before it
/// now.
pub fn waypoint_place(state: &AppState, cable: usize, arc_length_m: f64) -> usize {
    let answer = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable));
    let (Some(answer), Some(c)) = (answer, state.document.scene.cables.get(cable)) else {
        return 1;
    };
    if answer.supports.len() != c.supports.len() {
        return 1;
    }
    answer.supports.iter().take_while(|s| s.arc_length_m < arc_length_m).count()
}
