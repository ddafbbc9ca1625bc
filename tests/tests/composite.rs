//! These tests compare the answers of models without a mesh with whole scenes of
//! `data/composite.json`, at rest and in slow motion: `spans` floors and corners, beams, posts,
//! pulleys, stick bands, reversals, drags, loads and wind; `catenary` pulleys, loads and wind. They
//! are held to a part of the tolerance that the program's acceptance run states.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::solution::{CableSolution, ContactReport, ContactState, Node, Solution};
use cable_core::{Model, Scene, Simulation};
use serde_json::Value;

/// Steps a second of motion of `spans`.
const STEPS: f64 = 20.0;

/// Steps of a whole motion of `catenary`.
const CATENARY_STEPS: f64 = 60.0;

fn cases(group: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../data/composite.json")).unwrap();
    all["cases"].as_array().unwrap().iter().filter(|c| c["group"] == group).cloned().collect()
}

fn interpolate(c: &CableSolution, s: f64, read: impl Fn(&Node) -> f64) -> f64 {
    let n = &c.nodes;
    let k = n.partition_point(|p| p.arc_length_m < s).clamp(1, n.len() - 1);
    let (a, b) = (&n[k - 1], &n[k]);
    let d = b.arc_length_m - a.arc_length_m;
    let f = if d > 0.0 { ((s - a.arc_length_m) / d).clamp(0.0, 1.0) } else { 1.0 };
    read(a) + f * (read(b) - read(a))
}

fn contacts<'a>(c: &'a CableSolution, name: &str) -> Vec<&'a ContactReport> {
    c.contacts.iter().filter(|q| q.obstacle == name).collect()
}

/// Shapes at whole seconds on the way, and the last answer.
struct Run {
    seconds: Vec<Solution>,
    last: Solution,
}

fn number(run: &Run, path: &str) -> f64 {
    let c = &run.last.cables[0];
    if path == "max_tension_n" {
        return run.last.max_tension().tension_n;
    }
    if let Some((name, rest)) = path.split_once('(') {
        let rest = rest.strip_suffix(')').unwrap();
        let parts: Vec<&str> = rest.splitn(2, ',').map(str::trim).collect();
        let s = || parts[0].parse::<f64>().unwrap();
        let moved = || {
            let then = &run.seconds[parts[1].parse::<usize>().unwrap()].cables[0];
            let d = |read: fn(&Node) -> f64| interpolate(c, s(), read) - interpolate(then, s(), read);
            (d(|n| n.x_m), d(|n| n.y_m))
        };
        return match name {
            "x_at" => interpolate(c, s(), |n| n.x_m),
            "y_at" => interpolate(c, s(), |n| n.y_m),
            "tension_at" => interpolate(c, s(), |n| n.tension_n),
            "moved_y" => moved().1,
            "moved_along" => moved().0.hypot(moved().1),
            "ratio" => number(run, parts[0]) / number(run, parts[1]),
            "contact_before" => contacts(c, rest)[0].tension_before_n,
            "contact_after" => contacts(c, rest).last().unwrap().tension_after_n,
            "contact_sum" if parts[1] == "normal_n" => contacts(c, parts[0]).iter().map(|q| q.normal_n.abs()).sum(),
            "contact_sum" if parts[1] == "turn_deg" => contacts(c, parts[0]).iter().map(|q| q.turn_deg.abs()).sum(),
            other => panic!("{other}"),
        };
    }
    let parts: Vec<&str> = path.split('.').collect();
    let support = c.supports.iter().find(|s| s.name == parts[1]).expect("a support");
    match parts[2] {
        "reaction_x_n" => support.reaction_x_n,
        "reaction_y_n" => support.reaction_y_n,
        "arc_length_m" => support.arc_length_m,
        "tension_before_n" => support.tension_before_n.expect("a pulley"),
        "tension_after_n" => support.tension_after_n.expect("a pulley"),
        other => panic!("{other}"),
    }
}

