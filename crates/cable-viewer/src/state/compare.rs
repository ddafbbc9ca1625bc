//! Comparison keeps answers on screen beside the present one.

use std::sync::Arc;

use cable_core::{Scene, Solution};

use crate::jobs::model_comparison::Found;
use crate::record::run::Run;

/// An answer that is kept to compare with.
#[derive(Clone, Debug)]
pub struct Held {
    /// What it is of.
    pub name: String,
    /// The scene it answers.
    pub scene: Arc<Scene>,
    /// The answer.
    pub solution: Arc<Solution>,
    /// Wall time it took, s.
    pub wall_s: f64,
    /// The run it is the end of, where time ran.
    pub run: Option<Arc<Run>>,
}

impl Held {
    /// Most that are held: more lines cannot be told apart.
    pub const MOST: usize = 8;

    /// What to draw beside a picture of a time, s: the same time of its run.
    #[must_use]
    pub fn picture(&self, time_s: f64) -> &Solution {
        self.run.as_ref().and_then(|r| r.at(time_s)).unwrap_or(&self.solution)
    }
}

/// Holds each answer, in place of one held before of the same scene and model, as far as there is room.
pub fn hold(all: &mut Vec<Held>, found: &Found) {
    for answer in &found.answers {
        let Ok((solution, wall_s)) = &answer.result else { continue };
        let name = format!("{}, {} model at rest", found.scene.name, answer.model);
        let scene = Arc::clone(&found.scene);
        let held = Held { name, scene, solution: Arc::clone(solution), wall_s: *wall_s, run: None };
        let before = all.iter().position(|h| h.name == held.name && h.run.is_none() && h.scene == held.scene);
        if let Some(before) = before.and_then(|k| all.get_mut(k)) {
            *before = held;
        } else if all.len() < Held::MOST {
            all.push(held);
        }
    }
}
