//! These laws hold for a cable that lies on a smooth pipe.

use super::measure::{larger, reactions_n, settle, span, weight_n};
use cable_core::math::Vec2;
use cable_core::scene::{Obstacle, Scene, Shape};
use cable_core::{Error, Model};

/// Middle of the pipe, m.
pub(crate) const PIPE_AT: [f64; 2] = [0.0, 5.0];
/// Radius of the pipe, m.
pub(crate) const PIPE_RADIUS_M: f64 = 1.0;

/// A cable draped over a pipe, its ends held below at two heights.
pub(crate) fn draped(friction: f64) -> Scene {
    let mut scene = span([-2.5, 2.0], [2.5, 2.5]);
    scene.cables[0].length_m = 10.0;
    scene.cables[0].route_m = vec![[-2.5, 2.0], [-1.2, 5.5], [0.0, 6.5], [1.2, 5.5], [2.5, 2.5]];
    let shape = Shape::Circle { center_m: PIPE_AT, radius_m: PIPE_RADIUS_M };
    scene.obstacles = vec![Obstacle { name: "pipe".to_owned(), shape, friction: Some(friction) }];
    scene
}

/// Returns how deep the cable is in the pipe, relative to its length.
pub(crate) fn penetration(model: Model) -> Result<f64, Error> {
    let scene = draped(0.0);
    let (answer, cable) = (settle(&scene, model)?, &scene.cables[0]);
    let middle = Vec2::new(PIPE_AT[0], PIPE_AT[1]);
    let closest = PIPE_RADIUS_M + 0.5 * cable.diameter_m;
    let depth = answer.cables[0].nodes.iter().map(|n| closest - (n.at() - middle).norm());
    Ok(depth.fold(0.0, larger) / cable.length_m)
}

/// Returns what the forces of supports and pipe leave of the weight.
pub(crate) fn weight_not_held(model: Model) -> Result<f64, Error> {
    let scene = draped(0.0);
    let (answer, weight) = (settle(&scene, model)?, weight_n(&scene));
    let [x, y] = reactions_n(&answer);
    let contacts = answer.cables[0].contacts.iter();
    let [up_x, up_y] = contacts.fold([0.0; 2], |sum, c| [sum[0] + c.force_n[0], sum[1] + c.force_n[1]]);
    Ok((up_x - x).hypot(up_y - y - weight) / weight)
}

/// Without friction dT = w sin α ds and dy = (1 + T/EA) sin α ds, so that T + T²/2EA − w y does not
/// change along the cable: its greatest difference, relative to the greatest tension.
pub(crate) fn bernoulli(model: Model) -> Result<f64, Error> {
    let scene = draped(0.0);
    let (answer, cable) = (settle(&scene, model)?, &scene.cables[0]);
    let w = weight_n(&scene) / cable.length_m;
    let head = |k: usize| {
        let n = &answer.cables[0].nodes[k];
        n.tension_n * (1.0 + 0.5 * n.tension_n / cable.axial_stiffness_n) - w * n.y_m
    };
    let first = head(0);
    let off = (0..answer.cables[0].nodes.len()).map(|k| (head(k) - first).abs());
    Ok(off.fold(0.0, larger) / answer.max_tension().tension_n)
}

/// Friction of a smooth pipe, relative to what it pushes with; not a number if it touches nothing.
pub(crate) fn not_pushed(model: Model) -> Result<f64, Error> {
    let answer = settle(&draped(0.0), model)?;
    let contacts = &answer.cables[0].contacts;
    let rubs = contacts.iter().map(|c| if c.normal_n > 0.0 { c.friction_n.abs() / c.normal_n } else { f64::INFINITY });
    Ok(rubs.reduce(larger).unwrap_or(f64::NAN))
}
