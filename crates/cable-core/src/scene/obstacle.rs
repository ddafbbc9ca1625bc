//! Obstacles are what a cable can touch: terrain, beams, posts, thin lines.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::Point;

/// The ends of a line of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineEnds {
    /// The last point is an end.
    Open,
    /// An edge leads from the last point to the first.
    Joined,
}

/// One obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "ObstacleKeys")]
#[schemars(!try_from, deny_unknown_fields)]
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

/// The keys of an obstacle as they stand in a file: flat, so that a fault keeps its place and an
/// unknown key is refused (serde's flattening loses both).
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObstacleKeys {
    name: String,
    kind: ShapeKind,
    points_m: Option<Vec<Point>>,
    center_m: Option<Point>,
    radius_m: Option<f64>,
    thickness_m: Option<f64>,
    friction: Option<f64>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ShapeKind {
    Terrain,
    Polygon,
    Circle,
    Polyline,
}

impl TryFrom<ObstacleKeys> for Obstacle {
    type Error = String;

    fn try_from(keys: ObstacleKeys) -> Result<Self, String> {
        let needs = |kind: &str, key: &str| format!("a {kind} needs `{key}`");
        let has_not =
            |kind: &str, key: &str, there: bool| if there { Err(format!("a {kind} has no `{key}`")) } else { Ok(()) };
        let line = |kind: &str, points: Option<Vec<Point>>| {
            has_not(kind, "center_m", keys.center_m.is_some())?;
            has_not(kind, "radius_m", keys.radius_m.is_some())?;
            points.ok_or_else(|| needs(kind, "points_m"))
        };
        let shape = match keys.kind {
            ShapeKind::Terrain => {
                has_not("terrain", "thickness_m", keys.thickness_m.is_some())?;
                Shape::Terrain { points_m: line("terrain", keys.points_m)? }
            }
            ShapeKind::Polygon => {
                has_not("polygon", "thickness_m", keys.thickness_m.is_some())?;
                Shape::Polygon { points_m: line("polygon", keys.points_m)? }
            }
            ShapeKind::Polyline => Shape::Polyline {
                points_m: line("polyline", keys.points_m)?,
                thickness_m: keys.thickness_m.unwrap_or(0.0),
            },
            ShapeKind::Circle => {
                has_not("circle", "points_m", keys.points_m.is_some())?;
                has_not("circle", "thickness_m", keys.thickness_m.is_some())?;
                Shape::Circle {
                    center_m: keys.center_m.ok_or_else(|| needs("circle", "center_m"))?,
                    radius_m: keys.radius_m.ok_or_else(|| needs("circle", "radius_m"))?,
                }
            }
        };
        Ok(Self { name: keys.name, shape, friction: keys.friction })
    }
}
