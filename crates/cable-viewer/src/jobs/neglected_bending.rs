//! A job computes on request how neglected bending stiffness changes an answer.

use std::sync::Arc;

use cable_core::analysis::{NeglectedBending, neglected_bending};
use cable_core::{Scene, Settings, Solution};

use crate::jobs::background;

/// One result for each cable that is likely to be stiff and was answered without bending stiffness.
pub type Outcome = Arc<Vec<NeglectedBending>>;
/// Its progress.
pub type Progress = background::Progress<Outcome>;

/// The answer that the question is about.
#[derive(Clone, Debug)]
pub struct Query {
    /// The scene of the answer.
    pub scene: Arc<Scene>,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// The answer.
    pub answer: Arc<Solution>,
}

/// The last question and its result.
#[derive(Clone, Debug, Default)]
pub struct NeglectedBendingState {
    /// The question; None: nothing was asked of what is on screen.
    pub query: Option<Query>,
    /// Its progress.
    pub progress: Progress,
}

/// A running job.
#[derive(Debug)]
pub struct NeglectedBendingJob {
    job: background::Job<Outcome>,
    answer: Arc<Solution>,
}

impl NeglectedBendingJob {
    /// Starts the job; `shown` is called when there is something new to show.
    #[must_use]
    pub fn start(query: Query, shown: impl Fn() + Send + 'static) -> Self {
        let answer = Arc::clone(&query.answer);
        let work = move |_: background::Listener<'_, Outcome>| {
            Ok(Arc::new(neglected_bending(&query.scene, &query.answer, query.settings)))
        };
        Self { job: background::Job::start("bending stiffness", work, shown), answer }
    }

    /// Returns true if the job answers this question.
    #[must_use]
    pub fn is_of(&self, query: &Query) -> bool {
        Arc::ptr_eq(&self.answer, &query.answer)
    }

    /// Returns how far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.job.progress()
    }
}
