//! A model reason says why an answer comes from the model it comes from; [`crate::wording`] makes
//! the sentence.

use crate::error::SolveError;

/// The reason why an answer comes from its model.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum ModelReason {
    /// The user asked for it.
    #[default]
    Requested,
    /// The answer was read from a run.
    Recorded,
    /// Masses move.
    Inertia,
    /// The friction of the cable is mobilised towards one end.
    MobilisedFriction,
    /// The cable has bending stiffness.
    BendingStiffness,
    /// The cable can touch itself: its strands meet, or time runs.
    SelfContact,
    /// The cable could touch itself, and does so nowhere at rest.
    ClearOfItself,
    /// The floor of a plan view rubs everywhere.
    FloorFriction,
    /// A taut cable among obstacles.
    Obstacles,
    /// An end hangs over pulleys.
    EndOverPulleys,
    /// The cable rubs on wheels.
    WheelFriction,
    /// The cable touches nothing but its supports.
    SupportsOnly,
    /// The cable lies loose.
    LooseCable,
    /// The cable touches the robot, which moves.
    TouchesRobot,
    /// The model without a mesh did not find the cable clear of the ground.
    BuriedWithoutMesh,
    /// The model before it has no answer.
    NoAnswer(Box<SolveError>),
    /// The answer of the model before it breaks a law.
    Unsound(Box<SolveError>),
    /// The bending stiffness of flexible cables was settled, too.
    Bending {
        /// The reason for that model.
        reason: Box<Self>,
        /// The bending stiffness that was used.
        bending: LikelyBending,
    },
}

impl ModelReason {
    /// The same reason for a scene in which use was made of likely bending stiffness.
    #[must_use]
    pub fn with_bending(self, bending: LikelyBending) -> Self {
        Self::Bending { reason: Box::new(self), bending }
    }
}

/// The use made of the bending stiffness that is likely of the presets of flexible cables.
#[derive(Clone, Debug, PartialEq)]
pub enum LikelyBending {
    /// It was assumed, as the user asked.
    Assumed(Vec<AssumedStiffness>),
    /// It was assumed because the answer without it is not that of a cable.
    AssumedWhereItMatters(Vec<AssumedStiffness>),
    /// There is no answer with it.
    NoAnswer(Box<SolveError>),
}

/// The bending stiffness that was assumed for a cable.
#[derive(Clone, Debug, PartialEq)]
pub struct AssumedStiffness {
    /// Name of the cable.
    pub cable: String,
    /// Bending stiffness, N·m².
    pub bending_stiffness_n_m2: f64,
}
