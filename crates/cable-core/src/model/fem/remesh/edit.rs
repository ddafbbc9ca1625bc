//! An edit inserts a node into a mesh or removes one; material, position and momentum of the
//! remaining nodes do not change.

use crate::math::Vec2;
use crate::model::fem::mesh::SlidingNode;
use crate::model::fem::results::keep_answer;
use crate::model::fem::state::{CableState, MovingMass, NodeMotion, attribute_to};
use crate::model::fem::system::contact::floor_friction;

/// Inserts a node at an arc length (m) between nodes `k` − 1 and `k`.
pub(in crate::model::fem) fn insert(cable: &mut CableState, k: usize, arc_length: f64, sliding: Option<SlidingNode>) {
    let beside = [k - 1, k].into_iter().find_map(|j| cable.mesh.sliding.get(j).copied().flatten());
    match sliding.or(beside) {
        Some(node) => attribute_to(cable, node.slide_over, |d| insert_unaccounted(d, k, arc_length, sliding)),
        None => insert_unaccounted(cable, k, arc_length, None),
    }
}

/// As [`insert`], without the account of momentum.
fn insert_unaccounted(cable: &mut CableState, k: usize, arc_length: f64, sliding: Option<SlidingNode>) {
    keep_answer(cable);
    let mesh = &mut cable.mesh;
    let path = mesh.path(k - 1, &cable.motion.positions);
    let (a, b) = (mesh.arc_length[k - 1], mesh.arc_length[k]);
    let part = (arc_length - a) / (b - a);
    let first_arc = path.arcs[0] * mesh.end(k - 1, &cable.motion.positions).radius;
    let fraction =
        if path.straight > 0.0 { ((part * path.length - first_arc) / path.straight).clamp(0.0, 1.0) } else { 0.5 };
    let at = path.ends[0] + (path.ends[1] - path.ends[0]) * fraction;
    let m = &mut cable.motion;
    let t = path.direction;
    // Material at a sliding node moves with its round and runs over it.
    let of_material = |v: &[Vec2], rate: &[f64]| {
        let at = |j: usize| if mesh.sliding[j].is_some() { v[j] - t * rate[j] } else { v[j] };
        at(k - 1) * (1.0 - part) + at(k) * part
    };
    let v = of_material(&m.velocities, &m.slide_rates);
    let v_before = of_material(&m.previous_velocities, &m.previous_slide_rates);
    // A new mark moves with the round on which it is.
    let beside = [k - 1, k].into_iter().find(|&j| {
        mesh.sliding[j].is_some_and(|other| sliding.is_some_and(|this| this.slide_over == other.slide_over))
    });
    let [of_round, of_round_before] =
        beside.map_or([Vec2::zeros(); 2], |j| [m.velocities[j], m.previous_velocities[j]]);
    // The floor acts on it as on its neighbours.
    let slid = |j: usize| {
        let slid = cable.contacts.floor_slip[j];
        if mesh.sliding[j].is_some() { floor_friction::as_move(slid, t) } else { slid }
    };
    let between = slid(k - 1) * (1.0 - part) + slid(k) * part;
    let between = if sliding.is_some() { floor_friction::as_slide(between, t) } else { between };
    let w = if sliding.is_some() { (of_round - v).dot(&t) } else { 0.0 };
    let w_before = if sliding.is_some() { (of_round_before - v_before).dot(&t) } else { 0.0 };
    let (x, v, v_before) = sliding.map_or((at, v, v_before), |s| (s.position(), of_round, of_round_before));
    mesh.insert_node(k, arc_length, sliding);
    m.insert_node(
        k,
        arc_length,
        NodeMotion {
            position: x,
            velocity: v,
            previous_velocity: v_before,
            slide_rate: w,
            previous_slide_rate: w_before,
        },
    );
    cable.answers.reaction.insert(k, Vec2::zeros());
    cable.contacts.floor_slip.insert(k, between);
    renumber(cable, |node| Some(if node >= k { node + 1 } else { node }));
}

