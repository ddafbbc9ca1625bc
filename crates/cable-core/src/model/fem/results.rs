//! This module reads tensions, reactions and contacts out of a state.

use crate::contact::friction;
use crate::energy::bending::turn;
use crate::math::{Vec2, bounded, larger, perp, smaller};
use crate::model::arc_nodes;
use crate::model::fem::mesh::sliding_node::{Balanced, Load, SlideOver, SlidingNode};
use crate::model::fem::mesh::tangent_path::angle_between;
use crate::model::fem::obstacle::intersection_check::IntersectionCheck;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::bar_weight;
use crate::model::fem::system::bar_weight::Weight;
use crate::model::fem::system::floor_friction::OverRound;
use crate::model::fem::system::friction_state::ContactPair;
use crate::model::fem::system::mesh::Mesh;
use crate::model::fem::time::{branches, self_contact};
use crate::problem::Problem;
use crate::solution::{Assumptions, CableSolution, ContactReport, ContactSample, ContactState, Node, SupportReaction};

/// Nodes on a round: one at least every so many radians.
const ARC_STEP: f64 = 0.13;

/// Rounds in which it is found where a sagging cable leaves a round: each is nearer by the weight
/// on the round over the tension.
const SAG_ROUNDS: usize = 4;

/// Part of the diameter by which the way may be drawn longer than its material where a bar sags and
/// leaves a round sooner or later than straight, which makes it rδ³/6 longer at an angle δ. More:
/// of slack bars, whose sag is not known, more cable is drawn than there is; less: the force leads
/// away from the round that is drawn.
const PATH_EXCESS_DIAMETERS: f64 = 0.005;

/// The answer of a cable at this instant: that of the last step as it was balanced, else that of
/// the mesh as it is.
#[must_use]
pub fn solution(cable: &CableState) -> CableSolution {
    cable.answers.stepped.as_ref().map_or_else(|| solution_now(cable), |s| CableSolution::clone(s))
}

/// The answer with the mesh as it is.
fn solution_now(d: &CableState) -> CableSolution {
    let (problem, x, v) = (&d.problem, &d.motion.positions, &d.motion.velocities);
    let tension = bar_tensions(d, x);
    let (ends, lain) = end_forces(d, x, &tension);
    CableSolution {
        name: problem.cable.name.clone(),
        nodes: nodes(d, x, v, &tension, &ends),
        supports: supports(d, x, &ends, &tension),
        contacts: contacts(d, x, &tension, &lain),
        assumptions: Assumptions {
            bending_stiffness_n_m2: problem.bending_stiffness,
            self_contact: problem.cable.self_contact,
            inertia: d.motion.inertia_counts(),
        },
        momentum: d.motion.account.report(d.motion.inertia_counts()),
        ..CableSolution::default()
    }
}

/// Keeps the answer of a step before the first change of its mesh.
pub(in crate::model::fem) fn keep_answer(cable: &mut CableState) {
    if cable.answers.keeps && cable.answers.kept.is_none() {
        cable.answers.kept = Some(Box::new(solution_now(cable)));
    }
}

