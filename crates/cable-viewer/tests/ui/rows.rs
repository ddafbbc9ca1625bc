//! These tests are stories of the users that no other file tells: each test is named after its row.

use cable_core::scene::preset::robot_presets;
use cable_core::scene::{Pose, Shape, Support, catalog};
use cable_core::solution::WarningKind;
use cable_core::{Model, Robot, Scene, Solution};
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand, PlaybackCommand, SceneCommand};
use cable_viewer::render::colour::{CableQuantity, ColourMap};
use cable_viewer::state::dialog::SceneReplacement;
use cable_viewer::state::{AppState, Item};
use egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open, open_span};

pub fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

pub fn answer(harness: &Harness<'_, ViewerApp>) -> Solution {
    state(harness).live.snapshot.solution.as_deref().expect("an answer").clone()
}

pub fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

/// The first cable with a change.
pub fn set_cable(harness: &mut Harness<'_, ViewerApp>, change: impl FnOnce(&mut cable_core::Cable)) {
    let mut value = state(harness).document.scene.cables[0].clone();
    change(&mut value);
    apply(harness, Command::Scene(SceneCommand::SetCable { cable: 0, value: Box::new(value) }));
}

pub fn play(harness: &mut Harness<'_, ViewerApp>, frames: usize) {
    apply(harness, Command::Playback(PlaybackCommand::SetPaused(false)));
    harness.run_steps(frames);
}

pub fn warned(harness: &Harness<'_, ViewerApp>, kind: WarningKind) -> bool {
    answer(harness).warnings.iter().any(|w| w.kind == kind)
}

#[test]
fn s02_elements_answer_as_the_closed_form_does() {
    let mut harness = open(catalog::hanging_span());
    apply(&mut harness, Command::SetModel(Model::Catenary));
    let exact = answer(&harness).max_tension().tension_n;
    apply(&mut harness, Command::SetModel(Model::Fem));
    let found = answer(&harness);
    let error = found.max_tension().tension_n / exact - 1.0;
    assert!(error.abs() < 1e-3, "{error}");
    let told = found.cables[0].error_estimate.expect("an estimate");
    assert!(error.abs() <= 3.0 * told + 1e-9, "off by {error}, told {told}");
    harness.get_by_label("Error estimate");
}

#[test]
fn s03_a_property_changes_while_time_runs_and_time_goes_on() {
    let mut harness = open_span();
    play(&mut harness, 10);
    let before = answer(&harness);
    set_cable(&mut harness, |c| c.linear_density_kg_per_m *= 1.5);
    let after = answer(&harness);
    assert!(!state(&harness).live.playback.paused && after.time_s > before.time_s, "no restart");
    let end = |s: &Solution| s.cables[0].nodes[s.cables[0].nodes.len() / 2];
    let moved = (end(&after).x_m - end(&before).x_m).hypot(end(&after).y_m - end(&before).y_m);
    assert!(moved < 0.05, "the cable goes on where it was: {moved} m");
    harness.run_steps(30);
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert!(answer(&harness).max_tension().tension_n > 1.2 * before.max_tension().tension_n);
}

#[test]
fn s04_nothing_gets_into_anything() {
    let mut harness = open(catalog::over_beam());
    let radius = 0.5 * state(&harness).document.scene.cables[0].diameter_m;
    play(&mut harness, 45);
    for (k, answer) in state(&harness).live.recording.answers().iter().enumerate() {
        for n in &answer.cables[0].nodes {
            for o in &state(&harness).document.scene.obstacles {
                let deep = depth(&o.shape, [n.x_m, n.y_m]);
                assert!(deep < radius, "{} at ({}, {}) in picture {k}", o.name, n.x_m, n.y_m);
            }
        }
    }
    assert!(answer(&harness).cables[0].contacts.iter().any(|c| c.normal_n > 0.0), "and it does touch");
}

