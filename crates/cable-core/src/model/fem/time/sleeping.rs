//! A cable at rest sleeps until something that acts on it changes.
//!
//! On rough ground two or three nodes may tremble for ever inside the reach of the barrier. If no
//! node has left its position by more than that for a while, and the actions on the cable have not
//! changed, nothing more will happen: the state is kept, speeds are 0 and a step costs a
//! comparison.

use crate::math::Vec2;
use crate::model::fem::state::{CableState, MovingOutline, prepare_input};
use crate::problem::MovingPost;

/// Displacement of a hand that wakes a sleeping cable, as a fraction of the distance by which its
/// nodes may have moved. Smaller: the lag of a hand's filter keeps it awake; larger: a slow hand
/// moves nothing for a while and then jerks. A choice, tuned on no campaign.
const WAKING_HAND_FRACTION: f64 = 1e-3;

/// Distance (m) by which a node of a sleeping cable may have moved.
fn sleep_distance(cable: &CableState) -> f64 {
    cable.mesh.tuning.step.sleep_distance_reaches * cable.mesh.tuning.contact.reach_m
}

/// True if the wheel of a pulley over which the cable runs moves, lets go or is elsewhere at the
/// time `to` (s) by its own motion. Wheels that a hand drags are supports with a follower.
fn wheels_act(cable: &CableState, to: f64) -> bool {
    let moves = |post: &MovingPost| {
        let (at, velocity) = post.motion.at(to);
        at != post.center_at(cable.motion.time) || velocity != Vec2::zeros()
    };
    cable.problem.moving_posts.iter().any(moves) || pulleys_act(cable, to)
}

/// The same of wheels that are pulleys.
fn pulleys_act(cable: &CableState, to: f64) -> bool {
    cable.problem.supports.iter().zip(&cable.motion.followers).enumerate().any(|(k, (support, follower))| {
        let (Some(center), None) = (cable.mesh.pulley_center(k), follower) else { return false };
        let goes = support.place_at(to).is_some_and(|(at, velocity)| at != center || velocity != Vec2::zeros());
        goes || !support.holds_from(to)
    })
}

/// The data of the test for a still cable, and the loads when it fell asleep.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct Sleep {
    since: f64,
    place: Vec<Vec2>,
    arc_length: Vec<f64>,
    force: Vec<Vec2>,
    target: Vec<Vec2>,
    fixity: Vec<bool>,
    asleep: bool,
}

impl Sleep {
    /// Checks after a step whether the cable has been still since the last check; returns true if
    /// it falls asleep now.
    pub(in crate::model::fem) fn falls_asleep(&mut self, cable: &CableState) -> bool {
        let (motion, mesh) = (&cable.motion, &cable.mesh);
        let distance = sleep_distance(cable);
        let same = self.place.len() == motion.positions.len();
        if same && motion.time - self.since < mesh.tuning.step.sleep_delay_s && motion.time >= self.since {
            return false;
        }
        let near = |(a, b): (&Vec2, &Vec2)| (a - b).norm() <= distance;
        let still = same
            && self.place.iter().zip(&motion.positions).all(near)
            && self.arc_length.iter().zip(&mesh.arc_length).all(|(a, b)| (a - b).abs() <= distance);
        // A cable without contact may be at the turning point of a slow swing.
        let touches =
            !cable.contacts.friction_contacts.is_empty() || !cable.contacts.self_contacts.friction_contacts.is_empty();
        let falls_asleep =
            still && touches && self.same_input(cable) && !wheels_act(cable, motion.time) && !cable.changes();
        self.asleep |= falls_asleep;
        self.since = motion.time;
        self.place.clone_from(&motion.positions);
        self.arc_length.clone_from(&mesh.arc_length);
        self.note_input(cable);
        falls_asleep
    }

    /// Notes the forces and targets under which the cable sleeps.
    fn note_input(&mut self, cable: &CableState) {
        self.force.clone_from(&cable.input.loads.force);
        self.target.clone_from(&cable.input.supports.target);
        self.fixity.clone_from(&cable.mesh.fixity);
    }

    /// Notes them where the cable, that has just fallen asleep, has come to its balance: they
    /// depend on where bars meet rounds.
    pub(in crate::model::fem) fn note_balance(&mut self, cable: &mut CableState, dragged: &[Option<Vec2>]) {
        let now = cable.motion.time;
        prepare_input(cable, now, Some(dragged));
        self.note_input(cable);
    }

    /// True if the forces and targets of the cable are those of the last check.
    fn same_input(&self, cable: &CableState) -> bool {
        let (fixity, target) = (&cable.mesh.fixity, &cable.input.supports.target);
        self.force == cable.input.loads.force
            && self.fixity == *fixity
            && self.target.len() == target.len()
            && (0..target.len()).filter(|k| fixity[*k]).all(|k| self.target[k] == target[k])
    }

    /// True if the cable stays asleep until the time `to` (s), with its supports dragged to
    /// `dragged` (m), by springs those that are `pulled`.
    pub(in crate::model::fem) fn lasts_until(
        &mut self,
        cable: &mut CableState,
        pulled: &[bool],
        to: f64,
        dragged: &[Option<Vec2>],
    ) -> bool {
        let outline_moves = cable.outline.as_ref().is_some_and(MovingOutline::moves);
        if outline_moves || wheels_act(cable, to) || cable.changes() {
            self.asleep = false;
        }
        if !self.asleep {
            return false;
        }
        let hand = |k: usize| dragged.get(k).copied().flatten();
        let distance = sleep_distance(cable);
        let motion = &cable.motion;
        let follows = (0..motion.followers.len()).any(|k| match (motion.followers[k], hand(k)) {
            // A hand that grips, releases or moves on wakes it.
            (_, Some(_)) if pulled[k] != motion.hands[k].is_some() => true,
            (_, Some(to)) if pulled[k] => {
                motion.hands[k].is_none_or(|h| (h.end().position() - to).norm() > distance * WAKING_HAND_FRACTION)
            }
            (Some(f), Some(to)) => (f.position() - to).norm() > distance * WAKING_HAND_FRACTION,
            (None, Some(to)) => {
                cable.support_position(k).is_none_or(|at| (at - to).norm() > distance * WAKING_HAND_FRACTION)
            }
            _ => false,
        });
        prepare_input(cable, to, Some(dragged));
        self.asleep = !follows && self.same_input(cable);
        self.asleep
    }

    /// Wakes the cable.
    pub(in crate::model::fem) fn wake(&mut self) {
        *self = Self::default();
    }
}
