//! This check finds whether a stiff cable bears its compression or buckles.
//!
//! If an inextensible cable is turned by η(s), its energy changes by ½ ∫ (EI η'² + T η²) ds, T the
//! force along it, provided that every part between two held places keeps its chord: two conditions
//! each (R. Levien, "The elastica: a mathematical history", 2008; J. H. Maddocks, "Stability of
//! nonlinearly elastic rods", Arch. Rational Mech. Anal. 85, 1984). The energy may fall in as many
//! directions as there are conditions, because these can forbid them; with one more direction the
//! cable buckles.

use super::checked_cable::CheckedCable;
use super::support_hold::Role;
use super::surroundings::Neighbours;
use super::tolerance::BALANCE_FRACTION;
use crate::math::larger;
use crate::scene::SupportKind;
use crate::verification_report::{Law, Verification};

/// Difference of arc lengths within which a support holds a node, as a fraction of the cable's
/// length: round-off. Smaller: the node counts as free; larger: so does none beside a support.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// Checks the stability of stretches in compression.
pub(super) fn check_stability(checked: &CheckedCable<'_>, found: &mut Verification, near: &Neighbours) {
    found.ask(Law::Stability);
    let nodes = &checked.answer.nodes;
    let same = SAME_POINT_FRACTION * checked.cable.length_m;
    // The support that holds a node, and whether it may turn there.
    let mut holds = vec![None; nodes.len()];
    for hold in checked.holds.iter().filter(|h| !matches!(h.role, Role::Clear { .. } | Role::Load | Role::Released)) {
        let node = nodes.partition_point(|n| n.arc_length_m < hold.arc_length - same);
        if let Some(of_node) = holds.get_mut(node) {
            *of_node = Some(hold.support.kind == SupportKind::Clamped);
        }
    }
    let mut bars = Vec::with_capacity(nodes.len());
    let mut first_node = Vec::with_capacity(nodes.len());
    for (k, pair) in nodes.windows(2).enumerate() {
        let length = checked.thermal * (pair[1].arc_length_m - pair[0].arc_length_m);
        let Some(way) = (pair[1].at() - pair[0].at()).try_normalize(0.0).filter(|_| length > same) else {
            // If two nodes are one material point, a support that holds either holds both.
            holds[k + 1] = holds[k + 1].or(holds[k]);
            continue;
        };
        let pulls = [pair[1].force(), checked.force_before(k + 1)].map(|end| (pair[0].force() + end).dot(&way) * 0.5);
        bars.push(CompressedBar {
            length,
            pull: larger(pulls[0], pulls[1]),
            touches_obstacle: checked.touches(near, k),
            pinned: holds[k] == Some(false),
            clamped: [holds[k] == Some(true), holds[k + 1] == Some(true)],
        });
        first_node.push(k);
    }
    let ends = [holds.first(), holds.last()].map(|h| h.copied().flatten().is_some());
    let stiffness = checked.answer.assumptions.bending_stiffness_n_m2 / checked.thermal;
    // A force that may be out of balance is no compression, and a floor that rubs holds some.
    let noise = larger(BALANCE_FRACTION * checked.scale, floor_hold(checked, stiffness));
    if let Some(found_excess) = excess(&bars, stiffness, ends).filter(|e| !(e.push <= noise)) {
        let ExcessCompression { bar, push, bearable } = found_excess;
        found.report(checked.finding(Law::Stability, first_node[bar], push, bearable));
    }
}

/// The compression (N) up to which the floor of a plan view holds a cable of this bending stiffness
/// (N·m²) that lies aside of a straight line by its own radius r, in waves of any length.
///
/// A wave r sin kx needs r (P k² − EI k⁴) per metre to be held, at most r P²/4EI (with k² = P/2EI),
/// and the floor gives μw. (As pipelines on a sea bed: R. E. Hobbs, "In-service buckling of heated
/// pipelines", Journal of Transportation Engineering 110(2), 1984.)
fn floor_hold(checked: &CheckedCable<'_>, stiffness: f64) -> f64 {
    (4.0 * stiffness * checked.floor_friction_n_per_m() / (0.5 * checked.cable.diameter_m)).sqrt()
}

/// A part of the cable between two nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct CompressedBar {
    /// Material, m.
    pub length: f64,
    /// Force along it, N; negative in compression.
    pub pull: f64,
    /// True if an obstacle touches it, so that it does not turn.
    pub touches_obstacle: bool,
    /// True if the node before it is a support that lets it turn.
    pub pinned: bool,
    /// True if the node before it is clamped, and the one after it.
    pub clamped: [bool; 2],
}

/// A compression that a cable does not bear.
pub(super) struct ExcessCompression {
    /// Index of the bar with the greatest compression.
    bar: usize,
    /// Its compression, N.
    push: f64,
    /// The compression of that bar (N) up to which the cable bears that of all bars in proportion.
    bearable: f64,
}

