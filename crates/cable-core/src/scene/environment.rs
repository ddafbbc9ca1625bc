//! The environment of a scene is the orientation of its plane, gravity, wind and temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::Point;

/// Orientation of the plane of the scene.
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
