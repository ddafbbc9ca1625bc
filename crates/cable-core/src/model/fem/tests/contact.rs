//! These tests compare friction, landing, corners and thrown ends with closed forms, and ask that
//! nothing is crossed.

use std::sync::Arc;

use crate::math::Vec2;
use crate::model::fem::FemModel;
use crate::model::fem::stepper::Stepper;
use crate::model::fem::system::Converged;
use crate::model::{Inertia, Mechanics, Settings};
use crate::problem::problems;
use crate::scene::{Cable, Motion, Obstacle, Scene, Shape, Support, SupportKind, catalog};

const RADIUS: f64 = 0.014;

fn scene(cable: impl FnOnce(&mut Cable), obstacles: Vec<Obstacle>) -> Scene {
    let mut scene = catalog::hanging_span();
    cable(&mut scene.cables[0]);
    scene.obstacles = obstacles;
    scene
}

fn floor(friction: f64) -> Obstacle {
    let shape = Shape::Terrain { points_m: vec![[-100.0, 0.0], [100.0, 0.0]] };
    Obstacle { name: "floor".to_owned(), shape, friction: Some(friction) }
}

fn build(scene: &Scene) -> Stepper {
    Stepper::new(Arc::clone(&problems(scene).unwrap()[0]), Settings::default(), Arc::default()).unwrap()
}

/// A cable of 12 m on a floor, its end pulled along it at the height at which the barrier carries
/// its weight (an end held at the surface itself pulls its neighbour down: +0.3 % at this mesh).
fn drag(segments: usize) -> Scene {
    let height = RADIUS + 0.87 * crate::model::fem::settings::ContactTuning::default().reach_m;
    let pull = Motion { times_s: vec![0.0, 6.0], points_m: vec![[12.0, height], [13.5, height]] };
    scene(
        |c| {
            c.axial_stiffness_n = 1e5;
            c.segments = Some(segments);
            c.route_m = vec![[0.0, RADIUS], [12.0, RADIUS]];
            let end = Support { motion: Some(pull), ..Support::fixed("pull", [12.0, height]) };
            c.supports = vec![Support::free("tail"), end];
        },
        vec![floor(0.5)],
    )
}

fn weight_per_m() -> f64 {
    1.246 * crate::scene::STANDARD_GRAVITY
}

#[test]
fn dragging_along_a_floor_takes_the_friction_of_its_weight() {
    let expected = 0.5 * weight_per_m() * 12.0;
    // With inertia the start leaves an axial wave that dies out in 1.5 s (material damping of 1e-3
    // s): its mean is read.
    for (inertia, from, until, within) in [(Inertia::QuasiStatic, 0.8, 1.0, 1e-3), (Inertia::Dynamic, 2.0, 4.0, 5e-3)] {
        let mut d = build(&drag(60));
        d.settle(&[]).unwrap();
        let (mut sum, mut count) = (0.0, 0.0);
        while d.cable.state().time_s < until {
            d.advance(1.0 / 60.0, inertia, &[]).unwrap();
            assert!(d.cable.smallest_gap() > 0.0);
            if d.cable.state().time_s > from {
                sum -= d.solution().supports[1].reaction_x_n;
                count += 1.0;
            }
        }
        let pull = sum / count;
        assert!((pull / expected - 1.0).abs() < within, "{inertia:?}: {pull} N, expected {expected} N");
    }
}

#[test]
fn a_held_end_does_not_creep() {
    let mut d = build(&drag(40));
    d.settle(&[]).unwrap();
    for _ in 0..30 {
        d.advance(1.0 / 60.0, Inertia::QuasiStatic, &[]).unwrap();
    }
    // Dragged support stays where the hand put it: the pull must stay too.
    let here = d.cable.state().position_m.last().copied();
    let hand = [None, here];
    d.advance(1.0 / 60.0, Inertia::Dynamic, &hand).unwrap();
    let (before, start) = (-d.solution().supports[1].reaction_x_n, d.cable.state());
    for _ in 0..120 {
        d.advance(1.0 / 60.0, Inertia::Dynamic, &hand).unwrap();
    }
    let after = -d.solution().supports[1].reaction_x_n;
    assert!((after / before - 1.0).abs() < 1e-2, "{before} N became {after} N");
    for (a, b) in start.position_m.iter().zip(&d.cable.state().position_m) {
        assert!((a - b).norm() < 1e-3);
    }
}

