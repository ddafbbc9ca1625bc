//! A load is a force on a point of a cable.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::Point;

/// A dead point load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name of the cable.
    pub cable: String,
    /// Place on it, m of unstretched length from its start.
    pub arc_length_m: f64,
    /// Force, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_n: Option<Point>,
    /// Times of `forces_n`, s, increasing; linear in between.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub times_s: Vec<f64>,
    /// Force at each of `times_s`, N; instead of `force_n`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forces_n: Vec<Point>,
}