/// Removes node `k`; its loads go on over the next mark on its round.
pub(in crate::model::fem) fn remove(cable: &mut CableState, k: usize) {
    match cable.mesh.sliding.get(k).copied().flatten() {
        Some(node) => {
            hand_over_loads(cable, k, &node);
            attribute_to(cable, node.slide_over, |d| merge(d, k));
        }
        None => remove_plain(cable, k),
    }
}

/// Hands the loads of a sliding node to one beside it on the same round.
fn hand_over_loads(cable: &mut CableState, k: usize, node: &SlidingNode) {
    let shares = |j: &usize| cable.mesh.sliding[*j].is_some_and(|beside| beside.shares_round(node));
    if let Some(next) = [k - 1, k + 1].into_iter().find(shares) {
        for load in cable.meshing.loads.iter_mut().filter(|load| load.node == k) {
            load.node = next;
        }
    }
}

/// Removes a material node. Its free neighbours take over its momentum, of the present and of past
/// steps.
fn remove_plain(cable: &mut CableState, k: usize) {
    let beside = [k - 1, k + 1].map(|j| cable.mesh.sliding.get(j).copied().flatten());
    let Some(round) = beside.into_iter().flatten().next() else { return merge(cable, k) };
    if cable.mesh.is_free(k - 1) || cable.mesh.is_free(k + 1) {
        // Material that comes to lie on the round has no history.
        let history = |d: &CableState| {
            let mass = MovingMass::of(d);
            let m = &d.motion;
            mass.slid_by(&m.velocities, &m.slide_rates) - mass.slid_by(&m.previous_velocities, &m.previous_slide_rates)
        };
        let had = history(cable);
        merge(cable, k);
        let has = history(cable);
        cable.motion.account.record_transferred_history(round.slide_over, had - has);
    } else {
        attribute_to(cable, round.slide_over, |d| delete(d, k));
    }
}

/// Removes node `k` and gives its momentum to its free neighbours.
fn merge(cable: &mut CableState, k: usize) {
    let had = MovingMass::of(cable).momenta();
    delete(cable, k);
    let have = MovingMass::of(cable).momenta();
    let free = [k - 1, k].map(|j| cable.mesh.is_free(j));
    let node_mass = |j: usize| cable.mesh.mass_with(&cable.problem, &cable.meshing.support_node, j);
    let mass = |j: usize| if free[j + 1 - k] { node_mass(j) } else { 0.0 };
    let mass = mass(k - 1) + mass(k);
    if !(mass > 0.0) {
        return;
    }
    let [v, v_before] = [0, 1].map(|j| (had[j] - have[j]) / mass);
    let m = &mut cable.motion;
    for (j, _) in [k - 1, k].into_iter().zip(free).filter(|(_, free)| *free) {
        m.velocities[j] += v;
        m.previous_velocities[j] += v_before;
        m.previous_positions[j] -= (v + v_before) * (0.5 * m.step_before);
    }
}

/// Removes node `k` from every list of nodes.
fn delete(cable: &mut CableState, k: usize) {
    keep_answer(cable);
    cable.mesh.remove_node(k);
    cable.motion.remove_node(k);
    cable.answers.reaction.remove(k);
    cable.contacts.floor_slip.remove(k);
    renumber(cable, |node| match node.cmp(&k) {
        std::cmp::Ordering::Less => Some(node),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(node - 1),
    });
}

/// Gives nodes their new numbers wherever they are stored; None stands for a removed node.
fn renumber(cable: &mut CableState, change: impl Fn(usize) -> Option<usize>) {
    cable.meshing.renumber(&change);
    for clamp in &mut cable.mesh.clamps {
        clamp.node = change(clamp.node).unwrap_or(clamp.node);
    }
    cable.contacts.renumber(change);
}

/// Removes the material nodes between two arc lengths (m) that would lie on a round.
pub(in crate::model::fem) fn clear_of_nodes(cable: &mut CableState, [from, to]: [f64; 2]) {
    let mut k = 1;
    while k + 1 < cable.mesh.nodes() {
        let s = cable.mesh.arc_length[k];
        if s >= from && s <= to && cable.meshing.removable(&cable.mesh, k) && cable.mesh.sliding[k].is_none() {
            remove(cable, k);
        } else {
            k += 1;
        }
    }
}
