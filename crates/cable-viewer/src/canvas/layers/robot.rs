//! The robot is drawn to scale, from the side or from above: body, tracks, hitch.

use cable_core::math::Point;
use cable_core::problem::OUTLINE_NAME;
use cable_core::scene::preset::RobotPreset;
use cable_core::scene::{Heading, Pose, View};
use cable_core::solution::DriveState;
use egui::{Color32, Mesh, Pos2, Stroke};

use crate::canvas::canvas_view::CanvasView;
use crate::geometry::robot::{extent, robot_outline, robot_pose};
use crate::geometry::triangulate::triangulate;
use crate::state::{AppState, Item};

/// Height of the tracks as a part of the robot's height: drawn, not published.
const TRACK_HEIGHT: f64 = 0.28;
/// Width of a track as a part of the width across both: drawn, not published.
const TRACK_WIDTH: f64 = 0.25;
/// Wheels drawn in a track.
const WHEELS: u8 = 4;

/// Returns where its name stands and what it says: its name, and why it goes as it does.
#[must_use]
pub fn title(state: &AppState) -> Option<(Point, String)> {
    let (pose, preset) = robot_pose(state)?;
    let going = state.live.snapshot.solution.as_ref().and_then(|s| s.robot).map(|r| r.going);
    let text = match going {
        None | Some(DriveState::Standing | DriveState::Driving) => preset.name.clone(),
        Some(going) => format!("{}: {}", preset.name, going.name()),
    };
    let top = match state.document.scene.view {
        View::Elevation => preset.height_m.value,
        View::Plan => 0.5 * preset.width_m.value,
    };
    Some((pose.place([0.0, top]), text))
}

/// Draws it.
pub fn draw(view: &mut CanvasView<'_>, state: &AppState) {
    let Some((pose, preset)) = robot_pose(state) else { return };
    let is = |item: Option<Item>| item == Some(Item::Robot);
    let line = match (state.selection.contains(Item::Robot), is(state.selection.hovered)) {
        (true, _) => Stroke::new(2.5, view.palette.accent),
        (_, true) => Stroke::new(2.0, view.palette.accent),
        _ => Stroke::new(1.4, view.palette.surface),
    };
    let points = robot_outline(state);
    let mut mesh = Mesh::default();
    for &p in &points {
        mesh.colored_vertex(view.at(p), view.palette.robot);
    }
    for [a, b, c] in triangulate(&points) {
        mesh.add_triangle(a, b, c);
    }
    view.painter.add(mesh);
    let body: Vec<Pos2> = points.iter().map(|&p| view.at(p)).collect();
    view.avoid_area(egui::Rect::from_points(&body));
    view.painter.add(egui::Shape::closed_line(body, line));
    match state.document.scene.view {
        View::Elevation => {
            tracks(view, &pose, preset);
            touched(view, state, &pose, preset);
        }
        View::Plan => tracks_from_above(view, &pose, preset),
    }
    let hitch = view.at(pose.hitch_m(preset, state.document.scene.view));
    view.painter.circle(hitch, 4.0, Color32::TRANSPARENT, Stroke::new(1.6, view.palette.support));
}

/// Draws the contact outline of the robot if the cable touches it: the outline is cut back round
/// the hitch and boxed at the tracks. Its part below the ground, which keeps the cable from getting
/// under a track, is not drawn.
fn touched(view: &CanvasView<'_>, state: &AppState, pose: &Pose, preset: &RobotPreset) {
    let contacts = state.live.snapshot.solution.iter().flat_map(|s| &s.cables).flat_map(|c| &c.contacts);
    if !state.view.layers.contacts || !contacts.into_iter().any(|c| c.obstacle == OUTLINE_NAME) {
        return;
    }
    // In its own axes, looking right: the pose turns it to where it looks.
    let corners = preset.meets_cable_m(Heading::Right);
    let above: Vec<Pos2> = corners.iter().map(|c| view.at(pose.place([c.x, c.y.max(0.0)]))).collect();
    let line = Stroke::new(1.2, view.palette.normal);
    let first = above.first().copied();
    let ring: Vec<Pos2> = above.iter().copied().chain(first).collect();
    view.painter.extend(egui::Shape::dashed_line(&ring, line, 4.0, 3.0));
}

/// Places along it at which its tracks begin and end, m.
fn foot(preset: &RobotPreset) -> [f64; 2] {
    let height = TRACK_HEIGHT * preset.height_m.value;
    extent(preset.outline_m.iter().filter(|p| p[1] < height).map(|p| p[0]))
}

/// A belt on either side.
fn tracks_from_above(view: &CanvasView<'_>, pose: &Pose, preset: &RobotPreset) {
    let ([low, high], half) = (foot(preset), 0.5 * preset.width_m.value);
    let inner = half * (1.0 - 2.0 * TRACK_WIDTH);
    let stroke = Stroke::new(1.2, view.palette.surface);
    for side in [-1.0, 1.0] {
        let corners = [[low, inner], [high, inner], [high, half], [low, half]];
        let belt = corners.map(|[x, y]| view.at(pose.place([x, side * y])));
        view.painter.add(egui::Shape::convex_polygon(belt.into(), view.palette.hatch, stroke));
    }
}

/// A belt with wheels along the foot of the outline.
fn tracks(view: &CanvasView<'_>, pose: &Pose, preset: &RobotPreset) {
    let height = TRACK_HEIGHT * preset.height_m.value;
    let [low, high] = foot(preset);
    let radius = 0.5 * height;
    if !(low + height < high) {
        return;
    }
    // Two half circles and what is between them.
    let turn = |centre: f64, from: f64| {
        (0..=12).map(move |k| {
            let angle = from + std::f64::consts::PI * f64::from(k) / 12.0;
            [centre + radius * angle.cos(), radius + radius * angle.sin()]
        })
    };
    let right = turn(high - radius, -std::f64::consts::FRAC_PI_2);
    let left = turn(low + radius, std::f64::consts::FRAC_PI_2);
    let belt: Vec<Pos2> = right.chain(left).map(|p| view.at(pose.place(p))).collect();
    let stroke = Stroke::new(1.2, view.palette.surface);
    view.painter.add(egui::Shape::convex_polygon(belt, view.palette.hatch, stroke));
    let wheel = 0.55 * radius as f32 * view.camera.points_per_m as f32;
    for k in 0..WHEELS {
        let share = f64::from(k) / f64::from(WHEELS - 1);
        let x = low + radius + share * (high - low - 2.0 * radius);
        view.painter.circle_stroke(view.at(pose.place([x, radius])), wheel, stroke);
    }
}
