//! These modules change the nodes and bars of a cable between steps.
//!
//! | room | content |
//! |---|---|
//! | `adapt.rs` | between steps: sliding nodes come and go, long bars cut, crowded nodes removed |
//! | `edit_criteria.rs` | read-only tests of where a sliding node is needed or lifts off |
//! | `edit.rs` | insertion and removal of one node; material, position and momentum kept |
//! | `break_cable.rs` | a break: one node becomes two |
//! | `wheels.rs` | wheels that a cable in motion leaves |
//! | `stretched_bars.rs` | bars of an edited mesh keep their tension |
//! | `loads_over_rounds.rs` | loads run on to rounds, over them and off them |
//! | `arc_marks.rs` | marks on a round where material is counted: moved, added, removed |

pub(in crate::model::fem) mod adapt;
pub(in crate::model::fem) mod arc_marks;
mod break_cable;
pub(in crate::model::fem) mod edit;
mod edit_criteria;
mod loads_over_rounds;
mod stretched_bars;
mod wheels;

pub(in crate::model::fem) use adapt::{Remeshed, even_out, make_material_at_tangents, remesh, remesh_after_step};
pub(in crate::model::fem) use break_cable::break_cable;
pub(in crate::model::fem) use edit::{clear_of_nodes, insert, remove};
pub(in crate::model::fem) use stretched_bars::StretchedBars;
pub(in crate::model::fem) use wheels::{change_wheels, lifted_wheel, load_at_pulley};
