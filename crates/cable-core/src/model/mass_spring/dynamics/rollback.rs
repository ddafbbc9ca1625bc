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

/// Does `step`; where it fails, the model is as before.
pub(in crate::model::mass_spring) fn transaction<E>(
    model: &mut MassSpringModel,
    step: impl FnOnce(&mut MassSpringModel) -> Result<(), E>,
) -> Result<(), E> {
    let mut before = match model.rollback.0.take() {
        Some(mut before) => {
            copy_into(&mut before, model);
            before
        }
        None => Box::new(model.clone()),
    };
    let done = step(model);
    if done.is_err() {
        std::mem::swap(model, &mut before);
    }
    model.rollback.0 = Some(before);
    done
}

/// Makes `to` a copy of a model without new memory where there is room.
fn copy_into(to: &mut MassSpringModel, model: &MassSpringModel) {
    // All fields are named, so that none is forgotten.
    let MassSpringModel { settings, clock, mesh, drives, contacts, report, has_shape, rollback: _ } = model;
    (to.settings, to.has_shape) = (*settings, *has_shape);
    to.clock.clone_from(clock);
    to.mesh.clone_from(mesh);
    to.drives.clone_from(drives);
    to.contacts.clone_from(contacts);
    to.report.clone_from(report);
}
