//! These sentences say why an answer comes from its model.

use super::figures::{Figures, percent};
use super::{Sentence, display_in_si, serialize_in_si};
use crate::solution::{AssumedStiffness, LikelyBending, ModelReason, NeglectedEffect, NextCheaper};
use crate::units::{Quantity, UnitSystem};

display_in_si!(ModelReason, LikelyBending, NextCheaper);
serialize_in_si!(ModelReason);

impl Sentence for ModelReason {
    fn sentence(&self, units: UnitSystem) -> String {
        let text = match self {
            Self::Requested => "asked for",
            Self::Recorded => "read from a run",
            Self::Inertia => "masses move",
            Self::MobilisedFriction => "friction is fully mobilised towards one end",
            Self::BendingStiffness => "the cable has bending stiffness",
            Self::SelfContact => "the cable can touch itself",
            Self::ClearOfItself => {
                "the cable could touch itself but does not at rest; solved without a mesh and so without mesh error"
            }
            Self::FloorFriction => "in plan view the floor rubs everywhere",
            Self::Obstacles => "a taut cable among obstacles, solved without a mesh and so without mesh error",
            Self::EndOverPulleys => "an end hangs over pulleys; this model finds where it stops running",
            Self::WheelFriction => "the cable rubs on wheels, solved without a mesh and so without mesh error",
            Self::SupportsOnly => "the cable touches only its supports, so the elastic catenary has no mesh error",
            Self::LooseCable => "the cable lies loose: what hangs is plumb, what lies has no tension",
            Self::TouchesRobot => "the cable touches the robot, which moves",
            Self::BuriedWithoutMesh => "the cable was not found clear of the ground without a mesh",
            Self::NoAnswer(error) | Self::Unsound(error) => return error.sentence(units),
            Self::Bending { reason, bending } => {
                return format!("{}; {}", reason.sentence(units), bending.sentence(units));
            }
        };
        text.to_owned()
    }
}

impl Sentence for LikelyBending {
    fn sentence(&self, units: UnitSystem) -> String {
        let listed = |cables: &[AssumedStiffness]| {
            let each = cables.iter().map(|c| {
                let stiffness = Figures(units).given(Quantity::BendingStiffness, c.bending_stiffness_n_m2);
                format!("`{}` with {stiffness}", c.cable)
            });
            let all = each.collect::<Vec<_>>().join(", ");
            format!("the likely bending stiffness of its preset was used: {all}")
        };
        match self {
            Self::Assumed(cables) => listed(cables),
            Self::AssumedWhereItMatters(cables) => {
                format!(
                    "without bending stiffness it bends too tightly, lies in folds or crosses itself, so {}",
                    listed(cables)
                )
            }
            Self::NoAnswer(error) => {
                format!("with the likely bending stiffness of its preset there is no answer: {}", error.sentence(units))
            }
        }
    }
}

/// Difference of forces, in parts of the greatest tension, below which two answers are the same:
/// that of rounding.
const ANSWER_DIFFERENCE_FRACTION: f64 = 1e-9;

impl Sentence for NextCheaper {
    fn sentence(&self, units: UnitSystem) -> String {
        let f = Figures(units);
        let what = match self.neglects {
            NeglectedEffect::BendingStiffness => "bending stiffness",
            NeglectedEffect::SelfContact => "contact of the cable with itself",
            NeglectedEffect::FloorFriction => "the friction of the floor",
            NeglectedEffect::Obstacles => "obstacles",
            NeglectedEffect::WheelFriction => "the friction of wheels",
            NeglectedEffect::Inertia => "inertia",
        };
        let Some((force, place)) = self.force_error.zip(self.position_error_m) else {
            if self.costs_more {
                return format!("{}, ignoring {what}, takes more work and was not followed to the end", self.model);
            }
            let fails =
                if self.neglects == NeglectedEffect::Inertia { "does not come to the end" } else { "has no answer" };
            return format!("{}, ignoring {what}, {fails}", self.model);
        };
        if force <= ANSWER_DIFFERENCE_FRACTION {
            return format!("{}, ignoring {what}, gives the same answer", self.model);
        }
        let force = percent(force);
        let place = f.length(place, 3);
        format!(
            "{}, ignoring {what}, would be off by {force} of the greatest tension and by {place} in shape",
            self.model
        )
    }
}
