//! A cable that runs fast over a post or a wheel carries momentum round it: it presses and rubs by
//! its tension less ρv².
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::{Model, Simulation};

const PULL_N: f64 = 100.0;
const DENSITY_KG_PER_M: f64 = 1.246;

/// Without gravity, a cable that a dead load of 100 N holds runs a quarter round, drawn at a speed
/// that it has from 0.6 s on.
fn drawn(speed_m_per_s: f64, friction: f64, over_wheel: bool) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.gravity_m_per_s2 = 0.0;
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.linear_density_kg_per_m, cable.axial_stiffness_n) = (8.9869, DENSITY_KG_PER_M, 2e5);
    (cable.diameter_m, cable.damping_ratio, cable.bending_stiffness_n_m2) = (0.02, 1.0, 0.0);
    (cable.breaking_tension_n, cable.service_tension_n) = (1e9, 1e9);
    cable.segments = Some(60);
    let load = Support { force_n: Some([-PULL_N, 0.0]), ..Support::new("load", SupportKind::Load) };
    let mut hand = Support::fixed("hand", [0.31, -1.0]);
    // A fifth-degree start, then steady.
    let way = |t: f64| {
        let u = (t / 0.6).min(1.0);
        speed_m_per_s * (0.6 * (2.5 * u.powi(4) - 3.0 * u.powi(5) + u.powi(6)) + (t - 0.6).max(0.0))
    };
    let times_s: Vec<f64> = (0..=60).map(|k| 0.02 * f64::from(k)).collect();
    let points_m = times_s.iter().map(|t| [0.31, -1.0 - way(*t)]).collect();
    hand.motion = Some(Motion { times_s, points_m });
    cable.route_m = vec![[-7.5, 0.31], [0.0, 0.32], [0.32, 0.0], [0.31, -1.0]];
    scene.obstacles.clear();
    cable.supports = vec![load, hand];
    if over_wheel {
        cable.route_m.clear();
        let mut wheel = Support::pulley("wheel", [0.0, 0.0]);
        (wheel.radius_m, wheel.friction) = (Some(0.3), Some(friction));
        cable.supports.insert(1, wheel);
    } else {
        let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: 0.3 };
        scene.obstacles = vec![Obstacle { name: "post".into(), shape, friction: Some(friction) }];
    }
    scene
}

/// Mean over the last tenth of a second of the pull on the hand and of the force that post or wheel
/// takes, N.
fn forces(scene: Scene) -> [f64; 2] {
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    sim.settle().unwrap();
    let (mut sum, mut count) = ([0.0; 2], 0.0);
    for step in 1..=276 {
        sim.step(1.0 / 240.0).unwrap();
        if step > 252 {
            let cable = &sim.answers()[0];
            let hand = cable.supports.last().unwrap();
            let wheel = cable.supports.iter().find(|s| s.name == "wheel");
            let pressed = cable.contacts.first().map(|c| c.force_n[0].hypot(c.force_n[1]));
            let taken = wheel.map(|w| w.reaction_x_n.hypot(w.reaction_y_n)).or(pressed).unwrap_or(0.0);
            sum = [sum[0] + hand.reaction_y_n.abs(), sum[1] + taken];
            count += 1.0;
        }
    }
    sum.map(|s| s / count)
}

#[test]
fn a_cable_that_runs_fast_presses_by_its_tension_less_its_momentum() {
    for (speed, friction) in [(0.0, 0.0), (3.0, 0.0), (6.0, 0.0), (3.0, 0.3), (6.0, 0.3)] {
        for over_wheel in [false, true] {
            let [pull, taken] = forces(drawn(speed, friction, over_wheel));
            let flux = DENSITY_KG_PER_M * speed * speed;
            let leaves = flux + (PULL_N - flux) * (friction * std::f64::consts::FRAC_PI_2).exp();
            let presses = (PULL_N - flux).hypot(leaves - flux);
            println!(
                "{speed} m/s, friction {friction}, wheel {over_wheel}: pulls {pull:.2} ({leaves:.2}) N, presses {taken:.2} ({presses:.2}) N"
            );
            assert!((pull / leaves - 1.0).abs() < 0.02, "{speed} m/s, {friction}: pulls {pull} N, and not {leaves}");
            assert!(
                (taken / presses - 1.0).abs() < 0.03,
                "{speed} m/s, {friction}: presses {taken} N, and not {presses}"
            );
        }
    }
}
