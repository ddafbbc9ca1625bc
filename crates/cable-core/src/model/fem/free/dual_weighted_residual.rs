//! The dual-weighted residual estimates the error of the forces.
//!
//! Each element's chord differs by δ from the chord of the exact catenary under the same force.
//! With the exact chords the span closes at another start force, and pulleys slide a little to keep
//! their balance:
//! ```text
//! δF₀ = −C⁻¹ Σδ(F₀ + δF₀),     C = ∂reach/∂F₀
//! ```
//! (R. Becker and R. Rannacher, *An optimal control approach to a posteriori error estimation in
//! finite element methods*, Acta Numerica 2001: the residual weighted by the inverse Hessian, here
//! 2×2.) δ is evaluated at the corrected force, in a few rounds. One round is enough for a taut
//! span. In a slack one, whose horizontal force is a small fraction of its tension, the remainder
//! after one round is not small compared with that force.
//!
//! The estimate covers the error of the whole force vector beside every station, relative to the
//! greatest tension: a slack span may have its greatest tension right to many digits and its
//! horizontal force wrong in the third.

use crate::math::{Vec2, larger};
use crate::model::fem::free::beam::equilibrium::Beam;
use crate::model::fem::free::element::Material;
use crate::model::fem::free::pulley_balance::PulleyNetwork;
use crate::model::fem::free::results::SolutionPoint;
use crate::model::fem::free::span;
use crate::model::fem::free::span::{BarSpan, elements};
use crate::model::fem::free::stations::{SpanEnds, StationLayout};

/// The change from a mesh to one with bars half as long, per error of the coarser: 1 − 2⁻⁴, for the
/// fourth order.
const FOURTH_ORDER_CHANGE: f64 = 0.9375;
/// The error of the finer of two meshes is their difference over this: 2⁴ − 1 for the fourth order
/// of forces at stations, 2³ − 1 for the third order between nodes.
const STATION_ERROR_DIVISOR: f64 = 15.0;
const NODE_ERROR_DIVISOR: f64 = 7.0;

/// Maximum number of rounds of the correction.
const ROUNDS: usize = 8;
/// Change of the correction, relative to it, below which another round is not worth while.
const CORRECTION_TOLERANCE: f64 = 0.01;
/// Factor by which the number of elements grows if the present ones give no estimate.
const REFINEMENT_FACTOR: usize = 4;
/// Maximum number of such refinements: 4⁵ = 1024 times as many elements.
const MAX_REFINEMENTS: usize = 5;
/// Maximum number of elements of a span that is solved only for its error: some milliseconds.
const MAX_ELEMENTS: usize = 1 << 15;
/// Round-off of a span's closure, in units of the last place of its length. Measured against the
/// closed form: up to 5 for the difference of two answers.
const CLOSURE_ROUNDING_ULPS: f64 = 8.0;

/// Error of friction that remembers many steps, relative to the greatest tension: where round-off
/// stops Newton's method a balance is accepted at 1e-8, and the remainders add up. Smaller: one in
/// ten histories of stiff cables differs by more from that of `spans` (up to 8e-8 in 300); larger:
/// a worse bound than necessary.
const FRICTION_MEMORY_ERROR_FRACTION: f64 = 1e-7;

/// Difference of arc lengths (m) up to which two nodes of two meshes are the same.
const NODE_TOLERANCE_M: f64 = 1e-9;

/// Error without friction, relative to the greatest tension: tensions of stiff cables beside
/// pulleys agree to that.
const SMOOTH_PULLEY_TOLERANCE: f64 = 1e-10;

