//! This check finds whether the bars of a mesh run through obstacles.
//!
//! The step search is collision-free by construction (`contact/sweep.rs`). This check covers the
//! two cases that it does not: bars that change when a node is inserted, moved or removed beside a
//! corner, and adopted states. A bar that is tangent to the round of a corner is always nearer to
//! the corner's edges than the barrier's reach at that end, so there the check is that the tangent
//! point does not lie over an edge.

use crate::error::{NoEquilibrium, SolveError};
use crate::math::{Vec2, bounded, perp, smaller};
use crate::model::Model;
use crate::model::fem::mesh::{Mesh, SlideOver, SlidingNode, TangentPath, round_of};
use crate::model::fem::state::CableState;
use crate::model::fem::system::StepContext;
use crate::problem::{Departure, Problem};

/// Depth, in radii of the cable, from which the cable is reported to run through an obstacle; a
/// cable that just touches has a depth of 0. Smaller: cables that press on an obstacle are
/// reported; larger: cables that cut off a corner are not. A choice, tuned on no campaign.
const MAX_DEPTH_RADII: f64 = 0.9;

/// A cable among its obstacles, at given positions.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct IntersectionCheck<'a> {
    problem: &'a Problem,
    mesh: &'a Mesh,
    /// Reach of the barrier, m.
    reach: f64,
    /// Position of each node, m.
    positions: &'a [Vec2],
}

impl<'a> IntersectionCheck<'a> {
    /// The check of a cable in its present state.
    pub(in crate::model::fem) fn of(cable: &'a CableState) -> Self {
        Self::at(cable, &cable.motion.positions)
    }

    /// The check of a cable at positions `x` (m).
    pub(in crate::model::fem) fn at(cable: &'a CableState, x: &'a [Vec2]) -> Self {
        Self { problem: &cable.problem, mesh: &cable.mesh, reach: cable.contacts.barrier.reach, positions: x }
    }

    /// The obstacle through which a cable runs that did not come to rest, because it cannot get out
    /// of there.
    pub(in crate::model::fem) fn obstacle_run_through(&self) -> Option<NoEquilibrium> {
        let (mesh, world, x) = (self.mesh, &self.problem.world, self.positions);
        if x.len() != mesh.nodes() {
            return None;
        }
        // The centre line is inside the obstacle itself, or nearly so; a cable that touches it is
        // outside.
        let least = -MAX_DEPTH_RADII * self.problem.radius;
        let clear =
            |e: usize| mesh.is_break(e) || world.geometry().is_clear(mesh.straight(e, x), least, mesh.rounds(e));
        let e = (0..mesh.rest_length.len()).filter(|&e| mesh.is_free(e) || mesh.is_free(e + 1)).find(|&e| !clear(e))?;
        let [a, b] = mesh.straight(e, x);
        let gap = world.signed_gap((a + b) * 0.5, f64::INFINITY)?;
        let obstacle = world.obstacle_name(gap.obstacle).to_owned();
        Some(NoEquilibrium::ThroughObstacle { obstacle, at_m: gap.point, arc_length_m: mesh.arc_length[e] })
    }

    /// The check of the cable of a step at positions `x` (m).
    pub(in crate::model::fem) fn among(step: &StepContext<'a>, x: &'a [Vec2]) -> Self {
        Self { problem: step.problem, mesh: step.mesh, reach: step.contacts.barrier.reach, positions: x }
    }

    /// True if a bar meets nothing.
    pub(in crate::model::fem) fn is_clear(&self, e: usize) -> bool {
        self.mesh.is_break(e)
            || self.way_is_clear(&self.mesh.path(e, self.positions), [e, e + 1].map(|k| self.mesh.sliding[k].as_ref()))
    }

    /// Returns whether every bar between two free nodes is clear of obstacles. The positions of
    /// supports are given by the scene.
    pub(in crate::model::fem) fn cuts_nothing(&self) -> bool {
        let moves = |k: usize| self.mesh.sliding[k].is_some() || self.mesh.is_free(k);
        (0..self.mesh.rest_length.len()).all(|e| !(moves(e) && moves(e + 1)) || self.is_clear(e))
    }

    /// True if the cable meets or leaves the round of a corner over one of the corner's edges: it
    /// has folded back and would run through the edge.
    pub(in crate::model::fem) fn beyond_its_corner(&self, k: usize) -> bool {
        let Some(node) = self.mesh.sliding[k] else { return false };
        let meets = [self.mesh.path(k - 1, self.positions).ends[1], self.mesh.path(k, self.positions).ends[0]];
        meets.into_iter().any(|p| self.is_over_an_edge(&node, p, 0.0))
    }

    /// True if a point on the round of a corner lies over one of the corner's edges, nearer to it
    /// than `least` (a fraction of the barrier's reach): a path tangent there runs through the
    /// edge.
    pub(in crate::model::fem) fn is_over_an_edge(&self, node: &SlidingNode, p: Vec2, least: f64) -> bool {
        let geometry = self.problem.world.geometry();
        let body = node.feature().and_then(|f| Some((f, geometry.body_of(f)?)));
        let Some((f, body)) = body.filter(|b| b.1.center.is_none()) else { return false };
        let Some(corner) = body.corner((f - body.first) / 2) else { return false };
        let least = body.offset + least * self.reach;
        let into = [corner.before.map(|t| (-t, perp(t))), corner.after.map(|t| (t, perp(t)))];
        let from = p - node.end.center;
        into.into_iter().flatten().any(|(t, n)| from.dot(&t) > 0.0 && from.dot(&n).abs() < least)
    }

