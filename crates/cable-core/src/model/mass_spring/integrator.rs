//! The integrator of dynamic steps is explicit, or that of the preview.

use crate::model::mass_spring::MassSpringModel;
use crate::model::settings::Stepping;

/// Explicit sub-steps in a display frame of 1/60 s beyond which a step is a preview, unless asked
/// otherwise. At 100 elements they take some 100 ms a simulated second.
pub(in crate::model::mass_spring) const MOST_SUB_STEPS: f64 = 1000.0;

impl MassSpringModel {
    /// Returns whether a dynamic step is to be a preview.
    pub(in crate::model::mass_spring) fn previews(&self) -> bool {
        !(self.problem.bending_stiffness > 0.0)
            && match self.settings.stepping {
                Stepping::Explicit => false,
                Stepping::Preview => true,
                // Of even elements: a short one beside a pulley comes and goes, and a run must not
                // change its ways.
                Stepping::Auto => {
                    let swing = (self.problem.axial_stiffness / self.problem.linear_density).sqrt();
                    self.chain.even / swing * MOST_SUB_STEPS < 1.0 / 60.0
                }
            }
    }
}
