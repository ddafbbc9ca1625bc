//! This analysis answers a scene with other models and meshes, and compares each answer with the
//! given one.
//!
//! It shows the error of the next cheaper choice. This module has no clock: the caller measures the
//! time of each call of [`answer_with`].

use serde::{Deserialize, Serialize};

use crate::any_error::Error;
use crate::math::larger;
use crate::model::{Model, Settings};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::solution::{ErrorEstimates, Solution};

/// Numbers of elements of a cable, for models with a mesh.
pub const COMPARED_ELEMENTS: [usize; 5] = [25, 50, 100, 200, 400];

/// A model and its mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// The model.
    pub model: Model,
    /// Number of elements of each cable; None for a model without a mesh.
    pub elements: Option<usize>,
}

impl Setting {
    /// All settings that are compared: every model, those with a mesh on five meshes.
    pub fn all() -> impl Iterator<Item = Self> {
        Model::SOLVERS.into_iter().flat_map(|model| {
            let has_mesh = model.capabilities().mesh;
            let meshes = if has_mesh { COMPARED_ELEMENTS.map(Some).to_vec() } else { vec![None] };
            meshes.into_iter().map(move |elements| Self { model, elements })
        })
    }
}

/// The answer of a setting, compared with the given one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// Greatest tension of all cables, N.
    pub greatest_tension_n: f64,
    /// Greatest difference of a support's force and of a greatest tension, relative to the greatest
    /// tension of that cable in the given answer.
    pub force_difference: f64,
    /// Greatest distance of a point of a cable from its position in the given answer, m.
    pub shape_difference_m: f64,
    /// Relative error of the greatest tension that the setting states; None where it states none.
    pub stated_error: Option<f64>,
}

/// Answers the scene at rest with a setting, and compares it with a given answer.
///
/// # Errors
/// The reason why the setting has no answer.
pub fn answer_with(setting: Setting, scene: &Scene, given: &Solution, settings: Settings) -> Result<Compared, Error> {
    let settings = Settings { segments: setting.elements, histories: false, ..settings };
    // A number of elements in the scene would override that of the setting.
    let mut scene = scene.clone();
    scene.cables.iter_mut().for_each(|cable| cable.segments = None);
    let mut simulation = Simulation::with_settings(scene, setting.model, settings)?;
    let answer = simulation.settle()?;
    let mut found = Compared {
        greatest_tension_n: answer.max_tension().tension_n,
        force_difference: 0.0,
        shape_difference_m: 0.0,
        stated_error: answer.cables.iter().filter_map(|c| c.error_estimate).reduce(larger),
    };
    for (own, of_given) in answer.cables.iter().zip(&given.cables) {
        let apart = ErrorEstimates::between(own, of_given);
        let greatest = of_given.nodes.iter().map(|n| n.tension_n.abs()).fold(0.0, larger);
        for force in [apart.max_tension_n, apart.support_force_n].into_iter().flatten() {
            // A difference from an answer without any tension is stated in newtons.
            let part = if greatest > 0.0 { force / greatest } else { force };
            found.force_difference = larger(found.force_difference, part);
        }
        found.shape_difference_m = larger(found.shape_difference_m, apart.position_m.unwrap_or(0.0));
    }
    Ok(found)
}
