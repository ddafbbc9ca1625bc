//! The mesh adapts between steps: sliding nodes come and go, and nodes beside them make room.
//!
//! After every accepted step
//! - a sliding node that no longer presses on its corner is let go (the round is as far out as the
//!   barrier reaches, so nothing jumps);
//! - a corner or circle that presses on a bar or a node gets a sliding node;
//! - marks are moved to the middle of the arc, long arcs get more nodes (friction acts at them),
//!   passed ones lose theirs;
//! - bars that grew too long are cut, nodes that came too near a sliding one are taken out.
//!
//! Material, place and momentum of what stays are left as they are.

use crate::contact::friction;
use crate::math::{Vec2, bounded, perp, smaller};
use crate::model::Inertia;
use crate::model::fem::mesh::sliding_node::{Load, SlideOver, SlidingNode, round_of};
use crate::model::fem::mesh::tangent_path::{End, Path, angle_between};
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::bar_energy;
use crate::model::fem::system::bar_weight::Weight;
use crate::model::fem::system::floor_friction;
use crate::model::fem::system::step_input::load_scale;

/// Least part of the material between two nodes on each side of a node put between them.
const LEAST_PART: f64 = 1e-3;

/// The shares of two bars in their material where their paths change.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// Part of the first.
    first: f64,
    /// Growth of the strain of stretched bars; less than zero: the slack that is left.
    added_strain: f64,
}

impl Share {
    /// Ways (m), how much each bar is stretched (length over unstretched length), and the
    /// unstretched length of both (m). What is stretched keeps its strain and takes what it needs
    /// for that from what is slack; where that is not enough both are stretched by as much more.
    fn of(ways: [f64; 2], stretch: [f64; 2], whole: f64) -> Self {
        let needs = [0, 1].map(|j| if stretch[j] > 1.0 { ways[j] / stretch[j] } else { ways[j] });
        let sum = needs[0] + needs[1];
        let first = match stretch.map(|s| s > 1.0) {
            [true, false] if sum < whole => needs[0] / whole,
            [false, true] if sum < whole => 1.0 - needs[1] / whole,
            _ => needs[0] / sum,
        };
        Self { first: bounded(first, LEAST_PART, 1.0 - LEAST_PART), added_strain: sum / whole - 1.0 }
    }
}

/// The effect of a change of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::model::fem) struct Remeshed {
    /// The cable runs over other corners and rounds.
    pub(in crate::model::fem) seats: bool,
    /// Its bars are not those that were balanced.
    pub(in crate::model::fem) bars: bool,
    /// Material went from bar to bar as marks on rounds were moved.
    pub(in crate::model::fem) marks: bool,
}

impl CableState {
    /// Adapts the mesh to what the cable runs over, without inertia or with it.
    pub(in crate::model::fem) fn remesh(&mut self, inertia: Inertia) -> Remeshed {
        let rests = inertia == Inertia::QuasiStatic;
        if self.contacts.own.shape.is_on() {
            return Remeshed::default();
        }
        let mut changed = self.remove_sliding_nodes(&[], rests);
        let taken = self.add_sliding_nodes(rests);
        if !taken.is_empty() {
            // A node that took hold may lift its neighbour off. Itself it waits for a step where
            // inertia does not count: it took over weight of the nodes beside it, which under a
            // corner pulls it away until they have moved.
            self.remove_sliding_nodes(if rests { &taken } else { &[] }, rests);
            changed = true;
        }
        let moved = self.move_marks(rests);
        let wound = self.wind(rests);
        let evened = self.even_out();
        let bars = changed || wound || evened;
        if bars || moved {
            let x = std::mem::take(&mut self.motion.x);
            self.contacts.prepare(&self.problem, &self.mesh, &x, &x);
            self.motion.x = x;
            self.renew_input();
        }
        Remeshed { seats: changed, bars, marks: moved }
    }

    /// Length of an even bar, m of arc length.
    pub(in crate::model::fem) fn even(&self) -> f64 {
        self.problem.length / self.meshing.even_bars as f64
    }

