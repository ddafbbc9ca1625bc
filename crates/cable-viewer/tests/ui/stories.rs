//! Each test does by hand what a user asked for, and is named after that story.

use cable_core::record::read_history;
use cable_core::scene::catalog;
use cable_core::solution::{DriveState, RobotReport};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand};
use cable_viewer::state::Item;
use cable_viewer::state::dialog::Dialog;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open, open_span};

fn time_s(harness: &Harness<'_, ViewerApp>) -> f64 {
    harness.state().state.live.snapshot.solution.as_ref().expect("an answer").time_s
}

fn robot(harness: &Harness<'_, ViewerApp>) -> RobotReport {
    harness.state().state.live.snapshot.solution.as_ref().and_then(|s| s.robot).expect("a robot")
}

fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

fn hold(harness: &mut Harness<'_, ViewerApp>, key: Key, pressed: bool) {
    harness.event(egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE });
    harness.step();
}

#[test]
fn s06_keys_drive_the_robot_and_the_cable_follows() {
    let mut harness = open(catalog::robot_drive());
    let start = robot(&harness);
    hold(&mut harness, Key::D, true);
    harness.run_steps(75);
    let state = &harness.state().state;
    assert_eq!(state.live.snapshot.error, None);
    assert!(!state.live.playback.paused, "who drives sees time run");
    let driven = robot(&harness);
    assert!(driven.x_m > start.x_m + 0.3 && driven.going == DriveState::Driving, "{driven:?}");
    let end = harness.state().state.live.snapshot.solution.as_ref().unwrap().cables[0].nodes.last().copied().unwrap();
    assert!((end.x_m - (driven.x_m - 0.9)).abs() < 0.02, "{} {}", end.x_m, driven.x_m);
    // With limited acceleration and jerk it stops from its 0.8 m/s within 1.3 s.
    hold(&mut harness, Key::D, false);
    harness.run_steps(90);
    let stopped = robot(&harness);
    assert!(stopped.speed_m_per_s == 0.0 && stopped.going == DriveState::Standing, "{stopped:?}");
    hold(&mut harness, Key::A, true);
    harness.run_steps(30);
    assert!(robot(&harness).speed_m_per_s < -0.2);
    hold(&mut harness, Key::A, false);
}

#[test]
fn s08_pause_step_back_scrub_and_go_on() {
    let mut harness = open_span();
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(30);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let now = time_s(&harness);
    assert!(now > 0.4, "{now}");
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(2);
    assert!((now - time_s(&harness) - 1.0 / 60.0).abs() < 1e-9, "{now} {}", time_s(&harness));
    click(&mut harness, "Step back");
    assert!((now - time_s(&harness) - 2.0 / 60.0).abs() < 1e-9);
    // Forward again: through what was recorded to the present, then on.
    for _ in 0..2 {
        harness.key_press(Key::ArrowRight);
        harness.run_steps(2);
    }
    assert!(harness.state().state.live.recording.shown_s.is_none() && time_s(&harness) == now);
    harness.key_press(Key::ArrowRight);
    harness.run_steps(2);
    assert!(time_s(&harness) > now);

    // Scrubbed to the middle, everything on screen is of that time; played, it runs to the present
    // and on.
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.25))));
    assert!((time_s(&harness) - 0.25).abs() < 1.0 / 60.0);
    harness.get_by_label_contains("0.25 of ");
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(5);
    let replayed = time_s(&harness);
    assert!(replayed > 0.25 && replayed < 0.45 && harness.state().state.live.recording.shown_s.is_some(), "{replayed}");
    harness.run_steps(60);
    assert!(harness.state().state.live.recording.shown_s.is_none() && time_s(&harness) > now, "{}", time_s(&harness));
}

#[test]
fn s08_a_loop_begins_anew_and_speeds_are_kept() {
    let mut harness = open_span();
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(20);
    click(&mut harness, "Loop");
    let last = harness.state().state.live.recording.span_s().unwrap()[1];
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(120);
    assert_eq!(harness.state().state.live.recording.span_s().unwrap()[1], last, "nothing new while it loops");
    assert!(time_s(&harness) <= last);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetSpeed(0.01)));
    let before = harness.state().state.live.recording.shown_s.unwrap();
    harness.run_steps(6);
    let passed = harness.state().state.live.recording.shown_s.unwrap() - before;
    assert!(passed > 0.0 && passed < 0.01, "{passed}");
}

#[test]
fn s08_an_edit_is_of_the_present() {
    let mut harness = open_span();
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(20);
    apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(Some(0.1))));
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.length_m += 0.01;
    let edit = cable_viewer::command::SceneCommand::SetCable { cable: 0, value: Box::new(cable) };
    apply(&mut harness, Command::Scene(edit));
    assert!(harness.state().state.live.recording.shown_s.is_none());
}

