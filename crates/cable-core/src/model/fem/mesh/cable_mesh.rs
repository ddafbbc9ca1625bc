//! A mesh divides a cable into bars.

use std::sync::Arc;

use crate::energy::axial::Bar;
use crate::linalg::{BARS_HALF_BANDWIDTH, BENDING_HALF_BANDWIDTH};
use crate::math::Vec2;
use crate::model::fem::mesh::bar_memory::BarMemory;
use crate::model::fem::mesh::branch_moments::BranchMoments;
use crate::model::fem::mesh::mass_matrix::{MassMatrix, Spread};
use crate::model::fem::mesh::sliding_node::{SlideOver, SlidingNode};
use crate::model::fem::mesh::tangent_path::{BarEnd, StraightPart, TangentPath, angle_between};
use crate::model::fem::settings::Tuning;
use crate::model::length_change::LEAST_EXCESS;
use crate::problem::Problem;

/// Distance within which a node is at an arc length, as a fraction of the cable's length. Smaller:
/// nodes that a scene's digits miss are not found; larger: the wrong one of two near nodes is.
const NODE_DISTANCE_FRACTION: f64 = 1e-6;

/// A direction prescribed at a node. The bars on both sides of the node are bent against it, each
/// by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamp {
    /// The node.
    pub node: usize,
    /// Unit vector of growing arc length.
    pub direction: Vec2,
}

/// A cable divided into bars.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The tuned constants with which it is solved.
    pub tuning: Arc<Tuning>,
    /// Unstretched arc length of each node at rest temperature, m, increasing.
    pub arc_length: Vec<f64>,
    /// Unstretched length of each bar at the present temperature (thermal stretch · ds), m; 0: a
    /// break, where two nodes have the same place in the cable and no bar joins them.
    pub rest_length: Vec<f64>,
    /// True if each node is held in place.
    pub fixity: Vec<bool>,
    /// The prescribed directions.
    pub clamps: Vec<Clamp>,
    /// The corner, post or pulley of each sliding node; None: the node moves with the material.
    pub sliding: Vec<Option<SlidingNode>>,
    /// 1 + αΔT: unstretched length of a metre of arc length.
    pub thermal_stretch: f64,
    /// Length by which each bar is longer unstretched than its material, as a fraction of it: so
    /// that it kept its tension when the cable was divided anew. It fades.
    pub(in crate::model::fem) excess: BarMemory,
    /// EA, N.
    pub axial_stiffness: f64,
    /// EI, N·m²; 0 = no bending.
    pub bending_stiffness: f64,
    /// Difference of its mass matrix from the lumped one.
    pub spread: Spread,
    /// Forces in the relaxation branches of its bars.
    pub(in crate::model::fem) branch_forces: BarMemory,
    /// Impulse (N s) of each bar in the last step with inertia, as the integrator remembers it.
    pub(in crate::model::fem) remembered_impulses: BarMemory,
    /// Moments in the relaxation branches of its bends.
    pub(in crate::model::fem) branch_moments: BranchMoments,
}

impl Mesh {
    /// Divides a cable into about `segments` bars with a node at each of `breaks` (arc lengths, m,
    /// increasing, with both ends) and even bars in between. All nodes are free.
    #[must_use]
    pub fn new(problem: &Problem, tuning: Arc<Tuning>, breaks: &[f64], segments: usize, mass: MassMatrix) -> Self {
        let mut arc_length: Vec<f64> = Vec::with_capacity(segments + breaks.len());
        let mut stretches = Vec::with_capacity(breaks.len());
        for pair in breaks.windows(2) {
            let count = bars_between(pair[1] - pair[0], problem.length, segments);
            let step = (pair[1] - pair[0]) / count as f64;
            arc_length.extend((0..count).map(|k| pair[0] + step * k as f64));
            stretches.push((count, step));
        }
        arc_length.extend(breaks.last());
        let rest_length = arc_length.windows(2).map(|p| problem.thermal_stretch * (p[1] - p[0])).collect();
        Self {
            tuning,
            fixity: vec![false; arc_length.len()],
            sliding: vec![None; arc_length.len()],
            thermal_stretch: problem.thermal_stretch,
            excess: BarMemory::default(),
            rest_length,
            arc_length,
            clamps: Vec::new(),
            axial_stiffness: problem.axial_stiffness,
            bending_stiffness: problem.bending_stiffness,
            spread: match mass {
                MassMatrix::Spread => Spread::of(&stretches),
                MassMatrix::Lumped => Spread::default(),
            },
            branch_forces: BarMemory::default(),
            remembered_impulses: BarMemory::default(),
            branch_moments: BranchMoments::default(),
        }
    }

