//! The worker is the thread that owns the simulation, so that the window never waits for physics.
//!
//! Both ways hold one slot, not a queue: requests merge into the waiting one, the latest answer
//! replaces the one not yet shown, so memory and delay are bounded whatever the pointer does.
//!
//! A solve cannot be stopped from outside. Where a later edit, an undo or the user does not want to
//! wait for it, its thread is given up: another one goes on from where the engine was before that
//! solve, and what the first one finds is dropped.
//!
//! - `engine`: the simulation, requests and time, without threads
//! - `passing`: whether a cable passed an obstacle
//! - `request`: what the window asks
//! - `draft`: coarse answers that follow the hand
//! - `timing`: frames, drafts and bounds

pub mod draft;
pub mod engine;
mod passing;
pub mod request;
pub mod timing;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::state::WorkerStatus;
use crate::worker::engine::{Engine, Report};
use crate::worker::request::Request;
use crate::worker::timing::{FRAME_S, LEAST_QUIET_S, MAX_ANSWERS, QUIET_EDITS, QUIET_S};

/// The window's end.
pub struct Worker {
    kind: Kind,
}

/// Called whenever there is something new to show.
type Shown = Arc<dyn Fn() + Send + Sync>;

enum Kind {
    Thread { shared: Arc<Shared>, shown: Shown, handle: Option<JoinHandle<()>>, patience: Patience },
    Inline { engine: Box<Engine>, report: Option<Report> },
}

#[derive(Default)]
struct Shared {
    slots: Mutex<Slots>,
    wake: Condvar,
}

#[derive(Default)]
struct Slots {
    request: Option<Request>,
    /// When the waiting request came.
    asked_at: Option<Instant>,
    report: Option<Report>,
    busy: bool,
    stop: bool,
    /// What is being solved, where it may be given up.
    solve: Option<Solve>,
    /// Number of the thread that is listened to; the others have been given up.
    thread: u64,
    /// Reports so far: a solve that ends resets the patience.
    reports: u64,
}

/// A solve that may be given up.
struct Solve {
    began: Instant,
    /// The engine as it was before.
    engine: Box<Engine>,
    /// What it solves; None: the answer to a draft, or other histories of an answer.
    request: Option<Request>,
    /// It seeks other histories of an answer that is on screen.
    seeks_histories: bool,
}

/// How long a request waits for a solve that it makes worthless.
struct Patience {
    wait: Duration,
    /// Reports when it was last set.
    reports: u64,
}

impl Default for Patience {
    fn default() -> Self {
        Self { wait: GIVE_UP_AFTER, reports: 0 }
    }
}

