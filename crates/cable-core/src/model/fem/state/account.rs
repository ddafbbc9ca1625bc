//! The momentum account sums up the impulses on a cable since the step of its caller began.

use crate::math::Vec2;

/// Something for each kind of force: weight, loads, supports, contacts.
pub(in crate::model::fem) type Kinds = [Vec2; 4];

/// The account of momentum since the caller's step began.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::fem) struct Account {
    /// When it began, and up to when it goes, s.
    pub(in crate::model::fem) from: f64,
    pub(in crate::model::fem) to: f64,
    /// Momentum as it began, kg m/s.
    pub(in crate::model::fem) before: Vec2,
    /// Momentum after the last step, on the mesh that it balanced, kg m/s.
    pub(in crate::model::fem) reached: Vec2,
    /// Impulses since it began, N s.
    pub(in crate::model::fem) sum: Kinds,
    /// Of those, what came of changes of the mesh after the last step, N s.
    pub(in crate::model::fem) late: Kinds,
    /// Impulses of the last step that the history of the next one has, N s.
    pub(in crate::model::fem) last: Kinds,
    /// Those of the step before that, N s.
    pub(in crate::model::fem) older: Kinds,
}

impl Account {
    /// The caller's step ends now (s): the sum of its inner steps rounds.
    pub(in crate::model::fem) fn ends_at(&mut self, time: f64) {
        self.to = time;
    }

    pub(in crate::model::fem) fn add(&mut self, kind: usize, impulse: Vec2) {
        self.sum[kind] += impulse;
    }
}
