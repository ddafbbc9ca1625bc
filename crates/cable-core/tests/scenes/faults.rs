//! Faulty scenes are refused: every field with every fault, broken texts, impossible geometry.

use cable_core::error::SceneFault;
use cable_core::scene::{Obstacle, Shape, catalog};
use cable_core::{Model, Scene, SceneError, Simulation};
use toml::{Table, Value};

use super::{FULL, full};

/// Every leaf of a value with its path.
fn leaves(value: &Value, path: &str, out: &mut Vec<String>) {
    match value {
        Value::Table(t) => {
            for (k, v) in t {
                leaves(v, &if path.is_empty() { k.clone() } else { format!("{path}.{k}") }, out);
            }
        }
        Value::Array(a) => a.iter().enumerate().for_each(|(i, v)| leaves(v, &format!("{path}[{i}]"), out)),
        _ => out.push(path.to_owned()),
    }
}

fn steps(path: &str) -> Vec<&str> {
    path.split(['.', '[']).map(|s| s.trim_end_matches(']')).collect()
}

fn at<'a>(scene: &'a mut Table, path: &str) -> &'a mut Value {
    let mut steps = steps(path).into_iter();
    let mut value = scene.get_mut(steps.next().unwrap()).unwrap();
    for step in steps {
        value = match value {
            Value::Array(a) => a.get_mut(step.parse::<usize>().unwrap()).unwrap(),
            Value::Table(t) => t.get_mut(step).unwrap(),
            _ => unreachable!(),
        };
    }
    value
}

/// The scene with everything, and the paths of its leaves.
fn everything() -> (Table, Vec<String>) {
    let scene: Table = toml::from_str(FULL).unwrap();
    let mut paths = Vec::new();
    leaves(&Value::Table(scene.clone()), "", &mut paths);
    assert!(paths.len() > 110, "{}", paths.len());
    (scene, paths)
}

/// Refused, at that path, on a line that holds its key.
fn refused(text: &str, path: &str, what: &str) -> SceneError {
    let error = Scene::from_toml(text).expect_err(&format!("{path} {what} was accepted"));
    assert_eq!(error.path, path, "{what}: {error}");
    let place = error.at.unwrap_or_else(|| panic!("{path} {what}: no place"));
    let line = text.lines().nth(place.line - 1).unwrap();
    let key = path.rsplit('.').next().unwrap().split('[').next().unwrap();
    assert!(line.contains(key), "{path} {what}: line {} is `{line}`", place.line);
    error
}

#[test]
fn every_number_with_every_impossible_value_is_refused_by_its_path() {
    let (scene, paths) = everything();
    let mut tried = 0;
    for path in &paths {
        let mut broken = scene.clone();
        let old = at(&mut broken, path).clone();
        let mut faults = vec![Value::Boolean(true), Value::Array(vec![]), Value::Table(Table::new())];
        if path.ends_with("self_contact") {
            faults.remove(0);
        }
        if matches!(old, Value::Float(_) | Value::Integer(_)) {
            let numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308];
            faults.extend(numbers.map(Value::Float));
            faults.push(Value::String("1".to_owned()));
        } else {
            faults.extend([Value::Float(1.0), Value::Integer(3)]);
        }
        for fault in faults {
            *at(&mut broken, path) = fault.clone();
            refused(&toml::to_string(&broken).unwrap(), path, &fault.to_string());
            tried += 1;
        }
    }
    assert!(tried > 900, "{tried}");
}

#[test]
fn numbers_that_must_be_positive_are() {
    let (scene, paths) = everything();
    let positive = ["length_m", "linear_density", "axial_stiff", "diameter", "tension_n", "segments", "speed_m"];
    let not_negative = [
        "bending",
        "damping",
        "min_bend",
        "friction",
        "gravity",
        "radius",
        "mass_kg",
        "release_s",
        "wait_s",
        "thickness",
    ];
    let mut tried = 0;
    for path in &paths {
        let key = path.rsplit('.').next().unwrap();
        let zero_out = positive.iter().any(|p| key.starts_with(p) || key.ends_with(p)) && !key.starts_with("arc");
        let negative_out = zero_out || not_negative.iter().any(|p| key.starts_with(p));
        for (value, out) in
            [(0.0, zero_out), (-0.0, zero_out), (5e-324, zero_out), (-1.0, negative_out), (-5e-324, negative_out)]
        {
            let mut broken = scene.clone();
            *at(&mut broken, path) = Value::Float(value);
            let text = toml::to_string(&broken).unwrap();
            if out {
                refused(&text, path, &value.to_string());
                tried += 1;
            } else {
                let _ = Scene::from_toml(&text); // whatever the answer, no panic
            }
        }
    }
    assert!(tried > 60, "{tried}");
}

