//! These modules handle a section of cable that rests on obstacles without tension.
//!
//! If there is more cable than its drained route needs (see `drained_route`), only the hanging
//! parts have tension. They hang plumb: F is the weight below. The tension vanishes at each foot
//! and in each kink, where a cable under tension would not turn. Between two such points the cable
//! passes over one crest; on both sides its tension falls as in a cable that slides down there,
//!
//! ```text
//! dT/ds = −b·t ∓ μN,   T ≥ 0
//! ```
//!
//! and the greater of the two has to be held by friction: less than fully mobilised, if one falls
//! below the other before its end. Where both are zero the cable lies loose, and the surplus lies
//! there in folds. A plane model cannot tell where, or in how many layers: they are spread evenly
//! over that ground, which carries their weight. A plumb end of stretched length h obeys
//!
//! ```text
//! h = λ (s + b s²/2EA)
//! ```
//!
//! In any other equilibrium of the same cable it pulls or leans somewhere, which needs friction
//! memory. If there is less friction than a crest needs, the cable runs over it, and there is no
//! such equilibrium.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | the loose section along its route, or in a heap |
//! | `drained_route.rs` | the route fallen along the load on to what is below it |
//! | `upper_surfaces.rs` | the parts of boundaries that face the load |
//! | `slack_parts.rs` | the points at which the tension vanishes, and the chains between them |
//! | `over_crest.rs` | the tensions of a chain: the cable over one crest |
//! | `stretch_tensions.rs`, `support_span.rs` | spans over kinks, and to a support |
//! | `longest_in_tension.rs` | the length from which a cable cannot rest in tension |
//! | `pay_out.rs`, `heap.rs` | the material of each part, and the surplus |
//! | `loose_forces.rs`, `results.rs` | forces on ends and obstacles; the answer |

pub(in crate::model::spans) mod drained_route;
mod heap;
mod longest_in_tension;
mod loose_forces;
mod over_crest;
mod pay_out;
mod results;
mod slack_parts;
mod stretch_tensions;
mod support_span;
mod upper_surfaces;

use crate::math::Vec2;
use crate::model::spans::boundary::LooseSection;
use crate::model::spans::initial::section_route;
use crate::model::spans::section::{BoundaryConditions, CableSection, EndCondition, SolveContext};
use crate::model::spans::section_layout::SectionLayout;
use crate::model::spans::slack::drained_route::DrainedRoute;
use crate::model::spans::slack::heap::CREST_CONE_ROUNDING;
use crate::model::spans::slack::pay_out::pay_out;
use crate::model::spans::slack::slack_parts::SlackSolver;
use crate::model::spans::slack::upper_surfaces::{LoadFrame, UpperSurfaces};

pub(in crate::model::spans) use crate::model::spans::slack::longest_in_tension::exceeds_tension;
pub(in crate::model::spans) use crate::model::spans::slack::slack_parts::LooseShapes;

