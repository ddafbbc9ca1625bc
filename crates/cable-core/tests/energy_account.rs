//! The energy of a moving cable comes from somewhere and goes somewhere: over every step what it
//! has gained is the work of each kind of force on it, within 1e-3 of what was exchanged.
//!
//! All of it, with the figures: `cargo test --locked -p cable-core --test energy_account --
//! --nocapture`.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;

use cable_core::scene::{Motion as Path, Obstacle, Scene, Shape, Support};
use cable_core::solution::EnergyAccount;
use cable_core::{Model, Settings, Simulation};

use self::dice::Dice;

/// A motion and the worst imbalance in it.
struct Motion {
    last: EnergyAccount,
    /// Greatest energy that is not accounted for at an instant, in parts of what had been exchanged
    /// by then.
    worst: f64,
    /// Force of the cable on its last support at the end, N.
    held_n: [f64; 2],
}

fn say(name: &str, m: &Motion) {
    let a = &m.last;
    println!(
        "{name}: {:.1e} at worst, {:.1e} at the end of {:.3} J: gained {:.3?}, supports {:.4}, loads {:.4}, outlines {:.4}, friction {:.4}, material {:.4}, impacts {:.4}, edits {:.4}, numerical {:.4}, unaccounted {:.2e}",
        m.worst,
        a.unaccounted_j().abs() / a.exchanged_j,
        a.exchanged_j,
        [a.gained.kinetic_j, a.gained.gravity_j, a.gained.stretch_j, a.gained.bending_j],
        a.supports_j,
        a.loads_j,
        a.outlines_j,
        a.friction_j,
        a.material_j,
        a.impacts_j,
        a.edits_j,
        a.numerical_j,
        a.unaccounted_j(),
    );
}

fn run(name: &str, scene: &Scene, seconds: f64, dt_s: f64) -> Motion {
    run_with(name, scene, Settings::default(), seconds, dt_s)
}

fn run_with(name: &str, scene: &Scene, settings: Settings, seconds: f64, dt_s: f64) -> Motion {
    let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, settings).expect("a sound scene");
    sim.settle().expect("it rests");
    let mut m = Motion { last: EnergyAccount::default(), worst: 0.0, held_n: [0.0; 2] };
    for _ in 0..(seconds / dt_s).round() as usize {
        if let Err(e) = sim.step(dt_s) {
            println!("{name} stops: {e}");
            break;
        }
        let Some(account) = sim.solution().cables[0].energy_account else { continue };
        m.worst = m.worst.max(account.unaccounted_j().abs() / account.exchanged_j.max(1e-9));
        m.last = account;
        m.held_n = sim.answers()[0].supports.last().map_or([0.0; 2], |s| [s.reaction_x_n, s.reaction_y_n]);
        if std::env::var("TELL").is_ok() {
            say(name, &m);
        }
    }
    say(name, &m);
    m
}

fn scene(text: &str) -> Scene {
    Scene::from_toml(&format!("version = 1\n{text}")).expect("a sound scene")
}

/// A cable with these lines, and what else is in the scene.
fn cable(lines: &str, rest: &str) -> Scene {
    scene(&format!("[[cables]]\nname = \"cable\"\npreset = \"soow-6-4\"\n{lines}\n{rest}"))
}

const FLOOR: &str = r#"
[[obstacles]]
name = "floor"
kind = "terrain"
points_m = [[-10.0, 0.0], [20.0, 0.0]]
friction = 0.4
"#;

/// Greatest part of the exchanged energy that may be unaccounted for.
const MAX_UNACCOUNTED_FRACTION: f64 = 1e-3;

fn closes(name: &str, scene: &Scene, seconds: f64) -> EnergyAccount {
    let m = run(name, scene, seconds, 1.0 / 60.0);
    assert!(m.worst < MAX_UNACCOUNTED_FRACTION && m.last.exchanged_j > 0.1, "{name}: {} of {:?}", m.worst, m.last);
    m.last
}

