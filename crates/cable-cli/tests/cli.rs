//! These tests run the program from outside: arguments, exit codes, what it prints and writes.

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
    let bad: [&[&str]; 11] = [
        &[],
        &["dance"],
        &["solve"],
        &["solve", file, "--model", "finite"],
        &["solve", file, "--tolerance", "NaN"],
        &["run", file, "--for", "1s", "--stepping", "quickly", "--out", out],
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
    assert!(text(&o.stdout).contains("valid, 1 cable"));
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
        "errors",
        "max_tension_n",
        "max_tension_arc_length_m",
        "tightest_bend",
        "sidewall_pressure",
        "summary",
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
    let unitless = ["iterations", "error_estimate", "strain", "value", "limit", "relative_residual"];
    let units = ["_n", "_m", "_s", "_pa", "_per_m", "_deg", "_n_m2", "_ratio"];
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

/// A cable drawn over the floor: errors are above a hundredth, and below it on elements and steps
/// of a half or a quarter.
#[test]
fn run_says_its_errors_and_refines_until_they_are_as_asked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drag.toml");
    std::fs::write(&file, catalog::floor_drag().to_toml()).unwrap();
    let run = |more: &[&str]| {
        let out = folder.path().join("out");
        let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "1s", "--tolerance", "0.01"];
        arguments.extend(["--out", out.to_str().unwrap()]);
        arguments.extend(more);
        let o = cable(&arguments);
        assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
        text(&o.stdout)
    };
    let error = |told: &str| -> f64 {
        let line = told.lines().find_map(|l| l.strip_prefix("Greatest force error "));
        line.and_then(|l| l.split(' ').next()).expect("an error").parse().unwrap()
    };
    let (coarse, fine) = (run(&["--refine", "0"]), run(&[]));
    assert!(error(&coarse) > 0.01 && coarse.contains("1.0e-2 was asked for"), "{coarse}");
    assert!(error(&fine) <= 0.01 && !fine.contains("was asked for"), "{fine}");
    assert!(coarse.contains("estimated from coarser runs"), "{coarse}");
    assert!(run(&["--no-errors"]).contains("not known"));
}

#[test]
fn a_step_longer_than_the_run_or_than_any_step_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("span.toml");
    std::fs::write(&file, catalog::hanging_span().to_toml()).unwrap();
    for (duration, step, reason) in [("1s", "2s", "longer than the run"), ("5000s", "2000s", "step")] {
        let out = folder.path().join("out");
        let ask = ["run", file.to_str().unwrap(), "--for", duration, "--step", step, "--out", out.to_str().unwrap()];
        let o = cable(&ask);
        assert!(!o.status.success() && text(&o.stderr).contains(reason), "{step}: {}", text(&o.stderr));
    }
}

/// A drop on rubble: the greatest tension of the run has a range, and it is said that it depends on
/// small differences.
#[test]
fn run_says_that_a_greatest_tension_depends_on_small_differences() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drop.toml");
    std::fs::write(&file, catalog::rubble_drop().to_toml()).unwrap();
    let run = |more: &[&str]| {
        let out = folder.path().join("out");
        let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "1.5s", "--every", "0.5s"];
        arguments.extend(["--out", out.to_str().unwrap()]);
        arguments.extend(more);
        let o = cable(&arguments);
        assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
        text(&o.stdout)
    };
    let told = run(&[]);
    assert!(told.contains("This maximum depends on small differences"), "{told}");
    assert!(told.contains("Mach number ") && told.contains(": inertia matters at tolerance 0.001 ("), "{told}");
    let lines = run(&["--json"]);
    let last: Value = serde_json::from_str(lines.lines().last().expect("a line")).unwrap();
    let of_run = &last["run_peaks"][0];
    let greatest = of_run["greatest_tension_n"].as_f64().expect("a tension");
    let range = |key: &str, end: usize| of_run[key][end].as_f64().expect("a range");
    assert!(range("greatest_tension_range_n", 0) <= greatest && greatest <= range("greatest_tension_range_n", 1));
    assert_eq!(
        (&of_run["depends_on_small_differences"], &of_run["resolved"]),
        (&true.into(), &false.into()),
        "{of_run}"
    );
    let inertia = &last["inertia"];
    assert!(inertia["mach_number"].as_f64() > Some(0.0) && inertia["froude_number"].as_f64() > Some(0.1), "{inertia}");
    assert_eq!((&inertia["matters"], &last["next_cheaper"]["neglects"]), (&true.into(), &"inertia".into()), "{last}");
    let unknown: Value = serde_json::from_str(run(&["--json", "--no-errors"]).lines().last().expect("a line")).unwrap();
    assert!(unknown["run_peaks"][0]["depends_on_small_differences"].is_null(), "{unknown}");
    assert!(unknown["inertia"]["matters"].is_null() && unknown["inertia"]["mach_number"].is_f64(), "{unknown}");
}

