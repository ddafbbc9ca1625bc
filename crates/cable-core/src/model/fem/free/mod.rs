//! These modules find the equilibrium of a cable that touches nothing but its supports; `beam`
//! handles stiff ones.
//!
//! | room | content |
//! |---|---|
//! | `statics.rs` | `Statics`: rest, quasi-static steps, mesh refinement; calls the other rooms |
//! | `stations.rs` | supports, pulleys and point loads by arc length, with the elements between |
//! | `element.rs` | the corrected bar: chord and compliance from the force, of fourth order |
//! | `span.rs` | Newton's method for the force at the start of a span, a convex dual problem |
//! | `pulley_balance.rs` | arc lengths at the pulleys that join the spans: stick, slip, stability |
//! | `wheel_arcs.rs` | tangent points and capstan tension on wheels of finite radius |
//! | `pulley_state.rs` | friction state of one pulley, stick or slip, and where it held the cable |
//! | `wheel_friction_memory.rs` | start, transfer and commit of the friction memory of all pulleys |
//! | `wheel_friction_newton.rs` | Newton's method for angles and material at all pulleys with friction |
//! | `beam/` | equilibrium of a cable with bending stiffness, without contact |
//! | `dual_weighted_residual.rs` | a posteriori error estimate of forces and shape |
//! | `straight_route.rs` | straight nodes from support to support before the first answer |
//! | `element_material.rs` | values that all elements share, with the auxiliary weight of a weightless cable |
//! | `results.rs` | nodes and support reactions of a solved network of spans |
//! | `failure_report.rs` | solver failures as scene errors: which pulley runs out, what does not balance |

pub(in crate::model::fem) mod beam;
pub(in crate::model::fem) mod dual_weighted_residual;
pub mod element;
pub(in crate::model::fem) mod element_material;
pub(in crate::model::fem) mod failure_report;
pub(in crate::model::fem) mod pulley_balance;
pub(in crate::model::fem) mod pulley_state;
pub(in crate::model::fem) mod results;
pub(in crate::model::fem) mod span;
pub mod statics;
pub(in crate::model::fem) mod stations;
pub(in crate::model::fem) mod straight_route;
pub(in crate::model::fem) mod wheel_arcs;
pub(in crate::model::fem) mod wheel_friction_memory;
pub(in crate::model::fem) mod wheel_friction_newton;

pub(in crate::model::fem) use beam::buckled_shapes::{LEAST_BUCKLING_LOAD, SAME_SHAPE_FRACTION};
pub(in crate::model::fem) use beam::equilibrium::nearest_turn;
pub(in crate::model::fem) use beam::mesh::places;
pub(in crate::model::fem) use statics::Statics;
pub(in crate::model::fem) use stations::{Restraint, StationLayout, place};
