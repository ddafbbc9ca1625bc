//! This module models material damping with a constant loss factor: the same fraction of the energy
//! of stretching, and of that of bending, is lost in a cycle at every frequency.
//!
//! In parallel to the spring EA a bar has relaxation branches, each a spring EA y in series with a
//! dashpot of relaxation time θ (generalised Maxwell body: H. Emmerich, M. Korn, "Incorporation of
//! attenuation into time-domain computations of seismic wave fields", Geophysics 52(9), 1987; J.
//! Blanch, J. Robertsson, W. Symes, "Modeling of a constant Q: methodology and algorithm for an
//! efficient and optimally inexpensive viscoelastic technique", Geophysics 60(1), 1995):
//! ```text
//! T = EA ε + Σ q,   q̇ = −q/θ + EA y ε̇,   M(ω) = EA (1 + Σ y iωθ/(1 + iωθ)),   loss factor = Im M/Re M = 2ζ
//! ```
//! EA is the relaxed stiffness, that of slow motion. By causality a material with constant loss
//! factor stiffens with frequency, by (4ζ/π) ln(ω/ω₀) above the lowest frequency ω₀: at ζ = 0.02 by
//! 6 % a decade.
//!
//! If the strain is linear in time within a step, the branches have an exact solution, with d =
//! e^{−h/θ} and g = (1 − d) θ/h:
//! ```text
//! q = d q₀ + EA y g (ε − ε₀),   T = EA ε + C (ε − ε₀) + Q,   C = EA Σ y g,   Q = Σ d q₀
//! ```
//! This is a spring of stiffness C whose strain is measured from ε₀ − Q/C, the same form as the
//! viscous damping of a step.
//!
//! In bending EI takes the place of EA, the curvature ψ/l̄ that of the strain and a moment that of
//! the force.
//!
//! A bar of a flexible cable that goes slack buckles between its nodes. Its material keeps the
//! strain at which its tension ends and recovers from it (`fem/time/loss_memory.rs`), so that the
//! branches give back only energy that was put in. `mass_spring` has the same law in each spring
//! and bend (`mass_spring/mesh/relaxation_memory.rs`).
//!
//! In stretching a cable of `fem` that can rub has branches up to the frequency at which its
//! viscous loss, which keeps impacts resolved, is as great as the loss that is asked for. In
//! bending it has the loss that is asked for, and no other.

use crate::math::{bounded, smaller};
use crate::problem::Problem;

/// Least time constant of material damping, s, of a cable with possible friction. Without it a soft
/// cable (EA 1e5 N) shows 11 % of axial noise when it is dragged. A cable that can touch nothing
/// has only its own damping: this value would take a twelfth of the dynamic tension of a weight
/// that swings 9 times a second.
const MATERIAL_DAMPING: f64 = 1e-3;

/// Lowest frequency of constant loss, rad/s (0.1 Hz). Smaller: more branches, and a cable that
/// stiffens more; larger: slow swings have less loss.
const LOWEST_LOSS_FREQUENCY: f64 = 0.2 * std::f64::consts::PI;

/// Greatest ratio of the frequencies of neighbouring branches. Larger: the loss factor varies by
/// more than 5 % between them; smaller: more branches.
const MAX_FREQUENCY_RATIO: f64 = 10.0;

/// Damping ratio up to which loss is constant. With more the cable would stiffen manyfold (at 0.1
/// by 5 in four decades): the rest of the damping is viscous, with its ratio at the first axial
/// mode.
const CONSTANT_LOSS_RATIO_LIMIT: f64 = 0.1;

/// Greatest width of the band, decades. Smaller: the shortest bars of stiff cables ring with less
/// loss; larger: branches that no step resolves.
const MOST_DECADES: f64 = 9.0;

/// Rounds of the fit. Smaller: an error up to 1 % at the greatest ratio.
const ROUNDS: usize = 40;

/// A relaxation branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model) struct RelaxationBranch {
    /// Relaxation time θ, s.
    time: f64,
    /// Stiffness y as a fraction of EA or EI.
    part: f64,
}

impl RelaxationBranch {
    /// The values d and y g of a step of `h` (s).
    pub(in crate::model) fn in_step(&self, h: f64) -> [f64; 2] {
        let r = h / self.time;
        [(-r).exp(), self.part * -(-r).exp_m1() / r]
    }
}

/// The loss of a material in one kind of strain.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model) struct MaterialLoss {
    pub(in crate::model) branches: Vec<RelaxationBranch>,
    /// Time constant of the viscous part of the loss, s.
    pub(in crate::model) viscous: f64,
}