#[test]
fn s14_the_robot_follows_its_path_and_it_can_be_edited() {
    let mut harness = open(catalog::robot_drive());
    // The form of a robot with its path is higher than a window of 800 points shows.
    harness.set_size(egui::Vec2::new(1280.0, 1800.0));
    crate::select(&mut harness, Item::Robot);
    click(&mut harness, "Follow path");
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(60);
    let r = robot(&harness);
    assert!(r.leg == Some(0) && (r.commanded_m_per_s - 0.6).abs() < 1e-9 && r.x_m > 10.2, "{r:?}");
    apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    assert_eq!(robot(&harness).x_m, 10.0);
    let legs = harness.state().state.document.scene.robot.as_ref().unwrap().path.len();
    click(&mut harness, "Add wait");
    click(&mut harness, "Remove leg 1");
    assert_eq!(harness.state().state.document.scene.robot.as_ref().unwrap().path.len(), legs);
    assert_eq!(harness.state().state.live.snapshot.error, None);
}

#[test]
fn s17_the_robot_says_that_its_cable_holds_it() {
    let mut scene = catalog::robot_drive();
    scene.robot.as_mut().unwrap().at_m = [13.2, 0.0];
    let mut harness = open(scene);
    crate::select(&mut harness, Item::Robot);
    click(&mut harness, "Drive right");
    harness.run_steps(240);
    let r = robot(&harness);
    assert!(r.speed_m_per_s.abs() < 0.05, "{r:?}");
    // While its tracks slip, the swing of the cable may draw it back at this instant.
    let held = [DriveState::Stalled, DriveState::Slipping, DriveState::Slowed, DriveState::Dragged];
    assert!(held.contains(&r.going), "{r:?}");
    harness.get_by_label(r.going.name());
    assert!(!harness.state().state.live.recording.events().is_empty(), "the pull beyond the service tension is marked");
    click(&mut harness, "Stop");
}

#[test]
fn s11_what_was_recorded_is_saved_and_read_again() {
    let mut harness = open(catalog::robot_drive());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(20);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    apply(&mut harness, Command::File(FileCommand::SaveRun(run.clone())));
    assert_eq!(harness.state().state.ui.dialog, None);
    let table = read_history(std::fs::File::open(run.join("history.csv")).unwrap()).unwrap();
    let answers = harness.state().state.live.recording.answers();
    assert_eq!(table.time_s.len(), answers.len());
    for (k, answer) in answers.iter().enumerate() {
        assert_eq!(table.max_tension_n[k].to_bits(), answer.max_tension().tension_n.to_bits());
    }
    let speed = table.extras.iter().find(|e| e.name == "robot_speed_m_per_s").expect("the robot's speed");
    assert_eq!(speed.values.last().copied(), answers.last().and_then(|a| a.robot).map(|r| r.speed_m_per_s));
    assert!(table.extras.iter().any(|e| e.name == "kinetic_energy_j"));
}

