//! These checks hold for a flexible cable: its force is tangential and is its tension, the length
//! of its path is that of its strained material, and slack cable in the air has tension, too.

use super::checked_cable::{CheckedBar, CheckedCable};
use super::surroundings::{Neighbours, distance};
use super::tolerance::{
    BALANCE_FRACTION, COMPRESSION, CONTACT_SHIFT_DIAMETERS, FOLD_TURN, LUMPED_WEIGHT_TURN, MATERIAL_TOLERANCE,
    REPORTED_BALANCE, TURN,
};
use crate::math::{Vec2, cross, larger, smaller};
use crate::verification_report::{Law, Verification};

/// Deviation of a piece's path from the right one, its tolerance, and the material in excess of its
/// path, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct LengthDeviation {
    pub value: f64,
    pub limit: f64,
    pub folded: f64,
}

/// Checks a flexible cable from node to node: its tension is the size of its force, it has no
/// compression, and its path fits its material.
pub(super) fn check_flexible(checked: &CheckedCable<'_>, found: &mut Verification, near: &Neighbours) {
    [Law::Length, Law::Slack, Law::Tension, Law::Compression].into_iter().for_each(|law| found.ask(law));
    let mut before = None;
    for bar in checked.bars() {
        check_tension(checked, found, before, &bar);
        check_compression(checked, found, near, &bar);
        check_length(checked, found, near, &bar);
        before = Some(bar);
    }
    if let Some(bar) = before {
        let (k, from, forces) = (bar.index + 1, bar.to, [bar.forces[1]; 2]);
        check_tension(
            checked,
            found,
            before,
            &CheckedBar { index: k, from, forces, length: 0.0, way: Vec2::zeros(), ..bar },
        );
    }
}

/// Checks that the tension of a flexible cable is the size of its force: at a node between two bars
/// a value between those just before and just after it.
fn check_tension(
    checked: &CheckedCable<'_>,
    found: &mut Verification,
    before: Option<CheckedBar<'_>>,
    bar: &CheckedBar<'_>,
) {
    let tension = bar.from.tension_n;
    let limit = REPORTED_BALANCE * checked.scale;
    // Most nodes have it from the bar that begins there.
    if (tension - bar.forces[0]).abs() <= limit {
        return;
    }
    // `fem` takes it from the middles of the bars beside a node, so half of their weight, or of the
    // floor's friction on them, is between.
    let beside = bar.length + before.map_or(0.0, |b| b.length);
    let limit = limit + LUMPED_WEIGHT_TURN * checked.spread_load() * beside;
    let after = bar.from.force();
    let before = before.map_or(after, |_| checked.force_before(bar.index));
    let most = larger(before.norm(), bar.forces[0]);
    let least = distance(before, after, Vec2::zeros(), Vec2::zeros());
    let value = larger(tension - most, least - tension);
    if !(value <= limit) {
        found.report(checked.finding(Law::Tension, bar.index, value, limit));
    }
}

/// Checks that a flexible cable is not compressed.
///
/// A loose bar may carry its weight anywhere along it, so it counts as compressed only if it is at
/// both its ends.
fn check_compression(checked: &CheckedCable<'_>, found: &mut Verification, near: &Neighbours, bar: &CheckedBar<'_>) {
    // Nodes of one material point have no path between them.
    if bar.length <= MATERIAL_TOLERANCE * checked.cable.length_m {
        return;
    }
    let pulls = checked.forces_at_end(bar).map(|end| (bar.from.force() + end).dot(&bar.way));
    let most = if pulls[0] >= 0.0 { pulls[0] } else { larger(pulls[0], pulls[1]) };
    let least = smaller(bar.from.tension_n, bar.to.tension_n);
    if most >= 0.0 && least >= 0.0 {
        return;
    }
    let end = checked.forces_at_end(bar).map(|end| end.dot(&bar.way));
    let lies = checked.touches(near, bar.index);
    let most = if lies && larger(bar.from.force().dot(&bar.way), larger(end[0], end[1])) >= 0.0 { 0.0 } else { most };
    let pushes = if most < 0.0 { -0.5 * most / bar.way.norm() } else { 0.0 };
    let (value, limit) = (larger(pushes, -least), COMPRESSION * checked.scale);
    if !(value <= limit) {
        found.report(checked.finding(Law::Compression, bar.index, value, limit));
    }
}

