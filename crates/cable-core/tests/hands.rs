//! These tests draw a support: a motion of the scene is followed exactly or refused, a hand is no
//! faster than it may be.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::math::Vec2;
use cable_core::model::Inertia;
use cable_core::scene::{Motion, Scene, Support, catalog};
use cable_core::solution::WarningKind;
use cable_core::{Model, Settings, Simulation, timeline};

/// A slack cable whose right end can be moved far.
fn slack() -> Scene {
    let mut scene = catalog::hanging_span();
    scene.obstacles.clear();
    let c = &mut scene.cables[0];
    (c.length_m, c.segments, c.bending_stiffness_n_m2) = (20.0, Some(40), 0.0);
    (c.service_tension_n, c.breaking_tension_n) = (1e9, 1e9);
    c.supports = vec![Support::fixed("a", [0.0, 3.0]), Support::fixed("b", [4.0, 3.0])];
    scene
}

/// The right end 10 m to the right within so many seconds, s.
fn moved(within_s: f64) -> Scene {
    let mut scene = slack();
    let times_s = vec![0.0, 0.05, 0.05 + within_s, 2.0];
    let points_m = vec![[4.0, 3.0], [4.0, 3.0], [14.0, 3.0], [14.0, 3.0]];
    scene.cables[0].supports[1].motion = Some(Motion { times_s, points_m });
    scene
}

fn held(sim: &Simulation) -> Vec<String> {
    sim.warnings().filter(|w| w.kind == WarningKind::SupportHeld).map(|w| w.to_string()).collect()
}

fn at(sim: &Simulation) -> Vec2 {
    let s = &sim.answers()[0].supports[1];
    Vec2::new(s.x_m, s.y_m)
}

/// 10, 38 and 188 m/s at their fastest.
#[test]
fn a_motion_of_a_scene_is_followed_exactly() {
    for model in [Model::Fem, Model::MassSpring] {
        for within_s in [1.9, 0.5, 0.1] {
            let scene = moved(within_s);
            let motion = scene.cables[0].supports[1].motion.clone().unwrap();
            let mut sim = Simulation::new(scene, model).unwrap();
            sim.settle().unwrap();
            for k in 1..=60 {
                sim.step(1.0 / 60.0).unwrap_or_else(|e| panic!("{model}, {within_s} s, step {k}: {e}"));
                let off = (at(&sim) - motion.at(sim.time_s()).0).norm();
                assert!(off < 1e-9, "{model}, {within_s} s, step {k}: {off} m off");
                assert_eq!(held(&sim), [""; 0], "{model}, {within_s} s");
            }
        }
    }
}

#[test]
fn a_motion_faster_than_any_model_follows_is_refused_with_its_speed() {
    for model in [Model::Fem, Model::MassSpring, Model::Auto] {
        let mut sim = Simulation::new(moved(0.05), model).unwrap();
        sim.settle().unwrap();
        let error = sim.step(1.0 / 60.0).unwrap_err().to_string();
        assert!(error.contains("`b`") && error.contains("375.0 m/s") && error.contains("300 m/s"), "{error}");
    }
    // Without inertia there is no speed.
    let mut slow = Simulation::new(moved(0.05), Model::Catenary).unwrap();
    slow.settle().unwrap();
    for _ in 0..10 {
        slow.step_quasi_static(0.05).unwrap();
    }
    assert!((at(&slow) - Vec2::new(14.0, 3.0)).norm() < 1e-9);
}

/// Drawn away by 3 m at once.
#[test]
fn a_hand_is_no_faster_than_it_may_be_and_what_lags_is_said() {
    for model in [Model::Fem, Model::MassSpring] {
        for fastest in [2.0, 10.0] {
            let settings = Settings { hand_speed_m_per_s: fastest, ..Settings::default() };
            let mut sim = Simulation::with_settings(slack(), model, settings).unwrap();
            sim.settle().unwrap();
            let hand = Vec2::new(4.0, 6.0);
            sim.drag_support(0, 1, hand);
            let (mut before, mut lagged) = (at(&sim), 0);
            for _ in 0..120 {
                sim.step(1.0 / 60.0).unwrap();
                let moved = (at(&sim) - before).norm();
                assert!(moved <= fastest / 60.0 * (1.0 + 1e-9), "{model}: {moved} m in a frame");
                let said = held(&sim);
                lagged += usize::from(!said.is_empty());
                assert!(said.iter().all(|w| w.contains("`b`") && w.contains("m behind")), "{said:?}");
                before = at(&sim);
            }
            // It lags for 3 m at that speed.
            let frames = 60.0 * 3.0 / fastest;
            assert!((lagged as f64 - frames).abs() < 3.0, "{model}, {fastest} m/s: said in {lagged} frames");
            assert!((at(&sim) - hand).norm() < 1e-3 && held(&sim).is_empty(), "{model}: {}", at(&sim));
        }
    }
    let wrong = Settings { hand_speed_m_per_s: 21.0, ..Settings::default() };
    assert!(Simulation::with_settings(slack(), Model::Fem, wrong).is_err());
}

