//! Scene commands change the scene.

use cable_core::error::SceneFault;
use cable_core::math::Point;
use cable_core::scene::{Environment, RobotTask, Support};
use cable_core::{Cable, Load, Obstacle, Robot, Scene};

use crate::command::effects::{Effects, next_number, submit_edit, submit_undone};
use crate::command::move_item::{move_item, set};
use crate::command::playback::{self, PlaybackCommand};
use crate::command::remove_item::{drop_changed_selection, drop_lost_selection, remove_all};
use crate::command::robot_hitch::{SupportMove, hitched_support, set_robot};
use crate::command::unique_name::unique;
use crate::command::waypoint::add_waypoint;
use crate::command::{blocked_route, clipboard};
use crate::geometry::supports::is_broken;
use crate::state::live::RestartCause;
use crate::state::undo::EditKind;
use crate::state::{AppState, Item};
use crate::worker::engine::is_quasi_static;
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
        /// Its new properties.
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
    /// Puts a thing (a support, a whole obstacle by its first corner or centre, a corner) at a
    /// point, m.
    Move {
        /// The item that is moved.
        item: Item,
        /// The target, m.
        to_m: Point,
    },
    /// Puts several things at points, m.
    MoveAll(Vec<(Item, Point)>),
    /// A frictionless point pulley on the cable.
    AddWaypoint {
        /// Index of the cable.
        cable: usize,
        /// The place on the cable, m (decides its place among the supports).
        arc_length_m: f64,
        /// The place where it holds the cable, m.
        at_m: Point,
    },
    /// Sets another robot, or none: the support that the robot held is then fixed at its place.
    SetRobot(Option<Robot>),
    /// Adds a leg of the robot's path to a place, m: after the selected leg, else at the end.
    AddLeg {
        /// The target, m.
        to_x_m: f64,
    },
    /// Lays a cable anew from its supports at the start: its route and its motion are dropped.
    LayAnew {
        /// Index.
        cable: usize,
    },
    /// Another cable like the current one, beside it.
    AddCable,
    /// A new obstacle; its name is made unique.
    AddObstacle(Obstacle),
    /// A new load.
    AddLoad(Load),
    /// Takes a thing out; the ends of a cable become free, its last cable stays.
    Remove(Item),
    /// Takes several things out.
    RemoveAll(Vec<Item>),
    /// Copies the selection.
    Copy,
    /// Copies the selection and removes it.
    Cut,
    /// Pastes the copied items, with their middle at a point (m), else a little beside the
    /// originals.
    Paste {
        /// The middle of the pasted items, m.
        at_m: Option<Point>,
    },
    /// Ends a pointer drag or a typed value: the next edit is another step of undo.
    EditDone,
    /// Undoes one edit.
    Undo,
    /// Redoes one edit.
    Redo,
}

impl SceneCommand {
    /// Edits of one kind that follow each other are undone together.
    fn kind(&self) -> EditKind {
        EditKind::Series(match self {
            Self::SetName(_) => "name".to_owned(),
            Self::SetEnvironment(_) => "environment".to_owned(),
            Self::SetCable { cable, .. } => format!("cable {cable}"),
            Self::SetSupport { cable, support, .. } => format!("support {cable} {support}"),
            Self::SetObstacle { obstacle, .. } => format!("obstacle {obstacle}"),
            Self::SetLoad { load, .. } => format!("load {load}"),
            Self::SetRobot(_) => "robot".to_owned(),
            Self::Move { item, .. } => format!("move {item:?}"),
            Self::MoveAll(moves) => format!("move {:?}", moves.iter().map(|(item, _)| item).collect::<Vec<_>>()),
            _ => return EditKind::Single,
        })
    }
}

