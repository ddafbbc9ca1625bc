//! This module moves bodies along their paths, the outline of a robot and posts in place of wheels,
//! and the cable out of their way.
//!
//! Within a step a body stands where it will be at the end of the step. The cable is moved out of
//! its way first, as the start of the iteration only: history, inertia and friction anchors are
//! unchanged, so the barrier alone provides the contact force. That start is found in three parts:
//! - bars near a body move with it as if they were part of it, so it passes none of them;
//! - gaps g of the moved nodes and bars to fixed obstacles and to the bodies are restored, one
//!   after the other, until with the displacement u (for gaps to a body: relative to it)
//!   ```text
//!   n·u ≥ −(1 − κ) g
//!   ```
//! - the motion is swept, past fixed obstacles in the frame of the ground and past each body in its
//!   own frame. If it is not free, the outline moves half as far, and if it cannot move at all, it
//!   stays. A post moves as its scene says, so that the step fails then.

use std::sync::Arc;

use crate::contact::distance::segment_segment;
use crate::contact::geometry::{Body, Geometry, ObstaclePart};
use crate::contact::self_contact_pairs::SortedNodes;
use crate::contact::sweep::Sweep;
use crate::math::{RigidPose, Vec2, larger, smaller};
use crate::model::RobotContact;
use crate::model::fem::mesh::Mesh;
use crate::model::fem::state::{CableState, Meshing, prepare_step, stopped_by_obstacles};
use crate::model::fem::system::{BodyMotion, ContactPair, Failure, FailureCause, StepContext};
use crate::problem::{Problem, SupportPoint};
use crate::scene::SupportKind;

/// Sum of the squared shares of free nodes in a gap from which they restore it. Smaller: a free
/// node beside a held one is thrown a thousand times as far; larger: gaps beside supports stay
/// lost.
const LEAST_SQUARED_SHARES: f64 = 1e-6;

/// Displacement of the outline below which it stands still, m.
const STANDSTILL_DISPLACEMENT_M: f64 = 1e-12;

/// Lack of a gap below which the gap counts as restored, m.
const RESTORED_GAP_LACK_M: f64 = 1e-13;

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
        move_outline(cable, to);
    }
    moves
}

/// Places all bodies that move where they are at the time of the motion.
pub(in crate::model::fem) fn place_bodies(cable: &mut CableState) {
    cable.contacts.body_motions.clear();
    if let Some(at) = cable.motion.placement {
        move_outline(cable, at);
    }
    move_posts(cable, cable.motion.time);
}

/// Moves the outline only.
fn move_outline(cable: &mut CableState, to: RigidPose) {
    cable.motion.placement = Some(to);
    if let Some(outline) = &cable.outline {
        let world = &mut Arc::make_mut(&mut cable.problem).world;
        Arc::make_mut(world).place_outline(&outline.shape, to);
        cable.contacts.search.lists.clear();
    }
}

/// Moves the posts to their places at a time (s); returns the motions of those that were elsewhere.
fn move_posts(cable: &mut CableState, to: f64) -> Vec<BodyMotion> {
    let mut motions = Vec::new();
    let bodies = cable.problem.world.geometry().bodies();
    for post in &cable.problem.moving_posts {
        let center = bodies.iter().find(|body| body.obstacle == post.obstacle).and_then(|body| body.center);
        let (Some(from), to) = (center, post.center_at(to)) else { continue };
        if from != to {
            let pose = |at| RigidPose { at, ..RigidPose::default() };
            motions.push(BodyMotion {
                obstacle: post.obstacle,
                from: pose(from),
                to: pose(to),
                way_m: (to - from).norm(),
                is_support: true,
            });
        }
    }
    if !motions.is_empty() {
        let world = Arc::make_mut(&mut Arc::make_mut(&mut cable.problem).world);
        motions.iter().for_each(|motion| world.place_circle(motion.obstacle, motion.to.at));
        cable.contacts.search.lists.clear();
    }
    motions
}

