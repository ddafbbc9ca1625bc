//! A [`Warning`] carries its kind, its place, its cause and its numbers as data;
//! [`crate::wording`] makes the sentence.

use serde::{Deserialize, Serialize};

use super::error_estimates::greatest_tension;
use super::{CableSolution, Node};
use crate::math::{larger, smaller};
use crate::model_id::Model;
use crate::units::Quantity;

/// Something the user should know, with its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// The kind.
    pub kind: WarningKind,
    /// The cable's name.
    pub cable: String,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Place in the plane, m; None = at the cable's point of that arc length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_m: Option<[f64; 2]>,
    /// Since when, s; None = it is about the last step alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub since_s: Option<f64>,
    /// The value, in the SI unit of [`WarningCause::quantity`].
    pub value: f64,
    /// Its limit, same unit.
    pub limit: f64,
    /// The cause within its kind, with the figures that only this cause has.
    pub cause: WarningCause,
}

impl Warning {
    /// A warning about the last step, or about an answer at rest; its kind is that of its cause.
    #[must_use]
    pub fn new(cause: WarningCause, cable: &str, arc_length_m: f64, [value, limit]: [f64; 2]) -> Self {
        Self {
            kind: cause.kind(),
            cable: cable.to_owned(),
            arc_length_m,
            at_m: None,
            since_s: None,
            value,
            limit,
            cause,
        }
    }

    /// The same at a place in the plane, m.
    #[must_use]
    pub fn at(self, at_m: [f64; 2]) -> Self {
        Self { at_m: Some(at_m), ..self }
    }

    /// The same of a scene whose lengths are `length` times and whose times are `time` times those
    /// of this one; forces stay. Its place is the caller's to move.
    pub(crate) fn scaled(self, length: f64, time: f64) -> Self {
        let quantity = self.cause.quantity();
        Self {
            arc_length_m: self.arc_length_m * length,
            since_s: self.since_s.map(|s| s * time),
            value: self.value * quantity.scale(length, time),
            limit: self.limit * quantity.scale(length, time),
            cause: self.cause.scaled(length, time),
            ..self
        }
    }
}

/// The kinds of warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WarningKind {
    /// Tension above the service tension.
    ServiceTension,
    /// Tension above the breaking tension.
    BreakingTension,
    /// It broke here; value and limit are the breaking tension.
    Broken,
    /// It is open whether the cable breaks: the run is not fine enough to say, or no mesh is.
    MayBreak,
    /// Led round something narrower than the smallest bend radius allowed.
    BendRadius,
    /// Bent too sharply where nothing leads it.
    Kink,
    /// Pressed too hard sideways by what it is led round.
    SidewallPressure,
    /// A long part without tension.
    Slack,
    /// It crosses itself, or another part of itself lies across it.
    Loop,
    /// It curls up: a free part turns most of the way round.
    Curl,
    /// It goes round an obstacle once or more.
    Wrapped,
    /// An obstacle holds it fast while it is pulled harder and harder.
    Snag,
    /// With friction a resting place is not unique.
    NotUnique,
    /// A support was stopped by an obstacle, or its speed was capped.
    SupportHeld,
    /// The scene puts a support or the route into an obstacle: it was put outside.
    InitialPenetration,
    /// It hangs clear of the wheel of a pulley, which carries nothing.
    ClearOfWheel,
    /// It lies through the robot, of which the model knows nothing.
    ThroughRobot,
    /// Damping or velocity was raised to keep the motion stable.
    Stabilised,
    /// It has more energy than what moves it can have given; value and limit in J.
    EnergyGrows,
    /// The mesh is too coarse for the asked accuracy.
    Accuracy,
}

impl WarningKind {
    /// Every kind.
    pub const ALL: [Self; 20] = [
        Self::ServiceTension,
        Self::BreakingTension,
        Self::Broken,
        Self::MayBreak,
        Self::BendRadius,
        Self::Kink,
        Self::SidewallPressure,
        Self::Slack,
        Self::Loop,
        Self::Curl,
        Self::Wrapped,
        Self::Snag,
        Self::NotUnique,
        Self::SupportHeld,
        Self::InitialPenetration,
        Self::ClearOfWheel,
        Self::ThroughRobot,
        Self::Stabilised,
        Self::EnergyGrows,
        Self::Accuracy,
    ];

