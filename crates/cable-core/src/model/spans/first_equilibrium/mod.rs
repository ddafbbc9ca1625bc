//! These modules search the first equilibrium of a cable from its route.
//!
//! | room | content |
//! |---|---|
//! | `mod.rs` | the search: one first shape after the other; equilibria from other answers and in heaps |
//! | `first_shapes.rs` | the list of first shapes, and the law that makes each necessary |
//! | `length_homotopy.rs` | a cable is shortened until it is taut, and paid out again |
//! | `multiple_equilibria.rs` | unstable equilibria of slack cables, and their other equilibria |
//! | `missing_friction.rs` | the friction that a sliding cable would need; the equilibrium after
//! drawing |

mod first_shapes;
mod length_homotopy;
mod missing_friction;
mod multiple_equilibria;

pub(super) use first_shapes::{FirstShape, SHAPES_WITH_FRICTION};

use crate::math::Vec2;
use crate::model::spans::boundary::Mode;
use crate::model::spans::continuation::StepStats;
use crate::model::spans::first_equilibrium::first_shapes::{FIRST_SHAPES, FirstFriction, FirstLength, SlackCable};
use crate::model::spans::initial::from_solution;
use crate::model::spans::newton::Workspace;
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, CableSection, Failure};
use crate::model::spans::section_layout::SectionLayout;
use crate::model::spans::slack::{self, LooseShapes};
use crate::solution::Node;

/// Friction with which the search for a first equilibrium may begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum SearchStart {
    /// With friction only.
    Rubbing,
    /// Without friction as well: friction holds the cable from then on.
    Either,
    /// Without friction only.
    Frictionless,
}

/// A search that found no equilibrium.
#[derive(Debug)]
pub(in crate::model::spans) struct NotFound {
    /// The reason why there is none.
    pub failure: Failure,
    /// The cable as far as it was paid out, if that stopped the search.
    pub let_out: Option<Box<CableEquilibrium>>,
}

impl From<Failure> for NotFound {
    fn from(failure: Failure) -> Self {
        Self { failure, let_out: None }
    }
}

