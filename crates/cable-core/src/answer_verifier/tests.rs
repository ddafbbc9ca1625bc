//! Sound answers pass; each kind of fault, put into a sound answer by hand, is found and named.

use super::{Depth, Law, Verification, Verifier};
use crate::model::Mechanics;
use crate::model::fem::FemModel;
use crate::problem::problems;
use crate::scene::{Scene, Shape};
use crate::solution::{CableSolution, ContactReport, Solution};
use crate::{Model, Settings, Simulation};

const SPAN: &str = r#"
version = 1
[[cables]]
name = "cable"
preset = "soow-6-4"
length_m = 11.0
supports = [ { name = "a", kind = "fixed", at_m = [0.0, 5.0] }, { name = "b", kind = "fixed", at_m = [10.0, 6.0] } ]
[[loads]]
cable = "cable"
arc_length_m = 4.0
force_n = [3.0, -20.0]
"#;

const OVER_POST: &str = r#"
version = 1
[[cables]]
name = "cable"
preset = "soow-6-4"
length_m = 10.6
friction = 0.3
supports = [ { name = "a", kind = "fixed", at_m = [0.0, 3.0] }, { name = "b", kind = "fixed", at_m = [10.0, 2.0] } ]
[[obstacles]]
name = "post"
kind = "circle"
center_m = [5.0, 2.7]
radius_m = 0.3
[[obstacles]]
name = "floor"
kind = "terrain"
points_m = [[-5.0, 0.0], [15.0, 0.0]]
"#;

fn solved(text: &str, model: Model) -> (Scene, Solution) {
    let scene = Scene::from_toml(text).unwrap();
    let solution = Simulation::new(scene.clone(), model).unwrap().settle().unwrap();
    (scene, solution)
}

fn check(scene: &Scene, solution: &Solution) -> Verification {
    Verifier::new(scene).check(scene, solution, Depth::Full)
}

/// The laws that a changed answer violates.
fn broken(text: &str, change: impl Fn(&mut CableSolution)) -> Vec<Law> {
    let (scene, mut solution) = solved(text, Model::Auto);
    assert_eq!(check(&scene, &solution).findings, [], "sound before");
    change(&mut solution.cables[0]);
    check(&scene, &solution).findings.iter().map(|f| f.law).collect()
}

#[track_caller]
fn sees(law: Law, text: &str, change: impl Fn(&mut CableSolution)) {
    let found = broken(text, change);
    assert!(found.contains(&law), "{law:?} is not in {found:?}");
}

#[test]
fn sound_answers_of_every_model_pass() {
    for (text, models) in
        [(SPAN, &[Model::Catenary, Model::Fem, Model::MassSpring][..]), (OVER_POST, &[Model::Spans, Model::Fem])]
    {
        for &model in models {
            let (scene, solution) = solved(text, model);
            let found = check(&scene, &solution);
            assert!(found.is_sound(), "{model}: {:?}", found.findings);
            assert!(found.checked.contains(&Law::Balance) && found.balance.residual_n <= 2e-3 * found.balance.scale_n);
        }
    }
}

#[test]
fn a_number_that_is_none_is_seen() {
    sees(Law::Finite, SPAN, |c| c.nodes[3].tension_n = f64::NAN);
    sees(Law::Finite, SPAN, |c| c.supports[1].reaction_x_n = f64::INFINITY);
    sees(Law::Finite, OVER_POST, |c| c.contacts[0].normal_n = f64::NEG_INFINITY);
    sees(Law::Finite, SPAN, |c| c.nodes.clear());
}

#[test]
fn material_that_is_missing_is_seen() {
    sees(Law::Material, SPAN, |c| {
        c.nodes.pop();
    });
    sees(Law::Material, SPAN, |c| c.nodes.swap(4, 9));
}

#[test]
fn a_thousandth_of_a_force_that_is_missing_is_seen() {
    sees(Law::Balance, SPAN, |c| c.supports[0].reaction_y_n *= 1.001);
    sees(Law::Balance, SPAN, |c| c.nodes.iter_mut().take(8).for_each(|n| n.force_n[0] *= 1.001));
    sees(Law::TotalBalance, OVER_POST, |c| c.contacts[0].force_n[1] *= 1.02);
    // A contact that nobody reports.
    sees(Law::TotalBalance, OVER_POST, |c| c.contacts.clear());
}

#[test]
fn a_contact_in_the_air_is_seen() {
    let (scene, solution) = solved(OVER_POST, Model::Auto);
    let mut elsewhere = scene.clone();
    // The post is put where nothing touches it.
    let Shape::Circle { center_m, .. } = &mut elsewhere.obstacles[0].shape else { panic!() };
    *center_m = [5.0, 20.0];
    let found = Verifier::new(&elsewhere).check(&elsewhere, &solution, Depth::Always);
    assert!(found.findings.iter().any(|f| f.law == Law::Balance), "{:?}", found.findings);
}

