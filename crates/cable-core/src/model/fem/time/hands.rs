//! Hands drag supports in a step with inertia: by a spring, which is a force on a node, or by
//! prescribing the support's position.

use crate::math::{Vec2, larger};
use crate::model::fem::state::CableState;
use crate::model::fem::system::{Unknowns, bar_weight};
use crate::model::hand::Hand;
use crate::model::smoothed_target::{SmoothedTarget, is_led};
use crate::solution::Warning;

/// Force that holds a support's node against its bars and loads, N.
fn holding_force(cable: &CableState, support: usize, node: usize) -> Vec2 {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let pull = |e: usize| {
        let path = mesh.path(e, x);
        path.direction * larger(mesh.tension(e, path.length), 0.0)
    };
    let before = if node > 0 { pull(node - 1) } else { Vec2::zeros() };
    let after = if node + 1 < mesh.nodes() { pull(node) } else { Vec2::zeros() };
    let time = cable.motion.time;
    before
        - after
        - bar_weight::force_on_node(mesh, node, x, cable.problem.body_force(time))
        - cable.problem.hung_on(support, time)
}

/// Stores the force of the cable on supports that hands hold, at balanced unknowns.
pub(in crate::model::fem) fn keep_forces(cable: &mut CableState, unknowns: &Unknowns) {
    for hand in &cable.input.inertial.hands {
        cable.answers.reaction[hand.node] = (unknowns.positions[hand.node] - hand.at) * hand.stiffness;
    }
}

/// The hands that drag supports.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct HandDrive {
    /// Greatest speed of a hand, m/s.
    pub(in crate::model::fem) hand_speed: f64,
    /// Stiffness of its spring, N/m, if the user gave one.
    pub(in crate::model::fem) hand_stiffness: Option<f64>,
    /// True for dragged supports that a hand holds by a spring.
    pub(in crate::model::fem) pulled: Vec<bool>,
    /// Working memory for the points to which hands drag supports in a piece of a step.
    pub(in crate::model::fem) hand_targets: Vec<Option<Vec2>>,
}

impl HandDrive {
    /// Moves hands and dragged supports for `h` (s) towards the points `dragged` (m); supports that
    /// the robot moves get there at the time `due` (s).
    pub(in crate::model::fem) fn follow(&self, cable: &mut CableState, due: f64, h: f64, dragged: &[Option<Vec2>]) {
        for (k, target) in dragged.iter().enumerate() {
            let (Some(target), Some(at)) = (*target, cable.support_position(k)) else { continue };
            let fastest = self.hand_speed;
            if is_led(&cable.problem, k) {
                let left = due - cable.motion.time;
                let f = cable.motion.followers[k].get_or_insert(SmoothedTarget::at_rest(at));
                f.lead(target, if left > h { h / left } else { 1.0 }, h);
                continue;
            }
            let node =
                cable.meshing.support_node[k].filter(|_| cable.problem.supports[k].holds_from(cable.motion.time));
            if let Some(node) = node.filter(|_| self.pulled[k]) {
                let known = cable.motion.hands[k];
                let mut hand = known.unwrap_or_else(|| {
                    Hand::grip(&cable.problem, self.hand_stiffness, at, holding_force(cable, k, node))
                });
                hand.follow(target, h, fastest);
                (cable.motion.hands[k], cable.motion.followers[k]) = (Some(hand), None);
            } else {
                let released = cable.motion.hands[k].take().and(node);
                let begins = || {
                    released.map_or(SmoothedTarget::at_rest(at), |node| {
                        SmoothedTarget::moving(at, cable.motion.velocities[node])
                    })
                };
                let mut f = cable.motion.followers[k].unwrap_or_else(begins);
                f.follow(target, h, fastest);
                cable.motion.followers[k] = Some(f);
            }
        }
    }

    /// Warnings of hands that lag, and of supports that lag behind them.
    pub(in crate::model::fem) fn warnings(&self, cable: &CableState) -> impl Iterator<Item = Warning> {
        cable.motion.hands.iter().enumerate().filter_map(|(k, hand)| {
            let (hand, node) = (hand.as_ref()?, cable.meshing.support_node[k]?);
            let fastest = self.hand_speed;
            let (at, force) = (cable.motion.positions[node], -cable.answers.reaction[node]);
            hand.warning(&cable.problem, k, cable.mesh.arc_length[node], at, force, fastest)
        })
    }
}

/// Reports the supports that did not reach their targets; their hands restart from the supports'
/// positions.
pub(in crate::model::fem) fn report_lagging_supports(cable: &mut CableState, unknowns: &Unknowns) {
    for (support, node) in cable.meshing.support_node.iter().enumerate() {
        let Some(k) = node.filter(|&k| cable.mesh.fixity[k]) else { continue };
        if unknowns.positions[k] != cable.input.supports.target[k] && !cable.answers.lagging_supports.contains(&support)
        {
            cable.answers.lagging_supports.push(support);
        }
        if let Some(f) = &mut cable.motion.followers[support]
            && f.position() != unknowns.positions[k]
        {
            f.stop_at(unknowns.positions[k]);
        }
    }
}
