//! Window and thread share one slot for a request, one for the answer, and the solve that runs.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use crate::worker::engine::{Engine, Report};
use crate::worker::request::Request;
use crate::worker::timing::MAX_ANSWERS;

/// The slots that window and thread share.
#[derive(Default)]
pub struct Shared {
    pub slots: Mutex<Slots>,
    pub wake: Condvar,
}

/// One request, one answer and one solve.
#[derive(Default)]
pub struct Slots {
    pub request: Option<Request>,
    /// The time when the waiting request came.
    pub asked_at: Option<Instant>,
    /// The time when the last request was merged into it.
    pub last_asked_at: Option<Instant>,
    pub report: Option<Report>,
    pub busy: bool,
    pub stop: bool,
    /// The running solve, where it may be given up.
    pub solve: Option<Solve>,
    /// Number of the thread that is listened to; the others have been given up.
    pub thread: u64,
    /// Reports so far: a solve that ends starts the time to its abandonment anew.
    pub reports: u64,
}

/// A solve that may be given up.
pub struct Solve {
    pub began: Instant,
    /// The engine as it was before.
    pub engine: Box<Engine>,
    /// What it solves; None: the answer to a draft, or other histories of an answer.
    pub request: Option<Request>,
    /// It seeks other histories of an answer that is on screen.
    pub seeks_histories: bool,
}

impl Shared {
    /// A panic is caught outside the lock, so a poisoned lock still guards whole values.
    pub fn lock(&self) -> MutexGuard<'_, Slots> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Report {
    /// Takes in a later report that overtook this one.
    pub fn merge(&mut self, later: Self) {
        self.snapshot = later.snapshot;
        self.paused_itself |= later.paused_itself;
        if later.history_restarts {
            self.history_restarts = true;
            self.answers.clear();
        }
        self.answers.extend(later.answers);
        self.routes = later.routes;
        let excess = self.answers.len().saturating_sub(MAX_ANSWERS);
        self.answers.drain(..excess);
    }
}

/// Puts a report into its slot, with the one that waits there.
pub fn keep(slot: &mut Option<Report>, report: Report) {
    match slot {
        Some(waiting) => waiting.merge(report),
        None => *slot = Some(report),
    }
}
