//! The canvas has enough of the window, and nothing but the user changes how much.

use cable_core::analysis::tension_budget::StartEnd;
use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use cable_viewer::state::{FirstSteps, Item, OpenPanels, TensionMarker};
use cable_viewer::units::system::System;
use egui::{Key, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open, select};

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
        apply(&mut harness, Command::View(ViewCommand::AddReference));
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

/// A selected form pushed the results out of sight: the greatest tension, its share of the limits
/// and the verdict stand above everything that scrolls, at every usual size.
#[test]
fn results_stand_above_the_form_of_what_is_selected() {
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
        let mut harness = open(catalog::tank());
        harness.set_size(Vec2::from(size));
        for item in [Item::Support { cable: 0, support: 1 }, Item::Cable(0), Item::Obstacle(0)] {
            let select = ViewCommand::Select(Some(item));
            apply(&mut harness, Command::View(select));
            harness.run_steps(4);
            let form = harness.get_by_label("Selected").rect();
            for text in [
                "Greatest tension",
                " of service 800.0 N",
                " of break 10.00 kN",
                "Ends ",
                "verified",
                "13.1 % of service",
            ] {
                let figures = harness.query_all_by_label_contains(text).map(|n| n.rect());
                let seen = figures.filter(|r| r.min.x >= 0.0 && r.max.x <= size[0] && r.max.y < form.min.y).count();
                assert!(seen > 0, "{size:?}, {item:?}: {text}");
            }
        }
    }
}

/// Words beside the timeline made its row wider than the panel, and so the graphs, whose export was
/// cut.
#[test]
fn a_recording_with_events_does_not_push_the_graphs_out_of_sight() {
    let mut scene = catalog::tank_robot();
    scene.cables[0].service_tension_n = 100.0;
    let mut harness = open(scene);
    // Nothing is recorded yet, so nothing happened.
    assert!(harness.query_by_label_contains("event").is_none());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(40);
    assert!(!harness.state().state.live.recording.events().is_empty());
    apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(true)));
    let last = harness.state().state.live.recording.span_s().expect("a recording")[1];
    for shown in [None, Some(0.5 * last)] {
        apply(&mut harness, Command::Playback(PlaybackCommand::ShowTime(shown)));
        for size in [[1280.0, 800.0], [1024.0, 640.0]] {
            harness.set_size(Vec2::from(size));
            harness.run_steps(4);
            let results = harness.get_by_label("Greatest tension").rect().min.x;
            for name in ["Export Along the cable", "Along the cable"] {
                let right = harness.query_all_by_label(name).map(|n| n.rect().max.x).fold(0.0, f32::max);
                assert!(right < results, "{size:?}, {shown:?}: {name} ends at {right}, the panel at {results}");
            }
        }
    }
    // The speed of the last frame stood there as if time still ran.
    assert!(harness.query_by_label_contains("Runs at").is_none());
    harness.get_by_label("Paused");
}

/// Forces on supports, and the range of the greatest tension, were cut at the right.
#[test]
fn forces_on_supports_are_not_cut() {
    let mut harness = open(catalog::tank_robot());
    harness.set_size(Vec2::new(1280.0, 1400.0));
    harness.run_steps(4);
    for text in [" right, ", " left, "] {
        let row = harness.get_by_label_contains(text).rect();
        assert!(row.max.x <= 1280.0 && row.min.x > 1030.0, "{text} at {row}");
    }
}

/// The height of the robot was cut to "0.03" in a field that reached beyond its panel.
#[test]
fn fields_of_what_is_selected_end_within_their_panel() {
    let mut harness = open(catalog::tank_robot());
    for item in [Item::Robot, Item::Cable(0), Item::Support { cable: 0, support: 0 }, Item::Obstacle(4)] {
        for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
            harness.set_size(Vec2::from(size));
            apply(&mut harness, Command::View(ViewCommand::Select(Some(item))));
            harness.run_steps(4);
            let fields = harness.query_all_by_role(egui::accesskit::Role::TextInput).map(|n| n.rect());
            let right = fields.map(|r| r.max.x).fold(0.0, f32::max);
            assert!(right > 0.5 * size[0] && right <= size[0] - 4.0, "{item:?}, {size:?}: a field ends at {right}");
        }
    }
}