/// An end goes out and back between two rows of a run without inertia: the table held the tension
/// of its instants alone.
#[test]
fn issue_016_rows_hold_the_greatest_tension_since_the_row_before() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (folder.path().join("scene.toml"), folder.path().join("out"));
    let mut scene = catalog::hanging_span();
    let end = scene.cables[0].supports.last_mut().unwrap();
    let [x, y] = end.at_m.unwrap();
    let points_m = vec![[x, y], [x + 0.1, y], [x, y]];
    end.motion = Some(cable_core::scene::Motion { times_s: vec![0.0, 0.5, 1.0], points_m });
    std::fs::write(&file, scene.to_toml()).unwrap();
    let arguments = ["run", file.to_str().unwrap(), "--quasi-static", "--for", "1s", "--every", "1s", "--out"];
    let o = cable(&[&arguments[..], &[out.to_str().unwrap()]].concat());
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
    let rows: Vec<Vec<&str>> = history.lines().map(|line| line.split(',').collect()).collect();
    let figure = |row: usize, name: &str| -> f64 {
        rows[row][rows[0].iter().position(|n| *n == name).unwrap()].parse().unwrap()
    };
    assert_eq!(rows.len(), 3, "{history}");
    assert!(figure(2, "peak_tension_n") > 1.01 * figure(2, "max_tension_n"), "{history}");
    assert!(text(&o.stdout).contains(&format!("{:.4} N", figure(2, "peak_tension_n"))), "{}", text(&o.stdout));
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

/// A flexible cable drawn over a pipe of 0.2 m: bent to the pipe's and its own radius, pressed with
/// tension over radius.
#[test]
fn solve_tells_the_tightest_bend_and_the_highest_pressure() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("post.toml");
    let scene = catalog::round_post();
    std::fs::write(&file, scene.to_toml()).unwrap();
    let path = file.to_str().unwrap();
    let o = cable(&["solve", path, "--json"]);
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    let v: Value = serde_json::from_slice(&o.stdout).unwrap();
    let cable_radius = 0.5 * scene.cables[0].diameter_m;
    let cable_core::scene::Shape::Circle { radius_m, .. } = scene.obstacles[0].shape else { panic!("no pipe") };
    let radius = radius_m + cable_radius;
    let bend = v["tightest_bend"]["radius_m"].as_f64().unwrap();
    assert!((bend / radius - 1.0).abs() < 0.02, "{bend} m for {radius} m");
    // Tension over radius at the place it names, which is on the pipe.
    let p = &v["sidewall_pressure"];
    let number = |v: &Value, key: &str| v[key].as_f64().unwrap();
    let tension = (v["nodes"].as_array().unwrap().iter())
        .min_by(|a, b| {
            let off = |n: &Value| (number(n, "arc_length_m") - number(p, "arc_length_m")).abs();
            off(a).total_cmp(&off(b))
        })
        .map(|n| number(n, "tension_n"))
        .unwrap();
    let pressure = number(p, "pressure_n_per_m");
    assert!((pressure * radius / tension - 1.0).abs() < 0.02, "{pressure} N/m for {tension} N on {radius} m");
    assert!(pressure <= number(&v, "max_tension_n") / radius * (1.0 + 1e-9));
    let o = cable(&["solve", path]);
    let said = text(&o.stdout);
    for line in
        [format!("Tightest bend     radius {bend:.4} m, at"), format!("Sidewall pressure {pressure:.3} N/m, at")]
    {
        assert!(said.contains(&line), "{line}\n{said}");
    }
}

