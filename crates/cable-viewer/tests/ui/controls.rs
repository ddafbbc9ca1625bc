//! No control is lost when the window is laid out anew: each that it had is still found by its
//! name.

use std::collections::BTreeSet;

use cable_core::scene::catalog;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::geometry::handles;
use cable_viewer::state::Item;
use egui::Vec2;

use crate::{apply, open};

/// Names of the controls of several scenes with several things picked, a line each, as they were
/// before the outline.
const BEFORE: &str = include_str!("controls.txt");

fn names() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for scene in [
        catalog::tank(),
        catalog::robot_drive(),
        catalog::loads_wind_heat(),
        catalog::pulley_waypoints(),
        catalog::round_post(),
        catalog::over_beam(),
    ] {
        let mut harness = open(scene);
        apply(&mut harness, Command::View(ViewCommand::AddReference));
        harness.set_size(Vec2::new(1600.0, 3000.0));
        // What edits a thing stands where it is selected.
        let all = handles::all(&harness.state().state);
        let others = [Item::Cable(0), Item::Scene, Item::Environment, Item::Solver];
        for picked in [None].into_iter().chain(all.into_iter().chain(others).map(Some)) {
            apply(&mut harness, Command::View(ViewCommand::Select(picked)));
            harness.run_steps(2);
            names.extend(crate::help::controls(&harness).into_iter().map(|(name, ..)| name).filter(|n| !n.is_empty()));
        }
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
