//! This module solves a span, the elements between two anchors, for the force at its start.
//!
//! The force at the start determines the force at every node: F drops by q Δs along an element and
//! by the load at a station. So there are two unknowns however many elements there are, and they
//! minimise a convex function (the dual of the potential energy):
//! ```text
//! minimise  D(F₀) = Σ Ψₑ(Fₑ) − F₀·d,     ∇D = Σ chordₑ − d,     ∇²D = Σ ∂chordₑ/∂Fₑ
//! ```
//! Every minimum is an equilibrium in tension: compression and unstable states cannot occur.
//! Newton's method with a line search finds it; where D itself has no digits left, a step is
//! accepted by the gradient.

use crate::math::{Mat2, Vec2};
use crate::model::fem::free::element::Material;
use crate::model::fem::free::stations::{SpanEnds, StationLayout};
use crate::numerics::{ARMIJO_FRACTION, backtrack};

/// Width of a span below which it hangs plumb, as a fraction of its length: the parameter of its
/// catenary is then infinite. Smaller: overflow; larger: narrow loops begin as folds.
const PLUMB_WIDTH_FRACTION: f64 = 1e-6;
/// Most Newton steps of the guess of a taut span, which gains digits fast. Fewer: a worse guess.
const GUESS_STEPS: usize = 12;
/// Least part of the tension that such a step leaves: a guess below zero would not come back.
/// Smaller: a step across the pole; larger: more steps down.
const LEAST_LEFT_TENSION: f64 = 0.1;
/// Relative error of the tension at which the guess is good. Smaller: steps that Newton's method of
/// the span would take anyway; larger: more of those.
const GUESS_TOLERANCE: f64 = 1e-6;

/// Maximum number of Newton steps of a span. Measured: 3 to 14, up to 40 for a span folded on
/// itself.
const MAX_STEPS: usize = 200;
/// Maximum number of halvings of a Newton step.
const MAX_HALVINGS: usize = 40;
/// Gap, as a fraction of the length, below which a span is closed: a few rounding errors of a sum
/// over its elements.
const CLOSURE_TOLERANCE: f64 = 4e-16;
/// Gap, as a fraction of the length, at which a span still counts as closed if a step no longer
/// halves it: the gap of taut stiff spans stops at about 1e-13. Newton's method is quadratic here,
/// so a step that does not halve the gap has reached round-off.
const CLOSURE_LIMIT: f64 = 1e-10;
/// Size of a step, relative to the force, that no longer changes anything.
const FORCE_ROUNDING: f64 = 1e-15;

/// The shape of a span under a start force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpanResponse {
    /// From its first to its last node, m.
    pub reach: Vec2,
    /// ∂reach/∂F₀, m/N.
    pub compliance: Mat2,
    /// Σ Ψ, J.
    pub energy: f64,
    /// Tension force just before the last node, N.
    pub end_force: Vec2,
}

/// A solved span.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BarSpan {
    /// Tension force just after its first node, N.
    pub force: Vec2,
    /// Its shape.
    pub span_response: SpanResponse,
    /// Newton steps taken.
    pub steps: usize,
    /// Unbalanced force that corresponds to its gap, N.
    pub residual: f64,
}

/// An end of a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpanEnd {
    /// Its first node.
    First,
    /// Its last node.
    Last,
}

impl BarSpan {
    /// Derivatives of the forces at both ends by the arc length at one `end`.
    #[must_use]
    pub fn force_rates(&self, material: &Material, layout: &StationLayout, ends: SpanEnds, end: SpanEnd) -> [Vec2; 2] {
        let rate = reach_rate(material, layout, ends, self.force, end);
        let start = self.span_response.compliance.try_inverse().map_or(Vec2::repeat(f64::NAN), |k| -(k * rate));
        [start, start + material.body * if end == SpanEnd::Last { -1.0 } else { 1.0 }]
    }
}