/// The four steps of a frame said it four times, each with its own distance.
#[test]
fn issue_020_what_lags_in_the_steps_of_a_frame_is_said_once() {
    let hands = [Simulation::drag_support, Simulation::pull_support];
    for (model, hand) in [Model::Fem, Model::MassSpring].into_iter().flat_map(|m| hands.map(|h| (m, h))) {
        let mut sim = Simulation::new(slack(), model).unwrap();
        sim.settle().unwrap();
        hand(&mut sim, 0, 1, Vec2::new(4.0, 6.0));
        for _ in 0..30 {
            timeline::make_steps(&mut sim, Inertia::Dynamic, 4, None).unwrap();
            assert_eq!(held(&sim).len(), 1, "{model}: {:?}", held(&sim));
        }
    }
}

/// A hand: where its spring ends, its force on the cable, N.
fn hand(sim: &Simulation) -> (Vec2, Vec2, f64) {
    let hand = sim.answers()[0].supports[1].hand.expect("a hand holds it");
    (Vec2::new(hand.x_m, hand.y_m), Vec2::new(hand.force_x_n, hand.force_y_n), hand.stiffness_n_per_m)
}

/// Returns what the cable pulls with at its right end, N: the tension at the node before, and what
/// the element between weighs.
fn pull(sim: &Simulation) -> Vec2 {
    let nodes = &sim.answers()[0].nodes;
    let c = &sim.scene().cables[0];
    let [a, b] = [&nodes[nodes.len() - 2], &nodes[nodes.len() - 1]];
    let (way, part) = (a.at() - b.at(), b.arc_length_m - a.arc_length_m);
    way * (a.tension_n / way.norm()) - Vec2::new(0.0, part * c.linear_density_kg_per_m * 9.80665)
}

fn pulled(model: Model, settings: Settings) -> Simulation {
    let mut sim = Simulation::with_settings(slack(), model, settings).unwrap();
    sim.settle().unwrap();
    sim
}

fn steps(sim: &mut Simulation, seconds: f64) {
    for _ in 0..(seconds * 60.0) as usize {
        sim.step(1.0 / 60.0).unwrap();
    }
}

#[test]
fn a_hand_pulls_by_its_stiffness_and_how_far_it_is_ahead() {
    for model in [Model::Fem, Model::MassSpring] {
        for stiffness in [None, Some(300.0), Some(1e5)] {
            let mut sim = pulled(model, Settings { hand_stiffness_n_per_m: stiffness, ..Settings::default() });
            sim.pull_support(0, 1, Vec2::new(4.0, 3.0));
            // It takes hold with the force that held the support before.
            let before = pull(&sim);
            sim.step(1e-3).unwrap();
            let (_, first, k) = hand(&sim);
            assert!((first + before).norm() < 0.02 * first.norm(), "{model}: {first} for {before}");
            let weight = 9.80665 * sim.scene().cables[0].linear_density_kg_per_m * 20.0;
            assert!((k / stiffness.unwrap_or(weight / 0.2) - 1.0).abs() < 1e-9, "{k} N/m");
            sim.pull_support(0, 1, Vec2::new(6.0, 4.0));
            steps(&mut sim, 4.0);
            // The cable swings on, and half of an element with the support.
            let (mut forces, mut pulls, mut worst) = (Vec2::zeros(), Vec2::zeros(), 0.0);
            let damping = 0.5 * (k * sim.scene().cables[0].linear_density_kg_per_m * 20.0).sqrt();
            for _ in 0..480 {
                let from = at(&sim);
                sim.step(1.0 / 240.0).unwrap();
                let (end, force, _) = hand(&sim);
                assert!((end - Vec2::new(6.0, 4.0)).norm() < 1e-6, "{model}: the hand is at {end}");
                let spring = (end - at(&sim)) * k;
                // Sub-steps of an explicit model have velocities of their own: that of the last,
                // not of the whole step, is damped.
                let end = sim.answers()[0].nodes.last().unwrap();
                let speed = match model {
                    Model::Fem => (at(&sim) - from) * 240.0,
                    _ => Vec2::new(end.vx_m_per_s, end.vy_m_per_s),
                };
                let whole = spring - speed * damping;
                let off = (whole - force).norm() / force.norm();
                worst = if off > worst { off } else { worst };
                assert!(off < 1e-8, "{model}, {k} N/m: {whole} and {force} N");
                let reaction = &sim.answers()[0].supports[1];
                let on_support = Vec2::new(reaction.reaction_x_n, reaction.reaction_y_n);
                assert!((force + on_support).norm() < 1e-9 * force.norm(), "{model}: {force} and {on_support} N");
                (forces, pulls) = (forces + force, pulls + pull(&sim));
            }
            let off = (forces + pulls).norm() / forces.norm();
            println!("{model}, {k} N/m: {worst:.1e}, the cable pulls with all but {off:.4} of the hand's mean force");
            assert!(off < 0.01, "{model}, {k} N/m: {forces} {pulls}");
        }
    }
}

