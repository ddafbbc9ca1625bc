//! These tests do rows of the users' list by hand, as they are written: with the widgets of the
//! window, or with keys alone.

use cable_core::math::Point;
use cable_core::scene::catalog;
use cable_core::solution::{ContactState, Node};
use cable_core::{Model, Solution};
use cable_viewer::ViewerApp;
use cable_viewer::state::Item;
use cable_viewer::state::dialog::Dialog;
use egui::{Event, Key, Modifiers, Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::rows::{answer, click, state};
use crate::{open, select};

fn tall(harness: &mut Harness<'_, ViewerApp>) {
    harness.set_size(Vec2::new(1400.0, 2000.0));
    harness.run_steps(3);
}

/// Types into a named field and presses Enter.
fn enter(harness: &mut Harness<'_, ViewerApp>, label: &str, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, label).focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text(text.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

fn seconds(harness: &mut Harness<'_, ViewerApp>, time_s: f64) {
    harness.key_press(Key::Space);
    harness.run_steps(2);
    for _ in 0..2000 {
        assert_eq!(state(harness).live.snapshot.error, None);
        if answer(harness).time_s >= time_s {
            break;
        }
        harness.step();
    }
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(answer(harness).time_s >= time_s && state(harness).live.playback.paused);
}

fn at(n: &Node) -> Point {
    [n.x_m, n.y_m]
}

/// Least distance of parts of a cable that are more than `apart` (m) of length from each other, m.
fn least_gap(answer: &Solution, apart: f64) -> f64 {
    let nodes = &answer.cables[0].nodes;
    let mut least = f64::INFINITY;
    for (i, a) in nodes.iter().enumerate() {
        for pair in nodes[i..].windows(2).filter(|w| w[0].arc_length_m - a.arc_length_m > apart) {
            let ([px, py], [ax, ay], [bx, by]) = (at(a), at(&pair[0]), at(&pair[1]));
            let (dx, dy) = (bx - ax, by - ay);
            let f = (((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            least = f64::min(least, (ax + f * dx - px).hypot(ay + f * dy - py));
        }
    }
    least
}

/// The cable comes down on itself and stops on itself: at no time is a part of it inside another.
/// Without self-contact, switched off in the cable panel, the same cable falls through itself, and
/// what it does is named.
#[test]
fn s05_the_cable_stops_on_itself_and_what_tangles_is_named() {
    let mut harness = open(catalog::pile());
    tall(&mut harness);
    let diameter = state(&harness).document.scene.cables[0].diameter_m;
    seconds(&mut harness, 1.1);
    let on_itself = |a: &Solution| a.cables[0].contacts.iter().any(|c| c.obstacle == a.cables[0].name);
    let answers = state(&harness).live.recording.answers();
    assert!(answers.iter().any(on_itself), "it lies on itself");
    // Nodes stand on segments: between two nodes the round of the cable may be a little flatter.
    let least = answers.iter().map(|a| least_gap(a, 3.0 * diameter)).fold(f64::INFINITY, f64::min);
    assert!(least > 0.9 * diameter, "parts of it come as near as {least} m, it is {diameter} m thick");
    assert!(answers.iter().all(|a| a.warnings.iter().all(|w| w.kind.name() != "loop")), "it never crosses itself");

    harness.key_press(Key::R);
    harness.run_steps(3);
    select(&mut harness, Item::Cable(0));
    click(&mut harness, "Self-contact");
    assert!(!state(&harness).document.scene.cables[0].self_contact);
    seconds(&mut harness, 1.1);
    let least = state(&harness).live.recording.answers().iter().map(|a| least_gap(a, 3.0 * diameter));
    assert!(least.fold(f64::INFINITY, f64::min) < 0.5 * diameter, "now it goes through itself");
    let named = |h: &Harness<'_, ViewerApp>| {
        ["Crosses itself", "Tight curl", "Kinked"].iter().any(|t| h.query_all_by_label_contains(t).next().is_some())
    };
    let told = !state(&harness).live.recording.events().is_empty() || named(&harness);
    assert!(told, "what tangles is named: {:?}", answer(&harness).warnings);
}

/// A map is picked in the scene panel while time runs, and ground from another program is pasted;
/// both are there at once, the cable lies on what is there, and undo takes them back.
#[test]
fn s09_maps_are_picked_and_pasted_while_the_window_runs() {
    let mut harness = open(catalog::slack_to_floor());
    tall(&mut harness);
    let before = state(&harness).document.scene.clone();
    let map = cable_core::scene::preset::map_presets().iter().find(|m| m.id.starts_with("flat")).expect("a flat tank");
    select(&mut harness, Item::Scene);
    click(&mut harness, "Map");
    harness.get_by_label(&map.name).click();
    harness.run_steps(4);
    assert_eq!(state(&harness).document.scene.obstacles, map.obstacles);
    assert_eq!(state(&harness).live.snapshot.error, None);
    assert_eq!(state(&harness).live.snapshot.scene.as_ref().map(|s| s.obstacles.len()), Some(map.obstacles.len()));

    // Pasted: a step of ground where the cable hangs lowest.
    let low = answer(&harness).cables[0]
        .nodes
        .iter()
        .map(|n| (n.y_m, n.x_m))
        .fold((f64::MAX, 0.0), |a, b| if b.0 < a.0 { b } else { a });
    let [x, y] = [low.1, low.0 + 0.3];
    let table = format!("x\ty\n{}\t{}\n{}\t{}\n{}\t{}\n", x - 0.6, low.0 - 0.2, x, y, x + 0.6, low.0 - 0.2);
    harness.event(Event::Paste(table));
    harness.run_steps(3);
    assert!(matches!(state(&harness).ui.dialog, Some(Dialog::ImportMap { .. })), "{:?}", state(&harness).ui.dialog);
    click(&mut harness, "Add to the scene");
    harness.run_steps(3);
    click(&mut harness, "Close");
    assert_eq!(state(&harness).document.scene.obstacles.len(), map.obstacles.len() + 1);
    assert_eq!(state(&harness).live.snapshot.error, None);
    let inside = |n: &Node| (n.x_m - x).abs() < 0.3 && n.y_m < y - (n.x_m - x).abs() * (y - low.0 + 0.2) / 0.6 - 1e-3;
    let deep: Vec<Point> = answer(&harness).cables[0].nodes.iter().filter(|n| inside(n)).map(at).collect();
    assert!(
        deep.is_empty(),
        "the cable lies on the new ground, whose top is at ({x}, {y}): {deep:?} {:?}",
        answer(&harness).cables[0].contacts
    );

    // Time runs on it, and the reset and both edits are taken back.
    seconds(&mut harness, 0.1);
    harness.key_press(Key::R);
    harness.run_steps(3);
    for _ in 0..3 {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        harness.run_steps(3);
    }
    assert_eq!(state(&harness).document.scene.obstacles, before.obstacles);
}

/// Friction is typed at the obstacle. With it the cable truly sticks while it is pulled by less
/// than e^{μφ}: it does not move at all; beyond, it slides and the tensions differ by that factor.
/// Without it they are alike.
#[test]
fn s19_friction_typed_at_an_obstacle_sticks_slides_and_changes_the_tension() {
    let run = |friction: &str| {
        let mut harness = open(catalog::draped_slipping());
        tall(&mut harness);
        select(&mut harness, Item::Solver);
        click(&mut harness, "FEM");
        click(&mut harness, "Select pipe");
        enter(&mut harness, "Obstacle friction", friction);
        assert_eq!(state(&harness).document.scene.obstacles[0].friction, friction.parse().ok());
        let start = answer(&harness);
        seconds(&mut harness, 0.9);
        let held = answer(&harness);
        // The hand begins to draw at 1 s.
        seconds(&mut harness, 2.5);
        (start, held, answer(&harness))
    };
    let weight = |a: &Solution| a.cables[0].nodes[0].y_m;
    let wrap = |a: &Solution| a.cables[0].contacts.iter().find(|c| c.obstacle == "pipe").cloned().expect("a wrap");
    let ratio = |a: &Solution| {
        let c = wrap(a);
        c.tension_after_n / c.tension_before_n
    };
    let (start, held, drawn) = run("0.3");
    assert!((weight(&held) - weight(&start)).abs() < 1e-6, "it sticks: {} m", weight(&held) - weight(&start));
    assert_eq!(wrap(&held).state, ContactState::Stick);
    assert_eq!(wrap(&drawn).state, ContactState::Slip);
    assert!(weight(&drawn) - weight(&start) > 0.05, "the weight is drawn up");
    let capstan = (0.3 * std::f64::consts::PI).exp();
    assert!((ratio(&drawn) / capstan - 1.0).abs() < 0.1, "{} for {capstan}", ratio(&drawn));
    let (_, _, smooth) = run("0");
    assert!((ratio(&smooth) - 1.0).abs() < 0.05, "{}", ratio(&smooth));
    let most = |a: &Solution| a.max_tension().tension_n;
    assert!(most(&drawn) > 1.5 * most(&smooth), "{} {}", most(&drawn), most(&smooth));
}

/// The pointer takes an end while time runs and is held still a metre away: a spring holds the end,
/// its force is in the readouts and balances the cable; let go, the end stays where it came to, in
/// the scene as well.
#[test]
fn s06_a_pointer_holds_an_end_by_a_spring_while_time_runs() {
    let mut harness = open(catalog::hanging_span());
    tall(&mut harness);
    select(&mut harness, Item::Solver);
    click(&mut harness, "FEM");
    harness.key_press(Key::Space);
    harness.run_steps(3);
    let from = crate::support(&harness, "right");
    let scale = state(&harness).view.camera.points_per_m;
    let by = Vec2::new(-scale as f32, -0.5 * scale as f32);
    harness.hover_at(from);
    harness.step();
    crate::press(&harness, from, true);
    harness.step();
    for k in 1..=4 {
        harness.hover_at(from + by * (k as f32 / 4.0));
        harness.step();
    }
    let now = |h: &Harness<'_, ViewerApp>| answer(h).cables[0].supports[1].clone();
    assert!(now(&harness).hand.is_some() && state(&harness).selection.spring_support == Some((0, 1)));
    harness.run_steps(240);
    let pointer = state(&harness).document.scene.cables[0].supports[1].at_m.expect("drawn to the pointer");
    let (end, hand) = (now(&harness), now(&harness).hand.expect("held"));
    assert!((hand.x_m - pointer[0]).hypot(hand.y_m - pointer[1]) < 1e-3, "{hand:?} for {pointer:?}");
    let ahead = (hand.x_m - end.x_m).hypot(hand.y_m - end.y_m);
    let pulls = end.reaction_x_n.hypot(end.reaction_y_n);
    // The cable swings on: the spring has all of the force but what is its damper's.
    assert!(ahead > 1e-3 && (hand.force_n() / pulls - 1.0).abs() < 1e-6, "{ahead} m, {pulls} N for {hand:?}");
    assert!(harness.query_all_by_label_contains("Hand at right").next().is_some(), "its force is read off");
    crate::press(&harness, from + by, false);
    harness.run_steps(40);
    let (place, fixed) = (now(&harness), state(&harness).document.scene.cables[0].supports[1].at_m.expect("fixed"));
    assert!(place.hand.is_none() && state(&harness).selection.spring_support.is_none());
    assert!((place.x_m - end.x_m).hypot(place.y_m - end.y_m) < 0.02, "it stays where it was");
    assert!((place.x_m - fixed[0]).hypot(place.y_m - fixed[1]) < 1e-6, "{place:?} and {fixed:?}");
    assert_eq!(state(&harness).live.snapshot.error, None);
}

/// Everything by keys: open, pick, move, edit a number, another model, run, look back, hold, save.
#[test]
fn a_whole_session_by_keys_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = open(catalog::hanging_span());
    tall(&mut harness);
    let command = |harness: &mut Harness<'_, ViewerApp>, text: &str| {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
        harness.run_steps(2);
        harness.event(Event::Text(text.to_owned()));
        harness.run_steps(2);
        harness.key_press(Key::Enter);
        harness.run_steps(3);
    };
    let path = |harness: &mut Harness<'_, ViewerApp>, text: String| {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.step();
        harness.event(Event::Text(text));
        harness.run_steps(2);
        harness.key_press(Key::Enter);
        harness.run_steps(4);
    };
    command(&mut harness, "open scene over a beam");
    assert_eq!(state(&harness).document.scene.name, catalog::over_beam().name);
    // Pick the last support and move it by two grid lines.
    harness.key_press(Key::N);
    harness.run_steps(2);
    harness.key_press(Key::N);
    harness.run_steps(2);
    let Some(Item::Support { cable, support }) = state(&harness).selection.selected else {
        panic!("{:?}", state(&harness).selection.selected);
    };
    let before = state(&harness).document.scene.cables[cable].supports[support].at_m.unwrap();
    for _ in 0..2 {
        harness.key_press_modifiers(Modifiers::ALT, Key::ArrowLeft);
        harness.run_steps(3);
    }
    let after = state(&harness).document.scene.cables[cable].supports[support].at_m.unwrap();
    assert!(after[0] < before[0] && after[1] == before[1], "{before:?} {after:?}");
    assert_eq!(state(&harness).live.snapshot.error, None);
    // A number is reached with Tab and typed.
    command(&mut harness, "edit the cable");
    let focused = |h: &Harness<'_, ViewerApp>| {
        let id = h.ctx.memory(|m| m.focused());
        let named = |label: &str| {
            h.query_all_by_role_and_label(Role::TextInput, label).any(|n| n.accesskit_node().is_focused())
        };
        id.is_some() && named("Length")
    };
    for _ in 0..400 {
        if focused(&harness) {
            break;
        }
        harness.key_press(Key::Tab);
        harness.step();
    }
    assert!(focused(&harness), "Tab comes to the length");
    let length_m = state(&harness).document.scene.cables[0].length_m + 0.25;
    path(&mut harness, format!("{length_m}"));
    assert_eq!(state(&harness).document.scene.cables[0].length_m, length_m);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    // Another model; time runs, is looked back at, and begins anew.
    command(&mut harness, "solve with fem");
    assert_eq!(state(&harness).solver.model, Model::Fem);
    harness.key_press(Key::Space);
    harness.run_steps(20);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    let now_s = answer(&harness).time_s;
    assert!(state(&harness).live.playback.paused && now_s > 0.2, "{now_s}");
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(2);
    assert!(answer(&harness).time_s < now_s, "an earlier picture");
    command(&mut harness, "show the latest");
    command(&mut harness, "pin this result");
    assert_eq!(state(&harness).analysis.references.len(), 1);
    harness.key_press(Key::R);
    harness.run_steps(3);
    assert_eq!(answer(&harness).time_s, 0.0);
    // Saved, run and scene, and undone.
    harness.key_press_modifiers(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
    harness.run_steps(3);
    let file = folder.path().join("keys.toml");
    path(&mut harness, file.display().to_string());
    assert_eq!(cable_viewer::io::scene_file::load(&file).unwrap(), state(&harness).document.scene);
    command(&mut harness, "save run");
    let run = folder.path().join("run");
    path(&mut harness, run.display().to_string());
    assert!(run.join("history.csv").exists(), "{:?}", state(&harness).ui.dialog);
    assert!(state(&harness).ui.dialog.is_none() && !state(&harness).document.unsaved());
    // The reset was the last thing done.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert!(answer(&harness).time_s > 0.0);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert!(state(&harness).document.unsaved() && state(&harness).document.scene.cables[0].length_m < length_m);
}
