//! The ribbon of less and more friction, computed beside the window whenever scene, model or run have changed.

use std::sync::Arc;

use cable_core::Scene;
use cable_core::spread::{self, Ask, Spread};

use crate::background;
use crate::state::AppState;

/// What was found, and what was asked.
pub type Found = (Arc<Spread>, Arc<Ask>);
/// How far it is.
pub type Progress = background::Progress<Found>;

/// Longest run that is followed, s: three runs of it. Longer: a minute of both cores for a ribbon; shorter: a drive is cut off.
pub const LONGEST_S: f64 = 120.0;

/// Friction that is asked about.
#[derive(Clone, Debug)]
pub struct View {
    /// The ribbon is wanted.
    pub on: bool,
    /// Least and greatest friction over that of the scene.
    pub factors: [f64; 2],
    /// How far it is.
    pub progress: Progress,
}

impl Default for View {
    /// A third less and a third more: handbooks differ by that for rubber on concrete.
    fn default() -> Self {
        Self { on: false, factors: [0.67, 1.33], progress: Progress::None }
    }
}

/// A ribbon being computed.
#[derive(Debug)]
pub struct Job {
    job: background::Job<Found>,
    ask: Arc<Ask>,
}

impl Job {
    /// Starts one; `shown` is called whenever there is something new to show.
    #[must_use]
    pub fn start(ask: Ask, shown: impl Fn() + Send + 'static) -> Self {
        let ask = Arc::new(ask);
        let theirs = Arc::clone(&ask);
        let work = move |heard: background::Heard<'_, Found>| {
            let found = spread::spread(&theirs, |share| heard(share, None));
            found.map(|s| (Arc::new(s), theirs)).map_err(|e| e.to_string())
        };
        Self { job: background::Job::start("friction range", work, shown), ask }
    }

    /// What was asked.
    #[must_use]
    pub fn ask(&self) -> &Ask {
        &self.ask
    }

    /// How far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.job.progress()
    }
}

/// Whether an ask is the one that what is on screen asks.
#[must_use]
pub fn fits(state: &AppState, ask: &Ask) -> bool {
    ask.span_s == span_s(state)
        && ask.factors == state.spread.factors
        && ask.model == state.model
        && ask.settings == state.settings
        && ask.scene == *scene(state)
}

/// What is on screen asks; None while it moves or has no answer.
#[must_use]
pub fn asked(state: &AppState) -> Option<Ask> {
    let still = state.playback.paused && state.grabbed.is_none() && state.scene_fault.is_none();
    let answered = state.snapshot.solution.is_some() && state.snapshot.error.is_none() && !state.snapshot.draft;
    (state.spread.on && still && answered).then(|| Ask {
        scene: scene(state).clone(),
        model: state.model,
        settings: state.settings,
        factors: state.spread.factors,
        span_s: span_s(state),
    })
}

fn scene(state: &AppState) -> &Scene {
    state.snapshot.scene.as_deref().unwrap_or(&state.scene)
}

/// How long time has run.
fn span_s(state: &AppState) -> f64 {
    let now_s = state.live.solution.as_ref().map_or(0.0, |s| s.time_s);
    now_s.min(LONGEST_S)
}

/// The ribbon, if there is one of what is on screen.
#[must_use]
pub fn shown(state: &AppState) -> Option<&Found> {
    match &state.spread.progress {
        Progress::Done(found) if state.spread.on && fits(state, &found.1) => Some(found),
        _ => None,
    }
}
