//! The outline of a robot moves among the obstacles of a cable, from where it is to where it is
//! led.
//!
//! Within a step it stands where it will be at the end of it. What it moved into is pushed out of
//! its way first, and the step is worked out from there: histories, inertia and anchors stay those
//! of where the cable was, so what pushes is the barrier and nothing else. The place to begin from
//! is found in three parts:
//! - bars near the outline go with it as if they were a part of it, so none of them is passed;
//! - gaps g of the nodes and bars that went, to what stands and to the outline, that would be lost
//!   are given back: with u the way from where each was (for the outline: from where it went with
//!   it), one after the other until
//!   ```text
//!   n·u ≥ −(1 − κ) g
//!   ```
//! - the way there is swept, past what stands as seen from the ground and past the outline as seen
//!   from it: where it is not free the outline goes half as far, and where it cannot go at all it
//!   stays.

use std::sync::Arc;

use crate::contact::distance::segment_segment;
use crate::contact::geometry::{Geometry, Part};
use crate::contact::self_contact::SortedNodes;
use crate::contact::sweep::Sweep;
use crate::math::RigidPose;
use crate::math::{Vec2, larger};
use crate::model::RobotContact;
use crate::model::fem::results::rub_force;
use crate::model::fem::state::cable::CableState;
use crate::model::fem::system::assembly::Mesh;
use crate::model::fem::system::friction_state::{ContactPair, OutlineMotion};
use crate::model::fem::time::step_setup::clear_way;
use crate::problem::SupportPoint;
use crate::scene::SupportKind;

/// A way of the outline that counts as none, m.
const STANDS_M: f64 = 1e-12;

/// A lack of a gap that counts as none, m.
const NONE: f64 = 1e-13;

/// Returns whether a segment that moves evenly stays clear of an edge because its ends stay on one
/// side of the edge's line. For a cable that is drawn along the ground this decides at once, where
/// the sweep advances by one gap's width at a time.
fn is_passed_by(geometry: &Geometry, part: Part, from: [Vec2; 2], to: [Vec2; 2]) -> bool {
    let Some(body) = geometry.bodies().get(part.body) else { return false };
    let Some(edge) = part.edge.and_then(|k| body.edges.get(k)) else { return false };
    let heights = [from[0], from[1], to[0], to[1]].map(|p| (p - edge.p).dot(&edge.normal()));
    heights.iter().all(|h| *h > body.offset) || heights.iter().all(|h| *h < -body.offset)
}

impl CableState {
    /// Leads the outline: it goes there in the next advance.
    pub(in crate::model::fem) fn set_robot_pose(&mut self, to: RigidPose) {
        if let Some(outline) = &mut self.outline
            && to.at.iter().all(|c| c.is_finite())
            && to.angle.is_finite()
        {
            outline.led_before = std::mem::replace(&mut outline.to.1, to);
        }
    }

    /// Its way for an advance to the time `end`, s.
    pub(in crate::model::fem) fn begin_way(&mut self, end: f64) {
        let now = self.motion.time;
        if let (Some(outline), Some(at)) = (&mut self.outline, self.motion.placement) {
            outline.from = (now, at);
            outline.to.0 = end;
            outline.waits = false;
        }
    }

    /// True if it is to move.
    pub(in crate::model::fem) fn outline_moves(&self) -> bool {
        self.outline.as_ref().is_some_and(|r| r.led_before != r.to.1)
    }

    /// Puts the outline where it is led at once, whatever lies there; returns whether it moved.
    pub(in crate::model::fem) fn put_outline(&mut self) -> bool {
        let Some(to) = self.outline.as_ref().map(|r| r.to.1) else { return false };
        let moves = self.motion.placement != Some(to);
        if moves {
            self.motion.placement = Some(to);
            self.place_outline();
        }
        moves
    }

    /// The obstacles with the outline where the motion has it.
    pub(in crate::model::fem) fn place_outline(&mut self) {
        self.contacts.outline_motion = None;
        if let (Some(outline), Some(at)) = (&self.outline, self.motion.placement) {
            let world = &mut Arc::make_mut(&mut self.problem).world;
            Arc::make_mut(world).place_outline(&outline.shape, at);
            self.contacts.near.clear();
        }
    }

    /// Lets it wait where it is until the end of this advance; returns whether it was moving.
    pub(in crate::model::fem) fn outline_waits(&mut self) -> bool {
        let at = self.motion.placement;
        let Some(outline) = self.outline.as_mut().filter(|r| !r.waits && at != Some(r.to.1)) else { return false };
        outline.waits = true;
        true
    }

