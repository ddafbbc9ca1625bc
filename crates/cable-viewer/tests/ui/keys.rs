//! Keys do what had needed a pointer: the view, graphs, picking several things. Dialogs fit the
//! smallest window.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, FileCommand};
use cable_viewer::state::dialog::Dialog;
use cable_viewer::state::{AppState, Item};
use egui::{Key, Modifiers, Shape, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{By, NodeT, Queryable};

use crate::rows::play;
use crate::{apply, open, open_span};

fn state<'a>(harness: &'a Harness<'_, ViewerApp>) -> &'a AppState {
    &harness.state().state
}

fn press(harness: &mut Harness<'_, ViewerApp>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

#[test]
fn t04_the_view_is_zoomed_and_moved_by_keys() {
    let mut harness = open_span();
    let before = state(&harness).view.camera;
    for _ in 0..3 {
        press(&mut harness, Modifiers::NONE, Key::Plus);
    }
    let closer = state(&harness).view.camera;
    assert!((closer.points_per_m / before.points_per_m - 2.0).abs() < 0.01 && closer.centre_m == before.centre_m);
    for _ in 0..3 {
        press(&mut harness, Modifiers::NONE, Key::Minus);
    }
    assert!((state(&harness).view.camera.points_per_m / before.points_per_m - 1.0).abs() < 1e-9);
    for (key, [x, y]) in [
        (Key::ArrowRight, [1.0, 0.0]),
        (Key::ArrowUp, [0.0, 1.0]),
        (Key::ArrowLeft, [-1.0, 0.0]),
        (Key::ArrowDown, [0.0, -1.0]),
    ] {
        let before = state(&harness).view.camera.centre_m;
        press(&mut harness, Modifiers::SHIFT, key);
        let after = state(&harness).view.camera.centre_m;
        let moved = [after[0] - before[0], after[1] - before[1]];
        assert!(moved[0] * x >= 0.0 && moved[1] * y >= 0.0 && moved[0].hypot(moved[1]) > 0.1, "{key:?}: {moved:?}");
    }
    assert_eq!(state(&harness).live.latest.solution.as_ref().unwrap().time_s, 0.0, "no step was taken");
}

#[test]
fn s12_graphs_are_read_and_zoomed_by_keys() {
    let mut harness = open_span();
    play(&mut harness, 60);
    press(&mut harness, Modifiers::NONE, Key::Space);
    let told = |h: &Harness<'_, ViewerApp>| {
        h.get_by_label("Along the cable").accesskit_node().data().description().unwrap_or_default().to_owned()
    };
    let view = |h: &Harness<'_, ViewerApp>| {
        let ends = h.ctx.data(|d| d.get_temp::<[f64; 2]>(egui::Id::unique(("in view", "Along the cable"))));
        ends.expect("drawn")
    };
    assert!(!told(&harness).contains("; A "), "{}", told(&harness));
    harness.get_by_label("Along the cable").focus();
    harness.run_steps(2);
    let time_s = state(&harness).live.latest.solution.as_ref().unwrap().time_s;
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    assert!(told(&harness).contains("; A 6."), "in the middle: {}", told(&harness));
    press(&mut harness, Modifiers::NONE, Key::Enter);
    for _ in 0..10 {
        press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    }
    assert!(told(&harness).contains("B − A 1.2"), "a tenth of 12 m on: {}", told(&harness));
    // Zoom about the cursor, then along.
    let all = view(&harness);
    for _ in 0..3 {
        press(&mut harness, Modifiers::NONE, Key::ArrowUp);
    }
    let part = view(&harness);
    assert!(((all[1] - all[0]) / (part[1] - part[0]) - 2.0).abs() < 0.02, "{all:?} {part:?}");
    assert!(part[0] < 7.2 && 7.2 < part[1], "{part:?}");
    press(&mut harness, Modifiers::SHIFT, Key::ArrowLeft);
    let moved = view(&harness);
    assert!((part[0] - moved[0] - 0.125 * (part[1] - part[0])).abs() < 0.01, "{part:?} {moved:?}");
    // The keys were the graph's: time did not step. Without the focus they are the window's again.
    assert_eq!(state(&harness).live.latest.solution.as_ref().unwrap().time_s, time_s);
    assert_eq!(state(&harness).live.recording.shown_s, None);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, Modifiers::NONE, Key::ArrowLeft);
    assert!(state(&harness).live.recording.shown_s.is_some());
}

