//! The preview moves stiff cables in real time, with compliant constraints in fixed small sub-steps
//! instead of stable explicit ones.
//!
//! A spring is the constraint C = length − l₀ with compliance l₀/EA (M. Macklin, M. Müller, N.
//! Chentanez, "XPBD: position-based simulation of compliant constrained dynamics", Motion in Games,
//! 2016), one iteration in each of many sub-steps (M. Macklin et al., "Small steps in physics
//! simulation", Symposium on Computer Animation, 2019). Unlike the papers the constraints of a
//! chain are not taken one after the other but solved together (`constraint_solve`). It is a
//! picture, not a measurement: implicit in time, so fast motion is damped, and contacts act a
//! sub-step late.
//!
//! Directions are those of the predicted position x* = 2xₙ − xₙ₋₁, so transverse vibrations of a
//! taut cable, of frequency ω, obey xₙ₊₁ = (1 − ω²h²) x*, whose roots have modulus √(1 − ω²h²) up
//! to ωh = 1 and leave the unit circle at ω²h² = 4/3: taut cables take shorter sub-steps, still
//! longer than explicit ones by √(EA/T).

use crate::error::SolveError;
use crate::math::{Vec2, larger};
use crate::model::Settings;
use crate::model::mass_spring::dynamics::{
    ChainState, HandSettings, RunawayGuard, SupportDrives, floor_friction, hands, impacts,
};
use crate::model::mass_spring::forces::{nodal, pulley, tension};
use crate::model::mass_spring::mesh::{Mesh, lifted_wheel, release_pulleys};
use crate::model::mass_spring::preview_choice::FRAME_S;
use crate::model::mass_spring::xpbd::constraint_solve::ConstraintSolver;
use crate::model::settings::Stepping;
use crate::model::tension_gauge::TensionGauge;
use crate::solution::{Warning, WarningCause};

/// Part of a step by which a time may exceed a whole number of steps: round-off. Smaller: one more
/// step of nearly no length; larger: steps longer than the limit.
const STEP_COUNT_ROUNDING: f64 = 1e-9;

/// Advances by `dt_s` in sub-steps.
pub(in crate::model::mass_spring) fn preview(
    chain: &mut ChainState,
    settings: &Settings,
    dt_s: f64,
    gauge: &mut TensionGauge,
) -> Result<(), SolveError> {
    let end = chain.clock.time_s + dt_s;
    let tuning = chain.mesh.tuning.preview;
    let shortest = tuning.max_sub_step_s * tuning.min_sub_step_fraction;
    let mut solver = ConstraintSolver::default();
    let mut guard = RunawayGuard::new(&chain.mesh.problem, chain.clock.time_s);
    let (mut left, mut count, mut longest) = (dt_s, 0, 0.0);
    // Impulses at rest are those of a second, as the answer reads them.
    let mut last = if chain.report.cost.inner_step_s > 0.0 { chain.report.cost.inner_step_s } else { 1.0 };
    while left > 0.0 {
        let stable = (tuning.max_swing / max_transverse_frequency_squared(&chain.mesh)).sqrt();
        let limit = if stable < tuning.max_sub_step_s { stable } else { tuning.max_sub_step_s };
        if let Some(e) = lifted_wheel(&chain.mesh, chain.clock.time_s) {
            return Err(e);
        }
        let parts = (left / if limit > shortest { limit } else { shortest } - STEP_COUNT_ROUNDING).ceil().max(1.0);
        let h = left / parts;
        left = if parts > 1.0 { left - h } else { 0.0 };
        chain.clock.time_s = end - left;
        preview_step(chain, settings, [h, last], &mut solver);
        last = h;
        gauge.note(chain.clock.time_s, &chain.mesh.arc_length, |i| tension::at_node_inside(&chain.mesh, i));
        gauge.keep();
        guard.limit(&mut chain.mesh, &mut chain.drives, chain.clock.time_s);
        let mesh = &mut chain.mesh;
        for (x, v) in mesh.position.iter_mut().zip(&mesh.velocity) {
            *x += v * h;
        }
        if !mesh.wheels.pulleys.is_empty() {
            mesh.update_pulley_elements();
            pulley::update_all(mesh, chain.clock.time_s);
        }
        if let Some(e) = mesh.non_finite(chain.clock.time_s) {
            return Err(e);
        }
        count += 1;
        longest = if h > longest { h } else { longest };
    }
    nodal::update_from_tensions(&mut chain.mesh, chain.clock.time_s);
    chain.clock.behind_s = 0.0;
    chain.report.cost.iterations = count;
    chain.report.cost.inner_step_s = longest;
    chain.report.cost.residual_n = 0.0;
    chain.report.warnings.extend(guard.warnings(&chain.mesh.problem.cable.name));
    warn_of_preview(chain, settings, longest);
    Ok(())
}

