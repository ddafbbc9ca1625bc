//! Waves along the cable run at c = √(EA/ρ), ρ and length unstretched; it swings at φ c/L, N bars at that to the order 1/N⁴. Damping with time constant τ takes ω²τ/2 of the amplitude a second.

use cable_core::scene::{Support, SupportKind};

use super::measure::{Ring, behind, cable, climbs, ladder, masses, ring, sampled, settled, started};

const LENGTH: f64 = 20.0;
const EA: f64 = 1e4;
const DENSITY: f64 = 1.0;
const SPEED: f64 = 100.0;

/// First axial swing between two fixed ends at step `h` (s).
fn swing(damping_ratio: f64, segments: usize, h: f64) -> Ring {
    let supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [1.02 * LENGTH, 0.0])];
    let mut scene = cable([LENGTH, DENSITY, EA], segments, supports);
    scene.environment.gravity_m_per_s2 = 0.0;
    scene.cables[0].damping_ratio = damping_ratio;
    let shape = |s: f64| (std::f64::consts::PI * s / LENGTH).sin();
    let mut sim = started(&scene, |state| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            p.x += 1e-2 * shape(*s);
        }
    });
    let mass = masses(&scene, &sim.states()[0]);
    let rest: Vec<f64> = (0..mass.len()).map(|i| 1.02 * LENGTH * i as f64 / segments as f64).collect();
    let every = (std::f64::consts::TAU / continuous() / h / 5.0).round() as usize;
    let samples = sampled(&mut sim, (h, every), 48, |state| {
        (0..mass.len()).map(|i| mass[i] * shape(state.arc_length_m[i]) * (state.position_m[i].x - rest[i])).sum()
    });
    ring(&samples, h * every as f64)
}

fn continuous() -> f64 {
    std::f64::consts::PI * SPEED / LENGTH
}

#[test]
fn it_swings_at_the_speed_of_its_wave() {
    let h = 1.0 / 3840.0;
    let errors = [8, 16, 32].map(|n| behind(swing(0.0, n, h), h).omega / continuous() - 1.0);
    climbs("axial swing", &errors, 3.5, 5e-4);
}

/// The other end pulled by a force: a quarter of a wave.
#[test]
fn its_free_end_swings_at_the_speed_of_its_wave_too() {
    let (h, omega) = (1.0 / 3840.0, 1.5 * continuous());
    let errors = [8, 16, 32].map(|n| {
        let end = Support { force_n: Some([200.0, 0.0]), ..Support::new("end", SupportKind::Load) };
        let mut scene = cable([LENGTH, DENSITY, EA], n, vec![Support::fixed("wall", [0.0, 0.0]), end]);
        scene.environment.gravity_m_per_s2 = 0.0;
        let shape = |s: f64| (1.5 * std::f64::consts::PI * s / LENGTH).sin();
        let mut sim = started(&scene, |state| {
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                p.x += 1e-2 * shape(*s);
            }
        });
        let mass = masses(&scene, &sim.states()[0]);
        let every = (std::f64::consts::TAU / omega / h / 5.0).round() as usize;
        let samples = sampled(&mut sim, (h, every), 48, |state| {
            (0..mass.len()).map(|i| mass[i] * shape(state.arc_length_m[i]) * state.position_m[i].x).sum()
        });
        behind(ring(&samples, h * every as f64), h).omega / omega - 1.0
    });
    climbs("axial swing of a free end", &errors, 3.5, 1e-3);
}

#[test]
fn it_rings_down_by_its_damping_ratio() {
    for ratio in [0.008f64, 0.02, 0.1] {
        let exact = Ring { omega: continuous() * (1.0 - ratio * ratio).sqrt(), decay: ratio * continuous() };
        let mut slow = Vec::new();
        for h in [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0] {
            let found = swing(ratio, 16, h);
            let off = [found.decay / exact.decay - 1.0, behind(found, h).decay / exact.decay - 1.0];
            println!("ratio {ratio}, h {h:.5}: decay off by {:.2e}, without the steps' {:.1e}", off[0], off[1]);
            assert!(off[0].abs() < 6e-3, "ratio {ratio}: decay {} instead of {}", found.decay, exact.decay);
            assert!(off[1].abs() < 3e-4, "ratio {ratio}: decay off by {}", off[1]);
            slow.push(1.0 - found.omega / behind(found, h).omega);
        }
        ladder(&format!("ring-down at {ratio}, frequency"), &slow, 2.0, 8e-4);
    }
}

#[test]
fn a_pull_arrives_after_length_over_speed() {
    // The end is pulled harder within 0.05 s: the wall feels twice the change, centred at L/c + 0.025 s.
    let rise = 0.05;
    for n in [50, 100, 200] {
        let end = Support {
            times_s: vec![0.0, rise],
            forces_n: vec![[500.0, 0.0], [600.0, 0.0]],
            ..Support::new("end", SupportKind::Load)
        };
        let mut scene = cable([LENGTH, DENSITY, EA], n, vec![Support::fixed("wall", [0.0, 0.0]), end]);
        scene.environment.gravity_m_per_s2 = 0.0;
        // A time constant of 1 ms: without it the ends of the ramp ring from bar to bar.
        scene.cables[0].damping_ratio = 0.5e-3 * continuous();
        let mut sim = settled(&scene, cable_core::Model::Fem);
        let h = 1.0 / (19.2 * n as f64);
        let (mut t, mut last) = (0.0, 500.0);
        let wall = |sim: &cable_core::Simulation| sim.solution().cables[0].supports[0].reaction_x_n;
        let arrived = loop {
            sim.step(h).unwrap();
            t += h;
            let now = wall(&sim);
            if now > 600.0 {
                break t - h * (now - 600.0) / (now - last);
            }
            last = now;
            assert!(t < 1.0, "it never arrived: {now}");
        };
        while t < LENGTH / SPEED + rise + 0.05 {
            sim.step(h).unwrap();
            t += h;
        }
        let late = arrived / (LENGTH / SPEED + 0.5 * rise) - 1.0;
        let doubled = wall(&sim) / 700.0 - 1.0;
        println!("{n} bars: arrives late by {late:.1e}, the wall feels twice the change to {doubled:.1e}");
        assert!(late.abs() < 1.3e-3 && doubled.abs() < 2e-5, "{n}: {late} {doubled}");
    }
}
