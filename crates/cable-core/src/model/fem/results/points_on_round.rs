//! This module makes the points that draw the cable round a corner, post or pulley: from where it
//! meets the round (or halfway from the sliding node before) to where it leaves it (or halfway to
//! the next one).
//!
//! Their tensions follow from the weight of the cable and evenly mobilised friction. If no
//! mobilised friction connects the tensions at both ends, the tension is interpolated linearly.

use crate::math::{Vec2, bounded, larger, perp, smaller};
use crate::model::arc_nodes;
use crate::model::fem::mesh::{SlidingNode, SlidingNodeLoad, TangentPath, angle_between};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::results::weighted_capstan::WeightedCapstan;
use crate::model::fem::state::CableState;
use crate::model::fem::system::RoundFloorFriction;

/// Greatest angle between two nodes on a round, rad.
const ARC_STEP: f64 = 0.13;

/// Number of iterations that find where a sagging cable leaves a round: each reduces the error by
/// the ratio of the weight on the round to the tension.
const SAG_ROUNDS: usize = 4;

/// Excess of the drawn path over its material, as a fraction of the diameter, where a sagging bar
/// leaves a round by an angle δ sooner or later than a straight one, which makes it rδ³/6 longer.
/// Larger: for slack bars, whose sag is not known, more cable is drawn than there is; smaller: the
/// force leads away from the drawn round.
const PATH_EXCESS_DIAMETERS: f64 = 0.005;

/// Fraction of the length by which chords are shorter than their arc that goes to the bars beside
/// the round. Larger: they became longer than their material.
const CHORD_CORRECTION_FRACTION: f64 = 0.8;

/// A point of the cable on a round.
pub(super) struct OnRound {
    pub arc_length: f64,
    pub at: Vec2,
    pub tension: f64,
    /// Internal force just after it, N.
    pub force: Vec2,
    /// Stretched length of a metre of arc length.
    pub stretch: f64,
}

/// The points of the cable on the round of the sliding node `k`, in order.
pub(super) fn points_on_round(
    cable: &CableState,
    k: usize,
    node: &SlidingNode,
    load: &SlidingNodeLoad,
    x: &[Vec2],
    tension: &[f64],
) -> Vec<OnRound> {
    let round = Round::at(cable, k, node, load, x);
    let arcs = round.wrapped_arcs();
    if !(arcs[0] + arcs[1] > 0.0 && node.end.radius > 0.0) {
        return vec![round.point_off(arcs)];
    }
    let tensions = RoundTension::of(&round, arcs, tension);
    let count = tensions.count;
    let mut points: Vec<OnRound> = (0..=count as usize).map(|i| round.point(&tensions, i as f64)).collect();
    round.share_chord_excess(&mut points, tensions.whole, count, x, tension);
    strain_evenly(&mut points, cable.problem.axial_stiffness);
    points
}

/// A round with the two bars beside its sliding node; angles are measured from the mark of the
/// node, rad.
struct Round<'a> {
    cable: &'a CableState,
    k: usize,
    node: &'a SlidingNode,
    load: &'a SlidingNodeLoad,
    paths: [TangentPath; 2],
    /// True if the node before it, or the node after it, lies on the same round.
    shared: [bool; 2],
    /// Stretched length of a metre of arc length before and after the node.
    stretch: [f64; 2],
}

impl<'a> Round<'a> {
    /// The round of sliding node `k`, with the paths of the bars beside it.
    fn at(cable: &'a CableState, k: usize, node: &'a SlidingNode, load: &'a SlidingNodeLoad, x: &[Vec2]) -> Self {
        let mesh = &cable.mesh;
        let paths = [mesh.path(k - 1, x), mesh.path(k, x)];
        let shared = [k - 1, k + 1].map(|j| mesh.sliding[j].is_some_and(|s| s.shares_round(node)));
        // The slack of a bar hangs or lies beside the round; on the round the cable is taut.
        let stretch = [0, 1].map(|j| {
            larger(paths[j].length / (mesh.arc_length[k + j] - mesh.arc_length[k + j - 1]), mesh.thermal_stretch)
        });
        Self { cable, k, node, load, paths, shared, stretch }
    }

    /// The outward unit normal at an angle.
    fn normal(&self, turned: f64) -> Vec2 {
        let (mark, sense) = (self.node.end.mark, self.node.end.sense);
        let (sin, cos) = (sense * turned).sin_cos();
        Vec2::new(cos * mark.x - sin * mark.y, sin * mark.x + cos * mark.y)
    }

    /// Forces in the cable where it meets and leaves the round, at angles from the node, N; they
    /// include the weight of the cable between.
    fn forces_at_ends(&self, arcs: [f64; 2]) -> [Vec2; 2] {
        let (body, radius) = (self.cable.input.loads.body, self.node.end.radius);
        [0, 1].map(|j| self.load.force[j] - body * (arcs[j] * radius / self.stretch[j] * [-1.0, 1.0][j]))
    }

