//! The pulley balance finds how much cable lies on each side of the pulleys that join the spans.
//!
//! Each span is solved by itself (`span`); the arc lengths `s` at the pulleys couple them. With ρ =
//! ln(T_after/T_before) at a pulley and the bounds of Coulomb's law (capstan: ±μφ, φ the turn):
//! ```text
//! frictionless   ρ = 0
//! stick          s = s_old,      −μφ ≤ ρ ≤ μφ
//! slip           ρ = −μφ where s grew (the cable went to the side before), ρ = +μφ where it shrank
//! ```
//! ρ is the slope of the energy in `s` up to a positive factor, so an equilibrium is stable where
//! ∂ρ/∂s is positive: all pivots of the (tridiagonal) Newton matrix must be positive. If Newton's
//! method stalls or ends at an unstable equilibrium, each pulley in turn is bisected for a change
//! of ρ from − to +, which occurs only at stable ones. Wheels with a radius are in `wheel_arcs`.

use crate::linalg::{TridiagonalRow, solve_tridiagonal};
use crate::math::{Vec2, bounded, larger, perp};
use crate::model::fem::free::element::{Material, turn_between};
use crate::model::fem::free::pulley_state::PulleyState;
use crate::model::fem::free::span;
use crate::model::fem::free::span::{BarSpan, SpanEnd, elements};
use crate::model::fem::free::stations::{Restraint, SpanEnds, StationLayout, Wheel};
use crate::numerics::backtrack;

/// Material that must have passed a pulley for it to slide, as a fraction of the cable's length:
/// round-off. Smaller: the direction of friction changes with it; larger: small slides have none.
const LEAST_SLIDE_FRACTION: f64 = 1e-12;
/// Interval of the material at a pulley that jumps from one balance to another, as a fraction of
/// the cable's length, at which the search for the jump ends. Smaller: more halvings; larger: the
/// cable goes on from farther beyond the jump.
const JUMP_INTERVAL_FRACTION: f64 = 1e-6;
/// Most halvings of that interval; 60 exhaust the digits of an f64.
const JUMP_HALVINGS: usize = 60;

/// Maximum number of Newton steps for all pulleys together. Measured: 3 to 8.
const MAX_STEPS: usize = 40;

/// Maximum number of step lengths that are tried.
const MAX_HALVINGS: usize = 12;
/// Maximum number of rounds of bisection.
const MAX_ROUNDS: usize = 60;
/// Error of ρ below which a pulley is balanced.
const BALANCE_TOLERANCE: f64 = 1e-12;
/// As above if no step makes the error smaller (for a stiff cable ρ has lost its last digits).
const BALANCE_LIMIT: f64 = 1e-8;
/// Fraction of the room to the next station that a step may take.
const STEP_ROOM_FRACTION: f64 = 0.4;
/// Least arc length between a pulley and the next station, as a fraction of the cable.
const END_CABLE_FRACTION: f64 = 1e-7;

/// The reason why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PulleyFailure {
    /// The span that starts at this station could not be solved; with the unbalanced force, N.
    Span(usize, f64),
    /// The cable runs out through the pulley at this station.
    RunsOut(usize),
    /// The balance at the pulley of this station could not be found; with the unbalanced force, N.
    Unbalanced(usize, f64),
    /// The cable leaves its wheel.
    LeavesWheel(usize),
}

/// The cable between its stations.
#[derive(Clone, Debug)]
pub struct PulleyNetwork {
    /// The stations.
    pub layout: StationLayout,
    /// Values that the elements share.
    pub material: Material,
    /// The stations at each span's ends.
    pub ends: Vec<SpanEnds>,
    /// The solved spans, in the order of `ends`.
    pub spans: Vec<BarSpan>,
    /// Tension force just before and just after each station, N.
    pub forces: Vec<[Vec2; 2]>,
    /// Newton steps of all kinds.
    pub steps: usize,
    /// Largest unbalanced force, N.
    pub residual: f64,
    /// Arc length at each station before anything slid (friction remembers it), m.
    unslid_arc_length: Vec<f64>,
    warm: bool,
    /// The friction memory of every pulley, in order; empty until friction begins to remember
    /// (`pulley_state`).
    pub pulley_states: Vec<PulleyState>,
}

