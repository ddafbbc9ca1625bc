//! A window recovers what one that died has left; the robot is recovered, too.

use cable_core::Robot;
use cable_core::scene::{SupportKind, catalog};
use cable_viewer::command::{Command, SceneCommand};
use cable_viewer::state::Item;
use cable_viewer::state::dialog::Dialog;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

#[test]
fn kept_changes_are_offered_and_taken_over_as_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recovery.toml");
    let mut kept = catalog::over_beam();
    kept.name = "Worked on for hours".to_owned();
    cable_viewer::io::scene_file::save(&path, &kept).unwrap();
    let mut harness = open(catalog::hanging_span());
    harness.state_mut().enable_autosave(path.clone());
    harness.run_steps(2);
    harness.get_by_label("Recover").click();
    harness.run_steps(3);
    let state = &harness.state().state;
    assert_eq!(state.document.scene, kept);
    assert!(state.document.unsaved() && state.ui.dialog.is_none() && path.exists());
    assert_eq!(state.live.snapshot.error, None);
    let saved = folder.path().join("saved.toml");
    apply(&mut harness, Command::File(cable_viewer::command::FileCommand::SaveAs(saved)));
    assert!(!harness.state().state.document.unsaved());
}

#[test]
fn kept_changes_can_be_deleted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recovery.toml");
    cable_viewer::io::scene_file::save(&path, &catalog::over_beam()).unwrap();
    let mut harness = open(catalog::hanging_span());
    harness.state_mut().enable_autosave(path.clone());
    harness.run_steps(2);
    harness.get_by_label("Discard").click();
    harness.run_steps(2);
    assert!(!path.exists() && harness.state().state.ui.dialog.is_none());
}

#[test]
fn a_damaged_copy_is_said_and_the_window_stays_usable() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recovery.toml");
    std::fs::write(&path, "version = 1\nname = \"half").unwrap();
    let mut harness = open(catalog::hanging_span());
    harness.state_mut().enable_autosave(path);
    harness.run_steps(2);
    assert!(matches!(harness.state().state.ui.dialog, Some(Dialog::Message { .. })));
    harness.get_by_label("Close").click();
    harness.run_steps(2);
    assert!(harness.state().state.ui.dialog.is_none());
}

#[test]
fn a_robot_is_dragged_along_the_ground_with_the_cable_on_its_hitch() {
    let mut scene = catalog::over_beam();
    let robot = Robot { preset: "brokk-110".to_owned(), at_m: [10.0, 0.0], ..Robot::default() };
    let hitch = robot.hitch_m().unwrap();
    let end = scene.cables[0].supports.last_mut().unwrap();
    (end.kind, end.at_m) = (SupportKind::Robot, None);
    scene.robot = Some(robot);
    let mut harness = open(scene);
    assert_eq!(harness.state().state.live.snapshot.error, None);
    let end = |harness: &egui_kittest::Harness<'_, cable_viewer::ViewerApp>| {
        let solution = harness.state().state.live.snapshot.solution.clone().unwrap();
        let r = solution.cables[0].supports.last().unwrap().clone();
        [r.x_m, r.y_m]
    };
    assert!((end(&harness)[0] - hitch[0]).abs() < 1e-9, "{:?}", end(&harness));
    let to_m = [10.4, 3.0];
    apply(&mut harness, Command::Scene(SceneCommand::Move { item: Item::Robot, to_m }));
    let state = &harness.state().state;
    assert_eq!(state.document.scene.robot.as_ref().unwrap().at_m, [10.4, 0.0], "it stays on the ground");
    assert_eq!(state.live.snapshot.error, None);
    assert!((end(&harness)[0] - hitch[0] - 0.4).abs() < 1e-9);
    // Without the robot the cable stays where it hung.
    apply(&mut harness, Command::Scene(SceneCommand::Remove(Item::Robot)));
    let support = harness.state().state.document.scene.cables[0].supports.last().unwrap().clone();
    assert_eq!(support.kind, SupportKind::Fixed);
    assert!((support.at_m.unwrap()[0] - hitch[0] - 0.4).abs() < 1e-9);
    assert_eq!(harness.state().state.document.fault, None);
}
