//! This module moves, adds and removes marks: the places on a round at which the material of
//! sliding nodes is counted.

use crate::math::smaller;
use crate::model::Inertia;
use crate::model::fem::mesh::{BarEnd, SlidingNode, rotate};
use crate::model::fem::remesh::edit::{insert, remove};
use crate::model::fem::results::keep_answer;
use crate::model::fem::state::{CableState, attribute_to};

/// Smallest change of a mark that is made, m, so that a cable at rest stays the same to the bit.
const MARK_TOLERANCE: f64 = 1e-9;

/// Logarithm of the ratio of two tensions below which the next term of the series (x³/720) is
/// round-off.
const SERIES_LOG_RATIO: f64 = 1e-4;

/// Moves the mark of a round with one node to the place where the arc has the same total strain as
/// under evenly mobilised friction: its middle if there is no friction. In motion the material
/// between the old and the new mark comes from the bar that the mark leaves, whose strain does not
/// change. Returns whether any mark moved.
pub(in crate::model::fem) fn move_marks(cable: &mut CableState, inertia: Inertia) -> bool {
    let mut moved = false;
    for k in 1..cable.mesh.nodes().saturating_sub(1) {
        let Some(node) = cable.mesh.sliding[k] else { continue };
        let shared = |j: usize| cable.mesh.sliding[j].is_some_and(|s| s.shares_round(&node));
        if !(node.end.radius > 0.0) || shared(k - 1) || shared(k + 1) {
            continue;
        }
        let x = &cable.motion.positions;
        let paths = [cable.mesh.path(k - 1, x), cable.mesh.path(k, x)];
        let tensions = [0, 1].map(|j| cable.mesh.tension(k - 1 + j, paths[j].length));
        let whole = paths[0].arcs[1] + paths[1].arcs[0];
        let shift = part_before(tensions) * whole - paths[0].arcs[1];
        if !(shift.abs() * node.end.radius > MARK_TOLERANCE) {
            continue;
        }
        let bars = if inertia == Inertia::QuasiStatic {
            k - 1..k + 1
        } else if shift > 0.0 {
            k..k + 1
        } else {
            k - 1..k
        };
        let sum = |of: &dyn Fn(usize) -> f64| bars.clone().map(of).sum::<f64>();
        let stretch = sum(&|e| paths[e + 1 - k].length) / sum(&|e| cable.mesh.rest_length[e]);
        let material = shift * node.end.radius / (stretch * cable.mesh.thermal_stretch);
        let room = cable.mesh.tuning.remesh.removed_distance * cable.mesh.tuning.remesh.removed_distance * cable.even();
        let s = &cable.mesh.arc_length;
        if s[k] + material < s[k - 1] + room || s[k] + material > s[k + 1] - room {
            continue;
        }
        keep_answer(cable);
        moved = true;
        attribute_to(cable, node.slide_over, |d| turn_mark(d, k, shift, material));
    }
    moved
}

/// Turns the mark of a node by an angle (rad), past an arc length `material` (m).
fn turn_mark(cable: &mut CableState, k: usize, shift: f64, material: f64) {
    let Some(node) = cable.mesh.sliding[k] else { return };
    let turned =
        SlidingNode { end: BarEnd { mark: rotate(node.end.mark, node.end.sense * shift), ..node.end }, ..node };
    cable.mesh.sliding[k] = Some(turned);
    cable.mesh.arc_length[k] += material;
    cable.motion.previous_arc_length[k] += material;
    let more = cable.mesh.thermal_stretch * material;
    for (e, more) in [(k - 1, more), (k, -more)] {
        let length = cable.mesh.rest_length[e] + more;
        // An excess over the material stays as long as it was.
        match cable.mesh.has_excess() {
            true => cable.mesh.set_rest_length(e, length),
            false => cable.mesh.rest_length[e] = length,
        }
    }
    cable.motion.positions[k] = turned.position();
    cable.motion.previous_positions[k] = cable.motion.positions[k];
}

