//! These laws hold for cables that slide over pulleys.

use super::measure::{FRAME_S, base, dead_load, reactions_n, settle, span, weight_n};
use cable_core::scene::{Motion, Scene, Support};
use cable_core::{Error, Model, Simulation};

/// Friction of the rough pulley.
const FRICTION: f64 = 0.3;

/// A span that hangs over a smooth eye.
fn over_eye() -> Scene {
    let mut scene = base();
    scene.cables[0].supports.insert(1, Support::pulley("eye", [5.0, 7.0]));
    scene
}

/// Difference of tension at the pulley, relative.
pub(crate) fn passed_on(model: Model) -> Result<f64, Error> {
    let answer = settle(&over_eye(), model)?;
    Ok(match answer.cables[0].supports.get(1).map(|p| (p.tension_before_n, p.tension_after_n)) {
        Some((Some(before), Some(after))) => (after - before).abs() / before,
        _ => f64::NAN,
    })
}

pub(crate) fn weight_not_held(model: Model) -> Result<f64, Error> {
    let weight = weight_n(&over_eye());
    Ok((reactions_n(&settle(&over_eye(), model)?)[1] + weight).abs() / weight)
}

/// A dead load over a rough eye, by a hand that draws it up in the first second and lets it down in
/// the second one.
fn drawn_load() -> Scene {
    let mut scene = span([0.0, 5.0], [2.0, 1.0]);
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m) = (8.0, 0.05);
    let motion = Motion { times_s: vec![0.0, 1.0, 2.0], points_m: vec![[2.0, 1.0], [2.0, 0.2], [2.0, 1.0]] };
    c.supports = vec![
        dead_load("load", [0.0, -100.0]),
        Support { friction: Some(FRICTION), ..Support::pulley("eye", [0.0, 5.0]) },
        Support { motion: Some(motion), ..Support::fixed("hand", [2.0, 1.0]) },
    ];
    scene
}

pub(crate) fn drawn(model: Model) -> Result<f64, Error> {
    Ok((capstan_ratio(model, 1.0)? - 1.0).abs())
}

pub(crate) fn let_back(model: Model) -> Result<f64, Error> {
    Ok((capstan_ratio(model, 2.0)? + 1.0).abs())
}

/// ln(T₂/T₁)/μφ of the rough eye after a slow motion until a time (s).
fn capstan_ratio(model: Model, until_s: f64) -> Result<f64, Error> {
    let mut simulation = Simulation::new(drawn_load(), model)?;
    simulation.settle()?;
    while simulation.time_s() < until_s - 1e-9 {
        simulation.step_quasi_static(0.1)?;
    }
    Ok(ratio_at_eye(&simulation))
}

/// ln(T₂/T₁)/μφ of the rough eye. The turn follows from what the eye feels,
/// R² = T₁² + T₂² − 2 T₁T₂ cos φ.
fn ratio_at_eye(simulation: &Simulation) -> f64 {
    simulation.answers()[0].supports.get(1).map_or(f64::NAN, |eye| {
        let [before, after] = [eye.tension_before_n, eye.tension_after_n].map(|t| t.unwrap_or(f64::NAN));
        let force = eye.reaction_x_n.hypot(eye.reaction_y_n);
        let cos = (before * before + after * after - force * force) / (2.0 * before * after);
        (after / before).ln() / (FRICTION * cos.acos())
    })
}

/// Mean of ln(T₂/T₁)/μφ of the rough eye while the hand draws the load up in motion.
pub(crate) fn drawn_in_motion(model: Model) -> Result<f64, Error> {
    let mut simulation = Simulation::new(drawn_load(), model)?;
    simulation.settle()?;
    let mut ratios = Vec::new();
    for frame in 0..40 {
        simulation.step(FRAME_S)?;
        if frame >= 20 {
            ratios.push(ratio_at_eye(&simulation));
        }
    }
    Ok((ratios.iter().sum::<f64>() / ratios.len() as f64 - 1.0).abs())
}
