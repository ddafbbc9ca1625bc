//! This module computes a chain: the cable over one crest, between two points without tension. Its
//! tension falls on both sides as in a cable that slides down there.

use crate::math::{Vec2, larger};
use crate::model::spans::boundary::{LyingStretch, SlackForm, SlackPart, SlideResult};
use crate::model::spans::slack::slack_parts::{HALVINGS, SlackSolver, plumb};
use crate::model::spans::slack::stretch_tensions::StretchTensions;
use crate::model::spans::slack::support_span::SupportSpan;
use crate::numerics::bisect;

/// Distance from an end of a stretch at which its tension is tried, as a fraction of the stretch.
/// Smaller: round-off decides whether it rises; larger: tensions that rise and fall sooner are
/// missed. A choice, tuned on no campaign.
const TRIAL_FRACTION: f64 = 1e-3;

/// The tensions of the cable over one crest, computed from both sides.
struct CrestTensions {
    stretches: Vec<LyingStretch>,
    /// Material of the plumb leg behind each stretch, m: negative downwards.
    walls: Vec<Option<f64>>,
    forth: StretchTensions,
    back: StretchTensions,
    /// The side on which the crest draws the cable tight, if it does.
    tight: Option<usize>,
    /// The span to the support there.
    bridge: Option<SupportSpan>,
}

/// A span over a kink.
struct KinkSpan<'a> {
    part: &'a SlackPart,
    /// The stretch at which it ends.
    next: usize,
    /// Coordinates at which it leaves one stretch and meets the other.
    leaves: f64,
    meets: f64,
    /// True if its tension is the one computed from the start.
    by_start: bool,
}

impl CrestTensions {
    /// The span that begins behind a stretch, with the greater of the two tensions; next to a
    /// bridge only the tension from the bridge's side applies.
    fn span_behind(&self, k: usize) -> Option<KinkSpan<'_>> {
        let [f, b] =
            [&self.forth, &self.back].map(|side| side.spans[k].as_ref().map_or(0.0, |(span, _)| span.tension[0]));
        let by_start = match self.tight {
            Some(side) => side == 1,
            None => f >= b,
        };
        let side = if by_start { &self.forth } else { &self.back };
        side.spans[k].as_ref().map(|(part, next)| KinkSpan {
            part,
            next: *next,
            leaves: side.stretches[k].coordinates[1],
            meets: side.stretches[*next].coordinates[0],
            by_start,
        })
    }
}

