//! A timeline separates the steps of a run from the instants that are shown.
//!
//! A run goes in even steps, whatever is looked at. An instant that is asked for between two of
//! them is a step of a copy, which is then discarded, so no look changes what happens: states at
//! common instants are equal to the bit. Instants are whole ticks of a third of a nanosecond: 1/240
//! s and 0.1 ms are both whole numbers of them, and no sum of steps rounds.
//!
//! | room | content |
//! |---|---|
//! | `run_monitor.rs` | the greatest tensions of a run so far and the errors of its figures |
//! | `run_peaks.rs` | ranges of the greatest tensions, and whether mesh and step resolve them |
//! | `coarser_runs.rs` | coarser runs beside a run, from which its errors are estimated |
//! | `run_without_inertia.rs` | a run without inertia beside one with it |
//! | `motion_numbers.rs` | Mach and Froude numbers of a run |
//! | `refinement.rs` | a run that is made anew until its errors are as asked |

mod coarser_runs;
mod motion_numbers;
mod refinement;
mod run_monitor;
mod run_peaks;
mod run_without_inertia;

pub use self::refinement::{Refinement, refine_until_accurate};
pub use self::run_monitor::RunMonitor;
pub use self::run_peaks::{RunPeaks, TensionRanges};

use crate::error::SolveError;
use crate::model::Inertia;
use crate::simulation::{STEP_S, Simulation};
use crate::solution::{InertiaEffect, Solution};

/// Ticks in a second: the least common multiple of nanoseconds and of thirds of them, so that 1/60,
/// 1/240 and 1/3840 s are whole.
const TICKS_PER_S: f64 = 3e9;

/// Step without inertia, s: that of a display.
const QUASI_STATIC_STEP_S: f64 = 1.0 / 60.0;

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

    /// So much later.
    #[must_use]
    pub fn after(self, passed: Self) -> Self {
        Self(self.0.saturating_add(passed.0))
    }

    /// So many times as late.
    #[must_use]
    pub fn times(self, count: u64) -> Self {
        Self(self.0.saturating_mul(count))
    }
}

/// The step of a run where none is given.
#[must_use]
pub fn usual_step(inertia: Inertia) -> Instant {
    Instant::nearest(match inertia {
        Inertia::Dynamic => STEP_S,
        Inertia::QuasiStatic => QUASI_STATIC_STEP_S,
    })
}

/// The time that is to pass in a run which goes in whole steps alone: a display adds what it wants
/// to see pass, and takes the steps that this makes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TimeDebt(Instant);

impl TimeDebt {
    /// Has so much time (s) pass as well.
    pub fn add(&mut self, time_s: f64) {
        self.0 = self.0.after(Instant::nearest(time_s));
    }

    /// Takes out the whole steps that are due, and returns how many these are.
    pub fn take_steps(&mut self, step: Instant) -> u64 {
        let steps = self.0.0 / step.0.max(1);
        self.0.0 -= steps * step.0;
        steps
    }

    /// The time left, s: less than a step.
    #[must_use]
    pub fn seconds(self) -> f64 {
        self.0.seconds()
    }
}

/// Makes whole [usual](usual_step) steps from where a run is, and reads its answer after the last
/// of them: states are those of [`Timeline`] to the bit; peaks, warnings and the account of
/// momentum are of all these steps. The monitor follows each.
///
/// # Errors
/// As [`Simulation::step`].
pub fn make_steps(
    simulation: &mut Simulation,
    inertia: Inertia,
    count: u64,
    mut monitor: Option<&mut RunMonitor>,
) -> Result<(), SolveError> {
    // Steps are counted in ticks, so that no sum of them rounds.
    let dt_s = |time_s: f64| Instant::nearest(time_s).after(usual_step(inertia)).seconds() - time_s;
    let mut look = |run: &Simulation| {
        if let Some(monitor) = &mut monitor {
            monitor.look(run);
        }
    };
    match inertia {
        Inertia::Dynamic => simulation.advance_steps(count, dt_s, look)?,
        // Each answer is judged: one that breaks a law is sought again by another model.
        Inertia::QuasiStatic => {
            for _ in 0..count {
                simulation.step_quasi_static(dt_s(simulation.time_s()))?;
                look(simulation);
            }
        }
    }
    if let Some(monitor) = monitor {
        monitor.tell(simulation);
    }
    Ok(())
}

