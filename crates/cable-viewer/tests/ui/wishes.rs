//! These tests are wishes and test cases of the users that no other file tells: each test is named
//! after its row.

#[path = "../../../cable-core/tests/dice/mod.rs"]
mod dice;

use cable_core::Model;
use cable_core::scene::catalog;
use cable_core::scene::preset::cable_presets;
use cable_core::solution::WarningKind;
use cable_viewer::canvas::layers::grid;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::Item;
use dice::MmixDice;
use egui::Vec2;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::rows::{answer, click, crossing, play, set_cable, state, warned};
use crate::{apply, open, open_span};

#[test]
fn u02_grid_lines_are_round_and_numbered() {
    let mut harness = open_span();
    for _ in 0..12 {
        let camera = state(&harness).view.camera;
        let [major, minor] = grid::steps(&camera);
        let lead = major / 10f64.powf(major.log10().floor());
        assert!([1.0, 2.0, 5.0, 10.0].iter().any(|k| (lead / k - 1.0).abs() < 1e-9), "{major}");
        assert!(minor < major && major * camera.points_per_m >= 64.0 - 1e-9);
        apply(&mut harness, Command::View(ViewCommand::Zoom { about_m: [0.0, 0.0], factor: 1.37 }));
    }
}

#[test]
fn u03_both_ends_are_labelled_with_x_and_y() {
    let mut harness = open_span();
    let told = harness.get_by_label("Canvas").accesskit_node().description().unwrap_or_default();
    assert!(told.contains("left at (0.000, 5.000) m") && told.contains("right at (10.000, 5.000) m"), "{told}");
    for (support, labels) in [(0, ["x of left", "y of left"]), (1, ["x of right", "y of right"])] {
        crate::select(&mut harness, Item::Support { cable: 0, support });
        for label in labels {
            harness.get_by_label(label);
        }
    }
}

#[test]
fn u04_sag_and_tension_stand_in_the_window() {
    let harness = open_span();
    harness.get_by_label("Greatest tension");
    harness.get_by_label("Sag");
    let text = cable_viewer::units::format::force(answer(&harness).max_tension().tension_n);
    assert!(harness.get_all_by_label(&text).count() >= 1, "{text}");
}

#[test]
fn u05_many_segments_are_edited_and_run() {
    let mut harness = open_span();
    for segments in [20, 200, 1000] {
        set_cable(&mut harness, |c| c.segments = Some(segments));
        assert_eq!(state(&harness).live.snapshot.error, None, "{segments}");
        assert_eq!(answer(&harness).cables[0].nodes.len(), segments + 1);
        play(&mut harness, 2);
        assert_eq!(state(&harness).live.snapshot.error, None, "{segments}");
        apply(&mut harness, Command::Playback(PlaybackCommand::Reset));
    }
}

#[test]
fn u06_the_return_trip_is_driven() {
    let mut scene = catalog::robot_drive();
    let robot = scene.robot.as_mut().unwrap();
    let leg = |to_x_m| cable_core::scene::RobotTask::Drive { to_x_m, speed_m_per_s: 0.6 };
    (robot.path, robot.repeat) = (vec![leg(10.5), leg(10.0)], false);
    let mut harness = open(scene);
    play(&mut harness, 330);
    let seen: Vec<f64> = state(&harness).live.recording.answers().iter().filter_map(|a| Some(a.robot?.x_m)).collect();
    let most = seen.iter().copied().fold(f64::MIN, f64::max);
    assert!(most > 10.45 && (seen.last().unwrap() - 10.0).abs() < 0.1, "{most} {:?}", seen.last());
}

#[test]
fn u08_a_length_below_the_way_is_said_before_anything_fails_and_put_right() {
    let mut harness = open_span();
    set_cable(&mut harness, |c| {
        c.length_m = 9.0;
        c.breaking_tension_n = 1e4;
    });
    assert!(state(&harness).document.fault.is_some());
    assert!(harness.get_all_by_label_contains("needs ≥ ").count() >= 1);
    let fix = harness.get_all_by_label_contains("Set to ").next().expect("a fix");
    fix.click();
    harness.run_steps(3);
    assert_eq!(state(&harness).document.fault, None);
    assert_eq!(state(&harness).live.snapshot.error, None);
}

#[test]
fn u09_tangles_and_tight_bends_are_warned_of() {
    let mut harness = open(crossing());
    apply(&mut harness, Command::SetModel(Model::Fem));
    assert!(warned(&harness, WarningKind::Loop));
    let mut harness = open(catalog::pulley_waypoints());
    apply(&mut harness, Command::SetModel(Model::Fem));
    set_cable(&mut harness, |c| c.min_bend_radius_m = 5.0);
    assert!(warned(&harness, WarningKind::BendRadius), "{:?}", answer(&harness).warnings);
    harness.get_by_label_contains("Bend too tight");
}

