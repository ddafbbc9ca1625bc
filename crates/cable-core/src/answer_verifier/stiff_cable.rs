//! These checks hold for a stiff cable: between two nodes its path is an arc of its material, on
//! which its bending moment balances its force.

use super::checked_cable::{CheckedBar, CheckedCable};
use super::flexible_cable::{LengthDeviation, report_length};
use super::support_hold::Role;
use super::tolerance::{BALANCE_FRACTION, MATERIAL_TOLERANCE, MOMENT, TURN};
use crate::math::{cross, larger, smaller};
use crate::scene::SupportKind;
use crate::verification_report::{Law, Verification};

/// Checks a stiff cable from node to node: its path is an arc of its material, and with M the
/// bending moment, M' + t × F = 0.
///
/// M jumps at a clamp between the ends, by the clamp's own moment. An answer has one curvature at
/// that node, that of one side; what the bar on the other side lacks is the jump, which nothing
/// limits.
pub(super) fn check_stiff(checked: &CheckedCable<'_>, found: &mut Verification) {
    [Law::Length, Law::Moment].into_iter().for_each(|law| found.ask(law));
    let stiffness = checked.answer.assumptions.bending_stiffness_n_m2 / checked.thermal;
    let greatest = checked.answer.nodes.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, larger) * stiffness;
    let limit = MOMENT * greatest + BALANCE_FRACTION * checked.scale * 0.5 * checked.cable.diameter_m;
    let clamped = clamped_nodes(checked);
    // The unbalanced moment of the bar before a clamp, once that bar is passed; None in it where
    // the bar cannot show one.
    let mut before_clamp: Option<Option<(f64, usize)>> = None;
    let resolves: Vec<bool> = checked.bars().map(|bar| resolves_bend(checked, &bar)).collect();
    for bar in checked.bars() {
        report_length(checked, found, &bar, stiff_length(checked, &bar));
        // The curvature of a node comes from the bars on both sides of it.
        let beside = bar.index.saturating_sub(1)..(bar.index + 2).min(resolves.len());
        let shows = resolves[beside].iter().all(|resolves| *resolves);
        let mut unbalanced = shows.then(|| (unbalanced_moment(checked, &bar, stiffness), bar.index));
        if let Some(before) = before_clamp.take() {
            let smaller = |(before, after): ((f64, _), (f64, _))| if after.0 <= before.0 { after } else { before };
            unbalanced = before.zip(unbalanced).map(smaller);
        }
        if clamped.contains(&(bar.index + 1)) {
            before_clamp = Some(unbalanced);
        } else if let Some((value, node)) = unbalanced
            && !(value <= limit)
        {
            found.report(checked.finding(Law::Moment, node, value, limit));
        }
    }
}

/// True for a bar that is no longer than the bend beside a clamp or a contact, √(EI/T).
fn resolves_bend(checked: &CheckedCable<'_>, bar: &CheckedBar<'_>) -> bool {
    bar.way.norm_squared() * bar.forces[0] <= checked.answer.assumptions.bending_stiffness_n_m2
}

/// The moment (N·m) that is left on a bar of a cable of this bending stiffness (N·m²).
fn unbalanced_moment(checked: &CheckedCable<'_>, bar: &CheckedBar<'_>, stiffness: f64) -> f64 {
    let change = stiffness * (bar.to.curvature_per_m - bar.from.curvature_per_m);
    let off = checked.forces_at_end(bar).map(|end| cross(bar.way, (bar.from.force() + end) * 0.5) + change);
    smaller(off[0].abs(), off[1].abs())
}

/// The nodes between the ends that a clamp turns.
fn clamped_nodes(checked: &CheckedCable<'_>) -> Vec<usize> {
    let nodes = &checked.answer.nodes;
    let same = MATERIAL_TOLERANCE * checked.cable.length_m;
    let clamps = checked.holds.iter().filter(|h| h.role == Role::Held && h.support.kind == SupportKind::Clamped);
    let node = clamps.map(|h| nodes.partition_point(|n| n.arc_length_m < h.arc_length - same));
    node.filter(|k| *k > 0 && k + 1 < nodes.len()).collect()
}

/// The way of a bar of a stiff cable is an arc.
fn stiff_length(checked: &CheckedCable<'_>, bar: &CheckedBar<'_>) -> LengthDeviation {
    let (a, b) = (bar.from, bar.to);
    let material = checked.thermal * bar.length;
    let bend = larger(a.curvature_per_m.abs(), b.curvature_per_m.abs()) * material;
    let pull = 0.5 * (a.tension_n + b.tension_n);
    let change = (b.tension_n - a.tension_n).abs() + checked.body.norm() * material;
    let stretched = material * (1.0 + pull / checked.cable.axial_stiffness_n);
    let limit =
        checked.length_rounding(material) + (TURN * bend * bend + change / checked.cable.axial_stiffness_n) * material;
    LengthDeviation { value: (bar.way.norm() - stretched).abs(), limit, folded: 0.0 }
}
