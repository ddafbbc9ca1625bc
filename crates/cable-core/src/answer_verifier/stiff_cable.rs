//! These checks hold for a stiff cable: between two nodes its path is an arc of its material, on
//! which its bending moment balances its force.

use super::checked_cable::{CheckedBar, CheckedCable};
use super::flexible_cable::{LengthDeviation, report_length};
use super::tolerance::{BALANCE_FRACTION, MOMENT, TURN};
use crate::math::{cross, larger, smaller};
use crate::verification_report::{Law, Verification};

/// Checks a stiff cable from node to node: its path is an arc of its material, and with M the
/// bending moment, M' + t × F = 0.
pub(super) fn check_stiff(checked: &CheckedCable<'_>, found: &mut Verification) {
    [Law::Length, Law::Moment].into_iter().for_each(|law| found.ask(law));
    let stiffness = checked.answer.assumptions.bending_stiffness_n_m2 / checked.thermal;
    let greatest = checked.answer.nodes.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, larger) * stiffness;
    let limit = MOMENT * greatest + BALANCE_FRACTION * checked.scale * 0.5 * checked.cable.diameter_m;
    for bar in checked.bars() {
        report_length(checked, found, &bar, stiff_length(checked, &bar));
        // A bar that is longer than the bend beside a clamp or a contact, √(EI/T), cannot show
        // it.
        if bar.way.norm_squared() * bar.forces[0] > checked.answer.assumptions.bending_stiffness_n_m2 {
            continue;
        }
        let change = stiffness * (bar.to.curvature_per_m - bar.from.curvature_per_m);
        let off = checked.forces_at_end(&bar).map(|end| cross(bar.way, (bar.from.force() + end) * 0.5) + change);
        let value = smaller(off[0].abs(), off[1].abs());
        if !(value <= limit) {
            found.report(checked.finding(Law::Moment, bar.index, value, limit));
        }
    }
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
