//! The gauge reads the tension of a moving cable after every inner step of a model.
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

use crate::math::larger;
use crate::solution::{TensionPeak, TensionPeaks};

/// Looks at the mean in the time it is taken over. Of a triangular jerk as long as that, the
/// greatest mean is missed by 1/(4·4²) of its height at most, 1.6 %; with 8 looks by 0.4 %, and a
/// step of `fem`, which is as long as that time, costs 3 % more.
const LOOKS_PER_MEAN: usize = 4;

/// Two times (s) that differ by less are the same: sums of steps round.
const SAME_TIME_S: f64 = 1e-9;

/// A mean that a gauge looks for: a mean of this much, from a time on, between two arc lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Mean tension, N.
    pub tension_n: f64,
    /// Not before, s.
    pub from_s: f64,
    /// Arc lengths, m.
    pub within_m: [f64; 2],
}

impl Default for Limit {
    fn default() -> Self {
        Self { tension_n: f64::INFINITY, from_s: f64::NEG_INFINITY, within_m: [f64::NEG_INFINITY, f64::INFINITY] }
    }
}

/// Tension along a cable over the last while.
#[derive(Clone, Debug)]
pub struct TensionGauge {
    on: bool,
    /// Time that means are taken over, s; 0: each instant counts.
    over_s: f64,
    limit: Limit,
    /// Arc length and time of the cable over those of the model that is gauged.
    scale: [f64; 2],
    /// Arc lengths of the material points, m.
    points: Vec<f64>,
    /// Time reached, s; not a number where nothing is known.
    time_s: f64,
    /// Tension at the points then, N.
    now: Vec<f64>,
    /// Notes of a step that may still be discarded.
    next_s: f64,
    next: Vec<f64>,
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
    greatest: Option<TensionPeak>,
    held: Option<TensionPeak>,
    reached: Option<TensionPeak>,
}

impl Default for TensionGauge {
    fn default() -> Self {
        Self::off()
    }
}

impl TensionGauge {
    /// A gauge that gauges nothing.
    #[must_use]
    pub fn off() -> Self {
        Self {
            on: false,
            over_s: 0.0,
            limit: Limit::default(),
            scale: [1.0; 2],
            points: Vec::new(),
            time_s: f64::NAN,
            now: Vec::new(),
            next_s: f64::NAN,
            next: Vec::new(),
            look: 0.0,
            sum: Vec::new(),
            sums: Vec::new(),
            oldest: 0,
            mean: Vec::new(),
            spare: Vec::new(),
            greatest: None,
            held: None,
            reached: None,
        }
    }

    /// A gauge with means over a time (s).
    #[must_use]
    pub fn over(over_s: f64) -> Self {
        let over_s = if over_s > 0.0 && over_s.is_finite() { over_s } else { 0.0 };
        Self { on: true, over_s, ..Self::off() }
    }

    /// Begins a step of the caller: what was found before is forgotten, what was gauged is not.
    pub fn watch(&mut self, limit: Limit) {
        self.limit = limit;
        (self.greatest, self.held, self.reached) = (None, None, None);
    }

    /// Forgets what was gauged: the cable was put elsewhere, or goes on without inertia.
    pub fn forget(&mut self) {
        self.time_s = f64::NAN;
        (self.greatest, self.held, self.reached) = (None, None, None);
    }

    /// The greatest tensions and means since [`Self::watch`]; None where nothing was gauged.
    #[must_use]
    pub fn peaks(&self) -> Option<TensionPeaks> {
        let greatest = self.greatest?;
        // In a step between two looks the mean is what it was.
        let held = self.held.or_else(|| higher(None, &self.points, &self.mean, most_of(&self.mean), self.time_s));
        Some(TensionPeaks { greatest, held: held.unwrap_or(greatest), over_s: self.over_s })
    }

    /// Adds what was found in the parts of a step before.
    pub(crate) fn add_peaks(&mut self, before: Option<TensionPeaks>) {
        if let (Some(before), Some(now)) = (before, self.peaks()) {
            let sum = before.with(now);
            (self.greatest, self.held) = (Some(sum.greatest), Some(sum.held));
        }
    }

    /// Returns where and when the mean first reached the limit since [`Self::watch`].
    #[must_use]
    pub fn reached(&self) -> Option<TensionPeak> {
        self.reached
    }

