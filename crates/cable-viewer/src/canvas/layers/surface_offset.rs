//! A cable that is drawn thicker than it is looked sunk into what it lies on: where it is in
//! contact it is drawn beside its place, by as much as it is drawn too thick.

use cable_core::solution::{CableSolution, ContactReport, Node};
use egui::{Pos2, Vec2, vec2};

use crate::canvas::canvas_view::CanvasView;

/// Thinnest ribbon, points: the true diameter is drawn only where it is wider.
pub const MIN_WIDTH: f32 = 4.5;
/// Distance along the cable over which it comes back to its place beside a contact, points.
/// Shorter: a step is seen; longer: a cable that leaves the ground at once is drawn off its place.
const RAMP: f32 = 24.0;

/// The places of nodes on screen, off the surfaces that the cable is in contact with.
pub(super) fn places(view: &CanvasView<'_>, nodes: &[Node], cable: &CableSolution, diameter_m: f64) -> Vec<Pos2> {
    let points: Vec<Pos2> = nodes.iter().map(|n| view.at([n.x_m, n.y_m])).collect();
    let too_thick = 0.5 * (MIN_WIDTH - view.points(diameter_m));
    if !(too_thick > 0.0) {
        return points;
    }
    let ramp_m = f64::from(RAMP) / view.camera.points_per_m;
    // To the left of the cable (positive) or to the right, as a share of the whole shift.
    let mut shifts = vec![0.0_f32; nodes.len()];
    for contact in &cable.contacts {
        let [begins, ends] = contact.extent_m();
        let side = side(contact, cable);
        let from = nodes.partition_point(|n| n.arc_length_m < begins - ramp_m);
        for (shift, n) in shifts.iter_mut().zip(nodes).skip(from).take_while(|(_, n)| n.arc_length_m < ends + ramp_m) {
            let off = (begins - n.arc_length_m).max(n.arc_length_m - ends).max(0.0);
            let share = 1.0 - (off / ramp_m) as f32;
            if share > shift.abs() {
                *shift = side * share;
            }
        }
    }
    let left = |k: usize| {
        let (a, b) = (points[k.saturating_sub(1)], points[(k + 1).min(points.len() - 1)]);
        let along = (b - a).normalized();
        if along.is_finite() { vec2(along.y, -along.x) } else { Vec2::ZERO }
    };
    points.iter().zip(&shifts).enumerate().map(|(k, (p, s))| *p + left(k) * *s * too_thick).collect()
}

/// The side of the cable, looking along it, on which there is room: 1 on its left, −1 on its right.
/// It is that of the whole contact, also where the cable is wrapped about something.
fn side(contact: &ContactReport, cable: &CableSolution) -> f32 {
    let k = cable.nodes.partition_point(|n| n.arc_length_m < contact.arc_length_m);
    let (a, b) = (cable.nodes.get(k.saturating_sub(1)), cable.nodes.get(k + 1).or(cable.nodes.last()));
    let (Some(a), Some(b)) = (a, b) else { return 0.0 };
    let [x, y] = contact.normal;
    if x * (a.y_m - b.y_m) + y * (b.x_m - a.x_m) >= 0.0 { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use egui::{Context, LayerId, Painter, Rect};

    use super::*;
    use crate::render::theme;
    use crate::state::camera::Camera;

    /// Cables of 28 mm at 30 points to a metre had half of their width in the floor.
    #[test]
    fn the_lower_edge_of_a_cable_lies_on_the_floor_and_its_free_part_stays() {
        let ctx = Context::default();
        let rect = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(800.0, 600.0));
        let painter = Painter::new(ctx.clone(), LayerId::background(), rect);
        let palette = theme::palette(&egui::Visuals::dark());
        let camera = Camera { points_per_m: 30.0, ..Camera::default() };
        let (occupied, avoided) = (Vec::new(), Vec::new());
        let view = CanvasView { rect, camera, painter: &painter, palette, occupied, avoided };
        let radius_m = 0.014;
        for direction in [1.0, -1.0] {
            let node = |k: i32| {
                let arc_length_m = f64::from(k) * 0.1;
                Node { arc_length_m, x_m: direction * arc_length_m, y_m: radius_m, ..Node::default() }
            };
            let nodes: Vec<Node> = (0..=100).map(node).collect();
            let contact = ContactReport {
                arc_length_m: 2.0,
                begins_m: 0.0,
                ends_m: 4.0,
                normal: [0.0, 1.0],
                ..ContactReport::default()
            };
            let cable =
                CableSolution { nodes: nodes.clone().into(), contacts: vec![contact], ..CableSolution::default() };
            let drawn = places(&view, &nodes, &cable, 2.0 * radius_m);
            let floor = view.at([0.0, 0.0]).y;
            for (p, n) in drawn.iter().zip(&nodes).filter(|(_, n)| n.arc_length_m <= 4.0) {
                assert!((p.y + 0.5 * MIN_WIDTH - floor).abs() < 1e-3, "{} m: {} of {floor}", n.arc_length_m, p.y);
            }
            for (p, n) in drawn.iter().zip(&nodes).filter(|(_, n)| n.arc_length_m > 5.0) {
                assert_eq!(*p, view.at([n.x_m, n.y_m]));
            }
            // As thick as it is, it is drawn where it is.
            let thick = places(&view, &nodes, &cable, 0.4);
            assert_eq!(thick[10], view.at([nodes[10].x_m, nodes[10].y_m]));
        }
    }
}
