//! These criteria decide where sliding nodes are inserted and removed; they change nothing.

use crate::math::{bounded, larger, perp};
use crate::model::fem::mesh::{BarEnd, SlideOver, SlidingNode, TangentPath, angle_between, round_of};
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::state::{CableState, Meshing, NodalMotion};
use crate::model::fem::system::{ContactPair, StepContext, load_scale};

/// Least fraction of the material between two nodes on each side of a node inserted between them.
const LEAST_PART: f64 = 1e-3;

/// The division of the material of two bars when their paths change.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaterialShare {
    /// Fraction of the first bar.
    pub(super) first: f64,
    /// Growth of the strain of stretched bars; if negative, the slack that is left.
    added_strain: f64,
}

impl MaterialShare {
    /// Divides the material from the new path lengths (m), the stretch of each bar (length over
    /// unstretched length), and the unstretched length of both (m). A stretched bar keeps its
    /// strain and takes the material it needs from a slack one; if that is not enough, the strain
    /// of both grows equally.
    pub(super) fn of(ways: [f64; 2], stretch: [f64; 2], whole: f64) -> Self {
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

/// A sliding node and where it is inserted.
#[derive(Clone, Copy, Debug)]
pub(super) struct NewSlidingNode {
    /// Bar that it divides.
    pub(super) bar: usize,
    /// Arc length of its material, m.
    pub(super) arc_length: f64,
    pub(super) sliding: SlidingNode,
}

/// The parts of a cable that the criteria read: its mesh among obstacles, its division, and its
/// motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Criteria<'a> {
    step: StepContext<'a>,
    meshing: &'a Meshing,
    motion: &'a NodalMotion,
}

impl<'a> Criteria<'a> {
    /// The criteria for the present state of a cable.
    pub(super) fn of(cable: &'a CableState) -> Self {
        Self { step: cable.step_context(), meshing: &cable.meshing, motion: &cable.motion }
    }

    fn intersections(&self) -> IntersectionCheck<'a> {
        IntersectionCheck::among(&self.step, &self.motion.positions)
    }

    /// Length of an even bar, m of arc length.
    fn even(&self) -> f64 {
        self.meshing.even(self.step.problem.length)
    }

    /// True if a sliding node on an obstacle is pulled away from it, or blocks a node that has to
    /// pass.
    pub(super) fn lifts_off(&self, k: usize) -> bool {
        let (mesh, x) = (self.step.mesh, &self.motion.positions);
        let Some(node) = mesh.sliding[k] else { return false };
        let beside = |j: usize| mesh.sliding[j].is_some_and(|s| s.shares_round(&node));
        let fixed = |j: usize| mesh.sliding[j].is_none() && !self.meshing.removable(mesh, j);
        let blocked = [k - 1, k + 1]
            .into_iter()
            .any(|j| fixed(j) && mesh.material_between(j, k) < mesh.tuning.remesh.removed_distance * self.even());
        if blocked {
            return true;
        }
        if beside(k - 1) || beside(k + 1) {
            return false;
        }
        let Some(load) = self.step.load_at(k, x, None) else { return false };
        let (turn, tension) = (mesh.turn(k, x), 0.5 * (load.tension[0] + load.tension[1]));
        load.normal < 0.0
            || turn < 0.0
            || self.intersections().beyond_its_corner(k)
            || (tension < 0.5 * mesh.tuning.remesh.sliding_tension_weights * self.meshing.bar_weight
                && turn < 2.0 * mesh.tuning.remesh.max_left_half_turn_rad)
    }

