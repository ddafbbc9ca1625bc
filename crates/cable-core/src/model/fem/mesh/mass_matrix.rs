//! This module makes the mass matrix of straight bars, which is of fourth order in the frequencies
//! of free motion.
//!
//! The action of a chain with its mass in the nodes differs from that of the cable in the order h².
//! Insert the true motion x(s, t) into both: the trapezoidal sums of kinetic energy and weight are
//! off by h²/12 times the change of their slopes along each bar, and the bar is shorter than its
//! curve, |Δx|/h = |x'| + h² t·x‴/24. With the equation of motion F' = ρ (ẍ − g) and integration by
//! parts in s and t the difference, for any tension and material law, becomes
//! ```text
//! h²/24 { ∫ ρ |ẋ'|² ds + [ρ (ẋ·ẋ' + g·x')] }
//! ```
//! with the bracket taken over each stretch of even bars, because the cable may have an angle at
//! its ends. The action is stationary at the motion, so correcting the action to this order
//! corrects frequencies and support forces as well:
//! - the integral by the mean of the lumped and the consistent mass of every bar (a string's [1 10
//!   1]/12: G. L. Goudreau, R. L. Taylor, "Evaluation of numerical integration methods in
//!   elastodynamics", Computer Methods in Applied Mechanics and Engineering 2, 1973);
//! - the bracket by end weights, half of J. Gregory's for the trapezoidal rule: it is ½ d/ds of
//!   ρ|ẋ|² + 2 ρ g·x, so mass and weight are corrected alike. Gravity remains an acceleration, and
//!   the total mass is unchanged.
//!
//! End weights load the last two bars with p₁ hρẍ and p₂ hρẍ, p₁ = (3 + 2α)/48, p₂ = (1 + 2α)/48.
//! These bars yield by that force times h/T and add ½ h³ (p₁² + p₂²) |ρẍ|²/T to the action, which
//! with ρẍ = T x″ at the end is ½ h³ (p₁² + p₂²) ρ ẍ·x″. The weights with α, and −α/12 more of the
//! last bar's coupling, add −α/24 h³ ρ ẍ·x″ to those of α = 0. Both cancel if −α = 12 (p₁² + p₂²),
//! that is 8 α² + 208 α + 10 = 0.
//!
//! The matrix is diagonally dominant, so it is positive definite, and its band is as narrow as that
//! of the stiffness.

/// α, −13 + √167.75.
const END_WEIGHT_ALPHA: f64 = -0.048_166_153_011_381_5;

/// Fraction of a bar's mass that couples its nodes: 0 is lumped, 1/6 consistent.
const COUPLING_MASS_FRACTION: f64 = 1.0 / 12.0;

/// The kind of mass matrix of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassMatrix {
    /// All mass in the nodes.
    Lumped,
    /// Mass spread over the bars.
    Spread,
}

/// Difference of the mass matrix of a mesh from the lumped one; empty if there is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spread {
    /// Mass of a node beyond half of the bars beside it, as an arc length, m.
    pub more: Vec<f64>,
    /// Arc length (m) whose mass m couples the nodes of each bar: it adds −½ m |v₁ − v₂|² to the
    /// kinetic energy of the nodes.
    pub coupling: Vec<f64>,
}

impl Spread {
    /// The difference for successive stretches of `(number of bars, length of each)`.
    #[must_use]
    pub fn of(stretches: &[(usize, f64)]) -> Self {
        let bars = stretches.iter().map(|s| s.0).sum::<usize>();
        let mut this = Self { more: vec![0.0; bars + 1], coupling: Vec::with_capacity(bars) };
        for &(count, bar) in stretches {
            let first = this.coupling.len();
            this.coupling.resize(first + count, COUPLING_MASS_FRACTION * bar);
            // A single bar does not show how slopes change along it.
            if count > 1 {
                let last = first + count;
                this.end([first, first + 1, first + 2], first, bar);
                this.end([last, last - 1, last - 2], last - 1, bar);
            }
        }
        this
    }

    /// Adds the terms of an end of a stretch: its nodes from there on, and its last bar.
    fn end(&mut self, nodes: [usize; 3], last: usize, bar: f64) {
        let weights = [-(3.0 + 2.0 * END_WEIGHT_ALPHA), 4.0 + 4.0 * END_WEIGHT_ALPHA, -(1.0 + 2.0 * END_WEIGHT_ALPHA)];
        for (node, weight) in nodes.into_iter().zip(weights) {
            self.more[node] += weight * bar / 48.0;
        }
        self.coupling[last] = COUPLING_MASS_FRACTION * (1.0 - END_WEIGHT_ALPHA) * bar;
    }

