//! A mass that falls by h before a cable of length L catches it pulls with T = W(1 + √(1 +
//! 2hEA/(WL))); let go without a fall, with 2W. (J.-V. Poncelet; S. Timoshenko, "Strength of
//! materials", 1930.)

use cable_core::scene::Support;
use cable_core::{Model, Vec2};

use super::measure::{G, cable, lump, settled, started};

/// kg.
pub const MASS: f64 = 100.0;
/// m.
pub const LENGTH: f64 = 10.0;
/// N.
pub const EA: f64 = 2e4;

#[test]
fn it_pulls_as_the_energy_says() {
    for fall in [0.0, 0.5, 2.0] {
        let weight = MASS * G;
        let exact = weight * (1.0 + (1.0 + 2.0 * fall * EA / (weight * LENGTH)).sqrt());
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
            println!("fall {fall}, h {h:.5}: {largest:.3} of {exact:.3}");
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

/// Let go beside its slack cable, which hangs in a fold in the same line, it falls past it and is
/// caught.
#[test]
fn it_falls_past_its_slack_cable() {
    let (mass, length, ea) = (10.0, 5.0, 2e4);
    for held in [0.9, 0.95, 0.99] {
        // It hangs from what is let go by a thousandth of the cable.
        let beside = 1e-3 * length;
        let weight = Support { arc_length_m: Some(length - beside), ..lump("mass", mass) };
        let hold = Support { release_s: Some(0.02), ..Support::fixed("hold", [0.0, -held * length]) };
        let mut scene = cable([length, 2e-3, ea], 60, vec![Support::fixed("top", [0.0, 0.0]), weight, hold]);
        scene.environment.gravity_m_per_s2 = G;
        let (pull, fall) = (mass * G, (1.0 - held) * length - 2.0 * beside);
        let exact = pull * (1.0 + (1.0 + 2.0 * fall * ea / (pull * (length - beside))).sqrt());
        let mut sim = settled(&scene, Model::Fem);
        let mut largest = 0.0;
        for _ in 0..600 {
            sim.step(1e-3).unwrap();
            let pull = -sim.solution().cables[0].supports[0].reaction_y_n;
            largest = if pull > largest { pull } else { largest };
        }
        let off = largest / exact - 1.0;
        println!("held at {held} of the length: pulls with {largest:.2} of {exact:.2} N, off by {off:.1e}");
        assert!(off.abs() < 0.01, "held at {held}: {largest} instead of {exact}");
    }
}
