//! A signal that asks a run to end only sets a flag, so that the run ends properly.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// A signal that ends a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// Ctrl-C.
    Interrupt,
    /// `kill`, or a scheduler whose time is up.
    Terminate,
}

impl Signal {
    const ALL: [Self; 2] = [Self::Interrupt, Self::Terminate];

    fn number(self) -> i32 {
        match self {
            Self::Interrupt => SIGINT,
            Self::Terminate => SIGTERM,
        }
    }

    /// The name of the signal in POSIX.
    pub fn name(self) -> &'static str {
        match self {
            Self::Interrupt => "SIGINT",
            Self::Terminate => "SIGTERM",
        }
    }

    /// The exit code that shells use for a program that this signal ended.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Interrupt => 130,
            Self::Terminate => 143,
        }
    }
}

/// The signal that has arrived, if any. A second one ends the program at once, for when the disk
/// does not answer.
pub struct Signals(Arc<AtomicUsize>);

impl Signals {
    /// Installs the handlers.
    pub fn new() -> io::Result<Self> {
        let (arrived, any) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicBool::new(false)));
        for (k, signal) in Signal::ALL.into_iter().enumerate() {
            // The order matters: the second signal reads the flag that the first one set.
            flag::register_conditional_shutdown(signal.number(), i32::from(signal.exit_code()), any.clone())?;
            flag::register_usize(signal.number(), arrived.clone(), k + 1)?;
            flag::register(signal.number(), any.clone())?;
        }
        Ok(Self(arrived))
    }

    /// The signal that arrived last.
    pub fn arrived(&self) -> Option<Signal> {
        let k = self.0.load(Ordering::SeqCst).checked_sub(1)?;
        Signal::ALL.get(k).copied()
    }
}
