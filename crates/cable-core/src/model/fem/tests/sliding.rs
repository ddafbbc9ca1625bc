//! These tests draw cables over corners, posts and pulleys and compare them with the capstan law
//! and their own ripple.

use std::sync::Arc;

use crate::math::Vec2;
use crate::model::fem::obstacle::IntersectionCheck;
use crate::model::fem::remesh::make_material_at_tangents;
use crate::model::fem::stepper::Stepper;
use crate::model::{Inertia, Settings};
use crate::problem::problems;
use crate::scene::{Cable, Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};

const RADIUS: f64 = 0.002;
const LOAD: f64 = 50.0;

fn scene(cable: impl FnOnce(&mut Cable), obstacles: Vec<Obstacle>) -> Scene {
    let mut scene = catalog::hanging_span();
    let c = &mut scene.cables[0];
    c.linear_density_kg_per_m = 1e-5;
    c.axial_stiffness_n = 4e4;
    c.diameter_m = 2.0 * RADIUS;
    cable(c);
    scene.obstacles = obstacles;
    scene
}

fn build(scene: &Scene) -> Stepper {
    Stepper::new(Arc::clone(&problems(scene).unwrap()[0]), Settings::default(), Arc::default()).unwrap()
}

fn beam(friction: f64) -> Obstacle {
    let shape = Shape::Polygon { points_m: vec![[0.0, -0.2], [0.2, -0.2], [0.2, 0.0], [0.0, 0.0]] };
    Obstacle { name: "beam".to_owned(), shape, friction: Some(friction) }
}

/// A load hangs down the left side of a beam; the cable is pulled away over its top, which it
/// leaves at `slope`.
fn over_a_beam(friction: f64, segments: usize, pull: f64) -> Scene {
    let end = |by: f64| [2.0 + by, RADIUS + 0.8];
    scene(
        |c| {
            c.length_m = 4.2;
            c.segments = Some(segments);
            let way = 0.2 + 1.8f64.hypot(0.8);
            c.route_m = vec![[-0.003, 0.003 - (4.2 - way)], [-0.003, 0.003], [0.2, 0.003], end(0.0)];
            let hang = Support { force_n: Some([0.0, -LOAD]), ..Support::new("load", SupportKind::Load) };
            let motion = Motion { times_s: vec![0.0, 2.0], points_m: vec![end(0.0), end(pull)] };
            c.supports = vec![hang, Support { motion: Some(motion), ..Support::fixed("end", end(0.0)) }];
        },
        vec![beam(friction)],
    )
}

/// Pull over load, at times in `from`..2 s of a slow pull.
fn ratios(scene: &Scene, inertia: Inertia, from: f64) -> Vec<f64> {
    let mut d = build(scene);
    d.settle(&[]).unwrap();
    let mut out = Vec::new();
    for k in 1..=120 {
        d.advance(1.0 / 60.0, inertia, &[]).unwrap();
        assert!(d.cable.smallest_gap() > 0.0);
        if f64::from(k) / 60.0 > from {
            let r = &d.solution().supports[1];
            out.push(r.reaction_x_n.hypot(r.reaction_y_n) / LOAD);
        }
    }
    out
}

#[test]
fn a_load_drawn_over_a_corner_follows_the_capstan_without_ripple() {
    for friction in [0.0, 0.1, 0.3, 0.8] {
        let ratios = ratios(&over_a_beam(friction, 42, 0.6), Inertia::QuasiStatic, 0.5);
        let round = RADIUS + crate::model::fem::settings::ContactTuning::default().reach_m;
        let motion = Motion { times_s: vec![0.0, 2.0], points_m: vec![[0.0, 0.0], [0.6, 0.0]] };
        for (k, ratio) in ratios.iter().enumerate() {
            let by = motion.at(0.5 + (k as f64 + 1.0) / 60.0).0.x;
            // From straight up to the tangent that ends at the support: the cable leaves the top at
            // once.
            let (x, y) = (2.0 + by, RADIUS + 0.8);
            let turn = std::f64::consts::FRAC_PI_2 - (y.atan2(x) - (round / x.hypot(y)).asin());
            let expected = (friction * turn).exp();
            assert!((ratio / expected - 1.0).abs() < 2e-5, "μ {friction}: {ratio}, expected {expected}");
        }
    }
}

