//! A chain of bars that is let go finds the equilibrium of a stiff cable: the elastica begins there
//! when the contacts are not those of a flexible cable.
//!
//! Bars of rest length l̂ between nodes x, the angle ψ between two of them, weight and loads b,
//! obstacles at gaps g:
//! ```text
//! E(x) = Σ EA (|d| − l̂)²/2l̂ + Σ EI ψ²/2l̄ − Σ b·x        least, with every g ≥ 0
//! ```
//! Newton's method with a resistance to motion that fades as it comes to rest (pseudo-transient
//! continuation: C. Kelley, D. Keyes, *SIAM Journal on Numerical Analysis* 35(2), 1998). Tensions
//! are unknowns of their own: a step turns bars by the tension of the last one, not by what turning
//! has just stretched them, so that EA limits no step. Contacts are those whose gap would close in
//! the step, an active set of a quadratic programme; each mobilises the friction that it is given.
//! Material that the first lay has no room for is paid out on the way. At the end the second
//! derivative of E on the active set is positive definite: what was found is stable.

use crate::contact::Gap;
use crate::contact::pairs::Pair;
use crate::energy::bending::{BendingEnergy, ClampBend, turn};
use crate::energy::{Curvature, Energy};
use crate::linalg::{BandFactor, BandMatrix};
use crate::math::{Mat2, Vec2, larger, perp};
use crate::model::fem::elastica::band::Band;
use crate::model::fem::elastica::flexible_answer::{Curve, mobilised};
use crate::model::fem::free::stations::place as support_place;
use crate::model::fem::newton::initial_guess::{leaning_way, push_chain_out};
use crate::problem::Problem;
use crate::scene::SupportKind;
use crate::solution::{CableSolution, Node};

/// Bars in the bend beside a contact, √(EI/T) with T a third of the weight, or in the cable's
/// length, whichever asks for more up to the most.
const BARS_IN_BEND: f64 = 3.0;
/// See `BARS_IN_BEND`.
const LEAST_BARS: f64 = 150.0;
/// See `BARS_IN_BEND`.
const MOST_BARS: f64 = 500.0;

/// Newton steps. 10 to 20 from a flexible cable, 200 to 600 from a first lay.
const MAX_STEPS: usize = 1200;

/// Steps before anything that is not definite is resisted.
const STEPS_BEFORE_RESISTANCE: usize = 700;

/// Changes of the active set in a step. More: the first steps pay for exactness they do not need.
const MAX_SETS: usize = 8;

/// Changes of the active set in a step in which contacts are let go.
const RELEASE_ROUNDS: usize = 4;

/// Longest turn of a bar in a step, rad.
const LONGEST_TURN: f64 = 0.4;

/// Part by which a bar's rest length grows in a step until all material is paid out.
const PAY_OUT_RATE: f64 = 0.03;

/// Part of the cable's radius that a push of the whole weight presses in. Smaller: numbers lose
/// digits; larger: contacts are found late.
const PENALTY_DEPTH_FRACTION: f64 = 1e-3;

/// Part of the cable's radius by which nothing moves any more.
const MOVE_TOLERANCE: f64 = 1e-5;

/// Times that resistance is raised in a step.
const MOST_RESISTED: usize = 8;

/// A chain that is nearly at rest begins with this part of the first resistance.
const REDUCED_RESISTANCE_FACTOR: f64 = 1e-2;

/// Times that a chain is moved which has come to rest where it could give way.
const MAX_NUDGES: usize = 2;

/// Part of the cable's radius by which it is moved. Less: rounding moves it as far; more: it is put
/// into obstacles.
const PERTURBATION_FRACTION: f64 = 1e-2;

/// Part of the cable's radius by which the first lay is pushed out of obstacles.
const FIRST_CLEARANCE_FRACTION: f64 = 1e-3;

/// Part of the cable's radius by which it may be in an obstacle on its way.
const OVERLAP_LIMIT: f64 = 0.5;

/// Part by which a bar may be shorter than its material in the first lay of a flexible cable. A
/// stiff one has no pockets: more is laid anew.
const POCKET: f64 = 0.5;

/// Bars by which an answer may be elsewhere than the chain that was let go from it. Less: what a
/// coarse chain is off by; more: answers that give way a little are taken for stable.
const STABILITY_DISTANCE_BARS: f64 = 2.0;

