//! A cable breaks at a place and an instant, and is divided there among shorter cables.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | [`Break`]: place and instant of a break |
//! | `rupture.rs` | where and when the breaking tension is first reached |
//! | `partition.rs` | which stretch, supports and loads belong to which piece |
//!
//! Nothing here knows a model: [`crate::simulated_cable`] steps the pieces and asks this module
//! where one of them breaks and how it is divided.

mod partition;
pub(crate) mod rupture;

pub(crate) use self::partition::{CablePart, Cut};
use crate::math::Vec2;

/// A break.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Break {
    /// Time of the break, s.
    pub time_s: f64,
    /// Place on the cable, m.
    pub arc_length_m: f64,
    /// Place in the plane, m.
    pub at: Vec2,
    /// The support it tore off, if it did.
    pub detached_from: Option<String>,
    /// The time over which its mean tension reached the breaking tension, s; 0 = at once.
    pub over_s: f64,
}
