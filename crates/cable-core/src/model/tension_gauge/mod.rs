//! The gauge reads the tension of a moving cable after every inner step of a model.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`TensionGauge`]: tensions at material points, of one inner step after the other |
//! | `incubation_mean.rs` | the running mean over the incubation time |
//! | `peaks.rs` | the highest mean, and where it first reached a limit |
//!
//! A jerk can pass between two frames; the inner steps resolve it. A single instant of it does not
//! break a cable: fracture under a pulse takes time, and happens when the mean over that time
//! reaches the strength (the incubation time criterion: Yu. V. Petrov, N. F. Morozov, "On the
//! modeling of fracture of brittle solids", Journal of Applied Mechanics 61(3), 1994),
//! ```text
//! 1/τ ∫ T(s, t') dt' over t − τ … t  ≥  T_b
//! ```
//! at a material point s. Meshes change, so means are taken at points of the cable that stay: the
//! nodes of the first mesh that was gauged. Between two inner steps tension is linear in time,
//! between two nodes linear along the cable.

mod incubation_mean;
mod peaks;

pub use incubation_mean::TensionBefore;
pub use peaks::Limit;

use crate::solution::{TensionPeak, TensionPeaks};
use incubation_mean::IncubationMean;
use peaks::{PeaksOfMeans, greatest_of, higher};

/// Change of the cable's length, as a fraction of it, from which a history begins on new points:
/// round-off. Smaller: a history is lost by round-off; larger: peaks are kept at wrong places.
const SAME_LENGTH_FRACTION: f64 = 1e-9;

/// Two times (s) that differ by less are the same: sums of steps round.
const SAME_TIME_S: f64 = 1e-9;

/// Tension along a cable over the last while.
#[derive(Clone, Debug)]
pub struct TensionGauge {
    on: bool,
    /// The limits, of one stretch of the cable each.
    limits: Vec<Limit>,
    /// Arc length and time of the cable over those of the model that is gauged.
    scale: [f64; 2],
    /// Arc lengths of the material points, m.
    points: Vec<f64>,
    /// Time reached, s; NaN if nothing is known.
    time_s: f64,
    /// Tension at the points then, N.
    now: Vec<f64>,
    /// Data of a step that may still be discarded.
    next_s: f64,
    next: Vec<f64>,
    /// The running mean of the tension at the points.
    mean: IncubationMean,
    /// The greatest tension since [`Self::watch`], and what was found of the means.
    greatest: Option<TensionPeak>,
    means: PeaksOfMeans,
}

impl Default for TensionGauge {
    fn default() -> Self {
        Self::off()
    }
}

impl TensionGauge {
    /// A gauge that is switched off.
    #[must_use]
    pub fn off() -> Self {
        Self {
            on: false,
            limits: Vec::new(),
            scale: [1.0; 2],
            points: Vec::new(),
            time_s: f64::NAN,
            now: Vec::new(),
            next_s: f64::NAN,
            next: Vec::new(),
            mean: IncubationMean::default(),
            greatest: None,
            means: PeaksOfMeans::default(),
        }
    }

    /// A gauge with means over a time (s).
    #[must_use]
    pub fn over(over_s: f64) -> Self {
        let over_s = if over_s > 0.0 && over_s.is_finite() { over_s } else { 0.0 };
        Self { on: true, mean: IncubationMean::over(over_s), ..Self::off() }
    }

    /// Begins a step of the caller: earlier peaks are forgotten, the history of tensions is not.
    pub fn watch(&mut self, limits: impl IntoIterator<Item = Limit>) {
        self.limits.clear();
        self.limits.extend(limits);
        (self.greatest, self.means) = (None, PeaksOfMeans::default());
    }

    /// Forgets the history of tensions: the cable's state was replaced, or it continues without
    /// inertia.
    pub fn forget(&mut self) {
        self.time_s = f64::NAN;
        (self.greatest, self.means) = (None, PeaksOfMeans::default());
    }

    /// The greatest tensions and means since [`Self::watch`]; None where nothing was gauged.
    #[must_use]
    pub fn peaks(&self) -> Option<TensionPeaks> {
        let greatest = self.greatest?;
        // In a step between two looks the mean is what it was.
        let mean = self.mean.last();
        let mean_peak = self.means.held.or_else(|| higher(None, &self.points, mean, greatest_of(mean), self.time_s));
        Some(TensionPeaks { greatest, held: mean_peak.unwrap_or(greatest), over_s: self.mean.over_s })
    }

    /// Adds what was found in the parts of a step before.
    pub(crate) fn add_peaks(&mut self, before: Option<TensionPeaks>) {
        if let (Some(before), Some(now)) = (before, self.peaks()) {
            let sum = before.with(now);
            (self.greatest, self.means.held) = (Some(sum.greatest), Some(sum.held));
        }
    }

