//! This file writes the program's output and says with which code each failure exits.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::PathBuf;

use cable_core::files::FileError;
use cable_core::record::WriteError;
use cable_core::{Error, SceneError, SolveError};

use crate::signals::Signal;

/// The reason why a command did not end well.
#[derive(Debug)]
pub enum Failure {
    /// The scene is wrong.
    Scene(PathBuf, Box<SceneError>),
    /// A file could not be read or written.
    File(FileError),
    /// A table of the run could not be written.
    Table(PathBuf, WriteError),
    /// No answer.
    Solve(Box<SolveError>),
    /// A solver handed back a number that is not finite.
    NonFinite(String),
    /// A run ended early.
    Run { reached_s: f64, out: PathBuf, error: Box<SolveError> },
    /// An argument that does not fit the others.
    Argument(String),
    /// Standard output could not be written.
    Stdout(io::Error),
    /// A signal ended a run; where what was reached lies, if it was still written.
    Interrupted(Signal, Option<PathBuf>),
    /// The run has ended already, and who ended it says why.
    Ended,
    /// Signals cannot be waited for.
    Signals(io::Error),
    /// No thread can be begun.
    Thread(io::Error),
}

impl Failure {
    /// The exit code.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(..) | Self::Argument(_) => 2,
            Self::File(e) if e.is_of_writing() => 74,
            Self::Table(_, WriteError::Io { .. }) | Self::Stdout(_) => 74,
            Self::File(_) => 2,
            Self::Table(..) | Self::Solve(_) | Self::NonFinite(_) | Self::Run { .. } => 1,
            Self::Ended | Self::Signals(_) | Self::Thread(_) => 1,
            Self::Interrupted(signal, _) => signal.exit_code(),
        }
    }

    /// From an error of the library about a scene file.
    pub fn from_core(scene: &std::path::Path, e: Error) -> Self {
        match e {
            Error::Scene(e) => Self::Scene(scene.to_owned(), Box::new(e)),
            Error::Solve(e) => Self::Solve(Box::new(e)),
            Error::File(e) => Self::File(e),
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Scene(path, e) => write!(f, "{}: {e}", path.display()),
            Self::File(e) => write!(f, "{e}"),
            Self::Table(folder, e) => write!(f, "cannot write {}/{e}", folder.display()),
            Self::Solve(e) => write!(f, "{e}"),
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
            Self::Ended => f.write_str("the run has ended"),
            Self::Signals(e) => write!(f, "cannot wait for signals: {e}"),
            Self::Thread(e) => write!(f, "cannot begin a thread: {e}"),
        }
    }
}

/// Says on standard error what went wrong. A closed pipe is nobody's fault.
pub fn report(failure: &Failure) {
    // Nothing is left to tell if standard error is closed too.
    let _ = writeln!(io::stderr(), "cable: {failure}");
}

/// Standard output that takes a reader's leaving (`cable … | head`) as a wish to hear no more.
pub struct Printer {
    out: io::BufWriter<io::Stdout>,
    closed: bool,
}

impl Printer {
    /// Over standard output.
    pub fn new() -> Self {
        Self { out: io::BufWriter::new(io::stdout()), closed: false }
    }

    /// Prints one line.
    pub fn line(&mut self, text: &str) -> Result<(), Failure> {
        self.with(|out| writeln!(out, "{text}"))
    }

    /// Prints a value as one line of JSON.
    pub fn json(&mut self, value: &impl serde::Serialize) -> Result<(), Failure> {
        self.with(|out| {
            serde_json::to_writer(&mut *out, value)?;
            writeln!(out)
        })
    }

    /// Hands everything over.
    pub fn flush(&mut self) -> Result<(), Failure> {
        self.with(Write::flush)
    }

    fn with(&mut self, f: impl FnOnce(&mut io::BufWriter<io::Stdout>) -> io::Result<()>) -> Result<(), Failure> {
        if self.closed {
            return Ok(());
        }
        match f(&mut self.out) {
            Ok(()) => Ok(()),
            Err(e) if e.kind() == ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            Err(e) => Err(Failure::Stdout(e)),
        }
    }
}

/// Progress on standard error, only on a terminal.
pub struct Progress {
    shown: bool,
    last: Option<std::time::Instant>,
}

/// Time between two progress lines, s: shorter floods a slow terminal, longer looks stuck.
const PROGRESS_EVERY_S: f64 = 0.1;

impl Progress {
    /// Shown where standard error is a terminal.
    pub fn new() -> Self {
        Self { shown: io::stderr().is_terminal(), last: None }
    }

    /// Says how far a run is.
    pub fn at(&mut self, time_s: f64, duration_s: f64, tension_n: f64) {
        if !self.shown || self.last.is_some_and(|t| t.elapsed().as_secs_f64() < PROGRESS_EVERY_S) {
            return;
        }
        self.last = Some(std::time::Instant::now());
        let _ = write!(io::stderr(), "\r{time_s:9.3} s of {duration_s} s, greatest tension {tension_n:.4e} N  ");
    }

    /// Ends the line.
    pub fn end(&self) {
        if self.last.is_some() {
            let _ = writeln!(io::stderr());
        }
    }
}
