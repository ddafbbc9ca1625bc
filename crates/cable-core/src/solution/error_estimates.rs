//! The errors of an answer's figures are estimated from a better answer to the same question.

use serde::{Deserialize, Serialize};

use super::{CableSolution, Node};
use crate::math::{Vec2, larger, perp};

/// By how much more is said than what two answers differ by: the better one's figures are read at
/// its nodes. Less: one in twenty errors of cables in the air, known to be small, is 0.1 % more
/// than is said; more: nothing is gained.
const READING_FACTOR: f64 = 1.01;

/// Estimated errors of an answer for one cable; `None` if an error is not known or the quantity
/// does not exist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimates {
    /// Of the greatest tension, N.
    pub max_tension_n: Option<f64>,
    /// Of the force vector on any support, N.
    pub support_force_n: Option<f64>,
    /// Of the force vector that any obstacle puts on the cable in all, N.
    pub contact_force_n: Option<f64>,
    /// Of the place of any node: how far its material is from there, m.
    pub position_m: Option<f64>,
}

impl ErrorEstimates {
    /// Returns what an answer's figures differ by from a better one's.
    #[must_use]
    pub fn between(answer: &CableSolution, better: &CableSolution) -> Self {
        let supports = answer.supports.iter().zip(&better.supports);
        let off = supports.map(|(a, b)| (a.reaction_x_n - b.reaction_x_n).hypot(a.reaction_y_n - b.reaction_y_n));
        let moved = answer.nodes.iter().filter_map(|n| Some((place(&better.nodes, n.arc_length_m)? - n.at()).norm()));
        let touched: Vec<f64> =
            obstacles(answer, better).map(|name| (force_of(answer, name) - force_of(better, name)).norm()).collect();
        let apart = Self {
            max_tension_n: Some((greatest_tension(&answer.nodes) - greatest_tension(&better.nodes)).abs()),
            support_force_n: Some(off.fold(0.0, larger)),
            contact_force_n: touched.into_iter().reduce(larger),
            position_m: Some(moved.fold(0.0, larger)),
        };
        apart.times(READING_FACTOR)
    }

    /// Forces known to a part of the largest force in the cable; of the shape nothing is.
    #[must_use]
    pub(crate) fn of_forces(answer: &CableSolution, part: Option<f64>) -> Self {
        let force = part.map(|p| p * largest_force(answer));
        let touches = !answer.contacts.is_empty();
        let contact_force_n = force.filter(|_| touches);
        Self { max_tension_n: force, support_force_n: force, contact_force_n, position_m: None }
    }

    /// The error of forces, of the greatest tension and of any support, in parts of what the
    /// largest force in the cable is at least: of its greatest tension where it pulls.
    #[must_use]
    pub fn relative(&self, answer: &CableSolution) -> Option<f64> {
        let (force, most) = (larger(self.max_tension_n?, self.support_force_n?), largest_force(answer));
        let least = if force < 0.5 * most { most - force } else { most };
        Some(if least > 0.0 { force / least } else { force })
    }

    /// Each the larger of two; what one of them does not know is not known.
    #[must_use]
    pub(crate) fn componentwise_max(&self, other: &Self) -> Self {
        self.with(other, larger)
    }

    /// Each the sum of two; what one of them does not know is not known.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        self.with(other, |a, b| a + b)
    }

    /// Each times a factor.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        self.with(self, |a, _| a * factor)
    }

    /// Joins the estimates of two answers figure by figure; unknown if one is, but for contact
    /// forces.
    pub(crate) fn with(&self, other: &Self, join: impl Fn(f64, f64) -> f64) -> Self {
        let both = |a: Option<f64>, b: Option<f64>| Some(join(a?, b?));
        // If only one of two answers has a contact, the contact force of the other is zero.
        let contact_force_n = match (self.contact_force_n, other.contact_force_n) {
            (Some(a), Some(b)) => Some(join(a, b)),
            (a, b) => a.or(b),
        };
        Self {
            max_tension_n: both(self.max_tension_n, other.max_tension_n),
            support_force_n: both(self.support_force_n, other.support_force_n),
            contact_force_n,
            position_m: both(self.position_m, other.position_m),
        }
    }

    /// Lengths by a factor; forces stay.
    pub(crate) fn scale_lengths(&mut self, factor: f64) {
        self.position_m = self.position_m.map(|p| p * factor);
    }

    /// Returns whether every figure that is known is a number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let all = [self.max_tension_n, self.support_force_n, self.contact_force_n, self.position_m];
        all.into_iter().flatten().all(f64::is_finite)
    }
}

impl CableSolution {
    /// The same with its errors.
    pub(crate) fn known_to(mut self, errors: ErrorEstimates) -> Self {
        (self.error_estimate, self.errors) = (errors.relative(&self), errors);
        self
    }
}

/// Most that the curve between two nodes turns for its place to be read from their curvatures, rad:
/// beyond, it is a corner or a fold.
const MAX_TURN: f64 = 1.0;

/// Least number of elements of a mesh with which a finer one is compared: the errors of fewer say
/// nothing about those of more.
pub(crate) const MIN_COMPARED_ELEMENTS: usize = 4;

/// Curvatures of two neighbours on one curve differ by no more than this factor. Less: catenaries
/// on few nodes are read as straighter than they are; more: what leaves a round is bent.
const MAX_CURVATURE_RATIO: f64 = 3.0;

impl CableSolution {
    /// Returns where the cable is at an arc length, m: between two nodes on the curve that has
    /// their mean curvature.
    #[must_use]
    pub fn position_at(&self, arc_length_m: f64) -> Option<Vec2> {
        place(&self.nodes, arc_length_m)
    }
}

