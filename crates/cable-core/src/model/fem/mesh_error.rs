//! Two meshes are compared to estimate how wrong the figures of a cable in contact are.
//!
//! If `spans` has a solution, that has no mesh error, and the bars came to rest from it: the two
//! differ by the effect of mesh, barrier and stick-slip states. That difference is the error
//! estimate of each figure. In quasi-static steps `spans` continues beside the bars: it costs a
//! small part of what they cost, and has the same friction memory.
//!
//! If it has no solution (slack, stiff, in plan view, in self-contact), the same cable is solved on
//! bars twice and four times as long. Straight bars between contacts are of the second order,
//! where the cable touches down or meets a corner of the first: what is left of an error on the
//! finest of three meshes is a third of what the finer two differ by, or all of it. All of it is
//! said, and no less than half of what the coarser two differ by: one difference may pass through
//! nothing where the error does not, as a node comes to lie at a corner. (L. F. Richardson and J.
//! A. Gaunt, *The deferred approach to the limit*, Phil. Trans. R. Soc. A 226, 1927, without the
//! extrapolation: its order is not known here.)

use std::sync::Arc;

use crate::math::Vec2;
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::WorkBudget;
use crate::model::initial_equilibrium::InitialEquilibrium;
use crate::model::spans::SpansModel;
use crate::model::{Inertia, Mechanics, Settings};
use crate::problem::Problem;
use crate::solution::CableSolution;
use crate::solution::ErrorEstimates;

/// Least number of bars that is halved: half of fewer shows no shape.
const LEAST_BARS: usize = 8;
/// Part of what the coarser two of three meshes differ by that the error of the finest is at least:
/// that of the first order.
const FIRST_ORDER_ERROR_FRACTION: f64 = 0.5;
/// Estimates that may take as much work together as one search for the equilibrium: each begins at
/// the answer.
const ESTIMATES_PER_SEARCH: usize = 4;

/// The model beside which the errors of the cable are estimated, and the estimate.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct TwoMeshes {
    exact: Option<Box<SpansModel>>,
    coarse: Option<Box<Stepper>>,
    /// The errors as far as they are known now.
    pub errors: ErrorEstimates,
}

/// The permission of the comparison to change the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// The scene leaves the number of bars open.
    Allowed,
    /// The scene or the settings give it.
    Forbidden,
}

impl TwoMeshes {
    /// Estimates the errors of a cable that came to rest, beside the answer without a mesh where
    /// there is one; refines its mesh where that is allowed and makes them smaller.
    pub fn compare(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        refinement: Refinement,
        fine: &mut Stepper,
        exact: Option<InitialEquilibrium>,
        dragged: &[Option<Vec2>],
    ) {
        *self = Self::default();
        if problem.outline.is_some() {
            return;
        }
        if problem.cable.self_contact {
            self.errors = match exact {
                // A cable that touches itself nowhere rests as one that cannot; once it moves it
                // may.
                Some(exact) if !fine.cable.touches_itself() => errors_beside(&fine.solution(), &exact.answer, problem),
                _ => {
                    errors_by_coarser_meshes(problem, settings, fine, dragged).map(|found| found.0).unwrap_or_default()
                }
            };
            return;
        }
        if !fine.cable.meshing.slides {
            return;
        }
        if let Some(exact) = exact {
            let mut answer = fine.solution();
            self.errors = errors_beside(&answer, &exact.answer, problem);
            while refinement == Refinement::Allowed
                && exceeds(&self.errors, &answer, settings)
                && 2 * fine.cable.meshing.even_bars <= fine.cable.mesh.tuning.start.max_refined_bars
            {
                let bars = 2 * fine.cable.meshing.even_bars;
                let Some(finer) = at_rest_with_bars(problem, settings, fine, bars, &exact.answer, dragged) else {
                    break;
                };
                let next = finer.solution();
                let errors = errors_beside(&next, &exact.answer, problem);
                if !(errors.relative(&next) < self.errors.relative(&answer)) {
                    break;
                }
                *fine = finer;
                (answer, self.errors) = (next, errors);
            }
            self.exact = Some(exact.spans);
            return;
        }
        if let Some((errors, coarse)) = errors_by_coarser_meshes(problem, settings, fine, dragged) {
            (self.errors, self.coarse) = (errors, Some(Box::new(coarse)));
        }
    }