/// Half-bandwidth: a node sees two neighbours on each side.
const HALF_BAND: usize = 5;

/// A place of the chain that is near an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPair {
    /// The gap; `fraction` is its place on the bar after `node`.
    pub gap: Gap,
    pub node: usize,
    /// Arc length, m.
    pub arc: f64,
    /// Normal force, N.
    pub push: f64,
    pub active: bool,
    /// Friction along growing arc length over normal force.
    pub mobilised: f64,
}

impl ContactPair {
    /// Nodes with their shares in its place.
    pub fn shares(&self) -> [(usize, f64); 2] {
        [(self.node, 1.0 - self.gap.fraction), (self.node + 1, self.gap.fraction)]
    }
}

/// A chain of bars.
#[derive(Clone, Debug)]
pub(super) struct Chain<'a> {
    pub(super) problem: &'a Problem,
    pub(super) time_s: f64,
    pub(super) body: Vec2,
    pub(super) lay: Option<&'a CableSolution>,
    pub(super) arc: Vec<f64>,
    pub(super) positions: Vec<Vec2>,
    /// Rest lengths of the bars now and when all is paid out, m.
    rest: Vec<f64>,
    whole: Vec<f64>,
    pub(super) tension: Vec<f64>,
    held: Vec<bool>,
    /// Nodes with a direction, and whether the bar after them has it.
    clamps: Vec<(usize, bool, Vec2)>,
    pub(super) load: Vec<Vec2>,
    pub(super) touches: Vec<ContactPair>,
    scale: f64,
    /// Length of a bar, m.
    pub bar: f64,
    pub steps: usize,
    /// True if nothing is left that it could give way to.
    pub stable: bool,
    /// Number of its bars over that of the coarsest chain.
    finer: f64,
}

/// Nodes of the way along which a cable is first laid.
fn first_lay(problem: &Problem) -> Vec<Node> {
    let node = |(s, x): (f64, Vec2)| Node { arc_length_m: s, x_m: x.x, y_m: x.y, ..Node::default() };
    leaning_way(problem).into_iter().map(node).collect()
}

/// True if the material of an answer lies in heaps.
fn has_pockets(problem: &Problem, answer: &CableSolution) -> bool {
    let most = 1e-3 * problem.length;
    answer.nodes.windows(2).any(|p| {
        let ds = p[1].arc_length_m - p[0].arc_length_m;
        ds > most && (p[1].at() - p[0].at()).norm() < POCKET * ds
    })
}

/// A chain at rest from the answer for a flexible cable, or from where it is first laid; None where
/// it finds none.
pub(super) fn relaxed<'a>(
    problem: &'a Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    lay: Option<&'a CableSolution>,
) -> Option<Chain<'a>> {
    let lay = lay.filter(|l| l.nodes.len() > 1 && l.breaks.is_empty() && !has_pockets(problem, l));
    let first = first_lay(problem);
    if first.len() < 2 {
        return None;
    }
    let laid = lay.and_then(|l| Chain::new(problem, time_s, dragged, &Curve::new(&l.nodes), lay, 1.0));
    let mut chain = laid.or_else(|| Chain::new(problem, time_s, dragged, &Curve::new(&first), None, 1.0))?;
    (chain.settle(1.0) && chain.stable).then_some(chain)
}

/// The outcome of a chain that is let go from an answer.
pub(super) enum LetGo<'a> {
    /// It stays.
    Stays,
    /// It runs away, to rest elsewhere.
    Leaves(Box<Chain<'a>>),
    /// It stays, and would not if anything moved it.
    Totters,
    /// The scene has what a chain knows nothing of, or the chain finds no rest.
    Unknown,
}

/// Lets a chain go from an answer for the stiff cable.
pub(super) fn settle_chain<'a>(
    problem: &'a Problem,
    time_s: f64,
    dragged: &[Option<Vec2>],
    answer: &'a CableSolution,
) -> LetGo<'a> {
    let Some(mut chain) = Chain::new(problem, time_s, dragged, &Curve::new(&answer.nodes), Some(answer), 1.0) else {
        return LetGo::Unknown;
    };
    let from = chain.positions.clone();
    if !chain.settle(REDUCED_RESISTANCE_FACTOR) {
        return LetGo::Unknown;
    }
    let near = STABILITY_DISTANCE_BARS * chain.bar;
    let stays = from.iter().zip(&chain.positions).all(|(a, b)| (a - b).norm() <= near);
    match (chain.stable, stays) {
        (true, true) => LetGo::Stays,
        (true, false) => LetGo::Leaves(Box::new(chain)),
        (false, _) => LetGo::Totters,
    }
}

