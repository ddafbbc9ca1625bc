//! A slider is fine about the value that it has: dragged by its knob, a point of movement changes
//! the value by the same fraction wherever it stands, and by more the farther the pointer goes.

use egui::emath::smart_aim::best_in_range_f64;
use egui::{Response, SliderClamping, Ui};

/// The range of a slider.
#[derive(Clone, Copy, Debug)]
pub struct SliderRange {
    /// Values at its ends.
    pub ends: [f64; 2],
    /// Even steps are even factors.
    pub logarithmic: bool,
}

/// The outcome of a slider in this frame.
#[derive(Debug)]
pub struct SliderOutput {
    /// A new value.
    pub value: Option<f64>,
    /// The knob was let go of or the keyboard left it.
    pub done: bool,
    /// The slider itself.
    pub response: Response,
}

/// Change by a point of movement beside the place where the knob was taken: a fraction of the value
/// on a logarithmic rail. More: a hand cannot set 10.8 m; less: an order of magnitude is further
/// than the edge of the screen.
pub const VALUE_FRACTION_PER_POINT: f64 = 0.005;
/// As [`VALUE_FRACTION_PER_POINT`], a fraction of the whole rail on a linear one.
pub const RANGE_FRACTION_PER_POINT: f64 = 0.002;
/// Points of movement over which a point comes to do twice as much.
const DOUBLING_DISTANCE_POINTS: f64 = 10.0;
/// Fraction of the movement that is left while Shift is held.
const SHIFT_KEY_MOVEMENT_FRACTION: f64 = 0.1;
/// Rest of the hand after which movement is fine again about where the value is, s. Less: a slow
/// hand never gets far; more: who overshot waits.
const POINTER_REST_S: f64 = 0.3;
/// Smallest value above zero that a logarithmic slider from zero resolves, as a fraction of its
/// top.
const MIN_LOG_FRACTION: f64 = 1e-4;

/// Says what a drag does, for the hover text.
pub fn drag_help(logarithmic: bool) -> String {
    let (fraction, of) =
        if logarithmic { (VALUE_FRACTION_PER_POINT, "the value") } else { (RANGE_FRACTION_PER_POINT, "the range") };
    format!(
        "Drag the knob: {:.1} % of {of} per screen point at first, faster the farther you drag; hold Shift for a tenth of that. Click the track to jump there",
        1e2 * fraction
    )
}

/// The place from which a drag is counted.
#[derive(Clone, Copy, Debug, Default)]
struct DragAnchor {
    value: f64,
    /// Place of the pointer then, points.
    pointer_x: f32,
    fine: bool,
    /// Last place of the pointer, and the time at which it last moved, s.
    last: (f32, f64),
}

impl SliderRange {
    /// The least value above zero that is told from zero.
    fn least(self) -> f64 {
        if self.ends[0] > 0.0 { self.ends[0] } else { MIN_LOG_FRACTION * self.ends[1] }
    }

    /// Place of a value on the rail, from 0 to 1.
    fn share(self, value: f64) -> f64 {
        let [low, high] = self.ends;
        let share = if self.logarithmic {
            (value.max(self.least()) / self.least()).ln() / (high / self.least()).ln()
        } else {
            (value - low) / (high - low)
        };
        share.clamp(0.0, 1.0)
    }

    /// The value after a movement of so many points from where it was `from`. A typed value outside
    /// the ends is not drawn in by a touch.
    fn moved(self, from: f64, points: f64) -> f64 {
        let [low, high] = self.ends;
        let way = points * (1.0 + points.abs() / (2.0 * DOUBLING_DISTANCE_POINTS));
        let value = if self.logarithmic {
            let value = from.max(self.least()) * (VALUE_FRACTION_PER_POINT * way).exp();
            if low <= 0.0 && value < self.least() { low } else { value }
        } else {
            from + RANGE_FRACTION_PER_POINT * (high - low) * way
        };
        value.clamp(low.min(from), high.max(from))
    }
}

