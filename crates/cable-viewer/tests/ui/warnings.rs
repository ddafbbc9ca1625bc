//! Warnings are rows of a line each, whatever the width of the panel; a click leads to the place,
//! and the words come on demand.

use cable_core::scene::catalog;
use cable_core::solution::{Warning, WarningCause, WarningKind};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::{Item, OpenPanels};
use egui::{Order, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, kinked_tank, open};

/// Warnings of a scene that has several at rest, one of them with a long name.
const TOLD: [&str; 2] = ["Kinked at", "Depends on how it was laid"];

#[test]
fn a_warning_is_one_line_at_every_width() {
    let mut harness = open(kinked_tank());
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
        harness.set_size(Vec2::from(size));
        harness.run_steps(4);
        let window = harness.ctx.content_rect();
        let rows = TOLD.map(|told| harness.get_by_label_contains(told).rect());
        for (row, told) in rows.iter().zip(TOLD) {
            assert!(row.height() < 24.0, "{size:?}: {told} is {} high", row.height());
            assert!(window.contains_rect(*row), "{size:?}: {told} at {row}");
        }
        assert!(rows[1].top() - rows[0].top() < 66.0, "{size:?}: {rows:?}");
    }
}

/// A kind of warning with figures as long as they come, and the place that is told of it.
fn long_figures(kind: WarningKind) -> (Warning, &'static str) {
    use WarningKind as Kind;
    let [value, limit] = match kind {
        Kind::BreakingTension | Kind::Broken | Kind::MayBreak => [1934.5, 1800.0],
        Kind::ServiceTension => [12_345.0, 800.0],
        Kind::Kink | Kind::BendRadius => [0.0231, 0.14],
        Kind::SidewallPressure => [5833.0, 4380.0],
        Kind::Slack => [45.32, 0.0],
        Kind::Accuracy => [4.1e-3, 1e-3],
        Kind::Wrapped => [1.25, 0.5],
        Kind::Curl => [270.0, 270.0],
        Kind::Snag => [1.82, 1.5],
        Kind::EnergyGrows => [4321.0, 1.0],
        _ => [0.0, 0.0],
    };
    let cause = WarningCause::Recorded { kind, message: "as it says".to_owned() };
    let warning = Warning { since_s: Some(12.34), ..Warning::new(cause, "cable", 12.0, [value, limit]) };
    (warning, if kind == Kind::NotUnique { "" } else { "12.00\u{a0}m" })
}

/// At 1280×800 the place of four kinds was cut: "Above service 93.23 N > 80.00 N at…".
#[test]
fn no_line_of_a_warning_is_cut_and_each_ends_with_its_place() {
    use WarningKind as Kind;
    let mut harness = open(catalog::tank());
    let mut cut = Vec::new();
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
        harness.set_size(Vec2::from(size));
        for kind in [
            Kind::BreakingTension,
            Kind::Broken,
            Kind::MayBreak,
            Kind::Kink,
            Kind::SidewallPressure,
            Kind::Loop,
            Kind::Curl,
            Kind::Wrapped,
            Kind::Snag,
            Kind::Slack,
            Kind::ServiceTension,
            Kind::BendRadius,
            Kind::Accuracy,
            Kind::SupportHeld,
            Kind::InitialPenetration,
            Kind::ClearOfWheel,
            Kind::ThroughRobot,
            Kind::RobotInObstacle,
            Kind::Stabilised,
            Kind::EnergyGrows,
            Kind::NotUnique,
        ] {
            let (warning, place) = long_figures(kind);
            let live = &mut harness.state_mut().state.live;
            let mut answer = (**live.snapshot.solution.as_ref().unwrap()).clone();
            answer.warnings = vec![warning];
            live.snapshot.solution = Some(std::sync::Arc::new(answer));
            harness.run_steps(2);
            // Its row, by the button at its end.
            let row = harness.get_by_label("Details of warning 1").rect();
            let mut texts = Vec::new();
            harness.output().shapes.iter().for_each(|s| galleys(&s.shape, &mut texts));
            let beside = |r: egui::Rect| row.y_range().contains(r.center().y) && r.right() < row.right() + 1.0;
            let panel = size[0] - 350.0;
            let line: Vec<_> = texts.iter().filter(|(_, r, _)| beside(*r) && r.left() > panel).collect();
            assert!(!line.is_empty(), "{kind:?}");
            let ends = place.is_empty() || line.iter().any(|(text, ..)| text == place);
            if !ends || line.iter().any(|(.., elided)| *elided) {
                cut.push(format!("{size:?} {kind:?}: {:?}", line.iter().map(|(t, ..)| t).collect::<Vec<_>>()));
            }
        }
    }
    assert!(cut.is_empty(), "{cut:#?}");
}

