//! An edit of the mesh keeps the tension of every bar.
//!
//! A bar that takes the place of two is shorter than they were, one that an obstacle takes along is
//! longer, and their material is the same: they would be slacker or tauter at once, by 1.1 % for a
//! bend of 0.3 rad. So each bar has an unstretched length of its own at first, which differs from
//! that of its material by an excess that fades.

use crate::math::{larger, smaller};
use crate::model::fem::state::CableState;
use crate::model::length_change::MIN_UNSTRESSED_FRACTION;

/// The bars of a cable before an edit, and how far each is stretched.
#[derive(Clone, Debug)]
pub(in crate::model::fem) struct StretchedBars {
    /// Arc lengths of the nodes, m.
    arc_length: Vec<f64>,
    /// Length and unstretched length of each bar, m.
    lengths: Vec<[f64; 2]>,
}

impl StretchedBars {
    /// The bars as they are now.
    pub(in crate::model::fem) fn of(cable: &CableState) -> Self {
        let (mesh, x) = (&cable.mesh, &cable.motion.positions);
        let lengths = |e: usize| [mesh.path(e, x).length, mesh.rest_length[e]];
        Self { arc_length: mesh.arc_length.clone(), lengths: (0..mesh.rest_length.len()).map(lengths).collect() }
    }

    /// The same of a cable without slack: a slack bar is as long unstretched as it is.
    pub(in crate::model::fem) fn without_slack(mut self) -> Self {
        for [length, unstretched] in &mut self.lengths {
            *unstretched = smaller(*length, *unstretched);
        }
        self
    }

    /// Gives the bars of the edited cable the stretch that their material had. A flexible bar that
    /// was slack stays slack: it keeps its material, or gets as much as it just needs.
    pub(in crate::model::fem) fn restore(&self, cable: &mut CableState) {
        let (mesh, x) = (&mut cable.mesh, &cable.motion.positions);
        for e in 0..mesh.rest_length.len() {
            let lengths = [mesh.path(e, x).length, mesh.rest_length[e]];
            let ends = [mesh.arc_length[e], mesh.arc_length[e + 1]];
            // A bar without unstretched length is a break.
            if mesh.is_break(e) || lengths[0] == 0.0 || self.has_bar(ends, lengths) {
                continue;
            }
            match self.mean(ends) {
                Some(stretch) if stretch > 1.0 || stretch > 0.0 && !mesh.is_flexible() => {
                    let least = MIN_UNSTRESSED_FRACTION * lengths[1];
                    mesh.set_rest_length(e, larger(lengths[0] / stretch, least));
                }
                _ if lengths[0] > lengths[1] => mesh.set_rest_length(e, lengths[0]),
                _ => (),
            }
        }
        if mesh.has_excess() {
            cable.motion.earlier_excess = [1.0; 3];
        }
    }

    /// True if there was a bar with these ends (m of arc length), length and unstretched length
    /// (m).
    fn has_bar(&self, ends: [f64; 2], lengths: [f64; 2]) -> bool {
        let e = self.arc_length.partition_point(|&s| s < ends[0]);
        self.arc_length.get(e..e + 2).is_some_and(|own| own == ends) && self.lengths[e] == lengths
    }

    /// The mean stretch between two arc lengths, m.
    fn mean(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let first = self.arc_length.partition_point(|&s| s <= from).max(1) - 1;
        let bars = self.arc_length[first..].windows(2).zip(&self.lengths[first..]);
        let (mut sum, mut whole) = (0.0, 0.0);
        for (ends, [length, unstretched]) in bars.take_while(|(ends, _)| ends[0] < to) {
            let part = smaller(ends[1], to) - larger(ends[0], from);
            sum += part * length / unstretched;
            whole += part;
        }
        (whole > 0.0).then(|| sum / whole)
    }
}
