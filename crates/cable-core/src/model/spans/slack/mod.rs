//! A run of cable rests on obstacles without tension.
//!
//! If there is more cable than its drained route needs (see `drained_route`), only the parts that
//! hang have tension. They hang plumb: F is the weight below. The tension vanishes at each foot and
//! in each kink, where a cable under tension would not turn. Between two such points the cable
//! passes over one crest; on both sides its tension falls as in a cable that slides down there,
//!
//! ```text
//! dT/ds = −b·t ∓ μN,   T ≥ 0
//! ```
//!
//! and the greater of the two is what friction has to hold: less than all of it, if the one falls
//! below the other before its end. Where both are nothing the cable lies loose, and what is over
//! lies there in folds. A plane cannot show where, nor in how many layers: they are spread evenly
//! over that ground, which carries their weight where it carries the rest. Of a plumb end h long,
//! stretched,
//!
//! ```text
//! h = λ (s + b s²/2EA)
//! ```
//!
//! Any other rest of the same cable is one that pulls or leans somewhere, and then only by what
//! friction remembers. Where a crest is held by less friction than it takes, the cable runs over
//! it: that is no such rest.

mod bridge;
mod heap;
mod joint;
mod report;

use crate::math::{Vec2, cross, larger};
use crate::model::spans::boundary::capstan::Step;
use crate::model::spans::boundary::curve::Place;
use crate::model::spans::boundary::loose::{Line, Loose, Part, Stretch};
use crate::model::spans::boundary_conditions::{BoundaryConditions, Layout};
use crate::model::spans::initial::drained_route::{Drained, Frame, Leg, NONE_M, Roofs};
use crate::model::spans::initial::route::way;
use crate::model::spans::run::{CableRun, Course, Tie};
use crate::model::spans::slack::heap::{CREST_CONE_ROUNDING, heap};
use crate::numerics::bisect;

/// Part of the cable that there must be too much of: what is as long as its way lies along it, and
/// remembers what friction does.
const EXCESS_CABLE_FRACTION: f64 = 1e-9;
/// Turn (rad) up to which two stretches are one, and by which what hangs beside a roof may be off
/// its end.
const STRAIGHT_TURN: f64 = 1e-6;
/// Halvings of a stretch in the search for where its tension ends.
const HALVINGS: usize = 60;

impl Stretch {
    fn place(&self, course: &Course, p: f64) -> Place {
        let curve = &course.curves[self.curve];
        curve.place_on(self.piece, p - curve.origin(self.piece))
    }

    /// The tension at another place of it that follows from the tension `t` at one.
    fn slide(&self, course: &Course, from: f64, to: f64, t: f64, m: f64) -> Step {
        course.law.along(&course.law.spot(&self.place(course, from)), to - from, t, m)
    }

    fn friction(&self, course: &Course) -> f64 {
        course.curves[self.curve].friction
    }
}

impl Part {
    /// True if it lies without tension, so that there may be more of it.
    fn is_loose(&self) -> bool {
        matches!(self.form, Line::Lies(_)) && self.tension == [0.0; 2]
    }
}

/// The shapes of loose cable that a search accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum LooseShapes {
    /// Any.
    AnyTension,
    /// Only those in which no cable that lies has tension ([`Loose::spreads`]). Then a crest that
    /// draws ends the search, before the spans that it would hold are looked for.
    NoTension,
}

