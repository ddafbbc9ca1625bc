//! The state of the chain of masses and springs is made of parts: all that a step changes, and that
//! a rollback keeps.

use crate::model::mass_spring::contact_memory::ContactMemory;
use crate::model::mass_spring::dynamics::Clock;
use crate::model::mass_spring::dynamics::momentum::MomentumSums;
use crate::model::mass_spring::dynamics::supports::SupportDrives;
use crate::model::mass_spring::mesh::{Mesh, remesh};
use crate::solution::{Cost, Warning};

part! {
    /// The report of the present instant and of the last step.
    #[derive(Default)]
    Report {
        /// Work of the last step.
        cost: Cost,
        /// Warnings that have not been given to the user yet.
        warnings: Vec<Warning>,
        /// Account of momentum since the caller's step began.
        account: MomentumSums,
    }
}

part! {
    /// The chain of masses and springs, in parts: all that a step changes, and that a rollback
    /// keeps.
    ChainState {
        /// The time reached.
        clock: Clock,
        /// Nodes, springs and pulleys.
        mesh: Mesh,
        /// The motions and hands that lead the supports.
        drives: SupportDrives,
        /// The contacts of the last sub-step.
        contacts: ContactMemory,
        /// The report of the step.
        report: Report,
    }
}

impl ChainState {
    /// Keeps the elements beside pulleys near the even length.
    pub(in crate::model::mass_spring) fn remesh(&mut self) {
        if remesh(&mut self.mesh, self.clock.time_s) {
            self.contacts.renew(self.mesh.rest_length.len());
        }
    }
}