    /// The angle by which a bar on side `j` sags on to the round, or bulges away from it: the angle
    /// between its force and its path.
    fn sag(&self, j: usize, from: Vec2, to: Vec2) -> f64 {
        let (sense, radius) = (self.node.end.sense, self.node.end.radius);
        let sag = sense * angle_between(from, to);
        let longer = radius * sag.abs().powi(3) / 6.0;
        let drawn = !self.shared[j] && longer <= PATH_EXCESS_DIAMETERS * 2.0 * self.cable.problem.radius;
        // A bar that bulges away from the round leaves it sooner; drawn straight it would cut into
        // the round.
        if drawn { larger(sag, -arc_nodes::early_leave(radius, self.cable.problem.radius)) } else { 0.0 }
    }

    /// The angles before and after the node over which the cable lies on the round. It leaves the
    /// round where its force is tangent: a sagging cable turns further round than its straight bar,
    /// and has less weight beyond.
    fn wrapped_arcs(&self) -> [f64; 2] {
        let (paths, radius) = (&self.paths, self.node.end.radius);
        let straight = [paths[0].arcs[1], paths[1].arcs[0]];
        // At most the nearer half of the bar counts: the rest hangs from the node beyond.
        let room = [0, 1].map(|j| larger(0.5 * (paths[j].length / radius - straight[j]), 0.0));
        let mut sagged = straight;
        for _ in 0..SAG_ROUNDS {
            let ends = self.forces_at_ends(sagged);
            let sags = [self.sag(0, ends[0], paths[0].direction), self.sag(1, paths[1].direction, ends[1])];
            // A bar that bulges away may leave at the mark of the round, but not before.
            sagged = [0, 1].map(|j| larger(straight[j] + smaller(sags[j], room[j]), smaller(straight[j], 0.0)));
        }
        // It does not sag so far round that it would run into an edge beside the corner.
        let clear = |turned: f64| {
            let at = self.node.end.center + self.normal(turned) * radius;
            !IntersectionCheck::of(self.cable).is_over_an_edge(self.node, at, 0.0)
        };
        let before = if clear(-sagged[0]) { sagged[0] } else { straight[0] };
        let after = if clear(sagged[1]) { sagged[1] } else { straight[1] };
        // A last mark that the cable has left, and that will be removed after the step, is drawn
        // with the round up to it.
        let came_off = before + after <= 0.0 && (self.shared[0] || self.shared[1]);
        if came_off { [before, after].map(|arc| larger(arc, 0.0)) } else { [before, after] }
    }

    /// The single point of a cable that has come off the round: it runs straight past, near the
    /// point where its two tangents meet. Drawn through the mark it would cut into the round.
    fn point_off(&self, [before, after]: [f64; 2]) -> OnRound {
        let (mesh, radius) = (&self.cable.mesh, self.node.end.radius);
        let turned = if radius > 0.0 { 0.5 * (after - before) } else { 0.0 };
        let half = smaller(-0.5 * (before + after), mesh.tuning.remesh.max_tangent_half_turn_rad);
        let out = if radius > 0.0 { 1.0 / half.cos() } else { 1.0 };
        OnRound {
            arc_length: mesh.arc_length[self.k] + turned * radius / self.stretch[usize::from(turned > 0.0)],
            at: self.node.end.center + self.normal(turned) * (radius * out),
            tension: larger(self.load.tension[0], self.load.tension[1]),
            force: self.load.force[1],
            stretch: self.stretch[1],
        }
    }

    /// The point `i` of those that divide the arc evenly.
    fn point(&self, tensions: &RoundTension, i: f64) -> OnRound {
        let (count, radius, sense) = (tensions.count, self.node.end.radius, self.node.end.sense);
        let f = i / count;
        let turned = f * tensions.whole - tensions.before;
        let stretch = self.stretch[usize::from(turned > 0.0)];
        let normal = self.normal(turned);
        let tension = tensions.at(self, f, normal);
        // Half of the floor's friction on the chords beside a point acts at it, as at a node of the
        // cable.
        let beyond = if i < count { tension - 0.5 * tensions.floor / count } else { tension - self.load.floor[2] };
        // After the last point the cable has the force with which it leaves the round.
        let leaves = i >= count && !self.shared[1] && tensions.capstan.is_some();
        let (tension, force) =
            if leaves { (tensions.ends[1], tensions.forces[1]) } else { (tension, perp(normal) * (sense * beyond)) };
        let arc_length = self.cable.mesh.arc_length[self.k] + turned * radius / stretch;
        OnRound { arc_length, at: self.node.end.center + normal * radius, tension, force, stretch }
    }

