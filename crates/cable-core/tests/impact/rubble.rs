//! This scene lets a cable fall 2 m on rough ground.

use cable_core::scene::Shape;
use cable_core::scene::{Scene, catalog};
use cable_core::{Model, Settings, Simulation, Vec2};

use super::explicit_chain::Chain;
use super::peaks::{Tensions, spread};

/// The time when both ends let go, s. Until then it hangs still.
const RELEASE_S: f64 = 0.025;

/// Loss time of a cable that may rub, s.
pub const LOSS_TIME: f64 = 1e-3;

/// Time for which it is followed after the release, s.
pub const FOLLOWED_S: f64 = 2.0;

/// From when on it lies, s after the release.
pub const LIES_FROM_S: f64 = 1.5;

/// The scene, moved aside by `aside` (m), cut into so many bars, with bending stiffness EI (N m²).
/// Nothing breaks.
pub fn scene(segments: usize, aside: f64, bending: f64) -> Scene {
    let mut scene = catalog::rubble_drop();
    let cable = &mut scene.cables[0];
    cable.segments = Some(segments);
    cable.bending_stiffness_n_m2 = bending;
    cable.breaking_tension_n = 1e12;
    for s in &mut cable.supports {
        s.release_s = Some(RELEASE_S);
        if let Some(at) = &mut s.at_m {
            at[0] += aside;
        }
    }
    scene
}

/// Shifts of so many perturbed starts, m: whole millimetres, so that nodes of any mesh strike other
/// places of the ground.
pub fn shifts(count: usize) -> Vec<f64> {
    (0..count).map(|k| 1e-3 * k as f64).collect()
}

/// Tensions of the drop by `fem` in steps of `step_s`.
pub fn by_fem(scene: &Scene, step_s: f64) -> Tensions {
    let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, Settings::default()).expect("a sound scene");
    sim.settle().expect("it hangs");
    let length = scene.cables[0].length_m;
    let mut rows = Vec::new();
    let steps = ((RELEASE_S + FOLLOWED_S) / step_s).round() as usize;
    for _ in 0..steps {
        sim.step(step_s).expect("it falls");
        let nodes = &sim.solution().cables[0].nodes;
        let (s, t): (Vec<f64>, Vec<f64>) = nodes.iter().map(|n| (n.arc_length_m, n.tension_n)).unzip();
        if sim.time_s() > RELEASE_S {
            rows.push(spread(length, &s, &t));
        }
    }
    Tensions { step_s, rows }
}

/// Tensions of the drop by the explicit chain in steps of a part of the stable one, read every 1e-4
/// s.
pub fn by_chain(scene: &Scene, part: f64, contact: f64) -> Tensions {
    let cable = &scene.cables[0];
    let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, Settings::default()).expect("a sound scene");
    let start = sim.settle().expect("it hangs");
    // The nodes of a stiff rest are not even.
    let bars = cable.segments.expect("it is cut into bars");
    let at = |k: usize| start.cables[0].position_at(cable.length_m * k as f64 / bars as f64);
    let x: Vec<Vec2> = (0..=bars).map(|k| at(k).expect("it is on the cable")).collect();
    let Shape::Terrain { points_m } = &scene.obstacles[0].shape else { panic!("rubble is terrain") };
    let chain = Chain {
        density: cable.linear_density_kg_per_m,
        stiffness: cable.axial_stiffness_n,
        bending: cable.bending_stiffness_n_m2,
        // The loss factor is twice the damping ratio.
        bending_loss: 2.0 * cable.bending_damping(),
        loss_time: LOSS_TIME,
        radius: 0.5 * cable.diameter_m,
        friction: scene.obstacles[0].friction.expect("rubble rubs"),
        ground: points_m.iter().map(|p| Vec2::new(p[0], p[1])).collect(),
        contact,
        ..Chain::figures()
    };
    let mut chain = chain.laid(cable.length_m, x);
    let every_s = 1e-4;
    let count = (every_s / (part * chain.stable_step())).ceil();
    let h = every_s / count;
    let mut rows = Vec::new();
    let middles: Vec<f64> = (0..chain.tension.len()).map(|e| (e as f64 + 0.5) * chain.bar).collect();
    for _ in 0..(FOLLOWED_S / every_s).round() as usize {
        for _ in 0..count as usize {
            chain.step(h);
        }
        rows.push(spread(cable.length_m, &middles, &chain.tension));
    }
    Tensions { step_s: every_s, rows }
}