/// The figures that are read first are in JSON and text, and the tightest bend is the greatest
/// curvature of the nodes.
#[test]
fn solve_compares_models_and_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let file = span(folder.path());
    let o = cable(&["solve", file.to_str().unwrap(), "--json", "--compare"]);
    let answer: Value = serde_json::from_slice(&o.stdout).unwrap();
    let compared = answer["compared"].as_array().unwrap();
    let of = |model: &str, elements: Option<u64>| {
        let found = compared.iter().find(|c| c["model"] == model && c["elements"].as_u64() == elements);
        found.unwrap_or_else(|| panic!("{model} {elements:?}"))
    };
    let differs = |n: u64| of("mass-spring", Some(n))["force_difference"].as_f64().unwrap();
    assert!(differs(400) < 0.1 * differs(50), "springs are of the second order");
    assert!(of("catenary", None)["force_difference"].as_f64().unwrap() < 1e-9);
    assert!(compared.iter().all(|c| c["wall_time_s"].as_f64().unwrap() > 0.0));
    let table = text(&cable(&["solve", file.to_str().unwrap(), "--compare"]).stdout);
    assert!(table.contains("Other models and meshes, compared with this answer"), "{table}");
}

#[test]
fn solve_tells_what_is_read_first() {
    let folder = tempfile::tempdir().unwrap();
    let file = span(folder.path());
    let o = cable(&["solve", file.to_str().unwrap(), "--json", "--stiffness"]);
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    let v: Value = serde_json::from_slice(&o.stdout).unwrap();
    let s = &v["summary"][0];
    for key in [
        "cable",
        "ends",
        "greatest_tension",
        "least_tension",
        "length_m",
        "stretched_length_m",
        "lying_m",
        "suspended_m",
        "touchdowns",
        "sag",
        "lowest",
        "highest",
        "tightest_bend",
        "judged_bend",
        "sidewall_pressure",
        "utilisation",
        "friction",
        "balance",
        "end_stiffness",
    ] {
        assert!(s.get(key).is_some(), "{key} is missing");
    }
    let curvatures = v["nodes"].as_array().unwrap().iter().map(|n| n["curvature_per_m"].as_f64().unwrap().abs());
    let sharpest = 1.0 / curvatures.fold(0.0, f64::max);
    assert_eq!(v["tightest_bend"]["radius_m"].as_f64().unwrap(), sharpest);
    assert!((sharpest - 4.695).abs() < 1e-3, "{sharpest} m");
    assert!((s["sag"]["sag_m"].as_f64().unwrap() - (5.0 - s["lowest"]["y_m"].as_f64().unwrap())).abs() < 1e-12);
    assert!(s["balance"]["relative_residual"].as_f64().unwrap() < 1e-12);
    assert_eq!(s["end_stiffness"].as_array().unwrap().len(), 2);
    let o = cable(&["solve", file.to_str().unwrap()]);
    let said = text(&o.stdout);
    for line in ["key figures", "Start ", "Sag ", "Share of limits", "Balance "] {
        assert!(said.contains(line), "{line}\n{said}");
    }
    assert!(!said.contains("End stiffness"), "only when asked for");
    // The bending stiffness that is likely of the cable and was left out is told, unless nobody
    // wants to wait for it.
    assert!(said.contains("With bending      with the likely 1.4 (0.1 to 20) N·m² of its preset"), "{said}");
    assert_eq!(s["neglected_bending"]["bending_stiffness_n_m2"], 1.4);
    assert!((s["neglected_bending"]["greatest_tension_n"].as_f64().unwrap() - 93.02).abs() < 0.01);
    let said = text(&cable(&["solve", file.to_str().unwrap(), "--no-bending"]).stdout);
    assert!(!said.contains("With bending"), "{said}");
    // Or it is taken.
    let said = text(&cable(&["solve", file.to_str().unwrap(), "--bending", "likely"]).stdout);
    assert!(
        said.contains("likely bending stiffness of its preset was used: `") && !said.contains("With bending"),
        "{said}"
    );
    assert_eq!(cable(&["solve", file.to_str().unwrap(), "--bending", "some"]).status.code(), Some(2));
}

