//! The map picker puts the obstacles of a known tank into the scene.

use cable_core::Scene;
use cable_core::scene::preset::{self, MapPreset};
use egui::{ComboBox, Ui};

use crate::command::{Command, SceneCommand, ViewCommand};
use crate::geometry::handles;
use crate::state::{AppState, Item};
use crate::units::format;
use crate::widgets::property::labelled;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let present = preset::map_presets().iter().find(|m| m.obstacles == state.document.scene.obstacles);
    labelled(ui, "Map", "Map", |ui| {
        let text = match present {
            Some(map) => map.name.as_str(),
            None if state.document.scene.obstacles.is_empty() => "None",
            None => "Custom",
        };
        let combo = ComboBox::from_id_salt("map").selected_text(text).width(ui.available_width() - 14.0).truncate();
        let shown = combo.show_ui(ui, |ui| {
            if ui.selectable_label(state.document.scene.obstacles.is_empty(), "None").clicked() {
                choose(&state.document.scene, &[], commands);
            }
            for map in preset::map_presets() {
                let entry = ui.selectable_label(present.is_some_and(|m| m.id == map.id), &map.name);
                if entry.on_hover_text(about(map)).clicked() {
                    choose(&state.document.scene, &map.obstacles, commands);
                }
            }
        });
        shown.response.on_hover_text("Replaces all obstacles by those of a tank; cables stay where they are")
    });
    if let Some(map) = present {
        opening(ui, state, map, commands);
    }
}

/// The move of the cable's start to the opening of the tank, where it does not begin there.
#[must_use]
pub fn to_opening(state: &AppState) -> Option<SceneCommand> {
    let map = preset::map_presets().iter().find(|m| m.obstacles == state.document.scene.obstacles)?;
    let item = Item::Support { cable: state.current_cable(), support: 0 };
    handles::of(state, item).filter(|at| *at != map.riser_at_m)?;
    Some(SceneCommand::Move { item, to_m: map.riser_at_m })
}

/// Offers to begin the cable at the opening of the tank, where it does not.
fn opening(ui: &mut Ui, state: &AppState, map: &MapPreset, commands: &mut Vec<Command>) {
    let item = Item::Support { cable: state.current_cable(), support: 0 };
    let (Some(at), Some(to_opening)) = (handles::of(state, item), to_opening(state)) else { return };
    let help = format!(
        "Moves the start of the cable from {} to the opening of the tank at {}",
        format::position(at),
        format::position(map.riser_at_m)
    );
    if ui.button("Route the cable through the tank opening").on_hover_text(help).clicked() {
        commands.push(Command::Scene(SceneCommand::EditDone));
        commands.push(Command::Scene(to_opening));
        commands.push(Command::Scene(SceneCommand::EditDone));
    }
}

/// The text about a map on hover.
fn about(map: &MapPreset) -> String {
    format!(
        "{}\nInside width {}, waste up to {} deep, opening at {}",
        map.note,
        format::length(map.inside_width_m.value),
        format::length(map.waste_depth_m.value),
        format::position(map.riser_at_m)
    )
}

fn choose(scene: &Scene, obstacles: &[cable_core::Obstacle], commands: &mut Vec<Command>) {
    let mut scene = scene.clone();
    scene.obstacles = obstacles.to_vec();
    commands.push(Command::Scene(SceneCommand::SetScene(Box::new(scene))));
    commands.push(Command::View(ViewCommand::Fit));
}
