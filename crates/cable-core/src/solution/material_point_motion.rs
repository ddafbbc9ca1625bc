//! Displacements and accelerations follow each material point of a cable, whatever the nodes do.

use super::Node;
use crate::math::Vec2;

/// The vector that `of` reads of nodes at an arc length (m), between the two of the nearest ones;
/// None of a cable without nodes.
fn at(nodes: &[Node], arc_length: f64, of: impl Fn(&Node) -> Vec2) -> Option<Vec2> {
    let k = nodes.partition_point(|n| n.arc_length_m <= arc_length);
    let (before, after) = (nodes.get(k.saturating_sub(1))?, nodes.get(k).or(nodes.last())?);
    let length = after.arc_length_m - before.arc_length_m;
    let part = if length > 0.0 { ((arc_length - before.arc_length_m) / length).clamp(0.0, 1.0) } else { 0.0 };
    Some(of(before) * (1.0 - part) + of(after) * part)
}

fn velocity(node: &Node) -> Vec2 {
    Vec2::new(node.vx_m_per_s, node.vy_m_per_s)
}

/// Tells nodes how far they are from where they were at first.
pub(crate) fn displace(nodes: &mut [Node], first: &[Node]) {
    for n in nodes {
        let moved = at(first, n.arc_length_m, Node::at).map_or(Vec2::zeros(), |was| n.at() - was);
        n.displacement_m = [moved.x, moved.y];
    }
}

/// Tells nodes the mean acceleration since they were as `before`, `passed` (s) ago.
pub(crate) fn accelerate(nodes: &mut [Node], before: &[Node], passed: f64) {
    for n in nodes {
        let rate = at(before, n.arc_length_m, velocity).map_or(Vec2::zeros(), |was| (velocity(n) - was) / passed);
        n.acceleration_m_per_s2 = [rate.x, rate.y];
    }
}
