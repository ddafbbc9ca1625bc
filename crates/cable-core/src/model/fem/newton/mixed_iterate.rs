//! The iterate of the mixed Newton method in contact holds its unknowns other than positions.

use crate::contact::friction::Branch;
use crate::model::fem::system::{BarIterate, Unknowns};

/// State of the mixed iteration in contact other than positions and slides. For the minimiser it is
/// empty.
#[derive(Debug, Default)]
pub(in crate::model::fem) struct MixedIterate {
    /// Bar forces as unknowns; if empty, they follow from the present lengths.
    pub(in crate::model::fem) carried: Vec<BarIterate>,
    /// Assumed friction branches of the contacts; if empty, they follow from the present unknowns.
    pub(in crate::model::fem) branches: Vec<Branch>,
    /// Slide of each node before an iteration, m.
    pub(in crate::model::fem) slid: Vec<f64>,
    /// The unknowns at which the iteration began.
    pub(in crate::model::fem) begun: Unknowns,
    /// True if the iteration stopped near enough to the solution for the minimiser to continue from
    /// there.
    pub(in crate::model::fem) near_enough: bool,
    /// Number of iterations of the undamped Newton method in this step.
    pub(in crate::model::fem) undamped_iterations: usize,
}

impl MixedIterate {
    /// Allocates memory for so many nodes.
    pub(in crate::model::fem) fn new(nodes: usize) -> Self {
        Self {
            carried: Vec::with_capacity(nodes),
            branches: Vec::with_capacity(nodes),
            slid: Vec::with_capacity(nodes),
            ..Self::default()
        }
    }
}
