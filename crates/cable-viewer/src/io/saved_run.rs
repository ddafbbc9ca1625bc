//! The folder of a run is read again, whole or partial.

use std::path::Path;

use cable_core::record::{Event, HistoryTable, Manifest, NodeRow, RunTables};
use cable_core::scene::SupportKind;
use cable_core::solution::{
    CableSolution, Cost, Energy, ModelReason, RobotReport, RobotWork, SupportReaction, TensionPeak, TensionPeaks,
    Warning,
};
use cable_core::{Model, Scene, Solution, files};

use crate::units::sentence::sentence;

/// Largest table read, bytes: half an hour of 200 nodes at 60 answers a second is 3 GB; such a run
/// is for other programs.
const MAX_BYTES: u64 = 512 << 20;

/// A run as it lies in a folder.
#[derive(Clone, Debug)]
pub struct OpenedRun {
    /// Its scene.
    pub scene: Scene,
    /// Its instants, oldest first.
    pub answers: Vec<Solution>,
    /// Wall time that they took, s; None where the run does not say.
    pub wall_time_s: Option<f64>,
    /// Remarks on the run in sentences, as that it is partial or that figures are missing.
    pub remarks: Vec<String>,
}

/// Reads the folder of a run, whole or partial.
///
/// # Errors
/// In words: what is missing or broken, and where.
pub fn read_run(folder: &Path) -> Result<OpenedRun, String> {
    let run = files::load_run(folder, MAX_BYTES).map_err(|e| e.to_string())?;
    let mut remarks: Vec<String> = run.remarks().iter().map(|r| format!("{}.", sentence(r))).collect();
    let RunTables { history, mut nodes, events, .. } = run.tables;
    if history.time_s.is_empty() {
        return Err(format!("it holds no instant. {}", remarks.join(" ")).trim_end().to_owned());
    }
    if let Some(missing) = fill_missing(&mut nodes)? {
        remarks.push(missing);
    }
    let manifest = run.manifest.as_ref();
    let model = manifest.and_then(Manifest::model).unwrap_or(Model::Auto);
    let wall_time_s = manifest.and_then(|m| m.wall_time_s);
    let mut answers = answers(&run.scene, model, &history, nodes, &events);
    let count = answers.len();
    // A run may have written its nodes less often than its history: only where there are nodes is
    // there a picture.
    answers.retain(|a| a.cables.iter().any(|c| !c.nodes.is_empty()));
    if answers.is_empty() {
        return Err("its nodes.csv has no nodes, which the picture is drawn from".to_owned());
    }
    if answers.len() < count {
        remarks.push(format!("Nodes were written at {} of its {count} instants, and those are shown.", answers.len()));
    }
    Ok(OpenedRun { scene: run.scene, answers, wall_time_s, remarks })
}

/// Figures of nodes that the run left out become 0; a sentence about which. Places cannot be left
/// out.
fn fill_missing(nodes: &mut [NodeRow]) -> Result<Option<String>, String> {
    let Some(first) = nodes.first().map(|row| row.node) else { return Ok(None) };
    if [first.arc_length_m, first.x_m, first.y_m].iter().any(|v| v.is_nan()) {
        return Err("its nodes.csv lacks arc_length_m, x_m or y_m, which the picture is drawn from".to_owned());
    }
    let mut missing = Vec::new();
    for row in nodes {
        let n = &mut row.node;
        let ([dx, dy], [ax, ay]) = (&mut n.displacement_m, &mut n.acceleration_m_per_s2);
        let figures = [
            ("velocity", &mut n.vx_m_per_s),
            ("velocity", &mut n.vy_m_per_s),
            ("tension", &mut n.tension_n),
            ("strain", &mut n.strain),
            ("stress", &mut n.stress_pa),
            ("curvature", &mut n.curvature_per_m),
            ("displacement", dx),
            ("displacement", dy),
            ("acceleration", ax),
            ("acceleration", ay),
        ];
        for (name, value) in figures {
            if value.is_nan() {
                *value = 0.0;
                if !missing.contains(&name) {
                    missing.push(name);
                }
            }
        }
    }
    Ok((!missing.is_empty()).then(|| format!("It was written without {}, which is shown as 0.", missing.join(", "))))
}

/// The tables put together: an answer for each time of the history, by a model (`Auto`: by several,
/// or none is known).
fn answers(
    scene: &Scene,
    model: Model,
    history: &HistoryTable,
    nodes: Vec<NodeRow>,
    events: &[Event],
) -> Vec<Solution> {
    let mut nodes = nodes.into_iter().peekable();
    let mut out = Vec::with_capacity(history.time_s.len());
    for (k, &time_s) in history.time_s.iter().enumerate() {
        let mut cables: Vec<CableSolution> =
            scene.cables.iter().map(|c| CableSolution { name: c.name.clone(), ..CableSolution::default() }).collect();
        while let Some(row) = nodes.next_if(|row| row.time_s <= time_s) {
            let Some(cable) = cables.iter_mut().find(|c| c.name == row.cable) else { continue };
            // At a break two nodes are the same point of the cable.
            if cable.nodes.last().is_some_and(|n| n.arc_length_m == row.node.arc_length_m) {
                cable.breaks.push(cable.nodes.len());
            }
            cable.nodes.push(row.node);
        }
        reactions(scene, history, k, &mut cables);
        peaks(history, k, &mut cables);
        out.push(Solution {
            time_s,
            model,
            reason: ModelReason::Recorded,
            next_cheaper: None,
            robot: robot(scene, history, k, &cables),
            verification: None,
            cables,
            warnings: warnings(history, events, k),
            cost: Cost::default(),
            energy: energy(history, k),
        });
    }
    out
}

