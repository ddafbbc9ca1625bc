//! This analysis estimates how neglected bending stiffness would change an answer of a flexible
//! cable.
//!
//! A scene without a bending stiffness is answered as flexible: at rest the relative error is of
//! the order of √(EI/T) over spans and radii, and the answer is much cheaper. If the preset of the
//! cable has a likely stiffness, the same scene is answered with it, and the difference of the
//! figures is the error of neglecting it.
//!
//! On request the answer with the likely stiffness is given instead ([`settle_with_bending`]), or
//! the scene to run ([`scene_with_bending`]): for all such cables, or for those whose flexible
//! answer is no possible shape of a cable: bent too tightly, curled up, in folds, or crossing
//! itself. This is not the default: of 34 scenes (the catalogue and `repro`) whose cable has such a
//! preset, four have no sound answer with it, and heaps take seconds.

use serde::Serialize;

use crate::any_error::Error;
use crate::math::larger;
use crate::model::{Model, Settings};
use crate::scene::Scene;
use crate::scene::preset::cable_preset;
use crate::simulation::Simulation;
use crate::solution::error_estimates::greatest_tension;
use crate::solution::{AssumedStiffness, ErrorEstimates, LikelyBending, Solution, Warning, WarningCause, WarningKind};

/// Effects that an answer at rest without bending stiffness neglects, for one cable.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NeglectedBending {
    /// Name of the cable.
    pub cable: String,
    /// The bending stiffness that its preset is likely to have, N·m².
    pub bending_stiffness_n_m2: f64,
    /// The least and the greatest stiffness that it may have, N·m², if known.
    pub range_n_m2: [Option<f64>; 2],
    /// The greatest tension with the likely stiffness, N; None where no answer was found.
    pub greatest_tension_n: Option<f64>,
    /// Change of each figure with it, no less than the error of the answer with it.
    pub changes: ErrorEstimates,
    /// The reason why there is no answer with it.
    pub unknown: Option<Error>,
}

