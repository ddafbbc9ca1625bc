//! A slack weightless cable has no definite shape: an auxiliary weight gives it that of a very
//! light cable.

use crate::math::Vec2;
use crate::model::fem::free::element::Material;
use crate::model::fem::free::stations::StationLayout;
use crate::problem::Problem;

/// Auxiliary weight of a weightless cable without loads, as a fraction of EA: far below the strain
/// of round-off.
const UNLOADED_AUXILIARY_WEIGHT: f64 = 1e-18;
/// Auxiliary weight of a weightless cable, as a fraction of its loads: far below any tension of
/// interest.
const AUXILIARY_WEIGHT: f64 = 1e-12;
/// Smoothing tension as a fraction of the load, see [`Material::smoothing`]. It has an effect only
/// where the tension falls to it; at 1e-9 a fold at EA 1e9 closed to 1e-8 m only, because the force
/// had too few digits.
const SMOOTHING_TENSION_FRACTION: f64 = 1e-7;

/// The origin of the force per length of cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BodyForce {
    /// The cable's weight and wind.
    Own,
    /// A weightless cable was given an auxiliary weight.
    Auxiliary,
}

/// The values that the elements share, and the origin of their force per length.
pub(super) fn material_at(problem: &Problem, time: f64, layout: &StationLayout) -> (Material, BodyForce) {
    let mut body = problem.body_force(time);
    let loads: f64 = layout.stations.iter().map(|s| s.load.norm()).sum();
    let kind = if body.norm() > 0.0 { BodyForce::Own } else { BodyForce::Auxiliary };
    if kind == BodyForce::Auxiliary {
        let whole =
            if loads > 0.0 { AUXILIARY_WEIGHT * loads } else { UNLOADED_AUXILIARY_WEIGHT * problem.axial_stiffness };
        body = Vec2::new(0.0, -whole / problem.length);
    }
    let material = Material {
        axial_stiffness: problem.axial_stiffness,
        thermal_stretch: problem.thermal_stretch,
        body,
        smoothing: SMOOTHING_TENSION_FRACTION * (body.norm() * problem.length + loads),
    };
    (material, kind)
}
