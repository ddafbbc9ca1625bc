//! The account of a cable's momentum in a step: what each kind of force gave it, sub-step by
//! sub-step. There is none of previews, and of cables over pulleys, whose material takes its
//! momentum along.

use crate::math::Vec2;
use crate::model::mass_spring::MassSpringModel;
use crate::solution::MomentumAccount;

/// What became of the momentum since the caller's step began; impulses in N s.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct Account {
    /// As it began, kg m/s; None: no account is kept.
    before: Option<Vec2>,
    over_s: f64,
    weight: Vec2,
    loads: Vec2,
    pub(in crate::model::mass_spring) supports: Vec2,
    pub(in crate::model::mass_spring) contacts: Vec2,
}

impl MassSpringModel {
    /// A step of `dt` (s) begins, of which an account is `kept` or not.
    pub(in crate::model::mass_spring) fn begin_account(&mut self, dt: f64, kept: bool) {
        let before = (kept && self.wheels.pulleys.is_empty()).then(|| self.momentum());
        self.report.account = Account { before, over_s: dt, ..Account::default() };
    }

    /// Momentum of all nodes, kg m/s.
    pub(in crate::model::mass_spring) fn momentum(&self) -> Vec2 {
        self.chain.v.iter().zip(&self.chain.mass).map(|(v, m)| v * *m).sum()
    }

    /// Adds what forces give in a `kick` (s), supports beside what they have changed of the
    /// momentum of what they hold.
    pub(in crate::model::mass_spring) fn account_for_kick(&mut self, kick: f64) {
        if self.report.account.before.is_none() {
            return;
        }
        let p = &self.problem;
        let gravity = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        let lumps: f64 = p.supports.iter().map(|s| s.mass).sum();
        let hung: Vec2 = p.supports.iter().map(|s| s.force.at(self.clock.time_s)).sum();
        let loads: Vec2 = p.loads.iter().map(|l| l.force.at(self.clock.time_s)).sum();
        let pulled: Vec2 = self.chain.f.iter().zip(&self.drives.held).filter(|(_, held)| **held).map(|(f, _)| *f).sum();
        self.report.account.weight += (p.weight * p.length + gravity * lumps) * kick;
        self.report.account.loads += (p.wind.at(self.clock.time_s) * p.length + hung + loads) * kick;
        self.report.account.supports -= pulled * kick;
    }

    /// Of the last step with inertia.
    pub(in crate::model::mass_spring) fn momentum_account(&self) -> Option<MomentumAccount> {
        let Account { before, over_s, weight, loads, supports, contacts } = self.report.account;
        Some(MomentumAccount {
            over_s,
            before_kg_m_per_s: before?.into(),
            after_kg_m_per_s: self.momentum().into(),
            weight_n_s: weight.into(),
            loads_n_s: loads.into(),
            supports_n_s: supports.into(),
            contacts_n_s: contacts.into(),
        })
    }
}
