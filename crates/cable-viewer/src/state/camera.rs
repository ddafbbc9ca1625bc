//! The camera turns metres of the world into points on screen and back, in f64 until the last step.

use cable_core::math::Point;
use egui::{Pos2, Rect, Vec2, pos2, vec2};

/// The camera is the point of the world in the middle of the canvas, and the size of a metre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World point in the middle of the canvas, m.
    pub centre_m: Point,
    /// Points (logical pixels) per metre.
    pub points_per_m: f64,
    /// Fit the scene at the next frame (the canvas size is not known before).
    pub fit_wanted: bool,
    /// Size of the canvas that the scene was fitted to, points, until the view is moved by hand.
    pub fitted_to: Option<[f32; 2]>,
    /// The view keeps the robot or support that leads a cable, or a torn piece, in sight, until the
    /// view is moved by hand.
    pub follows: bool,
    /// True if the robot or support that leads a cable has been in view since the view was moved by
    /// hand.
    pub leader_seen: bool,
    /// Scale at which the scene was fitted, points per metre, if the view has widened since.
    pub widened_from: Option<f64>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            centre_m: [0.0; 2],
            points_per_m: 50.0,
            fit_wanted: true,
            fitted_to: None,
            follows: false,
            leader_seen: false,
            widened_from: None,
        }
    }
}

/// Smallest and largest scale, points per metre. Beyond them f32 screen coordinates lose whole
/// pixels.
const SCALE: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// Free border of a fitted scene, points: left (axis numbers), right, top, bottom. Smaller: labels
/// cover the ends of the cable; larger: the window is wasted.
pub const BORDER: [f32; 4] = [70.0, 56.0, 40.0, 52.0];

/// Least room that a fitted scene gets beside its borders, points, and least size of a scene, m. A
/// choice, tuned on nothing: they keep the scale finite.
const MIN_FITTED_POINTS: f32 = 40.0;
const MIN_FITTED_SIZE_M: f64 = 1e-3;

/// Greatest factor by which a view of the scene widens when something leaves it. Larger: a cable
/// that falls for ever becomes a dot; smaller: a robot that drives far has its cable out of view.
const MAX_WIDENING: f64 = 4.0;

/// Most of the height of a fitted picture that the ground below everything takes. More: a third of
/// a wide picture is ground; less: a robot stands on the edge of the picture.
const MOST_GROUND: f32 = 0.15;

impl Camera {
    /// World (m) to screen.
    #[must_use]
    pub fn to_screen(&self, canvas: Rect, p: Point) -> Pos2 {
        let c = canvas.center();
        let x = f64::from(c.x) + (p[0] - self.centre_m[0]) * self.points_per_m;
        let y = f64::from(c.y) - (p[1] - self.centre_m[1]) * self.points_per_m;
        // Far outside points are kept finite and small enough for the tessellator.
        pos2(x.clamp(-1e6, 1e6) as f32, y.clamp(-1e6, 1e6) as f32)
    }

    /// Screen to world (m).
    #[must_use]
    pub fn to_world(&self, canvas: Rect, p: Pos2) -> Point {
        let c = canvas.center();
        [
            self.centre_m[0] + f64::from(p.x - c.x) / self.points_per_m,
            self.centre_m[1] - f64::from(p.y - c.y) / self.points_per_m,
        ]
    }

    /// Moves the view by as little as brings a rectangle (m) into the canvas within free borders
    /// (points), at the same scale, and returns whether it had to; what is larger than the canvas
    /// is centred.
    pub fn keep_in_view(&mut self, canvas: Rect, [low, high]: [Point; 2], border: [f32; 4]) -> bool {
        if !(low.iter().chain(&high).all(|v| v.is_finite()) && canvas.is_positive()) {
            return false;
        }
        let before = self.centre_m;
        let [left, right, top, bottom] = border.map(|points| f64::from(points) / self.points_per_m);
        let half = [canvas.width(), canvas.height()].map(|points| f64::from(points) / (2.0 * self.points_per_m));
        for (k, [under, over]) in [[left, right], [bottom, top]].into_iter().enumerate() {
            // The centre with the upper end at its border, and with the lower one.
            let (least, most) = (high[k] + over - half[k], low[k] - under + half[k]);
            self.centre_m[k] = if least > most { 0.5 * (least + most) } else { self.centre_m[k].clamp(least, most) };
        }
        self.centre_m != before
    }

    /// Moves the world with the pointer.
    pub fn pan(&mut self, delta: Vec2) {
        self.leave_fit();
        self.centre_m[0] -= f64::from(delta.x) / self.points_per_m;
        self.centre_m[1] += f64::from(delta.y) / self.points_per_m;
    }

    /// Scales by a factor; the world point `about_m` stays where it is on screen.
    pub fn zoom(&mut self, about_m: Point, factor: f64) {
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        self.leave_fit();
        let scale = (self.points_per_m * factor).clamp(*SCALE.start(), *SCALE.end());
        let k = self.points_per_m / scale;
        for i in 0..2 {
            self.centre_m[i] = about_m[i] + (self.centre_m[i] - about_m[i]) * k;
        }
        self.points_per_m = scale;
    }

    /// Puts a point (m) in the middle.
    pub fn centre_on(&mut self, p: Point) {
        self.leave_fit();
        self.centre_m = p;
    }

    /// Notes that the user moved the view: it is not fitted again, not even when an answer comes,
    /// and follows nothing.
    fn leave_fit(&mut self) {
        (self.fit_wanted, self.fitted_to, self.follows) = (false, None, false);
        (self.leader_seen, self.widened_from) = (false, None);
    }