#[test]
fn u10_overstretch_is_warned_of() {
    let mut harness = open_span();
    let most = answer(&harness).max_tension().tension_n;
    set_cable(&mut harness, |c| c.service_tension_n = 0.5 * most);
    assert!(warned(&harness, WarningKind::ServiceTension));
    assert!(harness.get_all_by_label_contains(" of service ").count() >= 1, "the share of it is told too");
}

#[test]
fn u15_density_is_per_metre_and_presets_say_where_theirs_is_from() {
    let mut harness = open_span();
    crate::select(&mut harness, Item::Cable(0));
    let text = harness.get_by_label("Linear density").accesskit_node().value().unwrap_or_default();
    assert!(text.ends_with(" kg/m"), "{text}");
    assert!(cable_presets().len() >= 3);
    for preset in cable_presets() {
        let value =
            cable_viewer::panels::cable::provenance::with_preset(&state(&harness).document.scene.cables[0], preset);
        let density = value.linear_density_kg_per_m;
        apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(value) }));
        assert_eq!(state(&harness).document.fault, None, "{}", preset.id);
        assert!(density > 0.0 && density < 50.0, "{}", preset.id);
        assert!(!preset.note.is_empty());
    }
}

#[test]
fn u16_whatever_is_edited_the_window_answers_or_says_why() {
    let mut harness = open(catalog::over_beam());
    let mut dice = MmixDice(7);
    for k in 0..60 {
        let sizes = [1e-6, 0.3, 1.0, 3.0, 1e6, 0.0, -1.0, f64::NAN];
        let factor = sizes[(dice.unit() * 8.0) as usize];
        let which = (dice.unit() * 11.0) as usize;
        let property = &cable_viewer::panels::cable::property::PROPERTIES[which];
        set_cable(&mut harness, |c| (property.set)(c, (property.get)(c) * factor));
        if k % 4 == 0 {
            play(&mut harness, 2);
            apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
        }
        let s = state(&harness);
        assert!(s.live.snapshot.solution.is_some(), "{k}: the picture stays");
        if s.document.fault.is_some() {
            assert!(
                s.live.snapshot.error.is_some() && s.live.snapshot.stale,
                "{k}: {} × {factor} fails in silence",
                property.key
            );
        }
        if s.document.fault.is_some() || s.live.snapshot.error.is_some() {
            harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
            harness.run_steps(2);
        }
        for n in &answer(&harness).cables[0].nodes {
            assert!(n.x_m.is_finite() && n.y_m.is_finite() && n.tension_n.is_finite(), "{k}: {n:?}");
        }
    }
}

#[test]
fn u17_mass_and_length_change_live() {
    let mut harness = open_span();
    play(&mut harness, 5);
    for k in 0..20 {
        set_cable(&mut harness, |c| {
            c.length_m = 12.0 + 0.05 * f64::from(k);
            c.linear_density_kg_per_m = 1.0 + 0.1 * f64::from(k);
        });
        assert_eq!(state(&harness).live.snapshot.error, None, "{k}");
        let end = answer(&harness).cables[0].nodes.last().unwrap().arc_length_m;
        assert!((end - 12.0 - 0.05 * f64::from(k)).abs() < 1e-9, "{end}");
    }
    assert!(answer(&harness).time_s > 0.5, "time ran on");
}

#[test]
fn u19_every_figure_can_be_taken_along() {
    let mut harness = open_span();
    play(&mut harness, 10);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    apply(&mut harness, Command::File(FileCommand::SaveRun(run.clone())));
    for (name, column) in [("history.csv", "max_tension_n"), ("nodes.csv", "stress_pa"), ("events.csv", "kind")] {
        let text = std::fs::read_to_string(run.join(name)).unwrap();
        assert!(text.lines().next().is_some_and(|l| l.split(',').any(|c| c == column)), "{name}");
    }
}

#[test]
fn t02_parameters_take_effect_and_paradoxes_are_refused() {
    let mut harness = open_span();
    let before = answer(&harness).max_tension().tension_n;
    set_cable(&mut harness, |c| c.linear_density_kg_per_m *= 2.0);
    assert!((answer(&harness).max_tension().tension_n / before - 2.0).abs() < 0.01, "twice the weight, twice the pull");
    set_cable(&mut harness, |c| c.service_tension_n = 2.0 * c.breaking_tension_n);
    assert!(state(&harness).document.fault.is_some());
    assert!(harness.get_all_by_label_contains("breaking").count() >= 1);
}