/// Sets the velocities of a sub-step of `h` (s) after one of `last` (s).
///
/// Springs feel the contacts of the sub-step before, and both are solved in turns until they agree.
/// A contact that only followed the springs would stretch them: a node of a fine mesh at a corner
/// is drawn in by more than an element in one sub-step, and put back.
fn preview_step(chain: &mut ChainState, settings: &Settings, [h, last]: [f64; 2], solver: &mut ConstraintSolver) {
    if !chain.mesh.wheels.pulleys.is_empty() {
        release_pulleys(&mut chain.mesh, chain.clock.time_s - h);
        chain.remesh();
    }
    let (mesh, account) = (&mut chain.mesh, &mut chain.report.account);
    let hand_settings = HandSettings::of(settings);
    mesh.follow_edit(h);
    chain.drives.move_nodes(mesh, &chain.clock, hand_settings.max_speed_m_per_s, account, h);
    hands::follow(&mut chain.drives, mesh, hand_settings, h);
    nodal::set_loads(mesh, chain.clock.time_s);
    predict(mesh, chain.clock.time_s, h, solver);
    let hand_nodes = predict_hands(&chain.drives, mesh, h, solver);
    let per_step = h.recip();
    solver.free.clone_from(&solver.position);
    impacts::carry_over(&mut chain.contacts, h, last);
    let wheels: Vec<_> = mesh.wheels.pulleys.iter().map(|p| (mesh.arc_length[p.node], p.sliding_speed)).collect();
    for pass in 1..=mesh.tuning.preview.max_contact_passes {
        solver.position.clone_from(&solver.free);
        impacts::displace(&chain.contacts, mesh, &mut solver.position, h);
        for (p, (arc_length, sliding_speed)) in mesh.wheels.pulleys.iter_mut().zip(&wheels) {
            (mesh.arc_length[p.node], p.sliding_speed) = (*arc_length, *sliding_speed);
        }
        solver.solve(mesh, h);
        let moved = mesh.velocity.iter_mut().zip(&mesh.position).zip(&solver.position).zip(&mesh.supported);
        for (((v, x), to), is_supported) in moved {
            if !is_supported {
                *v = (to - x) * per_step;
            }
        }
        for HeldNode { node, velocity } in &hand_nodes {
            let v = (solver.position[*node] - mesh.position[*node]) * per_step;
            mesh.support_acceleration[*node] = (v - velocity) * per_step;
            mesh.velocity[*node] = v;
        }
        floor_friction::floor_friction(mesh, account, h);
        if mesh.problem.world.is_empty() {
            break;
        }
        if pass == 1 {
            impacts::find(&mut chain.contacts, mesh, h);
        }
        let change = (0..mesh.tuning.impact.passes)
            .map(|_| impacts::resolve(&mut chain.contacts, mesh, account, h))
            .fold(0.0, larger);
        let strain = mesh.tension.iter().copied().fold(0.0, larger) / mesh.problem.axial_stiffness;
        if change <= mesh.tuning.preview.contact_strain_fraction * strain * mesh.even_length {
            break;
        }
    }
}

/// Warns that stiffness made the step a preview, with its longest sub-step `h` (s).
fn warn_of_preview(chain: &mut ChainState, settings: &Settings, h: f64) {
    if settings.stepping != Stepping::Auto {
        return;
    }
    let name = &chain.mesh.problem.cable.name;
    let stable = FRAME_S / chain.mesh.tuning.sub_step.max_per_frame;
    chain.report.warnings.push(Warning::new(WarningCause::StiffPreview, name, 0.0, [h, stable]));
}

/// ω² of the fastest swing across the cable, 1/s², by Gershgorin's circles: 2(T_b/l_b +
/// T_a/l_a)/m at a node.
fn max_transverse_frequency_squared(mesh: &Mesh) -> f64 {
    let (mut fastest, mut before) = (0.0, 0.0);
    let is_supported = mesh.supported.iter().zip(&mesh.mass);
    let after = mesh.tension.iter().zip(&mesh.rest_length).map(|(tension, rest)| tension / rest).chain([0.0]);
    for ((is_supported, mass), after) in is_supported.zip(after) {
        let square = 2.0 * (before + after) / mass;
        if square > fastest && !is_supported {
            fastest = square;
        }
        before = after;
    }
    fastest
}

/// Predicts nodes and material on pulleys without springs in a sub-step of `h` (s).
fn predict(mesh: &mut Mesh, time_s: f64, h: f64, solver: &mut ConstraintSolver) {
    let count = mesh.position.len();
    solver.position.resize(count, Vec2::zeros());
    solver.inverse_mass.resize(count, 0.0);
    let nodes = mesh.position.iter().zip(&mut mesh.velocity).zip(&mesh.force).zip(&mesh.mass).zip(&mesh.supported);
    for (((((x, v), f), mass), is_supported), (to, inverse)) in
        nodes.zip(solver.position.iter_mut().zip(&mut solver.inverse_mass))
    {
        *inverse = if *is_supported { 0.0 } else { mass.recip() };
        if !is_supported {
            *v += f * (h * *inverse);
        }
        *to = x + *v * h;
    }
    let body = mesh.problem.body_force(time_s);
    for k in 0..mesh.wheels.pulleys.len() {
        let i = mesh.wheels.pulleys[k].node;
        let weight = body.dot(&(mesh.element(i - 1).middle - mesh.element(i).middle));
        let p = &mut mesh.wheels.pulleys[k];
        p.sliding_speed += weight * h / p.mass;
    }
}

/// A node that a hand holds, and its velocity before a sub-step, m/s.
struct HeldNode {
    node: usize,
    velocity: Vec2,
}

/// Predicts nodes that hands hold without the springs of the cable in a preview's sub-step of `h`
/// (s).
fn predict_hands(drives: &SupportDrives, mesh: &Mesh, h: f64, solver: &mut ConstraintSolver) -> Vec<HeldNode> {
    let mut found = Vec::new();
    for (hand, &node) in drives.hands.iter().zip(&mesh.support_node) {
        let Some(hand) = hand else { continue };
        let (mass, before) = (mesh.mass[node], mesh.velocity[node]);
        let (stiffness, at) = hand.pull(h, mesh.position[node]);
        let push = mesh.force[node] + (at - mesh.position[node]) * stiffness;
        let heavier = mass + stiffness * h * h;
        solver.position[node] = mesh.position[node] + (before * mass + push * h) * (h / heavier);
        solver.inverse_mass[node] = heavier.recip();
        found.push(HeldNode { node, velocity: before });
    }
    found
}
