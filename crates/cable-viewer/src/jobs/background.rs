//! A job runs a long computation on its own thread, beside the window, and ends on request.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// The progress of a job.
#[derive(Clone, Debug, Default)]
pub enum Progress<T> {
    /// Nothing was asked.
    #[default]
    None,
    /// Share done, 0 to 1, and what is known so far, where that can be shown.
    Running(f64, Option<T>),
    /// The result.
    Done(T),
    /// The reason why there is no result.
    Failed(String),
}

/// A function that is told the share done, 0 to 1, and the results so far, and returns whether the
/// job goes on.
pub type Listener<'a, T> = &'a mut dyn FnMut(f64, Option<T>) -> ControlFlow<()>;

/// A running job. If it is dropped, the job ends at its next report of progress.
#[derive(Debug)]
pub struct Job<T> {
    shared: Arc<SharedProgress<T>>,
}

#[derive(Debug)]
struct SharedProgress<T> {
    progress: Mutex<Progress<T>>,
    cancelled: AtomicBool,
}

impl<T> SharedProgress<T> {
    fn set(&self, progress: Progress<T>) {
        *self.progress.lock().unwrap_or_else(PoisonError::into_inner) = progress;
    }
}

impl<T: Clone + Send + 'static> Job<T> {
    /// Starts the job on a thread of this name; `shown` is called whenever there is a new result to
    /// show.
    #[must_use]
    pub fn start(
        name: &str,
        work: impl FnOnce(Listener<'_, T>) -> Result<T, String> + Send + 'static,
        shown: impl Fn() + Send + 'static,
    ) -> Self {
        let (progress, cancelled) = (Mutex::new(Progress::Running(0.0, None)), AtomicBool::new(false));
        let shared = Arc::new(SharedProgress { progress, cancelled });
        let theirs = Arc::clone(&shared);
        let job = move || {
            let mut listen = |share: f64, so_far: Option<T>| {
                if theirs.cancelled.load(Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                theirs.set(Progress::Running(share, so_far));
                shown();
                ControlFlow::Continue(())
            };
            let result = catch_unwind(AssertUnwindSafe(|| work(&mut listen)));
            theirs.set(match result {
                Ok(Ok(done)) => Progress::Done(done),
                Ok(Err(why)) => Progress::Failed(why),
                Err(_) => Progress::Failed("the solver stopped by a fault of its own".to_owned()),
            });
            shown();
        };
        if std::thread::Builder::new().name(name.to_owned()).spawn(job).is_err() {
            shared.set(Progress::Failed("no thread could be started for it".to_owned()));
        }
        Self { shared }
    }

    /// Returns how far it is.
    #[must_use]
    pub fn progress(&self) -> Progress<T> {
        self.shared.progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl<T> Drop for Job<T> {
    /// The thread is not joined: it ends at its next report of progress.
    fn drop(&mut self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }
}
