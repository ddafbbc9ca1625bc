//! The history keeps tension and reactions against time within a budget of memory: where that is
//! full, the older half is thinned so that extremes survive.

use std::collections::VecDeque;

use crate::record::decimation::{mean, merged};
use crate::record::sample::Sample;

/// The samples since the last start, oldest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampleHistory {
    /// Times increase.
    pub samples: VecDeque<Sample>,
    /// Memory of the samples, bytes.
    bytes: usize,
    /// For each whole block of [`BLOCKS`] samples two with the least and the greatest of every
    /// line.
    blocks: [Vec<Sample>; 2],
    /// For each whole block the means of every line.
    means: [Vec<Sample>; 2],
}

/// Samples in a block of each level. What a graph shows of a long history is read off the largest
/// blocks of which each of its columns has one, in a time that grows with its columns: all of a
/// full history took 30 ms a frame.
const BLOCKS: [usize; 2] = [16, 256];

impl SampleHistory {
    /// Memory for samples, bytes: 32 MiB hold 15 minutes of a cable with two supports at 240
    /// samples a second, and 10 minutes with eight. Once full, each four samples of the older half
    /// become two that keep the least and the greatest of every line, again and again: no peak is
    /// ever lost and nothing is forgotten. More costs small machines their memory and every frame
    /// that shows all of it; less makes what is minutes old coarse.
    pub const BUDGET_BYTES: usize = 32 << 20;

    /// Adds an instant; one at or before the last replaces what came after it.
    pub fn push(&mut self, sample: Sample) {
        while self.samples.back().is_some_and(|last| !(last.time_s < sample.time_s)) {
            self.bytes -= self.samples.pop_back().map_or(0, |s| s.bytes());
        }
        for ((level, means), size) in self.blocks.iter_mut().zip(&mut self.means).zip(BLOCKS) {
            level.truncate(2 * (self.samples.len() / size));
            means.truncate(self.samples.len() / size);
        }
        self.bytes += sample.bytes();
        self.samples.push_back(sample);
        if self.bytes > Self::BUDGET_BYTES {
            self.decimate();
        }
        self.summarise();
    }

    /// Brings the blocks up to the samples.
    fn summarise(&mut self) {
        for ((level, means), size) in self.blocks.iter_mut().zip(&mut self.means).zip(BLOCKS) {
            while (level.len() / 2 + 1) * size <= self.samples.len() {
                let from = level.len() / 2 * size;
                let block: Vec<&Sample> = self.samples.range(from..from + size).collect();
                level.extend(merged(&block));
                means.extend(mean(&block));
            }
        }
    }

    /// The samples between two times (s) and one on each side, or blocks of them where there are
    /// more than a graph of so many columns can show: oldest first, with the least and greatest of
    /// every line in every column.
    #[must_use]
    pub fn view(&self, range_s: [f64; 2], columns: Option<usize>) -> Vec<&Sample> {
        self.parts(range_s, columns, &self.blocks, 2)
    }

    /// The same with the means of blocks instead of their extremes. What was thinned because memory
    /// was full has the means of what was kept.
    #[must_use]
    pub fn means(&self, range_s: [f64; 2], columns: Option<usize>) -> Vec<&Sample> {
        self.parts(range_s, columns, &self.means, 1)
    }

