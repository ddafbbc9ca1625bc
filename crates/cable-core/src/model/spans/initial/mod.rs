//! These modules make the initial shape: from route, shortest path, contacts and tension, or from
//! another answer.
//!
//! | room | content |
//! |---|---|
//! | `route.rs` | the scene's route, or one over the obstacles from support to support |
//! | `shortest_path.rs` | taut string homotopic to the route: the corners and posts it bends round |
//! | `section_along_route.rs` | contacts where the taut string bends; forces of the spans between |
//! | `material_distribution.rs` | material laid along the taut string, in order, some of it in each span |
//! | `tightening.rs` | material spread evenly along the taut string; even tension in each contact |
//! | `from_solution.rs` | sections, contacts and friction memory from another model's answer |

pub(in crate::model::spans) mod from_solution;
pub(in crate::model::spans) mod material_distribution;
pub(in crate::model::spans) mod route;
pub(in crate::model::spans) mod section_along_route;
pub(in crate::model::spans) mod shortest_path;
pub(in crate::model::spans) mod tightening;

pub(in crate::model::spans) use route::section_route;