#[test]
fn compression_is_seen() {
    // A bar between supports that pushes them apart, its weight balanced at every node.
    sees(Law::Compression, SPAN, |c| {
        let turn = |f: &mut [f64; 2]| f[0] = -f[0];
        c.nodes.iter_mut().for_each(|n| turn(&mut n.force_n));
    });
}

#[test]
fn a_tension_that_is_not_the_force_is_seen() {
    sees(Law::Tension, SPAN, |c| c.nodes[9].tension_n *= 1.01);
    sees(Law::Tension, OVER_POST, |c| c.nodes.iter_mut().for_each(|n| n.tension_n = -n.tension_n));
}

#[test]
fn a_way_that_is_not_the_material_is_seen() {
    sees(Law::Length, SPAN, |c| c.nodes.iter_mut().for_each(|n| n.y_m = 5.0 + 1.01 * (n.y_m - 5.0)));
    // Arches at no tension: more way than material.
    sees(Law::Length, SPAN, |c| {
        c.nodes.iter_mut().for_each(|n| {
            n.force_n = [0.0; 2];
            n.x_m *= 1.5;
        });
    });
}

#[test]
fn what_lies_inside_an_obstacle_is_seen() {
    sees(Law::Penetration, OVER_POST, |c| c.nodes.iter_mut().for_each(|n| n.y_m -= 0.01));
    let deep = OVER_POST.replace("center_m = [5.0, 2.7]", "center_m = [5.0, 2.8]");
    let (_, solution) = solved(OVER_POST, Model::Auto);
    let scene = Scene::from_toml(&deep).unwrap();
    let found = check(&scene, &solution);
    assert!(found.findings.iter().any(|f| f.law == Law::Penetration), "{:?}", found.findings);
    // Under the floor, further than any reach.
    sees(Law::Penetration, SPAN_OVER_FLOOR, |c| c.nodes.iter_mut().for_each(|n| n.y_m -= 40.0));
}

const SPAN_OVER_FLOOR: &str = r#"
version = 1
[[cables]]
name = "cable"
preset = "soow-6-4"
length_m = 11.0
supports = [ { name = "a", kind = "fixed", at_m = [0.0, 5.0] }, { name = "b", kind = "fixed", at_m = [10.0, 6.0] } ]
[[obstacles]]
name = "floor"
kind = "terrain"
points_m = [[-50.0, 0.0], [50.0, 0.0]]
"#;

/// Over a valley between two crests, in bars nearly as long as the valley is wide.
const OVER_VALLEY: &str = r#"
version = 1
[[cables]]
name = "cable"
length_m = 23.9
linear_density_kg_per_m = 0.0638
axial_stiffness_n = 3e7
diameter_m = 0.02
service_tension_n = 1e6
breaking_tension_n = 1e6
min_bend_radius_m = 0.0
supports = [ { name = "a", kind = "fixed", at_m = [0.0, 0.259] }, { name = "b", kind = "fixed", at_m = [22.1, 0.152] } ]
[[obstacles]]
name = "ground"
kind = "terrain"
friction = 1.16
points_m = [[-99.0, 0.0], [0.0, 0.0], [1.73, 0.01], [3.44, -0.79], [6.53, -0.5], [8.21, 0.0], [10.5, 0.23], [11.8, 0.15],
    [13.7, 0.45], [15.6, -0.54], [17.6, 0.42], [20.3, -0.04], [22.1, 0.0], [99.0, 0.0]]
"#;

#[test]
fn slack_in_the_air_that_does_not_pull_is_seen() {
    let mut scene = Scene::from_toml(OVER_VALLEY).unwrap();
    let mut by_fem = |segments: usize| {
        scene.cables[0].segments = Some(segments);
        (scene.clone(), Simulation::new(scene.clone(), Model::Fem).unwrap().settle().unwrap())
    };
    let (scene, mut solution) = by_fem(18);
    assert_eq!(check(&scene, &solution).findings, [], "laid as `spans` lays it");
    let problem = problems(&scene).unwrap().remove(0);
    let mut alone = FemModel::new(problem, Settings::default()).unwrap();
    alone.start_without_spans();
    alone.settle().unwrap();
    solution.cables[0] = alone.solution();
    let found = check(&scene, &solution).findings;
    assert!(
        found.iter().any(|f| f.law == Law::Slack),
        "a bar of 1.3 m hangs 0.2 m below its chord, and pulls with 0.6 N: {found:?}"
    );
}

#[test]
fn a_contact_that_pulls_is_seen() {
    sees(Law::Push, OVER_POST, |c| c.contacts[0].normal_n *= -1.0);
}

