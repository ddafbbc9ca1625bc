//! What every layer paints with: the canvas rectangle, the camera, the colours.

use cable_core::math::Point;
use egui::{Align2, FontId, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use crate::camera::Camera;
use crate::theme::Palette;

/// One frame's picture.
pub struct View<'a> {
    /// The canvas.
    pub rect: Rect,
    /// What part of the world is in it.
    pub camera: Camera,
    /// Clipped to the canvas.
    pub painter: &'a Painter,
    /// Colours of the theme.
    pub palette: &'a Palette,
    /// Rectangles that labels must not cover.
    pub taken: Vec<Rect>,
}

impl View<'_> {
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

    /// A label on a plate near a point, where it covers nothing placed before; false if there is no room.
    pub fn label(&mut self, near: Pos2, text: &str, size: f32, colour: egui::Color32) -> bool {
        if !self.rect.expand(40.0).contains(near) {
            return false;
        }
        let galley = self.painter.layout_no_wrap(text.to_owned(), FontId::proportional(size), colour);
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
        ];
        for spot in spots {
            let rect = Rect::from_min_size(near + spot, plate);
            if self.rect.contains_rect(rect) && !self.taken.iter().any(|t| t.intersects(rect)) {
                self.painter.rect(
                    rect,
                    3.0,
                    self.palette.plate,
                    Stroke::new(1.0, self.palette.plate_line),
                    egui::StrokeKind::Inside,
                );
                self.painter.galley(rect.min + vec2(4.0, 2.0), galley, colour);
                self.taken.push(rect.expand(1.0));
                return true;
            }
        }
        false
    }

    /// Plain text; returns where it is.
    pub fn text(&self, at: Pos2, anchor: Align2, text: &str, size: f32, colour: egui::Color32) -> Rect {
        self.painter.text(pos2(at.x.round(), at.y.round()), anchor, text, FontId::proportional(size), colour)
    }
}
