//! Chooses the cheapest model that can answer, and says why.

use super::Model;
use crate::problem::Problem;

/// The model for a question at rest, and the reason in one sentence.
#[must_use]
pub fn choose(problem: &Problem) -> (Model, String) {
    if problem.bending_stiffness > 0.0 {
        (Model::Fem, "the cable has bending stiffness".to_owned())
    } else if !problem.world.is_empty() || problem.floor_friction.is_some() {
        (Model::Fem, "the scene has obstacles the cable can touch".to_owned())
    } else {
        (Model::Catenary, "supports only: the elastic catenary has no discretisation error".to_owned())
    }
}
