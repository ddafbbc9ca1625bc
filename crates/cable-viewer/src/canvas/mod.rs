//! The canvas draws the scene in layers and reads the pointer on it.
//!
//! - `layers`: what is drawn, a file a layer
//! - `canvas_view`: from metres to the painter
//! - `follow`: a view that goes with what leaves it
//! - `pointer`: clicks, drags and the wheel as commands
//! - `accessibility`: the same picture for screen readers

mod accessibility;
mod canvas_view;
pub mod follow;
pub mod layers;
mod pointer;

use egui::{Id, Rect, Role, Sense, Ui, WidgetInfo};

use crate::canvas::canvas_view::{CanvasView, hints_height};
use crate::canvas::layers::{
    annotations, breaks, cable, compare_overlay, contact, forces, grid, no_answer, obstacles, robot, robot_path,
    safe_reach, supports, tension_marker,
};
use crate::command::{Command, PlaybackCommand};
use crate::geometry::bounds;
use crate::render::theme;
use crate::state::AppState;
use crate::state::camera::BORDER;
use crate::units::labels;

/// Draws the scene into the rest of the window and reads the pointer.
pub fn ui(ui: &mut Ui, state: &mut AppState, commands: &mut Vec<Command>) {
    // Not focusable: single keys go to the window while the canvas is in use.
    let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::CLICK | Sense::DRAG);
    let rect = response.rect;
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Canvas"));
    // Written only for who listens.
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(accessibility::summary(state)));
    if !rect.is_positive() {
        return;
    }
    let answered = state.live.snapshot.solution.is_some() || state.live.snapshot.error.is_some();
    // A scene that was fitted stays so in a canvas of another size.
    let resized = state.view.camera.fitted_to.is_some_and(|size| size != <[f32; 2]>::from(rect.size()));
    let mut border = BORDER;
    border[3] += hints_height(state);
    follow::ui(state, rect, border);
    if (state.view.camera.fit_wanted || (resized && !state.view.camera.follows)) && answered {
        let fitted = bounds::scene(state);
        state.view.camera.fit(rect, fitted, border);
        if bounds::has_ground(state) {
            state.view.camera.hide_ground(rect, fitted[0][1], hints_height(state));
        }
        // The shape of the cable is not known yet: the view is fitted once more when it is.
        state.view.camera.fit_wanted = !state.is_answered();
    }
    state.view.visible_m = state.view.camera.visible_m(rect);
    pointer::read(ui, &response, state, commands);
    accessibility::ui(ui, rect, state);
    let mut view = CanvasView {
        rect,
        camera: state.view.camera,
        painter: &painter,
        palette: theme::palette(ui.visuals()),
        occupied: Vec::from_iter(take_clear_part(ui)),
        avoided: Vec::new(),
    };
    draw(&mut view, state);
    badge(ui, rect, state, commands);
}

/// Keeps labels out of a part of the canvas over which something is drawn, in the next frame.
pub fn keep_clear(ui: &Ui, part: Rect) {
    ui.data_mut(|d| d.insert_temp(Id::unique("kept clear"), Some(part)));
}

fn take_clear_part(ui: &Ui) -> Option<Rect> {
    ui.data_mut(|d| d.remove_temp::<Option<Rect>>(Id::unique("kept clear"))).flatten()
}

/// Time (s) after which a solve is said on the canvas, and after which it can be cancelled.
/// Shorter: they flicker in a drag.
const BADGE_AFTER_S: [f64; 2] = [0.25, 0.8];

/// Shows that an answer is being sought and for how long, with a button that ends the search.
fn badge(ui: &Ui, rect: Rect, state: &AppState, commands: &mut Vec<Command>) {
    let Some(seconds) = state.solving_for_s().filter(|s| *s > BADGE_AFTER_S[0]) else { return };
    let top = egui::pos2(rect.center().x, rect.min.y + 12.0);
    let area = egui::Area::new(Id::unique("solving")).fixed_pos(top).pivot(egui::Align2::CENTER_TOP);
    area.order(egui::Order::Middle).show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.add(egui::Spinner::new().size(14.0));
                ui.strong(labels::solving(seconds));
                let help = "Stops solving; the scene stays as it is, without an answer";
                if seconds > BADGE_AFTER_S[1] && ui.button("Cancel").on_hover_text(help).clicked() {
                    commands.push(Command::Playback(PlaybackCommand::CancelSolve));
                }
            });
        });
    });
}

/// All layers, back to front.
fn draw(view: &mut CanvasView<'_>, state: &AppState) {
    view.painter.rect_filled(view.rect, 0.0, view.palette.background);
    if state.view.layers.grid {
        grid::lines(view);
    }
    safe_reach::area(view, state);
    obstacles::draw(view, state);
    let mut figures = Vec::new();
    safe_reach::line(view, state, &mut figures);
    robot::draw(view, state);
    compare_overlay::draw(view, state);
    let current = state.is_current();
    if current {
        contact::draw(view, state);
    }
    cable::draw(view, state);
    forces::draw(view, state, &mut figures);
    supports::draw(view, state);
    breaks::draw(view, state);
    if current {
        tension_marker::draw(view, state, &mut figures);
    }
    robot_path::draw(view, state, &mut figures);
    pointer::frame(view, state);
    if state.view.layers.grid {
        grid::axes(view);
        grid::scale_bar(view);
    }
    no_answer::banner(view, state);
    if state.view.layers.labels {
        annotations::draw(view, state, figures);
    }
}
