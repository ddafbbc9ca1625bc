//! This file makes the JSON object of an answer, with SI units in the key names and finite numbers
//! only.

use cable_core::analysis::{Compared, EndStiffness, NeglectedBending, Setting};
use cable_core::answer_verifier::Verification;
use cable_core::solution::{
    Bend, CableSolution, ContactReport, ContactSample, ContactState, EnergyAccount, InertiaEffect, ModelReason,
    NextCheaper, Node, Pressure, RobotReport, Solution, SupportReaction, TensionPeaks, Warning,
};
use cable_core::summary::CableSummary;
use cable_core::timeline::RunPeaks;
use cable_core::{ErrorEstimates, Model, SolveError, UnitSystem};
use serde::Serialize;

use crate::finite_check::check_finite;

/// The output of `solve --json`, and of `run --json` for each time.
#[derive(Debug, Serialize)]
pub struct AnswerJson<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    pub model: &'static str,
    pub reason: &'a ModelReason,
    /// At rest, the error that the next cheaper choice of `auto` would have; in motion with errors,
    /// the error of a run without inertia so far.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next_cheaper: Option<NextCheaper>,
    pub converged: bool,
    pub residual_n: f64,
    pub iterations: usize,
    pub wall_time_s: f64,
    /// Estimated relative error of the greatest tension; null if the model gives none.
    pub error_estimate: Option<f64>,
    /// Estimated errors of the figures of each cable; null if they are not known.
    pub errors: Vec<OfCable<'a, ErrorEstimates>>,
    pub max_tension_n: f64,
    pub max_tension_arc_length_m: f64,
    /// The greatest tensions of each moving cable in all inner steps since the previous line.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub peaks: Vec<OfCable<'a, TensionPeaks>>,
    /// The greatest tensions of each moving cable in the run so far, and their errors.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub run_peaks: Vec<OfCable<'a, RunPeaksEntry>>,
    /// Mach and Froude numbers of the run so far, and whether masses matter in it; only with
    /// inertia.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<InertiaEntry>,
    /// The energy of each cable since it began to move, and the work of each kind of force.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub energy_account: Vec<OfCable<'a, EnergyAccount>>,
    /// The sharpest bend of all cables; null if all are nearly straight.
    pub tightest_bend: Option<OfCable<'a, Bend>>,
    /// The place of the greatest sidewall pressure of all cables; null if no cable is guided round
    /// anything.
    pub sidewall_pressure: Option<OfCable<'a, Pressure>>,
    /// The summary of each cable.
    pub summary: Vec<Summary<'a>>,
    pub supports: Vec<SupportJson<'a>>,
    pub nodes: Vec<NodeEntry<'a>>,
    pub contacts: Vec<ContactJson<'a>>,
    pub warnings: Vec<WarningEntry<'a>>,
    /// The robot, where the scene has one that can move, with the work of each force on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<&'a RobotReport>,
    /// The verification of the answer.
    pub verification: Option<&'a Verification>,
    /// The answers of other models and meshes, with `--compare`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub compared: &'a Vec<ComparedEntry>,
}

/// The answer of another model or mesh.
#[derive(Clone, Debug, Serialize)]
pub struct ComparedEntry {
    #[serde(flatten)]
    pub setting: Setting,
    pub wall_time_s: f64,
    /// `None` if it has no answer.
    #[serde(flatten)]
    pub answer: Option<Compared>,
    /// The reason why it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// The greatest tensions of a run so far, with the range in which the exact value lies.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RunPeaksEntry {
    pub greatest_tension_n: f64,
    /// The greatest mean over `breaking_time_s`.
    pub held_tension_n: f64,
    /// Lower and upper end of the range, N; null if it is not known.
    pub greatest_tension_range_n: Option<[f64; 2]>,
    pub held_tension_range_n: Option<[f64; 2]>,
    /// True if coarser runs differ from this one so much that another mesh, step or start has
    /// another greatest tension; null if that is not known.
    pub depends_on_small_differences: Option<bool>,
    /// True if the ranges are no wider than the tolerance; null if they are not known.
    pub resolved: Option<bool>,
}

impl RunPeaksEntry {
    pub fn of(run: &RunPeaks, tolerance: f64) -> Self {
        Self {
            greatest_tension_n: run.peaks.greatest.tension_n,
            held_tension_n: run.peaks.held.tension_n,
            greatest_tension_range_n: run.ranges.map(|r| r.greatest_n),
            held_tension_range_n: run.ranges.map(|r| r.held_n),
            depends_on_small_differences: run.ranges.map(|r| r.depend_on_small_differences()),
            resolved: run.ranges.map(|r| r.are_resolved(tolerance)),
        }
    }
}

