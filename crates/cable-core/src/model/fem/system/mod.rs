//! These modules hold the input of one step and assemble its energies into value, gradient and
//! banded Hessian.
//!
//! | room | content |
//! |---|---|
//! | `step_input.rs` | input of a step (loads, inertia, tolerances), its unknowns and its outcome |
//! | `step_context.rs` | problem, mesh, contacts and input together, as every solver reads them |
//! | `assembly.rs` | energy, gradient and banded Hessian of the whole mesh; held nodes pinned |
//! | `bar_energy.rs` | energy of a bar: stretching, damping, weight carried over sliding nodes |
//! | `bar_weight.rs` | weight of a bar partly on a round, at the centroid of its path |
//! | `contact/` | contacts in a step: search, barrier, friction and its memory, self-contact |

pub(in crate::model::fem) mod assembly;
pub(in crate::model::fem) mod bar_energy;
pub(in crate::model::fem) mod bar_weight;
pub(in crate::model::fem) mod contact;
pub(in crate::model::fem) mod step_context;
pub(in crate::model::fem) mod step_input;

pub(in crate::model::fem) use assembly::{Bends, System, bends_energy, bends_slope, visit_turns};
pub(in crate::model::fem) use bar_energy::{BarBranch, BarIterate, PlainBar};
pub(in crate::model::fem) use bar_weight::Weight;
pub(in crate::model::fem) use contact::body_motion::BodyMotion;
pub(in crate::model::fem) use contact::contact_energy::{add_barrier, add_floor, add_friction};
pub(in crate::model::fem) use contact::contact_pair::ContactPair;
pub(in crate::model::fem) use contact::contact_set::ContactSet;
pub(in crate::model::fem) use contact::floor_friction::RoundFloorFriction;
pub(in crate::model::fem) use contact::friction_contact::FrictionContact;
pub(in crate::model::fem) use contact::friction_contact::slip_at_rest;
pub(in crate::model::fem) use contact::friction_limits::FrictionLimits;
pub(in crate::model::fem) use contact::self_contact::{Coupling, SelfContactLaws, couple};
pub(in crate::model::fem) use step_context::{StepContext, longest};
pub(in crate::model::fem) use step_input::{
    Converged, Failure, FailureCause, HandSpring, RoundLoad, StepInput, Unknowns, WORK_MAGNITUDE_FRACTION, WorkBudget,
    load_scale, node_scale, tolerance,
};
