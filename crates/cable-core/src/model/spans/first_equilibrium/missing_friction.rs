//! A cable held by friction alone slides if there is too little of it: this module finds how much
//! it would need, and the equilibrium after the cable was drawn.

use crate::model::spans::contact::impending_slip;
use crate::model::spans::first_equilibrium::{FirstShape, SHAPES_WITH_FRICTION};
use crate::model::spans::newton::Workspace;
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, CableSection};
use crate::model::spans::section_layout::SectionLayout;

/// Relative accuracy of the missing friction: three digits are shown.
const MISSING_FRICTION_TOLERANCE: f64 = 2e-4;

/// Missing friction below which none is missing (round-off), as a fraction of the friction. Larger:
/// a cable that lacks so little has no answer and no reported cause.
const LEAST_MISSING_PART: f64 = 1e-7;

impl CableEquilibrium {
    /// The least multiple of its friction with which a cable held by friction alone would rest
    /// along its route. None if it rests with its own friction, or is not known to slide.
    ///
    /// With less friction every contact of the section slides the same way. The proof is that
    /// contacts are about to slide just above the multiple, so a failed search alone does not
    /// count.
    pub fn friction_needed(
        layout: &SectionLayout,
        instant: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Option<f64> {
        let tuned = &layout.settings.continuation;
        let context = layout.context(layout.curves(), instant);
        let mut rests = |part: f64, shape: FirstShape| {
            let begin = BoundaryConditions { friction: part, ..instant.clone() };
            let mut cable_equilibrium = Self { sections: Vec::new(), context: context.clone(), instant: begin.clone() };
            let stats = cable_equilibrium.settle_along_route(layout, &begin, shape, workspace).ok()?;
            (stats.runaways == 0).then_some(cable_equilibrium)
        };
        let (mut low, mut step) = (1.0, tuned.first_missing_part);
        let (mut high, shape) = loop {
            if step > tuned.max_missing_part {
                return None;
            }
            let high = 1.0 + step;
            if let Some(shape) = SHAPES_WITH_FRICTION.into_iter().find(|shape| rests(high, *shape).is_some()) {
                break (high, shape);
            }
            (low, step) = (high, 2.0 * step);
        };
        while high - low > MISSING_FRICTION_TOLERANCE * (high - 1.0) {
            let middle = 0.5 * (low + high);
            if rests(middle, shape).is_some() {
                high = middle;
            } else {
                low = middle;
            }
            if high - 1.0 < LEAST_MISSING_PART {
                return None;
            }
        }
        let found = rests(high, shape)?;
        let near = tuned.mobilised_fraction * (1.0 + MISSING_FRICTION_TOLERANCE * (high - 1.0));
        let slides = |s: &CableSection| {
            [1.0, -1.0].iter().any(|way| impending_slip::is_about_to_slide(s, &found.context, *way, near))
        };
        let unheld =
            layout.sections.iter().zip(&found.sections).filter(|(p, _)| p.supports.iter().all(Option::is_none));
        unheld.map(|(_, s)| s).any(slides).then_some(high)
    }

    /// The equilibrium in which all friction acts against a cable that was drawn one way (1:
    /// towards its end, −1: towards its start). None if there is none.
    pub fn fully_mobilised(&self, layout: &SectionLayout, way: f64, workspace: &mut Workspace) -> Option<Self> {
        let mut cable_equilibrium = self.clone();
        cable_equilibrium.context.mobilised = way;
        let instant = self.instant.clone();
        cable_equilibrium.step(layout, &instant, workspace).ok()?;
        Some(cable_equilibrium)
    }
}
