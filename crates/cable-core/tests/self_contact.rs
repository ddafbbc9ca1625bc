//! These tests make a cable an obstacle to itself: piles, legs that meet, and scenes that must not
//! change because nothing touches.

#![allow(clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod dice;
mod segments;

use cable_core::ErrorEstimates;
use cable_core::math::Vec2;
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support, catalog};
use cable_core::solution::{CableSolution, ModelReason, WarningKind};
use cable_core::{Model, Settings, Simulation};
use dice::Dice;
use segments::cross_properly;

const FLOOR: f64 = -0.5;

/// A cable of a length (m) in `segments` above a floor, between two supports.
fn scene(length_m: f64, segments: usize, ends: [[f64; 2]; 2]) -> Scene {
    let mut scene = catalog::hanging_span();
    let shape = Shape::Terrain { points_m: vec![[-20.0, FLOOR], [20.0, FLOOR]] };
    scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(0.4) }];
    let c = &mut scene.cables[0];
    c.self_contact = true;
    c.diameter_m = 0.03;
    c.axial_stiffness_n = 1e5;
    (c.breaking_tension_n, c.service_tension_n) = (1e12, 1e12);
    (c.length_m, c.segments) = (length_m, Some(segments));
    c.supports = vec![Support::fixed("a", ends[0]), Support::fixed("b", ends[1])];
    scene
}

/// Smallest distance of the cable's surface from itself, m (1 where it is farther).
fn own_gap(sim: &Simulation) -> f64 {
    let nodes = &sim.solution().cables[0].nodes;
    let x: Vec<Vec2> = nodes.iter().map(|n| Vec2::new(n.x_m, n.y_m)).collect();
    let s: Vec<f64> = nodes.iter().map(|n| n.arc_length_m).collect();
    assert!(x.iter().all(|p| p.x.is_finite() && p.y.is_finite()));
    smallest_own_gap(&x, &s, sim.scene().cables[0].diameter_m).min(1.0)
}

