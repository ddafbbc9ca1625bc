//! How dynamic steps are taken: explicit, or as a preview.

use serde::{Deserialize, Serialize};

use super::MassSpringModel;

/// Explicit sub-steps in a display frame of 1/60 s beyond which a step is a preview, unless asked otherwise. At 100
/// elements they take some 100 ms a simulated second.
pub(super) const MOST_SUB_STEPS: f64 = 1000.0;

/// How mass-spring takes dynamic steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stepping {
    /// Explicit, or a preview where that would take more than 1000 sub-steps in 1/60 s.
    #[default]
    Auto,
    /// Always explicit.
    Explicit,
    /// Always a preview (cables with bending stiffness excepted).
    Preview,
}

impl Stepping {
    /// The ways of a name on the command line.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "auto" => Some(Self::Auto),
            "explicit" => Some(Self::Explicit),
            "preview" => Some(Self::Preview),
            _ => None,
        }
    }
}

impl MassSpringModel {
    /// Whether a dynamic step is to be a preview.
    pub(super) fn previews(&self) -> bool {
        !(self.problem.bending_stiffness > 0.0)
            && match self.settings.stepping {
                Stepping::Explicit => false,
                Stepping::Preview => true,
                // Of even elements: a short one beside a pulley comes and goes, and a run must not change its ways.
                Stepping::Auto => {
                    let swing = (self.problem.axial_stiffness / self.problem.linear_density).sqrt();
                    self.even / swing * MOST_SUB_STEPS < 1.0 / 60.0
                }
            }
    }
}
