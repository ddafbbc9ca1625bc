//! A cable with bending stiffness at rest, in the angles of its bars.
//!
//! Bar e of unstretched length l points along t(θₑ); its middle carries the force Fₑ, which follows from the force F₀ at
//! the start of its span as in a flexible cable. Stretch is eliminated (τ = F·t/EA, chord = l(1 + τ)t), so neither a
//! stiff nor an inextensible cable is hard, and a clamp is an angle prescribed exactly:
//! ```text
//! L(θ, F₀) = Σ EI ψ²/2l̄ − Σ l (F·t + (F·t)²/2EA) + Σ F₀·d        stationary: equilibrium and closed spans
//! ∂L/∂θₑ   = bending − l (F·n)(1 + τ)
//! −∂L/∂F₀  = Σ chord − d
//! ```
//! ψ is the turn at a node and l̄ the rest length that belongs to it; between a clamp and the first bar l̄ = l/2. Newton on
//! the whole: θ tridiagonal, two force rows a span by their Schur complement S = BH⁻¹Bᵀ + C. The equilibrium is stable
//! when H and S have the same number of negative directions (Haynsworth's inertia formula). The start is the flexible
//! cable; where Newton fails from there, the bending stiffness is raised in steps. Second order in the bar length.

use nalgebra::{DMatrix, DVector};

use super::answer::Point;
use super::element::Material;
use super::layout::{Layout, Stop};
use super::network::Network;
use crate::linalg::{BandFactor, BandMatrix};
use crate::math::{Vec2, perp};

/// Newton steps at one bending stiffness. Measured: 4 to 12.
const MAX_STEPS: usize = 40;
/// Longest turn of a bar in one step, rad. Larger steps jump to other windings, smaller ones cost steps.
const LONGEST_TURN: f64 = 0.5;
/// Angles and forces are found when a step changes them by less than this.
const STILL: f64 = 1e-11;
/// Tries with other bending stiffnesses on the way to the real one.
const MAX_TRIES: usize = 80;
/// Bars along the boundary layer √(EI/T) at clamps, loads and supports: 8 give the clamp moment to 0.5 %.
const BARS_PER_LAYER: f64 = 8.0;
/// How fast bars may grow away from a boundary layer, m of bar length per m.
const GROWTH: f64 = 0.15;

/// One bar.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bar {
    /// Arc length of its first node and its own, m.
    start: f64,
    ds: f64,
    /// The stretch between stops it lies in.
    stretch: usize,
}

/// A cable with bending stiffness.
#[derive(Clone, Debug)]
pub struct Beam {
    layout: Layout,
    material: Material,
    bending: f64,
    ends: Vec<(usize, usize)>,
    bars: Vec<Bar>,
    angles: Vec<f64>,
    forces: Vec<Vec2>,
    /// Newton steps taken.
    pub steps: usize,
    /// Largest unbalanced force left, N.
    pub residual: f64,
}

/// What a solve found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A stable equilibrium.
    Stable,
    /// An equilibrium it runs away from.
    Unstable,
    /// None.
    Failed,
}

