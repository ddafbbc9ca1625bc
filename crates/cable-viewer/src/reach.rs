//! The map of where the robot can go, computed beside the window: a thread of its own, its progress, and its end on request.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use cable_core::robot::reach::{self, Map};
use cable_core::{Scene, Settings};

/// Places looked at. More: finer and, with the way back from each, slower by the square; fewer: mounds fall between them.
pub const PLACES: usize = 41;

/// What the map asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The scene.
    pub scene: Scene,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// From where to where, m.
    pub ends_m: [f64; 2],
}

/// How far it is.
#[derive(Clone, Debug, Default)]
pub enum Progress {
    /// Nothing was asked.
    #[default]
    None,
    /// Share done, 0 to 1.
    Running(f64),
    /// The map, and the scene it is of.
    Done(Arc<Map>, Arc<Scene>),
    /// Why there is none.
    Failed(String),
}

/// A map being computed.
#[derive(Debug)]
pub struct Job {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    progress: Mutex<Progress>,
    cancelled: AtomicBool,
}

impl Shared {
    fn set(&self, progress: Progress) {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner) = progress;
    }
}

impl Job {
    /// Starts one; `shown` is called whenever there is something new to show.
    #[must_use]
    pub fn start(order: Order, shown: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        shared.set(Progress::Running(0.0));
        let theirs = Arc::clone(&shared);
        let work = move || {
            work(&theirs, &order, &shown);
            shown();
        };
        if std::thread::Builder::new().name("safe reach".to_owned()).spawn(work).is_err() {
            shared.set(Progress::Failed("no thread could be started for it".to_owned()));
        }
        Self { shared }
    }

    /// How far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.shared.progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Drop for Job {
    /// Not joined: it ends at its next place.
    fn drop(&mut self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }
}

fn work(shared: &Shared, order: &Order, shown: &impl Fn()) {
    let heard = |share: f64| {
        if shared.cancelled.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        shared.set(Progress::Running(share));
        shown();
        ControlFlow::Continue(())
    };
    let job = || reach::reach(&order.scene, order.settings, (order.ends_m, PLACES), heard);
    shared.set(match catch_unwind(AssertUnwindSafe(job)) {
        Ok(Ok(map)) => Progress::Done(Arc::new(map), Arc::new(order.scene.clone())),
        Ok(Err(e)) => Progress::Failed(e.to_string()),
        Err(_) => Progress::Failed("the solver stopped by a fault of its own".to_owned()),
    });
}
