//! These tests lay stiff cables between ends that stand on a floor: slack ones bow, clamps hold
//! their angle, and one that is laid straight lies there.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, Scene, Shape, Support, SupportKind, catalog};
use cable_core::solution::CableSolution;
use cable_core::{Model, Simulation};

const RADIUS: f64 = 0.01;

/// A cable of 0.5 kg/m with its ends at two places, above a level floor.
fn scene(length: f64, bending: f64, ends: [[f64; 2]; 2]) -> Scene {
    let supports = vec![Support::fixed("a", ends[0]), Support::fixed("b", ends[1])];
    let mut scene = catalog::cable_alone([length, 0.5, 1e5], supports);
    let c = &mut scene.cables[0];
    (c.preset, c.diameter_m, c.segments, c.bending_stiffness_n_m2) = (None, 2.0 * RADIUS, None, bending);
    (c.min_bend_radius_m, c.sidewall_limit_n_per_m) = (0.0, None);
    let shape = Shape::Terrain { points_m: vec![[-30.0, 0.0], [40.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.3) }];
    scene
}

fn rest(scene: Scene) -> CableSolution {
    let mut sim = Simulation::new(scene, Model::Auto).unwrap();
    sim.settle().unwrap_or_else(|e| panic!("{e}"));
    sim.solution().cables[0].clone()
}

/// The more slack the less it pushes, the stiffer the more, and never with more than twice Euler's
/// force of its chord. Half of these were straight columns along the floor, pressed by up to 33 kN
/// with 5e-4 N stated, and seven were refused.
#[test]
fn a_slack_stiff_cable_bows() {
    // Of 20 N m², 1 cm of slack presses a straight strut with less than the floor holds straight.
    let lengths = [2.02, 2.05, 2.1, 2.2, 2.4, 3.0];
    let mut softer: Option<Vec<f64>> = None;
    for bending in [0.1, 0.3, 0.5, 1.0, 2.0, 5.0, 20.0] {
        let push = |l: &f64| -rest(scene(*l, bending, [[0.0, RADIUS], [2.0, RADIUS]])).nodes[0].tension_n;
        let pushes: Vec<f64> = lengths.iter().map(push).collect();
        println!("{bending} N m²: {pushes:.3?}");
        assert!(pushes.windows(2).all(|p| p[1] < p[0]), "{pushes:?}");
        if let Some(softer) = softer {
            assert!(pushes.iter().zip(&softer).all(|(p, s)| *p > *s - 1e-3), "{pushes:?} {softer:?}");
        }
        softer = Some(pushes);
    }
    // At 2 % of slack a stiff bow bends as Euler's strut with a weight on it.
    let euler = std::f64::consts::PI.powi(2) * 20.0 / 4.0;
    let push = softer.unwrap()[0];
    assert!(push > euler && push < 2.0 * euler, "{push} {euler}");
}

/// A clamp that stands on the floor holds its angle as one that stands a little higher does: it was
/// passed over, and the cable lay flat.
#[test]
fn a_clamp_on_the_floor_holds_its_angle() {
    let clamped = |height: f64| {
        let mut scene = scene(5.0, 0.3, [[0.0, RADIUS + height], [4.0, 2.0]]);
        scene.cables[0].linear_density_kg_per_m = 0.1;
        let a = &mut scene.cables[0].supports[0];
        (a.kind, a.angle_deg) = (SupportKind::Clamped, Some(5.0));
        rest(scene)
    };
    let pull = |c: &CableSolution| [c.supports[0].reaction_x_n, c.supports[0].reaction_y_n];
    let on = clamped(0.0);
    println!("{:?} {}", pull(&on), on.nodes[0].curvature_per_m);
    assert!(pull(&on)[1] < -0.5 && on.nodes[0].curvature_per_m < -0.5);
    for height in [1e-6, 1e-4, 1e-3] {
        let above = clamped(height);
        let off = (0..2).map(|k| (pull(&on)[k] - pull(&above)[k]).abs()).fold(0.0, f64::max);
        assert!(off < 20.0 * height + 1e-6, "{height} m higher: {:?} for {:?}", pull(&above), pull(&on));
    }
}

/// It was refused: no contact was reported of a cable that has no free piece.
#[test]
fn a_stiff_cable_that_is_laid_straight_lies_there() {
    for bending in [0.01, 0.5, 5.0] {
        let flat = rest(scene(2.0, bending, [[0.0, RADIUS], [2.0, RADIUS]]));
        let normal: f64 = flat.contacts.iter().map(|c| c.normal_n).sum();
        assert!((normal - 2.0 * 0.5 * 9.80665).abs() < 1e-2, "{normal} N");
        assert!(flat.nodes.iter().all(|n| n.tension_n.abs() < 1e-6));
    }
}

/// Curvatures were read on a straight line between the nodes of the mesh, 7 % off beside a load,
/// and the law of moments refused the answer.
#[test]
fn the_curvature_beside_a_load_follows_the_shear() {
    let supports = vec![Support::fixed("a", [0.0, 0.0]), Support::fixed("b", [3.7464, 0.6403])];
    let mut scene = catalog::cable_alone([3.8198, 0.19672, 1.8718e6], supports);
    let c = &mut scene.cables[0];
    (c.preset, c.diameter_m, c.segments, c.bending_stiffness_n_m2) = (None, 0.01, None, 0.1893);
    (c.min_bend_radius_m, c.thermal_expansion_per_k) = (0.0, 0.0);
    let name = c.name.clone();
    let loads = format!("\n[[loads]]\ncable = \"{name}\"\narc_length_m = 2.61476\nforce_n = [-2.8144, -11.1995]\n");
    let scene = Scene::from_toml(&(scene.to_toml() + &loads)).unwrap();
    let found = rest(scene);
    let (mut worst, mut most) = (0.0f64, 0.0f64);
    for pair in found.nodes.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let way = b.at() - a.at();
        // With the force halfway, which changes by the weight between them.
        let weight = 0.19672 * 9.80665 * (b.arc_length_m - a.arc_length_m);
        let (fx, fy) = (a.force_n[0], a.force_n[1] + 0.5 * weight);
        let off = (b.curvature_per_m - a.curvature_per_m) * 0.1893 + way.x * fy - way.y * fx;
        worst = worst.max(off.abs());
        most = most.max(a.curvature_per_m.abs() * 0.1893);
    }
    println!("{worst:e} of {most} N m");
    assert!(worst < 5e-3 * most, "{worst} N m of {most}");
}
