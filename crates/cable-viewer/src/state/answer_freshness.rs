//! The freshness tells if the answer on screen is that of the present scene: only then are figures,
//! warnings and verdicts shown as valid.

use crate::state::app_state::AppState;

/// Time (s) that an edit may wait before the picture counts as older than the scene. Shorter:
/// figures flicker in a drag whose answers are in the next frames; longer: old figures are read as
/// new ones.
const GRACE_S: f64 = 0.12;

/// The relation of the answer on screen to the present scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freshness {
    /// The answer is that of the present scene.
    Current,
    /// The answer is being sought; the one on screen is of the scene before the last edits.
    Solving,
    /// The answer is a draft with few segments, not at rest yet, while the scene is being moved.
    Draft,
    /// The scene has no answer; the one on screen is of the last scene that had one.
    Outdated,
}

impl AppState {
    /// Returns true if the answer on screen is that of the present scene.
    #[must_use]
    pub fn freshness(&self) -> Freshness {
        let Self { live, solver, .. } = self;
        if live.snapshot.stale || live.snapshot.error.is_some() {
            Freshness::Outdated
        } else if live.snapshot.draft {
            Freshness::Draft
        } else if live.snapshot.edit < solver.edits_sent && solver.solving_s.is_some_and(|t| t > GRACE_S) {
            Freshness::Solving
        } else {
            Freshness::Current
        }
    }

    /// Returns whether what is on screen answers the last edit, be it by a draft or by a refusal.
    #[must_use]
    pub fn is_answered(&self) -> bool {
        self.live.snapshot.edit >= self.solver.edits_sent
    }

    /// Figures on screen are of the scene as it is.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.freshness() == Freshness::Current
    }

    /// Time for which an answer has been sought that is not on screen yet, s.
    #[must_use]
    pub fn solving_for_s(&self) -> Option<f64> {
        let waits = matches!(self.freshness(), Freshness::Solving | Freshness::Draft)
            || (self.freshness() == Freshness::Outdated && self.live.snapshot.edit < self.solver.edits_sent);
        self.solver.solving_s.filter(|_| waits)
    }
}