/// The hints of the first minute lay over the foot of a pile.
#[test]
fn hints_do_not_lie_over_the_cable() {
    let mut harness = open(catalog::pile());
    harness.state_mut().state.ui.first_steps = FirstSteps::default();
    apply(&mut harness, Command::View(ViewCommand::Fit));
    harness.run_steps(4);
    let canvas = harness.get_by_label("Canvas").rect();
    let hints = harness.get_by_label("Start here…").rect();
    let state = &harness.state().state;
    let lowest =
        state.live.snapshot.solution.as_ref().unwrap().cables[0].nodes.iter().map(|n| n.y_m).fold(9.0, f64::min);
    let foot = state.view.camera.to_screen(canvas, [0.0, lowest]).y;
    assert!(foot < hints.top(), "the cable ends at {foot}, hints begin at {}", hints.top());
}

/// Issue 20: a length that has no answer moved the form by four rows: the next figure was typed
/// into another field.
#[test]
fn issue_020_a_fault_leaves_the_field_under_the_pointer_where_it_is() {
    let mut harness = open(catalog::hanging_span());
    apply(&mut harness, Command::View(ViewCommand::Select(Some(Item::Cable(0)))));
    harness.run_steps(3);
    let field = harness.get_by_label("Length").rect();
    harness.hover_at(field.center());
    harness.run_steps(2);
    let cable = harness.state().state.document.scene.cables[0].clone();
    for length_m in [1e9, 5.0, cable.length_m] {
        let value = Box::new(cable_core::Cable { length_m, ..cable.clone() });
        apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value }));
        harness.run_steps(4);
        let now = harness.get_by_label("Length").rect();
        assert!((now.center().y - field.center().y).abs() < 1.0, "{length_m} m: {field:?}, then {now:?}");
    }
}

/// The form of what was picked in the outline opened where the panel had been scrolled to, in its
/// middle.
#[test]
fn the_form_of_what_is_picked_begins_at_its_top() {
    let mut harness = open(catalog::tank_robot());
    harness.get_by_label_contains("Show friction range").scroll_to_me();
    harness.run_steps(3);
    let lowest = harness.get_by_label_contains("Show friction range").rect();
    assert!(lowest.bottom() < 780.0, "the panel is scrolled to its end: {lowest:?}");
    harness.get_by_label("Select umbilical").click();
    harness.run_steps(4);
    let name = harness.get_by_label("Deselect").rect();
    assert!(name.top() > 170.0 && name.bottom() < 400.0, "{name:?}");
    // It stays where the user scrolls it to.
    harness.get_by_label_contains("Show friction range").scroll_to_me();
    harness.run_steps(4);
    assert!(harness.get_by_label_contains("Show friction range").rect().bottom() < 780.0);
    // A click on the cable asks where its tension comes from: the answer stood below the form.
    let marker = TensionMarker { cable: 0, arc_length_m: 6.0, from: StartEnd::Slacker };
    apply(&mut harness, Command::View(ViewCommand::SetTensionMarker(Some(marker))));
    harness.run_steps(4);
    let budget = harness.get_by_label("Tension at the marked place").rect();
    assert!(budget.top() > 170.0 && budget.bottom() < 400.0, "{budget:?}");
}

