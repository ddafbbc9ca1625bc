//! The pointer on the canvas can hover, pick, drag, frame, pan, zoom, and add a waypoint or a leg.

use cable_core::scene::{Shape, SupportKind};
use egui::{CursorIcon, PointerButton, Pos2, Rect, Response, Stroke, StrokeKind, Ui};

use crate::canvas::canvas_view::CanvasView;
use crate::canvas::layers::grid;
use crate::command::{Command, SceneCommand, ViewCommand};
use crate::geometry::{handles, hit_test};
use crate::state::{AppState, Grab, Item, TensionMarker};

/// Distance from the cable at which a double-click adds a waypoint, points.
const WAYPOINT_REACH: f32 = 14.0;
/// Zoom per point of wheel: e^0.0025 ≈ a tenth a notch of 40 points. Larger overshoots, smaller
/// tires.
const WHEEL: f64 = 0.0025;

/// Reads the pointer.
pub fn read(ui: &Ui, response: &Response, state: &AppState, commands: &mut Vec<Command>) {
    let canvas = response.rect;
    hover(ui, response, state, commands);
    wheel(ui, response, state, commands);
    if response.double_clicked() {
        if let Some(p) = response.interact_pointer_pos() {
            double_click(state, canvas, p, commands);
        }
    } else if response.clicked()
        && let Some(p) = response.interact_pointer_pos()
    {
        let item = hit_test::item_at(state, canvas, p);
        if matches!(item, Some(Item::Cable(_)))
            && let Some((cable, arc_length_m, _)) = hit_test::cable_at(state, canvas, p, WAYPOINT_REACH)
        {
            let from = state.analysis.tension_marker.map(|p| p.from).unwrap_or_default();
            commands.push(Command::View(ViewCommand::SetTensionMarker(Some(TensionMarker {
                cable,
                arc_length_m,
                from,
            }))));
        }
        commands.push(Command::View(match item {
            Some(item) if adds(ui) => ViewCommand::ToggleSelected(item),
            item => ViewCommand::Select(item),
        }));
    }
    drag(ui, response, state, commands);
}

/// The keys that add to what is picked are held.
fn adds(ui: &Ui) -> bool {
    ui.input(|i| i.modifiers.command || i.modifiers.shift)
}

/// A waypoint on the cable; on the ground a leg of the robot's path to there.
fn double_click(state: &AppState, canvas: Rect, p: Pos2, commands: &mut Vec<Command>) {
    if let Some((cable, arc_length_m, at_m)) = hit_test::cable_at(state, canvas, p, WAYPOINT_REACH) {
        commands.push(Command::Scene(SceneCommand::AddWaypoint { cable, arc_length_m, at_m }));
    } else if state.document.scene.robot.is_some()
        && let Some(Item::Obstacle(k)) = hit_test::item_at(state, canvas, p)
        && state.document.scene.obstacles.get(k).is_some_and(|o| matches!(o.shape, Shape::Terrain { .. }))
    {
        let [to_x_m, _] = state.view.camera.to_world(canvas, p);
        commands.push(Command::Scene(SceneCommand::AddLeg { to_x_m }));
    }
}

/// Finds what is under the pointer and shows its cursor.
fn hover(ui: &Ui, response: &Response, state: &AppState, commands: &mut Vec<Command>) {
    let pointer = response.hover_pos();
    let item = match &state.selection.grab {
        Some(grab) => Some(grab.item),
        None => pointer.and_then(|p| hit_test::item_at(state, response.rect, p)),
    };
    let cursor_m = pointer.map(|p| state.view.camera.to_world(response.rect, p));
    if item != state.selection.hovered || cursor_m != state.selection.cursor_m {
        commands.push(Command::View(ViewCommand::Hover(item, cursor_m)));
    }
    if pointer.is_none() && state.selection.grab.is_none() {
        return;
    }
    let icon = match (state.selection.grab.is_some(), item) {
        (true, _) => CursorIcon::Grabbing,
        (false, Some(Item::Cable(_))) => CursorIcon::PointingHand,
        (false, Some(item)) if handles::of(state, dragged_with(state, item)).is_some() => CursorIcon::Grab,
        (false, Some(_)) => CursorIcon::PointingHand,
        (false, None) if response.dragged() => CursorIcon::AllScroll,
        (false, None) => CursorIcon::Default,
    };
    ui.ctx().set_cursor_icon(icon);
}

/// Zooms about the pointer.
fn wheel(ui: &Ui, response: &Response, state: &AppState, commands: &mut Vec<Command>) {
    let Some(p) = response.hover_pos() else { return };
    let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
    let factor = f64::from(pinch) * (f64::from(scroll) * WHEEL).exp();
    if factor != 1.0 {
        let about_m = state.view.camera.to_world(response.rect, p);
        commands.push(Command::View(ViewCommand::Zoom { about_m, factor }));
    }
}

