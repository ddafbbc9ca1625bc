//! Warnings tell what a cable suffers beyond its shape: limits exceeded, breaks, bends, slack,
//! tangles, snags, energy from nowhere.
//!
//! | room | content |
//! |---|---|
//! | `monitor.rs` | [`WarningMonitor`]: warnings that persist |
//! | `tension.rs` | tension limits, breaks, slack |
//! | `bend.rs` | bend radii and sidewall pressure |
//! | `guide_at_node.rs` | what leads the cable at a node |
//! | `tangle.rs` | loops, curls and wraps |
//! | `snag.rs` | an obstacle that holds the cable while the pull grows |
//! | `energy_growth.rs` | energy that nothing has given |
//! | `speed.rs` | speeds beyond those for which the models are made |
//!
//! Each part looks at one answer of one cable ([`CableSolution`]) and reports what it finds;
//! [`WarningMonitor`] adds time: since when, and no flicker. Models know nothing of it, so all of
//! them get it.

mod bend;
mod energy_growth;
mod guide_at_node;
mod monitor;
mod snag;
mod speed;
mod tangle;
mod tension;
#[cfg(test)]
mod tests;

use crate::breakage::Break;
use crate::problem::Problem;
use crate::solution::{CableSolution, Energy};

pub(crate) use bend::SharpestBends;
pub(crate) use monitor::WarningMonitor;

/// One cable, what it is said to do now, and where it broke.
#[derive(Clone, Copy)]
pub(crate) struct Observed<'a> {
    /// The whole cable.
    pub problem: &'a Problem,
    /// Its answer.
    pub answer: &'a CableSolution,
    /// Its energy.
    pub energy: Energy,
    /// Its bends.
    pub bends: SharpestBends,
    /// Its breaks.
    pub breaks: &'a [Break],
}