/// The unit of the last column of the pinned results was cut.
#[test]
fn the_table_of_pinned_results_is_as_wide_as_its_panel() {
    let mut harness = open(catalog::tank_robot());
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    let mut cable = harness.state().state.document.scene.cables[0].clone();
    cable.length_m = 15.2;
    apply(&mut harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
    let state = &mut harness.state_mut().state;
    // As long as a time can be.
    (state.live.snapshot.solve_wall_s, state.live.latest.solve_wall_s) = (0.888_88, 0.888_88);
    harness.run_steps(3);
    harness.get_by_label("Cost").scroll_to_me();
    harness.run_steps(3);
    // Foot-pounds are the longest unit.
    for units in [System::Si, System::Us] {
        apply(&mut harness, Command::View(ViewCommand::SetUnits(units)));
        let cost = harness.get_by_label("889 ms").rect();
        assert!(cost.right() <= 1272.0, "{cost:?}");
    }
    apply(&mut harness, Command::View(ViewCommand::SetUnits(System::Si)));
    harness.get_by_label("Length: 14.20 m, now 15.20 m");
}

/// Every text of a picture that is not cut, and where it stands.
fn texts(shape: &egui::Shape, out: &mut Vec<(String, egui::Rect)>) {
    match shape {
        egui::Shape::Text(text) if !text.galley.elided => {
            out.push((text.galley.text().to_owned(), text.visual_bounding_rect()))
        }
        egui::Shape::Vec(shapes) => shapes.iter().for_each(|s| texts(s, out)),
        _ => {}
    }
}

/// Issue 20: names of the hitch, the robot and its legs lay on the robot itself, which could not be
/// seen in a small window; and its legs were called "…" in the outline.
#[test]
fn issue_020_labels_leave_the_robot_to_be_seen() {
    for (size, at_x_m) in
        [([1024.0, 640.0], 4.6), ([1024.0, 640.0], 4.1), ([1280.0, 800.0], 4.6), ([1280.0, 800.0], 5.3)]
    {
        let mut scene = catalog::tank_robot();
        scene.robot.as_mut().unwrap().at_m[0] = at_x_m;
        let mut harness = Harness::builder()
            .with_size(Vec2::from(size))
            .build_eframe(|cc| ViewerApp::inline(&cc.egui_ctx, scene, None));
        harness.run_steps(6);
        let canvas = harness.get_by_label("Canvas").rect();
        let state = &harness.state().state;
        let outline = cable_viewer::geometry::robot::robot_outline(state);
        let outline: Vec<egui::Pos2> = outline.iter().map(|p| state.view.camera.to_screen(canvas, *p)).collect();
        let robot = egui::Rect::from_points(&outline);
        let mut found = Vec::new();
        harness.output().shapes.iter().for_each(|s| texts(&s.shape, &mut found));
        assert!(found.iter().any(|(text, _)| text.starts_with("leg 1")), "{found:?}");
        let hidden: f32 =
            found.iter().map(|(_, r)| r.intersect(robot)).filter(|r| r.is_positive()).map(|r| r.area()).sum();
        assert!(hidden < 0.1 * robot.area(), "{size:?}, {at_x_m} m: {hidden} of {}", robot.area());
        let legs = || found.iter().filter(|(text, _)| text == "leg 1" || text == "leg 3");
        let [outline, flags] =
            [false, true].map(|on| legs().filter(|(_, r)| canvas.contains(r.center()) == on).count());
        // Two sentences about the legs had hidden what the flags stand at.
        assert_eq!((outline, flags), (2, 2), "{size:?}, {at_x_m} m: {found:?}");
    }
}

/// A warning that came while a slider was dragged moved it, and the next click met another control.
#[test]
fn a_warning_that_comes_does_not_move_the_form_under_the_pointer() {
    let mut harness = open(catalog::hanging_span());
    select(&mut harness, Item::Cable(0));
    let place = |h: &Harness<'_, ViewerApp>| h.get_by_label("Linear density slider").rect();
    let before = place(&harness);
    harness.hover_at(before.center());
    harness.run_steps(2);
    let warn = |h: &mut Harness<'_, ViewerApp>, service_tension_n: f64| {
        let mut cable = h.state().state.document.scene.cables[0].clone();
        (cable.service_tension_n, cable.min_bend_radius_m) = (service_tension_n, 20.0);
        apply(h, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(cable) }));
        h.run_steps(3);
    };
    warn(&mut harness, 50.0);
    let warnings = harness.state().state.live.snapshot.solution.as_ref().unwrap().warnings.len();
    assert!(warnings >= 2, "{warnings}");
    assert!((place(&harness).top() - before.top()).abs() < 1.0, "{before:?} {:?}", place(&harness));
    // They go as they came.
    warn(&mut harness, 800.0);
    assert!((place(&harness).top() - before.top()).abs() < 1.0, "{before:?} {:?}", place(&harness));
    // A pointer elsewhere wants to see them.
    harness.hover_at(harness.get_by_label("Canvas").rect().center());
    harness.run_steps(2);
    warn(&mut harness, 50.0);
    assert!(place(&harness).top() > before.top() + 10.0);
}

/// A result that was pinned by name was nowhere to be seen: its table stood below what is in sight.
#[test]
fn a_result_that_is_pinned_by_name_is_seen() {
    let mut harness = open(catalog::over_beam());
    harness.hover_at(harness.get_by_label("Canvas").rect().center());
    harness.run_steps(2);
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    harness.run_steps(5);
    let unpin = harness.get_by_label("Unpin all").rect();
    assert!(harness.ctx.content_rect().contains_rect(unpin), "{unpin:?}");
}

