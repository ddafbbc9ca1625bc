//! A line on the terminal tells that an answer takes long.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

/// Prints on a terminal, every few seconds, that there is no answer yet.
pub struct WaitingNotice {
    /// The sender is dropped at the end, which ends the thread that prints.
    _end: Option<Sender<()>>,
}

impl WaitingNotice {
    /// Time between two lines. A shorter time disturbs, a longer one leaves a user without news.
    const NOTICE_INTERVAL: Duration = Duration::from_secs(3);

    /// Begins to print lines, until the value is dropped.
    pub fn begin() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self { _end: None };
        }
        let (end, ended) = std::sync::mpsc::channel();
        let began = Instant::now();
        let tell = move || {
            while ended.recv_timeout(Self::NOTICE_INTERVAL) == Err(RecvTimeoutError::Timeout) {
                eprintln!("cable: no resting place yet after {:.0} s (Ctrl+C ends)", began.elapsed().as_secs_f64());
            }
        };
        let thread = std::thread::Builder::new().name("waiting".to_owned()).spawn(tell);
        Self { _end: thread.is_ok().then_some(end) }
    }
}
