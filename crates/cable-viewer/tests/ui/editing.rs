//! These tests edit on the canvas and by keys: several things at once, copies, cables, the robot's
//! path, forces by their arrows.

use cable_core::scene::{RobotTask, Shape, SupportKind, catalog};
use cable_core::{Load, Obstacle};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::dialog::Dialog;
use cable_viewer::state::{AppState, Item};
use cable_viewer::units::system::System;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, drag, open, open_span, select, support};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

/// Returns where a point of the world is on screen.
fn screen(harness: &Harness<'_, ViewerApp>, p: [f64; 2]) -> Pos2 {
    let canvas = harness.get_by_label("Canvas").rect();
    state(harness).view.camera.to_screen(canvas, p)
}

fn click_at(harness: &mut Harness<'_, ViewerApp>, at: Pos2, modifiers: Modifiers, times: usize) {
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false].repeat(times) {
        let button = PointerButton::Primary;
        let event = Event::PointerButton { pos: at, button, pressed, modifiers };
        harness.event_modifiers(event, modifiers);
        harness.step();
    }
    harness.run_steps(2);
}

/// The hanging span with a beam and a post below it.
fn with_obstacles() -> cable_core::Scene {
    let mut scene = catalog::hanging_span();
    let square = [[4.0, -1.0], [5.0, -1.0], [5.0, 0.0], [4.0, 0.0]];
    for (name, shape) in [
        ("beam", Shape::Polygon { points_m: square.to_vec() }),
        ("post", Shape::Circle { center_m: [7.0, -0.5], radius_m: 0.3 }),
    ] {
        scene.obstacles.push(Obstacle { name: name.to_owned(), shape, friction: None });
    }
    scene
}

fn centre(harness: &Harness<'_, ViewerApp>, k: usize) -> [f64; 2] {
    match &state(harness).document.scene.obstacles[k].shape {
        Shape::Circle { center_m, .. } => *center_m,
        Shape::Terrain { points_m } | Shape::Polygon { points_m } | Shape::Polyline { points_m, .. } => points_m[0],
    }
}

/// Escape was taken for the selection, and what had been typed was entered as the form went.
#[test]
fn escape_drops_what_was_typed_and_then_the_selection() {
    let mut harness = open(catalog::hanging_span());
    select(&mut harness, Item::Cable(0));
    let before = harness.state().state.document.scene.clone();
    harness.get_by_label("Breaking tension").focus();
    harness.run_steps(2);
    harness.get_by_label("Breaking tension").type_text("60");
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    let state = &harness.state().state;
    assert_eq!((&state.document.scene, state.selection.selected), (&before, Some(Item::Cable(0))));
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(harness.state().state.selection.selected, None);
}

#[test]
fn several_things_are_picked_moved_copied_and_removed_together() {
    let mut harness = open(with_obstacles());
    let before = state(&harness).document.scene.clone();
    let [beam, post] = [screen(&harness, [4.5, -0.5]), screen(&harness, [7.0, -0.5])];
    click_at(&mut harness, beam, Modifiers::NONE, 1);
    click_at(&mut harness, post, Modifiers::SHIFT, 1);
    assert_eq!(state(&harness).selection.selected_items(), [Item::Obstacle(0), Item::Obstacle(1)]);
    // A drag of one moves both by the same.
    let metre = state(&harness).view.camera.points_per_m as f32;
    drag(&mut harness, post, Vec2::new(0.5 * metre, -0.25 * metre));
    for (k, was) in [[4.0, -1.0], [7.0, -0.5]].into_iter().enumerate() {
        let now = centre(&harness, k);
        assert!((now[0] - was[0] - 0.5).abs() < 0.02 && (now[1] - was[1] - 0.25).abs() < 0.02, "{k}: {now:?}");
    }
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(state(&harness).document.scene, before, "one drag is one entry, however many things it moves");
    // Alt and an arrow move them by a grid line.
    apply(&mut harness, Command::View(ViewCommand::SelectAll(vec![Item::Obstacle(0), Item::Obstacle(1)])));
    harness.key_press_modifiers(Modifiers::ALT, Key::ArrowUp);
    harness.run_steps(2);
    let risen = centre(&harness, 0)[1] + 1.0;
    assert!(risen > 0.01 && (centre(&harness, 1)[1] + 0.5 - risen).abs() < 1e-9, "{risen}");
    // Copies stand beside them, with names of their own.
    harness.event(Event::Copy);
    harness.run_steps(2);
    let text = state(&harness).selection.clipboard.text.clone();
    assert!(text.contains('\t') && text.lines().count() >= 5, "{text}");
    harness.remove_cursor();
    harness.step();
    harness.event(Event::Paste(text));
    harness.run_steps(2);
    let names: Vec<String> = state(&harness).document.scene.obstacles.iter().map(|o| o.name.clone()).collect();
    assert_eq!(names, ["beam", "post", "beam 2", "post 2"]);
    assert_eq!(state(&harness).selection.selected_items(), [Item::Obstacle(2), Item::Obstacle(3)]);
    assert!((centre(&harness, 2)[0] - centre(&harness, 0)[0] - 0.5).abs() < 1e-9);
    assert_eq!(state(&harness).live.snapshot.error, None);
    harness.key_press(Key::Delete);
    harness.run_steps(2);
    assert_eq!(state(&harness).document.scene.obstacles.len(), 2);
}

