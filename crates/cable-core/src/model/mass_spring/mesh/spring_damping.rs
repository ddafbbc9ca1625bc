//! This module computes the damping of the springs by their strain rate (Kelvin–Voigt) from the
//! damping ratio of the cable.

use crate::math::bounded;
use crate::model::mass_spring::settings::MeshTuning;
use crate::problem::Problem;

/// Damping ζ of the first axial mode, ω₁ = π/L·√(EA/ρ): strain-rate force EA·τ·ε̇ with τ = 2ζ/ω₁.
/// Mode k then has ζ_k = ζ·ω_k/ω₁, which for the fastest one is kept between
/// [`MeshTuning::min_mode_damping`] and [`MeshTuning::max_mode_damping`].
pub(super) fn damping_time(p: &Problem, tuning: &MeshTuning, rest: &[f64]) -> f64 {
    let c = (p.axial_stiffness / p.linear_density).sqrt();
    let first = std::f64::consts::PI / p.damped_length * c;
    let shortest = rest.iter().copied().fold(f64::INFINITY, f64::min);
    let fastest = 2.0 * c / shortest;
    let own = 2.0 * p.cable.damping_ratio / first;
    bounded(own, 2.0 * tuning.min_mode_damping / fastest, 2.0 * tuning.max_mode_damping / fastest)
}
