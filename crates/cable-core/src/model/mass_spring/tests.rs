use crate::model::Model;
use crate::scene::{Obstacle, Scene, Shape, Support, catalog};
use crate::solution::Solution;
use crate::{Simulation, SolveError};

fn span() -> Scene {
    let mut scene = catalog::hanging_span();
    let c = &mut scene.cables[0];
    c.linear_density_kg_per_m = 1.246;
    c.axial_stiffness_n = 1e5;
    c.bending_stiffness_n_m2 = 0.0;
    c.diameter_m = 0.028;
    c.damping_ratio = 0.02;
    scene.cables[0].segments = Some(40);
    scene
}

fn held_y(s: &Solution) -> f64 {
    s.cables[0].supports.iter().map(|r| r.reaction_y_n).sum()
}

#[test]
fn a_hanging_span_carries_its_weight_and_is_symmetric() {
    let mut sim = Simulation::new(span(), Model::MassSpring).unwrap();
    let s = sim.settle().unwrap();
    let weight = 12.0 * 1.246 * 9.80665;
    assert!((held_y(&s) + weight).abs() < 1e-5 * weight, "{}", held_y(&s));
    let n = &s.cables[0].nodes;
    for (a, b) in n.iter().zip(n.iter().rev()) {
        assert!((a.y_m - b.y_m).abs() < 1e-6);
    }
    // Swings of a resting cable are nothing but round-off.
    for _ in 0..30 {
        sim.step(1.0 / 60.0).unwrap();
    }
    let moved = sim.solution();
    for (a, b) in n.iter().zip(&moved.cables[0].nodes) {
        assert!((a.x_m - b.x_m).hypot(a.y_m - b.y_m) < 1e-4);
    }
}

#[test]
fn steps_that_cannot_be_taken_are_refused_and_change_nothing() {
    let mut sim = Simulation::new(span(), Model::MassSpring).unwrap();
    let before = sim.states();
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(matches!(sim.step(dt), Err(SolveError::TimeStep { .. })));
        assert!(matches!(sim.step_quasi_static(dt), Err(SolveError::TimeStep { .. })));
    }
    assert_eq!(sim.states(), before);
}

#[test]
fn the_same_steps_give_the_same_bits() {
    let run = || {
        let mut sim = Simulation::new(span(), Model::MassSpring).unwrap();
        for dt in [0.01, 1e-12, 0.05, 0.01] {
            sim.step(dt).unwrap();
        }
        sim.states()
    };
    assert_eq!(run(), run());
}

/// A cable with a free tail on a flat floor, its other end pulled along the floor.
fn drag() -> Scene {
    let mut scene = span();
    let c = &mut scene.cables[0];
    c.length_m = 5.0;
    c.segments = Some(20);
    c.axial_stiffness_n = 2e4;
    c.route_m = vec![[0.0, 0.014], [5.0, 0.014]];
    let mut hitch = Support::fixed("hitch", [5.0, 0.014]);
    hitch.motion = Some(crate::scene::Motion {
        times_s: vec![0.0, 1.0, 2.0, 3.0, 4.0],
        points_m: (0..5).map(|k| [5.0 + f64::from(k), 0.014]).collect(),
    });
    c.supports = vec![Support::free("tail"), hitch];
    scene.obstacles = vec![Obstacle {
        name: "floor".to_owned(),
        shape: Shape::Terrain { points_m: vec![[-5.0, 0.0], [20.0, 0.0]] },
        friction: Some(0.5),
    }];
    scene
}

#[test]
fn dragging_along_a_floor_takes_mu_w_l() {
    let mut sim = Simulation::new(drag(), Model::MassSpring).unwrap();
    sim.settle().unwrap();
    let (mut sum, mut count) = (0.0, 0);
    for k in 0..170 {
        sim.step(1.0 / 60.0).unwrap();
        let s = sim.solution();
        assert!(s.cables[0].nodes.iter().all(|n| n.y_m > 0.014 - 2.8e-4), "nothing sinks in");
        // Between the second and the fourth knot the speed is constant.
        if k >= 75 {
            sum += -s.cables[0].supports[1].reaction_x_n;
            count += 1;
        }
    }
    let exact = 0.5 * 1.246 * 9.80665 * 5.0;
    let mean = sum / f64::from(count);
    assert!((mean / exact - 1.0).abs() < 0.01, "{mean} against {exact}");
}

#[test]
fn slow_motion_over_rough_ground_is_refused() {
    let mut sim = Simulation::new(drag(), Model::MassSpring).unwrap();
    sim.settle().unwrap();
    assert!(matches!(sim.step_quasi_static(0.1), Err(SolveError::Unsupported { .. })));
}

#[test]
fn an_end_thrown_ten_metres_does_not_pass_a_thin_beam() {
    let mut scene = span();
    scene.cables[0].axial_stiffness_n = 2e4;
    scene.obstacles = vec![Obstacle {
        name: "beam".to_owned(),
        shape: Shape::Polygon { points_m: vec![[4.0, 0.0], [4.05, 0.0], [4.05, 2.0], [4.0, 2.0]] },
        friction: Some(0.3),
    }];
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    sim.settle().unwrap();
    sim.drag_support(0, 1, crate::math::Vec2::new(0.5, 0.5));
    for _ in 0..90 {
        sim.step(1.0 / 60.0).unwrap();
        for n in &sim.solution().cables[0].nodes {
            let inside = n.x_m > 4.0 && n.x_m < 4.05 && n.y_m > 0.0 && n.y_m < 2.0;
            assert!(!inside, "{n:?}");
        }
    }
}

/// A cable on a shelf, 0.6 m of it over the edge: friction along the shelf could hold 1.7 m.
#[test]
fn a_cable_below_its_slip_threshold_stays_where_it_lies() {
    let mut scene = span();
    let c = &mut scene.cables[0];
    c.length_m = 4.0;
    c.segments = Some(40);
    c.axial_stiffness_n = 2e4;
    c.route_m = vec![[-3.4, 0.014], [0.0, 0.014], [0.0099, 0.0099], [0.014, 0.0], [0.014, -0.58]];
    c.supports = vec![Support::free("on the shelf"), Support::free("hanging")];
    scene.obstacles = vec![Obstacle {
        name: "shelf".to_owned(),
        shape: Shape::Polygon { points_m: vec![[-5.0, -1.0], [0.0, -1.0], [0.0, 0.0], [-5.0, 0.0]] },
        friction: Some(0.5),
    }];
    let mut sim = Simulation::new(scene, Model::MassSpring).unwrap();
    let start = sim.settle().unwrap();
    for _ in 0..3600 {
        sim.step(1.0 / 60.0).unwrap();
    }
    for (a, b) in start.cables[0].nodes.iter().zip(&sim.solution().cables[0].nodes) {
        let moved = (a.x_m - b.x_m).hypot(a.y_m - b.y_m);
        assert!(moved < 1e-3, "{moved} m at {} m", a.arc_length_m);
    }
}
