//! The headless program `cable` finds where a cable rests and how it moves, and checks scenes.
//!
//! Exit codes: 0 answered, 1 no solution or not converged, 2 bad input, 74 could not write; 130 and
//! 143 where SIGINT or SIGTERM ended a run.

mod answer_json;
mod answer_text;
mod args;
mod check;
mod failure;
mod finite_check;
mod input;
mod output;
mod progress_line;
mod run;
mod schema;
mod signals;
mod solve;
mod summary;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, CableCommand};
use failure::CommandFailure;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match arguments.command {
        CableCommand::Solve(a) => solve::solve(&a),
        CableCommand::Run(a) => run::run(a),
        CableCommand::Check { scene } => check::check(&scene),
        CableCommand::Schema => schema::schema(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure::report(&failure);
            ExitCode::from(failure.exit_code())
        }
    }
}

/// The result of every command.
type CommandResult = Result<(), CommandFailure>;
