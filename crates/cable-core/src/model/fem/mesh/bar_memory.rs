//! Every bar of a mesh remembers values from step to step: the forces in its relaxation branches,
//! the memory of material loss in stretching (`model/material_loss.rs`), or the impulse that the
//! integrator remembers (`time/slack_recoil.rs`).
//!
//! It belongs to the bars. A bar that is divided gives it to both parts, and one bar that takes the
//! place of two has the mean of theirs by length, as it has the mean of their strains. Material
//! that slides from bar to bar takes on the memory of the bar to which it comes. It gains or loses
//! by that at most the energy in the branches, some 1e-4 of that of the stretch.

/// Values that every bar remembers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model::fem) struct BarMemory {
    /// Number of values of a bar.
    count: usize,
    /// One bar after the other; empty: all are zero.
    values: Vec<f64>,
}

impl BarMemory {
    /// The values of bar `e`; none if all are zero.
    #[inline]
    pub(in crate::model::fem) fn of_bar(&self, e: usize) -> &[f64] {
        self.values.get(e * self.count..(e + 1) * self.count).unwrap_or_default()
    }

    /// The sum of the values of bar `e`.
    #[inline]
    pub(in crate::model::fem) fn sum(&self, e: usize) -> f64 {
        self.of_bar(e).iter().sum()
    }

    /// The values of `bars` bars, `count` of each, one bar after the other.
    pub(in crate::model::fem) fn of_all(&mut self, bars: usize, count: usize) -> &mut [f64] {
        if self.count != count || self.values.len() != bars * count {
            self.count = count;
            self.values.clear();
            self.values.resize(bars * count, 0.0);
        }
        &mut self.values
    }

    /// True if all values are zero.
    pub(in crate::model::fem) fn is_zero(&self) -> bool {
        self.values.is_empty()
    }

    /// Makes all values zero.
    pub(in crate::model::fem) fn clear(&mut self) {
        self.values.clear();
    }

    /// Becomes a copy of `other`, reusing its memory.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.count = other.count;
        self.values.clone_from(&other.values);
    }

    /// Divides bar `e` into two.
    pub(super) fn divide(&mut self, e: usize) {
        let (from, to) = (e * self.count, (e + 1) * self.count);
        if to <= self.values.len() {
            self.values.extend_from_within(from..to);
            self.values[to..].rotate_right(self.count);
        }
    }

    /// Puts a break before bar `e`.
    pub(super) fn insert_break(&mut self, e: usize) {
        let at = e * self.count;
        if !self.values.is_empty() && at <= self.values.len() {
            self.values.splice(at..at, std::iter::repeat_n(0.0, self.count));
        }
    }

    /// Puts one bar in the place of bars `e` and `e` + 1, of which the first has a fraction `part`
    /// of the length.
    pub(super) fn merge(&mut self, e: usize, part: f64) {
        let (from, to) = (e * self.count, (e + 1) * self.count);
        if to + self.count > self.values.len() {
            return;
        }
        for k in from..to {
            self.values[k] = part * self.values[k] + (1.0 - part) * self.values[k + self.count];
        }
        self.values.drain(to..to + self.count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(values: &[f64]) -> BarMemory {
        BarMemory { count: 2, values: values.to_vec() }
    }

    #[test]
    fn parts_of_a_bar_have_its_values_and_a_merged_bar_has_their_mean() {
        let mut three = values(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        three.divide(1);
        assert_eq!(three, values(&[1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 5.0, 6.0]));
        three.merge(1, 0.5);
        assert_eq!(three, values(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        three.merge(0, 0.75);
        assert_eq!(three, values(&[1.5, 2.5, 5.0, 6.0]));
        three.insert_break(1);
        assert_eq!(three, values(&[1.5, 2.5, 0.0, 0.0, 5.0, 6.0]));
        assert_eq!((three.sum(0), three.sum(1), three.sum(9)), (4.0, 0.0, 0.0));
    }

    #[test]
    fn values_that_are_zero_stay_zero() {
        let mut none = BarMemory::default();
        none.divide(0);
        none.insert_break(2);
        none.merge(0, 0.5);
        assert_eq!((none.sum(0), none.of_bar(3).len()), (0.0, 0));
    }
}
