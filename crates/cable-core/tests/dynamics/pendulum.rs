//! These tests swing pendulums: a mass on a light stiff cable at large amplitude, a mass on a heavy
//! cable at small ones.

use cable_core::Vec2;
use cable_core::scene::Support;

use super::measure::{G, behind, cable, climbs, energy, ladder, lump, masses, ring, sampled, started};

/// Period of a mathematical pendulum, s: 4√(L/g) K(sin θ₀/2) = 2π√(L/g)/agm(1, cos θ₀/2) (C. F.
/// Gauss).
pub fn period(length: f64, amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
    while a - b > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::TAU * (length / G).sqrt() / a
}

#[test]
#[ignore = "open: short cables are solved at another scale of time, where steps are finer than asked: no order to see; longer ones show 2.5"]
fn a_large_swing_takes_gausss_period() {
    // Shorter cables are solved at another scale of time.
    let (length, mass, ea, angle) = (3.2, 10.0, 1e8, std::f64::consts::FRAC_PI_3);
    let scene = cable([length, 1e-4, ea], 2, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)]);
    let exact = period(length, angle);
    let (mut errors, mut losses) = (Vec::new(), Vec::new());
    for steps in [960.0, 1920.0, 3840.0] {
        let mut sim = started(&scene, |state| {
            let strain = mass * G * angle.cos() / ea;
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                *p = Vec2::new(angle.sin(), -angle.cos()) * (s * (1.0 + strain));
            }
        });
        let start = energy(&scene, &sim.states()[0]);
        let h = exact / steps;
        let (mut turns, mut before, mut largest, mut t) = (Vec::new(), 1.0, 0.0f64, 0.0);
        while turns.len() < 5 {
            sim.step(h).unwrap();
            t += h;
            let x = sim.states()[0].position_m[2].x;
            if t > 0.2 * exact {
                largest = largest.max(sim.solution().cables[0].nodes[0].tension_n);
            }
            if before * x < 0.0 {
                turns.push(t - h * x / (x - before));
            }
            before = x;
        }
        // From the first to the fifth passage of the middle: two periods.
        errors.push((turns[4] - turns[0]) / (2.0 * exact) - 1.0);
        // At the bottom W(1 + v²/gL), v² = 2gL(1 − cos θ₀).
        let pull = largest / (mass * G * (3.0 - 2.0 * angle.cos())) - 1.0;
        let lost = (start - energy(&scene, &sim.states()[0])) / (mass * G * length * (1.0 - angle.cos()));
        println!("h {h:.5}: pull at the bottom off by {pull:.1e}, energy lost {lost:.1e}");
        assert!(pull.abs() < 5e-4, "h {h}: pull {pull}");
        losses.push(lost);
    }
    ladder("large pendulum", &errors, 2.0, 5e-4);
    // Most of it in the first step, which is implicit Euler's.
    ladder("large pendulum, energy lost in two periods", &losses, 2.15, 2.8e-3);
}

/// Lowest frequency of a mass M below a heavy cable, 1/s, and its shape at 400 even steps, by
/// shooting (T y')' + ρω²y = 0, T = g(M + ρ(L − s)), from y(0) = 0 to T y' = Mω²y at L with
/// Runge–Kutta 4 in (y, F = T y').
pub fn heavy_pendulum(length: f64, density: f64, mass: f64) -> (f64, Vec<f64>) {
    let miss = |omega: f64| {
        let n = 400;
        let h = length / f64::from(n);
        let slope =
            |s: f64, u: [f64; 2]| [u[1] / (G * (mass + density * (length - s))), -density * omega * omega * u[0]];
        let ahead = |u: [f64; 2], k: [f64; 2], h: f64| [u[0] + h * k[0], u[1] + h * k[1]];
        let (mut u, mut shape) = ([0.0, 1.0], vec![0.0]);
        for i in 0..n {
            let s = h * f64::from(i);
            let k1 = slope(s, u);
            let k2 = slope(s + 0.5 * h, ahead(u, k1, 0.5 * h));
            let k3 = slope(s + 0.5 * h, ahead(u, k2, 0.5 * h));
            let k4 = slope(s + h, ahead(u, k3, h));
            for j in 0..2 {
                u[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
            }
            shape.push(u[0]);
        }
        (u[1] - mass * omega * omega * u[0], shape)
    };
    let (mut a, mut b) = (0.5 * (G / length).sqrt(), 1.5 * (G / length).sqrt());
    assert!(miss(a).0 > 0.0 && miss(b).0 < 0.0);
    for _ in 0..60 {
        let c = 0.5 * (a + b);
        if miss(c).0 > 0.0 {
            a = c;
        } else {
            b = c;
        }
    }
    let shape = miss(a).1;
    let last = shape[shape.len() - 1];
    (a, shape.iter().map(|y| y / last).collect())
}

#[test]
fn a_mass_below_a_heavy_cable() {
    for (part, bound) in [(0.1, 2e-6), (1.0, 3e-5), (10.0, 4e-3)] {
        let (length, mass) = (10.0, 5.0);
        let density = part * mass / length;
        let (exact, shape) = heavy_pendulum(length, density, mass);
        let errors = [4, 8, 16].map(|n| {
            let supports = vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)];
            // It stretches by some parts of 1e-7.
            let scene = cable([length, density, 1e8], n, supports);
            let at = |k: usize| shape[k * 400 / n];
            let mut sim = started(&scene, |state| {
                for (k, p) in state.position_m.iter_mut().enumerate() {
                    p.x = 1e-3 * length * at(k);
                }
            });
            let mass = masses(&scene, &sim.states()[0]);
            let h = 1.0 / 240.0;
            let every = (std::f64::consts::TAU / exact / h / 5.0).round() as usize;
            let samples = sampled(&mut sim, (h, every), 60, |state| {
                state.position_m.iter().enumerate().map(|(k, p)| mass[k] * at(k) * p.x).sum()
            });
            behind(ring(&samples, h * every as f64), h).omega / exact - 1.0
        });
        let name = format!("mass below a cable of {part} of it");
        println!("{name}: {errors:?}");
        assert!(errors.iter().all(|e| e.abs() < bound), "{name}: {errors:?}");
        if part > 1.0 {
            // 16 bars are off by less than by what it stretches.
            climbs(&name, &errors[..2], 3.5, bound);
        }
    }
}
