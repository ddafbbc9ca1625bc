//! Steps of a run, and instants that are shown: two things.
//!
//! A run goes in even steps, whatever is looked at. An instant that is asked for between two of them is a step of a copy, which is then
//! discarded, so no look changes what happens: states at common instants are equal to the bit. Instants are whole ticks of a third of a
//! nanosecond: 1/240 s and 0.1 ms are both whole numbers of them, and no sum of steps rounds.

mod coarse;

use crate::error::SolveError;
use crate::math::larger;
use crate::model::Inertia;
use crate::scene::Cable;
use crate::simulation::Simulation;
use crate::solution::{CableSolution, Solution, TensionPeaks, Warning, WarningKind};

use self::coarse::CoarseRuns;

/// Ticks in a second: the least common multiple of nanoseconds and of thirds of them, so that 1/60, 1/240 and 1/3840 s are whole.
const TICKS_PER_S: f64 = 3e9;

/// Step with inertia, s: the inner step of `fem`.
pub const STEP_S: f64 = 1.0 / 240.0;

/// Step without inertia, s: that of a display.
pub const QUASI_STATIC_STEP_S: f64 = 1.0 / 60.0;

/// An instant: a whole number of ticks after the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Instant(u64);

impl Instant {
    /// The instant nearest to a time (s); the start for what is not a time.
    #[must_use]
    pub fn nearest(time_s: f64) -> Self {
        // A cast takes what is no number or negative as 0.
        Self((time_s * TICKS_PER_S).round() as u64)
    }

    /// Its time, s.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0 as f64 / TICKS_PER_S
    }

    /// So many times as late.
    #[must_use]
    pub fn times(self, count: u64) -> Self {
        Self(self.0.saturating_mul(count))
    }
}

/// From what to what tensions of a cable may be, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TensionRanges {
    /// The greatest of any inner step.
    pub greatest_n: [f64; 2],
    /// The greatest mean over the cable's `breaking_time_s`.
    pub held_n: [f64; 2],
}

/// The greatest tensions of a cable in a run so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunPeaks {
    /// What they are, where and when.
    pub peaks: TensionPeaks,
    /// What is known of them; None where nothing is.
    pub ranges: Option<TensionRanges>,
}

/// A simulation that goes in even steps and shows any instant.
pub struct Timeline {
    simulation: Simulation,
    inertia: Inertia,
    step: Instant,
    /// Steps made.
    count: u64,
    coarse: Option<CoarseRuns>,
    /// One a cable.
    peaks: Vec<RunPeaks>,
    /// Greatest error of a force so far, N; None where one was not known.
    worst_n: Option<f64>,
}

impl Timeline {
    /// A run of a simulation that has settled at its start, in steps of `step_s` (s): [`STEP_S`] or [`QUASI_STATIC_STEP_S`] where that is
    /// None. A step is one tick at least.
    #[must_use]
    pub fn new(simulation: Simulation, inertia: Inertia, step_s: Option<f64>) -> Self {
        let usual_s = match inertia {
            Inertia::Dynamic => STEP_S,
            Inertia::QuasiStatic => QUASI_STATIC_STEP_S,
        };
        let step = Instant::nearest(step_s.unwrap_or(usual_s)).max(Instant(1));
        let at_rest = |answer: &CableSolution| RunPeaks { peaks: answer.peaks_at(simulation.time_s()), ranges: None };
        let peaks = simulation.answers().iter().map(at_rest).collect();
        Self { simulation, inertia, step, count: 0, coarse: None, peaks, worst_n: Some(0.0) }
    }

    /// The same, with errors in motion: coarser runs go beside it, for a third of its cost. Where there is none (no elements, or no
    /// inertia), nothing is added to what the model says.
    #[must_use]
    pub fn with_errors(mut self) -> Self {
        self.coarse = CoarseRuns::beside(&self.simulation, self.inertia, self.step);
        self.note();
        self
    }

