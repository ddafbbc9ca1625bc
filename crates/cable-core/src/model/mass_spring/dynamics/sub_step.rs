//! A sub-step computes forces and contacts and moves the nodes; it allocates nothing once the
//! buffers have grown.

use crate::error::{FailureCause, SolveError};
use crate::math::smaller;
use crate::model::Settings;
use crate::model::mass_spring::dynamics::chain_state::ChainState;
use crate::model::mass_spring::dynamics::pulley_sliding::slide;
use crate::model::mass_spring::dynamics::runaway_guard::RunawayGuard;
use crate::model::mass_spring::dynamics::supports::HandSettings;
use crate::model::mass_spring::dynamics::{SubStep, floor_friction, hands, impacts};
use crate::model::mass_spring::forces::{nodal, tension};
use crate::model::mass_spring::mesh::{Mesh, RelaxationMemory, lifted_wheel, release_pulleys};
use crate::model::tension_gauge::TensionGauge;
use crate::problem::Problem;

/// Advances by `dt_s` in equal sub-steps below the stability limit, shorter where motion is
/// fast.
pub(in crate::model::mass_spring) fn integrate(
    chain: &mut ChainState,
    settings: &Settings,
    dt_s: f64,
    gauge: &mut TensionGauge,
) -> Result<(), SolveError> {
    let (begin, end) = (chain.clock.time_s, chain.clock.time_s + dt_s);
    release_pulleys(&mut chain.mesh, begin);
    chain.remesh();
    let hand_settings = HandSettings::of(settings);
    let tuning = chain.mesh.tuning.sub_step;
    let mut stable = stable_step(&chain.mesh);
    let mut count = 0;
    let mut left = dt_s;
    let mut shortest = f64::INFINITY;
    let mut guard = RunawayGuard::new(&chain.mesh.problem, begin);
    // Material only slides over pulleys.
    let points = if chain.mesh.wheels.pulleys.is_empty() && gauge.knows(&chain.mesh.arc_length) {
        GaugePoints::Nodes
    } else {
        GaugePoints::Others
    };
    while left > 0.0 {
        let fastest = guard.limit(&mut chain.mesh, &mut chain.drives, chain.clock.time_s);
        let travel = tuning.max_travel_radii * chain.mesh.problem.radius / fastest;
        let limit = if !chain.mesh.problem.world.is_empty() && travel < stable { travel } else { stable };
        let h = until_release(&chain.mesh.problem, chain.clock.time_s, left / (left / limit).ceil());
        let failed = chain.mesh.non_finite(chain.clock.time_s);
        if let Some(e) = failed.or_else(|| lifted_wheel(&chain.mesh, chain.clock.time_s)) {
            return Err(e);
        }
        if h < tuning.min_stable_fraction * if stable < dt_s { stable } else { dt_s } {
            return Err(runaway(chain, h, fastest));
        }
        left -= h;
        chain.clock.time_s = end - left;
        sub_step(chain, &mut guard, hand_settings, gauge, points, h);
        if !chain.mesh.wheels.pulleys.is_empty() {
            chain.mesh.update_pulley_elements();
            chain.remesh();
            stable = stable_step(&chain.mesh);
        }
        count += 1;
        shortest = if h < shortest { h } else { shortest };
    }
    guard.limit(&mut chain.mesh, &mut chain.drives, chain.clock.time_s);
    chain.report.warnings.extend(guard.warnings(&chain.mesh.problem.cable.name));
    chain.report.cost.iterations = count;
    chain.report.cost.inner_step_s = shortest;
    chain.report.cost.residual_n = 0.0;
    chain.mesh.non_finite(chain.clock.time_s).map_or(Ok(()), Err)
}

/// Takes a sub-step of `h` (s) to the present time of the clock: forces, velocities, impulses at
/// contacts, places.
fn sub_step(
    chain: &mut ChainState,
    guard: &mut RunawayGuard,
    hand_settings: HandSettings,
    gauge: &mut TensionGauge,
    points: GaugePoints,
    h: f64,
) {
    release_pulleys(&mut chain.mesh, chain.clock.time_s - h);
    let (mesh, account) = (&mut chain.mesh, &mut chain.report.account);
    mesh.follow_edit(h);
    chain.drives.move_nodes(mesh, &chain.clock, hand_settings.max_speed_m_per_s, account, h);
    hands::follow(&mut chain.drives, mesh, hand_settings, h);
    nodal::update(mesh, chain.clock.time_s, 2.0 * chain.clock.behind_s);
    record(mesh, gauge, points, chain.clock.time_s);
    // Velocities go with the middle of a sub-step: from that of the last one to that of
    // this. A motion that begins has half a kick; with a whole one all falls g h t/2 too
    // far, an error of first order.
    let kick = chain.clock.behind_s + 0.5 * h;
    chain.clock.behind_s = 0.5 * h;
    let step = SubStep { length_s: h, kick_s: kick };
    hands::pull(&chain.drives, mesh, account, step);
    slide(mesh, step);
    for i in 0..mesh.position.len() {
        if !mesh.supported[i] {
            mesh.velocity[i] += mesh.force[i] * (kick / mesh.mass[i]);
            guard.cut_speed(mesh, chain.clock.time_s, i);
        }
    }
    account.add_kick(mesh, chain.clock.time_s, kick);
    chain.drives.correct_released(mesh, account, kick - 0.5 * h);
    floor_friction::floor_friction(mesh, account, kick);
    impacts::apply(&mut chain.contacts, mesh, account, h);
    for i in 0..mesh.position.len() {
        mesh.position[i] += mesh.velocity[i] * h;
    }
}

