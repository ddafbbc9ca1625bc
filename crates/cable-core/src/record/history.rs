//! The history keeps the course of a simulation in memory, within a stated budget.

use crate::solution::{CableSolution, ContactReport, Node, Solution, SupportReaction, Warning};

/// Solutions by time, oldest thinned out when a memory budget is reached.
///
/// Thinning halves the rate of the older three quarters where it is highest, so the recent past
/// keeps its full rate and the distant past an even, ever coarser one; the first and the last entry
/// are always kept.
#[derive(Clone, Debug)]
pub struct History {
    entries: Vec<Solution>,
    bytes: usize,
    budget_bytes: usize,
}

impl History {
    /// An empty history that holds at most `budget_bytes` of memory (two entries are kept whatever
    /// their size).
    #[must_use]
    pub fn new(budget_bytes: usize) -> Self {
        Self { entries: Vec::new(), bytes: 0, budget_bytes }
    }

    /// Appends a solution. Entries at its time or later are dropped first, so that a run that was
    /// wound back continues from there.
    pub fn push(&mut self, solution: Solution) {
        self.truncate_from(solution.time_s);
        self.bytes += size_of_solution(&solution);
        self.entries.push(solution);
        while self.bytes > self.budget_bytes && self.entries.len() > 2 {
            self.decimate();
        }
    }

    /// Drops every entry at `time_s` or later.
    pub(crate) fn truncate_from(&mut self, time_s: f64) {
        let keep = self.entries.partition_point(|e| e.time_s < time_s);
        self.bytes -= self.entries[keep..].iter().map(size_of_solution).sum::<usize>();
        self.entries.truncate(keep);
    }

    /// Halves the rate where it is highest among the older three quarters: the far past becomes
    /// evenly coarser.
    fn decimate(&mut self) {
        let older = (self.entries.len() * 3 / 4).max(2);
        let gaps = self.entries.windows(2).take(older - 1).filter_map(|w| Some(w.last()?.time_s - w.first()?.time_s));
        let least = gaps.fold(f64::INFINITY, |a, b| if b < a { b } else { a });
        let (mut index, mut freed, mut kept_s) = (0, 0, f64::NEG_INFINITY);
        self.entries.retain(|e| {
            // Entry 1 goes in any case where it is the only one that can.
            let close = e.time_s - kept_s < 1.5 * least || older == 2;
            let drop = index > 0 && index < older && close;
            index += 1;
            if drop {
                freed += size_of_solution(e);
            } else {
                kept_s = e.time_s;
            }
            !drop
        });
        self.bytes -= freed;
    }

    /// The last entry at or before a time (s); None before the first.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Option<&Solution> {
        self.entries.partition_point(|e| e.time_s <= time_s).checked_sub(1).and_then(|i| self.entries.get(i))
    }

    /// Every entry, oldest first.
    #[must_use]
    pub fn entries(&self) -> &[Solution] {
        &self.entries
    }

    /// Memory the entries hold, bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.bytes = 0;
    }
}

/// Memory of a solution: its own and what it points to, bytes (names are counted by their text).
fn size_of_solution(s: &Solution) -> usize {
    let cable = |c: &CableSolution| {
        size_of::<CableSolution>()
            + c.name.len()
            + c.nodes.len() * size_of::<Node>()
            + c.supports.iter().map(|s| size_of::<SupportReaction>() + s.name.len()).sum::<usize>()
            + c.contacts.iter().map(|k| size_of::<ContactReport>() + k.obstacle.len()).sum::<usize>()
    };
    size_of::<Solution>()
        + s.cables.iter().map(cable).sum::<usize>()
        + s.warnings.iter().map(|w| size_of::<Warning>() + w.cable.len()).sum::<usize>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::solution::{Cost, Energy, ModelReason};

    fn at(time_s: f64) -> Solution {
        let cable = CableSolution { nodes: vec![Node::default(); 100].into(), ..CableSolution::default() };
        Solution {
            time_s,
            model: Model::Fem,
            reason: ModelReason::Requested,
            next_cheaper: None,
            cables: vec![cable],
            warnings: Vec::new(),
            cost: Cost::default(),
            energy: Energy::default(),
            robot: None,
            verification: None,
        }
    }

    #[test]
    fn budget_holds_and_ends_are_kept() {
        let one = size_of_solution(&at(0.0));
        let mut h = History::new(20 * one);
        for k in 0..1000 {
            h.push(at(f64::from(k)));
            assert!(h.bytes() <= 20 * one);
            assert_eq!(h.bytes(), h.entries().len() * one, "the running count is exact");
        }
        assert_eq!(h.entries()[0].time_s, 0.0);
        assert_eq!(h.entries().last().unwrap().time_s, 999.0);
        assert!(h.entries().windows(2).all(|w| w[0].time_s < w[1].time_s));
        // The recent past is at full rate.
        let n = h.entries().len();
        assert_eq!(h.entries()[n - 3].time_s, 997.0);
    }

    #[test]
    fn a_budget_too_small_for_two_still_keeps_two() {
        let mut h = History::new(1);
        for k in 0..5 {
            h.push(at(f64::from(k)));
        }
        assert_eq!(h.entries().iter().map(|e| e.time_s).collect::<Vec<_>>(), [0.0, 4.0]);
    }

    #[test]
    fn lookup_and_winding_back() {
        let mut h = History::new(usize::MAX);
        assert!(h.at(0.0).is_none());
        for k in 0..10 {
            h.push(at(f64::from(k)));
        }
        assert!(h.at(-0.1).is_none());
        assert_eq!(h.at(3.7).unwrap().time_s, 3.0);
        assert_eq!(h.at(99.0).unwrap().time_s, 9.0);
        h.push(at(4.0));
        assert_eq!(h.entries().len(), 5);
        h.clear();
        assert_eq!(h.bytes(), 0);
    }
}
