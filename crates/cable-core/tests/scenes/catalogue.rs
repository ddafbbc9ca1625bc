//! The bundled scenes are readable, valid by the schema, and laid clear of obstacles.

use cable_core::scene::{Robot, Shape, SupportKind, catalog, preset};
use cable_core::solution::WarningKind;
use cable_core::{Model, Scene, Simulation, Vec2};

fn vec2(p: [f64; 2]) -> Vec2 {
    Vec2::new(p[0], p[1])
}

fn text_of(id: &str) -> &'static str {
    catalog::TEXTS.iter().find(|(k, _)| *k == id).map_or("", |(_, text)| text)
}

#[test]
fn every_catalogue_scene_is_read_from_its_file() {
    for (id, text) in catalog::TEXTS {
        Scene::from_toml(text).unwrap_or_else(|e| panic!("{id}: {e}"));
        assert!(text.starts_with("# "), "{id} says nothing about itself");
    }
    let all = catalog::all();
    assert!(all.len() >= 12);
    assert!(all.iter().all(|(_, scene)| !scene.cables.is_empty()));
    assert!(all.iter().any(|(_, scene)| *scene == catalog::tank()));
}

#[test]
fn reference_scenes_are_read() {
    let text = include_str!("../../../../tests/data/composite.json");
    let data: serde_json::Value = serde_json::from_str(text).unwrap();
    let cases = data["cases"].as_array().unwrap();
    assert!(cases.len() > 30);
    for case in cases {
        let scene =
            Scene::from_toml(case["scene"].as_str().unwrap()).unwrap_or_else(|e| panic!("{}: {e}", case["name"]));
        assert_eq!(Scene::from_toml(&scene.to_toml()).unwrap(), scene);
    }
}

#[test]
fn the_schema_accepts_every_bundled_scene_and_refuses_unknown_keys() {
    let schema = Scene::json_schema();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let json = |text: &str| serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap();
    for (id, text) in catalog::TEXTS.iter().chain(&[("full", super::FULL)]) {
        let faults: Vec<String> =
            validator.iter_errors(&json(text)).map(|e| format!("{}: {e}", e.instance_path)).collect();
        assert!(faults.is_empty(), "{id}: {faults:?}");
    }
    let breaks = [
        ("version = 1", "version = 2"),
        ("view = ", "veiw = "),
        ("gravity_m_per_s2", "gravity"),
        ("segments = 90", "segment = 90"),
        ("side = \"under\"", "side = \"left\""),
        ("times_s = [0.0, 4.0], p", "time_s = [0.0, 4.0], p"),
        ("center_m = [8.0, 0.5]", "center_m = [8.0, 0.5]\nthickness_m = 1.0"),
        ("thickness_m", "thicknes_m"),
        ("wait_s", "wait_for_s"),
        ("heading", "headed"),
        ("preset = \"brokk-110\"", "preset = \"brokk\""),
        ("length_m = 30.0", "length_m = \"30\""),
    ];
    for (from, to) in breaks {
        assert!(super::FULL.contains(from), "{from}");
        assert!(!validator.is_valid(&json(&super::FULL.replacen(from, to, 1))), "{to} was accepted");
    }
    // Without a preset its numbers are needed.
    assert!(!validator.is_valid(&json(&text_of("hanging-span").replace("preset = \"soow-6-4\"\n", ""))));
}

