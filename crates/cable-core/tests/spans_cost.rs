//! What a warm step and a first rest of `spans` cost, in Newton iterations: a change of the method that costs more is seen
//! without a clock. One iteration is one evaluation of all equations and one elimination (`benches/benches/spans.rs` has the
//! same scenes, and times).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::Vec2;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};

/// So many ridges a metre apart, on a rise, with a taut cable that bends at each.
fn ridges(count: usize) -> Scene {
    let height = |x: f64| 0.02 * x * (count as f64 + 1.0 - x);
    let mut points_m = vec![[-5.0, -1.0], [0.5, -1.0]];
    for k in 1..=count {
        let x = k as f64;
        points_m.push([x, height(x)]);
        if k < count {
            points_m.push([x + 0.5, height(x + 0.5) - 0.5]);
        }
    }
    let end = count as f64 + 1.0;
    points_m.extend([[end - 0.5, -1.0], [end + 5.0, -1.0]]);
    let way: f64 = (0..=count).map(|k| (height(k as f64 + 1.0) - height(k as f64)).hypot(1.0)).sum();
    let (a, b) = ([0.0, 0.0], [end, 0.0]);
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    scene.obstacles =
        vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: Some(0.3) }];
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, 1e6, 0.02);
    (c.service_tension_n, c.breaking_tension_n, c.length_m) = (1e15, 1e15, way * 1.0005);
    c.route_m = vec![a, [a[0], 9.0], [b[0], 9.0], b];
    c.supports = vec![Support::fixed("A", a), Support::fixed("B", b)];
    scene
}

/// A held end goes to and fro by 2 mm: every step reverses all friction that acts. Most iterations of a step, and of the rest.
fn cost(count: usize) -> (usize, usize) {
    let scene = ridges(count);
    let last = scene.cables[0].supports[1].at_m.expect("a place");
    let mut model = SpansModel::new(problems(&scene).expect("valid").remove(0), Settings::default()).expect("a model");
    let rest = model.settle().expect("a rest").cost.iterations;
    assert_eq!(model.solution().contacts.len(), count);
    let mut most = 0;
    for k in 0..40 {
        let side = if k % 2 == 0 { 1e-3 } else { -1e-3 };
        model.drag_support(1, Vec2::new(last[0], last[1] + side));
        let taken = model.advance(0.1, Inertia::QuasiStatic).expect("a step").cost;
        assert_eq!(taken.halved_steps, 0, "step {k}");
        most = most.max(taken.iterations);
    }
    println!("{count} contacts: first rest {rest} iterations, warm step at most {most}");
    (rest, most)
}

/// Measured: 4, 5 and 6 in a warm step, 57, 142 and 144 in a first rest.
#[test]
fn a_step_that_reverses_friction_takes_a_handful_of_iterations_whatever_the_number_of_contacts() {
    for (count, rest, warm) in [(1, 60, 5), (10, 150, 6), (36, 160, 7)] {
        let found = cost(count);
        assert!(found.0 <= rest && found.1 <= warm, "{count} contacts: {found:?}, {rest} and {warm} allowed");
    }
}
