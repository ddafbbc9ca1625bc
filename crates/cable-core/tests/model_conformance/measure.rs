//! This file holds scenes and measures that several laws share.

use cable_core::scene::{Scene, Support, SupportKind, catalog};
use cable_core::solution::Solution;
use cable_core::{Error, Model, Simulation};

/// A display frame, s.
pub(crate) const FRAME_S: f64 = 1.0 / 60.0;

/// A flexible span of 12 m between two points.
pub(crate) fn span(left: [f64; 2], right: [f64; 2]) -> Scene {
    let mut scene = catalog::hanging_span();
    let c = &mut scene.cables[0];
    c.axial_stiffness_n = 1e5;
    c.bending_stiffness_n_m2 = 0.0;
    c.length_m = 12.0;
    c.supports = vec![Support::fixed("left", left), Support::fixed("right", right)];
    scene
}

/// The span that most laws of rest are asked of.
pub(crate) fn base() -> Scene {
    span([0.0, 5.0], [10.0, 4.0])
}

/// A support that pulls with a dead force, N.
pub(crate) fn dead_load(name: &str, force_n: [f64; 2]) -> Support {
    Support { force_n: Some(force_n), ..Support::new(name, SupportKind::Load) }
}

/// The weight of the cable, N.
pub(crate) fn weight_n(scene: &Scene) -> f64 {
    let cable = &scene.cables[0];
    cable.length_m * cable.linear_density_kg_per_m * scene.environment.gravity_m_per_s2
}

pub(crate) fn settle(scene: &Scene, model: Model) -> Result<Solution, Error> {
    Ok(Simulation::new(scene.clone(), model)?.settle()?)
}

/// The sum of the cable's forces on its supports, N.
pub(crate) fn reactions_n(s: &Solution) -> [f64; 2] {
    let all = &s.cables[0].supports;
    [all.iter().map(|r| r.reaction_x_n).sum(), all.iter().map(|r| r.reaction_y_n).sum()]
}

/// Returns whether two things differ, as an error.
pub(crate) fn difference<T: PartialEq>(a: &T, b: &T) -> f64 {
    f64::from(u8::from(a != b))
}

/// The larger of two numbers; not a number if the second is not.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
