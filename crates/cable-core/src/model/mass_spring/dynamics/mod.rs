//! These modules take one explicit sub-step: supports and hands that move, material that slides
//! over pulleys, impacts, the account of momentum, limits and rollback. `chain_state` has the parts
//! that a step changes.
//!
//! | room | content |
//! |---|---|
//! | `chain_state.rs` | `ChainState`: clock, mesh, supports, contacts, report; what a rollback keeps |
//! | `sub_step.rs` | the explicit integrator: stable sub-steps, forces, contacts, gauge readings |
//! | `supports.rs` | moving supports: velocities and positions of held nodes and pulley centres |
//! | `hands.rs` | hands that drag supports by springs, implicit in the sub-step |
//! | `pulley_sliding.rs` | material over pulleys: its rate, capstan friction, momentum carried along |
//! | `impacts.rs` | inelastic normal and friction impulses at contacts in a sub-step |
//! | `floor_friction.rs` | Coulomb friction of the floor in plan view, on each node |
//! | `buried_nodes.rs` | refusal of a cable whose centre line is inside an obstacle |
//! | `momentum.rs` | impulse of each kind of force over a step, for the momentum account |
//! | `runaway_guard.rs` | limits of speed and energy against a runaway motion, with warnings |
//! | `rollback.rs` | copy of the state before a step, restored where the step fails |

pub(in crate::model::mass_spring) mod buried_nodes;
pub(in crate::model::mass_spring) mod chain_state;
pub(in crate::model::mass_spring) mod floor_friction;
pub(in crate::model::mass_spring) mod hands;
pub(in crate::model::mass_spring) mod impacts;
pub(in crate::model::mass_spring) mod momentum;
pub(in crate::model::mass_spring) mod pulley_sliding;
pub(in crate::model::mass_spring) mod rollback;
pub(in crate::model::mass_spring) mod runaway_guard;
pub(in crate::model::mass_spring) mod sub_step;
pub(in crate::model::mass_spring) mod supports;

pub(in crate::model::mass_spring) use chain_state::{ChainState, Report};
pub(in crate::model::mass_spring) use momentum::MomentumSums;
pub(in crate::model::mass_spring) use rollback::{Rollback, transaction};
pub(in crate::model::mass_spring) use runaway_guard::RunawayGuard;
pub(in crate::model::mass_spring) use sub_step::integrate;
pub(in crate::model::mass_spring) use supports::{HandSettings, SupportDrives};

part! {
    /// The times of the model.
    #[derive(Default)]
    Clock {
        /// Time reached, s.
        time_s: f64,
        /// End of the present step of the caller, s.
        due_s: f64,
        /// Time by which velocities are behind places, s: half of the last sub-step, 0 where a
        /// motion begins.
        behind_s: f64,
    }
}

/// One explicit sub-step.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::mass_spring) struct SubStep {
    /// Time by which positions go on, s.
    pub length_s: f64,
    /// Time for which forces act on velocities, s: from the middle of the sub-step before to the
    /// middle of this one.
    pub kick_s: f64,
}
