//! Coarser runs beside a run estimate its errors: the same scene on elements twice and three times
//! as long, in steps twice and three times as long.
//!
//! Bars are of the second order where the cable is free and of the first where it meets things,
//! steps likewise: what two runs differ by, of which one is twice as fine, is at least what the
//! finer one lacks then (L. F. Richardson and J. A. Gaunt, *The deferred approach to the limit*,
//! Phil. Trans. R. Soc. A 226, 1927, without the extrapolation). Where a cable is thrown about the
//! three go different ways, and so would a finer one: what is known is then only what they have in
//! common. They cost a quarter and a ninth of the run.

use super::TensionRanges;
use crate::math::{larger, smaller};
use crate::model::Inertia;
use crate::simulation::Simulation;
use crate::solution::ErrorEstimates;

/// Factors by which elements and steps are longer.
const COARSENING: [u64; 2] = [2, 3];
/// Steps after which all runs are at one instant.
const COMMON_STEPS: u64 = 6;
/// Part of a time by which a sum of steps may be short of it.
const TENSION_ROUNDING: f64 = 1e-9;

/// A difference is forgotten within these times, s, or [`COMMON_STEPS`] if they take longer; the
/// geometric mean of what both remember counts. With one time it is 0.25 s, and where 95 figures in
/// 100 are covered 78 instead of 80 are within ten times the error. Shorter: errors vanish wherever
/// two runs cross; longer: what once struck is uncertain long after it lies still.
const DECAY_TIMES_S: [f64; 2] = [0.1, 0.4];

/// Greatest tensions are compared of one to two times so much time, s: a jerk comes later in one
/// run than in another. Less: jerks of two runs are apart; more: one that all runs have hides
/// another that they do not agree on.
const WINDOW_S: f64 = 0.05;
/// A finer run may differ from the finest of three by so many times what that one differs by from
/// the others. Of 142 random motions (`motion_errors.rs`, seeds 300 to 323) 95 figures in 100 are
/// covered and 80 are between half and ten times the error; with 2 they are 91 and 84, with 4 they
/// are 97 and 71.
const ERROR_FACTOR: f64 = 3.0;
/// The runs count as converging if the difference between the finest and the second run is at most
/// this fraction of that between the finest and the third; then the first difference alone gives
/// the error. Steps of the second order have 0.375. With a smaller value, the errors of free swings
/// are estimated up to 20 times too high; with a larger value, fewer figures are covered.
const CONVERGENCE_RATIO: f64 = 0.6;
/// The logarithm of the greatest tension of a window may be so many times as far down and up on
/// finer meshes as it is apart in the three runs. With [2, 2] 9 in 100 runs on four times as many
/// elements are outside of ranges that call themselves resolved, with these 4.
const PEAK_FACTORS: [f64; 2] = [3.0, 2.5];
/// It is no further down and up than this where they are far apart, half as much and 3.7 times: the
/// whip of a flexible cable grows with the mesh. With [0.6, 1.1] the greatest tensions of 6 in 100
/// runs are outside, and means of 8; with these of 5, with [0.8, 1.5] no fewer.
const UNRESOLVED_FACTORS: [f64; 2] = [0.7, 1.3];
/// Tensions below this part of the greatest so far are none.
const MIN_TENSION_FRACTION: f64 = 1e-9;

/// The coarse runs beside a fine one.
#[derive(Debug)]
pub(super) struct CoarseRuns {
    runs: Vec<CoarseRun>,
    inertia: Inertia,
    /// Steps that the fine run has made.
    count: u64,
    /// The time when the present window began, s.
    window_began_s: f64,
    own: Vec<RecentPeaks>,
    /// Ranges of the windows before, a cable.
    before: Vec<TensionRanges>,
}

/// Greatest tensions and means of one cable, N, in the window before and in the present one.
#[derive(Clone, Copy, Debug)]
struct RecentPeaks([[f64; 2]; 2]);

impl RecentPeaks {
    fn begin(max_tensions: [f64; 2]) -> Self {
        Self([max_tensions; 2])
    }

