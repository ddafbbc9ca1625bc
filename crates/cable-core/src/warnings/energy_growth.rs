//! Energy grows from nowhere if a cable gains more of it than what moves the cable can have given.
//!
//! With E the kinetic, potential and elastic energy of a cable and W the work of what moves it,
//! friction, impacts and loss only take, so that E − W never rises. E is read from an answer, and
//! from two of them what W can have been at most between them:
//!
//! | what moves it | work at most |
//! |---|---|
//! | a support that is led, or held by a hand | greatest tension of the step, or its reaction if that is greater, times its way |
//! | a change of the unstretched length | greatest tension times the change |
//! | a rise of the bending stiffness | the energy of the bends times that |
//! | a load, wind, current | mean force of both ends of the step times the way, and half of how much it changed times the size of that |
//! | the outline of a robot | its force before and after and the impulse of all contacts, at the greatest speed of the cable |
//!
//! So a cable that a support drives is warned of once it has more energy than the support can have
//! given, and one that nothing drives at once. An unstable integrator multiplies energy without
//! end, and work only grows with the tension, the root of it: both are warned of. E is a figure of
//! an answer and not added up over steps, so its error does not grow with time either.

use std::collections::VecDeque;

use super::Observed;
use crate::math::{Vec2, larger};
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Energy, Warning, WarningCause};

/// Energy growth that is warned of, as a part of the energy exchanged meanwhile. Smaller: errors of
/// the nodes of a solution cause warnings; larger: an unstable motion is shown for longer before
/// its warning.
const GROWTH_LIMIT: f64 = 0.25;

/// Energy growth that is ignored, as a part of the work of the cable's weight and loads over its
/// length. Sagging bars count as straight in E, so that an edit of the mesh changes it; violent
/// scenes reach half of the limit. Smaller: those cause warnings; larger: small motions of long
/// cables may grow unseen.
const MIN_GROWTH_FRACTION: f64 = 3e-4;

/// Length of the moving window, s, whose greatest energy may become the least of the motion; it
/// holds [`RECENT_INSTANTS`] instants at least. Shorter: a velocity that an integrator swings
/// beyond its own for a few steps after an impact and back is growth; longer: growth is warned of
/// later.
const RECENT_S: f64 = 0.05;

/// See [`RECENT_S`].
const RECENT_INSTANTS: usize = 3;

/// Energy that one cable had, and that it has been given since.
#[derive(Clone, Debug, Default)]
pub(super) struct EnergyGrowth {
    before: Option<EnergySnapshot>,
    /// Work done since the motion began at most, J.
    work_j: f64,
    /// Recent times, s, each with energy less work, J.
    recent: VecDeque<[f64; 2]>,
    /// None until an instant is taken in.
    least: Option<EnergyMinimum>,
}

/// The least energy less work of a motion.
#[derive(Clone, Copy, Debug, Default)]
struct EnergyMinimum {
    /// Itself, J.
    energy_j: f64,
    /// The time when it was, s.
    time_s: f64,
    /// Work that had been done, J.
    work_j: f64,
    /// EnergyMinimum and greatest of each form of energy since then, J.
    ranges: [[f64; 2]; 4],
}

/// Observation of a support at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SupportState {
    /// The support holds the cable.
    Holds {
        /// Position, m.
        at: Vec2,
        /// Its own speed, m/s.
        speed: f64,
        /// Size of the force with which it pulls, N.
        force: f64,
    },
    /// It is a load, or has let go.
    Free {
        /// Position, m.
        at: Vec2,
    },
}

impl SupportState {
    fn holds(&self) -> bool {
        matches!(self, Self::Holds { .. })
    }
}

/// Observation of a cable at an instant.
#[derive(Clone, Debug)]
struct EnergySnapshot {
    time_s: f64,
    energy_j: f64,
    breaks: usize,
    supports: Vec<SupportState>,
    /// Position of each load, those at supports first, m.
    loads: Vec<Vec2>,
    /// Unstretched length, m, where it changes.
    unstretched_m: Option<f64>,
    /// Bending stiffness, N·m², and the energy that is stored by it, J.
    bending: [f64; 2],
    /// Time of the account from which the energy of bends is, s; None if it is from the nodes.
    accounted_s: Option<f64>,
    /// Work of edits in that account, J.
    edits_j: Option<f64>,
    /// True if the answer is of a run that accounts for its energy. A first rest is not, and may be
    /// another model's, on other bars: 1.7 J of 8 kJ in a cable drawn tight between posts.
    is_accounted: bool,
    /// Force times way of wind and current if it were from the origin: the place integrated over
    /// the cable, m².
    moment: Vec2,
    /// Size of what the robot's outline pushes with, N.
    outline_force: f64,
    /// Greatest speed of a node, m/s.
    max_speed: f64,
}

