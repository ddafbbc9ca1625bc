//! This file holds the commands `cable solve`, `cable check` and `cable schema`.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use cable_core::model::Settings;
use cable_core::solution::ModelReason;
use cable_core::summary::{Setting, answer_with, end_stiffness, neglected_bending, settle_with_bending, summaries};
use cable_core::{Model, Scene, Solution, SolveError, files};

use crate::Done;
use crate::answer::{ComparedEntry, Figures, NoAnswer, answer};
use crate::args::{Common, SolveArguments};
use crate::output::{Failure, Printer};
use crate::table::table;

/// Reads and validates a scene.
pub fn read_scene(path: &Path) -> Result<Scene, Failure> {
    files::load_scene(path).map_err(Failure::File)
}

/// The scene, with what arguments say of it.
pub fn asked_scene(a: &Common) -> Result<Scene, Failure> {
    let mut scene = read_scene(&a.scene)?;
    if let Some(mobilised) = a.mobilised {
        scene.cables.iter_mut().for_each(|cable| cable.friction_mobilised = mobilised);
    }
    Ok(scene)
}

/// The settings that arguments ask for.
pub fn settings(a: &Common) -> Settings {
    Settings { tolerance: a.tolerance, ..Settings::default() }
}

/// Says, in JSON, that there is no answer; hands back the failure.
pub fn no_answer(
    to: &mut Printer,
    model: Model,
    reason: Option<&ModelReason>,
    time_s: Option<f64>,
    error: &SolveError,
) -> Done {
    let reason = reason.map_or_else(|| "no answer".to_owned(), ToString::to_string);
    let error = error.to_string();
    to.json(&NoAnswer { time_s, model: model.name(), reason, converged: false, error })?;
    to.flush()
}

/// Finds where everything rests.
pub fn solve(arguments: &SolveArguments) -> Done {
    let a = &arguments.common;
    let scene = asked_scene(a)?;
    let mut out = Printer::new();
    let began = Instant::now();
    let waiting = Waiting::begin();
    let solved = settle_with_bending(&scene, a.model, settings(a), arguments.bending);
    drop(waiting);
    let wall_time_s = began.elapsed().as_secs_f64();
    match solved {
        Ok((scene, solution)) => {
            let stiffness = arguments.stiffness.then(|| end_stiffness(&scene, a.model, settings(a))).transpose();
            let stiffness = stiffness.map_err(|e| Failure::from_core(&a.scene, e))?;
            let neglected = || neglected_bending(&scene, &solution, settings(a));
            let bending = if arguments.no_bending { Vec::new() } else { neglected() };
            let compared = if arguments.compare { compared(&scene, &solution, a) } else { Vec::new() };
            let cables = summaries(&scene, &solution);
            let figures = Figures { cables, stiffness, bending, compared, ..Figures::default() };
            let printable = answer(&solution, &figures, wall_time_s, None).map_err(Failure::NonFinite)?;
            if a.json {
                out.json(&printable)?;
            } else {
                out.line(table(&solution, &figures).trim_end())?;
            }
            out.flush()
        }
        Err(e) => {
            if let (true, cable_core::Error::Solve(e)) = (a.json, &e) {
                no_answer(&mut out, a.model, None, None, e)?;
            }
            Err(Failure::from_core(&a.scene, e))
        }
    }
}

/// The answers of every model and mesh beside a given one, with the time that each took.
fn compared(scene: &Scene, given: &Solution, a: &Common) -> Vec<ComparedEntry> {
    let ask = |setting| {
        let began = Instant::now();
        let found = answer_with(setting, scene, given, settings(a));
        let wall_time_s = began.elapsed().as_secs_f64();
        let error = found.as_ref().err().map(ToString::to_string);
        ComparedEntry { setting, wall_time_s, answer: found.ok(), error }
    };
    Setting::all().map(ask).collect()
}

/// Largest table of a run that is checked, bytes. More would not fit into the memory of a small
/// machine.
const MOST_TABLE_BYTES: u64 = 2 << 30;

/// Says on a terminal, every few seconds, that there is no answer yet.
struct Waiting {
    /// Dropped at the end, which ends the thread that listens.
    _end: Option<Sender<()>>,
}

impl Waiting {
    /// Between two lines: shorter bothers, longer leaves a user alone.
    const EVERY: Duration = Duration::from_secs(3);

    fn begin() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self { _end: None };
        }
        let (end, ended) = std::sync::mpsc::channel();
        let began = Instant::now();
        let tell = move || {
            while ended.recv_timeout(Self::EVERY) == Err(RecvTimeoutError::Timeout) {
                eprintln!("cable: no resting place yet after {:.0} s (Ctrl+C ends)", began.elapsed().as_secs_f64());
            }
        };
        let told = std::thread::Builder::new().name("waiting".to_owned()).spawn(tell);
        Self { _end: told.is_ok().then_some(end) }
    }
}

/// Says whether a scene can be solved, or how far a run came.
pub fn check(path: &Path) -> Done {
    if files::is_run(path) {
        return check_run(path);
    }
    let scene = read_scene(path)?;
    let notes = cable_core::problem::check(&scene).map_err(|e| Failure::from_core(path, e.into()))?;
    let mut out = Printer::new();
    let count = |n: usize, one: &str, many: &str| format!("{n} {}", if n == 1 { one } else { many });
    out.line(&format!(
        "{}: sound, {}, {}, {}",
        path.display(),
        count(scene.cables.len(), "cable", "cables"),
        count(scene.obstacles.len(), "obstacle", "obstacles"),
        count(scene.loads.len(), "load", "loads"),
    ))?;
    for note in notes {
        out.line(&format!("Note: {note}"))?;
    }
    out.flush()
}

/// Says how far the run in a folder came, and what of its tables was left out.
fn check_run(path: &Path) -> Done {
    let run = files::load_run(path, MOST_TABLE_BYTES).map_err(Failure::File)?;
    let kind = match run.is_complete() {
        Some(true) => "a complete run",
        Some(false) => "a partial run",
        None => "a run that does not say whether it is complete",
    };
    let history = &run.tables.history;
    let mut out = Printer::new();
    out.line(&format!(
        "{}: {kind}, {} instants to {} s, {} rows of nodes, {} events",
        path.display(),
        history.time_s.len(),
        history.time_s.last().copied().unwrap_or(0.0),
        run.tables.nodes.len(),
        run.tables.events.len(),
    ))?;
    for remark in run.remarks() {
        out.line(&format!("{remark}."))?;
    }
    out.flush()
}

/// Prints the JSON Schema of a scene file.
pub fn schema() -> Done {
    let mut out = Printer::new();
    out.line(&format!("{:#}", Scene::json_schema()))?;
    out.flush()
}
