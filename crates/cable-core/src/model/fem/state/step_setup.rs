//! The setup of a step collects forces, targets, inertia, damping and stick-slip states at an
//! instant.

use crate::math::Vec2;
use crate::model::fem::mesh::sliding_node::SlideOver;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::mesh::Mesh;
use crate::model::fem::system::step_input::Unknowns;
use crate::model::fem::system::{bar_weight, floor_friction};
use crate::model::input_filter::MAX_SPEED;
use crate::problem::Problem;
use crate::scene::SupportKind;

/// Factors of sliding nodes count as found when they change by less than this.
const SCALE_TOLERANCE: f64 = 1e-9;

/// Forces at a sliding node within this part of each other are equal: the law is read off bars,
/// whose tension is known to the residual only.
const EVEN_FORCE: f64 = 1e-7;

/// Comparison of unknowns with the friction of sliding nodes with which it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) struct StickSlipChanges {
    /// Nodes that hold where they should slip, or slip where they should hold.
    pub(in crate::model::fem) wrong: usize,
    /// True if what slips has the friction that belongs to its turn, as nearly as anyone sees.
    pub(in crate::model::fem) lawful: bool,
    /// True if nothing changed but by rounding.
    pub(in crate::model::fem) same: bool,
}

impl StickSlipChanges {
    /// Nothing slides.
    pub(in crate::model::fem) const FOUND: Self = Self { wrong: 0, lawful: true, same: true };

    /// True if the law holds at every sliding node.
    pub(in crate::model::fem) fn hold(self) -> bool {
        self.wrong == 0 && self.lawful
    }
}

/// Sets the input anew after a change of the mesh, for what is read off it between steps.
pub(in crate::model::fem) fn renew_input(cable: &mut CableState) {
    prepare_input(cable, cable.motion.time, None);
}

/// Sets held nodes, their targets and all forces for the time `to` (s); dragged supports go
/// where `dragged` says.
pub(in crate::model::fem) fn prepare_input(cable: &mut CableState, to: f64, dragged: Option<&[Option<Vec2>]>) {
    prepare_step(cable, [to, to], dragged);
}

/// The same for a step from one time to another (s): what holds at its start holds to its end.
pub(in crate::model::fem) fn prepare_step(
    cable: &mut CableState,
    [from, to]: [f64; 2],
    dragged: Option<&[Option<Vec2>]>,
) {
    cable.answers.stepped = None;
    let (problem, mesh, input) = (&cable.problem, &mut cable.mesh, &mut cable.input);
    let n = mesh.nodes();
    let body = problem.body_force(to);
    let gravity = if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
    input.body = body;
    input.to = to;
    input.force.clear();
    input.force.extend((0..n).map(|k| body * mesh.share(k)));
    for (node, force) in &cable.meshing.loads {
        input.force[*node] += force.at(to);
    }
    input.start.clone_from(&cable.motion.positions);
    input.target.clone_from(&cable.motion.positions);
    input.cleared.clear();
    input.hands.clear();
    mesh.held.fill(false);
    mesh.clamps.clear();
    for (k, (s, node)) in problem.supports.iter().zip(&cable.meshing.support_node).enumerate() {
        let Some(node) = *node else { continue };
        if s.kind == SupportKind::Pulley {
            continue;
        }
        if s.kind == SupportKind::Load {
            input.force[node] += s.force.at(to);
        }
        input.force[node] += gravity * s.mass;
        if s.holds_from(from)
            && let Some((at, _)) = s.place_at(to)
        {
            let drawn = dragged.and_then(|d| d.get(k).copied().flatten());
            let at = cable.motion.followers[k].map_or(drawn.unwrap_or(at), |f| f.position());
            // A support that was stopped and is free again catches up no faster than this
            // beyond its own motion, which is followed exactly.
            let own = s.place_at(from).map_or(0.0, |(before, _)| (at - before).norm());
            let most = if cable.motion.followers[k].is_some() { 0.0 } else { own } + MAX_SPEED * (to - from);
            let at = if to > from { within(cable.motion.positions[node], at, most) } else { at };
            // A support that a hand holds by a spring is a node that moves.
            if cable.motion.hands[k].is_none() {
                mesh.held[node] = true;
                input.target[node] = clear_way(problem, mesh, cable.motion.positions[node], at);
                if input.target[node] != at && !cable.answers.held_back.contains(&k) {
                    cable.answers.held_back.push(k);
                }
            }
            if let Some(angle) = s.angle
                && s.kind == SupportKind::Clamped
                && mesh.bending_stiffness > 0.0
            {
                let direction = Vec2::new(angle.cos(), angle.sin());
                mesh.clamps.push(crate::model::fem::system::mesh::Clamp { node, direction });
            }
        }
    }
    for (k, node) in mesh.sliding.iter_mut().enumerate() {
        let Some(node) = node else { continue };
        if let SlideOver::Pulley(support) = node.slide_over
            && let Some((at, _)) =
                problem.supports.get(support).filter(|s| s.holds_from(from)).and_then(|s| s.place_at(to))
        {
            let hand = dragged.and_then(|d| d.get(support).copied().flatten());
            let follower = cable.motion.followers.get(support).copied().flatten();
            node.end.center = follower.map_or(hand.unwrap_or(at), |f| f.position());
            cable.motion.positions[k] = node.position();
            input.start[k] = cable.motion.positions[k];
        }
    }
    input.may_lag = to > from;
    input.outlined = cable.outline.is_some();
    input.max_iterations = mesh.tuning.step.max_iterations;
    input.max_move = mesh.tuning.newton.max_move_m;
    input.moves = false;
    input.shift = 0.0;
    input.loss.clear();
    input.loss.resize(mesh.rest_length.len(), [0.0; 2]);
    input.bending_damping = 0.0;
    input.most_noise = f64::INFINITY;
    input.inertia.clear();
    input.inertia.resize(n, 0.0);
    input.predicted.clone_from(&cable.motion.positions);
    input.coupling.clear();
    input.predicted_length.clear();
    input.predicted_length.extend_from_slice(&mesh.rest_length);
    input.predicted_slide.clear();
    input.predicted_slide.resize(n, 0.0);
    cable.input.set_scale(&cable.mesh);
    let x = std::mem::take(&mut cable.motion.positions);
    floor_friction::renew_limits(&mut cable.input.floor_limit, &cable.problem, &cable.mesh, &x, None);
    for k in 1..n.saturating_sub(1) {
        if cable.mesh.sliding[k].is_some() {
            let lying = bar_weight::parts_that_lie(&cable.mesh, k, &x, cable.input.body);
            if let Some(node) = &mut cable.mesh.sliding[k] {
                node.lying_fractions = lying;
            }
        }
    }
    cable.motion.positions = x;
}