    /// Gives the bars beside the round the excess material of its chords. Friction gives the arc
    /// another strain than the straight part beyond, which has its own tension. A cable that sags
    /// on to the round, or lies inside its gap, has a longer path than the bar; the chords, which
    /// are shorter than their arc, leave that much material.
    fn share_chord_excess(&self, points: &mut [OnRound], whole: f64, count: f64, x: &[Vec2], tension: &[f64]) {
        let (mesh, stretch, radius) = (&self.cable.mesh, self.stretch, self.node.end.radius);
        let half = 0.5 * whole / count;
        let sides = if self.shared.contains(&true) { 1.0 } else { 2.0 };
        let spare = CHORD_CORRECTION_FRACTION / sides * (whole - count * 2.0 * half.sin()) * radius;
        for j in [0, 1] {
            let (bar, beside) = (self.k + j - 1, if j == 0 { self.k - 1 } else { self.k + 1 });
            let Some(p) = (if j == 0 { points.first_mut() } else { points.last_mut() }) else { continue };
            if mesh.sliding[beside].is_some() {
                continue;
            }
            let strained = |tension: f64| 1.0 + tension / self.cable.problem.axial_stiffness;
            let even = mesh.tension(bar, self.paths[j].length);
            let beyond = if even > 0.0 { stretch[j] * strained(tension[bar]) / strained(even) } else { stretch[j] };
            let own = (p.arc_length - mesh.arc_length[beside]).abs() * stretch[j] / beyond;
            let more = bounded((p.at - x[beside]).norm() / beyond - own, 0.0, spare / beyond);
            p.arc_length = mesh.arc_length[beside] + [own + more, -own - more][j];
        }
    }
}

/// The course of the tension along a round, and the number of chords that draw it.
struct RoundTension {
    /// Angle from the point where the cable meets the round to its node, rad.
    before: f64,
    /// Angle over which the cable lies on the round, rad.
    whole: f64,
    /// Number of chords that draw it.
    count: f64,
    /// Forces in the cable where it meets and leaves the round, N.
    forces: [Vec2; 2],
    /// Tensions there without the friction of the floor beside the round, N.
    ends: [f64; 2],
    /// Friction of the floor of a plan view on the round, N.
    floor: f64,
    /// Outward normal where the cable meets the round.
    first: Vec2,
    over_floor: Option<RoundFloorFriction>,
    capstan: Option<WeightedCapstan>,
}

impl RoundTension {
    /// The distribution of tension over an arc that begins `before` and ends `after` the mark
    /// (rad).
    fn of(round: &Round<'_>, [before, after]: [f64; 2], tension: &[f64]) -> Self {
        let (cable, k, radius, sense) = (round.cable, round.k, round.node.end.radius, round.node.end.sense);
        let forces = round.forces_at_ends([before, after]);
        let whole = before + after;
        let [a, b] = [0, 1].map(|j| if round.shared[j] { tension[k + j - 1] } else { forces[j].norm() });
        let chords = arc_nodes::parts(radius, whole, cable.problem.radius) as f64;
        let count = larger((whole / ARC_STEP).ceil(), chords);
        // The friction of the floor before and after the round does not belong to the round.
        let [f0, floor, f2] = round.load.floor;
        let [a, b] = [a - f0, b + f2];
        let first = round.normal(-before);
        let load =
            [perp(first) * sense, first].map(|v| cable.input.loads.body.dot(&v) * radius / cable.mesh.thermal_stretch);
        // If the weight of a bar hangs over the round, the cable meets or leaves the round at an
        // angle to its tangent and presses at that point.
        let tangents = [-before, after].map(|turned| perp(round.normal(turned)) * sense);
        let kinks = [angle_between(forces[0], tangents[0]), angle_between(tangents[1], forces[1])];
        let kinks = [0, 1].map(|j| if round.shared[j] { 0.0 } else { larger(sense * kinks[j], 0.0) });
        let capstan =
            WeightedCapstan::between([a, b], whole, load, kinks).filter(|_| floor == 0.0 && a > 0.0 && b > 0.0);
        let mut found = Self { before, whole, count, forces, ends: [a, b], floor, first, over_floor: None, capstan };
        let last = found.without_friction(round, round.normal(after));
        found.over_floor = RoundFloorFriction::between([a, b - (last - a)], floor).filter(|_| floor != 0.0);
        found
    }

    /// The tension at a normal without friction, N: dT = −b·dx.
    fn without_friction(&self, round: &Round<'_>, normal: Vec2) -> f64 {
        let (cable, radius) = (round.cable, round.node.end.radius);
        self.ends[0] - cable.input.loads.body.dot(&(normal - self.first)) * radius / cable.mesh.thermal_stretch
    }

    /// The tension at a fraction of the arc, N.
    fn at(&self, round: &Round<'_>, fraction: f64, normal: Vec2) -> f64 {
        let [a, b] = self.ends;
        match (&self.capstan, &self.over_floor) {
            (Some(capstan), _) => capstan.at(self.whole * fraction),
            (None, Some(over)) => over.at(fraction) + self.without_friction(round, normal) - a,
            (None, None) => a + (b - a) * fraction,
        }
    }
}

/// Spreads the material of an arc by the strain of the tension along it; its total does not change.
fn strain_evenly(points: &mut [OnRound], axial_stiffness: f64) {
    let [Some(begins), Some(ends)] = [points.first(), points.last()].map(|p| p.map(|p| p.arc_length)) else { return };
    // Chords of one round have equal lengths, so their material depends on their strain alone.
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
