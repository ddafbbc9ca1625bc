//! These modules check an answer without the solver: equilibrium, clearance and tunnelling.
//!
//! | room | content |
//! |---|---|
//! | `equilibrium.rs` | spans by quadrature, contact and global balance, friction cone |
//! | `clearance.rs` | proof that nothing is inside an obstacle, by halving bounding triangles |
//! | `tunnelling.rs` | test whether a step passed the cable through a corner, from shapes before
//! and after |

pub(in crate::model::spans) mod clearance;
pub(in crate::model::spans) mod equilibrium;
pub(in crate::model::spans) mod tunnelling;

pub(in crate::model::spans) use tunnelling::{Side, tangent};