#[test]
fn t03_a_force_diagram_follows_the_load() {
    let mut harness = open_span();
    click(&mut harness, "Add load");
    let before = answer(&harness).cables[0].supports.clone();
    let load = cable_core::Load { force_n: Some([0.0, -300.0]), ..state(&harness).document.scene.loads[0].clone() };
    apply(&mut harness, Command::Scene(SceneCommand::SetLoad { load: 0, value: load }));
    let after = answer(&harness).cables[0].supports.clone();
    let down = |list: &[cable_core::solution::SupportReaction]| list.iter().map(|s| s.reaction_y_n).sum::<f64>();
    // The supports bear the whole load: 200 N more.
    assert!((down(&before) - down(&after) - 200.0).abs() < 0.5, "{} {}", down(&before), down(&after));
}

#[test]
fn t04_fast_moves_of_the_camera_neither_lose_it_nor_touch_the_scene() {
    let mut harness = open(catalog::tank());
    let scene = state(&harness).document.scene.clone();
    let mut dice = MmixDice(3);
    for _ in 0..200 {
        let by = Vec2::new(dice.unit() as f32 - 0.5, dice.unit() as f32 - 0.5) * 400.0;
        let factor = (4.0 * (dice.unit() - 0.5)).exp();
        let ctx = harness.ctx.clone();
        let about_m = state(&harness).view.camera.centre_m;
        let commands = vec![Command::View(ViewCommand::Pan(by)), Command::View(ViewCommand::Zoom { about_m, factor })];
        harness.state_mut().apply(&ctx, commands);
        harness.step();
        let camera = state(&harness).view.camera;
        assert!(camera.centre_m.iter().all(|v| v.is_finite()) && camera.points_per_m > 0.0);
    }
    apply(&mut harness, Command::View(ViewCommand::Fit));
    let canvas = harness.get_by_label("Canvas").rect();
    for s in &scene.cables[0].supports {
        let at = state(&harness).view.camera.to_screen(canvas, s.at_m.unwrap());
        assert!(canvas.contains(at), "{} is in view again", s.name);
    }
    assert_eq!(state(&harness).document.scene, scene);
}

/// Sunny: four good marks are kept. Rainy: a low mark is not taken without what confused, and that
/// is kept with what was on screen.
#[test]
fn t05_marks_are_kept_and_a_low_one_with_what_confused() {
    use cable_viewer::io::feedback::QUESTIONS;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("feedback.csv");
    let mut harness = open(catalog::round_post());
    let mark = |harness: &mut egui_kittest::Harness<'_, cable_viewer::ViewerApp>, marks: [u8; 4]| {
        click(harness, "Feedback");
        harness.run_steps(3);
        for ((_, question), k) in QUESTIONS.iter().zip(marks) {
            click(harness, &format!("{question}: {k}"));
        }
        let Some(cable_viewer::state::dialog::Dialog::Feedback { path: typed, .. }) =
            &mut harness.state_mut().state.ui.dialog
        else {
            panic!("no dialog");
        };
        *typed = path.display().to_string();
        harness.run_steps(2);
    };
    mark(&mut harness, [5, 4, 5, 4]);
    click(&mut harness, "Save feedback");
    assert!(state(&harness).ui.dialog.is_none());
    mark(&mut harness, [4, 2, 5, 4]);
    click(&mut harness, "Save feedback");
    assert!(state(&harness).ui.dialog.is_some(), "a low mark without words is not taken");
    harness.get_by_label_contains("please say what was confusing");
    harness.get_by_label("What was confusing or should change?").focus();
    harness.run_steps(2);
    harness.get_by_label("What was confusing or should change?").type_text("which end, \"left\"?");
    harness.run_steps(2);
    click(&mut harness, "Save feedback");
    assert!(state(&harness).ui.dialog.is_none());
    let text = std::fs::read_to_string(&path).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 3, "{text}");
    assert!(rows[0].starts_with("useful,clear,realistic,easy,confused_by,scene,model"), "{text}");
    assert!(rows[1].starts_with("5,4,5,4,\"\","), "{text}");
    let scene = &state(&harness).document.scene.name;
    assert!(rows[2].starts_with(&format!("4,2,5,4,\"which end, \"\"left\"\"?\",\"{scene}\",")), "{text}");
}

#[test]
fn t05_what_is_picked_is_said_and_shown() {
    let mut harness = open(catalog::tank());
    for item in [Item::Support { cable: 0, support: 0 }, Item::Obstacle(0), Item::Cable(0)] {
        apply(&mut harness, Command::View(ViewCommand::Select(Some(item))));
        let told = harness.get_by_label("Canvas").accesskit_node().description().unwrap_or_default();
        assert!(told.contains("selected: "), "{told}");
    }
}
