//! The continuation finds the initial equilibrium and follows it through time, and halves load
//! steps that fail.

use crate::contact::swept_corners;
use crate::math::{Vec2, larger};
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
use crate::model::spans::newton::slip_predictor::foresee;
use crate::model::spans::newton::{Solved, Work};
use crate::model::spans::run::CableRun;
use crate::model::spans::slack;
use crate::model::spans::verify::clearance;
use crate::model::spans::verify::equilibrium;
use crate::model::spans::verify::tension_loss;
use crate::model::spans::verify::tunnelling;
use crate::solution::Node;

/// Halvings of a step at most: 2⁻¹² of a step of 1 % of the cable is a hair's breadth.
const MAX_HALVINGS: u32 = 12;
/// Part of a step over which a cable that runs away is followed at least.
const RUNAWAY_STEP_FRACTION: f64 = 1e-3;
/// Drag with which it is followed at first, of the load per metre. Less: steps fail where it runs
/// fast. More: more of them.
const DRAG: f64 = 10.0;
/// It has come to rest when it needs no more than this part of that drag.
const LEAST_DRAG: f64 = 1e-3;
/// A force that differs by less than this part is the same.
const FORCE_TOLERANCE: f64 = 1e-9;
/// Steps it is followed for at most, and times in a row the drag is raised.
const MOST_DRAGGED: usize = 200;
const MOST_RAISED: usize = 5;
/// Friction, of the force there, that may be missing in the step in which a load comes down, and
/// the shortest step taken for its sake. More: forces are off by as much while such a step lasts.
/// Less: more steps.
const MISSING_FRICTION_FRACTION: f64 = 3e-4;
const LANDING_STEP_FRACTION: f64 = 1.0 / 64.0;
/// Spans that are tried as pockets in one step. More: dearer failures, each halving tries again.
const MOST_POCKETS: usize = 3;
/// Tension at which a rest is first sought, of the weight of the cable: so taut that it touches
/// only what it is led round. Less: it lies on more than the string of the route. More: nothing
/// gained.
const FIRST_TENSION_WEIGHTS: f64 = 4.0;
/// The same where that finds none: corners that the string of the route bends round and the cable
/// does not give away more than it was shrunk by.
const SECOND_TENSION_WEIGHTS: f64 = 400.0;
/// Part of the load that acts at first. More: a long span sags into what is below it before it can
/// be met step by step. Less: nothing gained.
const FIRST_LOAD_FRACTION: f64 = 1e-3;
/// First step of the way from taut to what it is, and how large (at most twice this) steps become
/// that succeed.
const FIRST_STEP: f64 = 0.05;
const LARGEST_STEP: f64 = 0.2;

/// Parts of the cone of friction that a cable taken over may use: along the very edge of the cone
/// sliding from an end would stop anywhere, and Newton stalls. The first changes nothing that
/// shows, the second holds a little first.
const ADOPTED_CONE_FRACTIONS: [f64; 3] = [1.0 - 1e-5, 1.0 - 1e-3, 0.99];

/// Friction over what there is that is first tried where a cable slides, then twice that, and so on
/// to the last, as parts of what there is. First smaller: more of them are tried. Last larger:
/// dearer where no friction holds it.
const FIRST_PART: f64 = 0.04;
const MOST_PART: f64 = 1e4;
/// Part of the friction that is missing to which it is found: three digits are shown.
const MISSING_FRICTION_TOLERANCE: f64 = 2e-4;
/// Less than this part that is missing is none: rounding. Larger: a cable that slides by so little
/// has no answer and no cause.
const LEAST_PART: f64 = 1e-7;
/// Part of the tensions by which a contact may be off sliding where less friction does not hold.
/// Smaller: what is missing would have to be found to more digits. Larger: a failure to find an
/// answer is taken for sliding.
const MOBILISED: f64 = 2e-2;

/// Why no rest was found, and how far the cable was let out.
pub(in crate::model::spans) type Unfound = (Failure, Option<Box<CableEquilibrium>>);