impl CableEquilibrium {
    /// The first equilibrium of a cable along its route.
    ///
    /// # Errors
    /// The reason why none was found.
    pub fn along_route(
        layout: &SectionLayout,
        instant: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<(Self, StepStats), NotFound> {
        Self::along_route_from(layout, instant, SearchStart::Either, workspace)
    }

    /// As [`Self::along_route`], with the friction with which the search may begin.
    pub fn along_route_from(
        layout: &SectionLayout,
        instant: &BoundaryConditions,
        start: SearchStart,
        workspace: &mut Workspace,
    ) -> Result<(Self, StepStats), NotFound> {
        // A cable that is not held at both ends would run to a place where it needs no friction.
        let is_held = layout.sections.iter().all(|s| s.supports.iter().all(Option::is_some));
        let without_friction = start != SearchStart::Rubbing && is_held;
        let with_friction = start != SearchStart::Frictionless && instant.friction > 0.0;
        let smooth = BoundaryConditions { friction: 0.0, ..instant.clone() };
        let context = layout.context(layout.curves(), instant);
        let (mut first, mut stopped, mut pushes, mut loose) = (None, None, false, None);
        let tuned = &layout.settings.continuation;
        let mut work_left = tuned.max_work;
        for shape in FIRST_SHAPES {
            let begin = match shape.friction {
                FirstFriction::FromTheStart => instant,
                FirstFriction::OnceAtRest => &smooth,
            };
            if !(if begin.friction > 0.0 { with_friction } else { without_friction }) {
                continue;
            }
            if shape.slack == SlackCable::WhereTensionEnds && !pushes {
                continue;
            }
            let mut cable_equilibrium = Self { sections: Vec::new(), context: context.clone(), instant: begin.clone() };
            cable_equilibrium.context.loose_where_tension_ends = shape.slack == SlackCable::WhereTensionEnds;
            // If an equilibrium is known, the cost of the search for another is limited.
            let beside_loose = shape.length != FirstLength::Whole
                && *loose.get_or_insert_with(|| Self::in_heaps(layout, instant).is_some());
            let most = if beside_loose { work_left.min(tuned.max_work_beside_loose) } else { work_left };
            workspace.work_left = Some(most);
            let found = cable_equilibrium.find_from(layout, shape, [begin, instant], workspace);
            work_left -= most - workspace.work_left.take().unwrap_or(most);
            match found {
                Ok(stats) => {
                    cable_equilibrium.context.loose_where_tension_ends = false;
                    return Ok((cable_equilibrium, stats));
                }
                Err(failure) => {
                    pushes |= matches!(failure, Failure::Compressed { .. });
                    if shape.length != FirstLength::Whole && stopped.is_none() {
                        stopped =
                            Some(NotFound { failure: failure.clone(), let_out: Some(Box::new(cable_equilibrium)) });
                    }
                    first = first.or(Some(failure));
                }
            }
        }
        Err(stopped.unwrap_or_else(|| first.unwrap_or(Failure::ContactCycling { s: 0.0 }).into()))
    }

    /// Seeks an equilibrium from one first shape, with the friction of `begin` and then that of
    /// `goal`.
    fn find_from(
        &mut self,
        layout: &SectionLayout,
        shape: FirstShape,
        [begin, goal]: [&BoundaryConditions; 2],
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        let stats = self.settle_along_route(layout, begin, shape, workspace)?;
        if !(begin.friction < goal.friction) {
            return Ok(stats);
        }
        let more = self.apply_friction(layout, goal, workspace)?;
        Ok(StepStats { found_without_friction: true, ..stats.plus(more) })
    }

    /// The equilibrium of a cable in heaps where it comes down, hanging over crests, and without
    /// tension where it lies.
    pub fn in_heaps(layout: &SectionLayout, instant: &BoundaryConditions) -> Option<Self> {
        let context = layout.context(layout.curves(), instant);
        let section = |k: usize| slack::loose_section(layout, k, &context, instant, LooseShapes::AnyTension);
        let sections = (0..layout.sections.len()).map(section).collect::<Option<Vec<CableSection>>>()?;
        Some(Self { sections, context, instant: instant.clone() })
    }

    /// As [`Self::in_heaps`], only if every section is too long to rest in tension.
    pub fn too_long_for_tension(layout: &SectionLayout, instant: &BoundaryConditions) -> Option<Self> {
        let context = layout.context(layout.curves(), instant);
        let exceeds = |k: usize| slack::exceeds_tension(layout, k, &context, instant);
        let all = !layout.sections.is_empty() && (0..layout.sections.len()).all(exceeds);
        if all { Self::in_heaps(layout, instant) } else { None }
    }

    /// The equilibrium next to an answer of another model.
    ///
    /// # Errors
    /// The reason why the cable does not rest there.
    pub fn from_answer(
        layout: &SectionLayout,
        instant: &BoundaryConditions,
        nodes: &[Node],
        workspace: &mut Workspace,
    ) -> Result<Self, Failure> {
        let mut first = None;
        for unused in layout.settings.continuation.unused_cone_fractions {
            let context = layout.context(layout.curves(), instant);
            let Some(sections) = from_solution::sections_of(layout, &context, instant, nodes, 1.0 - unused) else {
                continue;
            };
            let mut cable_equilibrium = Self { sections, context, instant: instant.clone() };
            match cable_equilibrium.step(layout, instant, workspace) {
                Ok(_) => return Ok(cable_equilibrium),
                Err(failure) => first = first.or(Some(failure)),
            }
        }
        let at = nodes.first().map_or(Vec2::zeros(), Node::at);
        Err(first.unwrap_or(Failure::ContactImpossible { s: 0.0, at }))
    }

    /// Lets friction act on a cable that rests without it.
    fn apply_friction(
        &mut self,
        layout: &SectionLayout,
        goal: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        layout.set_context(&mut self.context, goal);
        for c in self.sections.iter_mut().flat_map(|s| &mut s.contacts) {
            if self.context.friction(c) > 0.0 {
                c.mode = Mode::Stick;
            }
        }
        self.step(layout, goal, workspace)
    }
}
