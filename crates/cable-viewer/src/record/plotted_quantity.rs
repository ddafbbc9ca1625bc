//! A measure is what a graph shows upwards: a quantity of the cable, or of the robot and the whole.

use cable_core::Cable;

use crate::record::sample::Sample;
use crate::render::colour::CableQuantity;
use crate::units::format::{self, quantity};
use crate::units::{system, unit};

/// A line over time: its name, and how to read it off a sample.
pub type OverTime = (&'static str, SampleReader);
/// Reads a value (SI) off a sample.
pub type SampleReader = fn(&Sample) -> f64;

/// The quantity that goes up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A quantity of the cable, along it or its greatest over time.
    Cable(CableQuantity),
    /// Pull of the cable on the robot's hitch, N.
    Pull,
    /// Speed of the robot, m/s.
    Speed,
    /// Energies, J.
    Energy,
}

impl Measure {
    /// All of them, in the order a picker shows.
    pub const ALL: [Self; 6] = [
        Self::Cable(CableQuantity::Tension),
        Self::Cable(CableQuantity::Stress),
        Self::Cable(CableQuantity::Strain),
        Self::Pull,
        Self::Speed,
        Self::Energy,
    ];

    /// The line of each that a whole run is compared by, SI. Stress and strain follow from tension.
    pub const PRIMARY_LINES: [(Self, SampleReader); 4] = [
        (Self::Cable(CableQuantity::Tension), |s| s.max_tension_n),
        (Self::Pull, |s| s.robot.map_or(f64::NAN, |r| r[1])),
        (Self::Speed, |s| s.robot.map_or(f64::NAN, |r| r[0])),
        (Self::Energy, |s| s.energy_j[0]),
    ];

    /// The line this one is compared by.
    #[must_use]
    pub fn primary_line(self) -> Option<SampleReader> {
        Self::PRIMARY_LINES.iter().find(|(m, _)| m.shares_primary_line(self)).map(|(_, of)| *of)
    }

    /// Returns whether the line of this one is that of another.
    #[must_use]
    pub fn shares_primary_line(self, other: Self) -> bool {
        self == other || matches!((self, other), (Self::Cable(_), Self::Cable(_)))
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cable(quantity) => quantity.name(),
            Self::Pull => "Hitch pull",
            Self::Speed => "Robot speed",
            Self::Energy => "Energy",
        }
    }

    /// The explanation on hover.
    #[must_use]
    pub fn help(self) -> &'static str {
        match self {
            Self::Cable(CableQuantity::Tension) => "Pull in the cable",
            Self::Cable(CableQuantity::Stress) => "Tension over the full round section",
            Self::Cable(CableQuantity::Strain) => "Change of length over length",
            Self::Pull => "Force of the cable on the robot's hitch over time",
            Self::Speed => "Speed of the robot along the ground over time",
            Self::Energy => "Of motion, height above y = 0, stretch and bending over time",
        }
    }

    /// Unit shown and how many SI units it holds, for values up to `greatest` (SI).
    #[must_use]
    pub fn unit(self, greatest: f64) -> (&'static str, f64) {
        match self {
            Self::Cable(quantity) => quantity.unit(greatest),
            Self::Pull => CableQuantity::Tension.unit(greatest),
            Self::Speed => {
                let unit::Unit { symbol, si, .. } = unit::Unit::M_PER_S.display();
                (symbol, si)
            }
            Self::Energy => system::for_size(system::Kind::Energy, greatest),
        }
    }

    /// Its SI unit as the names of columns end in it.
    #[must_use]
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Cable(CableQuantity::Tension) => "tension_n",
            Self::Cable(CableQuantity::Stress) => "stress_pa",
            Self::Cable(CableQuantity::Strain) => "strain",
            Self::Pull => "pull_n",
            Self::Speed => "speed_m_per_s",
            Self::Energy => "energy_j",
        }
    }

    /// A value with its unit.
    #[must_use]
    pub fn text(self, value: f64) -> String {
        match self {
            Self::Cable(CableQuantity::Tension) | Self::Pull => format::force(value),
            Self::Cable(CableQuantity::Stress) => format::stress(value),
            Self::Cable(CableQuantity::Strain) => format::strain(value),
            Self::Speed | Self::Energy => {
                let (symbol, si) = self.unit(value.abs());
                quantity(value / si, unit::DIGITS, symbol)
            }
        }
    }

    /// The quantity of the cable it is, or the tension where it is none: what a graph along the
    /// cable shows.
    #[must_use]
    pub fn quantity(self) -> CableQuantity {
        match self {
            Self::Cable(quantity) => quantity,
            _ => CableQuantity::Tension,
        }
    }

    /// Service and breaking limit, SI; infinite where there is none.
    #[must_use]
    pub fn limits(self, cable: &Cable) -> [f64; 2] {
        match self {
            Self::Cable(quantity) => tension_limits(quantity, cable),
            _ => [f64::INFINITY; 2],
        }
    }

    /// The lines over time that are of no support, and how to read them off a sample.
    #[must_use]
    pub fn lines(self) -> &'static [OverTime] {
        match self {
            Self::Cable(_) => &[],
            Self::Pull => &[("Pull on the hitch", |s| s.robot.map_or(f64::NAN, |r| r[1]))],
            Self::Speed => &[("Speed", |s| s.robot.map_or(f64::NAN, |r| r[0]))],
            Self::Energy => &[
                ("Motion", |s| s.energy_j[0]),
                ("Height", |s| s.energy_j[1]),
                ("Stretch", |s| s.energy_j[2]),
                ("Bending", |s| s.energy_j[3]),
            ],
        }
    }
}

/// Service and breaking limit of a quantity, SI.
#[must_use]
pub fn tension_limits(quantity: CableQuantity, cable: &Cable) -> [f64; 2] {
    let per_newton = per_newton(quantity, cable);
    [cable.service_tension_n * per_newton, cable.breaking_tension_n * per_newton]
}

/// The quantity of a cable under one newton, SI.
#[must_use]
pub fn per_newton(quantity: CableQuantity, cable: &Cable) -> f64 {
    match quantity {
        CableQuantity::Tension => 1.0,
        CableQuantity::Stress => 1.0 / cable.area_m2(),
        CableQuantity::Strain => 1.0 / cable.axial_stiffness_n,
    }
}
