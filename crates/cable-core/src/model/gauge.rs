//! The tension of a moving cable, gauged after every inner step of a model.
//!
//! A jerk passes between two looks at a cable: the inner steps see it. And an instant of it breaks nothing: fracture under a pulse takes
//! its time, and happens when the mean over that time reaches the strength (the incubation time criterion: Yu. V. Petrov,
//! N. F. Morozov, "On the modeling of fracture of brittle solids", Journal of Applied Mechanics 61(3), 1994),
//! ```text
//! 1/τ ∫ T(s, t') dt' over t − τ … t  ≥  T_b
//! ```
//! at a material point s. Meshes change, so means are taken at points of the cable that stay: the nodes of the first mesh that was
//! gauged. Between two inner steps tension is linear in time, between two nodes linear along the cable.

use crate::math::larger;
use crate::solution::{TensionPeak, TensionPeaks};

/// Looks at the mean in the time it is taken over. Of a triangular jerk as long as that, the greatest mean is missed by 1/(4·8²) of its
/// height at most; with more of them a step of `fem`, which is as long, costs more.
const LOOKS: usize = 8;

/// Two times (s) that differ by less are the same: sums of steps round.
const SAME_TIME_S: f64 = 1e-9;

/// What a gauge watches for: a mean of this much, from a time on, between two arc lengths.
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
    /// What was noted of a step that may still be discarded.
    next_s: f64,
    next: Vec<f64>,
    /// Time of the last look at the mean, in parts of `over_s / LOOKS`.
    look: f64,
    /// ∫T dt since that look, N s.
    since: Vec<f64>,
    /// The same between the looks before it, those of a look beside each other; the oldest is overwritten.
    between: Vec<f64>,
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
            since: Vec::new(),
            between: Vec::new(),
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
        let held = self.held.or_else(|| higher(None, &self.points, &self.mean, self.time_s));
        Some(TensionPeaks { greatest, held: held.unwrap_or(greatest), over_s: self.over_s })
    }

    /// Adds what was found in the parts of a step before.
    pub fn add_peaks(&mut self, before: Option<TensionPeaks>) {
        if let (Some(before), Some(now)) = (before, self.peaks()) {
            let sum = before.with(now);
            (self.greatest, self.held) = (Some(sum.greatest), Some(sum.held));
        }
    }

    /// Where and when the mean first reached the limit since [`Self::watch`].
    #[must_use]
    pub fn reached(&self) -> Option<TensionPeak> {
        self.reached
    }

    /// From now on a model is gauged that reckons with lengths and times so many times as large.
    pub fn of_copy(&mut self, [length, time]: [f64; 2]) {
        self.scale = [self.scale[0] / length, self.scale[1] / time];
    }

    /// Whether anything is gauged, and the past is not known up to a time (s of the model).
    #[must_use]
    pub fn asks(&self, time_s: f64) -> bool {
        self.on && !((self.time_s - time_s * self.scale[1]).abs() <= SAME_TIME_S)
    }

    /// Begins a history at a time (s): with the present tension as long as one likes where the cable was `at_rest`, else with none
    /// before. Arc lengths of nodes in m, tensions in N.
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
        let (count, part_s) = (self.now.len(), self.over_s / LOOKS as f64);
        self.look = if self.over_s > 0.0 { (self.time_s / part_s).floor() } else { 0.0 };
        let (past, mean) = (&self.now, if at_rest { 1.0 } else { 0.0 });
        self.mean.clear();
        self.mean.extend(past.iter().map(|t| t * mean));
        self.between.clear();
        for _ in 0..LOOKS {
            self.between.extend(past.iter().map(|t| t * mean * part_s));
        }
        let since_s = self.time_s - self.look * part_s;
        self.since.clear();
        self.since.extend(past.iter().map(|t| t * mean * since_s));
        self.next.resize(count, 0.0);
        self.oldest = 0;
    }

    /// Notes the tension (N) at nodes of arc lengths (m, in order) after an inner step to a time (s). It counts once it is kept: the
    /// step may still be discarded.
    pub fn note(&mut self, time_s: f64, arcs: &[f64], tension: impl Fn(usize) -> f64) {
        if !self.on {
            return;
        }
        self.next_s = time_s * self.scale[1];
        self.next.resize(self.points.len(), 0.0);
        let by = self.scale[0];
        if arcs.len() == self.points.len() && arcs.iter().zip(&self.points).all(|(s, p)| s * by == *p) {
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
            let (was, is) = (std::mem::take(&mut self.now), std::mem::take(&mut self.next));
            self.look_at([from_s, to_s], &was, &is);
            (self.now, self.next) = (was, is);
        }
        let end_s = self.reached.map_or(to_s, |r| r.time_s);
        if end_s >= to_s {
            self.greatest = higher(self.greatest, &self.points, &self.next, to_s);
        } else if end_s > from_s {
            // A cable that broke in this step was not pulled on to its end.
            let part = (end_s - from_s) / h;
            self.now.iter_mut().zip(&self.next).for_each(|(a, b)| *a += (b - *a) * part);
            self.greatest = higher(self.greatest, &self.points, &self.now, end_s);
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
        let (part_s, per_s) = (self.over_s / LOOKS as f64, (to_s - from_s).recip());
        let count = self.points.len().max(1);
        let mut at_s = from_s;
        loop {
            let (before_s, mut until_s) = (self.look * part_s, (self.look + 1.0) * part_s);
            if until_s > to_s {
                break;
            }
            let last = (to_s / part_s).floor();
            if at_s - from_s >= self.over_s && last - self.look > LOOKS as f64 {
                // In a step this long the mean goes on evenly from here to its end.
                (self.look, until_s, self.oldest) = (last, last * part_s, 0);
                for (k, slot) in self.between.chunks_exact_mut(count).enumerate() {
                    let middle = (until_s - ((LOOKS - k) as f64 - 0.5) * part_s - from_s) * per_s;
                    let ends = self.now.iter().zip(&self.next);
                    slot.iter_mut().zip(ends).for_each(|(part, (a, b))| *part = part_s * (a + (b - a) * middle));
                }
            } else {
                self.look += 1.0;
                let [low, high] = weights([at_s, until_s].map(|t| (t - from_s) * per_s), until_s - at_s);
                let ends = self.now.iter().zip(&self.next);
                if let Some(slot) = self.between.chunks_exact_mut(count).nth(self.oldest) {
                    for ((part, since), (a, b)) in slot.iter_mut().zip(&mut self.since).zip(ends) {
                        (*part, *since) = (*since + low * a + high * b, 0.0);
                    }
                }
                self.oldest = (self.oldest + 1) % LOOKS;
            }
            at_s = until_s;
            let (was, mut is) = (std::mem::take(&mut self.mean), std::mem::take(&mut self.spare));
            is.clear();
            is.resize(self.points.len(), 0.0);
            for slot in self.between.chunks_exact(count) {
                is.iter_mut().zip(slot).for_each(|(mean, part)| *mean += part);
            }
            let per_window = self.over_s.recip();
            is.iter_mut().for_each(|mean| *mean *= per_window);
            self.look_at([before_s, until_s], &was, &is);
            (self.mean, self.spare) = (is, was);
        }
        let [low, high] = weights([at_s, to_s].map(|t| (t - from_s) * per_s), to_s - at_s);
        for (since, (a, b)) in self.since.iter_mut().zip(self.now.iter().zip(&self.next)) {
            *since += low * a + high * b;
        }
    }

    /// Looks at means (N) between two times (s) at which they are known.
    fn look_at(&mut self, [from_s, to_s]: [f64; 2], was: &[f64], is: &[f64]) {
        if self.reached.is_some() {
            return;
        }
        let Limit { tension_n, from_s: awake_s, within_m: [low, high] } = self.limit;
        if greatest(is) >= tension_n && to_s >= awake_s {
            let mut first: Option<(TensionPeak, f64)> = None;
            for ((&s, &had), &has) in self.points.iter().zip(was).zip(is) {
                if !(has >= tension_n && s >= low && s <= high) {
                    continue;
                }
                let part = if had < tension_n { (tension_n - had) / (has - had) } else { 0.0 };
                let time_s = larger(from_s + (to_s - from_s) * part, awake_s);
                if first.is_none_or(|(f, most)| time_s < f.time_s || (time_s == f.time_s && has > most)) {
                    first = Some((TensionPeak { tension_n: larger(had, tension_n), arc_length_m: s, time_s }, has));
                }
            }
            if let Some((first, _)) = first {
                self.reached = Some(first);
                self.held = self.held.filter(|h| h.tension_n >= first.tension_n).or(Some(first));
                return;
            }
        }
        self.held = higher(self.held, &self.points, is, to_s);
    }
}

/// What the tensions at two parts of a step weigh in the integral over a time (s) between them.
fn weights([from, to]: [f64; 2], time_s: f64) -> [f64; 2] {
    let high = 0.5 * (from + to);
    [(1.0 - high) * time_s, high * time_s]
}

/// The greatest of some figures, 0 of none. In lanes: one after the other each waits for the one before.
fn greatest(figures: &[f64]) -> f64 {
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
fn higher(before: Option<TensionPeak>, points: &[f64], tensions: &[f64], time_s: f64) -> Option<TensionPeak> {
    let most = greatest(tensions);
    if before.is_some_and(|b| !(most > b.tension_n)) {
        return before;
    }
    let arc_length_m = tensions.iter().zip(points).find(|(t, _)| **t == most).map_or(0.0, |p| *p.1);
    Some(TensionPeak { tension_n: most, arc_length_m, time_s })
}

#[cfg(test)]
#[path = "gauge_tests.rs"]
mod tests;