/// A taut span that is let go at one end recoils: its stretch becomes motion towards the end that
/// is held, at T/√(EA ρ) everywhere. The integrator pulled on with bars that had become slack: 12 %
/// more energy than the span held, and its end flew off at 2.1 times that speed. In a span with
/// loss the work of bars that fold went to the material, and 37 % of the energy came from the
/// integrator.
#[test]
fn issue_016_a_taut_span_that_is_let_go_gains_no_energy() {
    let span = |damping: f64| {
        cable(
            &format!(
                r#"length_m = 10.0
axial_stiffness_n = 1e5
linear_density_kg_per_m = 0.5
segments = 40
damping_ratio = {damping}
service_tension_n = 1e8
breaking_tension_n = 1e9
supports = [
    {{ name = "a", kind = "fixed", at_m = [0.0, 0.0] }},
    {{ name = "b", kind = "fixed", at_m = [10.1, 0.0], release_s = 0.01 }},
]"#
            ),
            "[environment]\ngravity_m_per_s2 = 0.0",
        )
    };
    // ½ T²L/EA.
    let held_j = 50.0;
    for dt_s in [1.0 / 240.0, 1.0 / 1000.0, 1.0 / 4000.0] {
        let free = run("let go, without loss", &span(0.0), 0.1, dt_s).last;
        assert!(free.gained.kinetic_j > 0.95 * held_j && free.gained.kinetic_j < 1.01 * held_j, "{free:?}");
        let lossy = run("let go, with loss", &span(0.02), 0.1, dt_s).last;
        assert!(lossy.numerical_j.abs() < 0.03 * held_j, "{lossy:?}");
        // The branches hold a part of the stretch, which the material keeps.
        assert!(lossy.material_j < -0.15 * held_j && lossy.material_j > -0.3 * held_j, "{lossy:?}");
    }
}

#[test]
fn a_swing_in_the_air() {
    let swing = cable(
        r#"length_m = 8.0
segments = 40
damping_ratio = 0.02
supports = [
    { name = "a", kind = "fixed", at_m = [0.0, 5.0] },
    { name = "b", kind = "fixed", at_m = [6.0, 5.0], release_s = 0.1 },
]"#,
        "",
    );
    let a = closes("swing", &swing, 4.0);
    // Nothing but its material and the integrator take anything.
    assert!(a.material_j < 0.0 && a.supports_j == 0.0 && a.friction_j == 0.0 && a.edits_j == 0.0, "{a:?}");
}

/// The end of a hanging cable is led to and fro: what the support gives is what the cable has, and
/// the integrator's part falls with the square of the step at least.
#[test]
fn what_the_integrator_takes_of_a_smooth_motion_falls_with_the_step() {
    let led = cable(
        r#"length_m = 8.0
segments = 40
supports = [
    { name = "a", kind = "fixed", at_m = [0.0, 5.0] },
    { name = "b", kind = "fixed", at_m = [6.0, 5.0], motion = { times_s = [0.0, 2.0, 4.0], points_m = [[6.0, 5.0], [6.5, 4.5], [6.0, 5.5]] } },
]"#,
        "",
    );
    let numerical = [120.0, 480.0].map(|rate: f64| {
        let settings = Settings { inner_step_s: Some(1.0 / rate), ..Settings::default() };
        let m = run_with(&format!("led at 1/{rate} s"), &led, settings, 3.0, 1.0 / 60.0);
        assert!(m.worst < MAX_UNACCOUNTED_FRACTION, "{}", m.worst);
        m.last.numerical_j.abs() / m.last.exchanged_j
    });
    assert!(numerical[1] < 1e-3 && numerical[1] < numerical[0] / 8.0, "{numerical:?}");
}

/// Friction and pull are those of the weight that lies on the floor, times the way.
#[test]
fn a_cable_dragged_along_a_floor_at_constant_speed() {
    let drag = cable(
        r#"length_m = 6.0
segments = 60
friction = 0.4
route_m = [[0.0, 0.02], [6.0, 0.02]]
supports = [
    { name = "a", kind = "free" },
    { name = "b", kind = "fixed", at_m = [6.0, 0.02], motion = { times_s = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], points_m = [[6.0, 0.02], [6.2, 0.02], [7.2, 0.02], [8.2, 0.02], [9.2, 0.02], [10.2, 0.02]] } },
]"#,
        FLOOR,
    );
    let [early, late] = [3.0, 4.0].map(|seconds| run(&format!("drag, {seconds} s"), &drag, seconds, 1.0 / 60.0));
    assert!(
        early.worst < MAX_UNACCOUNTED_FRACTION && late.worst < MAX_UNACCOUNTED_FRACTION,
        "{} {}",
        early.worst,
        late.worst
    );
    let c = &drag.cables[0];
    let weight = c.linear_density_kg_per_m * drag.environment.gravity_m_per_s2 * c.length_m;
    let lies = weight - late.held_n[1].abs();
    let expected = 0.4 * lies;
    let (rubbed, drawn) = (early.last.friction_j - late.last.friction_j, late.last.supports_j - early.last.supports_j);
    println!("friction {rubbed} J, drawn {drawn} J of {expected} J ({lies} N of {weight} N lie)");
    assert!((rubbed / expected - 1.0).abs() < 1e-3 && (drawn / expected - 1.0).abs() < 1e-3, "{rubbed} {drawn}");
    assert!(lies > 0.9 * weight && late.last.numerical_j.abs() < 1e-3 * late.last.exchanged_j, "{:?}", late.last);
}