    /// Mass that moves with a node, kg; `support_node` is the node of each support.
    #[must_use]
    pub fn mass_with(&self, problem: &Problem, support_node: &[Option<usize>], node: usize) -> f64 {
        problem.linear_density * self.tributary_length(node) + Self::lumped_mass(problem, support_node, node)
    }

    /// Lumped mass of the supports at a node, kg; `support_node` is the node of each support.
    #[must_use]
    pub fn lumped_mass(problem: &Problem, support_node: &[Option<usize>], node: usize) -> f64 {
        let here = problem.supports.iter().zip(support_node).filter(|(_, at)| **at == Some(node));
        here.map(|(s, _)| s.mass).sum()
    }

    /// Becomes a copy of `other`, reusing its memory where possible.
    pub fn copy_from(&mut self, other: &Self) {
        self.sliding.clone_from(&other.sliding);
        self.copy_material_nodes_from(other);
    }

    /// As [`Self::copy_from`] where neither mesh can have sliding nodes.
    pub fn copy_material_nodes_from(&mut self, other: &Self) {
        let Self { tuning, arc_length, rest_length, fixity, clamps, spread, branch_forces, branch_moments, .. } = other;
        self.tuning.clone_from(tuning);
        self.arc_length.clone_from(arc_length);
        self.rest_length.clone_from(rest_length);
        self.fixity.clone_from(fixity);
        self.clamps.clone_from(clamps);
        self.spread.copy_from(spread);
        self.branch_forces.copy_from(branch_forces);
        self.branch_moments.copy_from(branch_moments);
        self.remembered_impulses.copy_from(&other.remembered_impulses);
        self.thermal_stretch = other.thermal_stretch;
        self.excess.copy_from(&other.excess);
        self.axial_stiffness = other.axial_stiffness;
        self.bending_stiffness = other.bending_stiffness;
    }

    /// Changes the unstretched length of a metre of arc length.
    pub(in crate::model::fem) fn change_thermal_stretch(&mut self, stretch: f64) {
        let part = stretch / self.thermal_stretch;
        self.rest_length.iter_mut().for_each(|length| *length *= part);
        self.thermal_stretch = stretch;
    }

    /// Takes the unstretched length of bar `e` from its material.
    pub(in crate::model::fem) fn renew_rest_length(&mut self, e: usize) {
        let material = self.thermal_stretch * (self.arc_length[e + 1] - self.arc_length[e]);
        self.rest_length[e] = material * (1.0 + self.excess.sum(e));
    }

    /// Gives bar `e` an unstretched length (m), which differs from that of its material.
    pub(in crate::model::fem) fn set_rest_length(&mut self, e: usize, length: f64) {
        let material = self.thermal_stretch * (self.arc_length[e + 1] - self.arc_length[e]);
        self.rest_length[e] = length;
        self.excess.of_all(self.rest_length.len(), 1)[e] = length / material - 1.0;
    }

    /// True if the unstretched length of a bar is not that of its material.
    pub(in crate::model::fem) fn has_excess(&self) -> bool {
        !self.excess.is_zero()
    }

    /// The sum over all bars of how much their unstretched length differs from that of the
    /// material, m.
    pub(in crate::model::fem) fn whole_excess(&self) -> f64 {
        let material = |e: usize| self.thermal_stretch * (self.arc_length[e + 1] - self.arc_length[e]);
        (0..self.rest_length.len()).map(|e| self.excess.sum(e).abs() * material(e)).sum()
    }

