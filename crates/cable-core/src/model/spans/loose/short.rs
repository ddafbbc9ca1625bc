//! A strand that has a little too little to hang plumb everywhere.
//!
//! What hangs from supports and crests then comes down on to the ground as a catenary, tangent to it, with a force H across the load in each, and the
//! friction of the ground takes H up on the way on, so that between two of them there still is ground without tension. The more H, the less
//! cable it takes; it is as much as fits. Seen from where it touches down at q, with the tension H/|t·u| there, σ follows from the distance, and q
//! from the height (see `bridge`); off a crest it leaves where the crest has its direction.

use std::f64::consts::TAU;

use super::super::drained::NONE_M;
use super::{Drape, HALVINGS, Line, Part, Stretch};
use crate::math::Vec2;

/// Rounds in which the place where a crest is left settles: each gains the digits of the crest's radius over the height.
const ROUNDS: usize = 60;
/// Rounds of the search for H.
const SEARCH: usize = 80;
/// Least force across the load that is tried, of the weight of the cable, and how much more each time.
const LEAST: f64 = 1e-7;
const MORE: f64 = 4.0;
/// The greatest, of the weight: no ground takes that up.
const MOST: f64 = 1e2;
/// Part of the cable that is left over.
const LEFT: f64 = 1e-8;