#[test]
fn a_missing_key_is_named_and_an_unknown_one_gets_the_nearest() {
    let (scene, _) = everything();
    // (table, key, whether the scene is whole without it)
    let mut keys: Vec<(String, String)> = Vec::new();
    fn tables(value: &Value, path: &str, out: &mut Vec<(String, String)>) {
        match value {
            Value::Table(t) => {
                for (k, v) in t {
                    out.push((path.to_owned(), k.clone()));
                    tables(v, &if path.is_empty() { k.clone() } else { format!("{path}.{k}") }, out);
                }
            }
            Value::Array(a) => a.iter().enumerate().for_each(|(i, v)| tables(v, &format!("{path}[{i}]"), out)),
            _ => {}
        }
    }
    tables(&Value::Table(scene.clone()), "", &mut keys);
    let table = |scene: &mut Table, path: &str, f: &mut dyn FnMut(&mut Table)| match path {
        "" => f(scene),
        path => f(at(scene, path).as_table_mut().unwrap()),
    };
    let mut missed = 0;
    for (path, key) in &keys {
        let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let mut broken = scene.clone();
        table(&mut broken, path, &mut |t| drop(t.remove(key)));
        if let Err(error) = Scene::from_toml(&toml::to_string(&broken).unwrap()) {
            assert!(error.path.starts_with(path), "{path} without {key}: {error}");
            missed += 1;
        }
        let wrong = format!("{key}x");
        let mut broken = scene.clone();
        table(&mut broken, path, &mut |t| {
            let value = t.remove(key).unwrap();
            t.insert(wrong.clone(), value);
        });
        let error = refused(&toml::to_string(&broken).unwrap(), &below(&wrong), "unknown");
        assert_eq!(error.fault, SceneFault::UnknownKey { nearest: Some(key.clone()) }, "{path}");
    }
    assert!(missed > 25, "{missed}");
    for key in ["name", "length_m", "supports"] {
        let mut broken = scene.clone();
        table(&mut broken, "cables[0]", &mut |t| drop(t.remove(key)));
        let error = Scene::from_toml(&toml::to_string(&broken).unwrap()).unwrap_err();
        assert_eq!(error.path, format!("cables[0].{key}"));
    }
}

#[test]
fn every_line_twice_is_refused() {
    for (i, line) in FULL.lines().enumerate().filter(|(_, l)| l.contains(" = ") && !l.contains('{')) {
        let mut lines: Vec<&str> = FULL.lines().collect();
        lines.insert(i, line);
        let error = Scene::from_toml(&lines.join("\n")).expect_err(line);
        assert!(matches!(error.fault, SceneFault::Syntax { .. }), "{line}: {error}");
        assert!(error.at.is_some(), "{line}");
    }
}

