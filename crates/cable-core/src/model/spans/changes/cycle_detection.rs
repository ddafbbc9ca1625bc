//! This module detects a cycle of changes: a section returns to contacts that it had before, from
//! which the same changes would follow again.

use crate::model::spans::boundary::Mode;
use crate::model::spans::section::{CableSection, Contact};

/// Difference of contacts that count as the same, as a fraction of the cable's length. Smaller:
/// round-off hides a cycle. Larger: changes that converge pass for a cycle.
const SAME_PLACE_FRACTION: f64 = 1e-7;
/// Number of returns of the contacts that make a cycle: a single one may be a near miss.
const REPEATS: usize = 2;
/// Number of changes after which contacts are first stored: most solves need fewer.
const CHANGES_BEFORE_STORING: usize = 4;

/// A search for cycles among the solves of one section (R. P. Brent, "An improved Monte Carlo
/// factorization algorithm", BIT 20, 1980): contacts are stored after 4, 8, 16 … changes, and later
/// ones are compared with them.
#[derive(Debug, Default)]
pub(super) struct CycleSearch {
    changes: usize,
    contacts: Vec<Contact>,
    repeats: usize,
}

impl CycleSearch {
    /// Records a solved section; returns whether it is in a cycle.
    pub fn returns(&mut self, section: &CableSection) -> bool {
        self.changes += 1;
        if self.changes >= CHANGES_BEFORE_STORING && self.changes.is_power_of_two() {
            self.contacts.clone_from(&section.contacts);
            self.repeats = 0;
            return false;
        }
        let within = SAME_PLACE_FRACTION * (section.to - section.from);
        if self.changes > CHANGES_BEFORE_STORING
            && self.contacts.len() == section.contacts.len()
            && self.contacts.iter().zip(&section.contacts).all(|(a, b)| are_alike(a, b, within))
        {
            self.repeats += 1;
        }
        self.repeats >= REPEATS
    }
}

/// Returns whether two contacts are of the same kind and hold the same material, to within a length
/// (m).
fn are_alike(a: &Contact, b: &Contact, within: f64) -> bool {
    let sticks = |c: &Contact| c.mode == Mode::Stick;
    let near = |a: f64, b: f64| (a - b).abs() <= within;
    (a.curve, a.chain_range, a.wheel, a.next, a.load, a.smooth)
        == (b.curve, b.chain_range, b.wheel, b.next, b.load, b.smooth)
        && sticks(a) == sticks(b)
        && (0..2).all(|k| near(a.ends.material[k], b.ends.material[k]) && near(a.ends.place[k], b.ends.place[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::spans::boundary::{ChainRange, Ends};

    /// A section of 10 m with a contact that begins at each arc length, m.
    fn section(from: &[f64]) -> CableSection {
        let contact = |s: &f64| {
            let ends = Ends { place: [0.0; 2], material: [*s, s + 0.1], tension: [1.0; 2] };
            Contact::new(0, ChainRange { first: 0, last: 0 }, ends, Mode::Stick)
        };
        CableSection { from: 0.0, to: 10.0, contacts: from.iter().map(contact).collect(), ..CableSection::default() }
    }

    #[test]
    fn contacts_that_come_back_are_a_cycle() {
        for period in 1..=6 {
            let mut search = CycleSearch::default();
            let found = (0..200).find(|k| search.returns(&section(&[1.0, 2.0 + f64::from(k % period)])));
            assert!(found.is_some_and(|k| k <= 4 * period + 8), "period {period}: found after {found:?} changes");
        }
    }

    #[test]
    fn contacts_that_move_on_are_none() {
        let mut search = CycleSearch::default();
        assert!((0..200).all(|k| !search.returns(&section(&[1.0, 2.0 + 1e-3 * f64::from(k)]))));
        let mut search = CycleSearch::default();
        assert!((0..30).all(|k| !search.returns(&section(&vec![1.0; k]))));
    }
}
