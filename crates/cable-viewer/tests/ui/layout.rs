//! Room for the picture: how much of the window the canvas has, and that nothing but the user
//! changes that.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, SceneCommand, ViewCommand};
use cable_viewer::state::{Item, OpenPanels};
use egui::{Key, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

/// The canvas as a part of the window.
fn share(harness: &Harness<'_, ViewerApp>, [width, height]: [f32; 2]) -> f32 {
    let canvas = harness.get_by_label("Canvas").rect();
    canvas.area() / (width * height)
}

#[test]
fn the_canvas_has_most_of_the_window() {
    for (size, folded, with_graphs) in [([1280.0, 800.0], 0.60, 0.48), ([1024.0, 640.0], 0.50, 0.40)] {
        let mut harness = Harness::builder()
            .with_size(Vec2::from(size))
            .allow_missing_glyphs()
            .build_eframe(|cc| ViewerApp::inline(&cc.egui_ctx, catalog::tank(), None));
        harness.run_steps(6);
        let share_with_graphs = share(&harness, size);
        harness.key_press(Key::G);
        harness.run_steps(4);
        let share_folded = share(&harness, size);
        println!("{size:?}: {:.1} % with graphs, {:.1} % without", 100.0 * share_with_graphs, 100.0 * share_folded);
        assert!(share_folded >= folded, "{size:?}: {share_folded}");
        assert!(share_with_graphs >= with_graphs, "{size:?}: {share_with_graphs}");
        // One key each; the same key brings it back.
        for key in [Key::OpenBracket, Key::CloseBracket] {
            let before = harness.get_by_label("Canvas").rect().width();
            harness.key_press(key);
            harness.run_steps(4);
            assert!(harness.get_by_label("Canvas").rect().width() > before + 150.0);
            harness.key_press(key);
            harness.run_steps(4);
            assert_eq!(harness.get_by_label("Canvas").rect().width(), before);
        }
    }
}

/// Graphs were 35 points high at 1280×800, and half as wide as the canvas.
#[test]
fn graphs_are_high_and_wide_enough_to_read() {
    for (size, least) in [([1280.0, 800.0], [400.0, 80.0]), ([1024.0, 640.0], [280.0, 60.0])] {
        let mut harness = open(catalog::tank());
        harness.set_size(Vec2::from(size));
        harness.run_steps(4);
        for name in ["Over time", "Along the cable"] {
            let graph = harness.get_by_role_and_label(egui::accesskit::Role::Figure, name).rect();
            println!("{size:?}: {name} is {} by {} points", graph.width(), graph.height());
            assert!(graph.width() >= least[0] && graph.height() >= least[1], "{size:?}: {name} at {graph}");
        }
    }
}

/// The window opens on a robot in a tank, with nothing to warn of and three hints.
#[test]
fn the_window_opens_on_a_robot_without_a_warning() {
    let (_, first) = catalog::all().into_iter().next().expect("a scene");
    assert!(first.robot.is_some() && first.name.contains("tank"), "{}", first.name);
    let mut harness = open(first);
    harness.get_by_label("No warnings");
    for hint in ["Drag the robot", "Press Space to play", "Scroll to zoom"] {
        harness.get_by_label(hint);
    }
    // Nor in the first minute of play.
    harness.key_press(Key::Space);
    for _ in 0..60 {
        harness.run_steps(30);
        let state = &harness.state().state;
        assert!(state.live.snapshot.error.is_none() && state.live.recording.events().is_empty());
    }
    assert!(harness.state().state.live.snapshot.solution.as_ref().unwrap().time_s > 29.0);
}

/// D10.4: the side panels grew with what was in them, from 624 to 505 points of canvas in one
/// sitting.
#[test]
fn what_is_in_a_panel_does_not_move_the_canvas() {
    let mut harness = open(catalog::tank());
    let before = harness.get_by_label("Canvas").rect();
    for item in [Item::Support { cable: 0, support: 1 }, Item::Obstacle(0), Item::Cable(0)] {
        apply(&mut harness, Command::View(ViewCommand::Select(Some(item))));
        assert_eq!(harness.get_by_label("Canvas").rect(), before, "{item:?}");
    }
    for _ in 0..3 {
        apply(&mut harness, Command::View(ViewCommand::Hold));
    }
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    (cable.service_tension_n, cable.name) = (1.0, "a cable with an unreasonably long name for a panel".to_owned());
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    assert_eq!(harness.get_by_label("Canvas").rect(), before);
}

/// The scene stays fitted when the window changes, until the view is moved by hand.
#[test]
fn a_fitted_scene_is_fitted_again_when_the_window_changes() {
    let mut harness = open(catalog::hanging_span());
    let ends = |h: &Harness<'_, ViewerApp>| {
        let canvas = h.get_by_label("Canvas").rect();
        let camera = h.state().state.view.camera;
        [[0.0, 5.0], [10.0, 5.0]].map(|p| (canvas, camera.to_screen(canvas, p)))
    };
    harness.set_size(Vec2::new(900.0, 560.0));
    harness.run_steps(4);
    assert!(ends(&harness).iter().all(|(canvas, p)| canvas.shrink(30.0).contains(*p)), "{:?}", ends(&harness));
    harness.set_size(Vec2::new(1280.0, 800.0));
    harness.run_steps(4);
    let [(canvas, a), (_, b)] = ends(&harness);
    assert!(b.x - a.x > 0.7 * canvas.width(), "{:?}", ends(&harness));
    // Moved by hand it stays.
    apply(&mut harness, Command::View(ViewCommand::Pan(Vec2::new(50.0, 0.0))));
    let camera = harness.state().state.view.camera;
    harness.set_size(Vec2::new(1000.0, 700.0));
    harness.run_steps(4);
    assert_eq!(harness.state().state.view.camera, camera);
}

/// The greatest tension, its utilisation and the verdict are in sight whatever is scrolled or
/// folded.
#[test]
fn the_result_is_always_on_top() {
    let mut harness = open(catalog::tank());
    let panels = OpenPanels { edit: false, results: false, graphs: false };
    apply(&mut harness, Command::View(ViewCommand::ShowPanels(panels)));
    let most = harness.state().state.live.snapshot.solution.as_ref().unwrap().max_tension().tension_n;
    let text = format!("Max {}", cable_viewer::units::format::force(most));
    for label in [text.as_str(), "verified"] {
        assert!(harness.get_by_label_contains(label).rect().bottom() < 30.0, "{label}");
    }
    assert!(harness.get_by_label_contains("% of service").rect().bottom() < 30.0);
    let before = harness.state().state.view.camera.points_per_m;
    harness.get_by_label(&text).click();
    harness.run_steps(3);
    assert!(harness.state().state.view.camera.points_per_m > 1.5 * before, "a click zooms on it");
}
