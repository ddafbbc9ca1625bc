//! A contact is drawn as a band along the cable, filled where it holds, hollow where it slides,
//! with a tick at each slip front. Filled and hollow are told apart by every eye.

use cable_core::solution::{CableSolution, ContactPart, ContactReport, ContactState, Node};
use egui::{Mesh, Painter, Pos2, Rect, Stroke, StrokeKind, vec2};

use crate::canvas::canvas_view::CanvasView;
use crate::canvas::layers::cable::{Ribbon, distinct_nodes};
use crate::canvas::layers::surface_offset::{self, MIN_WIDTH};
use crate::render::theme::Palette;
use crate::state::AppState;

/// Width of the band beyond that of the cable, points.
const BAND_WIDTH: f32 = 6.0;
/// Width of its edge where it is hollow, points.
const HOLLOW_EDGE_WIDTH: f32 = 2.8;
/// Half the length of the tick at a slip front, points.
const TICK: f32 = 11.0;

/// Ticks nearer to the one before than this (points) are not drawn: closer in there is room for
/// them.
const MIN_SPACING: f32 = 8.0;

/// The stretches of a contact that hold or slide, in order.
#[must_use]
pub fn parts(contact: &ContactReport) -> Vec<ContactPart> {
    if contact.parts.is_empty() {
        let [begins_m, ends_m] = contact.extent_m();
        return vec![ContactPart { begins_m, ends_m, state: contact.state }];
    }
    contact.parts.clone()
}

/// Slip fronts of a contact, m of arc length.
pub fn fronts(contact: &ContactReport) -> impl Iterator<Item = f64> {
    contact.parts.windows(2).map(|p| p[1].begins_m)
}

/// Bands and ticks of all cables.
pub fn draw(view: &CanvasView<'_>, state: &AppState) {
    let Some(solution) = state.live.snapshot.solution.as_ref().filter(|_| state.view.layers.contacts) else { return };
    let solved = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let mut mesh = Mesh::default();
    for (answer, cable) in solution.cables.iter().zip(&solved.cables) {
        let width = view.points(cable.diameter_m).max(MIN_WIDTH);
        for part in answer.contacts.iter().flat_map(parts) {
            let nodes = between(answer, [part.begins_m, part.ends_m]);
            if nodes.len() < 2 {
                continue;
            }
            let nodes = distinct_nodes(view, &nodes, f64::INFINITY);
            let line = Ribbon::new(surface_offset::places(view, &nodes, answer, cable.diameter_m));
            let (colour, inside) = match part.state {
                ContactState::Stick => (view.palette.normal, None),
                ContactState::Slip => (view.palette.friction, Some(view.palette.background)),
            };
            line.add(&mut mesh, width + BAND_WIDTH, |_| Some(colour));
            if let Some(inside) = inside {
                line.add(&mut mesh, width + BAND_WIDTH - HOLLOW_EDGE_WIDTH, |_| Some(inside));
            }
        }
    }
    view.painter.add(mesh);
    for answer in &solution.cables {
        let mut last = None;
        for s in answer.contacts.iter().flat_map(fronts) {
            tick(view, answer, s, &mut last);
        }
    }
}

/// Draws a mark across the cable at an arc length (m), unless it would touch the last one.
fn tick(view: &CanvasView<'_>, answer: &CableSolution, s: f64, last: &mut Option<Pos2>) {
    let near = between(answer, [s, s]);
    let k = answer.nodes.partition_point(|n| n.arc_length_m <= s).clamp(1, answer.nodes.len().saturating_sub(1).max(1));
    let (Some(n), Some(a), Some(b)) = (near.first(), answer.nodes.get(k - 1), answer.nodes.get(k)) else { return };
    let along = view.at([b.x_m, b.y_m]) - view.at([a.x_m, a.y_m]);
    if along.length() > 0.0 {
        let across = along.normalized().rot90() * TICK;
        let at = view.at([n.x_m, n.y_m]);
        if last.is_some_and(|p| p.distance(at) < MIN_SPACING) {
            return;
        }
        *last = Some(at);
        view.painter.line_segment([at - across, at + across], Stroke::new(2.0, view.palette.text));
    }
}

/// The nodes between two arc lengths and the points of the cable at both; one where they are the
/// same.
#[must_use]
pub fn between(answer: &CableSolution, [from, to]: [f64; 2]) -> Vec<Node> {
    let (Some(first), Some(last)) = (at(answer, from), at(answer, to)) else { return Vec::new() };
    let inside = answer.nodes.iter().filter(|n| n.arc_length_m > from && n.arc_length_m < to).copied();
    if to > from { std::iter::once(first).chain(inside).chain([last]).collect() } else { vec![first] }
}

/// The point of the cable at an arc length, linear between nodes.
#[must_use]
pub fn at(answer: &CableSolution, s: f64) -> Option<Node> {
    let k = answer.nodes.partition_point(|n| n.arc_length_m < s);
    let b = answer.nodes.get(k).or(answer.nodes.last())?;
    let a = answer.nodes.get(k.saturating_sub(1))?;
    let ds = b.arc_length_m - a.arc_length_m;
    let f = if ds > 0.0 { ((s - a.arc_length_m) / ds).clamp(0.0, 1.0) } else { 1.0 };
    let mix = |x: f64, y: f64| x + (y - x) * f;
    Some(Node {
        arc_length_m: mix(a.arc_length_m, b.arc_length_m),
        x_m: mix(a.x_m, b.x_m),
        y_m: mix(a.y_m, b.y_m),
        tension_n: mix(a.tension_n, b.tension_n),
        ..*b
    })
}

/// A piece of band for the legend.
pub fn sample(painter: &Painter, palette: &Palette, rect: Rect, state: ContactState) {
    match state {
        ContactState::Stick => {
            painter.rect_filled(rect, 0.0, palette.normal);
        }
        ContactState::Slip => {
            let line = Stroke::new(HOLLOW_EDGE_WIDTH / 2.0, palette.friction);
            painter.rect(rect, 0.0, palette.background, line, StrokeKind::Inside);
        }
    }
    painter.rect_filled(Rect::from_center_size(rect.center(), vec2(rect.width(), 3.0)), 0.0, palette.casing);
}