/// The strand where it lies loose at an instant; None where it cannot.
pub(in crate::model::spans) fn loose_strand(
    layout: &Layout,
    index: usize,
    course: &Course,
    instant: &BoundaryConditions,
    sought: LooseShapes,
) -> Option<CableRun> {
    let part = layout.strands.get(index)?;
    let (load, [from, to]) = (course.law.load, part.material);
    let loaded = course.loads.iter().any(|l| l.arc_length > from && l.arc_length < to && l.force.norm() > 0.0);
    let frame = Frame::of(load).filter(|_| !loaded && part.pulleys.is_empty())?;
    let bodies = layout.problem.world.geometry().bodies();
    let roofs = Roofs::new(course, bodies.len(), frame);
    let held = part.supports.map(|s| s.and_then(|k| instant.places.get(k).copied()));
    let ends = held.map(|h| h.is_some());
    let drawn = [0, 1].map(|side| match part.supports[side] {
        None => layout.end_force(instant, part.material[side]),
        Some(_) => Vec2::zeros(),
    });
    let drawn = drawn[0] + drawn[1];
    let drape = Drape { course, frame, most: CREST_CONE_ROUNDING * load.norm() * (to - from), sought };
    let strand = |drained: Drained| {
        let lines = drape.lines(&roofs, &drained.legs);
        let parts = drape.parts(&lines, ends)?;
        let parts = pay_out(parts, course, frame, part.material, drawn, ends)?;
        let ties = [0, 1].map(|k| held[k].map_or(Tie::Loose(drawn), Tie::Held));
        let loose = Some(Loose { parts, drawn });
        Some(CableRun { from, to, ties, contacts: Vec::new(), forces: vec![Vec2::zeros()], loose })
    };
    let along_route = || Drained::new(&roofs, bodies, frame, &way(layout, part, instant).points);
    match held {
        [Some(_), Some(_)] => strand(along_route()?),
        [Some(at), None] | [None, Some(at)] => {
            // As the route lays it out on the ground; else it comes down in a heap below the
            // support.
            let laid_out = layout.problem.route.len() > 1 && drawn.norm() == 0.0;
            let laid = if laid_out { along_route().and_then(&strand) } else { None };
            laid.filter(|s| {
                s.loose.as_ref().is_some_and(|l| l.spreads() && l.hangs() <= layout.problem.cable.diameter_m)
            })
            .or_else(|| strand(Drained::plumb(&roofs, bodies, frame, at, held[0].is_none())?))
        }
        [None, None] => None,
    }
}

/// Gives each part its material, what is over to those without tension, or to a heap; None where
/// nothing is over or nothing holds it. A free end lies where the cable ends if that is before the
/// route does.
fn pay_out(
    mut parts: Vec<Part>,
    course: &Course,
    frame: Frame,
    [from, to]: [f64; 2],
    drawn: Vec2,
    held: [bool; 2],
) -> Option<Vec<Part>> {
    let own = |p: &Part| p.arc_lengths[1] - p.arc_lengths[0];
    let mut over = to - from - parts.iter().map(own).sum::<f64>();
    if !(over > EXCESS_CABLE_FRACTION * (to - from)) {
        cut(&mut parts, held.iter().position(|h| !h)?, -over)?;
        over = 0.0;
    }
    let free: f64 = parts.iter().filter(|p| p.is_loose()).map(own).sum();
    if over > 0.0 && (free <= NONE_M || drawn.norm() > 0.0) {
        let (at, found) = heap(&parts, course, frame, course.law.load * over + drawn)?;
        parts.insert(at, Part { arc_lengths: [0.0, over], tension: [0.0; 2], form: Line::Heap(found) });
    }
    let heaped = over == 0.0 || parts.iter().any(|p| matches!(p.form, Line::Heap(_)));
    let spread = if heaped { 0.0 } else { over / free };
    let mut s = from;
    for part in &mut parts {
        let more = if part.is_loose() { own(part) * spread } else { 0.0 };
        part.arc_lengths = [s, s + own(part) + more];
        s = part.arc_lengths[1];
    }
    Some(parts)
}

/// Takes so much material (m) off a free end (0: the start) that lies without tension; None where
/// it does not.
fn cut(parts: &mut Vec<Part>, end: usize, mut off: f64) -> Option<()> {
    loop {
        let at = if end == 0 { 0 } else { parts.len().checked_sub(1)? };
        let part = parts.get_mut(at)?;
        let Line::Lies(stretch) = &mut part.form else { return None };
        if part.tension != [0.0; 2] {
            return None;
        }
        let own = part.arc_lengths[1] - part.arc_lengths[0];
        if own > off {
            let left = 1.0 - off / own;
            let [kept, cut] = [stretch.coordinates[1 - end], stretch.coordinates[end]];
            stretch.coordinates[end] = kept + (cut - kept) * left;
            part.arc_lengths = [0.0, own * left];
            return Some(());
        }
        off -= own;
        parts.remove(at);
    }
}

