//! These tests ask how an answer changes with less and more friction.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::ops::ControlFlow;

use cable_core::analysis::friction_range::{
    Action, ActionKind, FrictionQuery, FrictionRange, friction_range, with_scaled_friction,
};
use cable_core::scene::catalog;
use cable_core::{Model, Settings, Simulation};

fn ask(model: Model, span_s: f64) -> FrictionQuery {
    let settings = Settings::default();
    FrictionQuery { scene: catalog::draped_slipping(), model, settings, factors: [0.5, 1.5], span_s, hands: Vec::new() }
}

fn find(ask: &FrictionQuery) -> FrictionRange {
    friction_range(ask, |_| ControlFlow::Continue(())).expect("three answers")
}

/// Drawn down over half a turn of a pipe with μ = 0.15, 0.3 and 0.45. With θ from the top, N =
/// T/r + w cos θ and dT/dθ = μ(T + w r cos θ) − w r sin θ, so T₂ = B + (T₁ + B) e^{μπ} with B = 2 μ
/// w r / (1 + μ²). T₁ is the same weight each time.
#[test]
fn a_hand_that_draws_pulls_by_the_capstan_law_of_each_friction() {
    let ask = ask(Model::Spans, 2.0);
    let found = find(&ask);
    assert_eq!(found.failure, None);
    let cable = &ask.scene.cables[0];
    let weight = cable.linear_density_kg_per_m * ask.scene.environment.gravity_m_per_s2;
    let radius = 0.5 + 0.5 * cable.diameter_m;
    let hung = |mu: f64, pull: f64| {
        let b = 2.0 * mu * weight * radius / (1.0 + mu * mu);
        (pull - b) * (-mu * std::f64::consts::PI).exp() - b
    };
    let [low, likely, high] = found.most_n;
    let [a, b, c] = [hung(0.15, low), hung(0.3, likely), hung(0.45, high)];
    // The hand does not stand exactly below the pipe's side, so the turn is not quite half a turn.
    assert!((a / b - 1.0).abs() < 5e-3 && (c / b - 1.0).abs() < 5e-3, "{a} {b} {c}: {:?}", found.most_n);
    let last = found.over_time.last().unwrap();
    assert!((last.at - 2.0).abs() < 1e-9 && last.low_n == low && last.high_n == high, "{last:?} {:?}", found.most_n);
    assert_eq!(found.over_time.len(), 121);
}

#[test]
fn the_answer_of_the_scene_lies_in_the_ribbon() {
    for (model, span_s) in [(Model::Spans, 0.0), (Model::Fem, 0.0), (Model::Spans, 1.5)] {
        let ask = ask(model, span_s);
        let found = find(&ask);
        let mut one = Simulation::new(ask.scene.clone(), model).unwrap();
        one.settle().unwrap();
        while one.time_s() < span_s - 1e-9 {
            one.step_quasi_static(1.0 / 60.0).unwrap();
        }
        let most = one.solution().max_tension().tension_n;
        for n in &one.solution().cables[0].nodes {
            let k = found.along[0].partition_point(|b| b.at < n.arc_length_m).clamp(1, 400);
            let near = &found.along[0][k - 1..=k];
            let low = near.iter().map(|b| b.low_n).fold(f64::INFINITY, f64::min);
            let high = near.iter().map(|b| b.high_n).fold(0.0, f64::max);
            assert!(low - 0.01 * most <= n.tension_n && n.tension_n <= high + 0.01 * most, "{model} {n:?} {near:?}");
        }
        assert!(found.over_time.iter().all(|b| b.low_n <= b.high_n));
    }
}

/// Half a metre down by hand and back up: what the hand did is done to all three, so the middle one
/// is the run itself.
#[test]
fn what_a_hand_did_is_repeated() {
    let mut ask = ask(Model::Spans, 1.0);
    for support in &mut ask.scene.cables[0].supports {
        support.motion = None;
    }
    let held: Vec<usize> = (0..ask.scene.cables[0].supports.len()).collect();
    let support = *held.last().unwrap();
    let from = ask.scene.cables[0].supports[support].at_m.unwrap();
    let y = |t: f64| from[1] - 0.5 + (2.0 * t - 1.0).abs() * 0.5;
    let mut one = Simulation::new(ask.scene.clone(), Model::Spans).unwrap();
    one.settle().unwrap();
    let still = one.largest_n([0]);
    for k in 1..=60 {
        let (time_s, to_m) = (f64::from(k) / 60.0, [from[0], y(f64::from(k) / 60.0)]);
        ask.hands.push(Action { time_s, what: ActionKind::Support { cable: 0, support, to_m } });
        one.drag_support(0, support, cable_core::math::vec2(to_m));
        one.step_quasi_static(1.0 / 60.0).unwrap();
    }
    let found = find(&ask);
    assert_eq!(found.failure, None);
    assert!((found.most_n[1] - one.largest_n([0])).abs() < 1e-6 * still, "{:?} {}", found.most_n, one.largest_n([0]));
    let pulled = found.over_time.iter().map(|b| b.high_n).fold(0.0, f64::max);
    let [low, _, high] = found.most_n;
    assert!(pulled > 1.05 * still && (high - low).abs() > 0.01 * still, "{pulled} {still} {:?}", found.most_n);
    // A support that a hand moved before begins where the hand left it.
    ask.hands =
        vec![Action { time_s: 0.0, what: ActionKind::Support { cable: 0, support, to_m: [from[0], from[1] - 0.2] } }];
    ask.span_s = 0.0;
    let mut there = ask.scene.clone();
    there.cables[0].supports[support].at_m = Some([from[0], from[1] - 0.2]);
    let mut one = Simulation::new(there, Model::Spans).unwrap();
    one.settle().unwrap();
    assert!((find(&ask).most_n[1] - one.largest_n([0])).abs() < 1e-9 * still);
}

#[test]
fn without_friction_anywhere_there_is_no_ribbon() {
    let mut ask = ask(Model::Spans, 0.0);
    ask.scene = with_scaled_friction(&ask.scene, 0.0);
    let found = find(&ask);
    let most = found.most_n[1];
    assert!(found.along[0].iter().all(|b| (b.high_n - b.low_n).abs() <= 1e-9 * most));
}

#[test]
fn every_coefficient_is_scaled_and_nothing_else() {
    let scene = catalog::pulley_waypoints();
    let half = with_scaled_friction(&scene, 0.5);
    assert_eq!(half.cables[0].friction, 0.5 * scene.cables[0].friction);
    let pulleys = half.cables[0].supports.iter().zip(&scene.cables[0].supports);
    assert!(pulleys.clone().all(|(a, b)| a.friction == b.friction.map(|f| 0.5 * f)));
    assert!(pulleys.clone().any(|(a, b)| a.friction != b.friction));
    assert_eq!(with_scaled_friction(&scene, 1.0), scene);
}

#[test]
fn it_ends_when_it_is_told_to() {
    let mut heard = 0;
    let found = friction_range(&ask(Model::Spans, 5.0), |_| {
        heard += 1;
        if heard > 10 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(found.is_ok() && heard == 11);
}
