//! The moments in the relaxation branches of the bends of a mesh, the memory of material loss in
//! bending (`model/material_loss.rs`).
//!
//! They belong to the material beside a node. Each node has two slots, one for the half bar before
//! it and one for that after it: a clamp bends the two halves by themselves, and a bend between two
//! bars has the same moments in both. Moments are positive where the cable turns to the left. A new
//! node has the moments of the material between its neighbours, by arc length. Where nothing is
//! bent (at a sliding node and beside it) there are none.

/// The moments in the branches of every slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model::fem) struct BranchMoments {
    /// Number of branches of a bend.
    branches: usize,
    /// One slot after the other, N·m; empty: all are zero.
    moments: Vec<f64>,
}

impl BranchMoments {
    /// The sum of the moments in the branches of a bend in two slots, N·m.
    pub(in crate::model::fem) fn sum(&self, slots: [usize; 2]) -> f64 {
        0.5 * slots.iter().map(|slot| self.of_slot(*slot).iter().sum::<f64>()).sum::<f64>()
    }

    /// The sum of the moments that a step in which each decays by a factor leaves of a bend, N·m.
    pub(in crate::model::fem) fn remainder(&self, slots: [usize; 2], decay: &[f64]) -> f64 {
        let of = |slot: usize| self.of_slot(slot).iter().zip(decay).map(|(m, d)| m * d).sum::<f64>();
        0.5 * (of(slots[0]) + of(slots[1]))
    }

    /// The moments in the branches of a slot, N·m; none if all are zero.
    fn of_slot(&self, slot: usize) -> &[f64] {
        self.moments.get(slot * self.branches..(slot + 1) * self.branches).unwrap_or_default()
    }

    /// The moments in the branches of the slots of `nodes` nodes, one slot after the other, N·m.
    pub(in crate::model::fem) fn of_all(&mut self, nodes: usize, branches: usize) -> &mut [f64] {
        if self.branches != branches || self.moments.len() != 2 * nodes * branches {
            self.branches = branches;
            self.moments.clear();
            self.moments.resize(2 * nodes * branches, 0.0);
        }
        &mut self.moments
    }

    /// Makes all moments zero.
    pub(in crate::model::fem) fn clear(&mut self) {
        self.moments.clear();
    }

    /// Becomes a copy of `other`, reusing its memory.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.branches = other.branches;
        self.moments.clone_from(&other.moments);
    }

    /// Puts a node before node `k`, at a fraction `part` of the way to it from the node before.
    pub(super) fn insert_node(&mut self, k: usize, part: f64) {
        let count = self.branches;
        let at = 2 * k * count;
        if k == 0 || at + count > self.moments.len() {
            return;
        }
        let between = |j: usize| (1.0 - part) * self.moments[at - count + j] + part * self.moments[at + j];
        let new: Vec<f64> = (0..2 * count).map(|j| between(j % count)).collect();
        self.moments.splice(at..at, new);
    }

    /// Breaks the cable at node `k`: there are two nodes in its place, which nothing bends.
    pub(super) fn break_at(&mut self, k: usize) {
        let (at, slots) = (2 * k * self.branches, 2 * self.branches);
        if !self.moments.is_empty() && at + slots <= self.moments.len() {
            self.moments.splice(at..at + slots, std::iter::repeat_n(0.0, 2 * slots));
        }
    }

    /// Removes node `k`.
    pub(super) fn remove_node(&mut self, k: usize) {
        let (at, slots) = (2 * k * self.branches, 2 * self.branches);
        if at + slots <= self.moments.len() {
            self.moments.drain(at..at + slots);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(values: &[f64]) -> BranchMoments {
        BranchMoments { branches: 1, moments: values.to_vec() }
    }

    #[test]
    fn a_new_node_has_the_moments_of_the_material_between_its_neighbours() {
        let mut two = moments(&[0.0, 1.0, 5.0, 5.0]);
        two.insert_node(1, 0.25);
        assert_eq!(two, moments(&[0.0, 1.0, 2.0, 2.0, 5.0, 5.0]));
        assert_eq!((two.sum([2, 3]), two.sum([0, 1]), two.sum([1, 1])), (2.0, 0.5, 1.0));
        assert_eq!(two.remainder([2, 3], &[0.5]), 1.0);
        two.break_at(1);
        assert_eq!(two, moments(&[0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 5.0, 5.0]));
        two.remove_node(1);
        assert_eq!(two, moments(&[0.0, 1.0, 0.0, 0.0, 5.0, 5.0]));
    }

    #[test]
    fn moments_that_are_zero_stay_zero() {
        let mut none = BranchMoments::default();
        none.insert_node(1, 0.5);
        none.break_at(1);
        none.remove_node(1);
        assert_eq!((none.sum([4, 5]), none), (0.0, BranchMoments::default()));
    }
}
