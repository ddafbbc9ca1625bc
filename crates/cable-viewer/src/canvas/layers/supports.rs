//! Supports are drawn as the signs engineers use.

use cable_core::scene::{Support, SupportKind};
use egui::{Pos2, Stroke, vec2};

use crate::canvas::canvas_view::CanvasView;
use crate::geometry::supports::{hand_spring, support_position};
use crate::state::{AppState, Item};

/// Windings of the spring between a hand and what it draws.
const WINDINGS: usize = 9;
/// Half of its width, points.
const HALF_WIDTH: f32 = 4.0;

/// The spring from a support to the hand that draws it.
fn spring(view: &CanvasView<'_>, [at, to]: [Pos2; 2]) {
    let stroke = Stroke::new(1.4, view.palette.accent);
    let (way, length) = (to - at, at.distance(to));
    let across = if length > 0.0 { vec2(-way.y, way.x) * (HALF_WIDTH / length) } else { egui::Vec2::ZERO };
    let mut points = vec![at];
    for k in 1..2 * WINDINGS {
        let side = if k % 2 == 0 { across } else { -across };
        points.push(at + way * (k as f32 / (2 * WINDINGS) as f32) + side);
    }
    points.push(to);
    view.painter.line(points, stroke);
    view.painter.circle_stroke(to, 4.5, stroke);
}

/// The signs.
pub fn draw(view: &CanvasView<'_>, state: &AppState) {
    for (cable, c) in state.document.scene.cables.iter().enumerate() {
        for (support, s) in c.supports.iter().enumerate() {
            let Some(at) = support_position(state, cable, support) else { continue };
            let p = view.at(at);
            if let Some(ends) = hand_spring(state, cable, support) {
                spring(view, ends.map(|p| view.at(p)));
                // The pointer may be ahead of the hand, which is no faster than it may be. Past the
                // length of the cable the scene keeps a place behind the hand.
                let leads = state.selection.spring_support == Some((cable, support)) && !state.solver.pulls_past_length;
                if let Some(to) = s.at_m.filter(|_| leads) {
                    let ends = [ends[1], to].map(|p| view.at(p));
                    view.painter.line_segment(ends, Stroke::new(1.0, view.palette.accent.gamma_multiply(0.6)));
                }
            }
            let item = Item::Support { cable, support };
            if state.selection.contains(item) || state.selection.hovered == Some(item) {
                let strong = if state.selection.contains(item) { 0.5 } else { 0.28 };
                view.painter.circle_filled(p, 15.0, view.palette.accent.gamma_multiply(strong));
            }
            sign(view, p, s);
        }
    }
}

/// Draws the sign of a support by its kind.
fn sign(view: &CanvasView<'_>, p: Pos2, s: &Support) {
    let (ink, paper) = (view.palette.support, view.palette.background);
    let line = Stroke::new(1.6, ink);
    let painter = view.painter;
    match s.kind {
        SupportKind::Fixed => {
            let feet = [p + vec2(-7.0, 11.0), p + vec2(7.0, 11.0)];
            painter.add(egui::Shape::convex_polygon(vec![p, feet[1], feet[0]], paper, line));
            painter.line_segment([feet[0] + vec2(-3.0, 0.0), feet[1] + vec2(3.0, 0.0)], line);
            painter.circle(p, 3.4, ink, Stroke::new(1.2, paper));
        }
        SupportKind::Clamped => {
            let along = s.angle_deg.unwrap_or(0.0).to_radians();
            let t = vec2(along.cos() as f32, -along.sin() as f32);
            let n = vec2(-t.y, t.x);
            painter.line_segment([p - n * 10.0, p + n * 10.0], Stroke::new(3.0, ink));
            painter.arrow(p, t * 22.0, Stroke::new(1.2, ink));
            painter.circle(p, 3.4, ink, Stroke::new(1.2, paper));
        }
        SupportKind::Pulley => {
            let radius = view.points(s.radius_m.unwrap_or(0.0)).max(6.5);
            painter.circle(p, radius, paper.gamma_multiply(0.6), line);
            painter.circle_filled(p, 2.2, ink);
        }
        SupportKind::Robot => {
            painter.rect(egui::Rect::from_center_size(p, vec2(13.0, 10.0)), 2.0, paper, line, egui::StrokeKind::Middle);
        }
        // Loads, free ends, and kinds to come.
        _ => {
            painter.circle(p, 4.0, paper, line);
        }
    }
}