impl Drape<'_> {
    /// Every part with so much force across the load that a length of material (m) is enough.
    pub(super) fn short(&self, lines: &[Line], held: [bool; 2], length: f64) -> Option<Vec<Part>> {
        let weight = self.course.law.load.norm() * length;
        let over = |parts: &[Part]| length * (1.0 - LEFT) - parts.iter().map(|p| p.s[1] - p.s[0]).sum::<f64>();
        let (mut low, mut high) = (0.0, LEAST * weight);
        let mut best = loop {
            let parts = self.tightened(lines, held, high)?;
            if over(&parts) >= 0.0 {
                break parts;
            }
            (low, high) = (high, MORE * high);
            if !(high < MOST * weight) {
                return None;
            }
        };
        for _ in 0..SEARCH {
            let middle = if low > 0.0 { (low * high).sqrt() } else { 0.5 * high };
            if !(middle > low && middle < high) {
                break;
            }
            match self.tightened(lines, held, middle) {
                Some(parts) if over(&parts) >= 0.0 => (high, best) = (middle, parts),
                _ => low = middle,
            }
            if high - low <= LEFT * high {
                break;
            }
        }
        Some(best)
    }

    /// Every part with a force across the load in what hangs (N).
    fn tightened(&self, lines: &[Line], held: [bool; 2], across: f64) -> Option<Vec<Part>> {
        let mut cut: Vec<Option<Line>> = lines.iter().map(|l| Some(*l)).collect();
        let mut legs: Vec<Option<Part>> = vec![None; lines.len()];
        for (k, line) in lines.iter().enumerate() {
            let Line::Hangs(ends) = *line else { continue };
            let falls = self.rise(ends) < 0.0;
            let (side, crest) = if falls { (0, k.checked_sub(1)) } else { (1, Some(k + 1).filter(|j| *j < lines.len())) };
            let lies = |j: &usize| matches!(lines[*j], Line::Lies(_));
            let below: Vec<usize> = match falls {
                true => (k + 1..lines.len()).take_while(lies).collect(),
                false => (0..k).rev().take_while(lies).collect(),
            };
            let from = match crest.and_then(|j| cut[j]) {
                Some(Line::Lies(s)) => Err(s),
                None if held[side] => Ok(ends[side]),
                _ => return None,
            };
            let (at, p, leaves, part) = self.land(&below, &cut, (from, side), across)?;
            for j in &below[..at] {
                cut[*j] = None;
            }
            if let Some(Line::Lies(s)) = &mut cut[below[at]] {
                s.p[side] = p;
            }
            if let (Some(Some(Line::Lies(s))), Some(p)) = (crest.and_then(|j| cut.get_mut(j)), leaves) {
                s.p[1 - side] = p;
            }
            legs[k] = Some(part);
        }
        self.between(&cut, &legs, held)
    }

    /// What lies between the legs.
    fn between(&self, cut: &[Option<Line>], legs: &[Option<Part>], held: [bool; 2]) -> Option<Vec<Part>> {
        let (mut out, mut group, mut begin): (Vec<Part>, Vec<Stretch>, f64) = (Vec::new(), Vec::new(), 0.0);
        let mut grip = held[0];
        for (line, leg) in cut.iter().zip(legs) {
            if let Some(leg) = leg {
                if !group.is_empty() {
                    self.lying(&group, ([begin, leg.tension[0]], [grip, false]), &mut out)?;
                }
                (begin, grip) = (leg.tension[1], false);
                group.clear();
                out.push(leg.clone());
            } else if let Some(Line::Lies(s)) = line {
                if let Some(last) = group.last()
                    && self.rests(&Line::Lies(*last), &Line::Lies(*s))?
                {
                    self.lying(&group, ([begin, 0.0], [grip, false]), &mut out)?;
                    (begin, grip) = (0.0, false);
                    group.clear();
                }
                group.push(*s);
            }
        }
        if !group.is_empty() {
            self.lying(&group, ([begin, 0.0], [grip, held[1]]), &mut out)?;
        }
        Some(out)
    }

    /// The leg from a support (`Ok`) or a crest to where it touches down: which of the stretches, p on it, p where it leaves the crest.
    #[allow(clippy::type_complexity)]
    fn land(
        &self,
        below: &[usize],
        cut: &[Option<Line>],
        (from, side): (Result<Vec2, Stretch>, usize),
        across: f64,
    ) -> Option<(usize, f64, Option<f64>, Part)> {
        let course = self.course;
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let mut target = match &from {
            Ok(at) => *at,
            Err(s) => s.place(course, s.p[1 - side]).at,
        };
        for _ in 0..ROUNDS {
            let mut found = None;
            for (at, j) in below.iter().enumerate() {
                let Some(Line::Lies(s)) = &cut[*j] else { return None };
                let seen = |p: f64| {
                    let place = s.place(course, p);
                    let tension = across / self.frame.split(place.tangent).x.abs();
                    self.seen((place.at, -place.tangent * sign), tension, target)
                };
                let (mut low, mut high) = (s.p[side], s.p[1 - side]);
                if seen(high).is_some_and(|s| !(s.over > 0.0)) {
                    continue;
                }
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if seen(middle).is_none_or(|s| s.over > 0.0) { high = middle } else { low = middle }
                }
                found = Some((at, low, seen(low).filter(|s| s.over.abs() <= NONE_M)?));
                break;
            }
            let (at, p, seen) = found?;
            let weight = course.law.load * seen.length;
            let ground = seen.towards * -sign * seen.tension;
            let top = ground + weight * sign;
            let leaves = from.as_ref().err().map(|s| {
                let curve = &course.curves[s.curve];
                let p = curve.with_tangent(s.piece, top);
                // Of the turns of a post the one it lies on.
                let turns = if curve.is_round() { ((s.p[1 - side] - p) / TAU).round() } else { 0.0 };
                (s, p + turns * TAU)
            });
            if let Some((s, p)) = leaves {
                let there = s.place(course, p).at;
                let moved = (there - target).norm();
                target = there;
                if !(p >= s.p[0] - NONE_M && p <= s.p[1] + NONE_M) {
                    return None;
                }
                if moved > 1e-3 * NONE_M {
                    continue;
                }
            }
            let (tension, form) = match side {
                0 => ([top.norm(), seen.tension], Line::Spans { from: target, force: top }),
                _ => ([seen.tension, top.norm()], Line::Spans { from: seen.at, force: ground }),
            };
            let part = Part { s: [0.0, seen.length], tension, form };
            return Some((at, p, leaves.map(|(_, p)| p), part));
        }
        None
    }
}
