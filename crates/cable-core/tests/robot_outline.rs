//! The outline of the robot is an obstacle for its cable: pushed, lain upon, never crossed.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, missing_docs)] // a failing test is meant to panic

mod segments;

use cable_core::answer_verifier::Law;
use cable_core::contact::Outline;
use cable_core::problem::robot_outline;
use cable_core::record::Fingerprint;
use cable_core::scene::{Shape, catalog};
use cable_core::solution::{ContactReport, DriveState, ModelReason, RobotReport, WarningKind};
use cable_core::{Model, Obstacle, Scene, Simulation, SolveError, Vec2};
use segments::cross_properly;

/// Time between two looks, s.
const FRAME_S: f64 = 1.0 / 60.0;

fn scene(length_m: f64, ground: &[[f64; 2]]) -> Scene {
    let mut scene = catalog::robot_drive();
    scene.cables[0].length_m = length_m;
    if let Shape::Terrain { points_m } = &mut scene.obstacles[0].shape {
        *points_m = ground.to_vec();
    }
    if let Some(robot) = &mut scene.robot {
        robot.path.clear();
    }
    scene
}

fn robot(simulation: &Simulation) -> RobotReport {
    simulation.solution().robot.unwrap()
}

/// Returns whether the cable crosses the outline, or has a node in it: by polygons alone, not by
/// what the solver uses.
fn crosses(simulation: &Simulation) -> Option<String> {
    let outline: Outline = robot_outline(simulation.scene(), 0.5).unwrap();
    let r = robot(simulation);
    let mut placement = outline.placement;
    (placement.at, placement.angle) = (Vec2::new(r.x_m, r.y_m), r.pitch_deg.to_radians());
    let edges: Vec<[Vec2; 2]> = outline.edges(placement).collect();
    let inside =
        |p: Vec2| edges.iter().filter(|[a, b]| cross_properly(p, Vec2::new(1e3, 777.0), *a, *b)).count() % 2 == 1;
    for cable in &simulation.solution().cables {
        for pair in cable.nodes.windows(2) {
            let (a, b) = (pair[0].at(), pair[1].at());
            if inside(a) || edges.iter().any(|[p, q]| cross_properly(a, b, *p, *q)) {
                return Some(format!("t {:.3} s: {a:?} {b:?} robot {r:?}", simulation.time_s()));
            }
        }
    }
    None
}

/// Drives by hand; nothing is crossed on the way.
fn drive(simulation: &mut Simulation, speed: f64, for_s: f64) {
    simulation.command_robot(Some(speed));
    for _ in 0..(for_s / FRAME_S).round() as usize {
        simulation.step(FRAME_S).unwrap();
        assert_eq!(crosses(simulation), None);
        assert!(simulation.solution().cables[0].nodes.iter().all(|n| n.at().norm() < 100.0));
    }
}

fn pushed(simulation: &Simulation) -> f64 {
    let of_robot = |c: &&ContactReport| c.obstacle == "robot";
    simulation.solution().cables[0].contacts.iter().filter(of_robot).map(|c| c.normal_n).sum()
}

const LEVEL: [[f64; 2]; 2] = [[-4.0, 0.0], [20.0, 0.0]];

fn start(scene: Scene) -> Simulation {
    let mut s = Simulation::new(scene, Model::Auto).unwrap();
    s.settle().unwrap();
    assert_eq!(crosses(&s), None);
    s
}

