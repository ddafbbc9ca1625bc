//! The robot: which, where, which way.

use cable_core::Robot;
use cable_core::scene::Heading;
use cable_core::scene::preset::{self, RobotPreset};
use egui::{ComboBox, Ui};

use super::{coordinates, show_faults};
use crate::command::{Command, SceneCommand};
use crate::panels::cable::labelled;
use crate::panels::fault;
use crate::panels::unit::Unit;
use crate::state::AppState;
use cable_core::scene::ground::Ground;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let present = state.scene.robot.as_ref();
    labelled(ui, "Robot", "Robot", |ui| {
        let shown = present.map(|r| preset::robot_preset(&r.preset).map_or(r.preset.as_str(), |p| p.name.as_str()));
        let combo = ComboBox::from_id_salt("robot").selected_text(shown.unwrap_or("None"));
        let combo = combo.width(ui.available_width() - 8.0).truncate();
        let shown = combo.show_ui(ui, |ui| {
            if ui.selectable_label(present.is_none(), "None").clicked() {
                set(None, commands);
            }
            for p in preset::robot_presets() {
                let entry = ui.selectable_label(present.is_some_and(|r| r.preset == p.id), &p.name);
                if entry.on_hover_text(about(p)).clicked() {
                    set(Some(chosen(state, p)), commands);
                }
            }
        });
        shown
            .response
            .on_hover_text("A vehicle to scale; set the kind of an end to Robot to hang the cable on its hitch")
    });
    if let Some(robot) = present {
        placed(ui, robot, commands);
    }
    fault::inline(ui, state, "robot", commands);
}

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

/// The same robot of another kind, or a first one with its hitch at the end of the cable.
fn chosen(state: &AppState, p: &RobotPreset) -> Robot {
    if let Some(present) = &state.scene.robot {
        return Robot { preset: p.id.to_owned(), ..present.clone() };
    }
    let end = state.scene.cables.get(state.current_cable()).and_then(|c| c.supports.last()?.at_m).unwrap_or_default();
    let x = end[0] + p.hitch_back_m.value;
    let y = Ground::of(&state.scene).height(x).unwrap_or(end[1] - p.hitch_up_m.value);
    Robot { preset: p.id.to_owned(), at_m: [x, y], ..Robot::default() }
}

fn placed(ui: &mut Ui, robot: &Robot, commands: &mut Vec<Command>) {
    let mut faults = Vec::new();
    let at = format!("Stands at, {}", Unit::M.shown().symbol);
    labelled(ui, &at, "Robot stands at", |ui| {
        let label = ui.weak("x, y");
        if let Some(at_m) = coordinates(ui, "robot", robot.at_m, &mut faults) {
            set(Some(Robot { at_m, ..robot.clone() }), commands);
        }
        label.on_hover_text(
            "Where the middle of its tracks touches the ground; dragged on the canvas it stays on the ground",
        )
    });
    labelled(ui, "Looks", "Robot looks", |ui| {
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