impl<'a> Chain<'a> {
    /// The same with bars of half the length, at rest if it comes to that.
    pub fn halved(&self, dragged: &[Option<Vec2>]) -> Option<(Self, bool)> {
        let nodes = self.nodes();
        let finer = 2.0 * self.finer;
        let mut fine = Self::new(self.problem, self.time_s, dragged, &Curve::new(&nodes), self.lay, finer)?;
        let rests = fine.settle(REDUCED_RESISTANCE_FACTOR);
        Some((fine, rests))
    }

    /// A chain at rest to which a shape leads where it is let go; None where it finds none, or
    /// would not stay.
    pub fn near(problem: &'a Problem, time_s: f64, dragged: &[Option<Vec2>], shape: &[Node]) -> Option<Self> {
        let mut chain = Self::new(problem, time_s, dragged, &Curve::new(shape), None, 1.0)?;
        (chain.settle(REDUCED_RESISTANCE_FACTOR) && chain.stable).then_some(chain)
    }

    /// The chain along a curve: the way of a flexible cable or its first lay. None where the scene
    /// has what this knows nothing of.
    pub fn new(
        problem: &'a Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        curve: &Curve<'_>,
        lay: Option<&'a CableSolution>,
        finer: f64,
    ) -> Option<Self> {
        if problem.outline.is_some() || problem.floor_friction.is_some() || problem.cable.self_contact {
            return None;
        }
        let length = problem.length;
        let body = problem.body_force(time_s);
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        let last = problem.supports.len().checked_sub(1)?;
        // Points of the cable where supports and loads act: place, hold, direction, load.
        let mut stops: Vec<(f64, Option<Vec2>, Option<f64>, Vec2)> = Vec::new();
        for (k, s) in problem.supports.iter().enumerate() {
            if s.kind == SupportKind::Pulley {
                return None;
            }
            let at = support_place(problem, k, time_s, dragged);
            let loaded = matches!(s.kind, SupportKind::Load | SupportKind::Free) || at.is_none();
            let force = if loaded { s.force.at(time_s) + gravity * s.mass } else { Vec2::zeros() };
            let arc = if k == 0 {
                0.0
            } else if k == last {
                length
            } else {
                s.arc_length?
            };
            stops.push((
                arc,
                at.filter(|_| !loaded),
                s.angle.filter(|_| s.kind == SupportKind::Clamped && !loaded),
                force,
            ));
        }
        for l in &problem.loads {
            stops.push((l.arc_length, None, None, l.force.at(time_s)));
        }
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let scale = problem.force_scale();
        let bend = (problem.bending_stiffness / larger(scale / 3.0, 1e-300)).sqrt();
        let count = (BARS_IN_BEND * length / bend).clamp(LEAST_BARS, MOST_BARS) * finer;
        let bar = length / count;
        let mut chain = Self {
            problem,
            time_s,
            body,
            lay,
            arc: vec![0.0],
            positions: Vec::new(),
            rest: Vec::new(),
            whole: Vec::new(),
            tension: Vec::new(),
            held: Vec::new(),
            clamps: Vec::new(),
            load: Vec::new(),
            touches: Vec::new(),
            scale,
            bar,
            steps: 0,
            stable: false,
            finer,
        };
        for pair in stops.windows(2) {
            let (from, to) = (pair[0].0, pair[1].0);
            if to - from > 1e-9 * length {
                let n = ((to - from) / bar).ceil().max(2.0);
                chain.arc.extend((1..=n as usize).map(|i| from + (to - from) * i as f64 / n));
            }
        }
        let n = chain.arc.len();
        chain.positions = chain.arc.iter().map(|&s| curve.at(s).0).collect();
        chain.held = vec![false; n];
        chain.load = vec![Vec2::zeros(); n];
        for (s, at, angle, force) in stops {
            let k = chain.arc.partition_point(|a| *a < s - 1e-9 * length).min(n - 1);
            if let Some(at) = at {
                chain.positions[k] = at;
                chain.held[k] = true;
            }
            if let Some(angle) = angle {
                let t = Vec2::new(angle.cos(), angle.sin());
                chain.clamps.extend(
                    [(k > 0).then_some((k, false, t)), (k + 1 < n).then_some((k, true, t))].into_iter().flatten(),
                );
            }
            chain.load[k] += force;
        }
        for e in 0..n - 1 {
            let ds = chain.arc[e + 1] - chain.arc[e];
            let way = (chain.positions[e + 1] - chain.positions[e]).norm();
            let whole = problem.thermal_stretch * ds;
            chain.whole.push(whole);
            let pull = curve.at(0.5 * (chain.arc[e] + chain.arc[e + 1])).1;
            let fits = whole * (1.0 + pull / problem.axial_stiffness);
            chain.rest.push(if way < (1.0 - PAY_OUT_RATE) * fits { larger(way, 0.05 * whole) } else { whole });
            chain.tension.push(pull);
            for k in [e, e + 1] {
                chain.load[k] += body * (0.5 * ds);
            }
        }
        push_chain_out(
            problem,
            &chain.held,
            &|_, _| false,
            &mut chain.positions,
            FIRST_CLEARANCE_FRACTION * problem.radius,
        );
        (chain.depth(&chain.positions) < OVERLAP_LIMIT * problem.radius).then_some(chain)
    }

