//! These modules hold the contacts of a mesh in a step: their search, the barrier and its
//! stiffness, and friction with its memory, with obstacles, with a floor and of the cable with
//! itself.
//!
//! | room | content |
//! |---|---|
//! | `contact_set.rs` | all contacts of a mesh in a step, with frozen normal forces of friction |
//! | `contact_search.rs` | neighbour lists and the pairs of bars and obstacles within reach |
//! | `contact_pair.rs` | one pair: a node or a point of a segment near an obstacle feature |
//! | `contact_energy.rs` | barrier and friction added to energy, gradient and Hessian |
//! | `barrier_stiffness.rs` | barrier stiffness that follows the greatest tension between steps |
//! | `friction_contact.rs` | friction of one contact in a step: frozen normal force, sliding from an anchor |
//! | `friction_limits.rs` | search for friction limits that agree with the normal forces of a lagged step |
//! | `friction_memory.rs` | slide of each contact from its anchor, kept between steps |
//! | `floor_friction.rs` | plan view: floor friction of cable that slides round a corner or post |
//! | `self_contact.rs` | contact of the cable with itself: barrier, friction and its memory |
//! | `body_motion.rs` | rigid motion of an outline or a post in a step; points carried with it |

pub(in crate::model::fem) mod barrier_stiffness;
pub(in crate::model::fem) mod body_motion;
pub(in crate::model::fem) mod contact_energy;
pub(in crate::model::fem) mod contact_pair;
pub(in crate::model::fem) mod contact_search;
pub(in crate::model::fem) mod contact_set;
pub(in crate::model::fem) mod floor_friction;
pub(in crate::model::fem) mod friction_contact;
pub(in crate::model::fem) mod friction_limits;
pub(in crate::model::fem) mod friction_memory;
pub(in crate::model::fem) mod self_contact;
