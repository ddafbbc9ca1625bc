//! A cable at rest sleeps until something that acts on it changes.
//!
//! On rough ground two or three nodes may tremble for ever inside the reach of the barrier. Where
//! no node has left its place by more than that for a while, and all that acts on the cable is what
//! acted then, nothing more will happen: the state is kept, speeds are 0 and a step costs a
//! comparison.

use crate::math::Vec2;
use crate::model::fem::dynamics::{Dynamics, REACH};
use crate::model::fem::state::stepping::Sleep;

/// How long a cable must have been still, s. Shorter: a slow swing that turns round may be caught.
const SLEEP_DELAY_S: f64 = 0.5;

/// How far (m) a node may have moved in that time: five times the reach of the barrier: a trembling
/// contact moves its neighbours by a few.
const SLEEP_DISTANCE: f64 = 5.0 * REACH;

impl Dynamics {
    /// Looks whether the cable has been still since the last look; to be called after a step.
    pub(in crate::model::fem) fn watch(&mut self) {
        let time = self.motion.time;
        let same = self.pacing.sleep.place.len() == self.motion.x.len();
        if same && time - self.pacing.sleep.since < SLEEP_DELAY_S && time >= self.pacing.sleep.since {
            return;
        }
        let near = |(a, b): (&Vec2, &Vec2)| (a - b).norm() <= SLEEP_DISTANCE;
        let still = same
            && self.pacing.sleep.place.iter().zip(&self.motion.x).all(near)
            && self
                .pacing
                .sleep
                .arc_length
                .iter()
                .zip(&self.mesh.arc_length)
                .all(|(a, b)| (a - b).abs() <= SLEEP_DISTANCE);
        // A cable that touches nothing may be at the turn of a slow swing.
        let lies = !self.contacts.rubs.is_empty() || !self.contacts.own.rubs.is_empty();
        if still && lies && self.same_input() {
            self.pacing.sleep.asleep = true;
            self.motion.v.fill(Vec2::zeros());
            self.motion.w.fill(0.0);
            self.forget_history();
        }
        self.pacing.sleep.since = time;
        self.pacing.sleep.place.clone_from(&self.motion.x);
        self.pacing.sleep.arc_length.clone_from(&self.mesh.arc_length);
        self.pacing.sleep.force.clone_from(&self.task.force);
        self.pacing.sleep.target.clone_from(&self.task.target);
        self.pacing.sleep.held.clone_from(&self.mesh.held);
    }

    fn same_input(&self) -> bool {
        let held = |k: &usize| self.mesh.held[*k];
        self.pacing.sleep.force == self.task.force
            && self.pacing.sleep.held == self.mesh.held
            && self.pacing.sleep.target.len() == self.task.target.len()
            && (0..self.task.target.len()).filter(held).all(|k| self.pacing.sleep.target[k] == self.task.target[k])
    }

    /// Whether the cable sleeps on until the time `to` (s), supports dragged by hand to `dragged`
    /// (m).
    pub(in crate::model::fem) fn sleeps_until(&mut self, to: f64, dragged: &[Option<Vec2>]) -> bool {
        if self.outline_moves() {
            self.pacing.sleep.asleep = false;
        }
        if !self.pacing.sleep.asleep {
            return false;
        }
        let hand = |k: usize| dragged.get(k).copied().flatten();
        let follows = (0..self.motion.followers.len()).any(|k| match (self.motion.followers[k], hand(k)) {
            // A hand that takes hold, lets go, or goes on.
            (_, Some(_)) if self.hand_drive.pulled[k] != self.motion.hands[k].is_some() => true,
            (_, Some(to)) if self.hand_drive.pulled[k] => {
                self.motion.hands[k].is_none_or(|h| (h.end().position() - to).norm() > SLEEP_DISTANCE * 1e-3)
            }
            (Some(f), Some(to)) => (f.position() - to).norm() > SLEEP_DISTANCE * 1e-3,
            (None, Some(to)) => self.support_position(k).is_none_or(|at| (at - to).norm() > SLEEP_DISTANCE * 1e-3),
            _ => false,
        });
        self.prepare_task(to, Some(dragged));
        self.pacing.sleep.asleep = !follows && self.same_input();
        self.pacing.sleep.asleep
    }

    /// Wakes the cable.
    pub(in crate::model::fem) fn wake(&mut self) {
        self.pacing.sleep = Sleep::default();
    }
}
