//! The cause of a warning carries the figures that belong to this kind of cause.

use serde::{Deserialize, Serialize};

use super::histories::{Histories, ShownEquilibrium};
use super::kind::WarningKind;
use crate::model_id::Model;
use crate::units::Quantity;

/// The cause of a warning, with the figures that its place, value and limit do not give.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum WarningCause {
    /// Tension above the service tension.
    AboveService {
        /// The time in the step, s; None = at rest.
        time_s: Option<f64>,
    },
    /// Tension above the breaking tension for an instant too short to break the cable.
    BrieflyAboveBreaking {
        /// Time, s.
        time_s: f64,
        /// Breaking tension, N.
        breaking_n: f64,
        /// Greatest mean tension, N.
        held_n: f64,
        /// Time over which the mean is taken, s.
        over_s: f64,
    },
    /// Tension above the breaking tension, in a scene whose cables do not break.
    AboveBreaking {
        /// The mean in which it is; None = at rest.
        mean: Option<MeanTension>,
    },
    /// Tension above the breaking tension in a cable that broke: its pieces are not watched until
    /// the wave of the break has crossed them and come back.
    AboveBreakingAfterBreak {
        /// The mean in which it is.
        mean: MeanTension,
    },
    /// The cable broke.
    Broke {
        /// Time, s.
        time_s: f64,
        /// Time over which the mean tension reached its strength, s; 0 = it is an instant's.
        over_s: f64,
        /// The support that it tore off; None = it broke in between.
        detached_from: Option<String>,
    },
    /// A finer run may differ on whether the cable breaks.
    BreakageUncertain {
        /// True if it broke.
        broke: bool,
        /// Greatest mean tension, N.
        held_n: f64,
        /// The least that it may be, N; the value of the warning is the most.
        lowest_n: f64,
        /// Time over which the mean is taken, s.
        over_s: f64,
    },
    /// Bent round something narrower than the smallest bend radius.
    NarrowGuide,
    /// Bent too sharply where nothing guides it.
    FreeKink,
    /// Pressed too hard against a guide.
    Pressure,
    /// Cable lies without tension on less ground than it is long.
    Folds {
        /// Length of the cable in folds, m.
        material_m: f64,
        /// Length of what it lies on, m.
        ground_m: f64,
        /// True if it lies on something; false = seen from above, or without weight.
        on_ground: bool,
    },
    /// A long part has less tension than a limit.
    LowTension {
        /// That limit, N.
        below_n: f64,
    },
    /// The cable crosses itself.
    Crossing {
        /// Arc length of the second strand at the crossing, m.
        other_arc_length_m: f64,
        /// Number of crossings of the cable.
        count: usize,
    },
    /// A free part turns most of the way round.
    TightTurn {
        /// Length within which it turns, m.
        within_m: f64,
    },
    /// The cable goes round an obstacle.
    RoundObstacle {
        /// The obstacle's name.
        obstacle: String,
    },
    /// An obstacle holds the cable while the pull grows.
    Caught {
        /// The obstacle's name.
        obstacle: String,
        /// Ratio of the tensions beside the contact when it began to stick.
        first_ratio: f64,
    },
    /// Without weight a slack cable has any shape.
    Weightless,
    /// An equilibrium that the least push ends.
    Unstable,
    /// The cable lies loose on the ground.
    Loose {
        /// Length that lies loose, m.
        material_m: f64,
        /// Length of ground under it, m.
        ground_m: f64,
        /// The most by which friction on it can hold, N.
        held_n: f64,
    },
    /// With friction there are many equilibria.
    ManyEquilibria {
        /// The one that is shown.
        shown: ShownEquilibrium,
        /// Other loading histories.
        histories: Histories,
    },
    /// An obstacle blocks a support, at the warning's place.
    Blocked {
        /// The support's name.
        support: String,
        /// The obstacle's name.
        obstacle: String,
        /// The displacement from there to its target, m.
        short_m: [f64; 2],
    },
    /// A support follows its target at a greatest speed, which is the limit.
    Lags {
        /// The support's name.
        support: String,
        /// Its distance from the target, m.
        behind_m: f64,
    },
    /// A support is behind the hand that pulls it, or the hand behind its target.
    HandLags {
        /// The support's name.
        support: String,
        /// Its distance from the hand, m; None = it keeps up.
        behind_m: Option<f64>,
        /// Distance of the hand from its target, m; 0 = it is there.
        hand_behind_m: f64,
        /// Force of the hand, N.
        pull_n: f64,
        /// Stiffness of its spring, N/m.
        stiffness_n_per_m: f64,
    },
    /// The cable hangs clear of a wheel.
    ClearOfWheel {
        /// The pulley's name.
        pulley: String,
    },
    /// The route was below the ground.
    RouteBuried {
        /// The ground's name.
        obstacle: String,
    },
    /// A support was on a surface.
    SupportOnSurface {
        /// The support's name.
        support: String,
        /// The obstacle's name.
        obstacle: String,
    },
    /// The robot does not drive its path, because the terrain ends below its tracks.
    RobotWithoutGround,
    /// The cable lies through the robot.
    RobotIgnored {
        /// The model, which knows nothing of the robot.
        model: Model,
    },
    /// The robot drives through an obstacle: only terrain stops it.
    RobotInObstacle {
        /// The obstacle's name.
        obstacle: String,
    },
    /// The cable slid from where it was laid to where it rests.
    SlidFromRoute {
        /// The reason why it did.
        why: SlideReason,
    },
    /// Nothing held the cable, and it slid on.
    SlidOn,
    /// Velocities were cut to the limit.
    SpeedCut,
    /// It moves faster than the models stand for.
    TooFast,
    /// Kinetic energy was cut to the limit.
    EnergyCut,
    /// The cable is too stiff for explicit steps; the value is the step taken.
    StiffPreview,
    /// The cable has more energy than what moves it can have given.
    EnergyFromNowhere {
        /// The instant from which that is counted, s.
        from_s: f64,
        /// The most work done on the cable since, J.
        work_j: f64,
        /// The greatest speed, m/s.
        speed_m_per_s: f64,
    },
    /// Tension beyond a corner depends on the mesh.
    CornerOfMesh {
        /// The obstacle's name.
        obstacle: String,
        /// Turn at the corner, °.
        turn_deg: f64,
        /// Length of the elements, m.
        element_m: f64,
    },
    /// The mesh is too coarse for the bend of a stiff cable.
    CoarseBend {
        /// Number of bars.
        bars: usize,
    },
    /// The contacts of a stiff cable are those of a chain of bars.
    BarContacts,
    /// The mesh is too coarse for the forces.
    CoarseForces {
        /// Number of elements.
        elements: usize,
    },
    /// The mesh is too coarse for the greatest tension.
    CoarseTension {
        /// Number of elements.
        elements: usize,
    },
    /// No speed was found at which robot and cable agree; value and limit are in parts of the
    /// forces on the robot.
    RobotOutOfBalance {
        /// The force that is left between them, N.
        left_n: f64,
    },
    /// A warning that was kept only as a sentence.
    Recorded {
        /// The kind.
        kind: WarningKind,
        /// The sentence, in SI units.
        message: String,
    },
}

