//! A run with inertia says its Mach and Froude numbers and, beside a run without inertia, whether
//! masses matter in it.
//!
//! All: `cargo test --locked -p cable-core --test inertia_matters -- --ignored --nocapture`;
//! `FROM=1000 TO=1200` takes other motions than those from which the rule was made.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::model::{Inertia, Question};
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};
use cable_core::solution::{InertiaEffect, NeglectedEffect};
use cable_core::timeline::{Instant, Timeline};
use cable_core::{ErrorEstimates, Model, Settings, Simulation};

use self::dice::Dice;

/// Time of a motion, s.
const SECONDS: f64 = 1.0;
const KNOTS: u32 = 40;

/// A cable of a length (m) between supports 8 m apart, of which one goes to and fro by `reach` (m)
/// as a sine squared.
fn shaken(length_m: f64, reach: [f64; 2]) -> Scene {
    let mut scene = catalog::hanging_span();
    let home = [4.0, 3.0];
    let times_s: Vec<f64> = (0..=KNOTS).map(|k| SECONDS * f64::from(k) / f64::from(KNOTS)).collect();
    let part = |t: &f64| (std::f64::consts::PI * t / SECONDS).sin().powi(2);
    let points_m = times_s.iter().map(|t| [home[0] + reach[0] * part(t), home[1] + reach[1] * part(t)]).collect();
    let shaken = Support { motion: Some(Motion { times_s, points_m }), ..Support::fixed("right", home) };
    let cable = &mut scene.cables[0];
    (cable.length_m, cable.segments) = (length_m, Some(40));
    (cable.axial_stiffness_n, cable.linear_density_kg_per_m) = (1e5, 0.4);
    (cable.breaking_tension_n, cable.service_tension_n) = (1e12, 1e12);
    cable.supports = vec![Support::fixed("left", [-4.0, 3.0]), shaken];
    scene.obstacles.clear();
    scene
}

const CREST: &str = r#"
version = 1
name = "x"

[environment]

[[cables]]
name = "c"
length_m = 4.136591221040085
linear_density_kg_per_m = 1.0
axial_stiffness_n = 200000.0
bending_stiffness_n_m2 = 0.0
diameter_m = 0.01
damping_ratio = 0.02
service_tension_n = 1000000000000.0
breaking_tension_n = 1000000000000.0
friction = 0.0
route_m = [[-1.5911035324732896, -1.8468261745737717], [0, 0.005], [1.4103285992028258, -0.9341700985018764]]
  [[cables.supports]]
  name = "A"
  kind = "free"
  [[cables.supports]]
  name = "B"
  kind = "fixed"
  at_m = [1.4103285992028258, -0.9341700985018764]
  release_s = 0.1

[[obstacles]]
name = "wedge"
kind = "terrain"
points_m = [[-7.813821178520827, -9.107370564004706], [0, 0], [9.984733558806683, -6.656207310446364]]
friction = 0.0
"#;

/// A cable over a crest without friction is let go and slides for ever: the run without inertia
/// beside it looked for a rest that there is not, for minutes.
#[test]
fn issue_019_a_cable_that_slides_for_ever_has_no_run_without_inertia() {
    let scene = Scene::from_toml(CREST).expect("a sound scene");
    let question = Question::History(Inertia::Dynamic);
    let mut sim = Simulation::for_question(scene, Model::Auto, Settings::default(), question).unwrap();
    sim.settle().unwrap();
    let mut timeline = Timeline::new(sim, Inertia::Dynamic, None).unwrap().with_next_cheaper();
    let answer = timeline.at(Instant::nearest(0.15), |_| ()).unwrap();
    let without = answer.next_cheaper.expect("a run beside it");
    assert_eq!((without.neglects, without.force_error), (NeglectedEffect::Inertia, None));
}

