//! The history holds where the cable is and how it moves; a checkpoint is a state to which a failed
//! step returns.

use crate::math::RigidPose;
use crate::math::Vec2;
use crate::model::fem::state::account::Account;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::friction_state::ContactSet;
use crate::model::input_filter::{Hand, SmoothedTarget};

/// The parts of the state that a step may change, kept to go back to.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct Motion {
    pub(in crate::model::fem) x: Vec<Vec2>,
    pub(in crate::model::fem) v: Vec<Vec2>,
    pub(in crate::model::fem) x_before: Vec<Vec2>,
    pub(in crate::model::fem) v_before: Vec<Vec2>,
    /// Place and velocity two steps ago, where the integrator looks so far back.
    pub(in crate::model::fem) x_older: Vec<Vec2>,
    pub(in crate::model::fem) v_older: Vec<Vec2>,
    /// Arc length at sliding nodes one step ago, m.
    pub(in crate::model::fem) s_before: Vec<f64>,
    /// Forces of the relaxation branches of each bar, one bar after the other, N; empty: none (see
    /// `loss`).
    pub(in crate::model::fem) branch: Vec<f64>,
    /// Rate of the arc length at sliding nodes, m/s.
    pub(in crate::model::fem) w: Vec<f64>,
    pub(in crate::model::fem) w_before: Vec<f64>,
    /// Last step, s; 0 = no history, the next step is implicit Euler.
    pub(in crate::model::fem) step_before: f64,
    /// Steps as long as the last, one after the other, after each of which all bars pulled.
    pub(in crate::model::fem) even_steps: usize,
    pub(in crate::model::fem) followers: Vec<Option<SmoothedTarget>>,
    /// Hands that hold supports by springs.
    pub(in crate::model::fem) hands: Vec<Option<Hand>>,
    pub(in crate::model::fem) time: f64,
    /// The pose of the robot's outline, if there is one.
    pub(in crate::model::fem) placement: Option<RigidPose>,
    /// The account of momentum since the caller's step began.
    pub(in crate::model::fem) account: Account,
}

impl Motion {
    /// Becomes a copy without new memory where there is room.
    pub(in crate::model::fem) fn copy_from(&mut self, other: &Self) {
        let Self {
            x, v, x_before, v_before, x_older, v_older, s_before, w, w_before, followers, hands, branch, ..
        } = other;
        self.x.clone_from(x);
        self.branch.clone_from(branch);
        self.v.clone_from(v);
        self.x_before.clone_from(x_before);
        self.v_before.clone_from(v_before);
        self.x_older.clone_from(x_older);
        self.v_older.clone_from(v_older);
        self.s_before.clone_from(s_before);
        self.w.clone_from(w);
        self.w_before.clone_from(w_before);
        self.followers.clone_from(followers);
        self.hands.clone_from(hands);
        (self.step_before, self.even_steps) = (other.step_before, other.even_steps);
        (self.time, self.placement) = (other.time, other.placement);
        self.account = other.account;
    }
}

/// A state to go back to.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct Checkpoint {
    pub(in crate::model::fem) motion: Motion,
    pub(in crate::model::fem) mesh: Mesh,
    pub(in crate::model::fem) contacts: ContactSet,
    pub(in crate::model::fem) support_node: Vec<Option<usize>>,
    /// Nodes of the loads; their number never changes.
    pub(in crate::model::fem) load_node: Vec<usize>,
    pub(in crate::model::fem) reaction: Vec<Vec2>,
}
