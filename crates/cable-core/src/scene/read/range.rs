//! Every number of a scene has its range here, with its unit.

/// A range of allowed numbers.
#[derive(Clone, Copy)]
pub(super) struct Range {
    low: f64,
    high: f64,
    /// The range in words, with its unit.
    pub(super) text: &'static str,
}

impl Range {
    const fn new(low: f64, high: f64, text: &'static str) -> Self {
        Self { low, high, text }
    }

    /// Whether the value is a number in the range. NaN and infinities are in none.
    pub(super) fn holds(self, value: f64) -> bool {
        value >= self.low && value <= self.high
    }
}

pub(super) const COORDINATE: Range = Range::new(-1e7, 1e7, "-1e7 to 1e7 m");
pub(super) const LENGTH: Range = Range::new(1e-3, 1e6, "0.001 to 1e6 m");
pub(super) const ARC_LENGTH: Range = Range::new(0.0, 1e6, "0 m to the cable's length");
pub(super) const DENSITY: Range = Range::new(1e-6, 1e4, "1e-6 to 1e4 kg/m");
pub(super) const AXIAL_STIFFNESS: Range = Range::new(1.0, 1e12, "1 to 1e12 N");
pub(super) const BENDING_STIFFNESS: Range = Range::new(0.0, 1e6, "0 to 1e6 N·m²");
pub(super) const DIAMETER: Range = Range::new(1e-5, 10.0, "1e-5 to 10 m");
pub(super) const DAMPING: Range = Range::new(0.0, 10.0, "0 to 10 (1 = critical)");
pub(super) const THERMAL: Range = Range::new(-1e-2, 1e-2, "-0.01 to 0.01 per K");
pub(super) const TENSION: Range = Range::new(1e-6, 1e15, "1e-6 to 1e15 N");
pub(super) const BREAKING_TIME: Range = Range::new(0.0, 5e-3, "0 to 0.005 s");
pub(super) const BEND_RADIUS: Range = Range::new(0.0, 1e4, "0 to 1e4 m");
pub(super) const SIDEWALL: Range = Range::new(1e-3, 1e9, "1e-3 to 1e9 N/m");
pub(super) const FRICTION: Range = Range::new(0.0, 10.0, "0 to 10");
pub(super) const SEGMENTS: Range = Range::new(1.0, 1e5, "1 to 100000");
pub(super) const GRAVITY: Range = Range::new(0.0, 100.0, "0 to 100 m/s²");
pub(super) const TEMPERATURE: Range = Range::new(-500.0, 5000.0, "-500 to 5000 K");
pub(super) const WIND: Range = Range::new(-1e6, 1e6, "-1e6 to 1e6 N/m");
pub(super) const FORCE: Range = Range::new(-1e12, 1e12, "-1e12 to 1e12 N");
pub(super) const MASS: Range = Range::new(0.0, 1e9, "0 to 1e9 kg");
pub(super) const TIME: Range = Range::new(-1e9, 1e9, "-1e9 to 1e9 s");
pub(super) const DURATION: Range = Range::new(0.0, 1e9, "0 to 1e9 s");
pub(super) const ANGLE: Range = Range::new(-360.0, 360.0, "-360 to 360 °");
pub(super) const WHEEL_RADIUS: Range = Range::new(0.0, 1e4, "0 to 1e4 m");
pub(super) const RADIUS: Range = Range::new(1e-6, 1e6, "1e-6 to 1e6 m");
pub(super) const THICKNESS: Range = Range::new(0.0, 1e3, "0 to 1000 m");
pub(super) const ROLLING: Range = Range::new(0.0, 1.0, "0 to 1");
pub(super) const ROBOT_SPEED: Range = Range::new(1e-6, 20.0, "1e-6 to 20 m/s");

/// How much a temperature may change a length: beyond, expansion or temperature is surely mistyped.
pub(super) const THERMAL_FACTOR: (f64, f64) = (0.5, 2.0);
/// Least time between two knots, s: much less, and velocities over it lose all digits.
pub(super) const MIN_INTERVAL_S: f64 = 1e-9;
