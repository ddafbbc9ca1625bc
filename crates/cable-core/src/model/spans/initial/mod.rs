//! These modules make the initial shape: route, shortest path, contacts and tension, or another
//! answer.

pub(in crate::model::spans) mod contacts;
pub(in crate::model::spans) mod drained_route;
pub(in crate::model::spans) mod from_solution;
pub(in crate::model::spans) mod material;
pub(in crate::model::spans) mod route;
pub(in crate::model::spans) mod shortest_path;
pub(in crate::model::spans) mod tension;
