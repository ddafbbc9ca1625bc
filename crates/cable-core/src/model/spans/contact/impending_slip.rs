//! A section is about to slide as a whole if the friction of all its contacts is used up in one
//! direction.

use crate::math::larger;
use crate::model::spans::contact::load_balance::load_balance;
use crate::model::spans::section::{CableSection, Contact, SolveContext};

/// True if all of a section is about to slide in a direction (1: towards its end, −1: towards its
/// start): at each contact the tensions are those of sliding within the relative tolerance `near`.
pub(in crate::model::spans) fn is_about_to_slide(
    section: &CableSection,
    context: &SolveContext,
    way: f64,
    near: f64,
) -> bool {
    let slides = |(j, c): (usize, &Contact)| {
        let m = way * context.friction(c);
        if c.is_load() {
            let load_balance = load_balance(section, context, j);
            return load_balance.sum.dot(&(load_balance.tangent + load_balance.normal * m)).abs()
                <= near * load_balance.size;
        }
        let [t1, t2] = c.ends.tension;
        let reached = context.contact_path(c).slide(c.ends.place[0], c.ends.place[1], t1, m).tension;
        let weight = context.law.load.norm() * (c.ends.material[1] - c.ends.material[0]);
        (t2 - reached).abs() <= near * larger(larger(t1.abs(), t2.abs()), weight)
    };
    !section.contacts.is_empty() && section.contacts.iter().enumerate().all(slides)
}
