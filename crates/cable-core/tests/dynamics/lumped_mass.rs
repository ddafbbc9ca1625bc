//! A lump M at the end of a cable swings along it at ω = β c/L with β tan β = ρL/M, c = √(EA/ρ)
//! (Lord Rayleigh, "The theory of sound", 1877).

use cable_core::scene::Support;

use super::measure::{behind, cable, climbs, lump, masses, ring, sampled, started};

const LENGTH: f64 = 20.0;
const EA: f64 = 1e4;

/// Smallest root of β tan β = r.
fn root(r: f64) -> f64 {
    let (mut a, mut b) = (0.0, 0.5 * std::f64::consts::PI);
    for _ in 0..80 {
        let c = 0.5 * (a + b);
        if c * c.sin() < r * c.cos() {
            a = c;
        } else {
            b = c;
        }
    }
    0.5 * (a + b)
}

#[test]
fn a_lump_slows_the_axial_swing() {
    for (mass, bound) in [(2.0, 1e-3), (20.0, 1e-3), (200.0, 1e-4)] {
        let beta = root(LENGTH / mass);
        let omega = beta * 100.0 / LENGTH;
        let errors = [4, 8, 16].map(|n| {
            let end = Support { force_n: Some([500.0, 0.0]), ..lump("lump", mass) };
            let mut scene = cable([LENGTH, 1.0, EA], n, vec![Support::fixed("wall", [0.0, 0.0]), end]);
            scene.environment.gravity_m_per_s2 = 0.0;
            let shape = |s: f64| (beta * s / LENGTH).sin();
            let mut sim = started(&scene, |state| {
                for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                    p.x += 0.1 * shape(*s);
                }
            });
            let mass = masses(&scene, &sim.states()[0]);
            let h = 1.0 / 480.0;
            let every = (std::f64::consts::TAU / omega / h / 5.0).round() as usize;
            let samples = sampled(&mut sim, (h, every), 40, |state| {
                (0..mass.len()).map(|k| mass[k] * shape(state.arc_length_m[k]) * state.position_m[k].x).sum()
            });
            behind(ring(&samples, h * every as f64), h).omega / omega - 1.0
        });
        climbs(&format!("lump of {mass} kg on 20 kg of cable"), &errors, 3.5, bound);
    }
}
