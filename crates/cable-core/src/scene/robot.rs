//! The tracked vehicle as a scene describes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::Point;

/// A tracked vehicle standing on the terrain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Robot {
    /// Preset its numbers come from.
    pub preset: String,
    /// Where its tracks' middle touches the ground, m.
    pub at_m: Point,
    /// Which way it looks.
    #[serde(default)]
    pub heading: Heading,
    /// What it does by itself, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<RobotTask>,
}

/// Which way a robot looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Heading {
    /// Towards +x.
    #[default]
    Right,
    /// Towards −x.
    Left,
}

/// One leg of a scripted path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, deny_unknown_fields)]
pub enum RobotTask {
    /// Drive until the tracks' middle is at x.
    Drive {
        /// Where to, m.
        to_x_m: f64,
        /// How fast, m/s.
        speed_m_per_s: f64,
    },
    /// Stand still.
    Wait {
        /// How long, s.
        wait_s: f64,
    },
}

impl Robot {
    /// Where the cable hangs on it, m (placeholder until presets carry the hitch).
    #[must_use]
    pub fn hitch_m(&self) -> Option<Point> {
        Some(self.at_m)
    }
}
