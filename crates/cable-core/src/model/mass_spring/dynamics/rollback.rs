//! A rollback keeps the state before a step, in the same memory step after step, to return to it
//! where the step fails.

use crate::model::mass_spring::dynamics::chain_state::ChainState;

/// A copy of the state, if one was made; copies of the model make their own.
#[derive(Debug, Default)]
pub(in crate::model::mass_spring) struct Rollback(Option<Box<ChainState>>);

impl Clone for Rollback {
    fn clone(&self) -> Self {
        Self(None)
    }
}

/// Does `step`; where it fails, the state is as before.
pub(in crate::model::mass_spring) fn transaction<E>(
    rollback: &mut Rollback,
    chain: &mut ChainState,
    step: impl FnOnce(&mut ChainState) -> Result<(), E>,
) -> Result<(), E> {
    match &mut rollback.0 {
        Some(before) => before.as_mut().clone_from(chain),
        None => rollback.0 = Some(Box::new(chain.clone())),
    }
    let done = step(chain);
    if let (Err(_), Some(before)) = (&done, &mut rollback.0) {
        std::mem::swap(chain, before);
    }
    done
}