/// Grabs what the pointer pressed, or begins a marquee; moves it, and lets go.
fn drag(ui: &Ui, response: &Response, state: &AppState, commands: &mut Vec<Command>) {
    let canvas = response.rect;
    if response.drag_started_by(PointerButton::Primary)
        && let Some(p) = ui.input(|i| i.pointer.press_origin())
    {
        let Some(item) = hit_test::item_at(state, canvas, p) else {
            if adds(ui) {
                let at = state.view.camera.to_world(canvas, p);
                commands.push(Command::View(ViewCommand::SetMarquee(Some([at, at]))));
            }
            return;
        };
        let item = dragged_with(state, item);
        if !state.selection.contains(item) {
            commands.push(Command::View(ViewCommand::Select(Some(item))));
        }
        if let Some(at) = handles::of(state, item) {
            let w = state.view.camera.to_world(canvas, p);
            let grab = Grab { item, offset_m: [at[0] - w[0], at[1] - w[1]] };
            commands.push(Command::View(ViewCommand::Grab(Some(grab))));
            // The pointer has moved on since the press.
            if let Some(now) = response.interact_pointer_pos() {
                move_to(state, &grab, canvas, now, commands);
            }
            return;
        }
    }
    match &state.selection.grab {
        Some(grab) => {
            if response.dragged_by(PointerButton::Primary)
                && let Some(p) = response.interact_pointer_pos()
            {
                move_to(state, grab, canvas, p, commands);
            }
            if response.drag_stopped() || !ui.input(|i| i.pointer.primary_down()) {
                commands.push(Command::View(ViewCommand::Grab(None)));
                commands.push(Command::Scene(SceneCommand::EditDone));
            }
        }
        None if state.selection.marquee_m.is_some() => drag_marquee(ui, response, state, commands),
        None => {
            let delta = response.drag_delta();
            if response.dragged() && delta != egui::Vec2::ZERO {
                commands.push(Command::View(ViewCommand::Pan(delta)));
            }
        }
    }
}

/// The item that a drag moves: a support on the hitch goes where its robot goes.
fn dragged_with(state: &AppState, item: Item) -> Item {
    let Item::Support { cable, support } = item else { return item };
    let support = state.document.scene.cables.get(cable).and_then(|c| c.supports.get(support));
    if support.is_some_and(|s| s.kind == SupportKind::Robot) { Item::Robot } else { item }
}

/// Moves what is grabbed to the pointer at `p`: a load along its cable, other things freely or on
/// the grid.
fn move_to(state: &AppState, grab: &Grab, canvas: egui::Rect, p: Pos2, commands: &mut Vec<Command>) {
    if let Item::Load(k) = grab.item {
        // A load slides along its cable.
        if let Some((cable, arc_length_m, _)) = hit_test::cable_at(state, canvas, p, f32::INFINITY)
            && let Some(mut value) = state.document.scene.loads.get(k).cloned()
            && state.document.scene.cables.get(cable).is_some_and(|c| c.name == value.cable)
        {
            value.arc_length_m = arc_length_m;
            commands.push(Command::Scene(SceneCommand::SetLoad { load: k, value }));
        }
        return;
    }
    let w = state.view.camera.to_world(canvas, p);
    let mut to_m = [w[0] + grab.offset_m[0], w[1] + grab.offset_m[1]];
    if state.view.layers.snap {
        let [_, step] = grid::steps(&state.view.camera);
        to_m = to_m.map(|v| (v / step).round() * step);
    }
    let item = grab.item;
    let from_m = handles::of(state, item)
        .filter(|_| state.selection.contains(item) && !state.selection.also_selected.is_empty());
    commands.push(Command::Scene(match from_m {
        Some(from) => SceneCommand::MoveAll(handles::moved(state, item, [to_m[0] - from[0], to_m[1] - from[1]])),
        None => SceneCommand::Move { item, to_m },
    }));
}

/// Draws the frame on, and picks what is in it when it is let go.
fn drag_marquee(ui: &Ui, response: &Response, state: &AppState, commands: &mut Vec<Command>) {
    let Some([from, to]) = state.selection.marquee_m else { return };
    let to = response.interact_pointer_pos().map_or(to, |p| state.view.camera.to_world(response.rect, p));
    if response.drag_stopped() || !ui.input(|i| i.pointer.primary_down()) {
        commands.push(Command::View(ViewCommand::SelectAll(handles::within(state, [from, to]))));
        commands.push(Command::View(ViewCommand::SetMarquee(None)));
    } else {
        commands.push(Command::View(ViewCommand::SetMarquee(Some([from, to]))));
    }
}

/// The frame being drawn round things to pick.
pub fn frame(view: &CanvasView<'_>, state: &AppState) {
    let Some([a, b]) = state.selection.marquee_m else { return };
    let rect = Rect::from_two_pos(view.at(a), view.at(b));
    let line = Stroke::new(1.2, view.palette.accent);
    view.painter.rect(rect, 0.0, view.palette.accent.gamma_multiply(0.12), line, StrokeKind::Middle);
}