fn extra(history: &HistoryTable, name: &str, k: usize) -> Option<f64> {
    history.extras.iter().find(|e| e.name == name)?.values.get(k).copied()
}

/// Tables hold the peaks over all cables: the first cable is given them, and keeps the others out
/// of it.
fn peaks(history: &HistoryTable, k: usize, cables: &mut [CableSolution]) {
    let time_s = history.time_s.get(k).copied().unwrap_or(0.0);
    let of = |name| Some(TensionPeak { tension_n: extra(history, name, k)?, time_s, ..TensionPeak::default() });
    if let (Some(first), Some(greatest), Some(held)) = (cables.first_mut(), of("peak_tension_n"), of("held_tension_n"))
    {
        first.peaks = Some(TensionPeaks { greatest, held, over_s: 0.0 });
    }
}

/// The energy in row `k` of the history.
fn energy(history: &HistoryTable, k: usize) -> Energy {
    let of = |name| extra(history, name, k).unwrap_or(0.0);
    Energy {
        kinetic_j: of("kinetic_energy_j"),
        gravity_j: of("gravity_energy_j"),
        stretch_j: of("stretch_energy_j"),
        bending_j: of("bending_energy_j"),
    }
}

/// Supports where the nodes of their cable end or lie nearest to where the scene has them; tables
/// do not hold places.
fn reactions(scene: &Scene, history: &HistoryTable, k: usize, cables: &mut [CableSolution]) {
    let mut columns = history.supports.iter();
    for (of, cable) in scene.cables.iter().zip(cables) {
        let last = of.supports.len().saturating_sub(1);
        for (i, s) in of.supports.iter().enumerate() {
            let column = columns.next();
            let force = |values: Option<&Vec<f64>>| values.and_then(|v| v.get(k)).copied().unwrap_or(0.0);
            let near = match (i, s.at_m) {
                (0, _) => cable.nodes.first(),
                (i, _) if i == last => cable.nodes.last(),
                (_, Some([x, y])) => {
                    let far = |n: &&cable_core::solution::Node| (n.x_m - x).hypot(n.y_m - y);
                    cable.nodes.iter().min_by(|a, b| far(a).total_cmp(&far(b)))
                }
                (_, None) => cable.nodes.iter().find(|n| s.arc_length_m.is_some_and(|at| n.arc_length_m >= at)),
            };
            let node = near.copied().unwrap_or_default();
            let place = s.at_m.filter(|_| s.motion.is_none() && i != 0 && i != last).unwrap_or([node.x_m, node.y_m]);
            cable.supports.push(SupportReaction {
                name: s.name.clone(),
                x_m: place[0],
                y_m: place[1],
                reaction_x_n: force(column.map(|c| &c.reaction_x_n)),
                reaction_y_n: force(column.map(|c| &c.reaction_y_n)),
                arc_length_m: node.arc_length_m,
                ..SupportReaction::default()
            });
        }
    }
}

/// The report of the robot in row `k` of the history; None if the run has no robot.
fn robot(scene: &Scene, history: &HistoryTable, k: usize, cables: &[CableSolution]) -> Option<RobotReport> {
    let of = |name| extra(history, name, k);
    let hitched = scene.cables.iter().zip(cables).flat_map(|(c, answer)| c.supports.iter().zip(&answer.supports));
    let pulls = hitched.filter(|(s, _)| s.kind == SupportKind::Robot);
    let pull = pulls.fold([0.0; 2], |sum, (_, r)| [sum[0] + r.reaction_x_n, sum[1] + r.reaction_y_n]);
    Some(RobotReport {
        x_m: of("robot_x_m")?,
        y_m: of("robot_y_m")?,
        pitch_deg: of("robot_pitch_deg")?,
        speed_m_per_s: of("robot_speed_m_per_s")?,
        thrust_n: of("robot_thrust_n")?,
        hitch_x_n: pull[0],
        hitch_y_n: pull[1],
        work: robot_work(history, k),
        ..RobotReport::default()
    })
}

/// The work of the forces on it; none where older tables hold none.
fn robot_work(history: &HistoryTable, k: usize) -> RobotWork {
    let of = |name| extra(history, name, k).unwrap_or(0.0);
    RobotWork {
        drive_j: of("robot_drive_work_j"),
        slip_j: of("robot_slip_work_j"),
        rolling_j: of("robot_rolling_work_j"),
        weight_j: of("robot_weight_work_j"),
        cable_j: of("robot_cable_work_j"),
        ground_j: of("robot_ground_work_j"),
        impact_j: of("robot_impact_work_j"),
    }
}

/// Events that began between the time before and this one. How long they lasted is in no table.
fn warnings(history: &HistoryTable, events: &[Event], k: usize) -> Vec<Warning> {
    let to = history.time_s.get(k).copied().unwrap_or(0.0);
    let from = k.checked_sub(1).and_then(|j| history.time_s.get(j)).copied().unwrap_or(f64::NEG_INFINITY);
    let began = events.iter().filter(|e| e.time_s > from && e.time_s <= to);
    began
        .map(|e| Warning {
            since_s: Some(e.time_s),
            ..Warning::new(e.cause.clone(), &e.cable, e.arc_length_m, [e.value, e.limit])
        })
        .collect()
}
