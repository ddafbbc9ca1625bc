//! These modules hold the equations of a contact, the loads on it and its ends.
//!
//! | room | content |
//! |---|---|
//! | `equations.rs` | two equations of a contact with derivatives; its mode, stick or slip |
//! | `support_contact.rs` | a support that comes to lie on a boundary, slides along it, or lifts off |
//! | `point_load.rs` | a dead load on a boundary: stick or slip, joining with contacts, lift-off |
//! | `impending_slip.rs` | friction of all contacts of a section used up in one direction |
//! | `load_balance.rs` | forces on such a load: both cable forces and the load, normal and tangential |
//! | `kink_load.rs` | a load in a concave kink, held by both its edges or sliding out |
//! | `slack_pocket.rs` | slack cable heaped in a concave kink, at zero tension |
//! | `release_below.rs` | parting of a contact that would have to pull below a post |
//! | `wheel_friction.rs` | friction memory and equations of one wheel, for models with spans of their own |

pub(in crate::model::spans) mod equations;
pub(in crate::model::spans) mod impending_slip;
pub(in crate::model::spans) mod kink_load;
pub(in crate::model::spans) mod load_balance;
pub(in crate::model::spans) mod point_load;
pub(in crate::model::spans) mod release_below;
pub(in crate::model::spans) mod slack_pocket;
pub(in crate::model::spans) mod support_contact;
pub(in crate::model) mod wheel_friction;

pub(in crate::model::spans) use load_balance::load_balance;
pub(in crate::model::spans) use point_load::LIFT_FRACTION;
pub(in crate::model::spans) use support_contact::place;
pub(in crate::model) use wheel_friction::{CableProperties, WheelEnds, WheelFriction};
