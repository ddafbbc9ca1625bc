//! This module holds the division of a cable into bars, and the nodes of its supports and loads.

use crate::math::{Vec2, perp};
use crate::model::fem::mesh::{Mesh, rotate};
use crate::model::fem::system::ContactPair;
use crate::problem::TimeSeries;

/// Length over which the weight of an element gives the shift of the Hessian, m. Smaller: a stiffer
/// shift, and slack nodes take more iterations; larger: they wander. A choice, tuned on no
/// campaign.
const SHIFT_LENGTH_M: f64 = 0.1;

/// The node at which a point load acts.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct LoadNode {
    /// Its material node; while it runs over a round, the sliding node nearest to it.
    pub(in crate::model::fem) node: usize,
    /// Arc length at which it acts, m.
    pub(in crate::model::fem) arc_length: f64,
    /// The force, N.
    pub(in crate::model::fem) force: TimeSeries,
}

impl LoadNode {
    /// For a load that runs over the round of its node, the way of its material for a slide of one
    /// metre: against the direction of the path there; and the side of the node's mark on which it
    /// is, 0 before and 1 after it. None at a material node.
    pub(in crate::model::fem) fn way_on_round(&self, mesh: &Mesh, x: &[Vec2]) -> Option<(Vec2, usize)> {
        let k = self.node;
        let end = mesh.sliding.get(k)?.as_ref()?.end;
        let side = usize::from(self.arc_length >= mesh.arc_length[k]);
        let e = k + side - 1;
        let (path, material) = (mesh.path(e, x), mesh.arc_length[e + 1] - mesh.arc_length[e]);
        let stretch = path.length / material;
        let from_mark = (self.arc_length - mesh.arc_length[k]) * stretch;
        let lies_on_arc = from_mark.abs() < end.radius * path.arcs[1 - side];
        let direction = match lies_on_arc {
            true => rotate(perp(end.mark), end.sense * from_mark / end.radius) * end.sense,
            false => path.direction,
        };
        Some((direction * -stretch, side))
    }

    /// The length of path from the round of its node to the load, m; negative while the load is on
    /// the round. None at a material node.
    pub(in crate::model::fem) fn beyond_round(&self, mesh: &Mesh, x: &[Vec2]) -> Option<f64> {
        let k = self.node;
        let end = mesh.sliding.get(k)?.as_ref()?.end;
        let side = usize::from(self.arc_length >= mesh.arc_length[k]);
        let e = k + side - 1;
        let (path, material) = (mesh.path(e, x), mesh.arc_length[e + 1] - mesh.arc_length[e]);
        let from_mark = (self.arc_length - mesh.arc_length[k]).abs() * path.length / material;
        Some(from_mark - end.radius * path.arcs[1 - side])
    }
}

/// The division of the cable into bars, and the nodes of supports and loads.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct Meshing {
    /// True if corners and posts get sliding nodes.
    pub(in crate::model::fem) slides: bool,
    /// True if there is no obstacle and no pulley that nodes could slide over.
    pub(in crate::model::fem) never_slides: bool,
    /// Number of bars of the even mesh.
    pub(in crate::model::fem) even_bars: usize,
    /// Normal force of an even bar on flat ground, N.
    pub(in crate::model::fem) bar_weight: f64,
    /// Node of each support; None for one that slides.
    pub(in crate::model::fem) support_node: Vec<Option<usize>>,
    /// The point loads.
    pub(in crate::model::fem) loads: Vec<LoadNode>,
    /// True if the cable touched nothing but its supports in the last step.
    pub(in crate::model::fem) was_contact_free: bool,
    /// Working memory for the contacts that are searched for corners.
    pub(in crate::model::fem) found: Vec<ContactPair>,
}

impl Meshing {
    /// Shift of the Hessian (N/m): the weight of an element over [`SHIFT_LENGTH_M`], enough to keep
    /// slack nodes from wandering.
    pub(in crate::model::fem) fn soft_shift(&self) -> f64 {
        self.bar_weight / SHIFT_LENGTH_M
    }

    /// Length of an even bar of a cable of this length, m of arc length.
    pub(in crate::model::fem) fn even(&self, length: f64) -> f64 {
        length / self.even_bars as f64
    }

    /// True if a node belongs to no support or load, so that it may be removed.
    pub(in crate::model::fem) fn removable(&self, mesh: &Mesh, k: usize) -> bool {
        k > 0
            && k + 1 < mesh.nodes()
            && mesh.is_free(k)
            && !self.support_node.contains(&Some(k))
            && self.loads.iter().all(|load| load.node != k)
    }

    /// True if a load and no support acts on an inner node.
    pub(in crate::model::fem) fn only_carries_load(&self, mesh: &Mesh, k: usize) -> bool {
        k > 0
            && k + 1 < mesh.nodes()
            && mesh.is_free(k)
            && !self.support_node.contains(&Some(k))
            && self.loads.iter().any(|load| load.node == k)
    }

    /// Gives the nodes of supports and loads their new numbers; None stands for a removed node.
    pub(in crate::model::fem) fn renumber(&mut self, change: impl Fn(usize) -> Option<usize>) {
        for node in &mut self.support_node {
            *node = node.and_then(&change);
        }
        for load in &mut self.loads {
            load.node = change(load.node).unwrap_or(load.node);
        }
    }

    /// True if the bend of a cable of a bending stiffness (N·m²) under a tension (N) is longer than
    /// its bars: then material nodes resolve it, and a sliding node, which carries no moment, would
    /// neglect it.
    pub(in crate::model::fem) fn bends_visibly(&self, mesh: &Mesh, stiffness: f64, tension: f64) -> bool {
        self.bends_visibly_on(self.even_bars, mesh, stiffness, tension)
    }

    /// The same on a mesh of so many bars.
    pub(in crate::model::fem) fn bends_visibly_on(
        &self,
        bars: usize,
        mesh: &Mesh,
        stiffness: f64,
        tension: f64,
    ) -> bool {
        let length = mesh.arc_length.last().copied().unwrap_or_default();
        let least = self.bar_weight + stiffness / (length * length);
        stiffness > 0.0
            && (stiffness / if tension > least { tension } else { least }).sqrt()
                > mesh.tuning.remesh.resolved_bend * length / bars as f64
    }
}