#[test]
fn a_frame_picks_what_is_in_it_and_a_cut_is_undone() {
    let mut harness = open(with_obstacles());
    let before = state(&harness).document.scene.clone();
    let [from, to] = [screen(&harness, [3.5, -1.5]), screen(&harness, [7.8, 0.5])];
    harness.hover_at(from);
    harness.step();
    let press = |pos, pressed| {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::SHIFT);
        Event::PointerButton { pos, button, pressed, modifiers }
    };
    harness.event_modifiers(press(from, true), Modifiers::SHIFT);
    harness.step();
    for k in 1..=4 {
        let at = from + (to - from) * (k as f32 / 4.0);
        harness.event_modifiers(Event::PointerMoved(at), Modifiers::SHIFT);
        harness.step();
    }
    assert!(state(&harness).selection.marquee_m.is_some());
    harness.event_modifiers(press(to, false), Modifiers::SHIFT);
    harness.run_steps(3);
    assert_eq!(state(&harness).selection.selected_items(), [Item::Obstacle(0), Item::Obstacle(1)]);
    assert!(state(&harness).selection.marquee_m.is_none());
    harness.event(Event::Cut);
    harness.run_steps(2);
    assert!(state(&harness).document.scene.obstacles.is_empty());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(state(&harness).document.scene, before);
}

#[test]
fn a_support_is_pasted_onto_the_cable() {
    let mut harness = open(catalog::pulley_waypoints());
    let count = state(&harness).document.scene.cables[0].supports.len();
    apply(&mut harness, Command::View(ViewCommand::Select(Some(Item::Support { cable: 0, support: 1 }))));
    harness.event(Event::Copy);
    harness.run_steps(2);
    let was = state(&harness).document.scene.cables[0].supports[1].clone();
    let at_m = was.at_m.map(|p| [p[0] + 0.6, p[1]]);
    apply(&mut harness, Command::Scene(SceneCommand::Paste { at_m }));
    let supports = &state(&harness).document.scene.cables[0].supports;
    assert_eq!(supports.len(), count + 1);
    let new = supports.iter().find(|s| s.name == format!("{} 2", was.name)).expect("a copy with a name of its own");
    assert_eq!((new.kind, new.radius_m, new.at_m), (SupportKind::Pulley, was.radius_m, at_m));
    assert_eq!(state(&harness).document.fault, None);
}

#[test]
fn a_table_pasted_from_another_program_is_offered_as_a_map() {
    let mut harness = open_span();
    harness.event(Event::Paste("0\t-3\n10\t-3\n".to_owned()));
    harness.run_steps(2);
    assert!(matches!(&state(&harness).ui.dialog, Some(Dialog::ImportMap { text, .. }) if text.starts_with("0\t-3")));
}

