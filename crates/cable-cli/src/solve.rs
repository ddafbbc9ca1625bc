//! The command `cable solve` finds the equilibrium of a scene.

use std::time::Instant;

use cable_core::analysis::{Setting, answer_with, end_stiffness, neglected_bending, settle_with_bending};
use cable_core::summary::summaries;
use cable_core::{Scene, Solution};

use crate::CommandResult;
use crate::answer_json::{ComparedEntry, NoAnswerJson, SummaryJson, answer};
use crate::answer_text::answer_text;
use crate::args::{Common, SolveArguments};
use crate::failure::CommandFailure;
use crate::input::{scene_with_arguments, settings};
use crate::output::Printer;
use crate::progress_line::WaitingNotice;

/// Finds the equilibrium of a scene.
pub fn solve(arguments: &SolveArguments) -> CommandResult {
    let a = &arguments.common;
    let scene = scene_with_arguments(a)?;
    let mut out = Printer::new();
    let began = Instant::now();
    let waiting = WaitingNotice::begin();
    let solved = settle_with_bending(&scene, a.model, settings(a), a.bending);
    drop(waiting);
    let wall_time_s = began.elapsed().as_secs_f64();
    match solved {
        Ok((scene, solution)) => {
            let stiffness = arguments.stiffness.then(|| end_stiffness(&scene, a.model, settings(a))).transpose();
            let stiffness = stiffness.map_err(|e| CommandFailure::from_core(&a.scene, e))?;
            let neglected = || neglected_bending(&scene, &solution, settings(a));
            let bending = if a.no_bending { Vec::new() } else { neglected() };
            let compared = if arguments.compare { compared(&scene, &solution, a) } else { Vec::new() };
            let cables = summaries(&scene, &solution);
            let figures = SummaryJson { cables, stiffness, bending, compared, ..SummaryJson::default() };
            let printable = answer(&solution, &figures, wall_time_s, None).map_err(CommandFailure::NonFinite)?;
            if a.json {
                out.json(&printable)?;
            } else {
                out.line(answer_text(&solution, &figures).trim_end())?;
            }
            out.flush()
        }
        Err(e) => {
            if let (true, cable_core::Error::Solve(e)) = (a.json, &e) {
                out.json(&NoAnswerJson::new(a.model, None, None, e))?;
                out.flush()?;
            }
            Err(CommandFailure::from_core(&a.scene, e))
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