/// Calls `each(ds, middle force)` for the elements between two stations; returns the force before
/// the last station.
pub fn elements(
    material: &Material,
    layout: &StationLayout,
    SpanEnds { first, last }: SpanEnds,
    start: Vec2,
    mut each: impl FnMut(f64, Vec2),
) -> Vec2 {
    let mut force = start;
    for k in first..last {
        let (station, next) = (&layout.stations[k], &layout.stations[k + 1]);
        if k > first {
            force -= station.load;
        }
        let ds = (next.arc_length - station.leaves()) / station.element_count as f64;
        let drop = material.body * ds;
        for e in 0..station.element_count {
            each(ds, force - drop * (e as f64 + 0.5));
        }
        force -= drop * station.element_count as f64;
    }
    force
}

/// The shape of a span under a start force.
#[must_use]
pub fn span_response(material: &Material, layout: &StationLayout, ends: SpanEnds, start: Vec2) -> SpanResponse {
    let mut w = SpanResponse::default();
    w.end_force = elements(material, layout, ends, start, |ds, force| {
        let r = material.respond(ds, force);
        w.reach += r.chord;
        w.compliance += r.compliance;
        w.energy += r.energy;
    });
    w
}

/// ∂reach/∂(arc length at one end), at a constant start force.
fn reach_rate(
    material: &Material,
    layout: &StationLayout,
    SpanEnds { first, last }: SpanEnds,
    start: Vec2,
    end: SpanEnd,
) -> Vec2 {
    let (moving, sign) = if end == SpanEnd::Last { (last - 1, 1.0) } else { (first, -1.0) };
    let mut rate = Vec2::zeros();
    let mut force = start;
    for k in first..last {
        let (station, next) = (&layout.stations[k], &layout.stations[k + 1]);
        if k > first {
            force -= station.load;
        }
        let element_count = station.element_count as f64;
        let ds = (next.arc_length - station.leaves()) / element_count;
        for e in 0..station.element_count {
            let middle = (e as f64 + 0.5) / element_count;
            let f = force - material.body * (ds * (e as f64 + 0.5));
            if k == moving {
                let compliance = material.respond(ds, f).compliance;
                rate +=
                    material.chord_rate(ds, f) * (sign / element_count) - compliance * material.body * (sign * middle);
            } else if k > moving {
                rate -= material.respond(ds, f).compliance * material.body * sign;
            }
        }
        force -= material.body * (ds * element_count);
    }
    rate
}

/// The whole load on a span, N, and its length, m of arc length.
fn load_and_length(material: &Material, layout: &StationLayout, SpanEnds { first, last }: SpanEnds) -> (Vec2, f64) {
    let length = layout.stations[last].arc_length - layout.stations[first].leaves();
    let loads: Vec2 = layout.stations[first + 1..last].iter().map(|s| s.load).sum();
    (material.body * length + loads, length)
}

/// A start force near the solution: that of the parabola if the span is taut, else the first guess
/// for a catenary (A. Peyrot and A. Goulois, *Analysis of cable structures*, Computers & Structures
/// 1979), with point loads spread evenly.
#[must_use]
pub fn first_guess(material: &Material, layout: &StationLayout, ends: SpanEnds, d: Vec2) -> Vec2 {
    let (load, length) = load_and_length(material, layout, ends);
    let rest = length * material.thermal_stretch;
    let (chord, weight) = (d.norm(), load.norm());
    let strain = chord / rest - 1.0;
    if !(weight > 0.0) {
        return if chord > 0.0 { d * (material.axial_stiffness * strain.max(0.0) / chord) } else { d };
    }
    let up = -load / weight;
    let rise = d.dot(&up);
    let across = d - up * rise;
    if strain < SLACK_STRAIN || chord == 0.0 {
        let width = across.norm();
        let lambda = if width > PLUMB_WIDTH_FRACTION * rest {
            (3.0 * ((rest * rest - rise * rise) / (width * width) - 1.0)).max(0.0).sqrt()
        } else {
            f64::INFINITY
        };
        let level =
            if lambda.is_finite() && lambda > 0.0 { across * (weight / rest / (2.0 * lambda)) } else { Vec2::zeros() };
        let steep = if lambda > 0.0 { rise / rest / lambda.tanh() } else { rise / rest };
        return level + up * (0.5 * weight * (steep - 1.0));
    }
    let direction = d / chord;
    let sideways = load - direction * load.dot(&direction);
    let beta = sideways.norm_squared() / 24.0;
    if strain <= 0.0 && beta.sqrt() <= CROSS_LOAD_FRACTION * weight {
        return load * 0.5;
    }
    // Taut: T/EA − β/T² = strain, β = (load across the chord)²/24. Concave and rising: Newton from
    // the left is monotone.
    let ea = material.axial_stiffness;
    let mut tension = if strain > 0.0 { (ea * strain).max((beta * ea).cbrt()) } else { (beta * ea).cbrt() };
    for _ in 0..GUESS_STEPS {
        let f = tension / ea - beta / (tension * tension) - strain;
        let slope = 1.0 / ea + 2.0 * beta / tension.powi(3);
        let next = tension - f / slope;
        tension = if next > LEAST_LEFT_TENSION * tension { next } else { LEAST_LEFT_TENSION * tension };
        if !(f.abs() > GUESS_TOLERANCE * slope * tension) {
            break;
        }
    }
    direction * tension + load * 0.5
}

