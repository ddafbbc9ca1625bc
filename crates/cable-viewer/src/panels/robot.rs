//! The robot panel drives by hand, edits the path, and shows what the motion is made of.

use cable_core::Robot;
use cable_core::scene::preset::robot_preset;
use cable_core::scene::{ROLLING_RESISTANCE, RobotTask, SupportKind, TRACK_FRICTION};
use cable_core::solution::RobotReport;
use egui::Ui;

use crate::command::{Command, PlaybackCommand, SceneCommand};
use crate::panels::readouts::dimmed_if_old;
use crate::panels::scene_errors;
use crate::state::AppState;
use crate::units::format::{self, quantity};
use crate::units::unit::Unit;
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::icon::{self, Icon};
use crate::widgets::property::labelled;
use crate::widgets::{field, readout};

/// Width of a number, points: “12.34 m/s” fits.
const WIDTH: f32 = 72.0;
/// Help of the button that stops the robot. A lever of a hydraulic travel drive is eased back
/// within about a second, and the brake holds once the robot stands; an emergency stop is not
/// modelled.
const STOP_HELP: &str = "Brakes as a lever that is eased back: at most 1 m/s², without a jerk. From 0.5 m/s it stands after 1 s \
                         and 0.25 m. An emergency stop is sharper, and is not modelled";
/// Room for “1  To”, “at” and the button of a leg with the gaps between, points.
const LEG_WORDS: f32 = 74.0;
/// Speed of a new leg, m/s, and its wait, s.
const FIRST_LEG: (f64, f64) = (0.3, 2.0);

/// Draws it, if the scene has one.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Some(robot) = &state.document.scene.robot else {
        ui.weak("No robot: select the scene and choose one");
        return;
    };
    by_hand(ui, state, commands);
    match state.live.snapshot.solution.as_ref().and_then(|s| s.robot) {
        Some(report) => dimmed_if_old(ui, state, |ui| readouts(ui, &report, pull_n(state))),
        None => {
            ui.weak("It cannot drive here: it needs ground below it in a side view");
        }
    }
    figures(ui, robot, commands);
    path(ui, robot, commands);
    scene_errors::inline(ui, state, "robot.path", commands);
}

/// Speed of the robot by hand, m/s: what was set, else its greatest.
#[must_use]
pub fn hand_speed(state: &AppState) -> f64 {
    let top = state
        .document
        .scene
        .robot
        .as_ref()
        .and_then(|r| robot_preset(&r.preset))
        .map_or(0.0, |p| p.speed_m_per_s.value);
    state.live.manual_robot_speed.map_or(top, |v| v.min(top))
}

/// The controls that drive the robot by hand.
fn by_hand(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let speed = hand_speed(state);
    let order = state.live.robot_speed_command;
    ui.horizontal_wrapped(|ui| {
        for (text, help, wanted, on) in [
            (
                "Drive left",
                "Drives to the left until it is stopped (hold A)",
                Some(-speed),
                order.is_some_and(|v| v < 0.0),
            ),
            ("Stop", STOP_HELP, Some(0.0), order == Some(0.0)),
            (
                "Drive right",
                "Drives to the right until it is stopped (hold D)",
                Some(speed),
                order.is_some_and(|v| v > 0.0),
            ),
            ("Follow path", "Drives its path by itself", None, order.is_none()),
        ] {
            if ui.selectable_label(on, text).on_hover_text(help).clicked() {
                commands.push(Command::Playback(PlaybackCommand::DriveRobot(wanted)));
            }
        }
    });
    labelled(ui, "Manual speed", "Manual speed", |ui| {
        let entry = field::number(ui, "Manual speed", Unit::M_PER_S, speed, WIDTH);
        if let Some(speed) = entry.value {
            commands.push(Command::Playback(PlaybackCommand::SetRobotSpeed(speed)));
        }
        entry.response.on_hover_text("How fast it is driven by hand; at most its greatest speed")
    });
}

