//! This judge checks the laws that an answer at rest must obey with what is written here alone:
//! brute force over all obstacles, no code of the library's checker or of its contact geometry.

use cable_core::Model;
use cable_core::scene::{Cable, Scene, Shape, SupportKind, View};
use cable_core::solution::{CableSolution, Solution, WarningCause, WarningKind};

use crate::stability::runs_away;

type V = [f64; 2];

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1]]
}
fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1]]
}
fn mul(a: V, k: f64) -> V {
    [a[0] * k, a[1] * k]
}
fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
fn cross(a: V, b: V) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
fn size(a: V) -> f64 {
    a[0].hypot(a[1])
}

/// Forces left over, of the greatest force: what `fem` stops at, some tens of nodes together.
const BALANCE: f64 = 2e-5;
/// The same of contacts and supports as they are reported.
const REPORTED: f64 = 1e-4;
/// Compression of a flexible cable, of the greatest force.
const COMPRESSION: f64 = 2e-5;
/// Friction beyond its cone, of the normal force.
const CONE: f64 = 2e-3;
/// Way too long for the material, of the material.
const TOO_LONG: f64 = 1e-6;

/// The relation of an obstacle to a point: its signed distance, the direction away from it, and how
/// much it rubs.
struct Near {
    gap: f64,
    normal: V,
    friction: f64,
}

fn nearest(p: V, a: V, b: V) -> V {
    let d = sub(b, a);
    let f = (dot(sub(p, a), d) / dot(d, d)).clamp(0.0, 1.0);
    add(a, mul(d, f))
}

/// Obstacles as lines and rounds.
struct World {
    things: Vec<(Shape, f64)>,
}

impl World {
    fn of(scene: &Scene, cable: &Cable, answer: &CableSolution) -> Self {
        let mut things: Vec<_> =
            scene.obstacles.iter().map(|o| (o.shape.clone(), o.friction.unwrap_or(cable.friction))).collect();
        // Wheels turn the cable as posts do.
        for (s, r) in cable.supports.iter().zip(&answer.supports) {
            if let (SupportKind::Pulley, Some(radius_m)) = (s.kind, s.radius_m.filter(|r| *r > 0.0)) {
                let shape = Shape::Circle { center_m: [r.x_m, r.y_m], radius_m };
                things.push((shape, s.friction.unwrap_or(0.0)));
            }
        }
        Self { things }
    }

    /// Everything within `reach` of a point, signed.
    fn near(&self, p: V, reach: f64, out: &mut Vec<Near>) {
        for (shape, friction) in &self.things {
            let friction = *friction;
            match shape {
                Shape::Circle { center_m, radius_m } => {
                    let d = sub(p, *center_m);
                    let gap = size(d) - radius_m;
                    if gap <= reach {
                        out.push(Near { gap, normal: mul(d, 1.0 / size(d).max(1e-300)), friction });
                    }
                }
                Shape::Polyline { points_m, thickness_m } => {
                    for e in points_m.windows(2) {
                        let d = sub(p, nearest(p, e[0], e[1]));
                        let gap = size(d) - 0.5 * thickness_m;
                        if gap <= reach {
                            out.push(Near { gap, normal: mul(d, 1.0 / size(d).max(1e-300)), friction });
                        }
                    }
                }
                Shape::Terrain { points_m } => Self::solid(p, points_m, false, (reach, friction), out),
                Shape::Polygon { points_m } => Self::solid(p, points_m, true, (reach, friction), out),
            }
        }
    }

    /// Returns where a piece is nearest to each corner and each round within `reach` of it, as
    /// parts of the piece.
    fn passed(&self, a: V, b: V, reach: f64) -> Vec<f64> {
        let way = sub(b, a);
        let mut out = Vec::new();
        let mut ask = |at: V, radius: f64| {
            let u = (dot(sub(at, a), way) / dot(way, way)).clamp(0.0, 1.0);
            if u > 0.0 && u < 1.0 && size(sub(at, add(a, mul(way, u)))) <= radius + reach {
                out.push(u);
            }
        };
        for (shape, _) in &self.things {
            match shape {
                Shape::Circle { center_m, radius_m } => ask(*center_m, *radius_m),
                Shape::Polyline { points_m, thickness_m } => points_m.iter().for_each(|p| ask(*p, 0.5 * thickness_m)),
                Shape::Terrain { points_m } | Shape::Polygon { points_m } => points_m.iter().for_each(|p| ask(*p, 0.0)),
            }
        }
        out
    }

