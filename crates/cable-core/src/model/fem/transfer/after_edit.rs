//! This module continues a cable after an edit of its scene, on the same mesh, divided anew for
//! other segments, and with all that it remembers: its history, its loss, and its friction.
//!
//! A mesh of its own, on which the cable would be laid anew, has nodes elsewhere and bars of other
//! strains: an edit of nothing pulled a cable drawn over a beam with 83 N for 108 N, and one round
//! posts with 10 N for 18 N.

use crate::contact::geometry::{Body, Geometry};
use crate::math::{Vec2, perp};
use crate::model::bending_change::BendingChange;
use crate::model::fem::first_shape::depenetrate;
use crate::model::fem::mesh::{BarEnd, PUSHED_OUT_REACHES, SlideOver, SlidingNode, round_of};
use crate::model::fem::obstacle::{IntersectionCheck, place_bodies};
use crate::model::fem::remesh::{StretchedBars, even_out, insert, make_material_at_tangents};
use crate::model::fem::state::{CableState, NodalMotion, renew_input};
use crate::model::length_change::LengthChange;
use crate::model::material_loss::Rubbing;
use crate::model::smoothed_target::{STILL_M_PER_S, SmoothedTarget};
use crate::problem::{MovingPost, PointLoad, Problem, SupportPoint};

/// Greatest way that an obstacle put elsewhere takes a node along, in even bars: beyond it the
/// cable is laid on the edited scene anew. Smaller: more edits of obstacles forget the history;
/// larger: a cable is stretched by a long way at once. A choice, tuned on no campaign.
const MAX_WAY_BARS: f64 = 1.0;
/// Distance from an obstacle from which a node does not lie on it, in reaches of the barrier.
const FREE_REACHES: f64 = 2.0;
/// Turn at a node from which the cable counts as folded there, rad. Larger: new nodes beside a fold
/// lie far from the bars; smaller: those of coarse meshes lie on the bars, and fall. A choice,
/// tuned on no campaign.
const MAX_CURVED_TURN_RAD: f64 = 0.5;
/// Part of the cable's length by which two places of a support, or of a corner, differ by rounding.
const SAME_PLACE_FRACTION: f64 = 1e-9;

/// The connection of a support with what draws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::fem) enum SupportDrag {
    Nothing,
    /// It goes where it is sent.
    Rigid,
    /// A hand pulls it by a spring.
    Spring,
}

impl SupportDrag {
    /// That of a support with a target, or none.
    pub(in crate::model::fem) fn of(target: Option<Vec2>, by_spring: bool) -> Self {
        match (target, by_spring) {
            (None, _) => Self::Nothing,
            (Some(_), false) => Self::Rigid,
            (Some(_), true) => Self::Spring,
        }
    }
}

/// The obstacles before and after an edit.
struct EditedObstacles<'a> {
    before: &'a Geometry,
    after: &'a Geometry,
}

impl<'a> EditedObstacles<'a> {
    /// The obstacle and the feature after the edit that a feature was before; None if the obstacle
    /// is gone, or is drawn with another number of points.
    fn feature(&self, feature: usize) -> Option<(usize, usize)> {
        let old = self.before.body_of(feature)?;
        let of_name = |geometry: &'a Geometry| geometry.bodies().iter().filter(|body| body.name == old.name);
        let place = of_name(self.before).position(|body| body.first == old.first)?;
        let new = of_name(self.after).nth(place)?;
        let same = new.edges.len() == old.edges.len() && new.moves() == old.moves();
        same.then(|| (new.obstacle, feature - old.first + new.first))
    }

    /// True if a post that moves is wider after the edit.
    fn widens_posts(&self) -> bool {
        let posts = self.after.bodies().iter().filter(|body| body.moves() && body.center.is_some());
        let was = |new: &Body| self.before.bodies().iter().find(|old| old.moves() && old.name == new.name);
        posts.into_iter().any(|new| was(new).is_none_or(|old| new.offset > old.offset))
    }

    /// True if every obstacle of the scene after the edit was there, in the same place.
    fn adds_nothing(&self) -> bool {
        let was_there = |new: &Body| self.before.bodies().iter().any(|old| old.is_where(new));
        self.after.bodies().iter().all(|new| new.moves() || was_there(new))
    }
}

