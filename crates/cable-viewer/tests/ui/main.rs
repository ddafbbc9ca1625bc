//! These tests drive the window as a user would, without a display. The worker runs inline: one
//! frame, one answer.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod contrast;
mod controls;
mod defects;
mod early;
mod editing;
mod exported_picture;
mod first_minute;
mod gallery;
mod gpu;
mod graphs;
mod hands;
mod help;
mod job;
mod keys;
mod layers;
mod layout;
mod leaving;
mod outline;
mod pauses;
mod pictures;
mod playing;
mod precision;
mod pulling;
mod quality;
mod reach;
mod recovery;
mod rows;
mod runs;
mod seen;
mod session;
mod sliders;
mod spans;
mod speed;
mod steps;
mod stories;
mod timing;
mod tools;
mod torn;
mod truth;
mod units;
mod walk;
mod warnings;
mod wishes;
mod words;

use cable_core::scene::{Shape, catalog};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, ViewCommand};
use cable_viewer::state::Item;
use egui::{Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// The tank with a cable that can touch itself: its free bends are judged as those of a flexible
/// line, and one of them is a kink.
fn kinked_tank() -> cable_core::Scene {
    let mut scene = catalog::tank();
    scene.cables[0].self_contact = true;
    scene
}

fn open(scene: cable_core::Scene) -> Harness<'static, ViewerApp> {
    let mut harness = Harness::builder()
        .with_size(Vec2::new(1280.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .build_eframe(|cc| ViewerApp::inline(&cc.egui_ctx, scene, None));
    harness.run_steps(5);
    harness
}

/// With a model that answers any span, whatever `auto` would choose.
fn open_span() -> Harness<'static, ViewerApp> {
    let mut harness = open(catalog::hanging_span());
    apply(&mut harness, Command::SetModel(cable_core::Model::Fem));
    harness
}

fn press(harness: &Harness<'_, ViewerApp>, at: Pos2, pressed: bool) {
    harness.event(egui::Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    });
}

/// Press, move in steps, release; a frame between each.
fn drag(harness: &mut Harness<'_, ViewerApp>, from: Pos2, by: Vec2) {
    harness.hover_at(from);
    harness.step();
    press(harness, from, true);
    harness.step();
    for k in 1..=4 {
        harness.hover_at(from + by * (k as f32 / 4.0));
        harness.step();
    }
    press(harness, from + by, false);
    harness.run_steps(2);
}

fn support(harness: &Harness<'_, ViewerApp>, name: &str) -> Pos2 {
    harness.get_by_label(&format!("Support {name} of cable")).rect().center()
}

/// Opens the form of a thing.
fn select(harness: &mut Harness<'_, ViewerApp>, item: Item) {
    apply(harness, Command::View(ViewCommand::Select(Some(item))));
}

fn apply(harness: &mut Harness<'_, ViewerApp>, command: Command) {
    let ctx = harness.ctx.clone();
    harness.state_mut().apply(&ctx, vec![command]);
    harness.run_steps(2);
}

#[test]
fn u13_dragging_an_end_moves_the_support_and_the_cable_follows() {
    let mut harness = open_span();
    let scale = harness.state().state.view.camera.points_per_m;
    let before = harness.state().state.document.scene.cables[0].supports[1].at_m.unwrap();
    let from = support(&harness, "right");
    drag(&mut harness, from, Vec2::new(-60.0, -40.0));

    let state = &harness.state().state;
    let after = state.document.scene.cables[0].supports[1].at_m.unwrap();
    assert!((after[0] - before[0] + 60.0 / scale).abs() < 0.5 / scale, "{before:?} {after:?}");
    assert!((after[1] - before[1] - 40.0 / scale).abs() < 0.5 / scale, "{before:?} {after:?}");
    let solution = state.live.snapshot.solution.as_ref().expect("an answer");
    let end = solution.cables[0].nodes.last().unwrap();
    assert!((end.x_m - after[0]).hypot(end.y_m - after[1]) < 1e-6, "the cable's end is at ({}, {})", end.x_m, end.y_m);
    assert_eq!(state.selection.selected, Some(Item::Support { cable: 0, support: 1 }));
    assert!(state.document.unsaved() && state.selection.grab.is_none());

    // The whole drag is one entry.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(harness.state().state.document.scene.cables[0].supports[1].at_m, Some(before));
}

#[test]
fn u06_double_click_on_the_cable_adds_a_waypoint_and_delete_removes_it() {
    let mut harness = open_span();
    let node = {
        let solution = harness.state().state.live.snapshot.solution.clone().expect("an answer");
        solution.cables[0].nodes[solution.cables[0].nodes.len() / 2]
    };
    let canvas = harness.get_by_label("Canvas").rect();
    let at = harness.state().state.view.camera.to_screen(canvas, [node.x_m, node.y_m]);
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false, true, false] {
        press(&harness, at, pressed);
        harness.step();
    }
    harness.run_steps(2);
    let supports = &harness.state().state.document.scene.cables[0].supports;
    assert_eq!(supports.len(), 3);
    assert_eq!(supports[1].kind, cable_core::scene::SupportKind::Pulley);
    assert_eq!(harness.state().state.live.snapshot.error, None);

    harness.key_press(Key::Delete);
    harness.run_steps(2);
    assert_eq!(harness.state().state.document.scene.cables[0].supports.len(), 2);
}

#[test]
fn t04_dragging_the_background_moves_the_view_and_not_the_scene() {
    let mut harness = open(catalog::hanging_span());
    let canvas = harness.get_by_label("Canvas").rect();
    let before = harness.state().state.view.camera.centre_m;
    drag(&mut harness, canvas.left_top() + Vec2::new(120.0, 160.0), Vec2::new(50.0, 20.0));
    assert_ne!(harness.state().state.view.camera.centre_m, before);
    assert!(!harness.state().state.document.unsaved());
}

