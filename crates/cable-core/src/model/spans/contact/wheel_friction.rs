//! This module gives models with spans of their own the friction of one wheel: its memory, and the
//! two equations of the cable on it.
//!
//! The law is that of every contact here (`capstan`, `friction_memory`, `equations`). Slip is seen
//! at points fixed to the wheel, since where the cable meets and leaves it wanders with its
//! directions and moves no material.

use crate::math::Vec2;
use crate::model::spans::boundary::capstan::{Law, Track};
use crate::model::spans::boundary::curve::{ChainRange, Curve};
use crate::model::spans::boundary::friction_memory::{Ends, Held, Knot, Mode, TensionProfile};
use crate::model::spans::contact::equations;

/// A wheel is one arc.
const WHEEL_RANGE: ChainRange = ChainRange { first: 0, last: 0 };
/// Part of the cone within which a cable taken over counts as sliding. Less: rounding of the answer
/// decides; more: a cable that holds is let slide, for as much of its tension.
const SLIDING_CONE_TOLERANCE: f64 = 1e-7;

/// Load (N/m), 1 + αΔT and EA (N) of the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model) struct OnWheel {
    pub load: Vec2,
    pub thermal: f64,
    pub stiffness: f64,
}

/// The points at which the cable meets and leaves a wheel: angle (rad, growing along the cable),
/// material (m), tension (N).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model) struct WheelEnds {
    pub p: [f64; 2],
    pub s: [f64; 2],
    pub t: [f64; 2],
}

/// Two equations and their derivatives by (p₁, s₁, T₁, p₂, s₂, T₂).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model) struct WheelRows {
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
    held: Option<Held>,
}

impl From<&WheelEnds> for Ends {
    fn from(e: &WheelEnds) -> Self {
        Self { p: e.p, s: e.s, t: e.t }
    }
}

impl WheelFriction {
    /// A wheel of a radius (of the centre line, m) that the cable passes clockwise (`facing` +1) or
    /// the other way (−1).
    pub fn new(radius: f64, friction: f64, facing: f64) -> Self {
        let mode = if friction > 0.0 { Mode::Hold } else { Mode::Slide(0.0) };
        Self { curve: Curve::wheel(radius, friction, facing), history: TensionProfile::default(), mode, held: None }
    }

    fn track(&self, on: &OnWheel) -> Track<'_> {
        let law = Law::new(on.load, on.thermal, on.stiffness);
        Track {
            curve: &self.curve,
            chain_range: WHEEL_RANGE,
            law,
            friction: self.curve.friction,
            drag: 0.0,
            floored: false,
            friction_of_loose: 0.0,
            pivot: None,
        }
    }

    /// The angle at which the cable has a direction, the one nearest to another.
    pub fn angle(&self, along: Vec2, near: f64) -> f64 {
        let p = self.curve.with_tangent(0, along);
        p + std::f64::consts::TAU * ((near - p) / std::f64::consts::TAU).round()
    }

    /// Direction of the cable and outward normal at an angle.
    pub fn directions(&self, p: f64) -> [Vec2; 2] {
        let place = self.curve.place(p, WHEEL_RANGE);
        [place.tangent, place.normal]
    }

    /// Begins with what is known of the cable on it: angle, material (m) and tension (N) at points
    /// in order.
    pub fn begin(&mut self, on: &OnWheel, points: &[[f64; 3]]) {
        let knots: Vec<Knot> = points
            .iter()
            .map(|&[p, s, tension]| Knot { coordinate: p, arc_length: s, tension, mobilised: 0.0 })
            .collect();
        let friction = self.curve.friction;
        self.history = TensionProfile::through(&self.track(on), &knots, 1.0);
        self.held = None;
        if let (Some(a), Some(b), true) = (knots.first(), knots.last(), friction > 0.0)
            && b.coordinate > a.coordinate
        {
            let reach = |m: f64| self.track(on).slide(a.coordinate, b.coordinate, a.tension, m).tension;
            let full = |m: f64| {
                (b.tension - reach(m)).abs() <= SLIDING_CONE_TOLERANCE * (reach(friction) - reach(-friction)).abs()
            };
            self.mode = [friction, -friction].into_iter().find(|&m| full(m)).map_or(Mode::Hold, Mode::Slide);
        }
    }

    /// The equations at these ends.
    pub fn rows(&mut self, on: &OnWheel, ends: &WheelEnds) -> WheelRows {
        let (e, track) = (Ends::from(ends), self.track(on));
        let spots = e.p.map(|p| track.place(p));
        let (rows, held) = equations::rows(&track, &self.history, &e, &spots, self.mode, [false; 2]);
        self.held = held;
        WheelRows { residual: rows.residual, by: rows.by, of_tension: rows.of_tension }
    }

    /// Goes over to sliding or holding where the law asks for it at these ends; whether it did.
    /// `patience` is how many times rounding a violation must be.
    pub fn change_mode(&mut self, on: &OnWheel, ends: &WheelEnds, patience: f64) -> bool {
        let e = Ends::from(ends);
        let next = equations::next_mode(&self.track(on), &self.history, &e, None, self.mode, [false; 2], patience);
        let changed = next != self.mode;
        self.mode = next;
        changed
    }

    /// Takes what came of a step as the new past.
    pub fn commit(&mut self, on: &OnWheel, ends: &WheelEnds) {
        let e = Ends::from(ends);
        let mut history = std::mem::take(&mut self.history);
        history.commit(&self.track(on), &e, self.mode, None, &mut TensionProfile::default());
        self.history = history;
    }

    /// Tension (N) and material (m) at an angle as they were last.
    pub fn at(&self, on: &OnWheel, p: f64) -> (f64, f64) {
        self.history.at(&self.track(on), p)
    }
}