/// Draws it over the width that sliders have here; `value` is what it stands at.
pub fn ui(ui: &mut Ui, value: f64, rail: SliderRange) -> SliderOutput {
    let [low, high] = rail.ends;
    let value = if value.is_finite() { value } else { low };
    // Keys and screen readers, and a press on the rail, ask for a value; the knob stays at its own.
    let mut asked = None;
    let widget = egui::Slider::from_get_set(low..=high, |new| {
        asked = new.filter(|v| *v != value).or(asked);
        value
    });
    let widget = widget.show_value(false).clamping(SliderClamping::Edits).logarithmic(rail.logarithmic);
    let response = ui.add(widget.smallest_positive(MIN_LOG_FRACTION * high));
    // Also in the frame in which it is let go of.
    let value = if response.interact_pointer_pos().is_some() {
        dragged(ui, &response, value, rail, asked)
    } else {
        ui.data_mut(|d| d.remove_temp::<DragAnchor>(response.id));
        asked
    };
    SliderOutput { value, done: response.drag_stopped() || response.lost_focus(), response }
}

/// The value while a pointer holds the slider; `asked`: what is below the pointer on the rail.
fn dragged(ui: &Ui, response: &Response, value: f64, rail: SliderRange, asked: Option<f64>) -> Option<f64> {
    let x = response.interact_pointer_pos()?.x;
    let (now_s, fine, pressed) = ui.input(|i| (i.time, i.modifiers.shift, i.pointer.press_origin()));
    let known = ui.data(|d| d.get_temp::<DragAnchor>(response.id)).filter(|_| !response.drag_started());
    let mut anchor = if let Some(anchor) = known {
        anchor
    } else {
        let radius = 0.5 * response.rect.height();
        let run = response.rect.width() - 2.0 * radius;
        let knob = response.rect.left() + radius + rail.share(value) as f32 * run;
        // A slow frame shows the pointer where it has gone to since.
        let from = pressed.map_or(x, |p| p.x);
        if (from - knob).abs() > radius {
            let value = asked.unwrap_or(value);
            ui.data_mut(|d| d.insert_temp(response.id, DragAnchor { value, pointer_x: x, fine, last: (x, now_s) }));
            return asked;
        }
        DragAnchor { value, pointer_x: from, fine, last: (from, now_s) }
    };
    let (last_x, moved_s) = anchor.last;
    if fine != anchor.fine || (x != last_x && now_s - moved_s > POINTER_REST_S) {
        anchor = DragAnchor { value, pointer_x: last_x, fine, ..anchor };
    }
    let points = f64::from(x - anchor.pointer_x) * if fine { SHIFT_KEY_MOVEMENT_FRACTION } else { 1.0 };
    let half = 0.5 * if fine { SHIFT_KEY_MOVEMENT_FRACTION } else { 1.0 };
    let moves = x != last_x;
    anchor.last = (x, if moves { now_s } else { moved_s });
    ui.data_mut(|d| d.insert_temp(response.id, anchor));
    if !moves {
        return None;
    }
    if x == anchor.pointer_x {
        return Some(anchor.value);
    }
    // The roundest number that a point of movement covers.
    let [from, to] = [points - half, points + half].map(|p| rail.moved(anchor.value, p));
    Some(best_in_range_f64(from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: SliderRange = SliderRange { ends: [0.5, 200.0], logarithmic: true };

    #[test]
    fn a_point_of_movement_is_the_stated_fraction_of_any_value() {
        for value in [0.6, 10.8, 150.0] {
            let moved = LENGTH.moved(value, 1.0) / value - 1.0;
            assert!((moved - VALUE_FRACTION_PER_POINT).abs() < 0.1 * VALUE_FRACTION_PER_POINT, "{value}: {moved}");
        }
        let friction = SliderRange { ends: [0.0, 1.5], logarithmic: false };
        assert!(
            (friction.moved(0.4, -1.0) - 0.4 + 1.5 * RANGE_FRACTION_PER_POINT).abs()
                < 0.1 * 1.5 * RANGE_FRACTION_PER_POINT
        );
    }

    #[test]
    fn the_ends_are_within_reach_of_a_hand_and_zero_is_one() {
        assert_eq!((LENGTH.moved(10.8, 130.0), LENGTH.moved(10.8, -130.0)), (200.0, 0.5));
        let stiffness = SliderRange { ends: [0.0, 100.0], logarithmic: true };
        assert_eq!(stiffness.moved(1.0, -130.0), 0.0);
        assert!(stiffness.moved(0.0, 3.0) > 0.0);
        // A typed value beyond the end goes down from where it is.
        assert!((300.0 * 0.98..300.0).contains(&LENGTH.moved(300.0, -2.0)));
        assert_eq!(LENGTH.moved(300.0, 2.0), 300.0);
    }
}
