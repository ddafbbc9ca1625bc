//! Supports hold a cable: fixed points, clamps, pulleys, loads, the robot's hitch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::motion::Motion;
use crate::math::{Point, vec2};

/// Kind of a support.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SupportKind {
    /// Held at a point, free to turn.
    Fixed,
    /// Held at a point and direction.
    Clamped,
    /// Slides through a point or round a wheel.
    Pulley,
    /// A dead load on a free point.
    Load,
    /// Hangs on the robot's hitch.
    Robot,
    /// Nothing.
    Free,
}

/// On which side of a wheel the cable runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PulleySide {
    /// Over the top.
    #[default]
    Over,
    /// Under the bottom.
    Under,
}

/// One support. Which fields apply depends on `kind`; [`crate::Scene::validate`] refuses the
/// others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Unique in its cable.
    pub name: String,
    /// Its kind.
    pub kind: SupportKind,
    /// Its position, m (fixed, clamped; a pulley's centre).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_m: Option<Point>,
    /// Place on the cable it sits, m (fixed, clamped or load between the ends).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc_length_m: Option<f64>,
    /// Clamp: direction of growing arc length, ° from +x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    /// Pulley: radius of the wheel, m; 0 = a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Pulley: on which side of the wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<PulleySide>,
    /// Pulley: Coulomb friction; left out = frictionless.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Load: dead force, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_n: Option<Point>,
    /// Load: times of `forces_n`, s, increasing; linear in between.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times_s: Vec<f64>,
    /// Load: dead force at each of `times_s`, N; instead of `force_n`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forces_n: Vec<Point>,
    /// Load, free: lumped mass, kg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Fixed, clamped, pulley: how it moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// The time when it lets go, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release_s: Option<f64>,
}

impl Support {
    /// A support of a kind with nothing else said.
    #[must_use]
    pub fn new(name: impl Into<String>, kind: SupportKind) -> Self {
        Self {
            name: name.into(),
            kind,
            at_m: None,
            arc_length_m: None,
            angle_deg: None,
            radius_m: None,
            side: None,
            friction: None,
            force_n: None,
            times_s: Vec::new(),
            forces_n: Vec::new(),
            mass_kg: None,
            motion: None,
            release_s: None,
        }
    }

    /// A fixed point, m.
    #[must_use]
    pub fn fixed(name: impl Into<String>, at_m: Point) -> Self {
        Self { at_m: Some(at_m), ..Self::new(name, SupportKind::Fixed) }
    }

    /// A frictionless point pulley, m.
    #[must_use]
    pub fn pulley(name: impl Into<String>, at_m: Point) -> Self {
        Self { at_m: Some(at_m), ..Self::new(name, SupportKind::Pulley) }
    }

    /// Moves the support, and the whole of its motion with it, so that both still agree at the
    /// start.
    pub fn move_to(&mut self, at_m: Point) {
        if let (Some(old), Some(motion)) = (self.at_m, self.motion.as_mut()) {
            motion.shift(vec2(at_m) - vec2(old));
        }
        self.at_m = Some(at_m);
    }

    /// A free end.
    #[must_use]
    pub fn free(name: impl Into<String>) -> Self {
        Self::new(name, SupportKind::Free)
    }
}