    fn note(&mut self, max_tensions: [f64; 2]) {
        self.0[1] = [larger(self.0[1][0], max_tensions[0]), larger(self.0[1][1], max_tensions[1])];
    }

    fn turn(&mut self, max_tensions: [f64; 2]) {
        self.0 = [self.0[1], max_tensions];
    }

    /// The greatest tension (0) or mean (1).
    fn greatest(&self, which: usize) -> f64 {
        larger(self.0[0][which], self.0[1][which])
    }
}

#[derive(Debug)]
struct CoarseRun {
    simulation: Simulation,
    /// Number of steps of the fine run that make one of it.
    times: u64,
    /// Time between comparisons of all runs by its last step, s; 0 before.
    common_s: f64,
    /// Difference of each cable from the fine run, as each of [`DECAY_TIMES_S`] remembers it.
    differences: Vec<[ErrorEstimates; 2]>,
    recent: Vec<RecentPeaks>,
}

impl CoarseRuns {
    /// Coarse runs beside one that has settled; None where it has no elements, or too few, or a
    /// coarse one does not come to rest.
    pub fn beside(fine: &Simulation, inertia: Inertia) -> Option<Self> {
        // Without inertia models say their errors by themselves.
        if inertia != Inertia::Dynamic {
            return None;
        }
        let mut runs = Vec::with_capacity(COARSENING.len());
        for times in COARSENING {
            let mut simulation = fine.resolved(1.0 / times as f64).ok().flatten()?;
            simulation.settle().ok()?;
            let cables = fine.answers().iter().zip(simulation.answers());
            let differences = cables.map(|(a, b)| [ErrorEstimates::between(b, a); 2]).collect();
            let recent = max_tensions(&simulation).map(RecentPeaks::begin).collect();
            runs.push(CoarseRun { simulation, times, common_s: 0.0, differences, recent });
        }
        let own: Vec<RecentPeaks> = max_tensions(fine).map(RecentPeaks::begin).collect();
        let before = vec![TensionRanges::default(); own.len()];
        Some(Self { runs, inertia, count: 0, window_began_s: fine.time_s(), own, before })
    }

    /// Each coarser run gets the same treatment as the run that it accompanies.
    pub fn steer(&mut self, mut how: impl FnMut(&mut Simulation)) {
        self.runs.iter_mut().for_each(|run| how(&mut run.simulation));
    }

    /// Advances the coarser runs to the time of the run that they accompany, which has made one
    /// more step; `None` if one of them fails.
    pub fn follow(mut self, fine: &Simulation) -> Option<Self> {
        self.count += 1;
        self.own.iter_mut().zip(max_tensions(fine)).for_each(|(own, max_tensions)| own.note(max_tensions));
        for run in self.runs.iter_mut().filter(|run| self.count.is_multiple_of(run.times)) {
            run.follow(fine, self.inertia)?;
        }
        // Sums of steps round.
        if self.count.is_multiple_of(COMMON_STEPS)
            && fine.time_s() - self.window_began_s >= WINDOW_S * (1.0 - TENSION_ROUNDING)
        {
            self.window_began_s = fine.time_s();
            self.before = (0..self.own.len()).map(|cable| self.ranges(cable)).collect();
            self.own.iter_mut().zip(max_tensions(fine)).for_each(|(own, max_tensions)| own.turn(max_tensions));
            for run in &mut self.runs {
                run.recent
                    .iter_mut()
                    .zip(max_tensions(&run.simulation))
                    .for_each(|(own, max_tensions)| own.turn(max_tensions));
            }
        }
        Some(self)
    }

    /// From what to what the greatest tensions of a cable in the run so far may be.
    pub fn ranges(&self, cable: usize) -> TensionRanges {
        let before = self.before.get(cable).copied().unwrap_or_default();
        TensionRanges {
            greatest_n: self.range(cable, 0, before.greatest_n),
            held_n: self.range(cable, 1, before.held_n),
        }
    }

