//! The monitor knows a run so far: its greatest tensions and, from coarser runs beside it, the
//! errors of its figures.

use super::coarser_runs::CoarseRuns;
use super::run_without_inertia::RunWithoutInertia;
use super::{RunPeaks, TensionRanges};
use crate::math::larger;
use crate::model::Inertia;
use crate::scene::Cable;
use crate::simulation::Simulation;
use crate::solution::{CableSolution, MotionNumbers, NextCheaper, Warning, WarningCause};

/// Looks at each step of a run, and remembers.
#[derive(Debug)]
pub struct RunMonitor {
    coarse: Option<CoarseRuns>,
    without_inertia: Option<RunWithoutInertia>,
    /// One a cable.
    peaks: Vec<RunPeaks>,
    /// Greatest error of a force so far, N; `None` if one of the errors was not known.
    worst_n: Option<f64>,
    motion_numbers: MotionNumbers,
}

impl RunMonitor {
    /// Returns the monitor of a run that begins with the present state of a simulation.
    #[must_use]
    pub fn new(simulation: &Simulation) -> Self {
        let so_far = |answer: &CableSolution| RunPeaks { peaks: answer.peaks_at(simulation.time_s()), ranges: None };
        let peaks = simulation.answers().iter().map(so_far).collect();
        Self {
            coarse: None,
            without_inertia: None,
            peaks,
            worst_n: Some(0.0),
            motion_numbers: MotionNumbers::default().with(simulation),
        }
    }

    /// The same, with errors in motion: coarser runs go beside one that has settled at its start,
    /// of a third of its work. Where there is none (no elements, or no inertia), nothing is added
    /// to what the model says.
    #[must_use]
    pub fn with_errors(simulation: &mut Simulation, inertia: Inertia) -> Self {
        let coarse = CoarseRuns::beside(simulation, inertia);
        let mut monitor = Self { coarse, ..Self::new(simulation) };
        monitor.note(simulation);
        monitor.tell(simulation);
        monitor
    }

    /// Does to the coarser runs what was done to the run: drags ends, commands the robot.
    pub fn steer(&mut self, how: impl FnMut(&mut Simulation)) {
        if let Some(coarse) = &mut self.coarse {
            coarse.steer(how);
        }
    }

    /// Looks at a run that has made one more step, and has it say what is known.
    pub fn follow(&mut self, simulation: &mut Simulation) {
        self.look(simulation);
        self.tell(simulation);
    }

    /// Looks at a run that has made one more step, whose answer need not be judged yet.
    pub(super) fn look(&mut self, simulation: &Simulation) {
        self.coarse = self.coarse.take().and_then(|coarse| coarse.follow(simulation));
        if let Some(run) = &mut self.without_inertia {
            run.follow(simulation);
        }
        self.note(simulation);
    }

    /// The greatest tensions so far, one a cable.
    #[must_use]
    pub fn peaks(&self) -> &[RunPeaks] {
        &self.peaks
    }

    /// The greatest error so far of the greatest tension and of any support's force, in parts of
    /// the greatest tension of the run; None where one was not known.
    #[must_use]
    pub fn relative_error(&self) -> Option<f64> {
        let most = self.peaks.iter().map(|run| run.peaks.greatest.tension_n).fold(0.0, larger);
        self.worst_n.map(|worst| if most > 0.0 { worst / most } else { worst })
    }

    /// Puts a run without inertia beside one that has it, in steps of `step_s` (s), and has settled
    /// at its start.
    pub(super) fn add_run_without_inertia(&mut self, simulation: &Simulation, inertia: Inertia, step_s: f64) {
        self.without_inertia = RunWithoutInertia::beside(simulation, inertia, step_s);
    }

    /// The error that the next cheaper choice, a run without inertia, would have had so far; None
    /// where none goes beside the run.
    #[must_use]
    pub fn next_cheaper(&self) -> Option<NextCheaper> {
        self.without_inertia.as_ref().map(|run| run.next_cheaper(&self.peaks))
    }

    /// The error of a run without inertia at rest, in parts of the greatest tension so far; None
    /// where none goes beside the run.
    pub(super) fn error_without_inertia_at_rest(&self) -> Option<f64> {
        self.without_inertia.as_ref().and_then(|run| run.error_at_rest(&self.peaks))
    }

    /// The Mach and Froude numbers of the run so far.
    #[must_use]
    pub fn motion_numbers(&self) -> MotionNumbers {
        self.motion_numbers
    }

    /// Has a simulation say the errors that are known now.
    pub(super) fn set_error_estimates(&self, simulation: &mut Simulation) {
        if let Some(coarse) = &self.coarse {
            simulation.set_error_estimates(coarse.errors());
        }
    }

    /// Notes what the last step adds to what is known.
    fn note(&mut self, simulation: &Simulation) {
        self.motion_numbers = self.motion_numbers.with(simulation);
        let mut known = self.coarse.as_ref().map(CoarseRuns::errors);
        let are_known = self.coarse.as_ref().is_none_or(CoarseRuns::know_errors);
        for (k, (run, answer)) in self.peaks.iter_mut().zip(simulation.answers()).enumerate() {
            run.peaks = run.peaks.with(answer.peaks_at(simulation.time_s()));
            run.ranges = self.coarse.as_ref().map(|coarse| coarse.ranges(k));
            let errors = known.as_mut().and_then(Iterator::next).unwrap_or(answer.errors);
            let force = errors.max_tension_n.zip(errors.support_force_n).map(|(a, b)| larger(a, b));
            if are_known {
                self.worst_n = self.worst_n.zip(force).map(|(a, b)| larger(a, b));
            }
        }
    }

    /// Has a run say what is known of it.
    pub(super) fn tell(&self, simulation: &mut Simulation) {
        self.set_error_estimates(simulation);
        let cables = simulation.scene().cables.iter().zip(simulation.answers());
        let warnings = cables.zip(&self.peaks).filter_map(|((cable, answer), run)| may_break(cable, answer, run));
        let warnings = warnings.collect();
        simulation.set_break_warnings(warnings);
    }
}

/// True if a cable breaks, or if what is known of its tensions leaves that open.
fn may_break(cable: &Cable, answer: &CableSolution, run: &RunPeaks) -> Option<Warning> {
    let (TensionRanges { held_n: [from, to], .. }, breaking_n) = (run.ranges?, cable.breaking_tension_n);
    let (broke, held, over_s) = (!answer.breaks.is_empty(), run.peaks.held, run.peaks.over_s);
    let open = if broke { from < breaking_n } else { to >= breaking_n };
    let cause = WarningCause::BreakageUncertain { broke, held_n: held.tension_n, lowest_n: from, over_s };
    open.then(|| Warning::new(cause, &cable.name, held.arc_length_m, [to, breaking_n]))
}
