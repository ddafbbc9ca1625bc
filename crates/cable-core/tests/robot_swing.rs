//! These tests let a robot run its cable taut: the tension swings on because the cable does, as a
//! string in its first mode, and not because vehicle and cable feel each other with a delay.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::model::{Inertia, Question};
use cable_core::scene::{RobotTask, Shape, catalog};
use cable_core::{Model, Settings, Simulation};

/// Length of its cable, m.
const LENGTH_M: f64 = 13.05;

/// The robot's brakes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Brakes {
    On,
    Off,
}

/// Driven out until it can no further; the pull on the hitch from 9 s on, N, at each step; its
/// brakes on from then on, or off.
fn pulls(dt_s: f64, segments: usize, brakes: Brakes) -> Vec<f64> {
    let mut scene = catalog::robot_drive();
    let robot = scene.robot.as_mut().unwrap();
    robot.path = vec![RobotTask::Drive { to_x_m: 18.0, speed_m_per_s: 0.6 }];
    robot.repeat = false;
    // Off the ground: how slack lies there differs in every run, and with it how hard the robot is
    // stopped.
    robot.at_m = [13.0, 0.0];
    scene.cables[0].length_m = LENGTH_M;
    if let Shape::Terrain { points_m } = &mut scene.obstacles[0].shape {
        *points_m = vec![[-4.0, 0.0], [24.0, 0.0]];
    }
    let settings = Settings { segments: Some(segments), ..Settings::default() };
    let question = Question::History(Inertia::Dynamic);
    let mut run = Simulation::for_question(scene, Model::Auto, settings, question).unwrap();
    run.settle().unwrap();
    let mut out = Vec::new();
    while run.time_s() < 24.0 {
        run.step(dt_s).unwrap();
        if run.time_s() > 9.0 {
            if brakes == Brakes::On {
                run.command_robot(Some(0.0));
            }
            let hitch = run.solution().cables[0].supports[1].clone();
            out.push(hitch.reaction_x_n.hypot(hitch.reaction_y_n));
        }
    }
    out
}

/// Amplitude of a tone of so many hertz in a stretch, by a window that is 0 at both ends (J. von
/// Hann's).
fn tone(pulls: &[f64], (mean, dt_s, hertz): (f64, f64, f64)) -> f64 {
    let turn = std::f64::consts::TAU;
    let part = |k: usize| {
        let window = 1.0 - (turn * k as f64 / pulls.len() as f64).cos();
        let angle = turn * hertz * k as f64 * dt_s;
        [angle.cos(), angle.sin()].map(|c| (pulls[k] - mean) * window * c)
    };
    let [a, b] = (0..pulls.len()).map(part).fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
    2.0 * a.hypot(b) / pulls.len() as f64
}

/// Mean, amplitude of the strongest tone in the first and in the last half, N, and its frequency,
/// Hz.
fn swing(pulls: &[f64], dt_s: f64) -> [f64; 4] {
    let mean = pulls.iter().sum::<f64>() / pulls.len() as f64;
    let at = |part: &[f64], hertz: f64| tone(part, (mean, dt_s, hertz));
    let tones = (100..3000).map(|k| 0.01 * f64::from(k));
    let strongest = tones.max_by(|a, b| at(pulls, *a).total_cmp(&at(pulls, *b))).unwrap();
    let (first, last) = pulls.split_at(pulls.len() / 2);
    [mean, at(first, strongest), at(last, strongest), strongest]
}

#[test]
fn a_robot_on_a_taut_cable_swings_as_its_cable_does_at_any_step_and_mesh() {
    let coarse = swing(&pulls(1.0 / 120.0, 80, Brakes::Off), 1.0 / 120.0);
    println!("{coarse:?}");
    let [mean, first, last, hertz] = coarse;
    // H. M. Irvine, "Cable Structures", MIT Press, 1981: ω² = (π/L)² T/m · (1 + 8 λ²/π⁴) for small
    // λ² = (wL/T)² EA/T.
    let cable = &catalog::robot_drive().cables[0];
    let (length, m) = (LENGTH_M, cable.linear_density_kg_per_m);
    let lambda2 = (m * 9.80665 * length / mean).powi(2) * cable.axial_stiffness_n / mean;
    let pi4 = std::f64::consts::PI.powi(4);
    let exact = 0.5 / length * (mean / m * (1.0 + 8.0 * lambda2 / pi4)).sqrt();
    assert!((hertz / exact - 1.0).abs() < 0.06, "{hertz} Hz, a string's {exact} Hz");
    // With its brakes on it is a fixed end: what is lost then is the cable's.
    let braked = swing(&pulls(1.0 / 120.0, 80, Brakes::On), 1.0 / 120.0);
    println!("{braked:?}");
    assert!(last < first, "it dies down: {coarse:?}");
    assert!(
        (last / first - braked[2] / braked[1]).abs() < 0.02,
        "it dies down as its cable lets it: {coarse:?} {braked:?}"
    );
    for (dt_s, segments) in [(1.0 / 240.0, 80), (1.0 / 120.0, 160)] {
        let other = swing(&pulls(dt_s, segments, Brakes::Off), dt_s);
        println!("{other:?}");
        assert!((other[0] / mean - 1.0).abs() < 0.002, "{coarse:?} {other:?}");
        assert!((other[2] / last - 1.0).abs() < 0.02 && other[2] < other[1], "{coarse:?} {other:?}");
        assert!((other[3] / hertz - 1.0).abs() < 0.01, "{coarse:?} {other:?}");
    }
}
