//! These modules tell whether the cable can touch anything, move the robot's outline, and check the
//! cable against obstacles after a step.
//!
//! | room | content |
//! |---|---|
//! | `contact_free.rs` | can the cable touch anything but its supports? |
//! | `outline_placement.rs` | the robot's outline moved along its path, cable pushed out of its way |
//! | `intersection_check.rs` | does a bar run through an obstacle, or fold back over a corner's edge? |

mod contact_free;
pub(in crate::model::fem) mod intersection_check;
pub(in crate::model::fem) mod outline_placement;

pub(in crate::model::fem) use contact_free::touches_nothing;
pub(in crate::model::fem) use intersection_check::IntersectionCheck;
pub(in crate::model::fem) use outline_placement::{outline_report, place_outline, prepare_way, put_outline};
