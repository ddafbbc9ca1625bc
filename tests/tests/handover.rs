//! One model goes on where another came to: the shape, the tensions, and what friction holds.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::math::Vec2;
use cable_core::model::{Inertia, Mechanics, Settings, build};
use cable_core::problem::problems;
use cable_core::solution::CableSolution;
use cable_core::{Model, Scene, Simulation};
use serde_json::Value;

/// Groups of `data/composite.json` in which friction holds something.
const GROUPS: [&str; 5] = ["floor-corner", "beams", "post", "reversal", "drag"];

/// Steps of 0.05 s after which it is handed over: some of it slides and some of it sticks.
const STEPS: [usize; 4] = [7, 15, 23, 30];

fn scenes() -> Vec<(String, Scene)> {
    let all: Value = serde_json::from_str(include_str!("../data/composite.json")).unwrap();
    let cases = all["cases"].as_array().unwrap().iter();
    let of_group = cases.filter(|c| GROUPS.iter().any(|g| c["group"] == *g));
    let scene = |c: &Value| (c["name"].as_str().unwrap().to_owned(), Scene::from_toml(c["scene"].as_str().unwrap()));
    of_group.map(scene).filter_map(|(name, scene)| Some((name, scene.ok()?))).collect()
}

fn model(scene: &Scene, model: Model, segments: Option<usize>) -> Option<Box<dyn Mechanics>> {
    let settings = Settings { segments, ..Settings::default() };
    build(model, problems(scene).ok()?.first()?.clone(), settings).ok()
}

/// `spans` somewhere on the way.
fn on_the_way(scene: &Scene, steps: usize) -> Option<Box<dyn Mechanics>> {
    let mut spans = model(scene, Model::Spans, None)?;
    spans.settle().ok()?;
    for _ in 0..steps {
        spans.advance(0.05, Inertia::QuasiStatic).ok()?;
    }
    Some(spans)
}

fn greatest(a: &CableSolution) -> f64 {
    a.nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max)
}