/// Adds marks on long arcs and removes those that the tangent has passed; returns whether it
/// changed any.
pub(in crate::model::fem) fn adapt_marks(cable: &mut CableState, inertia: Inertia) -> bool {
    let even = cable.even();
    let mut changed = false;
    let mut k = 1;
    let mut changes = 0;
    while k + 1 < cable.mesh.nodes() && changes < cable.mesh.tuning.remesh.max_changes {
        let Some(node) = cable.mesh.sliding[k].filter(|s| s.end.radius > 0.0) else {
            k += 1;
            continue;
        };
        let shared = [k - 1, k + 1].map(|j| cable.mesh.sliding[j].is_some_and(|s| s.shares_round(&node)));
        let x = &cable.motion.positions;
        let arcs = [cable.mesh.path(k - 1, x).arcs[1], cable.mesh.path(k, x).arcs[0]];
        let tuned = &cable.mesh.tuning.remesh;
        // On a large round the marks of a cable at rest are as far apart as nodes elsewhere,
        // because friction is resolved only from mark to mark.
        let spacing = if inertia == Inertia::QuasiStatic {
            smaller(0.5 * tuned.max_marked_arc_rad, even / node.end.radius)
        } else {
            0.5 * tuned.max_marked_arc_rad
        };
        let is_long = |arc: f64| arc > 2.0 * spacing && arc * node.end.radius > tuned.one_mark_bars * even;
        let long = arcs.map(is_long);
        changes += 1;
        if (!shared[0] && shared[1] && arcs[0] < 0.0) || (!shared[1] && shared[0] && arcs[1] < 0.0) {
            remove(cable, k);
            changed = true;
        } else if !shared[0] && long[0] {
            add_mark(cable, k, 0, arcs[0] - spacing);
            changed = true;
        } else if !shared[1] && long[1] {
            add_mark(cable, k, 1, arcs[1] - spacing);
            changed = true;
            k += 1;
        } else {
            k += 1;
            changes = 0;
        }
    }
    changed
}

/// Adds a mark on the round of node `k`, `angle` (rad) before it (`side` 0) or after it (1).
fn add_mark(cable: &mut CableState, k: usize, side: usize, angle: f64) {
    let Some(node) = cable.mesh.sliding[k] else { return };
    let bar = k - 1 + side;
    let sign = if side == 0 { -1.0 } else { 1.0 };
    let mark = rotate(node.end.mark, node.end.sense * sign * angle);
    let length = cable.mesh.path(bar, &cable.motion.positions).length;
    let s = [cable.mesh.arc_length[bar], cable.mesh.arc_length[bar + 1]];
    let part = angle * node.end.radius / length * (s[1] - s[0]);
    let arc_length = if side == 0 { s[1] - part } else { s[0] + part };
    insert(cable, bar + 1, arc_length, Some(SlidingNode { end: BarEnd { mark, ..node.end }, ..node }));
}

/// The fraction f of an arc before its mark. With the tension T₁ of the bar before the mark and T₂
/// of the bar after it, the arc is then as long as with a tension whose logarithm changes evenly,
/// T₁ e^{−xu}, 0 ≤ u ≤ 1:
/// ```text
/// f T₁ + (1 − f) T₂ = T₁ (1 − e^{−x})/x,   x = ln T₁/T₂,      f = 1/x − 1/(eˣ − 1)
/// ```
fn part_before([before, after]: [f64; 2]) -> f64 {
    let x = if before > 0.0 && after > 0.0 { (before / after).ln() } else { 0.0 };
    if x.abs() < SERIES_LOG_RATIO { 0.5 - x / 12.0 } else { 1.0 / x - 1.0 / x.exp_m1() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_with_its_mark_is_as_long_as_friction_makes_it() {
        for (before, after) in
            [(100.0f64, 100.0f64), (100.0, 99.999), (100.0, 40.0), (3.0, 800.0), (5e-7, 70.0), (1e-290, 1e9)]
        {
            let f = part_before([before, after]);
            let n = 20_000;
            let at = |k: i32| before * (after / before).powf((f64::from(k) + 0.5) / f64::from(n));
            let mean = (0..n).map(at).sum::<f64>() / f64::from(n);
            let two: f64 = f * before + (1.0 - f) * after;
            assert!((two - mean).abs() < 1e-6 * before.max(after), "{before} {after}: {two} {mean}");
            assert!((f + part_before([after, before]) - 1.0).abs() < 1e-12);
        }
    }
}