    /// Stiffness of contacts, N/m.
    fn stiffness(&self) -> f64 {
        self.scale / (PENALTY_DEPTH_FRACTION * self.problem.radius)
    }

    /// All pairs of chain and obstacles within `reach`, m.
    fn pairs(&self, x: &[Vec2], reach: f64, mut out: impl FnMut(usize, Pair)) {
        let geometry = self.problem.world.geometry();
        for k in 0..x.len() {
            if !self.held[k] {
                let before = k.checked_sub(1).and_then(|k| x.get(k)).copied();
                geometry.node_pairs(before, x[k], x.get(k + 1).copied(), reach, &mut |p| {
                    let at_end = k + 1 == x.len();
                    let fraction = f64::from(u8::from(at_end));
                    out(k - usize::from(at_end), Pair { gap: Gap { fraction, ..p.gap }, ..p });
                });
            }
            if let Some(&b) = x.get(k + 1) {
                geometry.segment_pairs(x[k], b, reach, &mut |p| out(k, p));
            }
        }
    }

    /// Greatest depth of the cable's surface in an obstacle, m.
    fn depth(&self, x: &[Vec2]) -> f64 {
        let mut deepest: f64 = 0.0;
        let world = &self.problem.world;
        let mut look = |p: Vec2| {
            if let Some(g) = world.signed_gap(p, self.bar) {
                deepest = larger(deepest, -g.gap_m);
            }
        };
        x.iter().zip(&self.held).filter(|(_, held)| !**held).for_each(|(p, _)| look(*p));
        for (a, b) in x.iter().zip(x.iter().skip(1)) {
            // A bar may cut off the corner that it is nearest to.
            world.geometry().segment_pairs(*a, *b, self.bar, &mut |p| look(a + (b - a) * p.gap.fraction));
        }
        deepest
    }

    fn find_touches(&mut self) {
        let mut found: Vec<ContactPair> = Vec::with_capacity(self.touches.len());
        let known = std::mem::take(&mut self.touches);
        self.pairs(&self.positions, self.bar, |node, p| {
            if p.weight <= 0.0 {
                return;
            }
            let s = self.arc[node] + (self.arc[node + 1] - self.arc[node]) * p.gap.fraction;
            let from = known.partition_point(|t| t.node + 1 < node);
            let old =
                known[from..].iter().take_while(|t| t.node <= node + 1).filter(|t| t.gap.feature == p.gap.feature);
            let old = old.min_by(|a, b| (a.arc - s).abs().total_cmp(&(b.arc - s).abs()));
            let old = old.filter(|t| (t.arc - s).abs() < 0.5 * self.bar);
            let mobilised = match (old, self.lay) {
                (Some(t), _) => t.mobilised,
                (None, Some(lay)) if p.gap.friction > 0.0 => mobilised(self.problem, lay, p.gap.obstacle, s).0,
                _ => 0.0,
            };
            let push = old.map_or(0.0, |t| t.push);
            let active = p.gap.gap_m < 0.0 || old.is_some_and(|t| t.active);
            found.push(ContactPair { gap: p.gap, node, arc: s, push, active, mobilised });
        });
        self.touches = found;
    }

