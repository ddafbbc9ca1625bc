//! This module adapts the mesh between steps: sliding nodes come and go, and nodes beside them make
//! room.
//!
//! After every accepted step
//! - a sliding node that no longer presses on its corner is removed or becomes a material node (the
//!   round is as far out as the barrier reaches, so nothing jumps);
//! - the sliding nodes of a pulley that has let go are removed but for one, which becomes a
//!   material node;
//! - a corner or circle that presses on a bar or a node gets a sliding node;
//! - marks are moved to the middle of the arc, long arcs get more nodes (friction acts at them),
//!   passed ones lose theirs;
//! - bars that grew too long are divided, nodes that came too near a sliding one are removed.
//!
//! Material, position and momentum of the remaining nodes do not change.

use crate::math::{Vec2, perp};
use crate::model::Inertia;
use crate::model::fem::mesh::{SlideOver, SlidingNode};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::arc_marks::{adapt_marks, move_marks};
use crate::model::fem::remesh::edit::{insert, remove};
use crate::model::fem::remesh::edit_criteria::{Criteria, MaterialShare, NewSlidingNode};
use crate::model::fem::remesh::loads_over_rounds::{add_nodes_of_loads, pass_loads};
use crate::model::fem::results::keep_answer;
use crate::model::fem::state::{CableState, LoadNode, MovingMass, attribute_to, renew_input};
use crate::model::fem::system::contact::floor_friction;
use crate::numerics::bisect;

/// Arc of a bar on its rounds below which it counts as unwound, rad: its tangent points have passed
/// each other. Nearer to 0: bars that graze a round are not divided; farther: a bar that runs
/// backwards is. A choice, tuned on no campaign.
const UNWOUND_ARC: f64 = -0.1;

/// The effects of an adaptation of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::model::fem) struct Remeshed {
    /// True if the cable now runs over other corners and rounds.
    pub(in crate::model::fem) sliding_nodes: bool,
    /// True if its bars are not those that were balanced.
    pub(in crate::model::fem) bars: bool,
    /// True if material moved from bar to bar because marks on rounds were moved.
    pub(in crate::model::fem) marks: bool,
}

/// Adapts the mesh to the corners and rounds that the cable runs over, without inertia or with it.
pub(in crate::model::fem) fn remesh(cable: &mut CableState, inertia: Inertia) -> Remeshed {
    adapt(cable, inertia, LoadPassage::None)
}

/// The same after a step in which loads may have come to rounds.
pub(in crate::model::fem) fn remesh_after_step(cable: &mut CableState, inertia: Inertia) -> Remeshed {
    let passed = !cable.contacts.self_contacts.shape.is_on() && pass_loads(cable, inertia);
    adapt(cable, inertia, if passed { LoadPassage::Some } else { LoadPassage::None })
}

/// Tells whether loads have passed onto rounds or off them since the mesh was adapted last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LoadPassage {
    None,
    Some,
}

/// Adds and removes sliding nodes, marks and bars; returns what it changed.
fn adapt(cable: &mut CableState, inertia: Inertia, passage: LoadPassage) -> Remeshed {
    if cable.contacts.self_contacts.shape.is_on() {
        return Remeshed::default();
    }
    let mut changed = remove_sliding_nodes(cable, &[], inertia);
    let added = add_sliding_nodes(cable, inertia);
    if !added.is_empty() {
        // A new sliding node may lift its neighbour off. At rest it is not itself removed before
        // the next step: it took over weight of the nodes beside it, which under a corner pulls it
        // away until they have moved.
        let new_nodes: &[SlideOver] = if inertia == Inertia::QuasiStatic { &added } else { &[] };
        remove_sliding_nodes(cable, new_nodes, inertia);
        changed = true;
    }
    let moved = move_marks(cable, inertia);
    let marks_changed = adapt_marks(cable, inertia);
    let evened = even_out(cable);
    let bars = passage == LoadPassage::Some || changed || marks_changed || evened;
    if bars || moved {
        let x = std::mem::take(&mut cable.motion.positions);
        cable.contacts.prepare(&cable.problem, &cable.mesh, &x, &x);
        cable.motion.positions = x;
        renew_input(cable);
    }
    Remeshed { sliding_nodes: changed, bars, marks: moved }
}