/// A cable that lands gives what its fall gave it to impacts and friction, and little of that is
/// the integrator's.
#[test]
fn a_drop_on_a_floor() {
    let drop = cable(
        r#"length_m = 6.0
segments = 60
friction = 0.4
supports = [
    { name = "a", kind = "fixed", at_m = [0.0, 2.0], release_s = 0.05 },
    { name = "b", kind = "fixed", at_m = [5.9, 2.0], release_s = 0.05 },
]"#,
        FLOOR,
    );
    let a = closes("drop", &drop, 1.5);
    assert!(a.impacts_j < 0.9 * a.gained.gravity_j && a.numerical_j.abs() < 0.05 * a.exchanged_j, "{a:?}");
}

#[test]
fn a_cable_drawn_over_a_corner() {
    let corner = cable(
        r#"length_m = 6.0
segments = 60
friction = 0.3
route_m = [[-3.0, 2.03], [0.0, 2.03], [0.03, 2.0], [0.03, -0.9]]
supports = [
    { name = "a", kind = "fixed", at_m = [-3.0, 2.03], motion = { times_s = [0.0, 0.5, 3.5], points_m = [[-3.0, 2.03], [-3.0, 2.03], [-4.5, 2.03]] } },
    { name = "b", kind = "load", force_n = [0.0, -60.0] },
]"#,
        r#"
[[obstacles]]
name = "block"
kind = "polygon"
points_m = [[-5.0, 0.0], [0.0, 0.0], [0.0, 2.0], [-5.0, 2.0]]
friction = 0.3
"#,
    );
    let a = closes("corner", &corner, 3.0);
    assert!(a.friction_j < -5.0 && a.loads_j < -50.0, "{a:?}");
}

/// The robot's own account knows what its cable took: the same forces, the same ways.
#[test]
fn a_robot_drives_out_and_back() {
    let scene = cable_core::scene::catalog::robot_drive();
    let mut sim = Simulation::with_settings(scene, Model::Fem, Settings::default()).expect("a sound scene");
    sim.settle().expect("it rests");
    let mut worst = 0.0;
    let mut last = None;
    for _ in 0..8 * 60 {
        sim.step(1.0 / 60.0).expect("it runs");
        let answer = sim.solution();
        if let (Some(a), Some(robot)) = (answer.cables[0].energy_account, answer.robot) {
            worst = f64::max(worst, a.unaccounted_j().abs() / a.exchanged_j.max(1e-9));
            last = Some((a, robot.work.cable_j));
        }
    }
    let (a, taken) = last.expect("it moves");
    say("robot-drive", &Motion { last: a, worst, held_n: [0.0; 2] });
    let given = a.supports_j + a.outlines_j;
    println!("the cable did {taken:.4} J on the robot, which did {given:.4} J on it");
    assert!(worst < MAX_UNACCOUNTED_FRACTION && a.exchanged_j > 30.0, "{worst} of {a:?}");
    assert!((given + taken).abs() < MAX_UNACCOUNTED_FRACTION * a.exchanged_j, "{given} {taken}");
}

