//! Clicks that come before the first frame, or that are over within a frame, wait for the next.
//!
//! egui finds what a pointer is on among the widgets of the frame before. A loaded machine draws
//! the first frame long after the window has opened, and whoever clicked in between clicked on
//! nothing. A slider asks whether the button is down: the tap of a finger is shorter than a frame,
//! and passed it by.

use egui::{Context, Event, Plugin, RawInput, Ui};

/// The events that wait for the next frame.
#[derive(Default)]
pub(super) struct HeldClicks {
    late_events: Vec<Event>,
    /// True once a frame has begun.
    begun: bool,
}

impl Plugin for HeldClicks {
    fn debug_name(&self) -> &'static str {
        "held clicks"
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        if !self.late_events.is_empty() {
            ui.ctx().request_repaint();
        }
    }

    fn input_hook(&mut self, _: &Context, input: &mut RawInput) {
        let is_click = |event: &Event| matches!(event, Event::PointerButton { .. });
        if self.begun {
            input.events.splice(0..0, self.late_events.drain(..));
            if let Some(released) = release_after_press(&input.events) {
                self.late_events = input.events.split_off(released);
            }
        } else {
            self.late_events = input.events.extract_if(.., |event| is_click(event)).collect();
            self.begun = true;
        }
    }
}

/// The first event that releases a button pressed by one before it.
fn release_after_press(events: &[Event]) -> Option<usize> {
    let mut down = Vec::new();
    events.iter().position(|event| match event {
        Event::PointerButton { button, pressed: true, .. } => {
            down.push(*button);
            false
        }
        Event::PointerButton { button, pressed: false, .. } => down.contains(button),
        _ => false,
    })
}
