//! The view goes with what leaves it: unasked where it was not moved by hand, else when the user
//! wants it to.

use cable_core::math::Point;
use egui::{Rect, Ui};

use crate::canvas::canvas_view::hints_height;
use crate::command::{Command, ViewCommand};
use crate::geometry::bounds;
use crate::geometry::leader::{Leader, LeaderKind, leader};
use crate::geometry::torn_cable::torn;
use crate::state::AppState;

/// Border of the canvas in which cables and robot may move before the view widens, points: left
/// (axis numbers), right, top, bottom. Smaller: they touch the edge; larger: the view moves as soon
/// as they do.
const WIDEN_BORDER: [f32; 4] = [48.0, 20.0, 20.0, 28.0];

/// Moves the camera. A view that was not moved by hand goes with a cable that is torn off and
/// falls, and is widened when a whole one is led out of it. It goes back to the scene at the start.
pub(super) fn ui(state: &mut AppState, rect: Rect, border: [f32; 4]) {
    // A thing that the pointer holds would go with the view.
    if state.selection.grab.is_some() {
        return;
    }
    let (torn, leader, moved) = (torn(state), leader(state), bounds::moving(state));
    let camera = &mut state.view.camera;
    let is_fitted = camera.fitted_to.is_some() && !camera.fit_wanted;
    match (torn, leader) {
        (Some(torn), _) if camera.follows || (is_fitted && torn.falls) => {
            camera.follows |= camera.keep_in_view(rect, torn.piece, border);
        }
        (None, Some(leader)) if camera.follows => {
            camera.keep_in_view(rect, leader.bounds_m, border);
        }
        (None, Some(leader)) if is_fitted => {
            let is_in_view = camera.widen(rect, moved, free_border(border));
            if !is_in_view {
                camera.keep_in_view(rect, leader.bounds_m, border);
            }
        }
        (None, None) if camera.follows || (is_fitted && camera.widened_from.is_some()) => {
            (camera.follows, camera.fit_wanted) = (false, true);
        }
        _ => {}
    }
    let in_view = leader.is_some_and(|leader| !is_out_of_view(camera.visible_m(rect), leader.bounds_m));
    camera.leader_seen |= in_view;
}

/// [`WIDEN_BORDER`] with the room for hints at the foot.
fn free_border(border: [f32; 4]) -> [f32; 4] {
    let hints = border[3] - crate::state::camera::BORDER[3];
    let [left, right, top, bottom] = WIDEN_BORDER;
    [left, right, top, bottom + hints]
}

/// Returns whether nothing of a rectangle (m) is in another.
fn is_out_of_view([left, right]: [Point; 2], [low, high]: [Point; 2]) -> bool {
    (0..2).any(|k| high[k] < left[k] || low[k] > right[k])
}

/// Offers to follow what has left the picture, where the user moved the view: it is not moved
/// unasked, and nothing is offered of what was out of view when the user moved it.
pub fn offer(ui: &Ui, rect: Rect, state: &AppState, commands: &mut Vec<Command>) {
    let out = |bounds_m| is_out_of_view(state.view.visible_m, bounds_m);
    let camera = &state.view.camera;
    let lost = |leader: &Leader| camera.leader_seen && !camera.follows && out(leader.bounds_m);
    let (name, kind) = match (torn(state), leader(state)) {
        (Some(torn), _) if out(torn.piece) => ("torn cable", LeaderKind::Cable),
        (None, Some(leader)) if lost(&leader) => (leader.kind.name(), leader.kind),
        _ => return,
    };
    let foot = egui::pos2(rect.center().x, rect.max.y - 46.0 - hints_height(state));
    let area = egui::Area::new(egui::Id::unique("out of view")).fixed_pos(foot).pivot(egui::Align2::CENTER_BOTTOM);
    area.order(egui::Order::Middle).show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("The {name} has left the view"));
                let help = "The view goes with it until you move the view (F shows the whole scene, C the cable)";
                let button = match kind {
                    LeaderKind::Robot => "Follow the robot",
                    LeaderKind::MovingEnd | LeaderKind::Cable => "Follow the cable",
                };
                if ui.button(button).on_hover_text(help).clicked() {
                    commands.push(Command::View(ViewCommand::Follow));
                }
            });
        });
    });
}
