//! The contacts of a chain are the places on its nodes and bars that are near an obstacle.

use crate::contact::Gap;
use crate::contact::obstacle_pairs::Pair;
use crate::math::{Vec2, larger};
use crate::model::fem::elastica::chain::BarChain;
use crate::model::fem::elastica::reference_curve::mobilised_friction;

/// Depth to which a chain may lie in an obstacle during relaxation, as a fraction of the cable's
/// radius.
const OVERLAP_LIMIT: f64 = 0.5;

/// Distance, in bars, within which a contact with the same surface is identified with one of the
/// step before.
const SAME_CONTACT_BARS: f64 = 0.5;

/// Least force of a contact that counts at rest, in parts of the forces of the scene.
const LEAST_PUSH_FRACTION: f64 = 1e-7;

/// A place of the chain that is near an obstacle.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::fem::elastica) struct ChainContact {
    /// The gap; `fraction` is its place on the bar after `node`.
    pub(in crate::model::fem::elastica) gap: Gap,
    pub(in crate::model::fem::elastica) node: usize,
    /// Arc length, m.
    pub(in crate::model::fem::elastica) arc: f64,
    /// Normal force, N.
    pub(in crate::model::fem::elastica) push: f64,
    /// True if it is in the active set.
    pub(super) active: bool,
    /// Friction along growing arc length over normal force.
    pub(super) mobilised: f64,
}

impl ChainContact {
    /// Its nodes, with their weights in its position.
    pub(super) fn shares(&self) -> [(usize, f64); 2] {
        [(self.node, 1.0 - self.gap.fraction), (self.node + 1, self.gap.fraction)]
    }

    /// True if it transmits friction.
    pub(super) fn rubs(&self) -> bool {
        self.active && self.mobilised != 0.0
    }
}

impl BarChain<'_> {
    /// Passes all pairs of chain and obstacles within `reach` (m) to `out`, with the bar of each.
    fn for_each_pair(&self, x: &[Vec2], reach: f64, mut out: impl FnMut(usize, Pair)) {
        let geometry = self.chain_input.problem.world.geometry();
        for k in 0..x.len() {
            if !self.fixity[k] {
                let before = k.checked_sub(1).and_then(|k| x.get(k)).copied();
                geometry.node_pairs(before, x[k], x.get(k + 1).copied(), reach, &mut |p| {
                    let at_end = k + 1 == x.len();
                    let fraction = f64::from(u8::from(at_end));
                    out(k - usize::from(at_end), Pair { gap: Gap { fraction, ..p.gap }, ..p });
                });
            }
            if let Some(&b) = x.get(k + 1) {
                geometry.segment_pairs(x[k], b, reach, &mut |p| out(k, p));
            }
        }
    }

    /// Greatest depth of the cable's surface in an obstacle, m.
    fn greatest_depth(&self, x: &[Vec2]) -> f64 {
        let mut deepest: f64 = 0.0;
        let world = &self.chain_input.problem.world;
        let mut measure = |p: Vec2| {
            if let Some(g) = world.signed_gap(p, self.bar) {
                deepest = larger(deepest, -g.gap_m);
            }
        };
        x.iter().zip(&self.fixity).filter(|(_, is_fixed)| !**is_fixed).for_each(|(p, _)| measure(*p));
        for (a, b) in x.iter().zip(x.iter().skip(1)) {
            // A bar may cut off the corner nearest to it.
            world.geometry().segment_pairs(*a, *b, self.bar, &mut |p| measure(a + (b - a) * p.gap.fraction));
        }
        deepest
    }

    /// True if nodes at positions `x` (m) are in no obstacle, or so shallow that Newton's method
    /// brings them out.
    pub(super) fn is_clear_enough(&self, x: &[Vec2]) -> bool {
        self.greatest_depth(x) < OVERLAP_LIMIT * self.chain_input.problem.radius
    }

    /// Finds the contacts at the present positions. A contact that was known keeps its force, its
    /// friction and its state in the active set.
    pub(super) fn find_contacts(&mut self) {
        let mut found: Vec<ChainContact> = Vec::with_capacity(self.contacts.len());
        let known = std::mem::take(&mut self.contacts);
        self.for_each_pair(&self.positions, self.bar, |node, p| {
            if p.weight <= 0.0 {
                return;
            }
            let s = self.arc[node] + (self.arc[node + 1] - self.arc[node]) * p.gap.fraction;
            let from = known.partition_point(|t| t.node + 1 < node);
            let old =
                known[from..].iter().take_while(|t| t.node <= node + 1).filter(|t| t.gap.feature == p.gap.feature);
            let old = old.min_by(|a, b| (a.arc - s).abs().total_cmp(&(b.arc - s).abs()));
            let old = old.filter(|t| (t.arc - s).abs() < SAME_CONTACT_BARS * self.bar);
            let mobilised = match (old, self.chain_input.friction_source) {
                (Some(t), _) => t.mobilised,
                (None, Some(answer)) if p.gap.friction > 0.0 => {
                    mobilised_friction(self.chain_input.problem, answer, p.gap.obstacle, s).coefficient
                }
                _ => 0.0,
            };
            let push = old.map_or(0.0, |t| t.push);
            let active = p.gap.gap_m < 0.0 || old.is_some_and(|t| t.active);
            found.push(ChainContact { gap: p.gap, node, arc: s, push, active, mobilised });
        });
        self.contacts = found;
    }

    /// The contacts that push, in order along the cable.
    pub(in crate::model::fem::elastica) fn pushing_contacts(&self) -> Vec<ChainContact> {
        let least = LEAST_PUSH_FRACTION * self.scale;
        let pushes = |t: &&ChainContact| t.active && t.push > least;
        let mut out: Vec<ChainContact> = self.contacts.iter().filter(pushes).copied().collect();
        out.sort_by(|a, b| a.arc.total_cmp(&b.arc));
        out
    }
}