impl EnergyGrowth {
    /// Follows the energy, and appends a warning where it has grown from nowhere.
    pub(crate) fn update(&mut self, observed: &Observed<'_>, time_s: f64, out: &mut Vec<Warning>) {
        let (now, forms) = EnergySnapshot::of(observed, time_s);
        let before = self.before.replace(now);
        let Some(now) = &self.before else { return };
        // Without inertia, and where a support let go or the cable broke, it begins anew.
        let goes_on = |b: &EnergySnapshot| {
            let holds = |m: &EnergySnapshot| m.supports.iter().filter(|s| s.holds()).count();
            observed.answer.peaks.is_some()
                && b.time_s < time_s
                && b.breaks == now.breaks
                && holds(b) == holds(now)
                && b.accounted_s.is_some() == now.accounted_s.is_some()
                && b.is_accounted == now.is_accounted
                && b.accounted_s <= now.accounted_s
        };
        match before.filter(goes_on) {
            Some(before) => self.work_j += work(observed, &before, now),
            None => (self.work_j, self.least) = (0.0, None),
        }
        if self.least.is_none() {
            self.recent.clear();
        }
        let left_j = now.energy_j - self.work_j;
        self.recent.push_back([time_s, left_j]);
        while self.recent.len() > RECENT_INSTANTS && self.recent.front().is_some_and(|[t, _]| time_s - t > RECENT_S) {
            self.recent.pop_front();
        }
        let lately = self.recent.iter().fold(f64::NEG_INFINITY, |most, [_, e]| larger(most, *e));
        let Some(least) = self.least.as_mut().filter(|least| !(lately < least.energy_j)) else {
            let ranges = forms.map(|e| [e; 2]);
            self.least = Some(EnergyMinimum { energy_j: lately, time_s, work_j: self.work_j, ranges });
            return;
        };
        for (range, e) in least.ranges.iter_mut().zip(forms) {
            *range = [if e < range[0] { e } else { range[0] }, larger(range[1], e)];
        }
        let grown = left_j - least.energy_j;
        let [kinetic, rest @ ..] = least.ranges;
        let moved = kinetic[1] + rest.iter().map(|[least, most]| most - least).sum::<f64>();
        let problem = observed.problem;
        let limit = GROWTH_LIMIT * moved + MIN_GROWTH_FRACTION * problem.force_scale() * problem.length;
        if grown > limit || grown.is_nan() {
            let since = *least;
            out.push(self.warning(observed, &since, [grown, limit]));
        }
    }

    /// The warning that energy has grown from nowhere, by `grown` over `limit` (J).
    fn warning(&self, observed: &Observed<'_>, since: &EnergyMinimum, [grown, limit]: [f64; 2]) -> Warning {
        let (name, nodes) = (&observed.problem.cable.name, &observed.answer.nodes);
        let speed = |k: usize| nodes.get(k).map_or(0.0, |n| n.vx_m_per_s.hypot(n.vy_m_per_s));
        let fastest = (0..nodes.len()).max_by(|a, b| speed(*a).total_cmp(&speed(*b))).unwrap_or(0);
        let at = nodes.get(fastest).copied().unwrap_or_default();
        let cause = WarningCause::EnergyFromNowhere {
            from_s: since.time_s,
            work_j: self.work_j - since.work_j,
            speed_m_per_s: speed(fastest),
        };
        Warning::new(cause, name, at.arc_length_m, [grown, limit]).at([at.x_m, at.y_m])
    }
}

impl EnergySnapshot {
    /// Of an answer, with the forms of its energy (J): of motion first.
    fn of(observed: &Observed<'_>, time_s: f64) -> (Self, [f64; 4]) {
        let Observed { problem, answer, energy, breaks, .. } = *observed;
        let Energy { mut kinetic_j, mut gravity_j, stretch_j, bending_j } = energy;
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        let mut supports = Vec::with_capacity(problem.supports.len());
        let mut loads = Vec::new();
        for (s, r) in problem.supports.iter().zip(&answer.supports) {
            let at = Vec2::new(r.x_m, r.y_m);
            let holds = !matches!(s.kind, SupportKind::Load | SupportKind::Free) && s.holds_from(time_s);
            let (_, v) = along(answer, r.arc_length_m);
            if holds {
                let led = s.place_at(time_s).map_or(0.0, |(_, v)| v.norm());
                let own = if r.hand.is_some() { v.norm() } else { led };
                let hand = r.hand.map_or(0.0, |h| h.force_n());
                let force = larger(hand, r.reaction_x_n.hypot(r.reaction_y_n));
                supports.push(SupportState::Holds { at, speed: own, force });
            } else {
                kinetic_j += 0.5 * s.mass * v.norm_squared();
                gravity_j -= s.mass * gravity.dot(&at);
                supports.push(SupportState::Free { at });
                loads.push(at);
            }
        }
        loads.extend(problem.loads.iter().map(|l| along(answer, l.arc_length).0));
        let mut moment = Vec2::zeros();
        if problem.wind != crate::problem::TimeSeries::constant(Vec2::zeros()) {
            for pair in answer.pieces().flat_map(|p| p.windows(2)) {
                let [a, b] = pair else { continue };
                moment += (a.at() + b.at()) * (0.5 * (b.arc_length_m - a.arc_length_m));
            }
        }
        let (mut outline_force, mut max_speed) = (0.0, 0.0);
        if let Some(outline) = &problem.outline {
            let by = answer.contacts.iter().filter(|c| c.obstacle == outline.name);
            outline_force = by.map(|c| c.normal_n.abs() + c.friction_n.abs()).sum();
            max_speed = answer.nodes.iter().map(|n| n.vx_m_per_s.hypot(n.vy_m_per_s)).fold(0.0, larger);
        }
        // Sliding nodes carry no moment, but their arcs are bent as much as the corner is round.
        let account = answer.energy_account.as_ref().filter(|_| answer.assumptions.bending_stiffness_n_m2 > 0.0);
        let (accounted_s, edits_j) = (account.map(|account| account.over_s), account.map(|account| account.edits_j));
        let forms = [kinetic_j, gravity_j, stretch_j, account.map_or(bending_j, |account| account.gained.bending_j)];
        let energy_j = forms.iter().sum();
        let breaks = breaks.len();
        let unstretched_m = answer.unstretched_length_m;
        let bending = [answer.assumptions.bending_stiffness_n_m2, bending_j];
        let snapshot = Self {
            time_s,
            energy_j,
            breaks,
            supports,
            loads,
            unstretched_m,
            bending,
            accounted_s,
            edits_j,
            is_accounted: answer.energy_account.is_some(),
            moment,
            outline_force,
            max_speed,
        };
        (snapshot, forms)
    }
}

