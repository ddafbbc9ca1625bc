//! The robot's path: a flag on the ground where each leg ends.

use cable_core::math::Point;
use cable_core::scene::RobotTask;
use cable_core::scene::ground::Ground;
use egui::{Color32, Pos2, Stroke, vec2};

use crate::canvas::view::View;
use crate::state::{AppState, Item};
use crate::units::labels;

/// Height and width of a flag, points.
const FLAG: [f32; 2] = [26.0, 15.0];

/// The legs that lead to a place: index, where, m, and what it says.
#[must_use]
pub fn flags(state: &AppState) -> Vec<(usize, Point, String)> {
    let Some(robot) = state.scene.robot.as_ref().filter(|r| !r.path.is_empty()) else { return Vec::new() };
    let ground = Ground::of(&state.scene);
    let mut out: Vec<(usize, Point, String)> = Vec::new();
    for (k, task) in robot.path.iter().enumerate() {
        match (task, out.last_mut()) {
            (RobotTask::Drive { to_x_m, speed_m_per_s }, _) => {
                let y = ground.height(*to_x_m).unwrap_or(robot.at_m[1]);
                out.push((k, [*to_x_m, y], format!("leg {}: {}", k + 1, labels::speed(*speed_m_per_s))));
            }
            (RobotTask::Wait { wait_s }, Some((_, _, text))) => {
                *text += &format!(", then waits {} s", labels::digits(*wait_s));
            }
            (RobotTask::Wait { .. }, None) => {}
        }
    }
    out
}

/// Draws them; what they say goes to `figures` for the labels to place.
pub fn draw(view: &View<'_>, state: &AppState, figures: &mut Vec<(Pos2, String, Color32)>) {
    for (k, at, text) in flags(state) {
        let item = Item::Leg(k);
        let marked = state.picked(item) || state.hovered == Some(item);
        let colour = if marked { view.palette.accent } else { view.palette.surface };
        let foot = view.at(at);
        let top = foot - vec2(0.0, FLAG[0]);
        view.painter.line_segment([foot, top], Stroke::new(if marked { 2.4 } else { 1.6 }, colour));
        let cloth = vec![top, top + vec2(FLAG[1], 5.5), top + vec2(0.0, 11.0)];
        view.painter.add(egui::Shape::convex_polygon(cloth, colour, Stroke::NONE));
        view.painter.circle_filled(foot, if marked { 4.5 } else { 3.0 }, colour);
        figures.push((top, text, view.palette.text));
    }
}
