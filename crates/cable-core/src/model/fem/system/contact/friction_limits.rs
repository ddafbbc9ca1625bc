//! A lagged step balances the cable with frozen friction limits; this module finds the limits that
//! agree with the normal forces of the balanced step.
//!
//! With the limit x at a contact, the balanced step has a normal force N there, which allows the
//! friction f(x) = μN. Wanted is the fixed point f(x) = x. Successive substitution x ← f(x) is
//! tried first. If more friction at a contact reduces its normal force, substitution oscillates.
//! The fixed point then lies between two limits that were tried, and is found by false position,
//! for each contact by itself (the Illinois method: M. Dowell, P. Jarratt, "A modified regula falsi
//! method for computing the root of an equation", BIT 11, 1971).

use crate::math::larger;
use crate::model::fem::system::contact::friction_contact::{FrictionContact, of_node};

/// Number of successive trials on one side of the fixed point after which the bracket is dropped,
/// unless they halved the excess. Smaller: brackets of steep functions are dropped; larger: rounds
/// are spent on a bracket that other contacts have made invalid.
const MAX_SAME_SIDE_TRIALS: u32 = 3;

/// A limit x that was tried, and its excess f(x) − x, N.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial {
    limit: f64,
    excess: f64,
}

/// The two limits between which the fixed point of a contact lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bracket {
    contact: FrictionContact,
    /// The last trial with a positive excess: the fixed point is above it.
    low: Option<Trial>,
    /// The last trial with a negative excess: the fixed point is below it.
    high: Option<Trial>,
    /// True if the last trial is the low one.
    last_is_low: bool,
    /// Number of successive trials on the side of the last one.
    same_side_trials: u32,
    /// Excess of the first of them, N.
    first_excess: f64,
}

impl Bracket {
    fn new(contact: FrictionContact) -> Self {
        Self { contact, low: None, high: None, last_is_low: false, same_side_trials: 0, first_excess: 0.0 }
    }

    /// Adds a trial. The other end of the bracket is dropped if it contradicts the trial, or if
    /// trials on this side do not converge: then other contacts have changed since it was tried.
    fn add(&mut self, trial: Trial) {
        let is_low = trial.excess > 0.0;
        let repeats = is_low == self.last_is_low && self.same_side_trials > 0;
        self.last_is_low = is_low;
        (self.same_side_trials, self.first_excess) =
            if repeats { (self.same_side_trials + 1, self.first_excess) } else { (1, trial.excess) };
        let (side, other) = if is_low { (&mut self.low, &mut self.high) } else { (&mut self.high, &mut self.low) };
        *side = Some(trial);
        let Some(far) = other else { return };
        let stalls =
            self.same_side_trials >= MAX_SAME_SIDE_TRIALS && trial.excess.abs() > 0.5 * self.first_excess.abs();
        if is_low != (far.limit > trial.limit) || stalls {
            *other = None;
            (self.same_side_trials, self.first_excess) = (1, trial.excess);
        } else if repeats {
            far.excess *= 0.5;
        }
    }

    /// The next limit to try, N; None without two ends.
    fn next(&self) -> Option<f64> {
        let (low, high) = (self.low?, self.high?);
        let next = (low.limit * high.excess - high.limit * low.excess) / (high.excess - low.excess);
        next.is_finite().then_some(next)
    }
}

/// The search for the friction limits of all contacts in the rounds of a step.
#[derive(Clone, Debug, Default)]
pub(in crate::model::fem) struct FrictionLimits(Vec<Bracket>);

impl FrictionLimits {
    /// Keeps the limits f(x) of `contacts` as those of the next round; `used` has the limits x of
    /// the round that gave them. Both lists are in order of nodes. Returns the greatest |f(x) − x|,
    /// N; a contact that has opened has f(x) = 0.
    pub(in crate::model::fem) fn substitute(
        &mut self,
        contacts: &mut Vec<FrictionContact>,
        used: &[FrictionContact],
    ) -> f64 {
        let off = self.add_trials(contacts, used);
        contacts.retain(|c| c.limit != 0.0);
        off
    }

    /// As [`Self::substitute`], but contacts with a bracket get its next limit.
    pub(in crate::model::fem) fn false_position(
        &mut self,
        contacts: &mut Vec<FrictionContact>,
        used: &[FrictionContact],
    ) -> f64 {
        let off = self.add_trials(contacts, used);
        for (contact, bracket) in contacts.iter_mut().zip(&self.0) {
            contact.limit = bracket.next().unwrap_or(contact.limit);
        }
        contacts.retain(|c| c.limit != 0.0);
        off
    }

    /// Adds a trial to the bracket of each contact, in the order of `contacts`, which then has
    /// those that have opened, too.
    fn add_trials(&mut self, contacts: &mut Vec<FrictionContact>, used: &[FrictionContact]) -> f64 {
        let has_opened = |u: &&FrictionContact| !of_node(contacts, u.touch.node).any(|c| c.is_of(&u.touch));
        let opened: Vec<FrictionContact> = used.iter().filter(has_opened).copied().collect();
        contacts.extend(opened.iter().map(|u| FrictionContact { limit: 0.0, ..*u }));
        contacts.sort_by_key(|c| c.touch.node);
        let mut off = 0.0;
        let mut brackets = Vec::with_capacity(contacts.len());
        for contact in contacts.iter() {
            let node = contact.touch.node;
            let limit = of_node(used, node).find(|u| u.is_of(&contact.touch)).map_or(0.0, |u| u.limit);
            let excess = contact.limit - limit;
            off = larger(off, excess.abs());
            let first = self.0.partition_point(|b| b.contact.touch.node < node);
            let mut of_same_node = self.0[first..].iter().take_while(|b| b.contact.touch.node == node);
            let known = of_same_node.find(|b| b.contact.is_of(&contact.touch));
            let mut bracket = known.map_or_else(|| Bracket::new(*contact), |b| Bracket { contact: *contact, ..*b });
            bracket.add(Trial { limit, excess });
            brackets.push(bracket);
        }
        self.0 = brackets;
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
                let next = if round < 8 { FrictionLimits::substitute } else { FrictionLimits::false_position };
                off = next(&mut limits, &mut now, &used);
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