#[test]
fn refining_changes_nothing_at_a_corner() {
    let coarse = ratios(&over_a_beam(0.3, 21, 0.3), Inertia::QuasiStatic, 1.9);
    let fine = ratios(&over_a_beam(0.3, 84, 0.3), Inertia::QuasiStatic, 1.9);
    for (a, b) in coarse.iter().zip(&fine) {
        assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
    }
}

fn round_a_post(friction: f64, turn: f64, pull: f64) -> Scene {
    // Plan view: from (−2, R) along +x, clockwise round a post at the origin, and away after `turn`
    // (rad).
    let r = 0.2 + RADIUS;
    let steps = (turn / 0.3).ceil();
    let on = |a: f64| [1.05 * r * a.sin(), 1.05 * r * a.cos()];
    let out = [turn.cos(), -turn.sin()];
    let leave = [r * turn.sin(), r * turn.cos()];
    let end = |by: f64| [leave[0] + (1.0 + by) * out[0], leave[1] + (1.0 + by) * out[1]];
    let post = Shape::Circle { center_m: [0.0, 0.0], radius_m: 0.2 };
    let mut scene = scene(
        |c| {
            let mut route = vec![[-2.0, r]];
            route.extend((0..=steps as usize).map(|k| on(turn * k as f64 / steps)));
            route.push(end(0.0));
            c.length_m = 3.0 + r * turn;
            c.segments = Some(60);
            c.friction = 0.0;
            c.route_m = route;
            let hang = Support { force_n: Some([-LOAD, 0.0]), ..Support::new("load", SupportKind::Load) };
            let motion = Motion { times_s: vec![0.0, 2.0], points_m: vec![end(0.0), end(pull)] };
            c.supports = vec![hang, Support { motion: Some(motion), ..Support::fixed("end", end(0.0)) }];
        },
        vec![Obstacle { name: "post".to_owned(), shape: post, friction: Some(friction) }],
    );
    scene.view = crate::scene::View::Plan;
    scene
}

#[test]
fn the_capstan_holds_from_a_twelfth_turn_to_one_and_a_half() {
    for (degrees, friction) in [(30.0f64, 0.8), (90.0, 0.3), (180.0, 0.3), (360.0, 0.2), (540.0, 0.1)] {
        let turn = degrees.to_radians();
        let ratios = ratios(&round_a_post(friction, turn, 0.5), Inertia::QuasiStatic, 1.0);
        let expected = (friction * turn).exp();
        let (mut low, mut high) = (f64::INFINITY, 0.0);
        for r in &ratios {
            (low, high) = (r.min(low), r.max(high));
            assert!((r / expected - 1.0).abs() < 1e-3, "{degrees}°, μ {friction}: {r}, expected {expected}");
        }
        assert!((high - low) / expected < 1e-3, "{degrees}°, μ {friction}: {low} to {high}");
    }
}

#[test]
fn the_capstan_holds_in_motion() {
    for degrees in [30.0f64, 90.0, 180.0, 360.0, 540.0] {
        for friction in [0.1, 0.3, 0.8] {
            let turn = degrees.to_radians();
            let expected = (friction * turn).exp();
            let mut scene = round_a_post(friction, turn, 0.5);
            // The pull grows to e^{7.5} times the load: as stiff a cable as bears it.
            scene.cables[0].axial_stiffness_n *= if expected > 20.0 { expected / 20.0 } else { 1.0 };
            // A material that creeps after the start has a viscous force of 1e-4 of the pull, which
            // rubs and is not reported.
            scene.cables[0].damping_ratio = 0.0;
            let ratios = ratios(&scene, Inertia::Dynamic, 1.0);
            let (low, high) = ratios.iter().fold((f64::INFINITY, 0.0f64), |(l, h), r| (r.min(l), r.max(h)));
            let (off, ripple) =
                ((low / expected - 1.0).abs().max((high / expected - 1.0).abs()), (high - low) / expected);
            println!("{degrees}°, μ {friction}: e^(μφ) {expected:.3}, off by {off:.1e}, ripple {ripple:.1e}");
            assert!(off < 1e-4 && ripple < 2e-5, "{degrees}°, μ {friction}: {low} to {high}, expected {expected}");
        }
    }
}

