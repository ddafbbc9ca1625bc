//! Issue 20: a cable that its robot or a motion led out of the view was not to be seen any more.

use cable_core::Scene;
use cable_core::scene::{Motion, catalog};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, ViewCommand};
use cable_viewer::geometry::bounds;
use egui::{Key, Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

/// A span whose ends both go 30 m to the right in ten seconds.
fn led_away() -> Scene {
    let mut scene = catalog::hanging_span();
    for support in &mut scene.cables[0].supports {
        let at = support.at_m.unwrap();
        let points_m = vec![at, [at[0] + 30.0, at[1]]];
        support.motion = Some(Motion { times_s: vec![0.0, 10.0], points_m });
    }
    scene
}

fn play(harness: &mut Harness<'_, ViewerApp>) {
    apply(harness, Command::Playback(PlaybackCommand::SetPaused(false)));
}

/// The canvas, and what moves in it, on screen.
fn on_screen(harness: &Harness<'_, ViewerApp>) -> (Rect, Rect) {
    let canvas = harness.get_by_label("Canvas").rect();
    let state = &harness.state().state;
    let corners = bounds::moving(state).map(|p| state.view.camera.to_screen(canvas, p));
    (canvas, Rect::from_points(&corners))
}

#[test]
fn a_view_that_was_not_moved_widens_when_a_cable_is_led_out_of_it_and_a_reset_brings_it_back() {
    let mut robot = catalog::robot_drive();
    // Beyond the flags of its path, which the view shows anyway, goes only a hand.
    robot.robot.as_mut().unwrap().path.clear();
    for scene in [led_away(), robot] {
        let name = scene.name.clone();
        let mut harness = open(scene);
        let before = harness.state().state.view.camera;
        play(&mut harness);
        if harness.state().state.document.scene.robot.is_some() {
            apply(&mut harness, Command::Playback(PlaybackCommand::DriveRobot(Some(0.8))));
        }
        let mut scale = before.points_per_m;
        for k in 0..20 {
            harness.run_steps(30);
            let (canvas, moving) = on_screen(&harness);
            assert!(canvas.contains_rect(moving), "{name}, after {k} halves of a second: {moving} in {canvas}");
            let now = harness.state().state.view.camera.points_per_m;
            assert!(now <= scale && now > scale / 1.5, "{name}: calmly, {scale} to {now}");
            scale = now;
        }
        assert!(scale < 0.9 * before.points_per_m, "{name} went far: {scale} of {}", before.points_per_m);
        harness.key_press(Key::R);
        harness.run_steps(4);
        let camera = harness.state().state.view.camera;
        assert_eq!((camera.centre_m, camera.points_per_m), (before.centre_m, before.points_per_m), "{name}");
    }
}

#[test]
fn a_view_that_was_moved_is_left_alone_and_offers_to_follow_what_leads_the_cable() {
    let mut harness = open(led_away());
    apply(&mut harness, Command::View(ViewCommand::Pan(Vec2::new(20.0, 0.0))));
    let moved = harness.state().state.view.camera;
    play(&mut harness);
    assert!(harness.query_by_label("Follow the cable").is_none());
    harness.run_steps(480);
    let camera = harness.state().state.view.camera;
    assert_eq!((camera.centre_m, camera.points_per_m), (moved.centre_m, moved.points_per_m));
    harness.get_by_label("The moving end has left the view");
    harness.get_by_label("Follow the cable").click();
    for _ in 0..4 {
        harness.run_steps(20);
        let (canvas, moving) = on_screen(&harness);
        assert!(canvas.contains(moving.center()), "{moving} in {canvas}");
    }
    assert_eq!(harness.state().state.view.camera.points_per_m, moved.points_per_m, "as large as it was");
    assert!(harness.query_by_label("Follow the cable").is_none());
    // The user moved it out of view on purpose.
    apply(&mut harness, Command::View(ViewCommand::Pan(Vec2::new(0.0, 3000.0))));
    let camera = harness.state().state.view.camera;
    harness.run_steps(10);
    assert_eq!(harness.state().state.view.camera.centre_m, camera.centre_m);
    assert!(harness.query_by_label("Follow the cable").is_none());
}

/// The view goes with a cable that falls for ever, which does not become a dot.
#[test]
fn a_view_widens_no_further_than_the_cable_can_be_seen() {
    let mut scene = catalog::hanging_span();
    for support in &mut scene.cables[0].supports {
        support.release_s = Some(0.1);
    }
    let mut harness = open(scene);
    let before = harness.state().state.view.camera.points_per_m;
    play(&mut harness);
    harness.run_steps(420);
    let (canvas, moving) = on_screen(&harness);
    let camera = harness.state().state.view.camera;
    assert!(camera.points_per_m > before / 4.01, "{before} to {}", camera.points_per_m);
    let state = &harness.state().state;
    let lowest = state.live.latest.solution.as_ref().unwrap().cables[0].nodes.iter().map(|n| n.y_m).fold(0.0, f64::min);
    assert!(lowest < -150.0, "it fell {lowest} m");
    assert!(moving.intersects(canvas), "{moving} in {canvas}");
}
