//! These tests apply forces that change: wind and pulls on a free cable move the middle of its mass
//! by F/m integrated twice; a ramp pulls a weight on a soft cable by F/k·(t − sin ωt/ω)/T.
//! Temperature is constant in a scene.

use cable_core::scene::Support;
use cable_core::{Load, Model, Simulation, Vec2};

use super::measure::{G, Mass, cable, ladder, lump, settled, started};

/// The time when the cable is let go, s.
const RELEASE: f64 = 0.1;

#[test]
fn wind_and_pulls_move_the_middle_of_mass() {
    let (length, density, mass, rise) = (4.0, 0.5, 1.5, 0.8);
    let whole = density * length + mass;
    let times = vec![0.0, RELEASE, RELEASE + rise];
    let pull = |x, y| vec![[0.0, 0.0], [0.0, 0.0], [x, y]];
    let end = Support { times_s: times.clone(), forces_n: pull(5.0, 0.0), force_n: None, ..lump("lump", mass) };
    let top = Support { release_s: Some(RELEASE), ..Support::fixed("top", [0.0, 0.0]) };
    let mut scene = cable([length, density, 1e6], 16, vec![top, end]);
    scene.environment.winds_n_per_m = pull(8.0, 2.0);
    scene.environment.wind_times_s = times.clone();
    scene.loads = vec![Load {
        cable: scene.cables[0].name.clone(),
        arc_length_m: 1.0,
        force_n: None,
        times_s: times,
        forces_n: pull(0.0, 6.0),
    }];
    let errors = [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0].map(|h| {
        let mut sim = settled(&scene, Model::Fem);
        let mass = Mass::of(&scene, &sim.states()[0]);
        let middle = |sim: &Simulation| {
            let x = &sim.states()[0].position_m;
            mass.times(x).into_iter().sum::<Vec2>() / whole
        };
        let (from, t) = (middle(&sim), 0.6);
        for _ in 0..((RELEASE + t) / h).round() as usize {
            sim.step(h).unwrap();
        }
        // A force that rises evenly to F at T moves a mass by F t³/(6 T m).
        let by = Vec2::new(8.0 * length + 5.0, 2.0 * length + 6.0) * (t * t * t / (6.0 * rise * whole));
        let exact = from + by - Vec2::new(0.0, 0.5 * G * t * t);
        (middle(&sim) - exact).norm()
    });
    ladder("middle of mass under wind and pulls, m", &errors, 2.0, 1.7e-4);
}

#[test]
fn a_ramp_pulls_a_weight_on_a_soft_cable() {
    let (length, ea, mass, rise, force) = (10.0, 2e4, 100.0, 0.7, 400.0);
    let k: f64 = ea / length;
    let omega = (k / mass).sqrt();
    // M u'' + ku = F t/T, u(0) = u'(0) = 0.
    let exact = |t: f64| force / (k * rise) * (t - (omega * t).sin() / omega);
    let errors = [1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0].map(|h| {
        let end = Support {
            times_s: vec![0.0, rise],
            forces_n: vec![[0.0, 0.0], [0.0, -force]],
            force_n: None,
            ..lump("weight", mass)
        };
        let scene = cable([length, 1e-6, ea], 4, vec![Support::fixed("top", [0.0, 0.0]), end]);
        let mut sim = started(&scene, |state| {
            for (p, s) in state.position_m.iter_mut().zip(&state.arc_length_m) {
                *p = Vec2::new(0.0, -s * (1.0 + mass * G / ea));
            }
        });
        let from = sim.states()[0].position_m[4].y;
        let mut worst = 0.0f64;
        for n in 1..=(rise / h) as usize {
            sim.step(h).unwrap();
            let moved = from - sim.states()[0].position_m[4].y;
            worst = worst.max((moved - exact(n as f64 * h)).abs());
        }
        worst / exact(rise)
    });
    ladder("ramp on a soft cable", &errors, 2.0, 1.2e-4);
}
