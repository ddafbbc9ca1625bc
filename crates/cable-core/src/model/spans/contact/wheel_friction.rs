//! This module gives models with spans of their own the friction of one wheel: its memory, and the
//! two equations of the cable on it.
//!
//! The law is that of every contact here (`capstan`, `friction_memory`, `equations`). Slip is
//! measured at points fixed to the wheel, because the points where the cable meets and leaves it
//! move with its directions without moving material.

use crate::math::Vec2;
use crate::model::spans::boundary::{
    Breakpoint, CableLaw, ChainRange, ContactPath, Curve, Ends, Mode, StickZone, TensionProfile,
};
use crate::model::spans::contact::equations;

/// A wheel is one arc.
const WHEEL_RANGE: ChainRange = ChainRange { first: 0, last: 0 };
/// Distance from the edge of the friction cone within which an adopted cable counts as sliding, as
/// a fraction of the cone. Smaller: the round-off of the answer decides; larger: a sticking cable
/// starts to slide, with that relative error of its tension.
const SLIDING_CONE_TOLERANCE: f64 = 1e-7;

/// Load (N/m), 1 + αΔT and EA (N) of the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model) struct CableProperties {
    pub load: Vec2,
    pub thermal: f64,
    pub stiffness: f64,
}

/// The points at which the cable meets and leaves a wheel: angle (rad, growing along the cable),
/// material (m), tension (N).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model) struct WheelEnds {
    pub place: [f64; 2],
    pub material: [f64; 2],
    pub tension: [f64; 2],
}

/// Two equations and their derivatives by (p₁, s₁, T₁, p₂, s₂, T₂).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model) struct WheelEquations {
    pub residual: [f64; 2],
    pub by: [[f64; 6]; 2],
    /// True if a row is of tensions (N), not of material (m).
    pub of_tension: [bool; 2],
}

/// A wheel's friction and its memory.
#[derive(Clone, Debug)]
pub(in crate::model) struct WheelFriction {
    curve: Curve,
    history: TensionProfile,
    mode: Mode,
    stick_zone: Option<StickZone>,
}

impl From<&WheelEnds> for Ends {
    fn from(e: &WheelEnds) -> Self {
        Self { place: e.place, material: e.material, tension: e.tension }
    }
}

impl WheelFriction {
    /// A wheel of a radius (of the centre line, m) that the cable passes clockwise (`facing` +1) or
    /// the other way (−1).
    pub fn new(radius: f64, friction: f64, facing: f64) -> Self {
        let mode = if friction > 0.0 { Mode::Stick } else { Mode::Slip(0.0) };
        Self {
            curve: Curve::wheel(radius, friction, facing),
            history: TensionProfile::default(),
            mode,
            stick_zone: None,
        }
    }

    /// The way of the cable over this wheel.
    fn contact_path(&self, on: &CableProperties) -> ContactPath<'_> {
        let law = CableLaw::new(on.load, on.thermal, on.stiffness);
        ContactPath {
            curve: &self.curve,
            chain_range: WHEEL_RANGE,
            law,
            friction: self.curve.friction,
            drag: 0.0,
            floored: false,
            friction_of_loose: 0.0,
            cached_piece: None,
        }
    }

    /// The angle at which the cable has the direction `along`, counted on the turn nearest to
    /// `near`.
    pub fn angle(&self, along: Vec2, near: f64) -> f64 {
        let p = self.curve.with_tangent(0, along);
        p + std::f64::consts::TAU * ((near - p) / std::f64::consts::TAU).round()
    }

    /// Direction of the cable and outward normal at an angle.
    pub fn directions(&self, p: f64) -> [Vec2; 2] {
        let place = self.curve.place(p, WHEEL_RANGE);
        [place.tangent, place.normal]
    }

    /// Begins the memory from angle (rad), material (m) and tension (N) at points in order.
    pub fn begin(&mut self, on: &CableProperties, points: &[[f64; 3]]) {
        let breakpoints: Vec<Breakpoint> =
            points.iter().map(|&[p, s, tension]| Breakpoint::frictionless(p, s, tension)).collect();
        let friction = self.curve.friction;
        self.history = TensionProfile::through(&self.contact_path(on), &breakpoints, 1.0);
        self.stick_zone = None;
        if let (Some(a), Some(b), true) = (breakpoints.first(), breakpoints.last(), friction > 0.0)
            && b.coordinate > a.coordinate
        {
            let reach = |m: f64| self.contact_path(on).slide(a.coordinate, b.coordinate, a.tension, m).tension;
            let full = |m: f64| {
                (b.tension - reach(m)).abs() <= SLIDING_CONE_TOLERANCE * (reach(friction) - reach(-friction)).abs()
            };
            self.mode = [friction, -friction].into_iter().find(|&m| full(m)).map_or(Mode::Stick, Mode::Slip);
        }
    }

    /// The equations at these ends.
    pub fn rows(&mut self, on: &CableProperties, ends: &WheelEnds) -> WheelEquations {
        let (e, contact_path) = (Ends::from(ends), self.contact_path(on));
        let end_points = e.place.map(|p| contact_path.place(p));
        let (rows, stick_zone) = equations::rows(&contact_path, &self.history, &e, &end_points, self.mode, [false; 2]);
        self.stick_zone = stick_zone;
        WheelEquations { residual: rows.residual, by: rows.by, of_tension: rows.of_tension }
    }

    /// Changes the mode to slip or stick if the law requires it at these ends; returns whether it
    /// did. `patience` is the multiple of round-off that a violation must have.
    pub fn change_mode(&mut self, on: &CableProperties, ends: &WheelEnds, patience: f64) -> bool {
        let e = Ends::from(ends);
        let next =
            equations::next_mode(&self.contact_path(on), &self.history, &e, None, self.mode, [false; 2], patience);
        let changed = next != self.mode;
        self.mode = next;
        changed
    }

    /// Stores the outcome of a step in the memory.
    pub fn commit(&mut self, on: &CableProperties, ends: &WheelEnds) {
        let e = Ends::from(ends);
        let mut history = std::mem::take(&mut self.history);
        history.commit(&self.contact_path(on), &e, self.mode, None, &mut TensionProfile::default());
        self.history = history;
    }

    /// Tension (N) and material (m) at an angle after the last step.
    pub fn at(&self, on: &CableProperties, p: f64) -> (f64, f64) {
        self.history.at(&self.contact_path(on), p)
    }
}
