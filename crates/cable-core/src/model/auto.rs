//! The chooser takes the cheapest model that can answer, and says why.

use std::sync::Arc;

use super::{Inertia, Model};
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;

/// A question about a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// The equilibrium.
    Rest,
    /// The motion over time.
    History(Inertia),
}

/// Returns whether nothing but pulleys holds the cable.
fn runs_free(problem: &Problem) -> bool {
    let held = |s: &SupportPoint| s.at.is_some() && s.kind != SupportKind::Pulley;
    problem.supports.iter().any(|s| s.kind == SupportKind::Pulley) && !problem.supports.iter().any(held)
}

/// The model for a question, and the reason in one sentence.
#[must_use]
pub fn choose(problem: &Problem, question: Question) -> (Model, String) {
    if question == Question::History(Inertia::Dynamic) {
        (Model::Fem, "masses move".to_owned())
    } else if !problem.cable.friction_mobilised.is_default() {
        (Model::Spans, "friction is fully mobilised towards one end".to_owned())
    } else if problem.bending_stiffness > 0.0 {
        (Model::Fem, "the cable has bending stiffness".to_owned())
    } else if problem.cable.self_contact {
        (Model::Fem, "the cable can touch itself".to_owned())
    } else if problem.floor_friction.is_some() {
        (Model::Fem, "in plan view the floor rubs everywhere".to_owned())
    } else if !problem.world.is_empty() || problem.outline.is_some() {
        (Model::Spans, "a taut cable among obstacles: contacts as intervals have no discretisation error".to_owned())
    } else if runs_free(problem) {
        (Model::Spans, "an end hangs over pulleys: contacts as intervals find where it stops running".to_owned())
    } else if problem.supports.iter().any(|s| s.wheel_radius > 0.0 && s.friction > 0.0) {
        // `catenary` keeps the friction of a whole wheel as one number: it finds some motions
        // slowly and some not at all.
        (Model::Spans, "the cable rubs on wheels: contacts as intervals have no discretisation error".to_owned())
    } else {
        (Model::Catenary, "supports only: the elastic catenary has no discretisation error".to_owned())
    }
}

/// The model for all cables of a scene, the one that takes on most of those chosen, and the reason
/// in one sentence.
#[must_use]
pub(crate) fn choose_for_all(problems: &[Arc<Problem>], question: Question) -> (Model, String) {
    let chosen = problems.iter().map(|p| choose(p, question));
    chosen.max_by_key(|(model, _)| model.rank()).unwrap_or((Model::Catenary, String::new()))
}

/// Returns what is built where a model was chosen: `spans` and `fem` take turns.
#[must_use]
pub(crate) fn built_for(chosen: Model) -> Model {
    if chosen == Model::Spans { Model::Auto } else { chosen }
}
