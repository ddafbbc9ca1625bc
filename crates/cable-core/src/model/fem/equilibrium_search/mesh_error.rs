//! This module compares meshes to estimate the errors of an answer in contact.
//!
//! If `spans` has a solution, that has no mesh error, and the bars came to rest from it: the two
//! differ by the effect of mesh, barrier and stick-slip states. That difference is the error
//! estimate of each figure. In quasi-static steps `spans` is advanced beside the bars: its cost is
//! small compared with theirs, and it has the same friction memory.
//!
//! If it has no solution (slack, stiff, in plan view, in self-contact), the same cable is solved on
//! bars twice and four times as long. Straight bars between contacts are of second order, and of
//! first order where the cable touches down or meets a corner: the error on the finest of three
//! meshes is a third of the difference of the finer two, or all of it. The estimate is all of it,
//! and at least half of the difference of the coarser two, because a single difference may vanish
//! by chance, as when a node comes to lie at a corner; all of that, too, beside a robot, where each
//! mesh finds its own resting place. (L. F. Richardson and J. A. Gaunt, *The
//! deferred approach to the limit*, Phil. Trans. R. Soc. A 226, 1927, without the extrapolation:
//! its order is not known here.)

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

/// Least number of bars that is halved: half of fewer would not represent the shape.
pub(in crate::model::fem) const LEAST_BARS: usize = 8;
/// Lower bound of the error on the finest of three meshes, as a fraction of the difference of the
/// coarser two: that of first order.
const FIRST_ORDER_ERROR_FRACTION: f64 = 0.5;
/// Number of estimates that together may take as much work as one search for the equilibrium,
/// because each begins at the answer.
const ESTIMATES_PER_SEARCH: usize = 4;

/// The comparison model and the error estimate of a cable.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct TwoMeshes {
    exact: Option<Box<SpansModel>>,
    coarse: Option<Box<Stepper>>,
    /// True after an edit of the scene: the next step without inertia finds a coarser mesh again.
    resumes: bool,
    /// The present error estimates.
    pub errors: ErrorEstimates,
}

/// Tells whether the comparison may change the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshRefinement {
    /// Refinement is allowed: the scene leaves the number of bars open.
    Allowed,
    /// The scene or the settings give the number of bars.
    Forbidden,
}

