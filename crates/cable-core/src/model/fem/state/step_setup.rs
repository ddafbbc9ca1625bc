//! This module sets up a step: forces, targets of supports, and wheels at an instant.

use crate::math::Vec2;
use crate::model::fem::mesh::{Clamp, SlideOver};
use crate::model::fem::state::cable_state::CableState;
use crate::model::fem::state::support_stop::{no_farther_than, stopped_by_obstacles};
use crate::model::fem::system::contact::floor_friction;
use crate::model::fem::system::{RoundLoad, bar_weight};
use crate::model::smoothed_target::MAX_SPEED;
use crate::scene::SupportKind;

/// Renews the input after a change of the mesh, for code that reads it between steps.
pub(in crate::model::fem) fn renew_input(cable: &mut CableState) {
    prepare_input(cable, cable.motion.time, None);
}

/// Sets held nodes, their targets and all forces for the time `to` (s); dragged supports go to the
/// points `dragged` (m).
pub(in crate::model::fem) fn prepare_input(cable: &mut CableState, to: f64, dragged: Option<&[Option<Vec2>]>) {
    prepare_step(cable, [to, to], dragged);
}

/// Sets up a step from one time to another (s): a support that holds the cable at its start holds
/// it to its end.
pub(in crate::model::fem) fn prepare_step(
    cable: &mut CableState,
    [from, to]: [f64; 2],
    dragged: Option<&[Option<Vec2>]>,
) {
    cable.answers.stepped = None;
    set_forces(cable, to);
    let (mesh, input) = (&mut cable.mesh, &mut cable.input);
    input.supports.start.clone_from(&cable.motion.positions);
    input.supports.target.clone_from(&cable.motion.positions);
    input.supports.cleared.clear();
    input.inertial.hands.clear();
    mesh.fixity.fill(false);
    mesh.clamps.clear();
    let dragged_to = |support: usize| dragged.and_then(|d| d.get(support).copied().flatten());
    for support in 0..cable.problem.supports.len() {
        set_support(cable, support, [from, to], dragged_to(support));
    }
    set_wheels(cable, [from, to], dragged_to);
    cable.input.supports.may_lag = to > from;
    clear_inertia_and_loss(cable);
    cable.input.set_scale(&cable.mesh);
    set_weight_on_rounds(cable);
}

/// Sets the forces on nodes at a time (s): weight, wind and point loads.
fn set_forces(cable: &mut CableState, to: f64) {
    let input = &mut cable.input;
    let body = cable.problem.body_force(to);
    input.loads.body = body;
    input.loads.time_s = to;
    input.loads.force.clear();
    input.loads.force.extend((0..cable.mesh.nodes()).map(|k| body * cable.mesh.tributary_length(k)));
    input.loads.on_rounds.clear();
    for load in &cable.meshing.loads {
        let force = load.force.at(to);
        match load.way_on_round(&cable.mesh, &cable.motion.positions) {
            Some((way, side)) => input.loads.on_rounds.push(RoundLoad { node: load.node, force, way, side }),
            None => input.loads.force[load.node] += force,
        }
    }
}

/// Sets the loads and the target of the node of a support other than a pulley. A dragged one
/// follows its hand.
fn set_support(cable: &mut CableState, support: usize, [from, to]: [f64; 2], dragged: Option<Vec2>) {
    let (problem, mesh, input) = (&cable.problem, &mut cable.mesh, &mut cable.input);
    let gravity = problem.gravity();
    let (Some(s), Some(Some(node))) = (problem.supports.get(support), cable.meshing.support_node.get(support)) else {
        return;
    };
    let node = *node;
    if s.kind == SupportKind::Pulley {
        return;
    }
    if s.kind == SupportKind::Load {
        input.loads.force[node] += s.force.at(to);
    }
    input.loads.force[node] += gravity * s.mass;
    let Some((at, _)) = s.place_at(to).filter(|_| s.holds_from(from)) else { return };
    let follower = cable.motion.followers[support];
    let at = follower.map_or(dragged.unwrap_or(at), |f| f.position());
    // A support that was stopped and is free again follows its own motion exactly, and catches up
    // at no more than this speed beyond it.
    let own = s.place_at(from).map_or(0.0, |(before, _)| (at - before).norm());
    let most = if follower.is_some() { 0.0 } else { own } + MAX_SPEED * (to - from);
    let at = if to > from { no_farther_than(cable.motion.positions[node], at, most) } else { at };
    // A support that a hand holds by a spring is a free node.
    if cable.motion.hands[support].is_none() {
        mesh.fixity[node] = true;
        input.supports.target[node] = stopped_by_obstacles(problem, mesh, cable.motion.positions[node], at);
        if input.supports.target[node] != at && !cable.answers.lagging_supports.contains(&support) {
            cable.answers.lagging_supports.push(support);
        }
    }
    if let Some(angle) = s.angle
        && s.kind == SupportKind::Clamped
        && mesh.bending_stiffness > 0.0
    {
        let direction = Vec2::new(angle.cos(), angle.sin());
        mesh.clamps.push(Clamp { node, direction });
    }
}