/// Estimated error of the force vector on any station, relative to the greatest tension.
#[must_use]
pub fn relative_error(network: &mut PulleyNetwork) -> f64 {
    let (mut largest, mut error) = (0.0, 0.0);
    let changes = force_errors(network);
    for (forces, change) in network.forces.iter().zip(&changes) {
        for (force, d) in forces.iter().zip(change) {
            largest = larger(largest, force.norm());
            error = larger(error, d.norm());
        }
        // The cable pulls at a pulley on both sides.
        error = larger(error, (change[1] - change[0]).norm());
    }
    let memory = match (network.pulleys().is_empty(), network.rubs()) {
        (true, _) => 0.0,
        (false, false) => SMOOTH_PULLEY_TOLERANCE * largest,
        (false, true) => FRICTION_MEMORY_ERROR_FRACTION * largest,
    };
    let error = error + rounding(network) + memory;
    // The error is relative to the least value that the greatest tension can have.
    let least = if error < 0.5 * largest { largest - error } else { largest };
    let share = if least > 0.0 { error / least } else { error };
    share * (1.0 + CORRECTION_TOLERANCE)
}

/// Estimated error of the shape, m: the sum of the chords' errors up to a node, and the
/// displacement by the force that closes the span.
#[must_use]
pub fn position_error(network: &mut PulleyNetwork) -> f64 {
    let changes = force_errors(network);
    let (mut most, layout) = (0.0, &network.layout);
    for (&ends, span) in network.ends.iter().zip(&network.spans) {
        let mut lack = 0.0;
        elements(&network.material, layout, ends, span.force, |ds, f| {
            lack += network.material.chord_error(ds, f).norm();
        });
        let closing = changes.get(ends.first).map_or(0.0, |c| (span.span_response.compliance * c[1]).norm());
        most = larger(most, lack + closing);
    }
    most + CLOSURE_ROUNDING_ULPS * f64::EPSILON * layout.length
}

/// Greatest distance of points of one mesh from those of the same arc length on another, m.
#[must_use]
pub fn greatest_distance(some: &[SolutionPoint], others: &[SolutionPoint]) -> f64 {
    let mut most = 0.0;
    for p in some {
        let k = others.partition_point(|o| o.arc_length < p.arc_length - NODE_TOLERANCE_M);
        if let Some(o) = others.get(k).filter(|o| (o.arc_length - p.arc_length).abs() <= NODE_TOLERANCE_M) {
            most = larger(most, (o.at - p.at).norm());
        }
    }
    most
}

/// Round-off of lengths in the force of the stiffest span, N.
fn rounding(network: &PulleyNetwork) -> f64 {
    let mut most = 0.0;
    for (&SpanEnds { first, last }, span) in network.ends.iter().zip(&network.spans) {
        let length = network.layout.stations[last].arc_length - network.layout.stations[first].leaves();
        let stiffness = span.span_response.compliance.try_inverse().map_or(0.0, |k| k.norm());
        most = larger(most, stiffness * length * CLOSURE_ROUNDING_ULPS * f64::EPSILON);
    }
    most
}

/// Estimated error of the tension force before and after each station, N.
fn force_errors(network: &mut PulleyNetwork) -> Vec<[Vec2; 2]> {
    let mut errors = vec![[Vec2::zeros(); 2]; network.layout.stations.len()];
    for (&ends, span) in network.ends.iter().zip(&network.spans) {
        let off = closing_force(network, ends, span);
        errors[ends.first][1] = off;
        errors[ends.last][0] = off;
    }
    if network.pulley_states.is_empty() {
        let_pulleys_follow(network, &mut errors);
    } else {
        network.let_rubbing_follow(&mut errors);
    }
    errors
}

/// Change of the start force with which the exact catenary closes a span, N. If a fold lies in one
/// element, its error gives no estimate of the force, and the span is solved on finer elements
/// until it does.
fn closing_force(network: &PulleyNetwork, ends: SpanEnds, span: &BarSpan) -> Vec2 {
    let (material, goal) = (&network.material, span.span_response.reach);
    if let Some(off) = correction(material, &network.layout, ends, span.force, goal) {
        return off;
    }
    let mut layout = network.layout.clone();
    let mut force = span.force;
    for _ in 0..MAX_REFINEMENTS {
        layout.stations[ends.first..ends.last].iter_mut().for_each(|s| s.element_count *= REFINEMENT_FACTOR);
        if layout.stations[ends.first..ends.last].iter().map(|s| s.element_count).sum::<usize>() > MAX_ELEMENTS {
            break;
        }
        let guess = span::first_guess(material, &layout, ends, goal);
        let solve = |start| span::solve(material, &layout, ends, goal, start);
        let Some(fine) = solve(force).or_else(|| solve(guess)) else { continue };
        force = fine.force;
        if let Some(off) = correction(material, &layout, ends, force, goal) {
            return (force + off - span.force) * (1.0 + CORRECTION_TOLERANCE);
        }
    }
    // The computed difference is that of the finest mesh from this span; the factor bounds the
    // rest.
    (force - span.force) * 2.0
}

