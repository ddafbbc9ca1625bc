//! A rollback keeps the state before a step, in the same memory step after step, to return to it
//! where the step fails.

use crate::model::mass_spring::MassSpringModel;

/// A copy of the model, if one was made; copies of the model make their own.
#[derive(Debug, Default)]
pub(in crate::model::mass_spring) struct Rollback(Option<Box<MassSpringModel>>);

impl Clone for Rollback {
    fn clone(&self) -> Self {
        Self(None)
    }
}

impl MassSpringModel {
    /// Does `step`; where it fails, all is as before.
    pub(in crate::model::mass_spring) fn or_as_before<E>(
        &mut self,
        step: impl FnOnce(&mut Self) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut kept = match self.kept.0.take() {
            Some(mut kept) => {
                kept.copy_from(self);
                kept
            }
            None => Box::new(self.clone()),
        };
        let done = step(self);
        if done.is_err() {
            std::mem::swap(self, &mut kept);
        }
        self.kept.0 = Some(kept);
        done
    }

    /// Becomes a copy without new memory where there is room.
    fn copy_from(&mut self, other: &Self) {
        // All fields are named, so that none is forgotten.
        let Self { problem, settings, clock, chain, drives, contacts, wheels, report, laid, kept: _ } = other;
        self.problem.clone_from(problem);
        (self.settings, self.laid) = (*settings, *laid);
        self.clock.clone_from(clock);
        self.chain.clone_from(chain);
        self.drives.clone_from(drives);
        self.contacts.clone_from(contacts);
        self.wheels.clone_from(wheels);
        self.report.clone_from(report);
    }
}
