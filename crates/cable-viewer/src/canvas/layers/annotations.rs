//! Annotations of the picture name supports and the robot, and give the largest tension and the
//! figures of arrows.

use egui::{Stroke, vec2};

use crate::canvas::canvas_view::{CanvasView, FigureLabel, LabelPriority};
use crate::canvas::layers::{breaks, robot};
use crate::geometry::supports::support_position;
use crate::state::AppState;
use crate::units::labels;

/// Names and coordinates of supports, the largest tension, then the figures of the arrows while
/// there is room.
pub fn draw(view: &mut CanvasView<'_>, state: &AppState, figures: Vec<FigureLabel>) {
    let text_colour = view.palette.text;
    let mut spots = Vec::new();
    for (cable, c) in state.document.scene.cables.iter().enumerate() {
        for (support, s) in c.supports.iter().enumerate() {
            if let Some(at) = support_position(state, cable, support) {
                let p = view.at(at);
                view.occupied.push(egui::Rect::from_min_max(p + vec2(-10.0, -8.0), p + vec2(10.0, 13.0)));
                let [x, y] = at.map(|v| labels::coordinate(v, 0.01));
                spots.push((p, format!("{}  ({x}, {y}) {}", s.name, labels::of_length().0)));
            }
        }
    }
    if let Some((at, name)) = robot::title(state) {
        spots.push((view.at(at), name));
    }
    for (p, text) in &spots {
        view.label(*p, text, text_colour, LabelPriority::Required);
    }
    if let Some(solution) = state.live.snapshot.solution.as_ref().filter(|_| state.is_current()) {
        let most = solution.max_tension();
        let cable = solution.cables.get(most.cable);
        if let Some(n) = cable.and_then(|c| c.nodes.iter().find(|n| n.arc_length_m >= most.arc_length_m)) {
            let p = view.at([n.x_m, n.y_m]);
            // At a support its own sign marks the place.
            if spots.iter().all(|(s, _)| s.distance(p) > 14.0) {
                view.painter.circle_stroke(p, 9.0, Stroke::new(1.5, text_colour));
            }
            view.label(p, &format!("max {}", labels::force(most.tension_n)), text_colour, LabelPriority::Required);
        }
    }
    if state.is_current() {
        breaks::names(view, state);
    }
    for FigureLabel { at, text, colour } in figures {
        view.label(at, &text, colour, LabelPriority::Optional);
    }
}
