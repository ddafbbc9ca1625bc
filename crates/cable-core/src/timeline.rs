//! Steps of a run, and instants that are shown: two things.
//!
//! A run goes in even steps, whatever is looked at. An instant that is asked for between two of them is a step of a copy, which is then
//! discarded, so no look changes what happens: states at common instants are equal to the bit. Instants are whole ticks of a third of a
//! nanosecond: 1/240 s and 0.1 ms are both whole numbers of them, and no sum of steps rounds.

mod coarse;

use crate::error::SolveError;
use crate::math::larger;
use crate::model::Inertia;
use crate::simulation::Simulation;
use crate::solution::{MaxTension, Solution};

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

/// The greatest tension of a run so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// What it is, and where.
    pub top: MaxTension,
    /// When, s.
    pub time_s: f64,
    /// From what to what it may be, N; None where that is not known.
    pub range_n: Option<[f64; 2]>,
}

/// A simulation that goes in even steps and shows any instant.
pub struct Timeline {
    simulation: Simulation,
    inertia: Inertia,
    step: Instant,
    /// Steps made.
    count: u64,
    coarse: Option<CoarseRuns>,
    peak: Peak,
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
        let peak = Peak { top: simulation.max_tension(), time_s: simulation.time_s(), range_n: None };
        Self { simulation, inertia, step, count: 0, coarse: None, peak, worst_n: Some(0.0) }
    }

    /// The same, with errors in motion: coarser runs go beside it, for a third of its cost. Where there is none (no elements, or no
    /// inertia), nothing is added to what the model says.
    #[must_use]
    pub fn with_errors(mut self) -> Self {
        self.coarse = CoarseRuns::beside(&self.simulation, self.inertia, self.step);
        if let Some(coarse) = &self.coarse {
            self.simulation.tell_errors(coarse.errors());
        }
        self.note_peak();
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

    /// The greatest tension so far.
    #[must_use]
    pub fn peak(&self) -> Peak {
        self.peak
    }

    /// The greatest error so far of the greatest tension and of any support's force, in parts of the greatest tension of the run; None where one
    /// was not known.
    #[must_use]
    pub fn relative_error(&self) -> Option<f64> {
        let most = self.peak.top.tension_n;
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
            if let Some(coarse) = &self.coarse {
                self.simulation.tell_errors(coarse.errors());
            }
            self.note_peak();
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

    fn note_peak(&mut self) {
        for answer in self.simulation.answers() {
            let errors = answer.errors;
            let force = errors.max_tension_n.zip(errors.support_force_n).map(|(a, b)| larger(a, b));
            self.worst_n = self.worst_n.zip(force).map(|(a, b)| larger(a, b));
        }
        let top = self.simulation.max_tension();
        if top.tension_n > self.peak.top.tension_n || top.tension_n.is_nan() {
            (self.peak.top, self.peak.time_s) = (top, self.simulation.time_s());
        }
        self.peak.range_n = self.coarse.as_ref().map(CoarseRuns::range);
    }
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
