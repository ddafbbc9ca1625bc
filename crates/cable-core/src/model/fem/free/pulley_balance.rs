//! The pulley balance finds how much cable lies on each side of the pulleys that join the spans.
//!
//! Each span is solved for itself (`span`); what joins them is the arc length `s` at each pulley.
//! With the tension before and after a pulley, ρ = ln(T_after/T_before), and the bounds of
//! Coulomb's law (capstan: ±μ·turn):
//! ```text
//! frictionless   ρ = 0
//! stick          s = s_old,      −μφ ≤ ρ ≤ μφ
//! slip           ρ = −μφ where s grew (the cable went to the side before), ρ = +μφ where it shrank
//! ```
//! ρ is the slope of the energy in `s` but for a positive factor, so a resting place is stable
//! where ∂ρ/∂s is positive: the pivots of the (tridiagonal) Newton matrix must be. When Newton
//! stalls or ends at an unstable place, each pulley in turn is bisected for a change of ρ from −
//! to +, which only stable places have. Wheels with a radius are in `wheel_arcs`.

use crate::math::{Vec2, bounded, larger, perp};
use crate::model::fem::free::element::{Material, turn_between};
use crate::model::fem::free::pulley_state::PulleyState;
use crate::model::fem::free::span;
use crate::model::fem::free::span::{Span, elements};
use crate::model::fem::free::stations::{Hold, Layout, SpanEnds, Wheel};
use crate::numerics::backtrack;

/// Newton steps for the pulleys together. Measured: 3 to 8.
const MAX_STEPS: usize = 40;

/// Lengths of a step that are tried.
const MAX_HALVINGS: usize = 12;
/// Powers of ten by which a fold is rounded off at first: to a tenth of the load, where any start
/// converges.
const FOLD_ROUNDING_DECADES: i32 = 6;
/// Rounds of bisection.
const MAX_ROUNDS: usize = 60;
/// Tensions at a pulley agree when ln of their ratio is off by less than this.
const BALANCE_TOLERANCE: f64 = 1e-12;
/// As above where no step makes it smaller (a stiff cable: ρ has lost its last digits).
const BALANCE_LIMIT: f64 = 1e-8;
/// Part of the room to the next stop that a step may take.
const STEP_ROOM_FRACTION: f64 = 0.4;
/// Least cable between a pulley and the next stop, in parts of the cable.
const END_CABLE_FRACTION: f64 = 1e-7;

/// The reason why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// The span that starts at this stop could not be solved; the force left, N.
    Span(usize, f64),
    /// The cable runs out through the pulley at this stop.
    RunsOut(usize),
    /// The balance at the pulley of this stop could not be found; the force left, N.
    Unbalanced(usize, f64),
    /// The cable leaves its wheel.
    LeavesWheel(usize),
}

/// The cable between its stops.
#[derive(Clone, Debug)]
pub struct Network {
    /// The stops.
    pub layout: Layout,
    /// Values that the elements share.
    pub material: Material,
    /// The stops at each span's ends.
    pub ends: Vec<SpanEnds>,
    /// The spans' answers, as `ends`.
    pub spans: Vec<Span>,
    /// Tension force just before and just after each stop, N.
    pub forces: Vec<[Vec2; 2]>,
    /// Newton steps of all kinds.
    pub steps: usize,
    /// Largest unbalanced force, N.
    pub residual: f64,
    /// Arc length at each stop before anything slid (friction remembers it), m.
    held_at: Vec<f64>,
    warm: bool,
    /// Every pulley with what friction remembers of it, in order; empty until it was asked for
    /// (`pulley_states`).
    pub pulley_states: Vec<PulleyState>,
}

/// The law of a pulley at the present forces.
struct Balance {
    /// ln(T_after/T_before).
    ratio: f64,
    /// Its bounds and its frictionless value: lower, frictionless, upper.
    law: [f64; 3],
}

impl Network {
    /// A network that has not been solved.
    #[must_use]
    pub fn new(layout: Layout, material: Material) -> Self {
        let ends: Vec<_> = layout.spans().collect();
        let mut network = Self {
            spans: vec![Span::default(); ends.len()],
            forces: vec![[Vec2::zeros(); 2]; layout.stops.len()],
            held_at: layout.stops.iter().map(|s| s.arc_length).collect(),
            ends,
            layout,
            material,
            steps: 0,
            residual: 0.0,
            warm: false,
            pulley_states: Vec::new(),
        };
        network.meet_wheels_straight();
        network
    }

