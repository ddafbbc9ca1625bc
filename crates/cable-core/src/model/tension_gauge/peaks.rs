//! This module finds the highest mean tension of a step, and the place and time at which it first
//! reached a limit.

use crate::math::larger;
use crate::solution::TensionPeak;

/// A limit of the mean tension, from a time on, between two arc lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Mean tension, N.
    pub tension_n: f64,
    /// Earliest time, s.
    pub from_s: f64,
    /// Arc lengths, m.
    pub within_m: [f64; 2],
}

impl Default for Limit {
    fn default() -> Self {
        Self { tension_n: f64::INFINITY, from_s: f64::NEG_INFINITY, within_m: [f64::NEG_INFINITY, f64::INFINITY] }
    }
}

/// The highest mean, and where the limit was first reached.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PeaksOfMeans {
    pub held: Option<TensionPeak>,
    pub reached: Option<TensionPeak>,
}

impl PeaksOfMeans {
    /// Compares means (N) with the limits, of one stretch each, between two times (s) at which they
    /// are known.
    pub fn look_at(&mut self, points: &[f64], limits: &[Limit], [from_s, to_s]: [f64; 2], [was, is]: [&[f64]; 2]) {
        if self.reached.is_some() {
            return;
        }
        let most = greatest_of(is);
        let mut first: Option<(TensionPeak, f64)> = None;
        for limit in limits.iter().filter(|limit| most >= limit.tension_n && to_s >= limit.from_s) {
            let [low, high] = limit.within_m;
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
        }
        if let Some((first, _)) = first {
            self.held = self.held.filter(|h| h.tension_n >= first.tension_n).or(Some(first));
            self.reached = Some(first);
            return;
        }
        self.held = higher(self.held, points, is, most, to_s);
    }
}

/// The greatest of some figures, 0 for none. Independent lanes let the processor work in parallel.
pub(super) fn greatest_of(figures: &[f64]) -> f64 {
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
pub(super) fn higher(
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
