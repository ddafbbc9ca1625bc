//! The energy account sums the work of each kind of force on a cable since it began to move.

use crate::model::fem::system::BodyMotion;
use crate::solution::{Energy, EnergyAccount};

/// Work of each kind of force on the cable, J.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::fem) struct Works {
    pub(in crate::model::fem) supports: f64,
    pub(in crate::model::fem) loads: f64,
    pub(in crate::model::fem) outlines: f64,
    pub(in crate::model::fem) friction: f64,
    pub(in crate::model::fem) material: f64,
    pub(in crate::model::fem) impacts: f64,
    pub(in crate::model::fem) edits: f64,
    pub(in crate::model::fem) breaks: f64,
    pub(in crate::model::fem) numerical: f64,
}

impl Works {
    /// Adds the work (J) that the motion of a body does on the cable.
    pub(in crate::model::fem) fn add_of_body(&mut self, body: Option<&BodyMotion>, work: f64) {
        match body {
            Some(body) if body.is_support => self.supports += work,
            _ => self.outlines += work,
        }
    }
}

/// The account of energy since the cable began to move.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem) struct Energies {
    /// The time at which it began, s; NaN if it has not begun.
    from: f64,
    /// The energy with which it began.
    began: Energy,
    /// The energy of the cable after the last entry.
    pub(in crate::model::fem) stored: Energy,
    works: Works,
    exchanged: f64,
}

impl Default for Energies {
    fn default() -> Self {
        let (none, works) = (Energy::default(), Works::default());
        Self { from: f64::NAN, began: none, stored: none, works, exchanged: 0.0 }
    }
}

impl Energies {
    /// Begins a step from the time `now` (s); returns the energy of the cable. If it may have
    /// `changed` since the last step, the difference is attributed to a change of the mesh or of
    /// the state.
    pub(in crate::model::fem) fn begin_step(
        &mut self,
        now: f64,
        changed: bool,
        stored: impl FnOnce() -> Energy,
    ) -> Energy {
        if self.from.is_nan() {
            let stored = stored();
            *self = Self { from: now, began: stored, stored, ..Self::default() };
        } else if changed {
            self.edit(stored());
        }
        self.stored
    }

    /// Records a change of the mesh that left the cable with this energy.
    pub(in crate::model::fem) fn edit(&mut self, stored: Energy) {
        self.works.edits += stored.total_j() - self.stored.total_j();
        self.stored = stored;
    }

    /// Records a break that left the cable with this energy.
    pub(in crate::model::fem) fn note_break(&mut self, stored: Energy) {
        if !self.from.is_nan() {
            self.works.breaks += stored.total_j() - self.stored.total_j();
            self.stored = stored;
        }
    }

    /// Adds the work of forces in a step that left the cable with this energy.
    pub(in crate::model::fem) fn add(&mut self, works: &Works, stored: Energy) {
        let mine = &mut self.works;
        mine.supports += works.supports;
        mine.loads += works.loads;
        mine.outlines += works.outlines;
        mine.friction += works.friction;
        mine.material += works.material;
        mine.impacts += works.impacts;
        mine.numerical += works.numerical;
        self.stored = stored;
    }

    /// Corrects the work of contacts that ended with the step: their impulses did `more` work than
    /// the counted forces, and the integrator gave the cable that much less.
    pub(in crate::model::fem) fn correct(&mut self, more: &Works) {
        self.works.impacts += more.impacts;
        self.works.friction += more.friction;
        self.works.outlines += more.outlines;
        self.works.supports += more.supports;
        self.works.numerical -= more.impacts + more.friction + more.outlines + more.supports;
    }

    /// Records plastic impacts that left the cable with this kinetic energy, J.
    pub(in crate::model::fem) fn land(&mut self, kinetic_j: f64) {
        self.works.impacts += kinetic_j - self.stored.kinetic_j;
        self.stored.kinetic_j = kinetic_j;
    }

    /// Records that the cable falls asleep: it stands still, with the energy `stored`.
    pub(in crate::model::fem) fn fall_asleep(&mut self, stored: Energy) {
        self.works.numerical += stored.total_j() - self.stored.total_j();
        self.stored = stored;
    }

    /// Ends a step.
    pub(in crate::model::fem) fn end_step(&mut self) {
        let half_sum = self.account().half_sum_j();
        self.exchanged = if half_sum > self.exchanged { half_sum } else { self.exchanged };
    }

    /// The account as answers have it.
    fn account(&self) -> EnergyAccount {
        let Works { supports, loads, outlines, friction, material, impacts, edits, breaks, numerical } = self.works;
        EnergyAccount {
            over_s: 0.0,
            gained: Energy {
                kinetic_j: self.stored.kinetic_j - self.began.kinetic_j,
                gravity_j: self.stored.gravity_j - self.began.gravity_j,
                stretch_j: self.stored.stretch_j - self.began.stretch_j,
                bending_j: self.stored.bending_j - self.began.bending_j,
            },
            supports_j: supports,
            loads_j: loads,
            outlines_j: outlines,
            friction_j: friction,
            material_j: material,
            impacts_j: impacts,
            edits_j: edits,
            breaks_j: breaks,
            numerical_j: numerical,
            exchanged_j: self.exchanged,
        }
    }

    /// The account up to the time `now` (s); None if it has not begun or is not finite.
    pub(in crate::model::fem) fn report(&self, now: f64) -> Option<EnergyAccount> {
        let account = EnergyAccount { over_s: now - self.from, ..self.account() };
        (account.over_s > 0.0 && account.is_finite()).then_some(account)
    }
}