/// True if two cables are divided at the same places of supports and loads, which hold them alike.
fn are_divided_alike(a: &CableState, b: &CableState) -> bool {
    let [p, q] = [&a.problem, &b.problem];
    let now = b.motion.time;
    // A longer cable is longer everywhere.
    let longer = p.length / q.length;
    let same_place = |s: f64, t: f64| (s - t * longer).abs() <= SAME_PLACE_FRACTION * p.length;
    let support = |(s, t): (&SupportPoint, &SupportPoint)| {
        s.kind == t.kind
            && match (s.arc_length, t.arc_length) {
                (Some(s), Some(t)) => same_place(s, t),
                // A wheel that was moved is led there, if it has no motion of its own.
                (None, None) => s.motion.is_none() && t.motion.is_none() || s.place_at(now) == t.place_at(now),
                _ => false,
            }
            && s.side == t.side
            && s.departure == t.departure
            && s.holds_from(now) == t.holds_from(now)
    };
    let load = |(s, t): (&PointLoad, &PointLoad)| same_place(s.arc_length, t.arc_length);
    p.supports.len() == q.supports.len()
        && p.supports.iter().zip(&q.supports).all(support)
        && p.loads.len() == q.loads.len()
        && p.loads.iter().zip(&q.loads).all(load)
}

/// True if the cable `a` is to have another number of bars than `b`. A number that
/// nobody gives goes with the length.
fn has_other_bars(a: &CableState, b: &CableState) -> bool {
    let same_length = a.problem.length == b.problem.length;
    a.meshing.even_bars != b.meshing.even_bars && (same_length || a.problem.cable.segments != b.problem.cable.segments)
}

/// True if the mesh of the cable `b` can serve for `a`: its mass is lumped if that of `a` is, and
/// both have bending or none, or `a` gets one while it moves.
fn can_share_a_mesh(a: &CableState, b: &CableState) -> bool {
    (b.mesh.spread.is_lumped() || !a.mesh.spread.is_lumped())
        && (a.mesh.is_flexible() == b.mesh.is_flexible() || b.mesh.is_flexible() && moves(b))
        && meet_alike(a, b)
}

/// True if both cables meet themselves or do not, and have the same outline of a robot, and the
/// friction of a floor or none.
fn meet_alike(a: &CableState, b: &CableState) -> bool {
    a.problem.cable.self_contact == b.problem.cable.self_contact
        && have_same_outline(&a.problem, &b.problem)
        && have_same_posts(&a.problem, &b.problem, b.motion.time)
        && a.problem.floor_friction.is_some() == b.problem.floor_friction.is_some()
}

/// True if the cable `a` is `b` without its bending stiffness, which `b` has while it moves, and
/// what else was edited puts nothing in its way.
pub(in crate::model::fem) fn loses_bending(a: &CableState, b: &CableState) -> bool {
    let edited = EditedObstacles { before: b.problem.world.geometry(), after: a.problem.world.geometry() };
    a.mesh.is_flexible()
        && !b.mesh.is_flexible()
        && moves(b)
        && a.problem.length == b.problem.length
        && b.mesh.breaks().next().is_none()
        && are_divided_alike(a, b)
        && meet_alike(a, b)
        && edited.adds_nothing()
}

/// True if the cable does not lie still.
fn moves(cable: &CableState) -> bool {
    cable.motion.velocities.iter().any(|v| v.norm() > STILL_M_PER_S)
}

/// True if the robots of two problems have the same outline, or none.
fn have_same_outline(a: &Problem, b: &Problem) -> bool {
    match (&a.outline, &b.outline) {
        (Some(a), Some(b)) => a.is_shaped_like(b),
        (None, None) => true,
        _ => false,
    }
}

/// True if the posts of two problems that move are as many, and in the same places at a time (s).
fn have_same_posts(a: &Problem, b: &Problem, time_s: f64) -> bool {
    let same = |(a, b): (&MovingPost, &MovingPost)| a.center_at(time_s) == b.center_at(time_s);
    a.moving_posts.len() == b.moving_posts.len() && a.moving_posts.iter().zip(&b.moving_posts).all(same)
}

