//! The slip predictor estimates before a step which contacts will slide in it, and how far.
//!
//! With a wrong set of sliding contacts Newton's method ends at a state that shows only the next
//! wrong set: ten contacts in a row are found to slide one after the other. To first order the
//! problem involves scalars only. With d the closure gap of a span after its ends have moved, C its
//! compliance, t the cable's direction and f = λt at its two ends a, b, and σ the material that has
//! slid back through the contacts before and after it (s at a fixed place grows by σ),
//!
//! ```text
//! ΔG = −C⁻¹(d + f_b σ_after − fₐ σ_before),      ΔT_a = tₐ·(ΔG − b σ_before),      ΔT_b = t_b·(ΔG − b σ_after)
//! contact: σ = 0 where T₂ is within what sliding makes of T₁ at ±μ; σ ≤ 0 at +μ, σ ≥ 0 at −μ
//! ```
//!
//! (a motion of a contact's end along the boundary takes as much from the cable as from the chord).
//! This is a tridiagonal linear complementarity problem, solved by changing the sides that are
//! wrong until none is: G. Zoutendijk's active sets in their simplest form. After each of a few
//! rounds the ends of contacts on arcs follow the directions of their spans, and the next round
//! begins with the new wraps. All this is only a first guess: Newton's method starts from it and
//! decides the mode of each contact again.

use crate::math::{Vec2, angle, exp, larger};
use crate::model::spans::boundary::{BoundaryPoint, CachedPiece, ContactPath, Ends, Mode};
use crate::model::spans::section::{CableSection, Contact, EndCondition, SolveContext};
use crate::model::spans::settings::SlipSettings;

/// Relative change of a span's force in a round below which it counts as unchanged. Larger: the
/// guess is off by as much.
const FORCE_TOLERANCE: f64 = 1e-8;

/// A span to first order.
#[derive(Clone, Copy, Debug, Default)]
struct LinearSpan {
    /// Start and end, m; None if its force is constant.
    ends: Option<[Vec2; 2]>,
    /// Force G, N.
    force: Vec2,
    /// Material at both ends, m.
    material: [f64; 2],
    /// Change of G without slip (N), and by σ before and after it (N/m).
    change: [Vec2; 3],
    /// Present tension at both ends, N.
    was: [f64; 2],
    /// Tension at both ends without slip, N.
    tension: [f64; 2],
    /// Change of tension at each end by σ before and after it, N/m.
    by: [[f64; 2]; 2],
    /// True if the last round did not change it, so that its linearisation stays valid.
    still: bool,
}

/// A contact to first order.
#[derive(Clone, Copy, Debug)]
struct LinearContact {
    /// End places, material and tensions there.
    ends: Ends,
    /// Tension at the end after sliding with −μ and +μ (N), and its derivative; None if the contact
    /// is not predicted.
    reach: Option<[(f64, f64); 2]>,
    /// −1 if it slides back, 0 if it sticks, +1 if it slides forward.
    side: i8,
    /// Slip of this round, m.
    sigma: f64,
    /// Slip before this round, m.
    slid: f64,
}

/// The places of both ends of a contact, and the piece of the first.
type ContactPlaces = ([BoundaryPoint; 2], CachedPiece);

/// Working memory of a prediction.
#[derive(Clone, Debug, Default)]
pub(in crate::model::spans) struct SlipPredictor {
    bars: Vec<LinearSpan>,
    links: Vec<LinearContact>,
    /// Upper diagonal and right-hand side of the elimination.
    swept: Vec<(f64, f64)>,
    end_points: Vec<ContactPlaces>,
    tuned: SlipSettings,
}

