//! Waves along the cable run at c = √(EA/ρ), ρ and length unstretched; it swings at φ c/L, N bars
//! at that to the order 1/N⁴. Its loss takes ζω of the amplitude a second at every frequency.

use cable_core::Model;
use cable_core::scene::{Obstacle, Shape, Support, SupportKind};
use cable_core::state::State;

use super::mass_spring;
use super::measure::{Ring, behind, cable, climbs, masses, ring, sampled, settled, spread_energy, started};

const LENGTH: f64 = 20.0;
const EA: f64 = 1e4;
const DENSITY: f64 = 1.0;
const SPEED: f64 = 100.0;

/// First axial swing between two fixed ends at step `h` (s).
fn swing(segments: usize, h: f64) -> Ring {
    let supports = vec![Support::fixed("A", [0.0, 0.0]), Support::fixed("B", [1.02 * LENGTH, 0.0])];
    let mut scene = cable([LENGTH, DENSITY, EA], segments, supports);
    scene.environment.gravity_m_per_s2 = 0.0;
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
    let errors = [8, 16, 32].map(|n| behind(swing(n, h), h).omega / continuous() - 1.0);
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

/// Bars of the bar that rings down.
const SEGMENTS: usize = 32;

/// A mass on the end of a bar that is pulled, or the bar alone between two walls: circular
/// frequency and decay of its free swing, 1/s.
///
/// Steps are a hundredth of the swing, so that those of `fem` take less than 1e-5 of critical.
fn rings(model: Model, ratio: f64, wanted: f64, obstacles: &[Obstacle]) -> [f64; 2] {
    let (length, density, ea, segments) = (10.0f64, 0.1f64, 1e5f64, SEGMENTS);
    let first = std::f64::consts::PI * (ea / density).sqrt() / length;
    let mode = (wanted / first).round();
    let wall = Support::fixed("wall", [0.0, 0.0]);
    let end = if mode == 0.0 {
        // A third of the bar swings with it.
        let mass_kg = Some(ea / length / (wanted * wanted) - density * length / 3.0);
        Support { mass_kg, force_n: Some([500.0, 0.0]), ..Support::new("mass", SupportKind::Load) }
    } else {
        Support::fixed("end", [1.005 * length, 0.0])
    };
    let mut scene = cable([length, density, ea], segments, vec![wall, end]);
    scene.environment.gravity_m_per_s2 = 0.0;
    scene.cables[0].damping_ratio = ratio;
    scene.obstacles = obstacles.to_vec();
    let shape = |s: f64| if mode == 0.0 { s / length } else { (mode * std::f64::consts::PI * s / length).sin() };
    let plucked = |state: &mut State| {
        for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
            p.x += 1e-3 * shape(*s);
        }
    };
    let mut sim = match model {
        Model::MassSpring => mass_spring::started(&scene, plucked),
        _ => started(&scene, plucked),
    };
    let mass = masses(&scene, &sim.states()[0]);
    let h = std::f64::consts::TAU / wanted / 100.0;
    let samples = sampled(&mut sim, (h, 20), 60, |state| {
        (0..mass.len()).map(|i| mass[i] * shape(state.arc_length_m[i]) * state.position_m[i].x).sum()
    });
    let found = ring(&samples, 20.0 * h);
    [found.omega, found.decay]
}

/// Loss is the same at every frequency: half of the loss factor is the damping ratio. And as EA is
/// the relaxed stiffness, swings are the faster for it by (2ζ/π) ln(ω/ω₀) above ω₀ = 0.63 rad/s.
#[test]
fn it_rings_down_by_its_damping_ratio_at_every_frequency() {
    for model in [Model::Fem, Model::MassSpring] {
        for ratio in [0.005f64, 0.02] {
            for wanted in [2.0, 10.0, 50.0, 314.16, 1256.6] {
                rings_down_by(model, ratio, wanted);
            }
        }
    }
}

fn rings_down_by(model: Model, ratio: f64, wanted: f64) {
    let [omega, decay] = rings(model, ratio, wanted, &[]);
    // A chain of springs is slower by the sine of half the phase from one to the next.
    let half = 0.5 * wanted / (1e6f64.sqrt() * SEGMENTS as f64 / 10.0);
    let chain = if model == Model::MassSpring { wanted * half.sin() / half } else { wanted };
    let (found, faster) = (decay / omega / ratio, omega / chain - 1.0);
    let stiffened = 2.0 * ratio / std::f64::consts::PI * (wanted / 0.628).ln();
    println!(
        "{model}, ratio {ratio} at {wanted} rad/s: {found:.3} of it, faster by {faster:.4}, of the law {stiffened:.4}"
    );
    assert!((found - 1.0).abs() < 0.2, "{model}: {found} of a damping ratio of {ratio} at {wanted} rad/s");
    // The lower edge of the band is not sharp: the lowest branch has half of its stiffness there.
    assert!((faster - stiffened).abs() < 1.5 * ratio, "{model}, {wanted} rad/s: faster by {faster}, not {stiffened}");
}

/// Of a ratio of 0.13 three hundredths are viscous at the first axial mode.
#[test]
fn both_models_lose_alike_what_is_asked_beyond_a_tenth() {
    let [fem, springs] = [Model::Fem, Model::MassSpring].map(|model| {
        let [omega, decay] = rings(model, 0.13, 314.16, &[]);
        decay / omega
    });
    println!("ratio 0.13: {fem:.4} by fem, {springs:.4} by mass-spring");
    assert!(fem > 0.11 && (springs / fem - 1.0).abs() < 0.02, "{springs} by mass-spring, {fem} by fem");
}

