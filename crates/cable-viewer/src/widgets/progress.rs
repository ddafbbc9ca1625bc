//! A bar for something that is being computed, with the share done in it.

use egui::{ProgressBar, Response, Ui};

use crate::render::theme;

/// Height, points: one line of text fits.
const HEIGHT: f32 = 16.0;

/// Draws one; `share` is from 0 to 1.
pub fn bar(ui: &mut Ui, share: f64) -> Response {
    let fill = theme::palette(ui.visuals()).bars[0];
    ui.add(ProgressBar::new(share as f32).text(format!("{:.0} %", 100.0 * share)).desired_height(HEIGHT).fill(fill))
}