    /// Lets go; returns whether it comes to rest, in a place that is stable.
    pub fn settle(&mut self, resistance: f64) -> bool {
        let n = self.positions.len();
        let mut matrix = BandMatrix::new(2 * n, HALF_BAND);
        let Ok(mut factor) = BandFactor::new(2 * n, HALF_BAND) else { return false };
        let weight = self.scale / self.problem.length;
        let first = weight / self.bar;
        let mut shift = resistance * first;
        let still = MOVE_TOLERANCE * self.problem.radius;
        let (mut small, mut nudges) = (false, 0);
        for round in 0..MAX_STEPS {
            self.steps += 1;
            let paid = self.pay_out();
            self.find_touches();
            // Near rest the second derivative counts as it is, far from it only what never gives
            // way. Where the first is not definite it gives way too as long as that leads to rest,
            // and is resisted where it does not.
            let (mut found, mut exact) = (None, small);
            for _ in 0..MOST_RESISTED {
                found = self.step(&mut matrix, &mut factor, shift, exact);
                if found.is_some() {
                    break;
                }
                if exact && round < STEPS_BEFORE_RESISTANCE && nudges == 0 {
                    exact = false;
                } else {
                    shift = larger(shift * 8.0, 1e-6 * first);
                }
            }
            let Some((mut step, settled)) = found else {
                small = false;
                continue;
            };
            let (mut moved, mut turned): (f64, f64) = (0.0, 0.0);
            for k in 0..n {
                moved = larger(moved, step[k].norm());
                if k + 1 < n {
                    turned = larger(
                        turned,
                        (step[k + 1] - step[k]).norm() / (self.positions[k + 1] - self.positions[k]).norm(),
                    );
                }
            }
            if !moved.is_finite() {
                return false;
            }
            let mut part = (self.bar / moved).min(LONGEST_TURN / turned).min(1.0);
            let mut next: Vec<Vec2>;
            let mut tries = 0;
            loop {
                next = self.positions.iter().zip(&step).map(|(x, d)| x + d * part).collect();
                if self.depth(&next) < OVERLAP_LIMIT * self.problem.radius {
                    break;
                }
                part *= 0.5;
                tries += 1;
                if tries > 12 {
                    break;
                }
            }
            if tries > 12 {
                shift = larger(shift * 8.0, 1e-6 * first);
                continue;
            }
            step.iter_mut().for_each(|d| *d *= part);
            self.take(&step, part, &next);
            let whole = part == 1.0;
            if whole && paid && settled && moved < still && shift <= 1e-3 * first {
                self.stable = exact;
                if exact || nudges >= MAX_NUDGES {
                    return true;
                }
                // It stands still where it could give way.
                nudges += 1;
                self.nudge(nudges);
                shift = larger(shift, REDUCED_RESISTANCE_FACTOR * first);
            }
            small = paid && whole && moved < 0.2 * self.bar;
            shift *= if whole && moved < 0.5 * self.bar {
                0.4
            } else if part > 0.3 {
                1.0
            } else {
                3.0
            };
            if shift < 1e-9 * first {
                shift = 1e-9 * first;
            }
        }
        false
    }

    /// Moves all nodes a little sideways, in the shape of a wave.
    fn nudge(&mut self, waves: usize) {
        let n = self.positions.len();
        let from = self.positions.clone();
        for k in (1..n - 1).filter(|&k| !self.held[k]) {
            let phase = std::f64::consts::PI * (waves * k) as f64 / n as f64;
            let along = from[k + 1] - from[k - 1];
            self.positions[k] += perp(along)
                * (PERTURBATION_FRACTION * self.problem.radius * phase.sin() / larger(along.norm(), 1e-300));
        }
    }

    /// Lets the bars grow; returns whether they are as long as they are.
    fn pay_out(&mut self) -> bool {
        let mut paid = true;
        for (rest, whole) in self.rest.iter_mut().zip(&self.whole) {
            if *rest < *whole {
                let grown = *rest * (1.0 + PAY_OUT_RATE);
                *rest = if grown < *whole { grown } else { *whole };
                paid &= *rest >= *whole;
            }
        }
        paid
    }