/// Returns the effect of neglected bending for each perfectly flexible cable whose preset has a
/// likely stiffness: the scene is laid and answered once more with that.
#[must_use]
pub fn neglected_bending(scene: &Scene, answer: &Solution, settings: Settings) -> Vec<NeglectedBending> {
    let mut stiff = scene.clone();
    let mut found = Vec::new();
    for (k, cable) in stiff.cables.iter_mut().enumerate() {
        let assumed = answer.cables.get(k).map(|c| c.assumptions.bending_stiffness_n_m2);
        let likely = cable.preset.as_deref().and_then(cable_preset).map(|p| &p.likely_bending_stiffness_n_m2);
        if let (Some(likely), Some(0.0)) = (likely.filter(|f| f.value > 0.0), assumed) {
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
    let settings = Settings { histories: false, ..settings };
    let better = Simulation::with_settings(stiff, Model::Auto, settings).and_then(|mut s| Ok(s.settle()?));
    let fill = |(k, mut of): (usize, NeglectedBending)| {
        match &better {
            Ok(better) => {
                if let (Some(flexible), Some(stiff)) = (answer.cables.get(k), better.cables.get(k)) {
                    of.greatest_tension_n = Some(greatest_tension(&stiff.nodes));
                    let known = stiff.errors;
                    of.changes = ErrorEstimates::between(flexible, stiff).with(&known, larger);
                }
            }
            Err(error) => of.unknown = Some(error.clone()),
        }
        of
    };
    found.into_iter().map(fill).collect()
}

/// Bending stiffness of the cables that are perfectly flexible in the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bending {
    /// No bending stiffness, as in the scene.
    #[default]
    AsWritten,
    /// The bending stiffness that their presets are likely to have.
    Likely,
    /// The likely stiffness for cables that without it are bent too tightly, curl up, lie in folds,
    /// or cross themselves.
    WhereItMatters,
}

/// The scene with the likely bending stiffness for some of its flexible cables, and that stiffness;
/// None if it is known for none of them.
fn with_likely(scene: &Scene, counts: impl Fn(&str) -> bool) -> Option<(Scene, Vec<AssumedStiffness>)> {
    let mut stiff = scene.clone();
    let mut assumed = Vec::new();
    for cable in stiff.cables.iter_mut().filter(|c| c.bending_stiffness_n_m2 == 0.0 && counts(&c.name)) {
        let likely = cable.likely_bending_stiffness_n_m2();
        if likely > 0.0 {
            cable.bending_stiffness_n_m2 = likely;
            assumed.push(AssumedStiffness { cable: cable.name.clone(), bending_stiffness_n_m2: likely });
        }
    }
    (!assumed.is_empty()).then_some((stiff, assumed))
}

/// Returns whether a warning shows a shape that no real cable could have: folds of a flexible line
/// have no width.
fn matters(warning: &Warning) -> bool {
    let kinds = [WarningKind::BendRadius, WarningKind::Kink, WarningKind::Curl, WarningKind::Loop];
    kinds.contains(&warning.kind) || matches!(warning.cause, WarningCause::Folds { .. })
}

/// A scene whose cables have the requested bending stiffness.
struct Chosen {
    scene: Scene,
    /// The likely stiffness that was used, if any.
    bending: Option<LikelyBending>,
    /// The answer of the scene at rest, if it was needed for the choice.
    answer: Option<Solution>,
}

fn settle(scene: &Scene, model: Model, settings: Settings) -> Result<Solution, Error> {
    Ok(Simulation::with_settings(scene.clone(), model, settings)?.settle()?)
}

/// Chooses the bending stiffnesses to solve with; an answer that this needed comes with them.
fn choose(scene: &Scene, model: Model, settings: Settings, bending: Bending) -> Result<Chosen, Error> {
    let as_written = |answer| Chosen { scene: scene.clone(), bending: None, answer };
    match bending {
        Bending::AsWritten => Ok(as_written(None)),
        Bending::Likely => Ok(match with_likely(scene, |_| true) {
            Some((scene, assumed)) => Chosen { scene, bending: Some(LikelyBending::Assumed(assumed)), answer: None },
            None => as_written(None),
        }),
        Bending::WhereItMatters => {
            let flexible = settle(scene, model, settings)?;
            let tight = |name: &str| flexible.warnings.iter().any(|w| matters(w) && w.cable == name);
            let Some((stiff, assumed)) = with_likely(scene, tight) else { return Ok(as_written(Some(flexible))) };
            match settle(&stiff, model, settings) {
                Ok(answer) => {
                    let bending = Some(LikelyBending::AssumedWhereItMatters(assumed));
                    Ok(Chosen { scene: stiff, bending, answer: Some(answer) })
                }
                Err(Error::Solve(error)) => {
                    let bending = Some(LikelyBending::NoAnswer(Box::new(error)));
                    Ok(Chosen { bending, ..as_written(Some(flexible)) })
                }
                Err(other) => Err(other),
            }
        }
    }
}

/// Returns the scene with the requested bending stiffness, and the likely stiffness that was used.
/// The equilibria without and with it show where it matters.
///
/// # Errors
/// As [`Simulation::with_settings`] and [`Simulation::settle`], where it is settled.
pub fn scene_with_bending(
    scene: &Scene,
    model: Model,
    settings: Settings,
    bending: Bending,
) -> Result<(Scene, Option<LikelyBending>), Error> {
    let Chosen { scene, bending, .. } = choose(scene, model, settings, bending)?;
    Ok((scene, bending))
}

/// Returns the equilibrium with the requested bending stiffness: the scene that was answered, and
/// its answer, whose reason names the stiffness. If it matters and there is no answer with it, the
/// answer without it is returned, with a note.
///
/// # Errors
/// As [`Simulation::with_settings`] and [`Simulation::settle`].
pub fn settle_with_bending(
    scene: &Scene,
    model: Model,
    settings: Settings,
    bending: Bending,
) -> Result<(Scene, Solution), Error> {
    let Chosen { scene, bending, answer } = choose(scene, model, settings, bending)?;
    let mut answer = answer.map_or_else(|| settle(&scene, model, settings), Ok)?;
    if let Some(bending) = bending {
        answer.reason = answer.reason.with_bending(bending);
    }
    Ok((scene, answer))
}
