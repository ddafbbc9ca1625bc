//! Peaks of the kinetic energy in two spans of time, one after the other, show whether it grows.

use crate::record::history::History;
use crate::record::sample::Sample;

/// Time over which the kinetic energy is compared with that of as long before, s. Shorter: every
/// swing is a growth; longer: a run that diverges has ended.
const GROWTH_SPAN_S: f64 = 1.0;
/// The greatest kinetic energy of the last span and of that before, J; None where less was
/// recorded.
#[must_use]
pub fn kinetic_peaks_j(history: &History) -> Option<[f64; 2]> {
    let now_s = history.samples.back()?.time_s;
    let first_s = history.samples.front()?.time_s;
    let peak = |from_s: f64| {
        let seen = history.view([from_s, from_s + GROWTH_SPAN_S], None);
        let inside = |s: &&&Sample| s.time_s > from_s && s.time_s <= from_s + GROWTH_SPAN_S;
        seen.iter().filter(inside).map(|s| s.energy_j[0]).fold(0.0, f64::max)
    };
    let before_s = now_s - 2.0 * GROWTH_SPAN_S;
    (before_s >= first_s).then(|| [peak(before_s), peak(now_s - GROWTH_SPAN_S)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_told_from_decay() {
        let history = |of: fn(f64) -> f64| {
            let mut history = History::default();
            for time_s in (0..300).map(|k| f64::from(k) / 60.0) {
                let energy_j = [of(time_s), 0.0, 0.0, 0.0];
                history.push(Sample { time_s, max_tension_n: 0.0, energy_j, robot: None, reactions_n: Vec::new() });
            }
            history
        };
        let [before, last] = kinetic_peaks_j(&history(|t| t.exp())).unwrap();
        assert!(last > 2.0 * before);
        let [before, last] = kinetic_peaks_j(&history(|t| (-t).exp())).unwrap();
        assert!(last < before);
        assert_eq!(kinetic_peaks_j(&History::default()), None);
    }
}