#[test]
fn a_hand_is_no_faster_than_it_may_be_and_a_stiff_one_is_followed_exactly() {
    for model in [Model::Fem, Model::MassSpring] {
        for fastest in [2.0, 5.0] {
            let settings =
                Settings { hand_speed_m_per_s: fastest, hand_stiffness_n_per_m: Some(1e8), ..Settings::default() };
            let mut sim = pulled(model, settings);
            sim.pull_support(0, 1, Vec2::new(4.0, 6.0));
            let (mut before, mut lagged) = (at(&sim), 0);
            for k in 0..120 {
                sim.step(1.0 / 60.0).unwrap();
                let (end, ..) = hand(&sim);
                assert!((end - at(&sim)).norm() < 1e-4, "{model}, step {k}: {} m behind", (end - at(&sim)).norm());
                assert!((end - before).norm() <= fastest / 60.0 * (1.0 + 1e-3) + 1e-4, "{model}, step {k}");
                lagged += usize::from(held(&sim).iter().any(|w| w.contains("m behind its target")));
                before = end;
            }
            let frames = 60.0 * 3.0 / fastest;
            assert!((lagged as f64 - frames).abs() < 3.0, "{model}, {fastest} m/s: said in {lagged} frames");
            assert!((at(&sim) - Vec2::new(4.0, 6.0)).norm() < 1e-4, "{model}: {}", at(&sim));
        }
    }
    for wrong in [0.0, f64::NAN, 1e10] {
        let settings = Settings { hand_stiffness_n_per_m: Some(wrong), ..Settings::default() };
        assert!(Simulation::with_settings(slack(), Model::Fem, settings).is_err(), "{wrong} N/m");
    }
}

/// Beyond the cable's length the hand pulls harder and harder, says so, and breaks it; what is let
/// go stays.
#[test]
fn a_hand_beyond_the_length_pulls_until_the_cable_breaks() {
    for model in [Model::Fem, Model::MassSpring] {
        let mut scene = slack();
        (scene.cables[0].service_tension_n, scene.cables[0].breaking_tension_n) = (1500.0, 2000.0);
        let mut sim = Simulation::with_settings(scene, model, Settings::default()).unwrap();
        sim.settle().unwrap();
        sim.pull_support(0, 1, Vec2::new(60.0, 3.0));
        let (mut most, mut said) = (0.0f64, false);
        for _ in 0..60 * 30 {
            sim.step(1.0 / 60.0).unwrap();
            let reach = (at(&sim) - Vec2::new(0.0, 3.0)).norm();
            if !sim.answers()[0].breaks.is_empty() {
                break;
            }
            assert!(reach < 20.1, "{model}: {reach} m away");
            let force = hand(&sim).1.norm();
            said |= force > 1000.0 && held(&sim).iter().any(|w| w.contains("hand that drags it, which pulls with"));
            most = most.max(force);
        }
        assert!(!sim.answers()[0].breaks.is_empty() && said, "{model}: {most} N");
        assert!((1800.0..2300.0).contains(&most), "{model}: {most} N");
    }
}