    /// One Newton step with resistance `shift`, N/m²,
    /// and whether the contacts it was taken with are those it ends in.
    fn step(
        &mut self,
        matrix: &mut BandMatrix,
        factor: &mut BandFactor,
        shift: f64,
        exact: bool,
    ) -> Option<(Vec<Vec2>, bool)> {
        let n = self.positions.len();
        let stiff = self.stiffness();
        let mut out = Vec::new();
        let mut changed = false;
        for set in 0..MAX_SETS {
            matrix.clear();
            let mut right = vec![0.0; 2 * n];
            let mut push = |k: usize, f: Vec2| {
                right[2 * k] += f.x;
                right[2 * k + 1] += f.y;
            };
            for (k, load) in self.load.iter().enumerate() {
                push(k, *load);
            }
            self.add_chain(matrix, &mut push, shift, exact);
            for t in self.touches.iter().filter(|t| t.active) {
                let f = (t.gap.normal + self.along(t) * t.mobilised) * (-stiff * t.gap.gap_m);
                let mut k = t.gap.normal * t.gap.normal.transpose() * stiff;
                if exact && t.push > 0.0 {
                    self.add_round(matrix, t, &mut k);
                }
                let shares = t.shares();
                for (i, a) in shares {
                    push(i, f * a);
                    for (j, b) in shares {
                        if i <= j && a * b != 0.0 {
                            matrix.add_block(2 * i, 2 * j, block(&(k * (a * b))));
                        }
                    }
                }
            }
            for k in 0..n {
                if self.held[k] {
                    for i in [2 * k, 2 * k + 1] {
                        matrix.pin(i);
                        right[i] = 0.0;
                    }
                }
            }
            factor.factor(matrix).ok()?;
            if self.touches.iter().any(|t| t.active && t.mobilised != 0.0) {
                self.rubbing(matrix).solve(&mut right).then_some(())?;
            } else {
                factor.solve_in_place(&mut right);
            }
            out = right.chunks_exact(2).map(|d| Vec2::new(d[0], d[1])).collect::<Vec<_>>();
            changed = false;
            for t in &mut self.touches {
                let moved = t.shares().iter().fold(0.0, |m, (k, a)| m + a * out[*k].dot(&t.gap.normal));
                let gap = t.gap.gap_m + moved;
                changed |= t.active != (gap < 0.0);
                // Two that are let go and taken back by turns would go on for ever: later on none
                // is let go.
                t.active = gap < 0.0 || (t.active && set >= RELEASE_ROUNDS);
                // A new contact pushes from the next solution on.
                t.push = if gap < 0.0 { -stiff * gap } else { 0.0 };
            }
            if !changed {
                break;
            }
        }
        Some((out, !changed))
    }

    /// Direction of the bar that a contact is on.
    fn along(&self, t: &ContactPair) -> Vec2 {
        (self.positions[t.node + 1] - self.positions[t.node]).normalize()
    }

    /// The matrix with friction that follows its normal force in the same step: with the force of
    /// the step before, each change of the one changes the other by more where an end is pressed
    /// against a corner, and none is found.
    fn rubbing(&self, matrix: &BandMatrix) -> Band {
        let size = matrix.rows();
        let mut band = Band::new(size, HALF_BAND);
        for i in 0..size {
            for j in i.saturating_sub(HALF_BAND)..(i + HALF_BAND + 1).min(size) {
                band.set(i, j, matrix.get(i, j));
            }
        }
        for t in self.touches.iter().filter(|t| t.active && t.mobilised != 0.0) {
            let k = self.along(t) * t.gap.normal.transpose() * (t.mobilised * self.stiffness());
            let free = |(i, _): &(usize, f64)| !self.held[*i];
            for (i, a) in t.shares().into_iter().filter(free) {
                for (j, b) in t.shares().into_iter().filter(free) {
                    for (r, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        band.add(2 * i + r, 2 * j + c, k[(r, c)] * (a * b));
                    }
                }
            }
        }
        band
    }

    /// Distance of the centre line from a round's centre in touch, m.
    fn offset(&self, gap: &Gap) -> f64 {
        self.problem.world.geometry().body_of(gap.feature).map_or(self.problem.radius, |b| b.offset)
    }

