//! A solve cannot be stopped from outside. Where a later edit, an undo or the user does not want to
//! wait for it, its thread is abandoned: another one goes on from where the engine was before that
//! solve, and what the first one finds is dropped.

use std::time::Duration;

use crate::worker::engine::Engine;
use crate::worker::slots::{Slots, Solve};

/// Time (s) that a request waits for a solve that it makes worthless. Shorter: a drag restarts
/// solves that would have been in the next frames; longer: an undo is felt to hang.
const GIVE_UP_AFTER: Duration = Duration::from_millis(40);
/// Most threads with the window's own handle counted: more would share the processor with the one
/// that is listened to.
const MAX_THREADS: usize = 6;

/// The time that a request waits for a solve that it makes worthless.
pub struct AbandonTimeout {
    wait: Duration,
    /// Reports when it was last set.
    reports: u64,
}

impl Default for AbandonTimeout {
    fn default() -> Self {
        Self { wait: GIVE_UP_AFTER, reports: 0 }
    }
}

/// Takes out the solve that runs if nobody waits for it any more, or the user has cancelled it, and
/// puts its request before the waiting one: returns the engine as it was before, and the number of
/// the thread that goes on with it. `threads` counts those that run, and the window.
pub fn take_superseded(
    slots: &mut Slots,
    abandon_timeout: &mut AbandonTimeout,
    threads: usize,
) -> Option<(Box<Engine>, u64)> {
    if abandon_timeout.reports != slots.reports {
        *abandon_timeout = AbandonTimeout { wait: GIVE_UP_AFTER, reports: slots.reports };
    }
    let asked_at = slots.asked_at?;
    let waiting = slots.request.as_ref().filter(|r| r.solves() || r.cancel)?;
    // The next draft goes on from the one on screen: its answer may be given up at once, and so
    // may other histories of a scene that has changed.
    let refines = slots.solve.as_ref().is_some_and(|s| s.request.is_none());
    let wait = if waiting.cancel || refines { Duration::ZERO } else { abandon_timeout.wait };
    let old = slots.solve.as_ref().is_some_and(|s| s.began.elapsed() >= wait);
    if !old || asked_at.elapsed() < wait || threads > MAX_THREADS {
        return None;
    }
    let Solve { engine, request, .. } = slots.solve.take()?;
    // Twice as long each time: a hand that never rests must not keep every answer from coming.
    abandon_timeout.wait *= 2;
    slots.thread += 1;
    let waiting = slots.request.take();
    slots.request = match (request, waiting) {
        (Some(mut first), Some(then)) => {
            first.merge(then);
            Some(first)
        }
        (first, then) => first.or(then),
    };
    Some((engine, slots.thread))
}
