//! A quantity along the cable.

use cable_core::Cable;
use cable_core::solution::CableSolution;
use egui::Ui;

use crate::panels::unit::Unit;

use super::measure::Measure;
use super::series::Series;
use super::{Graph, Touched, View, limits, show};

/// Draws it.
pub fn ui(ui: &mut Ui, cable: &Cable, solved: &CableSolution, view: View, height: f32) -> Touched {
    let (quantity, follow) = (view.measure.quantity(), view.follow);
    let points = solved.nodes.iter().map(|n| [n.arc_length_m, quantity.of(n)]).collect();
    let graph = Graph {
        title: "Along the cable",
        measure: Measure::Cable(quantity),
        across: ("Arc length", Unit::M),
        range: [0.0, cable.length_m],
        limits: limits(quantity, cable),
        follow,
        height,
        mark: None,
    };
    show(ui, &graph, &[Series { name: quantity.name().to_owned(), points, held: None }])
}