impl TwoMeshes {
    /// Estimates the errors of a cable at rest, against the answer without a mesh if there is one.
    /// Refines the mesh if that is allowed and makes the errors smaller.
    pub fn compare(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        refinement: MeshRefinement,
        fine: &mut Stepper,
        exact: Option<InitialEquilibrium>,
        dragged: &[Option<Vec2>],
    ) {
        *self = Self::default();
        if problem.cable.self_contact {
            if let Some((errors, coarse)) = errors_by_coarser_meshes(problem, settings, fine, dragged) {
                self.errors = errors;
                self.coarse = Some(Box::new(coarse));
            }
            // At rest a cable that does not touch itself is like one that cannot; in motion it may.
            if let Some(exact) = exact.filter(|_| !fine.cable.touches_itself()) {
                self.errors = errors_beside(&fine.solution(), &exact.answer, problem);
            }
            return;
        }
        if !fine.cable.meshing.slides {
            return;
        }
        if let Some(exact) = exact {
            let mut answer = fine.solution();
            self.errors = errors_beside(&answer, &exact.answer, problem);
            while refinement == MeshRefinement::Allowed
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

    /// The comparison of a cable at rest with one on bars twice as long, and of that with one on
    /// bars four times as long, each of which found its own resting place.
    pub fn beside(fine: &Stepper, coarse: Stepper, coarsest: Option<&Stepper>) -> Self {
        let (answer, other) = (fine.solution(), coarse.solution());
        let rounding = ErrorEstimates::rounding(&answer, &fine.cable.problem);
        let errors = ErrorEstimates::between(&other, &answer).plus(&rounding);
        let change = coarsest.map(|coarsest| ErrorEstimates::between(&coarsest.solution(), &other));
        // Differences by the choice of a resting place do not become less with the bars.
        let errors = change.map_or(errors, |change| errors.componentwise_max(&change));
        Self { coarse: Some(Box::new(coarse)), errors, ..Self::default() }
    }

    /// Estimates the errors of a cable beside a robot that has moved, or was laid before.
    pub fn compare_again(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        fine: &Stepper,
        dragged: &[Option<Vec2>],
    ) {
        let before = std::mem::take(self);
        if let Some((errors, coarse)) = errors_by_coarser_meshes(problem, settings, fine, dragged) {
            let is_known = before.errors != ErrorEstimates::default();
            // Which resting place was found depends on the mesh as it did before.
            self.errors = if is_known { errors.componentwise_max(&before.errors) } else { errors };
            self.coarse = Some(Box::new(coarse));
        }
    }

    /// Begins to follow a cable whose mesh came to rest at an answer without a mesh. Refines the
    /// mesh as far as the tolerance needs, if that is allowed.
    pub fn begin(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        refinement: MeshRefinement,
        fine: &mut Stepper,
        answer: &CableSolution,
        dragged: &[Option<Vec2>],
    ) {
        *self = Self::default();
        // Coarse bars are no measure of the bends of a cable that touches a robot.
        if problem.outline.is_some() {
            return;
        }
        while let Some((errors, coarse)) = errors_by_coarser_meshes(problem, settings, fine, dragged) {
            (self.errors, self.coarse) = (errors, Some(Box::new(coarse)));
            let bars = 2 * fine.cable.meshing.even_bars;
            if refinement == MeshRefinement::Forbidden
                || !exceeds(&errors, &fine.solution(), settings)
                || bars > fine.cable.mesh.tuning.start.max_refined_bars
            {
                return;
            }
            let Some(mut finer) = at_rest_with_bars(problem, settings, fine, bars, answer, dragged) else { return };
            finer.hand_drive.pulled.clone_from(&fine.hand_drive.pulled);
            *fine = finer;
        }
    }

    /// Limits the work of each step of the mesh beside the cable's.
    pub fn limit_work(&mut self, work: usize) {
        if let Some(coarse) = &mut self.coarse {
            coarse.solver.work_of_advance = WorkBudget::Left(work);
        }
    }

    /// Goes on after an edit of the scene of a cable with these errors.
    pub fn after_edit(errors: ErrorEstimates) -> Self {
        Self { errors, resumes: errors != ErrorEstimates::default(), ..Self::default() }
    }

    /// Begins to follow a cable that continues without inertia from an answer of another model: a
    /// mesh of bars twice as long continues from it, too.
    pub fn continue_beside(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        fine: &Stepper,
        answer: &CableSolution,
        dragged: &[Option<Vec2>],
    ) {
        *self = Self::default();
        let bars = fine.cable.meshing.even_bars;
        if bars < LEAST_BARS {
            return;
        }
        if let Some(coarse) = at_rest_with_bars(problem, settings, fine, bars / 2, answer, dragged) {
            self.errors = answer.errors.plus(&ErrorEstimates::between(&coarse.solution(), &fine.solution()));
            self.coarse = Some(Box::new(coarse));
        }
    }

    /// The relative difference of an answer from that of the coarser mesh beside it.
    pub fn halving_error(&self, answer: &CableSolution) -> Option<f64> {
        ErrorEstimates::between(&self.coarse.as_ref()?.solution(), answer).relative(answer)
    }

    /// Halves the bars of a cable at rest; the mesh that it had is the coarser one beside it.
    /// Returns whether that was possible.
    pub fn halve_bars(
        &mut self,
        problem: &Arc<Problem>,
        settings: Settings,
        fine: &mut Stepper,
        dragged: &[Option<Vec2>],
    ) -> bool {
        let bars = 2 * fine.cable.meshing.even_bars;
        if bars > fine.cable.mesh.tuning.start.max_refined_bars {
            return false;
        }
        let Some(mut finer) = at_rest_with_bars(problem, settings, fine, bars, &fine.solution(), dragged) else {
            return false;
        };
        finer.hand_drive.pulled.clone_from(&fine.hand_drive.pulled);
        self.coarse = Some(Box::new(std::mem::replace(fine, finer)));
        true
    }

    /// Follows a quasi-static step of the cable; steps with inertia have no estimate.
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
                // From here on the cable has no answer without a mesh.
                at_rest_with_bars(problem, settings, fine, fine.cable.meshing.even_bars / 2, &answer, dragged)
                    .map(Box::new)
            }
            (None, Some(mut coarse)) => {
                lead_outline(&mut coarse, fine);
                coarse.advance(dt_s, inertia, dragged).is_ok().then_some(coarse)
            }
            (None, None) if before.resumes => {
                let bars = fine.cable.meshing.even_bars;
                let coarse = || at_rest_with_bars(problem, settings, fine, bars / 2, &answer, dragged);
                if bars >= LEAST_BARS { coarse().map(Box::new) } else { None }
            }
            (None, None) => None,
        };
        let Some(coarse) = coarse else { return };
        // Friction carries the errors of the steps that it remembers.
        self.errors = before.errors.componentwise_max(&ErrorEstimates::between(&coarse.solution(), &answer));
        self.coarse = Some(coarse);
    }
}

/// The answer of `spans` one step later, if it has one.
fn advance_spans(spans: &mut SpansModel, dt_s: f64, dragged: &[Option<Vec2>]) -> Option<CableSolution> {
    for (k, at) in dragged.iter().enumerate() {
        if let Some(at) = at {
            spans.drag_support(k, *at);
        }
    }
    spans.advance(dt_s, Inertia::QuasiStatic).ok()?;
    Some(spans.solution())
}

/// Errors of a cable from the same cable on bars twice and four times as long, and the one on bars
/// twice as long. None if that does not come to rest.
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

/// Errors of an answer against one without a mesh.
fn errors_beside(answer: &CableSolution, exact: &CableSolution, problem: &Problem) -> ErrorEstimates {
    ErrorEstimates::between(answer, exact).plus(&ErrorEstimates::rounding(exact, problem))
}

/// Leads the outline of the robot beside one cable to where it is led beside another.
fn lead_outline(cable: &mut Stepper, like: &Stepper) {
    if let (Some(outline), Some(leads)) = (&mut cable.cable.outline, &like.cable.outline) {
        outline.lead_to(leads.to.1);
    }
}

fn exceeds(errors: &ErrorEstimates, answer: &CableSolution, settings: Settings) -> bool {
    errors.relative(answer).is_some_and(|e| e > settings.tolerance)
}

/// The same cable with another number of bars, at rest near an answer.
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
    lead_outline(&mut other, like);
    other.solver.work_of_advance = like.solver.work_of_advance;
    other.warm_start(answer, like.cable.time(), dragged).ok()?;
    if !other.rested {
        other.solver.work_left = WorkBudget::Left(like.cable.mesh.tuning.equilibrium.max_work / ESTIMATES_PER_SEARCH);
        let found = other.settle(dragged);
        other.solver.work_left = WorkBudget::Unlimited;
        found.ok()?;
    }
    Some(other)
}