/// Sets the input of a step from one time to another (s), with the bodies where they are at its
/// end.
///
/// # Errors `BodyInTheWay` if the cable does not come clear of a post.
pub(in crate::model::fem) fn prepare_way(
    cable: &mut CableState,
    times: [f64; 2],
    dragged: Option<&[Option<Vec2>]>,
) -> Result<(), Failure> {
    cable.contacts.body_motions.clear();
    let posts = move_posts(cable, times[1]);
    prepare_step(cable, times, dragged);
    if cable.outline.is_none() && posts.is_empty() {
        return Ok(());
    }
    let ends: Vec<[Vec2; 2]> =
        (0..cable.mesh.rest_length.len()).map(|e| cable.mesh.straight(e, &cable.motion.positions)).collect();
    if let Some([from, goal]) = way_of_outline(cable, times[1]) {
        for part in cable.mesh.tuning.outline.way_fractions {
            move_outline(cable, from.towards(&goal, part));
            prepare_step(cable, times, dragged);
            let Some(outline) = motion_of_outline(cable, from) else { break };
            let comes = hitch_on(cable, &outline);
            let mut motions = posts.clone();
            motions.push(outline);
            if comes && clear_way(cable, motions, &ends) {
                return Ok(());
            }
        }
        move_outline(cable, from);
        prepare_step(cable, times, dragged);
    }
    if let Some(stays) = cable.motion.placement.and_then(|at| motion_of_outline(cable, at)) {
        hitch_on(cable, &stays);
    }
    if posts.is_empty() || clear_way(cable, posts.clone(), &ends) {
        return Ok(());
    }
    // Nothing need give way to a post that goes away.
    if BodiesStep::of(cable, &posts).passes_nothing(&ends) {
        cable.contacts.body_motions = posts;
        return Ok(());
    }
    let near =
        |k: usize| posts.iter().map(|p| (cable.motion.positions[k] - p.to.at).norm()).fold(f64::INFINITY, smaller);
    let node = (0..cable.mesh.nodes()).min_by(|a, b| near(*a).total_cmp(&near(*b))).unwrap_or(0);
    Err(Failure { node, residual: f64::NAN, cause: FailureCause::BodyInTheWay })
}

/// The poses between which the outline moves to its goal at a time (s); None if it waits, or stands
/// there.
fn way_of_outline(cable: &CableState, to: f64) -> Option<[RigidPose; 2]> {
    let (outline, from) = (cable.outline.as_ref()?, cable.motion.placement?);
    let goal = outline.goal(to);
    let moves = !outline.waits && outline.shape.max_displacement(&from, &goal) > STANDSTILL_DISPLACEMENT_M;
    moves.then_some([from, goal])
}

/// The motion of the outline from a pose to its present one.
fn motion_of_outline(cable: &CableState, from: RigidPose) -> Option<BodyMotion> {
    let (outline, to) = (cable.outline.as_ref()?, cable.motion.placement?);
    let way_m = outline.shape.max_displacement(&from, &to);
    Some(BodyMotion { obstacle: outline.obstacle, from, to, way_m, is_support: false })
}

/// Begins the step with the cable clear of bodies that move; `ends` are the ends of the bars before
/// they moved. Returns false, with nothing changed, if there is no such start.
fn clear_way(cable: &mut CableState, motions: Vec<BodyMotion>, ends: &[[Vec2; 2]]) -> bool {
    let Some(cleared) = BodiesStep::of(cable, &motions).positions_clear_of_them(ends) else { return false };
    cable.input.supports.cleared = cleared;
    cable.contacts.body_motions = motions;
    true
}

/// Node of the hitch.
fn hitch(problem: &Problem, mesh: &Mesh, meshing: &Meshing) -> Option<usize> {
    let of_robot = |(s, node): (&SupportPoint, &Option<usize>)| node.filter(|_| s.kind == SupportKind::Robot);
    let node = problem.supports.iter().zip(&meshing.support_node).find_map(of_robot)?;
    mesh.fixity[node].then_some(node)
}