#[test]
fn s12_a_graph_is_zoomed_read_with_cursors_and_exported() {
    let mut harness = open_span();
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(60);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let plot = harness.get_by_label("Over time").rect();
    // Two cursors: the difference is told.
    for share in [0.2, 0.5] {
        let at = plot.left_center() + egui::vec2(70.0 + share * (plot.width() - 80.0), 0.0);
        harness.hover_at(at);
        harness.step();
        for pressed in [true, false] {
            crate::press(&harness, at, pressed);
            harness.step();
        }
        harness.run_steps(30);
    }
    let spoken = harness.get_by_label("Over time").accesskit_node().description().unwrap_or_default();
    assert!(spoken.contains("B − A"), "{spoken}");
    // The wheel ends following.
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::Vec2::new(0.0, 80.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    click(&mut harness, "Export Over time");
    let Some(Dialog::Export { sheet, .. }) = harness.state().state.ui.dialog.clone() else {
        panic!("{:?}", harness.state().state.ui.dialog)
    };
    assert!(sheet.bounds[2] - sheet.bounds[0] < 9.0, "it is zoomed: {:?}", sheet.bounds);
    let folder = tempfile::tempdir().unwrap();
    for name in ["graph.csv", "graph.svg"] {
        let path = folder.path().join(name);
        apply(&mut harness, Command::File(FileCommand::Export(path.clone(), sheet.clone())));
        assert_eq!(harness.state().state.ui.dialog, None, "{name}");
        assert!(std::fs::read_to_string(path).unwrap().contains(if name.ends_with("csv") { "time_s" } else { "<svg" }));
    }
    let path = folder.path().join("graph.png");
    apply(&mut harness, Command::File(FileCommand::Export(path.clone(), sheet)));
    let picture = image::open(path).unwrap().to_rgb8();
    let inked = picture.pixels().filter(|p| p.0 != [255; 3]).count();
    assert!(inked > 5000, "{inked} of {} pixels", picture.len() / 3);
}

#[test]
fn s10_energies_and_the_robot_are_graphs_too() {
    let mut harness = open(catalog::robot_drive());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(20);
    for measure in ["Energy", "Robot speed", "Hitch pull", "Strain", "Stress"] {
        click(&mut harness, measure);
        let spoken = harness.get_by_label("Over time").accesskit_node().description().unwrap_or_default();
        assert!(!spoken.is_empty() && !spoken.contains("NaN"), "{measure}: {spoken}");
    }
}

#[test]
fn t01_about_says_what_was_checked_and_what_was_not() {
    let mut harness = open_span();
    click(&mut harness, "About");
    harness.run_steps(3);
    harness.get_by_label("Not checked");
    harness.get_by_label_contains("not certified");
    click(&mut harness, "Close");
    harness.key_press(Key::F1);
    harness.run_steps(5);
    harness.get_by_label("Hold A, D");
}

#[test]
fn s09_a_pasted_table_becomes_ground_and_undo_takes_it_back() {
    let mut harness = open_span();
    let before = harness.state().state.document.scene.clone();
    let text = "x;y\n-2,0;-4,0\n5;-3,5\n12;-4\n".to_owned();
    apply(
        &mut harness,
        Command::File(FileCommand::ImportMap { path: None, text, unit_m: 1.0, replaces_ground: false }),
    );
    let state = &harness.state().state;
    assert_eq!(state.document.scene.obstacles.len(), before.obstacles.len() + 1);
    assert_eq!(state.live.snapshot.error, None);
    let Some(Dialog::Message { text, .. }) = &state.ui.dialog else { panic!("{:?}", state.ui.dialog) };
    assert!(text.contains("3 points") && text.contains("heading"), "{text}");
    apply(&mut harness, Command::File(FileCommand::SetDialog(None)));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(harness.state().state.document.scene, before);
    // A table that cannot be read changes nothing, and the line is reported.
    let text = "0 0\n1 x\n".to_owned();
    apply(
        &mut harness,
        Command::File(FileCommand::ImportMap { path: None, text, unit_m: 1.0, replaces_ground: false }),
    );
    assert_eq!(harness.state().state.document.scene, before);
    let Some(Dialog::Message { text, .. }) = &harness.state().state.ui.dialog else { panic!("no message") };
    assert!(text.contains("line 2"), "{text}");
}

#[test]
fn s16_four_answers_are_held_and_their_differences_told() {
    let mut harness = open_span();
    // Tall enough that the whole table is in sight.
    harness.set_size(egui::Vec2::new(1280.0, 1600.0));
    harness.run_steps(3);
    for k in 0..4 {
        click(&mut harness, "Pin this result");
        let mut cable = harness.state().state.document.scene.cables[0].clone();
        cable.length_m += 0.1 * f64::from(k + 1);
        let edit = cable_viewer::command::SceneCommand::SetCable { cable: 0, value: Box::new(cable) };
        apply(&mut harness, Command::Scene(edit));
    }
    let state = &harness.state().state;
    assert_eq!(state.analysis.references.len(), 4);
    let told = cable_viewer::panels::analysis::compare::differences(&state.analysis.references[0], state);
    assert!(told.iter().any(|l| l.starts_with("Length: 12")), "{told:?}");
    assert!(harness.get_all_by_label_contains(" %").count() >= 8, "differences of tension and sag");
    // Issue 20: they were named 1 to 4.
    let names = cable_viewer::panels::pin_names::pin_names(&harness.state().state);
    let names: Vec<&str> = names.iter().map(|name| name.full.as_str()).collect();
    let lengths = ["12.10", "12.30", "12.60"].map(|length| format!("Hanging span: length {length} m"));
    assert_eq!(names, ["Hanging span", &lengths[0], &lengths[1], &lengths[2]]);
    assert!(harness.query_all_by_label(&lengths[1]).count() > 0, "the panel names it");
    click(&mut harness, "Unpin Hanging span: length 12.10 m");
    assert_eq!(harness.state().state.analysis.references.len(), 3);
    click(&mut harness, "Unpin all");
    assert!(harness.state().state.analysis.references.is_empty());
}

#[test]
fn t03_hundreds_of_load_changes_end_at_the_last() {
    let mut harness = open_span();
    click(&mut harness, "Add load");
    let load = harness.state().state.document.scene.loads[0].clone();
    harness.get_by_label("Load force");
    let before = harness.state().state.document.scene.clone();
    let ctx = harness.ctx.clone();
    for k in 1..=300 {
        let value = cable_core::Load { force_n: Some([0.0, -f64::from(k)]), ..load.clone() };
        let command = cable_viewer::command::SceneCommand::SetLoad { load: 0, value };
        harness.state_mut().apply(&ctx, vec![Command::Scene(command)]);
        if k % 20 == 0 {
            harness.step();
        }
    }
    harness.run_steps(2);
    let state = &harness.state().state;
    assert_eq!(state.live.snapshot.error, None);
    assert_eq!(state.document.scene.loads[0].force_n, Some([0.0, -300.0]));
    assert_eq!(state.live.snapshot.scene.as_deref(), Some(&state.document.scene));
    // One drag of the slider is one entry.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    assert_eq!(harness.state().state.document.scene, before);
}

#[test]
fn t01_everything_is_found_by_name_in_the_palette() {
    let mut harness = open_span();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(4);
    harness.get_by_label("Command").type_text("robot out");
    harness.run_steps(3);
    harness.key_press(Key::Enter);
    harness.run_steps(6);
    let state = &harness.state().state;
    assert_eq!(state.ui.dialog, None);
    assert!(state.document.scene.robot.is_some(), "{}", state.document.scene.name);
}