/// Obstacles, ends that are let go or led, wind, stiff cables and loops by seed.
fn random(seed: u64) -> Scene {
    let mut dice = Dice(seed.wrapping_mul(0x2000_0003) + 11);
    let mut scene = cable(
        "length_m = 6.0\nsupports = [{ name = \"a\", kind = \"fixed\", at_m = [0.0, 2.0] }, { name = \"b\", kind = \"free\" }]",
        FLOOR,
    );
    let mut friction = || Some(dice.within(0.0, 0.8));
    let [of_floor, of_post, of_beam] = [friction(), friction(), friction()];
    scene.obstacles[0].friction = of_floor;
    if dice.chance(0.3) {
        scene.obstacles.clear();
    } else {
        if dice.chance(0.5) {
            let shape = Shape::Circle { center_m: [dice.within(-1.0, 1.0), 1.0], radius_m: dice.within(0.05, 0.3) };
            scene.obstacles.push(Obstacle { name: "post".to_owned(), shape, friction: of_post });
        }
        if dice.chance(0.5) {
            let (x, b) = (dice.within(1.5, 2.0), dice.within(0.1, 0.6));
            let points_m = vec![[x, 0.8], [x + b, 0.8], [x + b, 1.2], [x, 1.2]];
            scene.obstacles.push(Obstacle {
                name: "beam".to_owned(),
                shape: Shape::Polygon { points_m },
                friction: of_beam,
            });
        }
    }
    let c = &mut scene.cables[0];
    c.length_m = dice.within(6.2, 9.0);
    c.segments = Some(dice.within(20.0, 80.0) as usize);
    c.axial_stiffness_n = dice.log(1e4, 1e7);
    c.damping_ratio = dice.within(0.0, 0.05);
    (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
    c.bending_stiffness_n_m2 = if dice.chance(0.25) { dice.log(0.1, 10.0) } else { 0.0 };
    c.self_contact = dice.chance(0.2);
    let mut ends = [Support::fixed("left", [-3.0, 2.5]), Support::fixed("right", [3.0, 2.5])];
    for end in &mut ends {
        let kind = dice.unit();
        if kind < 0.35 {
            end.release_s = Some(dice.within(0.05, 0.6));
        } else if kind < 0.8 {
            let home = end.at_m.expect("a fixed end");
            let mut points_m = vec![home];
            points_m.extend((0..3).map(|_| [home[0] + dice.within(-1.0, 1.0), dice.within(2.0, 3.5)]));
            let quick = dice.within(0.2, 0.8);
            end.motion = Some(Path { times_s: (0..4).map(|k| quick * f64::from(k)).collect(), points_m });
        }
    }
    c.supports = ends.into();
    scene
}

#[test]
fn without_an_account_the_motion_is_the_same_to_the_bit() {
    let scene = random(3);
    let [with, without] = [true, false].map(|energy_account| {
        let settings = Settings { energy_account, ..Settings::default() };
        let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, settings).expect("a sound scene");
        sim.settle().expect("it rests");
        (0..60).for_each(|_| sim.step(1.0 / 240.0).expect("a step"));
        sim.solution().cables.remove(0)
    });
    assert!(with.energy_account.is_some() && without.energy_account.is_none());
    assert_eq!(with.nodes, without.nodes);
}

#[test]
fn random_scenes_close() {
    let (mut worst, mut count) = (0.0, 0);
    let only = std::env::var("SEED").ok().and_then(|s| s.parse::<u64>().ok());
    for seed in (0..40).filter(|seed| only.is_none_or(|o| o == *seed)) {
        let scene = random(seed);
        let Ok(mut sim) = Simulation::with_settings(scene.clone(), Model::Fem, Settings::default()) else { continue };
        if sim.settle().is_err() {
            continue;
        }
        let m = run(&format!("seed {seed}"), &scene, 1.2, 1.0 / 60.0);
        if m.last.exchanged_j > 1e-3 {
            (worst, count) = (f64::max(worst, m.worst), count + 1);
        }
    }
    println!("{count} random scenes: {worst:.1e} at worst");
    assert!(worst < MAX_UNACCOUNTED_FRACTION && (count > 25 || only.is_some()), "{worst} of {count}");
}

#[test]
#[ignore = "tells of the motions of the catalogue; nothing is asked"]
fn the_catalogue() {
    let only = std::env::var("SCENE").ok();
    for (name, scene) in cable_core::scene::catalog::all() {
        if only.as_deref().is_none_or(|o| o == name) && Simulation::new(scene.clone(), Model::Fem).is_ok() {
            run(name, &scene, 3.0, 1.0 / 60.0);
        }
    }
}

