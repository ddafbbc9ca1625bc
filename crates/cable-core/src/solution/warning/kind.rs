//! The kind of a warning says what it is about; files and the window name it so.

use serde::{Deserialize, Serialize};

use crate::units::Quantity;

/// The kinds of warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
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
    /// The cable curls up: a free part turns most of the way round.
    Curl,
    /// It goes round an obstacle once or more.
    Wrapped,
    /// An obstacle holds the cable fast while the pull on it grows.
    Snag,
    /// With friction a resting place is not unique.
    NotUnique,
    /// A support was stopped by an obstacle, its speed was capped, or its robot cannot drive.
    SupportHeld,
    /// The scene puts a support or the route into an obstacle: it was put outside.
    InitialPenetration,
    /// The cable hangs clear of the wheel of a pulley, which carries no force.
    ClearOfWheel,
    /// The cable passes through the robot, because the model does not include the robot's outline.
    ThroughRobot,
    /// The robot drives through an obstacle, because only terrain stops it.
    RobotInObstacle,
    /// Damping or velocity was raised to keep the motion stable.
    Stabilised,
    /// It has more energy than what moves it can have given; value and limit in J.
    EnergyGrows,
    /// The mesh is too coarse for the asked accuracy.
    Accuracy,
}

impl WarningKind {
    /// Every kind.
    pub const ALL: [Self; 21] = [
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
        Self::RobotInObstacle,
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
            Self::RobotInObstacle => "robot-in-obstacle",
            Self::Stabilised => "stabilised",
            Self::EnergyGrows => "energy-grows",
            Self::Accuracy => "accuracy",
        }
    }

    /// The quantity of value and limit, unless the cause names another.
    pub(super) fn quantity(self) -> Quantity {
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
            | Self::RobotInObstacle
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