    /// Takes over the forces of a network with the same stops, to start from.
    pub fn start_from(&mut self, other: &Self) {
        if other.ends == self.ends && other.warm {
            self.spans.clone_from(&other.spans);
            self.warm = true;
        }
    }

    /// The next solve may start from the present forces.
    pub(in crate::model::fem) fn warm_now(&mut self) {
        self.warm = true;
    }

    /// Solves everything, friction from where the material was laid.
    ///
    /// # Errors
    /// The reason why there is no answer.
    pub fn solve(&mut self) -> Result<(), Failure> {
        self.steps = 0;
        let wheels = self.layout.stops.iter().any(|s| matches!(s.hold, Hold::Pulley(w) if w.radius > 0.0));
        if wheels {
            self.balance_on_wheels()?
        } else {
            self.balance()?
        }
        self.warm = true;
        Ok(())
    }

    /// Solves the spans for the present arc lengths.
    pub(in crate::model::fem) fn solve_spans(&mut self) -> Result<(), Failure> {
        self.residual = 0.0;
        for i in 0..self.ends.len() {
            self.solve_span(i)?;
        }
        self.hang_tails();
        Ok(())
    }

    fn solve_span(&mut self, i: usize) -> Result<(), Failure> {
        let ends = self.ends[i];
        let SpanEnds { first, last } = ends;
        let (Some(a), Some(b)) = (self.layout.stops[first].point(1), self.layout.stops[last].point(0)) else {
            return Err(Failure::Span(first, f64::NAN));
        };
        let d = b - a;
        let solve = |guess| span::solve(&self.material, &self.layout, ends, d, guess);
        let warm = if self.warm || self.spans[i].steps > 0 { solve(self.spans[i].force) } else { None };
        let guess = span::first_guess(&self.material, &self.layout, ends, d);
        let span = warm.or_else(|| solve(guess)).or_else(|| self.unfold(ends, d, guess));
        let span = span.ok_or(Failure::Span(first, f64::NAN))?;
        self.steps += span.steps;
        self.residual = larger(self.residual, span.residual);
        self.forces[first][1] = span.force;
        self.forces[last][0] = span.walk.end_force;
        self.spans[i] = span;
        Ok(())
    }

    /// A span folded so sharply that one element turns round in itself: where its tension vanishes
    /// D has a kink, which is rounded off and then sharpened tenfold at a time.
    fn unfold(&self, ends: SpanEnds, d: Vec2, guess: Vec2) -> Option<Span> {
        let (mut force, mut steps) = (guess, 0);
        for power in (0..=FOLD_ROUNDING_DECADES).rev() {
            let material = Material { smoothing: self.material.smoothing * 10f64.powi(power), ..self.material };
            let span = span::solve(&material, &self.layout, ends, d, force)?;
            (force, steps) = (span.force, steps + span.steps);
            if power == 0 {
                return Some(Span { steps, ..span });
            }
        }
        None
    }

    /// Forces of the stretches that end free: the load beyond.
    fn hang_tails(&mut self) {
        let Some((first, last)) = self.layout.anchored() else { return };
        let end = self.layout.stops.len() - 1;
        self.forces[0][0] = Vec2::zeros();
        self.forces[end][1] = Vec2::zeros();
        if first > 0 {
            let start = -self.layout.stops[0].load;
            self.forces[first][0] =
                elements(&self.material, &self.layout, SpanEnds { first: 0, last: first }, start, |_, _| ());
        }
        if last < end {
            let stops = &self.layout.stops;
            let loads: Vec2 = stops[last + 1..].iter().map(|s| s.load).sum();
            self.forces[last][1] = loads + self.material.body * (stops[end].arc_length - stops[last].leaves());
        }
    }

    /// The pulley at a stop.
    pub(in crate::model::fem) fn wheel(&self, stop: usize) -> Option<Wheel> {
        match self.layout.stops[stop].hold {
            Hold::Pulley(w) => Some(w),
            _ => None,
        }
    }

