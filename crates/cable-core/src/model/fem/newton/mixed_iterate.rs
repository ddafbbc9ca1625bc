//! The iterate of the mixed Newton iteration in contact holds what its unknowns are beside places.

use crate::contact::friction::Branch;
use crate::model::fem::system::{BarIterate, Unknowns};

/// State of the mixed iteration in contact beside positions and slides; the minimiser finds it
/// empty and uses none of it.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct MixedIterate {
    /// Pulls carried as unknowns; empty: those of the present lengths.
    pub(in crate::model::fem) carried: Vec<BarIterate>,
    /// Branches of the friction of contacts, where that is being found out; empty: those of the
    /// present unknowns.
    pub(in crate::model::fem) branches: Vec<Branch>,
    /// Slide of each node before an iteration, m.
    pub(in crate::model::fem) slid: Vec<f64>,
    /// The unknowns at which the iteration began.
    pub(in crate::model::fem) begun: Unknowns,
    /// True if the iteration stopped near enough to the answer for the minimiser to go on from
    /// there.
    pub(in crate::model::fem) near_enough: bool,
    /// Iterations of the undamped Newton in this step.
    pub(in crate::model::fem) undamped_iterations: usize,
}

impl MixedIterate {
    /// Room for so many nodes.
    pub(in crate::model::fem) fn new(nodes: usize) -> Self {
        Self {
            carried: Vec::with_capacity(nodes),
            branches: Vec::with_capacity(nodes),
            slid: Vec::with_capacity(nodes),
            ..Self::default()
        }
    }
}
