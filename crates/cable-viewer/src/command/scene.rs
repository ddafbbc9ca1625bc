//! Commands that change the scene.

use cable_core::math::Point;
use cable_core::scene::ground::Ground;
use cable_core::scene::{Environment, Shape, Support, SupportKind};
use cable_core::{Cable, Load, Obstacle, Robot, Scene};

use super::{Effects, next_number, submit_scene};
use crate::state::{AppState, Item};
use crate::undo::EditKind;
use crate::worker::request::{Drag, Request};

/// Changes the scene. Indices that do not exist change nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneCommand {
    /// The whole scene, for edits that touch several parts at once (a map, a rename).
    SetScene(Box<Scene>),
    /// The scene's name.
    SetName(String),
    /// Gravity, wind, temperature.
    SetEnvironment(Environment),
    /// A cable with changed properties.
    SetCable {
        /// Index.
        cable: usize,
        /// Its new self.
        value: Box<Cable>,
    },
    /// A support with changed properties.
    SetSupport {
        /// Index of the cable.
        cable: usize,
        /// Index of the support.
        support: usize,
        /// Its new self.
        value: Box<Support>,
    },
    /// An obstacle with changed properties.
    SetObstacle {
        /// Index.
        obstacle: usize,
        /// Its new self.
        value: Obstacle,
    },
    /// A load with changed properties.
    SetLoad {
        /// Index.
        load: usize,
        /// Its new self.
        value: Load,
    },
    /// Puts a thing (a support, a whole obstacle by its first corner or centre, a corner) at a point, m.
    Move {
        /// What.
        item: Item,
        /// Where to, m.
        to_m: Point,
    },
    /// A frictionless point pulley on the cable.
    AddWaypoint {
        /// Index of the cable.
        cable: usize,
        /// Where on the cable, m (decides its place among the supports).
        arc_length_m: f64,
        /// Where it holds the cable, m.
        at_m: Point,
    },
    /// Another robot, or none: what hung on it is then fixed where it hung.
    SetRobot(Option<Robot>),
    /// A new obstacle; its name is made unique.
    AddObstacle(Obstacle),
    /// A new load.
    AddLoad(Load),
    /// Takes a thing out; the ends of a cable become free, its last cable stays.
    Remove(Item),
    /// A pointer drag or a typed value is complete: the next edit is undone by itself.
    EditDone,
    /// Back by one edit.
    Undo,
    /// Forward by one edit.
    Redo,
}

impl SceneCommand {
    /// Edits of one kind that follow each other are undone together.
    fn kind(&self) -> EditKind {
        EditKind(match self {
            Self::SetName(_) => "name".to_owned(),
            Self::SetEnvironment(_) => "environment".to_owned(),
            Self::SetCable { cable, .. } => format!("cable {cable}"),
            Self::SetSupport { cable, support, .. } => format!("support {cable} {support}"),
            Self::SetObstacle { obstacle, .. } => format!("obstacle {obstacle}"),
            Self::SetLoad { load, .. } => format!("load {load}"),
            Self::SetRobot(_) => "robot".to_owned(),
            Self::Move { item, .. } => format!("move {item:?}"),
            _ => "once".to_owned(),
        })
    }
}

/// Does one of them.
pub fn apply(state: &mut AppState, command: SceneCommand, effects: &mut Effects) {
    match command {
        SceneCommand::EditDone => return state.undo.close_entry(),
        SceneCommand::Undo | SceneCommand::Redo => {
            let other = match command {
                SceneCommand::Undo => state.undo.back(&state.scene),
                _ => state.undo.forward(&state.scene),
            };
            let Some(other) = other else { return };
            state.scene = other;
            drop_lost_selection(state);
            after_edit(state, None, effects);
            return;
        }
        _ => {}
    }
    let (before, kind) = (state.scene.clone(), command.kind());
    let once = kind.0 == "once";
    let dragged = match command {
        SceneCommand::Move { item: Item::Support { cable, support }, to_m } => Some((cable, support, to_m)),
        _ => None,
    };
    let robot_moves = matches!(command, SceneCommand::Move { item: Item::Robot, .. });
    change(state, command);
    let dragged = if robot_moves { hitched(&state.scene) } else { dragged };
    if state.scene == before {
        return;
    }
    if once {
        state.undo.close_entry();
    }
    state.undo.record(&before, kind);
    if once {
        state.undo.close_entry();
    }
    drop_lost_selection(state);
    after_edit(state, dragged, effects);
}

/// Sends the edited scene: as a drag while time runs, else to be solved.
fn after_edit(state: &mut AppState, dragged: Option<(usize, usize, Point)>, effects: &mut Effects) {
    state.scene_fault = state.scene.validate().err();
    match dragged {
        Some((cable, support, to_m)) if !state.playback.paused && state.scene_fault.is_none() => {
            state.show_time(None);
            let drag = Drag { cable, support, to_m, scene: state.scene.clone() };
            let request = Request { drag: Some(drag), number: next_number(state), ..Request::default() };
            effects.request.merge(request);
        }
        _ => submit_scene(state, false, effects),
    }
}

