//! These laws hold for cables that break.

use super::measure::{FRAME_S, span};
use cable_core::scene::{Motion, Scene};
use cable_core::solution::WarningKind;
use cable_core::{Error, Model, Simulation};

/// The time at which the cable is as long as its breaking strain says, s.
const BREAKS_AT_S: f64 = 2.0;

/// A cable of 10 m that is drawn evenly from 10 to 12 m in 4 s, and breaks at 11 m: T = EA (d/L −
/// 1), d = 10 + 2 (10u³ − 15u⁴ + 6u⁵), which is half way at half time.
fn drawn() -> Scene {
    let mut scene = span([0.0, 0.0], [10.0, 0.0]);
    // Models without inertia need something that says where a slack cable is.
    scene.environment.gravity_m_per_s2 = 1e-3;
    let c = &mut scene.cables[0];
    (c.length_m, c.linear_density_kg_per_m, c.damping_ratio) = (10.0, 1.0, 0.0);
    (c.service_tension_n, c.breaking_tension_n, c.segments) = (5e3, 1e4, Some(40));
    let points_m = vec![[10.0, 0.0], [12.0, 0.0]];
    c.supports[1].motion = Some(Motion { times_s: vec![0.0, 4.0], points_m });
    scene
}

/// The time at which a run of it breaks, s.
fn break_time_s(
    simulation: &mut Simulation,
    step: impl Fn(&mut Simulation) -> Result<(), Error>,
) -> Result<f64, Error> {
    simulation.settle()?;
    while simulation.time_s() < 2.0 * BREAKS_AT_S {
        step(simulation)?;
        let broken = simulation.warnings().find(|w| w.kind == WarningKind::Broken);
        if let Some(time_s) = broken.and_then(|w| w.since_s) {
            return Ok(time_s);
        }
    }
    Ok(f64::NAN)
}

pub(crate) fn slow_break_time(model: Model) -> Result<f64, Error> {
    let mut simulation = Simulation::new(drawn(), model)?;
    let time_s = break_time_s(&mut simulation, |s| Ok(s.step_quasi_static(1.0 / 15.0)?))?;
    Ok((time_s / BREAKS_AT_S - 1.0).abs())
}

/// In motion it breaks when the mean over the breaking time is there, half of that later.
pub(crate) fn break_time(model: Model) -> Result<f64, Error> {
    let mut simulation = Simulation::new(drawn(), model)?;
    let late_s = 0.5 * simulation.scene().cables[0].breaking_time_s;
    let time_s = break_time_s(&mut simulation, |s| Ok(s.step(FRAME_S)?))?;
    Ok((time_s / (BREAKS_AT_S + late_s) - 1.0).abs())
}

pub(crate) fn lost_length(model: Model) -> Result<f64, Error> {
    let mut simulation = Simulation::new(drawn(), model)?;
    break_time_s(&mut simulation, |s| Ok(s.step(FRAME_S)?))?;
    let answer = &simulation.answers()[0];
    let lengths = answer.pieces().filter_map(|p| Some(p.last()?.arc_length_m - p.first()?.arc_length_m));
    let length = drawn().cables[0].length_m;
    Ok((lengths.sum::<f64>() / length - 1.0).abs())
}
