//! An undamped swing loses what the steps take in 100 periods: steps take (1 − 2β) ω⁴h³/4 of its
//! amplitude a second and nothing else does (a light stiff cable stretches too little for its
//! damping to matter), so of its energy 1 − e^{−50 (1 − 2β) ω⁴h³ · 2π/ω}.

use cable_core::Vec2;
use cable_core::scene::Support;

use super::measure::{G, cable, damps, lump, spread_energy, started};

/// Length of the pendulum, m: shorter cables are solved at another scale of time.
const LENGTH: f64 = 4.0;

/// Part of its energy that a pendulum loses in 100 periods at step `h` (s).
fn lost(h: f64) -> f64 {
    let (length, mass, angle) = (LENGTH, 10.0, 0.1f64);
    let scene = cable([length, 1e-4, 1e7], 2, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)]);
    let mut sim = started(&scene, |state| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            *p = Vec2::new(angle.sin(), -angle.cos()) * (s * (1.0 + mass * G * angle.cos() / 1e7));
        }
    });
    // The first step is implicit Euler's, and the pull rings for some more: what counts begins
    // after them.
    for _ in 0..40 {
        sim.step(h).unwrap();
    }
    let lowest = -mass * G * length;
    let start = spread_energy(&scene, &sim.states()[0]) - lowest;
    let steps = (100.0 * std::f64::consts::TAU * (length / G).sqrt() / h).round() as usize;
    for _ in 0..steps {
        sim.step(h).unwrap();
    }
    1.0 - (spread_energy(&scene, &sim.states()[0]) - lowest) / start
}

#[test]
fn an_undamped_swing_loses_what_the_scheme_takes() {
    let omega = (G / LENGTH).sqrt();
    let time = 100.0 * std::f64::consts::TAU / omega;
    for h in [1.0 / 240.0, 1.0 / 480.0] {
        let theory = 1.0 - (-2.0 * damps(omega, h) * time).exp();
        let found = lost(h);
        println!("h {h:.5}: {found:.3e} of the energy lost in 100 periods, theory {theory:.3e}");
        // The imbalance is some 1e-7 a period; BDF2 alone would have 25 times the theory's loss,
        // 8.7e-5 and 1.1e-5.
        assert!((found - theory).abs() < 1e-6, "{found} instead of {theory}");
    }
}