/// The cable `old`, moving in the scene before an edit, in that of `new`. None if the edit concerns
/// its mesh, or an obstacle now stands where the cable is.
pub(in crate::model::fem) fn after_edit(
    old: &CableState,
    new: &CableState,
    drags: &[SupportDrag],
) -> Option<CableState> {
    if !are_divided_alike(new, old) || !can_share_a_mesh(new, old) || old.mesh.breaks().next().is_some() {
        return None;
    }
    // A cable that rubs on nothing has no memory that another mesh would lose.
    let other_bars = has_other_bars(new, old);
    if other_bars && old.rubbing() == Rubbing::Never {
        return None;
    }
    let mut cable = old.clone();
    cable.problem = new.problem.clone();
    drag_supports(&mut cable, drags);
    change_length(&mut cable, old.problem.length);
    change_bending_stiffness(&mut cable);
    cable.loss = new.loss.clone();
    if new.loss != old.loss {
        cable.mesh.branch_forces.clear();
        cable.mesh.branch_moments.clear();
    }
    adopt_material(&mut cable, new);
    if let (Some(outline), Some(edited)) = (&mut cable.outline, &new.outline) {
        outline.obstacle = edited.obstacle;
        outline.shape.clone_from(&edited.shape);
    }
    place_bodies(&mut cable);
    let (stretched_before, mut was_moved) = (StretchedBars::of(&cable), false);
    let edited = EditedObstacles { before: old.problem.world.geometry(), after: new.problem.world.geometry() };
    cable.contacts.change_features(|feature| edited.feature(feature));
    for k in 0..cable.mesh.nodes() {
        let Some(node) = cable.mesh.sliding[k] else { continue };
        let now = on_edited_obstacle([old, &cable], node, &edited);
        if let Some(now) = now {
            let way = now.position() - node.position();
            if way.norm() > MAX_WAY_BARS * cable.even() {
                return None;
            }
            was_moved |= way.norm() > SAME_PLACE_FRACTION * new.problem.length;
            cable.motion.shift(k, way);
        }
        cable.mesh.sliding[k] = now;
    }
    let adds = !edited.adds_nothing() || edited.widens_posts();
    if adds && is_inside_something(&cable) {
        push_out(&mut cable)?;
        was_moved = true;
    }
    if was_moved {
        stretched_before.restore(&mut cable);
    }
    // Nodes of a cable that can meet itself neither come nor go.
    if other_bars && !cable.contacts.self_contacts.shape.is_on() {
        (cable.meshing.even_bars, cable.meshing.bar_weight) = (new.meshing.even_bars, new.meshing.bar_weight);
        divide_anew(&mut cable);
    }
    if adds && is_inside_something(&cable) {
        return None;
    }
    // The momentum that an edit gives is not an impulse of obstacles.
    let account = &old.motion.account;
    (cable.motion.account.sum, cable.motion.account.late) = (account.sum, account.late);
    let x = std::mem::take(&mut cable.motion.positions);
    cable.contacts.prepare(&cable.problem, &cable.mesh, &x, &x);
    cable.motion.positions = x;
    renew_input(&mut cable);
    Some(cable)
}

/// Pushes a cable out of posts that were put where it lies, with the stretch of its bars; returns
/// whether it is clear of all then.
pub(in crate::model::fem) fn stand_clear(cable: &mut CableState) -> bool {
    if !is_inside_something(cable) {
        return true;
    }
    let stretched_before = StretchedBars::of(cable);
    let is_out = push_out(cable).is_some();
    stretched_before.restore(cable);
    let x = std::mem::take(&mut cable.motion.positions);
    cable.contacts.prepare(&cable.problem, &cable.mesh, &x, &x);
    cable.motion.positions = x;
    is_out && !is_inside_something(cable)
}

fn is_inside_something(cable: &CableState) -> bool {
    let check = IntersectionCheck::of(cable);
    check.refuse_buried().is_err() || !check.cuts_nothing()
}

/// Pushes the nodes of the material out of obstacles that were put there, with their history; None
/// if one would go farther than a bar.
fn push_out(cable: &mut CableState) -> Option<()> {
    let mut pushed = cable.motion.positions.clone();
    depenetrate(&cable.problem, &cable.mesh, &mut pushed, PUSHED_OUT_REACHES * cable.contacts.barrier.reach);
    for (k, to) in pushed.into_iter().enumerate() {
        let way = to - cable.motion.positions[k];
        if way.norm() > MAX_WAY_BARS * cable.even() {
            return None;
        }
        if cable.mesh.sliding[k].is_none() {
            cable.motion.shift(k, way);
        }
    }
    Some(())
}