    fn solid(p: V, points: &[V], closed: bool, (reach, friction): (f64, f64), out: &mut Vec<Near>) {
        let n = points.len();
        let edges = || (0..if closed { n } else { n - 1 }).map(|k| (points[k], points[(k + 1) % n]));
        // Crossings of a ray upwards, signed: into solid ground from an edge that runs to the
        // right.
        let mut sum = 0;
        for (a, b) in edges() {
            let right = a[0] <= p[0] && p[0] < b[0];
            let left = b[0] <= p[0] && p[0] < a[0];
            if (right || left) && a[1] + (b[1] - a[1]) * (p[0] - a[0]) / (b[0] - a[0]) > p[1] {
                sum += if right { 1 } else { -1 };
            }
        }
        let inside = if closed { sum != 0 } else { sum > 0 };
        if !inside {
            for (a, b) in edges() {
                let d = sub(p, nearest(p, a, b));
                if size(d) <= reach {
                    // A point on the line itself has the line's own normal, outwards on its left.
                    let e = sub(b, a);
                    let normal = if size(d) > 0.0 { mul(d, 1.0 / size(d)) } else { mul([-e[1], e[0]], 1.0 / size(e)) };
                    out.push(Near { gap: size(d), normal, friction });
                }
            }
            return;
        }
        let deepest = edges().map(|(a, b)| sub(p, nearest(p, a, b))).min_by(|a, b| size(*a).total_cmp(&size(*b)));
        if let Some(d) = deepest {
            out.push(Near { gap: -size(d), normal: mul(d, -1.0 / size(d).max(1e-300)), friction });
        }
    }
}

/// Returns how far a force is outside the cone of sums of what each contact may do.
fn outside(force: V, near: &[&Near]) -> f64 {
    let turned = |n: V, mu: f64| [n[0] - mu * n[1], n[1] + mu * n[0]];
    let rays: Vec<V> =
        near.iter().flat_map(|n| [turned(n.normal, n.friction), turned(n.normal, -n.friction)]).collect();
    let mut best = size(force);
    for (k, a) in rays.iter().enumerate() {
        let along = dot(force, *a) / dot(*a, *a);
        if along > 0.0 {
            best = best.min(size(sub(force, mul(*a, along))));
        }
        for b in &rays[..k] {
            let det = cross(*a, *b);
            if det.abs() > 1e-12 && cross(force, *b) / det >= 0.0 && cross(*a, force) / det >= 0.0 {
                return 0.0;
            }
        }
    }
    best
}

/// Returns what is wrong with an answer: one line a law, the worst of each.
pub fn faults(scene: &Scene, answer: &Solution) -> Vec<String> {
    let mut out = Vec::new();
    if answer.cables.len() != scene.cables.len() {
        return vec!["cables: not one answer a cable".to_owned()];
    }
    for (cable, found) in scene.cables.iter().zip(&answer.cables) {
        of_cable(scene, cable, (found, answer), &mut out);
        // Told, too, is what is not known to a tenth.
        let told = answer.warnings.iter().any(|w| matches!(w.cause, WarningCause::Unstable))
            || found.error_estimate.is_some_and(|e| e > 0.1);
        out.extend(runs_away(scene, cable, found).filter(|_| !told).map(|why| format!("stability: {why}")));
    }
    out
}

/// The worst of one law.
#[derive(Default)]
struct Worst {
    excess: f64,
    text: String,
}

impl Worst {
    fn tell(&mut self, value: f64, limit: f64, text: impl FnOnce() -> String) {
        let excess = if value.is_finite() { value / limit.max(1e-300) } else { f64::INFINITY };
        if !(value <= limit) && excess > self.excess {
            *self = Self { excess, text: text() };
        }
    }

    fn end(self, law: &str, out: &mut Vec<String>) {
        if self.excess > 0.0 {
            out.push(format!("{law}: {}", self.text));
        }
    }
}

/// Weight and wind, N/m.
pub fn body(scene: &Scene, cable: &Cable) -> V {
    let env = &scene.environment;
    let weight = if scene.view == View::Plan { 0.0 } else { cable.linear_density_kg_per_m * env.gravity_m_per_s2 };
    [env.wind_n_per_m[0], env.wind_n_per_m[1] - weight]
}

