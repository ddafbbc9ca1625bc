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
use crate::panels::quality::kinetic_peaks::{GROWTH_SPAN_S, kinetic_peaks_j};
use crate::panels::readouts;
use crate::record::sample::Sample;
use crate::state::AppState;
use crate::units::format;
use crate::widgets::readout;

/// A peak of the kinetic energy above that of the span before by less is said to be steady.
const MIN_GROWTH_RATIO: f64 = 1.1;
/// Spans in a row over which the kinetic energy has to grow before it is warned of, and one. Fewer:
/// a swing that begins is; more: a motion that diverges has ended.
const GROWTH_SPANS: usize = 5;
/// Energy gained in all of less than this share of what the motion gained came from height or
/// stretch.
const MIN_GAINED_SHARE: f64 = 0.5;
/// A kinetic energy below this share of the energy of stretch is that of a cable at rest.
const MIN_KINETIC_SHARE: f64 = 1e-3;

/// A reason not to rely on the figures.
#[derive(Clone, Debug, PartialEq)]
pub struct QualityProblem {
    /// The thing that is wrong.
    pub title: &'static str,
    /// Its figure.
    pub figure: String,
    /// The reason in a sentence.
    pub why: &'static str,
}

/// All that there is to say against an answer, as the form of the solver marks it.
#[must_use]
pub fn problems(state: &AppState, answer: &Solution) -> Vec<QualityProblem> {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let tolerance = state.solver.settings.tolerance;
    let (share, unbalanced) = unbalanced(tolerance, answer);
    let (condition, ill) = worst_condition(tolerance, scene, answer).map_or((0.0, None), |(c, ill)| (c, ill));
    let energy = format::energy(answer.energy.kinetic_j);
    let found = [
        (
            "Residual above tolerance",
            format!("{} > {}", format::percent(share), format::percent(tolerance)),
            unbalanced,
        ),
        ("Ill-conditioned equations", format::magnitude(condition, 1), ill),
        ("Kinetic energy grows", energy, grows_for_long(state, answer)),
    ];
    found.into_iter().filter_map(|(title, figure, why)| Some(QualityProblem { title, figure, why: why? })).collect()
}

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, answer: &Solution, commands: &mut Vec<Command>) {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    readouts::dimmed_if_old(ui, state, |ui| {
        residual(ui, state.solver.settings.tolerance, answer);
        displacement(ui, answer, commands);
        conditioning(ui, state.solver.settings.tolerance, scene, answer);
        kinetic_energy(ui, state, answer);
    });
}

/// The share of the greatest tension that is left unbalanced, and what is wrong with it.
fn unbalanced(tolerance: f64, answer: &Solution) -> (f64, Option<&'static str>) {
    let greatest_n = answer.max_tension().tension_n;
    let share = if greatest_n > 0.0 { answer.cost.residual_n / greatest_n } else { 0.0 };
    (share, (share > tolerance).then_some("It is above the tolerance asked for: the tensions are not settled"))
}

fn residual(ui: &mut Ui, tolerance: f64, answer: &Solution) {
    let (share, wrong) = unbalanced(tolerance, answer);
    let value = format!("{} ({})", format::force(answer.cost.residual_n), format::percent(share));
    let help = "Largest force left unbalanced at a node, and its share of the greatest tension: the smaller, the closer to balance";
    readout::assessed_row(ui, "Residual", &value, help, wrong);
}

/// The greatest displacement since the run began.
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

/// The greatest condition number of all cables as estimated, and what is wrong with it; None
/// without a mesh or a tension.
fn worst_condition(tolerance: f64, scene: &Scene, answer: &Solution) -> Option<(f64, Option<&'static str>)> {
    let all = scene.cables.iter().zip(&answer.cables).filter_map(|(cable, solved)| estimated(cable, solved));
    let worst = all.reduce(f64::max).filter(|_| answer.model.capabilities().mesh)?;
    let wrong = (worst * f64::EPSILON > tolerance)
        .then_some("Rounding alone may spoil the tolerance asked for: use fewer segments, or a softer cable");
    Some((worst, wrong))
}

/// The estimated condition number of the equations.
fn conditioning(ui: &mut Ui, tolerance: f64, scene: &Scene, answer: &Solution) {
    let name = "Condition estimate";
    if !answer.model.capabilities().mesh {
        return readout::row(ui, name, "no mesh", "A model without a mesh solves no large system of equations", |_| {});
    }
    let Some((worst, wrong)) = worst_condition(tolerance, scene, answer) else {
        return readout::row(ui, name, "not known", "No cable is under tension", |_| {});
    };
    let help = "Condition number, estimated as that of a straight cable of as many segments under the mean tension, without bending and \
                contact; its exponent is roughly the number of the 16 digits lost to rounding";
    readout::assessed_row(ui, name, &format!("≈ {}", format::magnitude(worst, 2)), help, wrong);
}

/// The kinetic energy, and whether its peaks grow.
fn kinetic_energy(ui: &mut Ui, state: &AppState, answer: &Solution) {
    let help = "Kinetic energy now, marked “growing” if its peak in the last second is above that of the second before. \
                Supports, loads or the robot may explain this; if nothing does and it lasts, a warning appears";
    let now = format::energy(answer.energy.kinetic_j);
    let growing = kinetic_peaks_j(&state.live.history).is_some_and(|peaks: [f64; 2]| grows(&peaks));
    let value = if growing { format!("{now}, growing") } else { now };
    readout::assessed_row(ui, "Kinetic energy", &value, help, grows_for_long(state, answer));
}

fn grows(peaks_j: &[f64]) -> bool {
    peaks_j.windows(2).all(|w| matches!(w, [before, last] if *last > MIN_GROWTH_RATIO * before && *last > 0.0))
}

/// Returns what is wrong with a motion that gains energy second by second while nothing gives any.
fn grows_for_long(state: &AppState, answer: &Solution) -> Option<&'static str> {
    let history = &state.live.history;
    let peaks = kinetic_peaks_j::<GROWTH_SPANS>(history)?;
    let [before, .., last] = peaks;
    let moves = last > MIN_KINETIC_SHARE * answer.energy.stretch_j.abs();
    // A cable that falls turns height into motion.
    let total_j = |s: &Sample| s.energy_j.iter().sum::<f64>();
    let from_s = answer.time_s.max(history.samples.back()?.time_s) - GROWTH_SPANS as f64 * GROWTH_SPAN_S;
    let gained_j = total_j(history.samples.back()?) - total_j(history.view([from_s, from_s], None).first()?);
    let given = is_driven(state, answer) || gained_j < MIN_GAINED_SHARE * (last - before);
    (moves && !given && grows(&peaks))
        .then_some("It grows every second and nothing in the scene supplies it: do not trust the motion")
}

/// Returns whether a hand, a schedule, the robot or a load may do work.
fn is_driven(state: &AppState, answer: &Solution) -> bool {
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    let supports = scene.cables.iter().flat_map(|c| &c.supports);
    let robot = answer.robot.is_some_and(|r| r.speed_m_per_s != 0.0);
    let wind = scene.environment.wind_n_per_m != [0.0; 2];
    state.selection.grab.is_some()
        || robot
        || wind
        || !scene.loads.is_empty()
        || supports.into_iter().any(|s| s.motion.is_some())
}
