//! A run without inertia beside one with it: the error that the next cheaper choice would have
//! cost. It ends once it has taken more work than the run that it accompanies: a choice that is not
//! cheaper is none. A fall costs more without inertia than with it, and so do folds.

use super::{QUASI_STATIC_STEP_S, RunPeaks, advance};
use crate::math::larger;
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::simulation::Simulation;
use crate::solution::{ErrorEstimates, NeglectedEffect, NextCheaper};

/// Greatest number of iterations of a step on all nodes, and that by which the run without inertia
/// may be ahead of the run that it accompanies. Smaller: slow motions with hard steps have no
/// answer; larger: what is let go costs more to follow without inertia than with it.
const MAX_ITERATIONS: usize = 1000;

/// The run without inertia beside one that has it.
#[derive(Debug)]
pub(super) struct RunWithoutInertia {
    /// None once it has no answer.
    simulation: Option<Simulation>,
    model: Model,
    /// Number of steps of the run that make one of it, and those that the run has made.
    times: u64,
    count: u64,
    /// Work that it may still do, in all and in a step, in iterations times nodes.
    work_left: usize,
    max_work_of_step: usize,
    /// True if it was given up because it had taken more work than the run beside it.
    costs_more: bool,
    /// The most by which the two differed so far, and at rest: of their meshes, or of what friction
    /// allows.
    apart: ErrorEstimates,
    apart_at_rest: ErrorEstimates,
    /// Greatest tension of each cable so far, N.
    greatest_n: Vec<f64>,
}

/// The larger of the errors of forces, N.
fn larger_force(apart: &ErrorEstimates) -> Option<f64> {
    apart.max_tension_n.zip(apart.support_force_n).map(|(a, b)| larger(a, b))
}

/// The greatest tension of all cables so far, N.
fn greatest_tension_n(peaks: &[RunPeaks]) -> f64 {
    peaks.iter().map(|run| run.peaks.greatest.tension_n).fold(0.0, larger)
}

/// A force in parts of the greatest tension; the force itself where nothing pulls.
fn in_parts_of(force: f64, most: f64) -> f64 {
    if most > 0.0 { force / most } else { force }
}

impl RunWithoutInertia {
    /// The run as `auto` has it beside one that has settled at its start; None beside one without
    /// inertia and one that has begun.
    pub fn beside(run: &Simulation, inertia: Inertia, step_s: f64) -> Option<Self> {
        if inertia != Inertia::Dynamic || run.time_s() > 0.0 {
            return None;
        }
        let settings = Settings { histories: false, ..run.settings() };
        let question = Question::History(Inertia::QuasiStatic);
        let simulation = Simulation::for_question(run.scene().clone(), Model::Auto, settings, question);
        let simulation = simulation.ok().and_then(|mut simulation| simulation.settle().is_ok().then_some(simulation));
        let nodes: usize = run.answers().iter().map(|answer| answer.nodes.len()).sum();
        let max_work = MAX_ITERATIONS * nodes;
        // A cast takes what is too long for one step as one.
        let times = ((QUASI_STATIC_STEP_S / step_s).round() as u64).max(1);
        let model = simulation.as_ref().map_or(Model::Auto, Simulation::model);
        let none = ErrorEstimates::default().times(0.0);
        let apart =
            ErrorEstimates { max_tension_n: Some(0.0), support_force_n: Some(0.0), position_m: Some(0.0), ..none };
        let greatest_n = vec![0.0; run.answers().len()];
        let mut this = Self {
            simulation,
            model,
            times,
            count: 0,
            work_left: max_work,
            max_work_of_step: max_work,
            costs_more: false,
            apart,
            apart_at_rest: apart,
            greatest_n,
        };
        this.compare(run);
        this.apart_at_rest = this.apart;
        Some(this)
    }

    /// Goes on to the run it is beside, which has made one more step.
    pub fn follow(&mut self, run: &Simulation) {
        self.count += 1;
        self.work_left += run.work_of_step();
        if !self.count.is_multiple_of(self.times) {
            return;
        }
        let Some(mut own) = self.simulation.take() else { return };
        own.limit_work(self.work_left.min(self.max_work_of_step));
        let steps = advance(&mut own, run.time_s(), Inertia::QuasiStatic).is_ok();
        let left = self.work_left.checked_sub(own.work_of_step());
        // A step that fails with all that a step may take is none that more steps would have paid
        // for.
        self.costs_more = left.is_none() || !steps && self.work_left < self.max_work_of_step;
        self.work_left = left.unwrap_or(0);
        self.simulation = (steps && !self.costs_more).then_some(own);
        self.compare(run);
    }

    fn compare(&mut self, run: &Simulation) {
        let Some(own) = &self.simulation else { return };
        self.model = if own.model().rank() > self.model.rank() { own.model() } else { self.model };
        for (k, (a, b)) in own.answers().iter().zip(run.answers()).enumerate() {
            let now = ErrorEstimates::between(a, b);
            self.apart = self.apart.componentwise_max(&ErrorEstimates { contact_force_n: None, ..now });
            if let Some(greatest) = self.greatest_n.get_mut(k) {
                *greatest = larger(*greatest, a.peaks_at(own.time_s()).greatest.tension_n);
            }
        }
    }

    /// The most by which forces differed at rest, in parts of the greatest of such peaks.
    pub fn error_at_rest(&self, peaks: &[RunPeaks]) -> Option<f64> {
        larger_force(&self.apart_at_rest).map(|force| in_parts_of(force, greatest_tension_n(peaks)))
    }

    /// The most by which it has differed from a run with such peaks so far, beyond what it did at
    /// rest.
    pub fn next_cheaper(&self, peaks: &[RunPeaks]) -> NextCheaper {
        let most = greatest_tension_n(peaks);
        let runs = peaks.iter().map(|run| run.peaks.greatest.tension_n);
        let peaks = runs.zip(&self.greatest_n).map(|(a, b)| (a - b).abs()).fold(0.0, larger);
        let beyond = |now: Option<f64>, at_rest: Option<f64>| {
            let answered = self.simulation.is_some();
            now.zip(at_rest).filter(|_| answered).map(|(now, at_rest)| larger(now - at_rest, 0.0))
        };
        let forces =
            beyond(larger_force(&self.apart).map(|apart| larger(apart, peaks)), larger_force(&self.apart_at_rest));
        NextCheaper {
            model: self.model,
            neglects: NeglectedEffect::Inertia,
            force_error: forces.map(|force| in_parts_of(force, most)),
            position_error_m: beyond(self.apart.position_m, self.apart_at_rest.position_m),
            costs_more: self.costs_more,
        }
    }
}
