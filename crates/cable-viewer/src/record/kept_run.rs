//! A whole run is kept to compare with.

use std::sync::Arc;

use cable_core::Solution;

use crate::record::plotted_quantity::Measure;
use crate::record::pyramid::Pyramid;
use crate::record::sample::Sample;

/// Most pictures kept of a run that is compared with; its lines in the graphs keep every sample.
/// Enough: ten minutes at one a second, and a run of 20 s (a drive of the robot from the riser and
/// back) at 30 a second, so that the cable of a fast run moves smoothly beside the present one; a
/// longer run is shown at fewer pictures a second, at least one a second up to ten minutes. 600
/// pictures of 200 nodes are 9 MB, of eight runs 70 MB. More: eight held runs fill the memory of a
/// small machine; fewer: the cable of a fast run jumps.
const MAX_ANSWERS: usize = 600;

/// The description of a run.
#[derive(Clone, Debug, Default)]
pub struct KeptRun {
    /// The leading line of each measure over time, SI, in the order of [`Measure::PRIMARY_LINES`].
    lines: Vec<Pyramid>,
    /// The greatest of each of them: looked for once, not in every frame.
    peaks: Vec<Option<Peak>>,
    /// Some of its answers, oldest first.
    answers: Vec<Arc<Solution>>,
    /// The number of warnings that began in it.
    pub events: usize,
}

/// The greatest of a run, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Value, SI.
    pub value: f64,
    /// Time, s.
    pub time_s: f64,
}

impl KeptRun {
    /// The run that was recorded; None while it has fewer than two instants.
    #[must_use]
    pub fn of<'a>(
        samples: impl Iterator<Item = &'a Sample> + Clone,
        answers: &[Solution],
        events: usize,
    ) -> Option<Self> {
        if answers.len() < 2 {
            return None;
        }
        let line = |of: fn(&Sample) -> f64| {
            let points = samples.clone().map(|s| [s.time_s, of(s)]).filter(|p| p[1].is_finite());
            Pyramid::new(points.collect())
        };
        let lines: Vec<Pyramid> = Measure::PRIMARY_LINES.iter().map(|(_, of)| line(*of)).collect();
        let peaks = lines.iter().map(|l| Peak::of(l.points().iter().copied())).collect();
        let every = answers.len().div_ceil(MAX_ANSWERS).max(1);
        let chosen = answers.iter().step_by(every).chain(answers.last());
        Some(Self { lines, peaks, answers: chosen.map(|a| Arc::new(a.clone())).collect(), events })
    }

    /// The leading line of a measure over time; None where it has none.
    #[must_use]
    pub fn line(&self, measure: Measure) -> Option<&Pyramid> {
        let k = Measure::PRIMARY_LINES.iter().position(|(m, _)| m.shares_primary_line(measure))?;
        self.lines.get(k).filter(|l| !l.points().is_empty())
    }

    /// The picture at a time, s: the last one not after it, else the first.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Option<&Arc<Solution>> {
        let k = self.answers.partition_point(|a| a.time_s <= time_s);
        self.answers.get(k.saturating_sub(1))
    }

    /// First and last time, s.
    #[must_use]
    pub fn span_s(&self) -> [f64; 2] {
        let time = |a: Option<&Arc<Solution>>| a.map_or(0.0, |a| a.time_s);
        [time(self.answers.first()), time(self.answers.last())]
    }

    /// The greatest of a measure.
    #[must_use]
    pub fn peak(&self, measure: Measure) -> Option<Peak> {
        let k = Measure::PRIMARY_LINES.iter().position(|(m, _)| m.shares_primary_line(measure))?;
        self.peaks.get(k).copied().flatten()
    }
}

impl Peak {
    /// The greatest of samples (time and value); what is not finite is left out.
    #[must_use]
    pub fn of(samples: impl Iterator<Item = [f64; 2]>) -> Option<Self> {
        let best = samples.filter(|s| s[1].is_finite()).max_by(|a, b| a[1].total_cmp(&b[1]))?;
        Some(Self { value: best[1], time_s: best[0] })
    }
}
