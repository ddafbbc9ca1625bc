//! A weightless cable has no shape of its own where it is slack: a hint of weight gives it that of
//! a very light one.

use crate::math::Vec2;
use crate::model::fem::free::element::Material;
use crate::model::fem::free::stations::StationLayout;
use crate::problem::Problem;

/// Weight given to a weightless cable without loads, in parts of EA: far below the strain that
/// rounding hides.
const UNLOADED_AUXILIARY_WEIGHT: f64 = 1e-18;
/// Weight given to a weightless cable, in parts of its loads: where it is slack it has no shape
/// of its own, this gives it that of a very light one. Far below any tension asked for.
const AUXILIARY_WEIGHT: f64 = 1e-12;
/// Smoothing tension in parts of the load, see [`Material::smoothing`]. Seen only where the tension
/// falls to it; at 1e-9 a fold at EA 1e9 closed to 1e-8 m only, for want of digits of the force.
const SMOOTHING: f64 = 1e-7;
/// Values that the elements share, and true if a weightless cable was given a hint of weight.
pub(super) fn material_at(problem: &Problem, time: f64, layout: &StationLayout) -> (Material, bool) {
    let mut body = problem.body_force(time);
    let loads: f64 = layout.stations.iter().map(|s| s.load.norm()).sum();
    let has_auxiliary_weight = !(body.norm() > 0.0);
    if has_auxiliary_weight {
        let whole =
            if loads > 0.0 { AUXILIARY_WEIGHT * loads } else { UNLOADED_AUXILIARY_WEIGHT * problem.axial_stiffness };
        body = Vec2::new(0.0, -whole / problem.length);
    }
    let material = Material {
        axial_stiffness: problem.axial_stiffness,
        thermal_stretch: problem.thermal_stretch,
        body,
        smoothing: SMOOTHING * (body.norm() * problem.length + loads),
    };
    (material, has_auxiliary_weight)
}
