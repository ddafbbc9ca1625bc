//! The picture of the scene, in layers, and the pointer on it.

pub mod bounds;
mod cable;
mod contact;
pub mod forces;
pub mod grid;
mod held;
mod legend;
mod named;
mod obstacles;
mod path;
pub mod pick;
pub mod place;
mod pointer;
mod probe;
mod reach;
pub mod robot;
pub mod supports;
mod triangulate;
mod view;

use egui::{Role, Sense, Ui, WidgetInfo};

use crate::command::Command;
use crate::state::AppState;
use crate::theme;
use view::View;

/// Draws the scene into the rest of the window and reads the pointer.
pub fn ui(ui: &mut Ui, state: &mut AppState, commands: &mut Vec<Command>) {
    // Not focusable: single keys go to the window while the canvas is in use.
    let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::CLICK | Sense::DRAG);
    let rect = response.rect;
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Canvas"));
    // Written only for who listens.
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(named::summary(state)));
    if !rect.is_positive() {
        return;
    }
    let answered = state.snapshot.solution.is_some() || state.snapshot.error.is_some();
    if state.camera.fit_wanted && answered {
        let bounds = bounds::scene(state);
        state.camera.fit(rect, bounds);
    }
    let [low, high] = [rect.left_bottom(), rect.right_top()].map(|p| state.camera.to_world(rect, p));
    state.visible_m = [low, high];
    pointer::read(ui, &response, state, commands);
    named::ui(ui, rect, state);
    let mut view = View {
        rect,
        camera: state.camera,
        painter: &painter,
        palette: theme::palette(ui.visuals()),
        taken: Vec::new(),
        avoided: Vec::new(),
    };
    draw(&mut view, state);
}

/// All layers, back to front.
fn draw(view: &mut View<'_>, state: &AppState) {
    view.painter.rect_filled(view.rect, 0.0, view.palette.background);
    if state.layers.grid {
        grid::lines(view);
    }
    reach::area(view, state);
    obstacles::draw(view, state);
    let mut figures = Vec::new();
    reach::line(view, state, &mut figures);
    robot::draw(view, state);
    held::draw(view, state);
    contact::draw(view, state);
    cable::draw(view, state);
    forces::draw(view, state, &mut figures);
    supports::draw(view, state);
    probe::draw(view, state, &mut figures);
    path::draw(view, state, &mut figures);
    pointer::frame(view, state);
    if state.layers.grid {
        grid::axes(view);
        grid::scale_bar(view);
    }
    legend::draw(view, state);
    legend::contacts(view, state);
    legend::banner(view, state);
    reach::legend(view, state);
    if state.layers.labels {
        supports::labels(view, state, figures);
    }
}
