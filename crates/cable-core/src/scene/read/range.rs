//! Every number of a scene has its range here, with its quantity.

use crate::units::Quantity;

/// A range of allowed numbers.
#[derive(Clone, Copy)]
pub(super) struct Range {
    low: f64,
    high: f64,
    /// The quantity that the range limits, in SI units.
    pub(super) quantity: Quantity,
}

impl Range {
    const fn new(low: f64, high: f64, quantity: Quantity) -> Self {
        Self { low, high, quantity }
    }

    /// The least and the greatest number in it.
    pub(super) fn limits(self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Returns whether the value is a number in the range. NaN and infinities are in none.
    pub(super) fn holds(self, value: f64) -> bool {
        value >= self.low && value <= self.high
    }
}

pub(super) const COORDINATE: Range = Range::new(-1e7, 1e7, Quantity::Length);
pub(super) const LENGTH: Range = Range::new(1e-3, 1e6, Quantity::Length);
pub(super) const ARC_LENGTH: Range = Range::new(0.0, 1e6, Quantity::Length);
pub(super) const DENSITY: Range = Range::new(1e-6, 1e4, Quantity::MassPerLength);
pub(super) const AXIAL_STIFFNESS: Range = Range::new(1.0, 1e12, Quantity::Force);
pub(super) const BENDING_STIFFNESS: Range = Range::new(0.0, 1e6, Quantity::BendingStiffness);
pub(super) const DIAMETER: Range = Range::new(1e-5, 10.0, Quantity::Length);
pub(super) const DAMPING: Range = Range::new(0.0, 10.0, Quantity::Number);
pub(super) const THERMAL: Range = Range::new(-1e-2, 1e-2, Quantity::PerTemperature);
pub(super) const TENSION: Range = Range::new(1e-6, 1e15, Quantity::Force);
pub(super) const BREAKING_TIME: Range = Range::new(0.0, 5e-3, Quantity::Time);
pub(super) const BEND_RADIUS: Range = Range::new(0.0, 1e4, Quantity::Length);
pub(super) const SIDEWALL: Range = Range::new(1e-3, 1e9, Quantity::ForcePerLength);
pub(super) const FRICTION: Range = Range::new(0.0, 10.0, Quantity::Number);
pub(super) const SEGMENTS: Range = Range::new(1.0, 1e5, Quantity::Number);
pub(super) const GRAVITY: Range = Range::new(0.0, 100.0, Quantity::Acceleration);
pub(super) const TEMPERATURE: Range = Range::new(-500.0, 5000.0, Quantity::Temperature);
pub(super) const WIND: Range = Range::new(-1e6, 1e6, Quantity::ForcePerLength);
pub(super) const FORCE: Range = Range::new(-1e12, 1e12, Quantity::Force);
pub(super) const MASS: Range = Range::new(0.0, 1e9, Quantity::Mass);
pub(super) const TIME: Range = Range::new(-1e9, 1e9, Quantity::Time);
pub(super) const DURATION: Range = Range::new(0.0, 1e9, Quantity::Time);
pub(super) const ANGLE: Range = Range::new(-360.0, 360.0, Quantity::Angle);
pub(super) const WHEEL_RADIUS: Range = Range::new(0.0, 1e4, Quantity::Length);
pub(super) const RADIUS: Range = Range::new(1e-6, 1e6, Quantity::Length);
pub(super) const THICKNESS: Range = Range::new(0.0, 1e3, Quantity::Length);
pub(super) const ROLLING: Range = Range::new(0.0, 1.0, Quantity::Number);
pub(super) const ROBOT_SPEED: Range = Range::new(1e-6, 20.0, Quantity::Speed);

/// Range of the factor by which a temperature may change a length: beyond, expansion or temperature
/// is surely mistyped.
pub(super) const THERMAL_FACTOR: [f64; 2] = [0.5, 2.0];
/// Least time between two knots, s: much less, and velocities over it lose all digits.
pub(super) const MIN_INTERVAL_S: f64 = 1e-9;
