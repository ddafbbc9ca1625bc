//! The colour legend, beside the canvas or in a strip above it: never over what can be taken.

use std::ops::RangeInclusive;

use cable_core::solution::ContactState;
use egui::{Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::canvas::layers::{cable, contact};
use crate::render::colour::{CableQuantity, ColourScale};
use crate::render::theme::{self, Palette};
use crate::state::AppState;
use crate::units::labels;

/// Height of the legend beside the canvas, points.
pub const STRIP_HEIGHT: f32 = 42.0;

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
    let has_bands = current && state.view.layers.contacts && stretches.into_iter().any(|c| c.ends_m > c.begins_m);
    let right = if has_bands { contact_samples(painter, palette, rect) } else { rect.right() };
    if let Some(times) = cable::thickening(state) {
        name_thickening(painter, palette, &times, title.right_top()..=pos2(right, title.top()));
        response.on_hover_text(format!("The cable is drawn {times} times as thick as it is, so that it can be seen"));
    }
    let bar = Rect::from_min_size(rect.min + vec2(0.0, 15.0), vec2(rect.width(), 9.0));
    painter.add(colour_bar(bar, |f| if current { state.view.colour.map.at(f) } else { palette.plate_line }));
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

/// Samples of the bands where the cable holds and slides, at the right end of the strip. Returns
/// where they begin.
fn contact_samples(painter: &Painter, palette: &Palette, strip: Rect) -> f32 {
    let mut x = strip.right();
    for (state, text) in [(ContactState::Slip, "slides"), (ContactState::Stick, "holds")] {
        let small = FontId::proportional(10.0);
        let words = painter.text(pos2(x, strip.top() + 1.0), Align2::RIGHT_TOP, text, small, palette.text);
        let sample = Rect::from_center_size(pos2(words.left() - 12.0, words.center().y), vec2(16.0, 7.0));
        contact::sample(painter, palette, sample, state);
        x = sample.left() - 6.0;
    }
    x
}

/// Says how many times too thick the cable is drawn, in as many words as have room.
fn name_thickening(painter: &Painter, palette: &Palette, times: &str, room: RangeInclusive<Pos2>) {
    let width = room.end().x - room.start().x - 10.0;
    let small = FontId::proportional(10.0);
    let words = [format!("drawn {times}× as thick"), format!("drawn {times}×"), format!("{times}×")];
    let words = words.map(|w| painter.layout_no_wrap(w, small.clone(), palette.weak_text));
    if let Some(words) = words.into_iter().find(|w| w.size().x <= width) {
        painter.galley(*room.start() + vec2(5.0, 1.0), words, palette.weak_text);
    }
}

/// A bar with the colour of each fraction of its width.
fn colour_bar(bar: Rect, colour: impl Fn(f64) -> Color32) -> Mesh {
    const STRIPS: u32 = 48;
    let mut mesh = Mesh::default();
    for k in 0..=STRIPS {
        let f = f64::from(k) / f64::from(STRIPS);
        let x = bar.min.x + bar.width() * f as f32;
        mesh.colored_vertex(pos2(x, bar.min.y), colour(f));
        mesh.colored_vertex(pos2(x, bar.max.y), colour(f));
        if k > 0 {
            let b = 2 * k;
            mesh.add_triangle(b - 2, b - 1, b);
            mesh.add_triangle(b - 1, b + 1, b);
        }
    }
    mesh
}