/// The law of a pulley at the present forces.
struct PulleyLaw {
    /// ln(T_after/T_before).
    ratio: f64,
    /// Its bounds and its frictionless value: lower, frictionless, upper.
    law: [f64; 3],
}

impl PulleyNetwork {
    /// A network that has not been solved.
    #[must_use]
    pub fn new(layout: StationLayout, material: Material) -> Self {
        let ends: Vec<_> = layout.spans().collect();
        let mut network = Self {
            spans: vec![BarSpan::default(); ends.len()],
            forces: vec![[Vec2::zeros(); 2]; layout.stations.len()],
            unslid_arc_length: layout.stations.iter().map(|s| s.arc_length).collect(),
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

    /// Takes over the forces of a network with the same stations, to start from.
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

    /// Solves all spans and pulleys, with friction measured from where the material was laid.
    ///
    /// # Errors
    /// The reason why there is no answer.
    pub fn solve(&mut self) -> Result<(), PulleyFailure> {
        self.steps = 0;
        let wheels = self.layout.stations.iter().any(|s| matches!(s.restraint, Restraint::Pulley(w) if w.radius > 0.0));
        if wheels {
            self.balance_on_wheels()?
        } else {
            self.balance()?
        }
        self.warm = true;
        Ok(())
    }

    /// Solves the spans for the present arc lengths.
    pub(in crate::model::fem) fn solve_spans(&mut self) -> Result<(), PulleyFailure> {
        self.residual = 0.0;
        for i in 0..self.ends.len() {
            self.solve_span(i)?;
        }
        self.set_free_end_forces();
        Ok(())
    }

    /// Solves span `i` between its present ends and stores its end forces.
    fn solve_span(&mut self, i: usize) -> Result<(), PulleyFailure> {
        let ends = self.ends[i];
        let SpanEnds { first, last } = ends;
        let (Some(a), Some(b)) = (self.layout.stations[first].point(1), self.layout.stations[last].point(0)) else {
            return Err(PulleyFailure::Span(first, f64::NAN));
        };
        let d = b - a;
        let solve = |guess| span::solve(&self.material, &self.layout, ends, d, guess);
        let warm = if self.warm || self.spans[i].steps > 0 { solve(self.spans[i].force) } else { None };
        let guess = span::first_guess(&self.material, &self.layout, ends, d);
        let span =
            warm.or_else(|| solve(guess)).or_else(|| span::solve_folded(&self.material, &self.layout, ends, d, guess));
        let span = span.ok_or(PulleyFailure::Span(first, f64::NAN))?;
        self.steps += span.steps;
        self.residual = larger(self.residual, span.residual);
        self.forces[first][1] = span.force;
        self.forces[last][0] = span.span_response.end_force;
        self.spans[i] = span;
        Ok(())
    }

    /// Sets the forces of the stretches that end free: the loads beyond them.
    fn set_free_end_forces(&mut self) {
        let Some((first, last)) = self.layout.anchored() else { return };
        let end = self.layout.stations.len() - 1;
        self.forces[0][0] = Vec2::zeros();
        self.forces[end][1] = Vec2::zeros();
        if first > 0 {
            let start = -self.layout.stations[0].load;
            self.forces[first][0] =
                elements(&self.material, &self.layout, SpanEnds { first: 0, last: first }, start, |_, _| ());
        }
        if last < end {
            let stations = &self.layout.stations;
            let loads: Vec2 = stations[last + 1..].iter().map(|s| s.load).sum();
            self.forces[last][1] = loads + self.material.body * (stations[end].arc_length - stations[last].leaves());
        }
    }

    /// The pulley at a station.
    pub(in crate::model::fem) fn wheel(&self, station: usize) -> Option<Wheel> {
        match self.layout.stations[station].restraint {
            Restraint::Pulley(w) => Some(w),
            _ => None,
        }
    }

    /// The stations with pulleys.
    pub(in crate::model::fem) fn pulleys(&self) -> Vec<usize> {
        (0..self.layout.stations.len()).filter(|&k| self.wheel(k).is_some()).collect()
    }

    /// The logarithm of the tension ratio at a pulley: its present value, and those with friction
    /// −μ, 0 and μ.
    fn law(&self, station: usize, wheel: &Wheel) -> PulleyLaw {
        let [before, after] = self.forces[station];
        let ratio = (after.norm() / before.norm()).ln();
        if wheel.radius > 0.0 {
            let clockwise = self.clockwise_at(station, wheel);
            let law = [-1.0, 0.0, 1.0].map(|sign| self.log_tension_ratio(wheel, before, clockwise, sign));
            return PulleyLaw { ratio, law };
        }
        let bound = wheel.friction * turn_between(before, after).abs();
        PulleyLaw { ratio, law: [-bound, 0.0, bound] }
    }

    /// Slide of the arc length at a pulley since friction last held, m (the middle of a wheel's
    /// arc).
    fn slid(&self, station: usize) -> f64 {
        self.layout.stations[station].arc_length + 0.5 * self.layout.stations[station].material_on_wheel
            - self.unslid_arc_length[station]
    }

    /// Imbalance at a pulley: 0 if it is balanced, positive if the arc length must shrink. `None`
    /// if friction holds it.
    pub(in crate::model::fem) fn imbalance(&self, station: usize, wheel: &Wheel) -> Option<f64> {
        let b = self.law(station, wheel);
        if !(wheel.friction > 0.0) {
            return Some(b.ratio - b.law[1]);
        }
        let slid = self.slid(station);
        let still = LEAST_SLIDE_FRACTION * self.layout.length;
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
    pub(in crate::model::fem) fn balance(&mut self) -> Result<(), PulleyFailure> {
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
            // If there are several stable equilibria, bisection may find a different one each time;
            // Newton's method stays at one.
            let bisected = self.clone();
            if self.newton(&self.pulleys()) {
                return Ok(());
            }
            *self = bisected;
        }
        let pulleys = self.pulleys();
        let worst = pulleys.iter().copied().find(|&k| self.wheel(k).and_then(|w| self.imbalance(k, &w)).is_some());
        let station = worst.unwrap_or(0);
        Err(PulleyFailure::Unbalanced(station, self.unbalance(station)))
    }

    fn unbalance(&self, station: usize) -> f64 {
        let imbalance = self.wheel(station).and_then(|w| self.imbalance(station, &w)).unwrap_or(0.0);
        imbalance.abs() * self.forces[station][0].norm()
    }

    /// Applies Newton's method to all pulleys; true if they end in a stable equilibrium.
    fn newton(&mut self, pulleys: &[usize]) -> bool {
        let imbalances = |n: &Self| -> Vec<Option<f64>> {
            pulleys.iter().map(|&k| n.wheel(k).and_then(|w| n.imbalance(k, &w))).collect()
        };
        let size = |f: &[Option<f64>]| f.iter().flatten().fold(0.0, |a: f64, b| if b.abs() <= a { a } else { b.abs() });
        let mut now = imbalances(self);
        for _ in 0..MAX_STEPS {
            let (step, stable) = self.newton_step(pulleys, &now);
            if size(&now) <= BALANCE_TOLERANCE {
                self.residual =
                    pulleys.iter().map(|&k| self.unbalance(k)).fold(self.residual, |a, b| if b <= a { a } else { b });
                return stable;
            }
            let from: Vec<f64> = pulleys.iter().map(|&k| self.layout.stations[k].arc_length).collect();
            let better = backtrack(1.0, MAX_HALVINGS, |part| {
                self.move_pulleys(pulleys, &from, &step, part);
                self.steps += 1;
                self.solve_spans().ok()?;
                Some(imbalances(self)).filter(|next| size(next) < size(&now))
            });
            let Some(next) = better else {
                self.move_pulleys(pulleys, &from, &step, 0.0);
                return self.solve_spans().is_ok() && stable && size(&now) <= BALANCE_LIMIT;
            };
            now = next;
        }
        false
    }

    /// Moves every pulley by the fraction `alpha` of its step, within its room, and not beyond the
    /// place where friction held it.
    fn move_pulleys(&mut self, pulleys: &[usize], from: &[f64], step: &[f64], alpha: f64) {
        for (i, &k) in pulleys.iter().enumerate() {
            self.layout.stations[k].arc_length = from[i];
        }
        let mut limited = Vec::with_capacity(pulleys.len());
        for (i, &k) in pulleys.iter().enumerate() {
            let stations = &self.layout.stations;
            let down = STEP_ROOM_FRACTION * (from[i] - stations[k - 1].leaves());
            let up = STEP_ROOM_FRACTION * (stations[k + 1].arc_length - from[i] - stations[k].material_on_wheel);
            let mut move_by = bounded(alpha * step[i], -down, up);
            let slid = self.slid(k);
            let friction = self.wheel(k).is_some_and(|w| w.friction > 0.0);
            if friction && slid * (slid + move_by) < 0.0 {
                move_by = -slid;
            }
            limited.push(from[i] + move_by);
        }
        for (i, &k) in pulleys.iter().enumerate() {
            self.layout.stations[k].arc_length = limited[i];
        }
    }

    /// The Newton step of each pulley's arc length, and whether all pivots are positive.
    pub(in crate::model::fem) fn newton_step(&self, pulleys: &[usize], imbalances: &[Option<f64>]) -> (Vec<f64>, bool) {
        let n = pulleys.len();
        let mut rows: Vec<TridiagonalRow> = vec![[0.0, 1.0, 0.0]; n];
        let mut right: Vec<f64> = imbalances.iter().map(|f| -f.unwrap_or(0.0)).collect();
        for (i, &k) in pulleys.iter().enumerate() {
            let Some(imbalance) = imbalances[i] else { continue };
            let Some(wheel) = self.wheel(k) else { continue };
            let [before, after] = self.forces[k];
            let own = self.rates_at(k, k);
            let rate = |r: [Vec2; 2]| self.imbalance_rate(&wheel, imbalance, [before, after], r);
            rows[i][1] = rate(own);
            if i > 0 {
                rows[i][0] = rate(self.rates_at(k, pulleys[i - 1]));
            }
            if i + 1 < n {
                rows[i][2] = rate(self.rates_at(k, pulleys[i + 1]));
            }
        }
        let mut stable = true;
        let solved = solve_tridiagonal(&rows, &mut right, |pivot| {
            if pivot > 0.0 {
                return Some(pivot);
            }
            stable = false;
            Some(if pivot < 0.0 { -pivot } else { 1.0 })
        });
        (right, stable && solved)
    }

    /// ∂(force before, force after the pulley at station `k`)/∂(arc length at the pulley of station
    /// `of`).
    pub(in crate::model::fem) fn rates_at(&self, k: usize, of: usize) -> [Vec2; 2] {
        let mut rates = [Vec2::zeros(); 2];
        for (span, &ends) in self.spans.iter().zip(&self.ends) {
            let moved = if ends.last == of {
                SpanEnd::Last
            } else if ends.first == of {
                SpanEnd::First
            } else {
                continue;
            };
            if ends.last == k {
                rates[0] += span.force_rates(&self.material, &self.layout, ends, moved)[1];
            }
            if ends.first == k {
                rates[1] += span.force_rates(&self.material, &self.layout, ends, moved)[0];
            }
        }
        if let Some((first, last)) = self.layout.anchored()
            && of == k
        {
            if k == first && first > 0 {
                rates[0] -= self.material.body;
            }
            if k == last && last + 1 < self.layout.stations.len() {
                rates[1] -= self.material.body;
            }
        }
        rates
    }

    /// Change of the imbalance at a pulley when the forces beside it change by `rates`.
    pub(in crate::model::fem) fn imbalance_rate(
        &self,
        wheel: &Wheel,
        imbalance: f64,
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
        // The active bound: the lower one if ρ lies below it or the pulley gave cable to the side
        // before.
        let lower = (after.norm() / before.norm()).ln() - imbalance < 0.0;
        let sign = if lower { -1.0 } else { 1.0 };
        ratio - sign * wheel.friction * turn.signum() * turning
    }

    /// Runs one round of bisection over the pulleys.
    fn bisect_each(&mut self) -> Result<(), PulleyFailure> {
        (0..self.pulleys().len()).try_for_each(|p| self.bisect(self.pulleys()[p]))
    }

    /// Balances one pulley with the others held: finds the change of its imbalance from − to +.
    fn bisect(&mut self, station: usize) -> Result<(), PulleyFailure> {
        let Some(wheel) = self.wheel(station) else { return Ok(()) };
        let start = self.layout.stations[station].arc_length;
        let resting_place = if wheel.friction > 0.0 { start - self.slid(station) } else { start };
        self.try_at(station, resting_place)?;
        let Some(imbalance) = self.imbalance(station, &wheel) else { return Ok(()) };
        let least = END_CABLE_FRACTION * self.layout.length;
        let limit = if imbalance < 0.0 {
            self.layout.stations[station + 1].arc_length - self.layout.stations[station].material_on_wheel - least
        } else {
            self.layout.stations[station - 1].leaves() + least
        };
        // The search goes from where friction held it towards the limit; the imbalance keeps its
        // sign up to the root.
        let (mut near, mut far) = (resting_place, limit);
        self.try_at(station, limit)?;
        let at_limit = self.imbalance(station, &wheel);
        if at_limit.is_some_and(|f| f * imbalance > 0.0) {
            let other = if imbalance < 0.0 { station + 1 } else { station - 1 };
            return self.move_past_station(station, other);
        }
        for _ in 0..JUMP_HALVINGS {
            let middle = 0.5 * (near + far);
            self.try_at(station, middle)?;
            match self.imbalance(station, &wheel) {
                Some(f) if f * imbalance > 0.0 => near = middle,
                _ => far = middle,
            }
            if (far - near).abs() <= JUMP_INTERVAL_FRACTION * self.layout.length {
                break;
            }
        }
        self.try_at(station, far)
    }

    /// Moves a pulley to an arc length (m) and solves the spans beside it.
    fn try_at(&mut self, station: usize, arc_length: f64) -> Result<(), PulleyFailure> {
        self.layout.stations[station].arc_length = arc_length;
        for i in 0..self.ends.len() {
            if self.ends[i].first == station || self.ends[i].last == station {
                self.solve_span(i)?;
            }
        }
        self.set_free_end_forces();
        Ok(())
    }

    /// Handles a pulley whose balance lies beyond the `other` station next to it: a load changes to
    /// the other side; at an end the cable runs out.
    fn move_past_station(&mut self, station: usize, other: usize) -> Result<(), PulleyFailure> {
        let inner = other > 0 && other + 1 < self.layout.stations.len();
        if !inner {
            return Err(PulleyFailure::RunsOut(station));
        }
        if self.layout.stations[other].anchors() {
            return Err(PulleyFailure::Unbalanced(station, self.unbalance(station)));
        }
        let element_count = (self.layout.stations[station].element_count, self.layout.stations[other].element_count);
        self.layout.stations.swap(station, other);
        self.unslid_arc_length.swap(station, other);
        (self.layout.stations[station].element_count, self.layout.stations[other].element_count) = element_count;
        let least = 2.0 * END_CABLE_FRACTION * self.layout.length * if other > station { 1.0 } else { -1.0 };
        let load_at = self.layout.stations[station].arc_length;
        self.layout.stations[other].arc_length =
            load_at + least - if other > station { 0.0 } else { self.layout.stations[other].material_on_wheel };
        self.ends = self.layout.spans().collect();
        self.spans = vec![BarSpan::default(); self.ends.len()];
        self.warm = false;
        self.solve_spans()
    }
}
