//! These tests let a hand do whatever it likes: ends thrown about over rough ground, beams and
//! posts. Nothing may cross, nothing may be anything but a number, and hardly a step may have to be
//! halved.

#![allow(clippy::unwrap_used)]

use cable_core::contact::World;
use cable_core::math::Vec2;
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};
use cable_core::{Model, Settings, Simulation, SolveError};
use proptest::prelude::{Strategy, any};
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Counts of what went wrong.
#[derive(Debug, Default)]
struct Count {
    steps: usize,
    halved: usize,
    failed: Vec<String>,
}

struct Dice(TestRunner);

impl Dice {
    /// The dice of a scene, so that each can be run by itself.
    fn new(scene: usize) -> Self {
        let mut seed = [7_u8; 32];
        seed[..8].copy_from_slice(&scene.to_le_bytes());
        Self(TestRunner::new_with_rng(Config::default(), TestRng::from_seed(RngAlgorithm::ChaCha, &seed)))
    }

    fn unit(&mut self) -> f64 {
        let n = any::<u32>().new_tree(&mut self.0).unwrap().current();
        f64::from(n) / f64::from(u32::MAX)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Rubble with a beam and a post above it; a cable between two ends over them.
fn random_scene(dice: &mut Dice) -> Scene {
    let mut scene = catalog::hanging_span();
    let rough = dice.between(0.0, 0.5);
    let points_m = (0..=60).map(|k| [-15.0 + 0.5 * f64::from(k), dice.between(-rough, rough)]).collect();
    let friction = Some(dice.between(0.0, 1.0));
    let ground = Obstacle { name: "rubble".to_owned(), shape: Shape::Terrain { points_m }, friction };
    let (x, y, b, h) =
        (dice.between(-2.0, 0.0), dice.between(0.9, 1.5), dice.between(0.05, 0.6), dice.between(0.05, 0.4));
    let beam = Shape::Polygon { points_m: vec![[x, y - h], [x + b, y - h], [x + b, y], [x, y]] };
    let post =
        Shape::Circle { center_m: [dice.between(1.5, 3.0), dice.between(1.2, 1.8)], radius_m: dice.between(0.05, 0.4) };
    scene.obstacles = vec![
        ground,
        Obstacle { name: "beam".to_owned(), shape: beam, friction },
        Obstacle { name: "post".to_owned(), shape: post, friction },
    ];
    let c = &mut scene.cables[0];
    c.length_m = dice.between(9.0, 14.0);
    c.axial_stiffness_n = 10f64.powf(dice.between(4.0, 7.0));
    c.segments = Some(60);
    // Breaking is tested elsewhere: here every step has to be survived.
    (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
    c.supports = vec![Support::fixed("left", [-4.0, 3.0]), Support::fixed("right", [4.0, 3.0])];
    scene
}

/// Smallest gap of the nodes of an answer, m.
fn smallest_gap(world: &World, sim: &Simulation) -> f64 {
    let mut least = f64::INFINITY;
    for n in &sim.solution().cables[0].nodes {
        let gap = world.signed_gap(Vec2::new(n.x_m, n.y_m), 0.05).map_or(f64::INFINITY, |g| g.gap_m);
        assert!(n.x_m.is_finite() && n.y_m.is_finite() && n.tension_n.is_finite());
        least = if gap < least { gap } else { least };
    }
    least
}

/// The behaviour of a cable that meets itself.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Own {
    Touches,
    Passes,
}

fn throw_about(scenes: impl IntoIterator<Item = usize>, frames: usize, dt: f64, own: Own) -> Count {
    let self_contact = own == Own::Touches;
    let mut count = Count::default();
    for s in scenes {
        let mut dice = Dice::new(s);
        let mut scene = random_scene(&mut dice);
        scene.cables[0].self_contact = self_contact;
        let c = &scene.cables[0];
        let diameter = if self_contact { c.diameter_m } else { 0.0 };
        let world = World::new(&scene.obstacles, c.friction, c.diameter_m / 2.0);
        // Hands ten times as fast as an arm.
        let settings = Settings { hand_speed_m_per_s: 20.0, ..Settings::default() };
        let mut sim = Simulation::with_settings(scene.clone(), Model::Fem, settings).unwrap();
        if let Err(e) = sim.settle() {
            count.failed.push(format!("scene {s} settle: {e}"));
            continue;
        }
        let mut hand = Vec2::new(4.0, 3.0);
        for f in 0..frames {
            // A hand that mostly wanders and sometimes jumps.
            let reach = if dice.unit() < 0.1 { 10.0 } else { 0.2 };
            let to = hand + Vec2::new(dice.between(-reach, reach), dice.between(-reach, reach));
            if to.x.abs() < 10.0 && to.y > 0.6 && to.y < 6.0 {
                hand = to;
            }
            sim.drag_support(0, 1, hand);
            count.steps += (dt * 240.0).ceil() as usize;
            match sim.step(dt) {
                Ok(()) => count.halved += sim.solution().cost.halved_steps,
                Err(e) => {
                    count.failed.push(format!("scene {s} frame {f}: {e}"));
                    break;
                }
            }
            let gap = smallest_gap(&world, &sim);
            let own_gap = smallest_own_gap(diameter, &sim);
            if !(gap > -1e-9 && own_gap > -1e-9) {
                count.failed.push(format!("scene {s} frame {f}: gap {gap}, own gap {own_gap}"));
                break;
            }
        }
    }
    count
}

/// Smallest distance of the surface of a cable of a diameter (m; 0: it may pass itself) from itself
/// by brute force, m: of each node from each segment farther along it than a half turn takes.
fn smallest_own_gap(diameter: f64, sim: &Simulation) -> f64 {
    let nodes = &sim.solution().cables[0].nodes;
    let x: Vec<Vec2> = nodes.iter().map(|n| Vec2::new(n.x_m, n.y_m)).collect();
    let s: Vec<f64> = nodes.iter().map(|n| n.arc_length_m).collect();
    let mut least = f64::INFINITY;
    for (e, ends) in x.windows(2).enumerate().filter(|_| diameter > 0.0) {
        let chord = ends[1] - ends[0];
        for (p, at) in x.iter().enumerate() {
            let between = if p <= e { s[e] - s[p] } else { s[p] - s[e + 1] };
            let fraction = ((at - ends[0]).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
            if between >= 2.4 * diameter {
                least = least.min((at - ends[0] - chord * fraction).norm() - diameter);
            }
        }
    }
    least
}

/// A cable of 30 m above rubble whose ends let go at once.
fn falling_scene(dice: &mut Dice, stiffness: f64, segments: usize) -> Scene {
    let mut scene = catalog::hanging_span();
    let points_m = (0..=160).map(|k| [-20.0 + 0.25 * f64::from(k), dice.between(0.0, 0.4)]).collect();
    let shape = Shape::Terrain { points_m };
    scene.obstacles = vec![Obstacle { name: "rubble".to_owned(), shape, friction: Some(0.6) }];
    let c = &mut scene.cables[0];
    (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
    (c.length_m, c.axial_stiffness_n, c.segments) = (30.0, stiffness, Some(segments));
    let half = dice.between(6.0, 14.0);
    c.supports = vec![Support::fixed("left", [-half, 13.0]), Support::fixed("right", [half, 13.0])];
    for support in &mut c.supports {
        support.release_s = Some(0.05);
    }
    scene
}

/// Drops cables for some time (s) each, in frames of `dt` (s).
fn drop_all(stiffnesses: &[f64], segments: usize, time: f64, dt: f64) -> Count {
    let mut count = Count::default();
    for (k, &stiffness) in stiffnesses.iter().enumerate() {
        let scene = falling_scene(&mut Dice::new(1000 + k), stiffness, segments);
        let c = &scene.cables[0];
        let world = World::new(&scene.obstacles, c.friction, c.diameter_m / 2.0);
        let mut sim = Simulation::new(scene.clone(), Model::Fem).unwrap();
        for f in 0..(time / dt).round() as usize {
            count.steps += (dt * 240.0).ceil() as usize;
            if let Err(e) = sim.step(dt) {
                count.failed.push(format!("EA {stiffness:e} frame {f}: {e}"));
                break;
            }
            count.halved += sim.solution().cost.halved_steps;
            let gap = smallest_gap(&world, &sim);
            if !(gap > -1e-9) {
                count.failed.push(format!("EA {stiffness:e} frame {f}: gap {gap}"));
                break;
            }
        }
    }
    count
}

#[test]
#[ignore = "open: since bars only pull, one frame of EA 1e5 lies 0.16 mm inside (2 % of the diameter are 0.56 mm)"]
fn a_cable_dropped_on_rubble_crosses_nothing() {
    let count = drop_all(&[1e5, 1e8], 60, 2.0, 1.0 / 60.0);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty(), "{:#?}", count.failed);
}

#[test]
#[ignore = "takes minutes: cargo test -p cable-core --test fem_robust -- --ignored --nocapture"]
fn thirty_metres_of_any_stiffness_drop_on_rubble() {
    for dt in [1.0 / 60.0, 1.0 / 240.0] {
        let count = drop_all(&[1e5, 1e6, 1e7, 1e8], 200, 4.0, dt);
        println!("frames of {dt:.4} s: {} steps, {} halved", count.steps, count.halved);
        assert!(count.failed.is_empty(), "{:#?}", count.failed);
        assert!(count.halved * 1000 <= count.steps, "{} of {} steps halved", count.halved, count.steps);
    }
}

#[test]
fn ends_thrown_about_cross_nothing() {
    // Scenes that each found a fault: no rest, a support squeezed against a post, a corner taken
    // hold of through another, a node beside a corner taken out so that the cable ran 10 mm inside
    // the corner's edge.
    let count = throw_about([17, 45, 73, 97, 98], 60, 1.0 / 60.0, Own::Passes);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty(), "{:#?}", count.failed);
}

#[test]
#[ignore = "takes minutes: cargo test -p cable-core --test fem_robust -- --ignored --nocapture"]
fn ends_thrown_about_ten_thousand_times_cross_nothing() {
    let count = throw_about(0..100, 100, 1.0 / 60.0, Own::Passes);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty(), "{:#?}", count.failed);
    assert!(count.halved * 1000 <= count.steps, "{} of {} steps halved", count.halved, count.steps);
}

#[test]
fn ends_thrown_about_do_not_cross_the_cable_itself() {
    // One in which a support squeezes the cable, one in which it does not.
    let count = throw_about([0, 45], 40, 1.0 / 60.0, Own::Touches);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty(), "{:#?}", count.failed);
}

