//! A mass that falls by h before a cable of length L catches it pulls with T = W(1 + √(1 + 2hEA/(WL))); let go without a
//! fall, with 2W. (J.-V. Poncelet; S. Timoshenko, "Strength of materials", 1930.)
//!
//! With the model's damping the catch is M ẍ = W − k(x + τẋ), k = EA/L, x(0) = 0, ẋ(0) = √(2gh): with ω² = k/M,
//! ζ = ωτ/2, ω_d = ω√(1 − ζ²), x = W/k + e^{−ζωt}(A cos ω_d t + B sin ω_d t).

use cable_core::Vec2;
use cable_core::scene::Support;

use super::measure::{G, cable, lump, started};

/// kg.
pub const MASS: f64 = 100.0;
/// m.
pub const LENGTH: f64 = 10.0;
/// N.
pub const EA: f64 = 2e4;
/// Least time constant of material damping in the model, s.
const DAMPING_TIME: f64 = 1e-3;

/// Largest pull k·x of the damped catch, N.
fn damped(fall: f64) -> f64 {
    let (weight, k) = (MASS * G, EA / LENGTH);
    let omega = (k / MASS).sqrt();
    let zeta = 0.5 * omega * DAMPING_TIME;
    let turn = omega * (1.0 - zeta * zeta).sqrt();
    let a = -weight / k;
    let b = ((2.0 * G * fall).sqrt() + zeta * omega * a) / turn;
    let x = |t: f64| weight / k + (-zeta * omega * t).exp() * (a * (turn * t).cos() + b * (turn * t).sin());
    (0..200_000).map(|i| x(f64::from(i) * 1e-5)).fold(0.0, f64::max) * k
}

#[test]
fn it_pulls_as_the_energy_says() {
    for fall in [0.0, 0.5, 2.0] {
        let weight = MASS * G;
        let textbook = weight * (1.0 + (1.0 + 2.0 * fall * EA / (weight * LENGTH)).sqrt());
        let exact = damped(fall);
        assert!((exact / textbook - 1.0).abs() < 0.02, "{exact} {textbook}");
        let mut errors = Vec::new();
        for h in [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0] {
            let scene = cable([LENGTH, 1e-6, EA], 4, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", MASS)]);
            let mut sim = started(&scene, |state| {
                for k in 0..5 {
                    let s = state.arc_length_m[k];
                    state.position_m[k] = Vec2::new(0.0, -s);
                    state.velocity_m_per_s[k] = Vec2::new(0.0, -(2.0 * G * fall).sqrt() * s / LENGTH);
                }
            });
            // A parabola through the largest three: the peak lies between two steps.
            let mut pulls = [0.0; 3];
            let largest = loop {
                sim.step(h).unwrap();
                let at = -sim.states()[0].position_m[4].y / LENGTH - 1.0;
                pulls = [pulls[1], pulls[2], EA * at];
                if pulls[1] > pulls[0] && pulls[1] > pulls[2] {
                    let [a, b, c] = pulls;
                    break b + 0.125 * (c - a).powi(2) / (2.0 * b - a - c);
                }
            };
            println!("fall {fall}, h {h:.5}: {largest:.3} of {exact:.3} (textbook {textbook:.3})");
            errors.push(largest / exact - 1.0);
        }
        // Begun with an eighth of a step, errors of the second and third order are about as large.
        let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).abs().log2()).collect();
        println!("dropped by {fall} m: {errors:?}, order {orders:.2?}");
        assert!(orders.iter().all(|o| *o > 1.75), "{fall}: {errors:?}");
        for (error, most) in errors.iter().zip([1e-5, 2.5e-6, 6e-7]) {
            assert!(error.abs() < most, "{fall}: {errors:?}");
        }
    }
}