/// Removes the sliding nodes that press on nothing, except those on `kept`; returns whether there
/// were any.
pub(in crate::model::fem) fn remove_sliding_nodes(
    cable: &mut CableState,
    new_nodes: &[SlideOver],
    inertia: Inertia,
) -> bool {
    let rests = inertia == Inertia::QuasiStatic;
    let mut changed = false;
    let mut k = 1;
    while k + 1 < cable.mesh.nodes() {
        let [this, next] = [k, k + 1].map(|k| cable.mesh.sliding[k].map(|s| s.slide_over));
        let is_released = this.is_some_and(|slide_over| is_released(cable, slide_over));
        let leaves = match this {
            None => false,
            Some(SlideOver::Pulley(_)) => is_released,
            Some(slide_over @ SlideOver::Obstacle { .. }) => {
                !new_nodes.contains(&slide_over) && Criteria::of(cable).lifts_off(k)
            }
        };
        // Of the nodes on a wheel that has let go, one keeps the bend.
        let is_spare = is_released && this == next;
        // A load that it carries needs a node: a corner keeps it until the load has run over.
        if leaves && !is_spare && cable.meshing.loads.iter().any(|load| load.node == k) {
            changed |= is_released && make_material_at_tangents(cable, k);
            k += 1;
            continue;
        }
        let runs_straight = leaves
            && cable.mesh.runs_straight(k, &cable.motion.positions)
            && IntersectionCheck::of(cable).clear_without(k);
        if is_spare || runs_straight {
            remove(cable, k);
            changed = true;
        } else if leaves
            && (rests || is_released || Criteria::of(cable).settles_unstretched(k))
            && make_material_at_tangents(cable, k)
        {
            changed = true;
            k += 1;
        } else if leaves && rests && IntersectionCheck::of(cable).clear_without(k) {
            remove(cable, k);
            changed = true;
        } else {
            k += 1;
        }
    }
    changed
}

/// True if a node slides over the wheel of a pulley that has let go.
fn is_released(cable: &CableState, slide_over: SlideOver) -> bool {
    let SlideOver::Pulley(support) = slide_over else { return false };
    cable.problem.supports.get(support).is_none_or(|s| !s.holds_from(cable.motion.time))
}

/// Turns a material node into a sliding node.
fn make_sliding(cable: &mut CableState, k: usize, arc_length: f64, sliding: SlidingNode) {
    attribute_to(cable, sliding.slide_over, |d| change_to_sliding(d, k, arc_length, sliding));
}

/// As [`make_sliding`], without the account of momentum.
fn change_to_sliding(cable: &mut CableState, k: usize, arc_length: f64, sliding: SlidingNode) {
    keep_answer(cable);
    let along = cable.mesh.direction(k - 1, &cable.motion.positions);
    let (mesh, m) = (&mut cable.mesh, &mut cable.motion);
    mesh.sliding[k] = Some(sliding);
    mesh.arc_length[k] = arc_length;
    let whole = mesh.rest_length[k - 1] + mesh.rest_length[k];
    for e in [k - 1, k] {
        match mesh.has_excess() {
            true => {
                let part = mesh.material_between(e, e + 1) / mesh.material_between(k - 1, k + 1);
                mesh.set_rest_length(e, whole * part);
            }
            false => mesh.renew_rest_length(e),
        }
    }
    m.slide_rates[k] = -m.velocities[k].dot(&along);
    m.previous_slide_rates[k] = m.slide_rates[k];
    m.previous_arc_length[k] = arc_length - m.slide_rates[k] * m.step_before;
    m.positions[k] = sliding.position();
    m.previous_positions[k] = m.positions[k];
    m.velocities[k] = Vec2::zeros();
    m.previous_velocities[k] = Vec2::zeros();
    cable.contacts.floor_slip[k] = floor_friction::as_slide(cable.contacts.floor_slip[k], along);
}

/// Turns a sliding node into a material node, because a bar in its place would meet another
/// obstacle.
///
/// It is placed where its two tangents meet, 1/cos(φ/2) radii from the centre, so that the bars
/// keep their lines. Loads that it carries get nodes. Its material is not that of the mark, unless
/// that was in the middle of the arc: see [`MaterialShare`]. (A mark 0.08 mm off gave a slack cable
/// of 2 MN 2000 N there, and broke it.) Where the wheel of a pulley let go it is placed nearer, so
/// that its bars are as long together as the path over the wheel: the cable may hold there at a
/// large angle.
pub(in crate::model::fem) fn make_material_at_tangents(cable: &mut CableState, k: usize) -> bool {
    let Some(node) = cable.mesh.sliding.get(k).copied().flatten() else { return change_to_material(cable, k) };
    let settles = attribute_to(cable, node.slide_over, |d| change_to_material(d, k));
    if settles {
        add_nodes_of_loads(cable, k);
    }
    settles
}

