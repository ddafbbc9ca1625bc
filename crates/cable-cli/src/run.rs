//! `cable run` settles a scene, then steps it, and writes an answer at every output time.
//!
//! A second thread solves and writes. The main thread waits for it and for signals. So a signal
//! that arrives during a long step, or while a reader of standard output is slow, ends the run at
//! once, and the part that was written remains.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use cable_core::analysis::{neglected_bending, scene_with_bending};
use cable_core::files::{RunEnd, RunFolder};
use cable_core::model::{Inertia, Question};
use cable_core::record::{RobotColumns, RunRequest, RunStop, WriteError};
use cable_core::solution::{
    EnergyAccount, InertiaEffect, LikelyBending, ModelReason, Solution, TensionPeak, TensionPeaks, Warning, WarningKind,
};
use cable_core::summary::summaries;
use cable_core::timeline::{Instant as Moment, Refinement, RunPeaks, Timeline, refine_until_accurate};
use cable_core::{Scene, Settings, Simulation, SolveError};

use crate::CommandResult;
use crate::answer_json::{NoAnswerJson, RunPeaksEntry, SummaryJson, answer};
use crate::answer_text::answer_text;
use crate::args::RunArguments;
use crate::failure::CommandFailure;
use crate::input::{scene_with_arguments, settings};
use crate::output::{Printer, RunProgress, wait_for_line};
use crate::signals::Signals;
use crate::summary::neglected_at_first_rest;

/// Largest number of output times of a run: 1e7 of them with 100 nodes are 100 GB of tables, which
/// no user intends.
const MAX_OUTPUTS: f64 = 1e7;

/// The run folder, until the run has ended or a signal has ended it.
#[derive(Clone)]
struct SharedRunFolder(Arc<Mutex<Option<RunFolder>>>);

impl SharedRunFolder {
    fn lock(&self) -> MutexGuard<'_, Option<RunFolder>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes to the folder, unless the run has ended.
    fn write(
        &self,
        out: &std::path::Path,
        write: impl FnOnce(&mut RunFolder) -> Result<(), WriteError>,
    ) -> CommandResult {
        match &mut *self.lock() {
            Some(folder) => write(folder).map_err(|e| CommandFailure::Table(out.to_owned(), e)),
            None => Err(CommandFailure::AlreadyEnded),
        }
    }

    /// Ends the run, unless it has ended, and returns the path of its folder.
    fn finish(&self, end: RunEnd) -> Option<Result<PathBuf, CommandFailure>> {
        let mut guard = self.lock();
        Some(guard.take()?.finish(end).map_err(CommandFailure::File))
    }

    /// The present path of the folder.
    fn place(&self) -> Option<PathBuf> {
        self.lock().as_ref().map(|folder| folder.place().to_owned())
    }
}

/// Destinations of the answers of a run.
struct Outputs {
    arguments: RunArguments,
    scene: Scene,
    /// The use that was made of likely bending stiffness.
    bending: Option<LikelyBending>,
    /// Lines on what neglected bending stiffness would change of the first rest.
    neglected: Vec<String>,
    folder: SharedRunFolder,
    print_lock: Arc<Mutex<()>>,
    printer: Printer,
    progress: RunProgress,
    /// The greatest tensions of each cable since the last answer.
    peaks_since_output: Vec<Option<TensionPeaks>>,
    warning_log: WarningLog,
    last: Option<Solution>,
    totals: Option<RunTotals>,
    /// The greatest tensions of each cable in the run so far.
    run_peaks: Vec<RunPeaksEntry>,
    inertia: Option<InertiaEffect>,
}

/// Totals of a whole run.
struct RunTotals {
    /// The peaks of the cable with the greatest tension.
    peaks: RunPeaks,
    relative_error: Option<f64>,
    /// Mach and Froude numbers of the motion, and its difference from one without inertia.
    inertia: Option<InertiaEffect>,
    /// True if errors were requested.
    errors_asked: bool,
}

impl RunTotals {
    fn of(timeline: &Timeline, arguments: &RunArguments) -> Option<Self> {
        let top = |run: &RunPeaks| run.peaks.greatest.tension_n;
        let peaks = timeline.monitor().peaks().iter().copied().reduce(|a, b| if top(&b) > top(&a) { b } else { a })?;
        let relative_error = timeline.monitor().relative_error();
        let errors_asked = !arguments.no_errors;
        Some(Self { peaks, relative_error, inertia: timeline.inertia_effect(), errors_asked })
    }

