//! A pyramid is a long line with the least and greatest sample of every block of it, of every block
//! of blocks, and so on: what a screen can show of any part of it is found in a time that grows
//! with the columns of the screen, not with the samples.

/// Samples in a block, blocks in a block of blocks. Larger: more to look through at the ends;
/// smaller: more memory (a third of the line at 4).
const BRANCHING_FACTOR: usize = 4;

/// A line with its extremes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pyramid {
    points: Vec<[f64; 2]>,
    /// Of each level's blocks: indices of the least and the greatest sample, in order of x.
    levels: Vec<Vec<[u32; 2]>>,
}

impl Pyramid {
    /// The pyramid of points in order of x; at most 2³² of them are kept.
    #[must_use]
    pub fn new(mut points: Vec<[f64; 2]>) -> Self {
        points.truncate(u32::MAX as usize);
        let mut levels: Vec<Vec<[u32; 2]>> = Vec::new();
        let value = |i: u32| points[i as usize][1];
        let extremes = |candidates: &mut dyn Iterator<Item = u32>| {
            let first = candidates.next().unwrap_or_default();
            let ends = candidates.fold([first; 2], |[low, high], i| {
                [if value(i) < value(low) { i } else { low }, if value(i) > value(high) { i } else { high }]
            });
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        let count = points.len() as u32;
        let starts = (0..count).step_by(BRANCHING_FACTOR);
        let mut level: Vec<[u32; 2]> =
            starts.map(|s| extremes(&mut (s..count.min(s.saturating_add(BRANCHING_FACTOR as u32))))).collect();
        while level.len() > 1 {
            let next = level.chunks(BRANCHING_FACTOR).map(|c| extremes(&mut c.iter().flatten().copied())).collect();
            levels.push(std::mem::replace(&mut level, next));
        }
        Self { points, levels }
    }

    /// Every sample.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The part between two places, in at most some samples a column, with every column's least and
    /// greatest among them.
    #[must_use]
    pub fn view(&self, [left, right]: [f64; 2], columns: usize) -> Vec<[f64; 2]> {
        // One on each side, so that the line reaches the frame.
        let from = self.points.partition_point(|p| p[0] < left).saturating_sub(1);
        let to = (self.points.partition_point(|p| p[0] <= right) + 1).min(self.points.len()).max(from);
        let per_column = (to - from) / columns.max(1);
        // The widest blocks of which each column still has one.
        let mut size = BRANCHING_FACTOR;
        let level = self.levels.iter().take_while(|_| {
            let fits = size <= per_column;
            size *= if fits { BRANCHING_FACTOR } else { 1 };
            fits
        });
        let Some(blocks) = level.last() else {
            return self.points.get(from..to).unwrap_or_default().to_vec();
        };
        let size = size / BRANCHING_FACTOR;
        let blocks = blocks.get(from / size..to.div_ceil(size).min(blocks.len())).unwrap_or_default();
        let mut out = Vec::with_capacity(2 * blocks.len());
        for &[a, b] in blocks {
            out.extend(self.points.get(a as usize));
            out.extend(self.points.get(b as usize).filter(|_| a != b));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(n: u32) -> Vec<[f64; 2]> {
        (0..n).map(f64::from).map(|x| [x, (x * 1e-3).sin() + if x == 77_777.0 { 9.0 } else { 0.0 }]).collect()
    }

    #[test]
    fn a_view_has_every_extreme_and_few_samples() {
        let p = Pyramid::new(wave(1_000_000));
        for range in [[0.0, 1e6], [70_000.0, 80_000.0], [77_700.5, 77_800.5], [-5.0, 1.0], [2e6, 3e6]] {
            let seen = p.view(range, 1000);
            assert!(seen.len() <= 2 * BRANCHING_FACTOR * 1000 + 4, "{range:?}: {}", seen.len());
            assert!(seen.windows(2).all(|w| w[0][0] < w[1][0]), "{range:?}");
            let inside = || p.points.iter().filter(|q| q[0] >= range[0] && q[0] <= range[1]).map(|q| q[1]);
            let most = inside().fold(f64::NEG_INFINITY, f64::max);
            let least = inside().fold(f64::INFINITY, f64::min);
            assert!(!(seen.iter().map(|q| q[1]).fold(f64::NEG_INFINITY, f64::max) < most), "{range:?}");
            assert!(!(seen.iter().map(|q| q[1]).fold(f64::INFINITY, f64::min) > least), "{range:?}");
        }
        assert!(p.view([0.0, 1e6], 1000).len() > 1000);
    }

    #[test]
    fn short_lines_are_shown_as_they_are() {
        for n in [0, 1, 2, 5, 63] {
            let p = Pyramid::new(wave(n));
            assert_eq!(p.view([-1.0, 1e9], 640), p.points());
        }
    }
}