/// A mean tension in a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeanTension {
    /// Time over which it is taken, s.
    pub over_s: f64,
    /// The time when it is greatest, s.
    pub time_s: f64,
}

/// The reason why a cable slid from where it was laid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SlideReason {
    /// Nothing there has friction.
    NoFriction,
    /// More friction would have held it.
    TooLittleFriction {
        /// The friction that would hold it, relative to the friction that there is.
        friction_ratio: f64,
    },
    /// Nothing holds all of its loads.
    UnheldForce {
        /// The unbalanced force, N.
        left_n: f64,
        /// All loads, N.
        loads_n: f64,
    },
    /// Nothing holds it there.
    NothingHolds,
}

impl WarningCause {
    /// The other histories, of a warning that there are many equilibria.
    #[must_use]
    pub fn histories(&self) -> Option<&Histories> {
        match self {
            Self::ManyEquilibria { histories, .. } => Some(histories),
            _ => None,
        }
    }

    /// The support that is not where it is sent.
    pub(crate) fn lagging_support(&self) -> Option<&str> {
        match self {
            Self::Lags { support, .. } | Self::HandLags { support, .. } => Some(support),
            _ => None,
        }
    }

    /// The kind to which it belongs.
    #[must_use]
    pub fn kind(&self) -> WarningKind {
        match self {
            Self::AboveService { .. } | Self::BrieflyAboveBreaking { .. } => WarningKind::ServiceTension,
            Self::AboveBreaking { .. } | Self::AboveBreakingAfterBreak { .. } => WarningKind::BreakingTension,
            Self::Broke { .. } => WarningKind::Broken,
            Self::BreakageUncertain { .. } => WarningKind::MayBreak,
            Self::NarrowGuide => WarningKind::BendRadius,
            Self::FreeKink => WarningKind::Kink,
            Self::Pressure => WarningKind::SidewallPressure,
            Self::Folds { .. } | Self::LowTension { .. } => WarningKind::Slack,
            Self::Crossing { .. } => WarningKind::Loop,
            Self::TightTurn { .. } => WarningKind::Curl,
            Self::RoundObstacle { .. } => WarningKind::Wrapped,
            Self::Caught { .. } => WarningKind::Snag,
            Self::Weightless | Self::Unstable | Self::Loose { .. } | Self::ManyEquilibria { .. } => {
                WarningKind::NotUnique
            }
            Self::Blocked { .. } | Self::Lags { .. } | Self::HandLags { .. } | Self::RobotWithoutGround => {
                WarningKind::SupportHeld
            }
            Self::RouteBuried { .. } | Self::SupportOnSurface { .. } => WarningKind::InitialPenetration,
            Self::ClearOfWheel { .. } => WarningKind::ClearOfWheel,
            Self::RobotIgnored { .. } => WarningKind::ThroughRobot,
            Self::RobotInObstacle { .. } => WarningKind::RobotInObstacle,
            Self::SlidFromRoute { .. } | Self::SlidOn | Self::SpeedCut | Self::EnergyCut | Self::StiffPreview => {
                WarningKind::Stabilised
            }
            Self::EnergyFromNowhere { .. } => WarningKind::EnergyGrows,
            Self::CornerOfMesh { .. }
            | Self::CoarseBend { .. }
            | Self::BarContacts
            | Self::CoarseForces { .. }
            | Self::CoarseTension { .. }
            | Self::TooFast
            | Self::RobotOutOfBalance { .. } => WarningKind::Accuracy,
            Self::Recorded { kind, .. } => *kind,
        }
    }