impl MaterialLoss {
    /// Stiffness of motion so fast that no branch relaxes, of that of slow motion: 1 + Σ y.
    pub(in crate::model) fn unrelaxed_ratio(&self) -> f64 {
        1.0 + self.branches.iter().map(|b| b.part).sum::<f64>()
    }
}

/// The loss of a cable's material.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model) struct Loss {
    /// That of a taut bar.
    pub(in crate::model) stretching: MaterialLoss,
    /// That of a bend.
    pub(in crate::model) bending: MaterialLoss,
}

/// Tells whether a cable can rub on anything, whose friction asks for damping in stretching.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model) enum Rubbing {
    Never,
    Possible,
}

impl Loss {
    /// The loss of a cable of even bars of length `bar` (m): constant up to their highest
    /// frequency, or, in stretching if it can rub, up to that at which the viscous loss is as
    /// great.
    pub(in crate::model) fn of(problem: &Problem, bar: f64, rubbing: Rubbing) -> Self {
        Self { stretching: stretching(problem, bar, rubbing), bending: bending(problem, bar) }
    }
}

/// The loss in stretching.
fn stretching(problem: &Problem, bar: f64, rubbing: Rubbing) -> MaterialLoss {
    let ratio = problem.cable.damping_ratio;
    let lowest = LOWEST_LOSS_FREQUENCY / problem.time_scale;
    let cutoff = 2.0 * (problem.axial_stiffness / problem.linear_density).sqrt() / bar;
    if !(ratio > 0.0 && cutoff.is_finite()) {
        return MaterialLoss::default();
    }
    let even = smaller(ratio, CONSTANT_LOSS_RATIO_LIMIT);
    if rubbing == Rubbing::Never {
        let viscous = damping_time(problem, rubbing) * (1.0 - even / ratio);
        return MaterialLoss { branches: fit(2.0 * even, 0.0, [lowest, cutoff]), viscous };
    }
    let viscous = damping_time(problem, rubbing);
    let highest = smaller(cutoff, 2.0 * even / viscous);
    let branches = if highest > lowest { fit(2.0 * even, viscous, [lowest, highest]) } else { Vec::new() };
    MaterialLoss { branches, viscous }
}

/// The loss in bending. The highest frequency at which bars of a length b bend is 4 √(EI/ρ)/b²,
/// where their nodes move to and fro in turn.
fn bending(problem: &Problem, bar: f64) -> MaterialLoss {
    let ratio = problem.cable.bending_damping();
    let lowest = LOWEST_LOSS_FREQUENCY / problem.time_scale;
    let cutoff = 4.0 * (problem.bending_stiffness / problem.linear_density).sqrt() / (bar * bar);
    if !(ratio > 0.0 && cutoff > 0.0 && cutoff.is_finite()) {
        return MaterialLoss::default();
    }
    let even = smaller(ratio, CONSTANT_LOSS_RATIO_LIMIT);
    let viscous = viscous_time(problem, ratio - even);
    MaterialLoss { branches: fit(2.0 * even, 0.0, [lowest, cutoff]), viscous }
}

/// Fits branches beside a viscous loss with a time constant `viscous` (s) to a loss factor from the
/// lowest to the highest frequency (rad/s).
///
/// They begin as those of a power law ω^γ, γ = (2/π) atan(loss factor). Then each is multiplied
/// repeatedly by the ratio of the wanted to the present loss factor at its own frequency, which
/// keeps them positive.
fn fit(factor: f64, viscous: f64, [lowest, highest]: [f64; 2]) -> Vec<RelaxationBranch> {
    let decades = bounded((highest / lowest).ln() / MAX_FREQUENCY_RATIO.ln(), 0.0, MOST_DECADES);
    let steps = if decades > 1.0 { decades.ceil() } else { 1.0 };
    let ratio = if decades > 0.0 { MAX_FREQUENCY_RATIO.powf(decades / steps) } else { MAX_FREQUENCY_RATIO };
    let power = std::f64::consts::FRAC_2_PI * factor.atan();
    let part = (std::f64::consts::PI * power).sin() / std::f64::consts::PI * ratio.ln();
    let mut branches: Vec<RelaxationBranch> = (0..=steps as i32)
        .map(|k| RelaxationBranch { time: 1.0 / (lowest * ratio.powi(k)), part: part * ratio.powi(k).powf(power) })
        .collect();
    for _ in 0..ROUNDS {
        let found: Vec<f64> = branches.iter().map(|b| loss_factor(&branches, viscous, 1.0 / b.time)).collect();
        for (b, found) in branches.iter_mut().zip(found) {
            b.part *= factor / found;
        }
    }
    branches
}

