//! Analyses are what is asked beyond the answer itself, and answers kept to compare with.

use std::sync::Arc;

use cable_core::{Scene, Solution};

use crate::jobs::model_comparison::{self, Outcome};
use crate::jobs::{friction_range, neglected_bending, safe_reach, work_precision};
use crate::record::kept_run::Run;
use crate::units::labels;

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
    /// What neglecting bending stiffness changes.
    pub neglected_bending: neglected_bending::NeglectedBendingState,
    /// Error over cost of every model and mesh.
    pub work_precision: work_precision::Progress,
    /// What less and more friction does.
    pub friction_range: friction_range::FrictionRangeState,
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
    /// What it is of.
    pub name: String,
    /// The scene it answers.
    pub scene: Arc<Scene>,
    /// The answer.
    pub solution: Arc<Solution>,
    /// Wall time it took, s; of a run that was read from its folder, the whole run; NaN where that
    /// does not say.
    pub wall_s: f64,
    /// The run it is the end of, where time ran.
    pub run: Option<Arc<Run>>,
}

impl Reference {
    /// Most that are held: more lines cannot be told apart.
    pub const MAX_COUNT: usize = 8;

    /// Returns what to draw beside a picture of a time, s: the same time of its run.
    #[must_use]
    pub fn picture(&self, time_s: f64) -> &Solution {
        self.run.as_ref().and_then(|r| r.at(time_s)).unwrap_or(&self.solution)
    }
}

/// Holds each answer, in place of one held before of the same scene and model, as far as there is
/// room.
pub fn hold(all: &mut Vec<Reference>, found: &Outcome) {
    for answer in &found.answers {
        let Ok((solution, wall_s)) = &answer.result else { continue };
        let name = format!("{}, {} model at rest", found.scene.name, labels::model(answer.model));
        let scene = Arc::clone(&found.scene);
        let held = Reference { name, scene, solution: Arc::clone(solution), wall_s: *wall_s, run: None };
        let before = all.iter().position(|h| h.name == held.name && h.run.is_none() && h.scene == held.scene);
        if let Some(before) = before.and_then(|k| all.get_mut(k)) {
            *before = held;
        } else if all.len() < Reference::MAX_COUNT {
            all.push(held);
        }
    }
}
