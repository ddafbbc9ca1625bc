//! The largest tension and the pulls at both ends against time.

use egui::Ui;

use super::series::{Series, thin};
use super::{Graph, View, limits, per_newton, show};
use crate::colour::Quantity;
use crate::history::Sample;
use crate::state::AppState;

/// Shortest time axis, s: the first frames would otherwise jump.
const SHORTEST_S: f64 = 1.0;

/// Draws it. Stress and strain follow from tension for a single cable only; with several, tension is shown.
pub fn ui(ui: &mut Ui, state: &AppState, view: View, height: f32) {
    let index = state.current_cable();
    let scene = state.snapshot.scene.as_deref().unwrap_or(&state.scene);
    let Some(cable) = scene.cables.get(index) else { return };
    let quantity = if scene.cables.len() == 1 { view.quantity } else { Quantity::Tension };
    let scale = per_newton(quantity, cable);
    let now_s = state.history.samples.back().map_or(0.0, |s| s.time_s);
    let first_s = state.history.samples.front().map_or(0.0, |s| s.time_s);
    let left_s = view.window_s.map_or(first_s, |w| (now_s - w).max(first_s));
    let range = [left_s, now_s.max(left_s + view.window_s.unwrap_or(SHORTEST_S).max(SHORTEST_S))];
    // Outside the window nothing is seen while it follows, and everything while it does not.
    let start = if view.follow { state.history.samples.partition_point(|s| s.time_s < left_s) } else { 0 };
    let columns = ui.available_width().max(1.0) as usize;
    let line = |name: String, of: &dyn Fn(&Sample) -> f64| Series {
        name,
        points: thin(state.history.samples.range(start..).map(|s| [s.time_s, of(s) * scale]), columns),
    };
    let what = if scene.cables.len() == 1 { "Maximum" } else { "Maximum of all" };
    let mut lines = vec![line(what.to_owned(), &|s| s.max_tension_n)];
    // Reactions of all cables stand one after the other.
    let before: usize = scene.cables.iter().take(index).map(|c| c.supports.len()).sum();
    for k in [0, cable.supports.len().saturating_sub(1)] {
        let Some(support) = cable.supports.get(k) else { continue };
        let pull = move |s: &Sample| s.reactions_n.get(before + k).map_or(f64::NAN, |r| r[0].hypot(r[1]));
        lines.push(line(format!("At {}", support.name), &pull));
    }
    let graph = Graph {
        title: "Over time",
        quantity,
        across: ["Time", "s"],
        range,
        limits: limits(quantity, cable),
        follow: view.follow,
        height,
    };
    show(ui, &graph, &lines);
}