#[test]
fn what_couples_distant_nodes_is_not_solved_with_the_right_side_of_a_step_before() {
    // The step was then halved (or lost) in frame 69.
    let count = throw_about([84], 70, 1.0 / 60.0, Own::Touches);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty() && count.halved == 0, "{} {:#?}", count.halved, count.failed);
}

#[test]
#[ignore = "takes minutes: cargo test -p cable-core --test fem_robust -- --ignored --nocapture"]
fn ends_thrown_about_ten_thousand_times_do_not_cross_the_cable_itself() {
    let count = throw_about(0..100, 100, 1.0 / 60.0, Own::Touches);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty(), "{:#?}", count.failed);
    assert!(count.halved * 1000 <= count.steps, "{} of {} steps halved", count.halved, count.steps);
}

#[test]
fn what_is_drawn_round_a_corner_or_along_the_cable_itself_is_not_halved() {
    // Straight on, a bar that slides along a corner and turns runs into it: six steps of these were
    // halved. Two in which bars go slack and taut by turns are.
    let count = throw_about([0, 3, 7, 9], 80, 1.0 / 60.0, Own::Touches);
    println!("{} steps, {} halved", count.steps, count.halved);
    assert!(count.failed.is_empty() && count.halved <= 2, "{} {:#?}", count.halved, count.failed);
}