#[test]
fn friction_beyond_the_cone_is_seen() {
    // As it is reported …
    sees(Law::Friction, OVER_POST, |c: &mut CableSolution| {
        let worst = |c: &mut ContactReport| c.friction_n = 0.31 * c.normal_n;
        c.contacts.iter_mut().for_each(worst);
    });
    // … and as the forces in the cable ask for it.
    let (scene, solution) = solved(
        &OVER_POST.replace("friction = 0.3", "friction = 0.3\nfriction_mobilised = \"towards-end\""),
        Model::Auto,
    );
    let mut smooth = scene.clone();
    smooth.obstacles[0].friction = Some(0.0);
    let found = Verifier::new(&smooth).check(&smooth, &solution, Depth::Always);
    assert!(found.findings.iter().any(|f| f.law == Law::Friction), "{:?}", found.findings);
}

/// Slack cable on a round pulls with less than all pieces of a long cable together may be beyond
/// their cones, so its tension is judged by the force there.
#[test]
fn issue_015_a_tension_that_bulges_on_a_round_is_seen() {
    let text = OVER_POST
        .replace("length_m = 10.6", "length_m = 60.0")
        .replace("friction = 0.3", "friction = 0.7")
        .replace("center_m = [5.0, 2.7]", "center_m = [5.0, -0.1]");
    sees(Law::Friction, &text, |c| {
        let on_post = |x: f64, y: f64| (x - 5.0).hypot(y + 0.1) < 0.32;
        let inside: Vec<usize> = (1..c.nodes.len() - 1)
            .filter(|&k| (k - 1..=k + 1).all(|k| on_post(c.nodes[k].x_m, c.nodes[k].y_m)))
            .collect();
        assert!(inside.len() > 3, "{inside:?}");
        let n = &mut c.nodes[inside[4]];
        assert!(n.tension_n > 0.3, "{n:?}");
        n.tension_n += 0.5;
        let pull = n.tension_n / n.force_n[0].hypot(n.force_n[1]);
        n.force_n = n.force_n.map(|f| f * pull);
    });
}

#[test]
fn a_moment_that_nothing_balances_is_seen() {
    let stiff = SPAN.replace("length_m = 11.0", "length_m = 11.0\nbending_stiffness_n_m2 = 5.0");
    sees(Law::Moment, &stiff, |c| c.nodes.iter_mut().for_each(|n| n.curvature_per_m *= -1.0));
}

/// A clamp between the ends takes a moment, and yet hides none that is missing elsewhere.
#[test]
fn a_moment_that_a_clamp_between_the_ends_does_not_take_is_seen() {
    let clamped = SPAN.replace("length_m = 11.0", "length_m = 11.0\nbending_stiffness_n_m2 = 5.0").replace(
        r#"{ name = "b""#,
        r#"{ name = "m", kind = "clamped", at_m = [6.0, 5.0], angle_deg = 40.0, arc_length_m = 6.5 }, { name = "b""#,
    );
    let beside = |c: &CableSolution| c.nodes.partition_point(|n| n.arc_length_m < 6.5 - 1e-9);
    sees(Law::Moment, &clamped, |c| {
        let clamp = beside(c);
        c.nodes[clamp].curvature_per_m *= 2.0;
    });
    sees(Law::Moment, &clamped, |c| {
        let clamp = beside(c);
        c.nodes[clamp + 1..].iter_mut().for_each(|n| n.curvature_per_m *= -1.0);
    });
}