    /// Distance at which the cable runs round a corner or circle, m: the reach of the barrier, but
    /// no more than that of an end of the cable that is fixed on that round.
    pub(in crate::model::fem) fn clearance(&self, feature: usize) -> f64 {
        let reach = self.contacts.barrier.reach;
        let Some((center, radius)) = round_of(self.problem.world.geometry(), feature, 0.0, 0.0) else { return reach };
        let fixed = [0, self.mesh.nodes() - 1].into_iter().filter(|&k| self.mesh.held[k]);
        let gaps = fixed.map(|k| bounded((self.motion.x[k] - center).norm() - radius, 0.0, reach));
        gaps.fold(reach, smaller)
    }

    /// The load of a sliding node as the cable lies now.
    pub(in crate::model::fem) fn load(&self, k: usize) -> Option<Load> {
        self.load_at(k, &self.motion.x, None)
    }

    /// The load of a sliding node at positions `x` (m) and slides (m), if there are such.
    pub(in crate::model::fem) fn load_at(&self, k: usize, x: &[Vec2], slide: Option<&[f64]>) -> Option<Load> {
        let (mesh, node) = (&self.mesh, self.mesh.sliding.get(k)?.as_ref()?);
        if k == 0 || k + 1 >= mesh.nodes() {
            return None;
        }
        let path = [mesh.path(k - 1, x), mesh.path(k, x)];
        let rest = [k - 1, k].map(|e| slide.map_or(mesh.rest_length[e], |s| bar_energy::rest_length(mesh, e, s)));
        // A step balances the pull with its loss.
        let tension = [0, 1].map(|j| {
            if slide.is_some() && self.input.moves {
                return bar_energy::pull_on(mesh, &self.input, k - 1 + j, x, rest[j]);
            }
            let elastic = mesh.axial_stiffness * (path[j].length / rest[j] - 1.0);
            if elastic < 0.0 { 0.0 } else { elastic }
        });
        let body = self.input.body;
        let weight = [0, 1].map(|j| Weight::of(mesh, k - 1 + j, &path[j], body));
        let material = rest.map(|l| l / mesh.thermal_stretch);
        let share = [0, 1].map(|j| weight[j].carried(material[j])[1 - j]);
        let straight = [0, 1].map(|j| weight[j].in_the_middle(tension[j], material[j], true));
        let floor = self.problem.floor_friction.map_or([0.0; 3], |(rough, normal)| {
            let slid = self.contacts.floor_slid[k].x + slide.map_or(0.0, |s| s[k]);
            let per_m = friction::at(slid, rough * normal, self.contacts.slip).1;
            floor_friction::reaches(mesh, k, x, slide).map(|reach| per_m * reach)
        });
        let load = Load::new(node, straight, [&path[0], &path[1]], body, share);
        // Between steps the input may be of another mesh, and nothing is balanced.
        let at_material = slide.map_or(load.pull, |slide| {
            [k - 1, k].map(|e| bar_energy::pull_at_slide(mesh, &self.input, e, k - e, x, slide))
        });
        let lifted = [0, 1].map(|j| tension[j] + body.dot(&(weight[j].center - x[k])));
        Some(Load { floor, lifted, at_material, ..load })
    }

    /// Lets go of the sliding nodes that press on nothing, but for those on `kept`; returns whether
    /// there were any.
    fn remove_sliding_nodes(&mut self, kept: &[SlideOver], rests: bool) -> bool {
        let mut changed = false;
        let mut k = 1;
        while k + 1 < self.mesh.nodes() {
            let leaves = match self.mesh.sliding[k].map(|s| s.slide_over) {
                None => false,
                Some(SlideOver::Pulley(support)) => {
                    self.problem.supports.get(support).is_none_or(|s| !s.holds_from(self.motion.time))
                }
                Some(slide_over @ SlideOver::Obstacle { .. }) => !kept.contains(&slide_over) && self.lifts_off(k),
            };
            if leaves && self.runs_straight(k) && self.clear_without(k) {
                self.remove(k);
                changed = true;
            } else if leaves && (rests || self.settles_unstretched(k)) && self.settle_down(k) {
                changed = true;
                k += 1;
            } else if leaves && rests && self.clear_without(k) {
                self.remove(k);
                changed = true;
            } else {
                k += 1;
            }
        }
        changed
    }

