//! The shape of a cable is summarised by sag, heights, lengths and touchdowns.

use super::{CablePlace, Sag, TouchKind, Touchdown};
use crate::math::larger;
use crate::scene::{Cable, SupportKind, View};
use crate::solution::{CableSolution, ContactReport, Node};

/// Places nearer than this part of the cable's length are the same.
const PLACE_TOLERANCE: f64 = 1e-9;

/// Sag: the greatest distance of the cable from the straight line between neighbouring supports
/// that hold it (a dead load hangs: it holds nothing), downwards in a side view, square to the line
/// in a plan view. None where no two of them are apart, or the cable is broken between them or torn
/// off one.
#[must_use]
pub fn sag(cable: &Cable, answer: &CableSolution, view: View) -> Option<Sag> {
    let hangs = |k: usize| {
        let kind = cable.supports.get(k).map(|s| s.kind);
        matches!(kind, Some(SupportKind::Load | SupportKind::Free))
    };
    let last = answer.supports.len().saturating_sub(1);
    let torn_off = |k: usize| {
        let breaks = |node: usize| answer.breaks.contains(&node);
        (k == 0 && breaks(0)) || (k == last && breaks(answer.nodes.len()))
    };
    let holds = |k: usize| !hangs(k) && !torn_off(k);
    let reactions: Vec<_> = answer.supports.iter().enumerate().filter(|(k, _)| holds(*k)).map(|(_, s)| s).collect();
    let mut best: Option<Sag> = None;
    for pair in reactions.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let Some(piece) = answer.pieces().find(|piece| reaches(piece, a.arc_length_m, b.arc_length_m)) else {
            continue;
        };
        let (dx, dy) = (b.x_m - a.x_m, b.y_m - a.y_m);
        let span = match view {
            View::Elevation => dx.abs(),
            View::Plan => dx.hypot(dy),
        };
        for n in piece.iter().filter(|n| n.arc_length_m >= a.arc_length_m && n.arc_length_m <= b.arc_length_m) {
            // Twice the triangle's area over the base: over its horizontal part that is the
            // vertical distance.
            let cross = dx * (n.y_m - a.y_m) - dy * (n.x_m - a.x_m);
            let sag_m = match view {
                View::Elevation => -cross * dx.signum() / span,
                View::Plan => cross.abs() / span,
            };
            if sag_m.is_finite() && best.is_none_or(|b| sag_m > b.sag_m) {
                best = Some(Sag { sag_m, at: CablePlace::of(n) });
            }
        }
    }
    best
}

/// True if a piece of the cable holds all material between two of its points (m), but for rounding.
fn reaches(piece: &[Node], from: f64, to: f64) -> bool {
    let (Some(first), Some(last)) = (piece.first(), piece.last()) else { return false };
    let rounding = PLACE_TOLERANCE * larger(to.abs(), last.arc_length_m.abs());
    first.arc_length_m <= from + rounding && to - rounding <= last.arc_length_m
}

/// Stretched length, m: ∫ (1 + ε) θ ds with θ = 1 + αΔT. The sum of the chords between nodes would
/// be shorter where the cable is curved, shorter even than the cable.
#[must_use]
pub fn stretched_length_m(cable: &CableSolution, thermal_stretch: f64) -> f64 {
    let elements = cable.pieces().flat_map(|piece| piece.windows(2));
    let each = elements.map(|w| (w[1].arc_length_m - w[0].arc_length_m) * (1.0 + 0.5 * (w[0].strain + w[1].strain)));
    thermal_stretch * each.sum::<f64>()
}

/// The lowest and the highest point.
pub(super) fn heights(answer: &CableSolution) -> (CablePlace, CablePlace) {
    let Some(first) = answer.nodes.first().map(CablePlace::of) else { return Default::default() };
    answer.nodes.iter().map(CablePlace::of).fold((first, first), |(low, high), p| {
        (if p.y_m < low.y_m { p } else { low }, if p.y_m > high.y_m { p } else { high })
    })
}

/// Returns whether a contact is with an obstacle, not with the cable itself.
pub(super) fn is_of_obstacle(cable: &Cable, c: &&ContactReport) -> bool {
    c.obstacle != cable.name
}

/// Unstretched length in contact, m: that of the union of all contacts, which may overlap.
pub(super) fn lying_m(cable: &Cable, answer: &CableSolution) -> f64 {
    let within = |s: f64| s.clamp(0.0, cable.length_m);
    let contacts = answer.contacts.iter().filter(|c| is_of_obstacle(cable, c));
    let mut all: Vec<[f64; 2]> = contacts.map(|c| c.extent_m().map(within)).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut reached) = (0.0, 0.0);
    for [from, to] in all {
        let from = if from > reached { from } else { reached };
        if to > from {
            sum += to - from;
            reached = to;
        }
    }
    sum
}

/// Returns where contacts begin and end, but for the ends of the cable that lie; one place where
/// two meet.
pub(super) fn touchdowns(cable: &Cable, answer: &CableSolution) -> Vec<Touchdown> {
    let same = PLACE_TOLERANCE * cable.length_m;
    let mut contacts: Vec<&ContactReport> = answer.contacts.iter().filter(|c| is_of_obstacle(cable, c)).collect();
    contacts.sort_by(|a, b| a.extent_m()[0].total_cmp(&b.extent_m()[0]));
    let mut out = Vec::new();
    for (k, c) in contacts.iter().enumerate() {
        let [from, to] = c.extent_m();
        let goes_on = |s: f64| {
            let others = contacts.iter().enumerate().filter(|(j, _)| *j != k);
            others.map(|(_, o)| o.extent_m()).any(|[a, b]| b - a > same && a <= s + same && s <= b + same)
        };
        let mut push = |s: f64, touch: TouchKind| {
            if let Some((at, tension_n)) = at(&answer.nodes, s) {
                out.push(Touchdown { obstacle: c.obstacle.clone(), touch, tension_n, at });
            }
        };
        if to - from <= same {
            if !goes_on(from) {
                push(c.arc_length_m, TouchKind::Point);
            }
            continue;
        }
        if from > same && !goes_on(from) {
            push(from, TouchKind::Begins);
        }
        if to < cable.length_m - same && !goes_on(to) {
            push(to, TouchKind::Ends);
        }
    }
    out.sort_by(|a, b| a.at.arc_length_m.total_cmp(&b.at.arc_length_m));
    out
}

/// CablePlace and tension at a material point (m), on the straight line between two nodes.
fn at(nodes: &[Node], s: f64) -> Option<(CablePlace, f64)> {
    let k = nodes.partition_point(|n| n.arc_length_m < s);
    let b = nodes.get(k).or(nodes.last())?;
    let a = k.checked_sub(1).and_then(|k| nodes.get(k)).unwrap_or(b);
    let ds = b.arc_length_m - a.arc_length_m;
    let f = if ds > 0.0 { ((s - a.arc_length_m) / ds).clamp(0.0, 1.0) } else { 0.0 };
    let mix = |of: fn(&Node) -> f64| of(a) + (of(b) - of(a)) * f;
    Some((CablePlace { arc_length_m: s, x_m: mix(|n| n.x_m), y_m: mix(|n| n.y_m) }, mix(|n| n.tension_n)))
}