/// A cable that is drawn until it breaks, and falls on the floor: the account goes on over the
/// break, whether its pieces are two models (`self_contact` false) or one.
fn a_break(self_contact: bool, stiffness: f64) -> Vec<EnergyAccount> {
    let lines = format!(
        r#"length_m = 6.0
segments = 48
self_contact = {self_contact}
axial_stiffness_n = 1e5
bending_stiffness_n_m2 = {stiffness}
breaking_tension_n = 500.0
service_tension_n = 400.0
supports = [
    {{ name = "a", kind = "fixed", at_m = [0.0, 1.0] }},
    {{ name = "top", kind = "fixed", at_m = [2.9, 1.5], arc_length_m = 3.2 }},
    {{ name = "b", kind = "fixed", at_m = [5.6, 1.0], motion = {{ times_s = [0.0, 0.6], points_m = [[5.6, 1.0], [6.4, 0.9]] }} }},
]"#
    );
    let mut sim =
        Simulation::with_settings(cable(&lines, FLOOR), Model::Fem, Settings::default()).expect("a sound scene");
    sim.settle().expect("it rests");
    let mut accounts = Vec::new();
    for _ in 0..720 {
        sim.step(1.0 / 240.0).expect("it moves");
        let account = sim.solution().cables[0].energy_account.expect("an account");
        assert!((account.over_s - sim.time_s()).abs() < 1e-9, "{} of {} s", account.over_s, sim.time_s());
        accounts.push(account);
    }
    assert_eq!(sim.solution().cables[0].breaks.len(), 1, "it breaks once");
    accounts
}

#[test]
fn the_account_goes_on_over_a_break() {
    for (self_contact, stiffness) in [(false, 0.0), (true, 0.0), (false, 0.5), (true, 0.5)] {
        let accounts = a_break(self_contact, stiffness);
        let part = |e: f64, a: &EnergyAccount| e.abs() / a.exchanged_j.max(1e-9);
        let worst = accounts.iter().map(|a| part(a.unaccounted_j(), a)).fold(0.0, f64::max);
        let last = accounts[accounts.len() - 1];
        println!("self_contact {self_contact}, EI {stiffness}: {worst:.1e} not accounted for, {last:?}");
        assert!(worst < MAX_UNACCOUNTED_FRACTION, "{worst}");
        // Nothing but the bend at the place of the break is lost there.
        assert!(part(last.breaks_j, &last) < MAX_UNACCOUNTED_FRACTION, "{last:?}");
        assert!(last.breaks_j <= 1e-9 * last.exchanged_j || !self_contact, "{last:?}");
        // The work of supports is not forgotten, and the exchanged energy only grows.
        for pair in accounts.windows(2) {
            let [a, b] = pair else { continue };
            assert!(b.exchanged_j >= a.exchanged_j * (1.0 - 1e-12), "{a:?} {b:?}");
            // The drawn end pulls with 500 N at most, and goes 5.6 mm in a step.
            assert!((b.supports_j - a.supports_j).abs() < 4.0, "{a:?} {b:?}");
        }
        assert!(last.supports_j > 1.0, "{last:?}");
    }
}

/// A clamped cable that a load has bent rings down: what its bends lose is the work of its
/// material, and none of it comes back as energy from nowhere.
#[test]
fn what_bends_lose_is_the_work_of_the_material() {
    let scene = cable(
        r#"length_m = 2.0
bending_stiffness_n_m2 = 20.0
damping_ratio = 0.0
bending_damping_ratio = 0.05
segments = 24
[[cables.supports]]
name = "wall"
kind = "clamped"
at_m = [0.0, 0.0]
angle_deg = 0.0
[[cables.supports]]
name = "end"
kind = "load"
times_s = [0.0, 0.2, 0.21]
forces_n = [[0.0, 0.0], [0.0, -3.0], [0.0, 0.0]]"#,
        "[environment]\ngravity_m_per_s2 = 0.0",
    );
    for dt_s in [1.0 / 240.0, 1.0 / 960.0] {
        let m = run("a clamped cable that rings down", &scene, 3.0, dt_s);
        let a = &m.last;
        assert!(m.worst < 1e-3, "{} of what was exchanged", m.worst);
        assert!(-a.material_j > 0.5 * a.loads_j, "the material takes {} of {} J", a.material_j, a.loads_j);
        assert!(a.numerical_j.abs() < 0.02 * a.loads_j, "steps take {} J", a.numerical_j);
        assert!(a.gained.total_j() > 0.0, "{:?}", a.gained);
    }
}
