//! A run without inertia beside one with it: the error that the next cheaper choice would have
//! cost. It ends where a step takes too many iterations: a fall costs more without inertia than
//! with it.

use super::{QUASI_STATIC_STEP_S, RunPeaks, advance};
use crate::math::larger;
use crate::model::auto::Question;
use crate::model::{Inertia, Model, Settings};
use crate::simulation::Simulation;
use crate::solution::{ErrorEstimates, NeglectedEffect, NextCheaper};

/// Greatest number of iterations of a step on all nodes. Smaller: slow motions with hard steps have
/// no answer; larger: what is let go costs more to follow without inertia than with it.
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
        let mut simulation =
            simulation.ok().and_then(|mut simulation| simulation.settle().is_ok().then_some(simulation));
        if let Some(simulation) = &mut simulation {
            let nodes = simulation.answers().iter().map(|answer| answer.nodes.len()).max();
            simulation.limit_work(MAX_ITERATIONS * nodes.unwrap_or(1));
        }
        // A cast takes what is too long for one step as one.
        let times = ((QUASI_STATIC_STEP_S / step_s).round() as u64).max(1);
        let model = simulation.as_ref().map_or(Model::Auto, Simulation::model);
        let none = ErrorEstimates::default().times(0.0);
        let apart =
            ErrorEstimates { max_tension_n: Some(0.0), support_force_n: Some(0.0), position_m: Some(0.0), ..none };
        let greatest_n = vec![0.0; run.answers().len()];
        let mut this = Self { simulation, model, times, count: 0, apart, apart_at_rest: apart, greatest_n };
        this.compare(run);
        this.apart_at_rest = this.apart;
        Some(this)
    }

    /// Goes on to the run it is beside, which has made one more step.
    pub fn follow(&mut self, run: &Simulation) {
        self.count += 1;
        if self.simulation.is_none() || !self.count.is_multiple_of(self.times) {
            return;
        }
        if self.simulation.as_mut().is_none_or(|own| advance(own, run.time_s(), Inertia::QuasiStatic).is_err()) {
            self.simulation = None;
        }
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

    /// The most by which it has differed from a run with such peaks so far, beyond what it did at
    /// rest.
    pub fn next_cheaper(&self, peaks: &[RunPeaks]) -> NextCheaper {
        let runs = peaks.iter().map(|run| run.peaks.greatest.tension_n);
        let most = runs.clone().fold(0.0, larger);
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
            force_error: forces.map(|force| if most > 0.0 { force / most } else { force }),
            position_error_m: beyond(self.apart.position_m, self.apart_at_rest.position_m),
        }
    }
}
