//! `spans` says where a cable loses its tension, of what kind, and not before. Each kind is
//! compared with a judge that knows nothing of the solver, and so for what it must still take on
//! the way there.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::catenary::{Catenary, Span};
use cable_core::error::TensionLoss;
use cable_core::model::spans::SpansModel;
use cable_core::model::{Inertia, Mechanics, Settings};
use cable_core::problem::problems;
use cable_core::scene::{Obstacle, Scene, Shape, Support, catalog};
use cable_core::{SolveError, Vec2};

const RADIUS: f64 = 0.01;
/// Weight per metre, N/m.
const WEIGHT: f64 = 9.806_65;

/// A cable of 1 kg/m from a to b over shapes.
fn scene(shapes: Vec<Shape>, route_m: Vec<[f64; 2]>, (length_m, friction, stiffness): (f64, f64, f64)) -> Scene {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    let named = |(k, shape)| Obstacle { name: format!("obstacle {k}"), shape, friction: None };
    scene.obstacles = shapes.into_iter().enumerate().map(named).collect();
    let c = &mut scene.cables[0];
    (c.bending_stiffness_n_m2, c.axial_stiffness_n, c.diameter_m) = (0.0, stiffness, 2.0 * RADIUS);
    (c.service_tension_n, c.breaking_tension_n, c.linear_density_kg_per_m) = (1e15, 1e15, 1.0);
    (c.length_m, c.friction) = (length_m, friction);
    c.supports = vec![Support::fixed("A", route_m[0]), Support::fixed("B", *route_m.last().unwrap())];
    c.route_m = route_m;
    scene
}

fn model(scene: &Scene) -> SpansModel {
    let mut model = SpansModel::new(problems(scene).unwrap().remove(0), Settings::default()).unwrap();
    model.settle().unwrap();
    model
}

fn floor() -> Shape {
    Shape::Terrain { points_m: vec![[-50.0, 0.0], [50.0, 0.0]] }
}

/// Moves a support in steps until tension is lost: how far it had come, and what was said.
fn until_lost(m: &mut SpansModel, support: usize, (from, step, most): (Vec2, Vec2, usize)) -> (f64, TensionLoss, f64) {
    for k in 1..=most {
        m.drag_support(support, from + step * k as f64);
        match m.advance(0.1, Inertia::QuasiStatic) {
            Ok(_) => {}
            Err(SolveError::TensionLost { loss, arc_length_m, .. }) => {
                return (step.norm() * (k - 1) as f64, loss, arc_length_m);
            }
            Err(e) => panic!("step {k}: {e}"),
        }
    }
    panic!("tension is never lost");
}

/// An end that lies on a floor without tension is drawn along it by d and pushed back. Drawn it
/// slides over x with T = μwx at the end, which lengthens it by d = T²/2EAμw. Pushed back every
/// tension falls by twice what friction takes, and is gone at the end half way back, T − 2μwy = 0
/// with y = x/2 and d' = Ty/2EA = d/2: no step before that may be refused, none behind it taken.
#[test]
fn a_lay_goes_slack_where_its_end_has_been_pushed_half_way_back() {
    let (friction, stiffness) = (0.5, 1e5);
    let route = vec![[0.0, RADIUS], [20.0, RADIUS], [24.0, 3.0]];
    let way = 20.0 + 4.0f64.hypot(3.0 - RADIUS);
    let mut m = model(&scene(vec![floor()], route, (way * 1.002, friction, stiffness)));
    assert!(m.solution().nodes[0].tension_n == 0.0, "friction has taken all tension up");
    let (drawn, steps) = (1.6e-3, 200);
    m.drag_support(0, Vec2::new(-drawn, RADIUS));
    m.advance(0.1, Inertia::QuasiStatic).unwrap();
    let tension = (2.0 * stiffness * friction * WEIGHT * drawn).sqrt();
    let found = m.solution().nodes[0].tension_n;
    assert!((found / tension - 1.0).abs() <= 1e-3, "{found}, by the law {tension}");
    let step = drawn / f64::from(steps);
    let (lost, loss, at) = until_lost(&mut m, 0, (Vec2::new(-drawn, RADIUS), Vec2::new(step, 0.0), 150));
    assert_eq!(loss, TensionLoss::Lay);
    assert!((lost - 0.5 * drawn).abs() <= 1.01 * step, "{lost} of {drawn}");
    assert!(at < 0.1, "{at} m along it");
}