#[test]
fn a_state_inside_an_obstacle_is_refused() {
    let mut scene = catalog::hanging_span();
    let shape = Shape::Terrain { points_m: vec![[-20.0, -3.0], [20.0, -3.0]] };
    scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape, friction: Some(0.5) }];
    let c = &mut scene.cables[0];
    (c.length_m, c.segments) = (9.0, Some(40));
    c.supports = vec![Support::fixed("left", [-4.0, 0.0]), Support::fixed("right", [4.0, 0.0])];
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    sim.settle().unwrap();
    let before = sim.states();
    let lowered = |by: f64| {
        let mut states = before.clone();
        for p in &mut states[0].position_m[1..40] {
            p.y = if p.y - by < -3.0 - by { -3.0 - by } else { p.y - by };
        }
        states
    };
    // A millimetre deep it is pushed out, deeper than it reaches it is refused, and is where it
    // was.
    sim.set_states(&lowered(1e-3)).unwrap();
    sim.step(1.0 / 60.0).unwrap();
    sim.set_states(&before).unwrap();
    let refused = sim.set_states(&lowered(4.0)).unwrap_err();
    println!("{refused}");
    assert!(
        matches!(refused, SolveError::Buried { ref obstacle, depth_m, .. } if obstacle == "ground" && depth_m > 0.5)
    );
    assert_eq!(sim.states(), before);
}

