//! A bar that becomes slack ends its impulse: this module takes what is left of it out of the
//! history.
//!
//! BDF2 gives a third of the impulse of each step in later steps, and more of it where steps grow.
//! From a bar that becomes slack that is a pull without a bar: a span let go at one end had 1.12
//! times the energy that was put in, and its end flew twice as fast as the cable. What is forgotten
//! is the same at both ends of the bar, so the momentum is kept.
//!
//! The history stays as long as the cable touches something: then bars become slack in nearly every
//! step, and impacts take such energy off ([`super::plastic_impact`]).

use crate::linalg::{TridiagonalRow, solve_tridiagonal};
use crate::math::{Vec2, larger};
use crate::model::fem::state::{CableState, kinetic_energy};
use crate::model::fem::system::{BarBranch, PlainBar, bar_energy};
use crate::model::fem::time::Weights;

/// Remembers the impulse of each bar in a step with these weights, as the integrator does.
pub(in crate::model::fem) fn remember_impulses(cable: &mut CableState, weights: Weights) {
    let bars = cable.mesh.rest_length.len();
    let impulses = cable.mesh.remembered_impulses.of_all(bars, 1);
    for (impulse, tension) in impulses.iter_mut().zip(&cable.answers.gauged.bars) {
        *impulse = *impulse * weights.past + if *tension > 0.0 { tension / weights.rate } else { 0.0 };
    }
}

/// Takes the impulses of bars that are slack at the end of a step with these weights (positions
/// `end`, m) out of its history, if they give the cable energy that the bars did not hold; returns
/// whether they do.
pub(in crate::model::fem) fn forget_slack_impulses(cable: &mut CableState, weights: Weights, end: &[Vec2]) -> bool {
    let (bars, step_before) = (cable.mesh.rest_length.len(), cable.motion.history_s());
    if !cable.mesh.is_flexible() || step_before == 0.0 {
        cable.mesh.remembered_impulses.clear();
        return false;
    }
    if !cable.meshing.was_contact_free {
        return false;
    }
    let mut memory = std::mem::take(&mut cable.mesh.remembered_impulses);
    let impulses = memory.of_all(bars, 1);
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    // Energy beyond what the bars held at the start of the step, J, and those bars.
    let (mut excess, mut slack) = (0.0, Vec::new());
    for e in 0..bars {
        let slides = mesh.sliding[e].is_some() || mesh.sliding[e + 1].is_some();
        if !(impulses[e] > 0.0) || slides || mesh.is_break(e) {
            continue;
        }
        let [from, to] = [x, end].map(|x| (x[e + 1] - x[e]).norm());
        if PlainBar::of(mesh, &cable.input, e).branch(to) == BarBranch::Slack {
            let given = weights.past * impulses[e] * weights.rate * (from - to);
            excess += larger(given - bar_energy::stretch_energy(mesh, [from, mesh.rest_length[e]]), 0.0);
            slack.push(e);
        }
    }
    let ends = !slack.is_empty() && excess > mesh.tuning.step.least_recoil * energy(cable);
    // The impulse that each node forgets, N s.
    let mut forgotten = vec![Vec2::zeros(); if ends { bars + 1 } else { 0 }];
    for e in slack.into_iter().filter(|_| ends) {
        let along = (x[e + 1] - x[e]).try_normalize(0.0).unwrap_or_default();
        let impulse = along * std::mem::take(&mut impulses[e]);
        forgotten[e] += impulse;
        forgotten[e + 1] -= impulse;
    }
    cable.mesh.remembered_impulses = memory;
    if forgotten.is_empty() {
        return false;
    }
    for (k, impulse) in forgotten.iter_mut().enumerate() {
        if !cable.mesh.is_free(k) {
            // The support at the other end of a bar forgets what the free node does.
            cable.motion.account.forget_support(-*impulse);
            *impulse = Vec2::zeros();
        }
    }
    let changes = velocities_of(cable, forgotten);
    let m = &mut cable.motion;
    for (k, change) in changes.into_iter().enumerate().filter(|(_, change)| *change != Vec2::zeros()) {
        m.previous_velocities[k] += change;
        m.previous_positions[k] -= change * (0.5 * step_before);
    }
    true
}

/// The energy of motion and stretch of a cable, J, and of a motion so slow that it does not count.
fn energy(cable: &CableState) -> f64 {
    let (mesh, x) = (&cable.mesh, &cable.motion.positions);
    let stretched = |e: usize| bar_energy::stretch_energy(mesh, [(x[e + 1] - x[e]).norm(), mesh.rest_length[e]]);
    let speed = mesh.tuning.step.slow_recoil_m_per_s;
    let slow = 0.5 * cable.problem.linear_density * cable.problem.length * speed * speed;
    kinetic_energy(cable) + (0..mesh.rest_length.len()).map(stretched).sum::<f64>() + slow
}

/// The velocities (m/s) that impulses (N s) give the free nodes of a mesh.
fn velocities_of(cable: &CableState, mut impulses: Vec<Vec2>) -> Vec<Vec2> {
    let (mesh, coupling) = (&cable.mesh, &cable.mesh.spread.coupling);
    let mass = |k: usize| mesh.mass_with(&cable.problem, &cable.meshing.support_node, k);
    if coupling.is_empty() {
        for (k, impulse) in impulses.iter_mut().enumerate().filter(|(_, impulse)| **impulse != Vec2::zeros()) {
            *impulse /= mass(k);
        }
        return impulses;
    }
    let between = |e: Option<usize>| e.and_then(|e| coupling.get(e)).map_or(0.0, |l| cable.problem.linear_density * l);
    let row = |k: usize| match mesh.is_free(k) {
        true => {
            let [before, after] = [between(k.checked_sub(1)), between(Some(k))];
            [before, mass(k) - before - after, after]
        }
        false => [0.0, 1.0, 0.0],
    };
    let rows: Vec<TridiagonalRow> = (0..impulses.len()).map(row).collect();
    for axis in 0..2 {
        let mut along: Vec<f64> = impulses.iter().map(|impulse| impulse[axis]).collect();
        if solve_tridiagonal(&rows, &mut along, Some) {
            impulses.iter_mut().zip(along).for_each(|(impulse, velocity)| impulse[axis] = velocity);
        }
    }
    impulses
}
