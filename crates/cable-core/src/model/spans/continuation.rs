//! The continuation finds the initial equilibrium and follows it through time, and halves load
//! steps that fail.

use crate::contact::swept_corners;
use crate::math::{Vec2, bounded, larger, smaller};
use crate::model::spans::boundary::friction_memory::Mode;
use crate::model::spans::boundary::loose::Loose;
use crate::model::spans::boundary_conditions::{BoundaryConditions, CableEquilibrium, Layout, place_ends};
use crate::model::spans::changes;
use crate::model::spans::contact::point_load;
use crate::model::spans::contact::slack_pocket;
use crate::model::spans::failure::Failure;
use crate::model::spans::initial::contacts;
use crate::model::spans::initial::from_solution;
use crate::model::spans::initial::shortest_path::{RINGS, Ring};
use crate::model::spans::initial::tension;
use crate::model::spans::newton;
use crate::model::spans::newton::slip_predictor::predict_slip;
use crate::model::spans::newton::{Solved, Work};
use crate::model::spans::run::{CableRun, Course};
use crate::model::spans::slack::{self, Sought};
use crate::model::spans::verify::clearance;
use crate::model::spans::verify::equilibrium;
use crate::model::spans::verify::tension_loss;
use crate::model::spans::verify::tunnelling;
use crate::solution::Node;

/// A force that differs by less than this part is the same.
const FORCE_TOLERANCE: f64 = 1e-9;

/// Part of the friction that is missing to which it is found: three digits are shown.
const MISSING_FRICTION_TOLERANCE: f64 = 2e-4;
/// Less than this part that is missing is none: rounding. Larger: a cable that slides by so little
/// has no answer and no cause.
const LEAST_PART: f64 = 1e-7;

/// Why no rest was found, and how far the cable was let out.
pub(in crate::model::spans) type Unfound = (Failure, Option<Box<CableEquilibrium>>);

/// Resolution of a route: the points that stand for a post, and the tension (of the weight) to
/// which the cable is shrunk at first.
#[derive(Clone, Copy, Debug)]
struct RouteResolution {
    ring: Ring,
    first_tension: Option<f64>,
    /// True if a cable that spreads on the ground may lie there without tension.
    loose: bool,
    /// True if cable that comes down without friction lies loose where it has no tension left.
    lies_loose: bool,
}

impl Default for RouteResolution {
    fn default() -> Self {
        Self { ring: RINGS[0], first_tension: None, loose: true, lies_loose: false }
    }
}

/// Places at which the search for an initial equilibrium may begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum SearchStart {
    /// With friction only.
    WithFriction,
    /// Without friction, too: friction holds the cable from then on.
    AlsoWithoutFriction,
}

/// Cost of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model::spans) struct StepStats {
    pub solved: Solved,
    pub halved: usize,
    /// Times it ran away from where it was to another place that holds it.
    pub ran: usize,
    /// True if the rest was found without friction, which held it from then on.
    pub eased: bool,
    /// Friction that what came down would have had in the step it came down in, of the force there.
    pub fresh: f64,
}

impl CableEquilibrium {
    /// The rest of a cable laid along its route.
    ///
    /// # Errors
    /// Why none was found, and how far the cable was let out where that stopped the search.
    pub fn rest(layout: &Layout, instant: &BoundaryConditions, work: &mut Work) -> Result<(Self, StepStats), Unfound> {
        Self::rest_from(layout, instant, SearchStart::AlsoWithoutFriction, work)
    }

