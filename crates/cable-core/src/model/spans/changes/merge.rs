//! This module merges two neighbouring contacts of one chain.

use crate::model::spans::boundary::{ContactPath, Mode};
use crate::model::spans::contact::release_below;
use crate::model::spans::section::{CableSection, SolveContext};

/// Merges two neighbouring contacts of one chain. Returns whether there were any.
pub(super) fn merge_contacts(section: &mut CableSection, context: &SolveContext) -> bool {
    for j in 1..section.contacts.len() {
        let (a, b) = (&section.contacts[j - 1], &section.contacts[j]);
        let loads = a.is_load() || b.is_load();
        let apart = |contact_path: &ContactPath<'_>| {
            contact_path.curve.is_round()
                && release_below::hangs_between(contact_path, a.ends.place[1], b.ends.place[0])
        };
        if a.curve == b.curve
            && a.chain_range == b.chain_range
            && a.wheel.is_none()
            && !loads
            && b.ends.place[1] >= a.ends.place[0]
            && !apart(&context.contact_path(a))
        {
            let b = section.contacts.remove(j);
            section.forces.remove(j);
            let a = &mut section.contacts[j - 1];
            a.history.append(&context.contact_path(&b), &b.history);
            a.smooth &= b.smooth;
            a.next = b.next;
            (a.ends.place[1], a.ends.material[1], a.ends.tension[1]) =
                (b.ends.place[1], b.ends.material[1], b.ends.tension[1]);
            if let (Mode::Slip(m), Mode::Stick) = (a.mode, b.mode)
                && m != 0.0
            {
                a.mode = Mode::Stick;
            }
            return true;
        }
    }
    false
}
