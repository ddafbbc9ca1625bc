//! The window has words for what a scene file calls by short names.

use cable_core::Model;
use cable_core::scene::catalog;
use cable_viewer::command::{Command, FileCommand, SceneCommand};
use cable_viewer::state::Item;
use cable_viewer::state::dialog::Dialog;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{apply, open, select};

/// Everything that the window says, a line each.
fn said(harness: &egui_kittest::Harness<'_, cable_viewer::ViewerApp>) -> Vec<String> {
    let mut left = vec![harness.root()];
    let mut out = Vec::new();
    while let Some(node) = left.pop() {
        left.extend(node.children());
        let inner = node.accesskit_node();
        out.extend([inner.label(), inner.value()].into_iter().flatten());
    }
    out
}

#[test]
fn a_fault_and_a_refusal_are_told_without_keys_and_short_names() {
    // A fault beside its field, in the list of warnings and on the canvas.
    let mut harness = open(catalog::hanging_span());
    let mut scene = harness.state().state.document.scene.clone();
    scene.cables[0].supports[1].at_m = None;
    apply(&mut harness, Command::Scene(SceneCommand::SetScene(Box::new(scene))));
    select(&mut harness, Item::Support { cable: 0, support: 1 });
    harness.run_steps(2);
    let told = said(&harness);
    assert!(told.iter().any(|t| t.contains("is missing")), "{told:?}");
    let keys: Vec<_> = told.iter().filter(|t| t.contains("at_m") || t.contains("cables[")).collect();
    assert!(keys.is_empty(), "{keys:?}");
    // A model that cannot answer.
    let mut harness = open(catalog::over_beam());
    apply(&mut harness, Command::SetModel(Model::Catenary));
    harness.run_steps(2);
    let told = said(&harness);
    assert!(told.iter().any(|t| t.contains("Catenary cannot answer this scene")), "{told:?}");
    assert!(!told.iter().any(|t| t.contains("catenary cannot")), "{told:?}");
}

#[test]
fn texts_of_the_wording_table() {
    let mut harness = open(catalog::tank_robot());
    select(&mut harness, Item::Robot);
    harness.set_size(egui::Vec2::new(1280.0, 2400.0));
    harness.run_steps(3);
    harness.get_by_label("Start position, m");
    harness.get_by_label("Traction used");
    let (path, text, unit_m) = (String::new(), "0 0\n1 0\n".to_owned(), "1".to_owned());
    apply(&mut harness, Command::File(FileCommand::SetDialog(Some(Dialog::ImportMap { path, text, unit_m }))));
    harness.get_by_label("1 unit =");
}