/// Resolution of a route: the points that stand for a post, and the tension (of the weight) to
/// which the cable is shrunk at first.
#[derive(Clone, Copy, Debug)]
struct Seen {
    ring: Ring,
    cooled: Option<f64>,
    /// True if a cable that spreads on the ground may lie there without tension.
    loose: bool,
}

impl Default for Seen {
    fn default() -> Self {
        Self { ring: RINGS[0], cooled: None, loose: true }
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
        // As it is laid; else where it needs no friction; either may have to begin taut.
        let smooth = BoundaryConditions { friction: 0.0, ..instant.clone() };
        let ways = [
            (instant, None),
            (&smooth, None),
            (&smooth, Some(FIRST_TENSION_WEIGHTS)),
            (instant, Some(FIRST_TENSION_WEIGHTS)),
            (&smooth, Some(SECOND_TENSION_WEIGHTS)),
        ];
        // What is not held at both ends would run to where it needs no friction.
        let held = start == SearchStart::AlsoWithoutFriction
            && layout.strands.iter().all(|s| s.supports.iter().all(Option::is_some));
        let seen = ways.map(|(begin, cooled)| (begin, Seen { cooled, ..Seen::default() }));
        let nearer = Self::seen(layout).into_iter().skip(1).map(|seen| (instant, seen));
        let (mut first, mut stopped) = (None, None);
        for (begin, seen) in seen.into_iter().chain(nearer).filter(|(begin, _)| held || begin.friction > 0.0) {
            let cooled = seen.cooled;
            let mut network = Self { strands: Vec::new(), course: course.clone(), instant: begin.clone() };
            match network.laid(layout, begin, seen, work).and_then(|taken| {
                if begin.friction < instant.friction {
                    network.rub(layout, instant, work).map(|more| StepStats { eased: true, ..taken.and(more) })
                } else {
                    Ok(taken)
                }
            }) {
                Ok(taken) => return Ok((network, taken)),
                Err(trouble) => {
                    if cooled.is_some() && stopped.is_none() {
                        stopped = Some((trouble.clone(), Some(Box::new(network))));
                    }
                    first = first.or(Some((trouble, None)));
                }
            }
        }
        Err(stopped.or(first).unwrap_or((Failure::Restless { s: 0.0 }, None)))
    }

    /// A cable that comes down in a heap and hangs over crests, without tension where it lies.
    pub fn heaped(layout: &Layout, instant: &BoundaryConditions) -> Option<Self> {
        let course = layout.course(layout.curves(), instant);
        let strands = strands_of(layout, |k| slack::lay(layout, k, &course, instant))?;
        Some(Self { strands, course, instant: instant.clone() })
    }

    /// The resolutions in which a cable can be laid as it is: posts seen nearer, too, where it lies
    /// on something and nothing else holds it.
    fn seen(layout: &Layout) -> Vec<Seen> {
        let loose = layout.strands.iter().any(|s| s.supports.iter().all(Option::is_none));
        let rings = if loose { &RINGS[..] } else { &RINGS[..1] };
        let laid = rings.iter().map(|ring| Seen { ring: *ring, ..Seen::default() });
        laid.chain(loose.then_some(Seen { cooled: Some(FIRST_TENSION_WEIGHTS), ..Seen::default() })).collect()
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
        let course = layout.course(layout.curves(), instant);
        let mut rests = |part: f64, seen: Seen| {
            let begin = BoundaryConditions { friction: part, ..instant.clone() };
            let mut network = Self { strands: Vec::new(), course: course.clone(), instant: begin.clone() };
            let taken = network.laid(layout, &begin, seen, work).ok()?;
            (taken.ran == 0).then_some(network)
        };
        let (mut low, mut step) = (1.0, FIRST_PART);
        let (mut high, seen) = loop {
            if step > MOST_PART {
                return None;
            }
            let high = 1.0 + step;
            if let Some(seen) = Self::seen(layout).into_iter().find(|seen| rests(high, *seen).is_some()) {
                break (high, seen);
            }
            (low, step) = (high, 2.0 * step);
        };
        while high - low > MISSING_FRICTION_TOLERANCE * (high - 1.0) {
            let middle = 0.5 * (low + high);
            if rests(middle, seen).is_some() {
                high = middle;
            } else {
                low = middle;
            }
            if high - 1.0 < LEAST_PART {
                return None;
            }
        }
        let found = rests(high, seen)?;
        let near = MOBILISED * (1.0 + MISSING_FRICTION_TOLERANCE * (high - 1.0));
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
        for within in ADOPTED_CONE_FRACTIONS {
            let course = layout.course(layout.curves(), instant);
            let Some(strands) = from_solution::take(layout, &course, instant, nodes, within) else { continue };
            let mut network = Self { strands, course, instant: instant.clone() };
            match network.step(layout, instant, work) {
                Ok(_) => return Ok(network),
                Err(trouble) => first = first.or(Some(trouble)),
            }
        }
        let at = nodes.first().map_or(Vec2::zeros(), Node::at);
        Err(first.unwrap_or(Failure::NoSeat { s: 0.0, at }))
    }

