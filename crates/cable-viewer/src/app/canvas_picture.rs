//! The canvas is drawn to a picture file as it is in view, under a caption with what stands beside
//! it in the window: the legend, and the greatest tension with its limit and its verification.

use std::path::Path;

use cable_core::files;
use egui::{CentralPanel, Frame, Label, Margin, Panel, RichText, Theme, Ui, UiBuilder};

use crate::app::headline;
use crate::canvas;
use crate::canvas::layers::{legend, safe_reach};
use crate::io::picture_file;
use crate::render::offscreen::Offscreen;
use crate::render::theme;
use crate::state::{AppState, Freshness};
use crate::units::{format, labels};

/// Pixels of a picture in a point: sharp on paper and on dense screens.
const PIXELS_PER_POINT: f32 = 2.0;
/// Widest legend, points.
const LEGEND_WIDTH: f32 = 260.0;
/// Narrower pictures have the legend below the words of the caption, points.
const LEAST_SIDE_BY_SIDE_WIDTH: f32 = 560.0;
/// Space between the words and the legend beside them, points.
const GAP: f32 = 12.0;
/// Height of the words of the caption and of each part of the legend, points.
const ROWS: [f32; 3] = [62.0, 47.0, 61.0];
/// Least and greatest side of the canvas in a picture, points.
const SIDES: [f64; 2] = [64.0, 4096.0];
/// The font knows its letters from the second frame on.
const FRAMES: usize = 2;

/// Draws the canvas to a PNG or SVG file.
///
/// # Errors
/// In words: the path is of another kind, or refuses.
pub fn save(state: &mut AppState, theme: Theme, path: &Path) -> Result<(), String> {
    // A picture is of the scene: what is picked and where the pointer is are of the hand.
    let (view, selection) = (state.view.clone(), state.selection.clone());
    (state.selection.selected, state.selection.hovered) = (None, None);
    state.selection.also_selected.clear();
    (state.view.camera.fitted_to, state.view.camera.follows) = (None, false);
    let frame = draw(state, theme);
    (state.view, state.selection) = (view, selection);
    let ground = frame.ctx().global_style().visuals.panel_fill;
    match path.extension() {
        Some(e) if e.eq_ignore_ascii_case("svg") => {
            files::write_atomic(path, frame.svg(ground).as_bytes()).map_err(|e| e.to_string())
        }
        Some(e) if e.eq_ignore_ascii_case("png") => picture_file::save(path, &frame.picture(ground)),
        _ => Err("its name must end in .png or .svg".to_owned()),
    }
}

/// Draws the canvas as it is in view, with its caption above, off screen.
fn draw(state: &mut AppState, theme: Theme) -> Offscreen {
    let [low, high] = state.view.visible_m;
    let side = |k: usize| (high[k] - low[k]).abs() * state.view.camera.points_per_m;
    let [width, height] = [0, 1].map(|k| side(k).clamp(SIDES[0], SIDES[1]).round() as f32);
    let maps = if state.analysis.safe_reach.found().is_some() { ROWS[2] } else { 0.0 };
    let legend = ROWS[1] + maps;
    let caption = if width < LEAST_SIDE_BY_SIDE_WIDTH { ROWS[0] + legend } else { ROWS[0].max(legend) };
    let mut offscreen = Offscreen::new([width as u32, (height + caption) as u32], PIXELS_PER_POINT);
    theme::install(offscreen.ctx());
    offscreen.ctx().set_theme(theme);
    for _ in 0..FRAMES {
        offscreen.frame(|ui| {
            let margin = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(8, 3));
            let panel = Panel::top("caption").frame(margin).resizable(false).exact_size(caption);
            panel.show(ui, |ui| write_caption(ui, state));
            CentralPanel::no_frame().frame(Frame::NONE).show(ui, |ui| canvas::ui(ui, state, &mut Vec::new()));
        });
    }
    offscreen
}

/// Words on the left, the legend on the right, or below where there is no room.
fn write_caption(ui: &mut Ui, state: &AppState) {
    let area = ui.max_rect();
    let (words, legend) = if ui.ctx().content_rect().width() < LEAST_SIDE_BY_SIDE_WIDTH {
        area.split_top_bottom_at_y(area.top() + ROWS[0])
    } else {
        let (left, right) = area.split_left_right_at_x(area.right() - LEGEND_WIDTH);
        (left.with_max_x(left.right() - GAP), right)
    };
    ui.scope_builder(UiBuilder::new().max_rect(words), |ui| write_name_and_summary(ui, state));
    ui.scope_builder(UiBuilder::new().max_rect(legend), |ui| {
        legend::beside(ui, state);
        safe_reach::legend_beside(ui, state);
    });
}

/// Writes the name of the scene and the summary of its answer, one line each.
fn write_name_and_summary(ui: &mut Ui, state: &AppState) {
    let scene = &state.document.scene;
    let name = if scene.name.is_empty() { "Untitled scene" } else { &scene.name };
    ui.add(Label::new(RichText::new(name).strong()).truncate());
    for line in summary(state) {
        ui.add(Label::new(line).truncate());
    }
}

/// The model with the instant and the greatest tension, or why there is no result of this scene.
fn summary(state: &AppState) -> Vec<String> {
    let Some(answer) = state.live.snapshot.solution.as_deref() else { return vec!["Not solved".to_owned()] };
    match state.freshness() {
        Freshness::Outdated => return vec!["The result is not of this scene".to_owned()],
        Freshness::Solving | Freshness::Draft => return vec!["Still being solved".to_owned()],
        Freshness::Current => {}
    }
    let (model, time) = (labels::model(answer.model), format::duration(answer.time_s));
    let verdict = answer.verification.as_ref().map_or_else(String::new, |v| format!(" · {}", headline::verdict(v)));
    let most = answer.max_tension();
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let share = scene.cables.get(most.cable).map_or_else(String::new, |c| {
        let share = format::percent(most.tension_n / c.service_tension_n);
        format!(", {share} of service {}", format::force(c.service_tension_n))
    });
    vec![format!("{model} model at {time}{verdict}"), format!("Max {}{share}", format::force(most.tension_n))]
}
