//! This module distributes material to the parts of a loose cable: the surplus goes to those
//! without tension, or into a heap.

use crate::math::Vec2;
use crate::model::spans::boundary::{SlackForm, SlackPart};
use crate::model::spans::slack::heap::heap;
use crate::model::spans::slack::slack_parts::SlackSolver;
use crate::model::spans::slack::upper_surfaces::NONE_M;

/// Least surplus of a loose cable, as a fraction of the cable: a cable as long as its way lies
/// along it in tension, with a friction memory.
const EXCESS_CABLE_FRACTION: f64 = 1e-9;
impl SlackPart {
    /// True if it lies without tension, so that it may take surplus material.
    pub(super) fn is_loose(&self) -> bool {
        matches!(self.form, SlackForm::Lies(_)) && self.tension == [0.0; 2]
    }
}

/// Gives each part its material, and the surplus to parts without tension or to a heap; None if
/// there is no surplus or nothing holds it. If the cable ends before the route, its free end lies
/// there.
pub(super) fn pay_out(
    mut parts: Vec<SlackPart>,
    drape: &SlackSolver<'_>,
    [from, to]: [f64; 2],
    drawn: Vec2,
    has_support: [bool; 2],
) -> Option<Vec<SlackPart>> {
    let own = |p: &SlackPart| p.arc_lengths[1] - p.arc_lengths[0];
    let mut over = to - from - parts.iter().map(own).sum::<f64>();
    if !(over > EXCESS_CABLE_FRACTION * (to - from)) {
        cut(&mut parts, has_support.iter().position(|h| !h)?, -over)?;
        over = 0.0;
    }
    let free: f64 = parts.iter().filter(|p| p.is_loose()).map(own).sum();
    if over > 0.0 && (free <= NONE_M || drawn.norm() > 0.0) {
        let (at, found) = heap(&parts, drape.context, drape.frame, drape.context.law.load * over + drawn)?;
        parts.insert(at, SlackPart { arc_lengths: [0.0, over], tension: [0.0; 2], form: SlackForm::Heap(found) });
    }
    let heaped = over == 0.0 || parts.iter().any(|p| matches!(p.form, SlackForm::Heap(_)));
    let spread = if heaped { 0.0 } else { over / free };
    let mut s = from;
    for part in &mut parts {
        let more = if part.is_loose() { own(part) * spread } else { 0.0 };
        part.arc_lengths = [s, s + own(part) + more];
        s = part.arc_lengths[1];
    }
    Some(parts)
}

/// Removes so much material (m) from a free end (0 for the start) that lies without tension; None
/// if it does not.
fn cut(parts: &mut Vec<SlackPart>, end: usize, mut off: f64) -> Option<()> {
    loop {
        let at = if end == 0 { 0 } else { parts.len().checked_sub(1)? };
        let part = parts.get_mut(at)?;
        let SlackForm::Lies(stretch) = &mut part.form else { return None };
        if part.tension != [0.0; 2] {
            return None;
        }
        let own = part.arc_lengths[1] - part.arc_lengths[0];
        if own > off {
            let left = 1.0 - off / own;
            let [other_end, cut] = [stretch.coordinates[1 - end], stretch.coordinates[end]];
            stretch.coordinates[end] = other_end + (cut - other_end) * left;
            part.arc_lengths = [0.0, own * left];
            return Some(());
        }
        off -= own;
        parts.remove(at);
    }
}