    /// The name used in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ServiceTension => "service-tension",
            Self::BreakingTension => "breaking-tension",
            Self::Broken => "broken",
            Self::MayBreak => "may-break",
            Self::BendRadius => "bend-radius",
            Self::Kink => "kink",
            Self::SidewallPressure => "sidewall-pressure",
            Self::Slack => "slack",
            Self::Loop => "loop",
            Self::Curl => "curl",
            Self::Wrapped => "wrapped",
            Self::Snag => "snag",
            Self::NotUnique => "not-unique",
            Self::SupportHeld => "support-held",
            Self::InitialPenetration => "initial-penetration",
            Self::ClearOfWheel => "clear-of-wheel",
            Self::ThroughRobot => "through-robot",
            Self::Stabilised => "stabilised",
            Self::EnergyGrows => "energy-grows",
            Self::Accuracy => "accuracy",
        }
    }

    /// The quantity of which value and limit are where the cause names no other.
    fn quantity(self) -> Quantity {
        match self {
            Self::ServiceTension | Self::BreakingTension | Self::Broken | Self::MayBreak => Quantity::Force,
            Self::BendRadius | Self::Kink | Self::Slack | Self::Loop | Self::InitialPenetration => Quantity::Length,
            Self::SidewallPressure => Quantity::ForcePerLength,
            Self::Curl => Quantity::Angle,
            Self::EnergyGrows => Quantity::Energy,
            Self::Wrapped
            | Self::Snag
            | Self::NotUnique
            | Self::SupportHeld
            | Self::ClearOfWheel
            | Self::ThroughRobot
            | Self::Stabilised
            | Self::Accuracy => Quantity::Number,
        }
    }

    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name() == name)
    }
}

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
        /// When, s.
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
    /// The cable broke.
    Broke {
        /// When, s.
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
        /// That tension, N.
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
    /// An obstacle blocks a support.
    Blocked {
        /// The support's name.
        support: String,
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
    /// The cable lies through the robot.
    RobotIgnored {
        /// The model, which knows nothing of the robot.
        model: Model,
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
    /// A warning of which only the sentence was kept.
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

/// Selection of the equilibrium that is shown among many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ShownEquilibrium {
    /// The one laid evenly along its route with the least sliding.
    EvenlyLaid,
    /// The one laid along its route with the least sliding.
    LeastSliding,
    /// The frictionless shape, held by friction.
    Frictionless,
    /// The one found from the route.
    FromRoute,
    /// The one found from the route; the histories are those of a flexible cable in its place.
    FromRouteAsFlexible,
}

/// The tensions that other loading histories would have left in a cable, N; ranges from the least
/// to the greatest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Histories {
    /// None was sought.
    NotSought,
    /// None was found.
    NotFound {
        /// Greatest tension as laid, N.
        greatest_n: f64,
    },
    /// Friction fully mobilised towards either end.
    Mobilised {
        /// Greatest tension as laid, N.
        greatest_n: f64,
        /// The same with friction mobilised towards the start, N; None = no equilibrium was found.
        towards_start_n: Option<f64>,
        /// The same towards the end, N.
        towards_end_n: Option<f64>,
        /// The same laid down loose, N; None = there is no cable to spare.
        #[serde(default)]
        loose_n: Option<f64>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
    },
    /// Each end drawn out or let in, and put back.
    EndsMoved {
        /// Greatest tension as laid, N.
        greatest_n: f64,
        /// The movements and what they left.
        moves: Vec<EndMove>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
        /// Range of the greatest tension, N.
        range_n: [f64; 2],
    },
    /// The slack of a cable that slides over pulleys without friction began in another span.
    SlackElsewhere {
        /// Greatest tension as laid, N.
        greatest_n: f64,
        /// The same of each of the others, N.
        others_n: Vec<f64>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
    },
    /// A stiff cable that is compressed was bowed to another side.
    BowedElsewhere {
        /// Greatest tension as laid, N; less than zero = all of it is compressed.
        greatest_n: f64,
        /// The same of each of the others, N.
        others_n: Vec<f64>,
        /// Range of the tension at the start, N.
        start_n: [f64; 2],
        /// Range of the tension at the end, N.
        end_n: [f64; 2],
    },
}

impl Histories {
    /// Other balances of a slack cable beside the one that is shown: the tensions of each at its
    /// start, at its end and at most, N. None where there is no other.
    #[must_use]
    pub(crate) fn slack_elsewhere(shown: [f64; 3], others: &[[f64; 3]]) -> Option<Self> {
        let [start_n, end_n] = ranges_at_ends(shown, others)?;
        let (greatest_n, others_n) = (shown[2], others.iter().map(|t| t[2]).collect());
        Some(Self::SlackElsewhere { greatest_n, others_n, start_n, end_n })
    }

    /// The same of a stiff cable that is compressed.
    #[must_use]
    pub(crate) fn bowed_elsewhere(shown: [f64; 3], others: &[[f64; 3]]) -> Option<Self> {
        let [start_n, end_n] = ranges_at_ends(shown, others)?;
        let (greatest_n, others_n) = (shown[2], others.iter().map(|t| t[2]).collect());
        Some(Self::BowedElsewhere { greatest_n, others_n, start_n, end_n })
    }

    /// The same of an answer that may be another equilibrium than the one they were sought from:
    /// it is the one as laid, and the ranges hold it.
    #[must_use]
    pub(crate) fn beside(mut self, answer: &CableSolution) -> Self {
        let tension = |node: Option<&Node>| node.map_or(0.0, |n| n.tension_n);
        let ends = [tension(answer.nodes.first()), tension(answer.nodes.last())];
        let most = greatest_tension(&answer.nodes);
        let widen = |range: &mut [f64; 2], n: f64| *range = [smaller(range[0], n), larger(range[1], n)];
        match &mut self {
            Self::NotSought => {}
            Self::NotFound { greatest_n } => *greatest_n = most,
            Self::Mobilised { greatest_n, start_n, end_n, .. }
            | Self::SlackElsewhere { greatest_n, start_n, end_n, .. }
            | Self::BowedElsewhere { greatest_n, start_n, end_n, .. } => {
                *greatest_n = most;
                widen(start_n, ends[0]);
                widen(end_n, ends[1]);
            }
            Self::EndsMoved { greatest_n, start_n, end_n, range_n, .. } => {
                *greatest_n = most;
                widen(start_n, ends[0]);
                widen(end_n, ends[1]);
                widen(range_n, most);
            }
        }
        self
    }
}

/// The ranges of the tension at the start and at the end among the equilibrium that is shown and
/// the others, N; None where there is no other.
fn ranges_at_ends(shown: [f64; 3], others: &[[f64; 3]]) -> Option<[[f64; 2]; 2]> {
    let range = |k: usize| others.iter().fold([shown[k]; 2], |[a, b], t| [smaller(a, t[k]), larger(b, t[k])]);
    (!others.is_empty()).then(|| [range(0), range(1)])
}

/// An end that was moved and put back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndMove {
    /// The support's name.
    pub support: String,
    /// Length by which it was drawn out, m; negative = let in.
    pub drawn_out_m: f64,
    /// Greatest tension that it left, N.
    pub greatest_n: f64,
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
        /// The friction that holds it, as a part of what there is.
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

    /// The kind to which it belongs.
    #[must_use]
    pub fn kind(&self) -> WarningKind {
        match self {
            Self::AboveService { .. } | Self::BrieflyAboveBreaking { .. } => WarningKind::ServiceTension,
            Self::AboveBreaking { .. } => WarningKind::BreakingTension,
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
            Self::Blocked { .. } | Self::Lags { .. } | Self::HandLags { .. } => WarningKind::SupportHeld,
            Self::RouteBuried { .. } | Self::SupportOnSurface { .. } => WarningKind::InitialPenetration,
            Self::ClearOfWheel { .. } => WarningKind::ClearOfWheel,
            Self::RobotIgnored { .. } => WarningKind::ThroughRobot,
            Self::SlidFromRoute { .. } | Self::SlidOn | Self::SpeedCut | Self::EnergyCut | Self::StiffPreview => {
                WarningKind::Stabilised
            }
            Self::EnergyFromNowhere { .. } => WarningKind::EnergyGrows,
            Self::CornerOfMesh { .. }
            | Self::CoarseBend { .. }
            | Self::BarContacts
            | Self::CoarseForces { .. }
            | Self::CoarseTension { .. } => WarningKind::Accuracy,
            Self::Recorded { kind, .. } => *kind,
        }
    }

    /// The quantity of which the warning's value and limit are.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        match self {
            Self::SpeedCut | Self::Lags { .. } | Self::HandLags { .. } => Quantity::Speed,
            Self::EnergyCut => Quantity::Energy,
            Self::StiffPreview => Quantity::Time,
            Self::Blocked { .. } => Quantity::Length,
            _ => self.kind().quantity(),
        }
    }

    /// The same of a scene whose lengths and times are so many times those of this one. Only what
    /// models warn of is ever scaled; the monitors see the scene as it is.
    fn scaled(mut self, length: f64, time: f64) -> Self {
        let force_per_length = Quantity::ForcePerLength.scale(length, time);
        match &mut self {
            Self::Loose { material_m, ground_m, .. } => {
                *material_m *= length;
                *ground_m *= length;
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A similar scene twice as large, in which time runs three times as slowly, has the same
    /// warning.
    #[test]
    fn warnings_of_a_similar_scene_are_brought_back() {
        let cause = WarningCause::Lags { support: "a".to_owned(), behind_m: 0.5 };
        let large = Warning::new(cause, "main", 3.0, [4.0, 6.0]).scaled(2.0, 3.0);
        assert_eq!((large.arc_length_m, large.value, large.limit), (6.0, 4.0 * 2.0 / 3.0, 4.0));
        assert_eq!(large.cause, WarningCause::Lags { support: "a".to_owned(), behind_m: 1.0 });
    }
}
