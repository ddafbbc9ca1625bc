//! A marker on the cable shows the place whose tension is broken down.

use egui::{Color32, Stroke, vec2};

use crate::canvas::canvas_view::{CanvasView, FigureLabel};
use crate::canvas::layers::contact;
use crate::state::AppState;
use crate::units::labels;

/// Half the diagonal of the mark, points.
const HALF_DIAGONAL_POINTS: f32 = 8.0;

/// Draws it; its figure goes to `figures` for the labels to place.
pub fn draw(view: &CanvasView<'_>, state: &AppState, figures: &mut Vec<FigureLabel>) {
    let Some(probe) = &state.analysis.tension_marker else { return };
    let cable = state.live.snapshot.solution.as_ref().and_then(|s| s.cables.get(probe.cable));
    let Some(n) = cable.and_then(|c| contact::at(c, probe.arc_length_m)) else { return };
    let at = view.at([n.x_m, n.y_m]);
    let corners = [
        vec2(0.0, -HALF_DIAGONAL_POINTS),
        vec2(HALF_DIAGONAL_POINTS, 0.0),
        vec2(0.0, HALF_DIAGONAL_POINTS),
        vec2(-HALF_DIAGONAL_POINTS, 0.0),
    ]
    .map(|d| at + d);
    let line = Stroke::new(2.0, view.palette.accent);
    view.painter.add(egui::Shape::convex_polygon(corners.to_vec(), Color32::TRANSPARENT, line));
    figures.push(FigureLabel { at, text: labels::force(n.tension_n), colour: view.palette.accent });
}