    /// The simulation at the last step made.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Its step, s.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step.seconds()
    }

    /// The greatest tensions so far, one a cable.
    #[must_use]
    pub fn peaks(&self) -> &[RunPeaks] {
        &self.peaks
    }

    /// The greatest error so far of the greatest tension and of any support's force, in parts of the greatest tension of the run; None where one
    /// was not known.
    #[must_use]
    pub fn relative_error(&self) -> Option<f64> {
        let most = self.peaks.iter().map(|run| run.peaks.greatest.tension_n).fold(0.0, larger);
        self.worst_n.map(|worst| if most > 0.0 { worst / most } else { worst })
    }

    /// Makes all steps up to an instant, `watch` looking at each, and returns the answer at the instant itself. An instant before the last
    /// step made is answered at that step.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn at(&mut self, instant: Instant, mut watch: impl FnMut(&Simulation)) -> Result<Solution, SolveError> {
        while self.step.times(self.count + 1) <= instant {
            let next = self.step.times(self.count + 1);
            advance(&mut self.simulation, next, self.inertia)?;
            self.count += 1;
            self.coarse = self.coarse.take().and_then(|coarse| coarse.follow(&self.simulation, (next, self.count)));
            self.note();
            watch(&self.simulation);
        }
        let mut solution = if self.step.times(self.count) < instant {
            let mut copy = self.simulation.clone();
            advance(&mut copy, instant, self.inertia)?;
            if let Some(coarse) = &self.coarse {
                copy.tell_errors(coarse.errors());
            }
            copy.solution()
        } else {
            self.simulation.solution()
        };
        // Adding steps up rounds; the instant asked for is the one meant.
        solution.time_s = instant.max(self.step.times(self.count)).seconds();
        Ok(solution)
    }

    /// Notes what the last step adds to what is known, and says it.
    fn note(&mut self) {
        if let Some(coarse) = &self.coarse {
            self.simulation.tell_errors(coarse.errors());
        }
        let mut warnings = Vec::new();
        let cables = self.simulation.scene().cables.iter().zip(self.simulation.answers());
        for (k, (run, (cable, answer))) in self.peaks.iter_mut().zip(cables).enumerate() {
            run.peaks = run.peaks.with(answer.peaks_at(self.simulation.time_s()));
            run.ranges = self.coarse.as_ref().map(|coarse| coarse.ranges(k));
            warnings.extend(may_break(cable, answer, run));
            let force = answer.errors.max_tension_n.zip(answer.errors.support_force_n).map(|(a, b)| larger(a, b));
            self.worst_n = self.worst_n.zip(force).map(|(a, b)| larger(a, b));
        }
        self.simulation.tell(warnings);
    }
}

/// Whether a cable breaks where what is known of its tensions leaves that open.
fn may_break(cable: &Cable, answer: &CableSolution, run: &RunPeaks) -> Option<Warning> {
    let ([from, to], breaking_n) = (run.ranges?.held_n, cable.breaking_tension_n);
    let (broke, held, over_s) = (!answer.breaks.is_empty(), run.peaks.held, run.peaks.over_s);
    let open = if broke { from < breaking_n } else { to >= breaking_n };
    let does = if broke { "broke here, and may hold" } else { "held here, and may break" };
    let message = format!(
        "`{}` {does}: its greatest mean tension over {over_s} s is {:.0} N, {from:.0} to {to:.0} N as coarser runs differ from it, and it breaks at {breaking_n} N: pull less, or more slowly",
        cable.name, held.tension_n
    );
    let warning = Warning::new(WarningKind::MayBreak, &cable.name, held.arc_length_m, [to, breaking_n], message);
    open.then_some(warning)
}

/// One step to an instant.
fn advance(simulation: &mut Simulation, to: Instant, inertia: Inertia) -> Result<(), SolveError> {
    let dt_s = to.seconds() - simulation.time_s();
    match inertia {
        Inertia::Dynamic => simulation.step(dt_s),
        Inertia::QuasiStatic => simulation.step_quasi_static(dt_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_milliseconds_are_whole_ticks() {
        for parts in [60u64, 240, 960, 3840, 1000, 1_000_000] {
            assert_eq!(Instant::nearest(1.0 / parts as f64).times(parts), Instant::nearest(1.0), "1/{parts} s");
        }
        assert_eq!(Instant::nearest(f64::NAN), Instant::default());
        assert_eq!(Instant::nearest(-1.0), Instant::default());
        assert!((Instant::nearest(0.016_666_66).seconds() - 0.016_666_66).abs() < 1e-9);
    }
}