/// Checks that the path of a bar is that of its material under its force.
fn check_length(checked: &CheckedCable<'_>, found: &mut Verification, near: &Neighbours, bar: &CheckedBar<'_>) {
    let touches = checked.touches(near, bar.index);
    let [spread, at_end] = checked.forces_at_end(bar);
    let path = BarPath { checked, bar, touches };
    let spread = path.strained(spread, bar.forces[1]);
    if spread.is_some_and(|(off, limit)| off.norm_squared() <= limit * limit) {
        return;
    }
    let lengths = |strained: Option<(Vec2, f64)>, q: f64| match strained {
        Some((off, limit)) => LengthDeviation { value: off.norm(), limit, folded: 0.0 },
        None => path.folded(q),
    };
    let spread = lengths(spread, bar.forces[1]);
    if spread.value <= spread.limit && spread.folded == 0.0 {
        return;
    }
    let at_end = lengths(path.strained(at_end, at_end.norm()), at_end.norm());
    let off = |l: &LengthDeviation| l.value / l.limit;
    let lengths = if off(&at_end) < off(&spread) { at_end } else { spread };
    check_slack(checked, found, near, bar, lengths.limit);
    report_length(checked, found, bar, lengths);
}

/// Reports a bar whose length is not that of its material, and adds what is folded in it.
pub(super) fn report_length(
    checked: &CheckedCable<'_>,
    found: &mut Verification,
    bar: &CheckedBar<'_>,
    lengths: LengthDeviation,
) {
    found.folded_m += lengths.folded;
    if !(lengths.value <= lengths.limit) {
        found.report(checked.finding(Law::Length, bar.index, lengths.value, lengths.limit));
    }
}

/// The path of a bar of a flexible cable.
struct BarPath<'a> {
    checked: &'a CheckedCable<'a>,
    bar: &'a CheckedBar<'a>,
    /// True if it lies against something.
    touches: bool,
}

impl BarPath<'_> {
    /// Allowed error of the path (m) of material (m) by round-off, and beside contacts.
    fn slack(&self, material: f64) -> f64 {
        let aside = if self.touches { CONTACT_SHIFT_DIAMETERS * self.checked.cable.diameter_m } else { 0.0 };
        self.checked.length_rounding(material) + aside
    }

    /// Returns the deviation of the path of a flexible bar, whose internal force at its end is
    /// `end` (N) of size `q` (N), and the allowed one, m; None if the force has no direction, or
    /// the bar's own weight turns it too far.
    #[inline]
    fn strained(&self, end: Vec2, q: f64) -> Option<(Vec2, f64)> {
        let &Self { checked, bar, touches } = self;
        let (compliance, start, p) = (1.0 / checked.cable.axial_stiffness_n, bar.from.force(), bar.forces[0]);
        let (least, most) = if p < q { (p, q) } else { (q, p) };
        let turn = (end - start).norm_squared() / (least * least);
        // A force within the allowed unbalanced one has no reliable direction, and may be zero.
        if !(turn < FOLD_TURN * FOLD_TURN && least > BALANCE_FRACTION * checked.scale) {
            return None;
        }
        // Simpson's rule for ∫ F/|F| (1 + |F|/EA) ds with F linear in s.
        let middle = (start + end) * 0.5;
        let rates = start * (1.0 / p + compliance)
            + middle * (4.0 * (1.0 / middle.norm() + compliance))
            + end * (1.0 / q + compliance);
        let material = checked.thermal * bar.length;
        // Weight that a bar carries beyond its straight part turns it by that much.
        let lumped = if touches { LUMPED_WEIGHT_TURN * checked.weight_beside(bar.index) / most } else { 0.0 };
        if lumped > FOLD_TURN {
            return None;
        }
        // The floor of a plan view may act anywhere between two nodes, not evenly: the mean
        // direction is then anywhere between those at the nodes.
        let by_floor = if checked.floor_rubs() { 0.5 * turn.sqrt() } else { 0.0 };
        let limit = self.slack(material) + (TURN * turn + lumped + by_floor) * material;
        Some((bar.way - rates * (material / 6.0), limit))
    }

    /// Handles a bar whose force, of size `q` (N) at its end, has no direction: it must not be
    /// longer than its material.
    fn folded(&self, q: f64) -> LengthDeviation {
        let &Self { checked, bar, .. } = self;
        let material = checked.thermal * bar.length;
        let stretched = material * (1.0 + larger(bar.forces[0], q) / checked.cable.axial_stiffness_n);
        let (way, limit) = (bar.way.norm(), self.slack(material));
        LengthDeviation { value: way - stretched, limit, folded: larger(stretched - way, 0.0) }
    }
}