/// As [`make_material_at_tangents`], without the account of momentum; returns false, and changes
/// nothing, if a bar would meet an obstacle there, too.
fn change_to_material(cable: &mut CableState, k: usize) -> bool {
    keep_answer(cable);
    let had = MovingMass::of(cable).momenta();
    let before = [k - 1, k].map(|e| cable.mesh.path(e, &cable.motion.positions).length / cable.mesh.rest_length[e]);
    let half = (0.5 * cable.mesh.turn(k, &cable.motion.positions)).abs();
    let out = 1.0
        / if half < cable.mesh.tuning.remesh.max_tangent_half_turn_rad {
            half.cos()
        } else {
            cable.mesh.tuning.remesh.max_tangent_half_turn_rad.cos()
        };
    let Some(end) = cable.mesh.sliding[k].map(|s| s.end) else { return false };
    let x = &cable.motion.positions;
    let along = cable.mesh.direction(k - 1, x) + cable.mesh.direction(k, x);
    let outward = perp(along) * -end.sense;
    let outward =
        if outward.norm() > cable.mesh.tuning.remesh.fold_direction_sum { outward.normalize() } else { end.mark };
    let is_released = cable.mesh.sliding[k].is_some_and(|s| is_released(cable, s.slide_over));
    let whole = [k - 1, k].map(|e| cable.mesh.path(e, &cable.motion.positions).length).iter().sum();
    let (sliding, place) = (cable.mesh.sliding[k].take(), cable.motion.positions[k]);
    let way = outward * (end.radius * out);
    cable.motion.positions[k] = end.center + way;
    if is_released {
        place_at_path_length(cable, k, whole, end.center, way);
    }
    if ![k - 1, k].into_iter().all(|e| IntersectionCheck::of(cable).is_clear(e)) {
        cable.mesh.sliding[k] = sliding;
        cable.motion.positions[k] = place;
        return false;
    }
    let mesh = &mut cable.mesh;
    let ways = [0, 1].map(|j| mesh.path(k - 1 + j, &cable.motion.positions).length);
    let whole = mesh.rest_length[k - 1] + mesh.rest_length[k];
    if ways[0] > 0.0 && ways[1] > 0.0 {
        let first = whole * MaterialShare::of(ways, before, whole).first;
        mesh.arc_length[k] = mesh.arc_length[k - 1] + first / mesh.thermal_stretch;
        for (e, length) in [(k - 1, first), (k, whole - first)] {
            match mesh.has_excess() {
                true => mesh.set_rest_length(e, length),
                false => mesh.rest_length[e] = length,
            }
        }
    }
    let m = &mut cable.motion;
    let slid = floor_friction::as_move(cable.contacts.floor_slip[k], along.try_normalize(0.0).unwrap_or_default());
    cable.contacts.floor_slip[k] = slid;
    m.slide_rates[k] = 0.0;
    m.previous_slide_rates[k] = 0.0;
    // It has the momentum of the material that was on the round, and that which neighbours gave up.
    let have = MovingMass::of(cable).momenta();
    let mass = cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    let m = &mut cable.motion;
    m.velocities[k] += (had[0] - have[0]) / mass;
    m.previous_velocities[k] = m.velocities[k];
    m.previous_positions[k] = m.positions[k] - m.velocities[k] * m.step_before;
    true
}

/// Places the material node `k` on the line from a centre `from` along `way` (m), where its two
/// bars are `whole` (m) long together, if they are longer at the end of the line.
fn place_at_path_length(cable: &mut CableState, k: usize, whole: f64, from: Vec2, way: Vec2) {
    let fits = |part: f64| {
        cable.motion.positions[k] = from + way * part;
        let x = &cable.motion.positions;
        [k - 1, k].map(|e| cable.mesh.path(e, x).length).iter().sum::<f64>() <= whole
    };
    let [part, _] = bisect([0.0, 1.0], f64::MANTISSA_DIGITS as usize, fits);
    cable.motion.positions[k] = from + way * part;
}

/// Puts sliding nodes where corners and circles press; returns what they slide over.
fn add_sliding_nodes(cable: &mut CableState, inertia: Inertia) -> Vec<SlideOver> {
    let mut added = Vec::new();
    if cable.problem.world.is_empty() || !cable.meshing.slides {
        return added;
    }
    let mut touches = std::mem::take(&mut cable.meshing.found);
    for _ in 0..cable.mesh.tuning.remesh.max_changes {
        cable.contacts.find(&cable.problem, &cable.mesh, &cable.motion.positions, &mut touches);
        let criteria = Criteria::of(cable);
        let found = touches.iter().find_map(|t| {
            let pressed = t.pair.weight > 0.0 && t.load(&cable.contacts.barrier) > 0.0 && t.pair.gap.feature % 2 == 1;
            let NewSlidingNode { bar, arc_length, sliding } =
                if pressed { criteria.sliding_node_for(t)? } else { return None };
            let near = cable.mesh.tuning.remesh.removed_distance * cable.even();
            let node = [bar, bar + 1].into_iter().find(|&k| {
                cable.meshing.removable(&cable.mesh, k) && (cable.mesh.arc_length[k] - arc_length).abs() < near
            });
            let beside = node.map_or([bar, bar + 1], |k| [k - 1, k + 1]);
            if !criteria.may_insert(beside, &sliding) {
                return None;
            }
            let s = beside.map(|k| cable.mesh.arc_length[k]);
            let arc_length = match inertia {
                Inertia::QuasiStatic => arc_length,
                Inertia::Dynamic => s[0] + criteria.share_of_sliding(beside, &sliding)?.first * (s[1] - s[0]),
            };
            Some((bar, node, arc_length, sliding))
        });
        let Some((bar, node, arc_length, sliding)) = found else { break };
        match node {
            Some(k) => make_sliding(cable, k, arc_length, sliding),
            None => insert(cable, bar + 1, arc_length, Some(sliding)),
        }
        clear_around(cable, node.unwrap_or(bar + 1));
        added.push(sliding.slide_over);
    }
    cable.meshing.found = touches;
    added
}

