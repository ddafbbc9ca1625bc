//! The errors of the figures of a cable at rest are estimated by comparison with `spans`, which has
//! no mesh, if that finds the equilibrium; with `fem`, if that knows a stiff cable better than was
//! asked for; else with meshes of elements twice and four times as long.
//!
//! Masses and springs are of the second order in the air and of the first at corners and where the
//! cable touches down, as the bars of `fem` in contact are, and the estimate is the same
//! (`fem/equilibrium_search/mesh_error.rs`).

use crate::model::fem::FemModel;
use crate::model::initial_equilibrium::initial_equilibrium;
use crate::model::mass_spring::chain_model::ChainModel;
use crate::model::mass_spring::results;
use crate::model::spans::SpansModel;
use crate::model::tension_gauge::TensionGauge;
use crate::model::{Inertia, Mechanics, Settings};
use crate::solution::error_estimates::MIN_COMPARED_ELEMENTS;
use crate::solution::{CableSolution, ErrorEstimates};

/// The model beside which errors are estimated.
#[derive(Clone, Debug, Default)]
pub(in crate::model::mass_spring) enum ErrorEstimator {
    /// No model: nothing is known.
    #[default]
    None,
    /// The cable without a mesh.
    Exact(Box<SpansModel>),
    /// No model yet: a better answer is known for the place where the cable rests.
    AtRest,
    /// A mesh of elements twice as long.
    Coarse(Box<ChainModel>),
}

/// An estimator and the errors that it found.
#[derive(Clone, Debug, Default)]
pub(in crate::model::mass_spring) struct Estimate {
    pub estimator: ErrorEstimator,
    pub errors: ErrorEstimates,
}

/// The shape from which a coarser mesh comes to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::mass_spring) enum CoarseMeshStart {
    /// The first shape of the scene.
    Scene,
    /// The shape in which the finer mesh is.
    Present,
}

impl Estimate {
    /// Estimates the errors of a model at rest, which came there from a `start`.
    pub(in crate::model::mass_spring) fn at_rest(model: &ChainModel, start: CoarseMeshStart) -> Self {
        let (problem, targets) = (&model.chain.mesh.problem, &model.chain.drives.targets);
        if start == CoarseMeshStart::Scene {
            let flexible = problem.bending_stiffness == 0.0;
            if flexible && let Ok(Some(exact)) = initial_equilibrium(problem, model.settings, targets, None) {
                let errors = errors_beside(model, &exact.answer);
                return Self { estimator: ErrorEstimator::Exact(exact.spans), errors };
            }
            if let Some(errors) = errors_beside_fem(model) {
                return Self { estimator: ErrorEstimator::AtRest, errors };
            }
        }
        let Some(coarse) = coarser(model, 2, start) else { return Self::default() };
        let (fine, half) = (model.solution(), coarse.solution());
        let rounding = ErrorEstimates::rounding(&fine, problem);
        let mut errors = ErrorEstimates::between(&half, &fine).plus(&rounding);
        if let Some(coarsest) = coarser(model, 4, start) {
            let change = ErrorEstimates::between(&coarsest.solution(), &half);
            errors = errors.componentwise_max(&change.times(model.chain.mesh.tuning.estimate.first_order_fraction));
        }
        Self { estimator: ErrorEstimator::Coarse(Box::new(coarse)), errors }
    }

    /// Follows a model through a quasi-static step of `dt_s`.
    pub(in crate::model::mass_spring) fn follow(self, model: &ChainModel, dt_s: f64) -> Self {
        let Self { estimator, errors } = self;
        let renewed = || coarser(model, 2, CoarseMeshStart::Present).map(|coarse| Self::beside(model, errors, coarse));
        match estimator {
            ErrorEstimator::None => None,
            ErrorEstimator::AtRest => renewed(),
            ErrorEstimator::Exact(mut spans) => {
                for (k, at) in model.chain.drives.targets.iter().enumerate() {
                    if let Some(at) = at {
                        spans.drag_support(k, *at);
                    }
                }
                if spans.advance(dt_s, Inertia::QuasiStatic).is_ok() {
                    let errors = errors_beside(model, &spans.solution());
                    Some(Self { estimator: ErrorEstimator::Exact(spans), errors })
                } else {
                    renewed()
                }
            }
            ErrorEstimator::Coarse(mut coarse) => {
                coarse.chain.drives.targets.clone_from(&model.chain.drives.targets);
                let stepped = coarse.advance(dt_s, Inertia::QuasiStatic, &mut TensionGauge::off()).is_ok();
                stepped.then(|| Self::beside(model, errors, *coarse))
            }
        }
        .unwrap_or_default()
    }

    /// Errors beside a coarser mesh, at least those `before`: friction is as wrong as the steps
    /// were that it remembers.
    fn beside(model: &ChainModel, before: ErrorEstimates, coarse: ChainModel) -> Self {
        let errors = before.componentwise_max(&ErrorEstimates::between(&coarse.solution(), &model.solution()));
        Self { estimator: ErrorEstimator::Coarse(Box::new(coarse)), errors }
    }
}

/// Errors beside the answer of `fem` on a mesh of its own, where that is known to better than was
/// asked for.
fn errors_beside_fem(model: &ChainModel) -> Option<ErrorEstimates> {
    let settings = Settings { segments: None, ..model.settings };
    let mut fem = FemModel::new(model.chain.mesh.problem.clone(), settings).ok()?;
    for (k, at) in model.chain.drives.targets.iter().enumerate() {
        if let Some(at) = at {
            fem.drag_support(k, *at);
        }
    }
    fem.settle().ok()?;
    let better = fem.solution();
    let is_known = better.errors.relative(&better).is_some_and(|e| e <= model.settings.tolerance);
    is_known.then(|| ErrorEstimates::between(&model.solution(), &better).plus(&better.errors))
}

fn errors_beside(model: &ChainModel, exact: &CableSolution) -> ErrorEstimates {
    let rounding = ErrorEstimates::rounding(exact, &model.chain.mesh.problem);
    ErrorEstimates::between(&model.solution(), exact).plus(&rounding)
}

/// The same cable at rest on elements `times` as long.
fn coarser(model: &ChainModel, times: usize, start: CoarseMeshStart) -> Option<ChainModel> {
    let elements = model.chain.mesh.rest_length.len();
    if elements < 2 * MIN_COMPARED_ELEMENTS {
        return None;
    }
    let settings = Settings { segments: Some(elements / times), ..model.settings };
    let mut coarse =
        ChainModel::new(model.chain.mesh.problem.clone(), settings, model.chain.mesh.tuning.clone()).ok()?;
    coarse.chain.drives.targets.clone_from(&model.chain.drives.targets);
    if start == CoarseMeshStart::Present {
        let state = results::state(&model.chain);
        coarse = coarse.on_shape(&state, &coarse.support_arc_lengths(&state))?;
    }
    coarse.settle().ok()?;
    Some(coarse)
}
