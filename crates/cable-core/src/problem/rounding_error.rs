//! Rounding limits an answer without a mesh: lengths are off by units in the last place, and forces
//! by that times the stiffness.

use super::definition::Problem;
use crate::math::{Mat2, larger, smaller};
use crate::solution::error_estimates::{ErrorEstimates, largest_force};
use crate::solution::{CableSolution, ContactReport, Node};

/// Relative rounding of a length that is added up from many pieces, in units in the last place.
/// Measured against the closed form: up to 5, of two answers. Less: rounding shows as an error that
/// nobody told of; more: stiff taut cables seem worse than they are.
const LENGTH_ROUNDING_FRACTION: f64 = 8.0 * f64::EPSILON;

/// Part of the tension at the slack end of a contact that rounding may be for the end of sliding to
/// be known. Measured over a corner: at 0.02 pulls are right to 1e-5, at 0.05 they are a half, at
/// 0.2 a fifth. Less: pulls that are known are said to be uncertain; more: pulls that are far too
/// small are said to be known.
const MAX_MISSING_FRACTION: f64 = 0.01;

impl ErrorEstimates {
    /// Returns what rounding leaves of an answer that has no error of a mesh: a length is off by
    /// units in the last place, and forces by the stiffness of the stiffest stretch between two
    /// supports or contacts times that,
    /// ```text
    /// δF = C⁻¹ δL,     C = ∫ (t tᵀ/EA + (I − t tᵀ)/T) ds
    /// ```
    /// C being how far its end moves under a force (H. M. Irvine, *Cable Structures*, MIT Press
    /// 1981, for shallow ones).
    #[must_use]
    pub fn rounding(answer: &CableSolution, problem: &Problem) -> Self {
        let far = answer.nodes.iter().map(|n| n.at().amax()).fold(problem.length, larger);
        let mut stops: Vec<f64> = answer.supports.iter().map(|s| s.arc_length_m).collect();
        stops.extend(answer.contacts.iter().flat_map(|c| c.extent_m()));
        stops.sort_by(f64::total_cmp);
        let stretches = stops.windows(2).filter_map(|w| stiffness(between_stops(&answer.nodes, w), problem));
        let rounded = LENGTH_ROUNDING_FRACTION * (far * stretches.fold(0.0, larger) + largest_force(answer));
        let drawn =
            answer.contacts.iter().filter_map(|c| unknown_slack_end(c, problem, LENGTH_ROUNDING_FRACTION * far));
        let force = drawn.fold(rounded, larger);
        Self {
            max_tension_n: Some(force),
            support_force_n: Some(force),
            contact_force_n: (!answer.contacts.is_empty()).then_some(force),
            position_m: Some(LENGTH_ROUNDING_FRACTION * far),
        }
    }
}

impl CableSolution {
    /// The same, known to its rounding.
    pub(crate) fn rounded(self, problem: &Problem) -> Self {
        let errors = ErrorEstimates::rounding(&self, problem);
        self.known_to(errors)
    }
}

/// Error of the greater tension at a contact, N, where rounding of lengths (m) leaves open how far
/// along it the cable slides: friction may then carry on all that it can. None where it does not.
///
/// Towards its slack end the tension T₁ falls by its e-th part over the length l/ln(T₂/T₁), and a
/// length δ that is missing there is the tension EA δ ln(T₂/T₁)/l. Friction that is mobilised whole
/// multiplies as it is given.
fn unknown_slack_end(contact: &ContactReport, problem: &Problem, rounding_m: f64) -> Option<f64> {
    let [a, b] = [contact.tension_before_n, contact.tension_after_n];
    let (low, high, length) = (smaller(a, b), larger(a, b), contact.ends_m - contact.begins_m);
    let may_slide = problem.cable.friction_mobilised.is_default();
    if !(may_slide && low > 0.0 && length > 0.0) {
        return None;
    }
    let missing_n = problem.axial_stiffness * rounding_m * (high / low).ln() / length;
    let bodies = problem.world.geometry().bodies();
    let body = bodies.iter().find(|body| problem.world.obstacle_name(body.obstacle) == contact.obstacle);
    let most = low * (body.map_or(0.0, |b| b.friction) * contact.turn_deg.to_radians().abs()).exp();
    (missing_n > MAX_MISSING_FRACTION * low).then(|| larger(high, most - high))
}

fn between_stops<'a>(nodes: &'a [Node], stops: &[f64]) -> &'a [Node] {
    let (Some(from), Some(to)) = (stops.first(), stops.last()) else { return &[] };
    let first = nodes.partition_point(|n| n.arc_length_m < *from);
    let last = nodes.partition_point(|n| n.arc_length_m <= *to);
    nodes.get(first..last).unwrap_or(&[])
}

/// Greatest force by which an end of a stretch answers a unit of displacement, N/m; None where it
/// has no length.
fn stiffness(nodes: &[Node], problem: &Problem) -> Option<f64> {
    let mut compliance = Mat2::zeros();
    for w in nodes.windows(2) {
        let (chord, ds) = (w[1].at() - w[0].at(), w[1].arc_length_m - w[0].arc_length_m);
        let Some(t) = chord.try_normalize(0.0).filter(|_| ds > 0.0) else { continue };
        let along = t * t.transpose();
        let tension = larger(0.5 * (w[0].tension_n + w[1].tension_n), f64::MIN_POSITIVE);
        compliance += along * (ds / problem.axial_stiffness) + (Mat2::identity() - along) * (ds / tension);
    }
    let [a, b, d] = [compliance[(0, 0)], compliance[(0, 1)], compliance[(1, 1)]];
    let (mean, spread) = (0.5 * (a + d), (0.5 * (a - d)).hypot(b));
    // The least eigenvalue, by the determinant: the difference of two large ones says nothing.
    let least = (a * d - b * b) / (mean + spread);
    (least > 0.0 && least.is_finite()).then(|| least.recip())
}