/// Moves the hitch to its place on the outline. Returns whether it can follow.
fn hitch_on(cable: &mut CableState, outline_motion: &BodyMotion) -> bool {
    let (Some(k), Some(outline)) = (hitch(&cable.problem, &cable.mesh, &cable.meshing), &cable.outline) else {
        return true;
    };
    let on_it = outline_motion.to.place(outline.shape.hitch);
    if (cable.input.supports.target[k] - on_it).norm() > STANDSTILL_DISPLACEMENT_M {
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
    let left_m = if left > STANDSTILL_DISPLACEMENT_M { left } else { 0.0 };
    Some(RobotContact {
        force_n: cable.contacts.force_on(outline.obstacle, &cable.problem, &cable.mesh, &cable.motion.positions),
        placement: at,
        left_m,
    })
}

/// A step in which bodies move.
struct BodiesStep<'a> {
    step: StepContext<'a>,
    motions: &'a [BodyMotion],
    /// Node of the hitch.
    hitch: Option<usize>,
}

impl<'a> BodiesStep<'a> {
    /// That of a cable whose input is set.
    fn of(cable: &'a CableState, motions: &'a [BodyMotion]) -> Self {
        let hitch = cable.outline.as_ref().and_then(|_| hitch(&cable.problem, &cable.mesh, &cable.meshing));
        Self { step: cable.step_context(), motions, hitch }
    }

    /// The body of a motion, with its index.
    fn body_of(&self, motion: &BodyMotion) -> Option<(usize, &Body)> {
        let bodies = self.step.problem.world.geometry().bodies();
        bodies.iter().enumerate().find(|(_, body)| body.obstacle == motion.obstacle)
    }

    /// Positions of the nodes out of the way of the bodies; `ends` are the ends of the bars before
    /// they moved. None if there are none; empty if no bar is near.
    fn positions_clear_of_them(&self, ends: &[[Vec2; 2]]) -> Option<Vec<Vec2>> {
        let mesh = self.step.mesh;
        let carried_distance = mesh.tuning.outline.carried_distance_m;
        // For each bar the first body that is near it.
        let near: Vec<Option<&BodyMotion>> = ends
            .iter()
            .enumerate()
            .map(|(k, e)| {
                let is_near = |motion: &&BodyMotion| {
                    self.is_near(motion, e.map(|p| motion.carried(p)), carried_distance + 4.0 * motion.way_m)
                };
                self.motions.iter().find(is_near).filter(|_| !mesh.is_break(k))
            })
            .collect();
        if near.iter().all(Option::is_none) {
            return Some(Vec::new());
        }
        let start = &self.step.input.supports.start;
        let goes_with =
            |k: usize| k.checked_sub(1).and_then(|bar| near[bar]).or_else(|| near.get(k).copied().flatten());
        let mut x = start.clone();
        for (k, p) in x.iter_mut().enumerate().filter(|(k, _)| mesh.is_free(*k)) {
            if let Some(motion) = goes_with(k) {
                *p = motion.carried(*p);
            }
        }
        if let Some(k) = self.hitch {
            x[k] = self.step.input.supports.target[k];
        }
        let way = self.motions.iter().map(|motion| motion.way_m).fold(0.0, larger);
        self.restore_gaps(larger(2.0 * way, self.step.contacts.barrier.reach), &mut x);
        self.is_free_way(ends, &x, &near).then_some(x)
    }

    /// True if a bar is nearer to the body of a motion than `within` (m).
    fn is_near(&self, motion: &BodyMotion, [a, b]: [Vec2; 2], within: f64) -> bool {
        let Some((_, body)) = self.body_of(motion) else { return false };
        let reach = within + body.offset;
        if let Some(center) = body.center {
            return segment_segment(a, b, center, center) < reach;
        }
        let r = Vec2::repeat(reach);
        body.candidates(a.inf(&b) - r, a.sup(&b) + r)
            .any(|k| body.edges.get(k).is_some_and(|e| segment_segment(a, b, e.from, e.to) < reach))
    }

