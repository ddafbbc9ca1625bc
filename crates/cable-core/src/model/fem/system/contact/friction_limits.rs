//! The friction limits of contacts are sought with which a lagged step finds the normal forces that
//! they were made of.
//!
//! With a limit x of a contact the step is balanced by normal forces that allow a friction f(x).
//! Sought is f(x) = x. Each round takes x = f(x) first. Where a contact that rubs more presses
//! less, that goes to and fro without end: from there on the fixed point lies between two limits
//! that were tried, and is found by false position, contact by contact (the Illinois method: M.
//! Dowell, P. Jarratt, "A modified regula falsi method for computing the root of an equation", BIT
//! 11, 1971).

use crate::math::larger;
use crate::model::fem::system::contact::friction_contact::{FrictionContact, of_node};

/// Limits that are tried on one side, one after the other, before the other side is forgotten if
/// that halved nothing. Fewer: steep changes are sought anew; more: rounds are lost on a limit that
/// is no longer one.
const MAX_IN_A_ROW: u32 = 3;

/// A limit that was tried, and what the step then allowed more than that, N.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tried {
    limit: f64,
    excess: f64,
}

/// The limits between which that of a contact lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bracket {
    contact: FrictionContact,
    /// The greatest limit with which more is allowed, and the least with which less is.
    low: Option<Tried>,
    high: Option<Tried>,
    /// True if the limit that was tried last is the low one.
    rises: bool,
    /// Limits that were tried on this side one after the other, and the excess of the first, N.
    in_a_row: (u32, f64),
}

impl Bracket {
    fn new(contact: FrictionContact) -> Self {
        Self { contact, low: None, high: None, rises: false, in_a_row: (0, 0.0) }
    }

    /// Adds a limit that was tried. The one on the other side is forgotten where it contradicts
    /// this one, or where the search came no nearer from this side: other contacts have changed
    /// since.
    fn add(&mut self, now: Tried) {
        let rises = now.excess > 0.0;
        let again = rises == self.rises && self.in_a_row.0 > 0;
        self.rises = rises;
        self.in_a_row = if again { (self.in_a_row.0 + 1, self.in_a_row.1) } else { (1, now.excess) };
        let (side, other) = if rises { (&mut self.low, &mut self.high) } else { (&mut self.high, &mut self.low) };
        *side = Some(now);
        let Some(far) = other else { return };
        let (count, first) = self.in_a_row;
        let stalls = count >= MAX_IN_A_ROW && now.excess.abs() > 0.5 * first.abs();
        if rises != (far.limit > now.limit) || stalls {
            *other = None;
            self.in_a_row = (1, now.excess);
        } else if again {
            far.excess *= 0.5;
        }
    }

    /// The limit to try next, N; None where there are not two between which it lies.
    fn next(&self) -> Option<f64> {
        let (low, high) = (self.low?, self.high?);
        let next = (low.limit * high.excess - high.limit * low.excess) / (high.excess - low.excess);
        next.is_finite().then_some(next)
    }
}

/// The search for the limits of all contacts.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct FrictionLimits(Vec<Bracket>);

impl FrictionLimits {
    /// Replaces the limits that a round allows, in `contacts`, by those to try next, given those
    /// with which it was balanced; `is_searched`: not by what it allows, where another is known.
    /// Returns the greatest difference between what was used and what is allowed, N. Both lists are
    /// in order of nodes; a contact that is gone allows nothing.
    pub(in crate::model::fem) fn next(
        &mut self,
        contacts: &mut Vec<FrictionContact>,
        used: &[FrictionContact],
        is_searched: bool,
    ) -> f64 {
        let is_gone = |b: &&FrictionContact| !of_node(contacts, b.touch.node).any(|n| n.is_of(&b.touch));
        let gone: Vec<FrictionContact> = used.iter().filter(is_gone).copied().collect();
        contacts.extend(gone.iter().map(|b| FrictionContact { limit: 0.0, ..*b }));
        contacts.sort_by_key(|r| r.touch.node);
        let mut off = 0.0;
        let mut brackets = Vec::with_capacity(contacts.len());
        for contact in contacts.iter_mut() {
            let node = contact.touch.node;
            let limit = of_node(used, node).find(|b| b.is_of(&contact.touch)).map_or(0.0, |b| b.limit);
            let excess = contact.limit - limit;
            off = larger(off, excess.abs());
            let low = self.0.partition_point(|b| b.contact.touch.node < node);
            let mut known = self.0[low..].iter().take_while(|b| b.contact.touch.node == node);
            let mut bracket = known
                .find(|b| b.contact.is_of(&contact.touch))
                .map_or_else(|| Bracket::new(*contact), |b| Bracket { contact: *contact, ..*b });
            bracket.add(Tried { limit, excess });
            if is_searched && let Some(next) = bracket.next() {
                contact.limit = next;
            }
            brackets.push(bracket);
        }
        self.0 = brackets;
        contacts.retain(|r| r.limit != 0.0);
        off
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Gap;
    use crate::contact::obstacle_pairs::Pair;
    use crate::math::Vec2;
    use crate::model::fem::system::contact::contact_pair::ContactPair;

    fn contact(node: usize, limit: f64) -> FrictionContact {
        let (gap_m, normal, point) = (0.0, Vec2::y(), Vec2::zeros());
        let gap = Gap { gap_m, normal, point, fraction: 0.0, friction: 0.5, obstacle: 0, feature: 0 };
        let touch = ContactPair { node, on_segment: false, pair: Pair { gap, weight: 1.0 } };
        FrictionContact { touch, tangent: Vec2::x(), limit, slid: 0.0, origin: Vec2::zeros() }
    }

    /// A contact that lifts where it rubs, as steep as may be, flat on both sides, beside one that
    /// rubs the more the more it may.
    #[test]
    fn limits_that_go_to_and_fro_are_found() {
        for (slope, rounds) in [(1.5, 25), (13.0, 25), (1e3, 40)] {
            let fixed = 0.06;
            let allows = |x: f64| (fixed - slope * (x - fixed)).clamp(0.0, 0.73);
            let (mut limits, mut used) = (FrictionLimits::default(), vec![contact(3, 0.7), contact(4, 1.0)]);
            let mut off = f64::INFINITY;
            for round in 0..rounds {
                let mut now = vec![contact(3, allows(used[0].limit)), contact(4, 0.5 + 0.4 * used[1].limit)];
                off = limits.next(&mut now, &used, round >= 8);
                // One without a limit is left out.
                if now.len() == 1 {
                    now.insert(0, contact(3, 0.0));
                }
                used = now;
            }
            assert!(off < 1e-6 && (used[0].limit - fixed).abs() < 1e-6, "{slope}: {off} {}", used[0].limit);
            assert!((used[1].limit - 0.5 / 0.6).abs() < 1e-6);
        }
    }
}
