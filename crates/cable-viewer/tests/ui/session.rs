//! This test is a working session from start to end, as a user does it: open, drag, drive, break,
//! compare, export.

use cable_core::record::read_history;
use cable_core::scene::catalog;
use cable_core::solution::WarningKind;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand};
use cable_viewer::state::AppState;
use cable_viewer::state::dialog::Dialog;
use egui::{Event, Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{drag, open_span};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Types into the field of the open dialog and presses its button.
fn answer(harness: &mut Harness<'_, ViewerApp>, text: &str, button: &str) {
    let field = harness.get_by_role_and_label(egui::accesskit::Role::TextInput, "Path");
    field.focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text(text.to_owned()));
    harness.run_steps(2);
    // The last: File menu and toolbars have buttons of the same name.
    harness.get_all_by_label(button).last().expect("a button").click();
    harness.run_steps(4);
}

fn hold(harness: &mut Harness<'_, ViewerApp>, key: Key, frames: usize) {
    let press = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
    harness.event(press(true));
    harness.run_steps(frames);
    harness.event(press(false));
    harness.run_steps(2);
}

#[test]
fn a_session_from_opening_a_file_to_exporting_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("robot.toml");
    std::fs::write(&scene, catalog::robot_drive().to_toml()).unwrap();
    let mut harness = open_span();
    // Tall enough that every panel is in sight.
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);

    // Open.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run_steps(3);
    answer(&mut harness, &scene.display().to_string(), "Open");
    assert_eq!(state(&harness).document.scene, catalog::robot_drive());
    assert_eq!(state(&harness).ui.dialog, None);

    // Drag the riser.
    let metre = state(&harness).view.camera.points_per_m as f32;
    let riser = harness.get_by_label("Support riser of umbilical").rect().center();
    drag(&mut harness, riser, Vec2::new(0.4 * metre, 0.0));
    let at = state(&harness).document.scene.cables[0].supports[0].at_m.unwrap();
    assert!((at[0] - 0.4).abs() < 0.05, "{at:?}");
    assert_eq!(state(&harness).live.snapshot.error, None);

    // Drive, hold the run, wind back.
    hold(&mut harness, Key::D, 45);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(state(&harness).live.playback.paused && state(&harness).live.recording.answers().len() > 30);
    click(&mut harness, "Pin this result");
    harness.key_press(Key::R);
    harness.run_steps(3);
    assert_eq!(state(&harness).live.snapshot.solution.as_ref().unwrap().time_s, 0.0);

    // A weaker cable breaks on the same way.
    let mut cable = state(&harness).document.scene.cables[0].clone();
    let most = state(&harness).live.snapshot.solution.as_ref().unwrap().max_tension().tension_n;
    (cable.service_tension_n, cable.breaking_tension_n) = (0.5 * most, 0.95 * most);
    let ctx = harness.ctx.clone();
    let edit = Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) });
    harness.state_mut().apply(&ctx, vec![edit]);
    harness.run_steps(3);
    hold(&mut harness, Key::D, 30);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(state(&harness).live.recording.events().iter().any(|e| e.warning.kind == WarningKind::Broken));
    assert!(harness.get_all_by_label_contains("Broken at ").count() >= 1);

    // Compare.
    harness.get_by_label("Whole runs");
    let told =
        cable_viewer::panels::analysis::compare::differences(&state(&harness).analysis.references[0], state(&harness));
    assert!(told.iter().any(|l| l.starts_with("Breaking tension ")), "{told:?}");

    // Export the graph and the run, and read both again.
    click(&mut harness, "Export Over time");
    let table = folder.path().join("tension.csv");
    answer(&mut harness, &table.display().to_string(), "Save");
    let text = std::fs::read_to_string(&table).unwrap();
    assert!(text.starts_with("time_s,maximum_tension_n") && text.lines().count() > 20, "{text}");
    let run = folder.path().join("run");
    let command = Command::File(FileCommand::SetDialog(Some(Dialog::SaveRun { path: String::new() })));
    harness.state_mut().apply(&ctx, vec![command]);
    harness.run_steps(2);
    answer(&mut harness, &run.display().to_string(), "Save");
    let history = read_history(std::fs::File::open(run.join("history.csv")).unwrap()).unwrap();
    assert_eq!(history.time_s.len(), state(&harness).live.recording.answers().len());

    // Nothing was lost on the way: undo leads back to the file.
    for _ in 0..3 {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        harness.run_steps(2);
    }
    assert_eq!(state(&harness).document.scene, catalog::robot_drive());
    harness.state_mut().apply(&ctx, vec![Command::Playback(PlaybackCommand::Reset)]);
    harness.run_steps(2);
    assert_eq!(state(&harness).live.snapshot.error, None);
}