impl Beam {
    /// The bars and angles of a solved flexible cable. `even` bars in each stretch, or graded towards the stops.
    #[must_use]
    pub fn new(network: &Network, bending: f64, even: bool) -> Self {
        let (layout, material) = (network.layout.clone(), network.material);
        let mut beam = Self {
            bars: Vec::new(),
            angles: Vec::new(),
            forces: network.spans.iter().map(|s| s.force).collect(),
            ends: network.ends.clone(),
            layout,
            material,
            bending,
            steps: 0,
            residual: 0.0,
        };
        for k in 0..beam.layout.stops.len().saturating_sub(1) {
            let (start, end) = (beam.layout.stops[k].arc_length, beam.layout.stops[k + 1].arc_length);
            let tension = 0.5 * (network.forces[k][1].norm() + network.forces[k + 1][0].norm());
            let layer = (bending / tension.max(bending / ((end - start) * (end - start)))).sqrt();
            let largest = (end - start) / beam.layout.stops[k].cells as f64;
            let nodes = if even {
                fractions(1.0, 1.0, beam.layout.stops[k].cells)
            } else {
                graded((layer / BARS_PER_LAYER).min(largest), largest, end - start)
            };
            beam.layout.stops[k].cells = nodes.len() - 1;
            for pair in nodes.windows(2) {
                let s = start + (end - start) * pair[0];
                beam.bars.push(Bar { start: s, ds: (end - start) * (pair[1] - pair[0]), stretch: k });
            }
        }
        beam.angles = vec![0.0; beam.bars.len()];
        let middle = beam.middle_forces();
        let mut last = 0.0;
        for (angle, f) in beam.angles.iter_mut().zip(&middle) {
            *angle = nearest_turn(f.y.atan2(f.x), last);
            last = *angle;
        }
        beam.turn_to_clamps();
        beam
    }

    /// The same cable with every bar halved, from the present answer.
    #[must_use]
    pub fn halved(&self) -> Self {
        let mut fine = self.clone();
        fine.bars = self
            .bars
            .iter()
            .flat_map(|b| [Bar { ds: 0.5 * b.ds, ..*b }, Bar { start: b.start + 0.5 * b.ds, ds: 0.5 * b.ds, ..*b }])
            .collect();
        fine.angles = self.angles.iter().flat_map(|&a| [a, a]).collect();
        for stop in &mut fine.layout.stops {
            stop.cells *= 2;
        }
        fine
    }

    /// Number of bars.
    #[must_use]
    pub fn bars(&self) -> usize {
        self.bars.len()
    }

    /// Counts each clamp's angle so that the bar beside it turns least.
    fn turn_to_clamps(&mut self) {
        for k in 0..self.layout.stops.len() {
            if let Some(angle) = self.layout.stops[k].clamp {
                let beside = self.bars.iter().position(|b| b.stretch == k).unwrap_or(self.bars.len().saturating_sub(1));
                self.layout.stops[k].clamp = Some(nearest_turn(angle, self.angles.get(beside).copied().unwrap_or(0.0)));
            }
        }
    }

    /// Tension forces just before and just after every stop, N.
    #[must_use]
    pub fn stop_forces(&self) -> Vec<[Vec2; 2]> {
        let stops = &self.layout.stops;
        let mut out = vec![[Vec2::zeros(); 2]; stops.len()];
        let starts = self.stretch_starts();
        for k in 0..stops.len().saturating_sub(1) {
            out[k][1] = starts[k];
            out[k + 1][0] = starts[k] - self.material.body * (stops[k + 1].arc_length - stops[k].arc_length);
        }
        out
    }

    /// Tension force just after each stop, N: known in hanging ends, from F₀ in spans.
    fn stretch_starts(&self) -> Vec<Vec2> {
        let stops = &self.layout.stops;
        let body = self.material.body;
        let last_anchor = stops.iter().rposition(Stop::anchors).unwrap_or(0);
        let mut out = vec![Vec2::zeros(); stops.len()];
        let mut force = Vec2::zeros();
        for k in 0..stops.len() {
            if let Some(i) = self.ends.iter().position(|e| e.0 == k) {
                force = self.forces[i];
            } else if k == last_anchor {
                let loads: Vec2 = stops[k + 1..].iter().map(|s| s.load).sum();
                force = loads + body * (self.layout.length - stops[k].arc_length);
            } else {
                force -= stops[k].load;
            }
            out[k] = force;
            if let Some(next) = stops.get(k + 1) {
                force -= body * (next.arc_length - stops[k].arc_length);
            }
        }
        out
    }

    fn middle_forces(&self) -> Vec<Vec2> {
        let starts = self.stretch_starts();
        let at = |b: &Bar| b.start + 0.5 * b.ds - self.layout.stops[b.stretch].arc_length;
        self.bars.iter().map(|b| starts[b.stretch] - self.material.body * at(b)).collect()
    }

