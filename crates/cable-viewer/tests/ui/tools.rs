//! Tools are verbs of a menu and of the palette, and each leads to where it is answered.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::app::analysis_tools::tools;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::state::OpenPanels;
use egui::accesskit::Role;
use egui::{Rect, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::{apply, open};

/// The verbs, and the heading of the section that each leads to.
const HEADINGS: [(&str, &str); 7] = [
    ("Find safe reach", "Safe reach"),
    ("Mark the greatest tension", "Tension at the marked place"),
    ("Pin this result", "Compare"),
    ("Compare all models", "Compare"),
    ("Find the friction range", "Friction range"),
    ("Plot error against cost for all models", "Selected"),
    ("Compare with the likely bending stiffness", "Readouts"),
];

/// The sections lay at the foot of the right panel, below 25 figures, and no menu named them.
#[test]
fn every_tool_of_the_menu_leads_to_its_section() {
    for size in [[1280.0, 800.0], [1024.0, 640.0], [800.0, 600.0]] {
        for (verb, heading) in HEADINGS {
            let mut harness = open(catalog::over_beam());
            harness.set_size(Vec2::from(size));
            apply(
                &mut harness,
                Command::View(ViewCommand::ShowPanels(OpenPanels { results: false, ..OpenPanels::default() })),
            );
            harness.run_steps(3);
            click(&mut harness, "Tools");
            click(&mut harness, verb);
            harness.run_steps(20);
            let at = heading_rect(&harness, heading);
            assert!(at.top() > 20.0 && at.bottom() < size[1] - 20.0, "{verb} at {size:?}: {heading} stands at {at:?}");
        }
    }
}

#[test]
fn the_palette_has_the_same_verbs() {
    let mut harness = open(catalog::over_beam());
    for tool in tools(&harness.state().state).iter().filter(|t| t.command.is_some()) {
        let found = cable_viewer::app::palette::names(tool.name, &harness.state().state);
        assert_eq!(found[0], tool.name);
    }
    // A section that was folded by hand is unfolded.
    harness.set_size(Vec2::new(1280.0, 2400.0));
    harness.run_steps(4);
    let heading = heading_rect(&harness, "Friction range").center();
    harness.hover_at(heading);
    harness.step();
    for pressed in [true, false] {
        crate::press(&harness, heading, pressed);
        harness.step();
    }
    harness.run_steps(20);
    assert!(harness.query_by_label("Show friction range").is_none());
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::P);
    harness.run_steps(3);
    harness.event(egui::Event::Text("find the friction".to_owned()));
    harness.run_steps(2);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(20);
    harness.get_by_label("Show friction range");
    assert!(harness.state().state.analysis.friction_range.on);
}

fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_role_and_label(Role::Button, label).click();
    harness.run_steps(4);
}

fn heading_rect(harness: &Harness<'_, ViewerApp>, heading: &str) -> Rect {
    harness.query_all_by_label(heading).map(|n| n.rect()).next().unwrap_or(Rect::NOTHING)
}