impl SlackSolver<'_> {
    /// Lays the stretches between two points without tension, or from or to a support. If a support
    /// is nearby and the crest draws the cable tight there, a span bridges to it; returns whether
    /// that was done at the end.
    ///
    /// # Errors The side on which it is drawn tight, if that is the cause.
    pub(super) fn chain(
        &self,
        lines: &[SlackForm],
        has_support: [bool; 2],
        near: [Option<Vec2>; 2],
        out: &mut Vec<SlackPart>,
    ) -> Result<bool, Option<usize>> {
        let (first, last) = (self.hanging_length(lines.first()), self.hanging_length(lines.last()));
        if let ([_], Some(alone)) = (lines, first) {
            // The cable goes down from a support, or up to one.
            let begins = has_support[0] && self.rise(alone.0) < 0.0;
            let ends = has_support[1] && self.rise(alone.0) > 0.0;
            out.push(self.hanging_part(alone.0, alone.1));
            return if begins || ends { Ok(false) } else { Err(None) };
        }
        if (has_support[0] && first.is_some()) || (has_support[1] && last.is_some()) {
            return Err(None);
        }
        let crest = self.crest_tensions(lines, has_support, near, [first, last])?;
        if let Some(found) = crest.bridge.as_ref().filter(|_| crest.tight == Some(0)) {
            // This replaces the plumb leg.
            out.pop();
            out.push(found.part.clone());
        }
        out.extend(first.map(|(ends, s)| self.hanging_part(ends, s)));
        self.add_crest(&crest, out)?;
        out.extend(last.map(|(ends, s)| self.hanging_part(ends, s)));
        if let Some(found) = crest.bridge.filter(|_| crest.tight == Some(1)) {
            out.push(found.part);
            return Ok(true);
        }
        Ok(false)
    }

    /// The ends of a plumb leg, and its material, m.
    fn hanging_length(&self, line: Option<&SlackForm>) -> Option<([Vec2; 2], f64)> {
        match line {
            Some(SlackForm::Hangs(ends)) => Some((*ends, plumb(self.context, self.rise(*ends).abs()))),
            _ => None,
        }
    }

    /// A plumb part with so much material, m.
    fn hanging_part(&self, ends: [Vec2; 2], s: f64) -> SlackPart {
        let t = self.context.law.load.norm() * s;
        let tension = if self.rise(ends) > 0.0 { [0.0, t] } else { [t, 0.0] };
        SlackPart { arc_lengths: [0.0, s], tension, form: SlackForm::Hangs(ends) }
    }

    /// Computes the tensions over the crest from both sides, and the span to a support if the crest
    /// draws the cable tight.
    fn crest_tensions(
        &self,
        lines: &[SlackForm],
        has_support: [bool; 2],
        near: [Option<Vec2>; 2],
        hung: [Option<([Vec2; 2], f64)>; 2],
    ) -> Result<CrestTensions, Option<usize>> {
        let ends = hung.map(|h| h.map_or(0.0, |(_, s)| self.context.law.load.norm() * s));
        let (mut stretches, mut walls): (Vec<LyingStretch>, Vec<Option<f64>>) = (Vec::new(), Vec::new());
        for (k, line) in lines.iter().enumerate() {
            match line {
                SlackForm::Lies(s) => (stretches.push(*s), walls.push(None)).0,
                SlackForm::Hangs(ends) if k > 0 => {
                    let rise = self.rise(*ends);
                    if let Some(wall) = walls.last_mut() {
                        *wall = Some(plumb(self.context, rise.abs()).copysign(rise));
                    }
                }
                _ => {}
            }
        }
        let forth = self.profile(&stretches, &walls, 0, ends[0]).ok_or(None)?;
        let back = self.profile(&stretches, &walls, 1, ends[1]).ok_or(None)?;
        let begins_tight = !has_support[0] && back.leaves > ends[0] + self.most;
        let ends_tight = !has_support[1] && forth.leaves > ends[1] + self.most;
        let (tight, bridge) = match (begins_tight, ends_tight) {
            (true, false) => (Some(0), near[0].and_then(|at| self.bridge(&back, at, 0))),
            (false, true) => (Some(1), near[1].and_then(|at| self.bridge(&forth, at, 1))),
            (false, false) => (None, None),
            (true, true) => return Err(None),
        };
        if tight.is_some() && bridge.is_none() {
            return Err(tight);
        }
        Ok(CrestTensions { stretches, walls, forth, back, tight, bridge })
    }

    /// Lays the stretches of a crest from its start to its end, and the spans over kinks between
    /// them.
    fn add_crest(&self, crest: &CrestTensions, out: &mut Vec<SlackPart>) -> Result<(), Option<usize>> {
        let CrestTensions { stretches, forth, back, tight, bridge, .. } = crest;
        let range = match bridge {
            Some(found) if *tight == Some(0) => found.line..stretches.len(),
            Some(found) => 0..found.line + 1,
            None => 0..stretches.len(),
        };
        let (mut k, mut entry) = (range.start, None);
        while k < range.end {
            let mut s = stretches[k];
            let [mut f, mut b] = [forth.enters[k], back.enters[k]];
            if let Some((p, by_start)) = entry {
                s.coordinates[0] = p;
                f = if by_start { f } else { 0.0 };
            }
            let beyond = if k + 1 < range.end { crest.span_behind(k) } else { None };
            if let Some(span) = &beyond {
                s.coordinates[1] = span.leaves;
                b = if span.by_start { 0.0 } else { b };
            }
            if let Some(found) = bridge.as_ref().filter(|found| found.line == k) {
                s.coordinates[usize::from(*tight == Some(1))] = found.coordinate;
            }
            match tight {
                Some(0) => f = 0.0,
                Some(_) => b = 0.0,
                None => {}
            }
            self.stretch(&s, [f, b], out);
            match beyond {
                Some(span) => {
                    out.push(span.part.clone());
                    (k, entry) = (span.next, Some((span.meets, span.by_start)));
                }
                None if k + 1 < range.end && crest.walls[k].is_some() => return Err(None),
                None => (k, entry) = (k + 1, None),
            }
        }
        Ok(())
    }

    /// Divides a stretch into its parts: with the tension from its start, without tension, and with
    /// the tension from its end.
    fn stretch(&self, s: &LyingStretch, [forth, back]: [f64; 2], out: &mut Vec<SlackPart>) {
        let (context, friction, [p0, p1]) = (self.context, s.friction(self.context), s.coordinates);
        let forth_at = |p: f64| if p == p0 { forth } else { s.slide(context, p0, p, forth, -friction).tension };
        let back_at = |p: f64| if p == p1 { back } else { s.slide(context, p1, p, back, friction).tension };
        // Each tension vanishes at once or rises and falls again; beyond the place where it
        // vanishes there is none.
        let seek = |has: f64, not: f64, holds: &dyn Fn(f64) -> bool| {
            if holds(not) { not } else { bisect([has, not], HALVINGS, holds)[0] }
        };
        let little = TRIAL_FRACTION * (p1 - p0);
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
            // If both apply, the greater counts.
            let meet = if forth_at(ends) >= back_at(ends) {
                ends
            } else if forth_at(begins) <= back_at(begins) {
                begins
            } else {
                seek(begins, ends, &|p| forth_at(p) >= back_at(p))
            };
            (ends, begins) = (meet, meet);
        }
        let mut push = |p: [f64; 2], m: f64, way: SlideResult, tension: [f64; 2]| {
            let form = SlackForm::Lies(LyingStretch { coordinates: p, mobilised: m, ..*s });
            out.push(SlackPart { arc_lengths: [0.0, way.material.abs()], tension, form });
        };
        if ends > p0 {
            let way = s.slide(context, p0, ends, forth, -friction);
            push([p0, ends], -friction, way, [forth, larger(way.tension, 0.0)]);
        }
        if begins > ends || p0 == p1 {
            push(
                [ends, begins],
                0.0,
                SlideResult { material: self.rest_of(s, begins - ends), ..SlideResult::none(0.0) },
                [0.0; 2],
            );
        }
        if p1 > begins {
            let way = s.slide(context, p1, begins, back, friction);
            push([begins, p1], friction, way, [larger(way.tension, 0.0), back]);
        }
    }

    /// Material without tension on a stretch of p, m.
    fn rest_of(&self, s: &LyingStretch, p: f64) -> f64 {
        p * s.place(self.context, s.coordinates[0]).stretch / self.context.law.stretch(0.0)
    }
}