    /// Sets the input of a step from one time to another (s), the outline where it will then be.
    pub(in crate::model::fem) fn prepare_way(&mut self, times: [f64; 2], dragged: Option<&[Option<Vec2>]>) {
        self.prepare_step(times, dragged);
        let (Some(outline), Some(from)) = (&self.outline, self.motion.placement) else { return };
        let (goal, obstacle) = (outline.goal(times[1]), outline.obstacle);
        if outline.waits || !(outline.shape.max_displacement(&from, &goal) > STANDS_M) {
            self.hitch_on(&OutlineMotion { obstacle, from, to: from });
            return;
        }
        let ends: Vec<[Vec2; 2]> =
            (0..self.mesh.rest_length.len()).map(|e| self.mesh.straight(e, &self.motion.x)).collect();
        for part in self.mesh.tuning.outline.way_fractions {
            let outline_motion = OutlineMotion { obstacle, from, to: from.towards(&goal, part) };
            self.move_outline(&outline_motion);
            self.prepare_step(times, dragged);
            let comes = self.hitch_on(&outline_motion);
            if let Some(cleared) = self.positions_clear_of(&outline_motion, &ends).filter(|_| comes) {
                self.input.cleared = cleared;
                self.contacts.outline_motion = Some(outline_motion);
                return;
            }
            self.move_outline(&OutlineMotion { from: outline_motion.to, to: from, ..outline_motion });
        }
        self.prepare_step(times, dragged);
        self.hitch_on(&OutlineMotion { obstacle, from, to: from });
    }

    /// Node of the hitch.
    fn hitch(&self) -> Option<usize> {
        let of_robot = |(s, node): (&SupportPoint, &Option<usize>)| node.filter(|_| s.kind == SupportKind::Robot);
        let node = self.problem.supports.iter().zip(&self.meshing.support_node).find_map(of_robot)?;
        self.mesh.held[node].then_some(node)
    }

    /// Puts the hitch where it is on the outline. Returns whether it can come along.
    fn hitch_on(&mut self, outline_motion: &OutlineMotion) -> bool {
        let (Some(k), Some(outline)) = (self.hitch(), &self.outline) else { return true };
        let on_it = outline_motion.to.place(outline.shape.hitch);
        if (self.input.target[k] - on_it).norm() > STANDS_M {
            self.input.target[k] = clear_way(&self.problem, &self.mesh, self.input.start[k], on_it);
        }
        let far = |p: Vec2| (p - on_it).norm();
        let now = self.input.start[k];
        // One that was stopped by a wall stays there until the robot is as far from it as it may be
        // left behind.
        let gap =
            |p: Vec2| self.problem.world.signed_gap(p, self.problem.radius).map_or(self.problem.radius, |g| g.gap_m);
        if far(now) <= self.mesh.tuning.outline.max_hitch_lag_m && gap(self.input.target[k]) < gap(now) {
            self.input.target[k] = now;
        }
        far(now) <= self.mesh.tuning.outline.max_hitch_lag_m
            || far(now) <= (now - outline_motion.from.place(outline.shape.hitch)).norm()
    }

    /// Moves the outline and nothing else.
    fn move_outline(&mut self, outline_motion: &OutlineMotion) {
        self.motion.placement = Some(outline_motion.to);
        self.place_outline();
    }

    /// Positions of the nodes out of the way of the outline; `ends` are those of the bars before it
    /// moved. None where they cannot.
    fn positions_clear_of(&self, outline_motion: &OutlineMotion, ends: &[[Vec2; 2]]) -> Option<Vec<Vec2>> {
        let Some(outline) = &self.outline else { return Some(Vec::new()) };
        let way = outline.shape.max_displacement(&outline_motion.from, &outline_motion.to);
        let near: Vec<bool> = ends
            .iter()
            .map(|e| {
                self.is_near(
                    e.map(|p| outline_motion.carried(p)),
                    self.mesh.tuning.outline.carried_distance_m + 4.0 * way,
                )
            })
            .collect();
        if !near.contains(&true) {
            return Some(Vec::new());
        }
        let start = &self.input.start;
        let goes = |k: usize| (k > 0 && near.get(k - 1) == Some(&true)) || near.get(k) == Some(&true);
        let mut x = start.clone();
        for (k, p) in x.iter_mut().enumerate().filter(|(k, _)| goes(*k)) {
            if self.mesh.is_free(k) {
                *p = outline_motion.carried(*p);
            }
        }
        if let Some(k) = self.hitch() {
            x[k] = self.input.target[k];
        }
        self.restore_gaps(outline_motion, larger(2.0 * way, self.contacts.barrier.reach), &mut x);
        self.is_free_way(outline_motion, ends, &x, &near).then_some(x)
    }