/// Applies a scene command.
pub fn apply(state: &mut AppState, command: SceneCommand, effects: &mut Effects) {
    match command {
        SceneCommand::EditDone => return state.document.undo.close_entry(),
        SceneCommand::Copy => return clipboard::copy(state, effects),
        SceneCommand::Cut => clipboard::copy(state, effects),
        SceneCommand::Undo if state.live.reset_is_last => {
            return playback::apply(state, PlaybackCommand::UndoRestart, effects);
        }
        SceneCommand::Undo | SceneCommand::Redo if ends_at_earlier_run(state, &command) => {
            let before = state.document.scene.clone();
            playback::apply(state, PlaybackCommand::UndoRestart, effects);
            return drop_changed_selection(state, &before);
        }
        SceneCommand::Undo | SceneCommand::Redo => {
            let other = match command {
                SceneCommand::Undo => state.document.undo.undo(&state.document.scene),
                _ => state.document.undo.redo(&state.document.scene),
            };
            let Some(other) = other else { return };
            let before = std::mem::replace(&mut state.document.scene, other);
            drop_changed_selection(state, &before);
            state.document.validate();
            submit_undone(state, effects);
            return;
        }
        _ => {}
    }
    let (before, kind) = (state.document.scene.clone(), command.kind());
    let dragged = match command {
        SceneCommand::Move { item: Item::Support { cable, support }, to_m } => {
            Some(SupportMove { cable, support, to_m })
        }
        _ => None,
    };
    let lays_anew = matches!(command, SceneCommand::LayAnew { .. });
    let robot_moves = matches!(command, SceneCommand::Move { item: Item::Robot, .. });
    let new_obstacles =
        matches!(command, SceneCommand::SetScene(_) | SceneCommand::AddObstacle(_) | SceneCommand::Paste { .. });
    change(state, command);
    if new_obstacles && state.document.scene.obstacles != before.obstacles {
        blocked_route::remove_penetrating_routes(&mut state.document.scene);
    }
    let dragged = if robot_moves { hitched_support(&state.document.scene) } else { dragged };
    if state.document.scene == before {
        if lays_anew && state.live.has_run() {
            playback::apply(state, PlaybackCommand::Reset, effects);
        }
        return;
    }
    state.document.undo.record(&before, kind);
    drop_lost_selection(state);
    state.live.reset_is_last = false;
    if let Some(SupportMove { cable, support, to_m }) = dragged
        && pulls_past_length(state, &before, cable, support)
    {
        pull_past_length(state, before, cable, support, to_m, effects);
        return;
    }
    if lays_anew {
        state.document.validate();
        // If time has run, the cable has a history as well.
        if state.live.has_run() {
            playback::apply(state, PlaybackCommand::Reset, effects);
        }
        return submit_undone(state, effects);
    }
    submit_edited_scene(state, dragged, effects);
}

/// Returns true if an undo or redo leads to the scene of the other run: the one that an edit ended,
/// or the one after that edit.
fn ends_at_earlier_run(state: &AppState, command: &SceneCommand) -> bool {
    let scene = state.live.earlier_run.as_ref().and_then(|run| match &run.cause {
        RestartCause::Edit(scene) => Some(scene),
        RestartCause::Reset(_) => None,
    });
    let [back, forward] = state.document.undo.neighbours();
    let to = if *command == SceneCommand::Undo { back } else { forward };
    scene.is_some() && to == scene
}

/// Returns whether the scene has no answer because a support was moved, after time had run, farther
/// than its cable reaches.
#[must_use]
pub fn is_refused_pull(state: &AppState) -> bool {
    let fault = state.document.fault.as_ref().map(|f| &f.fault);
    let ([Some(before), _], Some(SceneFault::TooShort { .. })) = (state.document.undo.neighbours(), fault) else {
        return false;
    };
    let mut then = state.document.scene.clone();
    for (cable, was) in then.cables.iter_mut().zip(&before.cables) {
        for (support, was) in cable.supports.iter_mut().zip(&was.supports) {
            support.at_m = was.at_m;
        }
    }
    then == *before && state.live.has_run()
}

