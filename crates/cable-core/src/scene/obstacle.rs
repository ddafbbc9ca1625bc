//! What a cable can touch: terrain, beams, posts, thin lines.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::Point;

/// One obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Obstacle {
    /// Unique name.
    pub name: String,
    /// Its form.
    #[serde(flatten)]
    pub shape: Shape,
    /// Coulomb friction with the cable; left out, the cable's own value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}

/// The form of an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Shape {
    /// Open polyline from left to right, solid below.
    Terrain {
        /// Corner points, m.
        points_m: Vec<Point>,
    },
    /// Closed polygon, solid inside; either winding.
    Polygon {
        /// Corner points, m.
        points_m: Vec<Point>,
    },
    /// A round post or pipe.
    Circle {
        /// Centre, m.
        center_m: Point,
        /// Radius, m.
        radius_m: f64,
    },
    /// Thin, two-sided.
    Polyline {
        /// Corner points, m.
        points_m: Vec<Point>,
        /// Full thickness, m.
        #[serde(default)]
        thickness_m: f64,
    },
}