#[test]
fn a_free_end_that_is_pulled_is_seen() {
    let free =
        SPAN.replace(r#"{ name = "b", kind = "fixed", at_m = [10.0, 6.0] }"#, r#"{ name = "b", kind = "free" }"#);
    sees(Law::Balance, &free, |c| c.nodes.iter_mut().for_each(|n| n.force_n[1] += 0.1));
}

#[test]
fn a_cable_that_is_not_where_it_is_held_is_seen() {
    sees(Law::Support, SPAN, |c| c.supports[1].x_m += 1e-3);
    sees(Law::Support, OVER_POST, |c| c.nodes.iter_mut().for_each(|n| n.y_m += 1e-3));
    let eye = SPAN.replace(r#"{ name = "b""#, r#"{ name = "eye", kind = "pulley", at_m = [5.0, 4.0] }, { name = "b""#);
    sees(Law::Support, &eye, |c| (c.supports[1].x_m, c.supports[1].y_m) = (0.0, 0.0));
}

#[test]
fn a_stiff_cable_that_would_bend_aside_is_seen() {
    // Straight between points nearer than it is long, EI/L² some hundredths of a newton.
    let stiff = SPAN.replace("length_m = 11.0", "length_m = 11.0\nbending_stiffness_n_m2 = 5.0");
    sees(Law::Stability, &stiff, |c| {
        for n in &mut c.nodes {
            (n.x_m, n.y_m) = (n.arc_length_m * 10.0 / 11.0, 5.0 + n.arc_length_m / 11.0);
            (n.force_n, n.tension_n, n.curvature_per_m) = ([-1e3, -1e2], -1e3, 0.0);
        }
    });
}

/// Over a wheel and through an eye that rub, drawn to where both slide.
const PULLEYS: &str = r#"
version = 1
[[cables]]
name = "cable"
preset = "soow-6-4"
length_m = 9.65
friction = 0.3
friction_mobilised = "towards-end"
supports = [
  { name = "a", kind = "fixed", at_m = [0.0, 0.0] },
  { name = "wheel", kind = "pulley", at_m = [3.0, 1.0], radius_m = 0.3, friction = 0.4 },
  { name = "eye", kind = "pulley", at_m = [6.0, -1.0], friction = 0.4 },
  { name = "b", kind = "fixed", at_m = [8.0, 1.0] },
]
"#;

#[test]
fn friction_of_pulleys_beyond_the_capstan_is_seen() {
    let (scene, solution) = solved(PULLEYS, Model::Spans);
    assert_eq!(check(&scene, &solution).findings, [], "sound before");
    for k in [1, 2] {
        let name = scene.cables[0].supports[k].name.clone();
        for (friction, seen) in [(0.0, true), (0.2, true), (0.39, true), (0.41, false)] {
            let mut other = scene.clone();
            other.cables[0].supports[k].friction = Some(friction);
            let found = check(&other, &solution);
            let is_reported = found.findings.iter().any(|f| f.law == Law::Friction && (k == 1 || f.with == name));
            assert_eq!(is_reported, seen, "{name} {friction}: {:?}", found.findings);
        }
    }
}

#[test]
fn a_tension_beside_a_pulley_that_is_not_the_force_is_seen() {
    sees(Law::Tension, PULLEYS, |c| c.supports[1].tension_before_n = c.supports[1].tension_before_n.map(|t| 1.01 * t));
    sees(Law::Tension, PULLEYS, |c| c.supports[2].tension_after_n = Some(0.0));
}

/// A cable that the robot backed over, slack in front of its own tracks, by `fem`.
fn on_robot() -> (Scene, Solution) {
    let mut scene = crate::scene::catalog::robot_drive();
    scene.cables[0].supports[0].at_m = Some([18.0, 3.0]);
    scene.cables[0].length_m = 11.5;
    let solution = Simulation::new(scene.clone(), Model::Fem).unwrap().settle().unwrap();
    (scene, solution)
}

#[test]
fn a_cable_on_the_robot_is_asked_everything() {
    let (scene, solution) = on_robot();
    let found = check(&scene, &solution);
    assert_eq!((&found.findings, &found.not_checked), (&vec![], &vec![]), "sound before");
    let of_robot = |c: &ContactReport| c.obstacle == "robot";
    let contact = solution.cables[0].contacts.iter().position(of_robot).unwrap();
    let seen = |change: &dyn Fn(&mut Solution), law: Law, with: &str| {
        let mut other = solution.clone();
        change(&mut other);
        let found = check(&scene, &other);
        let is_reported = found.findings.iter().any(|f| f.law == law && (f.with == with || with.is_empty()));
        assert!(is_reported, "{law:?}: {:?}", found.findings);
    };
    // Drawn into it, and the robot moved into the cable.
    seen(&|s| s.cables[0].nodes.iter_mut().for_each(|n| n.y_m -= 0.01), Law::Penetration, "robot");
    seen(&|s| s.robot.as_mut().unwrap().y_m += 0.01, Law::Penetration, "robot");
    // Reported beyond its cone, and pulling.
    let friction = scene.cables[0].friction;
    let rubs = |s: &mut Solution| {
        let c = &mut s.cables[0].contacts[contact];
        c.friction_n = 1.1 * friction * c.normal_n;
    };
    seen(&rubs, Law::Friction, "robot");
    seen(&|s| s.cables[0].contacts[contact].normal_n *= -1.0, Law::Push, "robot");
    // The robot away from under it: what it did comes from nowhere.
    seen(&|s| s.robot.as_mut().unwrap().y_m -= 0.1, Law::Balance, "");
    // Smoother than what holds: the forces in the cable are beyond the cone.
    let mut smooth = scene.clone();
    smooth.cables[0].friction = 0.0;
    let found = Verifier::new(&smooth).check(&smooth, &solution, Depth::Always);
    assert!(found.findings.iter().any(|f| f.law == Law::Friction && f.with == "robot"), "{:?}", found.findings);
}