/// Issue 20: with Tab alone the focus went where it could not be seen: below the edge of a panel
/// that scrolls, and on menus, headings and graphs nothing showed it.
#[test]
fn issue_020_tab_leads_to_every_control_and_the_focus_is_seen() {
    for size in [Vec2::new(1280.0, 800.0), Vec2::new(1024.0, 640.0)] {
        let mut harness = open(catalog::tank_robot());
        harness.set_size(size);
        play(&mut harness, 20);
        press(&mut harness, Modifiers::NONE, Key::Space);
        press(&mut harness, Modifiers::NONE, Key::Escape);
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
        let mut passed = Vec::new();
        loop {
            press(&mut harness, Modifiers::NONE, Key::Tab);
            harness.run_steps(12);
            let id = harness.ctx.memory(|m| m.focused()).expect("Tab gives the focus");
            if passed.first().is_some_and(|(first, _)| *first == id) {
                break;
            }
            let [node] = &harness.query_all(By::new().predicate(|n| n.is_focused())).collect::<Vec<_>>()[..] else {
                panic!("one thing has the focus")
            };
            let data = node.accesskit_node();
            let name = data.label().unwrap_or_default();
            let rect = node.rect();
            assert!(window.contains_rect(rect), "“{name}” at {rect} is out of sight at {size}");
            let framed = |s: &egui::epaint::ClippedShape| match &s.shape {
                Shape::Rect(r) => {
                    r.stroke.width >= 1.0 && r.rect.intersects(rect) && rect.expand(3.0).contains_rect(r.rect)
                }
                _ => false,
            };
            let is_field = data.role() == egui::accesskit::Role::TextInput;
            assert!(is_field || harness.output().shapes.iter().any(framed), "nothing shows the focus on “{name}”");
            passed.push((id, name));
            assert!(passed.len() < 300, "{passed:?}");
        }
        let names: Vec<&str> = passed.iter().map(|(_, name)| name.as_str()).collect();
        // From the title to the outline, the results, the graphs and the row at the foot.
        let order = ["File", "Add waypoint", "Find safe reach", "Follow", "Reset"];
        let places = order.map(|name| names.iter().position(|n| *n == name).expect(name));
        assert!(places.is_sorted(), "{order:?} are at {places:?} at {size}: {names:?}");
        let controls = crate::help::controls(&harness);
        for (name, ..) in &controls {
            let works = || harness.query_all_by_label(name).any(|n| !n.accesskit_node().is_disabled());
            assert!(
                name.is_empty() || !works() || names.contains(&name.as_str()),
                "Tab passes “{name}” by at {size}: {names:?}"
            );
        }
        assert!(controls.len() > 50, "{}", controls.len());
    }
}

/// Keys do with a menu as the pointer does: open, choose, and leave.
#[test]
fn issue_020_a_menu_is_used_by_keys() {
    let mut harness = open(catalog::tank_robot());
    press(&mut harness, Modifiers::NONE, Key::Tab);
    press(&mut harness, Modifiers::NONE, Key::Tab);
    press(&mut harness, Modifiers::NONE, Key::Tab);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(harness.query_by_label("Recentre on the cable (C)").is_some(), "the third menu is open");
    let focused = |h: &Harness<'_, ViewerApp>| {
        let node = h.query_all(By::new().predicate(|n| n.is_focused())).next();
        node.and_then(|n| n.accesskit_node().label()).unwrap_or_default()
    };
    for _ in 0..60 {
        if focused(&harness) == "Grid" {
            break;
        }
        press(&mut harness, Modifiers::NONE, Key::Tab);
    }
    assert!(state(&harness).view.layers.grid && focused(&harness) == "Grid", "{}", focused(&harness));
    press(&mut harness, Modifiers::NONE, Key::Space);
    assert!(!state(&harness).view.layers.grid);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("Recentre on the cable (C)").is_none(), "it is closed");
    // Single keys are the window's again.
    press(&mut harness, Modifiers::NONE, Key::Space);
    assert!(!state(&harness).live.playback.paused);
}

#[test]
fn several_things_are_picked_by_keys() {
    let mut harness = open(catalog::over_beam());
    for _ in 0..3 {
        press(&mut harness, Modifiers::NONE, Key::M);
    }
    let ends = [0, 1].map(|support| Item::Support { cable: 0, support });
    assert_eq!(state(&harness).selection.selected_items(), [ends[0], ends[1], Item::Obstacle(0)]);
    press(&mut harness, Modifiers::NONE, Key::N);
    assert_eq!(state(&harness).selection.selected_items().len(), 1, "N picks one alone");
    // One alone, and another that is not the next.
    press(&mut harness, Modifiers::NONE, Key::M);
    assert_eq!(state(&harness).selection.selected_items(), [ends[1], Item::Obstacle(0)]);
    for _ in 0..20 {
        press(&mut harness, Modifiers::NONE, Key::M);
    }
    let mut all = cable_viewer::geometry::handles::all(state(&harness));
    let mut picks = state(&harness).selection.selected_items();
    all.sort_by_key(|i| format!("{i:?}"));
    picks.sort_by_key(|i| format!("{i:?}"));
    assert_eq!(picks, all, "each once");
}

#[test]
fn dialogs_have_their_buttons_in_sight_in_the_smallest_window() {
    let mut harness = open_span();
    for size in [Vec2::new(640.0, 400.0), Vec2::new(1280.0, 800.0)] {
        harness.set_size(size);
        for (dialog, button) in [
            (Dialog::About, "Close"),
            (Dialog::Help, "Close"),
            (
                Dialog::Feedback { answers: cable_viewer::io::feedback::Answers::default(), path: "f.csv".to_owned() },
                "Cancel",
            ),
            (Dialog::ImportMap { path: String::new(), text: "0 0\n".repeat(40), unit_m: "1".to_owned() }, "Cancel"),
            (Dialog::Recover { scene: Box::new(catalog::tank()) }, "Recover"),
        ] {
            let name = format!("{dialog:?} at {size}");
            apply(&mut harness, Command::File(FileCommand::SetDialog(Some(dialog))));
            harness.run_steps(4);
            let place = harness.get_all_by_label(button).last().unwrap_or_else(|| panic!("{name}")).rect();
            let window = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
            assert!(window.contains_rect(place), "{name}: {place}");
        }
        apply(&mut harness, Command::File(FileCommand::SetDialog(None)));
    }
}