/// Lets supports that are drawn begin where they are, as fast as they are.
fn drag_supports(cable: &mut CableState, drags: &[SupportDrag]) {
    for (k, drag) in drags.iter().enumerate() {
        let begins = || {
            let at = cable.support_position(k)?;
            let held_by_hand = cable.motion.hands[k].and(cable.meshing.support_node[k]);
            Some(match held_by_hand {
                Some(node) => SmoothedTarget::moving(at, cable.motion.velocities[node]),
                None => SmoothedTarget::at_rest(at),
            })
        };
        let follower = cable.motion.followers[k].filter(|_| *drag != SupportDrag::Nothing);
        let follower = if *drag == SupportDrag::Rigid { follower.or_else(begins) } else { follower };
        cable.motion.followers[k] = follower;
        cable.motion.hands[k] = cable.motion.hands[k].filter(|_| *drag == SupportDrag::Spring);
    }
}

/// Lets a cable that was `before_m` long (m) begin to change its length to that of its problem, and
/// its temperature.
fn change_length(cable: &mut CableState, before_m: f64) {
    let longer = cable.problem.length / before_m;
    if longer != 1.0 {
        cable.mesh.scale_arc_lengths(longer);
        let NodalMotion { previous_arc_length: before, slide_rates, previous_slide_rates, .. } = &mut cable.motion;
        before.iter_mut().chain(slide_rates).chain(previous_slide_rates).for_each(|s| *s *= longer);
    }
    if cable.mesh.thermal_stretch != cable.problem.thermal_stretch {
        let begins = || LengthChange::from(cable.mesh.thermal_stretch * cable.problem.length);
        cable.motion.length_change = Some(cable.motion.length_change.unwrap_or_else(begins));
    }
}

/// Lets the bending stiffness begin to change to that of the problem.
fn change_bending_stiffness(cable: &mut CableState) {
    let (from, to) = (cable.mesh.bending_stiffness, cable.problem.bending_stiffness);
    let change = BendingChange::between(from, to);
    cable.motion.bending_change = Some(change).filter(|change| !change.is_over());
    cable.mesh.bending_stiffness = change.stiffness();
    if to > from {
        let now = StretchedBars::of(cable);
        // Bars that were slack push from now on; they have no tension at first.
        resolve_bends(cable, to, &if from == 0.0 { now.without_slack() } else { now });
    }
}

/// Turns the sliding nodes that would neglect visible bends of a stiffness (N·m²) into nodes of the
/// material. The bars keep the stretch that they had before.
fn resolve_bends(cable: &mut CableState, stiffness: f64, stretched_before: &StretchedBars) {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    // Of several nodes on a round, each that is changed stretches the bar to the next.
    let neglects_bend = |&k: &usize| {
        let slides = |node: SlidingNode| matches!(node.slide_over, SlideOver::Obstacle { .. });
        let tension = mesh.tension(k - 1, mesh.path(k - 1, x).length);
        mesh.sliding[k].is_some_and(slides) && cable.meshing.bends_visibly(mesh, stiffness, tension)
    };
    let changed: Vec<usize> = (1..mesh.nodes().max(1) - 1).filter(neglects_bend).collect();
    for k in changed {
        make_material_at_tangents(cable, k);
    }
    stretched_before.restore(cable);
}

/// Divides the bars that are too long for the mesh, and removes the nodes that it can spare. The
/// new nodes lie on the curve of the cable: on the straight bars they would fall until the bars are
/// bent like it. Every bar keeps its tension, so it is a little longer unstretched than its
/// material, which fades.
fn divide_anew(cable: &mut CableState) {
    let stretched_before = StretchedBars::of(cable);
    let even = cable.even();
    for e in (0..cable.mesh.rest_length.len()).rev() {
        let pieces = (cable.mesh.straight_length(e, &cable.motion.positions) / even).round() as usize;
        if pieces > 1 {
            divide(cable, e, pieces);
        }
    }
    even_out(cable);
    stretched_before.restore(cable);
}

