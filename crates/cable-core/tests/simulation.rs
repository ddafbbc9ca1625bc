//! These tests use the object that users hold, over several cables, and pin the Newton iterations
//! of the scenes that everybody uses.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Motion, Scene, catalog};
use cable_core::solution::{ErrorEstimates, NeglectedEffect};
use cable_core::{Model, Simulation, SolveError};

/// Two spans: the first moves, the second is let go at both ends at 0.05 s.
fn one_moves_one_is_let_go() -> Scene {
    let mut scene = catalog::hanging_span();
    let mut second = scene.cables[0].clone();
    let at = scene.cables[0].supports[1].at_m.unwrap();
    scene.cables[0].supports[1].motion =
        Some(Motion { times_s: vec![0.0, 1.0], points_m: vec![at, [at[0] - 1.0, at[1]]] });
    second.name = "second".to_owned();
    for support in &mut second.supports {
        support.release_s = Some(0.05);
    }
    scene.cables.push(second);
    scene
}

#[test]
fn where_one_cable_fails_none_has_moved() {
    let mut simulation = Simulation::new(one_moves_one_is_let_go(), Model::Catenary).unwrap();
    simulation.settle().unwrap();
    simulation.step_quasi_static(0.04).unwrap();
    let (before, answer) = (simulation.states(), simulation.solution());
    let error = simulation.step_quasi_static(0.2).unwrap_err();
    assert!(matches!(error, SolveError::NoRestingPlace { .. }), "{error}");
    assert_eq!(simulation.states(), before);
    assert_eq!(simulation.solution(), answer);
    // And it goes on from there.
    simulation.step_quasi_static(0.005).unwrap();
    assert!(simulation.states().iter().all(|s| (s.time_s - 0.045).abs() < 1e-12));
    assert_ne!(simulation.states()[0], before[0]);
}

#[test]
fn slow_steps_that_nobody_sees_change_nothing() {
    let answer = |pieces: usize| {
        let mut scene = one_moves_one_is_let_go();
        scene.cables.pop();
        let mut simulation = Simulation::new(scene, Model::Catenary).unwrap();
        simulation.settle().unwrap();
        for _ in 0..pieces {
            simulation.step_quasi_static(1.0 / pieces as f64).unwrap();
        }
        simulation.solution()
    };
    let (one, many) = (answer(1), answer(64));
    let (a, b) = (one.max_tension().tension_n, many.max_tension().tension_n);
    assert!((a - b).abs() < 1e-9 * a, "{a} {b}");
}

/// Newton iterations of `settle` on the catalogue scenes without obstacles. Fewer is better: change
/// the number then. More means a worse start, line search or Jacobian: find out which before
/// changing it.
const ITERATIONS: [(&str, Model, usize); 11] = [
    ("hanging-span", Model::Catenary, 4),
    ("hanging-span", Model::Fem, 4),
    ("steep-span", Model::Catenary, 4),
    ("steep-span", Model::Fem, 4),
    ("near-taut", Model::Catenary, 2),
    ("near-taut", Model::Fem, 2),
    // A wheel: its touch points are found in rounds, each a balance of its own.
    ("pulley-waypoints", Model::Catenary, 226),
    ("pulley-waypoints", Model::Fem, 18),
    ("clamped-stiff", Model::Fem, 10),
    ("loads-wind-heat", Model::Catenary, 5),
    ("loads-wind-heat", Model::Fem, 5),
];

#[test]
fn iterations_of_the_catalogue_stay_as_they_are() {
    let mut found = Vec::new();
    for (id, scene) in catalog::all() {
        if !scene.obstacles.is_empty() {
            continue;
        }
        for model in [Model::Catenary, Model::Fem] {
            let Ok(mut simulation) = Simulation::new(scene.clone(), model) else { continue };
            if let Ok(answer) = simulation.settle() {
                found.push((id, model, answer.cost.iterations));
            }
        }
    }
    assert_eq!(found, ITERATIONS, "{found:#?}");
}