impl Shared {
    /// A panic is caught outside the lock, so a poisoned lock still guards whole values.
    fn lock(&self) -> MutexGuard<'_, Slots> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Report {
    /// Takes in a later report that overtook this one.
    fn merge(&mut self, later: Self) {
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

impl Worker {
    /// Starts the thread; `shown` is called whenever there is something new to show.
    #[must_use]
    pub fn thread(shown: impl Fn() + Send + Sync + 'static) -> Self {
        let (shared, shown): (_, Shown) = (Arc::new(Shared::default()), Arc::new(shown));
        let handle = start(&shared, &shown, Engine::with_drafts(), 0);
        Self { kind: Kind::Thread { shared, shown, handle, patience: Patience::default() } }
    }

    /// Does the work in [`Self::submit`] and [`Self::poll`] themselves, for tests and still
    /// pictures.
    #[must_use]
    pub fn inline() -> Self {
        Self { kind: Kind::Inline { engine: Box::default(), report: None } }
    }

    /// Asks; never waits for the answer.
    pub fn submit(&mut self, request: Request) {
        match &mut self.kind {
            Kind::Thread { shared, .. } => {
                let mut slots = shared.lock();
                let mut request = request;
                // An edit that comes while other histories are sought has waited for no answer.
                let answers = slots.solve.as_ref().is_some_and(|s| !s.seeks_histories);
                request.hurried = request.edit.is_some() && answers;
                slots.asked_at.get_or_insert_with(Instant::now);
                match &mut slots.request {
                    Some(waiting) => waiting.merge(request),
                    None => slots.request = Some(request),
                }
                drop(slots);
                // Threads that have been given up may sleep here too.
                shared.wake.notify_all();
                self.give_up_what_is_worthless();
            }
            Kind::Inline { engine, report } => keep(report, guarded(engine, |e| e.handle(request))),
        }
    }

    /// What is new since the last call. Inline: lets one frame pass first if time runs.
    pub fn poll(&mut self) -> Option<Report> {
        self.give_up_what_is_worthless();
        match &mut self.kind {
            Kind::Thread { shared, .. } => shared.lock().report.take(),
            Kind::Inline { engine, report } => {
                if engine.playing() {
                    keep(report, guarded(engine, Engine::tick));
                }
                report.take()
            }
        }
    }

    /// Gives up a solve that nobody waits for any more, or that the user has cancelled; to be
    /// called often.
    fn give_up_what_is_worthless(&mut self) {
        let Kind::Thread { shared, shown, handle, patience } = &mut self.kind else { return };
        let mut slots = shared.lock();
        if patience.reports != slots.reports {
            *patience = Patience { wait: GIVE_UP_AFTER, reports: slots.reports };
        }
        let Some(asked_at) = slots.asked_at else { return };
        let Some(waiting) = slots.request.as_ref().filter(|r| r.solves() || r.cancel) else { return };
        // The next draft goes on from the one on screen: its answer may be given up at once, and so
        // may other histories of a scene that has changed.
        let refines = slots.solve.as_ref().is_some_and(|s| s.request.is_none());
        let wait = if waiting.cancel || refines { Duration::ZERO } else { patience.wait };
        let old = slots.solve.as_ref().is_some_and(|s| s.began.elapsed() >= wait);
        if !old || asked_at.elapsed() < wait || Arc::strong_count(shared) > MAX_THREADS {
            return;
        }
        let Some(Solve { engine, request, .. }) = slots.solve.take() else { return };
        // Twice as long each time: a hand that never rests must not keep every answer from coming.
        patience.wait *= 2;
        slots.thread += 1;
        let waiting = slots.request.take();
        slots.request = match (request, waiting) {
            (Some(mut first), Some(then)) => {
                first.merge(then);
                Some(first)
            }
            (first, then) => first.or(then),
        };
        let thread = slots.thread;
        drop(slots);
        *handle = start(shared, shown, *engine, thread);
    }

    /// How it is doing.
    #[must_use]
    pub fn status(&self) -> WorkerStatus {
        match &self.kind {
            Kind::Inline { .. } => WorkerStatus::Idle,
            Kind::Thread { shared, handle, .. } => match handle {
                Some(handle) if !handle.is_finished() => {
                    let slots = shared.lock();
                    if slots.busy || slots.request.is_some() { WorkerStatus::Busy } else { WorkerStatus::Idle }
                }
                Some(_) => WorkerStatus::Dead("the solver thread has ended".to_owned()),
                None => WorkerStatus::Dead("the solver thread could not be started".to_owned()),
            },
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        if let Kind::Thread { shared, .. } = &self.kind {
            // Not joined: a long solve must not keep the window from closing.
            shared.lock().stop = true;
            shared.wake.notify_all();
        }
    }
}

fn keep(slot: &mut Option<Report>, report: Report) {
    match slot {
        Some(waiting) => waiting.merge(report),
        None => *slot = Some(report),
    }
}

/// Least share of a frame that a drag lets pass at once. Smaller: many short steps for a quick
/// mouse; larger: the hand waits.
const LEAST_SHARE: f64 = 0.4;

/// Time (s) that a request waits for a solve that it makes worthless. Shorter: a drag restarts
/// solves that would have been in the next frames; longer: an undo is felt to hang.
const GIVE_UP_AFTER: Duration = Duration::from_millis(40);
/// Most threads with the window's own handle counted: more would share the processor with the one
/// that is listened to.
const MAX_THREADS: usize = 6;

fn start(shared: &Arc<Shared>, shown: &Shown, engine: Engine, thread: u64) -> Option<JoinHandle<()>> {
    let (shared, shown) = (Arc::clone(shared), Arc::clone(shown));
    let run = move || work(&shared, &*shown, engine, thread);
    std::thread::Builder::new().name("cable solver".to_owned()).spawn(run).ok()
}

fn work(shared: &Shared, shown: &dyn Fn(), mut engine: Engine, thread: u64) {
    let frame = Duration::from_secs_f64(FRAME_S);
    let mut next_tick = Instant::now();
    let mut last_tick = next_tick;
    // When a draft has stood long enough to be replaced by the answer, and an answer to be asked
    // for other histories.
    let mut refine_at = next_tick;
    let mut edited_at: Option<Instant> = None;
    loop {
        let request = {
            let mut slots = shared.lock();
            if slots.thread == thread {
                slots.busy = engine.draft();
            }
            loop {
                if slots.stop || slots.thread != thread {
                    return;
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
            slots.request.take()
        };
        let refines = request.is_none() && !engine.playing() && (!engine.settling() || Instant::now() >= refine_at);
        if refines || request.as_ref().is_some_and(Request::solves) {
            let seeks_histories = request.is_none() && engine.seeks_histories();
            let (began, engine) = (Instant::now(), Box::new(engine.spare()));
            let solve = Solve { began, engine, request: request.clone(), seeks_histories };
            shared.lock().solve = Some(solve);
        }
        let report = match request {
            Some(request) => {
                let drag = request.drag.is_some();
                // A single edit is answered at once, a hand that goes on is waited for.
                let draft_s = if engine.draft() || request.hurried {
                    let between = edited_at.map_or(QUIET_S, |at| at.elapsed().as_secs_f64());
                    (QUIET_EDITS * between).clamp(LEAST_QUIET_S, QUIET_S)
                } else {
                    0.0
                };
                if request.edit.is_some() {
                    edited_at = Some(Instant::now());
                }
                let mut report = guarded(&mut engine, |e| e.handle(request));
                let passed = last_tick.elapsed().as_secs_f64() / FRAME_S;
                if drag && engine.playing() && passed > LEAST_SHARE {
                    // The hand does not wait for the next frame: what has passed of this one is let
                    // pass.
                    last_tick = Instant::now();
                    next_tick = last_tick + frame;
                    report.merge(guarded(&mut engine, |e| e.tick_part(passed.min(1.0))));
                }
                let pause_s = if engine.draft() { draft_s } else { LEAST_QUIET_S };
                refine_at = Instant::now() + Duration::from_secs_f64(pause_s);
                if engine.draft() {
                    next_tick = Instant::now() + frame;
                }
                report
            }
            None if !engine.playing() && engine.settling() && Instant::now() < refine_at => {
                next_tick = Instant::now() + frame;
                guarded(&mut engine, Engine::settle_frame)
            }
            None if !engine.playing() => guarded(&mut engine, Engine::refine),
            None => {
                // A late frame is not made up for: time runs slower instead of falling behind for
                // ever.
                last_tick = Instant::now();
                next_tick = last_tick.max(next_tick + frame);
                guarded(&mut engine, Engine::tick)
            }
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

/// Runs a job; a panic inside becomes a report with its words.
fn guarded(engine: &mut Engine, job: impl FnOnce(&mut Engine) -> Report) -> Report {
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
        let report = guarded(&mut engine, |_| std::panic::panic_any("index out of bounds"));
        assert!(report.snapshot.stale && report.paused_itself);
        assert!(report.snapshot.error.is_some_and(|e| e.to_string().contains("index out of bounds")));
        // It goes on with the next request.
        let report = guarded(&mut engine, |e| e.handle(Request { reset: true, number: 3, ..Request::default() }));
        assert_eq!(report.snapshot.edit, 3);
    }

    #[test]
    fn later_requests_win_and_steps_are_bounded() {
        let scene = cable_core::scene::catalog::hanging_span();
        let edit = |fresh, name: &str| {
            let mut scene = scene.clone();
            scene.name = name.to_owned();
            let (model, settings) = (cable_core::Model::Auto, cable_core::Settings::default());
            Request {
                edit: Some(request::Edit { scene, model, settings, fresh, as_laid: false }),
                ..Request::default()
            }
        };
        let mut waiting = edit(true, "first");
        for _ in 0..1000 {
            waiting.merge(Request { steps: 1, ..Request::default() });
        }
        waiting.merge(edit(false, "last"));
        let merged = waiting.edit.expect("an edit");
        assert_eq!(merged.scene.name, "last");
        assert!(merged.fresh, "the new scene must not inherit the old one's state");
        assert!(waiting.steps <= 60);
    }
}