/// Returns whether the pointer pulls a support, while masses move, to where the cable does not
/// reach, and the user wants that to pull instead of being refused. Of a broken cable the pieces go
/// where the hand leads them.
fn pulls_past_length(state: &AppState, before: &Scene, cable: usize, support: usize) -> bool {
    let item = Item::Support { cable, support };
    let by_spring = state.selection.grab.is_some_and(|g| g.item == item) && !is_quasi_static(state.solver.model);
    let pulls = state.solver.pulls_past_length || is_broken(state, cable);
    let wanted = pulls && by_spring && !state.live.playback.paused;
    wanted && state.document.scene.validate().is_err() && before.validate().is_ok()
}

/// The hand goes on to a point (m) and pulls by its spring; in the scene the support stays where
/// the cable last reached it.
fn pull_past_length(
    state: &mut AppState,
    before: Scene,
    cable: usize,
    support: usize,
    to_m: Point,
    effects: &mut Effects,
) {
    state.document.scene = before;
    state.document.validate();
    state.live.show_time(None);
    state.selection.spring_support = Some((cable, support));
    drag_support(state, cable, support, to_m, effects);
}

/// Sends the edited scene: as a drag while time runs, else to be solved.
fn submit_edited_scene(state: &mut AppState, dragged: Option<SupportMove>, effects: &mut Effects) {
    state.document.validate();
    let grabbed = state.selection.grab.map(|g| g.item).filter(|_| dragged.is_some());
    let stops = !state.live.playback.paused || state.live.stopped_by_drag.is_some();
    match dragged {
        Some(_) if stops && state.document.fault.is_some() => {
            submit_edit(state, effects);
            state.live.stopped_by_drag = grabbed;
        }
        // The support is back within reach: `resume_after_drag` goes on as soon as the worker has
        // stopped.
        Some(_) if grabbed.is_some() && state.live.stopped_by_drag == grabbed => {}
        Some(SupportMove { cable, support, to_m }) if !state.live.playback.paused && state.document.fault.is_none() => {
            state.live.show_time(None);
            // A pointer holds the support by a spring; a key or a robot prescribes its place.
            let item = Item::Support { cable, support };
            let by_spring =
                state.selection.grab.is_some_and(|g| g.item == item) && !is_quasi_static(state.solver.model);
            state.selection.spring_support = by_spring.then_some((cable, support));
            drag_support(state, cable, support, to_m, effects);
        }
        _ => submit_edit(state, effects),
    }
}

/// Time that stopped because a drag led farther than a cable reaches goes on once the thing is back
/// within reach: a support from where the cable held it last, to be drawn on from there.
pub fn resume_after_drag(state: &mut AppState, effects: &mut Effects) {
    let Some(item) = state.live.stopped_by_drag else { return };
    // Time must not go on before the worker has reported its stop, which would pause it once more.
    if state.document.fault.is_some() || !state.live.playback.paused || !state.live.latest.stale {
        return;
    }
    if let Item::Support { cable, support } = item {
        let answer = state.live.latest.solution.as_ref().and_then(|s| s.cables.get(cable)?.supports.get(support));
        let at = answer.map(|s| [s.x_m, s.y_m]);
        let support_of_scene = state.document.scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support));
        if let (Some(at), Some(support_of_scene)) = (at, support_of_scene) {
            let to = support_of_scene.at_m.replace(at);
            if state.document.scene.validate().is_err()
                && let Some(support_of_scene) =
                    state.document.scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
            {
                support_of_scene.at_m = to;
            }
        }
    }
    state.live.playback.paused = false;
    submit_edit(state, effects);
}

/// Moves a support to a point (m), by a spring or by prescription.
fn drag_support(state: &mut AppState, cable: usize, support: usize, to_m: Point, effects: &mut Effects) {
    let by_spring = state.selection.spring_support == Some((cable, support));
    let drag = Drag { cable, support, to_m, by_spring, scene: state.document.scene.clone() };
    effects.request.merge(Request { drag: Some(drag), number: next_number(state), ..Request::default() });
}

