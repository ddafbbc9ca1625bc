//! What there is: cables, supports, obstacles, loads, environment, robot, in the words of a scene file.
//!
//! A [`Scene`] is a plain document: every field is public, so that an editor can hold a half-typed one.
//! [`Scene::validate`] says whether it can be solved; [`crate::Simulation::new`] refuses one that cannot.

pub mod cable;
pub mod catalog;
pub mod file;
pub mod ground;
pub mod import;
mod length_check;
pub mod load;
pub mod motion;
pub mod obstacle;
pub(crate) mod path;
pub mod preset;
mod range;
mod read;
pub mod robot;
pub mod scaled;
pub mod schema;
mod self_touch;
pub mod support;
mod support_rules;
pub mod survey;
pub mod validate;

pub use cable::{BREAKING_TIME_S, Cable, FrictionMobilised};
pub use load::Load;
pub use motion::Motion;
pub use obstacle::{Obstacle, Shape};
pub use robot::{Heading, Robot, RobotTask};
pub use support::{PulleySide, Support, SupportKind};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::Point;

/// The file version this build writes, and the newest it reads.
pub const VERSION: u32 = 1;

/// A whole scene, as a scene file holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// File format version; always 1.
    pub version: u32,
    /// Shown in title bars and reports.
    #[serde(default)]
    pub name: String,
    /// Side view or plan view.
    #[serde(default)]
    pub view: View,
    /// Gravity, wind, temperature.
    #[serde(default)]
    pub environment: Environment,
    /// The cables; at least one.
    pub cables: Vec<Cable>,
    /// Terrain, beams, posts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<Obstacle>,
    /// Point loads on cables.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<Load>,
    /// The tracked vehicle, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<Robot>,
}

/// How the plane of the scene lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum View {
    /// Seen from the side: gravity points down (−y).
    #[default]
    Elevation,
    /// Seen from above: gravity points into the page and the floor rubs everywhere.
    Plan,
}

/// Gravity, wind and temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// Gravity, m/s², 0 to 100; down in elevation, into the page in plan view.
    pub gravity_m_per_s2: f64,
    /// Wind force per unstretched metre at rest temperature, N/m.
    pub wind_n_per_m: Point,
    /// Times of `winds_n_per_m`, s, increasing; linear in between.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub wind_times_s: Vec<f64>,
    /// Wind force at each of `wind_times_s`, N/m; replaces `wind_n_per_m` if given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub winds_n_per_m: Vec<Point>,
    /// Temperature above the one at which lengths are given, K.
    pub temperature_change_k: f64,
}

/// Standard gravity, m/s² (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;

impl Default for Environment {
    fn default() -> Self {
        Self {
            gravity_m_per_s2: STANDARD_GRAVITY,
            wind_n_per_m: [0.0; 2],
            wind_times_s: Vec::new(),
            winds_n_per_m: Vec::new(),
            temperature_change_k: 0.0,
        }
    }
}