    /// The part of the world in the canvas: lower left and upper right corner, m.
    #[must_use]
    pub fn visible_m(&self, canvas: Rect) -> [Point; 2] {
        [canvas.left_bottom(), canvas.right_top()].map(|p| self.to_world(canvas, p))
    }

    /// Widens a fitted view by as little as brings a rectangle (m) into the canvas within free
    /// borders (points), where what it shows now stays in it; returns whether the rectangle is in
    /// view then. The view is no more than `MAX_WIDENING` times as wide as it was fitted.
    pub fn widen(&mut self, canvas: Rect, [low, high]: [Point; 2], border: [f32; 4]) -> bool {
        let [left, right, top, bottom] = border;
        let free = Rect::from_min_max(canvas.min + vec2(left, top), canvas.max - vec2(right, bottom));
        if !(low.iter().chain(&high).all(|v| v.is_finite()) && free.is_positive()) {
            return true;
        }
        let [from, to] = self.visible_m(canvas);
        let [least, most] = [free.left_bottom(), free.right_top()].map(|p| self.to_world(canvas, p));
        // The tolerance is for rounding on the way to the screen and back.
        let tolerance_m = 1e-6 * (to[0] - from[0]);
        if (0..2).all(|k| low[k] >= least[k] - tolerance_m && high[k] <= most[k] + tolerance_m) {
            return true;
        }
        let before = *self;
        let fitted = self.widened_from.unwrap_or(self.points_per_m);
        let both = [0, 1].map(|k| (least[k].min(low[k]), most[k].max(high[k])));
        self.fit(canvas, [both.map(|(low, _)| low), both.map(|(_, high)| high)], border);
        if self.points_per_m * MAX_WIDENING < fitted {
            *self = before;
            return false;
        }
        self.widened_from = Some(fitted);
        true
    }

    /// Puts a world rectangle (least and greatest corner, m) in view, with free borders (points) as
    /// in [`BORDER`].
    pub fn fit(&mut self, canvas: Rect, [low, high]: [Point; 2], border: [f32; 4]) {
        self.fit_wanted = false;
        self.fitted_to = Some(canvas.size().into());
        self.widened_from = None;
        if !(low.iter().chain(&high).all(|v| v.is_finite()) && canvas.is_positive()) {
            return;
        }
        // In a small canvas the border shrinks before the scene does.
        let shrunk = |pair: [f32; 2], points: f32| pair.map(|b| b * (0.5 * points / (pair[0] + pair[1])).min(1.0));
        let [left, right] = shrunk([border[0], border[1]], canvas.width());
        let [top, bottom] = shrunk([border[2], border[3]], canvas.height());
        let scale_of = |axis: usize, points: f32, borders: f32| {
            f64::from((points - borders).max(MIN_FITTED_POINTS)) / (high[axis] - low[axis]).max(MIN_FITTED_SIZE_M)
        };
        let scale = scale_of(0, canvas.width(), left + right).min(scale_of(1, canvas.height(), top + bottom));
        self.points_per_m = scale.clamp(*SCALE.start(), *SCALE.end());
        // The middle of the part within the borders is not that of the canvas.
        self.centre_m = [
            0.5 * (low[0] + high[0]) + f64::from(right - left) / 2.0 / self.points_per_m,
            0.5 * (low[1] + high[1]) + f64::from(top - bottom) / 2.0 / self.points_per_m,
        ];
    }

    /// Moves the view up where more than `MOST_GROUND` of its height is below a height, m; what
    /// hints cover at the foot (points) does not count.
    pub fn hide_ground(&mut self, canvas: Rect, lowest_m: f64, hints_height: f32) {
        let most = (MOST_GROUND * canvas.height()).max(BORDER[3]) + hints_height;
        let half = 0.5 * f64::from(canvas.height()) / self.points_per_m;
        let bottom = lowest_m - f64::from(most) / self.points_per_m;
        if bottom.is_finite() && bottom > self.centre_m[1] - half {
            self.centre_m[1] = bottom + half;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Rect = Rect { min: pos2(200.0, 30.0), max: pos2(1000.0, 630.0) };

    #[test]
    fn screen_and_world_are_inverse_and_zoom_keeps_the_point_under_the_pointer() {
        let mut camera = Camera { centre_m: [3.0, -2.0], points_per_m: 37.0, fit_wanted: false, ..Camera::default() };
        let pointer = pos2(431.0, 222.0);
        let before = camera.to_world(CANVAS, pointer);
        assert!(camera.to_screen(CANVAS, before).distance(pointer) < 1e-3);
        for factor in [1.7, 0.2, 1e9, 1e-30, f64::NAN, 0.0] {
            camera.zoom(before, factor);
            assert!(camera.to_screen(CANVAS, before).distance(pointer) < 1e-2, "factor {factor}");
        }
    }

    #[test]
    fn a_fitted_scene_lies_inside_its_border() {
        let mut camera = Camera::default();
        for bounds in [[[0.0, 0.0], [10.0, 1.0]], [[-5.0, 100.0], [-4.0, 220.0]], [[2.0, 2.0], [2.0, 2.0]]] {
            camera.fit(CANVAS, bounds, BORDER);
            let free = Rect::from_min_max(CANVAS.min + egui::vec2(69.0, 39.0), CANVAS.max - egui::vec2(55.0, 51.0));
            for corner in bounds {
                assert!(free.contains(camera.to_screen(CANVAS, corner)), "{bounds:?}");
            }
        }
    }
}