fn change(state: &mut AppState, command: SceneCommand) {
    let scene = &mut state.scene;
    match command {
        SceneCommand::SetScene(value) => *scene = *value,
        SceneCommand::SetName(name) => scene.name = name,
        SceneCommand::SetEnvironment(value) => scene.environment = value,
        SceneCommand::SetCable { cable, value } => set(&mut scene.cables, cable, *value),
        SceneCommand::SetSupport { cable, support, value } => {
            if let Some(c) = scene.cables.get_mut(cable) {
                set(&mut c.supports, support, *value);
            }
        }
        SceneCommand::SetObstacle { obstacle, value } => set(&mut scene.obstacles, obstacle, value),
        SceneCommand::SetLoad { load, value } => set(&mut scene.loads, load, value),
        SceneCommand::Move { item, to_m } => move_item(state, item, to_m),
        SceneCommand::AddWaypoint { cable, arc_length_m, at_m } => add_waypoint(state, cable, arc_length_m, at_m),
        SceneCommand::SetRobot(robot) => set_robot(scene, robot),
        SceneCommand::AddObstacle(mut obstacle) => {
            obstacle.name = unique(&obstacle.name, |n| scene.obstacles.iter().any(|o| o.name == n));
            scene.obstacles.push(obstacle);
            state.selected = Some(Item::Obstacle(state.scene.obstacles.len() - 1));
        }
        SceneCommand::AddLoad(load) => {
            scene.loads.push(load);
            state.selected = Some(Item::Load(state.scene.loads.len() - 1));
        }
        SceneCommand::Remove(item) => remove(state, item),
        SceneCommand::EditDone | SceneCommand::Undo | SceneCommand::Redo => {}
    }
}

fn set<T>(list: &mut [T], index: usize, value: T) {
    if let Some(slot) = list.get_mut(index) {
        *slot = value;
    }
}

/// The name, with the first free number appended if it is taken.
fn unique(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.to_owned();
    }
    (2..).map(|k| format!("{name} {k}")).find(|n| !taken(n)).unwrap_or_default()
}

fn move_item(state: &mut AppState, item: Item, to_m: Point) {
    if !to_m.iter().all(|v| v.is_finite()) {
        return;
    }
    let scene = &mut state.scene;
    match item {
        Item::Support { cable, support } => {
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
        Item::Cable(_) | Item::Load(_) => {}
    }
}

/// The support that hangs on the robot, and where.
fn hitched(scene: &Scene) -> Option<(usize, usize, Point)> {
    let hitch = scene.hitch_m()?;
    scene.cables.iter().enumerate().find_map(|(cable, c)| {
        let support = c.supports.iter().position(|s| s.kind == SupportKind::Robot)?;
        Some((cable, support, hitch))
    })
}

fn set_robot(scene: &mut Scene, robot: Option<Robot>) {
    if robot.is_none()
        && let Some((cable, support, hitch)) = hitched(scene)
        && let Some(s) = scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
    {
        *s = Support::fixed(s.name.clone(), hitch);
    }
    scene.robot = robot;
}

fn shifted(p: Point, from: Point, to: Point) -> Point {
    [p[0] + to[0] - from[0], p[1] + to[1] - from[1]]
}

fn add_waypoint(state: &mut AppState, cable: usize, arc_length_m: f64, at_m: Point) {
    let place = waypoint_place(state, cable, arc_length_m);
    let Some(c) = state.scene.cables.get_mut(cable) else { return };
    if c.supports.len() < 2 {
        return;
    }
    let place = place.clamp(1, c.supports.len() - 1);
    let name = unique("waypoint", |n| c.supports.iter().any(|s| s.name == n));
    c.supports.insert(place, Support::pulley(name, at_m));
    // A route laid before the waypoint existed may pass it on the wrong side.
    c.route_m.clear();
    state.selected = Some(Item::Support { cable, support: place });
}

/// Which place among the supports a point of the cable falls into: after those that sit before it now.
fn waypoint_place(state: &AppState, cable: usize, arc_length_m: f64) -> usize {
    let answer = state.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable));
    let (Some(answer), Some(c)) = (answer, state.scene.cables.get(cable)) else {
        return 1;
    };
    if answer.supports.len() != c.supports.len() {
        return 1;
    }
    answer.supports.iter().take_while(|s| s.arc_length_m < arc_length_m).count()
}

fn remove(state: &mut AppState, item: Item) {
    let scene = &mut state.scene;
    match item {
        Item::Cable(k) if scene.cables.len() > 1 && k < scene.cables.len() => {
            let gone = scene.cables.remove(k);
            scene.loads.retain(|l| l.cable != gone.name);
        }
        Item::Cable(_) => {}
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
        Item::Load(k) => {
            if k < scene.loads.len() {
                scene.loads.remove(k);
            }
        }
    }
    state.selected = None;
}

/// A selection that no longer exists must not point at its neighbour's panel.
fn drop_lost_selection(state: &mut AppState) {
    if state.selected.is_some_and(|item| !exists(state, item)) {
        state.selected = None;
    }
}

fn exists(state: &AppState, item: Item) -> bool {
    let scene = &state.scene;
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
        Item::Load(k) => k < scene.loads.len(),
        Item::Robot => scene.robot.is_some(),
    }
}