    /// Restores the gaps that were lost, as the module describes.
    fn restore_gaps(&self, within: f64, x: &mut [Vec2]) {
        let (mesh, start) = (self.step.mesh, &self.step.input.supports.start);
        let mut gaps: Vec<(ContactPair, Vec2)> = Vec::new();
        let mut found: Vec<ContactPair> = Vec::new();
        for motion in self.motions {
            let gone: Vec<Vec2> = start.iter().map(|p| motion.carried(*p)).collect();
            self.step.contacts.find_within(self.step.problem, mesh, &gone, within, &mut found);
            let wanted = |t: &&ContactPair| t.pair.weight > 0.0 && t.pair.gap.obstacle == motion.obstacle;
            gaps.extend(found.iter().filter(wanted).map(|t| (*t, t.interpolate(&gone))));
        }
        self.step.contacts.find_within(self.step.problem, mesh, start, within, &mut found);
        let is_fixed = |t: &ContactPair| self.motions.iter().all(|motion| motion.obstacle != t.pair.gap.obstacle);
        let wanted = |t: &&ContactPair| t.pair.weight > 0.0 && is_fixed(t);
        gaps.extend(found.iter().filter(wanted).map(|t| (*t, t.interpolate(start))));
        for _ in 0..self.step.mesh.tuning.outline.max_rounds {
            let mut worst = 0.0;
            for (touch, from) in &gaps {
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
                if !(lack > RESTORED_GAP_LACK_M) || sum < LEAST_SQUARED_SHARES {
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

    /// True if the bodies pass no bar that stays where it is.
    fn passes_nothing(&self, ends: &[[Vec2; 2]]) -> bool {
        let (mesh, geometry) = (self.step.mesh, self.step.problem.world.geometry());
        let passes = |e: usize, to: [Vec2; 2], motion: &BodyMotion| {
            let Some((own, _)) = self.body_of(motion) else { return false };
            let from = to.map(|p| motion.carried(p));
            let sweep = Sweep::new(from, to, self.swept_gap_fraction());
            let parts = geometry.parts(sweep.low, sweep.high, sweep.margin).filter(|p| p.body == own);
            geometry.free_fraction_among(parts, &sweep, mesh.rounds(e)) < 1.0
        };
        let mut bars = ends.iter().enumerate().filter(|(e, _)| !mesh.is_break(*e));
        bars.all(|(e, to)| self.motions.iter().all(|motion| !passes(e, *to, motion)))
    }

    /// True if the cable crosses nothing on the way to `x`: no fixed obstacle and, in the frame of
    /// each body that moves, not that body. `near` are the bodies near each bar.
    fn is_free_way(&self, ends: &[[Vec2; 2]], x: &[Vec2], near: &[Option<&BodyMotion>]) -> bool {
        let (mesh, geometry) = (self.step.mesh, self.step.problem.world.geometry());
        let moving: Vec<usize> = self.motions.iter().filter_map(|m| self.body_of(m)).map(|(k, _)| k).collect();
        let swept = |e: usize, from: [Vec2; 2], of_part: &dyn Fn(usize) -> bool| {
            let to = mesh.straight(e, x);
            let sweep = Sweep::new(from, to, self.swept_gap_fraction());
            let parts = geometry.parts(sweep.low, sweep.high, sweep.margin);
            let parts = parts.filter(|p: &ObstaclePart| of_part(p.body) && !is_passed_by(geometry, *p, from, to));
            geometry.free_fraction_among(parts, &sweep, mesh.rounds(e)) >= 1.0
        };
        let clear = ends.iter().enumerate().all(|(e, from)| {
            let moved = mesh.straight(e, x) != *from && !mesh.is_break(e);
            (!moved || swept(e, *from, &|body| !moving.contains(&body)))
                && self.motions.iter().all(|motion| {
                    let own = |body: usize| self.body_of(motion).is_some_and(|(k, _)| k == body);
                    !(moved || near[e] == Some(motion)) || swept(e, from.map(|p| motion.carried(p)), &own)
                })
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
