//! What neglecting the bending stiffness of cables changes, computed beside the window when it is asked for.

use std::sync::Arc;

use cable_core::summary::{NeglectedBending, neglected_bending};
use cable_core::{Scene, Settings, Solution};

use crate::jobs::background;

/// One a cable that is likely to be stiff and was answered without it.
pub type Found = Arc<Vec<NeglectedBending>>;
/// How far it is.
pub type Progress = background::Progress<Found>;

/// The question: of which answer.
#[derive(Clone, Debug)]
pub struct Ask {
    /// The scene of the answer.
    pub scene: Arc<Scene>,
    /// Mesh and accuracy.
    pub settings: Settings,
    /// The answer.
    pub answer: Arc<Solution>,
}

/// What was asked last, and what came of it.
#[derive(Clone, Debug, Default)]
pub struct View {
    /// The question; None: nothing was asked of what is on screen.
    pub ask: Option<Ask>,
    /// How far it is.
    pub progress: Progress,
}

/// It, while it is computed.
#[derive(Debug)]
pub struct Job {
    job: background::Job<Found>,
    answer: Arc<Solution>,
}

impl Job {
    /// Starts it; `shown` is called when there is something new to show.
    #[must_use]
    pub fn start(ask: Ask, shown: impl Fn() + Send + 'static) -> Self {
        let answer = Arc::clone(&ask.answer);
        let work = move |_: background::Heard<'_, Found>| {
            Ok(Arc::new(neglected_bending(&ask.scene, &ask.answer, ask.settings)))
        };
        Self { job: background::Job::start("bending stiffness", work, shown), answer }
    }

    /// Whether it is this question that it answers.
    #[must_use]
    pub fn is_of(&self, ask: &Ask) -> bool {
        Arc::ptr_eq(&self.answer, &ask.answer)
    }

    /// How far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.job.progress()
    }
}