#[test]
fn a_load_held_over_a_corner_for_a_minute_loses_nothing() {
    let scene = over_a_beam(0.3, 42, 0.3);
    let mut d = build(&scene);
    d.settle(&[]).unwrap();
    for _ in 0..120 {
        d.advance(1.0 / 60.0, Inertia::QuasiStatic, &[]).unwrap();
    }
    let (start, pull) = (d.cable.state(), d.solution().supports[1].clone());
    for _ in 0..3600 {
        d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap();
    }
    let (end, after) = (d.cable.state(), &d.solution().supports[1]);
    let change = (after.reaction_x_n - pull.reaction_x_n).hypot(after.reaction_y_n - pull.reaction_y_n);
    assert!(change / pull.reaction_x_n.hypot(pull.reaction_y_n) < 1e-5, "{change} N");
    assert!((end.position_m[0] - start.position_m[0]).norm() < 1e-6);
}

#[test]
fn material_is_neither_made_nor_lost_at_corners() {
    let mut d = build(&over_a_beam(0.3, 42, 0.6));
    d.settle(&[]).unwrap();
    for _ in 0..60 {
        d.advance(1.0 / 60.0, Inertia::QuasiStatic, &[]).unwrap();
        let s = d.cable.state().arc_length_m;
        assert!(s.first() == Some(&0.0) && (s.last().unwrap() - 4.2).abs() < 1e-12);
        assert!(s.windows(2).all(|p| p[1] > p[0]));
        let rest: f64 = d.cable.mesh.rest_length.iter().sum();
        assert!((rest - 4.2).abs() < 1e-12, "{rest}");
    }
}

/// A soft cable drawn down over a beam at both ends, and thrown up from it at a speed, m/s.
fn thrown_off_a_beam(speed: f64) -> Stepper {
    let scene = scene(
        |c| {
            (c.length_m, c.linear_density_kg_per_m, c.segments) = (3.33, 0.5, Some(33));
            c.axial_stiffness_n = 2e3;
            c.route_m = vec![[-1.5, -0.5], [-0.01, 0.02], [0.21, 0.02], [1.7, -0.5]];
            c.supports = vec![Support::fixed("a", [-1.5, -0.5]), Support::fixed("b", [1.7, -0.5])];
        },
        vec![beam(0.3)],
    );
    let mut d = build(&scene);
    d.settle(&[]).unwrap();
    assert!(d.cable.mesh.sliding.iter().flatten().count() > 0);
    for k in 1..d.cable.mesh.nodes() - 1 {
        if d.cable.mesh.sliding[k].is_none() {
            d.cable.motion.velocities[k].y = speed;
        }
    }
    d
}

#[test]
fn a_corner_never_pulls_at_what_is_thrown_off_it() {
    let mut d = thrown_off_a_beam(16.0);
    d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
    // The node at the corner stood still and is drawn along by its neighbours, 7 cm up by then;
    // held for the step, it would lie at the corner.
    let nodes = d.solution().nodes;
    let i = nodes.partition_point(|n| n.x_m < 0.0);
    let (a, b) = (&nodes[i - 1], &nodes[i]);
    let y = a.y_m + (b.y_m - a.y_m) * (0.0 - a.x_m) / (b.x_m - a.x_m);
    println!("{y} m above the corner");
    assert!(y > RADIUS + 5e-3, "{y}");
}

/// The corner that would have to pull at positions `x` (m).
fn pulled(d: &Stepper, x: &[Vec2]) -> Option<usize> {
    IntersectionCheck::at(&d.cable, x).pulled_corner(d.cable.mesh.tuning.remesh.max_reverse_turn_rad)
}