/// `auto` draws a cable with friction over two wheels to the end, as the capstan says: `catenary`
/// found no balance on the way.
#[test]
fn a_cable_that_rubs_on_wheels_is_drawn_to_the_end() {
    let text = r#"
version = 1
name = "two wheels"
[[cables]]
name = "c"
length_m = 6.2036
linear_density_kg_per_m = 0.3820095017632952
axial_stiffness_n = 29276.49031617108
bending_stiffness_n_m2 = 0.0
diameter_m = 0.002
service_tension_n = 1e12
breaking_tension_n = 1e12
supports = [
  { name = "A", kind = "fixed", at_m = [0.0, 0.45987739593123295] },
  { name = "P1", kind = "pulley", at_m = [1.7564249758031634, 0.17340276563541712], radius_m = 0.0639153339940018, friction = 0.13551670695112508 },
  { name = "P2", kind = "pulley", at_m = [3.828141911987024, 0.2493026713567143], radius_m = 0.0639153339940018, friction = 0.13551670695112508 },
  { name = "B", kind = "fixed", at_m = [5.779522889041098, 0.04115231597696779], motion = { times_s = [0.0, 6.0], points_m = [[5.779522889041098, 0.04115231597696779], [5.89930465698678, 0.010018452143435507]] } },
]
"#;
    let mut simulation = Simulation::new(Scene::from_toml(text).unwrap(), Model::Auto).unwrap();
    simulation.settle().unwrap();
    for _ in 0..360 {
        simulation.step_quasi_static(1.0 / 60.0).unwrap();
    }
    let cable = simulation.solution().cables.remove(0);
    let turn = |s: f64| {
        let k = cable.nodes.partition_point(|n| n.arc_length_m < s).clamp(1, cable.nodes.len() - 1);
        let d = cable.nodes[k].at() - cable.nodes[k - 1].at();
        d.y.atan2(d.x)
    };
    for support in &cable.supports[1..3] {
        let ratio = (support.tension_after_n.unwrap() / support.tension_before_n.unwrap()).ln();
        // Directions just off the wheel, on which the cable weighs a thirtieth of its tension.
        let (before, after) = (turn(support.arc_length_m - 0.04), turn(support.arc_length_m + 0.04));
        let capstan = 0.13551670695112508 * (before - after).abs();
        assert!((ratio / capstan - 1.0).abs() < 0.1, "{}: {ratio} instead of {capstan}", support.name);
    }
}

/// A cable let go at both ends falls as a stone: its nodes say how far and how fast.
#[test]
fn nodes_say_how_far_they_came_and_how_their_speed_changes() {
    for model in [Model::Fem, Model::MassSpring] {
        let mut scene = catalog::hanging_span();
        for s in &mut scene.cables[0].supports {
            s.release_s = Some(1e-6);
        }
        let g = scene.environment.gravity_m_per_s2;
        let mut sim = Simulation::new(scene, model).unwrap();
        sim.settle().unwrap();
        let rest = sim.solution().cables[0].nodes.clone();
        assert!(rest.iter().all(|n| n.displacement_m == [0.0; 2] && n.acceleration_m_per_s2 == [0.0; 2]));
        for _ in 0..60 {
            sim.step(1.0 / 240.0).unwrap();
        }
        // The release of its ends leaves waves; the centre of mass does not feel them.
        let nodes = &sim.solution().cables[0].nodes;
        let mean = |of: &dyn Fn(&cable_core::solution::Node) -> f64| {
            let length = nodes[nodes.len() - 1].arc_length_m;
            let part = |w: &[cable_core::solution::Node]| {
                0.5 * (of(&w[0]) + of(&w[1])) * (w[1].arc_length_m - w[0].arc_length_m) / length
            };
            nodes.windows(2).map(part).sum::<f64>()
        };
        let (fell, pulled) = (mean(&|n| n.displacement_m[1]), mean(&|n| n.acceleration_m_per_s2[1]));
        println!("{model}: fell by {fell} m, {pulled} m/s²");
        assert!((fell / (-0.5 * g * 0.0625) - 1.0).abs() < 1e-2, "{model}: {fell} m");
        assert!((pulled / -g - 1.0).abs() < 1e-3, "{model}: {pulled} m/s²");
    }
}

/// `auto` says what the next cheaper choice would have cost: for a cable over a beam, what the
/// catenary differs by that falls through it; for a stiff cable, the flexible one; nothing for a
/// catenary, for a model that was asked for, or once something moves.
#[test]
fn the_next_cheaper_choice_is_said_with_its_error() {
    let answer = |scene: &Scene, model| {
        let mut sim = Simulation::new(scene.clone(), model).unwrap();
        let at_rest = sim.settle().unwrap();
        sim.step_quasi_static(0.01).unwrap();
        assert_eq!(sim.solution().next_cheaper, None);
        at_rest
    };
    let scene = catalog::over_beam();
    let found = answer(&scene, Model::Auto);
    let next = found.next_cheaper.unwrap();
    assert_eq!((next.model, next.neglects), (Model::Catenary, NeglectedEffect::Obstacles));
    let mut bare = scene.clone();
    bare.obstacles.clear();
    let catenary = answer(&bare, Model::Auto);
    assert_eq!(catenary.next_cheaper, None);
    let apart = ErrorEstimates::between(&catenary.cables[0], &found.cables[0]);
    assert_eq!(next.force_error, apart.relative(&found.cables[0]));
    assert_eq!(next.position_error_m, apart.position_m);
    assert_eq!(answer(&scene, Model::Spans).next_cheaper, None);

    let mut stiff = bare;
    stiff.cables[0].bending_stiffness_n_m2 = 1.0;
    let next = answer(&stiff, Model::Auto).next_cheaper.unwrap();
    assert_eq!((next.model, next.neglects), (Model::Catenary, NeglectedEffect::BendingStiffness));
    assert!(next.force_error.unwrap() < 0.05, "{next:?}");
}
