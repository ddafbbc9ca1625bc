//! Obstacles are drawn: terrain, beams, posts and thin lines.

use cable_core::math::Point;
use cable_core::scene::Shape;
use egui::{Mesh, Pos2, Stroke, pos2, vec2};

use crate::canvas::canvas_view::CanvasView;
use crate::geometry::triangulate::triangulate;
use crate::state::{AppState, Item};

/// Distance of hatch strokes below a surface and their length, points.
const HATCH: [f32; 2] = [9.0, 8.0];

/// Points nearer to each other than this are drawn as one, points.
const MIN_SPACING: f32 = 1.0;

/// All of them.
pub fn draw(view: &CanvasView<'_>, state: &AppState) {
    for (k, obstacle) in state.document.scene.obstacles.iter().enumerate() {
        let touched =
            |item: Item| item == Item::Obstacle(k) || matches!(item, Item::Corner { obstacle, .. } if obstacle == k);
        let selected = state.selection.selected.is_some_and(touched) || state.selection.contains(Item::Obstacle(k));
        let stroke = if selected {
            Stroke::new(2.5, view.palette.accent)
        } else if state.selection.hovered.is_some_and(touched) {
            Stroke::new(2.0, view.palette.accent)
        } else {
            Stroke::new(1.5, view.palette.surface)
        };
        match &obstacle.shape {
            Shape::Terrain { points_m } => terrain(view, points_m, stroke),
            Shape::Polygon { points_m } => polygon(view, points_m, stroke),
            Shape::Circle { center_m, radius_m } => {
                view.painter.circle(view.at(*center_m), view.points(*radius_m), view.palette.solid, stroke);
                view.painter.circle_filled(view.at(*center_m), 1.5, view.palette.hatch);
            }
            Shape::Polyline { points_m, thickness_m } => {
                let width = view.points(*thickness_m).max(2.0);
                let points: Vec<Pos2> = points_m.iter().map(|&p| view.at(p)).collect();
                view.painter.line(points, Stroke::new(width, stroke.color));
            }
        }
        if selected {
            corners(view, &obstacle.shape, state);
        }
    }
}

/// Handles on the corners of the selected obstacle.
fn corners(view: &CanvasView<'_>, shape: &Shape, state: &AppState) {
    let (Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. }) = shape else {
        return;
    };
    for (k, &p) in points_m.iter().enumerate() {
        let is = |item: Option<Item>| matches!(item, Some(Item::Corner { corner, .. }) if corner == k);
        let fill = if is(state.selection.selected) || is(state.selection.hovered) {
            view.palette.accent
        } else {
            view.palette.background
        };
        let next = points_m.get(k + 1).or(points_m.get(k.wrapping_sub(1)));
        let crowded = next.is_some_and(|&q| view.at(q).distance(view.at(p)) < 14.0);
        let side = if crowded { 4.0 } else { 7.0 };
        let handle = egui::Rect::from_center_size(view.at(p), vec2(side, side));
        view.painter.rect(handle, 1.0, fill, Stroke::new(1.2, view.palette.accent), egui::StrokeKind::Middle);
    }
}

/// Draws ground, filled to the bottom of the canvas.
fn terrain(view: &CanvasView<'_>, points_m: &[Point], stroke: Stroke) {
    let line = distinct_points(view, points_m);
    let bottom = line.iter().fold(view.rect.max.y, |b, p| b.max(p.y)) + 4.0;
    let mut mesh = Mesh::default();
    for pair in line.windows(2) {
        let base = mesh.vertices.len() as u32;
        for p in [pair[0], pair[1], pos2(pair[1].x, bottom), pos2(pair[0].x, bottom)] {
            mesh.colored_vertex(p, view.palette.solid);
        }
        mesh.add_triangle(base, base + 1, base + 2);
        mesh.add_triangle(base, base + 2, base + 3);
    }
    view.painter.add(mesh);
    for pair in line.windows(2) {
        hatch(view, pair[0], pair[1]);
    }
    view.painter.line(line, stroke);
}

/// The points of a line that can be told apart on screen, with one beyond each edge that it
/// crosses.
fn distinct_points(view: &CanvasView<'_>, points_m: &[Point]) -> Vec<Pos2> {
    let side = |p: Pos2| i8::from(p.x > view.rect.max.x) - i8::from(p.x < view.rect.min.x);
    let mut out: Vec<Pos2> = Vec::new();
    let mut skipped: Option<Pos2> = None;
    for &p in points_m {
        let at = view.at(p);
        let Some(&last) = out.last() else {
            out.push(at);
            continue;
        };
        // Out of view on the same side as the one before, or on it: not drawn, unless the line
        // comes back from there.
        if (side(at) != 0 && side(at) == side(last)) || last.distance(at) < MIN_SPACING {
            skipped = Some(at);
            continue;
        }
        if let Some(before) = skipped.take().filter(|s| side(*s) != 0) {
            out.push(before);
        }
        out.push(at);
    }
    out.extend(skipped);
    out
}

/// Short slanted strokes under a stretch of ground, at places fixed to the screen's x.
fn hatch(view: &CanvasView<'_>, a: Pos2, b: Pos2) {
    let (low, high) = (a.x.min(b.x).max(view.rect.min.x), a.x.max(b.x).min(view.rect.max.x));
    if !(high > low) {
        return;
    }
    let stroke = Stroke::new(1.0, view.palette.hatch);
    // Anchored to the world, so that it moves with it: the offset of the centre modulo the spacing.
    let shift = (view.camera.centre_m[0] * view.camera.points_per_m).rem_euclid(f64::from(HATCH[0])) as f32;
    let mut x = ((low + shift - view.rect.center().x) / HATCH[0]).ceil() * HATCH[0] - shift + view.rect.center().x;
    while x <= high {
        let y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
        view.painter.line_segment([pos2(x, y + 1.0), pos2(x - HATCH[1] * 0.7, y + 1.0 + HATCH[1])], stroke);
        x += HATCH[0];
    }
}

/// Draws a filled polygon.
fn polygon(view: &CanvasView<'_>, points_m: &[Point], stroke: Stroke) {
    let mut mesh = Mesh::default();
    for &p in points_m {
        mesh.colored_vertex(view.at(p), view.palette.solid);
    }
    for [a, b, c] in triangulate(points_m) {
        mesh.add_triangle(a, b, c);
    }
    view.painter.add(mesh);
    let outline: Vec<Pos2> = points_m.iter().map(|&p| view.at(p)).collect();
    view.painter.add(egui::Shape::closed_line(outline, stroke));
}
