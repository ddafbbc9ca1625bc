//! A graph that has the focus, by keys: arrows move the last cursor, or set one; with shift the
//! part in view; up and down zoom about the cursor. Enter sets another cursor, as a click does.

use egui::{EventFilter, Key, Modifiers};
use egui_plot::PlotUi;

/// Zoom by one key: three presses double the scale.
const ZOOM: f64 = 1.26;
/// Share of the part in view by which an arrow key moves it.
const PAN: f64 = 0.125;
/// Share of the part in view by which an arrow key moves a cursor: held down, it crosses the graph
/// in a few seconds.
const STEP: f64 = 0.01;

/// The edits that keys ask of a graph.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KeyInput {
    /// The part in view was changed.
    pub zoomed: bool,
    /// The place where the last cursor is to be, in the unit of the axis.
    pub cursor: Option<f64>,
    /// The place where the next cursor is set by Enter, in the unit of the axis.
    pub next: f64,
}

/// Reads them; `last`: where the last cursor is, in the unit of the axis.
pub fn read(plot: &mut PlotUi<'_>, last: Option<f64>) -> KeyInput {
    let bounds = plot.plot_bounds();
    let [left, right] = [bounds.min()[0], bounds.max()[0]];
    let width = right - left;
    let at = last.filter(|x| (left..=right).contains(x)).unwrap_or(0.5 * (left + right));
    let mut asked = KeyInput { next: at, ..KeyInput::default() };
    if !plot.response().has_focus() {
        return asked;
    }
    let (ctx, id) = (plot.ctx().clone(), plot.response().id);
    let filter = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ctx.memory_mut(|m| m.set_focus_lock_filter(id, filter));
    let pressed = |modifiers, key| ctx.input_mut(|i| i.consume_key(modifiers, key));
    // Those with shift first: a plain arrow is found in them.
    let mut shown = [left, right];
    for (key, by) in [(Key::ArrowLeft, -PAN), (Key::ArrowRight, PAN)] {
        if pressed(Modifiers::SHIFT, key) {
            shown = shown.map(|x| x + by * width);
        }
    }
    for (key, by) in [(Key::ArrowLeft, -STEP), (Key::ArrowRight, STEP)] {
        if pressed(Modifiers::NONE, key) {
            // The first press sets one where it is seen.
            let place = if last.is_some() { at + by * width } else { at };
            asked.cursor = Some(place.clamp(left, right));
        }
    }
    for (key, factor) in [(Key::ArrowUp, ZOOM), (Key::ArrowDown, 1.0 / ZOOM)] {
        if pressed(Modifiers::NONE, key) {
            shown = shown.map(|x| at + (x - at) / factor);
        }
    }
    if shown != [left, right] {
        plot.set_plot_bounds_x(shown[0]..=shown[1]);
        asked.zoomed = true;
    }
    asked
}
