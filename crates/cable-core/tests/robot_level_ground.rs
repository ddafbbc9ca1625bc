//! A robot drives its path where a scene shows no terrain: seen from above, and on a slab.

#![allow(clippy::expect_used, clippy::unwrap_used, missing_docs)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, Shape, View, catalog};
use cable_core::solution::{WarningCause, WarningKind};
use cable_core::{Model, Scene, Simulation};

/// Coefficient of friction of the cable with the floor.
const FRICTION: f64 = 0.4;

/// A cable on a robot that drives from x = 6 m to 7 m.
fn scene(view: View) -> Scene {
    let mut scene = catalog::robot_drive();
    let robot = scene.robot.as_mut().unwrap();
    robot.at_m = [6.0, 0.0];
    robot.path = vec![cable_core::scene::RobotTask::Drive { to_x_m: 7.0, speed_m_per_s: 0.5 }];
    scene.view = view;
    scene.obstacles.clear();
    let cable = &mut scene.cables[0];
    cable.length_m = 6.5;
    cable.friction = FRICTION;
    cable.bending_stiffness_n_m2 = 0.0;
    cable.route_m.clear();
    cable.supports = vec![cable.supports[0].clone(), cable.supports.last().unwrap().clone()];
    cable.supports[0].at_m = Some([0.0, 0.0]);
    scene
}

fn driven(scene: Scene, seconds: f64) -> Simulation {
    let mut s = Simulation::new(scene, Model::Auto).unwrap();
    s.settle().unwrap();
    let frames = (seconds / 0.1).round() as usize;
    (0..frames).for_each(|_| s.step_quasi_static(0.1).unwrap());
    s
}

#[test]
fn seen_from_above_it_drives_its_path() {
    let s = driven(scene(View::Plan), 5.0);
    let answer = s.solution();
    let (robot, end) = (answer.robot.unwrap(), *answer.cables[0].nodes.last().unwrap());
    assert!((robot.x_m - 7.0).abs() < 2e-3, "{robot:?}");
    // Its hitch is 0.9 m behind its middle, and no height shows from above.
    assert!((end.x_m - 6.1).abs() < 2e-3 && end.y_m.abs() < 1e-9, "{end:?}");
    assert!(!robot.pitch_deg.is_nan() && robot.normal_n > 1e3 && robot.hitch_x_n <= 0.0, "{robot:?}");
    assert!(s.warnings().all(|w| w.cause != WarningCause::RobotWithoutGround));
}

#[test]
fn on_a_slab_and_over_nothing_it_drives_at_its_height() {
    let mut on_slab = scene(View::Elevation);
    on_slab.obstacles.push(Obstacle {
        name: "slab".to_owned(),
        shape: Shape::Polygon { points_m: vec![[-5.0, -1.0], [20.0, -1.0], [20.0, 0.0], [-5.0, 0.0]] },
        friction: Some(FRICTION),
    });
    on_slab.cables[0].supports[0].at_m = Some([0.0, 2.0]);
    let mut over_nothing = scene(View::Elevation);
    over_nothing.cables[0].supports[0].at_m = Some([0.0, 2.0]);
    for scene in [on_slab, over_nothing] {
        let robot = driven(scene, 5.0).solution().robot.unwrap();
        assert!((robot.x_m - 7.0).abs() < 2e-3 && robot.y_m == 0.0, "{robot:?}");
    }
}

#[test]
fn where_the_terrain_ends_below_it_the_answer_says_so() {
    let mut beside = scene(View::Elevation);
    beside.obstacles.push(Obstacle {
        name: "ground".to_owned(),
        shape: Shape::Terrain { points_m: vec![[-5.0, -1.0], [5.0, -1.0]] },
        friction: Some(FRICTION),
    });
    beside.cables[0].supports[0].at_m = Some([0.0, 2.0]);
    let mut s = Simulation::new(beside, Model::Auto).unwrap();
    s.settle().unwrap();
    assert!(s.warnings().any(|w| w.cause == WarningCause::RobotWithoutGround));
    s.step_quasi_static(0.1).unwrap();
    assert!(s.warnings().any(|w| w.cause == WarningCause::RobotWithoutGround) && s.solution().robot.is_none());
}

/// Boxes and pipes do not stop a robot, and it drove through them without a word.
#[test]
fn issue_016_a_robot_in_an_obstacle_is_told() {
    let mut scene = catalog::robot_drive();
    let told = |s: &Simulation| s.warnings().any(|w| w.kind == WarningKind::RobotInObstacle);
    let begin = |scene: Scene| {
        let mut s = Simulation::new(scene, Model::Auto).unwrap();
        s.settle().unwrap();
        s
    };
    assert!(!told(&begin(scene.clone())));
    let [x, y] = scene.robot_pose().unwrap().at_m;
    let beside = |dx: f64| vec![[x + dx, y - 1.0], [x + dx + 0.3, y - 1.0], [x + dx + 0.3, y + 0.4], [x + dx, y + 0.4]];
    let shapes = [
        (Shape::Polygon { points_m: beside(-0.1) }, true),
        (Shape::Polygon { points_m: beside(4.0) }, false),
        (Shape::Circle { center_m: [x, y + 0.3], radius_m: 0.1 }, true),
        (Shape::Circle { center_m: [x, y + 5.0], radius_m: 0.1 }, false),
        (Shape::Polyline { points_m: vec![[x - 3.0, y + 0.3], [x + 3.0, y + 0.3]], thickness_m: 0.05 }, true),
    ];
    for (shape, is_in) in shapes {
        scene.obstacles.truncate(1);
        scene.obstacles.push(Obstacle { name: "thing".to_owned(), shape, friction: Some(0.3) });
        assert_eq!(told(&begin(scene.clone())), is_in, "{:?}", scene.obstacles[1]);
    }
}