    /// The same, with the places where the search may begin.
    pub fn rest_from(
        layout: &Layout,
        instant: &BoundaryConditions,
        start: SearchStart,
        work: &mut Work,
    ) -> Result<(Self, StepStats), Unfound> {
        let curves = layout.curves();
        let course = layout.course(curves, instant);
        // As it is laid; else where it needs no friction; where it would push there, some of it
        // lies loose; each may have to begin taut.
        let smooth = BoundaryConditions { friction: 0.0, ..instant.clone() };
        let taut = [
            None,
            Some(layout.settings.continuation.first_tension_weights),
            Some(layout.settings.continuation.second_tension_weights),
        ];
        let laid = |k: usize| RouteResolution { first_tension: taut[k], ..RouteResolution::default() };
        let lies_loose = RouteResolution { lies_loose: true, ..RouteResolution::default() };
        let ways = [
            (instant, laid(0)),
            (&smooth, laid(0)),
            (&smooth, laid(1)),
            (instant, lies_loose),
            (instant, laid(1)),
            (&smooth, laid(2)),
        ];
        // A cable that is not held at both ends would run to where it needs no friction.
        let held = start == SearchStart::AlsoWithoutFriction
            && layout.strands.iter().all(|s| s.supports.iter().all(Option::is_some));
        let nearer = Self::resolutions(layout).into_iter().skip(1).map(|resolution| (instant, resolution));
        let (mut first, mut stopped, mut pushes) = (None, None, false);
        for (begin, resolution) in ways.into_iter().chain(nearer).filter(|(begin, _)| held || begin.friction > 0.0) {
            if resolution.lies_loose && !pushes {
                continue;
            }
            let first_tension = resolution.first_tension;
            let course = Course { lies_loose: resolution.lies_loose, ..course.clone() };
            let mut network = Self { strands: Vec::new(), course, instant: begin.clone() };
            match network.laid(layout, begin, resolution, work).and_then(|taken| {
                if begin.friction < instant.friction {
                    network.rub(layout, instant, work).map(|more| StepStats { eased: true, ..taken.and(more) })
                } else {
                    Ok(taken)
                }
            }) {
                Ok(taken) => {
                    network.course.lies_loose = false;
                    return Ok((network, taken));
                }
                Err(failure) => {
                    pushes |= matches!(failure, Failure::Compressed { .. });
                    if first_tension.is_some() && stopped.is_none() {
                        stopped = Some((failure.clone(), Some(Box::new(network))));
                    }
                    first = first.or(Some((failure, None)));
                }
            }
        }
        Err(stopped.or(first).unwrap_or((Failure::Restless { s: 0.0 }, None)))
    }

    /// A cable that comes down in a heap and hangs over crests, without tension where it lies.
    pub fn heaped(layout: &Layout, instant: &BoundaryConditions) -> Option<Self> {
        let course = layout.course(layout.curves(), instant);
        let strands = strands_of(layout, |k| slack::lay(layout, k, &course, instant, Sought::AnyTension))?;
        Some(Self { strands, course, instant: instant.clone() })
    }

    /// The resolutions in which a cable can be laid as it is: posts seen nearer, too, where it lies
    /// on something and nothing else holds it.
    fn resolutions(layout: &Layout) -> Vec<RouteResolution> {
        let loose = layout.strands.iter().any(|s| s.supports.iter().all(Option::is_none));
        let rings = if loose { &RINGS[..] } else { &RINGS[..1] };
        let laid = rings.iter().map(|ring| RouteResolution { ring: *ring, ..RouteResolution::default() });
        laid.chain(loose.then_some(RouteResolution {
            first_tension: Some(layout.settings.continuation.first_tension_weights),
            ..RouteResolution::default()
        }))
        .collect()
    }

    /// The same cable where all friction acts against it as it is drawn one way (1: towards its
    /// end, −1: towards its start): what it comes to where a history ends so. None where there is
    /// no such balance.
    pub fn drawn(&self, layout: &Layout, way: f64, work: &mut Work) -> Option<Self> {
        let mut network = self.clone();
        network.course.mobilised = way;
        let instant = self.instant.clone();
        network.step(layout, &instant, work).ok()?;
        Some(network)
    }

