//! The thread solves what is requested, lets frames pass while time runs, and refines drafts once
//! the hand rests.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::worker::engine::{Engine, Report};
use crate::worker::request::Request;
use crate::worker::slots::{Shared, Solve, keep};
use crate::worker::timing::{FRAME_S, IDLE_EDIT_INTERVALS, IDLE_S, MIN_IDLE_S};

/// Called whenever there is something new to show.
pub type UpdateCallback = Arc<dyn Fn() + Send + Sync>;

/// Least share of a frame that a drag lets pass at once. Smaller: many readings of single steps for
/// a quick mouse; larger: the hand waits.
const MIN_FRAME_FRACTION: f64 = 0.4;

/// Starts a thread; `thread` is its number.
pub fn start(shared: &Arc<Shared>, shown: &UpdateCallback, engine: Engine, thread: u64) -> Option<JoinHandle<()>> {
    let (shared, shown) = (Arc::clone(shared), Arc::clone(shown));
    let run = move || work(&shared, &*shown, engine, thread);
    std::thread::Builder::new().name("cable solver".to_owned()).spawn(run).ok()
}

/// The loop of the thread: waits for requests, solves, and publishes reports.
fn work(shared: &Shared, shown: &dyn Fn(), mut engine: Engine, thread: u64) {
    let mut schedule = Schedule::new();
    loop {
        let Ok(request) = wait_for_work(shared, &engine, thread, &schedule) else { return };
        let refines =
            request.is_none() && !engine.playing() && (!engine.settling() || Instant::now() >= schedule.refine_at);
        if refines || request.as_ref().is_some_and(Request::solves) {
            let seeks_histories = request.is_none() && engine.seeks_histories();
            let (began, engine) = (Instant::now(), Box::new(engine.checkpoint()));
            let solve = Solve { began, engine, request: request.clone(), seeks_histories };
            shared.lock().solve = Some(solve);
        }
        let report = match request {
            Some(request) => answer(&mut engine, request, &mut schedule),
            None => go_on(&mut engine, &mut schedule),
        };
        let mut slots = shared.lock();
        if slots.thread != thread {
            return;
        }
        slots.solve = None;
        slots.reports += 1;
        keep(&mut slots.report, report);
        drop(slots);
        shown();
    }
}

/// The times at which work of the engine is due.
struct Schedule {
    /// The next frame of time that runs, or of a draft.
    next_tick: Instant,
    /// The frame before.
    last_tick: Instant,
    /// A draft is replaced by the answer, and an answer is asked for other histories.
    refine_at: Instant,
    /// The last edit came.
    edited_at: Option<Instant>,
}

impl Schedule {
    fn new() -> Self {
        let now = Instant::now();
        Self { next_tick: now, last_tick: now, refine_at: now, edited_at: None }
    }
}

/// Answers a request.
fn answer(engine: &mut Engine, request: Request, schedule: &mut Schedule) -> Report {
    let drag = request.drag.is_some();
    // A single edit is answered at once, a hand that goes on is waited for.
    let draft_s = if engine.draft() || request.came_during_solve {
        let between = schedule.edited_at.map_or(IDLE_S, |at| at.elapsed().as_secs_f64());
        (IDLE_EDIT_INTERVALS * between).clamp(MIN_IDLE_S, IDLE_S)
    } else {
        0.0
    };
    if request.edit.is_some() {
        schedule.edited_at = Some(Instant::now());
    }
    let mut report = catch_panic(engine, |e| e.handle(request));
    let passed = schedule.last_tick.elapsed().as_secs_f64() / FRAME_S;
    if drag && engine.playing() && passed > MIN_FRAME_FRACTION {
        // The hand does not wait for the next frame: what has passed of this one is let pass.
        schedule.last_tick = Instant::now();
        schedule.next_tick = schedule.last_tick + frame();
        report.merge(catch_panic(engine, |e| e.advance_part_of_frame(passed)));
    }
    let pause_s = if engine.draft() { draft_s } else { MIN_IDLE_S };
    schedule.refine_at = Instant::now() + Duration::from_secs_f64(pause_s);
    if engine.draft() {
        schedule.next_tick = Instant::now() + frame();
    }
    report
}

/// Does what is due without a request: a frame of a draft, the answer that replaces it, or a frame
/// of time that runs.
fn go_on(engine: &mut Engine, schedule: &mut Schedule) -> Report {
    if engine.playing() {
        // A late frame is not made up for: time runs slower instead of falling behind for ever.
        schedule.last_tick = Instant::now();
        schedule.next_tick = schedule.last_tick.max(schedule.next_tick + frame());
        catch_panic(engine, Engine::advance_frame)
    } else if engine.settling() && Instant::now() < schedule.refine_at {
        schedule.next_tick = Instant::now() + frame();
        catch_panic(engine, Engine::settle_frame)
    } else {
        catch_panic(engine, Engine::refine)
    }
}

fn frame() -> Duration {
    Duration::from_secs_f64(FRAME_S)
}

/// The thread has to end: the window closes, or another thread has taken its place.
struct Stopped;

/// Waits until there is a request, or until work of the engine is due: a frame, or the answer that
/// replaces a draft. Returns the request, if there is one.
fn wait_for_work(
    shared: &Shared,
    engine: &Engine,
    thread: u64,
    &Schedule { next_tick, refine_at, .. }: &Schedule,
) -> Result<Option<Request>, Stopped> {
    let mut slots = shared.lock();
    if slots.thread == thread {
        slots.busy = engine.draft();
    }
    loop {
        if slots.stop || slots.thread != thread {
            return Err(Stopped);
        }
        let now = Instant::now();
        let due = match (engine.playing(), engine.draft(), engine.settling()) {
            (true, _, _) => Some(next_tick),
            (false, true, true) => Some(next_tick.min(refine_at)),
            (false, true, false) => Some(refine_at),
            (false, false, _) => engine.seeks_histories().then_some(refine_at),
        };
        if slots.request.is_some() || due.is_some_and(|at| now >= at) {
            break;
        }
        slots = match due {
            Some(at) => {
                let wait = shared.wake.wait_timeout(slots, at.saturating_duration_since(now));
                wait.unwrap_or_else(PoisonError::into_inner).0
            }
            None => shared.wake.wait(slots).unwrap_or_else(PoisonError::into_inner),
        };
    }
    slots.busy = slots.request.is_some() || engine.draft();
    slots.asked_at = None;
    Ok(slots.request.take())
}

/// Runs a job; a panic inside becomes a report with its words.
pub fn catch_panic(engine: &mut Engine, job: impl FnOnce(&mut Engine) -> Report) -> Report {
    match catch_unwind(AssertUnwindSafe(|| job(engine))) {
        Ok(report) => report,
        Err(payload) => {
            let message = payload
                .downcast_ref::<&str>()
                .map(|s| (*s).to_owned())
                .or_else(|| payload.downcast_ref::<String>().cloned())
                .unwrap_or_else(|| "no message".to_owned());
            engine.abandon(&message)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_in_the_solver_is_caught_and_said() {
        let mut engine = Engine::default();
        let report = catch_panic(&mut engine, |_| std::panic::panic_any("index out of bounds"));
        assert!(report.snapshot.stale && report.paused_itself);
        assert!(report.snapshot.error.is_some_and(|e| e.to_string().contains("index out of bounds")));
        // It goes on with the next request.
        let report = catch_panic(&mut engine, |e| e.handle(Request { reset: true, number: 3, ..Request::default() }));
        assert_eq!(report.snapshot.edit, 3);
    }
}