/// Place (m) and velocity (m/s) of a point of the cable.
fn along(answer: &CableSolution, s: f64) -> (Vec2, Vec2) {
    let nodes = &answer.nodes;
    let v = |k: usize| nodes.get(k).map_or(Vec2::zeros(), |n| Vec2::new(n.vx_m_per_s, n.vy_m_per_s));
    let x = |k: usize| nodes.get(k).map_or(Vec2::zeros(), |n| n.at());
    let k = nodes.partition_point(|n| n.arc_length_m < s).min(nodes.len().saturating_sub(1));
    let Some(j) = k.checked_sub(1) else { return (x(k), v(k)) };
    let arc = |k: usize| nodes.get(k).map_or(0.0, |n| n.arc_length_m);
    let (from, ds) = (arc(j), arc(k) - arc(j));
    let f = if ds > 0.0 { ((s - from) / ds).clamp(0.0, 1.0) } else { 1.0 };
    (x(j) + (x(k) - x(j)) * f, v(j) + (v(k) - v(j)) * f)
}

/// Returns what was done between two instants at most, J.
fn work(observed: &Observed<'_>, before: &EnergySnapshot, now: &EnergySnapshot) -> f64 {
    let Observed { problem, answer, .. } = *observed;
    let (from, to) = (before.time_s, now.time_s);
    let dt = to - from;
    let greatest = super::tension::greatest(answer);
    let length = |snapshot: &EnergySnapshot| snapshot.unstretched_m.unwrap_or(problem.length * problem.thermal_stretch);
    // The bars of a stiff cable push, too.
    let pushes = answer.nodes.iter().map(|n| -n.tension_n).fold(greatest, larger);
    let mut sum = match (before.unstretched_m, now.unstretched_m) {
        (None, None) => 0.0,
        _ => pushes * (length(now) - length(before)).abs(),
    };
    let ([softer, _], [stiffer, stored]) = (before.bending, now.bending);
    if stiffer > softer {
        // The account knows it from the bends of the mesh.
        let accounted = before.edits_j.zip(now.edits_j).map(|(before, now)| now - before);
        sum += larger(accounted.unwrap_or_else(|| stored * (1.0 - softer / stiffer)), 0.0);
    }
    for (s, (a, b)) in problem.supports.iter().zip(before.supports.iter().zip(&now.supports)) {
        use SupportState::Holds;
        let (Holds { at: from_at, speed: u, force: f }, Holds { at: to_at, speed: v, force: g }) = (a, b) else {
            continue;
        };
        let way = larger((to_at - from_at).norm(), larger(*u, *v) * dt);
        let sides = if s.kind == SupportKind::Pulley { 2.0 } else { 1.0 };
        sum += larger(sides * greatest, larger(*f, *g)) * way;
    }
    let free = problem.supports.iter().zip(&now.supports).filter(|(_, s)| !s.holds()).map(|(s, _)| &s.force);
    let forces = free.chain(problem.loads.iter().map(|l| &l.force));
    for (force, (a, b)) in forces.zip(before.loads.iter().zip(&now.loads)) {
        sum += max_work_of_force([force.at(from), force.at(to)], b - a);
    }
    sum += max_work_of_force([problem.wind.at(from), problem.wind.at(to)], now.moment - before.moment);
    if before.outline_force > 0.0 || now.outline_force > 0.0 {
        let impulse = answer.momentum.map_or(0.0, |m| m.contacts_n_s[0].hypot(m.contacts_n_s[1]));
        sum +=
            (larger(before.outline_force, now.outline_force) * dt + impulse) * larger(before.max_speed, now.max_speed);
    }
    sum
}

/// Work (J) of a force (N) that was one and became another over a way (m), at most.
fn max_work_of_force([first, last]: [Vec2; 2], way: Vec2) -> f64 {
    0.5 * ((first + last).dot(&way) + (last - first).norm() * way.norm())
}
