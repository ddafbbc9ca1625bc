//! The running mean of the tension over the incubation time is kept at each material point, from
//! one inner step to the next:
//! ```text
//! 1/τ ∫ T(s, t') dt' over t − τ … t
//! ```

use crate::math::Vec2;

/// Number of evaluations of the mean in its averaging time. For a triangular jerk of that duration
/// the greatest mean is missed by at most 1/(4·4²) of its height, 1.6 %; with 8 evaluations by 0.4
/// %, and a step of `fem`, which is as long as that time, costs 3 % more.
const LOOKS_PER_MEAN: usize = 4;

/// The tension of a cable before the time at which a gauge begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TensionBefore {
    /// That of the time itself: the cable was at rest.
    Same,
    /// None, because it is not known.
    Zero,
}

impl TensionBefore {
    /// The tension before an instant at which the nodes have these velocities (m/s).
    #[must_use]
    pub fn of_motion(velocities: &[Vec2]) -> Self {
        if velocities.iter().all(|v| *v == Vec2::zeros()) { Self::Same } else { Self::Zero }
    }
}

/// The running mean of the tension at the points of a gauge.
#[derive(Clone, Debug, Default)]
pub(super) struct IncubationMean {
    /// Averaging time, s; 0: each instant counts.
    pub over_s: f64,
    /// Time of the last look at the mean, in parts of `over_s / LOOKS_PER_MEAN`.
    look: f64,
    /// ∫T dt since the history began, N s.
    sum: Vec<f64>,
    /// The same at the last looks, those of a look beside each other; the oldest is overwritten.
    sums: Vec<f64>,
    oldest: usize,
    /// The mean at the last look, N, and room for the next.
    mean: Vec<f64>,
    spare: Vec<f64>,
}

impl IncubationMean {
    /// Means over a time (s).
    pub fn over(over_s: f64) -> Self {
        Self { over_s, ..Self::default() }
    }

    /// The means at the last look, N.
    pub fn last(&self) -> &[f64] {
        &self.mean
    }

    /// Begins at a time (s) with tensions (N) that followed those `before`.
    pub fn begin(&mut self, time_s: f64, now: &[f64], before: TensionBefore) {
        let part_s = self.over_s / LOOKS_PER_MEAN as f64;
        self.look = if self.over_s > 0.0 { (time_s / part_s).floor() } else { 0.0 };
        let mean = match before {
            TensionBefore::Same => 1.0,
            TensionBefore::Zero => 0.0,
        };
        self.mean.clear();
        self.mean.extend(now.iter().map(|t| t * mean));
        self.sums.clear();
        for k in 0..LOOKS_PER_MEAN {
            let before_s = time_s - (self.look - (LOOKS_PER_MEAN - 1 - k) as f64) * part_s;
            self.sums.extend(now.iter().map(|t| -t * mean * before_s));
        }
        self.sum.clear();
        self.sum.resize(now.len(), 0.0);
        self.oldest = 0;
    }

    /// Advances from a time to another (s) with the tensions (N) at both, and passes each pair of
    /// means (N), with their times (s), to `look`.
    pub fn advance(
        &mut self,
        [from_s, to_s]: [f64; 2],
        [now, next]: [&[f64]; 2],
        mut look: impl FnMut([f64; 2], [&[f64]; 2]),
    ) {
        let (part_s, per_s) = (self.over_s / LOOKS_PER_MEAN as f64, (to_s - from_s).recip());
        let (count, per_window) = (now.len().max(1), self.over_s.recip());
        let sum = &mut self.sum;
        let mut at_s = from_s;
        loop {
            let (before_s, mut until_s) = (self.look * part_s, (self.look + 1.0) * part_s);
            if until_s > to_s {
                break;
            }
            let last = (to_s / part_s).floor();
            if at_s - from_s >= self.over_s && last - self.look > LOOKS_PER_MEAN as f64 {
                // In a step this long the mean goes on evenly from here to its end.
                (self.look, self.oldest) = (last - LOOKS_PER_MEAN as f64, 0);
                for slot in self.sums.chunks_exact_mut(count) {
                    until_s = self.look * part_s;
                    add_integral(sum, now, next, [at_s, until_s].map(|t| (t - from_s) * per_s), until_s - at_s);
                    slot.copy_from_slice(sum);
                    (self.look, at_s) = (self.look + 1.0, until_s);
                }
                until_s = self.look * part_s;
            } else {
                self.look += 1.0;
            }
            add_integral(sum, now, next, [at_s, until_s].map(|t| (t - from_s) * per_s), until_s - at_s);
            at_s = until_s;
            self.spare.resize(now.len(), 0.0);
            if let Some(slot) = self.sums.chunks_exact_mut(count).nth(self.oldest) {
                for ((mean, sum), slot) in self.spare.iter_mut().zip(sum.iter()).zip(slot) {
                    *mean = (sum - *slot) * per_window;
                    *slot = *sum;
                }
            }
            self.oldest = (self.oldest + 1) % LOOKS_PER_MEAN;
            std::mem::swap(&mut self.mean, &mut self.spare);
            look([before_s, until_s], [&self.spare, &self.mean]);
        }
        add_integral(sum, now, next, [at_s, to_s].map(|t| (t - from_s) * per_s), to_s - at_s);
    }
}

/// Adds the integral of tensions over a time (s) between two parts of a step, N s.
fn add_integral(sum: &mut [f64], now: &[f64], next: &[f64], [from, to]: [f64; 2], time_s: f64) {
    let middle = 0.5 * (from + to);
    let (low, high) = ((1.0 - middle) * time_s, middle * time_s);
    for ((sum, a), b) in sum.iter_mut().zip(now).zip(next) {
        *sum += low * a + high * b;
    }
}
