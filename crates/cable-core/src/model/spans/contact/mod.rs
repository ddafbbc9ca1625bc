//! These modules hold the equations of a contact, the loads on it and its ends.

pub(in crate::model::spans) mod equations;
pub(in crate::model::spans) mod kink_load;
pub(in crate::model::spans) mod load_balance;
pub(in crate::model::spans) mod load_landing;
pub(in crate::model::spans) mod point_load;
pub(in crate::model::spans) mod release_below;
pub(in crate::model::spans) mod slack_pocket;
pub(in crate::model::spans) mod support_contact;
pub(in crate::model) mod wheel_friction;
