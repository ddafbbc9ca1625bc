//! A load between the ends of the cable runs over rounds with its material.
//!
//! Its node cannot pass a sliding node, and would jam in front of it. So where it comes to a round,
//! its node is taken out, and the round carries the load from there on, until its material has run
//! over: there it gets a node again. In motion bars keep their tension in both edits.
//!
//! A corner or post that can let go of the cable instead does so, and material nodes run over it.

use crate::contact::distance::nearest_fraction;
use crate::math::{Vec2, cross, larger};
use crate::model::Inertia;
use crate::model::fem::mesh::{Mesh, SlideOver, SlidingNode};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::edit::{insert, remove};
use crate::model::fem::remesh::edit_criteria::Criteria;
use crate::model::fem::remesh::stretched_bars::StretchedBars;
use crate::model::fem::state::CableState;

/// Distance from a round at which it takes a load over from a cable in motion, in even bars.
/// Smaller: shorter bars in front of the round; larger: the bend of the cable at the load is
/// neglected for longer. A choice, tuned on no campaign, as are the four below.
const LOAD_DISTANCE_BARS: f64 = 0.02;

/// The same without inertia, where one step can move the cable by more. Smaller: steps fail in
/// front of rounds, and are halved; larger: as above.
const LOAD_DISTANCE_BARS_AT_REST: f64 = 0.1;

/// Number of steps whose way counts as well. Smaller: the load jams in front of the round within a
/// step; larger: the bend at the load is neglected for longer.
const LOAD_WAY_STEPS: f64 = 1.5;

/// Multiple of that distance beyond the round at which the load gets a node of its own again.
/// Smaller: a load that comes to and fro is taken over again and again; larger: the bend at the
/// load is neglected for longer.
const CLEAR_FACTOR: f64 = 2.0;

/// Least length of a bar between two nodes, one of a load, in even bars. Smaller: bars so short
/// that rounding is their strain; larger: loads near to each other wait on the round.
const LEAST_BARS: f64 = 1e-3;

/// Lets loads run on to rounds, over them and off them; returns whether the mesh changed.
pub(super) fn pass_loads(cable: &mut CableState, inertia: Inertia) -> bool {
    let mut changed = false;
    for load in 0..cable.meshing.loads.len() {
        let on_round = cable.mesh.sliding[cable.meshing.loads[load].node].is_some();
        changed |= if on_round { leave_round(cable, load, inertia) } else { enter_round(cable, load, inertia) };
    }
    changed
}

/// Distance (m) from a round at which it takes over a load that does not move.
fn takeover_distance(cable: &CableState, inertia: Inertia) -> f64 {
    cable.even()
        * match inertia {
            Inertia::QuasiStatic => LOAD_DISTANCE_BARS_AT_REST,
            Inertia::Dynamic => LOAD_DISTANCE_BARS,
        }
}

/// True if the load (N) at material node `j` comes to the round of sliding node `k`, which cannot
/// make way: on its way in the next steps little is left of the straight cable between them.
fn comes_to(cable: &CableState, [j, k]: [usize; 2], force: Vec2, inertia: Inertia) -> bool {
    let Some(node) = cable.mesh.sliding[k].filter(|node| cannot_make_way(cable, k, node, force, inertia)) else {
        return false;
    };
    let (m, round) = (&cable.motion, node.end);
    let from = m.positions[j];
    let to = match inertia {
        Inertia::QuasiStatic => from,
        Inertia::Dynamic => from + (m.velocities[j] - m.velocities[k]) * (LOAD_WAY_STEPS * m.step_before),
    };
    let nearest = from + (to - from) * nearest_fraction(round.center, from, to) - round.center;
    let comes = inertia == Inertia::QuasiStatic || nearest.norm() < (from - round.center).norm();
    comes && nearest.norm_squared() - round.radius * round.radius < takeover_distance(cable, inertia).powi(2)
}

/// True if the sliding node `k` has to carry a load (N) that comes to it: a corner lets go of the
/// cable instead, unless that would stretch a cable in motion.
fn cannot_make_way(cable: &CableState, k: usize, node: &SlidingNode, force: Vec2, inertia: Inertia) -> bool {
    let is_stuck = || inertia == Inertia::Dynamic && !Criteria::of(cable).settles_unstretched(k);
    carries(&cable.mesh, node, force) && (matches!(node.slide_over, SlideOver::Pulley(_)) || is_stuck())
}

/// True if a load (N) of a flexible cable presses on the round of a sliding node; an eye holds it
/// whatever it pulls.
pub(super) fn carries(mesh: &Mesh, node: &SlidingNode, force: Vec2) -> bool {
    let is_eye = matches!(node.slide_over, SlideOver::Pulley(_)) && node.end.radius == 0.0;
    mesh.is_flexible() && (is_eye || force.dot(&node.end.mark) < 0.0)
}

