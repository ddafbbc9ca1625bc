//! This module refuses prescribed, fully mobilised friction for models that compute the mobilised
//! friction themselves.

use crate::error::{SolveError, Unsupported};
use crate::model_id::Model;
use crate::problem::Problem;

/// Refuses friction that is fully mobilised towards one end, for a model that computes the
/// mobilised friction itself.
///
/// # Errors
/// `Unsupported`.
pub(super) fn refuse_mobilised(model: Model, problem: &Problem) -> Result<(), SolveError> {
    let mobilised = problem.cable.friction_mobilised;
    if mobilised.is_default() || model.capabilities().mobilised_friction {
        return Ok(());
    }
    let feature = Unsupported::MobilisedFriction { towards: mobilised.name() };
    Err(SolveError::Unsupported { model, feature })
}