    /// The stops with pulleys.
    pub(in crate::model::fem) fn pulleys(&self) -> Vec<usize> {
        (0..self.layout.stops.len()).filter(|&k| self.wheel(k).is_some()).collect()
    }

    fn law(&self, stop: usize, wheel: &Wheel) -> Balance {
        let [before, after] = self.forces[stop];
        let ratio = (after.norm() / before.norm()).ln();
        if wheel.radius > 0.0 {
            let clockwise = self.clockwise_at(stop, wheel);
            let law = [-1.0, 0.0, 1.0].map(|sign| self.round_wheel(wheel, before, clockwise, sign));
            return Balance { ratio, law };
        }
        let bound = wheel.friction * turn_between(before, after).abs();
        Balance { ratio, law: [-bound, 0.0, bound] }
    }

    /// Slide of the arc length at a pulley since friction last held, m (the middle of a wheel's
    /// arc).
    fn slid(&self, stop: usize) -> f64 {
        self.layout.stops[stop].arc_length + 0.5 * self.layout.stops[stop].lap - self.held_at[stop]
    }

    /// Imbalance at a pulley: 0 where it rests, else positive where the arc length must shrink.
    /// `None`: held.
    pub(in crate::model::fem) fn fault(&self, stop: usize, wheel: &Wheel) -> Option<f64> {
        let b = self.law(stop, wheel);
        if !(wheel.friction > 0.0) {
            return Some(b.ratio - b.law[1]);
        }
        let slid = self.slid(stop);
        let still = 1e-12 * self.layout.length;
        if slid > still {
            Some(b.ratio - b.law[0])
        } else if slid < -still {
            Some(b.ratio - b.law[2])
        } else if b.ratio < b.law[0] {
            Some(b.ratio - b.law[0])
        } else if b.ratio > b.law[2] {
            Some(b.ratio - b.law[2])
        } else {
            None
        }
    }

    /// Finds the arc length at every pulley.
    pub(in crate::model::fem) fn balance(&mut self) -> Result<(), Failure> {
        self.solve_spans()?;
        let pulleys = self.pulleys();
        if pulleys.is_empty() {
            return Ok(());
        }
        if self.newton(&pulleys) {
            return Ok(());
        }
        for _ in 0..MAX_ROUNDS {
            self.bisect_each()?;
            // Of several stable places bisection may find another each time: Newton stays at one.
            let bisected = self.clone();
            if self.newton(&self.pulleys()) {
                return Ok(());
            }
            *self = bisected;
        }
        let pulleys = self.pulleys();
        let worst = pulleys.iter().copied().find(|&k| self.wheel(k).and_then(|w| self.fault(k, &w)).is_some());
        let stop = worst.unwrap_or(0);
        Err(Failure::Unbalanced(stop, self.unbalance(stop)))
    }

    fn unbalance(&self, stop: usize) -> f64 {
        let fault = self.wheel(stop).and_then(|w| self.fault(stop, &w)).unwrap_or(0.0);
        fault.abs() * self.forces[stop][0].norm()
    }

    /// Newton on all pulleys; true when they rest in a stable place.
    fn newton(&mut self, pulleys: &[usize]) -> bool {
        let faults = |n: &Self| -> Vec<Option<f64>> {
            pulleys.iter().map(|&k| n.wheel(k).and_then(|w| n.fault(k, &w))).collect()
        };
        let size = |f: &[Option<f64>]| f.iter().flatten().fold(0.0, |a: f64, b| if b.abs() <= a { a } else { b.abs() });
        let mut now = faults(self);
        for _ in 0..MAX_STEPS {
            let (step, stable) = self.newton_step(pulleys, &now);
            if size(&now) <= BALANCE_TOLERANCE {
                self.residual =
                    pulleys.iter().map(|&k| self.unbalance(k)).fold(self.residual, |a, b| if b <= a { a } else { b });
                return stable;
            }
            let from: Vec<f64> = pulleys.iter().map(|&k| self.layout.stops[k].arc_length).collect();
            let better = backtrack(1.0, MAX_HALVINGS, |part| {
                self.move_pulleys(pulleys, &from, &step, part);
                self.steps += 1;
                self.solve_spans().ok()?;
                Some(faults(self)).filter(|next| size(next) < size(&now))
            });
            let Some(next) = better else {
                self.move_pulleys(pulleys, &from, &step, 0.0);
                return self.solve_spans().is_ok() && stable && size(&now) <= BALANCE_LIMIT;
            };
            now = next;
        }
        false
    }

