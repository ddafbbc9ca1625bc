//! The momentum account sums the impulses on a cable since the step of its caller began.

use crate::math::Vec2;
use crate::model::fem::mesh::SlideOver;
use crate::solution::MomentumAccount;

/// Indices of the kinds of force in [`Kinds`].
pub(in crate::model::fem) const WEIGHT: usize = 0;
/// See `WEIGHT`.
pub(in crate::model::fem) const LOADS: usize = 1;
/// See `WEIGHT`.
pub(in crate::model::fem) const SUPPORTS: usize = 2;
/// See `WEIGHT`.
pub(in crate::model::fem) const CONTACTS: usize = 3;

/// The kind of the force of the corner, post or pulley of a sliding node.
pub(in crate::model::fem) fn kind_of(slide_over: SlideOver) -> usize {
    match slide_over {
        SlideOver::Pulley(_) => SUPPORTS,
        SlideOver::Obstacle { .. } => CONTACTS,
    }
}

/// A vector for each kind of force: weight, loads, supports, contacts.
pub(in crate::model::fem) type Kinds = [Vec2; 4];

/// The account of momentum since the caller's step began.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::fem) struct MomentumSums {
    /// The time at which it began, s.
    pub(in crate::model::fem) from: f64,
    /// The time up to which it goes, s.
    pub(in crate::model::fem) to: f64,
    /// Momentum at its beginning, kg m/s.
    pub(in crate::model::fem) before: Vec2,
    /// Momentum after the last step, on the mesh that it balanced, kg m/s.
    pub(in crate::model::fem) reached: Vec2,
    /// Impulses since it began, N s.
    pub(in crate::model::fem) sum: Kinds,
    /// The part of them from changes of the mesh after the last step, N s.
    pub(in crate::model::fem) late: Kinds,
    /// Impulses of the last step that are in the history of the next one, N s.
    pub(in crate::model::fem) last: Kinds,
    /// Those of the step before that, N s.
    pub(in crate::model::fem) older: Kinds,
}

impl MomentumSums {
    /// Sets the end of the caller's step (s): the sum of its inner steps has round-off.
    pub(in crate::model::fem) fn ends_at(&mut self, time: f64) {
        self.to = time;
    }

    /// Adds an impulse (N s) of a kind of force.
    pub(in crate::model::fem) fn add(&mut self, kind: usize, impulse: Vec2) {
        self.sum[kind] += impulse;
    }

    /// The account of a cable whose state was replaced: earlier entries do not apply to it.
    pub(in crate::model::fem) fn unknown() -> Self {
        Self { from: f64::NAN, to: f64::NAN, ..Self::default() }
    }

    /// The account of a step of the caller that begins at the time `now` (s); `momentum` gives the
    /// momentum of the cable (kg m/s) if the account does not know it.
    pub(in crate::model::fem) fn begun(self, now: f64, momentum: impl FnOnce() -> Vec2) -> Self {
        let known = if self.to == now { self } else { Self { reached: momentum(), ..Self::default() } };
        Self { from: now, to: now, before: known.reached, sum: known.late, ..known }
    }

    /// Extends it to the time `now` (s), at which the cable has a momentum (kg m/s) on the mesh
    /// that was balanced.
    pub(in crate::model::fem) fn close(&mut self, now: f64, momentum: Vec2) {
        (self.reached, self.to) = (momentum, now);
    }

    /// Goes on after an edit with a cable that is heavier by a factor, and has `more` momentum (kg
    /// m/s). The impulses in the history are then those of that cable.
    pub(in crate::model::fem) fn change_mass(&mut self, factor: f64, more: Vec2) {
        self.reached += more;
        self.last.iter_mut().chain(&mut self.older).for_each(|impulse| *impulse *= factor);
    }

    /// Records a plastic contact: the impulse `given` to the cable in the velocity step, and the
    /// part `forgotten` of the step's contact impulse that does not enter the history, N s.
    pub(in crate::model::fem) fn land(&mut self, given: Vec2, forgotten: Vec2) {
        self.add(CONTACTS, given);
        self.last[CONTACTS] -= forgotten;
    }

    /// Records an impulse of supports in the last step (N s) that does not enter the history.
    pub(in crate::model::fem) fn forget_support(&mut self, impulse: Vec2) {
        self.last[SUPPORTS] -= impulse;
    }

    /// Records an impulse (N s) of the history that material takes with it when it joins or leaves
    /// a round.
    pub(in crate::model::fem) fn record_transferred_history(&mut self, slide_over: SlideOver, impulse: Vec2) {
        self.last[kind_of(slide_over)] += impulse;
    }

    /// The account of the caller's last step; None before the first one.
    pub(in crate::model::fem) fn report(&self) -> Option<MomentumAccount> {
        let over_s = self.to - self.from;
        let [weight, loads, supports, contacts] = [0, 1, 2, 3].map(|k| <[f64; 2]>::from(self.sum[k] - self.late[k]));
        (over_s > 0.0).then(|| MomentumAccount {
            over_s,
            before_kg_m_per_s: self.before.into(),
            after_kg_m_per_s: self.reached.into(),
            weight_n_s: weight,
            loads_n_s: loads,
            supports_n_s: supports,
            contacts_n_s: contacts,
        })
    }
}