    /// A node that moves with its material becomes a sliding one.
    fn pin_down(&mut self, k: usize, arc_length: f64, sliding: SlidingNode) {
        self.as_of(sliding.slide_over, |d| d.make_sliding(k, arc_length, sliding));
    }

    fn make_sliding(&mut self, k: usize, arc_length: f64, sliding: SlidingNode) {
        self.keep_answer();
        let along = self.mesh.path(k - 1, &self.motion.x).direction;
        let (mesh, m) = (&mut self.mesh, &mut self.motion);
        mesh.sliding[k] = Some(sliding);
        mesh.arc_length[k] = arc_length;
        for e in [k - 1, k] {
            mesh.rest_length[e] = mesh.thermal_stretch * (mesh.arc_length[e + 1] - mesh.arc_length[e]);
        }
        m.w[k] = -m.v[k].dot(&along);
        m.w_before[k] = m.w[k];
        m.s_before[k] = arc_length - m.w[k] * m.step_before;
        m.x[k] = sliding.position();
        m.x_before[k] = m.x[k];
        m.v[k] = Vec2::zeros();
        m.v_before[k] = Vec2::zeros();
        self.contacts.floor_slid[k] = floor_friction::as_slide(self.contacts.floor_slid[k], along);
    }

    /// A sliding node becomes one that moves with its material: something else is in the way of a
    /// bar in its place.
    ///
    /// It goes where its two tangents meet, 1/cos(φ/2) radii from the centre, so that the bars lie
    /// where they lay. The material there is not that of its mark, unless that was in the middle of
    /// the arc: see [`Share`]. (A mark 0.08 mm off gave a slack cable of 2 MN 2000 N there, and
    /// broke it.)
    pub(in crate::model::fem) fn settle_down(&mut self, k: usize) -> bool {
        match self.mesh.sliding.get(k).copied().flatten() {
            Some(node) => self.as_of(node.slide_over, |d| d.make_material(k)),
            None => self.make_material(k),
        }
    }

    fn make_material(&mut self, k: usize) -> bool {
        self.keep_answer();
        let before = [k - 1, k].map(|e| self.mesh.path(e, &self.motion.x).length / self.mesh.rest_length[e]);
        let half = (0.5 * self.turn(k)).abs();
        let out = 1.0
            / if half < self.mesh.tuning.remesh.max_tangent_half_turn_rad {
                half.cos()
            } else {
                self.mesh.tuning.remesh.max_tangent_half_turn_rad.cos()
            };
        let Some(end) = self.mesh.sliding[k].map(|s| s.end) else { return false };
        let x = &self.motion.x;
        let along = self.mesh.path(k - 1, x).direction + self.mesh.path(k, x).direction;
        let outward = perp(along) * -end.sense;
        let outward =
            if outward.norm() > self.mesh.tuning.remesh.fold_direction_sum { outward.normalize() } else { end.mark };
        let (sliding, place) = (self.mesh.sliding[k].take(), self.motion.x[k]);
        self.motion.x[k] = end.center + outward * (end.radius * out);
        if ![k - 1, k].into_iter().all(|e| self.is_clear(e)) {
            self.mesh.sliding[k] = sliding;
            self.motion.x[k] = place;
            return false;
        }
        let mesh = &mut self.mesh;
        let ways = [0, 1].map(|j| mesh.path(k - 1 + j, &self.motion.x).length);
        let whole = mesh.rest_length[k - 1] + mesh.rest_length[k];
        if ways[0] > 0.0 && ways[1] > 0.0 {
            let first = whole * Share::of(ways, before, whole).first;
            mesh.arc_length[k] = mesh.arc_length[k - 1] + first / mesh.thermal_stretch;
            mesh.rest_length[k - 1] = first;
            mesh.rest_length[k] = whole - first;
        }
        let m = &mut self.motion;
        let slid = floor_friction::as_move(self.contacts.floor_slid[k], along.try_normalize(0.0).unwrap_or_default());
        self.contacts.floor_slid[k] = slid;
        m.v[k] = along * (-0.5 * m.w[k]);
        m.v_before[k] = m.v[k];
        m.x_before[k] = m.x[k] - m.v[k] * m.step_before;
        m.w[k] = 0.0;
        true
    }

