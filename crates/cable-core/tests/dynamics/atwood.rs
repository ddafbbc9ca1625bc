//! These tests let two weights run over a frictionless pulley (G. Atwood, 1784), the rope's own
//! weight with it: with l₁, l₂ the hanging lengths and x what has run over, M ẍ = (m₂ − m₁ + ρ(l₂ −
//! l₁)) g, l₂ − l₁ = d + 2x, M = m₁ + m₂ + ρL, so
//! ```text x = c (cosh kt − 1),   c = (m₂ − m₁ + ρd)/2ρ,   k² = 2ρg/M ``` A wheel has no mass of
//! its own: with a radius it is the same.

use cable_core::Model;
use cable_core::scene::{Scene, Support};

use super::measure::{G, cable, lump, settled};

const LENGTH: f64 = 10.0;
const RELEASE: f64 = 0.1;

/// Weights (kg) hung over a pulley of radius `radius` (m, of the cable's centre line), held near
/// the lighter until `RELEASE`.
fn over_a_pulley([m1, m2]: [f64; 2], density: f64, (radius, friction): (f64, f64), segments: usize) -> Scene {
    let mut scene = cable([LENGTH, density, 1e8], segments, Vec::new());
    let c = &mut scene.cables[0];
    c.diameter_m = 0.01;
    let wheel = if radius > 0.0 { radius - 0.005 } else { 0.0 };
    let pulley = Support { radius_m: Some(wheel), friction: Some(friction), ..Support::pulley("pulley", [0.0, 0.0]) };
    let hold = Support { arc_length_m: Some(0.5), release_s: Some(RELEASE), ..Support::fixed("hold", [-radius, -4.5]) };
    c.supports = vec![lump("lighter", m1), hold, pulley, lump("heavier", m2)];
    scene
}

/// Returns how far the rope has run over the pulley `time` (s) after it was let go, and what it
/// should be; m.
fn run(radius: f64, density: f64, segments: usize, steps: u32) -> [f64; 2] {
    let [m1, m2] = [5.0, 5.5];
    let scene = over_a_pulley([m1, m2], density, (radius, 0.0), segments);
    let mut sim = settled(&scene, Model::Fem);
    let h = RELEASE / f64::from(steps);
    for _ in 0..steps {
        sim.step(h).unwrap();
    }
    let arc = |sim: &cable_core::Simulation| sim.solution().cables[0].supports[2].arc_length_m;
    let start = arc(&sim);
    for _ in 0..10 * steps {
        sim.step(h).unwrap();
    }
    let t = 10.0 * RELEASE;
    let mass = m1 + m2 + density * LENGTH;
    let k = (2.0 * density * G / mass).sqrt();
    let c = (m2 - m1 + density * (LENGTH - 2.0 * start)) / (2.0 * density);
    [start - arc(&sim), c * ((k * t).cosh() - 1.0)]
}

#[test]
fn two_weights_move_as_atwood_says() {
    for radius in [0.0, 0.2] {
        for density in [1e-3, 0.4] {
            let error = |segments, steps| {
                let [found, exact] = run(radius, density, segments, steps);
                found / exact - 1.0
            };
            let name = format!("Atwood, R {radius}, {density} kg/m");
            let errors = [24, 48, 96].map(|steps| error(20, steps));
            let shown: Vec<String> = errors.iter().map(|e| format!("{e:.1e}")).collect();
            println!("{name}: {} of the way after 1 s", shown.join(" "));
            for (e, most) in errors.iter().zip([1.6e-5, 1.8e-5, 6e-6]) {
                assert!(e.abs() < most, "{name}: {e}");
            }
            // Bars do not matter: the rope is straight on both sides.
            let errors = [10, 40].map(|segments| error(segments, 96));
            assert!(errors.iter().all(|e| e.abs() < 1.1e-5), "{name}: {errors:?}");
        }
    }
}