    /// True if the mass is lumped.
    #[must_use]
    pub fn is_lumped(&self) -> bool {
        self.coupling.is_empty()
    }

    /// Makes the mass lumped, as for a mesh whose nodes come and go.
    pub fn clear(&mut self) {
        self.more.clear();
        self.coupling.clear();
    }

    /// Becomes a copy of `other`, reusing its memory where possible.
    pub fn copy_from(&mut self, other: &Self) {
        self.more.clone_from(&other.more);
        self.coupling.clone_from(&other.coupling);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Cholesky, DMatrix, DVector};

    /// Rows of the mass matrix of stretches, per density: diagonal and off-diagonal.
    fn rows(stretches: &[(usize, f64)]) -> (Vec<f64>, Vec<f64>) {
        let spread = Spread::of(stretches);
        let mut diagonal = spread.more.clone();
        let bars = stretches.iter().flat_map(|&(count, bar)| std::iter::repeat_n(bar, count));
        for (e, (bar, c)) in bars.zip(&spread.coupling).enumerate() {
            for k in [e, e + 1] {
                diagonal[k] += 0.5 * bar - c;
            }
        }
        (diagonal, spread.coupling)
    }

    #[test]
    fn the_whole_mass_stays_and_is_positive() {
        for stretches in
            [&[(1, 0.3)][..], &[(2, 0.3)], &[(3, 1.0)], &[(7, 0.2), (1, 1e-3), (2, 0.5)], &[(50, 0.2), (40, 0.21)]]
        {
            let (diagonal, beside) = rows(stretches);
            let whole: f64 = stretches.iter().map(|&(count, bar)| count as f64 * bar).sum();
            let sum = diagonal.iter().sum::<f64>() + 2.0 * beside.iter().sum::<f64>();
            assert!((sum / whole - 1.0).abs() < 1e-14, "{stretches:?}: {sum} of {whole}");
            for k in 0..diagonal.len() {
                let off = if k > 0 { beside[k - 1] } else { 0.0 } + beside.get(k).copied().unwrap_or(0.0);
                assert!(diagonal[k] > 2.0 * off, "{stretches:?}: node {k} has {} beside {off}", diagonal[k]);
            }
        }
    }

    /// ∫ f + h²/24 [f'] to the order h⁴: half way from the trapezoidal rule to Gregory's.
    #[test]
    fn weights_are_half_of_gregorys() {
        let off = |n: usize| {
            let bar = 1.0 / n as f64;
            let (diagonal, beside) = rows(&[(n, bar)]);
            let weight =
                |k: usize| diagonal[k] + if k > 0 { beside[k - 1] } else { 0.0 } + beside.get(k).unwrap_or(&0.0);
            let sum: f64 = (0..=n).map(|k| weight(k) * (2.0 * k as f64 * bar).exp()).sum();
            let rise = 2f64.exp() - 1.0;
            let exact = 0.5 * rise + bar * bar / 24.0 * 2.0 * rise;
            sum - exact
        };
        let (coarse, fine) = (off(20), off(40));
        assert!((coarse / fine).log2() > 2.9, "{coarse} {fine}");
    }

    /// The held end of a cable.
    #[derive(Clone, Copy, PartialEq)]
    enum Held {
        First,
        Both,
    }

    /// Frequencies of small motion across bars with the tension of each (or along them with EA),
    /// per √density, from the lowest on.
    fn frequencies(stretches: &[(usize, f64)], ends: Held, tension: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        let (diagonal, beside) = rows(stretches);
        let n = diagonal.len();
        let shares: Vec<f64> = (0..n)
            .map(|k| diagonal[k] + if k > 0 { beside[k - 1] } else { 0.0 } + beside.get(k).copied().unwrap_or(0.0))
            .collect();
        let bars: Vec<f64> = stretches.iter().flat_map(|&(count, bar)| std::iter::repeat_n(bar, count)).collect();
        let (mut mass, mut stiffness) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for (e, (t, bar)) in tension(&shares).iter().zip(&bars).enumerate() {
            (mass[(e, e + 1)], mass[(e + 1, e)]) = (beside[e], beside[e]);
            let k = t / bar;
            stiffness[(e, e)] += k;
            stiffness[(e + 1, e + 1)] += k;
            stiffness[(e, e + 1)] -= k;
            stiffness[(e + 1, e)] -= k;
        }
        mass.set_diagonal(&DVector::from_vec(diagonal));
        let free = if ends == Held::Both { n - 2 } else { n - 1 };
        let (mass, stiffness) = (mass.view((1, 1), (free, free)), stiffness.view((1, 1), (free, free)));
        let lower = Cholesky::new(mass.into_owned()).unwrap().l();
        let left = lower.solve_lower_triangular(&stiffness.into_owned()).unwrap();
        let whole = lower.solve_lower_triangular(&left.transpose()).unwrap();
        let mut squares: Vec<f64> = whole.symmetric_eigenvalues().iter().copied().collect();
        squares.sort_by(f64::total_cmp);
        squares.iter().map(|w| w.sqrt()).collect()
    }

