//! A weight that hangs over the edge of rough ground bounces on the part of the cable that hangs:
//! its swing dies as the damping ratio says, at ω = √(EA/(L M)) with a third of the part's mass
//! (Lord Rayleigh, "The theory of sound", 1877), and its energy never grows.

use cable_core::Simulation;
use cable_core::scene::{Obstacle, Shape, Support};
use cable_core::{Model, Settings};

use super::measure::{G, cable, lump, ring};

/// Length that hangs and length that lies, m.
const HANGS: f64 = 4.0;
const LIES: f64 = 4.0;
const MASS: f64 = 10.0;
const DENSITY: f64 = 0.2;

/// By what parts the bounce is faster than on the relaxed stiffness, and dies faster than asked.
fn bounces(segments: usize, ratio: f64, axial_stiffness: f64) -> [f64; 2] {
    let on_ground = [-LIES, 0.014 + 1e-4];
    let mut scene = cable(
        [HANGS + LIES, DENSITY, axial_stiffness],
        segments,
        vec![
            Support::fixed("anchor", on_ground),
            Support { force_n: Some([0.0, -0.02 * MASS * G]), ..lump("weight", MASS) },
        ],
    );
    let c = &mut scene.cables[0];
    c.damping_ratio = ratio;
    c.route_m = vec![on_ground, [0.014, 0.014], [0.014, -HANGS]];
    scene.obstacles = vec![Obstacle {
        name: "ground".to_owned(),
        shape: Shape::Terrain { points_m: vec![[-6.0, 0.0], [0.0, 0.0], [0.0, -20.0], [6.0, -20.0]] },
        friction: Some(0.9),
    }];
    let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, Settings::default()).unwrap();
    sim.settle().unwrap();
    // Before time runs an edit is of the scene at rest.
    sim.step(1e-3).unwrap();
    // The weight is a fiftieth lighter from now on.
    scene.cables[0].supports[1].force_n = Some([0.0, 0.0]);
    let mut sim = sim.with_scene(scene, Settings::default()).unwrap();
    let omega = (axial_stiffness / HANGS / (MASS + DENSITY * HANGS / 3.0)).sqrt();
    let h = std::f64::consts::TAU / omega / 100.0;
    let mut heights = Vec::new();
    for step in 0..1200 {
        if step % 20 == 0 {
            heights.push(sim.solution().cables[0].nodes.last().unwrap().y_m);
        }
        sim.step(h).unwrap();
    }
    // Five samples a swing, so six contain both ends of it.
    let swings: Vec<f64> = heights[1..]
        .chunks_exact(6)
        .map(|w| w.iter().copied().fold(f64::MIN, f64::max) - w.iter().copied().fold(f64::MAX, f64::min))
        .collect();
    assert!(swings.windows(2).all(|w| w[1] < 1.02 * w[0]), "a swing grows: {swings:?} m");
    let found = ring(&heights, 20.0 * h);
    println!("ω {:.3} of {omega:.3} rad/s, decay {:.4} of {:.4} 1/s", found.omega, found.decay, ratio * omega);
    [found.omega / omega - 1.0, found.decay / (ratio * found.omega) - 1.0]
}

/// The stiffness rises with the frequency as for a bar alone; up to 2ζ/(1 ms), above which the loss
/// of cables that rub is viscous, the loss is what is asked for within a fifth.
#[test]
fn a_weight_beyond_an_edge_bounces_down_by_its_damping_ratio() {
    for (ratio, axial_stiffness) in [(0.01, 5e3), (0.02, 2e4), (0.05, 2e4)] {
        for segments in [16, 64] {
            let [faster, dies_faster] = bounces(segments, ratio, axial_stiffness);
            println!("{segments} bars, ratio {ratio}: faster by {faster:.4}, dies by {dies_faster:.3} faster");
            assert!(dies_faster.abs() < 0.2, "{segments} bars, ratio {ratio}: {dies_faster}");
            assert!((0.0..4.0 * ratio).contains(&faster), "{segments} bars, ratio {ratio}: {faster}");
        }
    }
}
