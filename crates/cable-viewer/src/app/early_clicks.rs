//! Clicks that come before the first frame wait for the second.
//!
//! egui finds what a pointer is on among the widgets of the frame before. A loaded machine draws
//! the first frame long after the window has opened, and whoever clicked in between clicked on
//! nothing.

use egui::{Context, Event, Plugin, RawInput, Ui};

/// Buttons of the pointer that were pressed or released before the first frame.
#[derive(Default)]
pub(super) struct EarlyClicks {
    held: Vec<Event>,
    /// True once a frame has begun.
    begun: bool,
}

impl Plugin for EarlyClicks {
    fn debug_name(&self) -> &'static str {
        "early clicks"
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        if !self.held.is_empty() {
            ui.ctx().request_repaint();
        }
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        let is_click = |event: &Event| matches!(event, Event::PointerButton { .. });
        if self.begun {
            input.events.splice(0..0, self.held.drain(..));
        } else {
            self.held = input.events.extract_if(.., |event| is_click(event)).collect();
            self.begun = true;
        }
    }
}