/// Force of the cables on the hitch, N: at rest the report of the robot has none yet.
fn pull_n(state: &AppState) -> f64 {
    let Some(answer) = &state.live.snapshot.solution else { return 0.0 };
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let supports =
        scene.cables.iter().zip(&answer.cables).flat_map(|(c, solved)| c.supports.iter().zip(&solved.supports));
    let on_it = supports.filter(|(s, _)| s.kind == SupportKind::Robot);
    let [x, y] = on_it.fold([0.0; 2], |[x, y], (_, r)| [x + r.reaction_x_n, y + r.reaction_y_n]);
    x.hypot(y)
}

/// What the robot does now; `pull_n` is the pull on its hitch.
fn readouts(ui: &mut Ui, r: &RobotReport, pull_n: f64) {
    let share = if r.traction_n > 0.0 { r.thrust_n.abs() / r.traction_n } else { 0.0 };
    let Unit { symbol, si, .. } = Unit::M_PER_S.display();
    let speed = |v: f64| quantity(v / si, 3, symbol);
    let rows = [
        ("Motion", r.going.name().to_owned(), "Why it is as fast as it is"),
        ("Speed", speed(r.speed_m_per_s), "Along the ground"),
        ("Commanded speed", speed(r.commanded_m_per_s), "By hand or by its path"),
        ("Slope", format!("{:.1}°", r.pitch_deg).replace('-', "−"), "Positive where it climbs to the right"),
        ("Track force", format::force(r.thrust_n), "Force of the tracks along the ground"),
        (
            "Traction used",
            format::percent(share),
            "Track force as a share of what the tracks can hold, friction times normal force: at 100 % the tracks slip",
        ),
        ("Normal force", format::force(r.normal_n), "Of the ground on its tracks; the cable can lift or press"),
        ("Pull of the cable", format::force(pull_n), "On its hitch; it slows the robot by the balance of forces"),
        (
            "Cable contact force",
            format::force(r.push_x_n.hypot(r.push_y_n)),
            "On its body, where the cable lies on it or is pushed along",
        ),
        (
            "Work of the tracks",
            format::energy(r.work.drive_j + r.work.slip_j),
            "Of the drive since the start, less what it brakes and what slips take; all work together is its energy of motion",
        ),
        ("Work of the cable", format::energy(r.work.cable_j), "On its hitch and body since the start"),
        ("Work of rolling resistance", format::energy(r.work.rolling_j), "Of the ground on its tracks since the start"),
        (
            "Work of weight and ground",
            format::energy(r.work.weight_j + r.work.ground_j + r.work.impact_j),
            "By how high it stands, where it tips over corners, and where something stops it",
        ),
    ];
    for (name, value, help) in rows {
        readout::row(ui, name, &value, help, |_| {});
    }
}

fn set(robot: Robot, commands: &mut Vec<Command>) {
    commands.push(Command::Scene(SceneCommand::SetRobot(Some(robot))));
    commands.push(Command::Scene(SceneCommand::EditDone));
}

/// Track friction and rolling resistance.
fn figures(ui: &mut Ui, robot: &Robot, commands: &mut Vec<Command>) {
    let friction = robot.track_friction.unwrap_or(TRACK_FRICTION);
    let rolling = robot.rolling_resistance.unwrap_or(ROLLING_RESISTANCE);
    labelled(ui, "Track friction", "Track friction", |ui| {
        let entry = field::number(ui, "Track friction", Unit::PLAIN_NUMBER, friction, WIDTH);
        if let Some(value) = entry.value {
            set(Robot { track_friction: Some(value), ..robot.clone() }, commands);
        }
        entry
            .response
            .on_hover_text("Of tracks on the ground: 0.3 wet and smooth, 0.6 rough; 0.45 unless set (estimated)")
    });
    labelled(ui, "Rolling resistance", "Rolling resistance", |ui| {
        let entry = field::number(ui, "Rolling resistance", Unit::PLAIN_NUMBER, rolling, WIDTH);
        if let Some(value) = entry.value {
            set(Robot { rolling_resistance: Some(value), ..robot.clone() }, commands);
        }
        entry
            .response
            .on_hover_text("Over normal force: 0.03 on concrete, 0.1 on soft ground; 0.06 unless set (estimated)")
    });
}

