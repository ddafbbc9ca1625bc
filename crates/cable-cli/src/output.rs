//! Answers go to standard output, and progress to standard error.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Mutex, TryLockError};
use std::time::{Duration, Instant};

use crate::failure::CommandFailure;

/// Standard output that ends quietly when its reader has gone (`cable … | head`).
pub struct Printer {
    out: io::BufWriter<io::Stdout>,
    closed: bool,
}

impl Printer {
    /// Makes a printer to standard output.
    pub fn new() -> Self {
        Self { out: io::BufWriter::new(io::stdout()), closed: false }
    }

    /// Prints one line.
    pub fn line(&mut self, text: &str) -> Result<(), CommandFailure> {
        self.with(|out| writeln!(out, "{text}"))
    }

    /// Prints a value as one line of JSON.
    pub fn json(&mut self, value: &impl serde::Serialize) -> Result<(), CommandFailure> {
        self.with(|out| {
            serde_json::to_writer(&mut *out, value)?;
            writeln!(out)
        })
    }

    /// Flushes the buffer.
    pub fn flush(&mut self) -> Result<(), CommandFailure> {
        self.with(Write::flush)
    }

    fn with(&mut self, f: impl FnOnce(&mut io::BufWriter<io::Stdout>) -> io::Result<()>) -> Result<(), CommandFailure> {
        if self.closed {
            return Ok(());
        }
        match f(&mut self.out) {
            Ok(()) => Ok(()),
            Err(e) if e.kind() == ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            Err(e) => Err(CommandFailure::Stdout(e)),
        }
    }
}

/// Waits until a line that is being printed is complete, unless its reader has stopped reading.
pub fn wait_for_line(print_lock: &Mutex<()>) {
    let began = Instant::now();
    while let Err(TryLockError::WouldBlock) = print_lock.try_lock() {
        if began.elapsed() > Duration::from_millis(200) {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Progress on standard error, only on a terminal.
pub struct RunProgress {
    shown: bool,
    last: Option<Instant>,
}

/// Time between two progress lines, s. A shorter time floods a slow terminal, a longer one looks
/// stuck.
const PROGRESS_INTERVAL_S: f64 = 0.1;

impl RunProgress {
    /// Makes the progress, which is shown if standard error is a terminal.
    pub fn new() -> Self {
        Self { shown: io::stderr().is_terminal(), last: None }
    }

    /// Shows how far a run is.
    pub fn at(&mut self, time_s: f64, duration_s: f64, tension_n: f64) {
        if !self.shown || self.last.is_some_and(|t| t.elapsed().as_secs_f64() < PROGRESS_INTERVAL_S) {
            return;
        }
        self.last = Some(Instant::now());
        let _ = write!(io::stderr(), "\r{time_s:9.3} s of {duration_s} s, greatest tension {tension_n:.4e} N  ");
    }

    /// Ends the line.
    pub fn end(&self) {
        if self.last.is_some() {
            let _ = writeln!(io::stderr());
        }
    }
}
