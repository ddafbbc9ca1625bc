//! A failure of the program has a sentence and an exit code.

use std::io::{self, Write};
use std::path::PathBuf;

use cable_core::files::FileError;
use cable_core::record::WriteError;
use cable_core::{Error, SceneError, SolveError};

use crate::signals::Signal;

/// The reason why a command did not end well.
#[derive(Debug)]
pub enum CommandFailure {
    /// The scene is wrong.
    Scene(PathBuf, Box<SceneError>),
    /// A file could not be read or written.
    File(FileError),
    /// A table of the run could not be written.
    Table(PathBuf, WriteError),
    /// No answer.
    Solve(Box<SolveError>),
    /// An error of a kind that is newer than this program.
    Other(Error),
    /// A solver handed back a number that is not finite.
    NonFinite(String),
    /// A run ended early.
    Run { reached_s: f64, out: PathBuf, error: Box<SolveError> },
    /// An argument that does not fit the others.
    Argument(String),
    /// Standard output could not be written.
    Stdout(io::Error),
    /// A signal ended a run; the folder holds the part that was written, if any.
    Interrupted(Signal, Option<PathBuf>),
    /// The run has ended already, and another thread reports why.
    AlreadyEnded,
    /// The handlers of signals could not be installed.
    Signals(io::Error),
    /// A thread could not be started.
    Thread(io::Error),
}

impl CommandFailure {
    /// The exit code.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(..) | Self::Argument(_) => 2,
            Self::File(e) if e.is_of_writing() => 74,
            Self::Table(_, WriteError::Io { .. }) | Self::Stdout(_) => 74,
            Self::File(_) => 2,
            Self::Table(..) | Self::Solve(_) | Self::NonFinite(_) | Self::Run { .. } | Self::Other(_) => 1,
            Self::AlreadyEnded | Self::Signals(_) | Self::Thread(_) => 1,
            Self::Interrupted(signal, _) => signal.exit_code(),
        }
    }

    /// Converts an error of the library about a scene file.
    pub fn from_core(scene: &std::path::Path, e: Error) -> Self {
        match e {
            Error::Scene(e) => Self::Scene(scene.to_owned(), Box::new(e)),
            Error::Solve(e) => Self::Solve(Box::new(e)),
            Error::File(e) => Self::File(e),
            other => Self::Other(other),
        }
    }
}

impl std::fmt::Display for CommandFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Scene(path, e) => write!(f, "{}: {e}", path.display()),
            Self::File(e) => write!(f, "{e}"),
            Self::Table(folder, e) => write!(f, "cannot write {}/{e}", folder.display()),
            Self::Solve(e) => write!(f, "{e}"),
            Self::Other(e) => write!(f, "{e}"),
            Self::NonFinite(what) => write!(f, "no answer: {what} is not finite"),
            Self::Run { reached_s, out, error } => {
                write!(f, "the run ended at {reached_s:.6} s: {error}; what was reached is in {}", out.display())
            }
            Self::Argument(what) => f.write_str(what),
            Self::Stdout(e) => write!(f, "cannot write to standard output: {e}"),
            Self::Interrupted(signal, Some(out)) => {
                write!(f, "interrupted by {}; what was reached is in {}", signal.name(), out.display())
            }
            Self::Interrupted(signal, None) => write!(f, "interrupted by {} after the run had ended", signal.name()),
            Self::AlreadyEnded => f.write_str("the run has ended"),
            Self::Signals(e) => write!(f, "cannot wait for signals: {e}"),
            Self::Thread(e) => write!(f, "cannot begin a thread: {e}"),
        }
    }
}

/// Writes a failure to standard error. A closed pipe is no failure.
pub fn report(failure: &CommandFailure) {
    // If standard error is closed too, nothing can be reported.
    let _ = writeln!(io::stderr(), "cable: {failure}");
}
