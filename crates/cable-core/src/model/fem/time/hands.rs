//! Hands draw supports in a step with inertia: by a spring, which is a force on a node, or the
//! support itself.

use crate::math::Vec2;
use crate::model::fem::dynamics::Dynamics;
use crate::model::fem::system::bar_weight;
use crate::model::fem::system::step_input::Pose;
use crate::model::input_filter::{Hand, SmoothedTarget, is_led};
use crate::solution::Warning;

impl Dynamics {
    /// Hands and dragged supports move on for `h` (s) towards where they are drawn (m).
    pub(in crate::model::fem) fn follow_hands(&mut self, h: f64, dragged: &[Option<Vec2>]) {
        for (k, target) in dragged.iter().enumerate() {
            let (Some(target), Some(at)) = (*target, self.support_position(k)) else { continue };
            let fastest = self.hand_drive.hand_speed;
            if is_led(&self.problem, k) {
                let left = self.pacing.due - self.motion.time;
                let f = self.motion.followers[k].get_or_insert(SmoothedTarget::at_rest(at));
                f.lead(target, if left > h { h / left } else { 1.0 }, h);
                continue;
            }
            let node = self.meshing.support_node[k].filter(|_| self.problem.supports[k].holds_from(self.motion.time));
            if let Some(node) = node.filter(|_| self.hand_drive.pulled[k]) {
                let known = self.motion.hands[k];
                let mut hand = known.unwrap_or_else(|| {
                    Hand::grip(&self.problem, self.hand_drive.hand_stiffness, at, self.holding_force(k, node))
                });
                hand.follow(target, h, fastest);
                (self.motion.hands[k], self.motion.followers[k]) = (Some(hand), None);
            } else {
                let let_go = self.motion.hands[k].take().and(node);
                let begins = || {
                    let_go.map_or(SmoothedTarget::at_rest(at), |node| SmoothedTarget::moving(at, self.motion.v[node]))
                };
                let mut f = self.motion.followers[k].unwrap_or_else(begins);
                f.follow(target, h, fastest);
                self.motion.followers[k] = Some(f);
            }
        }
    }

    /// Force that holds a support's node against its bars and what hangs there, N.
    fn holding_force(&self, support: usize, node: usize) -> Vec2 {
        let (mesh, x) = (&self.mesh, &self.motion.x);
        let pull = |e: usize| {
            let path = mesh.path(e, x);
            let tension = mesh.bar(e).tension(path.length);
            path.direction * if tension > 0.0 { tension } else { 0.0 }
        };
        let before = if node > 0 { pull(node - 1) } else { Vec2::zeros() };
        let after = if node + 1 < mesh.nodes() { pull(node) } else { Vec2::zeros() };
        let time = self.motion.time;
        before
            - after
            - bar_weight::on_node(mesh, node, x, self.problem.body_force(time))
            - self.problem.hung_on(support, time)
    }

    /// Keeps the force of the cable on what hands hold, as a pose balances it.
    pub(in crate::model::fem) fn note_hands(&mut self, pose: &Pose) {
        for &(k, stiffness, at) in &self.task.hands {
            self.answers.reaction[k] = (pose.x[k] - at) * stiffness;
        }
    }

    /// What is to be said of hands that lag, and of supports that lag behind them.
    pub(in crate::model::fem) fn hand_warnings(&self) -> impl Iterator<Item = Warning> {
        self.motion.hands.iter().enumerate().filter_map(|(k, hand)| {
            let (hand, node) = (hand.as_ref()?, self.meshing.support_node[k]?);
            let fastest = self.hand_drive.hand_speed;
            let (at, force) = (self.motion.x[node], -self.answers.reaction[node]);
            hand.warning(&self.problem, k, self.mesh.arc_length[node], at, force, fastest)
        })
    }
}
