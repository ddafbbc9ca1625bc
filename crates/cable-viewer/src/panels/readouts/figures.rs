//! These figures of a cable's answer are neither in it nor in its summary as they stand.

use cable_core::solution::{CableSolution, Node};

/// Greatest value of a quantity along a cable and the node it is at; nodes where it is not finite
/// are left out.
#[must_use]
pub fn greatest(cable: &CableSolution, of: impl Fn(&Node) -> f64) -> Option<(f64, Node)> {
    let values = cable.nodes.iter().map(|n| (of(n), *n)).filter(|(v, _)| v.is_finite());
    values.max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_finite_are_passed_over() {
        let mut cable = CableSolution { nodes: vec![Node::default(); 9], ..CableSolution::default() };
        cable.nodes[3].tension_n = f64::NAN;
        cable.nodes[4].tension_n = 7.0;
        assert_eq!(greatest(&cable, |n| n.tension_n).unwrap().0, 7.0);
        assert!(greatest(&CableSolution::default(), |n| n.tension_n).is_none());
    }
}