    /// Samples in view, or what stands for blocks of them: `each` samples a block.
    fn parts<'a>(
        &'a self,
        [from_s, to_s]: [f64; 2],
        columns: Option<usize>,
        levels: &'a [Vec<Sample>; 2],
        each: usize,
    ) -> Vec<&'a Sample> {
        let samples = &self.samples;
        let start = samples.partition_point(|s| s.time_s < from_s).saturating_sub(1);
        let end = (samples.partition_point(|s| s.time_s <= to_s) + 1).min(samples.len()).max(start);
        let per_column = columns.map_or(0, |c| (end - start) / c.max(1));
        let level = levels.iter().zip(BLOCKS).rev().find(|(_, size)| *size <= per_column);
        let Some((blocks, size)) = level else { return samples.range(start..end).collect() };
        // Whole blocks, then what no block holds yet.
        let (first, last) = (start / size, (end.div_ceil(size)).min(blocks.len() / each));
        let mut out: Vec<&Sample> = blocks.get(each * first..each * last).unwrap_or_default().iter().collect();
        out.extend(samples.range((last * size).clamp(start, end)..end));
        out
    }

    /// Time (s) and value of the greatest of a line that
    /// [`Measure::PRIMARY_LINES`](crate::record::plotted_quantity::Measure::PRIMARY_LINES) names:
    /// the block it is in is found first.
    #[must_use]
    pub fn peak(&self, of: impl Fn(&Sample) -> f64) -> Option<[f64; 2]> {
        let greatest = |a: (usize, f64), b: (usize, f64)| if b.1 > a.1 { b } else { a };
        let [_, size] = BLOCKS;
        let [_, blocks] = &self.blocks;
        let known = blocks.len() / 2 * size;
        let values = blocks.iter().enumerate().map(|(k, s)| (k / 2 * size, of(s))).filter(|(_, v)| v.is_finite());
        let block = values.reduce(greatest).map_or(known, |(from, _)| from);
        let ends = [block..(block + size).min(known), known..self.samples.len()];
        let inside = ends.into_iter().flat_map(|r| r.map(|k| (k, self.samples.get(k).map_or(f64::NAN, &of))));
        let (k, value) = inside.filter(|(_, v)| v.is_finite()).reduce(greatest)?;
        Some([self.samples.get(k)?.time_s, value])
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Memory of the samples, bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Leaves half of the older half.
    fn decimate(&mut self) {
        let recent = self.samples.split_off(self.samples.len() / 8 * 4);
        let old = std::mem::take(&mut self.samples);
        self.samples.reserve_exact(old.len() / 2 + recent.len());
        let mut old = old.into_iter();
        while let (Some(a), Some(b), Some(c), Some(d)) = (old.next(), old.next(), old.next(), old.next()) {
            self.samples.extend(merged(&[&a, &b, &c, &d]));
        }
        self.samples.extend(recent);
        self.blocks = [Vec::new(), Vec::new()];
        self.means = [Vec::new(), Vec::new()];
        self.bytes = self.samples.iter().map(Sample::bytes).sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every line has peaks of its own at places of its own.
    fn at(k: u32) -> Sample {
        let t = f64::from(k) / 240.0;
        let peak = |n: u32, size: f64| if k % 7919 == n { size } else { 0.0 };
        Sample {
            time_s: t,
            max_tension_n: 100.0 + t.sin() + peak(11, 900.0),
            energy_j: [0, 1, 2, 3].map(|n| f64::from(n) + (t + f64::from(n)).cos() - peak(100 + n, 50.0)),
            robot: Some([0.3 + peak(500, 1.0), 200.0 - peak(501, 150.0)]),
            reactions_n: vec![[100.0, peak(1000, 800.0)], [-90.0 - peak(2000, 700.0), 3.0]],
        }
    }

    #[test]
    fn ten_minutes_at_240_hz_stay_within_the_budget_and_keep_every_peak() {
        let count = 240 * 60 * 20;
        let mut history = SampleHistory::default();
        for k in 0..count {
            history.push(at(k));
            assert!(history.bytes() <= SampleHistory::BUDGET_BYTES);
        }
        let samples = &history.samples;
        assert!(samples.len() > 100_000, "{}", samples.len());
        assert_eq!((samples[0].time_s, samples[samples.len() - 1].time_s), (0.0, at(count - 1).time_s));
        assert!(samples.iter().zip(samples.iter().skip(1)).all(|(a, b)| a.time_s < b.time_s));
        // The last five minutes are as they came.
        let recent: Vec<&Sample> = samples.iter().rev().take(240 * 300).collect();
        assert!(recent.iter().enumerate().all(|(j, s)| **s == at(count - 1 - j as u32)));
        // A graph of the history shows the greatest value of all, with few samples.
        for range in [[0.0, 1e9], [100.0, 1100.0], [600.0, 1200.0]] {
            let seen = history.view(range, Some(600));
            assert!(seen.len() < 20_000, "{range:?}: {}", seen.len());
            assert!(seen.windows(2).all(|w| w[0].time_s < w[1].time_s), "{range:?}");
            let inside = samples.iter().filter(|s| s.time_s >= range[0] && s.time_s <= range[1]);
            let most = inside.map(|s| s.max_tension_n).fold(0.0, f64::max);
            assert!(seen.iter().any(|s| s.max_tension_n >= most), "{range:?}");
        }
        assert_eq!(history.view([1000.0, 1001.0], Some(600)).len(), 243);
        // Every peak of every line, to the bit, within an eighth of a second of where it was.
        let lines: [fn(&Sample) -> f64; 9] = [
            |s| s.max_tension_n,
            |s| -s.energy_j[0],
            |s| -s.energy_j[1],
            |s| -s.energy_j[2],
            |s| -s.energy_j[3],
            |s| s.robot.map_or(0.0, |r| r[0]),
            |s| -s.robot.map_or(0.0, |r| r[1]),
            |s| s.reactions_n[0][0].hypot(s.reactions_n[0][1]),
            |s| s.reactions_n[1][0].hypot(s.reactions_n[1][1]),
        ];
        for (n, line) in [11, 100, 101, 102, 103, 500, 501, 1000, 2000].into_iter().zip(lines) {
            for peak in (n..count).step_by(7919).map(at) {
                let from = samples.partition_point(|s| s.time_s < peak.time_s - 0.125);
                let near = samples.range(from..).take_while(|s| s.time_s < peak.time_s + 0.125);
                assert!(near.clone().any(|s| line(s) == line(&peak)), "line {n}, peak at {} s", peak.time_s);
            }
        }
    }

    #[test]
    fn the_greatest_is_found_with_its_time_wherever_it_is() {
        let leads: [fn(&Sample) -> f64; 2] = [|s| s.max_tension_n, |s| s.robot.map_or(f64::NAN, |r| r[0])];
        for count in [0, 1, 200, 256, 600, 9000, 40_000] {
            let mut history = SampleHistory::default();
            (0..count).for_each(|k| history.push(at(k)));
            for of in leads {
                let all = history.samples.iter().map(|s| [s.time_s, of(s)]);
                let expected = all.reduce(|a, b| if b[1] > a[1] { b } else { a });
                assert_eq!(history.peak(of), expected, "of {count}");
            }
            assert_eq!(history.peak(|_| f64::NAN), None);
        }
    }

    #[test]
    fn means_of_blocks_are_those_of_their_samples() {
        let mut history = SampleHistory::default();
        (0..2600).for_each(|k| history.push(at(k)));
        for (columns, size) in [(150, 16), (10, 256)] {
            let means = history.means([0.0, 1e9], Some(columns));
            let first: Vec<Sample> = (0..size).map(at).collect();
            let expected = first.iter().map(|s| s.max_tension_n).sum::<f64>() / f64::from(size);
            assert!((means[0].max_tension_n - expected).abs() < 1e-9, "{size}");
            let expected = first.iter().map(|s| s.reactions_n[0][0].hypot(s.reactions_n[0][1])).sum::<f64>();
            assert!((means[0].reactions_n[0][0] - expected / f64::from(size)).abs() < 1e-9, "{size}");
            assert!(means.windows(2).all(|w| w[0].time_s < w[1].time_s), "{size}");
        }
        assert_eq!(history.means([0.0, 1e9], None).len(), 2600);
    }

    #[test]
    fn what_is_wound_back_over_is_forgotten() {
        let mut history = SampleHistory::default();
        (0..10).for_each(|k| history.push(at(k)));
        let bytes = history.bytes();
        history.push(at(4));
        assert_eq!(history.means, [Vec::new(), Vec::new()]);
        assert_eq!(history.samples.len(), 5);
        assert_eq!(history.bytes(), bytes / 2);
        history.clear();
        assert_eq!(history, SampleHistory::default());
    }
}
