//! Scene panel: the scene's name, its supports, obstacles and loads, with exact coordinates.

use crate::command::Command;
use crate::state::AppState;

/// Draws it.
pub fn ui(ui: &mut egui::Ui, state: &AppState, commands: &mut Vec<Command>) {
    let _ = (state, commands);
    ui.weak("Nothing here yet");
}
