//! The quality of the answer is shown by the force left unbalanced, the greatest displacement, an
//! estimate of the conditioning of the equations, and whether the motion gains energy.
//!
//! - `condition_number`: how badly the equations are conditioned, as of a straight cable
//! - `kinetic_peaks`: whether the motion gains energy

mod condition_number;
mod kinetic_peaks;

use cable_core::solution::Node;
use cable_core::{Scene, Solution};
use egui::Ui;

use crate::command::Command;
use crate::panels::quality::condition_number::estimated;
use crate::panels::quality::kinetic_peaks::kinetic_peaks_j;
use crate::panels::readouts;
use crate::record::history::History;
use crate::state::AppState;
use crate::units::format;
use crate::widgets::readout;

/// A peak of the kinetic energy above that of the span before by less is said to be steady.
const MIN_GROWTH_RATIO: f64 = 1.1;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, answer: &Solution, commands: &mut Vec<Command>) {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    readouts::dimmed_if_old(ui, state, |ui| {
        residual(ui, state.solver.settings.tolerance, answer);
        displacement(ui, answer, commands);
        conditioning(ui, state.solver.settings.tolerance, scene, answer);
        kinetic_energy(ui, &state.live.history, answer);
    });
}

fn residual(ui: &mut Ui, tolerance: f64, answer: &Solution) {
    let greatest_n = answer.max_tension().tension_n;
    let share = if greatest_n > 0.0 { answer.cost.residual_n / greatest_n } else { 0.0 };
    let wrong = (share > tolerance).then_some("It is above the tolerance asked for: the tensions are not settled");
    let value = format!("{} ({})", format::force(answer.cost.residual_n), format::percent(share));
    let help = "Largest force left unbalanced at a node, and its share of the greatest tension: the smaller, the closer to equilibrium";
    readout::assessed_row(ui, "Residual", &value, help, wrong);
}

fn displacement(ui: &mut Ui, answer: &Solution, commands: &mut Vec<Command>) {
    let far = |n: &Node| n.displacement_m[0].hypot(n.displacement_m[1]);
    let nodes = answer.cables.iter().flat_map(|c| c.nodes.iter().map(move |n| (c, n)));
    let most = nodes.max_by(|a, b| far(a.1).total_cmp(&far(b.1))).filter(|(_, n)| far(n) > 0.0);
    let help = "How far the node that moved most is from where it was when the run began";
    match most {
        None => readout::row(ui, "Greatest displacement", &format::length(0.0), help, |_| {}),
        Some((cable, node)) => {
            let help = format!("{help}: it is on {}", cable.name);
            readout::row(ui, "Greatest displacement", &format::length(far(node)), &help, |ui| {
                readouts::place(ui, "Show greatest displacement", node, commands);
            });
        }
    }
}

fn conditioning(ui: &mut Ui, tolerance: f64, scene: &Scene, answer: &Solution) {
    let name = "Condition estimate";
    if !answer.model.capabilities().mesh {
        return readout::row(ui, name, "no mesh", "A model without a mesh solves no large system of equations", |_| {});
    }
    let all = scene.cables.iter().zip(&answer.cables).filter_map(|(cable, solved)| estimated(cable, solved));
    let Some(worst) = all.reduce(f64::max) else {
        return readout::row(ui, name, "not known", "No cable is under tension", |_| {});
    };
    let wrong = (worst * f64::EPSILON > tolerance)
        .then_some("Rounding alone may spoil the tolerance asked for: use fewer segments, or a softer cable");
    let help = "Condition number, estimated as that of a straight cable of as many elements under the mean tension, without bending and \
                contact: of 16 digits its logarithm are lost to rounding";
    readout::assessed_row(ui, name, &format!("≈ {worst:.1e}"), help, wrong);
}

fn kinetic_energy(ui: &mut Ui, history: &History, answer: &Solution) {
    let help = "Energy of motion now, and whether its greatest in the last second is above that of the second before. \
                What supports, loads and the robot do explains a growth; energy that nothing gave is warned of";
    let now = format::energy(answer.energy.kinetic_j);
    let grows = kinetic_peaks_j(history).filter(|[before, last]| *last > MIN_GROWTH_RATIO * before && *last > 0.0);
    let value = grows.map_or_else(|| now.clone(), |_| format!("{now}, growing"));
    readout::assessed_row(ui, "Kinetic energy", &value, help, grows.map(|_| "It grows"));
}