    /// Keeps a part of what unstretched lengths differ from those of the material.
    pub(in crate::model::fem) fn fade_excess(&mut self, part: f64) {
        if !self.has_excess() {
            return;
        }
        let excess = self.excess.of_all(self.rest_length.len(), 1);
        excess.iter_mut().for_each(|excess| *excess *= part);
        if excess.iter().all(|excess| excess.abs() < LEAST_EXCESS) {
            self.excess.clear();
        }
        for e in 0..self.rest_length.len() {
            self.renew_rest_length(e);
        }
    }

    /// Gives the nodes the arc lengths of a cable that is longer by a factor, and as long
    /// unstretched as now.
    pub(in crate::model::fem) fn scale_arc_lengths(&mut self, factor: f64) {
        let Spread { more, coupling } = &mut self.spread;
        self.arc_length.iter_mut().chain(more).chain(coupling).for_each(|length| *length *= factor);
        self.thermal_stretch /= factor;
    }

    /// Number of nodes.
    #[inline]
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.arc_length.len()
    }

    /// True if the cable has no bending stiffness.
    #[inline]
    #[must_use]
    pub fn is_flexible(&self) -> bool {
        self.bending_stiffness == 0.0
    }

    /// Half-bandwidth of the Hessian.
    #[must_use]
    pub fn half_bandwidth(&self) -> usize {
        if self.bending_stiffness > 0.0 { BENDING_HALF_BANDWIDTH } else { BARS_HALF_BANDWIDTH }
    }

    /// Node `k` as the end of the bars beside it: a point, or the round of a sliding node.
    #[must_use]
    pub fn end(&self, k: usize, x: &[Vec2]) -> BarEnd {
        self.sliding[k].as_ref().map_or_else(|| BarEnd::point(x[k]), |s| s.end)
    }

    /// The path of bar `e`.
    #[inline]
    #[must_use]
    pub fn path(&self, e: usize, x: &[Vec2]) -> TangentPath {
        if self.sliding[e].is_none() && self.sliding[e + 1].is_none() {
            return TangentPath::line(x[e], x[e + 1]);
        }
        TangentPath::between(&self.end(e, x), &self.end(e + 1, x))
    }

    /// Ends of the straight part of bar `e`, m.
    #[inline]
    #[must_use]
    pub fn straight(&self, e: usize, x: &[Vec2]) -> [Vec2; 2] {
        if self.sliding[e].is_none() && self.sliding[e + 1].is_none() {
            [x[e], x[e + 1]]
        } else {
            StraightPart::of(&self.end(e, x), &self.end(e + 1, x)).ends
        }
    }

    /// Length of the straight part of bar `e`, m: that of [`Self::path`] without its arcs.
    #[inline]
    #[must_use]
    pub fn straight_length(&self, e: usize, x: &[Vec2]) -> f64 {
        if self.sliding[e].is_none() && self.sliding[e + 1].is_none() {
            (x[e + 1] - x[e]).norm()
        } else {
            StraightPart::of(&self.end(e, x), &self.end(e + 1, x)).length
        }
    }

    /// The direction of the straight part of bar `e`; a unit vector.
    #[inline]
    #[must_use]
    pub fn direction(&self, e: usize, x: &[Vec2]) -> Vec2 {
        if self.sliding[e].is_none() && self.sliding[e + 1].is_none() {
            TangentPath::line(x[e], x[e + 1]).direction
        } else {
            StraightPart::of(&self.end(e, x), &self.end(e + 1, x)).direction
        }
    }

    /// The obstacle features round which the ends of bar `e` run.
    #[inline]
    #[must_use]
    pub fn rounds(&self, e: usize) -> [Option<usize>; 2] {
        [e, e + 1].map(|k| self.sliding[k].as_ref().and_then(SlidingNode::feature))
    }

    /// True if a node moves with the material and its position is not prescribed.
    #[inline]
    #[must_use]
    pub fn is_free(&self, k: usize) -> bool {
        !self.fixity[k] && self.sliding[k].is_none()
    }

    /// True if the cable is broken between nodes `e` and `e + 1`: there is no bar.
    #[inline]
    #[must_use]
    pub fn is_break(&self, e: usize) -> bool {
        self.rest_length[e] == 0.0
    }

    /// The breaks, in order.
    pub fn breaks(&self) -> impl Iterator<Item = usize> {
        (0..self.rest_length.len()).filter(|&e| self.is_break(e))
    }

    /// True if the nodes beside an inner node `k` belong to the same piece as it.
    #[must_use]
    pub fn goes_on_through(&self, k: usize) -> bool {
        !(self.is_break(k - 1) || self.is_break(k))
    }

    /// Tension of bar `e` at a length (m), N: that of its stretch and its relaxation branches;
    /// negative in compression, except in a flexible bar.
    #[inline]
    #[must_use]
    pub(in crate::model::fem) fn tension(&self, e: usize, length: f64) -> f64 {
        self.tension_with(e, length, self.rest_length[e])
    }

    /// The tension of bar `e` at a length with another unstretched length (m), N.
    #[inline]
    #[must_use]
    pub(in crate::model::fem) fn tension_with(&self, e: usize, length: f64, rest_length: f64) -> f64 {
        if self.is_break(e) {
            return 0.0;
        }
        let stretching = Bar { rest_length, stiffness: self.axial_stiffness }.tension(length);
        let tension =
            if stretching > 0.0 || !self.is_flexible() { stretching + self.branch_forces.sum(e) } else { stretching };
        if tension < 0.0 && self.is_flexible() { 0.0 } else { tension }
    }

    /// Tributary arc length of a node, m: half of the bars beside it at rest temperature, corrected
    /// by the spread mass. Weight, wind and momentum of a node are this times their value per
    /// metre.
    #[must_use]
    pub fn tributary_length(&self, node: usize) -> f64 {
        let s = &self.arc_length;
        let before = if node > 0 { s[node] - s[node - 1] } else { 0.0 };
        let after = if node + 1 < s.len() { s[node + 1] - s[node] } else { 0.0 };
        0.5 * (before + after) + self.spread.more.get(node).copied().unwrap_or(0.0)
    }

    /// The node at an arc length (m), within a millionth of the cable.
    #[must_use]
    pub fn node_at(&self, arc_length: f64) -> Option<usize> {
        let near = NODE_DISTANCE_FRACTION * self.arc_length.last().copied().unwrap_or(0.0);
        let k = self.arc_length.partition_point(|&s| s < arc_length - near);
        (k < self.nodes() && (self.arc_length[k] - arc_length).abs() <= near).then_some(k)
    }

    /// Angle through which the bars beside node `k` turn, in the sense of a sliding node, rad.
    pub(in crate::model::fem) fn turn(&self, k: usize, x: &[Vec2]) -> f64 {
        let paths = [self.path(k - 1, x), self.path(k, x)];
        match &self.sliding[k] {
            Some(s) if s.end.radius > 0.0 => paths[0].arcs[1] + paths[1].arcs[0],
            _ => angle_between(paths[0].direction, paths[1].direction),
        }
    }

    /// True if a single bar in the place of node `k` would nearly follow the present path.
    pub(in crate::model::fem) fn runs_straight(&self, k: usize, x: &[Vec2]) -> bool {
        self.turn(k, x).abs() < self.tuning.remesh.removed_turn_rad
    }

    /// Arc length between two nodes, m.
    pub(in crate::model::fem) fn material_between(&self, a: usize, b: usize) -> f64 {
        (self.arc_length[a] - self.arc_length[b]).abs()
    }

    /// The smaller tension of two bars with these ratios of length to unstretched length, N.
    pub(in crate::model::fem) fn lesser_tension(&self, [a, b]: [f64; 2]) -> f64 {
        let strain = if b < a { b - 1.0 } else { a - 1.0 };
        if strain > 0.0 { self.axial_stiffness * strain } else { 0.0 }
    }

    /// Greatest tension of a bar, N.
    pub(in crate::model::fem) fn greatest_tension(&self, x: &[Vec2]) -> f64 {
        let tension = |e| self.tension(e, self.path(e, x).length);
        (0..self.rest_length.len()).map(tension).fold(0.0, |most, t| if t > most { t } else { most })
    }

    /// Lets the material slide through the sliding nodes by an arc length (m) at each.
    pub(in crate::model::fem) fn slide(&mut self, slide: &[f64]) {
        for (s, by) in self.arc_length.iter_mut().zip(slide) {
            *s += by;
        }
        for e in 0..self.rest_length.len() {
            if slide[e] == 0.0 && slide[e + 1] == 0.0 {
                continue;
            }
            if self.has_excess() {
                self.set_rest_length(e, self.rest_length[e] + self.thermal_stretch * (slide[e + 1] - slide[e]));
            } else {
                self.renew_rest_length(e);
            }
        }
    }

    /// True if a node is the only one of its wrap round an obstacle or a pulley.
    pub(in crate::model::fem) fn is_alone_on_round(&self, k: usize) -> bool {
        let shares = |j: usize| match (self.sliding[j], self.sliding[k]) {
            (Some(other), Some(node)) => other.shares_round(&node),
            _ => false,
        };
        self.sliding[k].is_some() && !shares(k - 1) && !shares(k + 1)
    }

    /// Centre of a pulley, m; None for other supports and pulleys that have let go.
    pub(in crate::model::fem) fn pulley_center(&self, support: usize) -> Option<Vec2> {
        self.sliding.iter().flatten().find(|s| s.slide_over == SlideOver::Pulley(support)).map(|s| s.end.center)
    }

    /// True if there is any sliding node.
    pub(in crate::model::fem) fn slides_anywhere(&self) -> bool {
        self.sliding.iter().any(Option::is_some)
    }

    /// Puts a node at an arc length (m) between nodes `k` − 1 and `k`.
    pub(in crate::model::fem) fn insert_node(&mut self, k: usize, arc_length: f64, sliding: Option<SlidingNode>) {
        let (a, b) = (self.arc_length[k - 1], self.arc_length[k]);
        self.spread.clear();
        self.branch_forces.divide(k - 1);
        self.excess.divide(k - 1);
        self.remembered_impulses.divide(k - 1);
        self.branch_moments.insert_node(k, (arc_length - a) / (b - a));
        self.arc_length.insert(k, arc_length);
        self.rest_length.insert(k, 0.0);
        self.renew_rest_length(k - 1);
        self.renew_rest_length(k);
        self.fixity.insert(k, false);
        self.sliding.insert(k, sliding);
    }

    /// Breaks the cable at node `k`: its second piece begins with node `k` + 1 at the same place.
    pub(in crate::model::fem) fn break_at(&mut self, k: usize) {
        self.arc_length.insert(k + 1, self.arc_length[k]);
        self.branch_forces.insert_break(k);
        self.excess.insert_break(k);
        self.remembered_impulses.insert_break(k);
        self.branch_moments.break_at(k);
        self.rest_length.insert(k, 0.0);
        self.fixity.insert(k + 1, false);
        self.sliding.insert(k + 1, None);
    }

    /// Removes node `k`.
    pub(in crate::model::fem) fn remove_node(&mut self, k: usize) {
        self.spread.clear();
        let part = self.material_between(k - 1, k) / self.material_between(k - 1, k + 1);
        self.branch_forces.merge(k - 1, part);
        self.excess.merge(k - 1, part);
        self.remembered_impulses.merge(k - 1, part);
        self.branch_moments.remove_node(k);
        self.arc_length.remove(k);
        self.rest_length.remove(k);
        self.renew_rest_length(k - 1);
        self.fixity.remove(k);
        self.sliding.remove(k);
    }
}

/// Number of bars for a stretch of `length` if a cable of length `whole` is to have about
/// `segments`.
#[must_use]
pub fn bars_between(length: f64, whole: f64, segments: usize) -> usize {
    let share = (segments as f64 * length / whole).round();
    if share >= 1.0 { share as usize } else { 1 }
}