    /// The part of its friction with which a cable that nothing holds but friction would rest as it
    /// is laid, where with all of it it slides: just above the least one. None where it rests, or
    /// where it is not known to slide.
    ///
    /// With less than that part every contact of the strand slides the same way: that, found just
    /// above it, is what proves that it is friction that is missing, not an answer.
    pub fn friction_needed(layout: &Layout, instant: &BoundaryConditions, work: &mut Work) -> Option<f64> {
        let tuned = &layout.settings.continuation;
        let course = layout.course(layout.curves(), instant);
        let mut rests = |part: f64, resolution: RouteResolution| {
            let begin = BoundaryConditions { friction: part, ..instant.clone() };
            let mut network = Self { strands: Vec::new(), course: course.clone(), instant: begin.clone() };
            let taken = network.laid(layout, &begin, resolution, work).ok()?;
            (taken.ran == 0).then_some(network)
        };
        let (mut low, mut step) = (1.0, tuned.first_missing_part);
        let (mut high, resolution) = loop {
            if step > tuned.max_missing_part {
                return None;
            }
            let high = 1.0 + step;
            if let Some(resolution) =
                Self::resolutions(layout).into_iter().find(|resolution| rests(high, *resolution).is_some())
            {
                break (high, resolution);
            }
            (low, step) = (high, 2.0 * step);
        };
        while high - low > MISSING_FRICTION_TOLERANCE * (high - 1.0) {
            let middle = 0.5 * (low + high);
            if rests(middle, resolution).is_some() {
                high = middle;
            } else {
                low = middle;
            }
            if high - 1.0 < LEAST_PART {
                return None;
            }
        }
        let found = rests(high, resolution)?;
        let near = tuned.mobilised_fraction * (1.0 + MISSING_FRICTION_TOLERANCE * (high - 1.0));
        let slides = |s: &CableRun| [1.0, -1.0].iter().any(|way| point_load::mobilised(s, &found.course, *way, near));
        let loose = layout.strands.iter().zip(&found.strands).filter(|(p, _)| p.supports.iter().all(Option::is_none));
        loose.map(|(_, s)| s).any(slides).then_some(high)
    }

    /// As an answer of another model has it.
    ///
    /// # Errors
    /// Why it does not hold there.
    pub fn taken(
        layout: &Layout,
        instant: &BoundaryConditions,
        nodes: &[Node],
        work: &mut Work,
    ) -> Result<Self, Failure> {
        let mut first = None;
        for unused in layout.settings.continuation.unused_cone_fractions {
            let course = layout.course(layout.curves(), instant);
            let Some(strands) = from_solution::take(layout, &course, instant, nodes, 1.0 - unused) else { continue };
            let mut network = Self { strands, course, instant: instant.clone() };
            match network.step(layout, instant, work) {
                Ok(_) => return Ok(network),
                Err(failure) => first = first.or(Some(failure)),
            }
        }
        let at = nodes.first().map_or(Vec2::zeros(), Node::at);
        Err(first.unwrap_or(Failure::ContactImpossible { s: 0.0, at }))
    }

    /// Lays it along the route as it is, or shrunk until it is taut and then let out again.
    fn laid(
        &mut self,
        layout: &Layout,
        goal: &BoundaryConditions,
        resolution: RouteResolution,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let taut = resolution.first_tension;
        let mut begin = goal.clone();
        layout.give(&mut self.course, &begin);
        self.strands.clear();
        let mut came = Vec::new();
        for k in 0..layout.strands.len() {
            let may = taut.is_none() && resolution.loose;
            let loose = if may { slack::lay(layout, k, &self.course, &begin, Sought::NoTension) } else { None };
            if let Some(strand) = loose.filter(|s| s.loose.as_ref().is_some_and(Loose::spreads)) {
                self.strands.push(strand);
                came.push(Vec::new());
                continue;
            }
            let laid = contacts::lay(layout, k, &self.course, &begin, resolution.ring);
            let no_way = Failure::ContactImpossible { s: layout.strands[k].material[0], at: goal.places[0] };
            let (strand, way) = laid.ok_or(no_way)?;
            self.strands.push(strand);
            came.push(way);
        }
        if let Some(taut) = taut {
            begin.thermal = self.shrunk_thermal(layout, goal, taut);
            begin.load *= tuned.first_load_fraction;
            begin.forces.iter_mut().for_each(|f| *f *= tuned.first_load_fraction);
            layout.give(&mut self.course, &begin);
            for (strand, part) in self.strands.iter_mut().zip(&layout.strands) {
                if part.supports.iter().all(Option::is_some) {
                    tension::tighten(strand, &self.course);
                }
            }
        }
        self.instant = begin.clone();
        let mut taken = self.step_from(layout, &begin, &came, work)?;
        // Contacts that were met on the way rub from now on.
        let mut met = false;
        for c in self.strands.iter_mut().flat_map(|s| &mut s.contacts).filter(|c| c.smooth) {
            c.smooth = false;
            met = true;
            if self.course.friction(c) > 0.0 {
                c.mode = Mode::Hold;
            }
        }
        if met {
            taken = taken.and(self.step(layout, &begin, work)?);
        }
        if taut.is_none() {
            return Ok(taken);
        }
        let heavy = BoundaryConditions { thermal: begin.thermal, ..goal.clone() };
        taken = taken.and(self.travel(layout, &heavy, tuned.first_step, work)?);
        Ok(taken.and(self.travel(layout, goal, tuned.first_step, work)?))
    }