/// Predicts the mode of each contact in the step, and the places of contacts and spans.
pub(in crate::model::spans) fn predict_slip(
    section: &mut CableSection,
    context: &SolveContext,
    memory: &mut SlipPredictor,
) {
    if context.drag > 0.0 || section.contacts.is_empty() {
        return;
    }
    section.update_end_tensions(context);
    let SlipPredictor { bars, links, end_points, tuned, .. } = memory;
    *tuned = context.settings.newton.slip;
    let seen = |c: &Contact| CachedPiece::of_ends(&context.curves[c.curve], c.chain_range, &context.law, c.ends.place);
    end_points.clear();
    end_points.extend(section.contacts.iter().map(seen));
    bars.clear();
    bars.extend((0..section.spans()).map(|k| span(section, context, end_points, k)));
    links.clear();
    links.extend((0..section.contacts.len()).map(|j| linear_contact(section, context, end_points, j)));
    let Some(settled) = memory.rounds(section, context) else { return };
    for (c, l) in section.contacts.iter_mut().zip(&memory.links).filter(|(_, l)| l.reach.is_some()) {
        let friction = context.friction(c);
        if friction > 0.0 {
            c.mode = if l.side == 0 { Mode::Stick } else { Mode::Slip(friction * f64::from(l.side)) };
        }
        if settled {
            c.ends = l.ends;
        }
    }
    if settled {
        for (force, bar) in section.forces.iter_mut().zip(&memory.bars).filter(|(_, b)| b.ends.is_some()) {
            *force = bar.force;
        }
    }
}

/// The linearised span at its present state.
fn span(section: &CableSection, context: &SolveContext, end_points: &[ContactPlaces], k: usize) -> LinearSpan {
    if !section.has_span(k) {
        return LinearSpan::default();
    }
    let (from, to) = section.material(k);
    let forces = [section.force(context, k, from), section.force(context, k, to)];
    let support_place = |t: &EndCondition| if let EndCondition::Fixed(at) = t { Some(*at) } else { None };
    let before = k
        .checked_sub(1)
        .and_then(|j| end_points.get(j))
        .map_or_else(|| support_place(&section.end_conditions[0]), |s| Some(s.0[1].at));
    let after = end_points.get(k).map_or_else(|| support_place(&section.end_conditions[1]), |s| Some(s.0[0].at));
    // A hanging span keeps its force.
    let ends = before.zip(after).map(|(a, b)| [a, b]);
    let tension = forces.map(|f| f.norm());
    LinearSpan { ends, force: section.forces[k], material: [from, to], tension, ..LinearSpan::default() }
}

impl LinearSpan {
    /// Force at both ends, N.
    fn pulls(&self, context: &SolveContext, first: f64) -> [Vec2; 2] {
        let [from, to] = self.material;
        let start = self.force - context.load_between(first, from);
        [start, start - context.load_between(from, to)]
    }

    /// Linearises the span at its present state; false if that is impossible.
    fn renew(&mut self, context: &SolveContext, first: f64) -> bool {
        let Some([a, b]) = self.ends else { return true };
        if self.still {
            self.change[0] = Vec2::zeros();
            return true;
        }
        let [from, to] = self.material;
        let [start, end] = self.pulls(context, first);
        let (way, compliance) = context.chain(from, to).reach(start);
        let Some(stiffness) = compliance.try_inverse() else { return false };
        let [rate, rate_end] = [start, end].map(|f| context.rate(f));
        self.change = [-(stiffness * (way - (b - a))), stiffness * rate, -(stiffness * rate_end)];
        for (i, f) in [start, end].into_iter().enumerate() {
            let (size, load) = (f.norm(), context.law.load);
            let t = f / size;
            self.was[i] = size;
            self.tension[i] = size + t.dot(&self.change[0]);
            self.by[i] = [t.dot(&self.change[1]), t.dot(&self.change[2])];
            self.by[i][i] -= t.dot(&load);
        }
        self.tension.iter().all(|t| t.is_finite())
    }
}

