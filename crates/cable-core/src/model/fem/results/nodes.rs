//! The nodes of an answer are those of the mesh, with points on the rounds that sliding nodes lie
//! on.

use crate::math::{Vec2, bounded, larger, perp, smaller};
use crate::model::arc_nodes;
use crate::model::fem::mesh::{SlidingNode, SlidingNodeLoad, angle_between};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::results::forces::{curvature_at, half, moments, shear};
use crate::model::fem::results::weighted_capstan::WeightedCapstan;
use crate::model::fem::state::CableState;
use crate::model::fem::system::RoundFloorFriction;
use crate::model::fem::time::loss_memory;
use crate::solution::Node;

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

pub(super) fn nodes(d: &CableState, x: &[Vec2], v: &[Vec2], tension: &[f64], ends: &[Vec2; 2]) -> Vec<Node> {
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
            k => bar(k) + d.input.loads.body * half(d, k, 1, x),
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
            beside.map(|e| if tension[e] > 0.0 { loss_memory::force(d, e) } else { 0.0 }).sum::<f64>() / count;
        out.push(Node { strain: node.strain - by_branches / d.problem.axial_stiffness, ..node });
    }
    out
}

/// The cable round a corner, post or pulley, from where it meets the round, or from halfway to the
/// sliding node before, to where it leaves it, or halfway to the next. Its tension is what its
/// weight makes of it, and friction that is mobilised evenly; where no friction leads from the one
/// end to the other it goes straight between them.
fn on_round(
    d: &CableState,
    k: usize,
    node: &SlidingNode,
    load: &SlidingNodeLoad,
    x: &[Vec2],
    tension: &[f64],
) -> Vec<OnRound> {
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
        [0, 1].map(|j| load.force[j] - d.input.loads.body * (arcs[j] * radius / stretch[j] * [-1.0, 1.0][j]))
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
    let unrubbed = |normal: Vec2| a - d.input.loads.body.dot(&(normal - first)) * radius / mesh.thermal_stretch;
    let last = unrubbed(normal(after));
    let over = RoundFloorFriction::between([a, b - (last - a)], floor);
    let load = [perp(first) * sense, first].map(|v| d.input.loads.body.dot(&v) * radius / mesh.thermal_stretch);
    // Where the weight of a bar hangs over the round, it comes or goes at an angle to its tangent
    // and presses at that one point.
    let tangents = [-before, after].map(|turned| perp(normal(turned)) * sense);
    let kinks = [angle_between(ends[0], tangents[0]), angle_between(tangents[1], ends[1])];
    let kinks = [0, 1].map(|j| if same[j] { 0.0 } else { larger(sense * kinks[j], 0.0) });
    let capstan = WeightedCapstan::between([a, b], whole, load, kinks).filter(|_| floor == 0.0 && a > 0.0 && b > 0.0);
    let at = |i: f64| {
        let f = i / count;
        let turned = f * whole - before;
        let stretch = stretch[usize::from(turned > 0.0)];
        let normal = normal(turned);
        let tension = if let Some(capstan) = capstan {
            capstan.at(whole * f)
        } else {
            let over = over.filter(|_| floor != 0.0);
            over.map_or(a + (b - a) * f, |over| over.at(f) + unrubbed(normal) - a)
        };
        // The floor's friction of half of what lies beside a point acts at it, as it does at a node
        // of the cable.
        let beyond = if i < count { tension - 0.5 * floor / count } else { tension - f2 };
        // Beyond the last point the cable has the force with which it leaves.
        let leaves = i >= count && !same[1] && capstan.is_some();
        let (tension, force) = if leaves { (b, ends[1]) } else { (tension, perp(normal) * (sense * beyond)) };
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
