//! This module moves the outline of a robot along its path, and the cable out of its way.
//!
//! Within a step the outline stands where it will be at the end of the step. The cable is moved out
//! of its way first, as the start of the iteration only: history, inertia and friction anchors are
//! unchanged, so the barrier alone provides the contact force. That start is found in three parts:
//! - bars near the outline move with it as if they were part of it, so it passes none of them;
//! - gaps g of the moved nodes and bars to fixed obstacles and to the outline are restored, one
//!   after the other, until with the displacement u (for gaps to the outline: relative to it)
//!   ```text
//!   n·u ≥ −(1 − κ) g
//!   ```
//! - the motion is swept, past fixed obstacles in the frame of the ground and past the outline in
//!   its own frame. If it is not free, the outline moves half as far, and if it cannot move at all,
//!   it stays.

use std::sync::Arc;

use crate::contact::distance::segment_segment;
use crate::contact::geometry::{Geometry, ObstaclePart};
use crate::contact::self_contact_pairs::SortedNodes;
use crate::contact::sweep::Sweep;
use crate::math::{Vec2, larger};
use crate::model::RobotContact;
use crate::model::fem::mesh::Mesh;
use crate::model::fem::state::{CableState, Meshing, MovingOutline, prepare_step, stopped_by_obstacles};
use crate::model::fem::system::{ContactPair, OutlineMotion, StepContext};
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;

/// Displacement of the outline below which it stands still, m.
const STANDS_M: f64 = 1e-12;

/// Lack of a gap below which the gap counts as restored, m.
const NONE: f64 = 1e-13;

/// Returns whether a segment that moves evenly stays clear of an edge because its ends stay on one
/// side of the edge's line. For a cable that is dragged along the ground this test decides at once,
/// whereas the sweep advances by one gap at a time.
fn is_passed_by(geometry: &Geometry, part: ObstaclePart, from: [Vec2; 2], to: [Vec2; 2]) -> bool {
    let Some(body) = geometry.bodies().get(part.body) else { return false };
    let Some(edge) = part.edge.and_then(|k| body.edges.get(k)) else { return false };
    let heights = [from[0], from[1], to[0], to[1]].map(|p| (p - edge.from).dot(&edge.normal()));
    heights.iter().all(|h| *h > body.offset) || heights.iter().all(|h| *h < -body.offset)
}

/// Moves the outline to its target at once, even into the cable; returns whether it moved.
pub(in crate::model::fem) fn put_outline(cable: &mut CableState) -> bool {
    let Some(to) = cable.outline.as_ref().map(|r| r.to.1) else { return false };
    let moves = cable.motion.placement != Some(to);
    if moves {
        cable.motion.placement = Some(to);
        place_outline(cable);
    }
    moves
}

/// Places the outline among the obstacles at the pose of the motion.
pub(in crate::model::fem) fn place_outline(cable: &mut CableState) {
    cable.contacts.outline_motion = None;
    if let (Some(outline), Some(at)) = (&cable.outline, cable.motion.placement) {
        let world = &mut Arc::make_mut(&mut cable.problem).world;
        Arc::make_mut(world).place_outline(&outline.shape, at);
        cable.contacts.search.lists.clear();
    }
}

/// Moves the outline only.
fn move_outline(cable: &mut CableState, outline_motion: &OutlineMotion) {
    cable.motion.placement = Some(outline_motion.to);
    place_outline(cable);
}

/// Sets the input of a step from one time to another (s), with the outline at its end pose.
pub(in crate::model::fem) fn prepare_way(cable: &mut CableState, times: [f64; 2], dragged: Option<&[Option<Vec2>]>) {
    prepare_step(cable, times, dragged);
    let (Some(outline), Some(from)) = (&cable.outline, cable.motion.placement) else { return };
    let (goal, obstacle) = (outline.goal(times[1]), outline.obstacle);
    if outline.waits || !(outline.shape.max_displacement(&from, &goal) > STANDS_M) {
        hitch_on(cable, &OutlineMotion { obstacle, from, to: from });
        return;
    }
    let ends: Vec<[Vec2; 2]> =
        (0..cable.mesh.rest_length.len()).map(|e| cable.mesh.straight(e, &cable.motion.positions)).collect();
    for part in cable.mesh.tuning.outline.way_fractions {
        let outline_motion = OutlineMotion { obstacle, from, to: from.towards(&goal, part) };
        move_outline(cable, &outline_motion);
        prepare_step(cable, times, dragged);
        let comes = hitch_on(cable, &outline_motion);
        let positions = OutlineStep::of(cable, outline_motion).and_then(|step| step.positions_clear_of_it(&ends));
        if let Some(cleared) = positions.filter(|_| comes) {
            cable.input.supports.cleared = cleared;
            cable.contacts.outline_motion = Some(outline_motion);
            return;
        }
        move_outline(cable, &OutlineMotion { from: outline_motion.to, to: from, ..outline_motion });
    }
    prepare_step(cable, times, dragged);
    hitch_on(cable, &OutlineMotion { obstacle, from, to: from });
}

