//! A graph shows a quantity along the cable.

use cable_core::Cable;
use cable_core::analysis::friction_range::TensionRange;
use cable_core::solution::{CableSolution, TensionPeak};
use egui::Ui;

use crate::plot::{Graph, GraphResponse, GraphView, show};
use crate::record::plotted_quantity::{Measure, per_newton, tension_limits};
use crate::record::series::{Series, thin, value_at};
use crate::render::colour::CableQuantity;
use crate::units::unit::Unit;

/// Its title.
pub const TITLE: &str = "Along the cable";
/// The group of graphs along the cable.
pub const GROUP: &str = "along";
/// Name of the greatest of the inner steps.
const PEAK: &str = "Peak since last frame";
/// A peak is marked where it is above the line by more than this part of it. Smaller: every frame
/// of a swing has a mark on its line; larger: a warning names more than the graph shows.
const MIN_PEAK_FRACTION: f64 = 0.01;

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
    let mut shown = line(thin(all(), columns));
    shown.extend(peak(solved, quantity, cable));
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
        hint: None,
        export: view.export == Some(TITLE),
    };
    let mut touched = show(ui, &graph, &shown);
    if let Some(sheet) = &mut touched.export {
        // Every node, not only those that can be told apart on screen; a column of places has no
        // row for the peak.
        sheet.lines = line(all().collect());
    }
    touched
}

/// The greatest tension of the inner steps that ended here, and what follows from it, at its place:
/// warnings name it, and the line of the instant stands below it.
fn peak(solved: &CableSolution, quantity: CableQuantity, cable: &Cable) -> Option<Series> {
    let TensionPeak { tension_n, arc_length_m, .. } = solved.peaks?.greatest;
    let tensions: Vec<[f64; 2]> = solved.nodes.iter().map(|n| [n.arc_length_m, n.tension_n]).collect();
    let now_n = value_at(&tensions, arc_length_m).unwrap_or(0.0);
    let above = tension_n > (1.0 + MIN_PEAK_FRACTION) * now_n;
    let points = vec![[arc_length_m, tension_n * per_newton(quantity, cable)]];
    above.then(|| Series { name: PEAK.to_owned(), points, ..Series::default() })
}

#[cfg(test)]
mod tests {
    use cable_core::scene::catalog;
    use cable_core::solution::{Node, TensionPeaks};

    use super::*;

    /// The warning of a jerk between two frames named what the graph did not show.
    #[test]
    fn a_peak_between_two_frames_is_marked_where_it_was() {
        let node = |arc_length_m| Node { arc_length_m, tension_n: 100.0, ..Node::default() };
        let with = |tension_n| {
            let greatest = TensionPeak { tension_n, arc_length_m: 1.5, time_s: 0.0 };
            let peaks = Some(TensionPeaks { greatest, ..TensionPeaks::default() });
            CableSolution { nodes: vec![node(0.0), node(2.0)].into(), peaks, ..CableSolution::default() }
        };
        let cable = &catalog::hanging_span().cables[0];
        let found = |tension_n| peak(&with(tension_n), CableQuantity::Tension, cable).map(|s| s.points);
        assert_eq!(found(250.0), Some(vec![[1.5, 250.0]]));
        assert_eq!(found(100.5), None);
        assert_eq!(peak(&CableSolution { peaks: None, ..with(250.0) }, CableQuantity::Tension, cable), None);
    }
}
