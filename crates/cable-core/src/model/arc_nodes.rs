//! This module chooses the number of nodes on an arc of an answer, so that the straight lines
//! between them represent the cable.
//!
//! A chord of an arc of radius r and turn φ comes inside it by its sagitta, r(1 − cos(φ/2)). With a
//! the greatest one allowed, φ ≤ 2 acos(1 − a/r) = 4 asin √(a/2r): the second form keeps its digits
//! where a ≪ r.

use crate::math::smaller;

/// Greatest sagitta, m. An answer promises 1 mm and 2 % of the cable's diameter; the rest is for
/// the errors of the ends of an arc, and for circles that are drawn as polygons. Larger: the nodes
/// of a cable appear inside a post. Smaller: the number of nodes grows as the inverse root without
/// visible effect.
const SAGITTA_M: f64 = 0.8e-3;
/// Greatest sagitta as a fraction of the cable's diameter.
const SAGITTA_DIAMETERS: f64 = 0.016;
/// Greatest turn between two nodes, rad: tension that grows as e^{μφ} leaves a straight line by
/// (μφ)²/8 of itself, 2e-3 at μ = 1. Larger: tension read between nodes is off by more; smaller:
/// small corners fill the answer.
const LONGEST_ARC_RAD: f64 = 0.13;
/// Maximum number of parts of one arc. Larger: a thin cable on a drum of kilometres fills the
/// memory; smaller: chords on such a drum cut it by more than is promised.
const MOST_PARTS: f64 = 8192.0;

fn sagitta_limit(cable_radius: f64) -> f64 {
    smaller(SAGITTA_M, 2.0 * SAGITTA_DIAMETERS * cable_radius)
}

/// Angle (rad) before its tangent point at which a straight line to the next node may leave an arc
/// of a radius (m): it comes inside by no more than the greatest sagitta.
pub(in crate::model) fn early_leave(radius: f64, cable_radius: f64) -> f64 {
    let sagitta = sagitta_limit(cable_radius);
    if radius > sagitta { 2.0 * (0.5 * sagitta / radius).sqrt().asin() } else { LONGEST_ARC_RAD }
}

/// Number of parts into which an arc of the centre line with a radius (m) and a turn (rad) is
/// divided, for a cable of a radius (m).
pub(in crate::model) fn parts(radius: f64, turn: f64, cable_radius: f64) -> usize {
    let sagitta = sagitta_limit(cable_radius);
    let most = if radius > sagitta {
        smaller(LONGEST_ARC_RAD, 4.0 * (0.5 * sagitta / radius).sqrt().asin())
    } else {
        LONGEST_ARC_RAD
    };
    let parts = if radius > 0.0 { (turn.abs() / most).ceil() } else { 1.0 };
    // NaN gives 1.
    if parts > MOST_PARTS {
        MOST_PARTS as usize
    } else if parts > 1.0 {
        parts as usize
    } else {
        1
    }
}

/// The fractions of the material of an arc that lie before each of its nodes but the first, for a
/// strain along it: where the strain is greater there is less material, ds ~ dφ/(1 + ε). Each part
/// is integrated by Simpson's rule.
pub(in crate::model) fn material(parts: usize, strain: impl Fn(f64) -> f64) -> Vec<f64> {
    let rate = |f: f64| 1.0 / (1.0 + strain(f));
    let step = 1.0 / parts as f64;
    let mut sum = 0.0;
    let mut out: Vec<f64> = (0..parts)
        .map(|i| {
            let [a, b] = [i, i + 1].map(|i| i as f64 * step);
            sum += rate(a) + 4.0 * rate(0.5 * (a + b)) + rate(b);
            sum
        })
        .collect();
    for share in &mut out {
        *share /= sum;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_come_inside_by_no_more_than_is_allowed_and_by_not_much_less() {
        for radius in [1e-4, 0.014, 0.16, 2.0, 300.0] {
            for cable_radius in [1e-4, 0.005, 0.014, 0.1] {
                for turn in [1e-3, 0.3, 3.0, 20.0] {
                    let count = parts(radius, turn, cable_radius);
                    if count as f64 >= MOST_PARTS {
                        continue;
                    }
                    let sagitta = |count: usize| radius * (1.0 - (0.5 * turn / count as f64).cos());
                    let allowed = (2.0 * SAGITTA_DIAMETERS * cable_radius).min(SAGITTA_M);
                    assert!(sagitta(count) <= allowed * (1.0 + 1e-6), "{radius} {cable_radius} {turn}");
                    let coarser =
                        count == 1 || turn / (count - 1) as f64 > LONGEST_ARC_RAD || sagitta(count - 1) > allowed;
                    assert!(coarser, "{radius} {cable_radius} {turn}: {count}");
                }
            }
        }
        assert_eq!((parts(1.0, f64::NAN, 0.01), parts(0.0, 1.0, 0.01)), (1, 1));
        assert_eq!(parts(1e4, 1e9, 1e-5), MOST_PARTS as usize);
    }

    #[test]
    fn there_is_less_material_where_it_is_strained() {
        assert_eq!(material(4, |_| 0.3), [0.25, 0.5, 0.75, 1.0]);
        // ∫ df/(1 + f) = ln(1 + f).
        let shares = material(8, |f| f);
        for (k, share) in shares.iter().enumerate() {
            let exact = (1.0 + (k + 1) as f64 / 8.0).ln() / 2f64.ln();
            assert!((share - exact).abs() < 1e-6, "{share} against {exact}");
        }
    }
}
