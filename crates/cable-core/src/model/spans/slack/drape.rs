//! A drained way is divided at the points where the tension vanishes: at feet, and in kinks that a
//! cable under tension would bridge.

use crate::math::{Vec2, cross};
use crate::model::spans::boundary::capstan::Step;
use crate::model::spans::boundary::curve::Place;
use crate::model::spans::boundary::loose::{Line, Part, Stretch};
use crate::model::spans::cable_section::Course;
use crate::model::spans::initial::drained_route::{Frame, Leg, Roofs};

/// Turn (rad) up to which two stretches are one, and by which what hangs beside a roof may be off
/// its end.
pub(super) const STRAIGHT_TURN: f64 = 1e-6;
/// Halvings of a stretch in the search for where its tension ends.
pub(super) const HALVINGS: usize = 60;

/// The shapes of loose cable that a search accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum LooseShapes {
    /// Any.
    AnyTension,
    /// Only those in which no cable that lies has tension ([`Loose::spreads`]). Then a crest that
    /// draws ends the search, before the spans that it would hold are looked for.
    NoTension,
}

impl Stretch {
    pub(super) fn place(&self, course: &Course, p: f64) -> Place {
        let curve = &course.curves[self.curve];
        curve.place_on(self.piece, p - curve.origin(self.piece))
    }

    /// The tension at another place of it that follows from the tension `t` at one.
    pub(super) fn slide(&self, course: &Course, from: f64, to: f64, t: f64, m: f64) -> Step {
        course.law.along(&course.law.spot(&self.place(course, from)), to - from, t, m)
    }

    pub(super) fn friction(&self, course: &Course) -> f64 {
        course.curves[self.curve].friction
    }
}

/// Material that hangs plumb over a height, m.
pub(super) fn plumb(course: &Course, height: f64) -> f64 {
    let law = &course.law;
    let free = height / law.thermal;
    2.0 * free / (1.0 + (1.0 + 2.0 * law.load.norm() * free / law.stiffness).sqrt())
}

/// A drained way under the laws of tension.
pub(super) struct Drape<'a> {
    pub course: &'a Course,
    pub frame: Frame,
    /// Tension that is rounding, N.
    pub most: f64,
    pub sought: LooseShapes,
}

impl Drape<'_> {
    /// The lines of the legs of a drained way.
    pub fn lines(&self, roofs: &Roofs, legs: &[Leg]) -> Vec<Line> {
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
    pub fn parts(&self, lines: &[Line], held: [bool; 2]) -> Option<Vec<Part>> {
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
    pub fn rise(&self, [from, to]: [Vec2; 2]) -> f64 {
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
}