    /// True if a bar is nearer to the outline than `within`, m.
    fn is_near(&self, [a, b]: [Vec2; 2], within: f64) -> bool {
        let geometry = self.problem.world.geometry();
        let Some(body) = geometry.bodies().last() else { return false };
        let r = Vec2::repeat(within + body.offset);
        let reach = within + body.offset;
        body.candidates(a.inf(&b) - r, a.sup(&b) + r)
            .any(|k| body.edges.get(k).is_some_and(|e| segment_segment(a, b, e.p, e.q) < reach))
    }

    /// Gives back the gaps that were lost; see the module.
    fn restore_gaps(&self, outline_motion: &OutlineMotion, within: f64, x: &mut [Vec2]) {
        let (mesh, start) = (&self.mesh, &self.input.start);
        let gone: Vec<Vec2> = start.iter().map(|p| outline_motion.carried(*p)).collect();
        let mut kept: Vec<(ContactPair, Vec2)> = Vec::new();
        let mut found: Vec<ContactPair> = Vec::new();
        for (from, of_outline) in [(&gone, true), (start, false)] {
            self.contacts.find_within(&self.problem, mesh, from, within, &mut found);
            let wanted = |t: &&ContactPair| {
                t.pair.weight > 0.0 && (t.pair.gap.obstacle == outline_motion.obstacle) == of_outline
            };
            kept.extend(found.iter().filter(wanted).map(|t| (*t, t.interpolate(from))));
        }
        for _ in 0..self.mesh.tuning.outline.max_rounds {
            let mut worst = 0.0;
            for (touch, from) in &kept {
                let gap = &touch.pair.gap;
                let least =
                    if gap.gap_m > 0.0 { -(1.0 - self.mesh.tuning.outline.kept_gap_fraction) * gap.gap_m } else { 0.0 };
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

    /// True if nothing is passed on the way to `x`: neither what stands nor, seen from it, the
    /// outline.
    fn is_free_way(&self, outline_motion: &OutlineMotion, ends: &[[Vec2; 2]], x: &[Vec2], near: &[bool]) -> bool {
        let (mesh, geometry) = (&self.mesh, self.problem.world.geometry());
        let own = geometry.bodies().len().saturating_sub(1);
        let swept = |e: usize, from: [Vec2; 2], of_outline: bool| {
            let to = mesh.straight(e, x);
            let sweep = Sweep::new(from, to, self.mesh.tuning.outline.swept_gap_fraction);
            let parts = geometry.parts(sweep.low, sweep.high, sweep.margin);
            let parts = parts.filter(|p: &Part| (p.body == own) == of_outline && !is_passed_by(geometry, *p, from, to));
            geometry.free_fraction_among(parts, &sweep, mesh.rounds(e)) >= 1.0
        };
        let clear = ends.iter().enumerate().all(|(e, from)| {
            let moved = mesh.straight(e, x) != *from;
            (!moved || swept(e, *from, false))
                && (!(moved || near[e]) || swept(e, from.map(|p| outline_motion.carried(p)), true))
        });
        let step = |k: usize| x[k] - self.input.start[k];
        let arc = mesh.arc_length.as_slice();
        let own_way = |order: &mut SortedNodes| {
            self.contacts.own.shape.free_fraction(
                &self.input.start,
                arc,
                &step,
                [self.mesh.tuning.outline.swept_gap_fraction, f64::INFINITY, 1.0],
                order,
            )
        };
        clear && own_way(&mut SortedNodes::default()) >= 1.0
    }

    /// Force of the cable on the outline, and the rest of the path on which the outline was led.
    pub(in crate::model::fem) fn outline_report(&self) -> Option<RobotContact> {
        let (outline, at) = (self.outline.as_ref()?, self.motion.placement?);
        let left = outline.shape.max_displacement(&at, &outline.to.1);
        let left_m = if left > STANDS_M { left } else { 0.0 };
        Some(RobotContact { force_n: self.force_on(outline.obstacle), placement: at, left_m })
    }

    /// Force of the cable on an obstacle, N.
    fn force_on(&self, obstacle: usize) -> Vec2 {
        let (mesh, x): (&Mesh, &[Vec2]) = (&self.mesh, &self.motion.x);
        let mut sum = Vec2::zeros();
        let mut touches = Vec::new();
        self.contacts.find(&self.problem, mesh, x, &mut touches);
        for touch in touches.iter().filter(|t| t.pair.gap.obstacle == obstacle) {
            sum -= touch.pair.gap.normal * touch.load(&self.contacts.barrier);
        }
        for rub in self.contacts.friction_contacts.iter().filter(|r| r.touch.pair.gap.obstacle == obstacle) {
            sum -= rub_force(&self.contacts, rub, x);
        }
        sum
    }
}