/// Slack pulls where it hangs in the air: a shallow bow of weight w and chord c, m longer than
/// that, with H = w a² / c · √(c / 24 m) across the load, where a is what the chord goes across it.
/// A bar without tension in its middle may leave out no more of it than of its own weight.
fn check_slack(
    checked: &CheckedCable<'_>,
    found: &mut Verification,
    near: &Neighbours,
    bar: &CheckedBar<'_>,
    limit: f64,
) {
    let (weight, chord) = (checked.body.norm(), bar.way.norm());
    let missing = checked.thermal * bar.length - chord;
    if !(missing > limit && weight > 0.0 && chord > 0.0) {
        return;
    }
    let lumped = LUMPED_WEIGHT_TURN * weight * bar.length;
    if (bar.from.force() - checked.body * (0.5 * bar.length)).norm() > lumped {
        return;
    }
    let across = |v: Vec2| cross(checked.body, v).abs() / weight;
    let bow = weight * across(bar.way).powi(2) / chord * (chord / (24.0 * missing)).sqrt();
    let left_out = bow - across(bar.from.force());
    let allowed = larger(lumped, REPORTED_BALANCE * checked.scale);
    if left_out > allowed && hangs_in_air(checked, bar, near, missing) {
        found.report(checked.finding(Law::Slack, bar.index, left_out, allowed));
    }
}

/// Number of straight parts in which the bow of a loose bar is checked.
const BOW_PARTS: usize = 8;

/// Returns whether a bar, with so much of its material (m) beside its chord, hangs between two
/// places that are held without anything to lie on: drawn as its chord c, a loose bar hangs below
/// that by √(3/8 c · missing).
fn hangs_in_air(checked: &CheckedCable<'_>, bar: &CheckedBar<'_>, near: &Neighbours, missing: f64) -> bool {
    let Some(down) = checked.body.try_normalize(0.0) else { return false };
    let touches = |bar: usize| !near.of(bar).is_empty();
    let last = bar.index + 2 == checked.answer.nodes.len();
    // Cable that hangs free beside the bar would give way.
    let is_supported = (bar.index == 0 || touches(bar.index - 1)) && (last || touches(bar.index + 1));
    let on_itself = || checked.self_contact_forces().next().is_some();
    if !is_supported || checked.floor_rubs() || touches(bar.index) || checked.is_at_wheel(bar.index) || on_itself() {
        return false;
    }
    let depth = (0.375 * bar.way.norm() * missing).sqrt();
    let at = |part: usize| {
        let u = part as f64 / BOW_PARTS as f64;
        bar.from.at() + bar.way * u + down * (4.0 * depth * u * (1.0 - u))
    };
    let mut met = Vec::new();
    for part in 0..BOW_PARTS {
        checked.surroundings.append_features_near(at(part), at(part + 1), checked.reach(), &mut met);
    }
    met.is_empty()
}