/// A bar that can touch something, here a pipe beside it, has the same loss up to the frequency
/// 2ζ/τ at which the viscous loss of τ = 1 ms is as great, and that above. `mass_spring` has the
/// same loss at every frequency there too.
#[test]
fn issue_017_it_rings_down_by_its_damping_ratio_beside_a_pipe() {
    let shape = Shape::Circle { center_m: [5.0, 1.0], radius_m: 0.2 };
    let pipe = [Obstacle { name: "pipe".to_owned(), shape, friction: Some(0.3) }];
    for ratio in [0.01f64, 0.02, 0.05] {
        for wanted in [1.0, 2.0, 5.0, 10.0, 30.0, 50.0] {
            let [omega, decay] = rings(Model::MassSpring, ratio, wanted, &pipe);
            let found = decay / omega / ratio;
            assert!((found - 1.0).abs() < 0.2, "mass-spring: {found} of a damping ratio of {ratio} at {wanted} rad/s");
            let [omega, decay] = rings(Model::Fem, ratio, wanted, &pipe);
            let viscous = 0.5e-3 * omega;
            let expected = if viscous < ratio { ratio } else { viscous };
            let found = decay / omega / expected;
            println!("ratio {ratio} at {wanted} rad/s: {found:.3} of {expected:.4}");
            assert!((0.8..1.35).contains(&found), "{found} of a damping ratio of {expected} at {wanted} rad/s");
        }
    }
}

/// Energy that was dissipated is never given back, also by a bar that is let go with more strain
/// than it can keep, and is slack and taut in turn.
#[test]
fn loss_never_gives_energy() {
    let (length, density, ea, segments) = (10.0f64, 0.1f64, 1e5f64, 16);
    for (ratio, drawn) in [(0.02, 1e-2), (0.1, 1e-2), (0.02, 0.2), (0.1, 0.2)] {
        let end = Support { mass_kg: Some(4.0), force_n: Some([0.0, 0.0]), ..Support::new("mass", SupportKind::Load) };
        let mut scene = cable([length, density, ea], segments, vec![Support::fixed("wall", [0.0, 0.0]), end]);
        scene.cables[0].damping_ratio = ratio;
        let mut sim = started(&scene, |state| {
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                p.y -= drawn * s / length;
            }
        });
        // Motion, height and strain of EA alone: what branches hold beside it is none at first, and
        // is never less than none.
        let start = spread_energy(&scene, &sim.states()[0]);
        let mut most = f64::NEG_INFINITY;
        for _ in 0..2000 {
            sim.step(1.0 / 960.0).unwrap();
            most = most.max(spread_energy(&scene, &sim.states()[0]) - start);
        }
        let swing = 0.5 * ea / length * drawn * drawn;
        println!("ratio {ratio}, drawn {drawn} m: at most {most:.2e} J more than at first, of {swing:.2e} J");
        assert!(most <= 1e-6 * swing, "ratio {ratio}, drawn by {drawn} m: {most} J from nowhere");
    }
}

/// Of slow motion EA is the stiffness: an end drawn out by a force that grows over 100 s is where
/// statics have it.
#[test]
fn slow_motion_has_the_stiffness_that_was_asked_for() {
    let (length, ea) = (10.0f64, 1e5f64);
    let end = Support {
        times_s: vec![0.0, 60.0, 100.0],
        forces_n: vec![[100.0, 0.0], [500.0, 0.0], [500.0, 0.0]],
        mass_kg: Some(1.0),
        ..Support::new("end", SupportKind::Load)
    };
    let mut scene = cable([length, 0.1, ea], 8, vec![Support::fixed("wall", [0.0, 0.0]), end]);
    scene.environment.gravity_m_per_s2 = 0.0;
    scene.cables[0].damping_ratio = 0.02;
    let mut sim = settled(&scene, Model::Fem);
    let mut worst = 0.0f64;
    for k in 1..=80 * 60 {
        sim.step(1.0 / 60.0).unwrap();
        let t = f64::from(k) / 60.0;
        let force = if t < 60.0 { 100.0 + 400.0 * t / 60.0 } else { 500.0 };
        let exact = length * (1.0 + force / ea);
        let off = (sim.states()[0].position_m[8].x - exact) / (length * 400.0 / ea);
        worst = worst.max(off.abs());
        if k == 80 * 60 {
            assert!(off.abs() < 1e-6, "20 s after it is off by {off} of the way");
        }
    }
    println!("off by {worst:.1e} of its way at most");
    assert!(worst < 5e-3, "{worst}");
}

#[test]
fn a_pull_arrives_after_length_over_speed() {
    // The end is pulled harder within 0.1 s, smoothly, so that bars do not ring: the wall feels
    // twice the change, centred at L/c + 0.05 s. Without loss, as a constant one would make the
    // wave faster (by 2ζ/π of ln(ω/ω₀)).
    let (rise, parts) = (0.1, 40);
    let smooth = |u: f64| u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    let at = |k: i32| f64::from(k) / f64::from(parts);
    for n in [50, 100, 200] {
        let end = Support {
            times_s: (0..=parts).map(|k| rise * at(k)).collect(),
            forces_n: (0..=parts).map(|k| [500.0 + 100.0 * smooth(at(k)), 0.0]).collect(),
            ..Support::new("end", SupportKind::Load)
        };
        let mut scene = cable([LENGTH, DENSITY, EA], n, vec![Support::fixed("wall", [0.0, 0.0]), end]);
        scene.environment.gravity_m_per_s2 = 0.0;
        let mut sim = settled(&scene, Model::Fem);
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