    fn rest(&self, e: usize) -> f64 {
        self.material.thermal_stretch * self.bars[e].ds
    }

    /// The clamp at the node before bar `e` (e = number of bars: at the end), if there is one.
    fn clamp_before(&self, e: usize) -> Option<f64> {
        let here = self.bars.get(e).map_or(self.layout.stops.len() - 1, |b| b.stretch);
        let first = e == self.bars.len() || e == 0 || self.bars[e - 1].stretch != here;
        if first { self.layout.stops[here].clamp } else { None }
    }

    /// Solves it.
    pub fn solve(&mut self) -> Outcome {
        let start = (self.angles.clone(), self.forces.clone());
        let mut outcome = self.newton(self.bending);
        if outcome == Outcome::Stable {
            return outcome;
        }
        // Up from a softer cable: `part` of the bending stiffness was met last, `factor` is the next rise.
        (self.angles, self.forces) = start;
        let (mut part, mut factor): (f64, f64) = (1e-8, 10.0);
        let mut saved = (self.angles.clone(), self.forces.clone());
        for _ in 0..MAX_TRIES {
            let next = (part * factor).min(1.0);
            outcome = self.newton(self.bending * next);
            if outcome == Outcome::Stable {
                if next >= 1.0 {
                    return outcome;
                }
                (part, factor) = (next, factor * 2.0);
                saved = (self.angles.clone(), self.forces.clone());
            } else {
                (self.angles, self.forces) = saved.clone();
                factor = factor.sqrt().max(1.01);
            }
        }
        outcome
    }

