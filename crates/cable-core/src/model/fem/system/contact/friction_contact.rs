//! A friction contact has a frozen normal force during a step; its slide is measured from an
//! anchor.

use crate::math::{Vec2, bounded};
use crate::model::fem::settings::ContactTuning;
use crate::model::fem::system::contact::contact_pair::ContactPair;
use crate::problem::Problem;

/// ε of a cable at rest under a greatest force of `force` (N), m.
#[must_use]
pub fn slip_at_rest(tuning: &ContactTuning, problem: &Problem, force: f64) -> f64 {
    let stretch = force * problem.length / problem.axial_stiffness;
    // A force that is NaN belongs to no state that is kept.
    bounded(tuning.slip_stretch_fraction * stretch, tuning.min_slip_m, tuning.slip_m)
}

/// Friction of one contact during a step: the normal force and direction are frozen, the slide is
/// not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionContact {
    /// The contact.
    pub touch: ContactPair,
    /// Unit vector of positive slide.
    pub tangent: Vec2,
    /// Largest friction force μN, N.
    pub limit: f64,
    /// Slide from the anchor at the start of the step, m.
    pub slid: f64,
    /// Position of the touching material at the start of the step, m.
    pub origin: Vec2,
}

impl FrictionContact {
    /// True if it is the friction of a contact, wherever that is now.
    #[inline]
    #[must_use]
    pub fn is_of(&self, touch: &ContactPair) -> bool {
        let key = |t: &ContactPair| (t.node, t.on_segment, t.pair.gap.feature);
        key(&self.touch) == key(touch)
    }

    /// Slide from the anchor, m.
    #[inline]
    #[must_use]
    pub fn sliding(&self, x: &[Vec2]) -> f64 {
        self.slid + self.tangent.dot(&(self.touch.interpolate(x) - self.origin))
    }
}

/// The friction contacts of a node, out of a list in order of nodes.
pub fn of_node(rubs: &[FrictionContact], node: usize) -> impl Iterator<Item = &FrictionContact> {
    let low = rubs.partition_point(|r| r.touch.node < node);
    rubs[low..].iter().take_while(move |r| r.touch.node == node)
}
