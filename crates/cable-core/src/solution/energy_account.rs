//! The energy account says where the energy of a moving cable came from and went to.

use serde::{Deserialize, Serialize};

use super::Energy;
use crate::math::larger;

/// Balance of a cable's energy since it began to move: what it has gained, and the work of each
/// kind of force on it, each from its own force and displacement in every inner step. What was
/// lost has a minus sign.
///
/// Gains are those of the cable as the model divides it, lumped masses included. Gains are the sum
/// of the works but for [`Self::unaccounted_j`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EnergyAccount {
    /// The time it is of, s.
    pub over_s: f64,
    /// The energy that the cable has more than as the account began, J.
    pub gained: Energy,
    /// Work of supports, pulleys and hands: the force on the cable times the way of the support, J.
    pub supports_j: f64,
    /// Work of wind, current and loads, J.
    pub loads_j: f64,
    /// Work of moving outlines: contact force times the way of the outline, J.
    pub outlines_j: f64,
    /// Work of friction, times what slides: on obstacles, on the floor, at sliding nodes and of the
    /// cable on itself, J.
    pub friction_j: f64,
    /// Work of the material's loss, in stretch (relaxation branches with what they hold) and in
    /// bending: force times change of length, J.
    pub material_j: f64,
    /// Work of normal forces of contact against what approaches, and the kinetic energy that
    /// plastic impacts take, J.
    pub impacts_j: f64,
    /// Energy that changes of the mesh gave the cable, J.
    pub edits_j: f64,
    /// Energy that breaks gave the cable, J: the pieces have the material, the places and the
    /// velocities of the cable, but no bend where it broke, and their own division into bars.
    pub breaks_j: f64,
    /// Energy that the time integrator gave the cable, J: what its inertia forces did less the
    /// change of kinetic energy, and what conservative forces did less the change of potential.
    pub numerical_j: f64,
    /// The energy that was exchanged, J: the greatest half sum of the magnitudes of gains and works
    /// so far, by which an imbalance is measured.
    pub exchanged_j: f64,
}

impl EnergyAccount {
    /// The kinds of work in the order of [`Self::works_j`].
    pub const KINDS: [&'static str; 9] =
        ["supports", "loads", "outlines", "friction", "material", "impacts", "edits", "breaks", "numerical"];

    /// The works in the order of the fields, J.
    #[must_use]
    pub fn works_j(&self) -> [f64; 9] {
        let Self { supports_j, loads_j, outlines_j, friction_j, material_j, impacts_j, .. } = *self;
        let Self { edits_j, breaks_j, numerical_j, .. } = *self;
        [supports_j, loads_j, outlines_j, friction_j, material_j, impacts_j, edits_j, breaks_j, numerical_j]
    }

    /// True if all of it is a number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.unaccounted_j().is_finite() && self.exchanged_j.is_finite()
    }

    /// The account of two cables.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            over_s: larger(self.over_s, other.over_s),
            gained: [self.gained, other.gained].into_iter().sum(),
            supports_j: self.supports_j + other.supports_j,
            loads_j: self.loads_j + other.loads_j,
            outlines_j: self.outlines_j + other.outlines_j,
            friction_j: self.friction_j + other.friction_j,
            material_j: self.material_j + other.material_j,
            impacts_j: self.impacts_j + other.impacts_j,
            edits_j: self.edits_j + other.edits_j,
            breaks_j: self.breaks_j + other.breaks_j,
            numerical_j: self.numerical_j + other.numerical_j,
            exchanged_j: self.exchanged_j + other.exchanged_j,
        }
    }

    /// Half of the sum of the magnitudes of gains and works, J.
    pub(crate) fn half_sum_j(&self) -> f64 {
        let Energy { kinetic_j, gravity_j, stretch_j, bending_j } = self.gained;
        let gains = [kinetic_j, gravity_j, stretch_j, bending_j];
        0.5 * gains.into_iter().chain(self.works_j()).map(f64::abs).sum::<f64>()
    }

    /// The part of the gains that no work accounts for, J: 0 but for what inner steps leave
    /// unbalanced.
    #[must_use]
    pub fn unaccounted_j(&self) -> f64 {
        self.gained.total_j() - self.works_j().iter().sum::<f64>()
    }

    /// The same of a similar copy whose times are so many times as long, and its energies.
    pub(crate) fn scale(&mut self, time: f64, energy: f64) {
        let Self {
            over_s,
            gained: Energy { kinetic_j, gravity_j, stretch_j, bending_j },
            supports_j,
            loads_j,
            outlines_j,
            friction_j,
            material_j,
            impacts_j,
            edits_j,
            breaks_j,
            numerical_j,
            exchanged_j,
        } = self;
        *over_s *= time;
        let gains = [kinetic_j, gravity_j, stretch_j, bending_j, exchanged_j];
        let works =
            [supports_j, loads_j, outlines_j, friction_j, material_j, impacts_j, edits_j, breaks_j, numerical_j];
        gains.into_iter().chain(works).for_each(|e| *e *= energy);
    }
}
