//! This module finds the other equilibria of a compressed stiff cable: it may bow to either side.
//!
//! A cable beyond its first buckling load rests on either side of the straight line (L. Euler, *De
//! curvis elasticis*, 1744; S. Timoshenko and J. Gere, *Theory of Elastic Stability*, McGraw-Hill
//! 1961). Its mirror image about the chord of its span balances the mirror image of its weight.
//! From there the weight is turned back to where it is.

use crate::math::{Vec2, larger};
use crate::model::fem::free::beam::equilibrium::{Beam, BeamOutcome, nearest_turn};
use crate::model::fem::free::dual_weighted_residual::greatest_distance;
use crate::model::fem::free::stations::Station;

/// Least buckling load of a straight cable in parts of EI/L²: held at one end, free at the other,
/// π²/4.
pub(in crate::model::fem) const LEAST_BUCKLING_LOAD: f64 = 2.467_401_100_272_34;
/// Number of steps in which the mirrored weight is turned back. Smaller: Newton's method fails on
/// the way; larger: more time.
const TURNS_OF_WEIGHT: u32 = 8;
/// Greatest distance of two shapes that count as one, as a fraction of the length. Smaller: the
/// error of the mesh appears as another equilibrium; larger: slightly bowed ones are lost.
pub(in crate::model::fem) const SAME_SHAPE_FRACTION: f64 = 1e-3;
/// Maximum number of spans that are mirrored one at a time. Larger: more time; smaller: a bow in a
/// later span is not found.
const MAX_SPANS: usize = 8;

impl Beam {
    /// The other stable equilibria, with each span alone bowed to its other side, and with all of
    /// them at once. Empty if nothing is compressed enough to buckle.
    #[must_use]
    pub fn other_buckled_shapes(&self) -> Vec<Self> {
        if !(self.compression() > LEAST_BUCKLING_LOAD * self.bending_force()) {
            return Vec::new();
        }
        let parts = self.layout.stations.iter().filter(|s| Station::anchors(s)).count() + 1;
        let alone = (parts > 1).then_some(0..parts).into_iter().flatten().take(MAX_SPANS).map(Some);
        let mut found: Vec<Self> = Vec::new();
        for part in alone.chain([None]) {
            let Some(other) = self.bowed(part) else { continue };
            let points = other.node_points();
            let same =
                |b: &Self| !(greatest_distance(&b.node_points(), &points) > SAME_SHAPE_FRACTION * self.layout.length);
            if !same(self) && !found.iter().any(same) {
                found.push(other);
            }
        }
        found
    }

    /// Greatest compression, N; negative if all of the cable is in tension.
    fn compression(&self) -> f64 {
        let starts = self.stretch_starts();
        let samples = (0..self.bars.len()).flat_map(|e| self.samples(e, &starts));
        samples.map(|p| -p.along).fold(f64::NEG_INFINITY, larger)
    }

    /// The part of the cable in which a stretch lies: between two supports, or beside the first or
    /// the last of them.
    fn part(&self, stretch: usize) -> usize {
        self.layout.stations[..=stretch].iter().filter(|s| Station::anchors(s)).count()
    }

    /// Direction of the chord of each part, and of the weight in one that hangs free; None where
    /// there is neither.
    fn axes(&self) -> Vec<Option<Vec2>> {
        let anchors: Vec<[Vec2; 2]> =
            self.layout.stations.iter().filter_map(|s| Some([s.point(0)?, s.point(1)?])).collect();
        let weight = self.material.body.try_normalize(0.0);
        let chord = |w: &[[Vec2; 2]]| (w[1][0] - w[0][1]).try_normalize(SAME_SHAPE_FRACTION * self.layout.length);
        let between = anchors.windows(2).map(|w| chord(w).or(weight));
        std::iter::once(weight).chain(between).chain([weight]).collect()
    }

    /// The stable equilibrium to which the mirror image of the part `only`, or of all parts, leads.
    fn bowed(&self, only: Option<usize>) -> Option<Self> {
        let axes = self.axes();
        let mirrors = |part: usize| only.is_none_or(|only| only == part);
        let axis = |part: usize| axes.get(part).copied().flatten().filter(|_| mirrors(part));
        let mut other = self.clone();
        let (mut last, mut changed) = (self.angles[0], false);
        for (k, angle) in other.angles.iter_mut().enumerate() {
            let bar = (k / 2).min(self.bars.len() - 1);
            if let Some(u) = axis(self.part(self.bars[bar].stretch)) {
                (*angle, changed) = (2.0 * u.y.atan2(u.x) - *angle, true);
            }
            *angle = nearest_turn(*angle, last);
            last = *angle;
        }
        if !changed {
            return None;
        }
        other.turn_to_clamps();
        // A loop between two clamps is no bow.
        if (other.winding() - self.winding()).abs() > std::f64::consts::PI {
            return None;
        }
        for (force, ends) in other.forces.iter_mut().zip(&self.ends) {
            if let Some(u) = axis(self.part(ends.first)) {
                *force = mirrored(*force, u);
            }
        }
        // All parts have one weight: it is mirrored as for the first part.
        let weight = self.material.body;
        let image = axes.iter().enumerate().find_map(|(part, _)| axis(part)).map_or(weight, |u| mirrored(weight, u));
        let start = (other.angles.clone(), other.forces.clone());
        if other.newton(self.bending) == BeamOutcome::Stable {
            return Some(other);
        }
        (other.angles, other.forces) = start;
        for k in 0..=TURNS_OF_WEIGHT {
            other.material.body = image + (weight - image) * (f64::from(k) / f64::from(TURNS_OF_WEIGHT));
            if other.newton(self.bending) != BeamOutcome::Stable {
                return None;
            }
        }
        Some(other)
    }
}

/// The mirror image of a vector about a direction.
fn mirrored(v: Vec2, axis: Vec2) -> Vec2 {
    axis * (2.0 * axis.dot(&v)) - v
}