/// Removes material nodes in the way of a new sliding node.
fn clear_around(cable: &mut CableState, k: usize) {
    let near = cable.mesh.tuning.remesh.min_bar * cable.even();
    let straight = |d: &CableState, e: usize| d.mesh.straight_length(e, &d.motion.positions);
    if k + 2 < cable.mesh.nodes()
        && cable.meshing.removable(&cable.mesh, k + 1)
        && straight(cable, k) < near
        && IntersectionCheck::of(cable).clear_without(k + 1)
    {
        remove(cable, k + 1);
    }
    if k > 1
        && cable.meshing.removable(&cable.mesh, k - 1)
        && straight(cable, k - 1) < near
        && IntersectionCheck::of(cable).clear_without(k - 1)
    {
        remove(cable, k - 1);
    }
}

/// Divides long bars beside sliding nodes and removes nodes that came too near to one.
///
/// Returns whether anything changed.
pub(in crate::model::fem) fn even_out(cable: &mut CableState) -> bool {
    let even = cable.even();
    let mut changed = false;
    let mut k = 1;
    while k + 1 < cable.mesh.nodes() {
        if !cable.meshing.removable(&cable.mesh, k) {
            k += 1;
            continue;
        }
        let (before, after) = (cable.mesh.sliding[k - 1], cable.mesh.sliding[k + 1]);
        let straight = |e: usize| cable.mesh.straight_length(e, &cable.motion.positions);
        let crowded = (before.is_some() && straight(k - 1) < cable.mesh.tuning.remesh.min_bar * even)
            || (after.is_some() && straight(k) < cable.mesh.tuning.remesh.min_bar * even);
        let spare = before.is_none()
            && after.is_none()
            && cable.mesh.material_between(k - 1, k + 1) < cable.mesh.tuning.remesh.spare_bars * even
            && cable.mesh.turn(k, &cable.motion.positions).abs() < cable.mesh.tuning.remesh.min_turn_rad;
        let enclosed = matches!((before, after), (Some(a), Some(b)) if a.shares_round(&b));
        if (crowded || enclosed || spare) && IntersectionCheck::of(cable).clear_without(k) {
            remove(cable, k);
            changed = true;
        } else {
            k += 1;
        }
    }
    let mut e = 0;
    while e + 1 < cable.mesh.nodes() {
        // A load beside its round has no node of its own, and none may come between.
        let holds = |load: &LoadNode| {
            let ends = [cable.mesh.arc_length[e], cable.mesh.arc_length[e + 1]];
            cable.mesh.sliding[load.node].is_some() && ends[0] < load.arc_length && load.arc_length < ends[1]
        };
        if cable.meshing.loads.iter().any(holds) {
            e += 1;
            continue;
        }
        // Only the straight part can be divided and only it counts: if the arcs counted, a piece
        // could be so short that it would be removed at once, and again in each step.
        let is_long = cable.mesh.straight_length(e, &cable.motion.positions) > cable.mesh.tuning.remesh.max_bar * even;
        let length = cable.mesh.material_between(e, e + 1);
        let x = &cable.motion.positions;
        let long = is_long.then(|| cable.mesh.path(e, x));
        if let Some(path) = long.filter(|path| !path.arcs.iter().any(|&a| a < UNWOUND_ARC)) {
            // Pieces are even; beside a sliding node the odd piece is the one next to it.
            let slides = [e, e + 1].map(|k| cable.mesh.sliding[k].is_some());
            let first = match slides {
                [false, true] => even,
                [true, false] => path.straight - even,
                _ => 0.5 * path.straight,
            };
            let lead = path.arcs[0] * cable.mesh.end(e, x).radius;
            let arc_length = cable.mesh.arc_length[e] + (lead + first) / path.length * length;
            insert(cable, e + 1, arc_length, None);
            changed = true;
            if slides[1] && !slides[0] {
                e += 1;
            }
            continue;
        }
        e += 1;
    }
    changed
}
