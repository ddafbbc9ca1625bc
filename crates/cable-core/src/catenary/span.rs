//! A span is a cable between two points; solved, it is a [`Catenary`].

use super::closed_form::{self, ChainPiece, HorizontalForce};
use crate::error::{NoEquilibrium, SolveError, SpanError};
use crate::math::{Vec2, bounded, perp};

/// Ratio of load to EA below which the load has no effect on a stretched cable (its square would
/// leave the range of f64), and the span is a straight bar.
const MIN_LOAD_RATIO: f64 = 1e-120;

/// A cable between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// From start to end, m.
    pub chord: Vec2,
    /// Unstretched length at rest temperature, m; > 0.
    pub length: f64,
    /// Load per metre of unstretched length, N/m: weight and wind, any direction.
    pub weight: Vec2,
    /// EA, N; infinite for an inextensible cable.
    pub axial_stiffness: f64,
    /// 1 + αΔT; > 0.
    pub thermal_stretch: f64,
}

impl From<SpanError> for SolveError {
    fn from(e: SpanError) -> Self {
        Self::NoRestingPlace { why: NoEquilibrium::Span(e) }
    }
}

/// The frame in which the load points along −`up`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LoadAxes {
    pub(super) across: Vec2,
    pub(super) up: Vec2,
}

impl LoadAxes {
    /// Against `load`; without one, across `chord`.
    pub(super) fn new(load: Vec2, chord: Vec2) -> Self {
        let (n, c) = (load.norm(), chord.norm());
        let up = if n > 0.0 {
            -load / n
        } else if c > 0.0 {
            perp(chord) / c
        } else {
            Vec2::y()
        };
        Self { across: -perp(up), up }
    }

    /// The same, mirrored so that `v` has a positive component across.
    pub(super) fn facing(self, v: Vec2) -> Self {
        if v.dot(&self.across) < 0.0 { Self { across: -self.across, up: self.up } } else { self }
    }

    pub(super) fn split(&self, v: Vec2) -> (f64, f64) {
        (v.dot(&self.across), v.dot(&self.up))
    }

    pub(super) fn join(&self, x: f64, z: f64) -> Vec2 {
        self.across * x + self.up * z
    }
}

/// A solved span: everything about it is a function of the force at its start.
///
/// ```
/// use cable_core::catenary::{Catenary, Span};
/// use cable_core::Vec2;
/// let span = Span {
///     chord: Vec2::new(100.0, 0.0),
///     length: 110.0,
///     weight: Vec2::new(0.0, -20.0),
///     axial_stiffness: f64::INFINITY,
///     thermal_stretch: 1.0,
/// };
/// let c = Catenary::solve(&span)?;
/// // √(L² − Z²) = 2a sinh(X/2a), a = H/w
/// let a = c.start_force().x / 20.0;
/// assert!((2.0 * a * (50.0 / a).sinh() - 110.0).abs() < 1e-12 * 110.0);
/// # Ok::<(), cable_core::catenary::SpanError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Catenary {
    span: Span,
    frame: LoadAxes,
    /// Force at the start in the frame, N.
    horizontal: f64,
    va: f64,
    iterations: usize,
}

impl Span {
    /// The first length s of it in the form of `closed_form.rs`: length at temperature, same total
    /// load.
    fn piece(&self, s: f64) -> ChainPiece {
        ChainPiece {
            w: self.weight.norm() / self.thermal_stretch,
            l: self.thermal_stretch * s,
            eps: 1.0 / self.axial_stiffness,
        }
    }
}

impl Catenary {
    /// Solves a span.
    ///
    /// # Errors
    /// See [`SpanError`].
    #[inline]
    pub fn solve(span: &Span) -> Result<Self, SpanError> {
        let (length, stiff) = (span.length * span.thermal_stretch, span.axial_stiffness);
        let finite = span.chord.iter().chain(span.weight.iter()).all(|v| v.is_finite());
        if !(finite && length > 0.0 && length.is_finite() && span.length > 0.0 && stiff > 0.0) {
            return Err(SpanError::NotANumber);
        }
        let chord = span.chord.norm();
        if stiff.is_infinite() && chord >= length {
            return Err(SpanError::TooShort { length_m: length, chord_m: chord });
        }
        let load = span.weight.norm() * span.length;
        let eps = load / stiff;
        if load == 0.0 || (eps < MIN_LOAD_RATIO && chord > length) {
            return Self::bar(span, chord, length);
        }
        // In units of the load and the length.
        let frame = LoadAxes::new(span.weight, span.chord).facing(span.chord);
        let (x, z) = frame.split(span.chord);
        let chord = [x / length, z / length];
        let piece = ChainPiece { w: 1.0, l: 1.0, eps };
        let (h, v, iterations) = if chord[0] < f64::MIN_POSITIVE {
            (0.0, closed_form::vertical(chord[1], eps), 0)
        } else {
            let (h, v) = closed_form::guess(chord, eps);
            let lengths = 1.0 + chord[0] + chord[1].abs();
            let energy = |h, v| piece.energy(h, v);
            let m = closed_form::minimise(energy, chord, [h, v], lengths, HorizontalForce::Positive);
            if !m.converged {
                return Err(SpanError::NotConverged { iterations: m.iterations, closure_m: m.closure * length });
            }
            (m.h, m.v, m.iterations)
        };
        Ok(Self { span: *span, frame, horizontal: h * load, va: v * load, iterations })
    }

