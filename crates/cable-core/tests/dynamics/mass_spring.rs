//! The same references are asked of `mass-spring`, stepped explicitly.
//!
//! In space a chain of springs swings at the frequencies of as many linear bars: second order. In
//! time the leapfrog is symplectic: at sub-step h it swings (ωh)²/24 too fast and damps nothing, so
//! what a swing loses is its axial damping alone, and paths are off by the second power of h;
//! velocities belong to half a sub-step earlier. Sub-steps are bounded by the stable step, so
//! ladders in time begin below it.

use cable_core::model::Stepping;
use cable_core::scene::{Scene, Support, SupportKind};
use cable_core::state::State;
use cable_core::{Model, Settings, Simulation, Vec2};

use super::hanging_chain::{ZEROS, j0};
use super::linked_rods::Rods;
use super::measure::{G, cable, energy, ladder, lump, masses, ring, sampled};
use super::pendulum::{heavy_pendulum, period};
use super::{dropped_mass, taut_string};

fn settled(scene: &Scene) -> Simulation {
    let settings = Settings { stepping: Stepping::Explicit, ..Settings::default() };
    let mut sim = Simulation::with_settings(scene.clone(), Model::MassSpring, settings).unwrap();
    sim.settle().unwrap();
    sim
}

/// A motion from the resting place as `change` changes it.
pub fn started(scene: &Scene, change: impl FnOnce(&mut State)) -> Simulation {
    let mut sim = settled(scene);
    let mut states = sim.states();
    states[0].velocity_m_per_s.fill(Vec2::zeros());
    change(&mut states[0]);
    sim.set_states(&states).unwrap();
    sim
}

#[test]
fn a_hanging_chain_swings_at_the_zeros_of_bessels_function() {
    let length = 10.0;
    let supports = || vec![Support::fixed("top", [0.0, 0.0]), Support::new("end", SupportKind::Free)];
    for (k, bound) in [7.5e-4, 1e-2, 3.8e-2].into_iter().enumerate() {
        let exact = 0.5 * ZEROS[k] * (G / length).sqrt();
        let shape = |s: f64| j0(ZEROS[k] * (1.0 - s / length).max(0.0).sqrt());
        let errors = [20, 40, 80].map(|n| {
            let scene = cable([length, 1.0, 3e6], n, supports());
            let mut sim = started(&scene, |state| {
                for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                    // Small: bent, it is longer, and nothing but that would damp its axial swings.
                    p.x = 1e-4 * length * shape(*s);
                }
            });
            let mass = masses(&scene, &sim.states()[0]);
            let dt = std::f64::consts::TAU / exact / 5.0;
            let samples = sampled(&mut sim, (dt, 1), 24, |state| {
                (0..mass.len()).map(|i| mass[i] * shape(state.arc_length_m[i]) * state.position_m[i].x).sum()
            });
            ring(&samples, dt).omega / exact - 1.0
        });
        ladder(&format!("mass-spring, hanging chain, mode {}", k + 1), &errors, 2.0, bound);
    }
}

/// The frequency is Lagrange's for as many masses, to the (ωh)²/24 of the scheme.
#[test]
fn a_taut_string_swings_at_lagranges_frequencies() {
    for k in [1, 2, 3] {
        let errors = [8, 16, 32].map(|n| {
            let scene = taut_string::scene(0.0, n);
            let shape = |s: f64| (k as f64 * std::f64::consts::PI * s / taut_string::LENGTH).sin();
            let mut sim = started(&scene, |state| {
                for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                    p.y = 1e-3 * shape(*s);
                }
            });
            let mass = masses(&scene, &sim.states()[0]);
            let dt = std::f64::consts::TAU / taut_string::continuous(k) / 5.0;
            let samples = sampled(&mut sim, (dt, 1), 60, |state| {
                (0..mass.len()).map(|i| mass[i] * shape(state.arc_length_m[i]) * state.position_m[i].y).sum()
            });
            let found = ring(&samples, dt).omega;
            let lagrange = taut_string::discrete(k, n);
            let h = sim.solution().cost.inner_step_s;
            let off = found / lagrange - 1.0 - (lagrange * h).powi(2) / 24.0;
            println!("mode {k}, {n} springs: {off:.1e} from Lagrange's string and the scheme");
            assert!(off.abs() < 1e-5, "mode {k}, {n} springs: {off:.2e}");
            found / taut_string::continuous(k) - 1.0
        });
        ladder(
            &format!("mass-spring, taut string, mode {k}"),
            &errors,
            2.0,
            (k as f64 * std::f64::consts::PI / 8.0).powi(2) / 24.0,
        );
    }
}