    /// The factor on lengths at which the cable is taut along the string of its route.
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

    /// Friction acts from now on; what rests without it rests with it.
    fn rub(&mut self, layout: &Layout, goal: &BoundaryConditions, work: &mut Work) -> Result<StepStats, Failure> {
        layout.give(&mut self.course, goal);
        for c in self.strands.iter_mut().flat_map(|s| &mut s.contacts) {
            if self.course.friction(c) > 0.0 {
                c.mode = Mode::Hold;
            }
        }
        self.step(layout, goal, work)
    }

    /// One step to an instant; on an error nothing has changed.
    pub fn step(&mut self, layout: &Layout, to: &BoundaryConditions, work: &mut Work) -> Result<StepStats, Failure> {
        self.step_from(layout, to, &[], work)
    }

    /// One step, of a rest that is sought from the given shapes of the strands.
    fn step_from(
        &mut self,
        layout: &Layout,
        to: &BoundaryConditions,
        came: &[Vec<Vec2>],
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let mut taken = StepStats::default();
        work.before.clone_from(&self.strands);
        work.instants[0].clone_from(&self.instant);
        self.instant.clone_from(to);
        layout.give(&mut self.course, to);
        for k in 0..self.strands.len() {
            match self.solve(layout, k, came.get(k).map(Vec::as_slice), work) {
                Ok(one) => taken = taken.and(one),
                Err(failure) => {
                    self.undo(layout, work);
                    return Err(failure);
                }
            }
        }
        if let Err(failure) = equilibrium::balanced(layout, self) {
            self.undo(layout, work);
            return Err(failure);
        }
        Ok(taken)
    }

    /// To where the last step began.
    fn undo(&mut self, layout: &Layout, work: &Work) {
        self.strands.clone_from(&work.before);
        self.instant.clone_from(&work.instants[0]);
        layout.give(&mut self.course, &self.instant);
    }

    fn solve(
        &mut self,
        layout: &Layout,
        k: usize,
        came: Option<&[Vec2]>,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let [mut start, mut moved] = std::mem::take(&mut work.strands);
        start.clone_from(&self.strands[k]);
        let found = self.solve_from(layout, k, came, [&mut start, &mut moved], work);
        if found.is_err() {
            self.strands[k].clone_from(&start);
        }
        work.strands = [start, moved];
        found
    }

