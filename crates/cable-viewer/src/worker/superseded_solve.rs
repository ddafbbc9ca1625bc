//! A solve cannot be stopped from outside. If a later edit, an undo or the user makes it worthless,
//! its thread is abandoned: another thread goes on from the engine before that solve, and the
//! result of the first one is dropped.

use std::time::Duration;

use crate::worker::engine::Engine;
use crate::worker::slots::{Slots, Solve};

/// Time (s) that a request waits for a solve that it makes worthless, and the least age of a solve
/// that an undo gives up. Shorter: a drag restarts solves that would have been in the next frames;
/// longer: an undo is felt to hang.
const GIVE_UP_AFTER: Duration = Duration::from_millis(40);
/// Time without a further edit (s) after which a hand counts as resting: no solve of before is
/// waited for any longer. Shorter: a hand whose frames are slow rests between two of them; longer:
/// a typed value is felt to hang.
const HAND_RESTS_AFTER: Duration = Duration::from_millis(80);
/// Most threads with the window's own handle counted: more would share the processor with the one
/// that is listened to.
const MAX_THREADS: usize = 6;
/// The same where the user asks for an undo or cancels: these are not to hang because edits have
/// abandoned as many solves as they may.
const MAX_THREADS_AT_ONCE: usize = 16;

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
    let solve = slots.solve.as_ref()?;
    // The next draft goes on from the one on screen: its answer may be given up at once, and so
    // may other histories of a scene that has changed.
    let at_once = waiting.cancel || solve.request.is_none();
    let rests = slots.last_asked_at.is_some_and(|at| at.elapsed() >= HAND_RESTS_AFTER);
    let due = if at_once {
        true
    } else if waiting.goes_back() {
        solve.began.elapsed() >= GIVE_UP_AFTER
    } else {
        solve.began.elapsed().min(asked_at.elapsed()) >= abandon_timeout.wait || rests
    };
    let most = if waiting.cancel || waiting.goes_back() { MAX_THREADS_AT_ONCE } else { MAX_THREADS };
    if !due || threads > most {
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

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::worker::request::{Edit, EditStart, Request};

    fn edit(start: EditStart) -> Request {
        let scene = cable_core::scene::catalog::hanging_span();
        let (model, settings) = (cable_core::Model::Auto, cable_core::Settings::default());
        let edit = Edit { scene, model, settings, start };
        Request { edit: Some(edit), ..Request::default() }
    }

    /// A solve that has run for a second, and what was asked for milliseconds before.
    fn slots(waiting: Request, [first_ms, last_ms]: [u64; 2]) -> Slots {
        let before = |ms: u64| Instant::now().checked_sub(Duration::from_millis(ms)).unwrap();
        Slots {
            request: Some(waiting),
            asked_at: Some(before(first_ms)),
            last_asked_at: Some(before(last_ms)),
            solve: Some(Solve {
                began: before(1000),
                engine: Box::default(),
                request: Some(edit(EditStart::PresentState)),
                seeks_histories: false,
            }),
            ..Slots::default()
        }
    }

    /// A hand that went on for long waits seconds; an undo, a cancel and a single edit do not.
    #[test]
    fn undo_cancel_and_a_resting_hand_never_wait_for_more_than_a_tenth_of_a_second() {
        let tired = || AbandonTimeout { wait: Duration::from_secs(3), reports: 0 };
        let given_up = |waiting: Request, asked_ms: [u64; 2], threads: usize| {
            take_superseded(&mut slots(waiting, asked_ms), &mut tired(), threads).is_some()
        };
        let cancel = || Request { cancel: true, ..Request::default() };
        for (waiting, asked_ms) in [
            (edit(EditStart::Route), [0, 0]),
            (cancel(), [0, 0]),
            (Request { reset: true, ..Request::default() }, [0, 0]),
            (edit(EditStart::PresentState), [100, 100]),
            (edit(EditStart::PresentState), [2000, 100]),
        ] {
            assert!(given_up(waiting.clone(), asked_ms, 2), "{waiting:?}");
        }
        assert!(!given_up(edit(EditStart::PresentState), [2000, 10], 2), "a hand that goes on has answers in between");
        // Abandoned threads are bounded, and the bound of edits is not that of an undo.
        assert!(
            given_up(edit(EditStart::Route), [0, 0], MAX_THREADS + 1) && given_up(cancel(), [0, 0], MAX_THREADS + 1)
        );
        assert!(!given_up(edit(EditStart::PresentState), [2000, 100], MAX_THREADS + 1));
        assert!(!given_up(edit(EditStart::Route), [0, 0], MAX_THREADS_AT_ONCE + 1));
    }
}
