//! These modules find equilibria in contact and steps without inertia.
//!
//! | room | content |
//! |---|---|
//! | `static_rest.rs` | the resting place in contact (`settle`): first shape, search, polishing |
//! | `quasi_static.rs` | steps without inertia: supports move, the cable rests, friction remembers |
//! | `relaxation.rs` | pseudo-transient continuation: implicit Euler against a fading resistance |
//! | `lagged_friction.rs` | rounds of minimising with frozen normal forces, which are then renewed |

pub(in crate::model::fem) mod lagged_friction;
pub(in crate::model::fem) mod quasi_static;
pub(in crate::model::fem) mod relaxation;
pub(in crate::model::fem) mod static_rest;

pub(in crate::model::fem) use static_rest::slides_as_a_whole;
