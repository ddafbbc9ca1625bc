//! This module reports the position of each support and the force of the cable on it.

use crate::math::Vec2;
use crate::model::fem::mesh::SlideOver;
use crate::model::fem::results::forces::{half, tension_beside_round};
use crate::model::fem::state::CableState;
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;
use crate::solution::SupportReaction;

/// The force of the cable on a pulley, with its tensions and its arc length.
fn pulley(d: &CableState, support: usize, x: &[Vec2], tension: &[f64]) -> Option<SupportReaction> {
    let slide_over = SlideOver::Pulley(support);
    let on = |k: &usize| d.mesh.sliding[*k].is_some_and(|s| s.slide_over == slide_over);
    let first = (1..x.len() - 1).find(on)?;
    let last = (1..x.len() - 1).rev().find(on)?;
    let (before, after) = (d.load(first)?, d.load(last)?);
    let inner = d.mesh.arc_length[last] - d.mesh.arc_length[first];
    let share = half(d, first, 0, x) + inner + half(d, last, 1, x);
    let directions = [d.mesh.direction(first - 1, x), d.mesh.direction(last, x)];
    let momentum_flux = d.mesh.sliding[first].and_then(|node| node.balanced).map_or(0.0, |b| b.momentum_flux);
    let force = directions[1] * (tension[last] - momentum_flux) - directions[0] * (tension[first - 1] - momentum_flux)
        + d.input.loads.body * share
        + (first..=last).map(|k| d.input.loads.on_round(k)).sum::<Vec2>();
    let center = d.mesh.sliding[first]?.end.center;
    Some(SupportReaction {
        name: d.problem.supports.get(support)?.name.clone(),
        x_m: center.x,
        y_m: center.y,
        reaction_x_n: force.x,
        reaction_y_n: force.y,
        arc_length_m: 0.5 * (d.mesh.arc_length[first] + d.mesh.arc_length[last]),
        tension_before_n: Some(tension_beside_round(d, first, &before, 0, x)),
        tension_after_n: Some(tension_beside_round(d, last, &after, 1, x)),
        hand: None,
    })
}

/// A pulley that has let go of the cable, or a support that the cable was torn off, at its place;
/// None for any other.
fn released(d: &CableState, support: usize, x: &[Vec2]) -> Option<SupportReaction> {
    let torn_off = |s: &SupportPoint| s.kind != SupportKind::Pulley;
    let s = d.problem.supports.get(support).filter(|s| torn_off(s) || !s.holds_from(d.time()))?;
    let at = s.place_at(d.time()).map(|place| place.0).or(s.at)?;
    let nearest = (0..x.len()).min_by(|&i, &j| (x[i] - at).norm().total_cmp(&(x[j] - at).norm()))?;
    Some(SupportReaction {
        name: s.name.clone(),
        x_m: at.x,
        y_m: at.y,
        arc_length_m: d.mesh.arc_length[nearest],
        ..SupportReaction::default()
    })
}

/// The reactions of all supports, in their order.
pub(super) fn supports(d: &CableState, x: &[Vec2], ends: &[Vec2; 2], tension: &[f64]) -> Vec<SupportReaction> {
    let problem: &Problem = &d.problem;
    problem
        .supports
        .iter()
        .zip(&d.meshing.support_node)
        .enumerate()
        .filter_map(|(k, (s, node))| {
            let Some(node) = *node else {
                return pulley(d, k, x, tension).or_else(|| released(d, k, x));
            };
            let last = x.len() - 1;
            let on_ground = problem.world.signed_gap(x[node], 3.0 * d.contacts.barrier.reach).is_some();
            let hand = d.motion.hands[k];
            let reaction = match node {
                _ if hand.is_some() => d.answers.reaction[node],
                // At a dead load the reaction is minus the load; a moving point mass may pull by
                // more. The ground carries a part of a load that lies on it, and that part is in
                // the contact's report.
                _ if !d.mesh.fixity[node] && on_ground => -problem.hung_on(k, d.time()),
                0 if !d.mesh.fixity[node] => ends[0],
                k if k == last && !d.mesh.fixity[node] => -ends[1],
                _ if !d.mesh.fixity[node] => -problem.hung_on(k, d.time()),
                // On the ground the end's own share of weight and friction acts on the ground, not
                // on the support.
                0 if on_ground => ends[0],
                k if k == last && on_ground => -ends[1],
                _ => d.answers.reaction[node],
            };
            Some(SupportReaction {
                name: s.name.clone(),
                x_m: x[node].x,
                y_m: x[node].y,
                reaction_x_n: reaction.x,
                reaction_y_n: reaction.y,
                arc_length_m: d.mesh.arc_length[node],
                hand: hand.map(|hand| hand.report(-reaction)),
                ..SupportReaction::default()
            })
        })
        .collect()
}
