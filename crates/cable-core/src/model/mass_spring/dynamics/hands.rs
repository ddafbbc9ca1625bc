//! Hands that hold supports by springs. The node is held, at the velocity that its own mass has
//! between the cable and the spring: that is taken at the end of the sub-step, so no spring is too
//! stiff for it.

use crate::model::hand::Hand;
use crate::model::mass_spring::dynamics::SubStep;
use crate::model::mass_spring::dynamics::momentum::MomentumSums;
use crate::model::mass_spring::dynamics::supports::{HandSettings, SupportDrives};
use crate::model::mass_spring::forces::reactions;
use crate::model::mass_spring::mesh::Mesh;
use crate::solution::Warning;

/// Moves the free ends of all hands that hold supports on for `h` (s).
pub(in crate::model::mass_spring) fn follow(drives: &mut SupportDrives, mesh: &Mesh, settings: HandSettings, h: f64) {
    for k in 0..drives.by_spring.len() {
        let node = mesh.support_node[k];
        let (true, true, Some(target)) = (drives.by_spring[k], mesh.supported[node], drives.targets[k]) else {
            continue;
        };
        let mut hand = drives.hands[k].unwrap_or_else(|| {
            Hand::grip(&mesh.problem, settings.stiffness_n_per_m, mesh.position[node], -mesh.force[node])
        });
        hand.follow(target, h, settings.max_speed_m_per_s);
        (drives.hands[k], drives.smoothed[k]) = (Some(hand), None);
    }
}

/// Sets the velocities of nodes that hands hold after the kick of a sub-step; the spring is as at
/// its end.
pub(in crate::model::mass_spring) fn pull(
    drives: &SupportDrives,
    mesh: &mut Mesh,
    account: &mut MomentumSums,
    SubStep { length_s: h, kick_s: kick }: SubStep,
) {
    for (hand, &node) in drives.hands.iter().zip(&mesh.support_node) {
        let Some(hand) = hand else { continue };
        let (mass, before) = (mesh.mass[node], mesh.velocity[node]);
        let (stiffness, at) = hand.pull(h, mesh.position[node]);
        let push = mesh.force[node] + (at - mesh.position[node]) * stiffness;
        let v = (before * mass + push * kick) / (mass + stiffness * h * kick);
        mesh.support_acceleration[node] = (v - before) / kick;
        account.supports += (v - before) * mass;
        mesh.velocity[node] = v;
    }
}

/// Warnings of hands that lag, and of supports that lag behind them.
pub(in crate::model::mass_spring) fn warnings(
    drives: &SupportDrives,
    mesh: &Mesh,
    max_speed_m_per_s: f64,
) -> Vec<Warning> {
    let hands = drives.hands.iter().enumerate().filter_map(|(k, hand)| Some((k, hand.as_ref()?)));
    let warning = |(k, hand): (usize, &Hand)| {
        let node = mesh.support_node[k];
        let force = -reactions::of_support(mesh, node);
        hand.warning(&mesh.problem, k, mesh.arc_length[node], mesh.position[node], force, max_speed_m_per_s)
    };
    hands.filter_map(warning).collect()
}
