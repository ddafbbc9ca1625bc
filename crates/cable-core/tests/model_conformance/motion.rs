//! These laws hold for cables whose masses accelerate.

use super::measure::{FRAME_S, base, difference, larger, weight_n};
use cable_core::math::Vec2;
use cable_core::scene::{Scene, catalog};
use cable_core::solution::{Energy, Node, Solution};
use cable_core::{Error, Model, Simulation};

/// Runs a scene from rest, and looks at every frame.
fn run(scene: Scene, model: Model, frames: usize, mut look: impl FnMut(&Solution)) -> Result<(), Error> {
    let mut simulation = Simulation::new(scene, model)?;
    look(&simulation.settle()?);
    for _ in 0..frames {
        simulation.step(FRAME_S)?;
        look(&simulation.solution());
    }
    Ok(())
}

/// The base span, both ends of which (or the last alone) are let go after 0.1 s.
fn let_go(supports: std::ops::Range<usize>) -> Scene {
    let mut scene = base();
    scene.cables[0].damping_ratio = 0.0;
    for support in &mut scene.cables[0].supports[supports] {
        support.release_s = Some(0.1);
    }
    scene
}

/// Returns how far a node of a cable at rest goes in a quarter of a second, relative to the length.
pub(crate) fn stirred(model: Model) -> Result<f64, Error> {
    let mut worst = 0.0;
    run(base(), model, 15, |answer| {
        let ways = answer.cables[0].nodes.iter().map(|n| n.displacement_m[0].hypot(n.displacement_m[1]));
        worst = ways.fold(worst, larger);
    })?;
    Ok(worst / base().cables[0].length_m)
}

pub(crate) fn not_repeatable(model: Model) -> Result<f64, Error> {
    let mut answers = [Vec::new(), Vec::new()];
    for list in &mut answers {
        run(catalog::swinging_span(), model, 30, |answer| list.push(answer.clone()))?;
    }
    Ok(difference(&answers[0], &answers[1]))
}

/// Mean velocity of the cable, m/s.
fn mean_velocity(nodes: &[Node]) -> Vec2 {
    let velocity = |n: &Node| Vec2::new(n.vx_m_per_s, n.vy_m_per_s);
    let (mut sum, mut length) = (Vec2::zeros(), 0.0);
    for pair in nodes.windows(2) {
        let part = pair[1].arc_length_m - pair[0].arc_length_m;
        sum += (velocity(&pair[0]) + velocity(&pair[1])) * (0.5 * part);
        length += part;
    }
    sum / length
}

/// Whatever goes on inside a cable that nothing holds, its centre of mass falls freely: the
/// difference of its mean acceleration from g, relative.
pub(crate) fn free_fall(model: Model) -> Result<f64, Error> {
    let mut velocities = Vec::new();
    run(let_go(0..2), model, 30, |a| velocities.push((a.time_s, mean_velocity(&a.cables[0].nodes))))?;
    let ((t0, v0), (t1, v1)) = (velocities[12], velocities[30]);
    let g = base().environment.gravity_m_per_s2;
    Ok(((v1 - v0) / (t1 - t0) + Vec2::new(0.0, g)).norm() / g)
}

/// Returns what of the change of momentum in a step no impulse explains, relative to what fell
/// meanwhile.
pub(crate) fn momentum_from_nowhere(model: Model) -> Result<f64, Error> {
    let scene = let_go(1..2);
    let fallen = weight_n(&scene) * FRAME_S;
    let (mut worst, mut counted) = (0.0, false);
    run(scene, model, 30, |answer| {
        if let Some(account) = answer.cables[0].momentum {
            counted = true;
            let off = [0, 1].map(|k| {
                let given: f64 = account.impulses_n_s().iter().map(|i| i[k]).sum();
                account.before_kg_m_per_s[k] + given - account.after_kg_m_per_s[k]
            });
            worst = larger(worst, off[0].hypot(off[1]) / fallen);
        }
    })?;
    Ok(if counted { worst } else { f64::NAN })
}

/// Returns what an undamped cable has more of than at the start, relative to its weight falling by
/// its length.
pub(crate) fn energy_from_nowhere(model: Model) -> Result<f64, Error> {
    let scene = let_go(1..2);
    let scale = weight_n(&scene) * scene.cables[0].length_m;
    let whole = |e: Energy| e.kinetic_j + e.gravity_j + e.stretch_j + e.bending_j;
    let (mut start, mut worst) = (None, 0.0);
    run(scene, model, 45, |answer| {
        let now = whole(answer.energy);
        worst = larger(worst, now - *start.get_or_insert(now));
    })?;
    Ok(worst / scale)
}
