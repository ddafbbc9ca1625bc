//! The contact search finds the pairs of bars and obstacles that are near each other, from the
//! neighbour lists of a step.

use crate::contact::geometry::{Geometry, ObstaclePart};
use crate::contact::neighbour_lists::NeighbourLists;
use crate::contact::obstacle_pairs::Pair;
use crate::math::Vec2;
use crate::model::fem::mesh::Mesh;
use crate::model::fem::system::contact::contact_pair::ContactPair;
use crate::problem::Problem;

/// Number of parts near a bar that one search keeps for it and the node at its start. Smaller: bars
/// over fine ground are searched twice; larger: more memory to clear in each search. No answer
/// depends on it.
const MAX_SHARED_PARTS: usize = 128;

/// Stores in `room` the parts that can be within `reach` (m) of a segment, in the order of the
/// trees; None if there are more than fit.
fn parts_near<'a>(
    geometry: &Geometry,
    [a, b]: [Vec2; 2],
    reach: f64,
    room: &'a mut [ObstaclePart; MAX_SHARED_PARTS],
) -> Option<&'a [ObstaclePart]> {
    let mut count = 0;
    for part in geometry.parts(a.inf(&b), a.sup(&b), reach) {
        *room.get_mut(count)? = part;
        count += 1;
    }
    room.get(..count)
}

/// The search for contacts, with the obstacles that each bar can come near to in this step.
#[derive(Clone, Debug, Default)]
pub struct ContactSearch {
    /// The listed obstacles of each bar.
    pub lists: NeighbourLists,
    /// True for each bar that is collapsed in this step: its ends meet obstacles for themselves,
    /// and nothing is between them that could.
    collapsed: Vec<bool>,
}

impl ContactSearch {
    /// Notes which bars of the mesh at `x` (m) are collapsed: slack, and shorter than `length_m`
    /// (m). In a heap of slack cable their directions are chance, and change with every iteration;
    /// contacts that depend on them, by inclusion and exclusion, have no minimum that could be
    /// found.
    pub fn note_collapsed_bars(&mut self, mesh: &Mesh, x: &[Vec2], length_m: f64) {
        let is_plain = |e: usize| mesh.sliding[e].is_none() && mesh.sliding[e + 1].is_none();
        let is_short = |e: usize| (x[e + 1] - x[e]).norm_squared() < length_m * length_m;
        self.collapsed.clear();
        self.collapsed
            .extend((0..mesh.rest_length.len()).map(|e| is_short(e) && is_plain(e) && mesh.rest_length[e] > length_m));
    }

    /// True if bar `e` joins its ends in contact.
    fn is_bar(&self, mesh: &Mesh, e: usize) -> bool {
        let is_collapsed = self.collapsed.len() == mesh.rest_length.len() && self.collapsed[e];
        !mesh.is_break(e) && !is_collapsed
    }

    /// Finds the contacts of the mesh at `x` (m), in order of arc length. Each bar, and the node at
    /// its start, has its own `reach` (m). Held nodes have no contacts.
    pub fn find(
        &self,
        problem: &Problem,
        mesh: &Mesh,
        x: &[Vec2],
        reach: impl Fn(usize) -> f64,
        out: &mut Vec<ContactPair>,
    ) {
        out.clear();
        if problem.world.is_empty() {
            return;
        }
        let (geometry, last) = (problem.world.geometry(), x.len().saturating_sub(1));
        let plain = |e: usize| mesh.sliding[e].is_none() && mesh.sliding[e + 1].is_none();
        let mut room = [ObstaclePart { body: 0, edge: None }; MAX_SHARED_PARTS];
        for node in 0..x.len() {
            let reach = reach(if node < last { node } else { last.saturating_sub(1) });
            if node < last && plain(node) && self.lists.is_clear(node, [[x[node], x[node + 1]]], reach) {
                continue;
            }
            let ends = (node < last).then(|| mesh.straight(node, x));
            let listed = match ends {
                Some(ends) => self.lists.of(node, [ends], reach),
                None => last.checked_sub(1).and_then(|e| self.lists.of(e, [mesh.straight(e, x)], reach)),
            };
            let listed = match (listed, ends) {
                (None, Some(ends)) if !mesh.is_break(node) => parts_near(geometry, ends, reach, &mut room),
                (listed, _) => listed,
            };
            if listed.is_some_and(<[_]>::is_empty) {
                continue;
            }
            if mesh.is_free(node) {
                let before = node.checked_sub(1).filter(|&e| self.is_bar(mesh, e)).map(|e| mesh.straight(e, x)[0]);
                let chain = [before, Some(x[node]), ends.filter(|_| self.is_bar(mesh, node)).map(|e| e[1])];
                let mut keep = |pair| out.push(ContactPair { node, on_segment: false, pair });
                match listed {
                    Some(parts) => geometry.node_pairs_among(parts.iter().copied(), &chain, reach, &mut keep),
                    None => geometry.node_pairs(chain[0], x[node], chain[2], reach, &mut keep),
                }
            }
            let moves = |_: &[Vec2; 2]| (mesh.is_free(node) || mesh.is_free(node + 1)) && self.is_bar(mesh, node);
            let Some(ends) = ends.filter(moves) else { continue };
            let rounds = mesh.rounds(node);
            let mut keep = |pair: Pair| {
                if !rounds.contains(&Some(pair.gap.feature)) {
                    out.push(ContactPair { node, on_segment: true, pair });
                }
            };
            match listed {
                Some(parts) => geometry.segment_pairs_among(parts.iter().copied(), ends, reach, &mut keep),
                None => geometry.segment_pairs(ends[0], ends[1], reach, &mut keep),
            }
        }
    }

    /// True if all bars stay farther than `reach` (m) from every obstacle on the way between two
    /// sets of node positions (m).
    pub fn is_out_of_reach(&self, mesh: &Mesh, [from, to]: [&[Vec2]; 2], reach: f64) -> bool {
        (0..mesh.rest_length.len()).all(|e| {
            let ways = [mesh.straight(e, from), mesh.straight(e, to)];
            self.lists.listed(e, ways, reach).is_some_and(<[_]>::is_empty)
        })
    }

    /// Lists the obstacles nearer to each bar at `x` (m) than `within` (m), unless the present
    /// lists have all those nearer than `needed` (m), and measures its gap.
    pub fn list_neighbours(
        &mut self,
        problem: &Problem,
        mesh: &Mesh,
        x: &[Vec2],
        needed: impl Fn(usize) -> f64,
        within: impl Fn(usize) -> f64,
    ) {
        let bars = mesh.rest_length.len();
        let suffices = |e: usize| self.lists.listed(e, [mesh.straight(e, x)], needed(e)).is_some();
        if self.lists.len() == bars && (0..bars).all(suffices) {
            for e in 0..bars {
                self.lists.measure(problem.world.geometry(), e, mesh.straight(e, x));
            }
            return;
        }
        self.lists.clear();
        self.lists.reserve(bars);
        for e in 0..bars {
            self.lists.push(problem.world.geometry(), mesh.straight(e, x), within(e));
        }
    }
}
