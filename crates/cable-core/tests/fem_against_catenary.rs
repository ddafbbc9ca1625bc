//! These tests compare two independent solvers of the same question: FEM statics against the
//! elastic catenary, on random supports, pulleys, wheels, friction, loads, wind and temperature.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{PulleySide, Scene, Support, catalog};
use cable_core::{Load, Model, Settings, Simulation, SolveError};
use proptest::prelude::*;

#[derive(Clone, Debug)]
struct Pulleys {
    heights: Vec<f64>,
    radius: f64,
    friction: f64,
}

/// Points that rub, or wheels that do not: where both come together the models lay the cable
/// differently at first, and friction keeps that for ever.
fn pulleys() -> impl Strategy<Value = Pulleys> {
    let kind = prop_oneof![Just((0.0, 0.0)), Just((0.15, 0.0)), Just((0.0, 0.2))];
    (prop::collection::vec(0.3..2.0f64, 0..4), kind).prop_map(|(heights, (radius, friction))| Pulleys {
        heights,
        radius,
        friction,
    })
}

/// A cable from (0, 0) over pulleys 4 m apart to a fixed end, `spare` longer than the straight way.
fn scene(pulleys: &Pulleys, spare: f64, ea: f64, wind: f64, load: Option<(f64, f64)>) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.environment.wind_n_per_m = [wind, 0.3 * wind];
    scene.environment.temperature_change_k = 25.0;
    let cable = &mut scene.cables[0];
    cable.axial_stiffness_n = ea;
    cable.bending_stiffness_n_m2 = 0.0;
    cable.breaking_tension_n = 1e15;
    cable.service_tension_n = 1e15;
    cable.route_m.clear();
    cable.segments = None;
    cable.supports = vec![Support::fixed("A", [0.0, 0.0])];
    let (mut last, mut way) = ([0.0, 0.0], 0.0);
    for (k, &height) in pulleys.heights.iter().enumerate() {
        // Up and down by turns, so that each presses on its wheel.
        let over = k % 2 == 0;
        let at = [4.0 * (k + 1) as f64, if over { height } else { -height }];
        way += f64::hypot(at[0] - last[0], at[1] - last[1]);
        last = at;
        let mut support = Support::pulley(format!("P{k}"), at);
        support.radius_m = Some(pulleys.radius);
        support.friction = Some(pulleys.friction);
        support.side = Some(if over { PulleySide::Over } else { PulleySide::Under });
        cable.supports.push(support);
    }
    let end = [4.0 * (pulleys.heights.len() + 1) as f64, 0.0];
    way += f64::hypot(end[0] - last[0], end[1] - last[1]);
    cable.supports.push(Support::fixed("B", end));
    cable.length_m = way * spare;
    scene.loads = load
        .map(|(part, force)| Load {
            cable: cable.name.clone(),
            arc_length_m: part * cable.length_m / (pulleys.heights.len() + 1) as f64,
            force_n: Some([0.2 * force, -force]),
            times_s: Vec::new(),
            forces_n: Vec::new(),
        })
        .into_iter()
        .collect();
    scene
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn both_say_the_same(
        pulleys in pulleys(),
        spare in 1.0005..1.08f64,
        log_ea in 4.0..7.0f64,
        wind in prop_oneof![Just(0.0), -3.0..3.0f64],
        load in prop::option::of((0.3..0.6f64, 5.0..60.0f64)),
    ) {
        let scene = scene(&pulleys, spare, 10f64.powf(log_ea), wind, load);
        let settings = Settings { tolerance: 1e-7, ..Settings::default() };
        let settle = |model| Simulation::with_settings(scene.clone(), model, settings).unwrap().settle();
        // With friction the rest is not unique: `fem` lays the cable as `spans` does, the catenary
        // by another rule.
        let shared = pulleys.friction > 0.0;
        let (fem, catenary) = (settle(Model::Fem), settle(if shared { Model::Spans } else { Model::Catenary }));
        match (fem, catenary) {
            (Ok(fem), Ok(catenary)) => {
                let largest = catenary.max_tension().tension_n;
                // On a wheel the largest tension lies at the top, between nodes that the models
                // place differently.
                let off = (fem.max_tension().tension_n - largest).abs();
                let nodes = if pulleys.radius > 0.0 { 1e-3 } else { 1e-6 };
                prop_assert!(off < nodes * largest, "largest tension {} against {largest}", fem.max_tension().tension_n);
                for (a, b) in fem.cables[0].supports.iter().zip(&catenary.cables[0].supports) {
                    let off = (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n);
                    prop_assert!(off < 1e-5 * largest, "{}: {a:?} against {b:?}", a.name);
                    prop_assert!((a.arc_length_m - b.arc_length_m).abs() < 1e-5, "{}: {a:?} against {b:?}", a.name);
                }
            }
            (Err(e), Ok(_)) => prop_assert!(false, "only the catenary answers: {e}"),
            (_, Err(SolveError::NonFinite { .. })) => prop_assert!(false, "a number blew up"),
            (_, Err(_)) => {}
        }
    }
}