    /// Follows a step of the cable without inertia; with inertia there is no estimate.
    pub fn follow(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        fine: &Stepper,
        dt_s: f64,
        inertia: Inertia,
        dragged: &[Option<Vec2>],
    ) {
        let before = std::mem::take(self);
        if inertia != Inertia::QuasiStatic {
            return;
        }
        let answer = fine.solution();
        let coarse = match (before.exact, before.coarse) {
            (Some(mut exact), _) => {
                if let Some(other) = advance_spans(&mut exact, dt_s, dragged) {
                    self.errors = errors_beside(&answer, &other, problem);
                    self.exact = Some(exact);
                    return;
                }
                // The cable has no answer without a mesh from here on.
                at_rest_with_bars(problem, settings, fine, fine.cable.meshing.even_bars / 2, &answer, dragged)
                    .map(Box::new)
            }
            (None, Some(mut coarse)) => coarse.advance(dt_s, inertia, dragged).is_ok().then_some(coarse),
            (None, None) => None,
        };
        let Some(coarse) = coarse else { return };
        // Friction is as wrong as the steps that it remembers.
        self.errors = before.errors.componentwise_max(&ErrorEstimates::between(&coarse.solution(), &answer));
        self.coarse = Some(coarse);
    }
}

/// The answer of `spans` a step further on, if it has one.
fn advance_spans(spans: &mut SpansModel, dt_s: f64, dragged: &[Option<Vec2>]) -> Option<CableSolution> {
    for (k, at) in dragged.iter().enumerate() {
        if let Some(at) = at {
            spans.drag_support(k, *at);
        }
    }
    spans.advance(dt_s, Inertia::QuasiStatic).ok()?;
    Some(spans.solution())
}

/// Errors of a cable by the same one on bars twice and four times as long, and the one on bars
/// twice as long; None where that finds no rest.
fn errors_by_coarser_meshes(
    problem: &Arc<Problem>,
    settings: Settings,
    fine: &Stepper,
    dragged: &[Option<Vec2>],
) -> Option<(ErrorEstimates, Stepper)> {
    if fine.cable.meshing.even_bars < LEAST_BARS {
        return None;
    }
    let answer = fine.solution();
    let coarse = at_rest_with_bars(problem, settings, fine, fine.cable.meshing.even_bars / 2, &answer, dragged)?;
    let other = coarse.solution();
    let errors = ErrorEstimates::between(&other, &answer).plus(&ErrorEstimates::rounding(&answer, problem));
    let coarsest = at_rest_with_bars(problem, settings, fine, fine.cable.meshing.even_bars / 4, &answer, dragged);
    let change = coarsest.map(|c| ErrorEstimates::between(&c.solution(), &other).times(FIRST_ORDER_ERROR_FRACTION));
    Some((change.map_or(errors, |change| errors.componentwise_max(&change)), coarse))
}

/// Errors of an answer beside one without a mesh.
fn errors_beside(answer: &CableSolution, exact: &CableSolution, problem: &Problem) -> ErrorEstimates {
    ErrorEstimates::between(answer, exact).plus(&ErrorEstimates::rounding(exact, problem))
}

fn exceeds(errors: &ErrorEstimates, answer: &CableSolution, settings: Settings) -> bool {
    errors.relative(answer).is_some_and(|e| e > settings.tolerance)
}

/// The same cable with another number of bars, at rest next to an answer.
fn at_rest_with_bars(
    problem: &Arc<Problem>,
    settings: Settings,
    like: &Stepper,
    bars: usize,
    answer: &CableSolution,
    dragged: &[Option<Vec2>],
) -> Option<Stepper> {
    let mut other =
        Stepper::new(problem.clone(), Settings { segments: Some(bars), ..settings }, like.cable.mesh.tuning.clone())
            .ok()?;
    other.cable.meshing.slides = like.cable.meshing.slides;
    other.warm_start(answer, like.cable.time(), dragged).ok()?;
    if !other.rested {
        other.solver.work_left = WorkBudget::Left(like.cable.mesh.tuning.equilibrium.max_work / ESTIMATES_PER_SEARCH);
        let found = other.settle(dragged);
        other.solver.work_left = WorkBudget::Unlimited;
        found.ok()?;
    }
    Some(other)
}
