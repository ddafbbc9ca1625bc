//! `auto` changes its model where a scene gets a property, however little of it; its answer changes
//! there by no more than the accuracy asked for, or says by how much it may be wrong.

#![allow(clippy::expect_used, clippy::unwrap_used)] // a failing test is meant to panic

use cable_core::scene::{Obstacle, Shape, Support, View, catalog};
use cable_core::{Model, Scene, Settings, Simulation, Solution};

/// Hardly any of a property.
const HARDLY_ANY: f64 = 1e-9;

fn settings() -> Settings {
    Settings { histories: false, ..Settings::default() }
}

/// The rest of a scene, on whatever mesh the accuracy asks for.
fn rest(mut scene: Scene, model: Model) -> Solution {
    scene.cables.iter_mut().for_each(|c| c.segments = None);
    Simulation::with_settings(scene, model, settings()).unwrap().settle().unwrap()
}

/// The greatest difference of two answers in a support's force and in the greatest tension, over
/// the greatest tension.
fn apart(a: &Solution, b: &Solution) -> f64 {
    let most = a.max_tension().tension_n;
    let mut worst = (most - b.max_tension().tension_n).abs();
    for (a, b) in a.cables.iter().zip(&b.cables) {
        assert_eq!(a.supports.len(), b.supports.len());
        for (a, b) in a.supports.iter().zip(&b.supports) {
            worst = worst.max((a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
        }
    }
    worst / most
}

/// The error that an answer states.
fn said(answer: &Solution) -> f64 {
    answer.cables.iter().filter_map(|c| c.error_estimate).fold(0.0, f64::max)
}

/// The fault of a change from one answer to another; None: it has none.
fn jump(name: &str, a: &Solution, b: &Solution) -> Option<String> {
    let (apart, said) = (apart(a, b), said(a) + said(b));
    println!("{name}: {} to {}: {apart:.1e} apart, {said:.1e} said", a.model, b.model);
    let allowed = said.max(settings().tolerance);
    (!(apart <= allowed)).then(|| format!("{name}: {} to {}: {apart:.1e} and {said:.1e} said", a.model, b.model))
}

/// Cables of the catalogue in the air, on a floor and over a beam, without bending stiffness.
fn flexible() -> Vec<(&'static str, Scene)> {
    let scenes = [
        ("hanging-span", catalog::hanging_span()),
        ("steep-span", catalog::steep_span()),
        ("near-taut", catalog::near_taut()),
        ("slack-to-floor", catalog::slack_to_floor()),
        ("over-beam", catalog::over_beam()),
    ];
    let flexible = |(id, mut scene): (&'static str, Scene)| {
        scene.cables.iter_mut().for_each(|c| c.bending_stiffness_n_m2 = 0.0);
        (id, scene)
    };
    scenes.map(flexible).into()
}

/// The answers to scenes without and with hardly any of a property, by different models.
fn switched(what: &str, scenes: Vec<(&'static str, Scene)>, change: fn(&mut Scene)) {
    let mut jumps = Vec::new();
    let mut switches = 0;
    for (id, scene) in scenes {
        let mut changed = scene.clone();
        change(&mut changed);
        assert_ne!(scene, changed, "{id}");
        let [a, b] = [scene, changed].map(|scene| rest(scene, Model::Auto));
        switches += usize::from(a.model != b.model);
        jumps.extend(jump(&format!("{what}, {id}"), &a, &b));
    }
    println!("{what}: {switches} switches");
    assert!(jumps.is_empty(), "{}", jumps.join("\n"));
    assert!(switches > 0 || what.contains("always by fem"), "{what}: nothing was switched");
}

#[test]
fn bending_stiffness() {
    switched("EI", flexible(), |s| s.cables[0].bending_stiffness_n_m2 = HARDLY_ANY);
}

#[test]
fn contact_with_itself() {
    switched("self-contact", flexible(), |s| s.cables[0].self_contact = true);
}

#[test]
fn friction_of_a_wheel() {
    let mut scene = catalog::pulley_waypoints();
    scene.cables[0].bending_stiffness_n_m2 = 0.0;
    for support in &mut scene.cables[0].supports {
        support.friction = support.friction.map(|_| 0.0);
    }
    switched("wheel friction", vec![("pulley-waypoints", scene)], |s| {
        let wheels = s.cables[0].supports.iter_mut().filter(|s| s.friction.is_some());
        wheels.for_each(|s| s.friction = Some(HARDLY_ANY));
    });
}

/// A plan view is always answered by `fem`. The cable is taut: a slack one lies there in any
/// shape.
#[test]
fn friction_of_the_floor_from_above() {
    let mut scene = catalog::plan_posts();
    let cable = &mut scene.cables[0];
    (cable.bending_stiffness_n_m2, cable.friction, cable.length_m) = (0.0, 0.0, 9.2);
    for obstacle in &mut scene.obstacles {
        obstacle.friction = Some(0.0);
    }
    assert_eq!(scene.view, View::Plan);
    switched("floor friction, always by fem", vec![("plan-posts", scene)], |s| s.cables[0].friction = HARDLY_ANY);
}

#[test]
fn an_obstacle_far_away() {
    let mut wheels = catalog::pulley_waypoints();
    wheels.cables[0].bending_stiffness_n_m2 = 0.0;
    let mut scenes = flexible();
    scenes.push(("pulley-waypoints", wheels));
    scenes.retain(|(_, scene)| scene.obstacles.is_empty());
    switched("far obstacle", scenes, |s| {
        let shape = Shape::Circle { center_m: [1e3, -1e3], radius_m: 1.0 };
        s.obstacles.push(Obstacle { name: "far".into(), shape, friction: Some(0.4) });
        // Of a cable that may stretch without end nothing is out of reach.
        s.cables.iter_mut().for_each(|cable| cable.breaking_tension_n = 1e12);
    });
}

/// Steps of a span that is lowered.
const STEPS: usize = 40;

/// A span whose supports are so high above a floor without friction, on which nothing remembers
/// how it came there.
fn above(height_m: f64) -> Scene {
    let supports = vec![Support::fixed("a", [0.0, height_m]), Support::fixed("b", [8.0, height_m])];
    let mut scene = catalog::cable_alone([10.5, 0.5, 1e6], supports);
    let shape = Shape::Terrain { points_m: vec![[-5.0, 0.0], [13.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".into(), shape, friction: Some(0.0) }];
    scene
}

/// From above the floor, where it hangs free, to where most of it lies: the answer of the model
/// in use is the same as that of the model that comes next or before.
#[test]
fn a_span_lowered_on_to_a_floor() {
    let height = |k: usize| 4.0 - 3.8 * k as f64 / STEPS as f64;
    let answers: Vec<Solution> = (0..=STEPS).map(|k| rest(above(height(k)), Model::Auto)).collect();
    let mut jumps = Vec::new();
    let mut touches = 0;
    for (k, answer) in answers.iter().enumerate() {
        touches += usize::from(!answer.cables[0].contacts.is_empty());
        let next = answers.get(k + 1).map_or(answer.model, |next| next.model);
        for other in [Model::Spans, Model::Fem, next].into_iter().filter(|m| *m != answer.model) {
            let name = format!("at {:.3} m", height(k));
            jumps.extend(jump(&name, answer, &rest(above(height(k)), other)));
        }
        // From step to step it changes by a like amount: no more than the step before and after,
        // doubled, and what is asked.
        if let Some([before, after]) = k.checked_sub(1).and_then(|j| Some([answers.get(j)?, answers.get(k + 1)?])) {
            let [to, on] = [apart(before, answer), apart(answer, after)];
            if !(on <= 2.0 * to + settings().tolerance) && touches > 3 {
                jumps.push(format!("at {:.3} m: changes by {to:.1e} and then by {on:.1e}", height(k)));
            }
        }
    }
    assert!(touches > 10 && touches < STEPS, "{touches} of its rests touch the floor");
    assert!(jumps.is_empty(), "{}", jumps.join("\n"));
}
