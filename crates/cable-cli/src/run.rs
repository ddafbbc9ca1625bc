//! `cable run`: settles, then steps, and writes what it sees at every output time.

use std::time::Instant;

use cable_core::model::Inertia;
use cable_core::model::auto::Question;
use cable_core::solution::{MaxTension, Solution, WarningKind};
use cable_core::{Settings, Simulation, SolveError, files};

use crate::Done;
use crate::answer::answer;
use crate::args::RunArguments;
use crate::output::{Failure, Printer, Progress};
use crate::solve::{asked_scene, no_answer, settings};
use crate::table::table;

/// Most output times of a run: 1e7 of them with 100 nodes are 100 GB of tables, which nobody meant.
const MAX_OUTPUTS: f64 = 1e7;

/// Where the answers of a run go.
struct Outputs<'a> {
    arguments: &'a RunArguments,
    folder: files::RunFolder,
    printer: Printer,
    progress: Progress,
    peak: MaxTension,
    peak_time_s: f64,
    begun: Begun,
}

impl Outputs<'_> {
    fn push(&mut self, solution: &Solution, wall_time_s: f64) -> Done {
        let printable = answer(solution, wall_time_s, Some(solution.time_s)).map_err(Failure::NonFinite)?;
        self.folder.push(solution).map_err(|e| Failure::Table(self.arguments.out.clone(), e))?;
        if self.arguments.common.json {
            self.printer.json(&printable)?;
            self.printer.flush()?;
        }
        self.begun.look(solution);
        let top = solution.max_tension();
        if solution.time_s == 0.0 || top.tension_n > self.peak.tension_n {
            (self.peak, self.peak_time_s) = (top, solution.time_s);
        }
        self.progress.at(solution.time_s, self.arguments.duration_s, top.tension_n);
        Ok(())
    }

    fn close(&mut self) -> Done {
        self.progress.end();
        self.folder.flush().map_err(|e| Failure::Table(self.arguments.out.clone(), e))
    }
}

/// Most warnings of a run that are printed: all of them are in its `events.csv`.
const MOST_PRINTED: usize = 20;

/// The warnings that began in a run.
#[derive(Default)]
struct Begun {
    count: usize,
    lines: Vec<String>,
    standing: Vec<(WarningKind, String)>,
}

impl Begun {
    fn look(&mut self, solution: &Solution) {
        for w in &solution.warnings {
            if self.standing.iter().any(|(kind, cable)| *kind == w.kind && *cable == w.cable) {
                continue;
            }
            self.count += 1;
            if self.lines.len() < MOST_PRINTED {
                let time_s = w.since_s.unwrap_or(solution.time_s);
                self.lines.push(format!("  {time_s:9.4} s  {:17}  {}", w.kind.name(), w.message));
            }
        }
        self.standing = solution.warnings.iter().map(|w| (w.kind, w.cable.clone())).collect();
    }

    /// A title and a line a warning.
    fn lines(&self) -> Vec<String> {
        let mut out = self.lines.clone();
        if !out.is_empty() {
            out.insert(0, "\nWarnings that began".to_owned());
        }
        if self.count > out.len() {
            out.push(format!("  and {} more, see events.csv", self.count - self.lines.len()));
        }
        out
    }
}

/// Follows a scene over time.
pub fn run(a: &RunArguments) -> Done {
    let every = a.every_s();
    if a.duration_s / every > MAX_OUTPUTS {
        return Err(Failure::Argument(format!(
            "--for {} s with --every {every} s makes more than {MAX_OUTPUTS:.0e} output times: make --every longer",
            a.duration_s
        )));
    }
    let scene = asked_scene(&a.common)?;
    let inertia = if a.quasi_static { Inertia::QuasiStatic } else { Inertia::Dynamic };
    let began = Instant::now();
    let settings = Settings { stepping: a.stepping, ..settings(&a.common) };
    let mut simulation = Simulation::for_question(scene.clone(), a.common.model, settings, Question::History(inertia))
        .map_err(|e| Failure::from_core(&a.common.scene, e))?;
    let folder = files::create_run(&a.out, &scene).map_err(Failure::File)?;
    let mut outputs = Outputs {
        arguments: a,
        folder,
        printer: Printer::new(),
        progress: Progress::new(),
        peak: MaxTension::default(),
        peak_time_s: 0.0,
        begun: Begun::default(),
    };
    let walked = walk(&mut simulation, inertia, &mut outputs, began);
    let closed = outputs.close();
    // What stopped the run matters more than a table that could not be flushed after it.
    walked.and(closed)?;
    if !a.common.json {
        let out = &mut outputs.printer;
        out.line(table(&simulation.solution()).trim_end())?;
        let (peak, t) = (outputs.peak, outputs.peak_time_s);
        out.line(&format!(
            "\nGreatest tension of the run  {:.6} N at {t:.4} s, at {:.4} m",
            peak.tension_n, peak.arc_length_m
        ))?;
        for line in outputs.begun.lines() {
            out.line(&line)?;
        }
        out.line(&format!("Written to {}", a.out.display()))?;
        out.flush()?;
    }
    Ok(())
}

/// Output k lies at k·every, the last one exactly at the end.
fn walk(simulation: &mut Simulation, inertia: Inertia, outputs: &mut Outputs<'_>, mut began: Instant) -> Done {
    let a = outputs.arguments;
    let first = match simulation.settle() {
        Ok(s) => s,
        Err(e) => return Err(stopped(outputs, simulation, e)),
    };
    outputs.push(&first, began.elapsed().as_secs_f64())?;
    // A last interval shorter than a billionth of the others is round-off, not an interval.
    let every = a.every_s();
    let count = (a.duration_s / every - 1e-9).ceil() as usize;
    for k in 1..=count {
        let target_s = if k == count { a.duration_s } else { k as f64 * every };
        began = Instant::now();
        let dt_s = target_s - simulation.time_s();
        let stepped = match inertia {
            Inertia::Dynamic => simulation.step(dt_s),
            Inertia::QuasiStatic => simulation.step_quasi_static(dt_s),
        };
        if let Err(e) = stepped {
            return Err(stopped(outputs, simulation, e));
        }
        let mut solution = simulation.solution();
        // Adding steps up rounds; the time asked for is the time meant.
        solution.time_s = target_s;
        outputs.push(&solution, began.elapsed().as_secs_f64())?;
    }
    Ok(())
}

fn stopped(outputs: &mut Outputs<'_>, simulation: &Simulation, error: SolveError) -> Failure {
    let reached_s = simulation.time_s();
    if outputs.arguments.common.json
        && let Err(e) =
            no_answer(&mut outputs.printer, simulation.model(), simulation.reason(), Some(reached_s), &error)
    {
        return e;
    }
    Failure::Run { reached_s, out: outputs.arguments.out.clone(), error: Box::new(error) }
}
