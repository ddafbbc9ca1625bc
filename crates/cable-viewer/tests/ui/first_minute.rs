//! Somebody who has never seen the window learns in the first minute what to do, where to begin,
//! and how to open a file.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::app::guidance::tutorials::TUTORIALS;
use cable_viewer::command::{Command, FileCommand, SceneCommand, ViewCommand};
use cable_viewer::geometry::robot::robot_outline;
use cable_viewer::state::Item;
use cable_viewer::state::dialog::{Dialog, SceneReplacement};
use cable_viewer::state::tutorial_place::TutorialPlace;
use cable_viewer::widgets::highlight;
use egui::{Key, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, drag, open, open_span, select, support};

const HINTS: [&str; 3] = ["Drag “right”", "Press Space to play", "Scroll to zoom"];

fn hints(harness: &Harness<'_, ViewerApp>) -> Vec<&'static str> {
    HINTS.into_iter().filter(|hint| harness.query_by_label(hint).is_some()).collect()
}

#[test]
fn three_hints_stand_on_the_canvas_until_each_was_followed() {
    let mut harness = open_span();
    let canvas = harness.get_by_label("Canvas").rect();
    assert_eq!(hints(&harness), HINTS);
    assert!(HINTS.iter().all(|hint| canvas.contains_rect(harness.get_by_label(hint).rect())));
    let from = support(&harness, "right");
    drag(&mut harness, from, Vec2::new(-60.0, -40.0));
    assert_eq!(hints(&harness), HINTS[1..]);
    harness.key_press(Key::Space);
    harness.run_steps(3);
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert_eq!(hints(&harness), HINTS[2..]);
    harness.key_press(Key::Plus);
    harness.run_steps(3);
    assert!(hints(&harness).is_empty());
    assert!(harness.query_by_label("Start here…").is_none(), "the whole line goes with the last hint");
    // Another scene does not bring them back.
    apply(&mut harness, Command::File(FileCommand::Discard(SceneReplacement::OpenCatalogue("tank".to_owned()))));
    assert!(harness.query_by_label("Scroll to zoom").is_none());
}

#[test]
fn hints_are_hidden_for_good() {
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("recovery.toml");
    let window = |kept: &std::path::Path| {
        let kept = kept.to_owned();
        let mut harness = Harness::builder().with_size(Vec2::new(1280.0, 800.0)).build_eframe(move |cc| {
            let mut app = ViewerApp::inline(&cc.egui_ctx, catalog::hanging_span(), None);
            app.enable_autosave(kept);
            app
        });
        harness.run_steps(5);
        harness
    };
    let mut harness = window(&kept);
    assert_eq!(hints(&harness), HINTS);
    harness.get_by_label("Hide these hints").click();
    harness.run_steps(3);
    assert!(hints(&harness).is_empty());
    assert!(hints(&window(&kept)).is_empty(), "a later window has none");
}

#[test]
fn start_here_leads_to_the_guides() {
    let mut harness = open_span();
    harness.get_by_label("Start here…").click();
    harness.run_steps(4);
    // The button that begins a guide was cut at the dialog's edge.
    let heights = [0, 3].map(|k: usize| harness.get_by_label(TUTORIALS[k].steps[0].text).rect().height());
    assert!(heights[0] > 1.5 * heights[1], "the first takes two lines, the fourth one: {heights:?}");
    assert_eq!(harness.state().state.ui.dialog, Some(Dialog::StartHere));
    harness.get_by_label(&format!("2. {}", TUTORIALS[1].title)).click();
    harness.run_steps(4);
    assert_eq!(harness.state().state.ui.tutorial, Some(TutorialPlace { tutorial: 1, step: 0 }));
    assert_eq!(harness.state().state.ui.dialog, None);
    // It is found in the menu and by name as well.
    harness.get_by_label("Learn").click();
    harness.run_steps(3);
    harness.get_by_label("Start here…").click();
    harness.run_steps(3);
    assert_eq!(harness.state().state.ui.dialog, Some(Dialog::StartHere));
}

/// A guide frames the control that it speaks of, wherever that is scrolled to, and nothing once it
/// ends.
#[test]
fn guides_point_at_what_they_speak_of() {
    for (tutorial, guide) in TUTORIALS.iter().enumerate() {
        let mut harness = open_span();
        apply(&mut harness, Command::SetModel(cable_core::Model::Auto));
        let begin = SceneReplacement::OpenTutorial { tutorial, scene: guide.scene };
        apply(&mut harness, Command::File(FileCommand::Discard(begin)));
        for (step, told) in guide.steps.iter().enumerate() {
            // The state that an earlier step would have made.
            match told.points_at {
                "Support waypoint of cable" if step == 1 => {
                    let waypoint = SceneCommand::AddWaypoint { cable: 0, arc_length_m: 5.0, at_m: [5.0, 3.5] };
                    apply(&mut harness, Command::Scene(waypoint));
                }
                "The scene cannot be solved" => {
                    let mut cable = harness.state().state.document.scene.cables[0].clone();
                    cable.length_m = 8.0;
                    let value = Box::new(cable);
                    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value }));
                }
                "Linear density" | "Length" => select(&mut harness, Item::Cable(0)),
                "Pause" => harness.key_press(Key::Space),
                _ => {}
            }
            apply(&mut harness, Command::View(ViewCommand::SetTutorialPlace(Some(TutorialPlace { tutorial, step }))));
            // Scrolling takes some frames.
            harness.run_steps(40);
            let window = harness.ctx.content_rect();
            let seen = highlight::visible_rect(&harness.ctx);
            let name = format!("{}, step {}: {}", guide.title, step + 1, told.points_at);
            assert!(seen.is_some_and(|rect| window.contains_rect(rect)), "{name}: {seen:?}");
        }
        apply(&mut harness, Command::View(ViewCommand::SetTutorialPlace(None)));
        assert_eq!(highlight::visible_rect(&harness.ctx), None);
    }
}

