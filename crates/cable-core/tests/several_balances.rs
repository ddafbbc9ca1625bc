//! Slack cables over smooth pulleys have balances that run away and several that do not: the shown
//! one is stable, and the others are told. Against closed forms of inextensible catenaries.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};
use cable_core::solution::{Histories, WarningCause};
use cable_core::{Model, Simulation};

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
