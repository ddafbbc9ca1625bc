//! The first equilibrium of a cable is sought from its route.
//!
//! Every first shape has one energy, and each law below says what can keep Newton's method from its
//! minimum. The shapes of [`FIRST_SHAPES`] are tried in order, the cheapest first, and each gives
//! up one thing that the shapes before it assume:
//!
//! - **Friction.** The equilibrium with the least sliding lies nearest to the route, so friction
//!   acts from there. A cable whose route is far from every such equilibrium slides to one: it is
//!   sought without friction, where the energy alone decides, and friction holds it from then on. A
//!   cable that is not held at both ends would run away, and keeps its friction.
//! - **Slack.** The spans of a slack cable are no function of its ends. Shrunk until a tension of a
//!   few weights draws it taut along its route, it is let out again step by step; more tension,
//!   where the first was not enough.
//! - **Tension.** A contact that would have to push shows that cable has no tension left there
//!   ([`Failure::Compressed`]): only then may it lie loose on the ground.
//! - **Posts as polygons.** A cable that nothing but friction holds may pass between the points
//!   that stand for a post: more points, for it alone ([`posts_seen_nearer`]).

use crate::math::Vec2;
use crate::model::spans::boundary::friction_memory::Mode;
use crate::model::spans::boundary::loose::Loose;
use crate::model::spans::boundary_conditions::{BoundaryConditions, CableEquilibrium, Layout};
use crate::model::spans::continuation::StepStats;
use crate::model::spans::failure::Failure;
use crate::model::spans::initial::contacts;
use crate::model::spans::initial::from_solution;
use crate::model::spans::initial::shortest_path::{RINGS, Ring};
use crate::model::spans::initial::tension;
use crate::model::spans::newton::Work;
use crate::model::spans::run::CableRun;
use crate::model::spans::settings::ContinuationSettings;
use crate::model::spans::slack::{self, LooseShapes};
use crate::solution::Node;

/// A first shape from which an equilibrium is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstShape {
    friction: FirstFriction,
    length: FirstLength,
    slack: SlackCable,
    /// The points that stand for a post.
    posts: Ring,
}

/// The friction with which an equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FirstFriction {
    /// All of it.
    FromTheStart,
    /// None until the cable rests, then all of it.
    OnceAtRest,
}

/// The length of cable with which an equilibrium is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FirstLength {
    /// All of it.
    Whole,
    /// Shrunk to `first_tension_weights`, then let out.
    Taut,
    /// Shrunk to `second_tension_weights`, then let out.
    VeryTaut,
}

/// Where a cable may lie without tension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SlackCable {
    /// Nowhere.
    Nowhere,
    /// A strand that spreads on the ground along its route.
    AlongRoute,
    /// That, and cable that comes down on a smooth contact and has no tension left.
    WhereTensionEnds,
}

/// All of the cable along its route with friction: most cables rest next to it.
const ALONG_ROUTE: FirstShape = FirstShape {
    friction: FirstFriction::FromTheStart,
    length: FirstLength::Whole,
    slack: SlackCable::AlongRoute,
    posts: RINGS[0],
};

/// The same cable, drawn taut.
const TAUT: FirstShape = FirstShape { length: FirstLength::Taut, ..ALONG_ROUTE };

/// The first shapes in the order in which they are tried, each with what makes it necessary.
const FIRST_SHAPES: [FirstShape; 6] = [
    ALONG_ROUTE,
    // Friction holds no place near the route.
    FirstShape { friction: FirstFriction::OnceAtRest, ..ALONG_ROUTE },
    // Slack keeps Newton's method from the place without friction.
    FirstShape { friction: FirstFriction::OnceAtRest, ..TAUT },
    // A contact would have to push: cable there has no tension.
    FirstShape { slack: SlackCable::WhereTensionEnds, ..ALONG_ROUTE },
    // Slack keeps Newton's method from the place with friction.
    TAUT,
    // A stiff cable stretches so little that a few weights do not draw it taut.
    FirstShape { friction: FirstFriction::OnceAtRest, length: FirstLength::VeryTaut, ..ALONG_ROUTE },
];

/// The first shapes that are tried after [`FIRST_SHAPES`] if nothing but friction holds a strand.
fn posts_seen_nearer(layout: &Layout) -> impl Iterator<Item = FirstShape> {
    shapes_with_friction(layout).into_iter().skip(1)
}

/// The first shapes with friction that can tell how much of it a cable needs.
pub(super) fn shapes_with_friction(layout: &Layout) -> Vec<FirstShape> {
    let held_by_friction = layout.strands.iter().any(|s| s.supports.iter().all(Option::is_none));
    let rings = if held_by_friction { &RINGS[..] } else { &RINGS[..1] };
    let shapes = rings.iter().map(|posts| FirstShape { posts: *posts, ..ALONG_ROUTE });
    shapes.chain(held_by_friction.then_some(TAUT)).collect()
}