/// Lying on a rough floor and drawn up to an end that comes back over the lay: the span stands
/// straight up where the material is just what lies and what hangs, x = L − h, and folds beyond.
#[test]
fn an_end_span_folds_where_its_support_stands_over_its_touchdown() {
    let height = 2.0;
    let (length, stiffness) = (12.0, 1e8);
    let s = scene(vec![floor()], vec![[0.0, RADIUS], [9.0, RADIUS], [11.0, height + RADIUS]], (length, 0.8, stiffness));
    let mut m = model(&s);
    let far = 11.0 - (length - height);
    let (lost, loss, _) = until_lost(&mut m, 1, (Vec2::new(11.0, height + RADIUS), Vec2::new(-1e-3, 0.0), 2000));
    assert_eq!(loss, TensionLoss::Fold);
    // A catenary from the floor with H left: H = w (s² − h²)/2h, and x less than s by what it bows.
    assert!(lost <= far + 1e-3 && far - lost <= 0.05, "{lost}, by its length {far}");
    // The lay has not moved: what stuck on it sticks, and nothing of it pushes.
    assert!(m.solution().nodes.iter().all(|n| n.tension_n >= 0.0));
}

/// Between a pulley and its touchdown on a rough floor: the pulley is carried over the touchdown
/// together with the end before it. Straight up its span has T = wh at the pulley, and so has the
/// span before, whose length one catenary tells: with it the place of the pulley is where all
/// material is used up.
#[test]
fn a_span_between_contacts_goes_slack_where_its_pulley_stands_over_its_touchdown() {
    let (height, length, stiffness) = (4.0, 16.1, 1e8);
    let (a, pulley, b) = ([-1.5, 4.5], [0.0, height + RADIUS], [12.0, RADIUS]);
    let route = vec![a, pulley, [2.0, RADIUS], b];
    let mut s = scene(vec![floor()], route, (length, 0.8, stiffness));
    let wheel = Support { radius_m: Some(0.0), friction: Some(0.0), ..Support::pulley("P", pulley) };
    s.cables[0].supports.insert(1, wheel);
    let mut m = model(&s);
    // The taut span from A to the pulley that is drawn by wh there: the longer, the less.
    let chord = Vec2::new(pulley[0] - a[0], pulley[1] - a[1]);
    let pull = |length: f64| {
        let weight = Vec2::new(0.0, -WEIGHT);
        let span = Span { chord, length, weight, axial_stiffness: stiffness, thermal_stretch: 1.0 };
        Catenary::solve(&span).unwrap().tension_at(length)
    };
    let (mut low, mut high) = (chord.norm(), 1.2 * chord.norm());
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pull(middle) > WEIGHT * height { low = middle } else { high = middle }
    }
    let far = low + height + b[0] - length;
    let step = 1e-3;
    let mut lost = None;
    for k in 1..=2000 {
        let by = step * f64::from(k);
        m.drag_support(0, Vec2::new(a[0] + by, a[1]));
        m.drag_support(1, Vec2::new(pulley[0] + by, pulley[1]));
        match m.advance(0.1, Inertia::QuasiStatic) {
            Ok(_) => {}
            Err(SolveError::TensionLost { loss, .. }) => {
                lost = Some((by - step, loss));
                break;
            }
            Err(e) => panic!("step {k}: {e}"),
        }
    }
    let (lost, loss) = lost.unwrap();
    assert_eq!(loss, TensionLoss::Span);
    assert!(lost <= far + step && far - lost <= 0.1, "{lost}, by its length {far}");
}