/// Speeds of a run so far, relative to those at which inertia matters.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct InertiaEntry {
    pub greatest_speed_m_per_s: f64,
    /// Greatest speed over the speed of longitudinal waves.
    pub mach_number: f64,
    /// Greatest speed over the square root of gravity times length; null without gravity.
    pub froude_number: Option<f64>,
    /// True if a run without inertia differs by more than the tolerance or has no answer; null if
    /// none accompanies this run, if it was given up as not cheaper, or if the difference is not
    /// clear.
    pub matters: Option<bool>,
}

impl InertiaEntry {
    fn of(effect: &InertiaEffect) -> Self {
        Self {
            greatest_speed_m_per_s: effect.numbers.greatest_speed_m_per_s,
            mach_number: effect.numbers.mach,
            froude_number: effect.numbers.froude,
            matters: effect.matters(),
        }
    }
}

/// A warning as data, the unit of its value and limit, and the sentence.
#[derive(Debug, Serialize)]
pub struct WarningEntry<'a> {
    #[serde(flatten)]
    pub warning: &'a Warning,
    /// Empty for a plain number.
    pub unit: &'static str,
    pub message: String,
}

impl<'a> WarningEntry<'a> {
    fn of(warning: &'a Warning) -> Self {
        let unit = warning.cause.quantity().symbol(UnitSystem::Si);
        Self { warning, unit, message: warning.to_string() }
    }
}

/// The figures of a cable, and the stiffness of its ends if it was requested.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    #[serde(flatten)]
    pub figures: &'a CableSummary,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end_stiffness: Option<Vec<&'a EndStiffness>>,
    /// The changes that its neglected bending stiffness would make.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub neglected_bending: Option<&'a NeglectedBending>,
}

/// The summary figures of a solution.
#[derive(Debug, Default)]
pub struct SummaryJson {
    /// One summary for each cable.
    pub cables: Vec<CableSummary>,
    /// The stiffness of all held ends, if it was requested.
    pub stiffness: Option<Vec<EndStiffness>>,
    /// The changes that neglected bending stiffness would make, for the cables for which they are
    /// known.
    pub bending: Vec<NeglectedBending>,
    /// The greatest tensions of each cable in a run so far.
    pub run_peaks: Vec<RunPeaksEntry>,
    /// Mach and Froude numbers of the motion, and its difference from one without inertia.
    pub inertia: Option<InertiaEffect>,
    /// The answers of other models and meshes, if they were requested.
    pub compared: Vec<ComparedEntry>,
}

/// A value of one cable with the name of the cable, even if it is the only one.
#[derive(Debug, Serialize)]
pub struct OfCable<'a, T> {
    pub cable: &'a str,
    #[serde(flatten)]
    pub of: T,
}

#[derive(Debug, Serialize)]
pub struct SupportJson<'a> {
    cable: &'a str,
    #[serde(flatten)]
    support: &'a SupportReaction,
}

#[derive(Debug, Serialize)]
pub struct NodeEntry<'a> {
    cable: &'a str,
    arc_length_m: f64,
    x_m: f64,
    y_m: f64,
    tension_n: f64,
    strain: f64,
    stress_pa: f64,
    curvature_per_m: f64,
    force_n: [f64; 2],
}

#[derive(Debug, Serialize)]
pub struct ContactJson<'a> {
    cable: &'a str,
    obstacle: &'a str,
    x_m: f64,
    y_m: f64,
    arc_length_m: f64,
    normal_n: f64,
    friction_n: f64,
    state: ContactState,
    turn_deg: f64,
    tension_before_n: f64,
    tension_after_n: f64,
    begins_m: f64,
    ends_m: f64,
    force_n: [f64; 2],
    samples: &'a [ContactSample],
}

/// The output of `--json` if there is no answer.
#[derive(Debug, Serialize)]
pub struct NoAnswerJson {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    pub model: &'static str,
    pub reason: String,
    pub converged: bool,
    pub error: String,
}

impl NoAnswerJson {
    /// Reports why a model has no answer, and at which time (s).
    pub fn new(model: Model, reason: Option<&ModelReason>, time_s: Option<f64>, error: &SolveError) -> Self {
        let reason = reason.map_or_else(|| "no answer".to_owned(), ToString::to_string);
        Self { time_s, model: model.name(), reason, converged: false, error: error.to_string() }
    }
}

