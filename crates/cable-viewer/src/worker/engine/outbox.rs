//! The outbox holds the reports that wait for the window: a snapshot, answers for the history, and
//! routes.

use std::sync::Arc;

use cable_core::math::Point;
use cable_core::timeline::RunPeaks;
use cable_core::{Scene, Solution};

use crate::state::Snapshot;
use crate::worker::timing::MAX_ANSWERS;

/// A message to the window.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The latest answer.
    pub snapshot: Snapshot,
    /// Forget the history shown so far.
    pub history_restarts: bool,
    /// New answers; at most [`crate::worker::timing::MAX_ANSWERS`].
    pub answers: Vec<Solution>,
    /// Routes of cables (by number) that the scene of this answer is to keep.
    pub routes: Vec<(usize, Vec<Point>)>,
    /// The worker paused itself because a step failed.
    pub paused_itself: bool,
}

/// Leaves out every second answer until no more than [`MAX_ANSWERS`] wait. The next answer takes
/// over the greatest tensions of one that is left out; warnings stay for a second, so no kind of
/// them is lost.
pub fn thin(answers: &mut Vec<Solution>) {
    while answers.len() > MAX_ANSWERS {
        let last = answers.len() - 1;
        let mut left_out: Option<Solution> = None;
        let mut thinned = Vec::with_capacity(last / 2 + 2);
        for (k, mut answer) in std::mem::take(answers).into_iter().enumerate() {
            if let Some(before) = left_out.take() {
                tell_peaks_of(&before, &mut answer);
            }
            if k % 2 == 1 && k < last {
                left_out = Some(answer);
            } else {
                thinned.push(answer);
            }
        }
        *answers = thinned;
    }
}

/// An answer takes over the greater tensions of the one before it.
fn tell_peaks_of(before: &Solution, answer: &mut Solution) {
    for (cable, then) in answer.cables.iter_mut().zip(&before.cables) {
        let own = cable.peaks_at(answer.time_s);
        let both = then.peaks_at(before.time_s).with(own);
        if (both.greatest, both.held) != (own.greatest, own.held) {
            cable.peaks = Some(both);
        }
    }
}

/// Reports that wait for the window.
#[derive(Clone, Debug, Default)]
pub(super) struct Outbox {
    pub snapshot: Snapshot,
    /// The last answer that was no draft: it is shown if a scene has no answer.
    pub last_answer: Option<LastAnswer>,
    pub answers: Vec<Solution>,
    /// The history starts again before the first of `answers`.
    pub history_restarts: bool,
    /// Routes of cables that the scene is to keep, by the number of the cable: the last edit would
    /// have moved them through an obstacle.
    pub routes: Vec<(usize, Vec<Point>)>,
}

/// The last answer that was no draft.
#[derive(Clone, Debug)]
pub(super) struct LastAnswer {
    scene: Option<Arc<Scene>>,
    solution: Arc<Solution>,
    peaks: Vec<RunPeaks>,
}

impl Outbox {
    /// Begins another scene: nothing of the one before is shown.
    pub fn restart(&mut self) {
        self.snapshot.solution = None;
        self.last_answer = None;
        self.history_restarts = true;
        self.answers.clear();
    }

    /// Shows an instant between two steps in the place of the last step; it is in no history.
    pub fn show_between_steps(&mut self, answer: Option<Solution>) {
        if let Some(answer) = answer {
            self.snapshot.solution = Some(Arc::new(answer));
        }
    }

    /// Shows an answer from a recording as it is there.
    pub fn show_recorded(&mut self, answer: Arc<Solution>) {
        self.answers.clear();
        self.answers.push((*answer).clone());
        self.snapshot.solution = Some(answer);
        self.keep_answer();
    }

    /// Returns the report that waits.
    pub fn report(&mut self) -> Report {
        Report {
            snapshot: self.snapshot.clone(),
            history_restarts: std::mem::take(&mut self.history_restarts),
            answers: std::mem::take(&mut self.answers),
            routes: self.routes.clone(),
            paused_itself: false,
        }
    }

    /// Keeps an answer that is on screen: it stays while later scenes have none.
    pub fn keep_answer(&mut self) {
        if let (false, Some(solution)) = (self.snapshot.draft, &self.snapshot.solution) {
            let Snapshot { scene, peaks, .. } = &self.snapshot;
            let (scene, solution, peaks) = (scene.clone(), Arc::clone(solution), peaks.clone());
            self.last_answer = Some(LastAnswer { scene, solution, peaks });
        }
    }

    /// A draft of a scene is no answer, least of all to another one.
    pub fn show_last_answer(&mut self) {
        self.snapshot.draft = false;
        self.snapshot.seeks_histories = false;
        if let Some(last) = &self.last_answer {
            self.snapshot.solution = Some(Arc::clone(&last.solution));
            self.snapshot.scene.clone_from(&last.scene);
            self.snapshot.peaks.clone_from(&last.peaks);
        }
    }
}