/// The change of the start force by rounds of the correction; None if they do not converge.
fn correction(material: &Material, layout: &StationLayout, ends: SpanEnds, force: Vec2, goal: Vec2) -> Option<Vec2> {
    let (mut off, mut before) = (Vec2::zeros(), f64::INFINITY);
    for _ in 0..ROUNDS {
        let mut lack = Vec2::zeros();
        let span_response = span::span_response(material, layout, ends, force + off);
        elements(material, layout, ends, force + off, |ds, f| lack += material.chord_error(ds, f));
        let change = -(span_response.compliance.try_inverse()? * (span_response.reach + lack - goal));
        off += change;
        if !(change.norm() < before) {
            return None;
        }
        before = change.norm();
        if before <= CORRECTION_TOLERANCE * off.norm() {
            return Some(off * (1.0 + CORRECTION_TOLERANCE));
        }
    }
    None
}

/// Error of the coarser of two networks, relative to the greatest tension: sixteen fifteenths
/// (fourth order) of the greatest difference of a force on a station between it and the same
/// network with bars half as long.
#[must_use]
pub fn difference(coarse: &PulleyNetwork, fine: &PulleyNetwork) -> f64 {
    let (mut largest, mut off) = (0.0, 0.0);
    for (a, b) in coarse.forces.iter().zip(&fine.forces) {
        let d = [a[0] - b[0], a[1] - b[1]];
        largest = larger(larger(largest, b[0].norm()), b[1].norm());
        off = larger(larger(off, d[0].norm()), larger(d[1].norm(), (d[1] - d[0]).norm()));
    }
    if largest > 0.0 { off / (FOURTH_ORDER_CHANGE * largest) } else { off }
}

/// Adds the response of frictionless pulleys to small changes of the forces beside the stations:
/// they slide until the tensions agree again.
fn let_pulleys_follow(network: &PulleyNetwork, changes: &mut [[Vec2; 2]]) {
    let pulleys = network.pulleys();
    let imbalances: Vec<Option<f64>> = pulleys
        .iter()
        .map(|&k| {
            let (wheel, [before, after]) = (network.wheel(k)?, network.forces[k]);
            network.imbalance(k, &wheel)?;
            Some(network.imbalance_rate(&wheel, 0.0, [before, after], changes[k]))
        })
        .collect();
    let (slides, _) = network.newton_step(&pulleys, &imbalances);
    for (&of, slide) in pulleys.iter().zip(slides) {
        for (k, change) in changes.iter_mut().enumerate() {
            let rates = network.rates_at(k, of);
            change[0] += rates[0] * slide;
            change[1] += rates[1] * slide;
        }
    }
}

/// Estimated relative error of the forces on the finer of two meshes: a fifteenth of the change at
/// the stations (fourth order), and a seventh between nodes (third order), where a stiff cable may
/// have its greatest tension.
#[must_use]
pub fn halving_error(coarse: &Beam, fine: &Beam) -> f64 {
    let (mut largest, mut change) = (fine.bending_force(), 0.0);
    for (a, b) in coarse.station_forces().iter().flatten().zip(fine.station_forces().iter().flatten()) {
        let (size, off) = (b.norm(), (b - a).norm());
        largest = larger(largest, size);
        change = larger(change, off / STATION_ERROR_DIVISOR);
    }
    change = larger(change, (fine.greatest_tension() - coarse.greatest_tension()).abs() / NODE_ERROR_DIVISOR);
    if largest > 0.0 { change / largest } else { change }
}
