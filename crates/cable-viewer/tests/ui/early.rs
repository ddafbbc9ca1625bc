//! Issue 20: on a slow machine a click right after the window opened was lost.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{open, press};

fn play(harness: &Harness<'_, ViewerApp>) -> Pos2 {
    harness.get_by_label("Play").rect().center()
}

/// egui took a press for no click once it had lasted 0.8 s, and a frame may last longer.
#[test]
fn issue_020_a_click_counts_however_long_a_frame_takes() {
    let mut harness = open(catalog::tank_robot());
    let at = play(&harness);
    harness.hover_at(at);
    harness.step();
    harness.input_mut().time = Some(10.0);
    press(&harness, at, true);
    harness.step();
    harness.input_mut().time = Some(12.0);
    press(&harness, at, false);
    harness.step();
    assert!(!harness.state().state.live.playback.paused);
}

/// egui finds what a pointer is on among the widgets of the frame before: at the first frame there
/// are none.
#[test]
fn issue_020_a_click_before_the_first_frame_counts() {
    let at = play(&open(catalog::tank_robot()));
    let context = egui::Context::default();
    let mut app = ViewerApp::inline(&context, catalog::tank_robot(), None);
    let button =
        |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    let mut events = vec![Event::PointerMoved(at), button(true), button(false)];
    for k in 0..4 {
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(1280.0, 800.0)));
        let time = Some(f64::from(k) / 60.0);
        let input = RawInput { screen_rect, time, events: std::mem::take(&mut events), ..RawInput::default() };
        context.run_ui(input, |ui| app.frame(ui)).drop_without_applying_deltas();
    }
    assert!(!app.state.live.playback.paused);
}
