//! Displacements and accelerations follow each material point of a cable, whatever the nodes do.

use crate::math::Vec2;
use crate::solution::Node;

/// A vector at each of some arc lengths (m, increasing).
#[derive(Clone, Debug, Default)]
pub(crate) struct AlongCable(Vec<(f64, Vec2)>);

impl AlongCable {
    /// Places of nodes, m.
    pub fn places(nodes: &[Node]) -> Self {
        Self(nodes.iter().map(|n| (n.arc_length_m, n.at())).collect())
    }

    /// Velocities of nodes, m/s.
    pub fn velocities(nodes: &[Node]) -> Self {
        Self(nodes.iter().map(|n| (n.arc_length_m, Vec2::new(n.vx_m_per_s, n.vy_m_per_s))).collect())
    }

    /// The vector at an arc length (m), between the two of the nearest ones; None of a cable
    /// without nodes.
    fn at(&self, arc_length: f64) -> Option<Vec2> {
        let k = self.0.partition_point(|(s, _)| *s <= arc_length);
        let (before, after) = (self.0.get(k.saturating_sub(1))?, self.0.get(k).or(self.0.last())?);
        let length = after.0 - before.0;
        let part = if length > 0.0 { ((arc_length - before.0) / length).clamp(0.0, 1.0) } else { 0.0 };
        Some(before.1 * (1.0 - part) + after.1 * part)
    }
}

/// Tells nodes how far they are from where they were at first.
pub(crate) fn displace(nodes: &mut [Node], first: &AlongCable) {
    for n in nodes {
        let moved = first.at(n.arc_length_m).map_or(Vec2::zeros(), |was| n.at() - was);
        n.displacement_m = [moved.x, moved.y];
    }
}

/// Tells nodes the mean acceleration since they had the velocities `before`, `passed` (s) ago.
pub(crate) fn accelerate(nodes: &mut [Node], before: &AlongCable, passed: f64) {
    for n in nodes {
        let now = Vec2::new(n.vx_m_per_s, n.vy_m_per_s);
        let rate = before.at(n.arc_length_m).map_or(Vec2::zeros(), |was| (now - was) / passed);
        n.acceleration_m_per_s2 = [rate.x, rate.y];
    }
}