fn corner(load: f64) -> Scene {
    let beam = Shape::Polygon { points_m: vec![[0.0, -0.2], [0.2, -0.2], [0.2, 0.0], [0.0, 0.0]] };
    scene(
        |c| {
            c.length_m = 4.0;
            c.linear_density_kg_per_m = 0.5;
            c.axial_stiffness_n = 4e4;
            c.diameter_m = 0.004;
            c.segments = Some(50);
            let way = 4.0 - 2.0f64.hypot(0.0);
            c.route_m = vec![[-0.003, 0.003 - way], [-0.003, 0.003], [1.997, 0.003]];
            let hang = Support { force_n: Some([0.0, -load]), ..Support::new("load", SupportKind::Load) };
            c.supports = vec![hang, Support::fixed("end", [1.997, 0.003])];
        },
        vec![Obstacle { name: "beam".to_owned(), shape: beam, friction: Some(0.3) }],
    )
}

#[test]
fn a_load_over_a_corner_rests_and_stays() {
    let mut d = build(&corner(50.0));
    d.settle(&[]).unwrap();
    let start = d.cable.state();
    for _ in 0..60 {
        d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap();
        assert!(d.cable.smallest_gap() > 0.0);
    }
    let moved = (d.cable.state().position_m[0] - start.position_m[0]).norm();
    assert!(moved < 1e-3, "{moved}");
}

