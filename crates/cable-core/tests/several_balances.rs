//! Slack cables over smooth pulleys have balances that run away and several that do not: the shown
//! one is stable, and the others are told. Against closed forms of inextensible catenaries.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::{Histories, ShownEquilibrium, WarningCause};
use cable_core::{Model, Settings, Simulation};

const DENSITY: f64 = 1.0;
const GRAVITY: f64 = 9.80665;

/// A cable over a smooth pulley between two level ends, with ground far below or none.
fn scene(spans: [f64; 2], length_m: f64, ground: bool) -> Scene {
    let far = spans[0] + spans[1];
    let supports = vec![
        Support::fixed("a", [0.0, 0.0]),
        Support { friction: Some(0.0), ..Support::pulley("p", [spans[0], 0.0]) },
        Support::fixed("b", [far, 0.0]),
    ];
    let mut scene = catalog::cable_alone([length_m, DENSITY, 1e9], supports);
    scene.cables[0].segments = None;
    scene.obstacles.clear();
    if ground {
        let shape = Shape::Terrain { points_m: vec![[-10.0, -2.0 * length_m], [far + 10.0, -2.0 * length_m]] };
        scene.obstacles.push(Obstacle { name: "ground".to_owned(), shape, friction: Some(0.0) });
    }
    scene
}

/// Tension at the ends of an inextensible cable of a length between level ends, N: with u = chord /
/// 2a, sinh u / u = length / chord, and T = w a cosh u (H. M. Irvine, "Cable structures", 1981).
fn end_tension(chord: f64, length: f64) -> f64 {
    let (mut low, mut high) = (1e-9, 50.0f64);
    for _ in 0..200 {
        let u = 0.5 * (low + high);
        if u.sinh() / u < length / chord { low = u } else { high = u }
    }
    let u = 0.5 * (low + high);
    DENSITY * GRAVITY * chord / (2.0 * u) * u.cosh()
}

/// Greatest tensions of all stable balances: where the tension after the pulley less that before
/// it, as a function of the cable before it, goes from − to +.
fn stable_balances(spans: [f64; 2], length: f64) -> Vec<f64> {
    let left = |before: f64| end_tension(spans[1], length - before) - end_tension(spans[0], before);
    let (from, to) = (spans[0] * (1.0 + 1e-7), length - spans[1] * (1.0 + 1e-7));
    // Fine near both limits, where a span is taut.
    let at = |k: usize| {
        let x = k as f64 / 20_001.0;
        from + (to - from) * x * x * (3.0 - 2.0 * x)
    };
    let mut out = Vec::new();
    for k in 0..20_001 {
        let (mut low, mut high) = (at(k), at(k + 1));
        if left(low) < 0.0 && left(high) > 0.0 {
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if left(middle) < 0.0 { low = middle } else { high = middle }
            }
            out.push(end_tension(spans[0], 0.5 * (low + high)));
        }
    }
    out
}

fn is_near(a: f64, b: f64, within: f64) -> bool {
    (a - b).abs() <= within * b.abs()
}

#[test]
fn issue_015_a_slack_cable_leaves_a_balance_that_runs_away() {
    for length in [11.0, 12.0, 12.7, 13.0, 16.0, 20.0, 30.0] {
        let balances = stable_balances([5.0; 2], length);
        assert_eq!(balances.len(), if length < 12.6 { 1 } else { 2 }, "{length}");
        for (model, ground, within) in [
            (Model::Auto, false, 1e-6),
            (Model::Auto, true, 1e-6),
            (Model::Spans, false, 1e-6),
            (Model::Fem, false, 1e-3),
            (Model::Fem, true, 1e-3),
        ] {
            let answer = Simulation::new(scene([5.0; 2], length, ground), model).unwrap().settle();
            let answer = answer.unwrap_or_else(|e| panic!("{length} m by {model:?}: {e}"));
            let found = answer.max_tension().tension_n;
            assert!(is_near(found, balances[0], within), "{length} m by {model:?}: {found}, {balances:?}");
            let told = answer.warnings.iter().any(|w| matches!(w.cause, WarningCause::Unstable));
            assert!(!told, "{length} m by {model:?}");
        }
    }
}

