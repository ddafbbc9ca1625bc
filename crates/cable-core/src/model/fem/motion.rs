//! Where the cable is and how it moves: all that a step changes beside its mesh and contacts.

use crate::contact::outline::Placement;
use crate::math::Vec2;
use crate::model::drive::Follower;

/// What a step may change, kept to go back to.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub(super) x: Vec<Vec2>,
    pub(super) v: Vec<Vec2>,
    pub(super) x_before: Vec<Vec2>,
    pub(super) v_before: Vec<Vec2>,
    /// Arc length at sliding nodes one step ago, m.
    pub(super) s_before: Vec<f64>,
    /// Rate of the arc length at sliding nodes, m/s.
    pub(super) w: Vec<f64>,
    pub(super) w_before: Vec<f64>,
    /// Last step, s; 0 = no history, the next step is implicit Euler.
    pub(super) step_before: f64,
    pub(super) followers: Vec<Option<Follower>>,
    pub(super) time: f64,
    /// Where the outline of the robot is, if there is one.
    pub(super) placement: Option<Placement>,
}

impl Motion {
    /// Becomes a copy without new memory where there is room.
    pub(super) fn copy_from(&mut self, other: &Self) {
        let Self { x, v, x_before, v_before, s_before, w, w_before, step_before, followers, time, placement } = other;
        self.x.clone_from(x);
        self.v.clone_from(v);
        self.x_before.clone_from(x_before);
        self.v_before.clone_from(v_before);
        self.s_before.clone_from(s_before);
        self.w.clone_from(w);
        self.w_before.clone_from(w_before);
        self.followers.clone_from(followers);
        (self.step_before, self.time, self.placement) = (*step_before, *time, *placement);
    }
}
