//! The colour legend, in the upper right corner.

use egui::{Align2, FontId, Mesh, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use crate::canvas::layers::{cable, contact};
use crate::canvas::view::CanvasView;
use crate::render::colour::{CableQuantity, ColourScale};
use crate::render::theme;
use crate::state::AppState;
use crate::units::labels;

/// Height of the legend beside the canvas, points.
const STRIP_HEIGHT: f32 = 42.0;
/// Size of the coloured bar, points.
const BAR: [f32; 2] = [14.0, 132.0];
/// Numbers beside the bar.
const BAR_LABEL_COUNT: usize = 5;

/// The colours and what they mean.
pub fn draw(view: &mut CanvasView<'_>, state: &AppState) {
    // Of what has no colours there is nothing to say.
    let Some(solution) = state.live.snapshot.solution.as_ref().filter(|_| state.is_current()) else { return };
    let [low, high] = state.view.colour.range(solution);
    let (unit, si) = state.view.colour.quantity.unit(high.abs().max(low.abs()));
    let plate = Rect::from_min_size(pos2(view.rect.max.x - 118.0, view.rect.min.y + 10.0), vec2(108.0, BAR[1] + 44.0));
    if plate.min.x < view.rect.min.x + 60.0 || plate.max.y > view.rect.max.y - 30.0 {
        return;
    }
    let line = Stroke::new(1.0, view.palette.plate_line);
    view.painter.rect(plate, 4.0, view.palette.plate, line, StrokeKind::Inside);
    let title = format!("{} ({unit})", state.view.colour.quantity.name());
    view.text(plate.min + vec2(9.0, 7.0), Align2::LEFT_TOP, &title, 12.0, view.palette.text);
    let bar = Rect::from_min_size(plate.min + vec2(10.0, 32.0), vec2(BAR[0], BAR[1]));
    let mut mesh = Mesh::default();
    const STRIPS: u32 = 48;
    for k in 0..=STRIPS {
        let f = f64::from(k) / f64::from(STRIPS);
        let y = bar.max.y - bar.height() * f as f32;
        let colour = state.view.colour.map.at(f);
        mesh.colored_vertex(pos2(bar.min.x, y), colour);
        mesh.colored_vertex(pos2(bar.max.x, y), colour);
        if k > 0 {
            let b = 2 * k;
            mesh.add_triangle(b - 2, b - 1, b);
            mesh.add_triangle(b - 1, b + 1, b);
        }
    }
    view.painter.add(mesh);
    view.painter.rect_stroke(bar, 0.0, line, StrokeKind::Outside);
    // A quarter of a step: 2.5 must not be read as 3.
    let decimals = labels::decimals_of((high - low) / si / (4 * (BAR_LABEL_COUNT - 1)) as f64).min(4);
    for k in 0..BAR_LABEL_COUNT {
        let f = k as f64 / (BAR_LABEL_COUNT - 1) as f64;
        let y = bar.max.y - bar.height() * f as f32;
        view.painter.hline(bar.max.x..=bar.max.x + 4.0, y, Stroke::new(1.0, view.palette.weak_text));
        let text = format!("{:.decimals$}", (low + f * (high - low)) / si);
        view.text(pos2(bar.max.x + 8.0, y), Align2::LEFT_CENTER, &text, 11.0, view.palette.text);
    }
    if state.view.colour.quantity == CableQuantity::Tension {
        service(view, state, bar, [low, high]);
    }
    view.occupied.push(plate);
}

/// The colours and what they mean, as a strip beside the canvas.
pub fn beside(ui: &mut Ui, state: &AppState) {
    let Some(solution) = state.live.snapshot.solution.as_ref() else { return };
    let current = state.is_current();
    let [low, high] = state.view.colour.range(solution);
    let quantity = state.view.colour.quantity;
    let (unit, si) = quantity.unit(high.abs().max(low.abs()));
    let palette = theme::palette(ui.visuals());
    let ink = if current { palette.text } else { palette.weak_text.gamma_multiply(0.5) };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), STRIP_HEIGHT), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, "Colours of the cable"));
    let painter = ui.painter();
    let font = FontId::proportional(11.0);
    let title = format!("{} ({unit})", quantity.name());
    let title = painter.text(rect.left_top(), Align2::LEFT_TOP, title, font.clone(), ink);
    let solved = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let service = solved.cables.first().filter(|_| current && quantity == CableQuantity::Tension);
    let stretches = solution.cables.iter().flat_map(|c| &c.contacts);
    let mut x = rect.right();
    if current && state.view.layers.contacts && stretches.into_iter().any(|c| c.ends_m > c.begins_m) {
        for (holds, text) in [(false, "slides"), (true, "holds")] {
            let small = FontId::proportional(10.0);
            let words = painter.text(pos2(x, rect.top() + 1.0), Align2::RIGHT_TOP, text, small, palette.text);
            let sample = Rect::from_center_size(pos2(words.left() - 12.0, words.center().y), vec2(16.0, 7.0));
            contact::sample(painter, palette, sample, holds);
            x = sample.left() - 6.0;
        }
    }
    if let Some(times) = cable::thickening(state) {
        let room = x - title.right() - 10.0;
        let small = FontId::proportional(10.0);
        let words = [format!("drawn {times}× as thick"), format!("drawn {times}×"), format!("{times}×")];
        let words = words.map(|w| painter.layout_no_wrap(w, small.clone(), palette.weak_text));
        let shown = words.into_iter().find(|w| w.size().x <= room);
        if let Some(words) = shown {
            painter.galley(title.right_top() + vec2(5.0, 1.0), words, palette.weak_text);
        }
        response.on_hover_text(format!("The cable is drawn {times} times as thick as it is, so that it can be seen"));
    }
    let bar = Rect::from_min_size(rect.min + vec2(0.0, 15.0), vec2(rect.width(), 9.0));
    let mut mesh = Mesh::default();
    const STRIPS: u32 = 48;
    for k in 0..=STRIPS {
        let f = f64::from(k) / f64::from(STRIPS);
        let x = bar.min.x + bar.width() * f as f32;
        let colour = if current { state.view.colour.map.at(f) } else { palette.plate_line };
        mesh.colored_vertex(pos2(x, bar.min.y), colour);
        mesh.colored_vertex(pos2(x, bar.max.y), colour);
        if k > 0 {
            let b = 2 * k;
            mesh.add_triangle(b - 2, b - 1, b);
            mesh.add_triangle(b - 1, b + 1, b);
        }
    }
    painter.add(mesh);
    if let Some(cable) = service {
        let f = ColourScale::fraction(cable.service_tension_n, [low, high]);
        if (0.0..=1.0).contains(&f) {
            let x = bar.min.x + bar.width() * f as f32;
            painter.vline(x, bar.min.y - 3.0..=bar.max.y + 3.0, Stroke::new(2.0, palette.risk));
        }
    }
    let decimals = labels::decimals_of((high - low) / si / 8.0).min(4);
    for (k, align) in [Align2::LEFT_TOP, Align2::CENTER_TOP, Align2::RIGHT_TOP].into_iter().enumerate() {
        let f = 0.5 * k as f64;
        let text = format!("{:.decimals$}", (low + f * (high - low)) / si);
        let at = pos2(bar.min.x + bar.width() * f as f32, bar.max.y + 2.0);
        painter.text(at, align, text, font.clone(), ink);
    }
}