#[test]
fn backing_over_its_own_slack_cable_it_pushes_it_along() {
    // At rest nothing touches the robot: answered without a mesh.
    assert_eq!(start(scene(12.5, &LEVEL)).model(), Model::Spans);
    let mut s = start(scene(15.5, &LEVEL));
    drive(&mut s, -0.6, 5.0);
    let r = robot(&s);
    // As fast as on free ground, where it gets up to a speed u with a jerk J = 2 m/s³ in 2 √(u/J),
    // with half of it on average; the heap rubs on the ground before it.
    let lost = 0.6 * (0.6_f64 / 2.0).sqrt();
    assert!((r.x_m - (10.0 - 0.6 * 5.0 + lost)).abs() < 0.02, "{r:?}");
    assert!(r.push_x_n > 5.0 && pushed(&s) > 5.0, "{r:?}");
    // Standing it holds what leans on it.
    drive(&mut s, 0.0, 1.5);
    assert!(robot(&s).speed_m_per_s == 0.0);
}

#[test]
fn the_same_log_gives_the_same_hash() {
    let hash = || {
        let mut s = start(scene(15.5, &LEVEL));
        let mut print = Fingerprint::default();
        for speed in [-0.6, -0.8, 0.3] {
            s.command_robot(Some(speed));
            for _ in 0..60 {
                s.step(FRAME_S).unwrap();
                print.push(&s.solution());
            }
        }
        assert!(s.solution().cables[0].nodes.len() > 10);
        print
    };
    assert_eq!(hash(), hash());
}

fn rough() -> Vec<[f64; 2]> {
    let height = |k: i32| 0.06 * f64::from(k * 7 % 5) + 0.04 * f64::from(k * 3 % 4);
    (0..60).map(|k| [-4.0 + 0.4 * f64::from(k), height(k)]).collect()
}

/// Over bumps, up and down slopes, back and forth, with every slack.
#[test]
fn whatever_the_ground_it_never_crosses_the_robot() {
    for length_m in [13.0, 16.0] {
        back_and_forth(length_m, &rough());
    }
}

/// If the ground rises before the robot, its rear leans over the cable behind it.
#[test]
fn in_a_valley_it_never_crosses_the_robot() {
    let valley = [[-4.0, 1.0], [4.0, 0.6], [7.5, 0.0], [9.0, 0.0], [13.0, 1.2], [20.0, 1.4]];
    for length_m in [15.0, 13.5] {
        back_and_forth(length_m, &valley);
    }
}

/// Speeds, m/s, and for how long, s.
const BACK_AND_FORTH: [(f64, f64); 4] = [(-0.8, 2.5), (0.8, 1.5), (-0.5, 2.0), (0.0, 0.3)];

fn back_and_forth(length_m: f64, ground: &[[f64; 2]]) {
    let mut s = start(scene(length_m, ground));
    for (speed, for_s) in BACK_AND_FORTH {
        drive(&mut s, speed, for_s);
    }
}

/// Its cable comes from before it and lies over its deck: what presses on the deck, pulls at the
/// hitch and at the riser and what the ground carries is its weight.
#[test]
fn lying_over_the_robot_the_forces_balance() {
    let mut over = scene(11.5, &LEVEL);
    over.cables[0].supports[0].at_m = Some([18.0, 3.0]);
    let mut s = start(over);
    assert_eq!(s.model(), Model::Fem);
    assert_eq!(s.reason(), &ModelReason::TouchesRobot);
    drive(&mut s, 0.0, 6.0);
    let (answer, r) = (s.solution(), robot(&s));
    let cable = &answer.cables[0];
    let sum = |of: fn(&cable_core::solution::SupportReaction) -> f64| cable.supports.iter().map(of).sum::<f64>();
    let ground: Vec2 = (cable.contacts.iter().filter(|c| c.obstacle == "floor"))
        .map(|c| Vec2::new(c.friction_n.abs(), -c.normal_n))
        .sum();
    let weight = 11.5 * s.scene().cables[0].linear_density_kg_per_m * 9.80665;
    let left = sum(|s| s.reaction_y_n) + r.push_y_n + ground.y + weight;
    assert!(left.abs() < 2e-3 * weight, "{left} of {weight}: {r:?} {:?}", cable.contacts);
    assert!(r.push_y_n < -0.05 * weight, "{r:?}");
    let sideways = sum(|s| s.reaction_x_n) + r.push_x_n;
    assert!(sideways.abs() <= ground.x + 2e-3 * weight, "{sideways}: {r:?} {:?}", cable.contacts);
    // The edge of the deck leads the cable: a sharp bend, but no kink of a free cable, as there may
    // be in the slack part behind it.
    let on_deck = |w: &&cable_core::solution::Warning| w.at_m.is_some_and(|at| at[1] > 1.0);
    let kinks = answer.warnings.iter().filter(on_deck).filter(|w| w.kind == WarningKind::Kink).count();
    assert_eq!(kinks, 0, "{:?}", answer.warnings);
    // The robot drives on under it and back.
    drive(&mut s, 0.6, 2.0);
    drive(&mut s, -0.6, 4.0);
}