impl FirstLength {
    /// The tension, in weights of the cable, to which it is shrunk; None: not at all.
    fn tension_weights(self, tuned: &ContinuationSettings) -> Option<f64> {
        match self {
            Self::Whole => None,
            Self::Taut => Some(tuned.first_tension_weights),
            Self::VeryTaut => Some(tuned.second_tension_weights),
        }
    }
}

/// Places at which the search for a first equilibrium may begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum SearchStart {
    /// With friction only.
    WithFriction,
    /// Without friction, too: friction holds the cable from then on.
    AlsoWithoutFriction,
}

/// A search that found no equilibrium.
#[derive(Debug)]
pub(in crate::model::spans) struct NotFound {
    /// Why there is none.
    pub failure: Failure,
    /// The cable as far as it was let out, where that stopped the search.
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
    /// Why none was found.
    pub fn along_route(
        layout: &Layout,
        instant: &BoundaryConditions,
        work: &mut Work,
    ) -> Result<(Self, StepStats), NotFound> {
        Self::along_route_from(layout, instant, SearchStart::AlsoWithoutFriction, work)
    }

    /// The same, with the places where the search may begin.
    pub fn along_route_from(
        layout: &Layout,
        instant: &BoundaryConditions,
        start: SearchStart,
        work: &mut Work,
    ) -> Result<(Self, StepStats), NotFound> {
        // A cable that is not held at both ends would run to where it needs no friction.
        let is_held = layout.strands.iter().all(|s| s.supports.iter().all(Option::is_some));
        let without_friction = start == SearchStart::AlsoWithoutFriction && is_held;
        let smooth = BoundaryConditions { friction: 0.0, ..instant.clone() };
        let course = layout.course(layout.curves(), instant);
        let (mut first, mut stopped, mut pushes) = (None, None, false);
        for shape in FIRST_SHAPES.into_iter().chain(posts_seen_nearer(layout)) {
            let begin = match shape.friction {
                FirstFriction::FromTheStart => instant,
                FirstFriction::OnceAtRest => &smooth,
            };
            if !(without_friction || begin.friction > 0.0) {
                continue;
            }
            if shape.slack == SlackCable::WhereTensionEnds && !pushes {
                continue;
            }
            let mut network = Self { strands: Vec::new(), course: course.clone(), instant: begin.clone() };
            network.course.loose_where_tension_ends = shape.slack == SlackCable::WhereTensionEnds;
            match network.find_from(layout, shape, [begin, instant], work) {
                Ok(taken) => {
                    network.course.loose_where_tension_ends = false;
                    return Ok((network, taken));
                }
                Err(failure) => {
                    pushes |= matches!(failure, Failure::Compressed { .. });
                    if shape.length != FirstLength::Whole && stopped.is_none() {
                        stopped = Some(NotFound { failure: failure.clone(), let_out: Some(Box::new(network)) });
                    }
                    first = first.or(Some(failure));
                }
            }
        }
        Err(stopped.unwrap_or_else(|| first.unwrap_or(Failure::Restless { s: 0.0 }).into()))
    }

    /// Seeks an equilibrium from one first shape, with the friction of `begin` and then that of
    /// `goal`.
    fn find_from(
        &mut self,
        layout: &Layout,
        shape: FirstShape,
        [begin, goal]: [&BoundaryConditions; 2],
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let taken = self.lay_along_route(layout, begin, shape, work)?;
        if !(begin.friction < goal.friction) {
            return Ok(taken);
        }
        let more = self.apply_friction(layout, goal, work)?;
        Ok(StepStats { found_without_friction: true, ..taken.and(more) })
    }

    /// The cable in heaps where it comes down, hanging over crests, without tension where it lies.
    pub fn in_heaps(layout: &Layout, instant: &BoundaryConditions) -> Option<Self> {
        let course = layout.course(layout.curves(), instant);
        let strand = |k: usize| slack::loose_strand(layout, k, &course, instant, LooseShapes::AnyTension);
        let strands = (0..layout.strands.len()).map(strand).collect::<Option<Vec<CableRun>>>()?;
        Some(Self { strands, course, instant: instant.clone() })
    }

    /// The equilibrium next to an answer of another model.
    ///
    /// # Errors
    /// Why the cable does not rest there.
    pub fn from_answer(
        layout: &Layout,
        instant: &BoundaryConditions,
        nodes: &[Node],
        work: &mut Work,
    ) -> Result<Self, Failure> {
        let mut first = None;
        for unused in layout.settings.continuation.unused_cone_fractions {
            let course = layout.course(layout.curves(), instant);
            let Some(strands) = from_solution::strands_of(layout, &course, instant, nodes, 1.0 - unused) else {
                continue;
            };
            let mut network = Self { strands, course, instant: instant.clone() };
            match network.step(layout, instant, work) {
                Ok(_) => return Ok(network),
                Err(failure) => first = first.or(Some(failure)),
            }
        }
        let at = nodes.first().map_or(Vec2::zeros(), Node::at);
        Err(first.unwrap_or(Failure::ContactImpossible { s: 0.0, at }))
    }

