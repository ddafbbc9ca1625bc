//! The benches and the charts share this: the grid of spans, and scenes brought to a model and a
//! mesh.

pub mod chart;
pub mod compare;
pub mod dots;
pub mod explicit;
pub mod machine;
pub mod maps;
pub mod motion;
pub mod ridges;
pub mod table;

use cable_core::catenary::Span;
use cable_core::math::vec2;
use cable_core::{Model, Scene, Settings, Simulation, Vec2};

/// Weight of the grid's spans, N/m.
const GRID_WEIGHT_N_PER_M: f64 = 10.0;

/// Level, inclined, steep, vertical, falling, reversed and folded spans × slack × stiffness: 150 of
/// them.
#[must_use]
pub fn span_grid() -> Vec<Span> {
    let shapes = [(100.0, 0.0), (100.0, 50.0), (1.0, 100.0), (0.0, 100.0), (100.0, -50.0), (-30.0, 40.0)];
    let mut out = Vec::new();
    for (x, y) in shapes {
        for ratio in [0.9, 1.0, 1.0001, 1.01, 1.5, 100.0] {
            for axial_stiffness in [1e3, 1e5, 1e7, 1e9] {
                let chord = Vec2::new(x, y);
                out.push(Span {
                    chord,
                    length: ratio * chord.norm(),
                    weight: Vec2::new(0.0, -GRID_WEIGHT_N_PER_M),
                    axial_stiffness,
                    thermal_stretch: 1.0,
                });
            }
        }
    }
    // Coincident ends have no chord to scale by.
    for length in [1.0, 100.0, 1000.0] {
        for axial_stiffness in [1e4, 1e6] {
            let weight = Vec2::new(0.0, -GRID_WEIGHT_N_PER_M);
            out.push(Span { chord: Vec2::zeros(), length, weight, axial_stiffness, thermal_stretch: 1.0 });
        }
    }
    out
}

/// The span of a scene of one cable between two supports at fixed places, whatever else is in it;
/// None of any other scene.
#[must_use]
pub fn span_of(scene: &Scene) -> Option<Span> {
    let [cable] = scene.cables.as_slice() else { return None };
    let [a, b] = cable.supports.as_slice() else { return None };
    let weight = cable.linear_density_kg_per_m * scene.environment.gravity_m_per_s2;
    Some(Span {
        chord: vec2(b.at_m?) - vec2(a.at_m?),
        length: cable.length_m,
        weight: vec2(scene.environment.wind_n_per_m) - Vec2::y() * weight,
        axial_stiffness: cable.axial_stiffness_n,
        thermal_stretch: 1.0 + cable.thermal_expansion_per_k * scene.environment.temperature_change_k,
    })
}

/// A simulation of a scene by a model at `segments` elements a cable, at rest. None, with a line on
/// stderr, where the model cannot answer the scene.
#[must_use]
pub fn settled(scene: &Scene, model: Model, segments: Option<usize>) -> Option<Simulation> {
    let mut simulation = fresh(scene, model, segments)?;
    match simulation.settle() {
        Ok(_) => Some(simulation),
        Err(e) => {
            eprintln!("skipped: {model} on \"{}\": {e}", scene.name);
            None
        }
    }
}

/// As [`settled`], at its first route. It seeks no other friction histories once it rests: a cost
/// is that of the answer alone.
#[must_use]
pub fn fresh(scene: &Scene, model: Model, segments: Option<usize>) -> Option<Simulation> {
    let settings = Settings { segments, histories: false, ..Settings::default() };
    match Simulation::with_settings(scene.clone(), model, settings) {
        Ok(s) => Some(s),
        Err(e) => {
            eprintln!("skipped: {model} on \"{}\": {e}", scene.name);
            None
        }
    }
}