/// Strain below which a span counts as slack for the first guess: both guesses are good about here.
const SLACK_STRAIN: f64 = -0.02;

/// Fraction of the load that must act across the chord for the parabola to be usable.
const CROSS_LOAD_FRACTION: f64 = 1e-6;

/// Solves a span between points `d` apart (m) from a start force. `None` if Newton's method
/// diverges.
#[must_use]
pub fn solve(material: &Material, layout: &StationLayout, ends: SpanEnds, d: Vec2, guess: Vec2) -> Option<BarSpan> {
    let (load, length) = load_and_length(material, layout, ends);
    let size = length.max(d.norm());
    let mut force = guess;
    let mut w = span_response(material, layout, ends, force);
    for steps in 0..MAX_STEPS {
        let gap = w.reach - d;
        let stiffness = w.compliance.try_inverse()?;
        let step = -(stiffness * gap);
        if !(step.x.is_finite() && step.y.is_finite()) {
            return None;
        }
        let done =
            |w: SpanResponse, force: Vec2| Some(BarSpan { force, span_response: w, steps, residual: step.norm() });
        if gap.norm() <= CLOSURE_TOLERANCE * size || step.norm() <= FORCE_ROUNDING * (force.norm() + load.norm()) {
            return done(w, force);
        }
        let (value, slope) = (w.energy - force.dot(&d), gap.dot(&step));
        let taken = backtrack(1.0, MAX_HALVINGS, |alpha| {
            let trial = force + step * alpha;
            let t = span_response(material, layout, ends, trial);
            let descends = t.energy - trial.dot(&d) <= value + ARMIJO_FRACTION * alpha * slope;
            let closes = (t.reach - d).norm() <= (1.0 - ARMIJO_FRACTION * alpha) * gap.norm();
            let accepted =
                (descends && alpha < 1.0) || closes || (descends && (t.reach - d).norm() <= 2.0 * gap.norm());
            accepted.then_some((trial, t))
        });
        match taken {
            Some((f, t)) => {
                (force, w) = (f, t);
                if gap.norm() <= CLOSURE_LIMIT * size && (t.reach - d).norm() > 0.5 * gap.norm() {
                    return done(w, force);
                }
            }
            None if gap.norm() <= CLOSURE_LIMIT * size => return done(w, force),
            None => return None,
        }
    }
    None
}

/// Decades by which the smoothing of a fold is first raised: to a tenth of the load, where any
/// start converges.
const FOLD_ROUNDING_DECADES: i32 = 6;

/// Solves a span folded so sharply that the fold lies within one element. D has an angle where the
/// tension vanishes; it is smoothed, and the smoothing is reduced tenfold at a time.
#[must_use]
pub fn solve_folded(
    material: &Material,
    layout: &StationLayout,
    ends: SpanEnds,
    d: Vec2,
    guess: Vec2,
) -> Option<BarSpan> {
    let (mut force, mut steps) = (guess, 0);
    for power in (0..=FOLD_ROUNDING_DECADES).rev() {
        let smoothed = Material { smoothing: material.smoothing * 10f64.powi(power), ..*material };
        let span = solve(&smoothed, layout, ends, d, force)?;
        (force, steps) = (span.force, steps + span.steps);
        if power == 0 {
            return Some(BarSpan { steps, ..span });
        }
    }
    None
}