/// Contact `j` linearised for the prediction of slip.
fn linear_contact(
    section: &CableSection,
    context: &SolveContext,
    end_points: &[ContactPlaces],
    j: usize,
) -> LinearContact {
    let c = &section.contacts[j];
    let e = &c.ends;
    let end_conditions = [
        (j == 0).then(|| section.end_conditions[0]),
        (j + 1 == section.contacts.len()).then(|| section.end_conditions[1]),
    ];
    let is_tied = end_conditions.iter().flatten().any(|t| matches!(t, EndCondition::Lies(_) | EndCondition::Loose(_)));
    let mut out = LinearContact { ends: c.ends, reach: None, side: 0, sigma: 0.0, slid: 0.0 };
    let beside_slack = section.in_pocket(j, 0) || section.in_pocket(j, 1);
    let beside_load = section.has_load_material(j, 0) || section.has_load_material(j, 1);
    if is_tied || beside_slack || beside_load || !(e.place[1] > e.place[0] && e.tension[0] > 0.0) {
        return out;
    }
    let friction = context.friction(c);
    let contact_path = ContactPath { cached_piece: end_points.get(j).map(|s| s.1), ..context.contact_path(c) };
    out.reach = Some([-friction, friction].map(|m| {
        let way = contact_path.slide(e.place[0], e.place[1], e.tension[0], m);
        (way.tension, way.by_tension)
    }));
    // A frictionless contact always slides.
    out.side = if friction > 0.0 { 0 } else { 1 };
    out
}

impl SlipPredictor {
    /// Runs Newton's method for the slips; returns whether it converged, None if not even the modes
    /// can be predicted.
    fn rounds(&mut self, section: &CableSection, context: &SolveContext) -> Option<bool> {
        let mut last = f64::INFINITY;
        for round in 0..self.tuned.newton_rounds {
            if !self.bars.iter_mut().all(|b| b.renew(context, section.from)) || !self.settle() {
                return (round > 0).then_some(false);
            }
            let Some(change) = self.step() else { return Some(false) };
            self.turn(section, context);
            if change <= self.tuned.round_tolerance {
                return Some(true);
            }
            last = change;
        }
        Some(last <= self.tuned.accepted_tension_change)
    }

    /// Lets the ends of contacts on arcs follow the directions of their spans.
    fn turn(&mut self, section: &CableSection, context: &SolveContext) {
        let (law, most) = (&context.law, self.tuned.max_followed_angle);
        let pulls = |bar: &LinearSpan, end: usize| bar.ends.map(|_| bar.pulls(context, section.from)[end]);
        for (j, c) in section.contacts.iter().enumerate() {
            let (l, (places, cached_piece)) = (&mut self.links[j], &mut self.end_points[j]);
            if l.reach.is_none() || self.bars[j].still && self.bars[j + 1].still {
                continue;
            }
            let old = l.ends;
            l.ends.material = l.ends.material.map(|s| s + l.sigma);
            let contact_path = ContactPath { cached_piece: Some(*cached_piece), ..context.contact_path(c) };
            for side in 0..2 {
                let bar = &mut self.bars[j + side];
                let Some(force) = pulls(bar, 1 - side) else { continue };
                let (tension, place) = (force.norm(), &mut places[side]);
                l.ends.tension[side] = tension;
                let angle = angle(place.tangent, force);
                if place.turn == 0.0 || !(angle.abs() <= most) {
                    continue;
                }
                let by = angle / place.turn;
                let p = l.ends.place[side] + by;
                let turned = if side == 0 { p < l.ends.place[1] } else { p > l.ends.place[0] };
                if turned && contact_path.turns(p) {
                    l.ends.place[side] = p;
                    l.ends.material[side] += by * place.stretch / context.law.stretch(tension);
                    *place = contact_path.place(p);
                }
                bar.material[1 - side] = l.ends.material[side];
                if let Some(ends) = &mut bar.ends {
                    ends[1 - side] = place.at;
                }
            }
            // T₂ = T₁ e^{mψ} with the load along it, to first order in the motion of the ends.
            for (m, (made, by)) in
                [-contact_path.friction, contact_path.friction].into_iter().zip(l.reach.iter_mut().flatten())
            {
                let load = |place: &BoundaryPoint, t: f64| law.slope(place, t, m) - m * place.turn.abs() * t;
                let [first, last] = [0, 1].map(|side| l.ends.place[side] - old.place[side]);
                let grown = exp(m * (last * places[1].turn.abs() - first * places[0].turn.abs()));
                *made += *by * (l.ends.tension[0] - old.tension[0] - load(&places[0], old.tension[0]) * first);
                *made = (*made + load(&places[1], *made) * last) * grown;
                *by *= grown;
            }
        }
    }