/// D10.12: an import added a second ground to the one that was there without a word.
#[test]
fn an_import_asks_whether_it_replaces_the_ground() {
    let mut scene = cable_core::scene::catalog::hanging_span();
    let ground = |name: &str, y: f64| cable_core::Obstacle {
        name: name.to_owned(),
        shape: Shape::Terrain { points_m: vec![[-5.0, y], [15.0, y]] },
        friction: None,
    };
    let post = cable_core::Obstacle {
        name: "post".to_owned(),
        shape: Shape::Circle { center_m: [20.0, -2.0], radius_m: 0.3 },
        friction: None,
    };
    scene.obstacles = vec![ground("floor", -4.0), post.clone()];
    for (button, grounds) in [("Replace the ground", 1), ("Add to the scene", 2)] {
        let mut harness = crate::open(scene.clone());
        harness.event(Event::Paste("-5\t-3\n15\t-3\n".to_owned()));
        harness.run_steps(3);
        assert!(harness.query_by_label("Import").is_none(), "it is asked");
        click(&mut harness, button);
        harness.run_steps(3);
        let Some(Dialog::Message { text, .. }) = &state(&harness).ui.dialog else { panic!() };
        assert_eq!(text.contains("“floor”: taken out"), grounds == 1, "{text}");
        click(&mut harness, "Close");
        let now = &state(&harness).document.scene.obstacles;
        assert_eq!(now.iter().filter(|o| matches!(o.shape, Shape::Terrain { .. })).count(), grounds, "{button}");
        assert!(now.contains(&post));
        assert_eq!(state(&harness).live.snapshot.error, None);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        harness.run_steps(3);
        assert_eq!(state(&harness).document.scene, scene);
    }
    // Shapes alone replace no ground; without one there is nothing to ask.
    let mut harness = crate::open(scene.clone());
    harness.event(Event::Paste("2\t-3\n3\t-3\n3\t-2\n2\t-3\n".to_owned()));
    harness.run_steps(3);
    click(&mut harness, "Replace the ground");
    harness.run_steps(3);
    assert_eq!(state(&harness).document.scene, scene);
    scene.obstacles.clear();
    let mut harness = crate::open(scene);
    harness.event(Event::Paste("-5\t-3\n15\t-3\n".to_owned()));
    harness.run_steps(3);
    click(&mut harness, "Import");
    assert_eq!(state(&harness).document.scene.obstacles.len(), 1);
}

#[test]
fn s01_cables_are_added_swapped_and_taken_out() {
    let mut harness = open_span();
    crate::select(&mut harness, Item::Cable(0));
    click(&mut harness, "Add cable");
    assert_eq!(state(&harness).document.scene.cables.len(), 2);
    assert_eq!(state(&harness).selection.selected, Some(Item::Cable(1)));
    assert_eq!(state(&harness).live.snapshot.error, None);
    let answer = state(&harness).live.snapshot.solution.clone().unwrap();
    assert_eq!(answer.cables.len(), 2);
    let [a, b] = [0, 1].map(|k| answer.cables[k].nodes[0]);
    assert!((b.y_m - a.y_m - 0.5).abs() < 1e-9 && (b.tension_n / a.tension_n - 1.0).abs() < 1e-9);
    // The new one gets a preset of its own; the first stays as it is.
    let first = state(&harness).document.scene.cables[0].clone();
    let mut second = state(&harness).document.scene.cables[1].clone();
    second.linear_density_kg_per_m *= 2.0;
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 1, value: Box::new(second) }));
    assert_eq!(state(&harness).document.scene.cables[0], first);
    let answer = state(&harness).live.snapshot.solution.clone().unwrap();
    assert!(answer.cables[1].nodes[0].tension_n > 1.9 * answer.cables[0].nodes[0].tension_n);
    // Both run.
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(5);
    assert_eq!(state(&harness).live.snapshot.error, None);
    apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    click(&mut harness, "Remove cable");
    assert_eq!(state(&harness).document.scene.cables, [first]);
}

#[test]
fn s14_the_path_is_edited_on_the_canvas() {
    let mut harness = open(catalog::robot_drive());
    let legs = |h: &Harness<'_, ViewerApp>| state(h).document.scene.robot.as_ref().unwrap().path.clone();
    let before = legs(&harness);
    let Some(RobotTask::Drive { to_x_m, .. }) = before.first().cloned() else { panic!("{before:?}") };
    let metre = state(&harness).view.camera.points_per_m as f32;
    let flag = harness.get_by_label("Leg 1 of the robot's path").rect().center();
    drag(&mut harness, flag, Vec2::new(-0.5 * metre, 0.0));
    let Some(RobotTask::Drive { to_x_m: now, .. }) = legs(&harness).first().cloned() else { panic!() };
    assert!((now - to_x_m + 0.5).abs() < 0.02, "{to_x_m} {now}");
    // A double click on the ground adds a leg to there.
    let at = screen(&harness, [14.0, 0.0]);
    click_at(&mut harness, at, Modifiers::NONE, 2);
    let after = legs(&harness);
    assert_eq!(after.len(), before.len() + 1);
    let Some(RobotTask::Drive { to_x_m: last, .. }) = after.last() else { panic!("{after:?}") };
    assert!((last - 14.0).abs() < 0.02, "{last}");
    harness.key_press(Key::Delete);
    harness.run_steps(2);
    assert_eq!(legs(&harness).len(), before.len());
    assert_eq!(state(&harness).document.fault, None);
}