    /// The division of the material between two nodes of a cable in motion by a sliding node
    /// between them. None if the node would stretch the cable, or if the cable is not taut: its
    /// tension is less than what an impact at its own transverse speed would cause.
    pub(super) fn share_of_sliding(&self, [before, after]: [usize; 2], sliding: &SlidingNode) -> Option<MaterialShare> {
        let (mesh, x) = (self.step.mesh, &self.motion.positions);
        let ways = [
            TangentPath::between(&mesh.end(before, x), &sliding.end),
            TangentPath::between(&sliding.end, &mesh.end(after, x)),
        ];
        let stretch = [before, after - 1].map(|e| mesh.path(e, x).length / mesh.rest_length[e]);
        let whole = (before..after).map(|e| mesh.rest_length[e]).sum();
        let share = MaterialShare::of(ways.map(|w| w.length), stretch, whole);
        let near = mesh.arc_length[before] - mesh.tuning.remesh.neighbourhood_m
            ..mesh.arc_length[after] + mesh.tuning.remesh.neighbourhood_m;
        let speed = |k: usize| {
            if mesh.sliding[k].is_some() { self.motion.slide_rates[k].abs() } else { self.motion.velocities[k].norm() }
        };
        let fastest = (0..mesh.nodes())
            .filter(|&k| near.contains(&mesh.arc_length[k]))
            .map(speed)
            .fold(0.0, |a: f64, b| if b <= a { a } else { b });
        let wave = (mesh.axial_stiffness / self.step.problem.linear_density).sqrt();
        let impact = mesh.tuning.remesh.impact_tension * mesh.axial_stiffness * (fastest / wave).powf(4.0 / 3.0);
        let tension = mesh.lesser_tension(stretch);
        (tension > impact && self.may_change(tension, &share)).then_some(share)
    }

    /// True if turning a sliding node into a material node does not change the tension of a cable
    /// in motion.
    pub(super) fn settles_unstretched(&self, k: usize) -> bool {
        let (mesh, x) = (self.step.mesh, &self.motion.positions);
        let Some(end) = mesh.sliding[k].map(|s| s.end) else { return false };
        let half = (0.5 * mesh.turn(k, x)).abs();
        let longer = end.radius * (half.tan() - half);
        let lengths = [k - 1, k].map(|e| mesh.path(e, x).length);
        let stretch = [0, 1].map(|j| lengths[j] / mesh.rest_length[k - 1 + j]);
        let whole = mesh.rest_length[k - 1] + mesh.rest_length[k];
        half < mesh.tuning.remesh.max_tangent_half_turn_rad
            && self.may_change(
                mesh.lesser_tension(stretch),
                &MaterialShare::of(lengths.map(|l| l + longer), stretch, whole),
            )
    }

    /// True if a change of the mesh adds a negligible amount to a tension (N).
    fn may_change(&self, tension: f64, share: &MaterialShare) -> bool {
        let StepContext { problem, mesh, .. } = self.step;
        let weight = load_scale(problem).0 * problem.length;
        let tuning = &mesh.tuning.remesh;
        mesh.axial_stiffness * share.added_strain
            < tuning.max_tension_change * (tension + tuning.weight_fraction * weight)
    }

    /// True if a sliding node between two nodes would bend the cable in the right sense and its
    /// bars would meet nothing.
    pub(super) fn may_insert(&self, [before, after]: [usize; 2], sliding: &SlidingNode) -> bool {
        let (mesh, x) = (self.step.mesh, &self.motion.positions);
        let paths = [
            TangentPath::between(&mesh.end(before, x), &sliding.end),
            TangentPath::between(&sliding.end, &mesh.end(after, x)),
        ];
        let slide_over = |k: usize| mesh.sliding[k].as_ref();
        let nodes = [[slide_over(before), Some(sliding)], [Some(sliding), slide_over(after)]];
        let turn = if sliding.end.radius > 0.0 {
            paths[0].arcs[1] + paths[1].arcs[0]
        } else {
            sliding.end.sense * angle_between(paths[0].direction, paths[1].direction)
        };
        let least_turn = -mesh.tuning.remesh.max_reverse_turn_rad;
        // A neighbour turns by the `arc` towards the new node and that of its other bar at its
        // `end`.
        let keeps_its_turn = |k: usize, arc: f64, other_bar: usize, end: usize| {
            mesh.sliding[k].is_none_or(|s| {
                s.feature().is_none() || s.shares_round(sliding) || arc + mesh.path(other_bar, x).arcs[end] > least_turn
            })
        };
        let neighbours_keep = (before == 0 || keeps_its_turn(before, paths[0].arcs[0], before - 1, 1))
            && (after + 1 == mesh.nodes() || keeps_its_turn(after, paths[1].arcs[1], after, 0));
        turn > least_turn && neighbours_keep && (0..2).all(|j| self.intersections().way_is_clear(&paths[j], nodes[j]))
    }

