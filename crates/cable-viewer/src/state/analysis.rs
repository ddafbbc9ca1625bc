//! This part of the state holds the questions beyond the answer itself, and the answers that are
//! pinned for comparison.

use std::path::PathBuf;
use std::sync::Arc;

use cable_core::scene::Change;
use cable_core::{Scene, Solution};

use crate::jobs::model_comparison::{self, ModelComparison};
use crate::jobs::{friction_range, neglected_bending, safe_reach, work_precision};
use crate::record::kept_run::KeptRun;

/// The questions beyond the answer itself.
#[derive(Debug, Default)]
pub struct Analysis {
    /// Answers kept on screen to compare with.
    pub references: Vec<Reference>,
    /// The answers of every model to a scene.
    pub models: model_comparison::Progress,
    /// The place on a cable at which it is shown where the tension comes from.
    pub tension_marker: Option<TensionMarker>,
    /// The places to which the robot or an end can be taken.
    pub safe_reach: safe_reach::SafeReachState,
    /// The effect of neglected bending stiffness.
    pub neglected_bending: neglected_bending::NeglectedBendingState,
    /// Error over cost of every model and mesh.
    pub work_precision: work_precision::Progress,
    /// The effect of less and of more friction.
    pub friction_range: friction_range::FrictionRangeState,
}

impl Analysis {
    /// Returns the differences of a scene that is to be pinned from that of the first pin, or, if
    /// there is none, from the scene as it was opened or saved.
    #[must_use]
    pub fn changes_to(&self, scene: &Scene, saved: &Scene) -> Vec<Change> {
        self.references.first().map_or(saved, |first| &first.scene).changes_to(scene)
    }
}

/// A place on a cable whose tension is taken apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensionMarker {
    /// Index of the cable.
    pub cable: usize,
    /// The place on it, m.
    pub arc_length_m: f64,
    /// The end the sum begins at.
    pub from: cable_core::analysis::tension_budget::StartEnd,
}

/// An answer that is kept to compare with.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The scene it answers.
    pub scene: Arc<Scene>,
    /// The changes that lead to it from the scene of the pin that was the first then, or else from
    /// the scene as it was opened or saved.
    pub changes: Vec<Change>,
    /// The folder that it was read from.
    pub folder: Option<PathBuf>,
    /// The answer.
    pub solution: Arc<Solution>,
    /// Wall time it took, s; of a run that was read from its folder, the whole run; NaN where that
    /// does not say.
    pub wall_s: f64,
    /// The run it is the end of, where time ran.
    pub run: Option<Arc<KeptRun>>,
}

impl Reference {
    /// Greatest number of pins: more lines cannot be told apart.
    pub const MAX_COUNT: usize = 8;

    /// Returns the answer to draw beside that of a time, s: the one of its run at the same time.
    #[must_use]
    pub fn picture(&self, time_s: f64) -> &Solution {
        self.run.as_ref().and_then(|r| r.at(time_s)).unwrap_or(&self.solution)
    }
}

/// Pins each answer, in place of one pinned before of the same scene and model at rest, as far as
/// there is room. `saved`: the scene as it was opened or saved.
pub fn pin_answers(analysis: &mut Analysis, found: &ModelComparison, saved: &Scene) {
    for answer in &found.answers {
        let Ok((solution, wall_s)) = &answer.result else { continue };
        let (scene, changes) = (Arc::clone(&found.scene), analysis.changes_to(&found.scene, saved));
        let (solution, folder) = (Arc::clone(solution), None);
        let reference = Reference { scene, changes, folder, solution, wall_s: *wall_s, run: None };
        let is_same = |h: &Reference| {
            let at_rest = h.run.is_none() && h.folder.is_none() && h.solution.time_s == reference.solution.time_s;
            at_rest && h.solution.model == reference.solution.model && h.scene == reference.scene
        };
        if let Some(before) = analysis.references.iter_mut().find(|h| is_same(h)) {
            *before = reference;
        } else if analysis.references.len() < Reference::MAX_COUNT {
            analysis.references.push(reference);
        }
    }
}