/// The answer so much later (s) than the last step of a run, by a step of a copy.
///
/// Nothing breaks between steps, and peaks and warnings are those of the last step: what a run says
/// of them does not depend on what is looked at.
///
/// # Errors
/// As [`Simulation::step`].
pub fn answer_between_steps(
    simulation: &Simulation,
    inertia: Inertia,
    later_s: f64,
    monitor: Option<&RunMonitor>,
) -> Result<Solution, SolveError> {
    let mut copy = simulation.clone();
    copy.prevent_breaks();
    match inertia {
        Inertia::Dynamic => copy.step(later_s)?,
        Inertia::QuasiStatic => copy.step_quasi_static(later_s)?,
    }
    if let Some(monitor) = monitor {
        monitor.set_error_estimates(&mut copy);
    }
    let (mut answer, last) = (copy.solution(), simulation.solution());
    answer.warnings = last.warnings;
    for (cable, last) in answer.cables.iter_mut().zip(&last.cables) {
        cable.peaks = last.peaks;
    }
    Ok(answer)
}

/// A simulation that goes in even steps and shows any instant.
pub struct Timeline {
    simulation: Simulation,
    inertia: Inertia,
    step: Instant,
    /// Steps made.
    count: u64,
    monitor: RunMonitor,
}

impl std::fmt::Debug for Timeline {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Timeline")
            .field("inertia", &self.inertia)
            .field("step", &self.step)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

impl Timeline {
    /// A run of a simulation that has settled at its start, in steps of `step_s` (s): 1/240 s or
    /// 1/60 s where that is None.
    ///
    /// # Errors
    /// [`SolveError::TimeStep`]: a step that is not positive, is no number, or is longer than
    /// [`Simulation`] makes at once.
    pub fn new(simulation: Simulation, inertia: Inertia, step_s: Option<f64>) -> Result<Self, SolveError> {
        // Less than half a tick is no step either.
        let given = step_s.map(|s| Simulation::check_step(s, inertia).map(|()| Instant::nearest(s).max(Instant(1))));
        let step = given.transpose()?.unwrap_or_else(|| usual_step(inertia));
        let monitor = RunMonitor::new(&simulation);
        Ok(Self { simulation, inertia, step, count: 0, monitor })
    }

    /// The same, with errors in motion: coarser runs go beside it, of a third of its work. Where
    /// there is none (no elements, or no inertia), nothing is added to what the model says.
    #[must_use]
    pub fn with_errors(mut self) -> Self {
        self.monitor = RunMonitor::with_errors(&mut self.simulation, self.inertia);
        self
    }

    /// The same, with a run without inertia beside it, as `auto` has it: answers say what that next
    /// cheaper choice would have cost in error so far. Beside one without inertia there is none.
    #[must_use]
    pub fn with_next_cheaper(mut self) -> Self {
        self.monitor.add_run_without_inertia(&self.simulation, self.inertia, self.step_s());
        self
    }

    /// The Mach and Froude numbers of the motion so far, and what it would be without inertia; None
    /// of a run that has none.
    #[must_use]
    pub fn inertia_effect(&self) -> Option<InertiaEffect> {
        (self.inertia == Inertia::Dynamic).then(|| InertiaEffect {
            numbers: self.monitor.motion_numbers(),
            without: self.monitor.next_cheaper(),
            error_at_rest: self.monitor.error_without_inertia_at_rest(),
            tolerance: self.simulation.settings().tolerance,
        })
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

    /// The peaks of the run so far and their ranges.
    #[must_use]
    pub fn monitor(&self) -> &RunMonitor {
        &self.monitor
    }

    /// Makes all steps up to an instant, `watch` looking at each, and returns the answer at the
    /// instant itself. An instant before the last step made is answered at that step.
    ///
    /// # Errors
    /// As [`Simulation::step`].
    pub fn at(&mut self, instant: Instant, mut watch: impl FnMut(&Simulation)) -> Result<Solution, SolveError> {
        while self.step.times(self.count + 1) <= instant {
            let next = self.step.times(self.count + 1);
            advance(&mut self.simulation, next.seconds(), self.inertia)?;
            self.count += 1;
            self.monitor.follow(&mut self.simulation);
            watch(&self.simulation);
        }
        let mut solution = if self.step.times(self.count) < instant {
            let later_s = instant.seconds() - self.simulation.time_s();
            answer_between_steps(&self.simulation, self.inertia, later_s, Some(&self.monitor))?
        } else {
            self.simulation.solution()
        };
        solution.next_cheaper = self.monitor.next_cheaper().or(solution.next_cheaper);
        // Adding steps up rounds; the instant asked for is the one meant.
        solution.time_s = instant.max(self.step.times(self.count)).seconds();
        Ok(solution)
    }
}

/// One step to a time (s).
fn advance(simulation: &mut Simulation, to_s: f64, inertia: Inertia) -> Result<(), SolveError> {
    let dt_s = to_s - simulation.time_s();
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