#[test]
fn an_obstacle_is_dragged_whole_and_its_corners_once_it_is_selected() {
    let mut scene = catalog::hanging_span();
    let square = [[4.0, -1.0], [6.0, -1.0], [6.0, 0.0], [4.0, 0.0]];
    scene.obstacles.push(cable_core::Obstacle {
        name: "beam".to_owned(),
        shape: Shape::Polygon { points_m: square.to_vec() },
        friction: None,
    });
    let mut harness = open(scene);
    let canvas = harness.get_by_label("Canvas").rect();
    let corners = |harness: &Harness<'_, ViewerApp>| match &harness.state().state.document.scene.obstacles[0].shape {
        Shape::Polygon { points_m } => points_m.clone(),
        other => panic!("{other:?}"),
    };
    let camera = harness.state().state.view.camera;
    let metre = camera.points_per_m as f32;
    drag(&mut harness, camera.to_screen(canvas, [5.0, -0.5]), Vec2::new(metre, -0.5 * metre));
    for (p, q) in square.iter().zip(corners(&harness)) {
        assert!((q[0] - p[0] - 1.0).abs() < 0.02 && (q[1] - p[1] - 0.5).abs() < 0.02, "{p:?} {q:?}");
    }
    drag(&mut harness, camera.to_screen(canvas, [7.0, 0.5]), Vec2::new(0.5 * metre, 0.0));
    let after = corners(&harness);
    assert!((after[2][0] - 7.5).abs() < 0.02 && (after[1][0] - 7.0).abs() < 0.02, "{after:?}");
}

#[test]
fn t04_the_wheel_zooms_at_the_pointer() {
    let mut harness = open(catalog::hanging_span());
    let canvas = harness.get_by_label("Canvas").rect();
    let pointer = canvas.center() + Vec2::new(90.0, -70.0);
    let before = harness.state().state.view.camera;
    harness.hover_at(pointer);
    harness.step();
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 80.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    let after = harness.state().state.view.camera;
    assert!(after.points_per_m > 1.1 * before.points_per_m);
    let (p, q) = (before.to_world(canvas, pointer), after.to_world(canvas, pointer));
    assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-6, "{p:?} {q:?}");
}

#[test]
fn every_catalogue_scene_is_drawn() {
    for (id, scene) in catalog::all() {
        let harness = open(scene);
        let state = &harness.state().state;
        assert!(
            state.live.snapshot.solution.is_some() || state.live.snapshot.error.is_some(),
            "{id} shows neither answer nor cause"
        );
    }
}

#[test]
fn u12_a_scene_without_an_answer_keeps_the_last_picture_and_says_why() {
    let mut harness = open_span();
    let good = harness.state().state.live.snapshot.solution.clone().expect("an answer");
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.axial_stiffness_n = f64::NAN;
    let broken = cable_viewer::command::SceneCommand::SetCable { cable: 0, value: Box::new(cable) };
    apply(&mut harness, Command::Scene(broken));
    let snapshot = &harness.state().state.live.snapshot;
    assert!(snapshot.stale && snapshot.error.is_some(), "{:?}", snapshot.error);
    assert_eq!(snapshot.solution.as_ref(), Some(&good));
    assert!(harness.state().state.document.fault.is_some());
}

#[test]
fn space_runs_and_pauses() {
    let mut harness = open(catalog::hanging_span());
    harness.key_press(Key::Space);
    harness.step();
    assert!(!harness.state().state.live.playback.paused || harness.state().state.live.snapshot.error.is_some());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    assert!(harness.state().state.live.playback.paused);
}

#[test]
fn a_window_without_area_does_not_panic() {
    let mut harness = open(catalog::hanging_span());
    for size in [[0.0, 0.0], [1.0, 1.0], [1280.0, 0.0], [300.0, 200.0], [1280.0, 800.0]] {
        harness.set_size(Vec2::new(size[0], size[1]));
        harness.run_steps(2);
        apply(&mut harness, Command::View(ViewCommand::Fit));
    }
}

#[test]
fn t01_a_file_that_is_no_scene_leaves_the_scene_and_says_where() {
    let mut harness = open(catalog::hanging_span());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.toml");
    std::fs::write(&path, "version = 1\ncables = 3\n").unwrap();
    let before = harness.state().state.document.scene.clone();
    apply(&mut harness, Command::File(cable_viewer::command::FileCommand::Open(path)));
    let state = &harness.state().state;
    assert_eq!(state.document.scene, before);
    let Some(cable_viewer::state::dialog::Dialog::Message { text, .. }) = &state.ui.dialog else {
        panic!("{:?}", state.ui.dialog)
    };
    assert!(text.contains("line 2"), "{text}");
}

#[test]
fn a_saved_scene_is_no_longer_marked_unsaved_and_opens_again() {
    let mut harness = open(catalog::hanging_span());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let rename = cable_viewer::command::SceneCommand::SetName("Renamed".to_owned());
    apply(&mut harness, Command::Scene(rename));
    assert!(harness.state().state.document.unsaved());
    apply(&mut harness, Command::File(cable_viewer::command::FileCommand::SaveAs(path.clone())));
    assert!(!harness.state().state.document.unsaved());
    assert_eq!(cable_viewer::io::scene_file::load(&path).unwrap(), harness.state().state.document.scene);
}

#[test]
fn the_canvas_keeps_its_size() {
    let mut harness = open(catalog::hanging_span());
    let before = harness.get_by_label("Canvas").rect();
    harness.run_steps(20);
    assert_eq!(harness.get_by_label("Canvas").rect(), before);
}
