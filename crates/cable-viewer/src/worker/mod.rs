//! The worker is the thread that owns the simulation, so that the window never waits for physics.
//!
//! Both ways hold one slot, not a queue: requests merge into the waiting one, the latest answer
//! replaces the one not yet shown, so memory and delay are bounded whatever the pointer does.
//!
//! - `engine`: the simulation, requests and time, without threads
//! - `solver_thread`: the loop of the thread
//! - `slots`: the request, the answer and the solve that window and thread share
//! - `superseded_solve`: the solve that nobody waits for any more, and its abandoned thread
//! - `shape_as_route`: the shape of a cable as a route of the scene
//! - `winding_number`: whether a cable passed an obstacle
//! - `request`: what the window asks
//! - `draft`: coarse answers that follow the hand
//! - `timing`: frames, drafts and bounds

pub mod draft;
pub mod engine;
pub mod request;
mod shape_as_route;
mod slots;
mod solver_thread;
mod superseded_solve;
pub mod timing;
mod winding_number;

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use crate::state::WorkerStatus;
use crate::worker::engine::{Engine, Report};
use crate::worker::request::Request;
use crate::worker::slots::{Shared, keep};
use crate::worker::solver_thread::{UpdateCallback, catch_panic, start};
use crate::worker::superseded_solve::{AbandonTimeout, take_superseded};

/// The end of the worker that the window holds.
pub struct Worker {
    kind: Backend,
}

enum Backend {
    Thread {
        shared: Arc<Shared>,
        shown: UpdateCallback,
        handle: Option<JoinHandle<()>>,
        abandon_timeout: AbandonTimeout,
    },
    Inline {
        engine: Box<Engine>,
        report: Option<Report>,
    },
}

impl Worker {
    /// Starts the thread; `shown` is called whenever there is something new to show.
    #[must_use]
    pub fn thread(shown: impl Fn() + Send + Sync + 'static) -> Self {
        let (shared, shown): (_, UpdateCallback) = (Arc::new(Shared::default()), Arc::new(shown));
        let handle = start(&shared, &shown, Engine::with_drafts(), 0);
        Self { kind: Backend::Thread { shared, shown, handle, abandon_timeout: AbandonTimeout::default() } }
    }

    /// Does the work in [`Self::submit`] and [`Self::poll`] themselves, for tests and still
    /// pictures.
    #[must_use]
    pub fn inline() -> Self {
        Self { kind: Backend::Inline { engine: Box::default(), report: None } }
    }

    /// Submits a request; it never waits for the answer.
    pub fn submit(&mut self, request: Request) {
        match &mut self.kind {
            Backend::Thread { shared, .. } => {
                let mut slots = shared.lock();
                let mut request = request;
                // An edit that comes while other histories are sought has waited for no answer.
                let answers = slots.solve.as_ref().is_some_and(|s| !s.seeks_histories);
                request.came_during_solve = request.edit.is_some() && answers;
                slots.asked_at.get_or_insert_with(Instant::now);
                slots.last_asked_at = Some(Instant::now());
                match &mut slots.request {
                    Some(waiting) => waiting.merge(request),
                    None => slots.request = Some(request),
                }
                drop(slots);
                // Threads that have been given up may sleep here too.
                shared.wake.notify_all();
                self.abandon_superseded_solve();
            }
            Backend::Inline { engine, report } => keep(report, catch_panic(engine, |e| e.handle(request))),
        }
    }

    /// Returns what is new since the last call. Inline: lets one frame pass first if time runs.
    pub fn poll(&mut self) -> Option<Report> {
        self.abandon_superseded_solve();
        match &mut self.kind {
            Backend::Thread { shared, .. } => shared.lock().report.take(),
            Backend::Inline { engine, report } => {
                if engine.playing() {
                    keep(report, catch_panic(engine, Engine::advance_frame));
                }
                report.take()
            }
        }
    }

    /// Abandons the thread of a solve that nobody waits for any more, and starts another; to be
    /// called often.
    fn abandon_superseded_solve(&mut self) {
        let Backend::Thread { shared, shown, handle, abandon_timeout } = &mut self.kind else { return };
        let taken = take_superseded(&mut shared.lock(), abandon_timeout, Arc::strong_count(shared));
        if let Some((engine, thread)) = taken {
            *handle = start(shared, shown, *engine, thread);
        }
    }

    /// Number of solves that were given up.
    #[must_use]
    pub fn abandoned_solves(&self) -> u64 {
        match &self.kind {
            Backend::Thread { shared, .. } => shared.lock().thread,
            Backend::Inline { .. } => 0,
        }
    }

    /// Returns whether a solve has been running for longer than this.
    #[must_use]
    pub fn solves_for(&self, time: std::time::Duration) -> bool {
        match &self.kind {
            Backend::Thread { shared, .. } => shared.lock().solve.as_ref().is_some_and(|s| s.began.elapsed() > time),
            Backend::Inline { .. } => false,
        }
    }

    /// Returns how it is doing.
    #[must_use]
    pub fn status(&self) -> WorkerStatus {
        match &self.kind {
            Backend::Inline { .. } => WorkerStatus::Idle,
            Backend::Thread { shared, handle, .. } => match handle {
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
        if let Backend::Thread { shared, .. } = &self.kind {
            // Not joined: a long solve must not keep the window from closing.
            shared.lock().stop = true;
            shared.wake.notify_all();
        }
    }
}
