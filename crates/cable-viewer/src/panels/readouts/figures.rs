//! The figures of a cable's answer that are not in it as they stand.

use cable_core::scene::View;
use cable_core::solution::{CableSolution, Node};

/// Greatest value of a quantity along a cable and the node it is at; nodes where it is not finite are left out.
#[must_use]
pub fn greatest(cable: &CableSolution, of: impl Fn(&Node) -> f64) -> Option<(f64, Node)> {
    let values = cable.nodes.iter().map(|n| (of(n), *n)).filter(|(v, _)| v.is_finite());
    values.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Sag: the greatest distance of the cable from the straight line between neighbouring supports, and the node
/// it is at. Measured downwards in a side view, square to the line in a plan view. None where no stretch has two ends
/// apart from each other.
#[must_use]
pub fn sag(cable: &CableSolution, view: View) -> Option<(f64, Node)> {
    let mut best: Option<(f64, Node)> = None;
    for pair in cable.supports.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let (dx, dy) = (b.x_m - a.x_m, b.y_m - a.y_m);
        let span = match view {
            View::Elevation => dx.abs(),
            View::Plan => dx.hypot(dy),
        };
        let between =
            cable.nodes.iter().filter(|n| n.arc_length_m >= a.arc_length_m && n.arc_length_m <= b.arc_length_m);
        for n in between {
            // Twice the triangle's area over the base: over its horizontal part that is the vertical distance.
            let cross = dx * (n.y_m - a.y_m) - dy * (n.x_m - a.x_m);
            let depth = match view {
                View::Elevation => -cross * dx.signum() / span,
                View::Plan => cross.abs() / span,
            };
            if depth.is_finite() && best.is_none_or(|(d, _)| depth > d) {
                best = Some((depth, *n));
            }
        }
    }
    best
}

/// Stretched length, m: ∫ (1 + ε) θ ds with θ = 1 + αΔT. The sum of the chords between nodes would be shorter where the cable
/// is curved, shorter even than the cable.
#[must_use]
pub fn stretched_length(cable: &CableSolution, thermal_stretch: f64) -> f64 {
    let elements = cable.pieces().flat_map(|piece| piece.windows(2));
    let each = elements.map(|w| (w[1].arc_length_m - w[0].arc_length_m) * (1.0 + 0.5 * (w[0].strain + w[1].strain)));
    thermal_stretch * each.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use cable_core::solution::SupportReaction;

    use super::*;

    fn parabola(tilt: f64) -> CableSolution {
        let node = |i: i32| {
            let x = f64::from(i) / 10.0;
            Node { arc_length_m: x, x_m: x, y_m: tilt * x - 4.0 * x * (1.0 - x), ..Node::default() }
        };
        let support = |x: f64| SupportReaction { x_m: x, y_m: tilt * x, arc_length_m: x, ..SupportReaction::default() };
        CableSolution {
            nodes: (0..=10).map(node).collect(),
            supports: vec![support(0.0), support(1.0)],
            ..CableSolution::default()
        }
    }

    #[test]
    fn sag_is_vertical_whatever_the_slope() {
        for tilt in [0.0, 3.0, -2.0] {
            let (depth, node) = sag(&parabola(tilt), View::Elevation).unwrap();
            assert!((depth - 1.0).abs() < 1e-12 && node.x_m == 0.5, "{tilt}: {depth}");
        }
    }

    #[test]
    fn sag_in_plan_is_square_to_the_line() {
        let (depth, _) = sag(&parabola(1.0), View::Plan).unwrap();
        assert!((depth - 0.5_f64.sqrt()).abs() < 1e-12, "{depth}");
    }

    #[test]
    fn a_vertical_line_has_no_sag_but_does_not_break() {
        let mut cable = parabola(0.0);
        cable.supports[1].x_m = 0.0;
        assert!(sag(&cable, View::Elevation).is_none_or(|(d, _)| d.is_finite()));
    }

    #[test]
    fn a_slack_cable_is_as_long_as_it_is_however_it_sags() {
        let mut cable = parabola(0.0);
        assert!((stretched_length(&cable, 1.0) - 1.0).abs() < 1e-12);
        for node in &mut cable.nodes {
            node.strain = 1e-3;
        }
        assert!((stretched_length(&cable, 1.002) - 1.002 * 1.001).abs() < 1e-12);
    }

    #[test]
    fn values_that_are_not_finite_are_passed_over() {
        let mut cable = parabola(0.0);
        cable.nodes[3].tension_n = f64::NAN;
        cable.nodes[4].tension_n = 7.0;
        assert_eq!(greatest(&cable, |n| n.tension_n).unwrap().0, 7.0);
        assert!(greatest(&CableSolution::default(), |n| n.tension_n).is_none());
    }
}
