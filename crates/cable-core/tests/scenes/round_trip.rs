//! A scene saved and loaded again is the same scene, to the last bit.

use cable_core::Scene;
use cable_core::error::SceneFault;
use cable_core::scene::{
    Cable, Environment, Heading, Load, Motion, Obstacle, PulleySide, Robot, RobotTask, Shape, Support, SupportKind,
    View, catalog, preset,
};
use proptest::prelude::*;

#[test]
fn catalogue_scenes_survive() {
    for (id, scene) in catalog::all() {
        let text = scene.to_toml();
        assert_eq!(Scene::from_toml(&text).unwrap_or_else(|e| panic!("{id}: {e}\n{text}")), scene, "{id}");
        assert_eq!(Scene::from_toml(&text).unwrap().to_toml(), text, "{id}");
        assert!(text.starts_with("version = 1\n"), "{id}:\n{text}");
    }
    let full = super::full();
    assert_eq!(Scene::from_toml(&full.to_toml()).unwrap(), full);
}

#[test]
fn of_a_preset_only_the_differences_are_written() {
    let mut scene = catalog::hanging_span();
    let text = scene.to_toml();
    assert!(text.contains("preset = \"soow-6-4\"") && !text.contains("axial_stiffness_n"), "{text}");
    scene.cables[0].axial_stiffness_n = 3.0e6;
    let text = scene.to_toml();
    assert!(text.contains("axial_stiffness_n = 3000000.0") && !text.contains("diameter_m"), "{text}");
    scene.cables[0].preset = None;
    assert!(scene.to_toml().contains("diameter_m = 0.028"));
    // A half-typed scene can be written too.
    scene.cables[0].length_m = f64::NAN;
    assert!(scene.to_toml().contains("length_m = nan"));
}

#[test]
fn a_support_takes_its_motion_along() {
    let mut scene = catalog::tank();
    let hitch = &mut scene.cables[0].supports[1];
    hitch.move_to([4.0, 1.0]);
    let way = hitch.motion.as_ref().unwrap();
    assert_eq!((way.at(0.0).0.x, way.at(0.0).0.y), (4.0, 1.0));
    scene.validate().unwrap();
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -100.0..100.0f64, (-3.0..3.0f64).prop_map(|e| 10f64.powf(e)), Just(-0.0)]
}

fn positive() -> impl Strategy<Value = f64> {
    (-3.0..3.0f64).prop_map(|e| 10f64.powf(e))
}

fn point() -> impl Strategy<Value = [f64; 2]> {
    [number(), number()]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z]{1,8}", Just("\"quoted\" = [x]\n#é😀".to_owned()), Just("'''".to_owned())]
}

fn points(least: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    // Steps to the right with some height: never two points in one place, never without an area.
    proptest::collection::vec((0.01..5.0f64, -3.0..3.0f64), least..8).prop_map(|steps| {
        let mut x = -5.0;
        let line = steps.into_iter().enumerate().map(|(i, (dx, y))| {
            x += dx;
            [x, if i % 2 == 0 { y } else { y + 10.0 }]
        });
        line.collect()
    })
}

/// A line that goes from left to right, closed below itself: a polygon that does not cross itself.
fn closed_below(mut line: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let below = line.iter().fold(0.0_f64, |low, p| low.min(p[1])) - 1.0;
    let (first, last) = (line[0][0], line[line.len() - 1][0]);
    line.extend([[last, below], [first, below]]);
    line
}

fn obstacles() -> impl Strategy<Value = Vec<Obstacle>> {
    let shape = prop_oneof![
        points(2).prop_map(|points_m| Shape::Terrain { points_m }),
        points(3).prop_map(|points_m| Shape::Polygon { points_m: closed_below(points_m) }),
        (points(2), positive()).prop_map(|(points_m, thickness_m)| Shape::Polyline { points_m, thickness_m }),
        (point(), positive()).prop_map(|(center_m, radius_m)| Shape::Circle { center_m, radius_m }),
    ];
    proptest::collection::vec((name(), shape, proptest::option::of(0.0..2.0f64)), 0..4).prop_map(|all| {
        let named = all.into_iter().enumerate();
        named.map(|(i, (name, shape, friction))| Obstacle { name: format!("{name}{i}"), shape, friction }).collect()
    })
}

fn end(place: &'static str) -> impl Strategy<Value = Support> {
    let motion = proptest::collection::vec((0.1..4.0f64, point()), 1..5).prop_map(|knots| {
        let mut time = 0.0;
        let (mut times_s, mut points_m) = (Vec::new(), Vec::new());
        for (dt, p) in knots {
            times_s.push(time);
            points_m.push(p);
            time += dt;
        }
        Motion { times_s, points_m }
    });
    prop_oneof![
        point().prop_map(move |p| Support::fixed(place, p)),
        (point(), -360.0..360.0f64).prop_map(move |(p, angle)| Support {
            at_m: Some(p),
            angle_deg: Some(angle),
            ..Support::new(place, SupportKind::Clamped)
        }),
        (motion, proptest::option::of(positive())).prop_map(move |(motion, release_s)| Support {
            release_s,
            at_m: motion.points_m.first().copied(),
            motion: Some(motion),
            ..Support::new(place, SupportKind::Fixed)
        }),
        proptest::option::of(positive()).prop_map(move |mass_kg| Support { mass_kg, ..Support::free(place) }),
        point().prop_map(move |f| Support { force_n: Some(f), ..Support::new(place, SupportKind::Load) }),
        Just(Support {
            times_s: vec![-1.0, 2.5],
            forces_n: vec![[1.0, 2.0], [-0.5, 1e-300]],
            ..Support::new(place, SupportKind::Load)
        }),
        Just(Support::new(place, SupportKind::Robot)),
    ]
}

