//! The messages of the solver are shown in the units on screen.

use cable_core::Model;
use cable_core::scene::catalog;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::units::system::System;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::rows::{answer, set_cable, state};
use crate::{apply, open};

/// Every text in the window that has a figure in an SI unit that US units have another for.
fn metric(harness: &egui_kittest::Harness<'_, cable_viewer::ViewerApp>) -> Vec<String> {
    let texts = harness.root().children_recursive().filter_map(|node| {
        let node = node.accesskit_node();
        node.value().or_else(|| node.label())
    });
    let si = |word: &str| {
        matches!(
            word.trim_matches(|c: char| !c.is_alphanumeric() && c != '/'),
            "N" | "kN" | "m" | "mm" | "N/m" | "kg/m"
        )
    };
    let is_number = |word: &str| word.trim_start_matches(['(', '-', '−']).starts_with(|c: char| c.is_ascii_digit());
    let has = |text: &String| {
        let words: Vec<&str> = text.split([' ', '\u{a0}']).collect();
        words.windows(2).any(|w| is_number(w[0]) && si(w[1]))
    };
    texts.filter(has).collect()
}

#[test]
fn warnings_and_refusals_are_read_in_us_units() {
    let mut harness = open(catalog::hanging_span());
    apply(&mut harness, Command::SetModel(Model::Fem));
    let most = answer(&harness).max_tension().tension_n;
    set_cable(&mut harness, |c| (c.service_tension_n, c.min_bend_radius_m) = (0.9 * most, 30.0));
    assert!(answer(&harness).warnings.len() >= 2, "{:?}", answer(&harness).warnings);
    assert!(!metric(&harness).is_empty(), "the measure sees SI figures");
    for k in 1..=answer(&harness).warnings.len() {
        harness.get_by_label(&format!("Details of warning {k}")).click();
        harness.run_steps(2);
    }
    apply(&mut harness, Command::View(ViewCommand::SetUnits(System::Us)));
    harness.run_steps(2);
    assert_eq!(metric(&harness), Vec::<String>::new());
    let pull = format!("carries {:.1} lbf", most / 4.448_221_615_260_5);
    harness.get_by_label_contains(&pull);
    // The reason why a scene cannot be solved is, too.
    set_cable(&mut harness, |c| c.length_m = 9.0);
    assert!(state(&harness).document.fault.is_some());
    assert_eq!(metric(&harness), Vec::<String>::new());
    apply(&mut harness, Command::View(ViewCommand::SetUnits(System::Si)));
    harness.run_steps(2);
}

/// “60” typed over “10.00 kN” said nothing of kilonewtons while it was typed.
#[test]
fn a_number_that_is_typed_has_its_unit_beside_it() {
    let mut harness = open(catalog::hanging_span());
    crate::select(&mut harness, cable_viewer::state::Item::Cable(0));
    for (field, unit) in [("Breaking tension", "kN"), ("Service tension", "N"), ("Damping", "%")] {
        let told = |harness: &egui_kittest::Harness<'_, cable_viewer::ViewerApp>| {
            let rect = harness.get_by_label(field).rect();
            let mut texts = Vec::new();
            harness.output().shapes.iter().for_each(|s| crate::warnings::galleys(&s.shape, &mut texts));
            texts.iter().any(|(text, r, _)| text == unit && rect.contains_rect(*r))
        };
        harness.get_by_label(field).focus();
        harness.run_steps(2);
        assert!(!told(&harness), "{field}: the value has its unit itself");
        harness.get_by_label(field).type_text("6");
        harness.run_steps(2);
        assert!(told(&harness), "{field}");
        harness.get_by_label(field).type_text("0 kN");
        harness.run_steps(2);
        assert!(!told(&harness), "{field}: a unit was typed");
        harness.key_press(egui::Key::Escape);
        harness.run_steps(2);
    }
}