#[test]
fn u14_a_force_is_set_by_the_head_of_its_arrow_and_shows_its_parts() {
    let mut scene = catalog::hanging_span();
    scene.loads.push(Load {
        cable: scene.cables[0].name.clone(),
        arc_length_m: 6.0,
        force_n: Some([0.0, -100.0]),
        times_s: Vec::new(),
        forces_n: Vec::new(),
    });
    let mut harness = open(scene);
    apply(&mut harness, Command::SetModel(cable_core::Model::Fem));
    let head = harness.get_by_label("Force of load 1").rect().center();
    let tail = harness.get_by_label("Load 1").rect().center();
    assert!((head - tail - Vec2::new(0.0, 48.0)).length() < 1.0, "100 N down is 48 points down: {head} {tail}");
    // Twice as long is four times the force.
    drag(&mut harness, head, Vec2::new(0.0, 48.0));
    let [x, y] = state(&harness).document.scene.loads[0].force_n.unwrap();
    // The cable gives way while it is drawn: the head stays at the pointer and the tail follows.
    assert!(x.abs() < 15.0 && (y + 400.0).abs() < 40.0, "{x} {y}");
    assert_eq!(state(&harness).live.snapshot.error, None);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(state(&harness).document.scene.loads[0].force_n, Some([0.0, -100.0]), "a drag is one entry");
}

#[test]
fn s08_time_goes_on_from_an_earlier_picture() {
    let mut harness = open(catalog::robot_drive());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(60);
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.5))));
    let then = state(&harness).live.snapshot.solution.clone().unwrap();
    click(&mut harness, "Resume from here");
    let now = state(&harness).live.snapshot.solution.clone().unwrap();
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert_eq!(now.time_s, then.time_s);
    assert!(state(&harness).live.recording.shown_s.is_none());
    assert_eq!(state(&harness).live.recording.span_s().unwrap()[1], then.time_s, "what came after is forgotten");
    assert_eq!(now.robot.unwrap().x_m, then.robot.unwrap().x_m);
    for (a, b) in now.cables[0].nodes.iter().zip(&then.cables[0].nodes) {
        assert!((a.x_m - b.x_m).hypot(a.y_m - b.y_m) < 1e-3, "({}, {}) ({}, {})", a.x_m, a.y_m, b.x_m, b.y_m);
    }
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(10);
    let on = state(&harness).live.snapshot.solution.clone().unwrap();
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert!(on.time_s > then.time_s && on.robot.unwrap().x_m > then.robot.unwrap().x_m);
}

#[test]
fn u01_units_are_switched_and_files_stay_si() {
    let mut harness = open_span();
    let file = state(&harness).document.scene.to_toml();
    apply(&mut harness, Command::View(ViewCommand::SetUnits(System::Us)));
    harness.run_steps(2);
    let spoken = |h: &Harness<'_, ViewerApp>, label: &str| {
        use egui_kittest::kittest::NodeT;
        h.get_by_label(label).accesskit_node().value().unwrap_or_default()
    };
    crate::select(&mut harness, Item::Cable(0));
    assert_eq!(spoken(&harness, "Length"), "39.37 ft");
    assert!(spoken(&harness, "Linear density").ends_with(" lb/ft"));
    assert!(harness.get_all_by_label_contains(" lbf").count() > 3);
    // Typed in feet, kept in metres.
    harness.get_by_label("Length").click();
    harness.run_steps(2);
    harness.get_by_label("Length").type_text("50");
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    let length_m = state(&harness).document.scene.cables[0].length_m;
    assert!((length_m - 15.24).abs() < 1e-9, "{length_m}");
    assert!(state(&harness).document.scene.to_toml().contains("length_m = 15.24"));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(state(&harness).document.scene.to_toml(), file);
    apply(&mut harness, Command::View(ViewCommand::SetUnits(System::Si)));
    harness.run_steps(2);
    assert!(spoken(&harness, "Length").ends_with(" m"));
}

#[test]
fn the_next_thing_is_picked_by_a_key_and_moved_by_arrows() {
    let mut harness = open_span();
    for expected in [0, 1, 0] {
        harness.key_press(Key::N);
        harness.run_steps(2);
        assert_eq!(state(&harness).selection.selected, Some(Item::Support { cable: 0, support: expected }));
    }
    let before = support(&harness, "left");
    harness.key_press_modifiers(Modifiers::ALT, Key::ArrowLeft);
    harness.run_steps(2);
    let after = support(&harness, "left");
    assert!(after.x < before.x - 3.0 && (after.y - before.y).abs() < 0.1, "{before} {after}");
    assert_eq!(state(&harness).live.snapshot.solution.as_ref().unwrap().time_s, 0.0, "it is no step in time");
}