    /// As [`Self::solve`]; on an error the strand is anywhere.
    fn solve_from(
        &mut self,
        layout: &Layout,
        k: usize,
        came: Option<&[Vec2]>,
        [start, moved]: [&mut CableRun; 2],
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        if self.strands[k].loose.is_some() {
            return self.lie(layout, k);
        }
        let world = &layout.problem.world;
        let strand = &mut self.strands[k];
        place_ends(layout, k, strand, &self.course, &self.instant)?;
        moved.clone_from(strand);
        if came.is_none() && self.course.mobilised == 0.0 {
            predict_slip(strand, &self.course, &mut work.slip_predictor);
        }
        let mut found = changes::solve(strand, &mut self.course, world, &layout.corners, came, work);
        if found.is_err() {
            // From where each span by itself would be.
            strand.clone_from(moved);
            let mut other = came.is_none();
            for j in 0..strand.spans() {
                if strand.has_span(j)
                    && let Some(g) = strand.solve_span(&self.course, j)
                {
                    other |= (strand.forces[j] - g).norm() > FORCE_TOLERANCE * g.norm();
                    strand.forces[j] = g;
                }
            }
            if other {
                found = changes::solve(strand, &mut self.course, world, &layout.corners, came, work);
            }
        }
        if found.is_err() {
            // Spans with hardly any tension left may have lost it: the least, the two least …
            let mut loose = Vec::new();
            slack_pocket::candidates(start, &self.course, &mut loose);
            for n in 1..=loose.len().min(layout.settings.continuation.max_pockets) {
                strand.clone_from(moved);
                for (_, k) in &loose[..n] {
                    slack_pocket::fill(strand, &self.course, *k);
                }
                let again = changes::solve(strand, &mut self.course, world, &layout.corners, came, work);
                if again.is_ok() {
                    found = again;
                    break;
                }
            }
        }
        let mut taken = StepStats { solved: found?, ..StepStats::default() };
        if came.is_none() {
            taken.fresh = point_load::fresh(&self.strands[k], &self.course);
        }
        for c in &mut self.strands[k].contacts {
            let track = self.course.track(c).seen_from(c.ends.p[0]);
            if c.is_load() {
                c.ends.p[1] = c.ends.p[0];
            }
            c.history.commit(&track, &c.ends, c.mode, c.held, &mut work.past);
            // Contacts that came down in this step rub from now on.
            if c.smooth && came.is_none() {
                c.smooth = false;
                c.mode = if self.course.curves[c.curve].friction > 0.0 { Mode::Hold } else { c.mode };
            }
        }
        equilibrium::verify(&self.strands[k], &self.course)?;
        clearance::clear(&self.strands[k], &self.course, world)?;
        // The shape before the step is drawn with the load and the lengths of before: with those of
        // after it spans of a cable that is let out or loaded in this step would end beside their
        // contacts.
        let was = &work.instants[0];
        let other =
            was.load != self.instant.load || was.thermal != self.instant.thermal || was.forces != self.instant.forces;
        let clear = || !other && tunnelling::clear(start, &self.strands[k], &self.course, &layout.corners);
        if !world.is_empty() && came.is_none() && !clear() {
            let [old, new] = &mut work.shapes;
            if other {
                layout.give(&mut self.course, &work.instants[0]);
            }
            tunnelling::shape(start, &self.course, old);
            if other {
                layout.give(&mut self.course, &self.instant);
            }
            tunnelling::shape(&self.strands[k], &self.course, new);
            if let Some(corner) = swept_corners::through(&layout.corners, old, new, &mut work.turns) {
                return Err(Failure::Passed { at: corner.at });
            }
        }
        Ok(taken)
    }

    /// A strand that lies loose goes on lying so while its supports stay where they are: as they
    /// move they draw its folds over the ground, and what that takes is not known here.
    fn lie(&mut self, layout: &Layout, k: usize) -> Result<StepStats, Failure> {
        let found = slack::lay(layout, k, &self.course, &self.instant, Sought::AnyTension);
        let strand = &mut self.strands[k];
        let Some(found) = found.filter(|f| f.ties == strand.ties) else {
            return Err(Failure::Drawn { s: strand.from });
        };
        *strand = found;
        Ok(StepStats::default())
    }

    /// Material that lies loose and the length of ground it lies on, m; None where none does.
    pub fn loose(&self) -> Option<[f64; 2]> {
        let lengths = self.strands.iter().filter_map(|s| s.loose.as_ref()).map(|l| l.lying_lengths(&self.course));
        lengths.reduce(|[a, b], [c, d]| [a + c, b + d])
    }

    /// The most that friction can hold of what lies loose, N.
    pub fn friction_of_loose(&self) -> f64 {
        self.strands.iter().filter_map(|s| s.loose.as_ref()).map(|l| l.friction(&self.course)).sum()
    }