    /// Moves every pulley by `alpha` of its step, within its room, and not beyond where friction
    /// held it.
    fn move_pulleys(&mut self, pulleys: &[usize], from: &[f64], step: &[f64], alpha: f64) {
        for (i, &k) in pulleys.iter().enumerate() {
            self.layout.stops[k].arc_length = from[i];
        }
        let mut limited = Vec::with_capacity(pulleys.len());
        for (i, &k) in pulleys.iter().enumerate() {
            let stops = &self.layout.stops;
            let down = STEP_ROOM_FRACTION * (from[i] - stops[k - 1].leaves());
            let up = STEP_ROOM_FRACTION * (stops[k + 1].arc_length - from[i] - stops[k].lap);
            let mut move_by = bounded(alpha * step[i], -down, up);
            let slid = self.slid(k);
            let friction = self.wheel(k).is_some_and(|w| w.friction > 0.0);
            if friction && slid * (slid + move_by) < 0.0 {
                move_by = -slid;
            }
            limited.push(from[i] + move_by);
        }
        for (i, &k) in pulleys.iter().enumerate() {
            self.layout.stops[k].arc_length = limited[i];
        }
    }

    /// The Newton step of each pulley's arc length, and whether all pivots are positive.
    pub(in crate::model::fem) fn newton_step(&self, pulleys: &[usize], faults: &[Option<f64>]) -> (Vec<f64>, bool) {
        let n = pulleys.len();
        let (mut diagonal, mut below, mut above) = (vec![1.0; n], vec![0.0; n], vec![0.0; n]);
        let mut right: Vec<f64> = faults.iter().map(|f| -f.unwrap_or(0.0)).collect();
        for (i, &k) in pulleys.iter().enumerate() {
            let Some(fault) = faults[i] else { continue };
            let Some(wheel) = self.wheel(k) else { continue };
            let [before, after] = self.forces[k];
            let own = self.rates_at(k, k);
            let rate = |r: [Vec2; 2]| self.fault_rate(&wheel, fault, [before, after], r);
            diagonal[i] = rate(own);
            if i > 0 {
                below[i] = rate(self.rates_at(k, pulleys[i - 1]));
            }
            if i + 1 < n {
                above[i] = rate(self.rates_at(k, pulleys[i + 1]));
            }
        }
        let mut stable = true;
        for i in 0..n {
            if i > 0 {
                let factor = below[i] / diagonal[i - 1];
                diagonal[i] -= factor * above[i - 1];
                right[i] -= factor * right[i - 1];
            }
            if !(diagonal[i] > 0.0) {
                stable = false;
                diagonal[i] = if diagonal[i] < 0.0 { -diagonal[i] } else { 1.0 };
            }
        }
        for i in (0..n).rev() {
            let next = if i + 1 < n { above[i] * right[i + 1] } else { 0.0 };
            right[i] = (right[i] - next) / diagonal[i];
        }
        (right, stable)
    }

    /// ∂(force before, force after the pulley at stop `k`)/∂(arc length at the pulley of stop
    /// `of`).
    pub(in crate::model::fem) fn rates_at(&self, k: usize, of: usize) -> [Vec2; 2] {
        let mut rates = [Vec2::zeros(); 2];
        for (span, &ends) in self.spans.iter().zip(&self.ends) {
            let by_end = if ends.last == of {
                true
            } else if ends.first == of {
                false
            } else {
                continue;
            };
            if ends.last == k {
                rates[0] += span.force_rates(&self.material, &self.layout, ends, by_end)[1];
            }
            if ends.first == k {
                rates[1] += span.force_rates(&self.material, &self.layout, ends, by_end)[0];
            }
        }
        if let Some((first, last)) = self.layout.anchored()
            && of == k
        {
            if k == first && first > 0 {
                rates[0] -= self.material.body;
            }
            if k == last && last + 1 < self.layout.stops.len() {
                rates[1] -= self.material.body;
            }
        }
        rates
    }

