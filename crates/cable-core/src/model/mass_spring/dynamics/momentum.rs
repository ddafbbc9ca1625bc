//! This account sums the impulse of each kind of force on a cable over the sub-steps of a step.
//! Previews have none, and neither have cables over pulleys, whose material takes its momentum
//! along.

use crate::math::Vec2;
use crate::model::mass_spring::mesh::Mesh;
use crate::solution::MomentumAccount;

/// Impulses since the caller's step began, N s.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct MomentumSums {
    /// Momentum as the step began, kg m/s; None if no account is kept.
    before: Option<Vec2>,
    over_s: f64,
    weight: Vec2,
    loads: Vec2,
    pub(in crate::model::mass_spring) supports: Vec2,
    pub(in crate::model::mass_spring) contacts: Vec2,
}

impl MomentumSums {
    /// The account of a step of `dt` (s) that begins now.
    pub(in crate::model::mass_spring) fn of_step(mesh: &Mesh, dt: f64) -> Self {
        let before = mesh.wheels.pulleys.is_empty().then(|| mesh.momentum());
        Self { before, over_s: dt, ..Self::default() }
    }

    /// Adds the impulses of forces in a `kick` (s) at a time; of supports those that pass through
    /// them, as the momentum of what they hold is counted already.
    pub(in crate::model::mass_spring) fn add_kick(&mut self, mesh: &Mesh, time_s: f64, kick: f64) {
        if self.before.is_none() {
            return;
        }
        let p = &mesh.problem;
        let gravity = if p.linear_density > 0.0 { p.weight / p.linear_density } else { Vec2::zeros() };
        let lumps: f64 = p.supports.iter().map(|s| s.mass).sum();
        let arc_moment: Vec2 = p.supports.iter().map(|s| s.force.at(time_s)).sum();
        let loads: Vec2 = p.loads.iter().map(|l| l.force.at(time_s)).sum();
        let pulled: Vec2 =
            mesh.force.iter().zip(&mesh.supported).filter(|(_, is_supported)| **is_supported).map(|(f, _)| *f).sum();
        self.weight += (p.weight * p.length + gravity * lumps) * kick;
        self.loads += (p.wind.at(time_s) * p.length + arc_moment + loads) * kick;
        self.supports -= pulled * kick;
    }

    /// The account as the answer gives it, if one was kept.
    pub(in crate::model::mass_spring) fn report(&self, mesh: &Mesh) -> Option<MomentumAccount> {
        let Self { before, over_s, weight, loads, supports, contacts } = *self;
        Some(MomentumAccount {
            over_s,
            before_kg_m_per_s: before?.into(),
            after_kg_m_per_s: mesh.momentum().into(),
            weight_n_s: weight.into(),
            loads_n_s: loads.into(),
            supports_n_s: supports.into(),
            contacts_n_s: contacts.into(),
        })
    }
}
