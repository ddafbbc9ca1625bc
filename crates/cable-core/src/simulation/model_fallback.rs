//! An answer that breaks a law of statics is refused. Where the user left the choice of the model,
//! the next more general one is asked for another, and where the number of segments is open, a
//! finer mesh.

use super::{RunPhase, Simulation};
use crate::error::SolveError;
use crate::model::auto;
use crate::model::{Model, ModelSource};
use crate::simulated_cable::SimulatedCable;
use crate::solution::ModelReason;

impl Simulation {
    /// Settles by one model after the other until the answer obeys every law.
    pub(super) fn settle_until_verified(&mut self) -> Result<(), SolveError> {
        let mut first: Option<SolveError> = None;
        loop {
            let found = self.for_each_cable(SimulatedCable::settle).and_then(|()| {
                self.refresh(RunPhase::AtRest);
                self.verify_answers()
            });
            let Err(error) = found else { return Ok(()) };
            let error = match self.cables.iter().find_map(SimulatedCable::refusal) {
                Some(refusal) if matches!(error, SolveError::Unsound { .. }) => {
                    SolveError::clearer(refusal.clone(), error)
                }
                _ => error,
            };
            // A cable that is said to have no resting place is not asked of another model.
            let last = matches!(error, SolveError::NoRestingPlace { .. } | SolveError::Unsupported { .. });
            let next = !last && self.switch_model(&error);
            first = Some(match first {
                Some(before) => SolveError::clearer(before, error),
                None => error,
            });
            if !next {
                return first.map_or(Ok(()), Err);
            }
        }
    }

    /// Verifies the present answers.
    pub(super) fn verify_answers(&self) -> Result<(), SolveError> {
        // The answer of a model that is a second opinion, asked for by name, is reported with the
        // laws that it breaks, and not refused. A cable that broke at rest is where it was when it
        // broke.
        let reports_findings =
            self.requested.capabilities().reports_violations || self.cables.iter().any(|c| !c.breaks().is_empty());
        match self.verification.worst().filter(|_| !reports_findings) {
            None => Ok(()),
            Some(finding) => Err(SolveError::Unsound { model: self.model, finding: Box::new(finding.clone()) }),
        }
    }

    /// Gives the scene to the next more general model, where the user left the choice, or the next
    /// finer mesh; returns whether there was one.
    pub(super) fn switch_model(&mut self, why: &SolveError) -> bool {
        let mut other = false;
        for cable in &mut self.cables {
            other |= cable.fall_back(why);
        }
        if other || !self.requested.is_automatic() {
            return other;
        }
        let next =
            if self.source.model() == Model::MOST_CAPABLE { self.model_at_rest() } else { Some(Model::MOST_CAPABLE) };
        let Some(model) = next else { return false };
        let source = ModelSource::Registered(auto::built_for(model));
        let others = self.cables.iter().map(|c| c.rebuilt(source.clone()));
        let Ok(next) = others.collect::<Result<Vec<_>, SolveError>>() else { return false };
        self.reason = ModelReason::Unsound(Box::new(why.clone()));
        (self.cables, self.source, self.model) = (next, source, model);
        self.set_robot_pose();
        true
    }

    /// The model that answers the scene at rest, where the present one was chosen because masses
    /// will move: `spans`, from which `fem` takes over as they begin to. None where another would
    /// have to, which cannot move, and once time has run: the cable is no longer on its route.
    fn model_at_rest(&self) -> Option<Model> {
        let begins = self.reason == ModelReason::Inertia && self.time_s() <= 0.0;
        if begins { auto::before_motion(self.cables.iter().map(SimulatedCable::problem)) } else { None }
    }
}