    /// Newton at a bending stiffness.
    fn newton(&mut self, bending: f64) -> Outcome {
        let n = self.bars.len();
        let Ok(mut factor) = BandFactor::new(n, 1) else { return Outcome::Failed };
        let mut h = BandMatrix::new(n, 1);
        let mut before = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let (g, b, c, gap) = self.assemble(bending, &mut h);
            let _ = factor.factor(&h);
            let negative = factor.negative_pivots();
            let solved: Vec<Vec<f64>> = b
                .iter()
                .map(|column| {
                    let mut y = column.clone();
                    factor.solve_in_place(&mut y);
                    y
                })
                .collect();
            let mut hg = g.clone();
            factor.solve_in_place(&mut hg);
            let m = b.len();
            let schur = DMatrix::from_fn(m, m, |i, j| c[(i, j)] + dot(&b[i], &solved[j]));
            let right = DVector::from_fn(m, |i, _| -gap[i] - dot(&b[i], &hg));
            let down =
                if m > 0 { schur.clone().symmetric_eigenvalues().iter().filter(|&&e| !(e > 0.0)).count() } else { 0 };
            let Some(force_step) = (if m > 0 { schur.lu().solve(&right) } else { Some(right) }) else {
                return Outcome::Failed;
            };
            let step: Vec<f64> =
                (0..n).map(|e| -hg[e] - (0..m).map(|j| solved[j][e] * force_step[j]).sum::<f64>()).collect();
            let turn = step.iter().fold(0.0, |a: f64, s| if s.abs() <= a { a } else { s.abs() });
            if !turn.is_finite() {
                return Outcome::Failed;
            }
            let scale = if turn > LONGEST_TURN { LONGEST_TURN / turn } else { 1.0 };
            for (a, s) in self.angles.iter_mut().zip(&step) {
                *a += scale * s;
            }
            let mut change: f64 = 0.0;
            for (i, f) in self.forces.iter_mut().enumerate() {
                let d = Vec2::new(force_step[2 * i], force_step[2 * i + 1]) * scale;
                *f += d;
                change = change.max(d.norm() / (f.norm() + self.material.smoothing));
                self.residual = d.norm();
            }
            self.steps += 1;
            let size = turn.max(change);
            if size <= STILL || (size <= 1e3 * STILL && size > 0.5 * before) {
                return if negative == down { Outcome::Stable } else { Outcome::Unstable };
            }
            before = size;
        }
        Outcome::Failed
    }

    /// Gradient, force columns, C and gaps at the present angles and forces; H into `h`.
    fn assemble(&self, bending: f64, h: &mut BandMatrix) -> (Vec<f64>, Vec<Vec<f64>>, DMatrix<f64>, Vec<f64>) {
        let (n, m) = (self.bars.len(), 2 * self.ends.len());
        let (mut g, mut b, mut c) = (vec![0.0; n], vec![vec![0.0; n]; m], DMatrix::zeros(m, m));
        let mut gap = vec![0.0; m];
        h.clear();
        for (i, &(first, last)) in self.ends.iter().enumerate() {
            let points = (self.layout.stops[first].point(1), self.layout.stops[last].point(0));
            if let (Some(a), Some(z)) = points {
                gap[2 * i] -= z.x - a.x;
                gap[2 * i + 1] -= z.y - a.y;
            }
        }
        let ea = self.material.axial_stiffness;
        for (e, f) in self.middle_forces().iter().enumerate() {
            let l = self.rest(e);
            let t = Vec2::new(self.angles[e].cos(), self.angles[e].sin());
            let (along, across) = (f.dot(&t), f.dot(&perp(t)));
            let tau = along / ea;
            g[e] -= l * across * (1.0 + tau);
            h.add(e, e, l * (along * (1.0 + tau) - across * across / ea));
            let stretch = self.bars[e].stretch;
            if let Some(i) = self.ends.iter().position(|&(first, last)| first <= stretch && stretch < last) {
                let chord = t * (l * (1.0 + tau));
                let turned = -(perp(t) * (1.0 + tau) + t * (across / ea)) * l;
                for r in 0..2 {
                    gap[2 * i + r] += chord[r];
                    b[2 * i + r][e] = turned[r];
                    for s in 0..2 {
                        c[(2 * i + r, 2 * i + s)] += l / ea * t[r] * t[s];
                    }
                }
            }
        }
        for e in 0..=n {
            self.assemble_bend(e, bending, &mut g, h);
        }
        (g, b, c, gap)
    }

    /// Bending at the node before bar `e`.
    fn assemble_bend(&self, e: usize, bending: f64, g: &mut [f64], h: &mut BandMatrix) {
        let n = self.bars.len();
        if let Some(clamp) = self.clamp_before(e) {
            for (bar, g) in g.iter_mut().enumerate().take(e + 1).skip(e.saturating_sub(1)) {
                let k = bending / (0.5 * self.rest(bar));
                *g += k * (self.angles[bar] - nearest_turn(clamp, self.angles[bar]));
                h.add(bar, bar, k);
            }
        } else if e > 0 && e < n {
            let k = bending / (0.5 * (self.rest(e - 1) + self.rest(e)));
            let moment = k * (self.angles[e] - self.angles[e - 1]);
            g[e] += moment;
            g[e - 1] -= moment;
            h.add(e, e, k);
            h.add(e - 1, e - 1, k);
            h.add(e - 1, e, -k);
        }
    }

    /// Curvature at the node before bar `e`, 1/m. At a clamp it is that of the clamp's own moment EI ψ/(l/2), which the
    /// moment balance of the first bar makes second order.
    fn curvature(&self, e: usize) -> f64 {
        let n = self.bars.len();
        if let Some(clamp) = self.clamp_before(e) {
            let (bar, sign) = if e < n { (e, 1.0) } else { (n - 1, -1.0) };
            let turn = sign * (self.angles[bar] - nearest_turn(clamp, self.angles[bar]));
            return turn / (0.5 * self.bars[bar].ds);
        }
        if e == 0 || e == n {
            return 0.0;
        }
        (self.angles[e] - self.angles[e - 1]) / (0.5 * (self.bars[e - 1].ds + self.bars[e].ds))
    }

    /// The direction at the node before bar `e`, rad.
    fn node_angle(&self, e: usize) -> f64 {
        match (self.clamp_before(e), e.checked_sub(1).and_then(|i| self.angles.get(i)), self.angles.get(e)) {
            (Some(clamp), _, _) => clamp,
            (None, Some(before), Some(after)) => {
                let (a, b) = (self.bars[e - 1].ds, self.bars[e].ds);
                (before * b + after * a) / (a + b)
            }
            (None, before, after) => before.or(after).copied().unwrap_or(0.0),
        }
    }

    /// All nodes; `before` and `after` of each hold the tension along the cable there (the shear is left out).
    #[must_use]
    pub fn points(&self) -> Vec<Point> {
        let n = self.bars.len();
        let (middle, forces) = (self.middle_forces(), self.stop_forces());
        let chord = |e: usize| {
            let t = Vec2::new(self.angles[e].cos(), self.angles[e].sin());
            t * (self.rest(e) * (1.0 + middle[e].dot(&t) / self.material.axial_stiffness))
        };
        let first = self.layout.stops.iter().position(Stop::anchors).unwrap_or(0);
        let anchor = self.layout.stops[first].point(0).unwrap_or_default();
        let mut at = (0..n).filter(|&e| self.bars[e].stretch < first).fold(anchor, |p, e| p - chord(e));
        let mut out = Vec::with_capacity(n + 1);
        for e in 0..=n {
            let angle = self.node_angle(e);
            let t = Vec2::new(angle.cos(), angle.sin());
            let stretch = self.bars.get(e).map_or(self.layout.stops.len() - 1, |b| b.stretch);
            let at_stop = e == n || e == 0 || self.bars[e - 1].stretch != stretch;
            let half = self.bars.get(e).map_or(Vec2::zeros(), |b| self.material.body * (0.5 * b.ds));
            let inside = middle.get(e).map_or(Vec2::zeros(), |f| f + half);
            let [before, after] = if at_stop { forces[stretch] } else { [inside; 2] };
            let arc_length = self.bars.get(e).map_or(self.layout.length, |b| b.start);
            if at_stop && let Some(p) = self.layout.stops[stretch].point(0) {
                at = p;
            }
            let curvature = self.curvature(e);
            out.push(Point { arc_length, at, before: t * before.dot(&t), after: t * after.dot(&t), curvature });
            if e < n {
                at += chord(e);
            }
        }
        out
    }

    /// The stops.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `angle` plus the whole turns that bring it nearest to `to`, rad.