    /// −p ∂²g of a contact that pushes with p: of a node against a round −p/D, of a bar that turns
    /// by φ about a point at distance D and slides along itself by m, −p g = p (Dφ²/2 + φm).
    fn add_round(&self, matrix: &mut BandMatrix, t: &ContactPair, at_node: &mut Mat2) {
        let round = !t.gap.feature.is_multiple_of(2);
        let far = t.gap.gap_m + self.offset(&t.gap);
        let f = t.gap.fraction;
        if round && (f == 0.0 || f == 1.0) {
            let d = perp(t.gap.normal);
            *at_node -= d * d.transpose() * (t.push / far);
        } else if round {
            let (k, d) = (2 * t.node, self.positions[t.node + 1] - self.positions[t.node]);
            let (l, n) = (d.norm(), t.gap.normal);
            let (turns, slides) = ([-n / l, n / l], [d * ((1.0 - f) / l), d * (f / l)]);
            for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                let own = turns[i] * turns[j].transpose() * far;
                let both = turns[i] * slides[j].transpose() + slides[i] * turns[j].transpose();
                matrix.add_block(k + 2 * i, k + 2 * j, block(&((own + both) * t.push)));
            }
        }
    }

    /// Bars, bends and resistance.
    fn add_chain(&self, matrix: &mut BandMatrix, push: &mut impl FnMut(usize, Vec2), shift: f64, exact: bool) {
        let n = self.positions.len();
        let ea = self.problem.axial_stiffness;
        for e in 0..n - 1 {
            let d = self.positions[e + 1] - self.positions[e];
            let l = d.norm();
            let t = d / l;
            let (axial, pull) = (ea / self.rest[e], ea * (l / self.rest[e] - 1.0));
            let turns = if exact { self.tension[e] } else { self.tension[e].max(0.0) } / l;
            let k = t * t.transpose() * (axial - turns) + Mat2::identity() * turns;
            matrix.add_spring(2 * e, [k[(0, 0)], k[(0, 1)], k[(1, 1)]]);
            push(e, t * pull);
            push(e + 1, -t * pull);
        }
        let curvature = if exact { Curvature::Exact } else { Curvature::Clipped };
        let ei = self.problem.bending_stiffness;
        for k in 1..n - 1 {
            if self.clamps.iter().any(|c| c.0 == k) {
                continue;
            }
            let bend = BendingEnergy { stiffness: ei, length: 0.5 * (self.whole[k - 1] + self.whole[k]), from: 0.0 };
            let x = [self.positions[k - 1], self.positions[k], self.positions[k + 1]];
            let (g, h) = (bend.gradient(&x), bend.hessian(&x, curvature));
            for i in 0..3 {
                push(k + i - 1, -g[i]);
                for j in i..3 {
                    matrix.add_block(2 * (k + i - 1), 2 * (k + j - 1), block(&h[i][j]));
                }
            }
        }
        for &(k, after, direction) in &self.clamps {
            let first = if after { k } else { k - 1 };
            let bend = ClampBend { stiffness: ei, length: 0.5 * self.whole[first], direction, from: 0.0 };
            let x = [self.positions[first], self.positions[first + 1]];
            let (g, h) = (bend.gradient(&x), bend.hessian(&x, curvature));
            for i in 0..2 {
                push(first + i, -g[i]);
                for j in i..2 {
                    matrix.add_block(2 * (first + i), 2 * (first + j), block(&h[i][j]));
                }
            }
        }
        for k in 0..n {
            let share = 0.5 * (self.whole[k.saturating_sub(1).min(n - 2)] + self.whole[k.min(n - 2)]);
            matrix.add(2 * k, 2 * k, shift * share);
            matrix.add(2 * k + 1, 2 * k + 1, shift * share);
        }
    }

    fn take(&mut self, step: &[Vec2], part: f64, next: &[Vec2]) {
        for e in 0..self.rest.len() {
            let d = self.positions[e + 1] - self.positions[e];
            let l = d.norm();
            let longer = (step[e + 1] - step[e]).dot(&d) / (l * part);
            let pull = self.problem.axial_stiffness * ((l + longer) / self.rest[e] - 1.0);
            self.tension[e] += part * (pull - self.tension[e]);
        }
        self.positions.copy_from_slice(next);
    }

    /// Curvatures at all nodes, 1/m of unstretched length.
    pub fn bends(&self) -> Vec<f64> {
        let n = self.positions.len();
        let mut bends = vec![0.0; n];
        for k in 1..n - 1 {
            let psi = turn(self.positions[k] - self.positions[k - 1], self.positions[k + 1] - self.positions[k]);
            bends[k] = psi / (0.5 * (self.arc[k + 1] - self.arc[k - 1]));
        }
        for &(k, after, t) in &self.clamps {
            let first = if after { k } else { k - 1 };
            let d = self.positions[first + 1] - self.positions[first];
            let psi = if after { turn(t, d) } else { turn(d, t) };
            bends[k] = psi / (0.5 * (self.arc[first + 1] - self.arc[first]));
        }
        bends
    }

    /// Its nodes as an answer: places, tensions and bends.
    pub fn nodes(&self) -> Vec<Node> {
        let n = self.positions.len();
        let bends = self.bends();
        let pull = |k: usize| 0.5 * (self.tension[k.saturating_sub(1)] + self.tension[k.min(n - 2)]);
        (0..n)
            .map(|k| Node {
                arc_length_m: self.arc[k],
                x_m: self.positions[k].x,
                y_m: self.positions[k].y,
                tension_n: pull(k),
                curvature_per_m: bends[k],
                ..Node::default()
            })
            .collect()
    }

    /// The contacts that push, in order along the cable.
    pub fn pushes(&self) -> Vec<ContactPair> {
        let least = 1e-7 * self.scale;
        let mut out: Vec<ContactPair> = self.touches.iter().filter(|t| t.active && t.push > least).copied().collect();
        out.sort_by(|a, b| a.arc.total_cmp(&b.arc));
        out
    }
}