/// The greatest force, N; of a cable without any, that of a strain of 1e-7.
pub fn greatest(scene: &Scene, cable: &Cable, found: &CableSolution) -> f64 {
    let tension = found.nodes.iter().map(|n| size(n.force_n).max(n.tension_n.abs())).fold(0.0, f64::max);
    let loads = scene.loads.iter().filter_map(|l| l.force_n).map(size).fold(0.0, f64::max);
    let ends = cable.supports.iter().filter_map(|s| s.force_n).map(size).fold(0.0, f64::max);
    let gravity = scene.environment.gravity_m_per_s2;
    let masses = cable.supports.iter().filter_map(|s| s.mass_kg).map(|m| m * gravity).fold(0.0, f64::max);
    let weight = size(body(scene, cable)).max(cable.linear_density_kg_per_m * gravity) * cable.length_m;
    tension.max(loads).max(ends).max(masses).max(weight).max(1e-7 * cable.axial_stiffness_n)
}

fn of_cable(scene: &Scene, cable: &Cable, (found, answer): (&CableSolution, &Solution), out: &mut Vec<String>) {
    let nodes = &found.nodes;
    let finite = nodes.iter().all(|n| {
        let all = [n.arc_length_m, n.x_m, n.y_m, n.tension_n, n.strain, n.stress_pa, n.curvature_per_m];
        all.iter().chain(&n.force_n).all(|v| v.is_finite())
    }) && found
        .supports
        .iter()
        .all(|s| [s.x_m, s.y_m, s.reaction_x_n, s.reaction_y_n].iter().all(|v| v.is_finite()))
        && found.contacts.iter().all(|c| {
            [c.x_m, c.y_m, c.normal_n, c.friction_n, c.turn_deg].iter().chain(&c.force_n).all(|v| v.is_finite())
        });
    if !finite || nodes.len() < 2 {
        out.push("finite: a number is not".to_owned());
        return;
    }
    let scale = greatest(scene, cable, found);
    let radius = 0.5 * cable.diameter_m;
    let world = World::of(scene, cable, found);
    let load = body(scene, cable);
    let plan = scene.view == View::Plan;
    let floor =
        if plan { cable.friction * cable.linear_density_kg_per_m * scene.environment.gravity_m_per_s2 } else { 0.0 };
    let thermal = 1.0 + cable.thermal_expansion_per_k * scene.environment.temperature_change_k;
    let flexible = cable.bending_stiffness_n_m2 == 0.0;
    let length = cable.length_m;
    // A mesh lumps the weight of a bar at its nodes: next to a contact half a bar's is carried by
    // the wrong one.
    let lump = if matches!(answer.model, Model::Spans | Model::Catenary) { 0.0 } else { size(load) };

    // Ends of the material, and what holds them.
    let mut material = Worst::default();
    material.tell(nodes[0].arc_length_m.abs(), 1e-9 * length, || "does not begin at 0".to_owned());
    material.tell((nodes[nodes.len() - 1].arc_length_m - length).abs(), 1e-9 * length, || {
        "does not end at its length".to_owned()
    });
    for w in nodes.windows(2) {
        let back = w[0].arc_length_m - w[1].arc_length_m;
        material.tell(back, 1e-9 * length, || format!("runs back at {:.4} m", w[0].arc_length_m));
    }
    material.end("material", out);
    let moved = [WarningKind::InitialPenetration, WarningKind::SupportHeld];
    let told = answer.warnings.iter().any(|w| moved.contains(&w.kind));
    let mut held = Worst::default();
    let last = cable.supports.len() - 1;
    for (k, s) in cable.supports.iter().enumerate() {
        if let (SupportKind::Fixed | SupportKind::Clamped, Some(at), true) = (s.kind, s.at_m, k == 0 || k == last) {
            let n = if k == 0 { nodes[0] } else { nodes[nodes.len() - 1] };
            let off = size(sub([n.x_m, n.y_m], at));
            // One that was given in something solid is put outside, and that is said.
            held.tell(if told { 0.0 } else { off }, 1e-6 * length, || format!("end {k} is {off:.3e} m off"));
        }
    }
    held.end("held", out);

    // Point forces on the cable, by arc length.
    let mut points: Vec<(f64, V)> = Vec::new();
    for (k, (s, r)) in cable.supports.iter().zip(&found.supports).enumerate() {
        let at = if k == 0 {
            0.0
        } else if k == last {
            length
        } else {
            r.arc_length_m
        };
        match s.kind {
            SupportKind::Load | SupportKind::Free => {
                let mass = if plan { 0.0 } else { s.mass_kg.unwrap_or(0.0) * scene.environment.gravity_m_per_s2 };
                points.push((at, add(s.force_n.unwrap_or_default(), [0.0, -mass])));
            }
            SupportKind::Pulley if s.radius_m.is_some_and(|r| r > 0.0) => {}
            _ => points.push((at, [-r.reaction_x_n, -r.reaction_y_n])),
        }
    }
    for l in &scene.loads {
        points.push((l.arc_length_m, l.force_n.unwrap_or_default()));
    }

    // The whole: supports and contacts as they are reported.
    if !plan {
        let mut sum = mul(load, length);
        for (_, f) in &points {
            sum = add(sum, *f);
        }
        for (s, r) in cable.supports.iter().zip(&found.supports) {
            if s.kind == SupportKind::Pulley && s.radius_m.is_some_and(|r| r > 0.0) {
                sum = sub(sum, [r.reaction_x_n, r.reaction_y_n]);
            }
        }
        for c in &found.contacts {
            sum = add(sum, c.force_n);
        }
        let mut whole = Worst::default();
        whole.tell(size(sum), REPORTED * scale, || format!("{:.3e} N of {scale:.3e} N are not carried", size(sum)));
        whole.end("whole", out);
    }

    // Contacts as they are reported.
    let mut cone = Worst::default();
    for c in &found.contacts {
        let own = scene.obstacles.iter().find(|o| o.name == c.obstacle).map(|o| o.friction.unwrap_or(cable.friction));
        let Some(mu) = own else { continue };
        cone.tell(-c.normal_n, BALANCE * scale, || format!("`{}` pulls with {:.3e} N", c.obstacle, -c.normal_n));
        let beyond = c.friction_n.abs() - mu * c.normal_n.abs();
        cone.tell(beyond, CONE * c.normal_n.abs() + BALANCE * scale, || {
            format!("`{}` rubs with {:.4e} N where {mu:.4} × {:.4e} N is all", c.obstacle, c.friction_n, c.normal_n)
        });
        // Contact forces where it says.
        let sum = c.samples.iter().fold([0.0; 2], |a, s| add(a, s.force_n));
        let off = size(sub(sum, c.force_n));
        cone.tell(if c.samples.is_empty() { 0.0 } else { off }, BALANCE * scale, || {
            "samples miss the force".to_owned()
        });
    }
    cone.end("reported cone", out);

    // Inside of things; what is near each piece.
    let reach = radius + (0.05 * cable.diameter_m).max(1.2e-3);
    let supports: Vec<V> = cable.supports.iter().filter_map(|s| s.at_m).collect();
    let mut inside = Worst::default();
    let mut near: Vec<Vec<Near>> = Vec::new();
    const PARTS: usize = 4;
    for w in nodes.windows(2) {
        let (a, b) = ([w[0].x_m, w[0].y_m], [w[1].x_m, w[1].y_m]);
        let mut list = Vec::new();
        let bend = w[0].curvature_per_m.abs().max(w[1].curvature_per_m.abs());
        let turn = turn_between(w[0].force_n, w[1].force_n).min(1.0);
        let way = size(sub(b, a));
        let sagitta = (bend * way * way / 8.0).max(turn * way / 8.0);
        // Evenly, and where the piece passes corners and rounds: there it leans on them, across
        // itself.
        let even = (0..=PARTS).map(|k| k as f64 / PARTS as f64);
        for u in even.chain(world.passed(a, b, reach + sagitta)) {
            let p = add(a, mul(sub(b, a), u));
            let from = list.len();
            world.near(p, reach + sagitta, &mut list);
            let allowed = (0.02 * cable.diameter_m).min(1e-3) + if u == 0.0 || u == 1.0 { 0.0 } else { sagitta };
            for n in &list[from..] {
                let deep = radius - n.gap;
                // A support that holds the axis on a surface, or in something, was given so.
                if supports.iter().any(|s| size(sub(*s, p)) <= 4.0 * radius.max(0.0)) {
                    continue;
                }
                inside.tell(deep, allowed, || format!("{deep:.3e} m at ({:.4}, {:.4})", p[0], p[1]));
            }
        }
        near.push(list);
    }
    inside.end("inside", out);

    // Each piece: what obstacles must do to it follows from its inner forces.
    let mut needed: Vec<V> = Vec::new();
    let same = 1e-9 * length;
    let mut used = vec![false; points.len()];
    let mut carried = [0.0; 2];
    for (k, w) in nodes.windows(2).enumerate() {
        let ds = w[1].arc_length_m - w[0].arc_length_m;
        let mut sum = add(sub(w[1].force_n, w[0].force_n), mul(load, ds));
        if k == 0 {
            sum = add(sum, w[0].force_n);
        }
        if k + 2 == nodes.len() {
            sum = sub(sum, w[1].force_n);
        }
        for (i, (s, f)) in points.iter().enumerate() {
            if !used[i] && (*s <= w[1].arc_length_m + same || k + 2 == nodes.len()) {
                used[i] = true;
                sum = add(sum, *f);
            }
        }
        // Nodes at one place of the material are one.
        sum = add(sum, carried);
        let one = nodes.get(k + 2).is_some_and(|n| n.arc_length_m <= w[1].arc_length_m + same);
        (carried, sum) = if one { (sum, [0.0; 2]) } else { ([0.0; 2], sum) };
        needed.push(mul(sum, -1.0));
    }
    let mut piece = Worst::default();
    let mut friction = Worst::default();
    let foreign = found.contacts.iter().any(|c| {
        scene.obstacles.iter().all(|o| o.name != c.obstacle) && cable.supports.iter().all(|s| s.name != c.obstacle)
    });
    for (k, force) in needed.iter().enumerate() {
        if foreign {
            break;
        }
        let mut around: Vec<&Near> = near[k].iter().collect();
        if k > 0 {
            around.extend(&near[k - 1]);
        }
        if let Some(next) = near.get(k + 1) {
            around.extend(next);
        }
        let ds = nodes[k + 1].arc_length_m - nodes[k].arc_length_m;
        let after = nodes.get(k + 2).map_or(0.0, |n| n.arc_length_m - nodes[k + 1].arc_length_m);
        let before = if k > 0 { nodes[k].arc_length_m - nodes[k - 1].arc_length_m } else { 0.0 };
        let beside = before.max(after);
        // The floor of a plan view holds any way.
        let floor = floor * (ds + beside);
        let limit = BALANCE * scale + floor;
        let at = || format!("at {:.4} m, ({:.4}, {:.4})", nodes[k].arc_length_m, nodes[k].x_m, nodes[k].y_m);
        if around.is_empty() {
            piece.tell(size(*force), limit, || format!("{:.3e} N of {scale:.3e} N {}, in the air", size(*force), at()));
        } else {
            let off = outside(*force, &around);
            friction.tell(off, limit + CONE * size(*force) + 0.5 * lump * ds.max(beside), || {
                format!("{off:.3e} N beyond the cone of {:.3e} N {}", size(*force), at())
            });
        }
    }
    piece.end("piece", out);
    friction.end("cone", out);

    // Tension: no pushing, and the force's size.
    if flexible {
        let mut pushes = Worst::default();
        for n in nodes {
            pushes.tell(-n.tension_n, COMPRESSION * scale, || {
                format!("{:.3e} N at {:.4} m", -n.tension_n, n.arc_length_m)
            });
        }
        for w in nodes.windows(2) {
            let chord = sub([w[1].x_m, w[1].y_m], [w[0].x_m, w[0].y_m]);
            let along = dot(w[0].force_n, chord) / size(chord).max(1e-300);
            // Over a turn by more than a right angle the chord says nothing.
            if turn_between(w[0].force_n, w[1].force_n) < 0.5
                && size(chord) > 0.5 * (w[1].arc_length_m - w[0].arc_length_m)
                && size(chord) > 1e-9 * length
            {
                let limit = COMPRESSION * scale + lump * (w[1].arc_length_m - w[0].arc_length_m);
                pushes
                    .tell(-along, limit, || format!("{:.3e} N against its way at {:.4} m", -along, w[0].arc_length_m));
            }
        }
        pushes.end("compression", out);
    }

    // Length.
    let mut long = Worst::default();
    let mut short = Worst::default();
    let mut loose = 0.0;
    for (k, w) in nodes.windows(2).enumerate() {
        let ds = w[1].arc_length_m - w[0].arc_length_m;
        let chord = size(sub([w[1].x_m, w[1].y_m], [w[0].x_m, w[0].y_m]));
        let tension = w[0].tension_n.max(w[1].tension_n).max(size(w[0].force_n));
        // The forces between supports and rounds may be off by the discretisation, of the second
        // order in the turn.
        let turn = turn_between(w[0].force_n, w[1].force_n)
            .max((w[0].curvature_per_m.abs().max(w[1].curvature_per_m.abs())) * ds);
        // A node has the mean of the tensions beside it.
        let pulled =
            nodes[k.saturating_sub(1)..(k + 3).min(nodes.len())].iter().map(|n| n.tension_n).fold(tension, f64::max);
        let full = ds * thermal * (1.0 + (pulled + lump * ds) / cable.axial_stiffness_n);
        let second = if !flexible {
            0.1
        } else if lump > 0.0 {
            1e-3
        } else {
            0.0
        };
        let slack = ds * (TOO_LONG + second * turn * turn) + 1e-9 * length;
        long.tell(chord - full, slack, || format!("{:.3e} m too long at {:.4} m", chord - full, w[0].arc_length_m));
        let least = w[0].tension_n.min(w[1].tension_n).max(if flexible { 0.0 } else { f64::MIN });
        let missing = ds * thermal * (1.0 + least / cable.axial_stiffness_n) - chord;
        let tight = turn < 0.5;
        if tight && missing > ds * (0.1 * turn * turn + 1e-5) + 1e-9 * length {
            loose += missing;
            // Loose material lies: without tension, on something; in the air where nothing pulls it
            // down. The force in a piece follows from that just beyond its first node, whatever
            // acts at the nodes. A slack piece is drawn as its chord c, and hangs below that by
            // √(3/8 c · missing): it may lie on what it meets there.
            let below = mul(load, (0.375 * chord * missing).sqrt() / size(load).max(1e-300));
            let mut met = Vec::new();
            for i in 1..PARTS {
                let u = i as f64 / PARTS as f64;
                let on = add([w[0].x_m, w[0].y_m], mul(sub([w[1].x_m, w[1].y_m], [w[0].x_m, w[0].y_m]), u));
                world.near(add(on, mul(below, 4.0 * u * (1.0 - u))), reach, &mut met);
            }
            // Or on the cable itself.
            let itself = found
                .contacts
                .iter()
                .any(|c| c.obstacle == cable.name && c.begins_m <= w[1].arc_length_m && c.ends_m >= w[0].arc_length_m);
            let touches = itself || !near[k].is_empty() || !met.is_empty();
            let lies = plan || touches || size(load) == 0.0;
            let tension = if plan { tension } else { size(w[0].force_n) };
            let slack = tension <= 1e-3 * scale + 2.0 * size(load) * ds;
            let value = if lies && slack { 0.0 } else { missing };
            short.tell(value, 1e-5 * length, || {
                format!(
                    "{missing:.3e} m gone at {:.4} m ({}, {tension:.3e} N)",
                    w[0].arc_length_m,
                    if lies { "lies" } else { "air" }
                )
            });
        }
    }
    long.end("too long", out);
    short.end("length gone", out);
    let _ = loose;

    // Free ends.
    let mut free = Worst::default();
    for (k, n) in [(0, nodes[0]), (last, nodes[nodes.len() - 1])] {
        let s = &cable.supports[k];
        let touches = if k == 0 { near.first() } else { near.last() }.is_some_and(|n| !n.is_empty());
        if s.kind == SupportKind::Free && s.mass_kg.is_none_or(|m| m == 0.0) && !touches && scene.loads.is_empty() {
            free.tell(n.tension_n.abs(), BALANCE * scale + floor * length / nodes.len() as f64, || {
                format!("{:.3e} N at a free end", n.tension_n)
            });
        }
    }
    free.end("free end", out);
}

/// The angle between two forces, rad.
fn turn_between(a: V, b: V) -> f64 {
    if size(a) == 0.0 || size(b) == 0.0 { std::f64::consts::PI } else { cross(a, b).abs().atan2(dot(a, b)) }
}