/// Moves the wheels of pulleys, with the nodes that slide over them and their history: a wheel
/// gives its node no velocity along the cable.
fn set_wheels(cable: &mut CableState, [from, to]: [f64; 2], dragged_to: impl Fn(usize) -> Option<Vec2>) {
    let mesh = &cable.mesh;
    let is_wheel = |k: usize| mesh.sliding[k].as_ref().is_some_and(|s| matches!(s.slide_over, SlideOver::Pulley(_)));
    let beside = (0..mesh.rest_length.len()).filter(|&e| is_wheel(e) || is_wheel(e + 1));
    let lengths = &mut cable.input.losses.lengths_at_wheels;
    lengths.clear();
    cable.input.supports.wheel_velocities.clear();
    lengths.extend(beside.map(|e| (e, mesh.path(e, &cable.motion.positions).length)));
    for (k, node) in cable.mesh.sliding.iter_mut().enumerate() {
        let Some(node) = node else { continue };
        let SlideOver::Pulley(support) = node.slide_over else { continue };
        let holding = cable.problem.supports.get(support).filter(|s| s.holds_from(from));
        let Some(own) = holding.and_then(|s| s.place_at(to)) else { continue };
        let follower = cable.motion.followers.get(support).copied().flatten();
        let (at, velocity) = match (follower, dragged_to(support)) {
            (Some(follower), _) => (follower.position(), follower.velocity()),
            (None, Some(hand)) => (hand, Vec2::zeros()),
            (None, None) => own,
        };
        node.end.center = at;
        cable.input.supports.wheel_velocities.push((k, velocity));
        cable.motion.shift(k, node.position() - cable.motion.positions[k]);
        cable.input.supports.start[k] = cable.motion.positions[k];
    }
}

/// Clears inertia, damping and resistance from the input.
fn clear_inertia_and_loss(cable: &mut CableState) {
    let (mesh, input) = (&cable.mesh, &mut cable.input);
    let n = mesh.nodes();
    input.supports.has_moving_bodies = cable.problem.has_moving_bodies();
    input.stopping.max_iterations = mesh.tuning.step.max_iterations;
    input.stopping.max_move = mesh.tuning.newton.max_move_m;
    input.inertial.moves = false;
    input.stopping.shift = 0.0;
    input.losses.bars.clear();
    input.losses.bars.resize(mesh.rest_length.len(), [0.0; 2]);
    input.losses.bending = [0.0; 2];
    input.stopping.max_noise = f64::INFINITY;
    input.inertial.stiffness.clear();
    input.inertial.stiffness.resize(n, 0.0);
    input.inertial.predicted.clone_from(&cable.motion.positions);
    input.inertial.coupling.clear();
    input.losses.predicted_length.clear();
    input.losses.predicted_length.extend_from_slice(&mesh.rest_length);
    input.losses.damped_from.clone_from(&mesh.rest_length);
    input.inertial.predicted_slide.clear();
    input.inertial.predicted_slide.resize(n, 0.0);
    input.inertial.momentum_flux.clear();
    input.inertial.momentum_flux.resize(n, 0.0);
}

/// Sets the greatest friction of a rough floor, and the fraction of the bars' weight that rests on
/// the rounds beside them.
fn set_weight_on_rounds(cable: &mut CableState) {
    let x = std::mem::take(&mut cable.motion.positions);
    let limits = &mut cable.input.loads.floor_limit;
    floor_friction::renew_limits(limits, &cable.problem, &cable.mesh, &cable.meshing.support_node, &x, None);
    for k in 1..cable.mesh.nodes().saturating_sub(1) {
        if cable.mesh.sliding[k].is_some() {
            let lying = bar_weight::lying_fractions_beside(&cable.mesh, k, &x, cable.input.loads.body);
            if let Some(node) = &mut cable.mesh.sliding[k] {
                node.lying_fractions = lying;
            }
        }
    }
    cable.motion.positions = x;
}
