//! The robot's path is drawn as a flag on the ground where each leg ends.

use egui::{Stroke, vec2};

use crate::canvas::canvas_view::{CanvasView, FigureLabel};
use crate::geometry::robot::path_flags;
use crate::state::{AppState, Item};

/// Height and width of a flag, points.
const FLAG: [f32; 2] = [26.0, 15.0];

/// Draws them; what they say goes to `figures` for the labels to place.
pub fn draw(view: &CanvasView<'_>, state: &AppState, figures: &mut Vec<FigureLabel>) {
    for (k, at, text) in path_flags(state) {
        let item = Item::PathLeg(k);
        let marked = state.selection.contains(item) || state.selection.hovered == Some(item);
        let colour = if marked { view.palette.accent } else { view.palette.surface };
        let foot = view.at(at);
        let top = foot - vec2(0.0, FLAG[0]);
        view.painter.line_segment([foot, top], Stroke::new(if marked { 2.4 } else { 1.6 }, colour));
        let cloth = vec![top, top + vec2(FLAG[1], 5.5), top + vec2(0.0, 11.0)];
        view.painter.add(egui::Shape::convex_polygon(cloth, colour, Stroke::NONE));
        view.painter.circle_filled(foot, if marked { 4.5 } else { 3.0 }, colour);
        // The task of a leg is told of the one that is asked about: two such labels hid what they
        // stood at.
        let text = if marked { text } else { format!("leg {}", k + 1) };
        figures.push(FigureLabel { at: top, text, colour: view.palette.text });
    }
}