    fn lines(&self, tolerance: f64) -> Vec<String> {
        let TensionPeaks { greatest, held, over_s } = self.peaks.peaks;
        let of = |p: TensionPeak, range: Option<[f64; 2]>| {
            let range = range.map(|[from, to]| format!("; {from:.4} to {to:.4} N, estimated from coarser runs"));
            let (tension_n, time_s, at) = (p.tension_n, p.time_s, p.arc_length_m);
            format!("{tension_n:.4} N at {time_s:.4} s, at {at:.4} m{}", range.unwrap_or_default())
        };
        let ranges = self.peaks.ranges;
        let mut lines = vec![format!("\nGreatest tension of the run  {}", of(greatest, ranges.map(|r| r.greatest_n)))];
        if over_s > 0.0 {
            lines.push(format!("Greatest mean over {over_s} s   {}", of(held, ranges.map(|r| r.held_n))));
        }
        if ranges.is_some_and(|r| r.are_resolved(tolerance)) {
            lines.push(format!(
                "This maximum is resolved: finer meshes and steps would change it by less than {tolerance:.1e} of its value"
            ));
        } else if ranges.is_some_and(|r| r.depend_on_small_differences()) {
            lines.push(
                "This maximum depends on small differences: the coarser runs do not converge, and another mesh, step or start gives another value"
                    .to_owned(),
            );
        }
        if let Some(error) = self.relative_error {
            let asked = match error > tolerance {
                true => format!(
                    " ({tolerance:.1e} was asked for; --refine 1 takes four times as long and is more accurate where motion is smooth)"
                ),
                false => String::new(),
            };
            lines.push(format!("Greatest force error {error:.1e} of the greatest tension{asked}"));
        } else if self.errors_asked {
            lines.push("The force errors are not known: there is no coarser run to compare with".to_owned());
        }
        lines.extend(self.inertia.map(|effect| effect.to_string()));
        lines
    }
}

/// Fraction of the exchanged energy below which a work is not listed.
const LEAST_WORK_FRACTION: f64 = 1e-6;

/// The energy account of a run.
fn energy_lines(account: &EnergyAccount) -> Vec<String> {
    let least = LEAST_WORK_FRACTION * account.exchanged_j;
    let named = |(kind, work): (&str, f64)| (work.abs() > least).then(|| format!("{kind} {work:.6} J"));
    let works: Vec<String> = EnergyAccount::KINDS.into_iter().zip(account.works_j()).filter_map(named).collect();
    if works.is_empty() {
        return Vec::new();
    }
    let (exchanged, gained) = (account.exchanged_j, account.gained.total_j());
    vec![
        format!("Energy exchanged            {exchanged:.6} J; gained {gained:.6} J by work of"),
        format!("                            {}", works.join(", ")),
        format!("Not accounted for           {:.1e} of that", account.unaccounted_j().abs() / exchanged),
    ]
}

/// Place of an output among those of the run.
#[derive(Clone, Copy)]
enum OutputOrder {
    Intermediate,
    Last,
}

impl OutputOrder {
    /// The place of output `k` of the outputs 0 to `last`.
    fn of(k: usize, last: usize) -> Self {
        if k == last { Self::Last } else { Self::Intermediate }
    }
}

impl Outputs {
    fn push(&mut self, mut solution: Solution, wall_time_s: f64, order: OutputOrder) -> CommandResult {
        for (cable, since) in solution.cables.iter_mut().zip(self.peaks_since_output.drain(..)) {
            cable.peaks = since.into_iter().chain(cable.peaks).reduce(TensionPeaks::with);
        }
        solution.reason = self.with_bending(solution.reason);
        let json = self.arguments.common.json;
        let cables = if json { summaries(&self.scene, &solution) } else { Vec::new() };
        let mut figures =
            SummaryJson { cables, run_peaks: self.run_peaks.clone(), inertia: self.inertia, ..SummaryJson::default() };
        if self.last.is_none() && !self.arguments.common.no_bending {
            figures.bending = neglected_bending(&self.scene, &solution, settings(&self.arguments.common));
            if !json {
                figures.cables = summaries(&self.scene, &solution);
                self.neglected = neglected_at_first_rest(&figures);
            }
        }
        let printable =
            answer(&solution, &figures, wall_time_s, Some(solution.time_s)).map_err(CommandFailure::NonFinite)?;
        let push = match order {
            OutputOrder::Intermediate => RunFolder::push,
            OutputOrder::Last => RunFolder::push_last,
        };
        self.folder.write(&self.arguments.out, |folder| {
            push(folder, &solution)?;
            folder.add_wall_time(wall_time_s);
            Ok(())
        })?;
        if json {
            let _whole_line = self.print_lock.lock().unwrap_or_else(PoisonError::into_inner);
            self.printer.json(&printable)?;
            self.printer.flush()?;
        }
        self.progress.at(solution.time_s, self.arguments.duration_s, solution.max_tension().tension_n);
        self.last = Some(solution);
        Ok(())
    }