/// Issue 20: with the pointer on it the bar of a panel grew over last letters ("172.1 N").
#[test]
fn issue_020_the_bar_of_a_panel_lies_beside_its_figures_under_the_pointer_too() {
    let mut harness = open(catalog::tank_robot());
    select(&mut harness, Item::Support { cable: 0, support: 0 });
    harness.hover_at(egui::pos2(1274.0, 400.0));
    harness.run_steps(30);
    let (mut found, mut bars) = (Vec::new(), Vec::new());
    for shape in harness.output().shapes.iter().filter(|s| s.clip_rect.left() > 1000.0) {
        texts(&shape.shape, &mut found);
        if let egui::Shape::Rect(r) = &shape.shape
            && r.rect.left() > 1250.0
            && r.rect.height() > 100.0
        {
            bars.push(r.rect);
        }
    }
    // Below what does not scroll.
    let rows = found.iter().filter(|(_, r)| r.top() > 230.0);
    let ends = rows.map(|(_, r)| r.right()).fold(0.0, f32::max);
    let begins = bars.iter().map(|r| r.left()).fold(f32::INFINITY, f32::min);
    assert!(begins.is_finite() && ends > 1250.0, "{bars:?}");
    assert!(begins >= ends - 1.0, "words end at {ends}, the bar begins at {begins}");
}

/// Issue 20: a step of a guide took two rows at 1024×640 and moved all that is below.
#[test]
fn issue_020_a_step_of_a_guide_is_one_row() {
    let mut harness = open(catalog::tank_robot());
    harness.set_size(Vec2::new(1024.0, 640.0));
    for (tutorial, guide) in cable_viewer::app::guidance::tutorials::TUTORIALS.iter().enumerate() {
        for step in 0..guide.steps.len() {
            let place = cable_viewer::state::tutorial_place::TutorialPlace { tutorial, step };
            harness.state_mut().state.ui.tutorial = Some(place);
            harness.run_steps(1);
            let end = harness.get_by_label("End guide").rect();
            let mut found = Vec::new();
            harness.output().shapes.iter().for_each(|s| texts(&s.shape, &mut found));
            assert!(found.iter().any(|(text, _)| text == guide.steps[step].text), "{}, step {step}", guide.title);
            assert!(end.bottom() < 54.0 && end.right() <= 1024.0, "{}, step {step}: {end}", guide.title);
        }
    }
}

/// In small windows the status took a second row, and all above it moved as its words changed.
#[test]
fn transport_and_status_stand_in_one_row_at_every_width() {
    for width in [640.0, 800.0, 1024.0, 1280.0] {
        let mut harness = open(catalog::tank_robot());
        harness.set_size(Vec2::new(width, 600.0));
        harness.run_steps(4);
        let canvas = harness.get_by_label("Canvas").rect();
        let row = harness.get_by_label("Reset").rect();
        assert!(600.0 - row.bottom() < 6.0, "{width}: {row}");
        harness.state_mut().state.ui.written = Some("a/long/name/of-a-picture-that-was-exported.png".into());
        crate::apply(&mut harness, Command::Playback(PlaybackCommand::SetPaused(false)));
        harness.run_steps(4);
        assert_eq!(harness.get_by_label("Canvas").rect(), canvas, "{width}");
        for told in ["Time 0", "Runs at"] {
            assert!(harness.get_by_label_contains(told).rect().right() <= width, "{width}: {told}");
        }
    }
}

/// Another scene was shown from where the results of the one before had been scrolled to.
#[test]
fn another_scene_is_read_from_its_first_figure_on() {
    let mut harness = open(catalog::tank_robot());
    let top = |harness: &Harness<'_, ViewerApp>| harness.get_by_label("Readouts").rect().top();
    let first = top(&harness);
    let panel = harness.get_by_label("Canvas").rect().right() + 100.0;
    harness.hover_at(egui::pos2(panel, 500.0));
    harness.step();
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, -300.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: egui::Modifiers::NONE,
    });
    harness.run_steps(30);
    assert!(top(&harness) < first - 100.0, "scrolled from {first} to {}", top(&harness));
    crate::apply(&mut harness, Command::File(FileCommand::OpenCatalogue("robot-drive".to_owned())));
    harness.run_steps(3);
    assert_eq!(top(&harness), first);
}
