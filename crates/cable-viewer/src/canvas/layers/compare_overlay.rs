//! Answers that are held are drawn as thin lines behind the present one.

use egui::{Pos2, Stroke};

use crate::canvas::view::CanvasView;
use crate::render::colour::LINES;
use crate::state::AppState;

/// Draws them, in the colours of the compare panel.
pub fn draw(view: &CanvasView<'_>, state: &AppState) {
    for (k, held) in state.analysis.references.iter().enumerate() {
        let stroke = Stroke::new(1.8, LINES[k % LINES.len()]);
        let time_s = state.live.snapshot.solution.as_ref().map_or(0.0, |s| s.time_s);
        for piece in held.picture(time_s).cables.iter().flat_map(|c| c.pieces()) {
            let points: Vec<Pos2> = piece.iter().map(|n| view.at([n.x_m, n.y_m])).collect();
            view.painter.extend(egui::Shape::dashed_line(&points, stroke, 8.0, 4.0));
        }
    }
}