    /// Lays it along the route as it is, or shrunk until it is taut and then let out again.
    fn laid(
        &mut self,
        layout: &Layout,
        goal: &BoundaryConditions,
        seen: Seen,
        work: &mut Work,
    ) -> Result<StepStats, Failure> {
        let taut = seen.cooled;
        let mut begin = goal.clone();
        layout.give(&mut self.course, &begin);
        self.strands.clear();
        let mut came = Vec::new();
        for k in 0..layout.strands.len() {
            let may = taut.is_none() && seen.loose;
            let loose = if may { slack::lay(layout, k, &self.course, &begin) } else { None };
            if let Some(strand) = loose.filter(|s| s.loose.as_ref().is_some_and(Loose::spreads)) {
                self.strands.push(strand);
                came.push(Vec::new());
                continue;
            }
            let laid = contacts::lay(layout, k, &self.course, &begin, seen.ring);
            let no_way = Failure::NoSeat { s: layout.strands[k].material[0], at: goal.places[0] };
            let (strand, way) = laid.ok_or(no_way)?;
            self.strands.push(strand);
            came.push(way);
        }
        if let Some(taut) = taut {
            begin.thermal = self.shrunk_thermal(layout, goal, taut);
            begin.load *= FIRST_LOAD_FRACTION;
            begin.forces.iter_mut().for_each(|f| *f *= FIRST_LOAD_FRACTION);
            layout.give(&mut self.course, &begin);
            for (strand, part) in self.strands.iter_mut().zip(&layout.strands) {
                if part.supports.iter().all(Option::is_some) {
                    tension::tighten(strand, &self.course);
                }
            }
        }
        self.instant = begin.clone();
        let mut taken = self.step_from(layout, &begin, &came, work)?;
        // What was met on the way rubs from now on.
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
        taken = taken.and(self.travel(layout, &heavy, FIRST_STEP, work)?);
        Ok(taken.and(self.travel(layout, goal, FIRST_STEP, work)?))
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
                Err(trouble) => {
                    self.undo(layout, work);
                    return Err(trouble);
                }
            }
        }
        if let Err(trouble) = equilibrium::balanced(layout, self) {
            self.undo(layout, work);
            return Err(trouble);
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
            foresee(strand, &self.course, &mut work.foresight);
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
            // What has hardly any tension left may have lost it: the least, the two least …
            let mut loose = Vec::new();
            slack_pocket::candidates(start, &self.course, &mut loose);
            for n in 1..=loose.len().min(MOST_POCKETS) {
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
            // What came down in this step rubs from now on.
            if c.smooth && came.is_none() {
                c.smooth = false;
                c.mode = if self.course.curves[c.curve].friction > 0.0 { Mode::Hold } else { c.mode };
            }
        }
        equilibrium::sound(&self.strands[k], &self.course)?;
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
        let found = slack::lay(layout, k, &self.course, &self.instant);
        let strand = &mut self.strands[k];
        let Some(found) = found.filter(|f| f.ties == strand.ties) else {
            return Err(Failure::Drawn { s: strand.from });
        };
        *strand = found;
        Ok(StepStats::default())
    }

    /// Material that lies loose and the length of ground it lies on, m; None where none does.
    pub fn loose(&self) -> Option<[f64; 2]> {
        let lies = self.strands.iter().filter_map(|s| s.loose.as_ref()).map(|l| l.lies(&self.course));
        lies.reduce(|[a, b], [c, d]| [a + c, b + d])
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
        let (before, old) = (self.strands.clone(), self.instant.clone());
        let size = to.load.norm();
        let (mut drag, mut taken, mut raised) = (DRAG * size, StepStats::default(), 0);
        let mut pushed = None;
        for _ in 0..MOST_DRAGGED {
            self.course.drag = drag;
            let result = self.step(layout, to, work);
            self.course.drag = 0.0;
            match result {
                Ok(t) => {
                    pushed = None;
                    taken = taken.and(t);
                    drag *= if raised > 0 { 0.5 } else { 0.25 };
                    raised = 0;
                    if drag < DRAG * LEAST_DRAG * size
                        && let Ok(t) = self.step(layout, to, work)
                    {
                        return Ok(taken.and(t));
                    }
                }
                Err(trouble) => {
                    pushed = matches!(trouble, Failure::Compressed { .. }).then_some(trouble);
                    drag *= 8.0;
                    raised += 1;
                }
            }
            if raised > MOST_RAISED {
                break;
            }
        }
        self.strands = before;
        layout.give(&mut self.course, &old);
        self.instant = old;
        Err(pushed.unwrap_or(Failure::Restless { s: 0.0 }))
    }

    /// True if every strand is a stable rest and not a balance that runs away.
    pub fn stable(&self, work: &mut Work) -> bool {
        self.strands.iter().all(|s| newton::stable(s, &self.course, work))
    }

    /// Why a step was not taken: it would have to push however much it is held back, or nothing
    /// better than the trouble of the step.
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
        let lies = |k: usize| self.strands[k].loose.as_ref().is_some_and(Loose::spreads);
        let follows = (0..self.strands.len()).all(|k| self.strands[k].loose.is_none() || (lies(k) && !held(k)));
        if self.loose().is_none() || !follows || self.instant.places == to.places {
            return;
        }
        let instant = self.instant.clone();
        let mut taut = self.clone();
        if taut.laid(layout, &instant, Seen { loose: false, ..Seen::default() }, work).is_ok() {
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
        let (mut done, mut step, mut taken) = (0.0, first, StepStats::default());
        let mut halvings: u32 = 0;
        // Not on the way to a first rest; and the step that was taken but had something come down
        // in it.
        let (mut moves, mut whole) = (first >= 1.0, None);
        while done < 1.0 {
            let next = if done + 1.000_001 * step >= 1.0 { 1.0 } else { done + step };
            at.between(from, to, next);
            let trouble = match self.step(layout, at, work) {
                // What comes down has no friction in the step in which it does: that shall be a
                // short one.
                Ok(t) if moves && t.fresh > MISSING_FRICTION_FRACTION && step > LANDING_STEP_FRACTION => {
                    self.undo(layout, work);
                    whole = whole.or(Some(step));
                    (step, taken.halved) = (0.5 * step, taken.halved + 1);
                    continue;
                }
                Ok(t) => {
                    (moves, whole) = (first >= 1.0, None);
                    taken = taken.and(t);
                    done = next;
                    if halvings > 0 || step < LARGEST_STEP {
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
                Err(trouble) => trouble,
            };
            halvings += 1;
            step *= 0.5;
            taken.halved += 1;
            if halvings > MAX_HALVINGS {
                // Where nothing near by holds the cable it runs away, to the next place that does.
                let next = if done + RUNAWAY_STEP_FRACTION < 1.0 { done + RUNAWAY_STEP_FRACTION } else { 1.0 };
                at.between(from, to, next);
                let t = match self.follow(layout, at, work) {
                    Ok(t) => t,
                    Err(other) => return Err(Stopped { failure: self.reason(trouble, other), done }),
                };
                (taken, done, halvings, step) = (taken.and(t), next, 0, RUNAWAY_STEP_FRACTION);
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
    fn and(self, more: Self) -> Self {
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