    /// Checks the order of convergence, from each mesh to the next, of the `modes` (number and
    /// frequency) of a cable of length 1.
    fn orders(name: &str, modes: &[(usize, f64)], bars: [usize; 4], found: impl Fn(usize) -> Vec<f64>) {
        let found = bars.map(found);
        for &(mode, exact) in modes {
            let errors = [0, 1, 2, 3].map(|k| found[k][mode] / exact - 1.0);
            let orders = [0, 1, 2].map(|k| (errors[k] / errors[k + 1]).abs().log2());
            println!("{name}, mode {}: {errors:?} order {orders:.2?}", mode + 1);
            assert!(orders.iter().all(|o| *o >= 3.5), "{name}, mode {}: {errors:?} {orders:?}", mode + 1);
        }
    }

    /// Tension of a chain that hangs from its first node, g = 1.
    fn weight_below(shares: &[f64]) -> Vec<f64> {
        (1..shares.len()).map(|k| shares[k..].iter().sum()).collect()
    }

    fn even(n: usize) -> Vec<(usize, f64)> {
        vec![(n, 1.0 / n as f64)]
    }

    /// Two stretches; the bars of the second are half as long again as those of the first.
    fn uneven(n: usize) -> Vec<(usize, f64)> {
        let bar = 0.8 / n as f64;
        vec![(n / 2, bar), (n / 2, 1.5 * bar)]
    }

    /// Zeros of J₀, half of which are the frequencies of a hanging chain.
    const ZEROS: [f64; 3] = [2.404_825_557_695_773, 5.520_078_110_286_311, 8.653_727_912_911_013];

    #[test]
    fn frequencies_are_of_fourth_order() {
        let pi = std::f64::consts::PI;
        let pulled = |shares: &[f64]| vec![1.0; shares.len() - 1];
        let string: Vec<(usize, f64)> = (0..3).map(|k| (k, pi * (k as f64 + 1.0))).collect();
        let quarter: Vec<(usize, f64)> = (0..3).map(|k| (k, pi * (k as f64 + 0.5))).collect();
        let chain: Vec<(usize, f64)> = (0..3).map(|k| (k, 0.5 * ZEROS[k])).collect();
        orders("string or bar held at both ends", &string, [10, 20, 40, 80], |n| {
            frequencies(&even(n), Held::Both, pulled)
        });
        orders("bar with a free end", &quarter, [10, 20, 40, 80], |n| frequencies(&even(n), Held::First, pulled));
        orders("hanging chain", &chain[..2], [10, 20, 40, 80], |n| frequencies(&even(n), Held::First, weight_below));
        // With 10 bars there are three to a half wave.
        orders("hanging chain", &chain[2..], [20, 40, 80, 160], |n| frequencies(&even(n), Held::First, weight_below));
        orders("chain of two stretches", &chain[..2], [10, 20, 40, 80], |n| {
            frequencies(&uneven(n), Held::First, weight_below)
        });
        orders("string of two stretches", &string[..1], [10, 20, 40, 80], |n| {
            frequencies(&uneven(n), Held::Both, pulled)
        });
    }

    /// This is why the mean of lumped and consistent mass alone does not suffice.
    #[test]
    fn a_chain_of_50_bars_has_its_third_mode() {
        let off = frequencies(&even(50), Held::First, weight_below)[2] / (0.5 * ZEROS[2]) - 1.0;
        // Lumped −6.2e-3, consistent 1.8e-3, their mean −2.1e-3.
        assert!(off.abs() < 2e-4, "{off}");
    }
}
