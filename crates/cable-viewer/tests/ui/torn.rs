//! A cable that is torn off at both ends fell out of the picture.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, SceneCommand, ViewCommand};
use egui::{Key, Modifiers, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

/// A span that breaks at both of its ends as soon as time runs.
fn weak() -> Harness<'static, ViewerApp> {
    let mut scene = catalog::hanging_span();
    (scene.cables[0].breaking_tension_n, scene.cables[0].service_tension_n) = (30.0, 20.0);
    scene.cables[0].breaking_time_s = 0.0;
    open(scene)
}

/// The place of the longest piece of the cable on screen.
fn piece(harness: &Harness<'_, ViewerApp>) -> (Rect, Rect) {
    let canvas = harness.get_by_label("Canvas").rect();
    let state = &harness.state().state;
    let solution = state.live.snapshot.solution.as_ref().unwrap();
    let longest = solution.cables[0].pieces().max_by_key(|p| p.len()).unwrap();
    let points: Vec<egui::Pos2> = longest.iter().map(|n| state.view.camera.to_screen(canvas, [n.x_m, n.y_m])).collect();
    (canvas, Rect::from_points(&points))
}

/// The middle of the view, m, and its scale.
fn place(harness: &Harness<'_, ViewerApp>) -> ([f64; 2], f64) {
    let camera = harness.state().state.view.camera;
    (camera.centre_m, camera.points_per_m)
}

fn ends_in_view(harness: &Harness<'_, ViewerApp>) -> bool {
    let canvas = harness.get_by_label("Canvas").rect();
    let camera = harness.state().state.view.camera;
    [[0.0, 5.0], [10.0, 5.0]].iter().all(|p| canvas.contains(camera.to_screen(canvas, *p)))
}

#[test]
fn a_view_that_was_not_moved_follows_what_falls_and_a_reset_brings_it_back() {
    let mut harness = weak();
    let scale = harness.state().state.view.camera.points_per_m;
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    for k in 0..12 {
        harness.run_steps(15);
        let (canvas, piece) = piece(&harness);
        assert!(canvas.contains(piece.center()), "after {k} quarters of a second: {piece} in {canvas}");
    }
    let solution = harness.state().state.live.snapshot.solution.clone().unwrap();
    assert!(!solution.cables[0].breaks.is_empty());
    assert!(!ends_in_view(&harness), "it fell far: {} s", solution.time_s);
    assert_eq!(harness.state().state.view.camera.points_per_m, scale, "as large as it was");
    apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    harness.run_steps(4);
    assert!(ends_in_view(&harness));
}

/// After a break a reset could not be undone: the recording was back, with a refusal in a dialog,
/// and what the solver held was the start.
#[test]
fn a_reset_after_a_break_is_taken_back_whole() {
    let mut harness = weak();
    harness.key_press(Key::Space);
    harness.run_steps(60);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let shown = |harness: &Harness<'_, ViewerApp>| harness.state().state.live.snapshot.solution.clone().unwrap();
    let (end, span) = (shown(&harness), harness.state().state.live.recording.span_s());
    assert!(!end.cables[0].breaks.is_empty());
    // Twice: the second reset of a run that stands at its start changes nothing.
    for _ in 0..2 {
        harness.key_press(Key::R);
        harness.run_steps(3);
        assert!(shown(&harness).time_s == 0.0 && shown(&harness).cables[0].breaks.is_empty());
    }
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    let state = &harness.state().state;
    assert!(state.ui.dialog.is_none(), "{:?}", state.ui.dialog);
    assert_eq!((state.live.recording.span_s(), state.live.recording.shown_s), (span, None), "the present is shown");
    assert_eq!(*shown(&harness), *end, "bit for bit");
    // Time goes on as if nobody had asked for a reset.
    let mut straight = weak();
    straight.key_press(Key::Space);
    straight.run_steps(60);
    straight.key_press(Key::Space);
    straight.run_steps(2);
    for harness in [&mut harness, &mut straight] {
        harness.key_press(Key::Space);
        harness.run_steps(20);
    }
    assert!(shown(&harness).time_s > end.time_s);
    assert_eq!(shown(&harness).cables, shown(&straight).cables);
}

/// An edit after a reset belonged to the run that the undo of the reset brought back.
#[test]
fn the_undo_of_a_reset_brings_its_scene_back_too() {
    let mut harness = open(catalog::hanging_span());
    harness.key_press(Key::Space);
    harness.run_steps(30);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let (scene, end_s) = {
        let state = &harness.state().state;
        (state.document.scene.clone(), state.live.now_s())
    };
    harness.key_press(Key::R);
    harness.run_steps(3);
    let mut cable = scene.cables[0].clone();
    cable.length_m += 0.5;
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    harness.get_by_label("Previous run").click();
    harness.run_steps(3);
    let state = &harness.state().state;
    assert_eq!((&state.document.scene, state.live.now_s()), (&scene, end_s));
    assert_eq!(state.live.latest.scene.as_deref(), Some(&scene));
    assert_eq!(state.freshness(), cable_viewer::state::Freshness::Current);
}

/// To take a reset back dropped what had run since.
#[test]
fn the_run_since_a_reset_is_kept_when_it_is_taken_back() {
    let mut harness = weak();
    let run = |harness: &mut Harness<'_, ViewerApp>, frames: usize| {
        harness.key_press(Key::Space);
        harness.run_steps(frames);
        harness.key_press(Key::Space);
        harness.run_steps(2);
        (harness.state().state.live.snapshot.solution.clone().unwrap(), harness.state().state.live.recording.span_s())
    };
    let first = run(&mut harness, 60);
    harness.key_press(Key::R);
    harness.run_steps(3);
    let second = run(&mut harness, 20);
    assert_ne!(first, second);
    for (button, then) in [("Undo restart", &first), ("Previous run", &second), ("Previous run", &first)] {
        harness.get_by_label(button).click();
        harness.run_steps(3);
        let live = &harness.state().state.live;
        assert_eq!((&live.snapshot.solution, live.recording.span_s()), (&Some(then.0.clone()), then.1));
    }
}

#[test]
fn a_view_that_was_moved_is_left_alone_and_offers_to_follow() {
    let mut harness = weak();
    apply(&mut harness, Command::View(ViewCommand::Pan(Vec2::new(20.0, 0.0))));
    let before = place(&harness);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    assert!(harness.query_by_label("Follow the cable").is_none());
    harness.run_steps(180);
    assert_eq!(place(&harness), before);
    harness.get_by_label("Follow the cable").click();
    harness.run_steps(3);
    let (canvas, fallen) = piece(&harness);
    assert!(canvas.contains(fallen.center()), "{fallen} in {canvas}");
    harness.run_steps(60);
    let (_, fallen) = piece(&harness);
    assert!(canvas.contains(fallen.center()), "it is followed: {fallen} in {canvas}");
    // The hand that moves the view has it.
    apply(&mut harness, Command::View(ViewCommand::Pan(Vec2::new(0.0, 3000.0))));
    let before = place(&harness);
    harness.run_steps(10);
    assert_eq!(place(&harness), before);
}