fn block(k: &Mat2) -> [[f64; 2]; 2] {
    [[k[(0, 0)], k[(0, 1)]], [k[(1, 0)], k[(1, 1)]]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::solution::CableSolution;

    fn problem(text: &str) -> Result<Problem, Box<dyn std::error::Error>> {
        let scene = Scene::from_toml(text)?;
        let first = crate::problem::problems(&scene)?.into_iter().next().ok_or("no cable")?;
        Ok(Problem::clone(&first))
    }

    /// A weightless strut of 2 m between hinges, pressed by `part` of its critical force π²EI/L².
    fn strut(part: f64) -> Result<(Problem, CableSolution), Box<dyn std::error::Error>> {
        let (ei, ea, l) = (1.0, 1e4, 2.0);
        let pull = -part * std::f64::consts::PI.powi(2) * ei / (l * l);
        let way = l * (1.0 + pull / ea);
        let p = problem(&format!(
            "version = 1\n[environment]\ngravity_m_per_s2 = 0.0\n[[cables]]\nname = \"c\"\nlength_m = {l}\ndiameter_m = 0.02\n\
             linear_density_kg_per_m = 1.0\naxial_stiffness_n = {ea:e}\nbending_stiffness_n_m2 = {ei}\n\
             service_tension_n = 1e9\nbreaking_tension_n = 1e9\n\
             [[cables.supports]]\nname = \"a\"\nkind = \"fixed\"\nat_m = [0.0, 1.0]\n\
             [[cables.supports]]\nname = \"b\"\nkind = \"fixed\"\nat_m = [{way:.12}, 1.0]\n"
        ))?;
        let node = |s: f64| Node { arc_length_m: s, x_m: s * way / l, y_m: 1.0, tension_n: pull, ..Node::default() };
        Ok((p, CableSolution { nodes: vec![node(0.0), node(l)], ..CableSolution::default() }))
    }

    /// Euler's strut: straight it stays below its critical force, and leaves above.
    #[test]
    fn a_strut_buckles_at_its_critical_force() -> Result<(), Box<dyn std::error::Error>> {
        for (part, stays) in [(0.5, true), (0.98, true), (1.02, false), (2.0, false)] {
            let (problem, straight) = strut(part)?;
            let mut chain =
                Chain::new(&problem, 0.0, &[None, None], &Curve::new(&straight.nodes), Some(&straight), 1.0)
                    .ok_or("no chain")?;
            assert!(chain.settle(REDUCED_RESISTANCE_FACTOR), "{part}");
            let off = chain.positions.iter().map(|x| (x.y - 1.0).abs()).fold(0.0, larger);
            assert!(chain.stable, "{part}");
            assert_eq!(off < 1e-9, stays, "{part} of the critical force: {off} m aside");
        }
        Ok(())
    }
}
