//! The scene panel edits the name, the map and the things of the scene, with exact coordinates.
//!
//! - `map`, `robot`: pickers of known tanks and robots
//! - `supports`, `obstacles`, `loads`: a list each, and everything else of the selected one
//! - `rows`: the cells, headings and fields that lists are made of

mod loads;
mod map;
mod obstacles;
mod robot;
pub mod rows;
mod supports;

use cable_core::scene::catalog;
use egui::{CollapsingHeader, ComboBox, Ui};

use crate::command::{Command, FileCommand, SceneCommand};
use crate::panels::scene_errors;
use crate::state::AppState;
use crate::widgets::field;
use crate::widgets::property::labelled;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let width = ui.available_width();
    name(ui, state, commands);
    pickers(ui, state, commands);
    scene_errors::inline(ui, state, "version", commands);
    let index = state.current_cable();
    let supports = state.document.scene.cables.get(index).map_or(0, |c| c.supports.len());
    let title = match state.document.scene.cables.get(index) {
        Some(cable) if state.document.scene.cables.len() > 1 => format!("Supports of {} ({supports})", cable.name),
        _ => format!("Supports ({supports})"),
    };
    list(ui, width, ("supports", &title), |ui| supports::ui(ui, state, index, commands));
    let title = format!("Obstacles ({})", state.document.scene.obstacles.len());
    list(ui, width, ("obstacles", &title), |ui| obstacles::ui(ui, state, commands));
    let title = format!("Loads ({})", state.document.scene.loads.len());
    list(ui, width, ("loads", &title), |ui| loads::ui(ui, state, commands));
}

fn list(ui: &mut Ui, width: f32, (id, title): (&str, &str), contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(title).id_salt(id).default_open(true).show_unindented(ui, |ui| {
        ui.set_max_width(width);
        contents(ui);
    });
}

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

fn pickers(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    labelled(ui, "Open", "Open scene", |ui| {
        let combo = ComboBox::from_id_salt("scene")
            .selected_text("Choose a scene…")
            .width(ui.available_width() - 8.0)
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
    robot::ui(ui, state, commands);
}