/// A robot that backs over its own slack cable pushes it before it.
#[test]
fn s04_the_cable_stays_out_of_the_robot() {
    let mut harness = open(catalog::robot_drive());
    let key = |pressed| egui::Event::Key {
        key: egui::Key::A,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: egui::Modifiers::NONE,
    };
    harness.event(key(true));
    harness.run_steps(300);
    harness.event(key(false));
    harness.run_steps(2);
    assert_eq!(state(&harness).live.snapshot.error, None);
    let heading = state(&harness).document.scene.robot.as_ref().unwrap().heading;
    let preset =
        robot_presets().iter().find(|p| p.id == state(&harness).document.scene.robot.as_ref().unwrap().preset).unwrap();
    let radius = 0.5 * state(&harness).document.scene.cables[0].diameter_m;
    let answers = state(&harness).live.recording.answers();
    let (mut way, mut pressed) = (0.0_f64, 0.0_f64);
    for answer in answers {
        let r = answer.robot.unwrap();
        way = way.max(answers[0].robot.unwrap().x_m - r.x_m);
        pressed = pressed.max(r.push_x_n.hypot(r.push_y_n));
        let pose = Pose { at_m: [r.x_m, r.y_m], pitch: r.pitch_deg.to_radians(), heading };
        // Its back is cut by 0.1 m, where the cable hangs.
        let back = 0.1 - preset.hitch_back_m.value;
        let outline: Vec<[f64; 2]> = preset.outline_m.iter().map(|p| pose.place([p[0].max(back), p[1]])).collect();
        for n in &answer.cables[0].nodes {
            let deep = inside(&outline, [n.x_m, n.y_m]);
            assert!(deep < radius, "({}, {}) is {deep} m deep at {} s", n.x_m, n.y_m, answer.time_s);
        }
    }
    assert!(way > 2.0 && pressed > 1.0, "it backs ({way} m) against its cable ({pressed} N)");
    // Whatever it is warned of, the greatest tension stays in sight.
    let warnings = answer(&harness).warnings.len();
    let read = harness.get_by_label("Greatest tension").rect();
    assert!(warnings >= 2 && read.bottom() < 500.0, "{warnings} warnings, {read}");
}

/// Returns how deep a point is in a polygon, m; 0 outside.
fn inside(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let edges = || polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crossed =
        edges().filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
    let far = |(a, b): (&[f64; 2], &[f64; 2])| {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let t = (((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy).max(1e-12)).clamp(0.0, 1.0);
        (a[0] + t * dx - x).hypot(a[1] + t * dy - y)
    };
    if crossed.count() % 2 == 1 { edges().map(far).fold(f64::MAX, f64::min) } else { 0.0 }
}

/// Returns how deep a point is in level ground, a box or a post, m; 0 outside.
fn depth(shape: &Shape, p: [f64; 2]) -> f64 {
    match shape {
        Shape::Terrain { points_m } => {
            let pair = points_m.windows(2).find(|w| w[0][0] <= p[0] && p[0] <= w[1][0]);
            let y = pair.map_or(f64::NEG_INFINITY, |w| {
                w[0][1] + (w[1][1] - w[0][1]) * (p[0] - w[0][0]) / (w[1][0] - w[0][0]).max(1e-12)
            });
            (y - p[1]).max(0.0)
        }
        Shape::Polygon { points_m } => {
            let ends = |k: usize| points_m.iter().fold([f64::MAX, f64::MIN], |[a, b], q| [a.min(q[k]), b.max(q[k])]);
            let [[x0, x1], [y0, y1]] = [ends(0), ends(1)];
            (p[0] - x0).min(x1 - p[0]).min(p[1] - y0).min(y1 - p[1]).max(0.0)
        }
        Shape::Circle { center_m, radius_m } => (radius_m - (p[0] - center_m[0]).hypot(p[1] - center_m[1])).max(0.0),
        Shape::Polyline { .. } => 0.0,
    }
}

/// A cable whose second part hangs deep and comes up across its first.
pub fn crossing() -> Scene {
    let mut scene = catalog::hanging_span();
    let cable = &mut scene.cables[0];
    cable.length_m = 22.0;
    let mut middle = Support::fixed("middle", [6.0, 5.0]);
    middle.arc_length_m = Some(7.0);
    // From the middle back below the first part, deep, and up on its far side.
    cable.supports = vec![Support::fixed("left", [0.0, 3.0]), middle, Support::fixed("right", [1.0, 9.0])];
    scene
}

#[test]
fn s05_a_cable_that_crosses_itself_is_named_and_can_be_made_to_stop_on_itself() {
    let mut harness = open(crossing());
    apply(&mut harness, Command::SetModel(Model::Fem));
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert!(warned(&harness, WarningKind::Loop), "{:?}", answer(&harness).warnings);
    harness.get_by_label_contains("Crosses itself");
    apply(
        &mut harness,
        Command::File(FileCommand::Discard(SceneReplacement::OpenCatalogue("hanging-span".to_owned()))),
    );
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);
    crate::select(&mut harness, Item::Cable(0));
    click(&mut harness, "Self-contact");
    assert!(state(&harness).document.scene.cables[0].self_contact);
    assert_eq!(state(&harness).live.snapshot.error, None);
    play(&mut harness, 5);
    assert_eq!(state(&harness).live.snapshot.error, None);
}