/// Asked for, a run goes on with the bending stiffness that is likely of the presets, of all cables
/// or of those whose rest without it is not one of a cable, and says so in its text, its JSON and
/// the scene of its folder.
#[test]
fn run_takes_the_likely_bending_stiffness_where_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let run = |scene: &cable_core::Scene, more: &[&str]| {
        let file = folder.path().join("scene.toml");
        std::fs::write(&file, scene.to_toml()).unwrap();
        let out = folder.path().join("out");
        let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "0.02s", "--no-errors"];
        arguments.extend(["--out", out.to_str().unwrap()]);
        arguments.extend(more);
        let o = cable(&arguments);
        assert_eq!(o.status.code(), Some(0), "{more:?}: {}", text(&o.stderr));
        let written = std::fs::read_to_string(out.join("scene.toml")).unwrap();
        let written = cable_core::Scene::from_toml(&written).unwrap().cables[0].bending_stiffness_n_m2;
        (text(&o.stdout), written)
    };
    let taken = "likely bending stiffness of its preset was used: `cable` with 1.4 N·m²";
    let span = catalog::hanging_span();
    for (bending, stiffness) in [("as-written", 0.0), ("likely", 1.4), ("where-it-matters", 0.0)] {
        let (told, written) = run(&span, &["--bending", bending]);
        assert_eq!(written, stiffness, "{bending}");
        assert_eq!(told.contains(taken), stiffness > 0.0, "{bending}: {told}");
    }
    // A pile of a flexible cable is folded to kinks.
    let pile = catalog::all().into_iter().find(|(name, _)| *name == "pile").unwrap().1;
    let (told, written) = run(&pile, &["--bending", "where-it-matters", "--json"]);
    assert_eq!(written, 1.4);
    let first: Value = serde_json::from_str(told.lines().next().unwrap()).unwrap();
    let reason = first["reason"].as_str().unwrap();
    assert!(reason.contains("without bending stiffness it bends too tightly") && reason.contains(taken), "{reason}");
    // It is the rest that `solve` finds with it.
    let file = folder.path().join("scene.toml");
    let solved = text(&cable(&["solve", file.to_str().unwrap(), "--bending", "where-it-matters", "--json"]).stdout);
    let solved: Value = serde_json::from_str(&solved).unwrap();
    let [run, rest] = [&first, &solved].map(|v| v["max_tension_n"].as_f64().unwrap());
    assert!((run / rest - 1.0).abs() < 1e-2, "{run} N for {rest} N");
}

/// The work of each force on a robot is in `history.csv` and in the JSON: together it is the
/// robot's energy of motion. Tables without it are read as before.
#[test]
fn run_writes_the_work_on_the_robot() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drive.toml");
    let scene = catalog::robot_drive();
    std::fs::write(&file, scene.to_toml()).unwrap();
    let out = folder.path().join("out");
    let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "1.5s", "--every", "0.1s", "--no-errors"];
    arguments.extend(["--no-bending", "--json", "--out", out.to_str().unwrap()]);
    let o = cable(&arguments);
    assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
    let last: Value = serde_json::from_str(text(&o.stdout).lines().last().unwrap()).unwrap();
    let table = std::fs::read(out.join("history.csv")).unwrap();
    let history = cable_core::record::read_history(table.as_slice()).unwrap();
    let of = |name: &str| {
        let column = history.extras.iter().find(|e| e.name == name).unwrap_or_else(|| panic!("{name} is missing"));
        *column.values.last().unwrap()
    };
    let mut sum = 0.0;
    for force in ["drive", "slip", "rolling", "weight", "cable", "ground", "impact"] {
        let work = of(&format!("robot_{force}_work_j"));
        assert_eq!(last["robot"]["work"][format!("{force}_j")].as_f64(), Some(work), "{force}");
        sum += work;
    }
    let mass = cable_core::scene::preset::robot_preset(&scene.robot.unwrap().preset).unwrap().mass_kg.value;
    let kinetic = 0.5 * mass * of("robot_speed_m_per_s").powi(2);
    assert!(kinetic > 1.0 && (sum / kinetic - 1.0).abs() < 1e-9, "{sum} J for {kinetic} J");
    assert!(of("robot_drive_work_j") > kinetic && of("robot_rolling_work_j") < 0.0);
    // A table of before ends with the thrust.
    let line = |row: &str| row.split(',').take(row.split(',').count() - 7).collect::<Vec<_>>().join(",") + "\n";
    let older: String = text(&table).lines().map(line).collect();
    let older = cable_core::record::read_history(older.as_bytes()).unwrap();
    assert_eq!(older.extras.last().unwrap().name, "robot_thrust_n");
    assert_eq!(older.time_s, history.time_s);
}