/// Distance of two segments, 0 where they cross, m.
fn distance(a: [Vec2; 2], b: [Vec2; 2]) -> f64 {
    let cross = |u: Vec2, v: Vec2| u.x * v.y - u.y * v.x;
    let side = |s: [Vec2; 2], p: Vec2| cross(s[1] - s[0], p - s[0]);
    if side(a, b[0]) * side(a, b[1]) < 0.0 && side(b, a[0]) * side(b, a[1]) < 0.0 {
        return 0.0;
    }
    let to = |p: Vec2, s: [Vec2; 2]| {
        let d = s[1] - s[0];
        let f = if d.norm() > 0.0 { ((p - s[0]).dot(&d) / d.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
        (p - s[0] - d * f).norm()
    };
    to(a[0], b).min(to(a[1], b)).min(to(b[0], a)).min(to(b[1], a))
}

#[test]
fn every_scene_starts_clear_of_its_obstacles() {
    for (id, scene) in catalog::all() {
        for cable in &scene.cables {
            let held = cable.supports.iter().filter_map(|s| s.at_m.map(vec2));
            let way: Vec<Vec2> = if cable.route_m.is_empty() {
                held.collect()
            } else {
                cable.route_m.iter().map(|p| vec2(*p)).collect()
            };
            for leg in way.windows(2).map(|w| [w[0], w[1]]) {
                for obstacle in &scene.obstacles {
                    let (corners, closed, extra) = match &obstacle.shape {
                        Shape::Terrain { points_m } => (points_m.clone(), false, 0.0),
                        Shape::Polygon { points_m } => (points_m.clone(), true, 0.0),
                        Shape::Polyline { points_m, thickness_m } => (points_m.clone(), false, thickness_m / 2.0),
                        Shape::Circle { center_m, radius_m } => (vec![*center_m, *center_m], false, *radius_m),
                    };
                    let mut corners: Vec<Vec2> = corners.into_iter().map(vec2).collect();
                    if closed {
                        corners.push(corners[0]);
                    }
                    for edge in corners.windows(2) {
                        let gap = distance(leg, [edge[0], edge[1]]) - extra - cable.diameter_m / 2.0;
                        assert!(gap >= 0.0, "{id}: {} starts {gap} m inside {}", cable.name, obstacle.name);
                    }
                }
            }
        }
    }
}

#[test]
fn routes_end_at_their_supports_and_are_about_as_long_as_the_cable() {
    for (id, scene) in catalog::all() {
        for cable in scene.cables.iter().filter(|c| !c.route_m.is_empty()) {
            let length: f64 = cable.route_m.windows(2).map(|w| (vec2(w[1]) - vec2(w[0])).norm()).sum();
            assert!((length / cable.length_m - 1.0).abs() < 0.05, "{id}: route {length} m, cable {} m", cable.length_m);
            let ends = [(cable.supports.first(), cable.route_m.first()), (cable.supports.last(), cable.route_m.last())];
            for (support, end) in ends {
                let support = support.unwrap();
                if !matches!(support.kind, SupportKind::Load | SupportKind::Free) {
                    assert_eq!(support.at_m.as_ref(), end, "{id}");
                }
            }
        }
    }
}

#[test]
fn a_hitch_hangs_behind_its_robot() {
    let mut robot: Robot = super::full().robot.unwrap();
    let (x, y) = (robot.at_m[0], robot.at_m[1]);
    assert_eq!(robot.hitch_m(), Some([x + 0.9, y + 0.4]));
    robot.heading = cable_core::scene::Heading::Right;
    assert_eq!(robot.hitch_m(), Some([x - 0.9, y + 0.4]));
    robot.preset = "none".to_owned();
    assert_eq!(robot.hitch_m(), None);
}

#[test]
fn every_map_and_every_cable_preset_makes_a_valid_scene() {
    for map in preset::map_presets() {
        let scene = Scene { obstacles: map.obstacles.clone(), ..catalog::hanging_span() };
        scene.validate().unwrap_or_else(|e| panic!("{}: {e}", map.id));
        let Shape::Terrain { points_m } = &map.obstacles[0].shape else { panic!("{} has no ground", map.id) };
        let wide = points_m.iter().map(|p| p[0]).fold(0.0, f64::max) - 1.0;
        assert!((2.0 * wide - map.inside_width_m.value).abs() < 1e-9, "{}: drawn {} m wide", map.id, 2.0 * wide);
        assert!(map.riser_at_m[0].abs() < wide, "{}", map.id);
    }
    let text = |id: &str| text_of("hanging-span").replace("soow-6-4", id);
    for cable in preset::cable_presets() {
        let scene = Scene::from_toml(&text(cable.id)).unwrap_or_else(|e| panic!("{}: {e}", cable.id));
        assert_eq!(scene.cables[0].linear_density_kg_per_m, cable.linear_density_kg_per_m.value);
    }
    for robot in preset::robot_presets() {
        let text = format!("{}\n[robot]\npreset = \"{}\"\nat_m = [0.0, 0.0]\n", text("soow-6-4"), robot.id);
        Scene::from_toml(&text).unwrap_or_else(|e| panic!("{}: {e}", robot.id));
    }
}

/// A scene whose ground is rough was said to have many resting places where its cable touched none
/// of it.
#[test]
fn a_cable_that_hangs_free_over_rough_ground_has_one_rest() {
    for model in [Model::Auto, Model::Spans, Model::Fem, Model::MassSpring] {
        let answer = Simulation::new(catalog::tank_robot(), model).unwrap().settle().unwrap();
        assert!(answer.warnings.is_empty(), "{model}: {:?}", answer.warnings);
        // With the robot nearer the cable lies on the ground, and it matters how it was laid.
        let mut near = catalog::tank_robot();
        near.robot.as_mut().unwrap().at_m = [0.5, 0.1];
        let answer = Simulation::new(near, model).unwrap().settle().unwrap();
        assert!(answer.warnings.iter().any(|w| w.kind == WarningKind::NotUnique), "{model}");
    }
}

/// The opening scene is harmless: over two rounds of the robot's path nothing is warned of, and the
/// tension stays below half of the service tension.
#[test]
fn the_opening_scene_has_nothing_to_warn_of() {
    let scene = catalog::tank_robot();
    let service_n = scene.cables[0].service_tension_n;
    let mut simulation = Simulation::new(scene, Model::Auto).unwrap();
    let mut answer = simulation.settle().unwrap();
    let (mut greatest_n, mut span_m) = (0.0_f64, [f64::INFINITY, f64::NEG_INFINITY]);
    while answer.time_s < 45.0 {
        assert!(answer.warnings.is_empty(), "{} s: {:?}", answer.time_s, answer.warnings);
        greatest_n = greatest_n.max(answer.max_tension().tension_n);
        let x_m = answer.robot.unwrap().x_m;
        span_m = [span_m[0].min(x_m), span_m[1].max(x_m)];
        simulation.step(1.0 / 60.0).unwrap();
        answer = simulation.solution();
    }
    assert!(span_m[0] < 3.5 && span_m[1] > 5.6, "the robot drives out and back: {span_m:?}");
    assert!(greatest_n > 200.0 && greatest_n < 0.5 * service_n, "{greatest_n} N");
}
