//! Warnings are rows of a line each, whatever the width of the panel; a click leads to the place,
//! and the words come on demand.

use cable_core::scene::catalog;
use cable_core::solution::WarningKind;
use egui::{Order, Vec2};
use egui_kittest::kittest::Queryable;

use crate::open;

/// What has several warnings at rest, one of them with a long name.
const TOLD: [&str; 2] = ["Kinked at", "Rest shape is not unique at"];

#[test]
fn a_warning_is_one_line_at_every_width() {
    let mut harness = open(catalog::tank());
    for size in [[1024.0, 640.0], [1280.0, 800.0], [1920.0, 1080.0]] {
        harness.set_size(Vec2::from(size));
        harness.run_steps(4);
        let window = harness.ctx.content_rect();
        let rows = TOLD.map(|told| harness.get_by_label_contains(told).rect());
        for (row, told) in rows.iter().zip(TOLD) {
            assert!(row.height() < 24.0, "{size:?}: {told} is {} high", row.height());
            assert!(window.contains_rect(*row), "{size:?}: {told} at {row}");
        }
        assert!(rows[1].top() - rows[0].top() < 26.0, "{size:?}: {rows:?}");
    }
}

#[test]
fn a_click_on_a_warning_zooms_and_its_words_stand_on_hover_or_below() {
    let mut harness = open(catalog::tank());
    harness.ctx.all_styles_mut(|style| {
        style.interaction.tooltip_delay = 0.0;
        style.interaction.show_tooltips_only_when_still = false;
    });
    let answer = harness.state().state.live.snapshot.solution.clone().unwrap();
    let kink = answer.warnings.iter().find(|w| w.kind == WarningKind::Kink).expect("a kink");
    let words = cable_viewer::units::sentence::sentence(kink);
    assert!(harness.query_by_label(&words).is_none(), "not before they are asked for");
    let row = harness.get_by_label_contains(TOLD[0]).rect();
    harness.hover_at(row.center());
    harness.run_steps(3);
    assert!(harness.ctx.memory(|m| m.areas().visible_layer_ids().iter().any(|l| l.order == Order::Tooltip)));
    let before = harness.state().state.view.camera.points_per_m;
    harness.get_by_label_contains(TOLD[0]).click();
    harness.run_steps(3);
    assert!(harness.state().state.view.camera.points_per_m > 1.5 * before);
    harness.get_by_label("Details of warning 1").click();
    harness.run_steps(3);
    harness.get_by_label(&words);
}
