//! The solver panel edits model, mesh and accuracy, and shows what the solver did.

use cable_core::model::hand;
use cable_core::problem::problems;
use cable_core::{Model, Settings, Solution};
use egui::{Grid, Ui};

use crate::command::{Command, PlaybackCommand};
use crate::panels::analysis::work_precision;
use crate::panels::quality;
use crate::state::{AppState, WorkerStatus};
use crate::units::format;
use crate::units::labels;
use crate::units::sentence::sentence;
use crate::units::unit::Unit;
use crate::widgets::checkbox_and_radio::checkbox;
use crate::widgets::property::{PropertyQuantity, Provenance, row};
use crate::worker;

const TOLERANCE: PropertyQuantity = PropertyQuantity {
    name: "Tolerance",
    unit: Unit::PERCENT,
    usual: [1e-6, 1e-1],
    logarithmic: true,
    help: "Relative accuracy asked of the tension. Models choose their mesh by it where nothing else says how many segments.",
};
const SEGMENTS: PropertyQuantity = PropertyQuantity {
    name: "Segments per cable",
    unit: Unit::COUNT,
    usual: [4.0, 1000.0],
    logarithmic: true,
    help: "Segments that every cable is divided into; overrides the cables' own numbers. More: finer and slower.",
};

const HAND: PropertyQuantity = PropertyQuantity {
    name: "Drag speed limit",
    unit: Unit::M_PER_S,
    usual: [0.1, 20.0],
    logarithmic: true,
    help: "How fast a dragged support can follow the pointer while time runs. The “hand” is the pointer's grip: it holds the support by a spring, which is drawn; a warning says when it lags. 2 m/s is about arm speed; faster, a flick of the mouse may break the cable.",
};

const HAND_STIFFNESS: PropertyQuantity = PropertyQuantity {
    name: "Stiffness of the hand",
    unit: Unit::N_PER_M,
    usual: [1.0, 1e6],
    logarithmic: true,
    help: "The spring by which the pointer holds a support while time runs. Stiffer: the support follows more exactly, and what is pulled beyond its length breaks sooner.",
};

/// Number of segments that is set when the user first fixes it before any answer.
const FIRST_SEGMENTS: usize = 100;

/// N/m, where the scene says nothing.
const FIRST_STIFFNESS: f64 = 1000.0;

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for model in [Model::Auto].into_iter().chain(Model::SOLVERS) {
            let info = model.info();
            if ui.selectable_label(state.solver.model == model, info.label).on_hover_text(info.help).clicked() {
                commands.push(Command::SetModel(model));
            }
        }
    });
    let answer = state.live.snapshot.solution.as_deref();
    if let Some(answer) = answer {
        let why =
            if state.solver.model.is_automatic() { format!(": {}", sentence(&answer.reason)) } else { String::new() };
        ui.label(format!("Solved with {}{why}", labels::model(answer.model)));
        if let Some(next) = &answer.next_cheaper {
            ui.weak(format!("Next cheaper model: {}", sentence(next)));
        } else if state.live.snapshot.seeks_histories {
            // The row keeps its place until it is known.
            ui.weak("Next cheaper model: …");
        }
    }
    if worker::engine::is_quasi_static(state.solver.model) {
        ui.weak("Time runs without inertia: supports and loads move, friction remembers, nothing swings");
    }
    mesh(ui, state, commands);
    let Some(answer) = answer else {
        ui.weak("Nothing solved yet");
        return;
    };
    ui.separator();
    work_precision::ui(ui, state, commands);
    ui.separator();
    quality::ui(ui, state, answer, commands);
    cost(ui, state, answer);
}