    /// True if a sliding node on an obstacle is pulled away from it, or is in the way of a node
    /// that has to pass.
    fn lifts_off(&self, k: usize) -> bool {
        let Some(node) = self.mesh.sliding[k] else { return false };
        let beside = |j: usize| self.mesh.sliding[j].is_some_and(|s| s.shares_round(&node));
        let fixed = |j: usize| self.mesh.sliding[j].is_none() && !self.removable(j);
        let blocked = [k - 1, k + 1]
            .into_iter()
            .any(|j| fixed(j) && self.bar_between(j, k) < self.mesh.tuning.remesh.removed_distance * self.even());
        if blocked {
            return true;
        }
        if beside(k - 1) || beside(k + 1) {
            return false;
        }
        let Some(load) = self.load(k) else { return false };
        let (turn, tension) = (self.turn(k), 0.5 * (load.tension[0] + load.tension[1]));
        load.normal < 0.0
            || turn < 0.0
            || self.beyond_its_corner(k, &self.motion.x)
            || (tension < self.mesh.tuning.remesh.material_tension_weights * self.meshing.bar_weight
                && turn < 2.0 * self.mesh.tuning.remesh.max_left_half_turn_rad)
    }

    /// Angle through which the bars beside node `k` turn, in the sense of a sliding node, rad.
    fn turn(&self, k: usize) -> f64 {
        self.turn_at(k, &self.motion.x)
    }

    /// The sliding nodes of obstacles that the cable, at positions `x` (m), turns round the wrong
    /// way: there a corner would have to pull.
    pub(in crate::model::fem) fn pulled(&self, x: &[Vec2]) -> Option<usize> {
        self.pulled_by(x, self.mesh.tuning.remesh.max_reverse_turn_rad)
    }

    /// See `pulled`; `wrong`: the turn (rad) the wrong way from which it counts.
    pub(in crate::model::fem) fn pulled_by(&self, x: &[Vec2], wrong: f64) -> Option<usize> {
        (1..self.mesh.nodes().saturating_sub(1)).find(|&k| {
            self.mesh.sliding[k].is_some_and(|node| {
                let shared = |j: usize| self.mesh.sliding[j].is_some_and(|s| s.shares_round(&node));
                let is_wrong = || self.turn_at(k, x) < -wrong || self.beyond_its_corner(k, x);
                node.feature().is_some() && !shared(k - 1) && !shared(k + 1) && is_wrong()
            })
        })
    }

    fn turn_at(&self, k: usize, x: &[Vec2]) -> f64 {
        let paths = [self.mesh.path(k - 1, x), self.mesh.path(k, x)];
        match &self.mesh.sliding[k] {
            Some(s) if s.end.radius > 0.0 => paths[0].arcs[1] + paths[1].arcs[0],
            _ => angle_between(paths[0].direction, paths[1].direction),
        }
    }

    /// True if a bar in the place of node `k` is nearly the way it lies now.
    fn runs_straight(&self, k: usize) -> bool {
        self.turn(k).abs() < self.mesh.tuning.remesh.removed_turn_rad
    }

    /// Arc length between two nodes, m.
    fn bar_between(&self, a: usize, b: usize) -> f64 {
        (self.mesh.arc_length[a] - self.mesh.arc_length[b]).abs()
    }

    /// Puts sliding nodes where corners and circles press; returns their seats.
    fn add_sliding_nodes(&mut self, rests: bool) -> Vec<SlideOver> {
        let mut taken = Vec::new();
        if self.problem.world.is_empty() || !self.meshing.slides {
            return taken;
        }
        let mut touches = std::mem::take(&mut self.meshing.found);
        for _ in 0..self.mesh.tuning.remesh.max_changes {
            self.contacts.find(&self.problem, &self.mesh, &self.motion.x, &mut touches);
            let found = touches.iter().find_map(|t| {
                let pressed =
                    t.pair.weight > 0.0 && t.load(&self.contacts.barrier) > 0.0 && t.pair.gap.feature % 2 == 1;
                let (bar, arc_length, sliding) =
                    if pressed { self.sliding_node_for(t.node, t.on_segment, &t.pair.gap)? } else { return None };
                let near = self.mesh.tuning.remesh.removed_distance * self.even();
                let node = [bar, bar + 1]
                    .into_iter()
                    .find(|&k| self.removable(k) && (self.mesh.arc_length[k] - arc_length).abs() < near);
                let beside = node.map_or([bar, bar + 1], |k| [k - 1, k + 1]);
                if !self.fits(beside, &sliding) {
                    return None;
                }
                let s = beside.map(|k| self.mesh.arc_length[k]);
                let arc_length = match rests {
                    true => arc_length,
                    false => s[0] + self.share_of_sliding(beside, &sliding)?.first * (s[1] - s[0]),
                };
                Some((bar, node, arc_length, sliding))
            });
            let Some((bar, node, arc_length, sliding)) = found else { break };
            match node {
                Some(k) => self.pin_down(k, arc_length, sliding),
                None => self.insert(bar + 1, arc_length, Some(sliding)),
            }
            self.clear_around(node.unwrap_or(bar + 1));
            taken.push(sliding.slide_over);
        }
        self.meshing.found = touches;
        taken
    }

