//! This module holds the friction state of a pulley: it holds its cable or lets it slide, and
//! remembers where it held it.

use crate::math::Vec2;
use crate::model::spans::contact::{CableProperties, WheelFriction};

/// State of friction at a pulley without a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PointFriction {
    /// The material there sticks.
    Holds,
    /// It slides with this signed coefficient.
    Slides(f64),
}

/// State of friction at a pulley.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // A scene has only a few of them.
pub(super) enum FrictionState {
    /// The state on a wheel.
    Wheel(WheelFriction),
    /// The state at a pulley without a radius: μ, stick or slip, and the arc length that it held
    /// last, m.
    Point { friction: f64, mode: PointFriction, resting_place: f64 },
}

/// A pulley and its memory.
#[derive(Clone, Debug)]
pub struct PulleyState {
    pub(super) support: Option<usize>,
    pub(super) friction: FrictionState,
    /// Angles at which the cable meets and leaves a wheel, rad.
    pub(super) angles: [f64; 2],
    /// Arc lengths there, m.
    pub(super) material: [f64; 2],
}

/// An unknown at a pulley: the angle or the arc length at its side 0 or 1, or the arc length at a
/// pulley without a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unknown {
    Angle(usize),
    Material(usize),
    Both,
}

/// A point of the cable on a wheel.
#[derive(Clone, Copy, Debug)]
pub struct PointOnWheel {
    /// Outward normal of the wheel.
    pub normal: Vec2,
    /// Arc length, m.
    pub arc_length: f64,
    /// Tension, N.
    pub tension: f64,
}

impl PulleyState {
    pub(super) fn unknowns(&self) -> &'static [Unknown] {
        use Unknown::{Angle, Both, Material};
        match self.friction {
            FrictionState::Wheel(_) => &[Angle(0), Material(0), Angle(1), Material(1)],
            FrictionState::Point { .. } => &[Both],
        }
    }

    /// The cable at a fraction of its arc in the last step; None for a pulley without a radius.
    pub fn on_arc(&self, on: &CableProperties, fraction: f64) -> Option<PointOnWheel> {
        let FrictionState::Wheel(wheel) = &self.friction else { return None };
        let angle = self.angles[0] + (self.angles[1] - self.angles[0]) * fraction;
        let (tension, arc_length) = wheel.at(on, angle);
        Some(PointOnWheel { normal: wheel.directions(angle)[1], arc_length, tension })
    }
}
