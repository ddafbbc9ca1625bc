//! This file lists the features of a scene, or of a question about it, that a model lacks.

use super::equilibrium_fault::EquilibriumFault;
use crate::math::Vec2;

/// A capability that a model lacks.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Unsupported {
    /// The cable has bending stiffness.
    BendingStiffness,
    /// A cable with bending stiffness runs over a pulley.
    BendingOverPulleys,
    /// The scene is seen from above.
    PlanView,
    /// The cable is an obstacle to itself.
    SelfContact,
    /// The cable is an obstacle to itself and runs over a pulley.
    SelfContactWithPulleys,
    /// The cable touches itself where the search for an equilibrium begins.
    SelfContactAtStart {
        /// Place on the cable, m.
        arc_length_m: f64,
    },
    /// A support lets go at some time.
    Release,
    /// Masses accelerate.
    Inertia,
    /// Friction is asked for that is fully mobilised towards one end.
    MobilisedFriction {
        /// The name of the choice in files.
        towards: &'static str,
    },
    /// The model is built by the program that uses the library.
    ExternalModel,
    /// An obstacle moves.
    MovingObstacle,
    /// The cable reaches an obstacle.
    Obstacle {
        /// Place on the cable, m.
        arc_length_m: f64,
    },
    /// An obstacle is met where the model can begin no contact.
    ContactImpossible {
        /// Place on the cable, m.
        arc_length_m: f64,
        /// Its place, m.
        at_m: Vec2,
    },
    /// The cable lifts off the wheel of a pulley.
    OffWheel {
        /// The pulley's name.
        support: String,
    },
    /// The cable comes back to a wheel that it has left, and that moves.
    BackOnWheel {
        /// The pulley's name.
        support: String,
    },
    /// No fixed support holds the cable.
    NothingHolds,
    /// A support holds no point of the cable.
    SupportWithoutPlace,
    /// The search for the contacts does not end.
    EndlessContacts {
        /// Place on the cable, m.
        arc_length_m: f64,
    },
    /// The cable would jump over a corner.
    CornerPassed {
        /// Position of the corner, m.
        at_m: Vec2,
    },
    /// A support is inside an obstacle.
    SupportInside {
        /// Its place, m.
        at_m: Vec2,
    },
    /// A point load rests on an obstacle.
    LoadOnObstacle {
        /// Place on the cable, m.
        arc_length_m: f64,
    },
    /// A load between the ends of a stiff cable, or one that pulls away from the wheel, comes to a
    /// pulley.
    LoadAtPulley {
        /// The pulley's name.
        support: String,
        /// Place of the load on the cable, m.
        arc_length_m: f64,
    },
    /// A part of the cable without tension is drawn along.
    LooseCableDrawn {
        /// Start of that part, m.
        arc_length_m: f64,
    },
    /// The answer of the model does not pass its own verification.
    Unverified {
        /// The fault.
        finding: EquilibriumFault,
        /// Place on the cable, m.
        arc_length_m: f64,
        /// Its place, m.
        at_m: Vec2,
    },
    /// A state without nodes.
    EmptyState,
    /// A state of a cable of another length.
    StateOfOtherLength,
    /// A state of the whole cable, for one that is broken.
    StateOfWholeCable,
    /// An edit that a broken cable cannot follow.
    EditOfBrokenCable,
    /// A support moves faster than masses are followed.
    MotionTooFast {
        /// The support's name.
        support: String,
        /// Its greatest speed, m/s.
        speed_m_per_s: f64,
        /// The time when that is, s.
        time_s: f64,
        /// The greatest speed that is followed, m/s.
        limit_m_per_s: f64,
    },
    /// A question about the safe reach that has no answer.
    Reach(UnsupportedReach),
}

impl Unsupported {
    /// The same, its places brought back from a similar copy of the scene.
    pub(crate) fn with_places(self, length: impl Fn(f64) -> f64, place: impl Fn(Vec2) -> Vec2) -> Self {
        match self {
            Self::SelfContactAtStart { arc_length_m: s } => Self::SelfContactAtStart { arc_length_m: length(s) },
            Self::Obstacle { arc_length_m: s } => Self::Obstacle { arc_length_m: length(s) },
            Self::ContactImpossible { arc_length_m: s, at_m } => {
                Self::ContactImpossible { arc_length_m: length(s), at_m: place(at_m) }
            }
            Self::EndlessContacts { arc_length_m: s } => Self::EndlessContacts { arc_length_m: length(s) },
            Self::CornerPassed { at_m } => Self::CornerPassed { at_m: place(at_m) },
            Self::SupportInside { at_m } => Self::SupportInside { at_m: place(at_m) },
            Self::LoadOnObstacle { arc_length_m: s } => Self::LoadOnObstacle { arc_length_m: length(s) },
            Self::LoadAtPulley { support, arc_length_m: s } => Self::LoadAtPulley { support, arc_length_m: length(s) },
            Self::LooseCableDrawn { arc_length_m: s } => Self::LooseCableDrawn { arc_length_m: length(s) },
            Self::Unverified { finding, arc_length_m: s, at_m } => {
                Self::Unverified { finding, arc_length_m: length(s), at_m: place(at_m) }
            }
            same => same,
        }
    }
}

/// The reason why a question about the safe reach has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnsupportedReach {
    /// No cable has the index asked for.
    NoSuchCable,
    /// The support asked for has no place to start from.
    SupportWithoutPlace,
    /// The grid has no places.
    EmptyGrid,
    /// The grid has more places than are computed.
    GridTooLarge,
    /// A cable hangs on a robot that the scene does not have.
    HitchWithoutRobot,
    /// The scene has no robot.
    NoRobot,
    /// No preset describes the robot.
    UnknownRobot,
    /// No cable hangs on the robot.
    RobotWithoutCable,
    /// The cable is broken in the answer to start from.
    BrokenCable,
}