/// Material that hangs plumb over a height, m.
fn plumb(course: &Course, height: f64) -> f64 {
    let law = &course.law;
    let free = height / law.thermal;
    2.0 * free / (1.0 + (1.0 + 2.0 * law.load.norm() * free / law.stiffness).sqrt())
}

/// A drained way under the laws of tension.
struct Drape<'a> {
    course: &'a Course,
    frame: Frame,
    /// Tension that is rounding, N.
    most: f64,
    sought: LooseShapes,
}

impl Drape<'_> {
    fn lines(&self, roofs: &Roofs, legs: &[Leg]) -> Vec<Line> {
        let line = |leg: &Leg| match *leg {
            Leg::Hangs { u, v } => Line::Hangs(v.map(|v| self.frame.point(u, v))),
            Leg::Lies { roof, u } => {
                let (curve, piece, p) = roofs.all[roof].stretch(&self.course.curves, u);
                Line::Lies(Stretch { curve, piece, coordinates: p, mobilised: 0.0 })
            }
        };
        legs.iter().map(line).collect()
    }

    /// Every part with its tension, and the material that takes; None where a crest does not hold.
    /// What is drawn tight in a kink goes on through it.
    fn parts(&self, lines: &[Line], held: [bool; 2]) -> Option<Vec<Part>> {
        let mut stops = vec![0];
        for k in 1..lines.len() {
            if self.rests(&lines[k - 1], &lines[k])? {
                stops.push(k);
            }
        }
        stops.push(lines.len());
        loop {
            let tight = match self.chains(lines, &stops, held) {
                Ok(parts) => return Some(parts),
                Err(stop) => stop?,
            };
            // A support's own plumb line is not drawn at by merging.
            let inner = |k: usize| (k > 0 || !held[0]) && (k + 1 < lines.len() || !held[1]);
            match lines.get(tight.checked_sub(1)?..=tight)? {
                [Line::Lies(a), Line::Lies(b)] if self.bends_in(a, b) => {}
                [Line::Lies(_), Line::Hangs(h)] if self.rise(*h) > 0.0 && inner(tight) => {}
                [Line::Hangs(h), Line::Lies(_)] if self.rise(*h) < 0.0 && inner(tight - 1) => {}
                _ => return None,
            }
            stops.retain(|k| *k != tight);
        }
    }

    /// The parts between such stops; else the stop, if that is it, at which a tension is not
    /// nothing.
    fn chains(&self, lines: &[Line], stops: &[usize], held: [bool; 2]) -> Result<Vec<Part>, Option<usize>> {
        let (mut out, mut bridged) = (Vec::new(), false);
        let support = |line: &Line, end: usize| match line {
            Line::Hangs(ends) => Some(ends[end]),
            _ => None,
        };
        for pair in stops.windows(2) {
            let (begin, end) = (pair[0], pair[1]);
            let near = [
                if held[0] && begin == 1 { support(&lines[0], 0) } else { None },
                if held[1] && end + 1 == lines.len() { support(&lines[end], 1) } else { None },
            ];
            if end < lines.len() || !bridged {
                let ends = [begin == 0 && held[0], end == lines.len() && held[1]];
                let tight = |side: Option<usize>| side.map(|side| pair[side]);
                bridged = self.chain(&lines[begin..end], ends, near, &mut out).map_err(tight)?;
            }
        }
        Ok(out)
    }

    /// Height by which a plumb line rises, m.
    fn rise(&self, [from, to]: [Vec2; 2]) -> f64 {
        (to - from).dot(&self.frame.up)
    }

    /// True if it has no tension between two lines: at a foot, and in a kink that a cable under
    /// tension would bridge. None where it turns with nothing to turn it.
    fn rests(&self, a: &Line, b: &Line) -> Option<bool> {
        let plumb = |s: &Stretch, p: f64| cross(s.place(self.course, p).tangent, self.frame.up).abs() <= STRAIGHT_TURN;
        match (a, b) {
            (Line::Hangs(h), Line::Lies(s)) => match self.rise(*h) < 0.0 {
                true => Some(true),
                false => plumb(s, s.coordinates[0]).then_some(false),
            },
            (Line::Lies(s), Line::Hangs(h)) => match self.rise(*h) > 0.0 {
                true => Some(true),
                false => plumb(s, s.coordinates[1]).then_some(false),
            },
            (Line::Lies(s), Line::Lies(next)) => {
                let [before, after] =
                    [s.place(self.course, s.coordinates[1]), next.place(self.course, next.coordinates[0])];
                let sense = self.course.curves[s.curve].sense;
                let turns = self.course.curves[next.curve].sense != sense;
                Some(turns || cross(before.tangent, after.tangent) * sense > STRAIGHT_TURN)
            }
            _ => Some(true),
        }
    }

    /// The stretches between two points without tension, or from or to a support. Where a support
    /// hangs nearby and the crest draws the cable tight there, a span bridges to it; whether that
    /// was done at the end. Else on which side it is drawn tight, if that is it.
    fn chain(
        &self,
        lines: &[Line],
        held: [bool; 2],
        near: [Option<Vec2>; 2],
        out: &mut Vec<Part>,
    ) -> Result<bool, Option<usize>> {
        let weight = self.course.law.load.norm();
        let hangs = |line: Option<&Line>| match line {
            Some(Line::Hangs(ends)) => Some((*ends, plumb(self.course, self.rise(*ends).abs()))),
            _ => None,
        };
        let hung = |(ends, s): ([Vec2; 2], f64)| {
            let t = weight * s;
            let tension = if self.rise(ends) > 0.0 { [0.0, t] } else { [t, 0.0] };
            Part { arc_lengths: [0.0, s], tension, form: Line::Hangs(ends) }
        };
        let (first, last) = (hangs(lines.first()), hangs(lines.last()));
        if let ([_], Some(alone)) = (lines, first) {
            // From a support down, or up to one.
            let begins = held[0] && self.rise(alone.0) < 0.0;
            let ends = held[1] && self.rise(alone.0) > 0.0;
            out.push(hung(alone));
            return if begins || ends { Ok(false) } else { Err(None) };
        }
        if (held[0] && first.is_some()) || (held[1] && last.is_some()) {
            return Err(None);
        }
        let ends = [first, last].map(|h| h.map_or(0.0, |(_, s)| weight * s));
        let (mut stretches, mut walls): (Vec<Stretch>, Vec<Option<f64>>) = (Vec::new(), Vec::new());
        for (k, line) in lines.iter().enumerate() {
            match line {
                Line::Lies(s) => (stretches.push(*s), walls.push(None)).0,
                Line::Hangs(ends) if k > 0 => {
                    let rise = self.rise(*ends);
                    if let Some(wall) = walls.last_mut() {
                        *wall = Some(plumb(self.course, rise.abs()).copysign(rise));
                    }
                }
                _ => {}
            }
        }
        let forth = self.profile(&stretches, &walls, 0, ends[0]).ok_or(None)?;
        let back = self.profile(&stretches, &walls, 1, ends[1]).ok_or(None)?;
        let begins_tight = !held[0] && back.leaves > ends[0] + self.most;
        let ends_tight = !held[1] && forth.leaves > ends[1] + self.most;
        let bridge = match (begins_tight, ends_tight) {
            (true, false) => Some(near[0].and_then(|at| self.bridge(&back, at, 0)).ok_or(Some(0))?),
            (false, true) => Some(near[1].and_then(|at| self.bridge(&forth, at, 1)).ok_or(Some(1))?),
            (false, false) => None,
            (true, true) => return Err(None),
        };
        let range = match &bridge {
            Some(found) if begins_tight => found.line..stretches.len(),
            Some(found) => 0..found.line + 1,
            None => 0..stretches.len(),
        };
        if let Some(found) = bridge.as_ref().filter(|_| begins_tight) {
            // In the place of what hung.
            out.pop();
            out.push(found.part.clone());
        }
        out.extend(first.map(hung));
        // Over a kink goes the span of the greater tension; up to a bridge only the one holds.
        let span = |k: usize| {
            let [f, b] = [&forth, &back].map(|side| side.spans[k].as_ref().map_or(0.0, |(span, _)| span.tension[0]));
            let by_start = if begins_tight || ends_tight { ends_tight } else { f >= b };
            let side = if by_start { &forth } else { &back };
            side.spans[k].as_ref().map(|(part, next)| {
                (part, *next, side.stretches[k].coordinates[1], side.stretches[*next].coordinates[0], by_start)
            })
        };
        let (mut k, mut entry) = (range.start, None);
        while k < range.end {
            let mut s = stretches[k];
            let [mut f, mut b] = [forth.enters[k], back.enters[k]];
            if let Some((p, by_start)) = entry {
                s.coordinates[0] = p;
                f = if by_start { f } else { 0.0 };
            }
            let beyond = if k + 1 < range.end { span(k) } else { None };
            if let Some((_, _, p, _, by_start)) = beyond {
                s.coordinates[1] = p;
                b = if by_start { 0.0 } else { b };
            }
            if let Some(found) = bridge.as_ref().filter(|found| found.line == k) {
                s.coordinates[usize::from(ends_tight)] = found.coordinate;
            }
            if begins_tight {
                f = 0.0;
            } else if ends_tight {
                b = 0.0;
            }
            self.stretch(&s, [f, b], out);
            match beyond {
                Some((part, next, _, p, by_start)) => {
                    out.push(part.clone());
                    (k, entry) = (next, Some((p, by_start)));
                }
                None if k + 1 < range.end && walls[k].is_some() => return Err(None),
                None => (k, entry) = (k + 1, None),
            }
        }
        out.extend(last.map(hung));
        if let Some(found) = bridge.filter(|_| ends_tight) {
            out.push(found.part);
            return Ok(true);
        }
        Ok(false)
    }

    /// A stretch in its parts: where the tension from its start holds, where there is none, where
    /// that from its end does.
    fn stretch(&self, s: &Stretch, [forth, back]: [f64; 2], out: &mut Vec<Part>) {
        let (course, friction, [p0, p1]) = (self.course, s.friction(self.course), s.coordinates);
        let forth_at = |p: f64| if p == p0 { forth } else { s.slide(course, p0, p, forth, -friction).tension };
        let back_at = |p: f64| if p == p1 { back } else { s.slide(course, p1, p, back, friction).tension };
        // Each ends at once or rises and falls again; from where it has fallen to nothing there is
        // none.
        let seek = |has: f64, not: f64, holds: &dyn Fn(f64) -> bool| {
            if holds(not) { not } else { bisect([has, not], HALVINGS, holds)[0] }
        };
        let little = 1e-3 * (p1 - p0);
        let goes = |t: f64, from: f64, to: f64, holds: &dyn Fn(f64) -> bool| match (t > 0.0, holds(from)) {
            (true, _) => seek(if from < to { p0 } else { p1 }, to, holds),
            (false, true) => seek(from, to, holds),
            (false, false) => {
                if from < to {
                    p0
                } else {
                    p1
                }
            }
        };
        let mut ends = goes(forth, p0 + little, p1, &|p| forth_at(p) > 0.0);
        let mut begins = goes(back, p1 - little, p0, &|p| back_at(p) > 0.0);
        if begins < ends {
            // Both: the greater.
            let meet = if forth_at(ends) >= back_at(ends) {
                ends
            } else if forth_at(begins) <= back_at(begins) {
                begins
            } else {
                seek(begins, ends, &|p| forth_at(p) >= back_at(p))
            };
            (ends, begins) = (meet, meet);
        }
        let mut push = |p: [f64; 2], m: f64, way: Step, tension: [f64; 2]| {
            let form = Line::Lies(Stretch { coordinates: p, mobilised: m, ..*s });
            out.push(Part { arc_lengths: [0.0, way.material.abs()], tension, form });
        };
        if ends > p0 {
            let way = s.slide(course, p0, ends, forth, -friction);
            push([p0, ends], -friction, way, [forth, larger(way.tension, 0.0)]);
        }
        if begins > ends || p0 == p1 {
            push([ends, begins], 0.0, Step { material: self.rest_of(s, begins - ends), ..Step::none(0.0) }, [0.0; 2]);
        }
        if p1 > begins {
            let way = s.slide(course, p1, begins, back, friction);
            push([begins, p1], friction, way, [larger(way.tension, 0.0), back]);
        }
    }

    /// Material without tension on a stretch of p, m.
    fn rest_of(&self, s: &Stretch, p: f64) -> f64 {
        p * s.place(self.course, s.coordinates[0]).stretch / self.course.law.stretch(0.0)
    }
}

