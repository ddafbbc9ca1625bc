//! The quality of the answer: the force left unbalanced, the greatest displacement, an estimate of
//! the conditioning of the equations, and whether the motion gains energy.

use cable_core::solution::{CableSolution, Node};
use cable_core::{Cable, Model, Scene, Solution};
use egui::Ui;

use crate::command::Command;
use crate::panels::readouts;
use crate::record::samples::{History, Sample};
use crate::state::AppState;
use crate::units::format;
use crate::widgets::icon::{self, Icon};
use crate::widgets::readout;

/// Time over which the kinetic energy is compared with that of as long before, s. Shorter: every
/// swing is a growth; longer: a run that diverges has ended.
const GROWTH_SPAN_S: f64 = 1.0;
/// A peak of the kinetic energy above that of the span before by less is said to be steady.
const GROWTH: f64 = 1.1;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, answer: &Solution, commands: &mut Vec<Command>) {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    residual(ui, state.solver.settings.tolerance, answer);
    displacement(ui, answer, commands);
    conditioning(ui, state.solver.settings.tolerance, scene, answer);
    kinetic_energy(ui, &state.live.history, answer);
}

/// A row that says in the colour of warnings where something is wrong.
fn judged(ui: &mut Ui, name: &str, value: &str, help: &str, wrong: Option<&str>) {
    let help = wrong.map_or_else(|| help.to_owned(), |wrong| format!("{wrong}. {help}"));
    readout::row(ui, name, value, &help, |ui| {
        if wrong.is_some() {
            icon::sign(ui, Icon::Caution, ui.visuals().warn_fg_color);
        }
    });
}

fn residual(ui: &mut Ui, tolerance: f64, answer: &Solution) {
    let greatest_n = answer.max_tension().tension_n;
    let share = if greatest_n > 0.0 { answer.cost.residual_n / greatest_n } else { 0.0 };
    let wrong = (share > tolerance).then_some("It is above the tolerance asked for: the tensions are not settled");
    let value = format!("{} ({})", format::force(answer.cost.residual_n), format::percent(share));
    let help = "Largest force left unbalanced at a node, and its share of the greatest tension: the smaller, the closer to equilibrium";
    judged(ui, "Residual", &value, help, wrong);
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

/// The ratio of the stiffest to the softest way in which a straight cable of n equal elements of
/// length h under a tension T gives way: the eigenvalues of its stiffness matrix lie between
/// T/h·(2 − 2 cos π/n), all of it moving sideways, and EA/h·(2 + 2 cos π/n), neighbours moving
/// against each other along it. Bending and contact are not in it.
#[must_use]
pub fn condition_number(axial_stiffness_n: f64, tension_n: f64, elements: usize) -> f64 {
    let turn = (std::f64::consts::PI / elements.max(2) as f64).cos();
    axial_stiffness_n * (1.0 + turn) / (tension_n * (1.0 - turn))
}

fn estimated(cable: &Cable, solved: &CableSolution) -> Option<f64> {
    let tensions = || solved.nodes.iter().map(|n| n.tension_n).filter(|t| t.is_finite());
    let mean_n = tensions().sum::<f64>() / tensions().count().max(1) as f64;
    (mean_n > 0.0).then(|| condition_number(cable.axial_stiffness_n, mean_n, solved.nodes.len().saturating_sub(1)))
}

fn conditioning(ui: &mut Ui, tolerance: f64, scene: &Scene, answer: &Solution) {
    let name = "Condition estimate";
    if answer.model != Model::Fem {
        return readout::row(ui, name, "no mesh", "Only FEM solves one large system of equations", |_| {});
    }
    let all = scene.cables.iter().zip(&answer.cables).filter_map(|(cable, solved)| estimated(cable, solved));
    let Some(worst) = all.reduce(f64::max) else {
        return readout::row(ui, name, "not known", "No cable is under tension", |_| {});
    };
    let wrong = (worst * f64::EPSILON > tolerance)
        .then_some("Rounding alone may spoil the tolerance asked for: use fewer segments, or a softer cable");
    let help = "Condition number, estimated as that of a straight cable of as many elements under the mean tension, without bending and \
                contact: of 16 digits its logarithm are lost to rounding";
    judged(ui, name, &format!("≈ {worst:.1e}"), help, wrong);
}

/// The greatest kinetic energy of the last span and of that before, J; None where less was
/// recorded.
#[must_use]
pub fn kinetic_peaks_j(history: &History) -> Option<[f64; 2]> {
    let now_s = history.samples.back()?.time_s;
    let first_s = history.samples.front()?.time_s;
    let peak = |from_s: f64| {
        let seen = history.view([from_s, from_s + GROWTH_SPAN_S], None);
        let inside = |s: &&&Sample| s.time_s > from_s && s.time_s <= from_s + GROWTH_SPAN_S;
        seen.iter().filter(inside).map(|s| s.energy_j[0]).fold(0.0, f64::max)
    };
    let before_s = now_s - 2.0 * GROWTH_SPAN_S;
    (before_s >= first_s).then(|| [peak(before_s), peak(now_s - GROWTH_SPAN_S)])
}

fn kinetic_energy(ui: &mut Ui, history: &History, answer: &Solution) {
    let help = "Energy of motion now, and whether its greatest in the last second is above that of the second before. \
                What supports, loads and the robot do explains a growth; energy that nothing gave is warned of";
    let now = format::energy(answer.energy.kinetic_j);
    let grows = kinetic_peaks_j(history).filter(|[before, last]| *last > GROWTH * before && *last > 0.0);
    let value = grows.map_or_else(|| now.clone(), |_| format!("{now}, growing"));
    judged(ui, "Kinetic energy", &value, help, grows.map(|_| "It grows"));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two elements have one free node: along it gives way with 2EA/h, sideways with 2T/h.
    #[test]
    fn the_condition_of_few_elements_is_known_by_hand() {
        assert!((condition_number(1e6, 100.0, 2) - 1e4).abs() < 1e-6);
        // Three: eigenvalues of [2 −1; −1 2] are 1 and 3.
        assert!((condition_number(1e6, 100.0, 3) - 3e4).abs() < 1e-6);
        // Many: 4 n² EA / (π² T).
        let many = condition_number(1e6, 100.0, 1000);
        let expected = 4.0 * 1e6 * 1e4 / std::f64::consts::PI.powi(2);
        assert!((many / expected - 1.0).abs() < 1e-5, "{many} {expected}");
    }

    #[test]
    fn growth_is_told_from_decay() {
        let history = |of: fn(f64) -> f64| {
            let mut history = History::default();
            for time_s in (0..300).map(|k| f64::from(k) / 60.0) {
                let energy_j = [of(time_s), 0.0, 0.0, 0.0];
                history.push(Sample { time_s, max_tension_n: 0.0, energy_j, robot: None, reactions_n: Vec::new() });
            }
            history
        };
        let [before, last] = kinetic_peaks_j(&history(|t| t.exp())).unwrap();
        assert!(last > 2.0 * before);
        let [before, last] = kinetic_peaks_j(&history(|t| (-t).exp())).unwrap();
        assert!(last < before);
        assert_eq!(kinetic_peaks_j(&History::default()), None);
    }
}
