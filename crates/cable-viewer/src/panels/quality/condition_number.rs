//! The condition number of the stiffness matrix is estimated as that of a straight cable.

use cable_core::Cable;
use cable_core::solution::CableSolution;

/// The ratio of the stiffest to the softest way in which a straight cable of n equal elements of
/// length h under a tension T gives way: the eigenvalues of its stiffness matrix lie between
/// T/h·(2 − 2 cos π/n), all of it moving sideways, and EA/h·(2 + 2 cos π/n), neighbours moving
/// against each other along it. Bending and contact are not in it.
#[must_use]
pub fn condition_number(axial_stiffness_n: f64, tension_n: f64, elements: usize) -> f64 {
    let turn = (std::f64::consts::PI / elements.max(2) as f64).cos();
    axial_stiffness_n * (1.0 + turn) / (tension_n * (1.0 - turn))
}

/// The estimate for a cable under the mean tension of its answer; None without tension.
pub(super) fn estimated(cable: &Cable, solved: &CableSolution) -> Option<f64> {
    let tensions = || solved.nodes.iter().map(|n| n.tension_n).filter(|t| t.is_finite());
    let mean_n = tensions().sum::<f64>() / tensions().count().max(1) as f64;
    (mean_n > 0.0).then(|| condition_number(cable.axial_stiffness_n, mean_n, solved.nodes.len().saturating_sub(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two elements have one free node: along it gives way with 2EA/h, sideways with 2T/h.
    #[test]
    fn the_condition_of_few_elements_is_known_by_hand() {
        assert!((condition_number(1e6, 100.0, 2) - 1e4).abs() < 1e-6);
        // Three: eigenvalues of [2 −1; −1 2] are 1 and 3.
        assert!((condition_number(1e6, 100.0, 3) - 3e4).abs() < 1e-6);
        // Many: 4 n² EA / (π² T).
        let many = condition_number(1e6, 100.0, 1000);
        let expected = 4.0 * 1e6 * 1e4 / std::f64::consts::PI.powi(2);
        assert!((many / expected - 1.0).abs() < 1e-5, "{many} {expected}");
    }
}