/// Axial swings of a cable of 20 m, 1 kg/m, EA 1e4 between two walls, c = 100 m/s, without loss:
/// error of the frequency, and decay over it.
fn axial(segments: usize) -> [f64; 2] {
    let length = 20.0;
    let supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [1.02 * length, 0.0])];
    let mut scene = cable([length, 1.0, 1e4], segments, supports);
    scene.environment.gravity_m_per_s2 = 0.0;
    let shape = |s: f64| (std::f64::consts::PI * s / length).sin();
    let mut sim = started(&scene, |state| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            p.x += 1e-2 * shape(*s);
        }
    });
    let mass = masses(&scene, &sim.states()[0]);
    let omega = std::f64::consts::PI * 100.0 / length;
    // The same sub-step on every mesh, so that (ωh)²/24 does not mix with the error in space.
    let (h, every) = (1.0 / 8000.0, (std::f64::consts::TAU / omega / 5.0 * 8000.0).round() as usize);
    let dt = h * every as f64;
    let samples = sampled(&mut sim, (h, every), 48, |state| {
        let rest = |s: f64| 1.02 * s;
        (0..mass.len())
            .map(|i| mass[i] * shape(state.arc_length_m[i]) * (state.position_m[i].x - rest(state.arc_length_m[i])))
            .sum()
    });
    let found = ring(&samples, dt);
    [found.omega / omega - 1.0, found.decay / omega]
}

#[test]
fn waves_run_at_their_speed_and_lose_nothing_without_loss() {
    let found = [8, 16, 32].map(axial);
    ladder("mass-spring, axial swing", &found.map(|f| f[0]), 2.0, 6.5e-3);
    let decay = found.map(|f| f[1]);
    println!("mass-spring, axial swing: damped by {decay:.1?}", decay = decay.map(|d| format!("{d:.1e}")));
    // It had at least 0.1 of critical at the fastest mode.
    assert!(decay.iter().all(|d| d.abs() < 1e-9), "{decay:?}");
}

/// T = W(1 + √(1 + 2hEA/(WL))).
#[test]
fn a_dropped_mass_pulls_as_the_energy_says() {
    let (mass, length, ea) = (dropped_mass::MASS, dropped_mass::LENGTH, dropped_mass::EA);
    for fall in [0.0, 0.5, 2.0] {
        let weight = mass * G;
        let exact = weight * (1.0 + (1.0 + 2.0 * fall * ea / (weight * length)).sqrt());
        // So light a cable swings fast: sub-steps are short and what is left is its own weight.
        let scene = cable([length, 1e-3, ea], 4, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)]);
        let mut sim = started(&scene, |state| {
            for k in 0..5 {
                let s = state.arc_length_m[k];
                state.position_m[k] = Vec2::new(0.0, -s);
                state.velocity_m_per_s[k] = Vec2::new(0.0, -(2.0 * G * fall).sqrt() * s / length);
            }
        });
        let mut largest = 0.0;
        for _ in 0..4000 {
            sim.step(5e-4).unwrap();
            let pull = ea * (-sim.states()[0].position_m[4].y / length - 1.0);
            largest = if pull > largest { pull } else { largest };
        }
        let off = largest / exact - 1.0;
        println!("mass-spring, dropped by {fall} m: largest pull off by {off:.1e}");
        assert!(off.abs() < 5e-4, "{fall}: {largest} instead of {exact}");
    }
}

#[test]
fn a_falling_chain_follows_rigid_links() {
    let (length, links) = (10.0, 50);
    let mut rods = Rods::new(length / links as f64, vec![0.0; links]);
    let mut path = Vec::new();
    for _ in 0..10 {
        (0..400).for_each(|_| rods.step(0.1 / 400.0));
        path.push(rods.tip());
    }
    let supports = || vec![Support::fixed("wall", [0.0, 0.0]), Support::new("tip", SupportKind::Free)];
    // Stretch is 1/EA: each stiffer cable has shorter sub-steps, so both errors fall together.
    let errors = [2.5e6, 1e7, 4e7].map(|ea| {
        let scene = cable([length, 1.0, ea], links, supports());
        let mut sim = started(&scene, |state| {
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                *p = Vec2::new(*s, 0.0);
            }
        });
        let start = energy(&scene, &sim.states()[0]);
        let mut off = 0.0f64;
        for at in &path {
            sim.step(0.1).unwrap();
            off = off.max((sim.states()[0].position_m[links] - at).norm());
        }
        let change = (energy(&scene, &sim.states()[0]) - start) / (G * length * length);
        println!(
            "EA {ea:.1e}, sub-step {:.1e} s: tip {off:.2e} m, energy {change:.1e} m g L",
            sim.solution().cost.inner_step_s
        );
        assert!(change.abs() < 1e-3, "{change}");
        off
    });
    // The sub-step halves from rung to rung. With a whole kick in the first sub-step the errors
    // were 4.5e-4, 2.2e-4 and 1.1e-4 m, of first order.
    ladder("mass-spring, falling chain, tip in m", &errors, 2.0, 3.8e-4);
}