/// The answer of a solution, or the name of the number in it that is not finite.
pub fn answer<'a>(
    s: &'a Solution,
    figures: &'a SummaryJson,
    wall_time_s: f64,
    time_s: Option<f64>,
) -> Result<AnswerJson<'a>, String> {
    check_finite(s)?;
    let top = s.max_tension();
    let name = |c: &'a CableSolution| c.name.as_str();
    let bends = s.cables.iter().filter_map(|c| c.tightest_bend.map(|of| OfCable { cable: name(c), of }));
    let pressures = s.cables.iter().filter_map(|c| c.sidewall_pressure.map(|of| OfCable { cable: name(c), of }));
    let mut out = AnswerJson {
        time_s,
        model: s.model.name(),
        reason: &s.reason,
        next_cheaper: s.next_cheaper,
        converged: true,
        residual_n: s.cost.residual_n,
        iterations: s.cost.iterations,
        wall_time_s,
        error_estimate: s.cables.iter().filter_map(|c| c.error_estimate).reduce(f64::max),
        errors: s.cables.iter().map(|c| OfCable { cable: name(c), of: c.errors }).collect(),
        max_tension_n: top.tension_n,
        max_tension_arc_length_m: top.arc_length_m,
        peaks: s.cables.iter().filter_map(|c| c.peaks.map(|of| OfCable { cable: name(c), of })).collect(),
        energy_account: s
            .cables
            .iter()
            .filter_map(|c| Some(OfCable { cable: name(c), of: c.energy_account? }))
            .collect(),
        run_peaks: s.cables.iter().zip(&figures.run_peaks).map(|(c, &of)| OfCable { cable: name(c), of }).collect(),
        inertia: figures.inertia.as_ref().map(InertiaEntry::of),
        tightest_bend: bends.reduce(|a, b| if b.of.radius_m < a.of.radius_m { b } else { a }),
        sidewall_pressure: pressures.reduce(|a, b| if b.of.pressure_n_per_m > a.of.pressure_n_per_m { b } else { a }),
        summary: figures.cables.iter().map(|of| summary(of, figures)).collect(),
        supports: Vec::new(),
        nodes: Vec::with_capacity(s.cables.iter().map(|c| c.nodes.len()).sum()),
        contacts: Vec::new(),
        warnings: s.warnings.iter().map(WarningEntry::of).collect(),
        robot: s.robot.as_ref(),
        verification: s.verification.as_ref(),
        compared: &figures.compared,
    };
    for c in &s.cables {
        let cable = name(c);
        out.supports.extend(c.supports.iter().map(|support| SupportJson { cable, support }));
        out.nodes.extend(c.nodes.iter().map(|n| node(cable, n)));
        out.contacts.extend(c.contacts.iter().map(|k| contact(cable, k)));
    }
    Ok(out)
}

fn summary<'a>(of: &'a CableSummary, figures: &'a SummaryJson) -> Summary<'a> {
    let own = |all: &'a Vec<EndStiffness>| all.iter().filter(|e| e.cable == of.cable).collect();
    let neglected_bending = figures.bending.iter().find(|b| b.cable == of.cable);
    Summary { figures: of, end_stiffness: figures.stiffness.as_ref().map(own), neglected_bending }
}

fn node<'a>(cable: &'a str, n: &Node) -> NodeEntry<'a> {
    NodeEntry {
        cable,
        arc_length_m: n.arc_length_m,
        x_m: n.x_m,
        y_m: n.y_m,
        tension_n: n.tension_n,
        strain: n.strain,
        stress_pa: n.stress_pa,
        curvature_per_m: n.curvature_per_m,
        force_n: n.force_n,
    }
}

fn contact<'a>(cable: &'a str, k: &'a ContactReport) -> ContactJson<'a> {
    ContactJson {
        cable,
        obstacle: &k.obstacle,
        x_m: k.x_m,
        y_m: k.y_m,
        arc_length_m: k.arc_length_m,
        normal_n: k.normal_n,
        friction_n: k.friction_n,
        state: k.state,
        turn_deg: k.turn_deg,
        tension_before_n: k.tension_before_n,
        tension_after_n: k.tension_after_n,
        begins_m: k.begins_m,
        ends_m: k.ends_m,
        force_n: k.force_n,
        samples: &k.samples,
    }
}
