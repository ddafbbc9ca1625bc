//! These laws hold for cables that lie on something rough.

use super::contact::{PIPE_AT, draped};
use super::measure::{dead_load, larger, settle, span, weight_n};
use cable_core::math::{Vec2, vec2};
use cable_core::scene::{Motion, Obstacle, Scene, Shape, Support};
use cable_core::solution::Node;
use cable_core::{Error, Model, Simulation};

/// Friction of everything rough here.
const FRICTION: f64 = 0.3;
/// Turn of the cable round the post, rad.
const TURN: f64 = 2.0;
/// Dead force on the end that nobody moves, N.
const LOAD_N: f64 = 100.0;

/// Returns how far a force of the pipe on the cable is outside of the friction cone, relative to
/// the greatest one. Its normal is known: from the middle of the pipe to the cable.
pub(crate) fn outside_cone(model: Model) -> Result<f64, Error> {
    let answer = settle(&draped(FRICTION), model)?;
    let cable = &answer.cables[0];
    let samples = cable.contacts.iter().flat_map(|c| &c.samples);
    let (mut worst, mut greatest) = (0.0, 0.0);
    for sample in samples {
        let normal = (place(&cable.nodes, sample.arc_length_m) - vec2(PIPE_AT)).normalize();
        let force = vec2(sample.force_n);
        let (push, rub) = (force.dot(&normal), force.perp(&normal).abs());
        worst = larger(worst, rub - FRICTION * push);
        greatest = larger(greatest, force.norm());
    }
    Ok(worst / greatest)
}

/// Returns where a point of the cable is, m.
fn place(nodes: &[Node], arc_length_m: f64) -> Vec2 {
    let after = nodes.partition_point(|n| n.arc_length_m < arc_length_m).clamp(1, nodes.len() - 1);
    let (a, b) = (&nodes[after - 1], &nodes[after]);
    a.at() + (b.at() - a.at()) * ((arc_length_m - a.arc_length_m) / (b.arc_length_m - a.arc_length_m))
}

/// A weightless cable round a rough post: a dead load at its start, a hand at its end that draws it
/// along itself in the first second and lets it back in the second one.
fn round_post() -> Scene {
    let mut scene = span([0.0, 0.0], [0.0, 0.0]);
    scene.environment.gravity_m_per_s2 = 0.0;
    let c = &mut scene.cables[0];
    let (post, tail) = (0.5, 2.0);
    let r = post + 0.5 * c.diameter_m;
    let on_circle = |angle: f64, out: f64| Vec2::new(angle.sin(), angle.cos()) * (r * out);
    let along = |angle: f64| Vec2::new(angle.cos(), -angle.sin());
    let point = |v: Vec2| [v.x, v.y];
    let hand = |out: f64| point(on_circle(TURN, 1.0) + along(TURN) * (tail + out));
    let mut route = vec![point(on_circle(0.0, 1.0) - along(0.0) * tail)];
    route.extend((0..=20).map(|k| point(on_circle(TURN * f64::from(k) / 20.0, 1.001))));
    route.push(hand(0.0));
    c.length_m = 2.0 * tail + r * TURN;
    c.route_m = route;
    let motion = Motion { times_s: vec![0.0, 1.0, 2.0], points_m: vec![hand(0.0), hand(0.3), hand(0.0)] };
    c.supports = vec![
        dead_load("load", point(-along(0.0) * LOAD_N)),
        Support { motion: Some(motion), ..Support::fixed("hand", hand(0.0)) },
    ];
    let shape = Shape::Circle { center_m: [0.0, 0.0], radius_m: post };
    scene.obstacles = vec![Obstacle { name: "post".to_owned(), shape, friction: Some(FRICTION) }];
    scene
}

pub(crate) fn drawn_round_post(model: Model) -> Result<f64, Error> {
    let tension = tension_at_hand(&round_post(), model, 1.0)?;
    Ok(((tension / LOAD_N).ln() / (FRICTION * TURN) - 1.0).abs())
}

pub(crate) fn let_back_round_post(model: Model) -> Result<f64, Error> {
    let tension = tension_at_hand(&round_post(), model, 2.0)?;
    Ok(((tension / LOAD_N).ln() / (FRICTION * TURN) + 1.0).abs())
}

/// A cable that a hand draws over a rough level floor against a dead load on its other end.
pub(crate) fn drawn_over_floor(model: Model) -> Result<f64, Error> {
    let mut scene = span([0.0, 0.0], [0.0, 0.0]);
    let c = &mut scene.cables[0];
    let height = 0.5 * c.diameter_m;
    let hand = |x: f64| [x, height];
    let motion = Motion { times_s: vec![0.0, 1.0], points_m: vec![hand(12.0), hand(12.5)] };
    c.route_m = vec![hand(0.0), hand(12.0)];
    c.supports =
        vec![dead_load("load", [-LOAD_N, 0.0]), Support { motion: Some(motion), ..Support::fixed("hand", hand(12.0)) }];
    let shape = Shape::Terrain { points_m: vec![[-20.0, 0.0], [30.0, 0.0]] };
    scene.obstacles = vec![Obstacle { name: "floor".to_owned(), shape, friction: Some(FRICTION) }];
    let rub = FRICTION * weight_n(&scene);
    Ok(((tension_at_hand(&scene, model, 1.0)? - LOAD_N) / rub - 1.0).abs())
}

/// Tension at the end after a slow motion until a time (s), N.
fn tension_at_hand(scene: &Scene, model: Model, until_s: f64) -> Result<f64, Error> {
    let mut simulation = Simulation::new(scene.clone(), model)?;
    simulation.settle()?;
    while simulation.time_s() < until_s - 1e-9 {
        simulation.step_quasi_static(0.05)?;
    }
    Ok(simulation.answers()[0].nodes.last().map_or(f64::NAN, |n| n.tension_n))
}
