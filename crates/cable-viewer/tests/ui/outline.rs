//! The outline on the left selects, and the panel on the right follows what is selected.

use cable_core::scene::catalog;
use cable_viewer::ViewerApp;
use cable_viewer::command::{Command, ViewCommand};
use cable_viewer::state::Item;
use egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

use crate::{kinked_tank, open};

fn click(harness: &mut Harness<'_, ViewerApp>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

fn selected(harness: &Harness<'_, ViewerApp>) -> Option<Item> {
    harness.state().state.selection.selected
}

#[test]
fn the_outline_begins_the_left_panel_and_selects() {
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
        let mut harness = open(kinked_tank());
        harness.set_size(Vec2::from(size));
        harness.run_steps(4);
        let [outline, scene, canvas] = ["Outline", "Select Scene", "Canvas"].map(|l| harness.get_by_label(l).rect());
        assert!(outline.bottom() < scene.top() && outline.right() < canvas.left(), "{size:?}");
        for (label, item) in [
            ("Select umbilical", Item::Cable(0)),
            ("Select hitch", Item::Support { cable: 0, support: 1 }),
            ("Select pipe", Item::Obstacle(4)),
            ("Select Scene", Item::Scene),
            ("Select Environment", Item::Environment),
            ("Select Solver", Item::Solver),
        ] {
            click(&mut harness, label);
            assert_eq!(selected(&harness), Some(item), "{size:?}");
        }
        // Warnings are the last of it, and lead to the worst.
        let before = harness.state().state.view.camera.points_per_m;
        click(&mut harness, "1 warning, 1 note");
        assert!(harness.state().state.view.camera.points_per_m > 1.5 * before, "{size:?}");
    }
    let mut harness = open(catalog::robot_drive());
    click(&mut harness, "Select robot");
    assert_eq!(selected(&harness), Some(Item::Robot));
    click(&mut harness, "Select leg 1");
    assert_eq!(selected(&harness), Some(Item::PathLeg(0)));
}

/// A hitch that the scene moves was called "Fixed".
#[test]
fn a_support_that_the_scene_moves_is_not_called_fixed() {
    let mut scene = catalog::floor_drag();
    scene.cables[0].supports.iter_mut().for_each(|s| s.motion = None);
    let (still, moved) = (scene, catalog::floor_drag());
    let name = moved.cables[0].supports.iter().find(|s| s.motion.is_some()).unwrap().name.clone();
    for (scene, word, other) in [(still, "Fixed", "Scheduled"), (moved, "Scheduled", "Fixed")] {
        let mut harness = open(scene);
        click(&mut harness, &format!("Select {name}"));
        let row = harness.get_by_label(&format!("Select {name}")).rect();
        let mut texts = Vec::new();
        harness.output().shapes.iter().for_each(|s| crate::warnings::galleys(&s.shape, &mut texts));
        let in_row: Vec<&str> =
            texts.iter().filter(|(_, r, _)| row.contains(r.center())).map(|(text, ..)| text.as_str()).collect();
        assert!(in_row.contains(&word) && !in_row.contains(&other), "{in_row:?}");
        let kind = format!("Kind of {name}");
        let form = harness.get_by_label(&kind);
        let value = form.accesskit_node().value().or_else(|| form.accesskit_node().label()).unwrap_or_default();
        assert!(!value.contains(other), "{value}");
    }
}

#[test]
fn the_right_panel_follows_the_selection() {
    for (scene, row, title, figures) in [
        (catalog::tank(), "Select hitch", "Support “hitch” of “umbilical”", &["Force on it", "Arc length"][..]),
        (
            catalog::pulley_waypoints(),
            "Select wheel",
            "Support “wheel” of “cable”",
            &["Tension before", "Tension after"],
        ),
        (catalog::tank(), "Select beam", "Obstacle “beam”", &["Lying on it", "Friction"]),
        (catalog::loads_wind_heat(), "Select load 1", "Load 1", &["Tension there"]),
        (catalog::tank(), "Select umbilical", "Cable “umbilical”", &["Cable preset", "Length slider"]),
        (catalog::tank(), "Select Scene", "The scene", &["Scene name", "Map"]),
        (catalog::tank(), "Select Environment", "The environment", &["Gravity", "Plan view"]),
        (catalog::tank(), "Select Solver", "The solver", &["Tolerance", "FEM", "Plot error against cost"]),
        (catalog::robot_drive(), "Select robot", "The robot", &["Pull of the cable", "Add drive", "Robot facing"]),
    ] {
        let mut harness = open(scene);
        let canvas = harness.get_by_label("Canvas").rect();
        assert!(harness.query_by_label("Deselect").is_none());
        click(&mut harness, row);
        let beside = |label: &str| {
            let mut found = harness.get_all_by_label(label);
            assert!(found.any(|n| n.rect().left() > canvas.right()), "{title}: {label} stands in the right panel");
        };
        beside(title);
        figures.iter().for_each(|label| beside(label));
        assert_eq!(harness.get_by_label("Canvas").rect(), canvas, "{title}: the canvas stays");
        click(&mut harness, "Deselect");
        assert_eq!(selected(&harness), None);
    }
}

/// A row too wide for the panel would push its figures out of sight.
#[test]
fn the_form_of_what_is_selected_fits_the_panel() {
    for (scene, item) in [
        (catalog::tank(), Item::Support { cable: 0, support: 1 }),
        (catalog::pulley_waypoints(), Item::Support { cable: 0, support: 1 }),
        (catalog::tank(), Item::Obstacle(0)),
        (catalog::loads_wind_heat(), Item::Load(0)),
        (catalog::robot_drive(), Item::Robot),
        (catalog::tank(), Item::Cable(0)),
        (catalog::tank(), Item::Scene),
        (catalog::tank(), Item::Environment),
        (catalog::tank(), Item::Solver),
    ] {
        let mut harness = open(scene);
        harness.set_size(Vec2::new(1024.0, 1600.0));
        crate::apply(&mut harness, Command::View(ViewCommand::Select(Some(item))));
        harness.run_steps(4);
        let canvas = harness.get_by_label("Canvas").rect();
        let (mut left, mut too_wide) = (vec![harness.root()], Vec::new());
        while let Some(node) = left.pop() {
            left.extend(node.children());
            let told = node.accesskit_node().label().unwrap_or_default();
            if told.is_empty() {
                continue;
            }
            let rect = node.rect();
            // The list of supports in the panel of figures scrolls by itself.
            let right = rect.left() > canvas.right() && rect.right() > 1024.0 - 3.0;
            let beside = rect.top() > canvas.top() && rect.bottom() < canvas.bottom();
            let left = beside && rect.right() < canvas.left() + 60.0 && rect.right() > canvas.left() - 3.0;
            if left || right {
                too_wide.push(format!("{told} ends at {}", rect.right()));
            }
        }
        assert!(too_wide.is_empty(), "{item:?}: {too_wide:?} beside {canvas}");
    }
}