/// The loose section at an instant; None if the cable cannot be loose.
pub(in crate::model::spans) fn loose_section(
    layout: &SectionLayout,
    index: usize,
    context: &SolveContext,
    instant: &BoundaryConditions,
    sought: LooseShapes,
) -> Option<CableSection> {
    let part = layout.sections.get(index)?;
    let (load, [from, to]) = (context.law.load, part.material);
    let loaded = context.loads.iter().any(|l| l.arc_length > from && l.arc_length < to && l.force.norm() > 0.0);
    let frame = LoadFrame::of(load).filter(|_| !loaded && part.pulleys.is_empty())?;
    let bodies = layout.problem.world.geometry().bodies();
    let surfaces = UpperSurfaces::new(context, bodies.len(), frame);
    let support_places = part.supports.map(|s| s.and_then(|k| instant.places.get(k).copied()));
    let ends = support_places.map(|h| h.is_some());
    let drawn = [0, 1].map(|side| match part.supports[side] {
        None => layout.end_force(instant, part.material[side]),
        Some(_) => Vec2::zeros(),
    });
    let drawn = drawn[0] + drawn[1];
    let drape = SlackSolver { context, frame, most: CREST_CONE_ROUNDING * load.norm() * (to - from), sought };
    let section = |mut drained: DrainedRoute| {
        drained.drop_free_ends(ends);
        let lines = drape.lines(&surfaces, &drained.legs);
        let parts = drape.parts(&lines, ends)?;
        let parts = pay_out(parts, &drape, part.material, drawn, ends)?;
        let end_conditions = [0, 1].map(|k| support_places[k].map_or(EndCondition::Loose(drawn), EndCondition::Fixed));
        let loose = Some(LooseSection { parts, drawn });
        Some(CableSection { from, to, end_conditions, contacts: Vec::new(), forces: vec![Vec2::zeros()], loose })
    };
    let along_route = || DrainedRoute::new(&surfaces, bodies, frame, &section_route(layout, part, instant).points);
    match support_places {
        [Some(_), Some(_)] => section(along_route()?),
        [Some(at), None] | [None, Some(at)] => {
            // The cable is laid out on the ground along its route, if it has one; else it comes
            // down in a heap below the support. A cable that hangs higher than it is thick may rest
            // along its route in tension, which is sought first.
            let laid_out = layout.problem.route.len() > 1 && drawn.norm() == 0.0;
            let section_along_route = if laid_out { along_route().and_then(&section) } else { None };
            let may_hang = sought == LooseShapes::AnyTension;
            section_along_route
                .filter(|s| {
                    let loose = s.loose.as_ref();
                    loose.is_some_and(|l| l.spreads() && (may_hang || l.hangs() <= layout.problem.cable.diameter_m))
                })
                .or_else(|| {
                    let down = DrainedRoute::plumb_down(&surfaces, bodies, frame, at)?;
                    section(if support_places[0].is_some() { down } else { down.back() })
                })
        }
        [None, None] => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::spans::section_layout::CableEnd;
    use crate::problem::problems;
    use crate::scene::catalog;
    use std::sync::Arc;

    /// Every flexible cable of the catalogue with lengths changed by such factors, as it is laid,
    /// with the names of its scene and factor.
    pub(super) fn catalogue_with_lengths(factors: &[f64]) -> Vec<(String, SectionLayout, BoundaryConditions)> {
        let mut out = Vec::new();
        for (id, scene) in catalog::all() {
            for longer in factors {
                let mut scene = scene.clone();
                for cable in &mut scene.cables {
                    (cable.bending_stiffness_n_m2, cable.length_m) = (0.0, cable.length_m * longer);
                }
                for problem in problems(&scene).unwrap_or_default() {
                    let Ok(layout) = SectionLayout::new(&problem, CableEnd::Start, Arc::default()) else { continue };
                    let mut instant = BoundaryConditions::default();
                    layout.instant(&vec![None; problem.supports.len()], 0.0, &mut instant);
                    out.push((format!("{id}, {longer} times as long"), layout, instant));
                }
            }
        }
        out
    }

    #[test]
    fn a_shape_without_tension_is_the_same_whichever_shapes_are_sought() {
        let (mut compared, mut found) = (0, 0);
        // Lengths from taut to loose.
        for (name, layout, instant) in catalogue_with_lengths(&[0.9, 1.0, 1.1, 1.3, 2.0]) {
            let context = layout.context(layout.curves(), &instant);
            for k in 0..layout.sections.len() {
                let loose = |sought| {
                    loose_section(&layout, k, &context, &instant, sought)
                        .filter(|s| s.loose.as_ref().is_some_and(LooseSection::spreads))
                };
                let [any, none] = [LooseShapes::AnyTension, LooseShapes::NoTension].map(loose);
                // Cable that hangs from a support and ends free on the ground may rest in tension.
                let hangs = any.as_ref().and_then(|s| s.loose.as_ref()).map_or(0.0, LooseSection::hangs);
                let ends_free = layout.sections[k].supports.iter().any(Option::is_none);
                if !(ends_free && hangs > layout.problem.cable.diameter_m) {
                    assert_eq!(format!("{any:?}"), format!("{none:?}"), "{name}");
                } else {
                    assert!(none.is_none(), "{name}");
                }
                compared += 1;
                found += usize::from(any.is_some());
            }
        }
        println!("{found} of {compared} lie without tension");
        assert!(found >= 5 && compared > 2 * found, "{found} of {compared}");
    }
}
