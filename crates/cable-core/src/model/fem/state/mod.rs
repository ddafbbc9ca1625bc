//! These modules hold the state of a cable in motion in its parts, and set up a step from it.
//!
//! | room | content |
//! |---|---|
//! | `cable_state.rs` | `CableState`: mesh, contacts, motion, loads of the step, last answers |
//! | `meshing.rs` | division into bars; the nodes of supports and loads |
//! | `motion.rs` | positions, velocities and the past steps that BDF looks back to |
//! | `step_setup.rs` | loads, support targets and wheels at an instant, into the step input |
//! | `support_stop.rs` | a support driven into an obstacle stops in front of it; one that lets go there |
//! | `outline_path.rs` | the robot's outline: its pose and the path it is led along in an advance |
//! | `stick_slip.rs` | friction assumed at each sliding node against Coulomb's law at the solution |
//! | `fold_imperfection.rs` | tiny offset of a collinear fold, a bifurcation point, so that it opens |
//! | `moving_mass.rs` | momentum of the cable and of material at sliding nodes, across mesh changes |
//! | `stored_energy.rs` | kinetic energy, and that of height, stretch and bending |
//! | `energy_account.rs` | work of each kind of force, summed since the cable began to move |
//! | `momentum_account.rs` | impulses by kind of force, summed over the caller's step |

pub(in crate::model::fem) mod cable_state;
pub(in crate::model::fem) mod energy_account;
pub(in crate::model::fem) mod fold_imperfection;
pub(in crate::model::fem) mod meshing;
pub(in crate::model::fem) mod momentum_account;
pub(in crate::model::fem) mod motion;
pub(in crate::model::fem) mod moving_mass;
pub(in crate::model::fem) mod outline_path;
pub(in crate::model::fem) mod step_setup;
pub(in crate::model::fem) mod stick_slip;
pub(in crate::model::fem) mod stored_energy;
pub(in crate::model::fem) mod support_stop;

pub(in crate::model::fem) use cable_state::{CableState, NodeTensions, StepAnswers};
pub(in crate::model::fem) use energy_account::{Energies, Works};
pub(in crate::model::fem) use fold_imperfection::open_collinear_folds;
pub(in crate::model::fem) use meshing::{LoadNode, Meshing};
pub(in crate::model::fem) use momentum_account::{CONTACTS, Kinds, LOADS, SUPPORTS, WEIGHT, kind_of};
pub(in crate::model::fem) use motion::{NodalMotion, NodeMotion};
pub(in crate::model::fem) use moving_mass::{MovingMass, attribute_to};
pub(in crate::model::fem) use outline_path::{MovingOutline, with_outline};
pub(in crate::model::fem) use step_setup::{prepare_input, prepare_step, renew_input};
pub(in crate::model::fem) use stick_slip::{ChangedNodes, StickSlipChanges, TriedExponents, update_stick_slip};
pub(in crate::model::fem) use stored_energy::{
    bending_energy, gravity_energy, kinetic_energy, kinetic_energy_of_step, stored_energy,
};
pub(in crate::model::fem) use support_stop::{place_released_supports, stopped_by_obstacles};
