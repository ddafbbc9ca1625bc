//! These modules find equilibria in contact and steps without inertia.
//!
//! | room | content |
//! |---|---|
//! | `quasi_static.rs` | the resting place in contact (`settle`), steps without inertia, polishing |
//! | `relaxation.rs` | pseudo-transient continuation: implicit Euler against a fading resistance |
//! | `lagged_friction.rs` | rounds of minimising with frozen normal forces, which are then renewed |

pub(in crate::model::fem) mod lagged_friction;
pub(in crate::model::fem) mod quasi_static;
pub(in crate::model::fem) mod relaxation;

pub(in crate::model::fem) use quasi_static::slides_as_a_whole;
