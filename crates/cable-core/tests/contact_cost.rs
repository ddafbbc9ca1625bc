//! The work of scenes with contact is pinned: Newton iterations and sub-steps at rest, and in half
//! a second of motion.

#![allow(clippy::unwrap_used)] // a failing test is meant to panic

use cable_core::math::vec2;
use cable_core::scene::catalog;
use cable_core::{Model, Simulation, Vec2};

/// Frames of half a second.
const FRAMES: usize = 30;
const FRAME_S: f64 = 1.0 / 60.0;
/// Way of the last support in motion, m.
const DRAWN: Vec2 = Vec2::new(0.15, 0.1);

/// Iterations of `settle`, and of all frames of motion after it, on catalogue scenes with contact.
/// Fewer is better: change the number then. More means a worse start, prediction of contacts or
/// line search: find out which before changing it.
const ITERATIONS: [(&str, Model, usize, usize); 19] = [
    ("slack-to-floor", Model::Spans, 6, 0),
    ("slack-to-floor", Model::Fem, 0, 397),
    ("slack-to-floor", Model::MassSpring, 51, 9420),
    ("over-beam", Model::Spans, 8, 0),
    ("over-beam", Model::Fem, 2, 603),
    ("over-beam", Model::MassSpring, 22, 10680),
    ("round-post", Model::Spans, 5, 0),
    ("round-post", Model::Fem, 4, 732),
    ("round-post", Model::MassSpring, 38, 11670),
    ("draped-slipping", Model::Spans, 3, 0),
    ("draped-slipping", Model::Fem, 2, 399),
    ("draped-slipping", Model::MassSpring, 56, 13110),
    ("floor-drag", Model::Spans, 10, 0),
    ("floor-drag", Model::Fem, 1, 705),
    ("floor-drag", Model::MassSpring, 119, 16230),
    ("rubble-drop", Model::Fem, 0, 439),
    ("rubble-drop", Model::MassSpring, 1, 14130),
    ("plan-posts", Model::Fem, 62, 1552),
    ("plan-posts", Model::MassSpring, 5, 11280),
];

#[test]
fn iterations_in_contact_stay_as_they_are() {
    let scenes =
        ["slack-to-floor", "over-beam", "round-post", "draped-slipping", "floor-drag", "rubble-drop", "plan-posts"];
    let mut found = Vec::new();
    for (id, scene) in catalog::all().into_iter().filter(|(id, _)| scenes.contains(id)) {
        for model in [Model::Spans, Model::Fem, Model::MassSpring] {
            let Ok(mut simulation) = Simulation::new(scene.clone(), model) else { continue };
            let Ok(answer) = simulation.settle() else { continue };
            // A hand draws the last support away, so that something moves in every scene.
            if let Some(at) = scene.cables[0].supports.last().and_then(|support| support.at_m) {
                simulation.drag_support(0, scene.cables[0].supports.len() - 1, vec2(at) + DRAWN);
            }
            let mut moving = 0;
            for _ in 0..if model.capabilities().inertia { FRAMES } else { 0 } {
                simulation.step(FRAME_S).unwrap();
                moving += simulation.solution().cost.iterations;
            }
            found.push((id, model, answer.cost.iterations, moving));
        }
    }
    assert_eq!(found, ITERATIONS, "{found:#?}");
}
