//! Answers that are held, and the one that the run began with, are drawn as thin lines behind the
//! present one.

use cable_core::Solution;
use egui::{Pos2, Stroke};

use crate::canvas::canvas_view::CanvasView;
use crate::render::colour::LINES;
use crate::state::AppState;

/// Draws them, in the colours of the compare panel; the shape at the start in none.
pub fn draw(view: &CanvasView<'_>, state: &AppState) {
    if state.view.layers.start_shape
        && let Some(start) = state.live.recording.answers().first()
    {
        dashed(view, start, Stroke::new(1.8, view.palette.weak_text));
    }
    for (k, reference) in state.analysis.references.iter().enumerate() {
        let time_s = state.live.snapshot.solution.as_ref().map_or(0.0, |s| s.time_s);
        dashed(view, reference.picture(time_s), Stroke::new(1.8, LINES[k % LINES.len()]));
    }
}

fn dashed(view: &CanvasView<'_>, answer: &Solution, stroke: Stroke) {
    for piece in answer.cables.iter().flat_map(|c| c.pieces()) {
        let points: Vec<Pos2> = piece.iter().map(|n| view.at([n.x_m, n.y_m])).collect();
        view.painter.extend(egui::Shape::dashed_line(&points, stroke, 8.0, 4.0));
    }
}