/// Takes out the node of a load that has come to a round beside it, which carries the load from
/// then on.
fn enter_round(cable: &mut CableState, load: usize, inertia: Inertia) -> bool {
    let j = cable.meshing.loads[load].node;
    if !cable.meshing.only_carries_load(&cable.mesh, j) {
        return false;
    }
    let force = cable.meshing.loads[load].force.at(cable.motion.time);
    let round = [j - 1, j + 1].into_iter().find(|&k| comes_to(cable, [j, k], force, inertia));
    let Some(k) = round.filter(|_| IntersectionCheck::of(cable).clear_without(j)) else { return false };
    let bars = (inertia == Inertia::Dynamic).then(|| StretchedBars::of(cable));
    for load in cable.meshing.loads.iter_mut().filter(|load| load.node == j) {
        load.node = k;
    }
    remove(cable, j);
    bars.iter().for_each(|bars| bars.restore(cable));
    true
}

/// Gives a load that has run over its round a node of its own, or hands it to the next mark on the
/// round; returns whether the mesh changed.
fn leave_round(cable: &mut CableState, load: usize, inertia: Inertia) -> bool {
    let (mesh, at) = (&cable.mesh, cable.meshing.loads[load].arc_length);
    let k = cable.meshing.loads[load].node;
    let to_load = |j: usize| (mesh.arc_length[j] - at).abs();
    let shares = |j: &usize| matches!((mesh.sliding[*j], mesh.sliding[k]), (Some(a), Some(b)) if a.shares_round(&b));
    let nearest = [k - 1, k + 1].into_iter().filter(shares).find(|j| to_load(*j) < to_load(k));
    if let Some(next) = nearest {
        cable.meshing.loads[load].node = next;
        return false;
    }
    let least = LEAST_BARS * cable.even();
    let e = bar_at(cable, at);
    let mesh = &cable.mesh;
    if [e, e + 1].contains(&k) {
        let Some(beyond) = cable.meshing.loads[load].beyond_round(mesh, &cable.motion.positions) else { return false };
        let slid = cable.motion.slide_rates[k] * cable.motion.step_before;
        // Material after the round runs off it where the arc length there falls.
        let runs_off = if e < k { slid } else { -slid };
        let near = larger(takeover_distance(cable, inertia), LOAD_WAY_STEPS * slid.abs());
        let clear = CLEAR_FACTOR * near + more_round(cable, load, e);
        let is_clear = beyond > if runs_off < 0.0 { larger(clear, cable.even()) } else { clear };
        if !is_clear || to_load(e) < least || to_load(e + 1) < least {
            return false;
        }
    }
    let bars = (inertia == Inertia::Dynamic).then(|| StretchedBars::of(cable));
    give_node(cable, load);
    // Two nodes so near to each other are one too many.
    let (own, near) = (cable.meshing.loads[load].node, takeover_distance(cable, inertia));
    let spare = |j: &usize| {
        let mesh = &cable.mesh;
        let is_plain = cable.meshing.removable(mesh, *j) && mesh.sliding[*j].is_none();
        is_plain && (mesh.arc_length[*j] - at).abs() < near && IntersectionCheck::of(cable).clear_without(*j)
    };
    if let Some(j) = [own.checked_sub(1), Some(own + 1)].into_iter().flatten().find(spare) {
        remove(cable, j);
    }
    bars.iter().for_each(|bars| bars.restore(cable));
    true
}

/// Index of the bar with the material at an arc length (m).
fn bar_at(cable: &CableState, arc_length: f64) -> usize {
    let mesh = &cable.mesh;
    mesh.arc_length.partition_point(|s| *s <= arc_length).clamp(1, mesh.nodes() - 1) - 1
}

/// Gives a load a material node: the one at its place, or a new one.
fn give_node(cable: &mut CableState, load: usize) {
    let at = cable.meshing.loads[load].arc_length;
    let e = bar_at(cable, at);
    let is_there = |j: &usize| {
        cable.mesh.sliding[*j].is_none() && (cable.mesh.arc_length[*j] - at).abs() < LEAST_BARS * cable.even()
    };
    let there = [e, e + 1].into_iter().find(is_there);
    if there.is_none() {
        insert(cable, e + 1, at, None);
    }
    cable.meshing.loads[load].node = there.unwrap_or(e + 1);
}

/// Gives the loads of node `k`, which has become a material node, nodes of their own.
pub(super) fn add_nodes_of_loads(cable: &mut CableState, k: usize) {
    let carried: Vec<usize> =
        (0..cable.meshing.loads.len()).filter(|&load| cable.meshing.loads[load].node == k).collect();
    for load in carried {
        give_node(cable, load);
    }
}

/// The length (m) by which the cable lies farther round its round if a load has a node of its own
/// on bar `e` beside it: there it bends by the angle of the force across the cable over the
/// tension.
fn more_round(cable: &CableState, load: usize, e: usize) -> f64 {
    let (mesh, load) = (&cable.mesh, &cable.meshing.loads[load]);
    let path = mesh.path(e, &cable.motion.positions);
    let across = cross(path.direction, load.force.at(cable.motion.time)).abs();
    let radius = mesh.sliding[load.node].map_or(0.0, |node| node.end.radius);
    radius * across.atan2(larger(mesh.tension(e, path.length), 0.0))
}