/// Im M/Re M at a frequency (rad/s).
fn loss_factor(branches: &[RelaxationBranch], viscous: f64, omega: f64) -> f64 {
    let (mut real, mut imaginary) = (1.0, viscous * omega);
    for b in branches {
        let r = omega * b.time;
        real += b.part * r * r / (1.0 + r * r);
        imaginary += b.part * r / (1.0 + r * r);
    }
    imaginary / real
}

/// Time constant of viscous damping in stretching, s: that of the damping ratio at the first axial
/// mode of the whole cable, and at least [`MATERIAL_DAMPING`] if it can rub. Taut bars of a cable
/// that cannot rub have relaxation branches instead, those of one that can have them beside it.
pub(in crate::model) fn damping_time(problem: &Problem, rubbing: Rubbing) -> f64 {
    let own = viscous_time(problem, problem.cable.damping_ratio);
    match rubbing {
        Rubbing::Never => own,
        Rubbing::Possible => MATERIAL_DAMPING.max(own),
    }
}

/// Time constant of a viscous loss with a damping ratio at the first axial mode of the whole cable,
/// s.
fn viscous_time(problem: &Problem, ratio: f64) -> f64 {
    let wave = (problem.axial_stiffness / problem.linear_density).sqrt();
    let first_mode = std::f64::consts::PI * wave / problem.damped_length;
    2.0 * ratio / first_mode
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test compares the least and the greatest loss factor over the band with the wanted one.
    #[test]
    fn the_loss_factor_is_constant_from_the_lowest_frequency_to_the_highest() {
        for (ratio, highest) in [(0.005, 20.0), (0.02, 1e4), (0.05, 1e6), (CONSTANT_LOSS_RATIO_LIMIT, 1e5)] {
            let branches = fit(2.0 * ratio, 0.0, [LOWEST_LOSS_FREQUENCY, highest]);
            for k in 0..=200 {
                let omega = LOWEST_LOSS_FREQUENCY * (highest / LOWEST_LOSS_FREQUENCY).powf(f64::from(k) / 200.0);
                let found = loss_factor(&branches, 0.0, omega) / (2.0 * ratio);
                assert!((0.92..1.09).contains(&found), "{ratio}, {omega} rad/s: {found} of what was asked");
            }
            assert!(branches.iter().all(|b| b.part > 0.0));
        }
    }

    /// The test sums the loss of branches and of a viscous part that has the wanted factor alone at
    /// the highest frequency.
    #[test]
    fn the_loss_factor_is_constant_up_to_where_the_viscous_loss_is_as_great() {
        for ratio in [0.002, 0.005, 0.02, 0.05, 0.1] {
            let viscous = MATERIAL_DAMPING;
            let highest = 2.0 * ratio / viscous;
            let branches = fit(2.0 * ratio, viscous, [LOWEST_LOSS_FREQUENCY, highest]);
            for k in 0..=200 {
                let omega = LOWEST_LOSS_FREQUENCY * (highest / LOWEST_LOSS_FREQUENCY).powf(f64::from(k) / 200.0);
                let found = loss_factor(&branches, viscous, omega) / (2.0 * ratio);
                assert!((0.8..1.3).contains(&found), "{ratio}, {omega} rad/s: {found} of what was asked");
            }
            assert!(branches.iter().all(|b| b.part >= 0.0));
        }
    }

    /// Cycles of strain with the exact update lose the energy that the loss factor gives.
    #[test]
    fn steps_lose_what_the_law_says() {
        let branches = fit(0.04, 0.0, [LOWEST_LOSS_FREQUENCY, 1e4]);
        for omega in [2.0f64, 30.0, 400.0] {
            let h = std::f64::consts::TAU / omega / 200.0;
            let mut q = vec![0.0; branches.len()];
            let (mut work, mut peak) = (0.0, 0.0f64);
            let at = |k: i32| (omega * h * f64::from(k)).sin();
            for k in 0..6000 {
                let before: f64 = q.iter().sum();
                for (q, b) in q.iter_mut().zip(&branches) {
                    let [decay, part] = b.in_step(h);
                    *q = *q * decay + part * (at(k + 1) - at(k));
                }
                let now: f64 = q.iter().sum();
                if k >= 5800 {
                    work += (at(k + 1) - at(k)) * (0.5 * (before + now));
                    peak = peak.max(now + at(k + 1));
                }
            }
            let real = 1.0
                + branches
                    .iter()
                    .map(|b| b.part * (omega * b.time).powi(2) / (1.0 + (omega * b.time).powi(2)))
                    .sum::<f64>();
            let found = work / (std::f64::consts::PI * real);
            assert!((found / 0.04 - 1.0).abs() < 0.07, "{omega} rad/s: {found}, peak {peak} of {real}");
        }
    }
}