    /// From now on a model is gauged that reckons with lengths and times so many times as large.
    pub(crate) fn of_copy(&mut self, [length, time]: [f64; 2]) {
        self.scale = [self.scale[0] / length, self.scale[1] / time];
    }

    /// Returns whether anything is gauged, and the past is not known up to a time (s of the model).
    #[must_use]
    pub fn asks(&self, time_s: f64) -> bool {
        self.on && !((self.time_s - time_s * self.scale[1]).abs() <= SAME_TIME_S)
    }

    /// Begins a history at a time (s): with the present tension as long as one likes where the
    /// cable was `at_rest`, else with none before. Arc lengths of nodes in m, tensions in N.
    pub fn begin(&mut self, time_s: f64, at_rest: bool, arcs: &[f64], tension: impl Fn(usize) -> f64) {
        if !self.on {
            return;
        }
        let whole = arcs.last().copied().unwrap_or(0.0) * self.scale[0];
        if !self.points.last().is_some_and(|last| (last - whole).abs() <= 1e-9 * whole) {
            self.points.clear();
            self.points.extend(arcs.iter().map(|s| s * self.scale[0]));
        }
        self.note(time_s, arcs, tension);
        self.time_s = self.next_s;
        std::mem::swap(&mut self.now, &mut self.next);
        let (count, part_s) = (self.now.len(), self.over_s / LOOKS_PER_MEAN as f64);
        self.look = if self.over_s > 0.0 { (self.time_s / part_s).floor() } else { 0.0 };
        let (past, mean) = (&self.now, if at_rest { 1.0 } else { 0.0 });
        self.mean.clear();
        self.mean.extend(past.iter().map(|t| t * mean));
        self.sums.clear();
        for k in 0..LOOKS_PER_MEAN {
            let before_s = self.time_s - (self.look - (LOOKS_PER_MEAN - 1 - k) as f64) * part_s;
            self.sums.extend(past.iter().map(|t| -t * mean * before_s));
        }
        self.sum.clear();
        self.sum.resize(count, 0.0);
        self.next.resize(count, 0.0);
        self.oldest = 0;
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
    pub fn knows(&self, arcs: &[f64]) -> bool {
        let by = self.scale[0];
        self.on && arcs.len() == self.points.len() && arcs.iter().zip(&self.points).all(|(s, p)| s * by == *p)
    }

    /// Room for the tensions (N) at a time (s) of a mesh that it [knows](Self::knows): as
    /// [`Self::note`].
    pub fn room(&mut self, time_s: f64) -> &mut [f64] {
        self.next_s = time_s * self.scale[1];
        &mut self.next
    }

    /// Keeps what was noted.
    pub fn keep(&mut self) {
        let (from_s, to_s) = (self.time_s, self.next_s);
        let h = to_s - from_s;
        if !(self.on && h > 0.0) {
            return;
        }
        if self.over_s > 0.0 {
            self.take_means(from_s, to_s);
        } else {
            let before = Found { held: self.held, reached: self.reached };
            Found { held: self.held, reached: self.reached } =
                look_at(&self.points, &self.limit, [from_s, to_s], [&self.now, &self.next], before);
        }
        let end_s = self.reached.map_or(to_s, |r| r.time_s);
        if end_s >= to_s {
            self.greatest = higher(self.greatest, &self.points, &self.next, most_of(&self.next), to_s);
        } else if end_s > from_s {
            // A cable that broke in this step was not pulled on to its end.
            let part = (end_s - from_s) / h;
            self.now.iter_mut().zip(&self.next).for_each(|(a, b)| *a += (b - *a) * part);
            self.greatest = higher(self.greatest, &self.points, &self.now, most_of(&self.now), end_s);
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

    /// Looks at the means between two times (s).
    fn take_means(&mut self, from_s: f64, to_s: f64) {
        let (part_s, per_s) = (self.over_s / LOOKS_PER_MEAN as f64, (to_s - from_s).recip());
        let (count, per_window) = (self.points.len().max(1), self.over_s.recip());
        let (sum, now, next) = (&mut self.sum, &self.now, &self.next);
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
                    add(sum, now, next, [at_s, until_s].map(|t| (t - from_s) * per_s), until_s - at_s);
                    slot.copy_from_slice(sum);
                    (self.look, at_s) = (self.look + 1.0, until_s);
                }
                until_s = self.look * part_s;
            } else {
                self.look += 1.0;
            }
            add(sum, now, next, [at_s, until_s].map(|t| (t - from_s) * per_s), until_s - at_s);
            at_s = until_s;
            self.spare.resize(self.points.len(), 0.0);
            if let Some(slot) = self.sums.chunks_exact_mut(count).nth(self.oldest) {
                for ((mean, sum), slot) in self.spare.iter_mut().zip(sum.iter()).zip(slot) {
                    *mean = (sum - *slot) * per_window;
                    *slot = *sum;
                }
            }
            self.oldest = (self.oldest + 1) % LOOKS_PER_MEAN;
            std::mem::swap(&mut self.mean, &mut self.spare);
            let before = Found { held: self.held, reached: self.reached };
            Found { held: self.held, reached: self.reached } =
                look_at(&self.points, &self.limit, [before_s, until_s], [&self.spare, &self.mean], before);
        }
        add(sum, now, next, [at_s, to_s].map(|t| (t - from_s) * per_s), to_s - at_s);
    }
}

