//! The friction memory stores the slide of each contact from its anchor, from one accepted step to
//! the next.

use crate::contact::friction;
use crate::math::Vec2;
use crate::model::fem::system::contact::contact_pair::ContactPair;
use crate::model::fem::system::contact::friction_contact::FrictionContact;

/// The memory of a friction contact after an accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RememberedContact {
    node: usize,
    on_segment: bool,
    feature: usize,
    obstacle: usize,
    slid: f64,
    /// Number of steps since it carried load.
    age: usize,
}

impl RememberedContact {
    /// A loaded contact with this slide (m).
    fn new(touch: &ContactPair, slid: f64) -> Self {
        let gap = &touch.pair.gap;
        let (node, on_segment) = (touch.node, touch.on_segment);
        Self { node, on_segment, feature: gap.feature, obstacle: gap.obstacle, slid, age: 0 }
    }
}

/// The slides of all friction contacts of a mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct FrictionMemory {
    /// In order of nodes; the contacts of one node with the newest first.
    contacts: Vec<RememberedContact>,
    /// Spare memory for the next list.
    spare: Vec<RememberedContact>,
}

impl FrictionMemory {
    /// An empty memory with room for the contacts of so many nodes.
    pub fn with_room_for(nodes: usize) -> Self {
        Self { contacts: Vec::with_capacity(2 * nodes), spare: Vec::with_capacity(2 * nodes) }
    }

    /// Copies another memory, with its capacity.
    pub fn copy_from(&mut self, other: &Self) {
        self.contacts.clear();
        self.contacts.reserve_exact(other.contacts.capacity());
        self.contacts.extend_from_slice(&other.contacts);
    }

    /// Multiplies every slide by a factor.
    pub fn scale(&mut self, factor: f64) {
        self.contacts.iter_mut().for_each(|m| m.slid *= factor);
    }

    /// Forgets all contacts.
    pub fn clear(&mut self) {
        self.contacts.clear();
    }

    /// Stores the slide of a contact, m.
    pub fn remember(&mut self, touch: &ContactPair, slid: f64) {
        self.contacts.push(RememberedContact::new(touch, slid));
        self.contacts.sort_by_key(|m| m.node);
    }

    /// The slide with which a contact starts: its own, else that of the same material on the same
    /// obstacle (it crossed a corner), else that of a neighbour at the same feature (the material
    /// moved past it), else 0.
    pub fn slid(&self, touch: &ContactPair) -> f64 {
        let low = self.contacts.partition_point(|m| m.node + 2 < touch.node);
        let near = self.contacts[low..].iter().take_while(|m| m.node <= touch.node + 2);
        let gap = &touch.pair.gap;
        let mut best = (0, 0.0);
        for m in near {
            let same_kind = m.on_segment == touch.on_segment;
            let rank = match (m.feature == gap.feature, m.node == touch.node && same_kind) {
                (true, true) => 3,
                (false, true) if m.obstacle == gap.obstacle => 2,
                (true, false) if same_kind => 1,
                _ => 0,
            };
            if rank > best.0 {
                best = (rank, m.slid);
            }
        }
        best.1
    }

    /// Stores the slides of the friction contacts of a step at its end (m), where `slip` (m)
    /// mobilises them fully; other contacts are kept for so many steps. The contacts of the step
    /// continue from there.
    pub fn commit(&mut self, contacts: &mut [FrictionContact], end: &[Vec2], slip: f64, remembered_steps: usize) {
        // A trembling contact loses its load now and then. If it were forgotten each time, it would
        // creep by ε a step.
        let mut old = std::mem::take(&mut self.contacts);
        let mut all = std::mem::take(&mut self.spare);
        all.clear();
        for contact in contacts.iter() {
            all.push(RememberedContact::new(&contact.touch, friction::return_map(contact.sliding(end), slip)));
        }
        let now = all.len();
        for m in old.iter().filter(|m| m.age < remembered_steps) {
            let same = |n: &RememberedContact| (n.node, n.on_segment, n.feature) == (m.node, m.on_segment, m.feature);
            let low = all[..now].partition_point(|n| n.node < m.node);
            if !all[low..now].iter().take_while(|n| n.node == m.node).any(same) {
                all.push(RememberedContact { age: m.age + 1, ..*m });
            }
        }
        old.clear();
        let (known, lost) = all.split_at(now);
        merge(known, lost, &mut old);
        (self.contacts, self.spare) = (old, all);
        // The friction in them is that of the accepted state, without a further slide.
        for (contact, memory) in contacts.iter_mut().zip(&self.spare) {
            contact.slid = memory.slid;
            contact.origin = contact.touch.interpolate(end);
        }
    }

    /// Renumbers the obstacles: `change` gives the obstacle and the feature of a feature, None if
    /// it is gone.
    pub fn change_features(&mut self, change: impl Fn(usize) -> Option<(usize, usize)>) {
        self.contacts.retain_mut(|contact| {
            let changed = change(contact.feature);
            if let Some((obstacle, feature)) = changed {
                (contact.obstacle, contact.feature) = (obstacle, feature);
            }
            changed.is_some()
        });
    }

    /// Renumbers the nodes: `change` gives the new number of a node, None if it was removed.
    pub fn renumber(&mut self, change: impl Fn(usize) -> Option<usize>) {
        let old = std::mem::take(&mut self.contacts);
        self.contacts.extend(old.into_iter().filter_map(|m| Some(RememberedContact { node: change(m.node)?, ..m })));
    }
}

/// Merges two lists in order of nodes into one; for the same node, entries of the first list come
/// first.
fn merge(first: &[RememberedContact], second: &[RememberedContact], out: &mut Vec<RememberedContact>) {
    let mut rest = second.iter().peekable();
    for m in first {
        while let Some(n) = rest.next_if(|n| n.node < m.node) {
            out.push(*n);
        }
        out.push(*m);
    }
    out.extend(rest);
}