    /// The reason for a model, with the use that was made of likely bending stiffness.
    fn with_bending(&self, reason: ModelReason) -> ModelReason {
        match &self.bending {
            Some(bending) => reason.with_bending(bending.clone()),
            None => reason,
        }
    }

    /// Notes what is known of the run so far.
    fn update_totals(&mut self, timeline: &Timeline) {
        self.totals = RunTotals::of(timeline, &self.arguments);
        self.inertia = timeline.inertia_effect();
        let tolerance = self.arguments.common.tolerance();
        self.run_peaks = timeline.monitor().peaks().iter().map(|run| RunPeaksEntry::of(run, tolerance)).collect();
    }

    /// Records the peaks and warnings of a step, whether it is written or not.
    fn observe_step(&mut self, simulation: &Simulation) {
        let time_s = simulation.time_s();
        self.warning_log.update(simulation.warnings(), time_s);
        self.peaks_since_output.resize(simulation.answers().len(), None);
        for (answer, since) in simulation.answers().iter().zip(&mut self.peaks_since_output) {
            let peaks = answer.peaks_at(time_s);
            *since = Some(since.map_or(peaks, |before: TensionPeaks| before.with(peaks)));
        }
    }
}

/// Largest number of warnings that are printed. All of them are in `events.csv`.
const MAX_PRINTED_WARNINGS: usize = 20;

/// The warnings that began in a run.
#[derive(Default)]
struct WarningLog {
    count: usize,
    lines: Vec<String>,
    active: Vec<Warning>,
}

impl WarningLog {
    fn update<'w>(&mut self, warnings: impl Iterator<Item = &'w Warning>, now_s: f64) {
        let mut active = Vec::new();
        for w in warnings {
            active.push(w.clone());
            if self.active.iter().any(|before| is_same(before, w)) {
                continue;
            }
            self.count += 1;
            if self.lines.len() < MAX_PRINTED_WARNINGS {
                let time_s = w.since_s.unwrap_or(now_s);
                self.lines.push(format!("  {time_s:9.4} s  {:17}  {}", w.kind.name(), w));
            }
        }
        self.active = active;
    }

    /// A title, and a line for each warning.
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

/// True if a warning was there before. A cable may break in several places, one after the other.
fn is_same(before: &Warning, now: &Warning) -> bool {
    let same_place = now.kind != WarningKind::Broken || before.arc_length_m == now.arc_length_m;
    before.kind == now.kind && before.cable == now.cable && same_place
}

/// Time between two checks for a signal, s. A user would notice a longer time at the end; a shorter
/// one wakes the processor in vain.
const SIGNAL_POLL_INTERVAL_S: f64 = 0.02;

/// Stack of the thread that solves, bytes: that of a main thread, as other threads get only 2 MiB.
const STACK_BYTES: usize = 8 << 20;

