//! The grid is drawn with axes, numbers and units, and a scale bar.

use egui::{Align2, Rect, Stroke, pos2, vec2};

use crate::canvas::canvas_view::CanvasView;
use crate::state::camera::Camera;
use crate::units::labels;

/// Least distance of numbered lines, points: closer and their numbers touch.
const MIN_SPACING: f64 = 64.0;
/// Width of the strip with the y numbers, and height of the one with the x numbers, points.
pub const STRIP: [f32; 2] = [46.0, 20.0];

/// Distance of numbered lines (1, 2 or 5 times a power of ten) and of the thin ones between, m.
#[must_use]
pub fn steps(camera: &Camera) -> [f64; 2] {
    // Round in the unit shown.
    let (_, unit_m) = labels::of_length();
    let least = MIN_SPACING / (camera.points_per_m * unit_m);
    let power = 10f64.powf(least.log10().floor());
    let (factor, parts) = [(1.0, 5.0), (2.0, 4.0), (5.0, 5.0), (10.0, 5.0)]
        .into_iter()
        .find(|(f, _)| f * power >= least)
        .unwrap_or((10.0, 5.0));
    [factor * power * unit_m, factor * power / parts * unit_m]
}

/// Draws the grid lines behind all other layers.
pub fn lines(view: &CanvasView<'_>) {
    let [major, minor] = steps(&view.camera);
    for (step, colour) in [(minor, view.palette.grid_minor), (major, view.palette.grid_major)] {
        each(view, 0, step, |x, zero| {
            let colour = if zero { view.palette.grid_zero } else { colour };
            view.painter.vline(x.round() + 0.5, view.rect.y_range(), Stroke::new(1.0, colour));
        });
        each(view, 1, step, |y, zero| {
            let colour = if zero { view.palette.grid_zero } else { colour };
            view.painter.hline(view.rect.x_range(), y.round() + 0.5, Stroke::new(1.0, colour));
        });
    }
}

/// Calls back with the screen coordinate of each multiple of `step`, and whether it is zero.
fn each(view: &CanvasView<'_>, axis: usize, step: f64, mut line: impl FnMut(f32, bool)) {
    numbered(view, axis, step, |at, value| line(at, value.abs() < 0.5 * step));
}

/// Calls `line` with the position (points) and the value (m) of each grid line of an axis.
fn numbered(view: &CanvasView<'_>, axis: usize, step: f64, mut line: impl FnMut(f32, f64)) {
    let a = view.camera.to_world(view.rect, view.rect.left_bottom())[axis];
    let b = view.camera.to_world(view.rect, view.rect.right_top())[axis];
    let (first, last) = ((a / step).ceil(), (b / step).floor());
    // A view far from the origin has more digits than f64; then there is nothing to number.
    if !(last - first < 1000.0 && first.abs() < 1e12) {
        return;
    }
    let mut k = first;
    while k <= last {
        let value = k * step;
        let p = view.at(if axis == 0 { [value, view.camera.centre_m[1]] } else { [view.camera.centre_m[0], value] });
        line(if axis == 0 { p.x } else { p.y }, value);
        k += 1.0;
    }
}

/// Draws the numbers along the left and lower edge, on strips above all other layers.
pub fn axes(view: &mut CanvasView<'_>) {
    let [major, _] = steps(&view.camera);
    let (length, _) = labels::of_length();
    let (rect, palette) = (view.rect, view.palette);
    let left = Rect::from_min_max(rect.min, pos2(rect.min.x + STRIP[0], rect.max.y));
    let below = Rect::from_min_max(pos2(rect.min.x, rect.max.y - STRIP[1]), rect.max);
    for strip in [left, below] {
        view.painter.rect_filled(strip, 0.0, palette.plate);
    }
    let edge = Stroke::new(1.0, palette.grid_zero);
    view.painter.vline(left.max.x, rect.y_range(), edge);
    view.painter.hline(rect.x_range(), below.min.y, edge);
    numbered(view, 0, major, |x, value| {
        // The first and last places belong to the y strip and to the title.
        if x > left.max.x + 4.0 && x < rect.max.x - 44.0 {
            view.painter.vline(x.round() + 0.5, below.min.y..=below.min.y + 4.0, edge);
            let text = labels::coordinate(value, major);
            view.text(pos2(x, below.min.y + 4.0), Align2::CENTER_TOP, &text, 11.0, palette.weak_text);
        }
    });
    numbered(view, 1, major, |y, value| {
        if y > rect.min.y + 26.0 && y < below.min.y - 6.0 {
            view.painter.hline(left.max.x - 4.0..=left.max.x, y.round() + 0.5, edge);
            let text = labels::coordinate(value, major);
            view.text(pos2(left.max.x - 6.0, y), Align2::RIGHT_CENTER, &text, 11.0, palette.weak_text);
        }
    });
    view.text(
        pos2(rect.max.x - 6.0, below.min.y + 4.0),
        Align2::RIGHT_TOP,
        &format!("x ({length})"),
        11.0,
        palette.text,
    );
    view.text(pos2(left.min.x + 6.0, rect.min.y + 6.0), Align2::LEFT_TOP, &format!("y ({length})"), 11.0, palette.text);
    view.occupied.extend([left, below]);
}

/// A bar of a round length, in the lower right corner.
pub fn scale_bar(view: &mut CanvasView<'_>) {
    let [major, _] = steps(&view.camera);
    let width = view.points(major);
    let end = pos2(view.rect.max.x - 16.0, view.rect.max.y - STRIP[1] - 14.0);
    let begin = end - vec2(width, 0.0);
    let stroke = Stroke::new(2.0, view.palette.text);
    view.painter.line_segment([begin, end], stroke);
    for p in [begin, end] {
        view.painter.vline(p.x, p.y - 4.0..=p.y + 4.0, stroke);
    }
    let text = format!("{} {}", labels::coordinate(major, major), labels::of_length().0);
    let middle = pos2(0.5 * (begin.x + end.x), begin.y - 4.0);
    let rect = view.text(middle, Align2::CENTER_BOTTOM, &text, 11.0, view.palette.text);
    view.occupied.push(rect.union(Rect::from_two_pos(begin, end)).expand(4.0));
}