    /// Change of the imbalance at a pulley when the forces beside it change by `rates`.
    pub(in crate::model::fem) fn fault_rate(
        &self,
        wheel: &Wheel,
        fault: f64,
        [before, after]: [Vec2; 2],
        rates: [Vec2; 2],
    ) -> f64 {
        let ratio = after.dot(&rates[1]) / after.norm_squared() - before.dot(&rates[0]) / before.norm_squared();
        if !(wheel.friction > 0.0) {
            return ratio;
        }
        let turn = turn_between(before, after);
        let turning =
            perp(after).dot(&rates[1]) / after.norm_squared() - perp(before).dot(&rates[0]) / before.norm_squared();
        // The bound that holds: the lower one where ρ lies below it or the pulley gave cable to the
        // side before.
        let lower = (after.norm() / before.norm()).ln() - fault < 0.0;
        let sign = if lower { -1.0 } else { 1.0 };
        ratio - sign * wheel.friction * turn.signum() * turning
    }

    /// One round of bisection over the pulleys.
    fn bisect_each(&mut self) -> Result<(), Failure> {
        (0..self.pulleys().len()).try_for_each(|p| self.bisect(self.pulleys()[p]))
    }

    /// Brings one pulley to rest with the others held: the change of its fault from − to +.
    fn bisect(&mut self, stop: usize) -> Result<(), Failure> {
        let Some(wheel) = self.wheel(stop) else { return Ok(()) };
        let start = self.layout.stops[stop].arc_length;
        let held = if wheel.friction > 0.0 { start - self.slid(stop) } else { start };
        self.try_at(stop, held)?;
        let Some(fault) = self.fault(stop, &wheel) else { return Ok(()) };
        let least = END_CABLE_FRACTION * self.layout.length;
        let limit = if fault < 0.0 {
            self.layout.stops[stop + 1].arc_length - self.layout.stops[stop].lap - least
        } else {
            self.layout.stops[stop - 1].leaves() + least
        };
        // From where friction held it towards the limit; the fault keeps its sign until it rests.
        let (mut near, mut far) = (held, limit);
        self.try_at(stop, limit)?;
        let at_limit = self.fault(stop, &wheel);
        if at_limit.is_some_and(|f| f * fault > 0.0) {
            return self.pass(stop, fault < 0.0);
        }
        for _ in 0..60 {
            let middle = 0.5 * (near + far);
            self.try_at(stop, middle)?;
            match self.fault(stop, &wheel) {
                Some(f) if f * fault > 0.0 => near = middle,
                _ => far = middle,
            }
            if (far - near).abs() <= 1e-6 * self.layout.length {
                break;
            }
        }
        self.try_at(stop, far)
    }

    fn try_at(&mut self, stop: usize, arc_length: f64) -> Result<(), Failure> {
        self.layout.stops[stop].arc_length = arc_length;
        for i in 0..self.ends.len() {
            if self.ends[i].first == stop || self.ends[i].last == stop {
                self.solve_span(i)?;
            }
        }
        self.hang_tails();
        Ok(())
    }

    /// A pulley that wants beyond the stop beside it: past a load the load changes sides, past an
    /// end it runs out.
    fn pass(&mut self, stop: usize, up: bool) -> Result<(), Failure> {
        let other = if up { stop + 1 } else { stop - 1 };
        let inner = other > 0 && other + 1 < self.layout.stops.len();
        if !inner {
            return Err(Failure::RunsOut(stop));
        }
        if self.layout.stops[other].anchors() {
            return Err(Failure::Unbalanced(stop, self.unbalance(stop)));
        }
        let cells = (self.layout.stops[stop].cells, self.layout.stops[other].cells);
        self.layout.stops.swap(stop, other);
        self.held_at.swap(stop, other);
        (self.layout.stops[stop].cells, self.layout.stops[other].cells) = cells;
        let least = 2.0 * END_CABLE_FRACTION * self.layout.length * if up { 1.0 } else { -1.0 };
        let load_at = self.layout.stops[stop].arc_length;
        self.layout.stops[other].arc_length = load_at + least - if up { 0.0 } else { self.layout.stops[other].lap };
        self.ends = self.layout.spans().collect();
        self.spans = vec![Span::default(); self.ends.len()];
        self.warm = false;
        self.solve_spans()
    }
}
