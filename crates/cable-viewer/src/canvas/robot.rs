//! The robot, to scale: body, tracks, hitch.

use cable_core::math::Point;
use cable_core::scene::preset::{RobotPreset, robot_preset};
use cable_core::scene::{Heading, Robot};
use egui::{Color32, Mesh, Pos2, Stroke, StrokeKind, vec2};

use super::triangulate::triangulate;
use super::view::View;
use crate::state::{AppState, Item};

/// Height of the tracks as a part of the robot's height: drawn, not published.
const TRACK_HEIGHT: f64 = 0.28;
/// Wheels drawn in a track.
const WHEELS: u8 = 4;

/// Its outline in the world, m; empty where there is no robot or no such preset.
#[must_use]
pub fn outline(state: &AppState) -> Vec<Point> {
    let Some((robot, preset)) = robot(state) else { return Vec::new() };
    preset.outline_m.iter().map(|&p| placed(robot, p)).collect()
}

/// Where its name stands and what it says.
#[must_use]
pub fn title(state: &AppState) -> Option<(Point, String)> {
    let (robot, preset) = robot(state)?;
    Some((placed(robot, [0.0, preset.height_m.value]), preset.name.clone()))
}

fn robot(state: &AppState) -> Option<(&Robot, &'static RobotPreset)> {
    let robot = state.scene.robot.as_ref()?;
    Some((robot, robot_preset(&robot.preset)?))
}

/// From the robot's own axes (looking right, from where the middle of its tracks touches the ground) to the world, m.
fn placed(robot: &Robot, p: Point) -> Point {
    let x = if robot.heading == Heading::Left { -p[0] } else { p[0] };
    [robot.at_m[0] + x, robot.at_m[1] + p[1]]
}

/// Draws it.
pub fn draw(view: &mut View<'_>, state: &AppState) {
    let Some((robot, preset)) = robot(state) else { return };
    let is = |item: Option<Item>| item == Some(Item::Robot);
    let line = match (is(state.selected), is(state.hovered)) {
        (true, _) => Stroke::new(2.5, view.palette.accent),
        (_, true) => Stroke::new(2.0, view.palette.accent),
        _ => Stroke::new(1.4, view.palette.surface),
    };
    let points = outline(state);
    let mut mesh = Mesh::default();
    for &p in &points {
        mesh.colored_vertex(view.at(p), view.palette.robot);
    }
    for [a, b, c] in triangulate(&points) {
        mesh.add_triangle(a, b, c);
    }
    view.painter.add(mesh);
    let body: Vec<Pos2> = points.iter().map(|&p| view.at(p)).collect();
    view.painter.add(egui::Shape::closed_line(body, line));
    tracks(view, robot, preset);
    if let Some(hitch) = robot.hitch_m() {
        view.painter.circle(view.at(hitch), 4.0, Color32::TRANSPARENT, Stroke::new(1.6, view.palette.support));
    }
}

/// A belt with wheels along the foot of the outline.
fn tracks(view: &View<'_>, robot: &Robot, preset: &RobotPreset) {
    let height = TRACK_HEIGHT * preset.height_m.value;
    let foot = preset.outline_m.iter().filter(|p| p[1] < height).map(|p| p[0]);
    let (low, high) = foot.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    if !(low < high) {
        return;
    }
    let [a, b] = [placed(robot, [low, height]), placed(robot, [high, 0.0])].map(|p| view.at(p));
    let belt = egui::Rect::from_two_pos(a, b);
    let radius = 0.5 * belt.height();
    let stroke = Stroke::new(1.2, view.palette.surface);
    view.painter.rect(belt, radius, view.palette.hatch, stroke, StrokeKind::Middle);
    for k in 0..WHEELS {
        let share = f32::from(k) / f32::from(WHEELS - 1);
        let x = belt.left() + radius + share * (belt.width() - 2.0 * radius);
        view.painter.circle_stroke(belt.left_center() + vec2(x - belt.left(), 0.0), 0.55 * radius, stroke);
    }
}