    /// The share of the material between two nodes of a cable in motion where a sliding node comes
    /// between them; None where the cable is not taut, pulled by less than what its own speed
    /// across, hitting something, would make of it, or where the node would stretch it.
    fn share_of_sliding(&self, [before, after]: [usize; 2], sliding: &SlidingNode) -> Option<Share> {
        let (mesh, x) = (&self.mesh, &self.motion.x);
        let ways =
            [Path::between(&mesh.end(before, x), &sliding.end), Path::between(&sliding.end, &mesh.end(after, x))];
        let stretch = [before, after - 1].map(|e| mesh.path(e, x).length / mesh.rest_length[e]);
        let whole = (before..after).map(|e| mesh.rest_length[e]).sum();
        let share = Share::of(ways.map(|w| w.length), stretch, whole);
        let near = mesh.arc_length[before] - self.mesh.tuning.remesh.neighbourhood_m
            ..mesh.arc_length[after] + self.mesh.tuning.remesh.neighbourhood_m;
        let speed = |k: usize| if mesh.sliding[k].is_some() { self.motion.w[k].abs() } else { self.motion.v[k].norm() };
        let fastest = (0..mesh.nodes())
            .filter(|&k| near.contains(&mesh.arc_length[k]))
            .map(speed)
            .fold(0.0, |a: f64, b| if b <= a { a } else { b });
        let wave = (mesh.axial_stiffness / self.problem.linear_density).sqrt();
        let impact = self.mesh.tuning.remesh.impact_tension * mesh.axial_stiffness * (fastest / wave).powf(4.0 / 3.0);
        let tension = self.least_tension(stretch);
        (tension > impact && self.may_change(tension, &share)).then_some(share)
    }

    /// True if a sliding node that becomes a plain one leaves a cable in motion as tense as it is.
    fn settles_unstretched(&self, k: usize) -> bool {
        let (mesh, x) = (&self.mesh, &self.motion.x);
        let Some(end) = mesh.sliding[k].map(|s| s.end) else { return false };
        let half = (0.5 * self.turn(k)).abs();
        let longer = end.radius * (half.tan() - half);
        let lengths = [k - 1, k].map(|e| mesh.path(e, x).length);
        let stretch = [0, 1].map(|j| lengths[j] / mesh.rest_length[k - 1 + j]);
        let whole = mesh.rest_length[k - 1] + mesh.rest_length[k];
        half < self.mesh.tuning.remesh.max_tangent_half_turn_rad
            && self.may_change(self.least_tension(stretch), &Share::of(lengths.map(|l| l + longer), stretch, whole))
    }

    /// The lesser tension of two bars, N.
    fn least_tension(&self, [a, b]: [f64; 2]) -> f64 {
        let strain = if b < a { b - 1.0 } else { a - 1.0 };
        if strain > 0.0 { self.mesh.axial_stiffness * strain } else { 0.0 }
    }

    /// True if a change of the mesh adds so little to a tension (N) that it does not show.
    fn may_change(&self, tension: f64, share: &Share) -> bool {
        let weight = load_scale(&self.problem).0 * self.problem.length;
        self.mesh.axial_stiffness * share.added_strain
            < self.mesh.tuning.remesh.max_tension_change * (tension + self.mesh.tuning.remesh.weight_fraction * weight)
    }