/// The run of a scene by `auto`, with errors and with a run without inertia.
fn effect(scene: &Scene) -> InertiaEffect {
    let question = Question::History(Inertia::Dynamic);
    let mut sim = Simulation::for_question(scene.clone(), Model::Auto, Settings::default(), question).unwrap();
    sim.settle().unwrap();
    let mut timeline = Timeline::new(sim, Inertia::Dynamic, None).unwrap().with_errors().with_next_cheaper();
    let answer = timeline.at(Instant::nearest(SECONDS), |_| ()).unwrap();
    let effect = timeline.inertia_effect().expect("a run with inertia");
    assert_eq!(answer.next_cheaper, effect.without);
    effect
}

#[test]
fn a_slow_motion_goes_without_inertia_and_a_fast_one_does_not() {
    let (slow, fast) = (effect(&shaken(8.5, [0.0, -1e-5])), effect(&shaken(10.0, [0.03, -0.01])));
    println!("slow: {slow}\nfast: {fast}");
    assert_eq!((slow.matters(), fast.matters()), (Some(false), Some(true)));
    let without = fast.without.expect("a run");
    assert_eq!((without.model, without.neglects), (Model::Catenary, NeglectedEffect::Inertia));
    // The end's own greatest speed is π times its way over the time.
    let end = std::f64::consts::PI * 0.03f64.hypot(0.01) / SECONDS;
    let speed = fast.numbers.greatest_speed_m_per_s;
    assert!(speed > 0.9 * end, "{speed}");
    assert!((fast.numbers.mach / (speed / (1e5f64 / 0.4).sqrt()) - 1.0).abs() < 1e-12);
    let froude = fast.numbers.froude.expect("gravity");
    assert!((froude / (speed / (9.80665f64 * 10.0).sqrt()) - 1.0).abs() < 1e-3, "{froude}");
    assert!(fast.to_string().contains("inertia matters at tolerance 0.001"), "{fast}");
    assert!(slow.to_string().contains("inertia does not matter at tolerance 0.001"), "{slow}");
}

/// Without inertia there is no way down for what is let go.
#[test]
fn a_fall_does_not_go_without_inertia() {
    let mut scene = shaken(8.5, [0.0, 0.0]);
    for support in &mut scene.cables[0].supports {
        (support.motion, support.release_s) = (None, Some(0.1));
    }
    let effect = effect(&scene);
    println!("{effect}");
    assert_eq!(effect.matters(), Some(true));
    assert_eq!(effect.without.and_then(|w| w.force_error), None);
}

