//! While an answer takes long, a line on the terminal says so.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

/// Says on a terminal, every few seconds, that there is no answer yet.
pub struct WaitingNotice {
    /// Dropped at the end, which ends the thread that listens.
    _end: Option<Sender<()>>,
}

impl WaitingNotice {
    /// Between two lines: shorter bothers, longer leaves a user alone.
    const NOTICE_INTERVAL: Duration = Duration::from_secs(3);

    /// Begins to wait, until this is dropped.
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
        let told = std::thread::Builder::new().name("waiting".to_owned()).spawn(tell);
        Self { _end: told.is_ok().then_some(end) }
    }
}
