//! The cable panel edits the properties of the current cable.
//!
//! - `property`: each property with its unit and usual range
//! - `provenance`: source and confidence of each value

pub mod property;
pub mod provenance;

use cable_core::Cable;
use cable_core::scene::preset;
use egui::{ComboBox, Ui};

use crate::command::{Command, SceneCommand, ViewCommand};
use crate::panels::cable::property::{PROPERTIES, SEGMENTS};
use crate::panels::scene_errors;
use crate::state::{AppState, Item};
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::field;
use crate::widgets::property::{Provenance, labelled, row};

/// Height of the list of presets, points: all of them are seen at once.
const POPUP_HEIGHT: f32 = 360.0;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let index = state.current_cable();
    let Some(cable) = state.document.scene.cables.get(index) else {
        ui.weak("No cable");
        return;
    };
    ui.push_id(index, |ui| {
        picker(ui, state, index, commands);
        count(ui, state, index, commands);
        presets(ui, index, cable, commands);
        // The loaded scene's cable of this name is what reset returns to without a preset.
        let loaded = state.document.saved.cables.iter().find(|c| c.name == cable.name);
        for property in &PROPERTIES {
            let known = provenance::of(property, cable, loaded);
            let change = row(ui, &property.quantity, &known);
            if let Some(value) = change.value {
                commands.push(changed(index, cable, |c| (property.set)(c, value)));
            }
            if change.done {
                commands.push(Command::Scene(SceneCommand::EditDone));
            }
            scene_errors::inline(ui, state, &format!("cables[{index}].{}", property.key), commands);
        }
        segments(ui, state, index, loaded, commands);
        self_contact(ui, index, cable, commands);
    });
}

fn changed(index: usize, cable: &Cable, change: impl FnOnce(&mut Cable)) -> Command {
    let mut value = cable.clone();
    change(&mut value);
    Command::Scene(SceneCommand::SetCable { cable: index, value: Box::new(value) })
}

/// Chooses the cable where there are several, and edits its name.
fn picker(ui: &mut Ui, state: &AppState, index: usize, commands: &mut Vec<Command>) {
    let Some(cable) = state.document.scene.cables.get(index) else { return };
    if state.document.scene.cables.len() > 1 {
        labelled(ui, "Cable", "Cable", |ui| {
            let combo = ComboBox::from_id_salt("cable").selected_text(&cable.name).width(ui.available_width() - 14.0);
            let shown = combo.show_ui(ui, |ui| {
                for (k, other) in state.document.scene.cables.iter().enumerate() {
                    if ui.selectable_label(k == index, &other.name).clicked() {
                        commands.push(Command::View(ViewCommand::Select(Some(Item::Cable(k)))));
                    }
                }
            });
            shown.response.on_hover_text("The cable whose properties are shown")
        });
    }
    let mut wrong = None;
    labelled(ui, "Name", "Cable name", |ui| {
        let entry = field::text(ui, "Cable name", &cable.name, ui.available_width() - 8.0);
        if let Some(name) = entry.value {
            commands.push(renamed(state, index, name));
        }
        wrong = entry.fault;
        entry.response.on_hover_text("Unique; loads find their cable by it")
    });
    if let Some(wrong) = wrong {
        field::fault(ui, &wrong);
    }
    scene_errors::inline(ui, state, &format!("cables[{index}].name"), commands);
}

/// The scene with a cable and everything that names it renamed.
fn renamed(state: &AppState, index: usize, name: String) -> Command {
    let mut scene = state.document.scene.clone();
    if let Some(cable) = scene.cables.get_mut(index) {
        let old = std::mem::replace(&mut cable.name, name.clone());
        for load in scene.loads.iter_mut().filter(|l| l.cable == old) {
            load.cable.clone_from(&name);
        }
    }
    Command::Scene(SceneCommand::SetScene(Box::new(scene)))
}

/// The choice of a preset.
fn presets(ui: &mut Ui, index: usize, cable: &Cable, commands: &mut Vec<Command>) {
    let present = cable.preset.as_deref().and_then(preset::cable_preset);
    labelled(ui, "Preset", "Cable preset", |ui| {
        let text = present.map_or("None", |p| p.name.as_str());
        let combo = ComboBox::from_id_salt("preset").selected_text(text).width(ui.available_width() - 14.0).truncate();
        let shown = combo.height(POPUP_HEIGHT).show_ui(ui, |ui| {
            for p in preset::cable_presets() {
                let entry = ui.selectable_label(present.is_some_and(|q| q.id == p.id), &p.name);
                if entry.on_hover_text(&p.note).clicked() {
                    commands.push(changed(index, cable, |c| *c = provenance::with_preset(cable, p)));
                    commands.push(Command::Scene(SceneCommand::EditDone));
                }
            }
        });
        shown.response.on_hover_text(
            present.map_or("Fills in the properties of a known kind of cable; length and supports stay", |p| {
                p.note.as_str()
            }),
        )
    });
}

/// The choice of a fixed number of segments.
fn segments(ui: &mut Ui, state: &AppState, index: usize, loaded: Option<&Cable>, commands: &mut Vec<Command>) {
    let Some(cable) = state.document.scene.cables.get(index) else { return };
    let mut own = cable.segments.is_some();
    let help = "Off: the model chooses by the accuracy asked for";
    if checkbox(ui, &mut own, "Fixed number of segments").on_hover_text(help).changed() {
        let chosen = own.then(|| solved_segments(state, index).unwrap_or(100));
        commands.push(changed(index, cable, |c| c.segments = chosen));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
    let Some(count) = cable.segments else { return };
    let origin = loaded.and_then(|c| c.segments).map(|n| (n as f64, "as loaded".to_owned()));
    let known = Provenance { value: count as f64, origin, source: None, estimated: false };
    let change = row(ui, &SEGMENTS, &known);
    if let Some(value) = change.value {
        // Saturates; zero and too many are refused by the scene's own check, which is shown below.
        commands.push(changed(index, cable, |c| c.segments = Some(value.round() as usize)));
    }
    if change.done {
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
    scene_errors::inline(ui, state, &format!("cables[{index}].segments"), commands);
}

fn solved_segments(state: &AppState, index: usize) -> Option<usize> {
    let answer = state.live.snapshot.solution.as_ref()?.cables.get(index)?;
    answer.nodes.len().checked_sub(1).filter(|&n| n > 0)
}

/// The choice of self-contact.
fn self_contact(ui: &mut Ui, index: usize, cable: &Cable, commands: &mut Vec<Command>) {
    let mut on = cable.self_contact;
    let help = "The cable is an obstacle to itself (FEM only, without pulleys). Off: it passes in front of itself";
    if checkbox(ui, &mut on, "Self-contact").on_hover_text(help).changed() {
        commands.push(changed(index, cable, |c| c.self_contact = on));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
}

/// Adds and takes out cables.
fn count(ui: &mut Ui, state: &AppState, index: usize, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let help = "Another cable with the same properties, half a metre above this one";
        if ui.button("Add cable").on_hover_text(help).clicked() {
            commands.push(Command::Scene(SceneCommand::AddCable));
        }
        let several = state.document.scene.cables.len() > 1;
        let remove = ui.add_enabled(several, egui::Button::new("Remove cable"));
        let remove =
            remove.on_hover_text("Removes this cable and its loads").on_disabled_hover_text("The last one stays");
        if remove.clicked() {
            commands.push(Command::Scene(SceneCommand::Remove(Item::Cable(index))));
        }
    });
}