/// D10.8: Browse does nothing where there is no portal. The dialog lists the folder itself.
#[test]
fn a_file_is_picked_from_a_list_without_a_portal() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("scenes");
    std::fs::create_dir(&inner).unwrap();
    let file = inner.join("post.toml");
    cable_viewer::io::scene_file::save(&file, &catalog::round_post()).unwrap();
    std::fs::write(inner.join("notes.txt"), "").unwrap();
    let mut harness = open(catalog::hanging_span());
    let typed = folder.path().display().to_string();
    apply(&mut harness, Command::File(FileCommand::SetDialog(Some(Dialog::Open { path: typed }))));
    harness.run_steps(3);
    harness.get_by_label("scenes/").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("notes.txt").is_none());
    harness.get_by_label("..").click();
    harness.run_steps(3);
    harness.get_by_label("scenes/").click();
    harness.run_steps(3);
    harness.get_by_label("post.toml").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(egui::accesskit::Role::Button, "Open").click();
    harness.run_steps(4);
    assert_eq!(harness.state().state.document.path.as_deref(), Some(file.as_path()));
    assert!(harness.state().state.ui.recent.contains(&file));

    // Saving keeps the typed name in another folder.
    let typed = folder.path().join("mine.toml").display().to_string();
    apply(&mut harness, Command::File(FileCommand::SetDialog(Some(Dialog::SaveAs { path: typed }))));
    harness.run_steps(3);
    harness.get_by_label("scenes/").click();
    harness.run_steps(3);
    let saved = inner.join("mine.toml");
    assert_eq!(harness.state().state.ui.dialog, Some(Dialog::SaveAs { path: saved.display().to_string() }));
    harness.get_by_role_and_label(egui::accesskit::Role::Button, "Save").click();
    harness.run_steps(3);
    assert!(saved.is_file());
}

#[test]
fn a_map_is_picked_from_a_list_too() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ground.csv");
    std::fs::write(&file, "x,y\n0,0\n5,0.5\n20,0\n").unwrap();
    let mut harness = open(catalog::hanging_span());
    let (path, text, unit_m) = (folder.path().display().to_string(), String::new(), "1".to_owned());
    apply(&mut harness, Command::File(FileCommand::SetDialog(Some(Dialog::ImportMap { path, text, unit_m }))));
    harness.run_steps(3);
    for label in ["Pick a file", "ground.csv", "Import"] {
        harness.get_by_label(label).click();
        // A header takes some frames to open.
        harness.run_steps(20);
    }
    assert_eq!(harness.state().state.document.scene.obstacles.len(), 1);
}

/// Issue 20: "Drag the robot" is the first hint, and a press a point beside its hull moved the
/// view.
#[test]
fn issue_020_a_press_beside_the_hull_of_the_robot_picks_it() {
    let mut harness = open(catalog::tank_robot());
    let canvas = harness.get_by_label("Canvas").rect();
    let (top, camera) = {
        let state = &harness.state().state;
        let outline = robot_outline(state);
        let back = outline.iter().copied().min_by(|a, b| a[0].total_cmp(&b[0])).unwrap();
        let top = outline.iter().copied().filter(|p| p[0] < back[0] + 1.0).max_by(|a, b| a[1].total_cmp(&b[1]));
        (top.unwrap(), state.view.camera)
    };
    let from = camera.to_screen(canvas, top) - Vec2::new(0.0, 3.0);
    let before = harness.state().state.document.scene.robot.as_ref().unwrap().at_m;
    drag(&mut harness, from, Vec2::new(-30.0, 0.0));
    let state = &harness.state().state;
    assert_eq!(state.selection.selected, Some(Item::Robot));
    assert!(state.document.scene.robot.as_ref().unwrap().at_m[0] < before[0] - 0.2);
    assert_eq!(state.view.camera.centre_m, camera.centre_m, "the view stays");
}