/// What the bands along the cable mean, below the colours, where there are some.
pub fn contacts(view: &mut CanvasView<'_>, state: &AppState) {
    let stretches = state.live.snapshot.solution.iter().flat_map(|s| &s.cables).flat_map(|c| &c.contacts);
    let any = state.is_current() && stretches.into_iter().any(|c| c.ends_m > c.begins_m);
    let top = view.rect.min.y + 10.0 + BAR[1] + 44.0 + 6.0;
    let plate = Rect::from_min_size(pos2(view.rect.max.x - 118.0, top), vec2(108.0, 42.0));
    if !any
        || !state.view.layers.contacts
        || plate.min.x < view.rect.min.x + 60.0
        || plate.max.y > view.rect.max.y - 30.0
    {
        return;
    }
    let line = Stroke::new(1.0, view.palette.plate_line);
    view.painter.rect(plate, 4.0, view.palette.plate, line, StrokeKind::Inside);
    for (k, text) in ["holds", "slides"].into_iter().enumerate() {
        let y = plate.min.y + 12.0 + 18.0 * k as f32;
        let bar = Rect::from_center_size(pos2(plate.min.x + 24.0, y), vec2(28.0, 9.0));
        contact::sample(view.painter, view.palette, bar, k == 0);
        view.text(pos2(bar.max.x + 9.0, y), Align2::LEFT_CENTER, text, 11.0, view.palette.text);
    }
    view.occupied.push(plate);
}

/// A red mark where the first cable's service tension lies.
fn service(view: &CanvasView<'_>, state: &AppState, bar: Rect, range: [f64; 2]) {
    let Some(cable) = state.document.scene.cables.first() else { return };
    let f = ColourScale::fraction(cable.service_tension_n, range);
    if (0.0..=1.0).contains(&f) {
        let y = bar.max.y - bar.height() * f as f32;
        view.painter.hline(bar.min.x - 5.0..=bar.max.x + 5.0, y, Stroke::new(2.0, view.palette.risk));
    }
}