    /// To an instant that no balance near by leads to: the cable slides under a drag that is taken
    /// away as it comes to rest.
    ///
    /// Each step is one of implicit Euler of η ds/dt = T₂ − T₁, which falls in energy; η is lowered
    /// as far as it goes (pseudo-transient continuation: C. T. Kelley and D. E. Keyes, SIAM J.
    /// Numer. Anal. 35, 1998).
    fn follow(&mut self, layout: &Layout, to: &BoundaryConditions, work: &mut Work) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let (before, old) = (self.strands.clone(), self.instant.clone());
        let size = to.load.norm();
        let (mut drag, mut taken, mut raised) = (tuned.drag_factor * size, StepStats::default(), 0);
        let mut pushed = None;
        for _ in 0..tuned.max_drag_steps {
            self.course.drag = drag;
            let result = self.step(layout, to, work);
            self.course.drag = 0.0;
            match result {
                Ok(t) => {
                    pushed = None;
                    taken = taken.and(t);
                    drag *= if raised > 0 { 0.5 } else { 0.25 };
                    raised = 0;
                    if drag < tuned.drag_factor * tuned.rest_drag_fraction * size
                        && let Ok(t) = self.step(layout, to, work)
                    {
                        return Ok(taken.and(t));
                    }
                }
                Err(failure) => {
                    pushed = matches!(failure, Failure::Compressed { .. }).then_some(failure);
                    drag *= 8.0;
                    raised += 1;
                }
            }
            if raised > tuned.max_drag_raises {
                break;
            }
        }
        self.strands = before;
        layout.give(&mut self.course, &old);
        self.instant = old;
        Err(pushed.unwrap_or(Failure::Restless { s: 0.0 }))
    }

    /// Leaves a balance that runs away for a stable one; a stable one is kept, and on an error
    /// nothing has changed.
    pub fn leave_unstable(
        &mut self,
        layout: &Layout,
        to: &BoundaryConditions,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        if self.stable(work) {
            return Ok(StepStats::default());
        }
        let by = layout.settings.continuation.leaving_fraction * layout.problem.length;
        let before = self.clone();
        self.slide_from(layout, to, |_| by, work).inspect_err(|_| {
            *self = before;
            layout.give(&mut self.course, to);
        })
    }

    /// Other balances of a slack cable that slides without friction: what hangs down in a loop
    /// pulls the harder the longer it is, so that the slack may rest on either side of a contact.
    /// It is moved from each side of each contact to the other, and on from each balance that is
    /// found so.
    pub fn other_balances(&self, layout: &Layout, work: &mut Work) -> Vec<Self> {
        let tuned = &layout.settings.continuation;
        let mut found = vec![self.clone()];
        let (mut from, mut tries) = (0, 0);
        while let Some(base) = found.get(from).cloned() {
            for (contact, by) in base.moves_of_slack(layout) {
                if tries == tuned.max_other_balances {
                    break;
                }
                tries += 1;
                let (mut other, to) = (base.clone(), base.instant.clone());
                let moved = |k: usize| if k == contact { by } else { 0.0 };
                if other.slide_from(layout, &to, moved, work).is_ok() && !found.iter().any(|f| f.is_at(&other, layout))
                {
                    found.push(other);
                }
            }
            from += 1;
        }
        found.split_off(1)
    }

    /// The contacts on both sides of which cable hangs, and the material that is moved to bring
    /// the slack of either side to the other, m.
    fn moves_of_slack(&self, layout: &Layout) -> Vec<(usize, f64)> {
        let least = layout.settings.continuation.least_slack_fraction;
        let mut moves = Vec::new();
        let mut index = 0;
        for strand in &self.strands {
            for j in 0..strand.contacts.len() {
                let slack = [j, j + 1].map(|k| strand.has_span(k).then(|| strand.slack(&self.course, k)).flatten());
                if let [Some([before, near]), Some([after, far])] = slack
                    && before + after > least * smaller(near, far)
                {
                    moves.extend([(index, (1.0 - least) * after), (index, -(1.0 - least) * before)]);
                }
                index += 1;
            }
        }
        moves
    }

    /// True if two balances have the same material at the same contacts.
    fn is_at(&self, other: &Self, layout: &Layout) -> bool {
        let near = layout.settings.continuation.other_balance_fraction * layout.problem.length;
        let [here, there] = [self, other].map(Self::materials);
        here.len() == there.len() && here.iter().zip(&there).all(|(a, b)| (a - b).abs() <= near)
    }

    /// Lets the cable slide to a stable balance, under a drag, from where the material at each
    /// contact is passed on by a length, m; on an error it is anywhere.
    ///
    /// The drag is lowered as the forces that are left fall, so that it stays while they grow
    /// (switched evolution relaxation: W. A. Mulder and B. van Leer, J. Comput. Phys. 59, 1985).
    fn slide_from(
        &mut self,
        layout: &Layout,
        to: &BoundaryConditions,
        passed_on_m: impl Fn(usize) -> f64,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let size = to.load.norm();
        let (mut drag, mut taken, mut left) = (tuned.leaving_drag_factor * size, StepStats::default(), None);
        let mut raised = 0;
        for (k, c) in self.strands.iter_mut().flat_map(|s| &mut s.contacts).enumerate() {
            let by = passed_on_m(k);
            c.history.pass_on(by);
            c.ends.s = c.ends.s.map(|s| s + by);
        }
        for strand in &mut self.strands {
            contacts::solve_spans(strand, &self.course).ok_or(Failure::Restless { s: strand.from })?;
        }
        for _ in 0..tuned.max_drag_steps {
            let materials = self.materials();
            self.course.drag = drag;
            let result = self.step(layout, to, work);
            self.course.drag = 0.0;
            let Ok(one) = result else {
                if raised == tuned.max_drag_raises {
                    break;
                }
                (drag, raised) = (8.0 * drag, raised + 1);
                continue;
            };
            (taken, raised) = (taken.and(one), 0);
            let slips = self.materials().into_iter().zip(materials).map(|(a, b)| (a - b).abs());
            let force = drag * slips.fold(0.0, larger);
            drag *= left.map_or(1.0, |left| bounded(force / left, 0.25, 1.0));
            left = Some(force);
            if drag < tuned.drag_factor * tuned.rest_drag_fraction * size
                && let Ok(one) = self.step(layout, to, work)
                && self.stable(work)
            {
                return Ok(taken.and(one));
            }
        }
        Err(Failure::Restless { s: 0.0 })
    }

    /// Material at the start of each contact, m.
    fn materials(&self) -> Vec<f64> {
        self.strands.iter().flat_map(|s| &s.contacts).map(|c| c.ends.s[0]).collect()
    }

    /// True if every strand is a stable rest and not a balance that runs away.
    pub fn stable(&self, work: &mut Work) -> bool {
        self.strands.iter().all(|s| newton::stable(s, &self.course, work))
    }

    /// Why a step was not taken: it would have to push however much it is held back, or nothing
    /// better than the failure of the step.
    fn reason(&self, step: Failure, held_back: Failure) -> Failure {
        let found_nothing = matches!(step, Failure::Stalled { .. } | Failure::Restless { .. });
        let pushes = matches!(held_back, Failure::Compressed { .. });
        if found_nothing && pushes && tension_loss::lost(&self.strands, &self.course, &step).is_none() {
            held_back
        } else {
            step
        }
    }

    /// A cable that lies loose along its route with a free end, as it is drawn: under hardly any
    /// tension instead, so that it can be followed.
    fn take_up(&mut self, layout: &Layout, to: &BoundaryConditions, work: &mut Work) {
        let held = |k: usize| layout.strands[k].supports.iter().all(Option::is_some);
        let spreads = |k: usize| self.strands[k].loose.as_ref().is_some_and(Loose::spreads);
        let follows = (0..self.strands.len()).all(|k| self.strands[k].loose.is_none() || (spreads(k) && !held(k)));
        if self.loose().is_none() || !follows || self.instant.places == to.places {
            return;
        }
        let instant = self.instant.clone();
        let mut taut = self.clone();
        if taut.laid(layout, &instant, RouteResolution { loose: false, ..RouteResolution::default() }, work).is_ok() {
            *self = taut;
        }
    }

    /// To an instant, in steps of this part of the way at first, halved where one fails.
    pub fn travel(
        &mut self,
        layout: &Layout,
        to: &BoundaryConditions,
        first: f64,
        work: &mut Work,
    ) -> Result<StepStats, Stopped> {
        self.take_up(layout, to, work);
        let [old, mut from, mut at] = std::mem::take(&mut work.instants);
        work.instants[0] = old;
        from.clone_from(&self.instant);
        let found = self.travel_from(layout, &from, to, &mut at, first, work);
        let old = std::mem::take(&mut work.instants[0]);
        work.instants = [old, from, at];
        found
    }

    fn travel_from(
        &mut self,
        layout: &Layout,
        from: &BoundaryConditions,
        to: &BoundaryConditions,
        at: &mut BoundaryConditions,
        first: f64,
        work: &mut Work,
    ) -> Result<StepStats, Stopped> {
        let tuned = &layout.settings.continuation;
        let (mut done, mut step, mut taken) = (0.0, first, StepStats::default());
        let mut halvings: u32 = 0;
        // Not on the way to a first rest; and the step that was taken but had something come down
        // in it.
        let (mut moves, mut whole) = (first >= 1.0, None);
        while done < 1.0 {
            let next = if done + 1.000_001 * step >= 1.0 { 1.0 } else { done + step };
            at.between(from, to, next);
            let failure = match self.step(layout, at, work) {
                // A contact has no friction in the step in which it comes down: that shall be a
                // short one.
                Ok(t) if moves && t.fresh > tuned.missing_friction_fraction && step > tuned.landing_step_fraction => {
                    self.undo(layout, work);
                    whole = whole.or(Some(step));
                    (step, taken.halved) = (0.5 * step, taken.halved + 1);
                    continue;
                }
                Ok(t) => {
                    (moves, whole) = (first >= 1.0, None);
                    taken = taken.and(t);
                    done = next;
                    if halvings > 0 || step < tuned.grown_step {
                        halvings = halvings.saturating_sub(1);
                        step *= 2.0;
                    }
                    continue;
                }
                // The long step was taken: better that than none.
                Err(_) if whole.is_some() => {
                    (moves, step) = (false, whole.take().unwrap_or(step));
                    continue;
                }
                Err(failure) => failure,
            };
            halvings += 1;
            step *= 0.5;
            taken.halved += 1;
            if halvings > tuned.max_halvings {
                // Where nothing near by holds the cable it runs away, to the next place that does.
                let next =
                    if done + tuned.runaway_step_fraction < 1.0 { done + tuned.runaway_step_fraction } else { 1.0 };
                at.between(from, to, next);
                let t = match self.follow(layout, at, work) {
                    Ok(t) => t,
                    Err(other) => return Err(Stopped { failure: self.reason(failure, other), done }),
                };
                (taken, done, halvings, step) = (taken.and(t), next, 0, tuned.runaway_step_fraction);
                taken.ran += 1;
            }
        }
        Ok(taken)
    }
}

/// All strands, where each is found.
fn strands_of(layout: &Layout, lay: impl Fn(usize) -> Option<CableRun>) -> Option<Vec<CableRun>> {
    (0..layout.strands.len()).map(lay).collect()
}

/// The end of a continuation that did not come to its instant.
#[derive(Clone, Debug)]
pub(in crate::model::spans) struct Stopped {
    /// Why.
    pub failure: Failure,
    /// The part of it that was gone.
    pub done: f64,
}

impl From<Stopped> for Failure {
    fn from(stopped: Stopped) -> Self {
        stopped.failure
    }
}

impl StepStats {
    pub fn and(self, more: Self) -> Self {
        Self {
            solved: self.solved.and(more.solved),
            halved: self.halved + more.halved,
            ran: self.ran + more.ran,
            eased: self.eased || more.eased,
            fresh: larger(self.fresh, more.fresh),
        }
    }
}

impl Solved {
    fn and(self, more: Self) -> Self {
        Self {
            iterations: self.iterations + more.iterations,
            residual: if more.residual > self.residual { more.residual } else { self.residual },
        }
    }
}
