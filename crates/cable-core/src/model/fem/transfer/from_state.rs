//! This module continues from a state of another mesh or model, and threads the cable through its
//! pulleys.

use std::sync::Arc;

use crate::error::SolveError;
use crate::math::{Vec2, perp};
use crate::model::fem::dynamics::Dynamics;
use crate::model::fem::free::stations::{Hold, Layout};
use crate::model::fem::mesh::sliding_node::{SlideOver, SlidingNode};
use crate::model::fem::mesh::tangent_path::End;
use crate::model::fem::newton::initial_guess::depenetrate;
use crate::model::fem::state::cable::CableState;
use crate::scene::PulleySide;
use crate::state::State;

impl CableState {
    /// Puts a sliding node at every pulley: where `state` has the cable nearest to it, else where
    /// the layout lays it.
    pub(in crate::model::fem) fn thread_pulleys(&mut self, state: Option<&State>) {
        let problem = Arc::clone(&self.problem);
        let layout = Layout::new(&problem, self.motion.time, &[], &[]);
        for stop in &layout.stops {
            let (Hold::Pulley(wheel), Some(support)) = (stop.hold, stop.support) else { continue };
            let s = state.and_then(|s| s.on_round(wheel.center, wheel.radius)).unwrap_or(stop.arc_length);
            let k = self.mesh.arc_length.partition_point(|&a| a <= s).clamp(1, self.mesh.nodes() - 1);
            let room = 0.05 * problem.length / self.meshing.even_bars as f64;
            let (low, high) = (self.mesh.arc_length[k - 1] + room, self.mesh.arc_length[k] - room);
            let at = if low < high { s.clamp(low, high) } else { 0.5 * (low + high) };
            let passing = self.motion.x[k] - self.motion.x[k - 1];
            let up = if wheel.side == PulleySide::Over { 1.0 } else { -1.0 };
            let right = if passing.x < 0.0 { -1.0 } else { 1.0 };
            let end = End { center: wheel.center, radius: wheel.radius, mark: Vec2::new(0.0, up), sense: -up * right };
            self.insert(k, at, Some(SlidingNode::new(end, wheel.friction, SlideOver::Pulley(support))));
        }
        self.even_out();
        self.renew_input();
    }

    /// Bars that cut off by more than the cable's radius what the state leads round get a node
    /// where the state is farthest from them: from there inside nothing tells on which side of a
    /// corner they were, and nothing could push them out.
    fn follow_corners(&mut self, state: &State) {
        let (mut e, mut left) = (0, state.arc_length_m.len());
        while e + 1 < self.mesh.nodes() {
            let farthest = if left > 0 && !self.is_clear(e) { self.farthest(e, state) } else { None };
            let Some((s, at)) = farthest else {
                e += 1;
                continue;
            };
            self.insert(e + 1, s, None);
            self.motion.x[e + 1] = at;
            self.motion.v[e + 1] = state.velocity_at(s).unwrap_or_default();
            left -= 1;
        }
    }

    /// Arc length and place (m) of the node of a state that is farthest from a bar, if that is more
    /// than the cable's radius.
    fn farthest(&self, e: usize, state: &State) -> Option<(f64, Vec2)> {
        let (s, x) = (&self.mesh.arc_length, &self.motion.x);
        let (from, along) = (x[e], (x[e + 1] - x[e]).try_normalize(0.0)?);
        let near = self.mesh.tuning.start.min_part * (s[e + 1] - s[e]);
        let nodes = state.arc_length_m.iter().copied().zip(state.position_m.iter().copied());
        let inside = nodes.filter(|(a, _)| *a > s[e] + near && *a < s[e + 1] - near);
        let off = |p: &Vec2| perp(along).dot(&(p - from)).abs();
        let farthest = inside.reduce(|a, b| if off(&b.1) > off(&a.1) { b } else { a })?;
        (off(&farthest.1) > self.problem.radius).then_some(farthest)
    }

    /// Takes all sliding nodes out.
    fn unthread(&mut self) {
        let mut k = 1;
        while k + 1 < self.mesh.nodes() {
            if self.mesh.sliding[k].is_some() {
                self.remove(k);
            } else {
                k += 1;
            }
        }
        self.even_out();
    }
}

impl Dynamics {
    /// Takes over a state (from statics: at rest).
    ///
    /// # Errors
    /// When a number is not finite, and `Buried` when it is so far inside an obstacle that nodes
    /// cannot be pushed out.
    pub fn set_state(&mut self, state: &State) -> Result<(), SolveError> {
        if let Some(e) = state.refuse_non_finite() {
            return Err(e);
        }
        if state.arc_length_m.len() < 2 || state.position_m.len() != state.arc_length_m.len() {
            return Ok(());
        }
        self.rollback.save(&self.cable);
        let taken = self.take(state);
        if taken.is_err() {
            self.rollback.restore(&mut self.cable);
        }
        taken
    }

    fn take(&mut self, state: &State) -> Result<(), SolveError> {
        self.pacing.sleep.wake();
        let led = self.cable.put_outline();
        let same = state.arc_length_m == self.cable.mesh.arc_length && !led;
        if !same {
            self.cable.unthread();
        }
        for (k, &s) in self.cable.mesh.arc_length.iter().enumerate() {
            if self.cable.mesh.sliding[k].is_some() {
                continue;
            }
            if let Some(p) = state.position_at(s) {
                self.cable.motion.x[k] = p;
            }
            self.cable.motion.v[k] = state.velocity_at(s).unwrap_or_default();
        }
        self.cable.motion.time = state.time_s;
        self.cable.motion.followers.fill(None);
        self.cable.motion.hands.fill(None);
        self.cable.contacts.forget();
        if !same {
            self.cable.thread_pulleys(Some(state));
        }
        // A state in motion goes on as it is; one at rest is brought to rest on this mesh.
        let still = !state.in_motion && self.cable.motion.v.iter().all(|v| v.norm() == 0.0);
        // So does a first equilibrium: bars that cut a corner would come to rest there. Within a
        // run without inertia what friction holds is not disturbed.
        if !same && (!still || state.time_s == 0.0) {
            self.cable.follow_corners(state);
        }
        if !same || self.cable.refuse_buried().is_err() {
            let mut x = std::mem::take(&mut self.cable.motion.x);
            depenetrate(&self.cable.problem, &self.cable.mesh, &mut x, 0.9 * self.cable.contacts.barrier.reach);
            self.cable.motion.x = x;
        }
        self.cable.refuse_buried()?;
        self.forget_history();
        // A state at rest on another mesh is brought to rest on this one before it moves.
        self.rested = same || !still;
        self.cable.renew_input();
        Ok(())
    }
}
