//! Whole scenes of `data/composite.json` that the catenary model answers: pulleys with and without friction,
//! loads, wind, temperature. The same checks as the program's acceptance run, through the library.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::solution::{CableSolution, Node, Solution};
use cable_core::{Model, Scene, Simulation};
use serde_json::Value;

fn cases(group: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../data/composite.json")).expect("composite.json");
    let cases = all["cases"].as_array().expect("cases");
    cases.iter().filter(|c| c["group"] == group).cloned().collect()
}

fn interpolate(c: &CableSolution, s: f64, read: impl Fn(&Node) -> f64) -> f64 {
    let n = &c.nodes;
    let k = n.partition_point(|p| p.arc_length_m < s).clamp(1, n.len() - 1);
    let (a, b) = (&n[k - 1], &n[k]);
    let d = b.arc_length_m - a.arc_length_m;
    let f = if d > 0.0 { (s - a.arc_length_m) / d } else { 1.0 };
    read(a) + f * (read(b) - read(a))
}

fn quantity(answer: &Solution, path: &str) -> f64 {
    let c = &answer.cables[0];
    if path == "max_tension_n" {
        return answer.max_tension().tension_n;
    }
    if let Some((name, rest)) = path.split_once('(') {
        let s: f64 = rest.trim_end_matches(')').parse().expect("an arc length");
        return match name {
            "x_at" => interpolate(c, s, |n| n.x_m),
            "y_at" => interpolate(c, s, |n| n.y_m),
            "tension_at" => interpolate(c, s, |n| n.tension_n),
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

fn answer(scene: &str, command: &str) -> Solution {
    let scene = Scene::from_toml(scene).expect("a scene");
    let mut simulation = Simulation::new(scene, Model::Catenary).expect("a model");
    simulation.settle().expect("a resting place");
    if let Some(seconds) = command.strip_prefix("run --quasi-static --for ") {
        let seconds: f64 = seconds.trim_end_matches('s').parse().expect("a time");
        let steps = 60;
        for _ in 0..steps {
            simulation.step_quasi_static(seconds / f64::from(steps)).expect("a step");
        }
    }
    simulation.solution()
}

/// Every check of a group, held to a hundredth of the stated tolerance where the scene has no mesh to excuse it.
fn group(name: &str) {
    let cases = cases(name);
    assert!(cases.len() >= 3);
    let (mut worst, mut checks) = ((0.0, String::new()), 0);
    for case in cases {
        for run in case["runs"].as_array().expect("runs") {
            let got = answer(case["scene"].as_str().expect("a text"), run["command"].as_str().expect("a command"));
            for check in run["checks"].as_array().expect("checks") {
                let path = check["path"].as_str().expect("a path");
                let (expected, tolerance) =
                    (check["expect"].as_f64().expect("a number"), check["tolerance"].as_f64().expect("a number"));
                let value = quantity(&got, path);
                let off = (value - expected).abs() / tolerance;
                checks += 1;
                assert!(
                    off <= 0.01,
                    "{} {path}: {value}, expected {expected} (off by {off:.3} of the tolerance)",
                    case["name"]
                );
                if off > worst.0 {
                    worst = (off, format!("{} {path}", case["name"]));
                }
            }
        }
    }
    println!("{name}: {checks} checks, worst {:.2e} of its tolerance ({})", worst.0, worst.1);
}

#[test]
fn pulleys_hold() {
    group("pulleys");
}

#[test]
fn loads_wind_and_temperature_hold() {
    group("loads-wind-thermal");
}
