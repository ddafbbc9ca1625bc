//! This module chooses the cheapest model that can answer, and gives the reason.

use std::sync::Arc;

use super::{Inertia, Model};
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;
use crate::solution::ModelReason;

/// A question about a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// The equilibrium.
    Rest,
    /// The motion over time.
    History(Inertia),
}

/// Returns whether pulleys alone hold the cable.
fn runs_free(problem: &Problem) -> bool {
    let is_in_place = |s: &SupportPoint| s.at.is_some() && s.kind != SupportKind::Pulley;
    problem.supports.iter().any(|s| s.kind == SupportKind::Pulley) && !problem.supports.iter().any(is_in_place)
}

/// The model for a question, and the reason.
#[must_use]
pub fn choose(problem: &Problem, question: Question) -> (Model, ModelReason) {
    if question == Question::History(Inertia::Dynamic) {
        (Model::Fem, ModelReason::Inertia)
    } else if !problem.cable.friction_mobilised.is_default() {
        (Model::Spans, ModelReason::MobilisedFriction)
    } else if problem.bending_stiffness > 0.0 {
        (Model::Fem, ModelReason::BendingStiffness)
    } else if problem.floor_friction.is_some() {
        (Model::Fem, ModelReason::FloorFriction)
    } else if problem.cable.self_contact {
        // `fem` takes over if its strands meet.
        (Model::Spans, ModelReason::ClearOfItself)
    } else if !problem.world.is_empty() || problem.outline.is_some() {
        (Model::Spans, ModelReason::Obstacles)
    } else if runs_free(problem) {
        (Model::Spans, ModelReason::EndOverPulleys)
    } else if problem.supports.iter().any(|s| s.wheel_radius > 0.0 && s.friction > 0.0) {
        // `catenary` stores the friction of a whole wheel as one number: it follows some motions
        // slowly and some not at all.
        (Model::Spans, ModelReason::WheelFriction)
    } else {
        (Model::Catenary, ModelReason::SupportsOnly)
    }
}

/// The model for all cables of a scene: the most capable of those chosen for each, and the reason.
#[must_use]
pub(crate) fn choose_for_all(problems: &[Arc<Problem>], question: Question) -> (Model, ModelReason) {
    let chosen = problems.iter().map(|p| choose(p, question));
    chosen.max_by_key(|(model, _)| model.rank()).unwrap_or((Model::Catenary, ModelReason::SupportsOnly))
}

/// The model that answers for the equilibrium of cables that will move: `spans`, from which
/// [`Model::MOST_CAPABLE`] takes over when motion begins. None if another model would be needed,
/// which cannot move.
#[must_use]
pub(crate) fn before_motion<'a>(mut cables: impl Iterator<Item = &'a Problem>) -> Option<Model> {
    let is_spans = cables.all(|problem| choose(problem, Question::Rest).0 == Model::Spans);
    is_spans.then_some(Model::Spans)
}

/// Returns the model that is built for a chosen one: `spans` and `fem` take turns, and `catenary`
/// has a fallback for wheels that the cable leaves.
#[must_use]
pub(crate) fn built_for(chosen: Model) -> Model {
    if matches!(chosen, Model::Spans | Model::Catenary) { Model::Auto } else { chosen }
}
