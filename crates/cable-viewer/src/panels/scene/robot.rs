//! The form of the robot says which it is, where it stands and which way. A first one stands where
//! it can, with the end of the cable on its hitch.

use cable_core::scene::preset::{self, RobotPreset};
use cable_core::scene::{Ground, Heading, SupportKind};
use cable_core::{Robot, Scene};
use egui::{ComboBox, Ui};

use crate::command::{Command, SceneCommand, support_kind};
use crate::panels::scene::rows::{coordinates, named_place, show_faults};
use crate::panels::scene_errors;
use crate::state::AppState;
use crate::units::unit::Unit;
use crate::widgets::property::labelled;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let present = state.document.scene.robot.as_ref();
    labelled(ui, "Robot", "Robot", |ui| {
        let shown = present.map(|r| preset::robot_preset(&r.preset).map_or(r.preset.as_str(), |p| p.name.as_str()));
        let combo = ComboBox::from_id_salt("robot").selected_text(shown.unwrap_or("None"));
        let combo = combo.width(ui.available_width() - 14.0).truncate();
        let shown = combo.show_ui(ui, |ui| {
            if ui.selectable_label(present.is_none(), "None").clicked() {
                set(None, commands);
            }
            for p in preset::robot_presets() {
                let entry = ui.selectable_label(present.is_some_and(|r| r.preset == p.id), &p.name);
                if entry.on_hover_text(about(p)).clicked() {
                    commands.push(chosen(state, p));
                    commands.push(Command::Scene(SceneCommand::EditDone));
                }
            }
        });
        shown
            .response
            .on_hover_text("A vehicle to scale. A first one stands near the end of the cable, on ground that is level enough, and has that end on its hitch")
    });
    if let Some(robot) = present {
        placed(ui, robot, commands);
    }
    scene_errors::inline(ui, state, "robot", commands);
}

/// The text about a robot preset on hover.
fn about(p: &RobotPreset) -> String {
    format!(
        "{}\n{} long, {} high, {}; hitch {} behind the middle, {} up",
        p.note,
        Unit::M.text(p.length_m.value),
        Unit::M.text(p.height_m.value),
        Unit::KG.text(p.mass_kg.value),
        Unit::M.text(p.hitch_back_m.value),
        Unit::M.text(p.hitch_up_m.value)
    )
}

fn set(robot: Option<Robot>, commands: &mut Vec<Command>) {
    commands.push(Command::Scene(SceneCommand::SetRobot(robot)));
    commands.push(Command::Scene(SceneCommand::EditDone));
}

/// The same robot of another kind, or a first one with the end of the cable on its hitch.
#[must_use]
pub fn chosen(state: &AppState, p: &RobotPreset) -> Command {
    Command::Scene(match &state.document.scene.robot {
        Some(present) => SceneCommand::SetRobot(Some(Robot { preset: p.id.to_owned(), ..present.clone() })),
        None => {
            let mut scene = state.document.scene.clone();
            add(&mut scene, state.current_cable(), p);
            SceneCommand::SetScene(Box::new(scene))
        }
    })
}

/// Steepest ground that a first robot is put on, rad: 11°. More: much of what its tracks hold is
/// spent before it pulls; less: rough waste has no place for it.
const MAX_START_SLOPE: f64 = 0.2;
/// Distance of the places that are tried, m, and their number to each side: a tank's width.
const PLACEMENT_TRIALS: (f64, u32) = (0.25, 100);

/// Puts a robot into a scene that has none: as near as can be to below the end of a cable, which it
/// takes over from a hand.
fn add(scene: &mut Scene, cable: usize, p: &RobotPreset) {
    let end = scene.cables.get(cable).and_then(|c| c.supports.last()?.at_m);
    let at = end.unwrap_or_default();
    let (ground, half) = (Ground::of(scene), p.track_half_length_m());
    let stands = |x: f64| {
        // No part of it in a wall, and not on top of one.
        let level = |half: f64| ground.stand(x, half).filter(|s| s.pitch.abs() < MAX_START_SLOPE);
        let place = level(0.5 * p.length_m.value).and(level(half)).map(|s| [x, s.height]);
        place.filter(|place| place[1] <= at[1] + p.height_m.value)
    };
    // Its back is turned to where the cable comes from.
    let start = scene.cables.get(cable).and_then(|c| c.supports.first()?.at_m);
    let (heading, forward) =
        if start.is_some_and(|s| s[0] > at[0]) { (Heading::Left, -1.0) } else { (Heading::Right, 1.0) };
    let below = at[0] + forward * p.hitch_back_m.value;
    let places =
        (0..=PLACEMENT_TRIALS.1).flat_map(|k| [-1.0, 1.0].map(|side| below + side * PLACEMENT_TRIALS.0 * f64::from(k)));
    let at_m = places.into_iter().find_map(stands).unwrap_or([below, at[1] - p.hitch_up_m.value]);
    scene.robot = Some(Robot { preset: p.id.to_owned(), at_m, heading, ..Robot::default() });
    let may_be_hitched = |kind| matches!(kind, SupportKind::Fixed | SupportKind::Clamped | SupportKind::Free);
    let last = scene.cables.get_mut(cable).and_then(|c| c.supports.last_mut());
    if let Some(support) = last.filter(|s| may_be_hitched(s.kind)) {
        *support = support_kind::of_kind(support, SupportKind::Robot, at, 0.0, support_kind::SupportPlace::CableEnd);
    }
}

/// Position and heading of the robot.
fn placed(ui: &mut Ui, robot: &Robot, commands: &mut Vec<Command>) {
    let mut faults = Vec::new();
    named_place(ui, "Start position", |ui| {
        if let Some(at_m) = coordinates(ui, "robot", robot.at_m, &mut faults) {
            set(Some(Robot { at_m, ..robot.clone() }), commands);
        }
    });
    labelled(ui, "Facing", "Robot facing", |ui| {
        let mut heading = robot.heading;
        let left = ui.selectable_value(&mut heading, Heading::Left, "Left");
        let help = "Its hitch is at its other end";
        ui.selectable_value(&mut heading, Heading::Right, "Right").on_hover_text(help);
        if heading != robot.heading {
            set(Some(Robot { heading, ..robot.clone() }), commands);
        }
        left.on_hover_text(help)
    });
    show_faults(ui, &faults);
}