/// None where there is no resting place.
fn answer(model: Model, scene: &str, command: &str) -> Option<Run> {
    let scene = Scene::from_toml(scene).expect("a scene");
    let mut simulation = Simulation::new(scene, model).expect("a model");
    let mut last = simulation.settle().ok()?;
    let mut seconds = vec![last.clone()];
    if let Some(time) = command.strip_prefix("run --quasi-static --for ") {
        let time: f64 = time.trim_end_matches('s').parse().expect("a time");
        let rate = if model == Model::Catenary { CATENARY_STEPS / time } else { STEPS };
        for k in 1..=(time * rate).round() as usize {
            simulation.step_quasi_static(1.0 / rate).unwrap_or_else(|e| panic!("{command}, step {k}: {e}"));
            if k % rate as usize == 0 {
                seconds.push(simulation.solution());
            }
        }
        last = simulation.solution();
    }
    Some(Run { seconds, last })
}

/// Every check of a group, held to a part of the stated tolerance.
fn group(model: Model, name: &str, part: f64) {
    let cases = cases(name);
    assert!(cases.len() >= 3);
    let (mut worst, mut checks) = ((0.0, String::new()), 0);
    for case in cases {
        let name = case["name"].as_str().unwrap();
        for run in case["runs"].as_array().unwrap() {
            let command = run["command"].as_str().unwrap();
            if command.starts_with("run --for") {
                continue;
            }
            let got = answer(model, case["scene"].as_str().unwrap(), command);
            for check in run["checks"].as_array().unwrap() {
                let path = check["path"].as_str().unwrap();
                checks += 1;
                if path == "exit_code" {
                    assert!(got.is_none(), "{name}: nothing can hold this");
                    continue;
                }
                let got = got.as_ref().unwrap_or_else(|| panic!("{name}: no rest"));
                if path.starts_with("contact_states") {
                    assert_eq!(check["equals"], "stick");
                    assert!(contacts(&got.last.cables[0], "post").iter().all(|c| c.state == ContactState::Stick));
                    continue;
                }
                let value = number(got, path);
                if let Some(least) = check["min"].as_f64() {
                    assert!(value >= least && value <= check["max"].as_f64().unwrap(), "{name} {path}: {value}");
                    continue;
                }
                let (expected, tolerance) = (check["expect"].as_f64().unwrap(), check["tolerance"].as_f64().unwrap());
                let off = (value - expected).abs() / tolerance;
                assert!(off <= part, "{name} {path}: {value}, expected {expected} (off by {off:.3} of the tolerance)");
                if off > worst.0 {
                    worst = (off, format!("{name} {path}"));
                }
            }
        }
    }
    println!("{name}: {checks} checks, worst {:.2e} of its tolerance ({})", worst.0, worst.1);
}

#[test]
fn floors_and_corners_hold() {
    group(Model::Spans, "floor-corner", 0.02);
}

#[test]
fn beams_hold() {
    group(Model::Spans, "beams", 0.02);
}

#[test]
fn posts_hold() {
    group(Model::Spans, "post", 0.02);
}

#[test]
fn pulleys_hold() {
    group(Model::Spans, "pulleys", 0.02);
}

#[test]
fn stick_bands_hold() {
    group(Model::Spans, "stick-band", 0.2);
}

#[test]
fn reversals_hold() {
    group(Model::Spans, "reversal", 0.02);
}

#[test]
fn drags_hold() {
    group(Model::Spans, "drag", 0.02);
}

#[test]
fn loads_wind_and_temperature_hold() {
    group(Model::Spans, "loads-wind-thermal", 0.02);
}

#[test]
fn catenary_pulleys_hold() {
    group(Model::Catenary, "pulleys", 0.01);
}

#[test]
fn catenary_loads_wind_and_temperature_hold() {
    group(Model::Catenary, "loads-wind-thermal", 0.01);
}
