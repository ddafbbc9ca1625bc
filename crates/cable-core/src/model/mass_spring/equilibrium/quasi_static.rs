//! Quasi-static steps: the supports move a little, the cable comes to rest there, and friction
//! remembers.

use crate::error::SolveError;
use crate::math::Vec2;
use crate::model::mass_spring::dynamics::ChainState;
use crate::model::mass_spring::equilibrium::contact_energy::Anchors;
use crate::model::mass_spring::equilibrium::static_rest::find_equilibrium;
use crate::numerics::{HalvedSteps, MAX_HALVINGS};

/// Part of a step that is taken with the step before it.
const JOINED_FRACTION: f64 = 0.5;

/// Follows the supports through equilibria for `dt_s`.
pub(in crate::model::mass_spring) fn quasi_static_step(chain: &mut ChainState, dt_s: f64) -> Result<(), SolveError> {
    let (begin, end) = (chain.clock.time_s, chain.clock.time_s + dt_s);
    let from = chain.mesh.position.clone();
    let nodes: Vec<(usize, usize)> = chain.mesh.support_node.iter().copied().enumerate().collect();
    let parts = first_parts(chain, dt_s);
    let targets = chain.drives.targets.clone();
    let starts: Vec<Vec2> = nodes.iter().map(|&(_, n)| from[n]).collect();
    let mut steps = HalvedSteps::new(1.0, 1.0 / parts, MAX_HALVINGS, JOINED_FRACTION);
    let (mut done, mut iterations) = (0.0, 0);
    while let Some(next) = steps.next(done) {
        let before = chain.clone();
        chain.clock.time_s = begin + (end - begin) * next;
        for (k, target) in targets.iter().enumerate() {
            // A hand goes straight.
            chain.drives.targets[k] = target.map(|t| starts[k] + (t - starts[k]) * next);
        }
        chain.mesh.approach_edit((next - done) / (1.0 - done));
        match find_equilibrium(chain, Anchors::Kept) {
            Ok(()) => {
                iterations += chain.report.cost.iterations;
                done = next;
            }
            Err(e) => {
                *chain = before;
                if !steps.halve() {
                    return Err(e);
                }
            }
        }
    }
    chain.report.cost.iterations = iterations;
    // Friction on a supported node acts against its velocity.
    for &(k, node) in &nodes {
        let now = chain.mesh.support_node[k];
        if chain.mesh.supported[now] {
            chain.mesh.velocity[now] = (chain.mesh.position[now] - from[node]) / dt_s;
        }
    }
    chain.drives.targets = targets;
    Ok(())
}

/// Number of equal parts in which a step is first tried.
fn first_parts(chain: &ChainState, dt_s: f64) -> f64 {
    let (mesh, tuning) = (&chain.mesh, &chain.mesh.tuning.quasi_static);
    if !mesh.can_touch() && mesh.wheels.pulleys.is_empty() {
        return 1.0;
    }
    let within =
        if mesh.problem.world.is_empty() { mesh.even_length } else { mesh.even_length.min(mesh.problem.radius) };
    (support_path_m(chain, dt_s) / (tuning.max_path_lengths * within)).ceil().clamp(1.0, tuning.max_parts)
}

/// Length of the paths of all supports in a step, m: that of a motion within the step may be longer
/// than the distance.
fn support_path_m(chain: &ChainState, dt_s: f64) -> f64 {
    let samples = chain.mesh.tuning.quasi_static.path_samples;
    let mut path = 0.0;
    for (k, &node) in chain.mesh.support_node.iter().enumerate() {
        let support = &chain.mesh.problem.supports[k];
        let mut last = chain.mesh.position[node];
        for j in 1..=samples {
            let time = chain.clock.time_s + dt_s * f64::from(j) / f64::from(samples);
            let Some((at, _)) = support.position_at(time) else { break };
            let at = chain.drives.targets[k].unwrap_or(at);
            path += (at - last).norm();
            last = at;
        }
    }
    path
}