    fn range(&self, cable: usize, which: usize, before: [f64; 2]) -> [f64; 2] {
        let of = |all: &[RecentPeaks]| all.get(cable).map_or(0.0, |recent| recent.greatest(which));
        let none = MIN_TENSION_FRACTION * larger(of(&self.own), before[1]);
        let own = larger(of(&self.own), none);
        let others = self.runs.iter().map(|run| larger(of(&run.recent), none));
        let (least, most) =
            others.fold((own, own), |(least, most), n| (if n < least { n } else { least }, larger(most, n)));
        // Of a cable that no run pulls nothing is apart.
        let apart = if own > 0.0 { larger((own / least).ln(), (most / own).ln()) } else { 0.0 };
        // Convergence of the runs is not enough: with that alone the greatest tensions of 6 in 100
        // runs more are outside.
        let [down, up] = [0, 1].map(|j| smaller(PEAK_FACTORS[j] * apart, UNRESOLVED_FACTORS[j]));
        let here = [own * (-down).exp(), own * up.exp()];
        [larger(before[0], here[0]), larger(before[1], here[1])]
    }

    /// True if each run has made a step, or none has: before, differences are still those of the
    /// start.
    pub fn know_errors(&self) -> bool {
        self.count == 0 || self.count >= COMMON_STEPS
    }

    /// Error estimates of each cable; they say nothing while they are [not
    /// known](Self::know_errors).
    pub fn errors(&self) -> impl Iterator<Item = ErrorEstimates> {
        let known = self.know_errors();
        let cables = self.runs.first().map_or(0, |run| run.differences.len());
        (0..cables).map(move |k| {
            let remembered = |run: &CoarseRun| {
                let [short, long] = run.differences.get(k)?;
                Some(short.with(long, |short, long| (short * long).sqrt()))
            };
            let differences = self.runs.iter().filter_map(remembered);
            // Differences of few instants may be small because runs cross there: that runs converge
            // is not seen by them.
            let seldom = self.runs.iter().any(|run| run.common_s > DECAY_TIMES_S[1]);
            let bound = if seldom { error_bound_of_any } else { error_bound };
            let bounds = differences.reduce(|finer, coarser| finer.with(&coarser, bound));
            bounds.filter(|_| known).unwrap_or_default()
        })
    }
}

/// Greatest tension and mean of each cable in the last step, N.
fn max_tensions(simulation: &Simulation) -> impl Iterator<Item = [f64; 2]> {
    let peaks = simulation.answers().iter().map(|answer| answer.peaks_at(simulation.time_s()));
    peaks.map(|p| [p.greatest.tension_n, p.held.tension_n])
}

/// By how much a finer run may differ from one that differs by so much from a coarser one, and from
/// a still coarser one.
fn error_bound(finer: f64, coarser: f64) -> f64 {
    match finer <= CONVERGENCE_RATIO * coarser {
        true => ERROR_FACTOR * finer,
        false => error_bound_of_any(finer, coarser),
    }
}

/// The same, of runs that may not converge.
fn error_bound_of_any(finer: f64, coarser: f64) -> f64 {
    ERROR_FACTOR * larger(finer, coarser)
}

impl CoarseRun {
    fn follow(&mut self, fine: &Simulation, inertia: Inertia) -> Option<()> {
        let before_s = self.simulation.time_s();
        // Nobody reads its warnings.
        self.simulation.advance_unjudged(fine.time_s() - before_s, inertia).ok()?;
        self.recent
            .iter_mut()
            .zip(max_tensions(&self.simulation))
            .for_each(|(own, max_tensions)| own.note(max_tensions));
        let step_s = fine.time_s() - before_s;
        // A memory shorter than the time between comparisons of all runs would hold but the last
        // difference, which vanishes where two runs cross.
        self.common_s = step_s * COMMON_STEPS as f64 / self.times as f64;
        let remainder = DECAY_TIMES_S.map(|memory_s| (-step_s / larger(memory_s, self.common_s)).exp());
        let cables = fine.answers().iter().zip(self.simulation.answers());
        for (remembered, (a, b)) in self.differences.iter_mut().zip(cables) {
            let now = ErrorEstimates::between(b, a);
            for (difference, remainder) in remembered.iter_mut().zip(remainder) {
                *difference = now.componentwise_max(&difference.times(remainder));
            }
        }
        Some(())
    }
}