impl Loose {
    /// Force in the cable at a support, N.
    pub fn end_force(&self, course: &Course, side: usize) -> Vec2 {
        let part = if side == 0 { self.parts.first() } else { self.parts.last() };
        part.map_or_else(Vec2::zeros, |part| part.force(course, side))
    }

    /// Force with which obstacles carry it, N.
    pub fn held(&self, course: &Course) -> Vec2 {
        let ends = [0, 1].map(|side| self.end_force(course, side));
        let s = self.parts.first().zip(self.parts.last()).map_or(0.0, |(a, b)| b.arc_lengths[1] - a.arc_lengths[0]);
        ends[0] - ends[1] - course.law.load * s - self.drawn
    }

    /// The most that friction can hold of what lies, N.
    pub fn friction(&self, course: &Course) -> f64 {
        let press = |p: &Part| p.held(course).norm() * p.form.friction(course);
        self.parts.iter().map(press).sum()
    }

    /// True if nothing that lies has tension. Where it is drawn over crests, and where all that is
    /// over is a heap in a kink, a strand under hardly any tension is much the same, and can be
    /// followed as it moves.
    pub fn spreads(&self) -> bool {
        let is_slack = |p: &Part| matches!(p.form, Line::Hangs(_)) || p.is_loose();
        self.parts.iter().all(is_slack)
            && self.parts.iter().any(|p| p.is_loose() && p.arc_lengths[1] - p.arc_lengths[0] > NONE_M)
    }