#[test]
fn issue_015_every_balance_of_a_slack_cable_is_told() {
    for (spans, length) in [([4.9, 5.1], 20.0), ([4.0, 6.0], 20.0), ([5.0, 5.0], 14.0), ([2.0, 6.0], 30.0)] {
        let balances = stable_balances(spans, length);
        let answer = Simulation::new(scene(spans, length, false), Model::Auto).unwrap().settle().unwrap();
        let shown = answer.max_tension().tension_n;
        let others: Vec<f64> = answer
            .warnings
            .iter()
            .filter_map(|w| match &w.cause {
                WarningCause::ManyEquilibria { histories: Histories::SlackElsewhere { others_n, .. }, .. } => {
                    Some(others_n.clone())
                }
                _ => None,
            })
            .flatten()
            .collect();
        let mut all: Vec<f64> = std::iter::once(shown).chain(others).collect();
        let mut right = balances.clone();
        all.sort_by(f64::total_cmp);
        right.sort_by(f64::total_cmp);
        assert_eq!(all.len(), right.len(), "{spans:?}: {all:?}, {right:?}");
        assert!(all.iter().zip(&right).all(|(a, b)| is_near(*a, *b, 1e-6)), "{spans:?}: {all:?}, {right:?}");
    }
}

const STIFFNESS: f64 = 20.0;
const LIGHT: f64 = 0.2;

/// A stiff cable between two level points nearer to each other than it is long, with ground far
/// below or none.
fn arch(length: f64, chord: f64, ground: bool) -> Scene {
    let supports = vec![Support::fixed("a", [0.0, 0.0]), Support::fixed("b", [chord, 0.0])];
    let mut scene = catalog::cable_alone([length, LIGHT, 1e9], supports);
    scene.cables[0].segments = None;
    scene.cables[0].bending_stiffness_n_m2 = STIFFNESS;
    scene.obstacles.clear();
    if ground {
        let shape = Shape::Terrain { points_m: vec![[-10.0, -10.0], [10.0 + chord, -10.0]] };
        scene.obstacles.push(Obstacle { name: "ground".to_owned(), shape, friction: Some(0.0) });
    }
    scene
}