fn nearest_turn(angle: f64, to: f64) -> f64 {
    angle + ((to - angle) / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

/// Fractions 0 … 1 of `count` bars whose lengths run with the metric 1/h, h = least + GROWTH·(distance to the nearer
/// end), at most `largest`; all in parts of the stretch.
fn fractions(least: f64, largest: f64, count: usize) -> Vec<f64> {
    let reach = ((largest - least) / GROWTH).clamp(0.0, 0.5);
    let layer = (1.0 + GROWTH * reach / least).ln() / GROWTH;
    let half = layer + (0.5 - reach) / largest;
    let place =
        |m: f64| if m <= layer { ((GROWTH * m).exp() - 1.0) * least / GROWTH } else { reach + (m - layer) * largest };
    (0..=count)
        .map(|k| {
            let m = 2.0 * half * k as f64 / count as f64;
            if m <= half { place(m) } else { 1.0 - place(2.0 * half - m) }
        })
        .collect()
}

/// Bars graded from `least` at both ends of a stretch to at most `largest` (m) inside it.
fn graded(least: f64, largest: f64, length: f64) -> Vec<f64> {
    let (least, largest) = (least / length, largest / length);
    let reach = ((largest - least) / GROWTH).clamp(0.0, 0.5);
    let half = (1.0 + GROWTH * reach / least).ln() / GROWTH + (0.5 - reach) / largest;
    fractions(least, largest, (2.0 * half).ceil() as usize)
}