#[test]
fn byte_order_mark_and_crlf_are_accepted_and_other_encodings_named() {
    let windows = format!("\u{feff}{}", FULL.replace('\n', "\r\n"));
    assert_eq!(Scene::from_toml(&windows).unwrap(), full());
    assert_eq!(Scene::from_toml_bytes(windows.as_bytes()).unwrap(), full());
    let utf16: Vec<u8> = [0xfeff_u16].into_iter().chain(FULL.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    assert!(Scene::from_toml_bytes(&utf16).unwrap_err().to_string().contains("UTF-16"));
    let mut latin = FULL.as_bytes().to_vec();
    latin[40] = 0xe4;
    assert!(Scene::from_toml_bytes(&latin).unwrap_err().to_string().contains("line 4, column 8: this is not UTF-8"));
    for empty in ["", " \n", "\u{feff}"] {
        assert!(Scene::from_toml(empty).unwrap_err().to_string().contains("empty"));
    }
    assert!(Scene::from_toml("version = 2").unwrap_err().to_string().contains("only version"));
}

#[test]
fn truncated_texts_are_read_or_refused_never_worse() {
    let mut texts: Vec<&str> =
        catalog::TEXTS.iter().map(|(_, text)| *text).filter(|t| t.len() < 1500).take(5).collect();
    texts.push(FULL);
    for text in &texts {
        for end in 0..text.len() {
            let _ = Scene::from_toml_bytes(&text.as_bytes()[..end]);
        }
    }
}

/// Texts with one bit flipped, the same on every run (a linear congruential sequence, Knuth's
/// MMIX).
fn flips(count: usize) {
    let mut seed: u64 = 1;
    for _ in 0..count {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut bytes = FULL.as_bytes().to_vec();
        let place = (seed >> 33) as usize % bytes.len();
        bytes[place] ^= 1 << (seed >> 20 & 7);
        if let Ok(scene) = Scene::from_toml_bytes(&bytes) {
            scene.validate().unwrap();
        }
    }
}

#[test]
fn flipped_bits_are_read_or_refused_never_worse() {
    flips(3_000);
}

#[test]
#[ignore = "two minutes (a millisecond each): cargo test -p cable-core --test scenes hundred_thousand -- --ignored"]
fn a_hundred_thousand_flipped_bits_are_read_or_refused_never_worse() {
    flips(100_000);
}

#[test]
fn hostile_texts_are_refused() {
    let deep = format!("version = 1\nx = {}1{}", "[".repeat(50_000), "]".repeat(50_000));
    let dotted = format!("version = 1\n{}y = 1", "a.".repeat(50_000));
    let wide = format!("version = 1\nname = \"{}\"", "n".repeat(9 << 20));
    let many = FULL.replace("segments = 90", "segments = 1000000");
    let long = FULL.replace("name = \"umbilical\"", &format!("name = \"{}\"", "n".repeat(1 << 20)));
    for text in [deep, dotted, wide, many, long] {
        Scene::from_toml(&text).unwrap_err();
    }
}

#[test]
fn a_cable_too_short_is_refused_with_both_lengths_unless_it_can_stretch() {
    let mut scene = catalog::hanging_span();
    scene.cables[0].length_m = 9.9;
    let error = scene.validate().unwrap_err();
    assert_eq!(error.path, "cables[0].length_m");
    let SceneFault::TooShort { length_m, way_m, needed_n, .. } = error.fault else { panic!("{error}") };
    assert_eq!((length_m, way_m), (9.9, 10.0));
    assert!((needed_n - 2.0e6 * (10.0 / 9.9 - 1.0)).abs() < 1e-6);
    // 0.4 % of strain takes 8 kN of the 10 kN it bears.
    scene.cables[0].length_m = 10.0 / 1.004;
    scene.validate().unwrap();
    // Cold makes it shorter.
    scene.environment.temperature_change_k = -100.0;
    assert!(matches!(scene.validate().unwrap_err().fault, SceneFault::TooShort { .. }));
    // A pulley on the way makes the way longer.
    let mut scene = catalog::pulley_waypoints();
    scene.cables[0].length_m = 11.6;
    assert!(matches!(scene.validate().unwrap_err().fault, SceneFault::TooShort { .. }));
}

#[test]
fn what_does_not_fit_together_is_refused_where_it_is() {
    let cases: [(&str, &str, &str); 16] = [
        ("kind = \"fixed\"\narc_length_m = 7.0", "kind = \"fixd\"\narc_length_m = 7.0", "cables[0].supports[2].kind"),
        ("angle_deg = -20.0", "", "cables[0].supports[3].angle_deg"),
        ("side = \"under\"", "angle_deg = 1.0", "cables[0].supports[1].angle_deg"),
        ("arc_length_m = 12.0", "arc_length_m = 6.5", "cables[0].supports[3].arc_length_m"),
        ("arc_length_m = 20.0", "arc_length_m = 30.0", "cables[0].supports[4].arc_length_m"),
        ("times_s = [0.0, 4.0]", "times_s = [0.0, 0.0]", "cables[0].supports[2].motion.times_s[1]"),
        ("times_s = [0.0, 4.0]", "times_s = [0.0]", "cables[0].supports[2].motion.points_m"),
        (
            "points_m = [[6.0, 3.0], [6.5, 3.0]]",
            "points_m = [[6.1, 3.0], [6.5, 3.0]]",
            "cables[0].supports[2].motion.points_m",
        ),
        ("preset = \"soow-6-4\"", "preset = \"soow-64\"", "cables[0].preset"),
        ("preset = \"brokk-110\"", "preset = \"brok-110\"", "robot.preset"),
        ("cable = \"umbilical\"\narc_length_m = 5.0", "cable = \"umbilicus\"\narc_length_m = 5.0", "loads[0].cable"),
        ("name = \"beam\"", "name = \"floor\"", "obstacles[1].name"),
        ("[[-1.0, 0.0], [30.0, 0.5]]", "[[-1.0, 0.0], [-30.0, 0.5]]", "obstacles[0].points_m"),
        ("[4.3, 1.0], [4.3, 1.2]]", "[4.3, 1.0], [4.6, 1.0]]", "obstacles[1].points_m"),
        ("[[1.0, 1.0], [2.0, 1.5]]", "[[1.0, 1.0], [1.0, 1.0]]", "obstacles[3].points_m[1]"),
        ("service_tension_n = 700.0", "service_tension_n = 70000.0", "cables[0].service_tension_n"),
    ];
    for (from, to, path) in cases {
        assert!(FULL.contains(from), "{from}");
        let error = Scene::from_toml(&FULL.replacen(from, to, 1)).expect_err(path);
        assert_eq!(error.path, path, "{error}");
        assert!(error.at.is_some());
    }
}

fn with_obstacle(shape: Shape) -> Scene {
    let mut scene = catalog::slack_to_floor();
    scene.obstacles = vec![Obstacle { name: "ground".to_owned(), friction: None, shape }];
    scene
}

#[test]
fn terrain_and_polygons_that_cross_themselves_are_refused_with_both_edges() {
    let loops = vec![[-5.0, 0.0], [4.0, 0.0], [4.0, -2.0], [2.0, 1.0], [30.0, 0.0]];
    let error = with_obstacle(Shape::Terrain { points_m: loops }).validate().unwrap_err();
    assert_eq!(error.path, "obstacles[0].points_m[2]");
    let said = error.to_string();
    assert!(said.contains("(4 m, −2 m) to (2 m, 1 m)") && said.contains("(−5 m, 0 m) to (4 m, 0 m)"), "{said}");
    let bow = vec![[0.0, -4.0], [2.0, -2.0], [2.0, -4.0], [0.5, -1.5]];
    let error = with_obstacle(Shape::Polygon { points_m: bow }).validate().unwrap_err();
    assert_eq!(error.path, "obstacles[0].points_m[2]");
    // A thin plate has no inside to lose.
    let folded = vec![[0.0, -4.0], [2.0, -2.0], [2.0, -4.0], [0.5, -2.0]];
    with_obstacle(Shape::Polyline { points_m: folded, thickness_m: 0.01 }).validate().unwrap();
    // Overhangs are ground like any other.
    let overhang = vec![[-5.0, -3.0], [4.0, -3.0], [3.0, -2.0], [6.0, -2.0], [5.0, -3.0], [30.0, -3.0]];
    with_obstacle(Shape::Terrain { points_m: overhang }).validate().unwrap();
}

/// Rough ground of a million points with an overhang every tenth: no quick way out of the search
/// for crossings. (About a second; that it ends is the test.)
#[test]
fn a_million_points_of_ground_are_taken() {
    let points_m = (0..1_000_000)
        .map(|k| {
            let x = f64::from(k) * 1e-3;
            let rough = 0.01 * (0.7 * f64::from(k)).sin();
            if k % 10 == 3 { [x - 0.0014, rough - 4.0 + 0.05] } else { [x, rough - 4.0] }
        })
        .collect();
    let mut scene = with_obstacle(Shape::Terrain { points_m });
    scene.obstacles[0].name = "scan".to_owned();
    match Simulation::new(scene.clone(), Model::Fem) {
        Ok(_) => {}
        Err(e) => panic!("{}", e.to_string().chars().take(300).collect::<String>()),
    }
    let Shape::Terrain { points_m } = &mut scene.obstacles[0].shape else { unreachable!() };
    points_m.push([2000.0, 0.0]);
    let error = scene.validate().unwrap_err().to_string();
    assert!(error.contains("1000001"), "{error}");
}
