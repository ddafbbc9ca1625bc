//! A state says where a cable is at an instant, in a form that every model can give and take.

use crate::error::SolveError;
use crate::math::Vec2;
use crate::solution::Node;

/// Part of its radius by which a point on a round may be off it.
const ROUND_TOLERANCE: f64 = 1e-6;

/// Positions, velocities and material coordinates of one cable at an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Time, s.
    pub time_s: f64,
    /// Unstretched arc length of each node at rest temperature, m, increasing.
    pub arc_length_m: Vec<f64>,
    /// Position of each node, m.
    pub position_m: Vec<Vec2>,
    /// Velocity of each node, m/s.
    pub velocity_m_per_s: Vec<Vec2>,
    /// True if the state is one of motion even if every velocity is zero: a model continues from it
    /// without finding an equilibrium first.
    pub in_motion: bool,
}

impl State {
    /// The state of a whole cable at the nodes of its answer. If the answer has two nodes at one
    /// place, as where the tension jumps, the state has one.
    #[must_use]
    pub fn of_nodes(nodes: &[Node], time_s: f64) -> Self {
        let mut state = Self { time_s, ..Self::default() };
        for n in nodes {
            if state.arc_length_m.last().is_none_or(|s| n.arc_length_m > *s) {
                state.arc_length_m.push(n.arc_length_m);
                state.position_m.push(Vec2::new(n.x_m, n.y_m));
                state.velocity_m_per_s.push(Vec2::new(n.vx_m_per_s, n.vy_m_per_s));
            }
        }
        state
    }

    /// The states of the pieces of a broken cable, whose nodes at a break have the same arc length.
    #[must_use]
    pub(crate) fn pieces(&self) -> Vec<Self> {
        let s = &self.arc_length_m;
        let breaks = || (1..s.len()).filter(|&k| s[k] <= s[k - 1]);
        let ends = std::iter::once(0).chain(breaks()).zip(breaks().chain([s.len()]));
        let piece = |(a, b): (usize, usize)| Self {
            arc_length_m: s[a..b].to_vec(),
            position_m: self.position_m.get(a..b).unwrap_or_default().to_vec(),
            velocity_m_per_s: self.velocity_m_per_s.get(a..b).unwrap_or_default().to_vec(),
            ..*self
        };
        ends.map(piece).collect()
    }

    /// Returns whether it is a state of motion: said to be one, or with a velocity.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.in_motion || self.velocity_m_per_s.iter().any(|v| v.norm() > 0.0)
    }

    /// The first node with a number that is not finite.
    #[must_use]
    pub(crate) fn first_non_finite(&self) -> Option<usize> {
        (0..self.position_m.len()).find(|&i| {
            !(self.position_m[i].iter().all(|v| v.is_finite())
                && self.velocity_m_per_s.get(i).is_none_or(|v| v.iter().all(|c| c.is_finite())))
        })
    }

    /// The refusal of a state that holds a number that is not finite.
    #[must_use]
    pub(crate) fn refuse_non_finite(&self) -> Option<SolveError> {
        let node = self.first_non_finite()?;
        let arc_length_m = self.arc_length_m.get(node).copied().unwrap_or(f64::NAN);
        Some(SolveError::NonFinite { quantity: "position or velocity", arc_length_m, time_s: self.time_s })
    }

    /// Arc lengths between which it lies on a round of a radius (m); those of the place nearest to
    /// its centre if it does not.
    #[must_use]
    pub(crate) fn on_round(&self, center: Vec2, radius: f64) -> Option<[f64; 2]> {
        let on = |p: &Vec2| radius > 0.0 && ((p - center).norm() - radius).abs() <= ROUND_TOLERANCE * radius;
        let (first, last) = (self.position_m.iter().position(on), self.position_m.iter().rposition(on));
        match (first.and_then(|k| self.arc_length_m.get(k)), last.and_then(|k| self.arc_length_m.get(k))) {
            (Some(a), Some(b)) => Some([*a, *b]),
            _ => self.nearest(center).map(|s| [s; 2]),
        }
    }

    /// Arc length where the cable is nearest to a point, m.
    #[must_use]
    pub(crate) fn nearest(&self, to: Vec2) -> Option<f64> {
        let mut best: Option<(f64, f64)> = None;
        for (p, s) in self.position_m.windows(2).zip(self.arc_length_m.windows(2)) {
            let f = crate::contact::distance::nearest_fraction(to, p[0], p[1]);
            let d = (p[0] + (p[1] - p[0]) * f - to).norm();
            if best.is_none_or(|b| d < b.0) {
                best = Some((d, s[0] + f * (s[1] - s[0])));
            }
        }
        best.map(|b| b.1)
    }

    /// Position at a material coordinate, linear between nodes, m.
    #[must_use]
    pub fn position_at(&self, arc_length_m: f64) -> Option<Vec2> {
        self.between(&self.position_m, arc_length_m)
    }

    /// Velocity at a material coordinate, linear between nodes, m/s.
    #[must_use]
    pub fn velocity_at(&self, arc_length_m: f64) -> Option<Vec2> {
        self.between(&self.velocity_m_per_s, arc_length_m)
    }

    /// The value at an arc length (m), linear between nodes.
    fn between(&self, values: &[Vec2], arc_length_m: f64) -> Option<Vec2> {
        let n = self.arc_length_m.len();
        let k = self.arc_length_m.partition_point(|&s| s <= arc_length_m).clamp(1, n.max(2) - 1);
        let (s0, s1) = (*self.arc_length_m.get(k - 1)?, *self.arc_length_m.get(k)?);
        let (a, b) = (*values.get(k - 1)?, *values.get(k)?);
        let f = if s1 > s0 { ((arc_length_m - s0) / (s1 - s0)).clamp(0.0, 1.0) } else { 0.0 };
        Some(a + (b - a) * f)
    }
}