/// Tolerance, speed and stiffness of the hand, and the number of segments.
fn mesh(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let Settings { tolerance, segments, .. } = state.solver.settings;
    let usual = Settings::default();
    let origin = Some((usual.tolerance, "the default".to_owned()));
    let known = Provenance { value: tolerance, origin, ..Provenance::default() };
    if let Some(tolerance) = row(ui, &TOLERANCE, &known).value {
        // A solver told to be exact, or not to be, would run for ever or not at all.
        let tolerance = tolerance.clamp(1e-9, 0.5);
        commands.push(Command::SetSettings(Settings { tolerance, ..state.solver.settings }));
    }
    let known = Provenance {
        value: state.solver.settings.hand_speed_m_per_s,
        origin: Some((usual.hand_speed_m_per_s, "the default".to_owned())),
        ..Provenance::default()
    };
    if let Some(speed) = row(ui, &HAND, &known).value {
        let hand_speed_m_per_s = speed.clamp(0.01, 20.0);
        commands.push(Command::SetSettings(Settings { hand_speed_m_per_s, ..state.solver.settings }));
    }
    default_hand_stiffness(ui, state, commands);
    pull_past_length(ui, state, commands);
    let mut fixed = segments.is_some();
    let help = "Off: each cable's own number or, without one, as many as the tolerance needs";
    if checkbox(ui, &mut fixed, "Same number of segments for every cable").on_hover_text(help).changed() {
        let count = largest_mesh(state.live.snapshot.solution.as_deref()).unwrap_or(FIRST_SEGMENTS);
        commands.push(Command::SetSettings(Settings { segments: fixed.then_some(count), ..state.solver.settings }));
    }
    let Some(count) = segments else { return };
    let known = Provenance { value: count as f64, ..Provenance::default() };
    if let Some(value) = row(ui, &SEGMENTS, &known).value {
        // The range of the scene file's `segments`.
        let segments = Some(value.round().clamp(1.0, 1e5) as usize);
        commands.push(Command::SetSettings(Settings { segments, ..state.solver.settings }));
    }
}

/// The choice of one hand stiffness for all cables.
fn default_hand_stiffness(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let stiffness = state.solver.settings.hand_stiffness_n_per_m;
    let set =
        |hand_stiffness_n_per_m| Command::SetSettings(Settings { hand_stiffness_n_per_m, ..state.solver.settings });
    let mut stated = stiffness.is_some();
    let help = "Off: for each cable, so stiff that its whole load stretches the spring by 1 % of the cable's length";
    if checkbox(ui, &mut stated, "Same drag stiffness for all cables").on_hover_text(help).changed() {
        // The choice of the present cable, which is as wide as any.
        let of_cable =
            problems(&state.document.scene).ok().and_then(|all| all.first().map(|p| hand::default_hand_stiffness(p)));
        commands.push(set(stated.then(|| of_cable.unwrap_or(FIRST_STIFFNESS))));
    }
    let Some(value) = stiffness else { return };
    if let Some(value) = row(ui, &HAND_STIFFNESS, &Provenance { value, ..Provenance::default() }).value {
        commands.push(set(Some(value.clamp(*hand::HAND_STIFFNESSES.start(), *hand::HAND_STIFFNESSES.end()))));
    }
}

/// The choice whether a hand may pull a cable beyond its length.
fn pull_past_length(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let mut pulls = state.solver.pulls_past_length;
    let help = "On: a support that is dragged farther than the cable reaches, while time runs, is pulled by the hand's \
                spring; the force rises with the distance until the cable breaks. Off: it is refused";
    if checkbox(ui, &mut pulls, "Allow pulling beyond the cable's length").on_hover_text(help).changed() {
        commands.push(Command::Playback(PlaybackCommand::PullPastLength(pulls)));
    }
}

fn largest_mesh(answer: Option<&Solution>) -> Option<usize> {
    let nodes = answer?.cables.iter().map(|c| c.nodes.len()).max()?;
    nodes.checked_sub(1).filter(|&n| n > 0)
}

/// What the last solve or step took.
fn cost(ui: &mut Ui, state: &AppState, answer: &Solution) {
    let cost = answer.cost;
    let status = match &state.solver.status {
        WorkerStatus::Idle => "ready",
        WorkerStatus::Busy => "working…",
        WorkerStatus::Dead(_) => "stopped, see warnings",
    };
    let step = if cost.inner_step_s > 0.0 { format::duration(cost.inner_step_s) } else { "none, at rest".to_owned() };
    let segments = largest_mesh(Some(answer)).map_or_else(|| "–".to_owned(), |n| n.to_string());
    let rows = [
        ("Solve time", format::duration(state.live.snapshot.solve_wall_s), "How long the last solve or step took"),
        (
            "Iterations",
            cost.iterations.to_string(),
            "Newton iterations, or explicit sub-steps, of the last solve or step",
        ),
        ("Inner time step", step, "The step the model takes inside a frame"),
        ("Steps halved", cost.halved_steps.to_string(), "Steps that failed and were taken in halves"),
        ("Segments", segments, "Segments of the finest cable as solved"),
        ("Solver", status.to_owned(), "The thread that solves while the window stays usable"),
    ];
    let diagnostics = egui::CollapsingHeader::new("Diagnostics").id_salt("cost");
    diagnostics.show_unindented(ui, |ui| {
        Grid::new("cost").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| {
            for (name, value, help) in rows {
                ui.weak(name).on_hover_text(help);
                ui.label(value).on_hover_text(help);
                ui.end_row();
            }
        });
    });
}