    /// Lays the cable along its route in hardly any tension, whether or not it could lie there
    /// loose.
    pub(super) fn lay_in_tension(
        &mut self,
        layout: &Layout,
        goal: &BoundaryConditions,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        self.lay_along_route(layout, goal, FirstShape { slack: SlackCable::Nowhere, ..ALONG_ROUTE }, work)
    }

    /// Lays the cable along its route and finds its equilibrium: with all of its length, or shrunk
    /// until it is taut and then let out again.
    pub(super) fn lay_along_route(
        &mut self,
        layout: &Layout,
        goal: &BoundaryConditions,
        shape: FirstShape,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let taut = shape.length.tension_weights(tuned);
        let mut begin = goal.clone();
        layout.set_course(&mut self.course, &begin);
        let routes = self.lay_strands(layout, &begin, shape)?;
        if let Some(taut) = taut {
            begin.thermal = self.shrunk_thermal(layout, goal, taut);
            begin.load *= tuned.first_load_fraction;
            begin.forces.iter_mut().for_each(|f| *f *= tuned.first_load_fraction);
            layout.set_course(&mut self.course, &begin);
            for (strand, part) in self.strands.iter_mut().zip(&layout.strands) {
                if part.supports.iter().all(Option::is_some) {
                    tension::tighten(strand, &self.course);
                }
            }
        }
        self.instant = begin.clone();
        let mut taken = self.step_from(layout, &begin, &routes, work)?;
        if self.end_smoothness() {
            taken = taken.and(self.step(layout, &begin, work)?);
        }
        if taut.is_none() {
            return Ok(taken);
        }
        let heavy = BoundaryConditions { thermal: begin.thermal, ..goal.clone() };
        taken = taken.and(self.travel(layout, &heavy, tuned.first_step, work)?);
        Ok(taken.and(self.travel(layout, goal, tuned.first_step, work)?))
    }

    /// Lays each strand along its route; returns the routes, none for a strand that lies loose.
    fn lay_strands(
        &mut self,
        layout: &Layout,
        begin: &BoundaryConditions,
        shape: FirstShape,
    ) -> Result<Vec<Vec<Vec2>>, Failure> {
        let may_lie_loose = shape.length == FirstLength::Whole && shape.slack != SlackCable::Nowhere;
        self.strands.clear();
        let mut routes = Vec::new();
        for k in 0..layout.strands.len() {
            let loose = if may_lie_loose {
                slack::loose_strand(layout, k, &self.course, begin, LooseShapes::NoTension)
            } else {
                None
            };
            if let Some(strand) = loose.filter(|s| s.loose.as_ref().is_some_and(Loose::spreads)) {
                self.strands.push(strand);
                routes.push(Vec::new());
                continue;
            }
            let laid = contacts::strand_along_route(layout, k, &self.course, begin, shape.posts);
            let no_way = Failure::ContactImpossible { s: layout.strands[k].material[0], at: begin.places[0] };
            let (strand, route) = laid.ok_or(no_way)?;
            self.strands.push(strand);
            routes.push(route);
        }
        Ok(routes)
    }

    /// Lets the contacts rub that were met on the way to an equilibrium; returns whether there were
    /// any.
    fn end_smoothness(&mut self) -> bool {
        let mut met = false;
        for c in self.strands.iter_mut().flat_map(|s| &mut s.contacts).filter(|c| c.smooth) {
            c.smooth = false;
            met = true;
            if self.course.friction(c) > 0.0 {
                c.mode = Mode::Hold;
            }
        }
        met
    }

    /// The factor on lengths with which a tension of so many weights draws the cable along its
    /// route.
    fn shrunk_thermal(&self, layout: &Layout, goal: &BoundaryConditions, taut: f64) -> f64 {
        let p = &layout.problem;
        let drawn: f64 = goal.forces.iter().map(|f| f.norm()).sum();
        let tension = taut * goal.load.norm() * p.length + drawn;
        let mut least = goal.thermal;
        for s in &self.strands {
            let way = tension::taut_length(s, &self.course);
            let taut = way / ((s.to - s.from) * (1.0 + tension / p.axial_stiffness));
            if taut < least && taut > 0.0 {
                least = taut;
            }
        }
        least
    }

    /// Lets friction act on a cable that rests without it, and rests with it all the more.
    fn apply_friction(
        &mut self,
        layout: &Layout,
        goal: &BoundaryConditions,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        layout.set_course(&mut self.course, goal);
        for c in self.strands.iter_mut().flat_map(|s| &mut s.contacts) {
            if self.course.friction(c) > 0.0 {
                c.mode = Mode::Hold;
            }
        }
        self.step(layout, goal, work)
    }
}