/// The tensions at the start and in the middle of an inextensible elastica on two level hinges, N,
/// by shooting (fourth order of Runge and Kutta) from a first angle and thrust; by symmetry each
/// hinge bears half of the weight.
fn shot([mut angle, mut thrust]: [f64; 2], length: f64, chord: f64) -> [f64; 2] {
    let weight = LIGHT * GRAVITY;
    const STEPS: usize = 4000;
    let h = 0.5 * length / STEPS as f64;
    // θ' = κ, κ' = −F·n/EI, F = (−thrust, −w(L/2 − s)), x' = cos θ.
    let end = |angle: f64, thrust: f64| -> [f64; 2] {
        let slope = |s: f64, u: [f64; 3]| {
            let force = [-thrust, -weight * (0.5 * length - s)];
            let across = -force[0] * u[0].sin() + force[1] * u[0].cos();
            [u[1], -across / STIFFNESS, u[0].cos()]
        };
        let mut u = [angle, 0.0, 0.0];
        for k in 0..STEPS {
            let s = k as f64 * h;
            let on = |d: [f64; 3], by: f64| [u[0] + by * d[0], u[1] + by * d[1], u[2] + by * d[2]];
            let a = slope(s, u);
            let b = slope(s + 0.5 * h, on(a, 0.5 * h));
            let c = slope(s + 0.5 * h, on(b, 0.5 * h));
            let d = slope(s + h, on(c, h));
            for i in 0..3 {
                u[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
        [u[0], u[2] - 0.5 * chord]
    };
    for _ in 0..50 {
        let (r, d) = (end(angle, thrust), 1e-6);
        let (by_angle, by_thrust) = (end(angle + d, thrust), end(angle, thrust + d));
        let j = [
            [(by_angle[0] - r[0]) / d, (by_thrust[0] - r[0]) / d],
            [(by_angle[1] - r[1]) / d, (by_thrust[1] - r[1]) / d],
        ];
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        angle -= (r[0] * j[1][1] - r[1] * j[0][1]) / det;
        thrust -= (r[1] * j[0][0] - r[0] * j[1][0]) / det;
    }
    let left = end(angle, thrust);
    assert!(left[0].abs() + left[1].abs() < 1e-9, "{left:?}");
    [-thrust * angle.cos() - 0.5 * weight * length * angle.sin(), -thrust]
}

#[test]
fn issue_015_the_other_side_of_a_bowed_cable_is_told() {
    for (length, chord) in [(3.0, 2.0), (3.0, 2.6), (2.0, 1.9)] {
        let euler = std::f64::consts::PI.powi(2) * STIFFNESS / (length * length);
        let steep = 2.0 * (1.0 - chord / length).sqrt();
        let [down, up] = [-1.0, 1.0].map(|side: f64| shot([side * steep, 1.1 * euler], length, chord));
        assert!(down[1] - up[1] > 1.0, "{down:?} {up:?}");
        for ground in [false, true] {
            let answer = Simulation::new(arch(length, chord, ground), Model::Auto).unwrap().settle().unwrap();
            let shown = answer.cables[0].nodes[0].tension_n;
            let told = answer.warnings.iter().find_map(|w| match &w.cause {
                WarningCause::ManyEquilibria { histories: Histories::BowedElsewhere { start_n, .. }, .. } => {
                    Some(*start_n)
                }
                _ => None,
            });
            let mut right = [down[0], up[0]];
            right.sort_by(f64::total_cmp);
            let told = told.unwrap_or_else(|| panic!("{length} m on {chord} m"));
            println!("{length} m on {chord} m, ground {ground}: {shown}, {told:?} N; by shooting {right:?} N");
            let size = right[0].abs();
            assert!(told.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-5 * size), "{told:?} {right:?}");
            assert!(right.iter().any(|r| (r - shown).abs() < 1e-5 * size), "{shown} {right:?}");
        }
    }
}

/// A cable that is pulled has one shape: nothing is told of others.
#[test]
fn issue_015_a_stiff_cable_that_pulls_bows_to_one_side() {
    let answer = Simulation::new(arch(3.0, 2.9, false), Model::Auto).unwrap().settle().unwrap();
    let mut taut = arch(3.0, 2.9999, false);
    taut.cables[0].linear_density_kg_per_m = 20.0;
    taut.cables[0].bending_stiffness_n_m2 = 1.0;
    let pulled = Simulation::new(taut, Model::Auto).unwrap().settle().unwrap();
    let told = |s: &cable_core::Solution| {
        s.warnings.iter().any(|w| {
            matches!(w.cause, WarningCause::ManyEquilibria { histories: Histories::BowedElsewhere { .. }, .. })
        })
    };
    assert!(told(&answer));
    assert!(!told(&pulled));
}

/// The greatest tension of a stiff cable may be between two nodes, and its error says how well it
/// is known there.
#[test]
fn issue_016_the_greatest_tension_between_nodes_is_within_its_error() {
    let mut pole = catalog::cable_alone(
        [3.0, 1.0, 1e6],
        vec![
            Support { kind: SupportKind::Clamped, angle_deg: Some(90.0), ..Support::fixed("base", [0.0, 0.0]) },
            Support::free("top"),
        ],
    );
    pole.obstacles.clear();
    pole.cables[0].bending_stiffness_n_m2 = 2.0;
    let found = |segments: Option<usize>, tolerance: f64| {
        let settings = Settings { tolerance, segments, ..Settings::default() };
        let mut scene = pole.clone();
        scene.cables[0].segments = None;
        let answer = Simulation::with_settings(scene, Model::Auto, settings).unwrap().settle().unwrap();
        (answer.max_tension().tension_n, answer.cables[0].errors.max_tension_n.unwrap())
    };
    let (right, _) = found(None, 1e-10);
    for segments in [None, Some(20), Some(40), Some(80)] {
        let (shown, error) = found(segments, 1e-3);
        println!("{segments:?}: {shown} ± {error} N of {right} N");
        assert!((shown - right).abs() <= error, "{segments:?}: {shown} ± {error} N of {right} N");
    }
}

/// A cable that sags on to a beam from above rests there without friction, and one that is laid
/// over the beam rests where friction stops it: other histories, and each is called by its name.
/// (Both were called laid with the least sliding, though 1 cm of the beam made 17 % of the
/// tension.)
#[test]
fn issue_016_each_shown_history_is_called_by_its_name() {
    for (corner, called) in [(3.19, ShownEquilibrium::Frictionless), (3.20, ShownEquilibrium::LeastSliding)] {
        let supports = vec![Support::fixed("A", [0.0, 5.0]), Support::fixed("B", [6.0, 0.3])];
        let mut scene = catalog::cable_alone([8.257_414, 1.25, 2e6], supports);
        scene.cables[0].diameter_m = 0.028;
        let points_m = vec![[corner - 0.3, 2.2], [corner, 2.2], [corner, 2.5], [corner - 0.3, 2.5]];
        scene.obstacles =
            vec![Obstacle { name: "beam".to_owned(), shape: Shape::Polygon { points_m }, friction: Some(0.3) }];
        let rest = |friction: f64| {
            let mut scene = scene.clone();
            scene.obstacles[0].friction = Some(friction);
            let mut sim = Simulation::new(scene, Model::Auto).unwrap();
            sim.settle().unwrap().clone()
        };
        let (held, smooth) = (rest(0.3), rest(0.0));
        let shown = held.warnings.iter().find_map(|w| match w.cause {
            WarningCause::ManyEquilibria { shown, .. } => Some(shown),
            _ => None,
        });
        let off = held.max_tension().tension_n / smooth.max_tension().tension_n - 1.0;
        println!("beam to {corner} m: {shown:?}, greatest tension {off:e} beside that without friction");
        assert_eq!(shown, Some(called));
        assert_eq!(called == ShownEquilibrium::Frictionless, off.abs() < 1e-6);
    }
}
