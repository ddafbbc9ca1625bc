//! The scene panel edits the name, the map and the robot of the scene; the outline lists its
//! things.
//!
//! - `outline`: everything in the scene as a tree that selects
//! - `map`, `robot`: pickers of known tanks and robots
//! - `supports`, `obstacles`, `loads`: a list each, and a form for everything of one
//! - `rows`: the rows of the outline, and the cells and fields that forms are made of

pub(crate) mod loads;
pub(crate) mod map;
pub(crate) mod obstacles;
pub mod outline;
pub(crate) mod robot;
pub mod rows;
pub(crate) mod supports;

use cable_core::scene::catalog;
use egui::{ComboBox, Ui};

use crate::command::{Command, FileCommand, SceneCommand};
use crate::panels::scene_errors;
use crate::state::AppState;
use crate::widgets::field;
use crate::widgets::property::labelled;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    name(ui, state, commands);
    pickers(ui, state, commands);
    scene_errors::inline(ui, state, "version", commands);
}

/// The name of the scene.
fn name(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let mut wrong = None;
    labelled(ui, "Name", "Scene name", |ui| {
        let entry = field::text(ui, "Scene name", &state.document.scene.name, ui.available_width() - 8.0);
        wrong = entry.fault;
        if let Some(name) = entry.value {
            commands.push(Command::Scene(SceneCommand::SetName(name)));
            commands.push(Command::Scene(SceneCommand::EditDone));
        }
        entry.response.on_hover_text("Shown in the title and in reports")
    });
    if let Some(wrong) = wrong {
        field::fault(ui, &wrong);
    }
    scene_errors::inline(ui, state, "name", commands);
}

/// The choices of a scene, a map and a robot.
fn pickers(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    labelled(ui, "Open", "Open scene", |ui| {
        let combo = ComboBox::from_id_salt("scene")
            .selected_text("Choose a scene…")
            .width(ui.available_width() - 14.0)
            .truncate();
        let shown = combo.show_ui(ui, |ui| {
            for (id, scene) in catalog::all() {
                if ui.selectable_label(scene.name == state.document.scene.name, &scene.name).clicked() {
                    commands.push(Command::File(FileCommand::OpenCatalogue(id.to_owned())));
                }
            }
        });
        shown.response.on_hover_text("Ready-made scenes; asks first if this one is not saved")
    });
    map::ui(ui, state, commands);
    // One that is there has a panel of its own.
    if state.document.scene.robot.is_none() {
        robot::ui(ui, state, commands);
    }
}