#[test]
fn a_pose_that_turns_a_corner_the_wrong_way_is_noticed() {
    let d = thrown_off_a_beam(0.0);
    let mut x = d.cable.motion.positions.clone();
    assert_eq!(pulled(&d, &x), None);
    let first = d.cable.mesh.sliding.iter().position(Option::is_some).unwrap();
    for (k, at) in x.iter_mut().enumerate().filter(|(k, _)| d.cable.mesh.sliding[*k].is_none()) {
        at.y += if k < first + 2 { 0.1 } else { 0.0 };
    }
    assert_eq!(pulled(&d, &x), Some(first));
}

#[test]
fn a_cable_that_folds_back_at_a_corner_does_not_run_through_its_edge() {
    let mut d = build(&over_a_beam(0.3, 42, 0.3));
    d.settle(&[]).unwrap();
    let k = d.cable.mesh.sliding.iter().position(Option::is_some).unwrap();
    let mut x = d.cable.motion.positions.clone();
    assert_eq!(pulled(&d, &x), None);
    // It comes up the left side of the beam, and now goes back there: round the corner and through
    // the top.
    x[k + 1] = d.cable.mesh.sliding[k].unwrap().end.center - crate::math::Vec2::new(0.5, 0.5);
    assert_eq!(pulled(&d, &x), Some(k));
}

/// A mark that is not in the middle of its arc: the node that takes its place must not stretch one
/// bar and squeeze the other. Of that a slack cable of 2 MN once broke.
#[test]
fn a_node_that_leaves_its_corner_leaves_the_tension_as_it_was() {
    let shape = Shape::Polygon { points_m: vec![[-1.0, -0.2], [1.0, -0.2], [0.0, 0.0]] };
    let ridge = Obstacle { name: "ridge".to_owned(), shape, friction: Some(0.3) };
    let stiff = 2e6;
    let held = |c: &mut Cable| {
        (c.diameter_m, c.axial_stiffness_n, c.linear_density_kg_per_m) = (0.028, stiff, 1.2);
        (c.length_m, c.segments) = (4.004, Some(24));
        c.route_m = vec![[-2.0, -0.05], [0.0, 0.0145], [2.0, -0.05]];
        c.supports = vec![Support::fixed("a", [-2.0, -0.05]), Support::fixed("b", [2.0, -0.05])];
    };
    let mut d = build(&scene(held, vec![ridge]));
    d.settle(&[]).unwrap();
    let k = (0..d.cable.mesh.nodes()).find(|&k| d.cable.mesh.sliding[k].is_some()).unwrap();
    let turn = {
        let path =
            [d.cable.mesh.path(k - 1, &d.cable.motion.positions), d.cable.mesh.path(k, &d.cable.motion.positions)];
        path[0].arcs[1] + path[1].arcs[0]
    };
    let node = d.cable.mesh.sliding[k].unwrap();
    let (radius, aside) = (node.end.radius, 0.3 * turn);
    // The material that is there, but for what its strain makes of a hundredth of a millimetre.
    let mark = crate::model::fem::mesh::rotate(node.end.mark, node.end.sense * aside);
    d.cable.mesh.sliding[k] = Some(crate::model::fem::mesh::SlidingNode {
        end: crate::model::fem::mesh::BarEnd { mark, ..node.end },
        ..node
    });
    let material = aside * radius;
    d.cable.mesh.arc_length[k] += material;
    d.cable.mesh.rest_length[k - 1] += material;
    d.cable.mesh.rest_length[k] -= material;
    let tensions = |d: &Stepper| {
        [k - 1, k].map(|e| {
            stiff * (d.cable.mesh.path(e, &d.cable.motion.positions).length / d.cable.mesh.rest_length[e] - 1.0)
        })
    };
    let before = tensions(&d);
    assert!(make_material_at_tangents(&mut d.cable, k));
    let after = tensions(&d);
    // Two tangents are longer than the arc between them; both bars share that.
    let longer = radius * (2.0 * (0.5 * turn).tan() - turn);
    let more = stiff * longer / (d.cable.mesh.rest_length[k - 1] + d.cable.mesh.rest_length[k]);
    println!("{before:?} N, then {after:?}: {more} N more for a turn of {turn}");
    assert!(turn > 0.03 && stiff * material / d.cable.mesh.rest_length[k] > 500.0);
    assert!((0..2).all(|j| (after[j] - before[j] - more).abs() < 1.0), "{before:?} {after:?} {more}");
}