    /// The sliding node that is needed where a corner or circle presses on a bar or node; None if
    /// the cable does not bend round it there, or is slack or stiff.
    pub(super) fn sliding_node_for(&self, touch: &ContactPair) -> Option<NewSlidingNode> {
        let ContactPair { node, on_segment, pair } = *touch;
        let gap = &pair.gap;
        let (mesh, x) = (self.step.mesh, &self.motion.positions);
        let last = mesh.nodes() - 1;
        let (center, radius) = round_of(
            self.step.problem.world.geometry(),
            gap.feature,
            self.intersections().clearance(gap.feature),
            mesh.tuning.remesh.min_turn_rad,
        )?;
        let (bar, fraction) = match (on_segment, node) {
            (true, e) => (e, gap.fraction),
            (false, k) if k > 0 && k < last => (k - 1, 1.0),
            (false, _) => return None,
        };
        let path = mesh.path(bar, x);
        let along = if on_segment { path.direction } else { path.direction + mesh.direction(node, x) };
        let sense = if gap.normal.dot(&perp(along)) > 0.0 { -1.0 } else { 1.0 };
        // A cable folded back on itself at an obstacle runs round it in neither sense, and one that
        // is bent away from it hits it with a node.
        if !on_segment && (along.norm() < mesh.tuning.remesh.fold_direction_sum || mesh.turn(node, x) * sense < 0.0) {
            return None;
        }
        // Seen from the nodes beyond the bar, the cable must bend round the corner and be taut.
        let first = bar.saturating_sub(1);
        let beyond = (bar + 1).min(last - 1);
        let wrap = sense * angle_between(mesh.direction(first, x), mesh.direction(beyond, x));
        let tension = mesh.tension(bar, path.length);
        if !(wrap > 0.0 && tension > mesh.tuning.remesh.sliding_tension_weights * self.meshing.bar_weight) {
            return None;
        }
        let s = [mesh.arc_length[bar], mesh.arc_length[bar + 1]];
        let near = mesh.tuning.remesh.removed_distance * self.even();
        // Ends of the cable and its loads stay clear of corners.
        let from_start = fraction * (s[1] - s[0]);
        let from_end = (1.0 - fraction) * (s[1] - s[0]);
        if (from_start < near && !self.meshing.removable(mesh, bar))
            || (from_end < near && !self.meshing.removable(mesh, bar + 1))
        {
            return None;
        }
        let stiffness = larger(mesh.bending_stiffness, self.step.problem.bending_stiffness);
        if self.meshing.bends_visibly(mesh, stiffness, tension) {
            return None;
        }
        let before = path.arcs[0] * mesh.end(bar, x).radius;
        let part = if path.length > 0.0 { (before + fraction * path.straight) / path.length } else { fraction };
        let arc_length = s[0] + bounded(part, LEAST_PART, 1.0 - LEAST_PART) * (s[1] - s[0]);
        let end = BarEnd { center, radius, mark: gap.normal, sense };
        let slide_over = SlideOver::Obstacle { obstacle: gap.obstacle, feature: gap.feature };
        let sliding = SlidingNode::new(end, gap.friction, slide_over);
        Some(NewSlidingNode { bar, arc_length, sliding })
    }
}
