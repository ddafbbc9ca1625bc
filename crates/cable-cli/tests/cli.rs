//! The program from outside: arguments, exit codes, what it prints and writes.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use cable_core::scene::catalog;
use serde_json::Value;

fn cable(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cable")).args(arguments).stdin(Stdio::null()).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The catalogue's hanging span in a file.
fn span(folder: &Path) -> PathBuf {
    let file = folder.join("span.toml");
    std::fs::write(&file, catalog::hanging_span().to_toml()).unwrap();
    file
}

#[test]
fn arguments_that_mean_nothing_exit_2() {
    let folder = tempfile::tempdir().unwrap();
    let file = span(folder.path());
    let file = file.to_str().unwrap();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let bad: [&[&str]; 10] = [
        &[],
        &["dance"],
        &["solve"],
        &["solve", file, "--model", "finite"],
        &["solve", file, "--tolerance", "NaN"],
        &["run", file, "--for", "-1s", "--out", out],
        &["run", file, "--for", "ten", "--out", out],
        &["run", file, "--for", "1s", "--every", "0s", "--out", out],
        &["run", file, "--for", "1s"],
        &["run", file, "--for", "10000000s", "--every", "0.000001s", "--out", out],
    ];
    for arguments in bad {
        let o = cable(arguments);
        assert_eq!(o.status.code(), Some(2), "{arguments:?}: {}", text(&o.stderr));
        assert!(o.stdout.is_empty() && !o.stderr.is_empty(), "{arguments:?}");
    }
    assert!(!Path::new(out).exists(), "nothing is written for bad input");
}

#[test]
fn schema_is_json() {
    let o = cable(&["schema"]);
    assert_eq!(o.status.code(), Some(0));
    let v: Value = serde_json::from_slice(&o.stdout).unwrap();
    assert!(v["properties"]["cables"].is_object());
}

#[test]
fn scenes_that_cannot_be_read_exit_2_and_say_where() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.toml");
    let path = file.to_str().unwrap();
    std::fs::write(&file, "version = 1\ncables = 3\n").unwrap();
    for command in [["check", path], ["solve", path]] {
        let o = cable(&command);
        assert_eq!(o.status.code(), Some(2));
        let said = text(&o.stderr);
        assert!(said.contains("bad.toml") && said.contains("line 2, column"), "{said}");
    }
    std::fs::write(&file, [b'a', 0xff, 0xfe]).unwrap();
    assert_eq!(cable(&["check", path]).status.code(), Some(2));
    assert_eq!(cable(&["check", folder.path().to_str().unwrap()]).status.code(), Some(2), "a folder");
    assert_eq!(cable(&["check", "/nonexistent/scene.toml"]).status.code(), Some(2));
}

#[test]
fn check_says_sound() {
    let folder = tempfile::tempdir().unwrap();
    let o = cable(&["check", span(folder.path()).to_str().unwrap()]);
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    assert!(text(&o.stdout).contains("sound, 1 cable"));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_exits_74() {
    let folder = tempfile::tempdir().unwrap();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let o = Command::new(env!("CARGO_BIN_EXE_cable"))
        .args(["check", span(folder.path()).to_str().unwrap()])
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(o.status.code(), Some(74), "{}", text(&o.stderr));
    // A folder that cannot be made, because a file has its name.
    let file = span(folder.path());
    let o = cable(&["run", file.to_str().unwrap(), "--for", "1s", "--quasi-static", "--out", file.to_str().unwrap()]);
    assert_eq!(o.status.code(), Some(74), "{}", text(&o.stderr));
}

/// Every number of a JSON value, with its key.
fn numbers(key: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(key.to_owned()),
        Value::Array(a) => a.iter().for_each(|v| numbers(key, v, found)),
        Value::Object(o) => o.iter().for_each(|(k, v)| numbers(k, v, found)),
        _ => {}
    }
}

#[test]
fn solve_prints_one_object_with_the_stated_keys() {
    let folder = tempfile::tempdir().unwrap();
    let o = cable(&["solve", span(folder.path()).to_str().unwrap(), "--json"]);
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    assert!(o.stderr.is_empty(), "progress only on a terminal");
    let v: Value = serde_json::from_slice(&o.stdout).unwrap();
    for key in [
        "model",
        "reason",
        "converged",
        "residual_n",
        "iterations",
        "wall_time_s",
        "error_estimate",
        "max_tension_n",
        "max_tension_arc_length_m",
        "supports",
        "nodes",
        "contacts",
        "warnings",
    ] {
        assert!(v.get(key).is_some(), "{key} is missing");
    }
    assert_eq!(v["converged"], true);
    let mut found = Vec::new();
    numbers("", &v, &mut found);
    let unitless = ["iterations", "error_estimate", "strain", "value", "limit"];
    let units = ["_n", "_m", "_s", "_pa", "_per_m", "_deg"];
    for key in found {
        assert!(unitless.contains(&key.as_str()) || units.iter().any(|u| key.ends_with(u)), "{key} has no unit");
    }
    // The supports carry the weight: 12 m of 1.246 kg/m.
    let weight_n = 12.0 * 1.246 * 9.80665;
    let held: f64 = v["supports"].as_array().unwrap().iter().map(|s| s["reaction_y_n"].as_f64().unwrap()).sum();
    assert!((held + weight_n).abs() < 1e-6 * weight_n, "{held} against {weight_n}");
}

#[test]
fn run_prints_an_object_a_line_and_its_folder_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a/b");
    let o = cable(&[
        "run",
        span(folder.path()).to_str().unwrap(),
        "--for",
        "0.25s",
        "--every",
        "0.1s",
        "--quasi-static",
        "--json",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    let lines: Vec<Value> = text(&o.stdout).lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let times: Vec<f64> = lines.iter().map(|v| v["time_s"].as_f64().unwrap()).collect();
    assert_eq!(times, [0.0, 0.1, 0.2, 0.25]);
    let open = |name: &str| std::fs::File::open(out.join(name)).unwrap();
    let history = cable_core::record::read_history(open("history.csv")).unwrap();
    assert_eq!(history.time_s, times);
    for (k, v) in lines.iter().enumerate() {
        assert_eq!(history.max_tension_n[k], v["max_tension_n"].as_f64().unwrap(), "bit for bit");
        assert_eq!(history.supports[0].reaction_x_n[k], v["supports"][0]["reaction_x_n"].as_f64().unwrap());
    }
    let nodes = cable_core::record::read_nodes(open("nodes.csv")).unwrap();
    let printed: usize = lines.iter().map(|v| v["nodes"].as_array().unwrap().len()).sum();
    assert_eq!(nodes.len(), printed);
    cable_core::record::read_events(open("events.csv")).unwrap();
    let scene = std::fs::read_to_string(out.join("scene.toml")).unwrap();
    assert_eq!(cable_core::Scene::from_toml(&scene).unwrap(), catalog::hanging_span());
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_cable"))
        .args(["run", span(folder.path()).to_str().unwrap(), "--for", "5s", "--quasi-static", "--json", "--out"])
        .arg(folder.path().join("out"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let o = child.wait_with_output().unwrap();
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    assert!(o.stderr.is_empty());
}
