//! Places of a cable carry the figures that are read there: tensions, depths and touchdowns.

use serde::{Deserialize, Serialize};

use crate::solution::Node;

/// A point of the cable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CablePlace {
    /// Arc length, m.
    pub arc_length_m: f64,
    /// Its place, m.
    pub x_m: f64,
    /// Its place, m.
    pub y_m: f64,
}

impl CablePlace {
    pub(super) fn of(n: &Node) -> Self {
        Self { arc_length_m: n.arc_length_m, x_m: n.x_m, y_m: n.y_m }
    }
}

/// A tension and its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TensionAt {
    /// Tension, N.
    pub tension_n: f64,
    /// Its place.
    #[serde(flatten)]
    pub at: CablePlace,
}

/// A depth and its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sag {
    /// Depth, m.
    pub sag_m: f64,
    /// Its place.
    #[serde(flatten)]
    pub at: CablePlace,
}

/// Side of a touchdown that lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TouchKind {
    /// It lies from here on, along growing arc length.
    Begins,
    /// It lies up to here.
    Ends,
    /// It touches in this point alone.
    Point,
}

/// A place at which the cable comes down on something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Touchdown {
    /// Name of the obstacle it touches.
    pub obstacle: String,
    /// The side that lies.
    pub touch: TouchKind,
    /// Tension there, N.
    pub tension_n: f64,
    /// Its place.
    #[serde(flatten)]
    pub at: CablePlace,
}