/// Reads turn and grip of every sliding node off unknowns and says how that differs from what
/// the unknowns was found with. Where `one` is set only the first of the grips that are wrong
/// is changed, and turns half of the way: nearly slack bars hang from a round, and turn over it
/// by the more the less they pull.
///
/// A node that slid the wrong way until its grip was seen to be wrong has not slid at all.
pub(in crate::model::fem) fn update_grips(
    cable: &mut CableState,
    unknowns: &mut Unknowns,
    one: bool,
) -> StickSlipChanges {
    if cable.meshing.never_slides {
        return StickSlipChanges::FOUND;
    }
    let mut grips = StickSlipChanges {
        same: !floor_friction::renew_limits(
            &mut cable.input.floor_limit,
            &cable.problem,
            &cable.mesh,
            &unknowns.positions,
            Some(&unknowns.slides),
        ),
        ..StickSlipChanges::FOUND
    };
    for k in 0..cable.mesh.nodes() {
        let (Some(node), Some(load)) =
            (cable.mesh.sliding[k], cable.step_context().load_at(k, &unknowns.positions, Some(&unknowns.slides)))
        else {
            continue;
        };
        if !(node.friction > 0.0) {
            continue;
        }
        let mut next = node;
        // Bars that do not pull press on nothing, and what would push where it leaves has no
        // tension that friction could raise.
        let presses = load.turn > 0.0 && load.pull[0] + load.pull[1] > 0.0 && load.pull[1] > 0.0;
        let exponent = if presses { node.friction * load.turn } else { 0.0 };
        next.exponent = if one { 0.5 * (node.exponent + exponent) } else { exponent };
        let inertia = cable.input.inertia[k] * (unknowns.slides[k] - cable.input.predicted_slide[k]);
        let pulls = load.pull[0].abs() + load.pull[1].abs();
        let slack = cable.input.tolerance + EVEN_FORCE * pulls;
        let stiffness = cable.mesh.axial_stiffness;
        let grip = load.grip(&next, unknowns.slides[k], [inertia, slack], stiffness);
        if grip != node.grip {
            grips.wrong += 1;
            if !one || grips.wrong == 1 {
                next.grip = grip;
            }
        }
        next.factor = load.factor(next.grip, next.exponent, stiffness);
        let floor = floor_friction::reaches(&cable.mesh, k, &unknowns.positions, Some(&unknowns.slides));
        next.floor_factor = floor_friction::factor(floor, load.ratio(next.grip, next.exponent));
        if next.sticks() && !node.sticks() {
            unknowns.slides[k] = 0.0;
        }
        let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SCALE_TOLERANCE;
        grips.same &= same(next.factor, node.factor) && same(next.floor_factor, node.floor_factor);
        let off = ((load.factor(node.grip, exponent, stiffness) - node.factor) * load.pull[1]).abs();
        grips.lawful &= off <= cable.mesh.tuning.step.grip_tolerance * pulls * exponent + slack;
        cable.mesh.sliding[k] = Some(next);
    }
    cable.input.set_scale(&cable.mesh);
    grips
}

/// The point on the way from `from` towards `to` that is at most `most` (m) away.
fn within(from: Vec2, to: Vec2, most: f64) -> Vec2 {
    let (way, distance) = (to - from, (to - from).norm());
    if distance > most { from + way * (most / distance) } else { to }
}

/// Rounding of a gap, m.
const GAP_ROUNDING: f64 = 1e-9;

/// The target of a held node, stopped where an obstacle is in its way (m).
pub(in crate::model::fem) fn clear_way(problem: &Problem, mesh: &Mesh, from: Vec2, to: Vec2) -> Vec2 {
    if problem.world.is_empty() || from == to {
        return to;
    }
    let least_gap = mesh.tuning.step.support_gap_reaches * mesh.tuning.contact.reach_m;
    let gap = |p: Vec2| problem.world.signed_gap(p, least_gap).map_or(least_gap, |g| g.gap_m);
    // A support that the scene puts on a surface may stay on it; none may come nearer than it
    // stands.
    let least = gap(from) - GAP_ROUNDING;
    let free = problem.world.free_fraction([from, from], [to, to], mesh.tuning.step.kept_support_gap_fraction);
    let mut part = if free >= 1.0 { 1.0 } else { free };
    for _ in 0..mesh.tuning.step.stand_off_tries {
        let at = if part >= 1.0 { to } else { from + (to - from) * part };
        if gap(at) >= least {
            return at;
        }
        part *= 0.5;
    }
    from
}
