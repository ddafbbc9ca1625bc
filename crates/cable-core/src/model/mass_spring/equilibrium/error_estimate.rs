//! How wrong the figures of a chain at rest are: beside `spans`, which has no mesh, where that lays
//! the cable; beside `fem` where that knows a stiff one better than was asked for; else beside
//! chains of elements twice and four times as long.
//!
//! Masses and springs are of the second order in the air and of the first at corners and where the
//! cable touches down, as the bars of `fem` in contact are, and what is said is the same
//! (`fem/two_meshes`).

use crate::model::fem::FemModel;
use crate::model::initial_equilibrium::initial_equilibrium;
use crate::model::mass_spring::{MassSpringModel, mesh};
use crate::model::spans::SpansModel;
use crate::model::{Inertia, Mechanics, Settings};
use crate::solution::CableSolution;
use crate::solution::ErrorEstimates;

/// Fewer elements than this have no half of use.
const LEAST_ELEMENTS: usize = 8;
/// Part of what the coarser two of three meshes differ by that the error of the finest is at least:
/// that of the first order.
const FIRST_ORDER_ERROR_FRACTION: f64 = 0.5;

/// Who goes on beside a chain.
#[derive(Clone, Debug, Default)]
pub(in crate::model::mass_spring) enum ErrorEstimator {
    /// Nobody: nothing is known.
    #[default]
    Nobody,
    /// The cable without a mesh.
    Exact(Box<SpansModel>),
    /// Nobody yet: a better answer is known for the place where it rests.
    AtRest,
    /// A chain of elements twice as long.
    Coarse(Box<MassSpringModel>),
}

impl MassSpringModel {
    /// Looks at the place where it rests; `first`, as the cable was laid.
    pub(in crate::model::mass_spring) fn look_beside(&mut self, first: bool) {
        (self.report.beside, self.report.errors) = (ErrorEstimator::Nobody, ErrorEstimates::default());
        let flexible = self.problem.bending_stiffness == 0.0;
        if first
            && flexible
            && let Ok(Some(lay)) = initial_equilibrium(&self.problem, self.settings, &self.drives.drag, None)
        {
            self.report.errors = self.apart(&lay.answer);
            self.report.beside = ErrorEstimator::Exact(lay.spans);
            return;
        }
        if first && let Some(errors) = self.beside_fem() {
            (self.report.beside, self.report.errors) = (ErrorEstimator::AtRest, errors);
            return;
        }
        let Some(coarse) = self.coarser(2, first) else { return };
        let (answer, other) = (self.answer(), coarse.answer());
        let rounding = ErrorEstimates::rounding(&answer, &self.problem);
        self.report.errors = ErrorEstimates::between(&other, &answer).plus(&rounding);
        if let Some(coarsest) = self.coarser(4, first) {
            let change = ErrorEstimates::between(&coarsest.answer(), &other);
            self.report.errors = self.report.errors.or_larger(&change.times(FIRST_ORDER_ERROR_FRACTION));
        }
        self.report.beside = ErrorEstimator::Coarse(Box::new(coarse));
    }

    /// Goes on beside it without inertia; with inertia nothing is known.
    pub(in crate::model::mass_spring) fn follow_beside(&mut self, dt_s: f64, inertia: Inertia) {
        let (beside, before) = (std::mem::take(&mut self.report.beside), std::mem::take(&mut self.report.errors));
        if inertia != Inertia::QuasiStatic {
            return;
        }
        match beside {
            ErrorEstimator::Nobody => {}
            ErrorEstimator::AtRest => {
                if let Some(coarse) = self.coarser(2, false) {
                    self.keep_beside(before, coarse);
                }
            }
            ErrorEstimator::Exact(mut spans) => {
                for (k, at) in self.drives.drag.iter().enumerate() {
                    if let Some(at) = at {
                        spans.drag_support(k, *at);
                    }
                }
                if spans.advance(dt_s, inertia).is_ok() {
                    self.report.errors = self.apart(&spans.solution());
                    self.report.beside = ErrorEstimator::Exact(spans);
                } else if let Some(coarse) = self.coarser(2, false) {
                    self.keep_beside(before, coarse);
                }
            }
            ErrorEstimator::Coarse(mut coarse) => {
                coarse.drives.drag.clone_from(&self.drives.drag);
                if coarse.advance(dt_s, inertia).is_ok() {
                    self.keep_beside(before, *coarse);
                }
            }
        }
    }

    /// What friction remembers is as wrong as the steps were that it remembers.
    fn keep_beside(&mut self, before: ErrorEstimates, coarse: Self) {
        self.report.errors = before.or_larger(&ErrorEstimates::between(&coarse.answer(), &self.answer()));
        self.report.beside = ErrorEstimator::Coarse(Box::new(coarse));
    }

    /// Errors beside the answer of `fem` on a mesh of its own, where that is known to better than
    /// was asked for.
    fn beside_fem(&self) -> Option<ErrorEstimates> {
        let mut fem = FemModel::new(self.problem.clone(), Settings { segments: None, ..self.settings }).ok()?;
        for (k, at) in self.drives.drag.iter().enumerate() {
            if let Some(at) = at {
                fem.drag_support(k, *at);
            }
        }
        fem.settle().ok()?;
        let better = fem.solution();
        let known = better.errors.relative(&better).is_some_and(|e| e <= self.settings.tolerance);
        known.then(|| ErrorEstimates::between(&self.answer(), &better).plus(&better.errors))
    }

    fn apart(&self, exact: &CableSolution) -> ErrorEstimates {
        ErrorEstimates::between(&self.answer(), exact).plus(&ErrorEstimates::rounding(exact, &self.problem))
    }

    /// The same cable at rest on a part of the elements: laid for itself (`first`), or from where
    /// this one lies.
    fn coarser(&self, times: usize, first: bool) -> Option<Self> {
        if self.chain.rest.len() < LEAST_ELEMENTS {
            return None;
        }
        let settings = Settings { segments: Some(self.chain.rest.len() / times), ..self.settings };
        let mut coarse = Self::mesh(self.problem.clone(), settings, &mesh::lay_supports(&self.problem));
        coarse.drives.drag.clone_from(&self.drives.drag);
        if !first {
            let state = self.present();
            let slid = coarse.slid_in(&state);
            coarse = coarse.shaped(&state, &slid)?;
        }
        coarse.settle_alone().ok()?;
        Some(coarse)
    }
}
