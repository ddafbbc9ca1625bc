//! A figure is a number in SI units with its [`Quantity`]; a [`UnitSystem`] says in which units it
//! is written.

/// A foot, m (exact, as are the inch and the pound: international yard and pound agreement, 1959).
pub const FOOT_M: f64 = 0.3048;
/// A pound, kg.
pub const POUND_KG: f64 = 0.453_592_37;
/// A pound-force, N: a pound times standard gravity.
pub const POUND_FORCE_N: f64 = POUND_KG * 9.80665;

/// The units in which figures are written. Files and data are SI always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnitSystem {
    /// Metres, newtons, kilograms.
    #[default]
    Si,
    /// Feet, pounds-force, pounds.
    Us,
}

/// The physical quantity that a number is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// A plain number, such as a count or a ratio.
    Number,
    /// m.
    Length,
    /// N.
    Force,
    /// N/m.
    ForcePerLength,
    /// N m.
    Moment,
    /// N s.
    Impulse,
    /// N·m².
    BendingStiffness,
    /// J.
    Energy,
    /// m/s.
    Speed,
    /// m/s².
    Acceleration,
    /// kg.
    Mass,
    /// kg/m.
    MassPerLength,
    /// s.
    Time,
    /// °.
    Angle,
    /// K, a difference.
    Temperature,
    /// 1/K.
    PerTemperature,
}

impl Quantity {
    /// The symbol of its unit; empty for a plain number.
    #[must_use]
    pub fn symbol(self, units: UnitSystem) -> &'static str {
        self.unit(units).0
    }

    /// A number in SI units, in those of a system.
    #[must_use]
    pub fn convert(self, value: f64, units: UnitSystem) -> f64 {
        match units {
            UnitSystem::Si => value,
            UnitSystem::Us => value / self.unit(units).1,
        }
    }

    /// The factor of a figure where lengths and times grow by factors and forces stay.
    pub(crate) fn scale(self, length: f64, time: f64) -> f64 {
        match self {
            Self::Number | Self::Force | Self::Angle | Self::Temperature | Self::PerTemperature => 1.0,
            Self::Length | Self::Moment | Self::Energy => length,
            Self::ForcePerLength => 1.0 / length,
            Self::Impulse | Self::Time => time,
            Self::BendingStiffness => length * length,
            Self::Speed => length / time,
            Self::Acceleration => length / (time * time),
            Self::Mass => time * time / length,
            Self::MassPerLength => time * time / (length * length),
        }
    }

    /// The unit's symbol, and how many SI units it is.
    fn unit(self, units: UnitSystem) -> (&'static str, f64) {
        match (units, self) {
            (_, Self::Number) => ("", 1.0),
            (_, Self::Time) => ("s", 1.0),
            (_, Self::Angle) => ("°", 1.0),
            (UnitSystem::Si, Self::Length) => ("m", 1.0),
            (UnitSystem::Si, Self::Force) => ("N", 1.0),
            (UnitSystem::Si, Self::ForcePerLength) => ("N/m", 1.0),
            (UnitSystem::Si, Self::Moment) => ("N m", 1.0),
            (UnitSystem::Si, Self::Impulse) => ("N s", 1.0),
            (UnitSystem::Si, Self::BendingStiffness) => ("N·m²", 1.0),
            (UnitSystem::Si, Self::Energy) => ("J", 1.0),
            (UnitSystem::Si, Self::Speed) => ("m/s", 1.0),
            (UnitSystem::Si, Self::Acceleration) => ("m/s²", 1.0),
            (UnitSystem::Si, Self::Mass) => ("kg", 1.0),
            (UnitSystem::Si, Self::MassPerLength) => ("kg/m", 1.0),
            (UnitSystem::Si, Self::Temperature) => ("K", 1.0),
            (UnitSystem::Si, Self::PerTemperature) => ("per K", 1.0),
            (UnitSystem::Us, Self::Length) => ("ft", FOOT_M),
            (UnitSystem::Us, Self::Force) => ("lbf", POUND_FORCE_N),
            (UnitSystem::Us, Self::ForcePerLength) => ("lbf/ft", POUND_FORCE_N / FOOT_M),
            (UnitSystem::Us, Self::Moment) => ("lbf ft", POUND_FORCE_N * FOOT_M),
            (UnitSystem::Us, Self::Impulse) => ("lbf s", POUND_FORCE_N),
            (UnitSystem::Us, Self::BendingStiffness) => ("lbf·ft²", POUND_FORCE_N * FOOT_M * FOOT_M),
            (UnitSystem::Us, Self::Energy) => ("ft·lbf", FOOT_M * POUND_FORCE_N),
            (UnitSystem::Us, Self::Speed) => ("ft/s", FOOT_M),
            (UnitSystem::Us, Self::Acceleration) => ("ft/s²", FOOT_M),
            (UnitSystem::Us, Self::Mass) => ("lb", POUND_KG),
            (UnitSystem::Us, Self::MassPerLength) => ("lb/ft", POUND_KG / FOOT_M),
            (UnitSystem::Us, Self::Temperature) => ("°F", 1.0 / 1.8),
            (UnitSystem::Us, Self::PerTemperature) => ("per °F", 1.8),
        }
    }
}