#[test]
fn s07_robots_are_drawn_as_large_as_published() {
    for preset in robot_presets() {
        let mut scene = catalog::robot_drive();
        let robot = Robot { preset: preset.id.to_owned(), at_m: [9.0, 0.0], ..Robot::default() };
        scene.robot = Some(robot);
        let harness = open(scene);
        assert_eq!(state(&harness).document.fault, None, "{}", preset.id);
        let outline = cable_viewer::geometry::robot::robot_outline(state(&harness));
        let span = |k: usize| {
            let values = || outline.iter().map(|p| p[k]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        for (found, published) in [(span(0), preset.length_m.value), (span(1), preset.height_m.value)] {
            assert!((found / published - 1.0).abs() < 0.01, "{}: {found} m, published {published} m", preset.id);
        }
        assert!(!preset.note.is_empty(), "{} says where its figures are from", preset.id);
    }
    assert!(robot_presets().len() >= 2);
}

#[test]
fn s10_stress_and_strain_are_told_with_their_units() {
    let harness = open_span();
    let cable = &answer(&harness).cables[0];
    let most = |of: fn(&cable_core::solution::Node) -> f64| cable.nodes.iter().map(of).fold(0.0, f64::max);
    for (label, text) in [
        ("Max stress", cable_viewer::units::format::stress(most(|n| n.stress_pa))),
        ("Max strain", cable_viewer::units::format::strain(most(|n| n.strain))),
    ] {
        harness.get_by_label(label);
        harness.get_by_label(&text);
    }
    let node = cable.nodes[3];
    let area = state(&harness).document.scene.cables[0].area_m2();
    assert!((node.stress_pa * area / node.tension_n - 1.0).abs() < 1e-12, "T / A");
}

#[test]
fn s13_two_levels_of_tension_are_warned_of_with_their_place() {
    let mut harness = open_span();
    let most = answer(&harness).max_tension();
    set_cable(&mut harness, |c| c.service_tension_n = 0.9 * most.tension_n);
    assert!(warned(&harness, WarningKind::ServiceTension));
    harness.get_by_label_contains("Above service tension at ");
    click(&mut harness, "Details of warning 1");
    click(&mut harness, "Show warning 1");
    set_cable(&mut harness, |c| {
        c.service_tension_n = 0.5 * most.tension_n;
        c.breaking_tension_n = 0.95 * most.tension_n;
    });
    assert!(warned(&harness, WarningKind::BreakingTension), "{:?}", answer(&harness).warnings);
    harness.get_by_label_contains("Breaks here at ");
}

#[test]
fn s15_it_breaks_at_its_breaking_tension_and_goes_on_as_two() {
    // Over a grip that is higher than both ends: the greatest tension is in the middle.
    let mut scene = catalog::hanging_span();
    let cable = &mut scene.cables[0];
    let mut grip = Support::fixed("grip", [5.0, 8.0]);
    grip.arc_length_m = Some(7.0);
    cable.length_m = 15.0;
    cable.supports.insert(1, grip);
    let mut harness = open(scene);
    apply(&mut harness, Command::SetModel(Model::Fem));
    let most = answer(&harness).max_tension();
    assert!((most.arc_length_m - 7.0).abs() < 0.2, "{most:?}");
    set_cable(&mut harness, |c| {
        c.service_tension_n = 0.5 * most.tension_n;
        c.breaking_tension_n = 0.9 * most.tension_n;
    });
    play(&mut harness, 30);
    assert_eq!(state(&harness).live.snapshot.error, None);
    let after = answer(&harness);
    assert!(
        after.cables[0].pieces().count() >= 2,
        "{} s, {:?}: {:?}",
        after.time_s,
        state(&harness).live.playback,
        after.warnings
    );
    let event = state(&harness).live.recording.events().iter().find(|e| e.warning.kind == WarningKind::Broken).cloned();
    assert!(event.is_some_and(|e| e.time_s < 0.1), "marked on the timeline");
    // It falls, and time goes on.
    let low = |s: &Solution| s.cables[0].nodes.iter().map(|n| n.y_m).fold(f64::MAX, f64::min);
    let before = answer(&harness).time_s;
    harness.run_steps(10);
    assert!(answer(&harness).time_s > before && low(&answer(&harness)).is_finite());
    assert_eq!(state(&harness).live.snapshot.error, None);
}

#[test]
fn s18_properties_have_names_units_presets_and_a_way_back() {
    let mut harness = open_span();
    let loaded = state(&harness).document.scene.cables[0].clone();
    let spoken = |h: &Harness<'_, ViewerApp>, label: &str| {
        let field = h.get_by_role_and_label(egui::accesskit::Role::TextInput, label);
        field.accesskit_node().value().unwrap_or_default()
    };
    crate::select(&mut harness, Item::Cable(0));
    harness.set_size(Vec2::new(1280.0, 1800.0));
    harness.run_steps(3);
    for property in &cable_viewer::panels::cable::property::PROPERTIES {
        let text = spoken(&harness, property.quantity.name);
        let symbol = property.quantity.unit.symbol;
        assert!(text.ends_with(symbol), "{}: {text}", property.quantity.name);
        harness.get_by_label(&format!("{} slider", property.quantity.name));
    }
    set_cable(&mut harness, |c| c.length_m = 15.0);
    click(&mut harness, "Reset length");
    assert_eq!(state(&harness).document.scene.cables[0], loaded);
}

#[test]
fn s20_colours_are_even_to_every_eye_and_what_they_show_is_chosen() {
    for map in ColourMap::ALL {
        // Lightness alone orders the colours: read in grey, and by colour-blind eyes.
        let light = |f: f64| {
            let c = map.at(f);
            0.299 * f64::from(c.r()) + 0.587 * f64::from(c.g()) + 0.114 * f64::from(c.b())
        };
        assert!((1..=20).all(|k| light(f64::from(k) / 20.0) > light(f64::from(k - 1) / 20.0)), "{}", map.name());
    }
    let mut harness = open_span();
    harness.get_by_role_and_label(egui::accesskit::Role::Button, "View").click();
    harness.run_steps(3);
    harness.get_by_label("Colour by stress").click();
    harness.run_steps(3);
    assert_eq!(state(&harness).view.colour.quantity, CableQuantity::Stress);
    let [low, high] = state(&harness).view.colour.range(&answer(&harness));
    let node = answer(&harness).cables[0].nodes[0];
    assert!(low < high && (low..=high).contains(&node.stress_pa));
}

#[test]
fn every_row_that_was_asked_for_has_a_test_named_after_it() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ui");
    let files = std::fs::read_dir(folder).unwrap().map(|f| std::fs::read_to_string(f.unwrap().path()).unwrap());
    let all: String = files.collect();
    for (row, last) in [('s', 20), ('u', 19), ('t', 5)] {
        for k in 1..=last {
            assert!(all.contains(&format!("\nfn {row}{k:02}_")), "{row}{k:02} has none");
        }
    }
}
