//! This analysis finds the places to which the end of a cable can be taken, with the tension there
//! and on the way there and back.
//!
//! | room | content |
//! |---|---|
//! | `line.rs` | a robot is moved along its ground |
//! | `area.rs` | an end is taken through the free plane; `area/exploration.rs` visits the places |
//!
//! The motions are quasi-static, with friction: a robot moves along its ground ([`mod@line`]), or a
//! hand or a crane moves an end through the free plane ([`mod@area`]). From each place it returns
//! to the start, because a cable that was drawn round an edge on the way out may be held there on
//! the way back. The drive is not limited: the question is what the cable would have to bear.

pub mod area;
pub mod line;

use crate::any_error::Error;
use crate::error::{SolveError, Unsupported, UnsupportedReach};
use crate::model::Model;
use crate::scene::{Cable, Scene, SupportKind};
use crate::simulation::Simulation;
use crate::solution::Solution;

/// Time of a step, s. Without inertia it only determines the lag of a support behind its target.
/// Smaller: the lag is a fraction of the step, and a taut cable shows a tenth of a millimetre;
/// larger: no effect.
const STEP_S: f64 = 0.5;

/// Multiple of its breaking tension beyond which a cable gets no farther.
const UNREACHABLE_FACTOR: f64 = 2.0;

/// The scene frozen at its start: nothing moves by itself, releases the cable or breaks. Supports
/// and robot are at the places of an answer, if there is one.
fn frozen_scene(scene: &Scene, now: Option<&Solution>) -> Scene {
    let mut still = scene.clone();
    let environment = &mut still.environment;
    if let Some(&wind) = environment.winds_n_per_m.first() {
        environment.wind_n_per_m = wind;
    }
    environment.winds_n_per_m.clear();
    environment.wind_times_s.clear();
    for load in &mut still.loads {
        load.force_n = load.forces_n.first().copied().or(load.force_n);
        load.forces_n.clear();
        load.times_s.clear();
    }
    for cable in &mut still.cables {
        for support in &mut cable.supports {
            if let Some(&from) = support.motion.as_ref().and_then(|m| m.points_m.first()) {
                support.at_m = Some(from);
            }
            support.motion = None;
            support.release_s = None;
            support.force_n = support.forces_n.first().copied().or(support.force_n);
            support.forces_n.clear();
            support.times_s.clear();
        }
    }
    if let Some(robot) = &mut still.robot {
        robot.path.clear();
        if let Some(now) = now.and_then(|n| n.robot) {
            robot.at_m = [now.x_m, now.y_m];
        }
    }
    for (cable, now) in still.cables.iter_mut().zip(now.iter().flat_map(|n| &n.cables)) {
        for (support, now) in cable.supports.iter_mut().zip(&now.supports) {
            if support.at_m.is_some() && support.kind != SupportKind::Pulley {
                support.at_m = Some([now.x_m, now.y_m]);
            }
        }
    }
    still
}

/// Lays the cables: at rest in the shape of an answer, or else as in the scene.
fn place_cables(simulation: &mut Simulation, now: Option<&Solution>) -> Result<(), Error> {
    if let Some(now) = now {
        if now.cables.iter().any(|c| !c.breaks.is_empty()) {
            return Err(unsupported(UnsupportedReach::BrokenCable));
        }
        simulation.resume(&at_rest(now))?;
    }
    simulation.settle()?;
    Ok(())
}

/// An answer in which nothing moves.
fn at_rest(answer: &Solution) -> Solution {
    let mut still = answer.clone();
    for node in still.cables.iter_mut().flat_map(|c| &mut c.nodes) {
        (node.vx_m_per_s, node.vy_m_per_s) = (0.0, 0.0);
    }
    still
}

/// The least of a quantity of some cables.
fn least(scene: &Scene, cables: &[usize], of: fn(&Cable) -> f64) -> f64 {
    let values = cables.iter().filter_map(|k| scene.cables.get(*k)).map(of);
    values.fold(f64::INFINITY, |a, b| if b < a { b } else { a })
}

fn unsupported(question: UnsupportedReach) -> Error {
    Error::from(SolveError::Unsupported { model: Model::Auto, feature: Unsupported::Reach(question) })
}
