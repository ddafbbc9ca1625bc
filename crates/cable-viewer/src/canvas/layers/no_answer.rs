//! A banner on the canvas says why there is no new answer.

use egui::{FontId, Rect, Stroke, StrokeKind, vec2};

use crate::canvas::canvas_view::CanvasView;
use crate::panels::{display_names, scene_errors};
use crate::state::{AppState, WorkerStatus};
use crate::units::sentence::sentence;

/// Draws the reason why the picture is not of the scene as it is now, and keeps labels off it.
pub fn banner(view: &mut CanvasView<'_>, state: &AppState) {
    let (title, text) = match (&state.solver.status, &state.live.snapshot.error) {
        (WorkerStatus::Dead(why), _) => ("The solver has stopped", why.clone()),
        (_, Some(why)) => {
            let reason = scene_errors::summary(state).unwrap_or_else(|| display_names::capital(&sentence(why)));
            ("No answer for this scene", reason)
        }
        _ => return,
    };
    let last_result =
        if state.live.snapshot.solution.is_some() { "The last valid result is shown in grey." } else { "" };
    let body = if last_result.is_empty() { text } else { format!("{text}\n{last_result}") };
    let width = (view.rect.width() - 200.0).clamp(140.0, 440.0);
    let at = view.rect.min + vec2(crate::canvas::layers::grid::STRIP[0] + 12.0, 12.0);
    let heading = view.painter.layout(title.to_owned(), FontId::proportional(14.0), view.palette.risk, width);
    let body = view.painter.layout(body, FontId::proportional(12.5), view.palette.text, width);
    let size = vec2(heading.size().x.max(body.size().x) + 26.0, heading.size().y + body.size().y + 22.0);
    let plate = Rect::from_min_size(at, size);
    let line = Stroke::new(1.0, view.palette.risk);
    view.painter.rect(plate, 4.0, view.palette.plate, line, StrokeKind::Inside);
    let edge = Rect::from_min_size(plate.min, vec2(5.0, plate.height()));
    view.painter.rect_filled(edge, 2.0, view.palette.risk);
    let gap = heading.size().y + 4.0;
    view.painter.galley(at + vec2(15.0, 8.0), heading, view.palette.risk);
    view.painter.galley(at + vec2(15.0, 8.0 + gap), body, view.palette.text);
    view.occupied.push(plate);
}