/// Runs a scene over time.
pub fn run(a: RunArguments) -> CommandResult {
    let every = a.every_s();
    check_durations(&a, every)?;
    let choice = a.node_choice().map_err(CommandFailure::Argument)?;
    let written = scene_with_arguments(&a.common)?;
    let inertia = if a.quasi_static { Inertia::QuasiStatic } else { Inertia::Dynamic };
    let began = Instant::now();
    let settings = Settings { stepping: a.stepping, ..settings(&a.common) };
    let at_rest = Settings { histories: false, ..settings };
    let (scene, bending) = scene_with_bending(&written, a.common.model, at_rest, a.common.bending)
        .map_err(|e| CommandFailure::from_core(&a.common.scene, e))?;
    let simulation = Simulation::for_question(scene.clone(), a.common.model, settings, Question::History(inertia))
        .map_err(|e| CommandFailure::from_core(&a.common.scene, e))?;
    // From here on a signal ends the run properly.
    let signals = Signals::new().map_err(CommandFailure::Signals)?;
    let request = RunRequest {
        program: format!("cable {}", env!("CARGO_PKG_VERSION")),
        model: Some(a.common.model.name().to_owned()),
        quasi_static: Some(a.quasi_static),
        duration_s: Some(a.duration_s),
        every_s: Some(every),
        step_s: a.step,
    };
    let mut folder = RunFolder::create(&a.out, &scene, request, choice).map_err(CommandFailure::File)?;
    // Even a run that is ended before its first instant has tables then.
    let robot = RobotColumns::of(&simulation.solution());
    folder.begin(&scene, robot).map_err(|e| CommandFailure::Table(a.out.clone(), e))?;
    let shared = SharedRunFolder(Arc::new(Mutex::new(Some(folder))));
    let print_lock = Arc::new(Mutex::new(()));
    let outputs = Outputs {
        arguments: a,
        scene,
        bending,
        neglected: Vec::new(),
        folder: shared.clone(),
        print_lock: print_lock.clone(),
        printer: Printer::new(),
        progress: RunProgress::new(),
        totals: None,
        run_peaks: Vec::new(),
        inertia: None,
        peaks_since_output: Vec::new(),
        warning_log: WarningLog::default(),
        last: None,
    };
    let (done, ended) = sync_channel(1);
    let solver = std::thread::Builder::new().name("solver".to_owned()).stack_size(STACK_BYTES);
    let solver = solver.spawn(move || {
        // The receiver is gone if a signal has ended the run.
        let _ = done.send(run_to_end(simulation, inertia, outputs, began));
    });
    let solver = solver.map_err(CommandFailure::Thread)?;
    await_end(&ended, solver, &signals, &shared, &print_lock)
}

/// Refuses durations that make too many outputs, or no step.
fn check_durations(a: &RunArguments, every: f64) -> Result<(), CommandFailure> {
    if a.duration_s / every > MAX_OUTPUTS {
        return Err(CommandFailure::Argument(format!(
            "--for {} s with --every {every} s makes more than {MAX_OUTPUTS:.0e} output times: make --every longer",
            a.duration_s
        )));
    }
    if let Some(step) = a.step.filter(|step| *step > a.duration_s && a.duration_s > 0.0) {
        return Err(CommandFailure::Argument(format!(
            "--step {step} s is longer than the run (--for {} s): make --step shorter",
            a.duration_s
        )));
    }
    Ok(())
}

/// Waits for the thread that solves, and for signals, which end the run in order.
fn await_end(
    ended: &Receiver<CommandResult>,
    solver: JoinHandle<()>,
    signals: &Signals,
    shared: &SharedRunFolder,
    print_lock: &Mutex<()>,
) -> CommandResult {
    loop {
        match ended.recv_timeout(Duration::from_secs_f64(SIGNAL_POLL_INTERVAL_S)) {
            Ok(done) => return done,
            Err(RecvTimeoutError::Timeout) => {
                if let Some(signal) = signals.arrived() {
                    let place = shared.place();
                    // The tables are readable and marked as partial already, whether this can be
                    // noted or not.
                    let _ = shared.finish(RunEnd::Partial(RunStop::Interrupted { signal: signal.name().to_owned() }));
                    wait_for_line(print_lock);
                    return Err(CommandFailure::Interrupted(signal, place));
                }
            }
            Err(RecvTimeoutError::Disconnected) => match solver.join() {
                Err(panic) => {
                    let _ = shared.finish(RunEnd::Partial(RunStop::Panicked));
                    std::panic::resume_unwind(panic)
                }
                Ok(()) => return Err(CommandFailure::AlreadyEnded),
            },
        }
    }
}

