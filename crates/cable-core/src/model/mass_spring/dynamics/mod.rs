//! These modules take one explicit sub-step: forces, impacts, limits, rollback, momentum and hands.

pub(in crate::model::mass_spring) mod hands;
pub(in crate::model::mass_spring) mod impacts;
pub(in crate::model::mass_spring) mod momentum;
pub(in crate::model::mass_spring) mod rollback;
pub(in crate::model::mass_spring) mod runaway_guard;
pub(in crate::model::mass_spring) mod sub_step;

use crate::math::Vec2;
use crate::model::input_filter::{Hand, SmoothedTarget};

part! {
    /// The times of the model.
    Clock {
        /// Time reached, s.
        time_s: f64,
        /// When the present step of the caller ends, s.
        due_s: f64,
        /// Time by which velocities are behind places, s: half of the last sub-step, 0 where a
        /// motion begins.
        behind_s: f64,
    }
}

part! {
    /// How supports hold nodes, and what leads them.
    SupportDrives {
        /// Whether a support holds the node now.
        held: Vec<bool>,
        /// Nodes that their support has let go as the present sub-step began.
        let_go: Vec<usize>,
        /// Acceleration of held nodes, m/s².
        held_acceleration: Vec<Vec2>,
        /// Where each support is dragged to, if it is.
        drag: Vec<Option<Vec2>>,
        /// Followers of dragged supports.
        followers: Vec<Option<SmoothedTarget>>,
        /// Which of the dragged supports a hand holds by a spring.
        pulled: Vec<bool>,
        /// Those hands.
        hands: Vec<Option<Hand>>,
        /// Fastest any support has moved, m/s.
        driven: f64,
    }
}