/// A steel-stiff cable drawn to 1e5 N over a post, without sliding nodes: the barrier alone carries
/// it.
fn taut_over_a_post() -> Stepper {
    let post = Shape::Circle { center_m: [0.0, 0.0], radius_m: 0.2 };
    let scene = scene(
        |c| {
            (c.length_m, c.axial_stiffness_n, c.segments) = (4.0, 1e7, Some(40));
            (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
            c.route_m = vec![[-2.0, -0.2], [0.0, 0.22], [2.0, -0.2]];
            c.supports = vec![Support::fixed("a", [-2.0, -0.2]), Support::fixed("b", [2.0, -0.2])];
        },
        vec![Obstacle { name: "post".to_owned(), shape: post, friction: Some(0.3) }],
    );
    let mut d = build(&scene);
    d.cable.meshing.slides = false;
    d
}

#[test]
fn a_barrier_as_stiff_as_the_cable_is_taut_keeps_a_gap_that_numbers_can_tell() {
    let mut d = taut_over_a_post();
    d.settle(&[]).unwrap();
    let mut halved = 0;
    for _ in 0..12 {
        halved += d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap().cost.halved_steps;
        let gap = d.cable.smallest_gap();
        let pull = d.solution().supports[1].reaction_x_n.abs();
        println!("{gap:e} m under {pull:.0} N, {halved} halved");
        assert!(pull > 5e4, "{pull}");
        // A hundredth of the tension turns at a node here: φ'(u) = −0.2 of the barrier's stiffness,
        // at u = 0.7.
        assert!(
            gap > 0.2 * crate::model::fem::settings::ContactTuning::default().reach_m && halved == 0,
            "{gap:e} m under {pull} N, {halved} halved"
        );
    }
}

#[test]
fn an_end_thrown_ten_metres_in_a_frame_does_not_pass_a_beam() {
    let beam = Shape::Polygon { points_m: vec![[15.0, -50.0], [15.05, -50.0], [15.05, 50.0], [15.0, 50.0]] };
    let beam = Obstacle { name: "beam".to_owned(), shape: beam, friction: Some(0.3) };
    let scene = scene(|c| c.segments = Some(40), vec![beam]);
    let mut d = build(&scene);
    d.settle(&[None, None]).unwrap();
    let hand = [None, Some(Vec2::new(20.0, 5.0))];
    let mut was_warned = false;
    for _ in 0..60 {
        let report = d.advance(1.0 / 60.0, Inertia::Dynamic, &hand).unwrap();
        was_warned |= !report.warnings.is_empty();
        for p in &d.cable.state().position_m {
            assert!(p.x < 15.0 - RADIUS && p.iter().all(|c| c.is_finite()), "{p}");
        }
    }
    assert!(was_warned);
}

/// The steps that are hard change with the last digit of the start, so several starts are tried.
#[test]
fn a_cable_dropped_on_rubble_loses_hardly_a_step_and_never_penetrates() {
    const STARTS: usize = 8;
    let mut points = Vec::new();
    for i in 0..=80 {
        let height = 0.35 * (f64::from(i) * 12.9898).sin() * (f64::from(i) * 4.1).cos();
        points.push([-10.0 + 0.6 * f64::from(i), height]);
    }
    let rubble =
        Obstacle { name: "rubble".to_owned(), shape: Shape::Terrain { points_m: points }, friction: Some(1.0) };
    let dropped = |aside: f64| {
        let mut scene = scene(
            |c| {
                c.length_m = 30.0;
                c.segments = Some(200);
                let ends = [[aside - 5.0, 2.0], [aside + 25.0, 2.0]];
                c.route_m = ends.to_vec();
                let let_go = |name: &str, at| Support { release_s: Some(0.05), ..Support::fixed(name, at) };
                c.supports = vec![let_go("left", ends[0]), let_go("right", ends[1])];
            },
            vec![rubble.clone()],
        );
        scene.name = "rubble".to_owned();
        let mut d = build(&scene);
        d.settle(&[]).unwrap();
        let mut halved = 0;
        for _ in 0..240 {
            halved += d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap().cost.halved_steps;
            assert!(d.cable.smallest_gap() > 0.0);
        }
        let state = d.cable.state();
        let highest = state.position_m.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        assert!(highest < 0.6, "{highest} m: it has not landed after 4 s");
        halved
    };
    let halved: Vec<usize> = (0..STARTS).map(|k| dropped(1e-6 * k as f64)).collect();
    println!("{halved:?} halved steps of 960");
    // Some steps do not find which corners hold and which slip, and are taken again in halves (1 in
    // 1000 of violent scenes is).
    assert!(halved.iter().sum::<usize>() <= 2 * STARTS, "{halved:?}");
}

#[test]
fn the_same_run_gives_the_same_bits() {
    let run = || {
        let mut d = build(&drag(30));
        d.settle(&[]).unwrap();
        for _ in 0..20 {
            d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap();
        }
        d.cable.state()
    };
    assert_eq!(run(), run());
}

#[test]
fn the_answer_lists_the_floor() {
    let mut d = build(&drag(60));
    d.settle(&[]).unwrap();
    let s = d.solution();
    assert_eq!(s.contacts.len(), 1);
    let expected = weight_per_m() * 12.0;
    assert!((s.contacts[0].normal_n / expected - 1.0).abs() < 1e-3, "{:?}", s.contacts[0]);
    assert_eq!(s.contacts[0].obstacle, "floor");
}

/// A floor carries all of a cable that lies on it, the halves at its held ends too: the supports
/// pull only along it.
#[test]
fn a_floor_carries_what_lies_on_it_up_to_the_held_ends() {
    for friction in [0.0, 0.3] {
        let d = {
            let flat = scene(
                |c| {
                    c.axial_stiffness_n = 1e5;
                    c.segments = Some(24);
                    c.length_m = 11.99;
                    c.route_m = vec![[0.0, RADIUS], [12.0, RADIUS]];
                    c.supports = vec![Support::fixed("A", [0.0, RADIUS]), Support::fixed("B", [12.0, RADIUS])];
                },
                vec![floor(friction)],
            );
            let mut d = build(&flat);
            d.settle(&[]).unwrap();
            d
        };
        let answer = d.solution();
        let weight = weight_per_m() * 11.99;
        assert_eq!(answer.contacts.len(), 1, "{:?}", answer.contacts);
        let contact = &answer.contacts[0];
        assert!((contact.normal_n / weight - 1.0).abs() < 1e-6, "{} N of {weight} N", contact.normal_n);
        assert!((contact.begins_m, contact.ends_m) == (0.0, 11.99), "{contact:?}");
        assert!(answer.supports.iter().all(|s| s.reaction_y_n.abs() < 1e-6 * weight), "{:?}", answer.supports);
    }
}

/// Drops that differ by a millimetre land anywhere. A fold of a few slack bars that stands up
/// between two stones swings on like the linkage it is: without bending stiffness nothing damps it.
/// Of 300 such drops 223 slept after 20 s, and in 10 more than three nodes still moved.
#[test]
fn a_cable_dropped_on_rubble_comes_to_rest() {
    let (mut asleep, mut restless) = (0, 0);
    for higher in 0..12 {
        let mut scene = catalog::rubble_drop();
        let lift = |p: &mut [f64; 2]| p[1] += 1e-3 * f64::from(higher);
        scene.cables[0].route_m.iter_mut().for_each(lift);
        scene.cables[0].supports.iter_mut().filter_map(|s| s.at_m.as_mut()).for_each(lift);
        let mut d = build(&scene);
        d.settle(&[]).unwrap();
        for _ in 0..1200 {
            d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap();
        }
        let start = d.cable.state();
        let iterations: usize =
            (0..60).map(|_| d.advance(1.0 / 60.0, Inertia::Dynamic, &[]).unwrap().cost.iterations).sum();
        let end = d.cable.state();
        if iterations == 0 {
            assert_eq!(start.position_m, end.position_m);
            asleep += 1;
        }
        let moved = |(a, b): &(&Vec2, &Vec2)| (*a - *b).norm() > 1e-3;
        restless += usize::from(start.position_m.iter().zip(&end.position_m).filter(moved).count() > 3);
    }
    // By these rates one set of drops in three hundred has fewer asleep, one in two hundred more
    // that move.
    assert!(asleep >= 5 && restless <= 2, "{asleep} of 12 came to rest, {restless} do not come near it");
}

#[test]
fn a_cable_that_sleeps_wakes_when_it_is_pulled() {
    let mut d = build(&drag(40));
    d.settle(&[]).unwrap();
    let height = RADIUS + 0.87 * crate::model::fem::settings::ContactTuning::default().reach_m;
    let mut hand = [None, Some(Vec2::new(12.0, height))];
    let mut iterations = 0;
    for _ in 0..120 {
        iterations = d.advance(1.0 / 60.0, Inertia::Dynamic, &hand).unwrap().cost.iterations;
    }
    assert_eq!(iterations, 0, "it does not sleep");
    hand[1] = Some(Vec2::new(12.3, height + 0.2));
    for _ in 0..60 {
        d.advance(1.0 / 60.0, Inertia::Dynamic, &hand).unwrap();
    }
    let end = *d.cable.state().position_m.last().unwrap();
    assert!((end - hand[1].unwrap()).norm() < 1e-3, "{end}");
}

#[test]
fn a_cable_that_lands_stays_on_the_ground() {
    let scene = scene(
        |c| {
            (c.length_m, c.axial_stiffness_n, c.segments) = (2.0, 1e5, Some(20));
            c.route_m = vec![[-1.0, RADIUS], [1.0, RADIUS]];
            c.supports = vec![Support::fixed("a", [-1.0, RADIUS]), Support::fixed("b", [1.0, RADIUS])];
            c.supports.iter_mut().for_each(|s| s.release_s = Some(0.0));
        },
        vec![floor(0.5)],
    );
    let mut d = build(&scene);
    d.settle(&[]).unwrap();
    // Thrown down flat with 2.4 m/s from 5 cm: a barrier without landing throws it back at half of
    // that, 7 cm up.
    for (x, v) in d.cable.motion.positions.iter_mut().zip(&mut d.cable.motion.velocities) {
        (x.y, v.y) = (x.y + 0.05, -2.4);
    }
    d.forget_history();
    let highest = |d: &Stepper| d.cable.state().position_m.iter().map(|p| p.y - RADIUS).fold(0.0, f64::max);
    let (mut landed, mut most) = (false, 0.0f64);
    for _ in 0..60 {
        d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
        if landed {
            most = most.max(highest(&d));
        }
        landed |= highest(&d) < 4e-3;
    }
    println!("{landed}, {most:e} m above the ground after landing");
    assert!(landed && most < 6e-3, "{most}");
}

/// Two legs of a hanging hairpin thrown at each other until they touch.
pub(super) fn legs_that_touch() -> Stepper {
    let mut scene = scene(
        |c| {
            (c.length_m, c.axial_stiffness_n, c.segments, c.self_contact) = (4.0, 1e5, Some(40), true);
            c.supports = vec![Support::fixed("a", [-0.1, 0.0]), Support::fixed("b", [0.1, 0.0])];
        },
        Vec::new(),
    );
    scene.cables[0].diameter_m = 0.03;
    let mut d = build(&scene);
    d.settle(&[]).unwrap();
    for k in 1..d.cable.mesh.nodes() - 1 {
        d.cable.motion.velocities[k].x = 3.0 * (std::f64::consts::FRAC_PI_2 * d.cable.mesh.arc_length[k]).sin();
    }
    for _ in 0..60 {
        d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
        if d.cable.contacts.self_contacts.friction_contacts.len() > 2 {
            break;
        }
    }
    d
}

#[test]
fn legs_that_land_on_each_other_go_on_together() {
    let mut d = legs_that_touch();
    let rubs = d.cable.contacts.self_contacts.friction_contacts.clone();
    assert!(rubs.len() > 2, "{}", rubs.len());
    for k in 0..d.cable.mesh.nodes() {
        let way = if d.cable.mesh.fixity[k] { 0.0 } else { 1.0 };
        d.cable.motion.velocities[k] =
            Vec2::new(if d.cable.mesh.arc_length[k] < 2.0 { 2.0 } else { -1.0 } * way, 0.3 * way);
    }
    let momentum = |d: &Stepper| {
        (0..d.cable.mesh.nodes()).map(|k| d.cable.motion.velocities[k] * d.cable.mesh.tributary_length(k)).sum::<Vec2>()
    };
    let fastest = |d: &Stepper| {
        rubs.iter().map(|r| r.pair.normal.dot(&r.pair.difference(&d.cable.motion.velocities)).abs()).fold(0.0, f64::max)
    };
    let (before, approach) = (momentum(&d), fastest(&d));
    crate::model::fem::time::land_on_itself(&mut d.cable, 1.0 / 240.0, 240.0, &d.solver.ways);
    let (after, left) = (momentum(&d), fastest(&d));
    println!("{} contacts: {approach} m/s became {left}, momentum {before:?} {after:?}", rubs.len());
    assert!(approach > 2.5 && left < 0.5 * approach, "{approach} {left}");
    assert!((after - before).norm() < 1e-12 * before.norm());
}

#[test]
fn legs_rub_on_each_other_and_remember_it() {
    let mut d = legs_that_touch();
    let (start, by) = (d.cable.motion.positions.clone(), 3e-6);
    let mut slid = start.clone();
    for k in (0..d.cable.mesh.nodes()).filter(|&k| d.cable.mesh.arc_length[k] > 2.0) {
        slid[k].y += by;
    }
    let (barrier, own) = (d.cable.contacts.barrier, &mut d.cable.contacts.self_contacts);
    own.forget();
    own.prepare(&barrier, &d.cable.mesh, &start, &start);
    assert!(own.friction_contacts.len() > 2);
    for rub in &own.friction_contacts {
        let load = -barrier.at(rub.pair.gap_m).slope * rub.pair.weight;
        assert!(load > 0.0 && (rub.limit - own.friction * load).abs() < 1e-12 * load && own.friction > 0.0);
        // The legs hang: their normals lie nearly level.
        assert!((rub.sliding(&slid).abs() - by).abs() < 0.1 * by && rub.sliding(&start) == 0.0);
    }
    let before: Vec<f64> = own.friction_contacts.iter().map(|r| r.sliding(&slid)).collect();
    own.commit(&slid, 1e-5, barrier.reach);
    own.prepare(&barrier, &d.cable.mesh, &slid, &slid);
    let count = own.friction_contacts.iter().filter(|r| before.contains(&r.sliding(&slid))).count();
    assert!(count > 2 && count * 2 > own.friction_contacts.len(), "{count} of {}", own.friction_contacts.len());
}

/// A polish that asks for less than the rounding of short bars iterates for nothing.
#[test]
fn a_rest_of_many_bars_is_polished_as_far_as_its_bars_are_known() {
    let settings = Settings { segments: Some(10_000), ..Settings::default() };
    let problem = problems(&catalog::slack_to_floor()).unwrap().remove(0);
    let mut model = FemModel::new(problem, settings).unwrap();
    model.settle().unwrap();
    let done = model.stepper.polish(Converged::default(), &[]);
    println!("{done:?}");
    assert!(done.iterations <= 5, "{done:?}");
}