/// Divides a bar into even pieces.
fn divide(cable: &mut CableState, e: usize, pieces: usize) {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let path = mesh.path(e, x);
    let lead = path.arcs[0] * mesh.end(e, x).radius;
    let (first, material) = (mesh.arc_length[e], mesh.arc_length[e + 1] - mesh.arc_length[e]);
    let curvature = curvature(cable, e);
    let outward = perp(path.direction) * (-0.5 * curvature * path.straight * path.straight);
    for j in 1..pieces {
        let part = j as f64 / pieces as f64;
        let at = first + (lead + part * path.straight) / path.length * material;
        insert(cable, e + j, at, None);
    }
    let on_chord = cable.motion.clone();
    for j in 1..pieces {
        let part = j as f64 / pieces as f64;
        cable.motion.shift(e + j, outward * (part * (1.0 - part)));
    }
    let check = IntersectionCheck::of(cable);
    if !(e..e + pieces).all(|bar| check.is_clear(bar)) {
        cable.motion = on_chord;
    }
}

/// Curvature of the cable along a bar, 1/m: the smaller of those at its ends, none where they
/// differ in sign. Folds, and what a cable lies on, bend it in one point.
fn curvature(cable: &CableState, e: usize) -> f64 {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let at = |k: usize| {
        let is_inside = k > 0 && k + 1 < mesh.nodes() && mesh.is_free(k);
        let is_free =
            is_inside && cable.problem.world.signed_gap(x[k], FREE_REACHES * cable.contacts.barrier.reach).is_none();
        let beside = || 0.5 * (mesh.straight_length(k - 1, x) + mesh.straight_length(k, x));
        let turn = if is_free { mesh.turn(k, x) } else { f64::INFINITY };
        (turn.abs() < MAX_CURVED_TURN_RAD).then(|| turn / beside())
    };
    let smaller_of = |a: f64, b: f64| if a.abs() < b.abs() { a } else { b };
    match (at(e), at(e + 1)) {
        (Some(a), Some(b)) if a * b > 0.0 => smaller_of(a, b),
        (Some(a), None) | (None, Some(a)) => a,
        _ => 0.0,
    }
}

/// Gives a cable the material, the supports and the loads of `new`.
fn adopt_material(cable: &mut CableState, new: &CableState) {
    let mesh = &mut cable.mesh;
    mesh.tuning.clone_from(&new.mesh.tuning);
    mesh.axial_stiffness = new.mesh.axial_stiffness;
    let (meshing, edited) = (&mut cable.meshing, &new.meshing);
    (meshing.slides, meshing.never_slides) = (edited.slides, edited.never_slides);
    meshing.bar_weight = edited.bar_weight * (edited.even_bars as f64 / meshing.even_bars as f64);
    for (load, edited) in meshing.loads.iter_mut().zip(&edited.loads) {
        load.arc_length = edited.arc_length;
        load.force.clone_from(&edited.force);
    }
    cable.contacts.tuning = new.contacts.tuning;
    cable.contacts.search.lists.clear();
    cable.contacts.self_contacts.shape.diameter = new.contacts.self_contacts.shape.diameter;
    cable.contacts.self_contacts.friction = new.contacts.self_contacts.friction;
    cable.input.stopping = new.input.stopping;
}

/// A sliding node after an edit; None if its obstacle is gone: then it is a node of the material.
fn on_edited_obstacle(
    [old, cable]: [&CableState; 2],
    node: SlidingNode,
    edited: &EditedObstacles<'_>,
) -> Option<SlidingNode> {
    let feature = match node.slide_over {
        SlideOver::Obstacle { feature, .. } => feature,
        SlideOver::Pulley(support) => {
            let [before, after] = [old, cable].map(|c| c.problem.supports.get(support));
            let (before, after) = (before?, after?);
            let radius = node.end.radius + (after.wheel_radius - before.wheel_radius);
            return Some(SlidingNode { end: BarEnd { radius, ..node.end }, friction: after.friction, ..node });
        }
    };
    let (obstacle, after) = edited.feature(feature)?;
    let (center, radius) = round_of(edited.after, after, 0.0, 0.0)?;
    let clearance = node.end.radius - round_of(edited.before, feature, 0.0, 0.0)?.1;
    let friction = edited.after.body_of(after)?.friction;
    let slide_over = SlideOver::Obstacle { obstacle, feature: after };
    Some(SlidingNode { end: BarEnd { center, radius: radius + clearance, ..node.end }, friction, slide_over, ..node })
}
