//! These modules tell whether the cable can touch anything, move the robot's outline and the posts
//! in place of wheels, and check the cable against obstacles after a step.
//!
//! | room | content |
//! |---|---|
//! | `contact_free.rs` | can the cable touch anything but its supports? |
//! | `moving_bodies.rs` | the robot's outline and posts moved along their paths, cable pushed out of their way |
//! | `intersection_check.rs` | does a bar run through an obstacle, or fold back over a corner's edge? |

mod contact_free;
pub(in crate::model::fem) mod intersection_check;
pub(in crate::model::fem) mod moving_bodies;

pub(in crate::model::fem) use contact_free::touches_nothing;
pub(in crate::model::fem) use intersection_check::IntersectionCheck;
pub(in crate::model::fem) use moving_bodies::{outline_report, place_bodies, prepare_way, put_outline};