/// The error of a motion whose stable sub-step (s) has become too short.
fn runaway(chain: &ChainState, h: f64, fastest: f64) -> SolveError {
    let mesh = &chain.mesh;
    let node = mesh.velocity.iter().position(|v| v.norm() >= fastest).unwrap_or(0);
    SolveError::StepFailed {
        model: crate::Model::MassSpring,
        time_s: chain.clock.time_s,
        dt_s: h,
        residual_n: mesh.force[node].norm(),
        place: mesh.problem.place(mesh.arc_length[node], mesh.position[node], chain.clock.time_s),
        cause: FailureCause::RunawaySpeed { speed_m_per_s: fastest },
    }
}

/// The longest stable sub-step, s. By Gershgorin's circles a node of mass m between springs k₁,
/// k₂ swings no faster than ω² = 2(k₁ + k₂)/m, and bending adds 16 EI/(m l³) (its row is 1, −4,
/// 6, −4, 1). With k = mω² of all branches that have not relaxed, and c that of the viscous parts
/// times their time constants, it is stable up to h² k + 2 h c = 4 m.
fn stable_step(mesh: &Mesh) -> f64 {
    let [ea, ei] = [&mesh.spring_memory, &mesh.bend_memory].map(RelaxationMemory::unrelaxed_stiffness);
    // Before the next choice of a sub-step it may have become as stiff as its scene says.
    let ei = ei * mesh.bending_change.map_or(1.0, |change| change.greatest_growth());
    let [stretching, bending] = [&mesh.spring_memory, &mesh.bend_memory].map(RelaxationMemory::viscosity);
    let mut stable = f64::INFINITY;
    for n in 0..mesh.position.len() {
        let spring = |e: Option<usize>| e.and_then(|e| mesh.rest_length.get(e)).map_or(0.0, |l| 1.0 / l);
        let (before, after) = (spring(n.checked_sub(1)), spring(Some(n)));
        let tighter = if before > after { before } else { after };
        let row =
            |stretching: f64, bending: f64| 2.0 * stretching * (before + after) + 16.0 * bending * tighter.powi(3);
        let (k, c) = (row(ea, ei), row(stretching, bending));
        let mass = mesh.wheels.at(n).map_or(mesh.mass[n], |k| k.mass);
        stable = smaller(stable, ((c * c + 4.0 * k * mass).sqrt() - c) / k);
    }
    mesh.tuning.sub_step.stable_fraction * stable
}

/// Length of a sub-step of `h` (s) that ends where a support lets go in it, s.
fn until_release(problem: &Problem, time_s: f64, h: f64) -> f64 {
    let releases = problem.supports.iter().filter_map(|s| s.release_between(time_s, time_s + h));
    releases.map(|at| at - time_s).fold(h, smaller)
}

/// Points at which a gauge takes tensions.
#[derive(Clone, Copy, PartialEq, Eq)]
enum GaugePoints {
    /// The nodes of the mesh, without pulleys.
    Nodes,
    /// Other arc lengths.
    Others,
}

/// Records the tensions of now.
fn record(mesh: &Mesh, gauge: &mut TensionGauge, points: GaugePoints, time_s: f64) {
    if points == GaugePoints::Nodes {
        let last = mesh.rest_length.len();
        let ends = [tension::at_node(mesh, 0), tension::at_node(mesh, last)];
        if let [first, inner @ .., end] = gauge.room(time_s) {
            (*first, *end) = (ends[0], ends[1]);
            for (t, pair) in inner.iter_mut().zip(mesh.tension.windows(2)) {
                *t = 0.5 * (pair[0] + pair[1]);
            }
        }
    } else {
        gauge.note(time_s, &mesh.arc_length, |i| tension::at_node(mesh, i));
    }
    gauge.keep();
}