/// A cable squeezed between the robot and a wall is not cut through: the robot comes to a stand.
#[test]
fn squeezed_against_a_wall_it_jams() {
    // A hitch that trailed into the wall kept the robot there at every second speed.
    for speed in [0.5, 0.58, 0.6, 0.64, 0.7] {
        let mut walled = scene(16.0, &LEVEL);
        let points_m = vec![[6.6, -0.2], [7.0, -0.2], [7.0, 0.7], [6.6, 0.7]];
        walled.obstacles.push(Obstacle { name: "wall".into(), shape: Shape::Polygon { points_m }, friction: None });
        let mut s = start(walled);
        drive(&mut s, -speed, 6.0);
        let r = robot(&s);
        // Its rear is 0.8 m behind its middle; not nearer to the wall than the cable is thick.
        let left = r.x_m - 0.8 - 7.0;
        assert!(left > 0.02 && left < 0.6, "{left}: {r:?}");
        assert!(matches!(r.going, DriveState::Jammed | DriveState::Stalled | DriveState::Slipping), "{r:?}");
        // And it comes away again.
        drive(&mut s, 0.6, 2.0);
        assert!(robot(&s).x_m > r.x_m + 0.8, "{speed} m/s: {:?}", robot(&s));
    }
}

/// A robot that presses its cable against bumps has its speed sought between one that is flat and
/// one that is steep: 22 steps of these ended with up to 119 kN between robot and cable.
#[test]
fn robot_and_cable_agree_in_every_step() {
    for (length_m, ground, drives) in [
        (16.0, LEVEL.to_vec(), vec![(-0.5, 1.0)]),
        (13.0, rough(), BACK_AND_FORTH.to_vec()),
        (16.0, rough(), BACK_AND_FORTH.to_vec()),
    ] {
        let mut s = start(scene(length_m, &ground));
        for (speed, for_s) in drives {
            s.command_robot(Some(speed));
            for _ in 0..(for_s / FRAME_S).round() as usize {
                s.step(FRAME_S).unwrap();
                let told = s.warnings().find(|w| w.to_string().contains("out of balance"));
                assert!(told.is_none(), "{length_m} m: {told:?}");
            }
        }
    }
}

#[test]
fn a_model_that_knows_nothing_of_it_says_so() {
    let mut over = scene(11.5, &LEVEL);
    over.cables[0].supports[0].at_m = Some([18.0, 3.0]);
    // A cable that lies through the robot is no answer; `mass-spring`, as a preview, warns of it.
    let refused = Simulation::new(over.clone(), Model::Spans).unwrap().settle().unwrap_err();
    assert!(matches!(&refused, SolveError::Unsound { finding, .. } if finding.with == "robot"), "{refused}");
    let answer = Simulation::new(over, Model::MassSpring).unwrap().settle().unwrap();
    assert!(answer.warnings.iter().any(|w| w.kind == WarningKind::ThroughRobot), "{:?}", answer.warnings);
    let told =
        answer.verification.as_ref().unwrap().findings.iter().any(|f| f.law == Law::Penetration && f.with == "robot");
    assert!(told, "{:?}", answer.verification);
}
