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
#[serde(untagged, try_from = "TaskKeys")]
#[schemars(!try_from, deny_unknown_fields)]
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

/// The keys of a leg as they stand in a file: flat, so that a fault keeps its place.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TaskKeys {
    to_x_m: Option<f64>,
    speed_m_per_s: Option<f64>,
    wait_s: Option<f64>,
}

impl TryFrom<TaskKeys> for RobotTask {
    type Error = &'static str;

    fn try_from(keys: TaskKeys) -> Result<Self, Self::Error> {
        match (keys.to_x_m, keys.speed_m_per_s, keys.wait_s) {
            (Some(to_x_m), Some(speed_m_per_s), None) => Ok(Self::Drive { to_x_m, speed_m_per_s }),
            (None, None, Some(wait_s)) => Ok(Self::Wait { wait_s }),
            _ => Err("a leg has either `to_x_m` and `speed_m_per_s`, or `wait_s`"),
        }
    }
}

impl Robot {
    /// Where the cable hangs on it, m; None for an unknown preset. On level ground: a robot that tilts turns
    /// its hitch with it.
    #[must_use]
    pub fn hitch_m(&self) -> Option<Point> {
        let preset = super::preset::robot_preset(&self.preset)?;
        let back = preset.hitch_back_m.value;
        let x = match self.heading {
            Heading::Right => self.at_m[0] - back,
            Heading::Left => self.at_m[0] + back,
        };
        Some([x, self.at_m[1] + preset.hitch_up_m.value])
    }
}
