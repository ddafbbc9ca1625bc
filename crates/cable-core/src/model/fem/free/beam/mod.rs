//! These modules find the equilibrium of a stiff cable that touches nothing but its supports.
//!
//! | room | content |
//! |---|---|
//! | `equilibrium.rs` | quadratic elements in the tangent angle, stretch eliminated; Newton's method |
//! | `mesh.rs` | nodes graded into the boundary layers beside clamps, loads and supports |
//! | `refinement.rs` | halving of bars until the error estimate suffices |
//! | `buckled_shapes.rs` | other equilibria of a compressed (buckled) cable, bowed to its other side |
//! | `results.rs` | nodes of a solved stiff cable: positions, tensions, moments, curvatures |

pub(in crate::model::fem) mod buckled_shapes;
pub(in crate::model::fem) mod equilibrium;
pub(in crate::model::fem) mod mesh;
pub(in crate::model::fem) mod refinement;
pub(in crate::model::fem) mod results;
