//! This file estimates how neglected bending stiffness would change an answer of a flexible cable.
//!
//! A scene that says nothing of bending stiffness is answered without it: at rest that is exact to
//! √(EI/T) beside spans and radii, and much cheaper. Where the preset of the cable says which
//! stiffness is likely, the same scene is answered with it, and what the figures differ by is the
//! error of having left it out.
//!
//! Who asks for it gets the answer with the likely stiffness instead ([`settle_with_bending`]), or
//! the scene to run ([`scene_with_bending`]), for all such cables or for those of which the answer
//! without it is not one of a cable: bent tighter than it stands, curled up, in folds, or across
//! itself. It is not the rule: of 34 scenes (the catalogue and `repro`) whose cable has such a
//! preset, four have no sound answer with it, and heaps take seconds.

use serde::Serialize;

use crate::any_error::Error;
use crate::math::larger;
use crate::model::{Model, Settings};
use crate::scene::Scene;
use crate::scene::preset::cable_preset;
use crate::simulation::Simulation;
use crate::solution::error_estimates::greatest_tension;
use crate::solution::{ErrorEstimates, LikelyBending, Solution, TakenStiffness, Warning, WarningCause, WarningKind};

/// Effects that an answer at rest without bending stiffness left out, for one cable.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NeglectedBending {
    /// Name of the cable.
    pub cable: String,
    /// The bending stiffness that its preset is likely to have, N·m².
    pub bending_stiffness_n_m2: f64,
    /// The least and the most it may have, N·m², as far as that is known.
    pub range_n_m2: [Option<f64>; 2],
    /// The greatest tension with the likely stiffness, N; None where no answer was found.
    pub greatest_tension_n: Option<f64>,
    /// Change of each figure with it, no less than the error of the answer with it.
    pub changes: ErrorEstimates,
    /// The reason why there is no answer with it.
    pub unknown: Option<Error>,
}

/// Returns what it changes that cables were taken as perfectly flexible, of those whose preset says
/// which stiffness is likely: the scene is laid and answered once more with that.
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
    /// None, as the scene says.
    #[default]
    AsWritten,
    /// The bending stiffness that their presets are likely to have.
    Likely,
    /// That, of cables which without it are bent tighter than they stand, curl up, lie in folds, or
    /// cross themselves.
    WhereItMatters,
}

/// The scene with the likely bending stiffness of some cables that are flexible in it, and that
/// stiffness; None where nothing is known of any of them.
fn with_likely(scene: &Scene, counts: impl Fn(&str) -> bool) -> Option<(Scene, Vec<TakenStiffness>)> {
    let mut stiff = scene.clone();
    let mut taken = Vec::new();
    for cable in stiff.cables.iter_mut().filter(|c| c.bending_stiffness_n_m2 == 0.0 && counts(&c.name)) {
        let likely = cable.likely_bending_stiffness_n_m2();
        if likely > 0.0 {
            cable.bending_stiffness_n_m2 = likely;
            taken.push(TakenStiffness { cable: cable.name.clone(), bending_stiffness_n_m2: likely });
        }
    }
    (!taken.is_empty()).then_some((stiff, taken))
}

/// Returns whether a flexible line is not where a cable could be: folds have no width.
fn matters(warning: &Warning) -> bool {
    let kinds = [WarningKind::BendRadius, WarningKind::Kink, WarningKind::Curl, WarningKind::Loop];
    kinds.contains(&warning.kind) || matches!(warning.cause, WarningCause::Folds { .. })
}

/// A scene whose cables have the bending stiffness that was asked for.
struct Chosen {
    scene: Scene,
    /// The use that was made of likely stiffness, where there is any.
    bending: Option<LikelyBending>,
    /// The answer of the scene at rest, where that was needed to choose it.
    answer: Option<Solution>,
}

fn settle(scene: &Scene, model: Model, settings: Settings) -> Result<Solution, Error> {
    Ok(Simulation::with_settings(scene.clone(), model, settings)?.settle()?)
}

fn choose(scene: &Scene, model: Model, settings: Settings, bending: Bending) -> Result<Chosen, Error> {
    let as_written = |answer| Chosen { scene: scene.clone(), bending: None, answer };
    match bending {
        Bending::AsWritten => Ok(as_written(None)),
        Bending::Likely => Ok(match with_likely(scene, |_| true) {
            Some((scene, taken)) => Chosen { scene, bending: Some(LikelyBending::Taken(taken)), answer: None },
            None => as_written(None),
        }),
        Bending::WhereItMatters => {
            let flexible = settle(scene, model, settings)?;
            let tight = |name: &str| flexible.warnings.iter().any(|w| matters(w) && w.cable == name);
            let Some((stiff, taken)) = with_likely(scene, tight) else { return Ok(as_written(Some(flexible))) };
            match settle(&stiff, model, settings) {
                Ok(answer) => {
                    let bending = Some(LikelyBending::TakenWhereItMatters(taken));
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

/// Returns the scene with the bending stiffness that is asked for, and the use that was made of
/// likely stiffness. Where it matters is seen from where everything rests, without and with it.
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

/// Returns where everything rests, with the bending stiffness that is asked for: the scene that was
/// answered, and its answer, whose reason says what was taken. Where it matters and there is no
/// answer with it, the answer is that without it, and says so.
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
