//! A motion moves a support: knots in time, followed by a C² curve.
//!
//! A piecewise quintic with zero acceleration at every knot. In Bernstein form its derivative on an
//! interval of length h from p₀ to p₁ with end velocities v₀, v₁ has the control values (v₀, v₀, 5Δ
//! − 2(v₀ + v₁), v₁, v₁), Δ = (p₁ − p₀)/h, whose mean is Δ. All of one sign make the curve monotone
//! between the knots: |v₀ + v₁| ≤ 5/2 |Δ|, after W. Heß and J. W. Schmidt, "Positive quartic,
//! monotone quintic C²-spline interpolation in one and two dimensions", J. Comput. Appl. Math. 55
//! (1994). Knot velocities are the weighted harmonic mean of the slopes at both sides (F. N.
//! Fritsch and J. Butland, "A method for constructing local monotone piecewise cubic interpolants",
//! SIAM J. Sci. Stat. Comput. 5, 1984), cut to 5/4 of the smaller slope so that the condition holds
//! on both sides without a global solve. Two knots give p₀ + (p₁ − p₀)(10u³ − 15u⁴ + 6u⁵).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::{Point, Vec2, vec2};

/// Largest knot velocity as a multiple of the smaller neighbouring slope. Half of the 5/2 that two
/// ends of an interval may share; larger lets the curve overshoot a knot, smaller makes it slow
/// down at each.
const KNOT_VELOCITY_LIMIT: f64 = 1.25;

/// A path through points at times, followed smoothly (C²): between two knots each coordinate never
/// leaves their interval; it is at rest at a knot where it turns, before the first and after the
/// last one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Times of the knots, s, strictly increasing.
    pub times_s: Vec<f64>,
    /// Position at each time, m.
    pub points_m: Vec<Point>,
}

impl Motion {
    /// Position (m) and velocity (m/s) at a time (s). Knots without a partner in the other list are
    /// ignored.
    #[must_use]
    pub fn at(&self, time_s: f64) -> (Vec2, Vec2) {
        let n = self.times_s.len().min(self.points_m.len());
        let (times, points) = (&self.times_s[..n], &self.points_m[..n]);
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
            return (Vec2::zeros(), Vec2::zeros());
        };
        if time_s.is_nan() {
            return (Vec2::repeat(f64::NAN), Vec2::repeat(f64::NAN));
        }
        let after = times.partition_point(|&t| t <= time_s);
        if after == 0 {
            return (vec2(first), Vec2::zeros());
        }
        if after == n {
            return (vec2(last), Vec2::zeros());
        }
        let ((x, u), (y, v)) = (self.component(after, time_s, 0), self.component(after, time_s, 1));
        (Vec2::new(x, y), Vec2::new(u, v))
    }

    /// The greatest speed, m/s, and when, s.
    #[must_use]
    pub fn fastest(&self) -> (f64, f64) {
        /// Looks between two knots: the speed, a quartic in each coordinate, is missed by 1e-3 of
        /// it at most.
        const SPEED_SAMPLES: u32 = 64;
        let mut most = (0.0, 0.0);
        for pair in self.times_s.windows(2) {
            for k in 0..SPEED_SAMPLES {
                let time_s = pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(SPEED_SAMPLES);
                let speed = self.at(time_s).1.norm();
                if speed > most.0 {
                    most = (speed, time_s);
                }
            }
        }
        most
    }

    /// The same motion with every knot moved by `offset` (m).
    pub fn shift(&mut self, offset: Vec2) {
        for p in &mut self.points_m {
            *p = [p[0] + offset.x, p[1] + offset.y];
        }
    }

    /// Returns when it comes to its last rest, s.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// Value and velocity of one coordinate between the knots `k − 1` and `k`.
    fn component(&self, k: usize, time_s: f64, axis: usize) -> (f64, f64) {
        let (p0, p1) = (self.points_m[k - 1][axis], self.points_m[k][axis]);
        let h = self.times_s[k] - self.times_s[k - 1];
        let (v0, v1) = (self.knot_velocity(k - 1, axis), self.knot_velocity(k, axis));
        let u = (time_s - self.times_s[k - 1]) / h;
        // Zero acceleration at both ends puts three control points on each end tangent.
        let value = bezier([p0, p0 + h * v0 / 5.0, p0 + h * v0 * 0.4, p1 - h * v1 * 0.4, p1 - h * v1 / 5.0, p1], u);
        let velocity = bezier([v0, v0, 5.0 * (p1 - p0) / h - 2.0 * (v0 + v1), v1, v1], u);
        // Round-off must not leave the interval either.
        let (low, high) = if p0 <= p1 { (p0, p1) } else { (p1, p0) };
        let value = if value < low {
            low
        } else if value > high {
            high
        } else {
            value
        };
        (value, velocity)
    }

    /// Velocity of one coordinate at a knot: zero at the ends and where it turns or stands.
    fn knot_velocity(&self, k: usize, axis: usize) -> f64 {
        let n = self.times_s.len().min(self.points_m.len());
        if k == 0 || k + 1 >= n {
            return 0.0;
        }
        let (t, p) = (&self.times_s, &self.points_m);
        let (h0, h1) = (t[k] - t[k - 1], t[k + 1] - t[k]);
        let (d0, d1) = ((p[k][axis] - p[k - 1][axis]) / h0, (p[k + 1][axis] - p[k][axis]) / h1);
        if !(d0.signum() == d1.signum() && d0 != 0.0 && d1 != 0.0) {
            return 0.0;
        }
        // Weighted harmonic mean: 3(h₀ + h₁)/((2h₁ + h₀)/d₀ + (h₁ + 2h₀)/d₁).
        let mean = 3.0 * (h0 + h1) / ((2.0 * h1 + h0) / d0 + (h1 + 2.0 * h0) / d1);
        let limit = KNOT_VELOCITY_LIMIT * if d0.abs() < d1.abs() { d0.abs() } else { d1.abs() };
        if mean.abs() > limit { limit * d0.signum() } else { mean }
    }
}

/// De Casteljau's algorithm: repeated convex combinations, so the value stays among the control
/// values.
fn bezier<const N: usize>(mut c: [f64; N], u: f64) -> f64 {
    for level in (1..N).rev() {
        for i in 0..level {
            c[i] = c[i] * (1.0 - u) + c[i + 1] * u;
        }
    }
    c[0]
}
