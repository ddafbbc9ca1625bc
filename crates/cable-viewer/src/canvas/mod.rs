//! The picture of the scene, in layers, and the pointer on it.

pub mod bounds;

use egui::{Sense, Ui};

use crate::command::Command;
use crate::state::AppState;

/// Draws the scene into the rest of the window and reads the pointer.
pub fn ui(ui: &mut Ui, state: &mut AppState, commands: &mut Vec<Command>) {
    let _ = commands;
    let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::click_and_drag());
    if state.camera.fit_wanted {
        let bounds = bounds::scene(state);
        state.camera.fit(response.rect, bounds);
    }
    if let Some(solution) = &state.snapshot.solution {
        for cable in &solution.cables {
            let points = cable.nodes.iter().map(|n| state.camera.to_screen(response.rect, [n.x_m, n.y_m])).collect();
            painter.line(points, egui::Stroke::new(2.0, ui.visuals().text_color()));
        }
    }
}