    /// The quantity of the warning's value and limit.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        match self {
            Self::SpeedCut | Self::TooFast | Self::Lags { .. } | Self::HandLags { .. } => Quantity::Speed,
            Self::EnergyCut => Quantity::Energy,
            Self::StiffPreview => Quantity::Time,
            Self::Blocked { .. } => Quantity::Length,
            _ => self.kind().quantity(),
        }
    }

    /// The same of a scene whose lengths and times are so many times those of this one. Only what
    /// models warn of is ever scaled; the monitors see the scene as it is.
    pub(super) fn scaled(mut self, length: f64, time: f64) -> Self {
        let force_per_length = Quantity::ForcePerLength.scale(length, time);
        match &mut self {
            Self::Loose { material_m, ground_m, .. } => {
                *material_m *= length;
                *ground_m *= length;
            }
            Self::Blocked { short_m, .. } => *short_m = short_m.map(|m| m * length),
            Self::Lags { behind_m, .. } => *behind_m *= length,
            Self::HandLags { behind_m, hand_behind_m, stiffness_n_per_m, .. } => {
                *behind_m = behind_m.map(|m| m * length);
                *hand_behind_m *= length;
                *stiffness_n_per_m *= force_per_length;
            }
            Self::CornerOfMesh { element_m, .. } => *element_m *= length,
            _ => {}
        }
        self
    }
}