/// Solves, writes, and ends the run.
fn run_to_end(simulation: Simulation, inertia: Inertia, mut outputs: Outputs, began: Instant) -> CommandResult {
    let walked = run_steps(simulation, inertia, &mut outputs, began);
    outputs.progress.end();
    let end = match &walked {
        Ok(()) => RunEnd::Complete,
        Err(failure) => RunEnd::Partial(RunStop::Failed { message: failure.to_string() }),
    };
    let finished = outputs.folder.finish(end);
    // Why the run stopped matters more than a folder that could not be closed after it.
    walked?;
    let place = finished.ok_or(CommandFailure::AlreadyEnded)??;
    let Outputs { arguments, scene, mut printer, last, .. } = outputs;
    if let (false, Some(last)) = (arguments.common.json, last) {
        let figures = SummaryJson { cables: summaries(&scene, &last), ..SummaryJson::default() };
        printer.line(answer_text(&last, &figures).trim_end())?;
        for line in outputs.totals.iter().flat_map(|reached| reached.lines(arguments.common.tolerance())) {
            printer.line(&line)?;
        }
        for line in &outputs.neglected {
            printer.line(line)?;
        }
        for line in last.energy_account().iter().flat_map(energy_lines) {
            printer.line(&line)?;
        }
        for line in outputs.warning_log.lines() {
            printer.line(&line)?;
        }
        printer.line(&format!("Written to {}", place.display()))?;
        printer.flush()?;
    }
    Ok(())
}

/// Output k lies at k·every, the last one exactly at the end.
fn run_steps(mut simulation: Simulation, inertia: Inertia, outputs: &mut Outputs, mut began: Instant) -> CommandResult {
    if let Err(e) = simulation.settle() {
        return Err(end_with_error(outputs, &simulation, e));
    }
    let arguments = &outputs.arguments;
    let asked = Refinement {
        duration_s: arguments.duration_s,
        step_s: arguments.step,
        tolerance: arguments.common.tolerance(),
        max_halvings: arguments.refinements(),
    };
    let (simulation, step) = match refine_until_accurate(simulation.clone(), inertia, &asked) {
        Ok(found) => found,
        Err(e) => return Err(end_with_error(outputs, &simulation, e)),
    };
    let first = simulation.solution();
    // A last interval shorter than a billionth of the others is round-off, not an interval.
    let (duration_s, every) = (outputs.arguments.duration_s, outputs.arguments.every_s());
    let count = (duration_s / every - 1e-9).ceil() as usize;
    outputs.observe_step(&simulation);
    outputs.push(first, began.elapsed().as_secs_f64(), OutputOrder::of(0, count))?;
    let interval = Moment::nearest(every);
    let at_rest = simulation.clone();
    let mut timeline = match Timeline::new(simulation, inertia, step) {
        Ok(timeline) => timeline,
        Err(e) => return Err(end_with_error(outputs, &at_rest, e)),
    };
    if !outputs.arguments.no_errors {
        timeline = timeline.with_errors().with_next_cheaper();
    }
    outputs.update_totals(&timeline);
    for k in 1..=count {
        let moment = if k == count { Moment::nearest(duration_s) } else { interval.times(k as u64) };
        began = Instant::now();
        let answer = timeline.at(moment, |simulation| outputs.observe_step(simulation));
        outputs.update_totals(&timeline);
        match answer {
            Ok(solution) => outputs.push(solution, began.elapsed().as_secs_f64(), OutputOrder::of(k, count))?,
            Err(e) => return Err(end_with_error(outputs, timeline.simulation(), e)),
        }
    }
    Ok(())
}

fn end_with_error(outputs: &mut Outputs, simulation: &Simulation, error: SolveError) -> CommandFailure {
    let reached_s = simulation.time_s();
    let reason = outputs.with_bending(simulation.reason().clone());
    if outputs.arguments.common.json {
        let answer = NoAnswerJson::new(simulation.model(), Some(&reason), Some(reached_s), &error);
        if let Err(e) = outputs.printer.json(&answer).and_then(|()| outputs.printer.flush()) {
            return e;
        }
    }
    let place = outputs.folder.place().unwrap_or_else(|| outputs.arguments.out.clone());
    CommandFailure::Run { reached_s, out: place, error: Box::new(error) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cable_core::solution::WarningCause;

    /// Only the first break of a cable was printed, though `events.csv` has all.
    #[test]
    fn issue_016_each_break_is_listed_once() {
        let broke = |arc_length_m: f64| {
            let cause = WarningCause::Broke { time_s: 1.0, over_s: 0.0, detached_from: None };
            Warning::new(cause, "cable", arc_length_m, [150.0, 150.0])
        };
        let (mut log, [first, second]) = (WarningLog::default(), [broke(2.0), broke(3.0)]);
        log.update([&first].into_iter(), 1.0);
        log.update([&first].into_iter(), 2.0);
        log.update([&second, &first].into_iter(), 3.0);
        assert_eq!((log.count, log.lines.len()), (2, 2), "{:?}", log.lines);
    }
}
