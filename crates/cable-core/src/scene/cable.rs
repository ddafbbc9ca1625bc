//! A cable of a scene has properties, supports and a first route.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::support::Support;
use crate::math::Point;

/// One cable, every number resolved (a preset has already filled what the file left out).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cable {
    /// Unique name.
    pub name: String,
    /// Preset the numbers started from; on save only what differs from it is written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// Unstretched length at rest temperature, m.
    pub length_m: f64,
    /// Mass per unstretched metre, kg/m.
    pub linear_density_kg_per_m: f64,
    /// Axial stiffness EA, N: tension = EA × engineering strain.
    pub axial_stiffness_n: f64,
    /// Bending stiffness EI, N·m²; 0 for a perfectly flexible cable.
    #[serde(default)]
    pub bending_stiffness_n_m2: f64,
    /// Outside diameter, m.
    pub diameter_m: f64,
    /// Material damping in stretching, fraction of critical: half of the loss factor.
    ///
    /// `mass_spring` has it at every frequency from 0.1 Hz to the highest of its springs, and so
    /// has `fem` where the cable can touch nothing and slides over nothing. A constant loss
    /// stiffens with frequency: the axial stiffness is that of slow motion, and grows by three
    /// times this ratio from decade to decade beyond 0.1 Hz. What is asked beyond 0.1 is viscous:
    /// of this ratio at the first axial mode of the cable and in proportion to the frequency. A
    /// `fem` cable that can touch something has a viscous loss with a time constant of at least 1
    /// ms, and the constant loss up to the frequency at which that is as great.
    #[serde(default)]
    pub damping_ratio: f64,
    /// Material damping in bending, fraction of critical: half of the loss factor; left out, it is
    /// that in stretching.
    ///
    /// `fem` and `mass_spring` have it from 0.1 Hz to the highest frequency at which their bars
    /// bend, and what is asked beyond 0.1 as a viscous loss at the first axial mode.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bending_damping_ratio: Option<f64>,
    /// Thermal expansion, 1/K.
    #[serde(default)]
    pub thermal_expansion_per_k: f64,
    /// Tension of the first warning, N.
    pub service_tension_n: f64,
    /// Tension at which it breaks, N.
    pub breaking_tension_n: f64,
    /// Time over which the mean tension of a moving cable has to reach the breaking tension before
    /// it breaks, s; 0 = each instant counts. Without inertia it breaks at once.
    #[serde(default = "default_breaking_time_s")]
    pub breaking_time_s: f64,
    /// Smallest allowed bend radius, m; 0 = none stated.
    #[serde(default)]
    pub min_bend_radius_m: f64,
    /// Greatest normal force per metre it stands where it is led round something, N/m; left out,
    /// none is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sidewall_limit_n_per_m: Option<f64>,
    /// Coulomb friction with what does not say otherwise.
    #[serde(default)]
    pub friction: f64,
    /// Selection among the many balances that friction allows; left out, that of the least sliding.
    #[serde(default, skip_serializing_if = "FrictionMobilised::is_default")]
    pub friction_mobilised: FrictionMobilised,
    /// Elements; left out, the model chooses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segments: Option<usize>,
    /// True if the cable is an obstacle to itself, and its pieces to each other where it breaks.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub self_contact: bool,
    /// The route along which the cable is first laid, m; if it is empty, the cable is laid straight
    /// from support to support and lifted over obstacles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub route_m: Vec<Point>,
    /// Supports in order along the cable; the first is its start, the last its end.
    pub supports: Vec<Support>,
}

/// Breaking time of a cable of which none is stated, s. No measurement of cables stands behind it
/// (incubation times of metals are microseconds): it is the time over which means of tension agree
/// between meshes, 4 % in a drop on rubble, whose instants differ by 30 %. Shorter: whether the
/// cable breaks in a jerk hangs on the mesh; longer: what is seen of a jerk is less than what the
/// cable feels.
pub(crate) const BREAKING_TIME_S: f64 = 4e-3;

fn default_breaking_time_s() -> f64 {
    BREAKING_TIME_S
}

/// Part of the friction that is mobilised where the cable rests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionMobilised {
    /// The friction that the cable needs when laid along its route.
    #[default]
    LeastSliding,
    /// All of it, against a cable that is drawn towards its start.
    TowardsStart,
    /// All of it, against a cable that is drawn towards its end, as mooring tools assume of the end
    /// at the vessel.
    TowardsEnd,
}

impl FrictionMobilised {
    /// Every choice.
    pub const ALL: [Self; 3] = [Self::LeastSliding, Self::TowardsStart, Self::TowardsEnd];

    /// Returns whether it is what a scene that says nothing asks for.
    #[must_use]
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::LeastSliding
    }

    /// The name used in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LeastSliding => "least-sliding",
            Self::TowardsStart => "towards-start",
            Self::TowardsEnd => "towards-end",
        }
    }

    /// The choice of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.name() == name)
    }

    /// Direction in which the cable is drawn: 1 towards its end, −1 towards its start, 0 neither.
    #[must_use]
    pub fn direction(self) -> f64 {
        match self {
            Self::LeastSliding => 0.0,
            Self::TowardsStart => -1.0,
            Self::TowardsEnd => 1.0,
        }
    }
}

impl Cable {
    /// Cross-section area of the full round, m²: π d²/4 (stress is quoted on it).
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        std::f64::consts::FRAC_PI_4 * self.diameter_m * self.diameter_m
    }

    /// Material damping in bending, fraction of critical: its own, or else that in stretching.
    #[must_use]
    pub fn bending_damping(&self) -> f64 {
        self.bending_damping_ratio.unwrap_or(self.damping_ratio)
    }

    /// The bending stiffness by which bends at sharp corners are judged, N·m²: its own, of a cable
    /// taken as perfectly flexible that which its preset is likely to have, 0 where neither is
    /// known.
    #[must_use]
    pub fn likely_bending_stiffness_n_m2(&self) -> f64 {
        if self.bending_stiffness_n_m2 > 0.0 {
            return self.bending_stiffness_n_m2;
        }
        let preset = self.preset.as_deref().and_then(super::library::preset::cable_preset);
        preset.map_or(0.0, |p| p.likely_bending_stiffness_n_m2.value)
    }
}
