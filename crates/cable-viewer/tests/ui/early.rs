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

/// The tap of a finger is over within a frame, and a slider that asks whether the button is down
/// never saw it.
#[test]
fn a_tap_on_the_rail_of_a_slider_or_of_the_timeline_moves_it() {
    let mut harness = open(catalog::tank_robot());
    harness.key_press(egui::Key::Space);
    harness.run_steps(60);
    harness.key_press(egui::Key::Space);
    harness.run_steps(2);
    let end_s = harness.state().state.live.now_s();
    for label in ["Timeline", "Speed slider"] {
        let rail = harness.get_by_label(label).rect();
        let at = rail.left_center() + Vec2::new(0.4 * rail.width(), 0.0);
        harness.hover_at(at);
        harness.step();
        let events = [true, false].map(|pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.input_mut().events.extend(events);
        harness.run_steps(4);
    }
    let live = &harness.state().state.live;
    let shown_s = live.recording.shown_s.expect("an earlier time is shown");
    assert!(shown_s > 0.3 * end_s && shown_s < 0.5 * end_s, "{shown_s} of {end_s}");
    assert!(live.playback.speed < 0.2, "{}", live.playback.speed);
}