/// Every text of a picture, its place, and whether it is cut.
pub fn galleys(shape: &egui::Shape, out: &mut Vec<(String, egui::Rect, bool)>) {
    match shape {
        egui::Shape::Text(text) => {
            out.push((text.galley.text().to_owned(), text.visual_bounding_rect(), text.galley.elided));
        }
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|s| galleys(s, out)),
        _ => {}
    }
}

/// Opens the words of the warning that says how a cable was laid.
fn open_laid(harness: &mut Harness<'_, ViewerApp>) {
    let row = harness.get_by_label_contains(TOLD[1]).rect();
    let details = harness.query_all_by_label_contains("Details of warning");
    let own = details.min_by(|a, b| {
        let far = |n: &egui_kittest::Node<'_>| (n.rect().center().y - row.center().y).abs();
        far(a).total_cmp(&far(b))
    });
    own.expect("its details").click();
    harness.run_steps(3);
}

/// A route that an edit had written could only be taken away in the scene's file.
#[test]
fn a_cable_that_a_route_or_time_led_can_be_laid_anew() {
    let mut scene = catalog::tank();
    scene.cables[0].route_m.clear();
    let mut harness = open(scene);
    let start = harness.state().state.live.snapshot.solution.clone().unwrap();
    let scene = harness.state().state.document.scene.clone();
    // As laid from its supports there is nothing to lay anew.
    open_laid(&mut harness);
    let enabled = |h: &Harness<'_, ViewerApp>| {
        let button = h.get_by_label("Lay again");
        !egui_kittest::kittest::NodeT::accesskit_node(&button).is_disabled()
    };
    assert!(!enabled(&harness));
    // A little above where it lies.
    let mut led = scene.cables[0].clone();
    led.route_m = start.cables[0].nodes.iter().step_by(12).map(|n| [n.x_m, n.y_m + 0.3]).collect();
    let command = SceneCommand::SetCable { cable: 0, value: Box::new(led) };
    apply(&mut harness, Command::Scene(command));
    assert_eq!(harness.state().state.live.snapshot.error, None);
    let before = harness.state().state.document.scene.clone();
    assert!(!before.cables[0].route_m.is_empty() && enabled(&harness));
    harness.get_by_label("Lay again").click();
    harness.run_steps(3);
    assert_eq!(harness.state().state.document.scene, scene);
    let anew = harness.state().state.live.snapshot.solution.clone().unwrap();
    assert_eq!(anew.cables[0].nodes, start.cables[0].nodes, "bit for bit as laid at first");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(3);
    assert_eq!(harness.state().state.document.scene, before);
    // Time leads it too.
    apply(&mut harness, Command::Scene(SceneCommand::Redo));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(20);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    assert!(harness.state().state.live.snapshot.solution.as_ref().unwrap().time_s > 0.0);
    apply(&mut harness, Command::Scene(SceneCommand::LayAnew { cable: 0 }));
    harness.run_steps(3);
    let anew = harness.state().state.live.snapshot.solution.clone().unwrap();
    assert_eq!((anew.time_s, &anew.cables[0].nodes), (0.0, &start.cables[0].nodes));
}

#[test]
fn a_click_on_a_warning_zooms_and_its_words_stand_on_hover_or_below() {
    let mut harness = open(kinked_tank());
    harness.ctx.all_styles_mut(|style| {
        style.interaction.tooltip_delay = 0.0;
        style.interaction.show_tooltips_only_when_still = false;
    });
    let answer = harness.state().state.live.snapshot.solution.clone().unwrap();
    let kink = answer.warnings.iter().find(|w| w.kind == WarningKind::Kink).expect("a kink");
    let words = cable_viewer::units::sentence::sentence(kink);
    assert!(harness.query_by_label(&words).is_none(), "not before they are asked for");
    let row = harness.get_by_label_contains(TOLD[0]).rect();
    harness.hover_at(row.center());
    harness.run_steps(3);
    assert!(harness.ctx.memory(|m| m.areas().visible_layer_ids().iter().any(|l| l.order == Order::Tooltip)));
    let before = harness.state().state.view.camera.points_per_m;
    harness.get_by_label_contains(TOLD[0]).click();
    harness.run_steps(3);
    assert!(harness.state().state.view.camera.points_per_m > 1.5 * before);
    harness.get_by_label("Details of warning 1").click();
    harness.run_steps(3);
    harness.get_by_label(&words);
}