/// Returns where the cable is at an arc length, m: between two nodes on the curve that has their
/// mean curvature and leaves both symmetrically, which is a circle's to the fourth order in the
/// distance of the nodes; a straight line between them is of the second.
#[must_use]
pub(crate) fn place(nodes: &[Node], arc_length_m: f64) -> Option<Vec2> {
    let k = nodes.partition_point(|n| n.arc_length_m < arc_length_m);
    let (Some(a), Some(b)) = (k.checked_sub(1).and_then(|k| nodes.get(k)), nodes.get(k)) else {
        return nodes.get(k).or(nodes.last()).map(Node::at);
    };
    let (ds, chord) = (b.arc_length_m - a.arc_length_m, b.at() - a.at());
    let f = (arc_length_m - a.arc_length_m) / ds;
    let half = 0.5 * ds * between_curvatures(a.curvature_per_m, b.curvature_per_m);
    if !(half.abs() <= 0.5 * MAX_TURN) {
        return Some(a.at() + chord * f);
    }
    let speed = if half == 0.0 { 1.0 } else { half / half.sin() };
    let (along, across) = (chord * (speed * half.cos()), perp(chord) * (speed * half.sin()));
    let (start, end) = (along - across, along + across);
    // Hermite's cubic.
    let g = 1.0 - f;
    Some(
        a.at() * (g * g * (1.0 + 2.0 * f)) + b.at() * (f * f * (1.0 + 2.0 * g)) + start * (f * g * g)
            - end * (g * f * f),
    )
}

/// Curvature between two nodes, 1/m: their mean; where one lies at the end of a round and has that
/// of the round, the other's, and none where they bend to different sides.
fn between_curvatures(a: f64, b: f64) -> f64 {
    let (least, most) = if a.abs() < b.abs() { (a, b) } else { (b, a) };
    match least * most > 0.0 {
        true if most.abs() <= MAX_CURVATURE_RATIO * least.abs() => 0.5 * (a + b),
        true => least,
        false => 0.0,
    }
}

/// The greatest tension, less than zero where the whole of a stiff cable is compressed, N.
pub(crate) fn greatest_tension(nodes: &[Node]) -> f64 {
    nodes.iter().map(|n| n.tension_n).reduce(larger).unwrap_or(0.0)
}

/// The largest force in the cable, N: its greatest tension, or what compresses or shears a stiff
/// one.
pub(crate) fn largest_force(c: &CableSolution) -> f64 {
    let along = c.nodes.iter().map(|n| n.tension_n.abs()).fold(0.0, larger);
    // A flexible cable is not sheared, and a support in its middle bears more than its tension.
    if c.assumptions.bending_stiffness_n_m2 == 0.0 {
        return along;
    }
    let ends = c.supports.first().into_iter().chain(c.supports.last());
    ends.map(|s| s.reaction_x_n.hypot(s.reaction_y_n)).fold(along, larger)
}

/// The obstacles that either answer touches, each once.
fn obstacles<'a>(a: &'a CableSolution, b: &'a CableSolution) -> impl Iterator<Item = &'a str> {
    let mut names: Vec<&str> = a.contacts.iter().chain(&b.contacts).map(|c| c.obstacle.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names.into_iter()
}

fn force_of(c: &CableSolution, obstacle: &str) -> Vec2 {
    let its = c.contacts.iter().filter(|k| k.obstacle == obstacle);
    its.map(|k| Vec2::new(k.force_n[0], k.force_n[1])).sum()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a failing test is meant to panic
mod tests {
    use super::*;

    fn node(s: f64, y: f64, tension_n: f64) -> Node {
        Node { arc_length_m: s, x_m: s, y_m: y, tension_n, ..Node::default() }
    }

    #[test]
    fn a_round_is_read_between_its_nodes() {
        let at = |angle: f64| Node {
            arc_length_m: 2.0 * angle,
            x_m: 2.0 * angle.sin(),
            y_m: 2.0 - 2.0 * angle.cos(),
            curvature_per_m: 0.5,
            ..Node::default()
        };
        let off = |step: f64| {
            let nodes: Vec<Node> = (0..=4).map(|k| at(step * f64::from(k))).collect();
            let tries = (0..40).map(|k| 0.1 * step * f64::from(k));
            tries.map(|a| (place(&nodes, 2.0 * a).unwrap() - at(a).at()).norm()).fold(0.0, larger)
        };
        assert!(off(0.2) < 2e-5 && off(0.1) < off(0.2) / 14.0, "{:e} {:e}", off(0.2), off(0.1));
    }

    #[test]
    fn figures_of_two_answers_differ_each_by_its_own() {
        let one =
            CableSolution { nodes: vec![node(0.0, 0.0, 3.0), node(1.0, 0.0, 4.0)].into(), ..CableSolution::default() };
        let two =
            CableSolution { nodes: vec![node(0.0, 0.0, 3.0), node(1.0, 0.5, 4.5)].into(), ..CableSolution::default() };
        let off = ErrorEstimates::between(&one, &two);
        assert_eq!(
            (off.max_tension_n, off.position_m, off.contact_force_n),
            (Some(0.5 * READING_FACTOR), Some(0.5 * READING_FACTOR), None)
        );
        assert_eq!(off.componentwise_max(&off.times(3.0)).max_tension_n, Some(1.5 * READING_FACTOR));
        assert_eq!(off.componentwise_max(&ErrorEstimates::default()).max_tension_n, None);
    }
}