fn middle() -> impl Strategy<Value = Vec<Support>> {
    let pulley = (point(), proptest::option::of(0.0..1.0f64), any::<bool>()).prop_map(|(p, radius_m, under)| Support {
        radius_m,
        side: under.then_some(PulleySide::Under),
        friction: under.then_some(0.25),
        ..Support::pulley("", p)
    });
    let fixed = point().prop_map(|p| Support::fixed("", p));
    proptest::collection::vec(prop_oneof![pulley, fixed], 0..4)
}

fn cable() -> impl Strategy<Value = Cable> {
    let preset = proptest::option::of((0..preset::cable_presets().len()).prop_map(|i| preset::cable_presets()[i].id));
    let numbers = proptest::array::uniform10(proptest::option::of(positive()));
    let rest = (proptest::option::of(1..100_000usize), any::<bool>(), proptest::option::of(points(2)));
    ((name(), preset, numbers), (end("start"), middle(), end("end")), rest).prop_map(
        |((name, preset, numbers), (start, middle, end), (segments, self_contact, route))| {
            let base = preset.and_then(preset::cable_preset);
            let value =
                |k: usize, otherwise: f64| numbers[k].or(base.map(|p| p.figures()[k].1.value)).unwrap_or(otherwise);
            let mut supports = vec![start];
            let count = middle.len();
            for (i, mut support) in middle.into_iter().enumerate() {
                support.name = format!("mid {i}");
                if support.kind == SupportKind::Fixed {
                    #[expect(clippy::cast_precision_loss)]
                    let fraction = (i + 1) as f64 / (count + 1) as f64;
                    support.arc_length_m = Some(1e5 * fraction);
                }
                supports.push(support);
            }
            supports.push(end);
            Cable {
                name,
                preset: preset.map(str::to_owned),
                length_m: 1e5,
                linear_density_kg_per_m: value(0, 1.0),
                axial_stiffness_n: value(1, 1e5) + 1.0,
                bending_stiffness_n_m2: value(2, 0.0),
                diameter_m: value(3, 0.01) / 1000.0 + 1e-5,
                damping_ratio: value(4, 0.0) / 1000.0,
                bending_damping_ratio: self_contact.then_some(value(4, 0.0) / 500.0),
                thermal_expansion_per_k: value(5, 0.0) / 1e6,
                service_tension_n: value(6, 1.0),
                breaking_tension_n: value(7, 1.0) + value(6, 1.0),
                breaking_time_s: base.map_or(1e-3, |p| p.breaking_time_s.value),
                min_bend_radius_m: value(8, 0.0),
                sidewall_limit_n_per_m: None,
                friction: value(9, 0.0) / 1000.0,
                friction_mobilised: cable_core::scene::FrictionMobilised::ALL[segments.unwrap_or(0) % 3],
                segments,
                self_contact,
                route_m: route.unwrap_or_default(),
                supports,
            }
        },
    )
}

fn scenes() -> impl Strategy<Value = Scene> {
    let environment =
        (0.0..20.0f64, point(), any::<bool>(), -50.0..50.0f64).prop_map(|(g, wind, series, t)| Environment {
            gravity_m_per_s2: g,
            wind_n_per_m: wind,
            wind_times_s: if series { vec![0.0, 1.5] } else { vec![] },
            winds_n_per_m: if series { vec![[0.0, 0.0], wind] } else { vec![] },
            temperature_change_k: t,
        });
    (name(), any::<bool>(), environment, cable(), obstacles(), proptest::collection::vec((positive(), point()), 0..3))
        .prop_map(|(name, plan, environment, cable, obstacles, loads)| Scene {
            version: 1,
            name,
            view: if plan { View::Plan } else { View::Elevation },
            environment,
            loads: loads
                .into_iter()
                .map(|(s, f)| Load {
                    cable: cable.name.clone(),
                    arc_length_m: s,
                    force_n: Some(f),
                    times_s: vec![],
                    forces_n: vec![],
                })
                .collect(),
            cables: vec![cable],
            obstacles,
            robot: Some(Robot {
                preset: "dxr-140".to_owned(),
                at_m: [1.0, -0.5],
                heading: if plan { Heading::Left } else { Heading::Right },
                path: vec![RobotTask::Drive { to_x_m: 3.0, speed_m_per_s: 0.1 + 0.2 }, RobotTask::Wait { wait_s: 1.0 }],
                track_friction: plan.then_some(0.3),
                rolling_resistance: None,
                repeat: plan,
            }),
        })
}

proptest! {
    #[test]
    fn generated_scenes_survive(scene in scenes()) {
        let checked = scene.validate();
        // Wheels and ends in one place are no scene.
        prop_assume!(!matches!(&checked, Err(e) if matches!(e.fault, SceneFault::NoWay { .. })));
        if let Err(e) = checked {
            return Err(TestCaseError::fail(format!("generated scene is refused: {e}")));
        }
        let text = scene.to_toml();
        let again = Scene::from_toml(&text).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
        prop_assert_eq!(&again, &scene);
        prop_assert_eq!(again.to_toml(), text);
    }
}