/// Adds the integral of tensions over a time (s) between two parts of a step, N s.
fn add(sum: &mut [f64], now: &Vec<f64>, next: &Vec<f64>, [from, to]: [f64; 2], time_s: f64) {
    let middle = 0.5 * (from + to);
    let (low, high) = ((1.0 - middle) * time_s, middle * time_s);
    for ((sum, a), b) in sum.iter_mut().zip(now).zip(next) {
        *sum += low * a + high * b;
    }
}

/// The highest mean, and where the limit was first reached.
#[derive(Clone, Copy)]
struct Found {
    held: Option<TensionPeak>,
    reached: Option<TensionPeak>,
}

/// Looks at means (N) between two times (s) at which they are known.
fn look_at(points: &[f64], limit: &Limit, [from_s, to_s]: [f64; 2], [was, is]: [&[f64]; 2], before: Found) -> Found {
    let held = before.held;
    if before.reached.is_some() {
        return before;
    }
    let most = most_of(is);
    if most >= limit.tension_n && to_s >= limit.from_s {
        let [low, high] = limit.within_m;
        let mut first: Option<(TensionPeak, f64)> = None;
        for ((&s, &had), &has) in points.iter().zip(was).zip(is) {
            if !(has >= limit.tension_n && s >= low && s <= high) {
                continue;
            }
            let part = if had < limit.tension_n { (limit.tension_n - had) / (has - had) } else { 0.0 };
            let time_s = larger(from_s + (to_s - from_s) * part, limit.from_s);
            if first.is_none_or(|(f, most)| time_s < f.time_s || (time_s == f.time_s && has > most)) {
                let tension_n = larger(had, limit.tension_n);
                first = Some((TensionPeak { tension_n, arc_length_m: s, time_s }, has));
            }
        }
        if let Some((first, _)) = first {
            let held = held.filter(|h| h.tension_n >= first.tension_n).or(Some(first));
            return Found { held, reached: Some(first) };
        }
    }
    Found { held: higher(held, points, is, most, to_s), reached: None }
}

/// The greatest of some figures, 0 of none. In lanes: one after the other each waits for the one
/// before.
fn most_of(figures: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let fours = figures.chunks_exact(4);
    for (lane, last) in lanes.iter_mut().zip(fours.remainder()) {
        *lane = larger(*lane, *last);
    }
    for four in fours {
        for (lane, figure) in lanes.iter_mut().zip(four) {
            *lane = if figure > lane { *figure } else { *lane };
        }
    }
    lanes.into_iter().fold(0.0, larger)
}

/// A peak, or the greatest of some tensions (N) at points (m) at a time (s) where that is more.
fn higher(
    before: Option<TensionPeak>,
    points: &[f64],
    tensions: &[f64],
    most: f64,
    time_s: f64,
) -> Option<TensionPeak> {
    if before.is_some_and(|b| !(most > b.tension_n)) {
        return before;
    }
    let arc_length_m = tensions.iter().zip(points).find(|(t, _)| **t == most).map_or(0.0, |p| *p.1);
    Some(TensionPeak { tension_n: most, arc_length_m, time_s })
}

#[cfg(test)]
#[path = "gauge_tests.rs"]
mod tests;