/// The work of the hand is the energy that the cable gains: it lifts an end by 2 m, slowly.
#[test]
fn a_hand_gives_the_energy_that_the_cable_gains() {
    for model in [Model::Fem, Model::MassSpring] {
        let mut sim = pulled(model, Settings { hand_speed_m_per_s: 0.2, ..Settings::default() });
        sim.pull_support(0, 1, Vec2::new(4.0, 3.0));
        steps(&mut sim, 4.0);
        let energy = |sim: &Simulation| sim.solution().energy.total_j();
        let (begin, mut given) = (energy(&sim), 0.0);
        sim.pull_support(0, 1, Vec2::new(4.0, 5.0));
        for _ in 0..60 * 14 {
            let (from, before) = (at(&sim), hand(&sim).1);
            sim.step(1.0 / 60.0).unwrap();
            given += (hand(&sim).1 + before).dot(&(at(&sim) - from)) * 0.5;
        }
        let gained = energy(&sim) - begin;
        println!("{model}: {given} J given, {gained} J gained");
        assert!(given > 100.0 && (gained / given - 1.0).abs() < 0.02, "{model}: {given} J given, {gained} J gained");
    }
}

#[test]
fn what_a_hand_lets_go_stays_where_it_is() {
    for model in [Model::Fem, Model::MassSpring] {
        let mut sim = pulled(model, Settings::default());
        assert_eq!(sim.let_go(0, 1), None);
        sim.pull_support(0, 1, Vec2::new(5.0, 4.0));
        steps(&mut sim, 0.5);
        let place = sim.let_go(0, 1).expect("it was held");
        steps(&mut sim, 1.0);
        assert!((at(&sim) - place).norm() < 1e-6, "{model}: {} of {place}", at(&sim));
        assert!(sim.answers()[0].supports[1].hand.is_none() && held(&sim).is_empty(), "{model}");
    }
}

/// A slack cable whose end is drawn away at `v` (m/s) until the chord is as long as the cable, and
/// stopped there: the greatest tension (N), and the greatest speed of any node (m/s).
fn snatched(v: f64, ea: f64, segments: usize) -> [f64; 2] {
    let mut scene = slack();
    let c = &mut scene.cables[0];
    (c.axial_stiffness_n, c.segments) = (ea, Some(segments));
    let (begin, way) = (0.1, 16.0);
    let times_s = vec![0.0, begin, begin + way / v, 60.0];
    c.supports[1].motion = Some(Motion { times_s, points_m: vec![[4.0, 3.0], [4.0, 3.0], [20.0, 3.0], [20.0, 3.0]] });
    let mut sim = Simulation::new(scene, Model::Fem).unwrap();
    sim.settle().unwrap();
    let [mut most, mut fastest] = [0.0_f64; 2];
    for _ in 0..((begin + way / v + 1.0) * 240.0) as usize {
        sim.step(1.0 / 240.0).unwrap_or_else(|e| panic!("{v} m/s, EA {ea}: {e}"));
        let answer = &sim.answers()[0];
        most = most.max(answer.peaks_at(sim.time_s()).greatest.tension_n);
        fastest = answer.nodes.iter().map(|n| n.vx_m_per_s.hypot(n.vy_m_per_s)).fold(fastest, f64::max);
    }
    [most, fastest]
}

/// A wave that stops a part of a cable which comes at a speed u raises the tension by u √(EA ρ),
/// and by twice that where a fixed end throws it back (K. F. Graff, Wave Motion in Elastic Solids,
/// Clarendon Press, 1975, section 2.4). A cable that straightens is faster across than the hand
/// that draws it, so u is the greatest speed of any of its nodes.
#[test]
fn extreme_hands_pull_no_harder_than_impact_theory() {
    let rho = slack().cables[0].linear_density_kg_per_m;
    for (ea, v) in [(1e6, 5.0), (1e6, 20.0), (1e8, 5.0), (1e8, 20.0)] {
        let mut pulls = Vec::new();
        for segments in [20, 40, 80] {
            let [most, u] = snatched(v, ea, segments);
            pulls.push(most);
            let bound = 2.0 * u * (ea * rho).sqrt();
            let told =
                format!("EA {ea:.0e} N, {v} m/s, {segments} elements: {most:.0} N, {u:.1} m/s, theory {bound:.0} N");
            println!("{told}");
            assert!(most < bound, "{told}");
        }
        // Of 20 elements each is too long for the whip of the loose end: they have a sixth less
        // than 80.
        assert!((pulls[2] / pulls[1] - 1.0).abs() < 0.1, "{pulls:.0?} N on three meshes");
    }
}