/// The compression that the cable does not bear; None if it bears all. `ends` are true for ends of
/// the cable that are held in place.
pub(super) fn excess(bars: &[CompressedBar], stiffness: f64, ends: [bool; 2]) -> Option<ExcessCompression> {
    let (worst, most) = bars.iter().enumerate().min_by(|a, b| a.1.pull.total_cmp(&b.1.pull))?;
    if !(most.pull < 0.0) || bars.iter().any(|b| !(b.length > 0.0)) {
        return None;
    }
    let open = conditions(bars, ends);
    let holds = |part: f64| negative_pivots(bars, stiffness, part) <= open;
    if holds(1.0) {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    // The bisection covers a kilonewton on a bar that holds a millinewton, to three digits.
    for _ in 0..32 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    Some(ExcessCompression { bar: worst, push: -most.pull, bearable: -most.pull * low })
}

/// Two for each part between places that are held.
fn conditions(bars: &[CompressedBar], ends: [bool; 2]) -> usize {
    let mut count = 0;
    let mut begun = ends[0];
    for (k, bar) in bars.iter().enumerate() {
        if (bar.pinned || bar.clamped[0]) && k > 0 && !bar.touches_obstacle && !bars[k - 1].touches_obstacle {
            count += if begun { 2 } else { 0 };
            begun = true;
        }
        if bar.touches_obstacle {
            // A free stretch before it ends here.
            count += if begun && k > 0 && !bars[k - 1].touches_obstacle { 2 } else { 0 };
            begun = true;
        }
    }
    let free = bars.last().is_some_and(|b| !b.touches_obstacle);
    count + if begun && free && ends[1] { 2 } else { 0 }
}

/// Number of directions in which the energy falls with the fraction `part` of each compression:
/// negative pivots of the tridiagonal second variation (Sylvester).
fn negative_pivots(bars: &[CompressedBar], stiffness: f64, part: f64) -> usize {
    let (mut count, mut before) = (0, None);
    for (k, bar) in bars.iter().enumerate() {
        if bar.touches_obstacle {
            before = None;
            continue;
        }
        let spring = |other: Option<&CompressedBar>| other.map_or(0.0, |o| 2.0 * stiffness / (bar.length + o.length));
        let [left, right] = [spring(k.checked_sub(1).and_then(|i| bars.get(i))), spring(bars.get(k + 1))];
        let clamp = |on: bool, beside: f64| if on { 2.0 * stiffness / bar.length } else { beside };
        let pull = if bar.pull < 0.0 { part * bar.pull } else { bar.pull };
        let mut pivot = pull * bar.length + clamp(bar.clamped[0], left) + clamp(bar.clamped[1], right);
        if let Some(before) = before.filter(|_| !bar.clamped[0]) {
            pivot -= left * left / before;
        }
        // A zero is on the safe side.
        pivot = if pivot == 0.0 { f64::MIN_POSITIVE } else { pivot };
        count += usize::from(pivot < 0.0);
        before = Some(pivot);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The way in which both ends of a straight cable are held.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Ends {
        Pinned,
        Clamped,
    }

    fn straight(n: usize, length: f64, push: f64, ends: Ends) -> Vec<CompressedBar> {
        let bar = CompressedBar {
            length: length / n as f64,
            pull: -push,
            touches_obstacle: false,
            pinned: false,
            clamped: [false; 2],
        };
        let mut bars = vec![bar; n];
        if ends == Ends::Clamped {
            (bars[0].clamped[0], bars[n - 1].clamped[1]) = (true, true);
        }
        bars
    }

    #[test]
    fn what_is_asked_lies_above_eulers_loads_and_far_below_ten_times_them() {
        let (n, length, stiffness) = (200, 3.0, 2.0);
        let euler = std::f64::consts::PI.powi(2) * stiffness / (length * length);
        // Both ends pinned: π²; clamped: 4π². With two conditions more than needed up to (3π)² may
        // pass.
        for (ends, least, most) in [(Ends::Pinned, 1.0, 4.1), (Ends::Clamped, 4.0, 9.1)] {
            let passes = |f: f64| excess(&straight(n, length, f * euler, ends), stiffness, [true; 2]).is_none();
            assert!(passes(0.99 * least) && !passes(most), "{ends:?}");
        }
        let free = |f: f64| excess(&straight(n, length, f * euler, Ends::Pinned), stiffness, [true, false]).is_none();
        assert!(!free(0.01), "nothing holds the far end");
    }

    #[test]
    fn what_lies_in_a_groove_holds_any_push() {
        let mut bars = straight(50, 3.0, 1e6, Ends::Pinned);
        bars.iter_mut().for_each(|b| b.touches_obstacle = true);
        assert!(excess(&bars, 1.0, [true; 2]).is_none());
        bars[20..30].iter_mut().for_each(|b| b.touches_obstacle = false);
        let ExcessCompression { push, bearable: holds, .. } = excess(&bars, 1.0, [true; 2]).unwrap();
        assert!(push == 1e6 && holds > 30.0 && holds < 600.0, "{push} {holds}");
    }

    #[test]
    fn what_pulls_is_never_asked() {
        assert!(excess(&straight(9, 1.0, -5.0, Ends::Pinned), 1.0, [true; 2]).is_none());
    }
}
