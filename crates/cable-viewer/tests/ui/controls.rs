//! No control is lost when the window is laid out anew: each that it had is still found by its
//! name.

use std::collections::BTreeSet;

use cable_core::scene::{Scene, catalog};
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::geometry::handles;
use cable_viewer::state::Item;
use egui::Vec2;

use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

type Window = egui_kittest::Harness<'static, cable_viewer::ViewerApp>;

/// Names of the controls of several scenes with several things picked, a line each, as they were
/// before the outline.
const BEFORE: &str = include_str!("controls.txt");

/// Opens a scene and looks at the window with each of its things picked in turn.
fn with_each_thing_picked(scene: Scene, mut look: impl FnMut(&Window)) -> Window {
    let mut harness = open(scene);
    apply(&mut harness, Command::View(ViewCommand::AddReference));
    harness.set_size(Vec2::new(1600.0, 3000.0));
    // A form that edits a thing stands where it is selected.
    let all = handles::all(&harness.state().state);
    let others = [Item::Cable(0), Item::Scene, Item::Environment, Item::Solver];
    for picked in [None].into_iter().chain(all.into_iter().chain(others).map(Some)) {
        apply(&mut harness, Command::View(ViewCommand::Select(picked)));
        harness.run_steps(2);
        look(&harness);
    }
    harness
}

fn names() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for scene in [
        catalog::tank(),
        crate::kinked_tank(),
        catalog::robot_drive(),
        catalog::loads_wind_heat(),
        catalog::pulley_waypoints(),
        catalog::round_post(),
        catalog::over_beam(),
    ] {
        with_each_thing_picked(scene, |harness| {
            names.extend(crate::help::controls(harness).into_iter().map(|(name, ..)| name).filter(|n| !n.is_empty()));
        });
    }
    names
}

#[test]
fn no_control_is_lost() {
    let now = names();
    if std::env::var_os("LIST_CONTROLS").is_some() {
        now.iter().for_each(|name| println!("CONTROL {name}"));
    }
    let lost: Vec<&str> = BEFORE.lines().filter(|name| !now.contains(*name)).collect();
    assert!(lost.is_empty(), "{} controls are gone: {lost:?}", lost.len());
    println!("{} controls before, {} now", BEFORE.lines().count(), now.len());
}

/// Buttons that the palette has no use for: menus, of which it has the entries, those of single
/// rows of a table, and figures that lead to where they are.
fn is_left_out(name: &str) -> bool {
    let menus = ["File", "Edit", "View", "Tools", "Scenes", "Learn", "Colours", "Open recent"];
    let rows = ["Remove corner ", "Add a corner after corner ", "Add a time after ", "Remove time "];
    let is_count = ["warning", "warnings", "note", "notes"].iter().any(|word| name.ends_with(&format!(" {word}")));
    let figure = name.starts_with("Max ") || is_count || name.starts_with("Command palette");
    menus.contains(&name) || rows.iter().any(|begins| name.starts_with(begins)) || figure
}

/// The palette had 60 of the window's commands, and no layer, no graph and no box of a form.
#[test]
fn the_palette_knows_every_button_by_the_words_on_it() {
    let (mut unknown, mut asked) = (BTreeSet::new(), BTreeSet::new());
    let mut ask = |harness: &Window| {
        for (name, role, _) in crate::help::controls(harness) {
            let button = matches!(role, Role::Button | Role::CheckBox | Role::RadioButton);
            if !button || name.is_empty() || is_left_out(&name) || !asked.insert(name.clone()) {
                continue;
            }
            // Menus tell their key beside the words.
            let words = [" (", " Ctrl+"].iter().find_map(|key| name.split_once(key));
            let words = words.map_or(name.as_str(), |(words, _)| words).trim_end_matches('…');
            if cable_viewer::app::palette::names(words, &harness.state().state).is_empty() {
                unknown.insert(name);
            }
        }
    };
    for scene in [
        catalog::tank(),
        catalog::tank_robot(),
        catalog::loads_wind_heat(),
        catalog::pulley_waypoints(),
        catalog::floor_drag(),
    ] {
        let mut harness = with_each_thing_picked(scene, &mut ask);
        for menu in ["File", "Edit", "View", "Tools", "Scenes", "Learn"] {
            harness.get_by_role_and_label(Role::Button, menu).click();
            harness.run_steps(3);
            ask(&harness);
            harness.key_press(egui::Key::Escape);
            harness.run_steps(2);
        }
    }
    println!("{} buttons asked for", asked.len());
    assert!(asked.len() > 200, "{asked:?}");
    assert!(unknown.is_empty(), "{} are not found: {unknown:#?}", unknown.len());
    // A graph that is asked for by name is shown, and a layer is drawn.
    let mut harness = open(catalog::tank());
    let names = |h: &egui_kittest::Harness<'_, cable_viewer::ViewerApp>, text: &str| {
        cable_viewer::app::palette::names(text, &h.state().state)
    };
    assert_eq!(names(&harness, "graph stress")[0], "Graph of stress");
    for typed in ["graph of stress", "nodes on"] {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::P);
        harness.run_steps(3);
        harness.event(egui::Event::Text(typed.to_owned()));
        harness.run_steps(2);
        harness.key_press(egui::Key::Enter);
        harness.run_steps(4);
    }
    assert!(harness.state().state.view.layers.nodes);
    let along = harness.get_by_role_and_label(Role::Figure, "Along the cable");
    let told = egui_kittest::kittest::NodeT::accesskit_node(&along).description().unwrap_or_default();
    assert!(told.contains("Pa"), "{told}");
}
