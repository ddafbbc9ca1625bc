//! The length of a drained route bounds every cable that rests in tension along it.
//!
//! Let a cable with tension everywhere pass all obstacles on the side of its route, and run one way
//! across the load. Where it touches an obstacle below, it lies on the drained route. Between two
//! such contacts it bends against the load only, in free spans and where it is pressed against an
//! obstacle from below: it is convex, and nowhere below the drained route. A convex arc is no
//! longer than a line that encloses it from outside between the same ends (Archimedes, On the
//! Sphere and Cylinder I, second assumption), so it is no longer than the drained route there, with
//! its plumb legs. The sum over all these arcs bounds the stretched cable.

use crate::math::{Vec2, larger, smaller};
use crate::model::spans::boundary::SlackForm;
use crate::model::spans::initial::section_route;
use crate::model::spans::section::{BoundaryConditions, SolveContext};
use crate::model::spans::section_layout::SectionLayout;
use crate::model::spans::slack::drained_route::DrainedRoute;
use crate::model::spans::slack::slack_parts::{LooseShapes, SlackSolver};
use crate::model::spans::slack::upper_surfaces::{LoadFrame, NONE_M, UpperSurfaces};

/// Relative excess over the drained route that a cable must have (round-off).
const ROUNDING_FRACTION: f64 = 1e-9;

/// True if a section held at both ends is too long to rest in tension along its route. Also false
/// if the bound does not apply: over pulleys, with loads, and if the route turns back across the
/// load.
pub(in crate::model::spans) fn exceeds_tension(
    layout: &SectionLayout,
    index: usize,
    context: &SolveContext,
    instant: &BoundaryConditions,
) -> bool {
    drained_length(layout, index, context, instant).is_some_and(|drained| {
        let [from, to] = layout.sections[index].material;
        (to - from) * context.law.thermal > drained * (1.0 + ROUNDING_FRACTION)
    })
}

/// Length of the drained route of a section, m; None if it is no bound.
fn drained_length(
    layout: &SectionLayout,
    index: usize,
    context: &SolveContext,
    instant: &BoundaryConditions,
) -> Option<f64> {
    let part = layout.sections.get(index)?;
    let [from, to] = part.material;
    let loaded = context.loads.iter().any(|l| l.arc_length > from && l.arc_length < to && l.force.norm() > 0.0);
    let between_supports = part.supports.iter().all(Option::is_some) && part.pulleys.is_empty() && !loaded;
    let frame = LoadFrame::of(context.law.load).filter(|_| between_supports)?;
    let route = section_route(layout, part, instant).points;
    let bodies = layout.problem.world.geometry().bodies();
    let surfaces = UpperSurfaces::new(context, bodies.len(), frame);
    goes_one_way(&route, frame).then_some(())?;
    let drained = DrainedRoute::new(&surfaces, bodies, frame, &route)?;
    let solver = SlackSolver { context, frame, most: 0.0, sought: LooseShapes::NoTension };
    let length = |line: &SlackForm| match line {
        SlackForm::Hangs(ends) => solver.rise(*ends).abs(),
        SlackForm::Lies(s) => {
            let [a, b] = s.coordinates;
            (b - a).abs() * s.place(context, a).stretch
        }
        SlackForm::Heap(_) | SlackForm::Spans { .. } => 0.0,
    };
    Some(solver.lines(&surfaces, &drained.legs).iter().map(length).sum())
}

/// True if a route never turns back across the load.
fn goes_one_way(route: &[Vec2], frame: LoadFrame) -> bool {
    let across = route.windows(2).map(|pair| frame.split(pair[1] - pair[0]).x);
    let [least, most] = across.fold([0.0, 0.0], |[a, b], u| [smaller(a, u), larger(b, u)]);
    least > -NONE_M || most < NONE_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::spans::newton::Workspace;
    use crate::model::spans::section::{CableEquilibrium, Connection};
    use crate::model::spans::slack::tests::catalogue_with_lengths;

    #[test]
    fn no_rest_in_tension_is_longer_than_its_drained_route() {
        let (mut rests, mut too_long) = (0, 0);
        for (name, layout, instant) in catalogue_with_lengths(&[0.95, 1.0, 1.05, 1.2, 1.5, 2.0]) {
            let context = layout.context(layout.curves(), &instant);
            let found = CableEquilibrium::along_route(&layout, &instant, &mut Workspace::default());
            for k in 0..layout.sections.len() {
                let exceeds = exceeds_tension(&layout, k, &context, &instant);
                too_long += usize::from(exceeds);
                let Some(found) = found.as_ref().ok().map(|(found, _)| &found.sections[k]) else { continue };
                // Slack in a pocket is no cable in tension.
                let has_pocket = found.contacts.iter().any(|c| c.next == Connection::Pocket);
                let in_tension = found.loose.is_none() && !has_pocket;
                rests += usize::from(in_tension);
                assert!(!(exceeds && in_tension), "{name}, section {k}");
            }
        }
        println!("{rests} rest in tension, {too_long} are too long for that");
        assert!(rests >= 20 && too_long >= 5, "{rests} and {too_long}");
    }
}