/// A slow cable that can touch itself: steps without inertia search longer than those with it. That
/// such a run is given up says nothing about inertia.
#[test]
fn issue_016_a_run_without_inertia_that_costs_more_leaves_the_verdict_open() {
    let mut scene = shaken(8.5, [0.0, 0.0]);
    let shape = Shape::Terrain { points_m: vec![[-6.0, 0.0], [30.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".into(), shape, friction: Some(0.5) }];
    let cable = &mut scene.cables[0];
    (cable.self_contact, cable.length_m, cable.segments) = (true, 6.0, Some(60));
    (cable.axial_stiffness_n, cable.linear_density_kg_per_m) = (4e5, 0.6);
    cable.supports = vec![Support::fixed("left", [0.0, 2.0]), Support::fixed("right", [2.0, 2.0])];
    cable.supports[1].motion = Some(Motion { times_s: vec![0.0, 20.0], points_m: vec![[2.0, 2.0], [1.8, 2.0]] });
    let question = Question::History(Inertia::Dynamic);
    let mut sim = Simulation::for_question(scene, Model::Auto, Settings::default(), question).unwrap();
    sim.settle().unwrap();
    let mut timeline = Timeline::new(sim, Inertia::Dynamic, None).unwrap().with_next_cheaper();
    timeline.at(Instant::nearest(5.0), |_| ()).unwrap();
    let effect = timeline.inertia_effect().expect("a run with inertia");
    println!("{effect}");
    let without = effect.without.expect("a run beside it");
    assert!(without.costs_more && without.force_error.is_none(), "{effect}");
    assert_eq!(effect.matters(), None);
}

#[test]
fn a_run_without_inertia_has_no_such_numbers() {
    let mut sim = Simulation::new(shaken(8.5, [0.0, -0.1]), Model::Auto).unwrap();
    sim.settle().unwrap();
    let timeline = Timeline::new(sim, Inertia::QuasiStatic, None).unwrap().with_next_cheaper();
    assert_eq!(timeline.inertia_effect(), None);
}

/// The most by which runs with and without inertia differ, beyond what they do at rest, in parts of
/// the greatest tension: on four times as many elements, in half the steps.
fn difference(scene: &Scene) -> Option<f64> {
    let mut scene = scene.clone();
    scene.cables[0].segments = scene.cables[0].segments.map(|n| 4 * n);
    let run = |model, inertia, step_s| {
        let settings = Settings { inner_step_s: Some(step_s), histories: false, ..Settings::default() };
        let mut sim = Simulation::for_question(scene.clone(), model, settings, Question::History(inertia)).ok()?;
        sim.settle().ok()?;
        Timeline::new(sim, inertia, Some(step_s)).ok()
    };
    let mut with = run(Model::Fem, Inertia::Dynamic, 1.0 / 480.0)?;
    let mut without = run(Model::Auto, Inertia::QuasiStatic, 1.0 / 120.0)?;
    let (mut at_rest, mut apart, mut most) = (0.0f64, 0.0f64, 0.0f64);
    for k in 0..=60u64 {
        let at = Instant::nearest(SECONDS / 60.0).times(k);
        let (a, b) = (with.at(at, |_| ()).ok()?, without.at(at, |_| ()).ok()?);
        let errors = ErrorEstimates::between(&b.cables[0], &a.cables[0]);
        apart = apart.max(errors.max_tension_n?).max(errors.support_force_n?);
        at_rest = if k == 0 { apart } else { at_rest };
        most = most.max(a.max_tension().tension_n);
    }
    Some((apart - at_rest) / most)
}

/// Of random motions, slow and fast, in the air and on a floor, the verdict is that of finer runs
/// of both kinds, but where they differ by nearly the tolerance.
#[test]
#[ignore = "minutes"]
fn verdicts_are_those_of_finer_runs() {
    let (mut right, mut near, mut wrong, mut slow, mut hidden) = (0u64, 0, Vec::new(), 0u64, 0);
    let number = |name: &str, usual: u64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(usual);
    let numbers = number("FROM", 0)..number("TO", 100);
    let count = numbers.end.saturating_sub(numbers.start);
    for number in numbers {
        let mut dice = Dice(number.wrapping_mul(0x2000_0003) + 19);
        let reach = dice.log(1e-6, 1.0);
        let angle = dice.within(0.0, std::f64::consts::TAU);
        let mut scene = shaken(dice.within(8.3, 11.0), [reach * angle.cos(), reach * angle.sin()]);
        let cable = &mut scene.cables[0];
        cable.axial_stiffness_n = dice.log(1e4, 1e7);
        cable.linear_density_kg_per_m = dice.within(0.1, 2.0);
        if dice.chance(0.5) {
            let shape = Shape::Terrain { points_m: vec![[-20.0, 1.5], [20.0, 1.5]] };
            scene.obstacles = vec![Obstacle { name: "floor".into(), shape, friction: Some(dice.within(0.0, 0.6)) }];
        }
        let said = effect(&scene);
        let is = difference(&scene);
        let tolerance = said.tolerance;
        slow += u64::from(said.matters() == Some(false));
        let line = format!(
            "{number}: reach {reach:.1e} m, {said}; at rest {:.1e}; finer: {is:?}",
            said.error_at_rest.unwrap_or(f64::NAN)
        );
        println!("{line}");
        match is {
            _ if said.matters().is_none() => hidden += 1,
            Some(is) if is > 0.5 * tolerance && is < 2.0 * tolerance => near += 1,
            is if said.matters() == Some(!is.is_some_and(|is| is <= tolerance)) => right += 1,
            _ => wrong.push(line),
        }
    }
    println!(
        "{right} right, {near} near the tolerance, {hidden} hidden, {} wrong, {slow} go without inertia",
        wrong.len()
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(100 * right > 60 * count && 100 * slow > 10 * count, "{right} {slow}");
}
