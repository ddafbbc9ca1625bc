//! The history holds where the cable is and how it moves, and the checkpoint to which a failed step
//! returns.

use crate::math::RigidPose;
use crate::math::{Vec2, cross, perp};
use crate::model::fem::dynamics::Dynamics;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::friction_state::ContactSet;
use crate::model::fem::time::momentum::Account;
use crate::model::input_filter::{Hand, SmoothedTarget};

/// What a step may change, kept to go back to.
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
    /// What the relaxation branches of each bar pull with, one bar after the other, N; empty:
    /// nothing (see `loss`).
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
    /// Where the outline of the robot is, if there is one.
    pub(in crate::model::fem) placement: Option<RigidPose>,
    /// What became of the momentum since the caller's step began.
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
    motion: Motion,
    mesh: Mesh,
    contacts: ContactSet,
    support_node: Vec<Option<usize>>,
    /// Nodes of the loads; their number never changes.
    load_node: Vec<usize>,
    reaction: Vec<Vec2>,
}

/// How far (parts of a bar) the middle of a fold is moved aside. Less: the fold opens later than it
/// would; more: its bars are stretched by half of the square of it.
const ASIDE: f64 = 1e-4;

/// Sine of the turn off a line below which a fold lies in it.
const FOLD_LINE_SINE: f64 = 1e-6;

impl Dynamics {
    /// Moves the middle of each fold that lies in one line a little aside, as a motion begins. In
    /// the line itself a bar would have to pass through no length to turn over: a weight that fell
    /// beside its slack cable hung in the fold.
    pub(in crate::model::fem) fn open_folds(&mut self) {
        let (mesh, x) = (&self.mesh, &mut self.motion.x);
        for k in 1..x.len().saturating_sub(1) {
            let (a, b) = (x[k] - x[k - 1], x[k + 1] - x[k]);
            let size = a.norm() * b.norm();
            if mesh.is_free(k) && a.dot(&b) < 0.0 && cross(a, b).abs() <= FOLD_LINE_SINE * size {
                x[k] += perp(a) * ASIDE;
            }
        }
    }

    /// Keeps the present state to go back to, in the memory of the one kept before.
    pub(in crate::model::fem) fn save(&mut self) {
        match &mut self.rollback.saved {
            Some(s) => {
                s.motion.copy_from(&self.motion);
                s.mesh.copy_from(&self.mesh, !self.meshing.never_slides);
                s.contacts.copy_from(&self.contacts);
                s.support_node.clone_from(&self.meshing.support_node);
                s.reaction.clone_from(&self.answers.reaction);
                s.load_node.clear();
                s.load_node.extend(self.meshing.loads.iter().map(|l| l.0));
            }
            None => {
                self.rollback.saved = Some(Box::new(Checkpoint {
                    motion: self.motion.clone(),
                    mesh: self.mesh.clone(),
                    contacts: self.contacts.clone(),
                    support_node: self.meshing.support_node.clone(),
                    load_node: self.meshing.loads.iter().map(|l| l.0).collect(),
                    reaction: self.answers.reaction.clone(),
                }));
            }
        }
        self.rollback.can_restore = true;
    }

    /// Goes back to the state kept, once.
    pub(in crate::model::fem) fn restore(&mut self) {
        if let Some(s) = self.rollback.saved.as_ref().filter(|_| self.rollback.can_restore) {
            self.motion.copy_from(&s.motion);
            self.mesh.copy_from(&s.mesh, !self.meshing.never_slides);
            self.contacts.copy_from(&s.contacts);
            self.meshing.support_node.clone_from(&s.support_node);
            self.answers.reaction.clone_from(&s.reaction);
            for (load, &node) in self.meshing.loads.iter_mut().zip(&s.load_node) {
                load.0 = node;
            }
            self.rollback.can_restore = false;
            self.place_outline();
            self.renew_task();
        }
    }
}