/// Returns how far the nodes of one answer are from the curve of another, m, and the greatest
/// difference of the supports' forces, of the greatest tension.
fn apart(fine: &CableSolution, coarse: &CableSolution) -> (f64, f64) {
    let mut shape = 0.0_f64;
    for n in &coarse.nodes {
        let near = |w: &[cable_core::solution::Node]| {
            let (a, b) = (w[0].at(), w[1].at());
            let d = b - a;
            let f = if d.norm() > 0.0 { ((n.at() - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
            (a + d * f - n.at()).norm()
        };
        shape = shape.max(fine.nodes.windows(2).map(near).fold(f64::INFINITY, f64::min));
    }
    let force = |a: &CableSolution, k: usize| Vec2::new(a.supports[k].reaction_x_n, a.supports[k].reaction_y_n);
    let forces = (0..fine.supports.len()).map(|k| (force(fine, k) - force(coarse, k)).norm()).fold(0.0, f64::max);
    (shape, forces / greatest(fine))
}

#[test]
fn spans_go_on_from_their_own_answer_as_if_nothing_had_been() {
    let mut tried = 0;
    for ((name, scene), steps) in scenes().iter().flat_map(|s| STEPS.map(|n| (s, n))) {
        let Some(old) = on_the_way(scene, steps).filter(|m| greatest(&m.solution()) > 0.0) else { continue };
        let mut new = model(scene, Model::Spans, None).unwrap();
        new.warm_start(&old.solution(), old.time_s()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (shape, force) = apart(&old.solution(), &new.solution());
        // Their nodes lie elsewhere on the curve, and between nodes it is a chord. Of the cone 1e-5
        // is left unused.
        assert!(shape < 1e-3 && force < 2e-5, "{name}: {shape:.1e} m, {force:.1e}");
        tried += 1;
    }
    assert!(tried >= 15, "{tried}");
}

#[test]
#[ignore = "open: spans refuses 6 of 68 answers of fem; the rest agree within 1.1e-3 after 1.5 s (1e-3 asked)"]
fn friction_holds_on_when_fem_goes_on_from_spans_and_back() {
    let (mut worst, mut last, mut within, mut tried, mut refused) = ([0.0_f64; 4], [0.0_f64; 4], 0, 0, 0);
    for ((name, scene), steps) in scenes().iter().flat_map(|s| STEPS.map(|n| (s, n))) {
        let Some(old) = on_the_way(scene, steps).filter(|m| greatest(&m.solution()) > 0.0) else { continue };
        let before = old.solution();
        let mut fem = model(scene, Model::Fem, None).unwrap();
        fem.warm_start(&before, old.time_s()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let there = apart(&before, &fem.solution());
        let mut back = model(scene, Model::Spans, None).unwrap();
        if let Err(e) = back.warm_start(&fem.solution(), fem.time_s()) {
            println!("{name}: refused: {e}");
            refused += 1;
            continue;
        }
        let again = apart(&back.solution(), &fem.solution());
        println!(
            "{name}, step {steps}: to fem {:.2} mm, {:.1e}; to spans {:.2} mm, {:.1e}",
            1e3 * there.0,
            there.1,
            1e3 * again.0,
            again.1
        );
        let found = [there.0, there.1, again.0, again.1];
        for (w, v) in worst.iter_mut().zip(found) {
            *w = w.max(v);
        }
        if steps == STEPS[3] {
            for (w, v) in last.iter_mut().zip(found) {
                *w = w.max(v);
            }
        }
        within += usize::from(found.iter().all(|v| *v <= 1e-3));
        tried += 1;
    }
    println!(
        "worst of {tried}: {worst:?}, refused {refused}; {within} within 1 mm and 1e-3; worst after 1.5 s: {last:?}"
    );
    assert!(tried >= 60 && refused <= 1, "{tried} {refused}");
    assert!(last.iter().all(|v| *v <= 1e-3), "after 1.5 s: {last:?}");
    // At the beginning of a pull tensions are a few newtons, and the front of sliding is as wide as
    // a bar.
    assert!(worst.iter().all(|v| *v < 1e-2) && 20 * within >= 17 * tried, "{within} of {tried}: {worst:?}");
}

/// A cable of 10 m on a floor, whose end is let down until more of it lies there than there is way,
/// and drawn up again.
fn let_down() -> Scene {
    Scene::from_toml(
        r#"
version = 1
name = "let down"

[environment]
gravity_m_per_s2 = 9.80665

[[cables]]
name = "c"
length_m = 10.0
linear_density_kg_per_m = 0.5
axial_stiffness_n = 1e5
bending_stiffness_n_m2 = 0.0
diameter_m = 0.02
damping_ratio = 0.02
service_tension_n = 1e12
breaking_tension_n = 1e12
friction = 0.3
route_m = [[0.0, 0.01], [5.0, 0.01], [8.4, 4.5]]

  [[cables.supports]]
  name = "A"
  kind = "fixed"
  at_m = [0.0, 0.01]

  [[cables.supports]]
  name = "B"
  kind = "fixed"
  at_m = [8.4, 4.5]
  motion = { times_s = [0.0, 2.0, 4.0], points_m = [[8.4, 4.5], [8.4, 0.8], [8.4, 4.5]] }

[[obstacles]]
name = "floor"
kind = "terrain"
points_m = [[-5.0, 0.0], [20.0, 0.0]]
friction = 0.3
"#,
    )
    .unwrap()
}

/// Once with two models in turn, once with `fem` alone: who answers, and the force on the end that
/// moves.
#[test]
fn auto_hands_a_cable_that_goes_slack_to_fem_and_takes_it_back() {
    let run = |model: Model| {
        let mut sim = Simulation::new(let_down(), model).unwrap();
        sim.settle().unwrap();
        let mut out = Vec::new();
        for k in 0..80 {
            sim.step_quasi_static(0.05).unwrap_or_else(|e| panic!("{model}, step {k}: {e}"));
            let a = sim.solution();
            assert!((a.time_s - 0.05 * f64::from(k + 1)).abs() < 1e-9);
            let s = &a.cables[0].supports[1];
            out.push((a.model, Vec2::new(s.reaction_x_n, s.reaction_y_n), a.reason.to_string()));
        }
        out
    };
    let (auto, fem) = (run(Model::Auto), run(Model::Fem));
    let greatest = fem.iter().map(|f| f.1.norm()).fold(0.0, f64::max);
    let mut turns = vec![auto[0].0];
    for (k, (a, f)) in auto.iter().zip(&fem).enumerate() {
        if turns.last() != Some(&a.0) {
            turns.push(a.0);
        }
        let off = (a.1 - f.1).norm() / greatest;
        assert!(off < 5e-3, "step {k} by {}: {off:.1e}", a.0);
        assert_eq!(a.0 == Model::Fem, a.2.contains("a span folds"), "{}", a.2);
    }
    assert_eq!(turns, [Model::Spans, Model::Fem, Model::Spans]);
}