/// Smallest distance of a cable of a diameter from itself by brute force, m: of each node from each
/// segment farther along it than a half turn takes.
fn smallest_own_gap(x: &[Vec2], arc: &[f64], diameter: f64) -> f64 {
    let mut least = f64::INFINITY;
    for (e, ends) in x.windows(2).enumerate() {
        let chord = ends[1] - ends[0];
        for (p, at) in x.iter().enumerate() {
            let between = if p <= e { arc[e] - arc[p] } else { arc[p] - arc[e + 1] };
            let fraction = ((at - ends[0]).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
            if between >= 2.4 * diameter {
                least = least.min((at - ends[0] - chord * fraction).norm() - diameter);
            }
        }
    }
    least
}

fn top(sim: &Simulation) -> f64 {
    sim.solution().cables[0].nodes.iter().map(|n| n.y_m).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns whether two bars of the cable cross.
fn crosses(sim: &Simulation) -> bool {
    let nodes = &sim.solution().cables[0].nodes;
    let x: Vec<Vec2> = nodes.iter().map(|n| Vec2::new(n.x_m, n.y_m)).collect();
    (2..x.len() - 1).any(|j| (0..j - 1).any(|i| cross_properly(x[i], x[i + 1], x[j], x[j + 1])))
}

/// A cable let go above the floor, upright but for a slight lean, comes down on itself.
fn pile(self_contact: bool, seconds: f64) -> (Simulation, f64, usize) {
    let mut scene = scene(3.0, 60, [[0.0, FLOOR + 3.1], [0.05, FLOOR + 0.2]]);
    scene.cables[0].self_contact = self_contact;
    scene.cables[0].supports[0].release_s = Some(0.05);
    scene.cables[0].supports[1].release_s = Some(0.05);
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    let (mut least, mut halved) = (f64::INFINITY, 0);
    for _ in 0..(seconds * 60.0) as usize {
        sim.step(1.0 / 60.0).unwrap();
        halved += sim.solution().cost.halved_steps;
        let gap = own_gap(&sim);
        least = if gap < least { gap } else { least };
    }
    (sim, least, halved)
}

#[test]
fn a_falling_cable_piles_up_on_itself() {
    let (sim, least, halved) = pile(true, 2.0);
    let (through, crossed, _) = pile(false, 2.0);
    println!(
        "least gap {least:e} m, {halved} halved, top {} m, without {} m",
        top(&sim) - FLOOR,
        top(&through) - FLOOR
    );
    assert!(least > 0.0, "{least}");
    // The test can fail: a cable that may pass itself does.
    assert!(crossed < 0.0, "{crossed}");
    assert!(top(&sim) > top(&through) + 0.03);
    let own = sim.solution().cables[0].contacts.iter().filter(|c| c.obstacle == sim.scene().cables[0].name).count();
    assert!(own > 0);
    let nodes = &sim.solution().cables[0].nodes;
    assert!((nodes[nodes.len() - 1].arc_length_m - 3.0).abs() < 1e-12);
}

/// The two legs of a hanging hairpin, 0.3 m apart, thrown at each other with 2 · `speed` (m/s): how
/// often they are found crossed in the next 24 inner steps, and the least gap. Bars are long for
/// the cable's width: where two cross, no node need be near the other.
fn legs_thrown_together(self_contact: bool, speed: f64) -> (usize, f64) {
    let mut scene = scene(6.0, 20, [[-0.15, 3.0], [0.15, 3.0]]);
    scene.cables[0].self_contact = self_contact;
    scene.cables[0].diameter_m = 0.004;
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    sim.settle().unwrap();
    sim.step(1e-4).unwrap();
    let mut states = sim.states();
    let state = &mut states[0];
    for (v, s) in state.velocity_m_per_s.iter_mut().zip(&state.arc_length_m) {
        *v = Vec2::new(speed * (std::f64::consts::TAU * s / 6.0).sin(), 0.0);
    }
    sim.set_states(&states).unwrap();
    let (mut crossed, mut least) = (0, f64::INFINITY);
    for _ in 0..24 {
        sim.step(1.0 / 240.0).unwrap();
        crossed += usize::from(crosses(&sim));
        let gap = own_gap(&sim);
        least = if gap < least { gap } else { least };
    }
    (crossed, least)
}

#[test]
fn legs_that_would_pass_each_other_within_a_step_do_not() {
    // 0.33 m and more in an inner step: from one side to the other, past the barrier at both ends
    // of the step.
    for speed in [40.0, 60.0, 80.0] {
        let (crossed, least) = legs_thrown_together(true, speed);
        println!("{speed} m/s: crossed {crossed}, least gap {least:e} m");
        assert!(crossed == 0 && least > 0.0, "{crossed} {least}");
        // The test can fail: a cable that may pass itself does.
        assert!(legs_thrown_together(false, speed).0 > 0);
    }
}

#[test]
fn an_end_whipped_through_its_own_leg_does_not_pass_it() {
    let settings = Settings { hand_speed_m_per_s: 20.0, ..Settings::default() };
    let mut sim = Simulation::with_settings(scene(6.0, 60, [[0.0, 3.0], [1.5, 2.0]]), Model::Fem, settings).unwrap();
    sim.settle().unwrap();
    // As fast as a hand may be: 20 m/s, 8 cm in an inner step, where the cable and its barrier
    // together are 3 cm.
    sim.drag_support(0, 1, Vec2::new(-2.0, 2.0));
    for k in 0..48 {
        sim.step(1.0 / 240.0).unwrap();
        let gap = own_gap(&sim);
        assert!(gap > 0.0 && !crosses(&sim), "{gap} after {k} steps");
    }
}

#[test]
fn an_end_drawn_against_its_own_leg_pushes_it_aside() {
    let mut sim = Simulation::new(scene(6.0, 60, [[0.0, 3.0], [1.5, 2.0]]), Model::Fem).unwrap();
    sim.settle().unwrap();
    let mut hand = Vec2::new(1.5, 2.0);
    for _ in 0..120 {
        hand.x -= 0.03;
        sim.drag_support(0, 1, hand);
        sim.step(1.0 / 60.0).unwrap();
        let gap = own_gap(&sim);
        assert!(gap > 0.0, "{gap} with the hand at {}", hand.x);
    }
    // The hand went to x = −2.1; the leg it pushed hangs from x = 0 and lies to its left now.
    let nodes = &sim.solution().cables[0].nodes;
    let leg = nodes.iter().filter(|n| n.arc_length_m < 2.0).map(|n| n.x_m).fold(f64::INFINITY, f64::min);
    assert!(leg < -0.5, "{leg}");
}

#[test]
fn a_cable_that_does_not_meet_itself_is_as_it_was() {
    let ends = [[-2.0, 1.5], [2.0, 1.0]];
    let tension = |self_contact: bool| {
        let mut scene = scene(5.0, 80, ends);
        scene.cables[0].self_contact = self_contact;
        let mut sim = Simulation::new(scene, Model::Fem).unwrap();
        sim.settle().unwrap().max_tension().tension_n
    };
    let (with, without) = (tension(true), tension(false));
    assert!((with / without - 1.0).abs() < 1e-6, "{with} {without}");
}

/// Every such scene was answered by `fem`.
#[test]
fn auto_answers_a_cable_that_does_not_meet_itself_as_one_that_can_pass_itself_and_moves_it_as_one_that_cannot() {
    for ends in [[[-2.0, 1.5], [2.0, 1.0]], [[0.0, 6.0], [1.5, 5.0]]] {
        let mut settled = [true, false].map(|self_contact| {
            let mut scene = scene(5.0, 80, ends);
            scene.cables[0].self_contact = self_contact;
            let mut sim = Simulation::new(scene, Model::Auto).unwrap();
            sim.settle().unwrap();
            assert_eq!(sim.model(), Model::Spans);
            sim
        });
        let [with, without] = settled.each_ref().map(Simulation::solution);
        assert_eq!(settled[0].reason(), &ModelReason::ClearOfItself);
        assert_eq!(with.cables[0].nodes, without.cables[0].nodes);
        assert!(with.cables[0].assumptions.self_contact && !without.cables[0].assumptions.self_contact);
        // With inertia it is an obstacle to itself.
        let [sim, _] = &mut settled;
        let mut without_inertia = sim.clone();
        sim.step(1.0 / 60.0).unwrap();
        assert_eq!((sim.model(), sim.reason()), (Model::Fem, &ModelReason::Inertia));
        for _ in 0..3 {
            without_inertia.step_quasi_static(1.0 / 60.0).unwrap();
            assert_eq!(
                (without_inertia.model(), without_inertia.reason()),
                (Model::Spans, &ModelReason::ClearOfItself)
            );
        }
    }
}

/// A run without inertia was of `fem`, whose nodes do not slide over a corner where the cable is an
/// obstacle to itself: 37.3 N for 27.1 N, without an error or a word.
#[test]
fn issue_016_drawn_over_a_mound_a_cable_clear_of_itself_is_as_one_that_can_pass_itself() {
    let pulls = |self_contact: bool| {
        let mut s = scene(6.888, 60, [[0.0, 2.716], [5.332, 0.3]]);
        s.obstacles[0].shape =
            Shape::Terrain { points_m: vec![[-20.0, 0.0], [3.199, 0.0], [3.699, 0.4], [4.199, 0.0], [40.0, 0.0]] };
        s.obstacles[0].friction = Some(0.2);
        s.cables[0].self_contact = self_contact;
        s.cables[0].axial_stiffness_n = 2e6;
        s.cables[0].segments = None;
        let mut sim = Simulation::new(s, Model::Auto).unwrap();
        sim.settle().unwrap();
        sim.drag_support(0, 1, Vec2::new(5.5, 0.3));
        for _ in 0..5 {
            sim.step_quasi_static(0.1).unwrap();
        }
        sim.solution().cables[0].supports.clone()
    };
    assert_eq!(pulls(true), pulls(false));
}

/// An end is drawn through the other leg without inertia, by 0.1 m and by 1 m a step. (In one step
/// of 2.5 m every point of the cable moves straight to its next place without meeting another.)
#[test]
fn auto_lets_no_end_through_its_own_leg_without_inertia() {
    for step in [0.1, 1.0] {
        let mut s = scene(2.0, 60, [[0.0, 3.0], [1.0, 2.3]]);
        s.cables[0].diameter_m = 0.02;
        let mut sim = Simulation::new(s, Model::Auto).unwrap();
        sim.settle().unwrap();
        assert_eq!(sim.model(), Model::Spans);
        let (mut x, mut by_fem) = (1.0, 0);
        while x > -1.5 {
            x -= step;
            sim.drag_support(0, 1, Vec2::new(x, 2.3));
            // A support that cannot follow may stop the run.
            if let Err(stopped) = sim.step_quasi_static(5.0) {
                println!("{stopped}");
                break;
            }
            by_fem += usize::from(sim.model() == Model::Fem);
            assert!(own_gap(&sim) > 0.0 && !crosses(&sim), "{x}");
        }
        println!("by {step} m: {by_fem} answers of fem until the end was at {x} m");
        assert!(by_fem > 0, "{step}");
    }
}

/// The legs of a long cable between near supports come nearer than the cable is thick at its
/// lowest point.
#[test]
fn auto_asks_fem_where_strands_meet() {
    let scene = scene(3.0, 60, [[0.0, 6.0], [0.04, 6.0]]);
    let mut passing = scene.clone();
    passing.cables[0].self_contact = false;
    let mut sim = Simulation::new(passing, Model::Auto).unwrap();
    sim.settle().unwrap();
    assert!(own_gap(&sim) < 0.0, "{}", own_gap(&sim));
    let mut sim = Simulation::new(scene, Model::Auto).unwrap();
    sim.settle().unwrap();
    assert_eq!((sim.model(), sim.reason()), (Model::Fem, &ModelReason::SelfContact));
    assert!(own_gap(&sim) > 0.0 && !crosses(&sim), "{}", own_gap(&sim));
}

#[test]
fn the_catalogue_has_a_scene_that_piles_up() {
    let scene = catalog::pile();
    let diameter = scene.cables[0].diameter_m;
    let mut sim = Simulation::new(scene, Model::Auto).unwrap();
    sim.settle().unwrap();
    for frame in 0..150 {
        sim.step(1.0 / 60.0).unwrap();
        assert!(own_gap(&sim) > 0.0, "{} m in frame {frame}", own_gap(&sim));
        // Bars nearer along the cable than half a turn takes may cross where it curls up, and that
        // is told.
        let curls = sim.solution().warnings.iter().any(|w| w.kind == WarningKind::Curl);
        assert!(curls || !crosses(&sim), "crossed in frame {frame}");
    }
    println!("{} m high after 2.5 s", top(&sim));
    // Laid flat its middle is half a diameter up.
    assert!(top(&sim) > 1.5 * diameter, "{}", top(&sim));
}

#[test]
fn a_pile_weighs_what_its_cable_weighs() {
    let (mut sim, _, _) = pile(true, 6.0);
    for _ in 0..60 {
        sim.step(1.0 / 60.0).unwrap();
    }
    let cable = &sim.solution().cables[0];
    let floor: f64 = cable.contacts.iter().filter(|c| c.obstacle == "floor").map(|c| c.normal_n * c.normal[1]).sum();
    let c = &sim.scene().cables[0];
    let weight = c.linear_density_kg_per_m * 3.0 * 9.80665;
    println!("floor carries {floor} N of {weight} N");
    assert!((floor / weight - 1.0).abs() < 0.02, "{floor} {weight}");
}

/// A run begins at the answer of `solve`, friction and all, where the cable touches itself nowhere:
/// it began at another rest, with 4.1 N for 14.3 N at the end (24 of 26 scenes off by 0.5 to 24 N).
#[test]
fn issue_016_a_run_begins_where_the_cable_rests() {
    use cable_core::model::{Inertia, Question};
    for (along, length) in [(4.907, 7.584), (6.2, 9.3), (3.1, 6.2)] {
        let mut s = scene(length, 60, [[0.0, 4.148], [along, 0.3]]);
        s.obstacles[0].shape = Shape::Terrain { points_m: vec![[-20.0, 0.0], [40.0, 0.0]] };
        s.cables[0].axial_stiffness_n = 2e6;
        s.cables[0].segments = None;
        let pulls = |question: Question| {
            let mut sim = Simulation::for_question(s.clone(), Model::Auto, Settings::default(), question).unwrap();
            let answer = sim.settle().unwrap();
            let supports = &answer.cables[0].supports;
            supports.iter().flat_map(|r| [r.reaction_x_n, r.reaction_y_n]).collect::<Vec<f64>>()
        };
        let (rests, begins) = (pulls(Question::Rest), pulls(Question::History(Inertia::Dynamic)));
        let most = rests.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        let off = rests.iter().zip(&begins).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.02 * most, "{along}: {off} N of {most} N, {rests:?} {begins:?}");
    }
}

/// A cable with self-contact, as stiff as asked, of which one end is drawn slowly to where it folds
/// over a bump of the floor; a second later, with so many segments.
fn drawn_together(number: u64, most_stiff: f64, segments: usize) -> Option<CableSolution> {
    let mut dice = Dice(number.wrapping_mul(0x2000_0003) + 29);
    let mut scene = scene(dice.within(5.0, 7.0), segments, [[-1.0, 1.0], [dice.within(1.0, 3.0), 1.0]]);
    let bump = [[-20.0, FLOOR], [0.0, FLOOR], [0.5, FLOOR + dice.within(0.0, 0.4)], [1.0, FLOOR], [20.0, FLOOR]];
    scene.obstacles[0].shape = Shape::Terrain { points_m: bump.into() };
    let c = &mut scene.cables[0];
    c.bending_stiffness_n_m2 = most_stiff * dice.within(0.1, 1.0);
    let (from, way) = (c.supports[1].at_m?, [dice.within(-1.5, 0.3), dice.within(-0.8, 0.5)]);
    let to = [from[0] + way[0], from[1] + way[1]];
    c.supports[1].motion = Some(Motion { times_s: vec![0.0, 1.0], points_m: vec![from, to] });
    let mut sim = Simulation::new(scene, Model::Fem).ok()?;
    sim.settle().ok()?;
    for _ in 0..60 {
        sim.step_quasi_static(1.0 / 60.0).ok()?;
    }
    sim.solution().cables.first().cloned()
}

/// Counts of figures, of those whose error covers the difference from four times as many segments,
/// and of those whose error is between half and ten times that.
fn errors_of_drawn(numbers: std::ops::Range<u64>, most_stiff: f64) -> [[usize; 4]; 3] {
    let [mut all, mut covered, mut apt] = [[0; 4]; 3];
    for number in numbers {
        let answers = [60, 240].map(|segments| drawn_together(number, most_stiff, segments));
        let [Some(coarse), Some(fine)] = answers else {
            println!("{number}: no answer");
            continue;
        };
        let figures = |e: &ErrorEstimates| [e.max_tension_n, e.support_force_n, e.contact_force_n, e.position_m];
        let least = 1e-6 * coarse.nodes.last().map_or(1.0, |node| node.arc_length_m);
        let pairs = figures(&coarse.errors).into_iter().zip(figures(&ErrorEstimates::between(&coarse, &fine)));
        for (k, (said, is)) in pairs.enumerate() {
            let Some(is) = is else { continue };
            let said = said.unwrap_or_else(|| panic!("{number}: figure {k} has no error"));
            println!("{number}, figure {k}: {said:.3e} for {is:.3e}");
            all[k] += 1;
            covered[k] += usize::from(said >= is || is < least);
            apt[k] += usize::from(is < least || (0.5 * is..10.0 * is).contains(&said));
        }
    }
    println!("greatest tension, supports, contacts, shape: {covered:?} of {all:?} covered, {apt:?} apt");
    [all, covered, apt]
}

/// Errors of stiff cables that touch themselves were not known in steps without inertia.
#[test]
fn issue_016_errors_of_stiff_cables_with_self_contact_are_stated_without_inertia() {
    let [all, covered, _] = errors_of_drawn(0..3, 2.0);
    assert!(all[0] >= 2, "{all:?}");
    assert!((0..4).all(|k| 3 * covered[k] >= 2 * all[k]), "{covered:?} of {all:?}");
}

#[test]
#[ignore = "minutes: cables drawn together slowly, each on four times as many segments, too"]
fn errors_of_many_cables_drawn_together() {
    let number = |name: &str, usual: u64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(usual);
    let [all, covered, _] = errors_of_drawn(number("FROM", 0)..number("TO", 40), number("EI", 2) as f64);
    assert!((0..3).all(|k| 10 * covered[k] >= 8 * all[k]), "{covered:?} of {all:?}");
}
