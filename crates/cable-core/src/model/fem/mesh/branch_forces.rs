//! The forces in the relaxation branches of the bars of a mesh, the memory of material loss
//! in stretching (`model/material_loss.rs`).
//!
//! They belong to the bars. A bar that is divided gives its forces to both parts, and one bar that
//! takes the place of two has the mean of theirs by length, as it has the mean of their strains.
//! Material that slides from bar to bar takes on the forces of the bar to which it comes. It gains
//! or loses by that at most the energy in the branches, some 1e-4 of that of the stretch.

/// The forces in the branches of every bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model::fem) struct BranchForces {
    /// Number of branches of a bar.
    branches: usize,
    /// One bar after the other, N; empty: all are zero.
    forces: Vec<f64>,
}

impl BranchForces {
    /// The forces in the branches of bar `e`, N; none if all are zero.
    #[inline]
    pub(in crate::model::fem) fn of_bar(&self, e: usize) -> &[f64] {
        self.forces.get(e * self.branches..(e + 1) * self.branches).unwrap_or_default()
    }

    /// The sum of the forces in the branches of bar `e`, N.
    #[inline]
    pub(in crate::model::fem) fn sum(&self, e: usize) -> f64 {
        self.of_bar(e).iter().sum()
    }

    /// The forces in the branches of `bars` bars, one bar after the other, N.
    pub(in crate::model::fem) fn of_all(&mut self, bars: usize, branches: usize) -> &mut [f64] {
        if self.branches != branches || self.forces.len() != bars * branches {
            self.branches = branches;
            self.forces.clear();
            self.forces.resize(bars * branches, 0.0);
        }
        &mut self.forces
    }

    /// Makes all forces zero.
    pub(in crate::model::fem) fn clear(&mut self) {
        self.forces.clear();
    }

    /// Becomes a copy of `other`, reusing its memory.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.branches = other.branches;
        self.forces.clone_from(&other.forces);
    }

    /// Divides bar `e` into two.
    pub(super) fn divide(&mut self, e: usize) {
        let (from, to) = (e * self.branches, (e + 1) * self.branches);
        if to <= self.forces.len() {
            self.forces.extend_from_within(from..to);
            self.forces[to..].rotate_right(self.branches);
        }
    }

    /// Puts a break before bar `e`.
    pub(super) fn insert_break(&mut self, e: usize) {
        let at = e * self.branches;
        if !self.forces.is_empty() && at <= self.forces.len() {
            self.forces.splice(at..at, std::iter::repeat_n(0.0, self.branches));
        }
    }

    /// Puts one bar in the place of bars `e` and `e` + 1, of which the first has a fraction `part`
    /// of the length.
    pub(super) fn merge(&mut self, e: usize, part: f64) {
        let (from, to) = (e * self.branches, (e + 1) * self.branches);
        if to + self.branches > self.forces.len() {
            return;
        }
        for k in from..to {
            self.forces[k] = part * self.forces[k] + (1.0 - part) * self.forces[k + self.branches];
        }
        self.forces.drain(to..to + self.branches);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forces(values: &[f64]) -> BranchForces {
        BranchForces { branches: 2, forces: values.to_vec() }
    }

    #[test]
    fn parts_of_a_bar_have_its_forces_and_a_merged_bar_has_their_mean() {
        let mut three = forces(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        three.divide(1);
        assert_eq!(three, forces(&[1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 5.0, 6.0]));
        three.merge(1, 0.5);
        assert_eq!(three, forces(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        three.merge(0, 0.75);
        assert_eq!(three, forces(&[1.5, 2.5, 5.0, 6.0]));
        three.insert_break(1);
        assert_eq!(three, forces(&[1.5, 2.5, 0.0, 0.0, 5.0, 6.0]));
        assert_eq!((three.sum(0), three.sum(1), three.sum(9)), (4.0, 0.0, 0.0));
    }

    #[test]
    fn forces_that_are_zero_stay_zero() {
        let mut none = BranchForces::default();
        none.divide(0);
        none.insert_break(2);
        none.merge(0, 0.5);
        assert_eq!((none.sum(0), none.of_bar(3).len()), (0.0, 0));
    }
}
