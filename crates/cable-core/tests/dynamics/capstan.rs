//! A pulley that rubs holds two weights as long as W₂/W₁ ≤ q = e^{μπ} (L. Euler 1769, J. A.
//! Eytelwein 1808). Pulled harder and harder on one side, W₂ + ft, it slips at t* = (qW₁ − W₂)/f,
//! and from there (m₂ + q m₁) ẍ = f (t − t*).

use cable_core::scene::Support;
use cable_core::{Model, Simulation};

use super::measure::{G, cable, lump, settled};

const FRICTION: f64 = 0.2;
const MASS: f64 = 5.0;
/// Growth of the pull, N/s.
const PULL: f64 = 80.0;

fn arc(sim: &Simulation) -> f64 {
    sim.solution().cables[0].supports[1].arc_length_m
}

#[test]
fn it_holds_up_to_eulers_ratio_and_slips_beyond() {
    let q = (FRICTION * std::f64::consts::PI).exp();
    let late = (q - 1.0) * MASS * G / PULL;
    for radius in [0.0, 0.2] {
        let wheel = if radius > 0.0 { radius - 0.005 } else { 0.0 };
        let pulley =
            Support { radius_m: Some(wheel), friction: Some(FRICTION), ..Support::pulley("pulley", [0.0, 0.0]) };
        let end = Support {
            times_s: vec![0.0, 10.0],
            forces_n: vec![[0.0, 0.0], [0.0, -10.0 * PULL]],
            force_n: None,
            ..lump("pulled", MASS)
        };
        let mut scene = cable([10.0, 1e-5, 1e6], 20, vec![lump("weight", MASS), pulley, end]);
        scene.cables[0].diameter_m = 0.01;
        scene.cables[0].route_m = vec![[-radius, -5.0], [0.0, radius], [radius, -5.0]];
        for h in [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0] {
            let mut sim = settled(&scene, Model::Fem);
            let (start, mut t, mut held) = (arc(&sim), 0.0, 0.0f64);
            while t < late + 0.5 {
                sim.step(h).unwrap();
                t += h;
                if t < 0.95 * late {
                    held = held.max((arc(&sim) - start).abs());
                }
            }
            let exact = PULL * (t - late).powi(3) / (6.0 * MASS * (1.0 + q));
            let found = start - arc(&sim);
            let off = found / exact - 1.0;
            println!("R {radius}, h {h:.5}: held to {held:.1e} m up to 0.95 t*, then {found:.5} m, off by {off:.1e}");
            assert!(held < 5e-6, "R {radius}: moved by {held} m while it holds");
            assert!(off.abs() < 1e-3, "R {radius}: {found} instead of {exact}");
        }
    }
}