/// Node of the hitch.
fn hitch(problem: &Problem, mesh: &Mesh, meshing: &Meshing) -> Option<usize> {
    let of_robot = |(s, node): (&SupportPoint, &Option<usize>)| node.filter(|_| s.kind == SupportKind::Robot);
    let node = problem.supports.iter().zip(&meshing.support_node).find_map(of_robot)?;
    mesh.held[node].then_some(node)
}

/// Moves the hitch to its place on the outline. Returns whether it can follow.
fn hitch_on(cable: &mut CableState, outline_motion: &OutlineMotion) -> bool {
    let (Some(k), Some(outline)) = (hitch(&cable.problem, &cable.mesh, &cable.meshing), &cable.outline) else {
        return true;
    };
    let on_it = outline_motion.to.place(outline.shape.hitch);
    if (cable.input.supports.target[k] - on_it).norm() > STANDS_M {
        cable.input.supports.target[k] =
            stopped_by_obstacles(&cable.problem, &cable.mesh, cable.input.supports.start[k], on_it);
    }
    let far = |p: Vec2| (p - on_it).norm();
    let now = cable.input.supports.start[k];
    // A hitch that was stopped by a wall stays there until its distance from the robot reaches the
    // allowed lag.
    let gap =
        |p: Vec2| cable.problem.world.signed_gap(p, cable.problem.radius).map_or(cable.problem.radius, |g| g.gap_m);
    if far(now) <= cable.mesh.tuning.outline.max_hitch_lag_m && gap(cable.input.supports.target[k]) < gap(now) {
        cable.input.supports.target[k] = now;
    }
    far(now) <= cable.mesh.tuning.outline.max_hitch_lag_m
        || far(now) <= (now - outline_motion.from.place(outline.shape.hitch)).norm()
}

/// Force of the cable on the outline, and the part of its path that is left.
pub(in crate::model::fem) fn outline_report(cable: &CableState) -> Option<RobotContact> {
    let (outline, at) = (cable.outline.as_ref()?, cable.motion.placement?);
    let left = outline.shape.max_displacement(&at, &outline.to.1);
    let left_m = if left > STANDS_M { left } else { 0.0 };
    Some(RobotContact {
        force_n: cable.contacts.force_on(outline.obstacle, &cable.problem, &cable.mesh, &cable.motion.positions),
        placement: at,
        left_m,
    })
}

/// A step in which the outline moves.
struct OutlineStep<'a> {
    step: StepContext<'a>,
    outline: &'a MovingOutline,
    motion: OutlineMotion,
    /// Node of the hitch.
    hitch: Option<usize>,
}

impl<'a> OutlineStep<'a> {
    /// The outline's step for a cable whose input is set; None without an outline.
    fn of(cable: &'a CableState, motion: OutlineMotion) -> Option<Self> {
        let outline = cable.outline.as_ref()?;
        let hitch = hitch(&cable.problem, &cable.mesh, &cable.meshing);
        Some(Self { step: cable.step_context(), outline, motion, hitch })
    }

    /// Positions of the nodes out of the way of the outline; `ends` are the ends of the bars before
    /// it moved. None if there are none.
    fn positions_clear_of_it(&self, ends: &[[Vec2; 2]]) -> Option<Vec<Vec2>> {
        let way = self.outline.shape.max_displacement(&self.motion.from, &self.motion.to);
        let near: Vec<bool> = ends
            .iter()
            .enumerate()
            .map(|(k, e)| {
                !self.step.mesh.is_break(k)
                    && self.is_near(
                        e.map(|p| self.motion.carried(p)),
                        self.step.mesh.tuning.outline.carried_distance_m + 4.0 * way,
                    )
            })
            .collect();
        if !near.contains(&true) {
            return Some(Vec::new());
        }
        let start = &self.step.input.supports.start;
        let goes = |k: usize| (k > 0 && near.get(k - 1) == Some(&true)) || near.get(k) == Some(&true);
        let mut x = start.clone();
        for (k, p) in x.iter_mut().enumerate().filter(|(k, _)| goes(*k)) {
            if self.step.mesh.is_free(k) {
                *p = self.motion.carried(*p);
            }
        }
        if let Some(k) = self.hitch {
            x[k] = self.step.input.supports.target[k];
        }
        self.restore_gaps(larger(2.0 * way, self.step.contacts.barrier.reach), &mut x);
        self.is_free_way(ends, &x, &near).then_some(x)
    }