    /// True if a sliding node between two nodes would bend the cable the right way and its bars
    /// would meet nothing.
    fn fits(&self, [before, after]: [usize; 2], sliding: &SlidingNode) -> bool {
        let x = &self.motion.x;
        let paths = [
            Path::between(&self.mesh.end(before, x), &sliding.end),
            Path::between(&sliding.end, &self.mesh.end(after, x)),
        ];
        let slide_over = |k: usize| self.mesh.sliding[k].as_ref();
        let nodes = [[slide_over(before), Some(sliding)], [Some(sliding), slide_over(after)]];
        let turn = if sliding.end.radius > 0.0 {
            paths[0].arcs[1] + paths[1].arcs[0]
        } else {
            sliding.end.sense * angle_between(paths[0].direction, paths[1].direction)
        };
        // Nor may it turn a neighbour the wrong way.
        let beside = |k: usize, arc: f64, e: usize, j: usize| {
            self.mesh.sliding[k].is_none_or(|s| {
                s.feature().is_none()
                    || s.shares_round(sliding)
                    || arc + self.mesh.path(e, x).arcs[j] > -self.mesh.tuning.remesh.max_reverse_turn_rad
            })
        };
        let sides = (before == 0 || beside(before, paths[0].arcs[0], before - 1, 1))
            && (after + 1 == self.mesh.nodes() || beside(after, paths[1].arcs[1], after, 0));
        turn > -self.mesh.tuning.remesh.max_reverse_turn_rad
            && sides
            && (0..2).all(|j| self.way_is_clear(&paths[j], nodes[j]))
    }

    /// The sliding node that a corner or circle pressing on a bar or node asks for: its bar, arc
    /// length and itself.
    fn sliding_node_for(
        &self,
        node: usize,
        on_segment: bool,
        gap: &crate::contact::Gap,
    ) -> Option<(usize, f64, SlidingNode)> {
        let (mesh, x, last) = (&self.mesh, &self.motion.x, self.mesh.nodes() - 1);
        let (center, radius) = round_of(
            self.problem.world.geometry(),
            gap.feature,
            self.clearance(gap.feature),
            self.mesh.tuning.remesh.min_turn_rad,
        )?;
        let (bar, fraction) = match (on_segment, node) {
            (true, e) => (e, gap.fraction),
            (false, k) if k > 0 && k < last => (k - 1, 1.0),
            (false, _) => return None,
        };
        let path = mesh.path(bar, x);
        let along = if on_segment { path.direction } else { path.direction + mesh.path(node, x).direction };
        let sense = if gap.normal.dot(&perp(along)) > 0.0 { -1.0 } else { 1.0 };
        // A cable folded back on itself at an obstacle runs neither way round it, one that is bent
        // away from it hits it with a node.
        if !on_segment && (along.norm() < self.mesh.tuning.remesh.fold_direction_sum || self.turn(node) * sense < 0.0) {
            return None;
        }
        // Seen from beyond the bar the cable must bend round the corner, and be taut.
        let first = bar.saturating_sub(1);
        let beyond = (bar + 1).min(last - 1);
        let wrap = sense * angle_between(mesh.path(first, x).direction, mesh.path(beyond, x).direction);
        let tension = mesh.bar(bar).tension(path.length);
        if !(wrap > 0.0 && tension > self.mesh.tuning.remesh.sliding_tension_weights * self.meshing.bar_weight) {
            return None;
        }
        let s = [mesh.arc_length[bar], mesh.arc_length[bar + 1]];
        let near = self.mesh.tuning.remesh.removed_distance * self.even();
        // The ends of a cable and what hangs on it stay clear of corners.
        let from_start = fraction * (s[1] - s[0]);
        let from_end = (1.0 - fraction) * (s[1] - s[0]);
        if (from_start < near && !self.removable(bar)) || (from_end < near && !self.removable(bar + 1)) {
            return None;
        }
        if self.bends_visibly(tension) {
            return None;
        }
        let before = path.arcs[0] * mesh.end(bar, x).radius;
        let part = if path.length > 0.0 { (before + fraction * path.straight) / path.length } else { fraction };
        let arc_length = s[0] + bounded(part, LEAST_PART, 1.0 - LEAST_PART) * (s[1] - s[0]);
        let end = End { center, radius, mark: gap.normal, sense };
        let slide_over = SlideOver::Obstacle { obstacle: gap.obstacle, feature: gap.feature };
        let sliding = SlidingNode::new(end, gap.friction, slide_over);
        Some((bar, arc_length, sliding))
    }

