//! The picture of the scene, in layers, and the pointer on it.

pub mod bounds;
mod cable;
mod forces;
pub mod grid;
mod held;
mod legend;
mod obstacles;
pub mod pick;
mod pointer;
mod robot;
mod supports;
mod triangulate;
mod view;

use egui::{Rect, Role, Sense, Ui, WidgetInfo, vec2};

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
    if !rect.is_positive() {
        return;
    }
    let answered = state.snapshot.solution.is_some() || state.snapshot.error.is_some();
    if state.camera.fit_wanted && answered {
        let bounds = bounds::scene(state);
        state.camera.fit(rect, bounds);
    }
    pointer::read(ui, &response, state, commands);
    name_supports(ui, rect, state);
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
    obstacles::draw(view, state);
    robot::draw(view, state);
    held::draw(view, state);
    cable::draw(view, state);
    let mut figures = Vec::new();
    forces::draw(view, state, &mut figures);
    supports::draw(view, state);
    if state.layers.grid {
        grid::axes(view);
        grid::scale_bar(view);
    }
    legend::draw(view, state);
    legend::banner(view, state);
    if state.layers.labels {
        supports::labels(view, state, figures);
    }
}

/// Lets a screen reader, and the tests, find each support where it is painted.
fn name_supports(ui: &Ui, canvas: Rect, state: &AppState) {
    for (cable, c) in state.scene.cables.iter().enumerate() {
        for (support, s) in c.supports.iter().enumerate() {
            let Some(at) = supports::place(state, cable, support) else { continue };
            let spot = Rect::from_center_size(state.camera.to_screen(canvas, at), vec2(20.0, 20.0));
            let id = ui.scope_id().with(("support", cable, support));
            let response = ui.interact(spot.intersect(canvas), id, Sense::hover());
            let text = format!("Support {} of {}", s.name, c.name);
            response.widget_info(|| WidgetInfo::labeled(Role::GraphicsSymbol, true, &text));
        }
    }
}
