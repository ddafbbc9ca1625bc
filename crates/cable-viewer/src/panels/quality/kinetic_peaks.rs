//! Peaks of the kinetic energy in spans of time, one after the other, show whether it grows.

use crate::record::sample::Sample;
use crate::record::sample_history::SampleHistory;

/// Time over which the kinetic energy is compared with that of as long before, s. Shorter: every
/// swing is a growth; longer: a run that diverges has ended.
pub const GROWTH_SPAN_S: f64 = 1.0;
/// The greatest kinetic energy of the last N spans, oldest first, J; None where less was recorded.
#[must_use]
pub fn kinetic_peaks_j<const N: usize>(history: &SampleHistory) -> Option<[f64; N]> {
    let now_s = history.samples.back()?.time_s;
    let first_s = history.samples.front()?.time_s;
    let peak = |from_s: f64| {
        let seen = history.view([from_s, from_s + GROWTH_SPAN_S], None);
        let inside = |s: &&&Sample| s.time_s > from_s && s.time_s <= from_s + GROWTH_SPAN_S;
        seen.iter().filter(inside).map(|s| s.energy_j[0]).fold(0.0, f64::max)
    };
    let begins_s = |k: usize| now_s - (N - k) as f64 * GROWTH_SPAN_S;
    (begins_s(0) >= first_s).then(|| std::array::from_fn(|k| peak(begins_s(k))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_told_from_decay() {
        let history = |of: fn(f64) -> f64| {
            let mut history = SampleHistory::default();
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
        assert_eq!(kinetic_peaks_j::<2>(&SampleHistory::default()), None);
        let four = kinetic_peaks_j::<4>(&history(|t| t.exp())).unwrap();
        assert!(four.windows(2).all(|w| w[1] > 2.0 * w[0]));
        assert_eq!(kinetic_peaks_j::<5>(&history(|t| t.exp())), None);
    }
}