    /// True if the bend of a cable under a tension (N) is longer than bars are: then nodes that
    /// move with their material show it, and a sliding node, which carries no moment, would leave
    /// it out.
    pub(in crate::model::fem) fn bends_visibly(&self, tension: f64) -> bool {
        let stiffness = self.mesh.bending_stiffness;
        let least = self.meshing.bar_weight + stiffness / (self.problem.length * self.problem.length);
        stiffness > 0.0
            && (stiffness / if tension > least { tension } else { least }).sqrt()
                > self.mesh.tuning.remesh.resolved_bend * self.even()
    }

    /// Takes out plain nodes in the way of a new sliding node.
    fn clear_around(&mut self, k: usize) {
        let near = self.mesh.tuning.remesh.min_bar * self.even();
        let straight = |d: &Self, e: usize| d.mesh.path(e, &d.motion.x).straight;
        if k + 2 < self.mesh.nodes() && self.removable(k + 1) && straight(self, k) < near && self.clear_without(k + 1) {
            self.remove(k + 1);
        }
        if k > 1 && self.removable(k - 1) && straight(self, k - 1) < near && self.clear_without(k - 1) {
            self.remove(k - 1);
        }
    }

    /// Cuts long bars beside sliding nodes and takes out nodes that came too near to one.
    ///
    /// Returns whether there was anything to do.
    pub(in crate::model::fem) fn even_out(&mut self) -> bool {
        let even = self.even();
        let mut changed = false;
        let mut k = 1;
        while k + 1 < self.mesh.nodes() {
            if !self.removable(k) {
                k += 1;
                continue;
            }
            let (before, after) = (self.mesh.sliding[k - 1], self.mesh.sliding[k + 1]);
            let straight = |e: usize| self.mesh.path(e, &self.motion.x).straight;
            let crowded = (before.is_some() && straight(k - 1) < self.mesh.tuning.remesh.min_bar * even)
                || (after.is_some() && straight(k) < self.mesh.tuning.remesh.min_bar * even);
            let spare = before.is_none()
                && after.is_none()
                && self.bar_between(k - 1, k + 1) < self.mesh.tuning.remesh.spare_bars * even
                && self.runs_straight(k);
            let enclosed = matches!((before, after), (Some(a), Some(b)) if a.shares_round(&b));
            if (crowded || enclosed || spare) && self.clear_without(k) {
                self.remove(k);
                changed = true;
            } else {
                k += 1;
            }
        }
        let mut e = 0;
        while e + 1 < self.mesh.nodes() {
            let length = self.bar_between(e, e + 1);
            let x = &self.motion.x;
            let path = self.mesh.path(e, x);
            let unwound = path.arcs.iter().any(|&a| a < -0.1);
            if length > self.mesh.tuning.remesh.max_bar * even
                && path.straight > 0.8 * self.mesh.tuning.remesh.max_bar * even
                && !unwound
            {
                // Even pieces, the straight part permitting; beside a sliding node the odd piece is
                // its.
                let slides = [e, e + 1].map(|k| self.mesh.sliding[k].is_some());
                let part = match slides {
                    [false, true] => even,
                    [true, false] => length - even,
                    _ => 0.5 * length,
                };
                let lead = path.arcs[0] * self.mesh.end(e, x).radius / path.length;
                let straight = path.straight / path.length;
                let fraction = bounded(part / length, lead + 0.1 * straight, lead + 0.9 * straight);
                let arc_length = self.mesh.arc_length[e] + fraction * length;
                self.insert(e + 1, arc_length, None);
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

    /// True if a node is there for nothing but the mesh.
    pub(in crate::model::fem) fn removable(&self, k: usize) -> bool {
        k > 0
            && k + 1 < self.mesh.nodes()
            && self.mesh.is_free(k)
            && !self.meshing.support_node.contains(&Some(k))
            && self.meshing.loads.iter().all(|l| l.0 != k)
    }
}