/// A mass that begins to swing falls g t²/2 at first, whatever the sub-step: half a kick in the
/// first one.
#[test]
fn a_motion_begins_with_half_a_kick() {
    let (length, mass) = (1.0, 10.0);
    let scene = cable([length, 1e-2, 1e6], 2, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)]);
    for h in [1e-5, 2e-5] {
        let mut sim = started(&scene, |state| {
            // Slack: nothing but weight pulls.
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                *p = Vec2::new(0.5 * s, 0.0);
            }
        });
        let mut t = 0.0;
        for _ in 0..100 {
            sim.step(h).unwrap();
            t += h;
        }
        let fallen = -sim.states()[0].position_m[2].y;
        let off = fallen / (0.5 * G * t * t) - 1.0;
        println!("sub-step {:.1e} s: falls by {off:.1e} too far", sim.solution().cost.inner_step_s);
        assert!(off.abs() < 1e-9, "{h}: {off:e}");
    }
}

#[test]
fn a_large_pendulum_takes_gausss_period_and_loses_nothing() {
    let (length, mass, ea, angle) = (1.0, 10.0, 1e6, std::f64::consts::FRAC_PI_3);
    let scene = cable([length, 1e-2, ea], 2, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)]);
    let exact = period(length, angle);
    let mut sim = started(&scene, |state| {
        let strain = mass * G * angle.cos() / ea;
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            *p = Vec2::new(angle.sin(), -angle.cos()) * (s * (1.0 + strain));
        }
    });
    let lowest = -mass * G * length;
    let start = energy(&scene, &sim.states()[0]) - lowest;
    let h = 1e-3;
    let (mut turns, mut before, mut t) = (Vec::new(), 1.0, 0.0);
    while turns.len() < 41 {
        sim.step(h).unwrap();
        t += h;
        let x = sim.states()[0].position_m[2].x;
        if before * x < 0.0 {
            turns.push(t - h * x / (x - before));
        }
        before = x;
    }
    let off = (turns[40] - turns[0]) / (20.0 * exact) - 1.0;
    let lost = 1.0 - (energy(&scene, &sim.states()[0]) - lowest) / start;
    println!("mass-spring, pendulum of 60°: period off by {off:.1e}, energy lost in 20 periods {lost:.1e}");
    // Stretch lengthens it: T/EA is 1e-4 to 2e-4, half of it in the period.
    assert!((0.0..1.5e-4).contains(&off), "{off}");
    assert!(lost.abs() < 2e-4, "{lost}");
}

#[test]
fn a_mass_below_a_heavy_cable_swings() {
    let (length, mass) = (10.0, 5.0);
    for (part, bound) in [(0.1, 5.1e-4), (1.0, 3.8e-3)] {
        let density = part * mass / length;
        let (exact, shape) = heavy_pendulum(length, density, mass);
        let errors = [4, 8, 16].map(|n| {
            let scene = cable([length, density, 1e7], n, vec![Support::fixed("top", [0.0, 0.0]), lump("mass", mass)]);
            let at = |k: usize| shape[k * 400 / n];
            let mut sim = started(&scene, |state| {
                for (k, p) in state.position_m.iter_mut().enumerate() {
                    p.x = 5e-3 * length * at(k);
                }
            });
            let mass = masses(&scene, &sim.states()[0]);
            let dt = std::f64::consts::TAU / exact / 5.0;
            let samples = sampled(&mut sim, (dt, 1), 30, |state| {
                state.position_m.iter().enumerate().map(|(k, p)| mass[k] * at(k) * p.x).sum()
            });
            ring(&samples, dt).omega / exact - 1.0
        });
        ladder(&format!("mass-spring, mass below a cable of {part} of it"), &errors, 2.0, bound);
    }
}
