//! What it changes that a cable was taken as perfectly flexible.
//!
//! A scene that says nothing of bending stiffness is answered without it: at rest that is exact to √(EI/T) beside spans and radii, and
//! much cheaper. Where the preset of the cable says which stiffness is likely, the same scene is answered with it, and what the figures
//! differ by is the error of having left it out.

use serde::{Deserialize, Serialize};

use crate::estimates::ErrorEstimates;
use crate::math::larger;
use crate::model::{Model, Settings};
use crate::scene::Scene;
use crate::scene::preset::cable_preset;
use crate::simulation::Simulation;
use crate::solution::{CableSolution, Solution};

/// What an answer at rest without bending stiffness left out, for one cable.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NeglectedBending {
    /// Name of the cable.
    pub cable: String,
    /// The bending stiffness that its preset is likely to have, N·m².
    pub bending_stiffness_n_m2: f64,
    /// The least and the most it may have, N·m², as far as that is known.
    pub range_n_m2: [Option<f64>; 2],
    /// The greatest tension with the likely stiffness, N; None where no answer was found.
    pub greatest_tension_n: Option<f64>,
    /// What each figure changes by with it, no less than the answer with it is known to.
    pub changes: ErrorEstimates,
    /// Why there is no answer with it.
    pub unknown: Option<String>,
}

/// What it changes that cables were taken as perfectly flexible, of those whose preset says which stiffness is likely: the scene is laid
/// and answered once more with that.
#[must_use]
pub fn neglected_bending(scene: &Scene, answer: &Solution, settings: Settings) -> Vec<NeglectedBending> {
    let mut stiff = scene.clone();
    let mut found = Vec::new();
    for (k, cable) in stiff.cables.iter_mut().enumerate() {
        let taken = answer.cables.get(k).map(|c| c.assumptions.bending_stiffness_n_m2);
        let likely = cable.preset.as_deref().and_then(cable_preset).map(|p| &p.likely_bending_stiffness_n_m2);
        if let (Some(likely), Some(0.0)) = (likely.filter(|f| f.value > 0.0), taken) {
            cable.bending_stiffness_n_m2 = likely.value;
            let neglected = NeglectedBending {
                cable: cable.name.clone(),
                bending_stiffness_n_m2: likely.value,
                range_n_m2: [likely.low, likely.high],
                ..NeglectedBending::default()
            };
            found.push((k, neglected));
        }
    }
    if found.is_empty() {
        return Vec::new();
    }
    let better = Simulation::with_settings(stiff, Model::Auto, settings).and_then(|mut s| Ok(s.settle()?));
    let fill = |(k, mut of): (usize, NeglectedBending)| {
        match &better {
            Ok(better) => {
                if let (Some(flexible), Some(stiff)) = (answer.cables.get(k), better.cables.get(k)) {
                    of.greatest_tension_n = Some(greatest(stiff));
                    let known = stiff.errors;
                    of.changes = ErrorEstimates::between(flexible, stiff).with(&known, larger);
                }
            }
            Err(error) => of.unknown = Some(error.to_string()),
        }
        of
    };
    found.into_iter().map(fill).collect()
}

fn greatest(of: &CableSolution) -> f64 {
    of.nodes.iter().map(|n| n.tension_n).fold(0.0, larger)
}