/// Issue 20: what lies above the form scrolled out of sight as warnings came.
#[test]
fn issue_020_the_worst_warning_stands_on_top_whatever_is_scrolled() {
    let mut scene = catalog::tank();
    (scene.cables[0].service_tension_n, scene.cables[0].min_bend_radius_m) = (20.0, 5.0);
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0], [820.0, 600.0]] {
        let mut harness = open(scene.clone());
        harness.set_size(Vec2::from(size));
        apply(&mut harness, Command::View(ViewCommand::Select(Some(Item::Cable(0)))));
        harness.run_steps(4);
        let answer = harness.state().state.live.snapshot.solution.clone().unwrap();
        assert!(answer.warnings.len() > 2, "{:?}", answer.warnings);
        let seen = |h: &Harness<'_, ViewerApp>| {
            for text in ["% of service", "verified", "Max "] {
                assert!(h.query_all_by_label_contains(text).any(|n| n.rect().bottom() < 30.0), "{size:?}: {text}");
            }
            let worst = h.get_by_label("Details of warning 1").rect();
            assert!(worst.top() > 0.0 && worst.right() <= size[0] && worst.bottom() < 240.0, "{size:?}: {worst}");
        };
        seen(&harness);
        let last = if size[0] < 1000.0 { "Friction slider" } else { "Compare all models" };
        harness.query_all_by_label_contains(last).next().expect("what is at the end").scroll_to_me();
        harness.run_steps(4);
        seen(&harness);
        // With the panel folded it stands in the strip above the canvas, where it is not cut to its
        // first letters.
        let panels = OpenPanels { results: false, edit: false, ..harness.state().state.ui.panels };
        apply(&mut harness, Command::View(ViewCommand::ShowPanels(panels)));
        harness.run_steps(2);
        let worst = harness.get_by_label("Worst warning").rect();
        let canvas = harness.get_by_label("Canvas").rect();
        assert!(worst.bottom() <= canvas.top() && worst.width() > 120.0, "{size:?}: {worst}");
    }
}

/// A click on it shows the place, and where there is nothing to warn of it says so in as much room.
#[test]
fn the_line_of_the_worst_warning_leads_to_its_place_and_takes_the_same_room_without_one() {
    let mut harness = open(catalog::hanging_span());
    let empty = harness.get_by_label("No warnings").rect();
    let below = harness.get_by_label("Readouts").rect().top();
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.service_tension_n = 10.0;
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    harness.run_steps(3);
    let row = harness.get_by_label("Details of warning 1").rect();
    assert!((row.center().y - empty.center().y).abs() < 3.0, "{row} {empty}");
    assert!((harness.get_by_label("Readouts").rect().top() - below).abs() < 1.0);
    let before = harness.state().state.view.camera.points_per_m;
    harness.get_by_label_contains("Above service tension at").click();
    harness.run_steps(3);
    assert!(harness.state().state.view.camera.points_per_m > 1.5 * before);
}

/// Issue 20: while a cable is pulled, "Support blocked" stood on top, and 318 % of the service
/// tension below it.
#[test]
fn issue_020_a_tension_above_its_limit_comes_first_among_equals() {
    let mut scene = kinked_tank();
    scene.cables[0].service_tension_n = 20.0;
    let mut harness = open(scene);
    let live = &mut harness.state_mut().state.live;
    let mut answer = (**live.snapshot.solution.as_ref().unwrap()).clone();
    answer.warnings.sort_by_key(|w| w.kind == WarningKind::ServiceTension);
    assert!(answer.warnings.iter().any(|w| w.kind == WarningKind::Kink), "{:?}", answer.warnings);
    live.snapshot.solution = Some(std::sync::Arc::new(answer));
    harness.run_steps(2);
    let first = harness.get_by_label("Details of warning 1").rect().center().y;
    let row = harness.get_by_label_contains("Above service tension at").rect();
    assert!(row.y_range().contains(first), "{row} beside {first}");
}

/// A remark on how the cable was laid was counted as a warning.
#[test]
fn notes_are_counted_as_notes() {
    let harness = open(catalog::over_beam());
    let notes = &harness.state().state.live.snapshot.solution.as_ref().unwrap().warnings;
    assert!(notes.len() == 1 && notes[0].kind == WarningKind::NotUnique, "{notes:?}");
    harness.get_by_label("1 note");
}