    /// Material that hangs, m.
    fn hangs(&self) -> f64 {
        self.parts
            .iter()
            .filter(|p| matches!(p.form, Line::Hangs(_)))
            .map(|p| p.arc_lengths[1] - p.arc_lengths[0])
            .sum()
    }

    /// Material that lies, and the length of ground it lies on, m.
    pub fn lying_lengths(&self, course: &Course) -> [f64; 2] {
        let lying = self.parts.iter().filter(|p| p.is_loose() || matches!(p.form, Line::Heap(_)));
        lying.fold([0.0; 2], |[material, ground], p| {
            let way = if let Line::Lies(s) = &p.form {
                (s.coordinates[1] - s.coordinates[0]) * s.place(course, s.coordinates[0]).stretch
            } else {
                0.0
            };
            [material + p.arc_lengths[1] - p.arc_lengths[0], ground + way]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::spans::boundary_conditions::CableEnd;
    use crate::problem::problems;
    use crate::scene::catalog;
    use std::sync::Arc;

    #[test]
    fn a_shape_without_tension_is_the_same_whichever_shapes_are_sought() {
        let (mut compared, mut found) = (0, 0);
        for (id, mut scene) in catalog::all() {
            scene.cables.iter_mut().for_each(|c| c.bending_stiffness_n_m2 = 0.0);
            // Lengths from taut to loose.
            for longer in [0.9, 1.0, 1.1, 1.3, 2.0] {
                let mut scene = scene.clone();
                scene.cables.iter_mut().for_each(|c| c.length_m *= longer);
                for problem in problems(&scene).unwrap_or_default() {
                    let Ok(layout) = Layout::new(&problem, CableEnd::Start, Arc::default()) else { continue };
                    let mut instant = BoundaryConditions::default();
                    layout.instant(&vec![None; problem.supports.len()], 0.0, &mut instant);
                    let course = layout.course(layout.curves(), &instant);
                    for k in 0..layout.strands.len() {
                        let laid = |sought| {
                            loose_strand(&layout, k, &course, &instant, sought)
                                .filter(|s| s.loose.as_ref().is_some_and(Loose::spreads))
                        };
                        let [any, none] = [LooseShapes::AnyTension, LooseShapes::NoTension].map(laid);
                        assert_eq!(format!("{any:?}"), format!("{none:?}"), "{id}, {longer} times as long");
                        compared += 1;
                        found += usize::from(any.is_some());
                    }
                }
            }
        }
        println!("{found} of {compared} lie without tension");
        assert!(found >= 5 && compared > 2 * found, "{found} of {compared}");
    }
}