    /// Solves a straight bar without load.
    fn bar(span: &Span, chord: f64, length: f64) -> Result<Self, SpanError> {
        if chord < length {
            return Err(SpanError::Slack { length_m: length, chord_m: chord });
        }
        let straight = Span { weight: Vec2::zeros(), ..*span };
        let frame = LoadAxes::new(Vec2::zeros(), span.chord).facing(span.chord);
        Ok(Self {
            span: straight,
            frame,
            horizontal: span.axial_stiffness * (chord / length - 1.0),
            va: 0.0,
            iterations: 0,
        })
    }

    /// A cable whose start force (N, along growing arc length) is known, which determines its end:
    /// a hanging tail, for instance. `span.chord` is not read.
    #[must_use]
    pub fn from_start_force(span: &Span, force: Vec2) -> Self {
        let frame = LoadAxes::new(span.weight, force).facing(force);
        let (h, va) = frame.split(force);
        let mut c = Self { span: *span, frame, horizontal: h, va, iterations: 0 };
        c.span.chord = c.position_at(span.length);
        c
    }

    /// The span that was solved.
    #[must_use]
    pub fn span(&self) -> &Span {
        &self.span
    }

    /// Newton iterations taken.
    #[must_use]
    pub fn iterations(&self) -> usize {
        self.iterations
    }

    /// Vertical force (along the load's frame) at s.
    fn v(&self, s: f64) -> f64 {
        self.va + self.span.weight.norm() * s
    }

    /// Force the rest of the cable exerts on the part before s, N: along the tangent of growing arc
    /// length.
    #[must_use]
    pub(crate) fn force_at(&self, s: f64) -> Vec2 {
        self.frame.join(self.horizontal, self.v(s))
    }

    /// Force at the start, N: the force of the cable on the support at its start.
    #[must_use]
    pub fn start_force(&self) -> Vec2 {
        self.force_at(0.0)
    }

    /// Force at the end, N: minus the force of the cable on the support at its end.
    #[must_use]
    pub fn end_force(&self) -> Vec2 {
        self.force_at(self.span.length)
    }

    /// Tension at s, N.
    #[must_use]
    pub fn tension_at(&self, s: f64) -> f64 {
        self.horizontal.hypot(self.v(s))
    }

    /// The greatest tension, N: always at an end.
    #[must_use]
    pub fn max_tension(&self) -> f64 {
        let (a, b) = (self.tension_at(0.0), self.tension_at(self.span.length));
        if a > b { a } else { b }
    }

    /// Position at s from the start, m.
    #[must_use]
    pub fn position_at(&self, s: f64) -> Vec2 {
        let (x, z) = self.span.piece(s).displacement(self.horizontal, self.va);
        self.frame.join(x, z)
    }

    /// Stretched length up to s, m.
    #[must_use]
    pub fn stretched_to(&self, s: f64) -> f64 {
        self.span.piece(s).stretched(self.horizontal, self.va)
    }

    /// Arc length of the point farthest along the load (the lowest point under weight), m: inside
    /// or at an end.
    #[must_use]
    pub fn lowest_s(&self) -> f64 {
        let w = self.span.weight.norm();
        if w > 0.0 {
            bounded(-self.va / w, 0.0, self.span.length)
        } else if self.span.chord.dot(&self.frame.up) < 0.0 {
            self.span.length
        } else {
            0.0
        }
    }

    /// The lowest point, m from the start.
    #[must_use]
    pub fn lowest(&self) -> Vec2 {
        self.position_at(self.lowest_s())
    }

    /// Arc length where the cable is farthest below its chord along the load: V/H = Z/X, m. In a
    /// vertical fold the lowest point.
    #[must_use]
    pub(crate) fn sag_s(&self) -> f64 {
        let w = self.span.weight.norm();
        let (x, z) = self.frame.split(self.span.chord);
        if w > 0.0 && x > 0.0 {
            bounded((self.horizontal * z / x - self.va) / w, 0.0, self.span.length)
        } else {
            self.lowest_s()
        }
    }

    /// Greatest distance below the chord, measured along the load, m (below the lower end where the
    /// chord has no extent across the load).
    #[must_use]
    pub fn sag(&self) -> f64 {
        let (x, z) = self.frame.split(self.span.chord);
        let (px, pz) = self.frame.split(self.position_at(self.sag_s()));
        if x > 0.0 { z * (px / x) - pz } else { (if z < 0.0 { z } else { 0.0 }) - pz }
    }
}
