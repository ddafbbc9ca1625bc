//! Named scenes used by tests, benches, examples and the viewer alike (placeholder list).

use super::{Cable, Environment, Scene, Support, View};

/// A cable between two points, sagging freely.
#[must_use]
pub fn hanging_span() -> Scene {
    Scene {
        version: super::VERSION,
        name: "Hanging span".to_owned(),
        view: View::Elevation,
        environment: Environment::default(),
        cables: vec![Cable {
            name: "cable".to_owned(),
            preset: None,
            length_m: 12.0,
            linear_density_kg_per_m: 1.246,
            axial_stiffness_n: 2.0e6,
            bending_stiffness_n_m2: 0.0,
            diameter_m: 0.028,
            damping_ratio: 0.02,
            thermal_expansion_per_k: 1.7e-5,
            service_tension_n: 800.0,
            breaking_tension_n: 10_000.0,
            min_bend_radius_m: 0.14,
            friction: 0.5,
            segments: None,
            self_contact: false,
            route_m: Vec::new(),
            supports: vec![Support::fixed("left", [0.0, 5.0]), Support::fixed("right", [10.0, 5.0])],
        }],
        obstacles: Vec::new(),
        loads: Vec::new(),
        robot: None,
    }
}

/// Every catalogue scene, in the order a picker shows them: short id, scene.
#[must_use]
pub fn all() -> Vec<(&'static str, Scene)> {
    vec![("hanging-span", hanging_span())]
}