/// Laid exactly on a post, its nodes a rounding away from it: it finds a rest from there, too.
#[test]
fn a_cable_laid_in_touch_finds_a_rest() {
    let mut scene = catalog::hanging_span();
    scene.loads.clear();
    let (mu, radius) = (0.23653988940858117, 0.12154170598370315);
    let (tail, drop) = (1.3562381160663473, 0.43386497201316426);
    let c = &mut scene.cables[0];
    (c.linear_density_kg_per_m, c.axial_stiffness_n, c.bending_stiffness_n_m2) =
        (0.3609995931039175, 277959831.6329003, 0.0);
    (c.diameter_m, c.friction, c.length_m, c.segments) = (0.001, mu, 2.171937618702684, None);
    c.route_m = vec![[-radius, -tail]];
    c.route_m.extend((0..10).map(|i| {
        let angle = std::f64::consts::PI - f64::from(i) * 20_f64.to_radians();
        [radius * angle.cos(), radius * angle.sin()]
    }));
    c.route_m.push([radius, -drop]);
    c.supports = vec![Support::free("A"), Support::fixed("B", [radius, -drop])];
    let weight = c.linear_density_kg_per_m * cable_core::scene::STANDARD_GRAVITY;
    let post = Shape::Circle { center_m: [0.0, 0.0], radius_m: radius - 0.0005 };
    scene.obstacles = vec![Obstacle { name: "post".to_owned(), shape: post, friction: Some(mu) }];
    let mut simulation = Simulation::new(scene, Model::Fem).unwrap();
    simulation.settle().unwrap();
    let tension = simulation.solution().cables[0].supports[1].reaction_y_n + weight * drop;
    // Somewhere between what the tail weighs with all the friction there is against it and for it.
    let most = (mu * std::f64::consts::PI).exp();
    assert!(tension > 0.9 * weight * tail / most && tension < 1.1 * weight * tail * most, "{tension} N");
}

/// Drawn up against the underside of a beam, from one corner to the next: weight pulls what holds a
/// corner off there, and a corner that was let go of at once, again and again, was passed by bars,
/// which friction held with three times the tension.
#[test]
fn a_cable_drawn_up_under_a_beam_slides_round_both_corners() {
    for width in [0.1, 0.11] {
        let mut scene = catalog::hanging_span();
        scene.loads.clear();
        let right = 1.9 + width;
        let c = &mut scene.cables[0];
        (c.length_m, c.linear_density_kg_per_m, c.diameter_m) = (4.5, 0.7, 0.02);
        (c.axial_stiffness_n, c.bending_stiffness_n_m2, c.friction, c.segments) = (1e6, 0.0, 0.4, None);
        c.route_m = vec![[0.0, 1.0], [1.88, -0.04], [right + 0.02, -0.04], [3.6, 0.7]];
        let mut hand = Support::fixed("B", [3.6, 0.7]);
        hand.motion = Some(Motion { times_s: vec![0.0, 6.0], points_m: vec![[3.6, 0.7], [4.1, 0.75]] });
        c.supports = vec![Support::fixed("A", [0.0, 1.0]), hand];
        let beam = Shape::Polygon { points_m: vec![[1.9, 0.0], [right, 0.0], [right, 0.1], [1.9, 0.1]] };
        scene.obstacles = vec![Obstacle { name: "beam".to_owned(), shape: beam, friction: Some(0.4) }];
        let [fem, spans] = [Model::Fem, Model::Spans].map(|model| {
            let mut simulation = Simulation::new(scene.clone(), model).unwrap();
            simulation.settle().unwrap();
            for _ in 0..360 {
                simulation.step_quasi_static(1.0 / 60.0).unwrap();
            }
            simulation.solution().cables[0].nodes.iter().map(|n| n.tension_n).fold(0.0, f64::max)
        });
        println!("{width} m: {fem} N, {spans} N with exact spans");
        assert!((fem / spans - 1.0).abs() < 5e-3 && spans > 50.0, "{width} m: {fem} N, {spans} N with exact spans");
    }
}