    /// Applies the result of the round; returns the greatest relative change of tension, None if
    /// that is too large.
    fn step(&mut self) -> Option<f64> {
        let (mut greatest, limit) = (0.0, self.tuned.max_tension_factor);
        for k in 0..self.bars.len() {
            let slide = |j: Option<usize>| j.and_then(|j| self.links.get(j)).map_or(0.0, |l| l.sigma);
            let (before, after) = (slide(k.checked_sub(1)), slide(Some(k)));
            let bar = &mut self.bars[k];
            if bar.ends.is_none() {
                continue;
            }
            let change = bar.change[0] + bar.change[1] * before + bar.change[2] * after;
            let now = [0, 1].map(|i| bar.tension[i] + bar.by[i][0] * before + bar.by[i][1] * after);
            for (now, was) in now.into_iter().zip(bar.was) {
                if !(now <= was * limit && now >= was / limit) {
                    return None;
                }
                greatest = larger(greatest, (now - was).abs() / was);
            }
            bar.still = before == 0.0 && after == 0.0 && change.norm() <= FORCE_TOLERANCE * bar.was[0];
            (bar.was, bar.tension) = (now, now);
            bar.force += change;
            bar.material = [bar.material[0] + before, bar.material[1] + after];
            if !(bar.material[1] > bar.material[0]) {
                return None;
            }
        }
        for l in &mut self.links {
            l.slid += l.sigma;
        }
        Some(greatest)
    }

    /// Finds consistent sides and slips; false if the iteration does not end.
    fn settle(&mut self) -> bool {
        for _ in 0..2 * self.links.len() + self.tuned.newton_rounds {
            if !self.solve() {
                return false;
            }
            if !self.change() {
                return true;
            }
        }
        false
    }

    /// Solves the slips for the present sides, a tridiagonal system.
    fn solve(&mut self) -> bool {
        self.swept.clear();
        let mut before = (0.0, 0.0);
        for (j, l) in self.links.iter().enumerate() {
            let reach = l.reach.and_then(|r| match l.side {
                0 => None,
                side => Some(r[usize::from(side > 0)]),
            });
            before = match reach {
                None => (0.0, -l.slid),
                Some((made, by)) => {
                    let (one, two) = (&self.bars[j], &self.bars[j + 1]);
                    // The row is T₂ − (tension from T₁) = 0.
                    let lower = -by * one.by[1][0];
                    let middle = two.by[0][0] - by * one.by[1][1];
                    let rest = made + by * (one.tension[1] - l.ends.tension[0]) - two.tension[0];
                    let pivot = middle - lower * before.0;
                    (two.by[0][1] / pivot, (rest - lower * before.1) / pivot)
                }
            };
            self.swept.push(before);
        }
        let mut after = 0.0;
        for (l, (upper, rest)) in self.links.iter_mut().zip(&self.swept).rev() {
            l.sigma = rest - upper * after;
            after = l.sigma;
        }
        self.links.iter().all(|l| l.sigma.is_finite())
    }

    /// Changes the sides that disagree with the slips; returns whether there was any.
    fn change(&mut self) -> bool {
        let sigma = |links: &[LinearContact], j: Option<usize>| j.and_then(|j| links.get(j)).map_or(0.0, |l| l.sigma);
        let mut changed = false;
        for j in 0..self.links.len() {
            let l = self.links[j];
            let Some([(low, by_low), (high, by_high)]) = l.reach else { continue };
            if low == high {
                continue;
            }
            let side = if l.side == 0 {
                let (before, after) = (sigma(&self.links, j.checked_sub(1)), sigma(&self.links, Some(j + 1)));
                let (one, two) = (&self.bars[j], &self.bars[j + 1]);
                let grown = one.tension[1] + one.by[1][0] * before + one.by[1][1] * l.sigma - l.ends.tension[0];
                let reached = two.tension[0] + two.by[0][0] * l.sigma + two.by[0][1] * after;
                if reached > high + by_high * grown {
                    1
                } else if reached < low + by_low * grown {
                    -1
                } else {
                    0
                }
            } else if (l.slid + l.sigma) * f64::from(l.side) > 0.0 {
                0
            } else {
                l.side
            };
            changed |= side != l.side;
            self.links[j].side = side;
        }
        changed
    }
}
