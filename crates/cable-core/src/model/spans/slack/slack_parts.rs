//! This module divides a drained route at the points where the tension vanishes: at feet, and in
//! kinks that a cable under tension would bridge.

use crate::math::{Vec2, cross};
use crate::model::spans::boundary::{BoundaryPoint, LyingStretch, SlackForm, SlackPart, SlideResult, slide_on_piece};
use crate::model::spans::section::SolveContext;
use crate::model::spans::slack::drained_route::RouteLeg;
use crate::model::spans::slack::upper_surfaces::{LoadFrame, UpperSurfaces};

/// Turn (rad) up to which two stretches are one, and by which a plumb leg beside a surface may be
/// off its end.
pub(super) const STRAIGHT_TURN: f64 = 1e-6;
/// Number of bisections in the search for the place where the tension of a stretch vanishes.
pub(super) const HALVINGS: usize = 60;

/// The shapes of loose cable that a search accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::model::spans) enum LooseShapes {
    /// Any shape.
    AnyTension,
    /// Only shapes in which no lying cable has tension (`LooseSection::spreads`). Then a crest with
    /// tension ends the search before its spans are computed.
    NoTension,
}

impl LyingStretch {
    pub(super) fn place(&self, context: &SolveContext, p: f64) -> BoundaryPoint {
        let curve = &context.curves[self.curve];
        curve.place_on(self.piece, p - curve.origin(self.piece))
    }

    /// The tension at the place `to` that follows from the tension `t` at the place `from`.
    pub(super) fn slide(&self, context: &SolveContext, from: f64, to: f64, t: f64, m: f64) -> SlideResult {
        slide_on_piece(&context.law, &context.law.local_load(&self.place(context, from)), to - from, t, m)
    }

    pub(super) fn friction(&self, context: &SolveContext) -> f64 {
        context.curves[self.curve].friction
    }
}

/// Material of a plumb leg of a height, m.
pub(super) fn plumb(context: &SolveContext, height: f64) -> f64 {
    let law = &context.law;
    let free = height / law.thermal;
    2.0 * free / (1.0 + (1.0 + 2.0 * law.load.norm() * free / law.stiffness).sqrt())
}

/// Computes the tensions of a drained route.
pub(super) struct SlackSolver<'a> {
    pub context: &'a SolveContext,
    pub frame: LoadFrame,
    /// Tension that counts as round-off, N.
    pub most: f64,
    pub sought: LooseShapes,
}

impl SlackSolver<'_> {
    /// The forms of the legs of a drained route.
    pub fn lines(&self, surfaces: &UpperSurfaces, legs: &[RouteLeg]) -> Vec<SlackForm> {
        let line = |leg: &RouteLeg| match *leg {
            RouteLeg::Hangs { u, v } => SlackForm::Hangs(v.map(|v| self.frame.point(u, v))),
            RouteLeg::Lies { surface, u } => {
                let (curve, piece, p) = surfaces.all[surface].stretch(&self.context.curves, u);
                SlackForm::Lies(LyingStretch { curve, piece, coordinates: p, mobilised: 0.0 })
            }
        };
        legs.iter().map(line).collect()
    }

    /// All parts with their tensions and their material; None if a crest does not hold. A cable
    /// that is drawn tight in a kink continues through it.
    pub fn parts(&self, lines: &[SlackForm], has_support: [bool; 2]) -> Option<Vec<SlackPart>> {
        let mut stops = vec![0];
        for k in 1..lines.len() {
            if self.rests(&lines[k - 1], &lines[k])? {
                stops.push(k);
            }
        }
        stops.push(lines.len());
        loop {
            let tight = match self.chains(lines, &stops, has_support) {
                Ok(parts) => return Some(parts),
                Err(stop) => stop?,
            };
            // The plumb leg of a support itself is not merged.
            let inner = |k: usize| (k > 0 || !has_support[0]) && (k + 1 < lines.len() || !has_support[1]);
            match lines.get(tight.checked_sub(1)?..=tight)? {
                [SlackForm::Lies(a), SlackForm::Lies(b)] if self.bends_in(a, b) => {}
                [SlackForm::Lies(_), SlackForm::Hangs(h)] if self.rise(*h) > 0.0 && inner(tight) => {}
                [SlackForm::Hangs(h), SlackForm::Lies(_)] if self.rise(*h) < 0.0 && inner(tight - 1) => {}
                _ => return None,
            }
            stops.retain(|k| *k != tight);
        }
    }

    /// The parts between the points without tension; or the one of these points at which there is
    /// tension, if that is the cause of failure.
    fn chains(
        &self,
        lines: &[SlackForm],
        stops: &[usize],
        has_support: [bool; 2],
    ) -> Result<Vec<SlackPart>, Option<usize>> {
        let (mut out, mut bridged) = (Vec::new(), false);
        let support = |line: &SlackForm, end: usize| match line {
            SlackForm::Hangs(ends) => Some(ends[end]),
            _ => None,
        };
        for pair in stops.windows(2) {
            let (begin, end) = (pair[0], pair[1]);
            let near = [
                if has_support[0] && begin == 1 { support(&lines[0], 0) } else { None },
                if has_support[1] && end + 1 == lines.len() { support(&lines[end], 1) } else { None },
            ];
            if end < lines.len() || !bridged {
                let ends = [begin == 0 && has_support[0], end == lines.len() && has_support[1]];
                let tight = |side: Option<usize>| side.map(|side| pair[side]);
                bridged = self.chain(&lines[begin..end], ends, near, &mut out).map_err(tight)?;
            }
        }
        Ok(out)
    }

    /// Height by which a plumb leg rises, m.
    pub fn rise(&self, [from, to]: [Vec2; 2]) -> f64 {
        (to - from).dot(&self.frame.up)
    }

    /// True if the tension vanishes between two forms: at a foot, and in a kink that a cable under
    /// tension would bridge. None if the cable turns there without a contact.
    fn rests(&self, a: &SlackForm, b: &SlackForm) -> Option<bool> {
        let plumb =
            |s: &LyingStretch, p: f64| cross(s.place(self.context, p).tangent, self.frame.up).abs() <= STRAIGHT_TURN;
        match (a, b) {
            (SlackForm::Hangs(h), SlackForm::Lies(s)) => match self.rise(*h) < 0.0 {
                true => Some(true),
                false => plumb(s, s.coordinates[0]).then_some(false),
            },
            (SlackForm::Lies(s), SlackForm::Hangs(h)) => match self.rise(*h) > 0.0 {
                true => Some(true),
                false => plumb(s, s.coordinates[1]).then_some(false),
            },
            (SlackForm::Lies(s), SlackForm::Lies(next)) => {
                let [before, after] =
                    [s.place(self.context, s.coordinates[1]), next.place(self.context, next.coordinates[0])];
                let sense = self.context.curves[s.curve].sense;
                let turns = self.context.curves[next.curve].sense != sense;
                Some(turns || cross(before.tangent, after.tangent) * sense > STRAIGHT_TURN)
            }
            _ => Some(true),
        }
    }
}
