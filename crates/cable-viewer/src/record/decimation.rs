//! Several samples are replaced by two that keep the least and the greatest of every line, or by
//! one with their means.

use crate::record::sample::Sample;

/// Two samples in the place of several: of every line the least and the greatest, in the order they
/// came in. None of none.
pub(super) fn merged(several: &[&Sample]) -> Vec<Sample> {
    let middle = several.len() / 2;
    let (Some(first), Some(half)) = (several.first(), several.get(middle)) else { return Vec::new() };
    let order = |of: &dyn Fn(&Sample) -> f64| {
        let (mut low, mut high) = (0, 0);
        let (mut least, mut most) = (of(first), of(first));
        for (k, sample) in several.iter().enumerate() {
            let value = of(sample);
            if value < least {
                (low, least) = (k, value);
            }
            if value > most {
                (high, most) = (k, value);
            }
        }
        // All alike: two places all the same.
        let two = if low == high { [0, middle] } else { [low.min(high), low.max(high)] };
        two.map(|k| several[k])
    };
    let mut out = vec![(*first).clone(), (*half).clone()];
    for (sample, from) in out.iter_mut().zip(order(&|s| s.max_tension_n)) {
        sample.max_tension_n = from.max_tension_n;
    }
    for k in 0..first.energy_j.len() {
        for (sample, from) in out.iter_mut().zip(order(&|s| s.energy_j[k])) {
            sample.energy_j[k] = from.energy_j[k];
        }
    }
    for k in 0..2 {
        for (sample, from) in out.iter_mut().zip(order(&|s| s.robot.map_or(0.0, |r| r[k]))) {
            if let (Some(mine), Some(theirs)) = (sample.robot.as_mut(), from.robot) {
                mine[k] = theirs[k];
            }
        }
    }
    for k in 0..first.reactions_n.len() {
        let size = |s: &Sample| s.reactions_n.get(k).map_or(0.0, |r| r[0].hypot(r[1]));
        for (sample, from) in out.iter_mut().zip(order(&size)) {
            if let (Some(mine), Some(theirs)) = (sample.reactions_n.get_mut(k), from.reactions_n.get(k)) {
                *mine = *theirs;
            }
        }
    }
    out
}

/// The means of several samples, at the mean of their times; of forces that of their size, to the
/// right. None of none.
pub(super) fn mean(several: &[&Sample]) -> Option<Sample> {
    let mut mean = (*several.first()?).clone();
    let count = several.len() as f64;
    let of = |value: &dyn Fn(&Sample) -> f64| several.iter().map(|s| value(s)).sum::<f64>() / count;
    mean.time_s = of(&|s| s.time_s);
    mean.max_tension_n = of(&|s| s.max_tension_n);
    for (k, energy_j) in mean.energy_j.iter_mut().enumerate() {
        *energy_j = of(&|s| s.energy_j[k]);
    }
    mean.robot = mean.robot.map(|_| [0, 1].map(|k| of(&|s| s.robot.map_or(0.0, |r| r[k]))));
    for (k, reaction_n) in mean.reactions_n.iter_mut().enumerate() {
        *reaction_n = [of(&|s| s.reactions_n.get(k).map_or(0.0, |r| r[0].hypot(r[1]))), 0.0];
    }
    Some(mean)
}