/// A run says once, of its first rest, which bending it neglects.
#[test]
fn run_says_once_what_its_first_rest_neglects_of_bending() {
    let folder = tempfile::tempdir().unwrap();
    let file = span(folder.path());
    let out = folder.path().join("out");
    let run = |more: &[&str]| {
        let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "0.02s", "--no-errors"];
        arguments.extend(["--out", out.to_str().unwrap()]);
        arguments.extend(more);
        let o = cable(&arguments);
        assert_eq!(o.status.code(), Some(0), "{more:?}: {}", text(&o.stderr));
        text(&o.stdout)
    };
    let told = run(&[]);
    let of_rest = "first rest, with the likely 1.4 (0.1 to 20) N·m² of its preset, the greatest tension is 93.02";
    assert_eq!(told.matches("was neglected").count(), 1, "{told}");
    assert!(told.contains(of_rest), "{told}");
    let lines = run(&["--json"]);
    let lines: Vec<Value> = lines.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert!(lines.len() > 1);
    for (k, line) in lines.iter().enumerate() {
        let neglected = &line["summary"][0]["neglected_bending"];
        assert_eq!(neglected["bending_stiffness_n_m2"].as_f64(), (k == 0).then_some(1.4), "line {k}");
    }
    // Unless nobody wants to wait for it, or nothing was left out.
    for more in [["--no-bending"].as_slice(), &["--bending", "likely"]] {
        assert!(!run(more).contains("was neglected"), "{more:?}");
    }
}

/// A run that says a limit is exceeded says so once in its text, in its JSON with its place, and in
/// its events.
#[test]
fn run_tells_the_warnings_that_begin() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = catalog::hanging_span();
    scene.cables[0].service_tension_n = 1.0;
    // Too stiff for explicit steps: previewed, and said.
    scene.cables[0].axial_stiffness_n = 1e9;
    scene.cables[0].bending_stiffness_n_m2 = 0.0;
    scene.cables[0].segments = Some(40);
    let file = folder.path().join("span.toml");
    std::fs::write(&file, scene.to_toml()).unwrap();
    let run = |out: &str, more: &[&str]| {
        let out = folder.path().join(out);
        let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "0.2s", "--model", "mass-spring", "--out"];
        arguments.push(out.to_str().unwrap());
        arguments.extend(more);
        let o = cable(&arguments);
        assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
        let events = std::fs::File::open(out.join("events.csv")).unwrap();
        (text(&o.stdout), cable_core::record::read_events(events).unwrap())
    };
    let (said, events) = run("text", &[]);
    for kind in ["service-tension", "stabilised"] {
        let lines = said.split_once("Warnings that began").unwrap().1.lines().filter(|l| l.contains(kind)).count();
        assert_eq!(lines, 1, "{kind}: {said}");
        assert_eq!(events.iter().filter(|e| e.kind.name() == kind).count(), 1, "{kind}");
    }
    let (said, _) = run("json", &["--json"]);
    let last: Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
    let warnings = last["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w["kind"] == "service-tension" && w["at_m"].is_array()), "{warnings:?}");
    assert!(warnings.iter().any(|w| w["kind"] == "stabilised"), "{warnings:?}");
    // Asked for, a preview is no surprise.
    let (_, events) = run("asked", &["--stepping", "preview"]);
    assert!(events.iter().all(|e| e.kind.name() != "stabilised"), "{events:?}");
}

#[test]
fn run_tells_where_the_energy_went() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = catalog::hanging_span();
    scene.cables[0].supports[1].release_s = Some(0.1);
    let file = folder.path().join("span.toml");
    std::fs::write(&file, scene.to_toml()).unwrap();
    let run = |out: &str, more: &[&str]| {
        let out = folder.path().join(out);
        let mut arguments = vec!["run", file.to_str().unwrap(), "--for", "0.5s", "--every", "0.1s", "--model", "fem"];
        arguments.extend(["--no-errors", "--out", out.to_str().unwrap()].iter().chain(more));
        let o = cable(&arguments);
        assert_eq!(o.status.code(), Some(0), "{}", text(&o.stderr));
        let history = std::fs::File::open(out.join("history.csv")).unwrap();
        (text(&o.stdout), cable_core::record::read_history(history).unwrap())
    };
    let (said, history) = run("text", &[]);
    assert!(said.contains("Energy exchanged") && said.contains("numerical -"), "{said}");
    let last = |name: &str| *history.extras.iter().find(|e| e.name == name).unwrap().values.last().unwrap();
    let open = last("unaccounted_energy_j").abs() / last("exchanged_energy_j");
    assert!(last("exchanged_energy_j") > 1.0 && open < 1e-3, "{open}");
    let (said, _) = run("json", &["--json"]);
    let json: Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
    let account = &json["energy_account"][0];
    assert_eq!(account["numerical_j"].as_f64(), Some(last("numerical_work_j")), "{account}");
}