    /// True if a bar is nearer to the outline than `within` (m).
    fn is_near(&self, [a, b]: [Vec2; 2], within: f64) -> bool {
        let geometry = self.step.problem.world.geometry();
        let Some(body) = geometry.bodies().last() else { return false };
        let r = Vec2::repeat(within + body.offset);
        let reach = within + body.offset;
        body.candidates(a.inf(&b) - r, a.sup(&b) + r)
            .any(|k| body.edges.get(k).is_some_and(|e| segment_segment(a, b, e.from, e.to) < reach))
    }

    /// Restores the gaps that were lost, as the module describes.
    fn restore_gaps(&self, within: f64, x: &mut [Vec2]) {
        let (mesh, start) = (self.step.mesh, &self.step.input.supports.start);
        let gone: Vec<Vec2> = start.iter().map(|p| self.motion.carried(*p)).collect();
        let mut kept: Vec<(ContactPair, Vec2)> = Vec::new();
        let mut found: Vec<ContactPair> = Vec::new();
        for (from, of_outline) in [(&gone, true), (start, false)] {
            self.step.contacts.find_within(self.step.problem, mesh, from, within, &mut found);
            let wanted =
                |t: &&ContactPair| t.pair.weight > 0.0 && (t.pair.gap.obstacle == self.motion.obstacle) == of_outline;
            kept.extend(found.iter().filter(wanted).map(|t| (*t, t.interpolate(from))));
        }
        for _ in 0..self.step.mesh.tuning.outline.max_rounds {
            let mut worst = 0.0;
            for (touch, from) in &kept {
                let gap = &touch.pair.gap;
                let least = if gap.gap_m > 0.0 {
                    -(1.0 - self.step.mesh.tuning.outline.kept_gap_fraction) * gap.gap_m
                } else {
                    0.0
                };
                let lack = least - gap.normal.dot(&(touch.interpolate(x) - from));
                let shares = touch.shares();
                let free = [0, 1].map(|j| match shares[j] > 0.0 && mesh.is_free(touch.node + j) {
                    true => shares[j],
                    false => 0.0,
                });
                let sum = free[0] * free[0] + free[1] * free[1];
                if !(lack > NONE) || sum < 1e-6 {
                    continue;
                }
                worst = larger(worst, lack);
                for j in (0..2).filter(|&j| free[j] > 0.0) {
                    x[touch.node + j] += gap.normal * (lack * free[j] / sum);
                }
            }
            if worst == 0.0 {
                break;
            }
        }
    }

    /// The fraction of a gap that the sweep requires: half of the restored one, so that round-off
    /// stops nothing.
    fn swept_gap_fraction(&self) -> f64 {
        0.5 * self.step.mesh.tuning.outline.kept_gap_fraction
    }

    /// True if the cable crosses nothing on the way to `x`: no fixed obstacle and, in the frame of
    /// the moving outline, not the outline.
    fn is_free_way(&self, ends: &[[Vec2; 2]], x: &[Vec2], near: &[bool]) -> bool {
        let (mesh, geometry) = (self.step.mesh, self.step.problem.world.geometry());
        let own = geometry.bodies().len().saturating_sub(1);
        let swept = |e: usize, from: [Vec2; 2], of_outline: bool| {
            let to = mesh.straight(e, x);
            let sweep = Sweep::new(from, to, self.swept_gap_fraction());
            let parts = geometry.parts(sweep.low, sweep.high, sweep.margin);
            let parts =
                parts.filter(|p: &ObstaclePart| (p.body == own) == of_outline && !is_passed_by(geometry, *p, from, to));
            geometry.free_fraction_among(parts, &sweep, mesh.rounds(e)) >= 1.0
        };
        let clear = ends.iter().enumerate().all(|(e, from)| {
            let moved = mesh.straight(e, x) != *from && !mesh.is_break(e);
            (!moved || swept(e, *from, false))
                && (!(moved || near[e]) || swept(e, from.map(|p| self.motion.carried(p)), true))
        });
        let step = |k: usize| x[k] - self.step.input.supports.start[k];
        let arc = mesh.arc_length.as_slice();
        let own_way = |order: &mut SortedNodes| {
            self.step.contacts.self_contacts.shape.free_fraction(
                &self.step.input.supports.start,
                arc,
                &step,
                [self.swept_gap_fraction(), f64::INFINITY, 1.0],
                order,
            )
        };
        clear && own_way(&mut SortedNodes::default()) >= 1.0
    }
}
