//! The torn ends of a cable that broke are marked, with the tension that it broke at.

use cable_core::solution::{CableSolution, Node};
use egui::{Pos2, Stroke, vec2};

use crate::canvas::canvas_view::{CanvasView, LabelPriority};
use crate::state::AppState;
use crate::units::labels;

/// Half of the size of a mark, points.
const HALF_SIZE: f32 = 6.0;

/// Draws a cross at each torn end.
pub fn draw(view: &mut CanvasView<'_>, state: &AppState) {
    for end in torn_ends(state).iter().flatten() {
        let p = view.at([end.x_m, end.y_m]);
        for (width, colour) in [(4.5, view.palette.background), (2.2, view.palette.risk)] {
            for side in [1.0, -1.0] {
                let arm = vec2(HALF_SIZE, side * HALF_SIZE);
                view.painter.line_segment([p - arm, p + arm], Stroke::new(width, colour));
            }
        }
    }
}

/// Says at the first torn end of each cable what it broke at.
pub fn names(view: &mut CanvasView<'_>, state: &AppState) {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let broken = scene.cables.iter().zip(torn_ends(state));
    let labels: Vec<(Pos2, String)> = broken
        .filter_map(|(cable, ends)| {
            let end = ends.first()?;
            Some((view.at([end.x_m, end.y_m]), format!("broke at {}", labels::force(cable.breaking_tension_n))))
        })
        .collect();
    for (p, text) in labels {
        view.label(p, &text, view.palette.risk, LabelPriority::Required);
    }
}

/// The torn ends of each cable.
fn torn_ends(state: &AppState) -> Vec<Vec<Node>> {
    let answer = state.live.snapshot.solution.as_deref();
    answer.map_or_else(Vec::new, |s| s.cables.iter().map(of_cable).collect())
}

fn of_cable(cable: &CableSolution) -> Vec<Node> {
    // The last node of one piece and the first of the next; at an end of the cable there is one.
    let beside = |k: &usize| [k.checked_sub(1), Some(*k)].into_iter().flatten();
    cable.breaks.iter().flat_map(beside).filter_map(|k| cable.nodes.get(k)).copied().collect()
}