    /// True if the straight part of a path between two nodes is clear of obstacles, and of the
    /// edges of the corners to which it is tangent.
    pub(in crate::model::fem) fn way_is_clear(&self, way: &TangentPath, nodes: [Option<&SlidingNode>; 2]) -> bool {
        if matches!(nodes, [Some(a), Some(b)] if a.opposes(b)) {
            return false;
        }
        let geometry = self.problem.world.geometry();
        let rounds = nodes.map(|s| s.and_then(SlidingNode::feature));
        (0..2).all(|j| {
            nodes[j].is_none_or(|s| !self.is_over_an_edge(s, way.ends[j], self.mesh.tuning.remesh.min_gap_reaches))
        }) && geometry.is_clear(way.ends, self.mesh.tuning.remesh.min_gap_reaches * self.reach, rounds)
    }

    /// True if the straight path without node `k` is clear of obstacles.
    pub(in crate::model::fem) fn clear_without(&self, k: usize) -> bool {
        if self.problem.world.is_empty() {
            return true;
        }
        let x = self.positions;
        let way = TangentPath::between(&self.mesh.end(k - 1, x), &self.mesh.end(k + 1, x));
        self.way_is_clear(&way, [k - 1, k + 1].map(|j| self.mesh.sliding[j].as_ref()))
    }

    /// A bar that is tangent to a corner or circle and runs through an obstacle. All other bars are
    /// checked by the step bound, so if there is none, the cable crosses nothing.
    pub(in crate::model::fem) fn crossing(&self) -> Option<usize> {
        let (mesh, geometry) = (self.mesh, self.problem.world.geometry());
        (0..mesh.rest_length.len()).find(|&e| {
            let nodes = [e, e + 1].map(|k| mesh.sliding[k].as_ref());
            let slides =
                |s: Option<&SlidingNode>| s.is_some_and(|s| matches!(s.slide_over, SlideOver::Obstacle { .. }));
            if !nodes.into_iter().any(slides) {
                return false;
            }
            let way = mesh.path(e, self.positions);
            let over = (0..2).any(|j| nodes[j].is_some_and(|s| self.is_over_an_edge(s, way.ends[j], 0.0)));
            // The positions of supports and pulleys are given by the scene.
            let own = (0..2).all(|j| slides(nodes[j]) || mesh.is_free(e + j));
            over || (own && !geometry.is_clear(way.ends, 0.0, mesh.rounds(e)))
        })
    }

    /// Returns an error if a node is inside an obstacle. A bar that only cuts off a corner is
    /// mended by the following equilibrium.
    pub(in crate::model::fem) fn refuse_buried(&self) -> Result<(), SolveError> {
        let (mesh, x, world) = (self.mesh, self.positions, &self.problem.world);
        if world.is_empty() {
            return Ok(());
        }
        let buried = |k: usize, obstacle: usize, depth_m: f64| SolveError::Buried {
            model: Model::Fem,
            obstacle: world.obstacle_name(obstacle).to_owned(),
            depth_m,
            arc_length_m: mesh.arc_length[k],
            at_m: x[k],
        };
        for k in (0..mesh.nodes()).filter(|&k| mesh.is_free(k)) {
            // Any depth counts.
            if let Some(gap) = world.signed_gap(x[k], f64::INFINITY).filter(|g| g.gap_m <= 0.0) {
                return Err(buried(k, gap.obstacle, -gap.gap_m));
            }
        }
        Ok(())
    }

    /// A sliding node on an obstacle round which the cable turns the wrong way by more than `wrong`
    /// (rad), or beside which it runs through the obstacle: the corner would have to pull there.
    pub(in crate::model::fem) fn pulled_corner(&self, wrong: f64) -> Option<usize> {
        (1..self.mesh.nodes().saturating_sub(1)).find(|&k| {
            self.mesh.sliding[k].is_some_and(|node| {
                let is_wrong = || self.mesh.turn(k, self.positions) < -wrong || self.beyond_its_corner(k);
                node.feature().is_some() && self.mesh.is_alone_on_round(k) && is_wrong()
            })
        })
    }

    /// A sliding node on a wheel that the cable may leave and round which it turns the wrong way by
    /// more than `wrong` (rad): the wheel would have to pull.
    pub(in crate::model::fem) fn pulled_wheel(&self, wrong: f64) -> Option<usize> {
        let may_be_left = |k: usize| match self.mesh.sliding[k].map(|node| node.slide_over) {
            Some(SlideOver::Pulley(support)) => {
                self.problem.supports.get(support).is_some_and(|s| s.departure == Departure::Possible)
            }
            _ => false,
        };
        let is_wrong = |k: &usize| {
            may_be_left(*k) && self.mesh.is_alone_on_round(*k) && self.mesh.turn(*k, self.positions) < -wrong
        };
        (1..self.mesh.nodes().saturating_sub(1)).find(is_wrong)
    }

    /// Distance at which the cable runs round a corner or circle, m: the reach of the barrier, but
    /// at most the distance of an end of the cable that is fixed on that round.
    pub(in crate::model::fem) fn clearance(&self, feature: usize) -> f64 {
        let reach = self.reach;
        let Some((center, radius)) = round_of(self.problem.world.geometry(), feature, 0.0, 0.0) else { return reach };
        let fixed = [0, self.mesh.nodes() - 1].into_iter().filter(|&k| self.mesh.fixity[k]);
        let gaps = fixed.map(|k| bounded((self.positions[k] - center).norm() - radius, 0.0, reach));
        gaps.fold(reach, smaller)
    }
}
