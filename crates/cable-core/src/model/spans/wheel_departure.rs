//! A cable leaves wheels: where a post stands for one its contact goes on as a contact with that
//! post, with its friction.

use crate::model::spans::section::CableEquilibrium;
use crate::model::spans::section_layout::SectionLayout;
use crate::problem::Departure;

impl CableEquilibrium {
    /// The same equilibrium in a layout without the wheels that the cable has left there; None if
    /// there are none, or if it touches one for which no post stands.
    pub(in crate::model::spans) fn without_wheels(
        &self,
        before: &SectionLayout,
        after: &SectionLayout,
    ) -> Option<Self> {
        let holds = |layout: &SectionLayout| layout.sections.iter().map(|s| s.pulleys.len()).sum::<usize>();
        if holds(after) >= holds(before) {
            return None;
        }
        let bodies = after.problem.world.geometry().bodies();
        let known = before.problem.world.geometry().bodies().len();
        let left = |support: usize| after.problem.supports.get(support).is_some_and(|s| s.departure == Departure::Done);
        // Index of the forward boundary of each pulley, in either layout.
        let first_curve = |layout: &SectionLayout, support: usize| {
            let pulleys = layout.sections.iter().flat_map(|s| &s.pulleys);
            pulleys.filter(|q| q.support == support).map(|q| q.curve).next()
        };
        let post_of = |support: usize| {
            let center = self.instant.places.get(support)?;
            let post = bodies.iter().skip(known).position(|body| body.center.as_ref() == Some(center))?;
            Some(2 * (known + post))
        };
        let mut sections = self.sections.clone();
        for contact in sections.iter_mut().flat_map(|section| &mut section.contacts) {
            let Some(support) = contact.wheel else { continue };
            let side = contact.curve - first_curve(before, support)?;
            if left(support) {
                contact.wheel = None;
                contact.curve = post_of(support)? + side;
            } else {
                contact.curve = first_curve(after, support)? + side;
            }
        }
        let mut context = after.context(after.curves(), &self.instant);
        context.drag = self.context.drag;
        context.loose_where_tension_ends = self.context.loose_where_tension_ends;
        Some(Self { sections, context, instant: self.instant.clone() })
    }
}
