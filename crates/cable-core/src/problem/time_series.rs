//! A series is a vector as a function of time.

use crate::math::{Vec2, vec2};

/// Times nearer than this are the same, s: sums of steps come as near to a time as rounding lets
/// them.
pub(super) const TIME_TOLERANCE_S: f64 = 1e-9;

/// A vector as a function of time: linear between knots, constant outside them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimeSeries {
    pub(super) times: Vec<f64>,
    pub(super) values: Vec<Vec2>,
}

impl TimeSeries {
    /// The same value at all times.
    #[must_use]
    pub fn constant(value: Vec2) -> Self {
        Self { times: vec![0.0], values: vec![value] }
    }

    /// Knots; times must increase.
    #[must_use]
    pub fn new(times: &[f64], values: &[[f64; 2]]) -> Self {
        Self { times: times.to_vec(), values: values.iter().map(|v| vec2(*v)).collect() }
    }

    /// The value at a time (s).
    #[must_use]
    pub fn at(&self, time_s: f64) -> Vec2 {
        let k = self.times.partition_point(|&t| t <= time_s);
        match (k.checked_sub(1).and_then(|i| self.values.get(i)), self.values.get(k)) {
            (Some(&a), Some(&b)) => {
                let f = (time_s - self.times[k - 1]) / (self.times[k] - self.times[k - 1]);
                a + (b - a) * f
            }
            (Some(&a), None) => a,
            (None, Some(&b)) => b,
            (None, None) => Vec2::zeros(),
        }
    }
}

/// The first of `times` between two others (s, not either of them) at which what goes through
/// `values` turns back or stops.
pub(super) fn turn_between<V>(times: &[f64], values: &[V], from: f64, to: f64, of: impl Fn(&V) -> Vec2) -> Option<f64> {
    let first = times.partition_point(|&t| t <= from + TIME_TOLERANCE_S);
    let last = times.partition_point(|&t| t < to - TIME_TOLERANCE_S);
    (first.max(1)..last).find_map(|k| {
        let [a, b, c] = [values.get(k - 1)?, values.get(k)?, values.get(k + 1)?].map(&of);
        (!((b - a).dot(&(c - b)) > 0.0)).then_some(times[k])
    })
}
