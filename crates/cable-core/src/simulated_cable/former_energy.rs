//! The energy account of models that were replaced, and the reason why one is.

use crate::solution::EnergyAccount;

/// The account of models that were replaced.
#[derive(Clone, Copy, Debug)]
pub(super) struct FormerEnergy {
    pub account: EnergyAccount,
    /// The time at which it began, s.
    pub from_s: f64,
}

/// The reason why a model is replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReplacementReason {
    Break,
    Edit,
}
