//! How a support moves: knots in time, followed by a C² curve.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::{Point, Vec2, vec2};

/// A path through points at times, followed smoothly (C²): between two knots the curve never leaves
/// their interval, it is at rest at a knot where it turns, and it rests after the last one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Times of the knots, s, strictly increasing.
    pub times_s: Vec<f64>,
    /// Where it is at each time, m.
    pub points_m: Vec<Point>,
}

impl Motion {
    /// Position (m) and velocity (m/s) at a time (s).
    #[must_use]
    pub fn at(&self, time_s: f64) -> (Vec2, Vec2) {
        // Placeholder: smoothstep from knot to knot, at rest at each.
        let (t, p) = (&self.times_s, &self.points_m);
        let (Some(&first), Some(&last)) = (p.first(), p.last()) else {
            return (Vec2::zeros(), Vec2::zeros());
        };
        if time_s <= t[0] {
            return (vec2(first), Vec2::zeros());
        }
        for k in 1..t.len().min(p.len()) {
            if time_s < t[k] {
                let h = t[k] - t[k - 1];
                let u = (time_s - t[k - 1]) / h;
                let s = u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
                let ds = 30.0 * u * u * (1.0 - u) * (1.0 - u) / h;
                let d = vec2(p[k]) - vec2(p[k - 1]);
                return (vec2(p[k - 1]) + d * s, d * ds);
            }
        }
        (vec2(last), Vec2::zeros())
    }
}