/// Reads the tension at each node, as [`nodes`] has it.
pub(in crate::model::fem) fn gauge_tension(cable: &mut CableState) {
    let mut gauged = std::mem::take(&mut cable.answers.gauged);
    let x = &cable.motion.positions;
    gauged.arc_length.clone_from(&cable.mesh.arc_length);
    gauged.bars.clear();
    if cable.meshing.never_slides {
        let mesh = &cable.mesh;
        gauged.bars.extend(x.windows(2).enumerate().map(|(e, pair)| {
            let t = mesh.bar(e).tension((pair[1] - pair[0]).norm());
            let t = if t > 0.0 { t + branches::force(cable, e) } else { t };
            if t < 0.0 && mesh.is_flexible() { 0.0 } else { t }
        }));
    } else {
        gauged.bars.extend((0..cable.mesh.rest_length.len()).map(|e| bar_tension(cable, x, e)));
    }
    let ends = end_forces(cable, x, &gauged.bars).0.map(|f| f.norm());
    gauged.tension.clear();
    gauged.tension.push(ends[0]);
    gauged.tension.extend(gauged.bars.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
    gauged.tension.push(ends[1]);
    for (k, _) in cable.mesh.sliding.iter().enumerate().filter(|(_, s)| s.is_some()) {
        if let (Some(t), Some(load)) = (gauged.tension.get_mut(k), cable.load(k)) {
            *t = larger(load.tension[0], load.tension[1]);
        }
    }
    cable.answers.gauged = gauged;
}

/// Error of the tension of a stiff cable where it bends round obstacles and pulleys, in parts
/// of the greatest tension, and the arc length (m) where it is greatest. A sliding node carries
/// no moment: tension there is off by EI/2ρ² where the cable lies on the round, and by no more
/// than T(1 − cos ½φ), φ its turn, where it touches in a point. At a node that turns by ψ the
/// normal force of a contact has any direction in between: along the cable that is ½ψ of it.
pub(in crate::model::fem) fn bending_error(cable: &CableState) -> (f64, f64) {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let tension = bar_tensions(cable, x);
    let most = tension.iter().map(|t| t.abs()).fold(0.0, larger);
    let (mut off, mut at) = (0.0, 0.0);
    let mut take = |force: f64, node: usize| {
        if force > off {
            (off, at) = (force, mesh.arc_length[node]);
        }
    };
    for k in 1..mesh.nodes().saturating_sub(1) {
        let (Some(sliding), Some(load)) = (&mesh.sliding[k], cable.load(k)) else { continue };
        let point = 0.5 * (load.tension[0] + load.tension[1]) * (1.0 - (0.5 * load.turn).cos());
        let radius = sliding.end.radius;
        let lying = if radius > 0.0 { 0.5 * mesh.bending_stiffness / (radius * radius) } else { point };
        take(if lying < point { lying } else { point }, k);
    }
    let mut touches: Vec<ContactPair> = Vec::new();
    cable.contacts.find(&cable.problem, mesh, x, &mut touches);
    for t in touches.iter().filter(|t| !t.on_segment && t.node > 0 && t.node + 1 < mesh.nodes()) {
        let bend = turn(mesh.path(t.node - 1, x).direction, mesh.path(t.node, x).direction);
        take(0.5 * bend.abs() * t.load(&cable.contacts.barrier), t.node);
    }
    for t in touches.iter().filter(|t| t.on_segment) {
        // The next node the cable could have touched with.
        let ends = [t.node, t.node + 1].into_iter().filter(|&k| k > 0 && k + 1 < mesh.nodes());
        for k in ends {
            let bend = turn(mesh.path(k - 1, x).direction, mesh.path(k, x).direction);
            take(0.5 * bend.abs() * t.load(&cable.contacts.barrier), k);
        }
    }
    (if most > 0.0 { off / most } else { 0.0 }, at)
}

/// Tension in the middle of the straight part of each bar, N; a stiff cable's may be less than
/// zero.
fn bar_tensions(d: &CableState, x: &[Vec2]) -> Vec<f64> {
    (0..d.mesh.rest_length.len()).map(|e| bar_tension(d, x, e)).collect()
}

fn bar_tension(d: &CableState, x: &[Vec2], e: usize) -> f64 {
    let path = d.mesh.path(e, x);
    let t = d.mesh.bar(e).tension(path.length);
    let flexible = d.mesh.is_flexible();
    if d.mesh.sliding[e].is_some() || d.mesh.sliding[e + 1].is_some() {
        let material = d.mesh.arc_length[e + 1] - d.mesh.arc_length[e];
        return Weight::of(&d.mesh, e, &path, d.input.body).in_the_middle(t, material, flexible);
    }
    let t = if t > 0.0 || !flexible { t + branches::force(d, e) } else { t };
    if t < 0.0 && flexible { 0.0 } else { t }
}

/// Arc length from a node to the middle of the straight part of the bar before it (`side` 0) or
/// after it (1), m.
fn half(d: &CableState, node: usize, side: usize, x: &[Vec2]) -> f64 {
    let e = node + side - 1;
    let material = d.mesh.arc_length[e + 1] - d.mesh.arc_length[e];
    Weight::of(&d.mesh, e, &d.mesh.path(e, x), d.input.body).carried(material)[1 - side]
}

/// The force of the ground on the half bar at a held end that lies on it.
struct Lain {
    /// The end, and the node beside it.
    node: usize,
    next: usize,
    obstacle: usize,
    /// Along the cable, unit vector.
    along: Vec2,
    normal: Vec2,
    /// On the cable, N.
    force: Vec2,
}

/// Tension force (N) at the start of the first bar and at the end of the last: what hangs there on
/// a free end, else that of the middle plus what acts on the half between. On the ground what acts
/// on the half is guessed from the next node. With it what the ground does to the halves that lie
/// along an edge.
fn end_forces(d: &CableState, x: &[Vec2], tension: &[f64]) -> ([Vec2; 2], [Option<Lain>; 2]) {
    let n = x.len();
    let mut lain = [None, None];
    let mut end = |node: usize, next: usize, e: usize, sign: f64| {
        let ground = d.problem.world.signed_gap(x[node], 3.0 * d.contacts.barrier.reach);
        if let Some(hung) = free_end(d, node) {
            // The ground carries the normal force there, and friction a part: at the tip itself no
            // more than its cone.
            let taken = ground.map_or(Vec2::zeros(), |g| {
                let pressed = hung.dot(&g.normal).min(0.0);
                let along = perp(g.normal);
                let half = d.problem.body_force(d.time()) * d.mesh.share(node);
                let most = -pressed * g.friction;
                let rubbed = (ground_force(d, node, x) + half).dot(&along).clamp(-most, most);
                g.normal * pressed - along * rubbed
            });
            return (taken - hung) * sign;
        }
        let middle = d.mesh.path(e, x).direction * tension[e];
        let half = half(d, node, usize::from(sign > 0.0), x);
        let body = d.problem.body_force(d.time()) * half;
        let Some(ground) = ground else { return middle + body * sign };
        let grounded = ground_force(d, next, x) * (half / d.mesh.share(next));
        let force = middle + (body + grounded) * sign;
        // A cable that lies on an edge up to its end presses on the edge alone; the barrier's width
        // would tilt the last bar.
        let beyond = d.problem.world.signed_gap(x[next], 3.0 * d.contacts.barrier.reach);
        let along = ground.feature % 2 == 0 && beyond.is_some_and(|g| g.feature == ground.feature);
        // No more than what presses: beyond that the support is pulled off the edge.
        let pressed = larger(grounded.dot(&ground.normal), 0.0);
        let tilt = force.dot(&ground.normal) * sign;
        let lift = if along { if tilt < pressed { tilt } else { pressed } } else { 0.0 };
        // The next node presses more by what the tilt lifts here, and rubs more: with less normal
        // force this half rubs less.
        let kept = if pressed > 0.0 { (1.0 - lift / pressed).clamp(0.0, 1.0) } else { 1.0 };
        let rubbed = (grounded - ground.normal * pressed) * (1.0 - kept);
        let lift = ground.normal * (lift * sign);
        let (grounded, force) = (grounded - rubbed, force - rubbed * sign);
        // The ground carries the normal force of a point mass as well: its node tells.
        lain[usize::from(sign < 0.0)] = d.mesh.held[node].then(|| Lain {
            node,
            next,
            obstacle: ground.obstacle,
            along: d.mesh.path(e, x).direction,
            normal: ground.normal,
            force: grounded - lift * sign,
        });
        force - lift
    };
    if n < 3 {
        return ([Vec2::zeros(); 2], lain);
    }
    ([end(0, 1, 0, 1.0), end(n - 1, n - 2, n - 2, -1.0)], lain)
}

/// The load on a free end, N; None for other nodes, and where a point mass moves, whose inertia
/// pulls as well.
fn free_end(d: &CableState, node: usize) -> Option<Vec2> {
    let k = d.meshing.support_node.iter().position(|n| *n == Some(node)).filter(|_| !d.mesh.held[node])?;
    if d.motion.hands[k].is_some() {
        return Some(d.problem.hung_on(k, d.time()) - d.answers.reaction[node]);
    }
    let rests = d.problem.supports.get(k)?.mass == 0.0 || !d.motion.inertia_counts();
    rests.then(|| d.problem.hung_on(k, d.time()))
}

/// Normal and friction force of edges and floor on a node, N.
fn ground_force(d: &CableState, node: usize, x: &[Vec2]) -> Vec2 {
    let mut sum = Vec2::zeros();
    for rub in d.contacts.friction_contacts.iter().filter(|r| r.touch.node == node && !r.touch.on_segment) {
        sum += rub.touch.pair.gap.normal * rub.touch.load(&d.contacts.barrier) + d.contacts.friction_force(rub, x);
    }
    if let Some(&limit) = d.input.floor_limit.get(node) {
        sum -= friction::at_plane(d.contacts.floor_slid[node], limit, d.contacts.slip).1;
    }
    sum
}

/// Sum of all forces on a cable that no support holds, N: weight, loads, and what obstacles and
/// floor do to it. Between its bars nothing is left, whatever their tension: this has none of the
/// rounding of their forces, and tells what slides from what rests where each node alone is let off
/// with a little.
pub(in crate::model::fem) fn unbalanced(d: &CableState, x: &[Vec2], time_s: f64) -> Vec2 {
    let problem = &d.problem;
    let hung: Vec2 = (0..problem.supports.len()).map(|k| problem.hung_on(k, time_s)).sum();
    let at_support =
        |s: f64| problem.supports.iter().any(|p| p.arc_length.is_some_and(|a| (a - s).abs() <= 1e-9 * problem.length));
    let loads: Vec2 = problem.loads.iter().filter(|l| !at_support(l.arc_length)).map(|l| l.force.at(time_s)).sum();
    let mut sum = problem.body_force(time_s) * problem.length + hung + loads;
    let mut touches: Vec<ContactPair> = Vec::new();
    d.contacts.find(problem, &d.mesh, x, &mut touches);
    for touch in &touches {
        sum += touch.pair.gap.normal * touch.load(&d.contacts.barrier);
    }
    for rub in &d.contacts.friction_contacts {
        sum += d.contacts.friction_force(rub, x);
    }
    for k in 0..x.len() {
        let floor =
            d.input.floor_limit.get(k).map(|&l| friction::at_plane(d.contacts.floor_slid[k], l, d.contacts.slip).1);
        if d.mesh.sliding[k].is_some() && k > 0 && k + 1 < x.len() {
            let [before, after] = [k - 1, k].map(|e| {
                let path = d.mesh.path(e, x);
                path.direction * d.mesh.bar(e).tension(path.length)
            });
            sum += before - after - bar_weight::on_node(&d.mesh, k, x, problem.body_force(time_s));
        } else {
            sum -= floor.unwrap_or_default();
        }
    }
    sum
}

fn nodes(d: &CableState, x: &[Vec2], v: &[Vec2], tension: &[f64], ends: &[Vec2; 2]) -> Vec<Node> {
    let (mesh, n) = (&d.mesh, x.len());
    let area = d.problem.cable.area_m2();
    let moments = moments(d, x);
    let node = |s: f64, (x, v): (Vec2, Vec2), t: f64, (curvature_per_m, force): (f64, Vec2)| Node {
        arc_length_m: s,
        x_m: x.x,
        y_m: x.y,
        vx_m_per_s: v.x,
        vy_m_per_s: v.y,
        tension_n: t,
        strain: t / d.problem.axial_stiffness,
        stress_pa: t / area,
        curvature_per_m,
        force_n: force.into(),
        ..Node::default()
    };
    let mut out: Vec<Node> = Vec::with_capacity(n + 2);
    for k in 0..n {
        if let (Some(sliding), Some(load)) = (&mesh.sliding[k], d.load(k)) {
            for p in on_round(d, k, sliding, &load, x, tension) {
                let velocity = p.force.try_normalize(0.0).unwrap_or_default() * (-d.motion.slide_rates[k] * p.stretch);
                let curvature =
                    if sliding.end.radius > 0.0 { p.stretch * sliding.end.sense / sliding.end.radius } else { 0.0 };
                if out.last().is_none_or(|l: &Node| p.arc_length > l.arc_length_m + 1e-9) {
                    out.push(node(p.arc_length, (p.at, velocity), p.tension, (curvature, p.force)));
                } else if let Some(last) = out.last_mut() {
                    last.force_n = p.force.into();
                }
            }
            continue;
        }
        let t = match k {
            0 => ends[0].norm(),
            k if k + 1 == n => ends[1].norm(),
            k => 0.5 * (tension[k - 1] + tension[k]),
        };
        let bar = |e: usize| mesh.path(e, x).direction * tension[e] + shear(mesh, &moments, e, x);
        let force = match k {
            0 => ends[0] + shear(mesh, &moments, 0, x),
            k if k + 1 == n => ends[1] + shear(mesh, &moments, k - 1, x),
            k => bar(k) + d.input.body * half(d, k, 1, x),
        };
        // A round that reaches to the node within a step ends there.
        while out.last().is_some_and(|l: &Node| l.arc_length_m >= mesh.arc_length[k]) {
            out.pop();
        }
        let node = node(mesh.arc_length[k], (x[k], v[k]), t, (curvature_at(mesh, k, x), force));
        // Relaxation branches pull beside what the strain makes.
        let beside = if k == 0 { 0..1 } else { k - 1..if k + 1 < n { k + 1 } else { k } };
        let count = beside.len() as f64;
        let by_branches =
            beside.map(|e| if tension[e] > 0.0 { branches::force(d, e) } else { 0.0 }).sum::<f64>() / count;
        out.push(Node { strain: node.strain - by_branches / d.problem.axial_stiffness, ..node });
    }
    out
}

/// Force of a round on the cable at a sliding node, N: the change of the internal force without the
/// part of the floor.
fn by_round(load: &Load) -> Vec2 {
    let [before, after] = load.force.map(|f| f.try_normalize(0.0).unwrap_or_default());
    let on = (before + after).try_normalize(0.0).unwrap_or_default();
    -load.jump - before * load.floor[0] - on * load.floor[1] - after * load.floor[2]
}

/// Growth of the logarithm of tension over a small round, in parts of what friction makes of its
/// turn, from which on weight that hangs over it from the bars beside it is told from sag. Less:
/// what a sagging bar rubs in the air beside a corner is said to rub there; more: short pieces rub
/// beyond their cone.
const HANGING_TENSION_GROWTH: f64 = 1.2;

/// Part of what chords are shorter than their arc that goes to the ways beside it. More: they were
/// longer than their material.
const CHORD_CORRECTION_FRACTION: f64 = 0.8;

/// A point of the cable on a round.
struct OnRound {
    arc_length: f64,
    at: Vec2,
    tension: f64,
    /// Internal force just beyond it, N.
    force: Vec2,
    /// Length of a metre of arc length.
    stretch: f64,
}

/// The cable round a corner, post or pulley, from where it meets the round, or from halfway to the
/// sliding node before, to where it leaves it, or halfway to the next. Its tension is that of its
/// weight, and beyond that grows evenly in its logarithm, as friction makes it.
fn on_round(d: &CableState, k: usize, node: &SlidingNode, load: &Load, x: &[Vec2], tension: &[f64]) -> Vec<OnRound> {
    let mesh = &d.mesh;
    let paths = [mesh.path(k - 1, x), mesh.path(k, x)];
    let same = [k - 1, k + 1].map(|j| mesh.sliding[j].is_some_and(|s| s.shares_round(node)));
    // The slack of a bar hangs or lies beside the round: on it the cable is taut.
    let stretch = [0, 1]
        .map(|j| larger(paths[j].length / (mesh.arc_length[k + j] - mesh.arc_length[k + j - 1]), mesh.thermal_stretch));
    let (mark, sense, radius) = (node.end.mark, node.end.sense, node.end.radius);
    // The stretch between the node and the point where the cable meets or leaves the round, at an
    // angle (rad) from it, has its own weight.
    let force_at = |arcs: [f64; 2]| {
        [0, 1].map(|j| load.force[j] - d.input.body * (arcs[j] * radius / stretch[j] * [-1.0, 1.0][j]))
    };
    let sag = |j: usize, from: Vec2, to: Vec2| {
        let sag = sense * angle_between(from, to);
        let longer = radius * sag.abs().powi(3) / 6.0;
        let drawn = !same[j] && longer <= PATH_EXCESS_DIAMETERS * 2.0 * d.problem.radius;
        // A bar that bulges away from the round leaves it sooner; drawn straight it would cut it.
        if drawn { larger(sag, -arc_nodes::early_leave(radius, d.problem.radius)) } else { 0.0 }
    };
    let normal = |turned: f64| {
        let (sin, cos) = (sense * turned).sin_cos();
        Vec2::new(cos * mark.x - sin * mark.y, sin * mark.x + cos * mark.y)
    };
    // It leaves where its force does: what sags turns further round than the straight bar that
    // stands for it, and has less weight beyond.
    let straight = [paths[0].arcs[1], paths[1].arcs[0]];
    // The nearer half of the bar at most: the rest hangs from the node beyond.
    let room = [0, 1].map(|j| larger(0.5 * (paths[j].length / radius - straight[j]), 0.0));
    let mut sagged = straight;
    for _ in 0..SAG_ROUNDS {
        let ends = force_at(sagged);
        let sags = [sag(0, ends[0], paths[0].direction), sag(1, paths[1].direction, ends[1])];
        // A bar that bulges away may leave at the mark of the round, but not before.
        sagged = [0, 1].map(|j| larger(straight[j] + smaller(sags[j], room[j]), smaller(straight[j], 0.0)));
    }
    // As far round as it would run into an edge beside a corner it does not sag.
    let clear =
        |turned: f64| !IntersectionCheck::of(d).is_over_an_edge(node, node.end.center + normal(turned) * radius, 0.0);
    let before = if clear(-sagged[0]) { sagged[0] } else { straight[0] };
    let after = if clear(sagged[1]) { sagged[1] } else { straight[1] };
    // A last mark that the cable has come off, to be taken out after the step, is drawn with the
    // round up to it.
    let came_off = before + after <= 0.0 && (same[0] || same[1]);
    let [before, after] = if came_off { [before, after].map(|arc| larger(arc, 0.0)) } else { [before, after] };
    let ends = force_at([before, after]);
    let whole = before + after;
    if !(whole > 0.0 && radius > 0.0) {
        return vec![OnRound {
            arc_length: mesh.arc_length[k],
            at: node.position(),
            tension: larger(load.tension[0], load.tension[1]),
            force: load.force[1],
            stretch: stretch[1],
        }];
    }
    let [a, b] = [0, 1].map(|j| if same[j] { tension[k + j - 1] } else { ends[j].norm() });
    let chords = arc_nodes::parts(radius, whole, d.problem.radius) as f64;
    let count = larger((whole / ARC_STEP).ceil(), chords);
    // The forces of the floor before and after the round are not the round's.
    let [f0, floor, f2] = load.floor;
    let [a, b] = [a - f0, b + f2];
    // dT = −b·dx without friction.
    let first = normal(-before);
    let unrubbed = |normal: Vec2| a - d.input.body.dot(&(normal - first)) * radius / mesh.thermal_stretch;
    let last = unrubbed(normal(after));
    let over = OverRound::between([a, b - (last - a)], floor);
    // On a round that is small beside its bars, friction of the weight that hangs over it from them
    // is beside it: on the round it is no more than its turn there allows.
    let grown = (b / last).ln();
    let small = same == [false; 2] && whole * radius < d.mesh.tuning.remesh.one_mark_bars * d.even();
    let most = node.friction * whole;
    let rate = if small && grown.abs() > HANGING_TENSION_GROWTH * most { most.copysign(grown) } else { grown };
    // The load beside it acts where the weight hangs: before the round and after it by the angle
    // there between the cable's force and the end of the arc.
    let tangents = [-before, after].map(|turned| perp(normal(turned)) * sense);
    let hangs = [angle_between(ends[0], tangents[0]), angle_between(tangents[1], ends[1])]
        .map(|angle| larger(sense * angle, 0.0));
    let part_before = if hangs[0] + hangs[1] > 0.0 { hangs[0] / (hangs[0] + hangs[1]) } else { 0.5 };
    let begins = (part_before * (grown - rate)).exp();
    let at = |i: f64| {
        let f = i / count;
        let turned = f * whole - before;
        let stretch = stretch[usize::from(turned > 0.0)];
        let normal = normal(turned);
        let smooth = unrubbed(normal);
        let tension = if floor != 0.0 {
            over.map_or(a + (b - a) * f, |over| over.at(f) + smooth - a)
        } else if a > 0.0 && b > 0.0 && smooth > 0.0 && last > 0.0 {
            smooth * begins * (rate * f).exp()
        } else {
            a + (b - a) * f
        };
        // The floor's friction of half of what lies beside a point acts at it, as it does at a node
        // of the cable.
        let beyond = if i < count { tension - 0.5 * floor / count } else { tension - f2 };
        let force = perp(normal) * (sense * beyond);
        let arc_length = mesh.arc_length[k] + turned * radius / stretch;
        OnRound { arc_length, at: node.end.center + normal * radius, tension, force, stretch }
    };
    let mut points: Vec<OnRound> = (0..=count as usize).map(|i| at(i as f64)).collect();
    // Friction on the round strains what lies there otherwise than the straight part beyond, which
    // has its own tension. And what sags on to the round, or comes from inside its gap, comes and
    // goes by a longer way than the bar: by as much as chords are shorter than their arc the round
    // has material to spare.
    let half = 0.5 * whole / count;
    let sides = if same.contains(&true) { 1.0 } else { 2.0 };
    let spare = CHORD_CORRECTION_FRACTION / sides * (whole - count * 2.0 * half.sin()) * radius;
    for j in [0, 1] {
        let (bar, beside) = (k + j - 1, if j == 0 { k - 1 } else { k + 1 });
        let Some(p) = (if j == 0 { points.first_mut() } else { points.last_mut() }) else { continue };
        if mesh.sliding[beside].is_some() {
            continue;
        }
        let strained = |tension: f64| 1.0 + tension / d.problem.axial_stiffness;
        let even = mesh.bar(bar).tension(paths[j].length);
        let beyond = if even > 0.0 { stretch[j] * strained(tension[bar]) / strained(even) } else { stretch[j] };
        let own = (p.arc_length - mesh.arc_length[beside]).abs() * stretch[j] / beyond;
        let more = bounded((p.at - x[beside]).norm() / beyond - own, 0.0, spare / beyond);
        p.arc_length = mesh.arc_length[beside] + [own + more, -own - more][j];
    }
    strain_evenly(&mut points, d.problem.axial_stiffness);
    points
}

/// Spreads the material of an arc as the tension along it strains it; how much of it there is on
/// the whole stays.
fn strain_evenly(points: &mut [OnRound], axial_stiffness: f64) {
    let [Some(begins), Some(ends)] = [points.first(), points.last()].map(|p| p.map(|p| p.arc_length)) else { return };
    // Chords of one round are equally long: their material goes by their strain alone.
    let slackness = |p: &[OnRound]| 1.0 / (1.0 + 0.5 * (p[0].tension + p[1].tension) / axial_stiffness);
    let whole: f64 = points.windows(2).map(slackness).sum();
    if !(whole > 0.0 && whole.is_finite()) {
        return;
    }
    let mut s = begins;
    for k in 1..points.len() {
        s += (ends - begins) * slackness(&points[k - 1..=k]) / whole;
        points[k].arc_length = s;
    }
}

/// d(angle)/d(arc length) at a node, 1/m.
fn curvature_at(mesh: &Mesh, k: usize, x: &[Vec2]) -> f64 {
    if k > 0 && k + 1 < x.len() {
        let rest = 0.5 * (mesh.arc_length[k + 1] - mesh.arc_length[k - 1]);
        return turn(mesh.path(k - 1, x).direction, mesh.path(k, x).direction) / rest;
    }
    let Some(clamp) = mesh.clamps.iter().find(|c| c.node == k) else { return 0.0 };
    let e = if k == 0 { 0 } else { k - 1 };
    let sign = if k == 0 { 1.0 } else { -1.0 };
    sign * turn(clamp.direction, x[e + 1] - x[e]) / (0.5 * (mesh.arc_length[e + 1] - mesh.arc_length[e]))
}

/// Bending moment at each node, N·m; empty for a flexible cable.
fn moments(d: &CableState, x: &[Vec2]) -> Vec<f64> {
    let mesh = &d.mesh;
    if !(mesh.bending_stiffness > 0.0) {
        return Vec::new();
    }
    let slides = |k: usize| mesh.sliding.get(k).is_some_and(Option::is_some);
    let carries = |k: usize| !(slides(k) || slides(k + 1) || k > 0 && slides(k - 1));
    let stiffness = mesh.bending_stiffness / mesh.thermal_stretch;
    (0..x.len()).map(|k| if carries(k) { stiffness * curvature_at(mesh, k, x) } else { 0.0 }).collect()
}

/// Shear force of bar e, N: what balances the moments at its nodes.
fn shear(mesh: &Mesh, moments: &[f64], e: usize, x: &[Vec2]) -> Vec2 {
    let (Some(before), Some(after)) = (moments.get(e), moments.get(e + 1)) else { return Vec2::zeros() };
    let path = mesh.path(e, x);
    if path.length > 0.0 { perp(path.direction) * ((before - after) / path.length) } else { Vec2::zeros() }
}

/// The force of the cable on a pulley with its tensions and arc length.
fn pulley(d: &CableState, support: usize, x: &[Vec2], tension: &[f64]) -> Option<SupportReaction> {
    let slide_over = SlideOver::Pulley(support);
    let on = |k: &usize| d.mesh.sliding[*k].is_some_and(|s| s.slide_over == slide_over);
    let first = (1..x.len() - 1).find(on)?;
    let last = (1..x.len() - 1).rev().find(on)?;
    let (before, after) = (d.load(first)?, d.load(last)?);
    let inner = d.mesh.arc_length[last] - d.mesh.arc_length[first];
    let share = half(d, first, 0, x) + inner + half(d, last, 1, x);
    let directions = [d.mesh.path(first - 1, x).direction, d.mesh.path(last, x).direction];
    let force = directions[1] * tension[last] - directions[0] * tension[first - 1] + d.input.body * share;
    let center = d.mesh.sliding[first]?.end.center;
    Some(SupportReaction {
        name: d.problem.supports.get(support)?.name.clone(),
        x_m: center.x,
        y_m: center.y,
        reaction_x_n: force.x,
        reaction_y_n: force.y,
        arc_length_m: 0.5 * (d.mesh.arc_length[first] + d.mesh.arc_length[last]),
        tension_before_n: Some(before.tension[0]),
        tension_after_n: Some(after.tension[1]),
        hand: None,
    })
}

fn supports(d: &CableState, x: &[Vec2], ends: &[Vec2; 2], tension: &[f64]) -> Vec<SupportReaction> {
    let problem: &Problem = &d.problem;
    problem
        .supports
        .iter()
        .zip(&d.meshing.support_node)
        .enumerate()
        .filter_map(|(k, (s, node))| {
            let Some(node) = *node else { return pulley(d, k, x, tension) };
            let last = x.len() - 1;
            let on_ground = problem.world.signed_gap(x[node], 3.0 * d.contacts.barrier.reach).is_some();
            let hand = d.motion.hands[k];
            let reaction = match node {
                _ if hand.is_some() => d.answers.reaction[node],
                // A dead load is what hangs there: the cable pulls it the other way; a lump it may
                // pull faster. Of one that lies the ground takes a part, which is the contact's.
                _ if !d.mesh.held[node] && on_ground => -problem.hung_on(k, d.time()),
                0 if !d.mesh.held[node] => ends[0],
                k if k == last && !d.mesh.held[node] => -ends[1],
                _ if !d.mesh.held[node] => -problem.hung_on(k, d.time()),
                // On the ground the end's own share of weight and friction is the ground's, not the
                // support's.
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

/// One report for each stretch of neighbouring contacts with one obstacle.
fn contacts(d: &CableState, x: &[Vec2], tension: &[f64], lain: &[Option<Lain>; 2]) -> Vec<ContactReport> {
    let mut touches: Vec<ContactPair> = Vec::new();
    d.contacts.find(&d.problem, &d.mesh, x, &mut touches);
    let mut obstacles: Vec<usize> = touches.iter().map(|t| t.pair.gap.obstacle).collect();
    obstacles.sort_unstable();
    obstacles.dedup();
    let mut out = Vec::new();
    for obstacle in obstacles {
        let mut stretch: Vec<ContactPair> = Vec::new();
        for t in touches.iter().filter(|t| t.pair.gap.obstacle == obstacle) {
            if stretch.last().is_some_and(|l| t.node > l.node + 1) {
                out.push(report(d, x, tension, lain, &stretch));
                stretch.clear();
            }
            stretch.push(*t);
        }
        out.push(report(d, x, tension, lain, &stretch));
    }
    for end in lain.iter().flatten() {
        let (tip, at) = (d.mesh.arc_length[end.node], d.mesh.arc_length[end.next]);
        let name = d.problem.world.obstacle_name(end.obstacle);
        let holds = |c: &&mut ContactReport| c.obstacle == name && c.begins_m <= at && c.ends_m >= at;
        if let Some(c) = out.iter_mut().find(holds) {
            c.normal_n += end.force.dot(&end.normal);
            c.friction_n += end.force.dot(&end.along);
            let mut samples = std::mem::take(&mut c.samples);
            samples.insert(if tip < at { 0 } else { samples.len() }, ContactSample::new(0.5 * (tip + at), end.force));
            c.set_samples(samples);
            (c.begins_m, c.ends_m) = (c.begins_m.min(tip), c.ends_m.max(tip));
            c.arc_length_m += 0.5 * (tip - at);
            let half = (x[end.node] - x[end.next]) * 0.5;
            (c.x_m, c.y_m) = (c.x_m + half.x, c.y_m + half.y);
        } else {
            // Only its end lies there.
            let mut c = ContactReport {
                obstacle: name.to_owned(),
                x_m: x[end.node].x,
                y_m: x[end.node].y,
                arc_length_m: tip,
                normal: [end.normal.x, end.normal.y],
                normal_n: end.force.dot(&end.normal),
                friction_n: end.force.dot(&end.along),
                begins_m: tip,
                ends_m: tip,
                ..ContactReport::default()
            };
            c.set_samples(vec![ContactSample::new(tip, end.force)]);
            out.push(c);
        }
    }
    rounds(d, x, &mut out);
    self_contact::reports(d, x, tension, &mut out);
    out.retain(|c| c.normal_n > 0.0);
    out.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
    out
}

/// One report for each corner, post or circle with sliding nodes.
fn rounds(d: &CableState, x: &[Vec2], out: &mut Vec<ContactReport>) {
    let n = x.len();
    let mut k = 1;
    while k + 1 < n {
        let first = k;
        k += 1;
        let Some(node) = d.mesh.sliding[first] else { continue };
        let SlideOver::Obstacle { obstacle, .. } = node.slide_over else { continue };
        while k + 1 < n && d.mesh.sliding[k].is_some_and(|s| s.shares_round(&node)) {
            k += 1;
        }
        let mut r = ContactReport {
            obstacle: d.problem.world.obstacle_name(obstacle).to_owned(),
            arc_length_m: 0.5 * (d.mesh.arc_length[first] + d.mesh.arc_length[k - 1]),
            ..ContactReport::default()
        };
        // A wrap slips when all of it does: one place that holds is enough for the cable to stay.
        let (mut push, mut turn, mut slips, mut samples) = (Vec2::zeros(), 0.0, true, Vec::new());
        for j in first..k {
            let (Some(load), Some(node)) = (d.load(j), &d.mesh.sliding[j]) else { continue };
            let [before, after] = load.tension;
            // The law of friction holds between the pulls along the bars: what hangs across them is
            // the cable's own weight, and what the floor takes of what slides here is not the
            // round's.
            let acts = node.balanced.unwrap_or(Balanced { pull: load.at_round(), turn: load.turn });
            let [a, b] = acts.pull;
            let floor = load.floor[1];
            let over = OverRound::between([a, b], floor);
            let mean = over.map_or(0.5 * (a + b), |over| over.normal(1.0));
            // A bar that would push lies slack there.
            let pressed = larger(mean * acts.turn, 0.0);
            r.normal_n += pressed;
            push += node.end.mark * pressed;
            turn += load.turn;
            // Without friction what they differ by is weight alone.
            r.friction_n += if node.friction > 0.0 { a - b - floor } else { 0.0 };
            slips &= !node.sticks();
            // The round's own arc on either side of the node is of the contact.
            let lap = |e: usize, side: usize| {
                let stretch = d.mesh.thermal_stretch * (1.0 + load.tension[side] / d.problem.axial_stiffness);
                node.end.radius * d.mesh.path(e, x).arcs[1 - side] / stretch
            };
            if j == first {
                r.tension_before_n = before;
                r.begins_m = d.mesh.arc_length[j] - lap(j - 1, 0);
            }
            r.ends_m = d.mesh.arc_length[j] + lap(j, 1);
            samples.push(ContactSample::new(d.mesh.arc_length[j], by_round(&load)));
            r.tension_after_n = after;
        }
        let normal = if push.norm() > 0.0 { push.normalize() } else { node.end.mark };
        let at = node.end.center + normal * node.end.radius;
        (r.x_m, r.y_m, r.normal) = (at.x, at.y, [normal.x, normal.y]);
        r.turn_deg = node.end.sense * turn.to_degrees();
        r.state = if slips { ContactState::Slip } else { ContactState::Stick };
        r.set_samples(samples);
        out.push(r);
    }
}

fn report(
    d: &CableState,
    x: &[Vec2],
    tension: &[f64],
    lain: &[Option<Lain>; 2],
    stretch: &[ContactPair],
) -> ContactReport {
    let (Some(first), Some(last)) = (stretch.first(), stretch.last()) else {
        return ContactReport::default();
    };
    let bars = tension.len();
    let before = if first.on_segment { first.node } else { first.node.saturating_sub(1) };
    let after = last.node.min(bars - 1);
    let (mut normal, mut normal_n, mut friction_n) = (Vec2::zeros(), 0.0, 0.0);
    // The force on a node that stays, over a round or as an end that lies, belongs to that round or
    // end.
    let stays = |k: usize| d.mesh.sliding[k].is_some() || lain.iter().flatten().any(|l| l.node == k);
    let part = |t: &ContactPair| {
        let [a, b] = t.shares();
        (if stays(t.node) { 0.0 } else { a }) + (if b != 0.0 && !stays(t.node + 1) { b } else { 0.0 })
    };
    for t in stretch {
        let load = t.load(&d.contacts.barrier) * part(t);
        normal_n += load;
        normal += t.pair.gap.normal * load;
    }
    let mut slips = 0.0;
    let rubs = d.contacts.friction_contacts.iter().filter(|r| {
        r.touch.pair.gap.obstacle == first.pair.gap.obstacle && (first.node..=last.node).contains(&r.touch.node)
    });
    for rub in rubs.clone() {
        let e = rub.touch.node.min(bars - 1);
        let along = d.mesh.path(e, x).direction;
        friction_n += d.contacts.friction_force(rub, x).dot(&along) * part(&rub.touch);
        if rub.sliding(x).abs() > 0.999 * d.contacts.slip {
            slips += rub.limit;
        }
    }
    let limit: f64 = stretch.iter().map(|t| t.load(&d.contacts.barrier) * t.pair.gap.friction).sum();
    let (a, b) = (first.interpolate(x), last.interpolate(x));
    let arc = |t: &ContactPair| {
        let s = &d.mesh.arc_length;
        s[t.node] + if t.on_segment { t.pair.gap.fraction * (s[t.node + 1] - s[t.node]) } else { 0.0 }
    };
    let unit = if normal.norm() > 0.0 { normal.normalize() } else { first.pair.gap.normal };
    let middle = (a + b) * 0.5;
    // Summed bar by bar: a wrap may go round more than once.
    let turned: f64 = (before..after)
        .filter(|&e| d.mesh.sliding[e + 1].is_none())
        .map(|e| turn(d.mesh.path(e, x).direction, d.mesh.path(e + 1, x).direction))
        .sum();
    let frictionless = first.pair.gap.friction == 0.0;
    let mut out = ContactReport {
        obstacle: d.problem.world.obstacle_name(first.pair.gap.obstacle).to_owned(),
        x_m: middle.x,
        y_m: middle.y,
        arc_length_m: 0.5 * (arc(first) + arc(last)),
        normal: [unit.x, unit.y],
        normal_n,
        friction_n,
        state: if frictionless || slips > 0.5 * limit { ContactState::Slip } else { ContactState::Stick },
        turn_deg: turned.to_degrees(),
        tension_before_n: tension[before],
        tension_after_n: tension[after],
        begins_m: arc(first),
        ends_m: arc(last),
        ..ContactReport::default()
    };
    let press = |t: &ContactPair| t.pair.gap.normal * (t.load(&d.contacts.barrier) * part(t));
    let mut samples: Vec<ContactSample> = stretch.iter().map(|t| ContactSample::new(arc(t), press(t))).collect();
    for rub in rubs {
        samples.push(ContactSample::new(arc(&rub.touch), d.contacts.friction_force(rub, x) * part(&rub.touch)));
    }
    samples.sort_by(|a, b| a.arc_length_m.total_cmp(&b.arc_length_m));
    out.set_samples(samples);
    out
}
