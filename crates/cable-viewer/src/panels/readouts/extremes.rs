//! These figures of a cable's answer are neither in it nor in its summary as they stand.

use cable_core::solution::{CableSolution, Node};

/// Greatest value of a quantity along a cable and the node it is at; nodes where it is not finite
/// are left out. Of equal ones it is the first, as in [`cable_core::Solution::max_tension`]: the
/// picture names that place.
#[must_use]
pub fn greatest(cable: &CableSolution, of: impl Fn(&Node) -> f64) -> Option<(f64, Node)> {
    let values = cable.nodes.iter().map(|n| (of(n), *n)).filter(|(v, _)| v.is_finite());
    values.reduce(|a, b| if b.0 > a.0 { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_finite_are_passed_over() {
        let mut cable = CableSolution { nodes: vec![Node::default(); 9].into(), ..CableSolution::default() };
        cable.nodes[3].tension_n = f64::NAN;
        cable.nodes[4].tension_n = 7.0;
        assert_eq!(greatest(&cable, |n| n.tension_n).unwrap().0, 7.0);
        // Issue 20: at a hanging span the picture named one end and the readouts the other.
        (cable.nodes[4].x_m, cable.nodes[6].x_m, cable.nodes[6].tension_n) = (1.0, 2.0, 7.0);
        assert_eq!(greatest(&cable, |n| n.tension_n).unwrap().1.x_m, 1.0);
        assert!(greatest(&CableSolution::default(), |n| n.tension_n).is_none());
    }
}