    /// Returns where and when the mean first reached the limit since [`Self::watch`].
    #[must_use]
    pub fn reached(&self) -> Option<TensionPeak> {
        self.means.reached
    }

    /// From now on the gauged model uses lengths and times multiplied by these factors.
    pub(crate) fn of_copy(&mut self, [length, time]: [f64; 2]) {
        self.scale = [self.scale[0] / length, self.scale[1] / time];
    }

    /// Returns whether the gauge is on and its history does not reach up to a time (s of the
    /// model).
    #[must_use]
    pub fn asks(&self, time_s: f64) -> bool {
        self.on && !((self.time_s - time_s * self.scale[1]).abs() <= SAME_TIME_S)
    }

    /// Begins a history at a time (s), after the tension `before`. Arc lengths of nodes in m,
    /// tensions in N.
    pub fn begin(&mut self, time_s: f64, before: TensionBefore, arcs: &[f64], tension: impl Fn(usize) -> f64) {
        if !self.on {
            return;
        }
        let whole = arcs.last().copied().unwrap_or(0.0) * self.scale[0];
        if !self.points.last().is_some_and(|last| (last - whole).abs() <= SAME_LENGTH_FRACTION * whole) {
            self.points.clear();
            self.points.extend(arcs.iter().map(|s| s * self.scale[0]));
        }
        self.note(time_s, arcs, tension);
        self.time_s = self.next_s;
        std::mem::swap(&mut self.now, &mut self.next);
        self.mean.begin(self.time_s, &self.now, before);
        self.next.resize(self.now.len(), 0.0);
    }

    /// Notes the tension (N) at nodes of arc lengths (m, in order) after an inner step to a time
    /// (s). It counts once it is kept: the step may still be discarded.
    pub fn note(&mut self, time_s: f64, arcs: &[f64], tension: impl Fn(usize) -> f64) {
        if !self.on {
            return;
        }
        self.next_s = time_s * self.scale[1];
        self.next.resize(self.points.len(), 0.0);
        let by = self.scale[0];
        if self.knows(arcs) {
            self.next.iter_mut().enumerate().for_each(|(k, t)| *t = tension(k));
            return;
        }
        let Some(last) = arcs.len().checked_sub(1) else { return };
        let at = |k: usize| arcs.get(k).map_or(f64::INFINITY, |s| s * by);
        let mut k = 0;
        for (t, &p) in self.next.iter_mut().zip(&self.points) {
            while k < last && at(k + 1) < p {
                k += 1;
            }
            let (a, b) = (at(k), at(k + 1));
            let part = ((p - a) / (b - a)).clamp(0.0, 1.0);
            *t = if k < last && part > 0.0 { tension(k) + (tension(k + 1) - tension(k)) * part } else { tension(k) };
        }
    }

    /// Returns whether its points are the nodes of a mesh (arc lengths, m).
    #[must_use]
    pub(crate) fn knows(&self, arcs: &[f64]) -> bool {
        let by = self.scale[0];
        self.on && arcs.len() == self.points.len() && arcs.iter().zip(&self.points).all(|(s, p)| s * by == *p)
    }

    /// Room for the tensions (N) at a time (s) of a mesh that it [knows](Self::knows): as
    /// [`Self::note`].
    pub(crate) fn room(&mut self, time_s: f64) -> &mut [f64] {
        self.next_s = time_s * self.scale[1];
        &mut self.next
    }

    /// Keeps the noted step.
    pub fn keep(&mut self) {
        let (from_s, to_s) = (self.time_s, self.next_s);
        let h = to_s - from_s;
        if !(self.on && h > 0.0) {
            return;
        }
        let (points, limits, means) = (&self.points, &self.limits, &mut self.means);
        let mut look = |times_s: [f64; 2], tensions: [&[f64]; 2]| means.look_at(points, limits, times_s, tensions);
        if self.mean.over_s > 0.0 {
            self.mean.advance([from_s, to_s], [&self.now, &self.next], look);
        } else {
            look([from_s, to_s], [&self.now, &self.next]);
        }
        let end_s = self.means.reached.map_or(to_s, |r| r.time_s);
        if end_s >= to_s {
            self.greatest = higher(self.greatest, &self.points, &self.next, greatest_of(&self.next), to_s);
        } else if end_s > from_s {
            // A cable that broke in this step was not pulled on to its end.
            let part = (end_s - from_s) / h;
            self.now.iter_mut().zip(&self.next).for_each(|(a, b)| *a += (b - *a) * part);
            self.greatest = higher(self.greatest, &self.points, &self.now, greatest_of(&self.now), end_s);
        }
        std::mem::swap(&mut self.now, &mut self.next);
        self.time_s = to_s;
    }

    /// Goes on to a time (s) with the tension as it is.
    pub fn stay(&mut self, time_s: f64) {
        self.next_s = time_s * self.scale[1];
        self.next.clone_from(&self.now);
        self.keep();
    }
}

#[cfg(test)]
mod tests;
