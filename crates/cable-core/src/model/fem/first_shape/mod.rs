//! These modules lay a cable along its route: the shape from which its equilibrium is sought.
//!
//! | room | content |
//! |---|---|
//! | `first_state.rs` | first state: laid along its route, at rest, clear of obstacles |
//! | `route.rs` | material spread along a route over obstacles; an arc; a stiff end that leans |
//! | `threading.rs` | sliding nodes at the pulleys |
//! | `push_out.rs` | nodes and bars pushed out of obstacles |

pub(in crate::model::fem) mod first_state;
pub(in crate::model::fem) mod push_out;
pub mod route;
pub(in crate::model::fem) mod threading;

pub(in crate::model::fem) use first_state::cable_along_route;
pub(in crate::model::fem) use push_out::{depenetrate, push_chain_out};
pub(in crate::model::fem) use route::{bow, leaning_way};
pub(in crate::model::fem) use threading::thread_pulleys;