/// The pointer lets go of a support that it held by a spring: it is fixed where it is.
pub(super) fn release_spring_support(state: &mut AppState, effects: &mut Effects) {
    let Some((cable, support)) = state.selection.spring_support.take() else { return };
    // Out of reach the scene was refused: it stays as the pointer leaves it, so that what is said
    // of it and the mends that are offered are of this scene.
    if state.document.fault.is_some() {
        return;
    }
    let answer = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(cable)?.supports.get(support));
    let at = answer.filter(|r| r.hand.is_some()).map(|r| [r.x_m, r.y_m]);
    let support_of_scene = state.document.scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support));
    if let (Some(at), Some(support_of_scene)) = (at, support_of_scene) {
        let before = support_of_scene.at_m.replace(at);
        // A piece that tore off may have been led farther than the whole cable reaches.
        if state.document.scene.validate().is_err()
            && let Some(support_of_scene) =
                state.document.scene.cables.get_mut(cable).and_then(|c| c.supports.get_mut(support))
        {
            support_of_scene.at_m = before;
        }
        drag_support(state, cable, support, at, effects);
    }
}

/// Applies a command to the scene.
fn change(state: &mut AppState, command: SceneCommand) {
    let scene = &mut state.document.scene;
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
        SceneCommand::MoveAll(moves) => moves.into_iter().for_each(|(item, to_m)| move_item(state, item, to_m)),
        SceneCommand::AddWaypoint { cable, arc_length_m, at_m } => add_waypoint(state, cable, arc_length_m, at_m),
        SceneCommand::SetRobot(robot) => set_robot(scene, robot),
        SceneCommand::AddLeg { to_x_m } => add_leg(state, to_x_m),
        SceneCommand::LayAnew { cable } => {
            if let Some(cable) = scene.cables.get_mut(cable) {
                cable.route_m.clear();
            }
        }
        SceneCommand::AddCable => clipboard::add_cable(state),
        SceneCommand::Paste { at_m } => clipboard::paste(state, at_m),
        SceneCommand::AddObstacle(mut obstacle) => {
            obstacle.name = unique(&obstacle.name, |n| scene.obstacles.iter().any(|o| o.name == n));
            scene.obstacles.push(obstacle);
            state.selection.selected = Some(Item::Obstacle(state.document.scene.obstacles.len() - 1));
        }
        SceneCommand::AddLoad(load) => {
            scene.loads.push(load);
            state.selection.selected = Some(Item::Load(state.document.scene.loads.len() - 1));
        }
        SceneCommand::Remove(item) => remove_all(state, vec![item]),
        SceneCommand::RemoveAll(items) => remove_all(state, items),
        SceneCommand::Cut => remove_all(state, state.selection.selected_items()),
        SceneCommand::EditDone | SceneCommand::Copy | SceneCommand::Undo | SceneCommand::Redo => {}
    }
}

/// Speed of a first leg, m/s: a careful walk.
const FIRST_LEG_M_PER_S: f64 = 0.3;

/// Adds a leg after the selected one, or at the end of the path, with the speed of the one before.
fn add_leg(state: &mut AppState, to_x_m: f64) {
    let Some(robot) = state.document.scene.robot.as_mut().filter(|_| to_x_m.is_finite()) else { return };
    let place = match state.selection.selected {
        Some(Item::PathLeg(k)) => (k + 1).min(robot.path.len()),
        _ => robot.path.len(),
    };
    let speeds = robot.path.iter().take(place).rev().filter_map(|task| match task {
        RobotTask::Drive { speed_m_per_s, .. } => Some(*speed_m_per_s),
        RobotTask::Wait { .. } => None,
    });
    let speed_m_per_s = speeds.into_iter().next().unwrap_or(FIRST_LEG_M_PER_S);
    robot.path.insert(place, RobotTask::Drive { to_x_m, speed_m_per_s });
    (state.selection.selected, state.selection.also_selected) = (Some(Item::PathLeg(place)), Vec::new());
}
