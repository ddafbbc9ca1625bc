//! Every layer paints with a view: the canvas rectangle, the camera, the colours.

use cable_core::math::Point;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use crate::render::theme::Palette;
use crate::state::AppState;
use crate::state::camera::Camera;

/// Room for the hints of the first minute at the foot of the canvas, points: they must not lie over
/// the cable or the legend of the safe reach.
const HINTS_HEIGHT_POINTS: f32 = 46.0;

/// Returns the room that the hints take now, points.
#[must_use]
pub fn hints_height(state: &AppState) -> f32 {
    if state.ui.first_steps.open().is_empty() { 0.0 } else { HINTS_HEIGHT_POINTS }
}

/// One frame's picture.
pub struct CanvasView<'a> {
    /// The canvas.
    pub rect: Rect,
    /// The part of the world in the view.
    pub camera: Camera,
    /// Clipped to the canvas.
    pub painter: &'a Painter,
    /// Colours of the theme.
    pub palette: &'a Palette,
    /// Rectangles that labels must not cover.
    pub occupied: Vec<Rect>,
    /// Rectangles that labels should not cover if there is room elsewhere: the cable, arrows.
    pub avoided: Vec<Rect>,
}

/// A figure that waits for a place among the labels.
pub struct FigureLabel {
    /// The place that it belongs to.
    pub at: Pos2,
    /// What it says.
    pub text: String,
    /// Its colour.
    pub colour: Color32,
}

/// Points between two squares along a line that labels keep off.
const AVOIDED_SQUARE_SPACING: f32 = 7.0;

/// The right of a label to cover the cable or an arrow where there is no other room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelPriority {
    /// It may.
    Required,
    /// It is left out instead.
    Optional,
}

impl CanvasView<'_> {
    /// World (m) to screen.
    #[must_use]
    pub fn at(&self, p: Point) -> Pos2 {
        self.camera.to_screen(self.rect, p)
    }

    /// A length in metres, in points.
    #[must_use]
    pub fn points(&self, metres: f64) -> f32 {
        (metres * self.camera.points_per_m).min(1e6) as f32
    }

    /// An arrow from `tail` along `along` (points), with a filled head.
    pub fn arrow(&self, tail: Pos2, along: Vec2, stroke: Stroke) {
        let length = along.length();
        if !(length > 1.0) {
            return;
        }
        let (dir, head) = (along / length, (3.2 * stroke.width + 3.0).min(length));
        let tip = tail + along;
        let neck = tip - dir * head;
        let side = vec2(-dir.y, dir.x) * head * 0.42;
        self.painter.line_segment([tail, neck], stroke);
        self.painter.add(egui::Shape::convex_polygon(vec![tip, neck + side, neck - side], stroke.color, Stroke::NONE));
    }

    /// Labels placed later keep off an area on screen if they can, as much of it as there is of a
    /// line.
    pub fn avoid_area(&mut self, area: Rect) {
        let area = area.intersect(self.rect);
        if !area.is_positive() {
            return;
        }
        let rows = (area.height() / AVOIDED_SQUARE_SPACING).ceil().clamp(1.0, 100.0);
        for k in 0..=rows as usize {
            let y = area.min.y + area.height() * (k as f32 / rows);
            self.avoid_line(pos2(area.min.x, y), pos2(area.max.x, y));
        }
    }

    /// Labels placed later keep off a line on screen if they can.
    pub fn avoid_line(&mut self, a: Pos2, b: Pos2) {
        if !self.rect.intersects(Rect::from_two_pos(a, b)) {
            return;
        }
        let parts = ((b - a).length() / AVOIDED_SQUARE_SPACING).ceil().clamp(1.0, 400.0);
        for k in 0..=parts as usize {
            self.avoided.push(Rect::from_center_size(a + (b - a) * (k as f32 / parts), vec2(6.0, 6.0)));
        }
    }

    /// A label on a plate near a point, where it covers nothing placed before.
    pub fn label(&mut self, near: Pos2, text: &str, colour: egui::Color32, place: LabelPriority) {
        const SIZE: f32 = 11.5;
        if !self.rect.expand(40.0).contains(near) {
            return;
        }
        let galley = self.painter.layout_no_wrap(text.to_owned(), FontId::proportional(SIZE), colour);
        let plate = galley.size() + vec2(8.0, 4.0);
        let gap = 10.0;
        let (w, h) = (plate.x, plate.y);
        let spots = [
            vec2(gap, -gap - h),
            vec2(-gap - w, -gap - h),
            vec2(gap, gap),
            vec2(-gap - w, gap),
            vec2(-w / 2.0, -2.2 * gap - h),
            vec2(-w / 2.0, 2.2 * gap),
            vec2(3.0 * gap, -h / 2.0),
            vec2(-3.0 * gap - w, -h / 2.0),
            vec2(-w / 2.0, -4.5 * gap - h),
            vec2(2.0 * gap, -4.0 * gap - h),
            vec2(-2.0 * gap - w, -4.0 * gap - h),
            vec2(gap, 3.5 * gap),
            vec2(-gap - w, 3.5 * gap),
            vec2(gap, -7.0 * gap - h),
            vec2(-gap - w, -7.0 * gap - h),
        ];
        let rects = spots.map(|spot| Rect::from_min_size(near + spot, plate)).into_iter();
        let open: Vec<Rect> =
            rects.filter(|r| self.rect.contains_rect(*r) && !self.occupied.iter().any(|t| t.intersects(*r))).collect();
        let covered = |r: &Rect| self.avoided.iter().filter(|t| t.intersects(*r)).count();
        let Some((hidden, &rect)) = open.iter().map(|r| (covered(r), r)).min_by_key(|(hidden, _)| *hidden) else {
            return;
        };
        if hidden > 0 && place == LabelPriority::Optional {
            return;
        }
        let line = Stroke::new(1.0, self.palette.plate_line);
        self.painter.rect(rect, 3.0, self.palette.plate, line, egui::StrokeKind::Inside);
        self.painter.galley(rect.min + vec2(4.0, 2.0), galley, colour);
        self.occupied.push(rect.expand(1.0));
    }

    /// Plain text; returns where it is.
    pub fn text(&self, at: Pos2, anchor: Align2, text: &str, size: f32, colour: egui::Color32) -> Rect {
        self.painter.text(pos2(at.x.round(), at.y.round()), anchor, text, FontId::proportional(size), colour)
    }
}