/// A leg to a place a metre ahead.
#[must_use]
pub fn first_drive(robot: &Robot) -> RobotTask {
    RobotTask::Drive { to_x_m: robot.at_m[0] + 1.0, speed_m_per_s: FIRST_LEG.0 }
}

/// A leg that stands still for a while.
#[must_use]
pub fn first_wait() -> RobotTask {
    RobotTask::Wait { wait_s: FIRST_LEG.1 }
}

/// The legs of the path.
fn path(ui: &mut Ui, robot: &Robot, commands: &mut Vec<Command>) {
    ui.separator();
    ui.weak(if robot.path.is_empty() { "No path: it stands until it is driven" } else { "Path" });
    let mut faults = Vec::new();
    for k in 0..robot.path.len() {
        ui.push_id(("leg", k), |ui| leg(ui, robot, k, &mut faults, commands));
    }
    for text in &faults {
        field::fault(ui, text);
    }
    ui.horizontal(|ui| {
        let mut add = |task| {
            let mut changed = robot.clone();
            changed.path.push(task);
            set(changed, commands);
        };
        if ui.button("Add drive").on_hover_text("A leg to a place").clicked() {
            add(first_drive(robot));
        }
        if ui.button("Add wait").on_hover_text("Stands still for a while").clicked() {
            add(first_wait());
        }
        let mut repeat = robot.repeat;
        if checkbox(ui, &mut repeat, "Repeat").on_hover_text("Starts again after the last leg").changed() {
            set(Robot { repeat, ..robot.clone() }, commands);
        }
    });
}

/// The fields of leg `k`.
fn leg(ui: &mut Ui, robot: &Robot, k: usize, faults: &mut Vec<String>, commands: &mut Vec<Command>) {
    let Some(task) = robot.path.get(k) else { return };
    let number = k + 1;
    // Beside both numbers stand words and the button that takes the leg out.
    let width = (0.5 * (ui.available_width() - LEG_WORDS) - 8.0).clamp(44.0, WIDTH);
    let put = |task: Option<RobotTask>, commands: &mut Vec<Command>| {
        let mut changed = robot.clone();
        match (task, changed.path.get_mut(k)) {
            (Some(task), Some(slot)) => *slot = task,
            (None, Some(_)) => {
                changed.path.remove(k);
            }
            _ => return,
        }
        set(changed, commands);
    };
    ui.horizontal(|ui| {
        match *task {
            RobotTask::Drive { to_x_m, speed_m_per_s } => {
                ui.label(format!("{number}  To"));
                let to = field::number(ui, &format!("Place of leg {number}"), Unit::COORDINATE, to_x_m, width);
                if let Some(to_x_m) = to.value {
                    put(Some(RobotTask::Drive { to_x_m, speed_m_per_s }), commands);
                }
                faults.extend(to.fault);
                to.response.on_hover_text("Where the middle of its tracks goes; its flag on the canvas can be dragged");
                ui.label("at");
                let at = field::number(ui, &format!("Speed of leg {number}"), Unit::M_PER_S, speed_m_per_s, width);
                if let Some(speed_m_per_s) = at.value {
                    put(Some(RobotTask::Drive { to_x_m, speed_m_per_s }), commands);
                }
                faults.extend(at.fault);
                at.response.on_hover_text("How fast; at most its greatest speed");
            }
            RobotTask::Wait { wait_s } => {
                ui.label(format!("{number}  Wait"));
                let wait = field::number(ui, &format!("Wait of leg {number}"), Unit::S, wait_s, WIDTH);
                if let Some(wait_s) = wait.value {
                    put(Some(RobotTask::Wait { wait_s }), commands);
                }
                faults.extend(wait.fault);
                wait.response.on_hover_text("How long it stands");
            }
        }
        let remove = icon::plain_button(ui, Icon::Remove);
        field::name(&remove, &format!("Remove leg {number}"));
        if remove.on_hover_text("Removes this leg").clicked() {
            put(None, commands);
        }
    });
}
