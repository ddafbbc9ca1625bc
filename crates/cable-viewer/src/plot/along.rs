//! A graph shows a quantity along the cable.

use cable_core::Cable;
use cable_core::analysis::friction_range::TensionRange;
use cable_core::solution::CableSolution;
use egui::Ui;

use crate::plot::{Graph, GraphResponse, GraphView, show};
use crate::record::measure::{Measure, per_newton, tension_limits};
use crate::record::series::{Series, thin};
use crate::units::unit::Unit;

/// Its title.
pub const TITLE: &str = "Along the cable";
/// The group of graphs along the cable.
pub const GROUP: &str = "along";

/// Draws it.
pub fn ui(
    ui: &mut Ui,
    cable: &Cable,
    solved: &CableSolution,
    ribbon: &[TensionRange],
    view: GraphView,
    height: f32,
) -> GraphResponse {
    let (quantity, follow) = (view.measure.quantity(), view.follow);
    let columns = ui.available_width().max(1.0) as usize;
    let all = || solved.nodes.iter().map(|n| [n.arc_length_m, quantity.of(n)]);
    let line = |points| vec![Series { name: quantity.name().to_owned(), points, ..Series::default() }];
    let graph = Graph {
        title: TITLE,
        group: GROUP,
        measure: Measure::Cable(quantity),
        across: ("Arc length", Unit::M),
        range: [0.0, cable.length_m],
        last: cable.length_m * (1.0 + 1e-9),
        limits: tension_limits(quantity, cable),
        follow,
        height,
        ribbon: {
            let scale = per_newton(quantity, cable);
            ribbon.iter().map(|b| [b.at, b.low_n * scale, b.high_n * scale]).collect()
        },
        mark: None,
        export: view.export == Some(TITLE),
    };
    let mut touched = show(ui, &graph, &line(thin(all(), columns)));
    if let Some(sheet) = &mut touched.export {
        // Every node, not only those that can be told apart on screen.
        sheet.lines = line(all().collect());
    }
    touched
}
