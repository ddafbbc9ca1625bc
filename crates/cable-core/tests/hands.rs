//! What draws a support: a motion of the scene is followed exactly or refused, a hand is no faster than it may be.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_core::math::Vec2;
use cable_core::scene::{Motion, Scene, Support, catalog};
use cable_core::solution::WarningKind;
use cable_core::{Model, Settings, Simulation};

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
    sim.warnings().filter(|w| w.kind == WarningKind::SupportHeld).map(|w| w.message.clone()).collect()
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
