//! This module finds the equilibrium of a cable with bending stiffness, with the angles of its
//! tangent as unknowns.
//!
//! The tangent t(θ) is interpolated by quadratic finite elements: an angle at each node and one at
//! the middle of each bar (numbered 2e, 2e + 1, 2e + 2 in bar e). The force F(s) follows from the
//! force F₀ at the start of its span as in a flexible cable. Stretch is eliminated (τ = F·t/EA,
//! dx = (1 + τ)t ds), so neither a stiff nor an inextensible cable is hard, and a clamp is an angle
//! prescribed exactly:
//! ```text
//! L(θ, F₀) = ∫ EI θ'²/2 − (F·t + (F·t)²/2EA) ds + Σ F₀·d        stationary: equilibrium and closed spans
//! ∂L/∂θₐ   = ∫ EI θ' φₐ' − (F·n)(1 + τ) φₐ ds
//! −∂L/∂F₀  = ∫ (1 + τ) t ds − d
//! M(node)  = ± ∂Lₑ/∂θ(node) of the bar beside it                 the moment that balances this bar
//! ```
//! Forces, node positions, node angles and the moments so recovered are of fourth order (G. Strang
//! and G. Fix, *An Analysis of the Finite Element Method*, Prentice-Hall 1973: twice the degree),
//! at three Gauss points a bar. Newton on the whole: θ banded, two force rows a span by their Schur
//! complement S = BH⁻¹Bᵀ + C. The equilibrium is stable when H and S have the same number of
//! negative directions (Haynsworth's inertia formula). The start is the flexible cable; where
//! Newton fails from there, the bending stiffness is raised in steps.

use nalgebra::{DMatrix, DVector};

use crate::linalg::{BandFactor, BandMatrix};
use crate::math::{GAUSS_3, Vec2, larger, perp};
use crate::model::fem::free::beam::mesh::places;
use crate::model::fem::free::element::Material;
use crate::model::fem::free::pulley_balance::PulleyNetwork;
use crate::model::fem::free::stations::{SpanEnds, Station, StationLayout};

/// Newton steps at one bending stiffness. Measured: 4 to 12.
const MAX_STEPS: usize = 40;
/// Greatest turn of a node in one step, rad. Larger: steps jump to other windings; smaller: more
/// steps.
const LONGEST_TURN: f64 = 0.5;
/// Newton's method has converged when a step changes angles (rad) and relative forces by less than
/// this.
pub(in crate::model::fem) const STEP_TOLERANCE: f64 = 1e-11;
/// Maximum number of solves with lower bending stiffnesses on the way to the real one.
const MAX_TRIES: usize = 80;
/// First bending stiffness, as a fraction of the real one, if Newton's method fails from the
/// flexible cable. Smaller: more solves on the way; larger: the first one fails as well. A choice,
/// tuned on no campaign, as are the four below.
const FIRST_STIFFNESS_FRACTION: f64 = 1e-8;
/// First factor by which it is raised. Smaller: more solves; larger: more of them fail.
const FIRST_RISE: f64 = 10.0;
/// Factor of the rise after a solve that was stable. Smaller: more solves; larger: more of them
/// fail.
const RISE_GROWTH: f64 = 2.0;
/// Least rise after solves that failed. Smaller: the tries run out before the whole stiffness is
/// reached; larger: a sharp change of shape is not followed.
const MIN_RISE: f64 = 1.01;
/// Step, in tolerances, up to which an iteration whose steps no longer shrink counts as converged
/// to round-off. Smaller: cables of kilometres fail by their round-off; larger: an iteration that
/// stalls passes for converged.
const STALLED_TOLERANCES: f64 = 1e3;
/// Ratio of successive steps above which they no longer shrink. Smaller: slow convergence passes
/// for round-off; larger: iterations go on in round-off up to the last step.
const STALLED_STEP_FRACTION: f64 = 0.5;
/// 3l ∫φₐ'φ_b' ds of a bar of length l.
pub(in crate::model::fem) const BEND_STIFFNESS_INTEGRALS: [[f64; 3]; 3] =
    [[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]];

/// One bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::fem) struct BeamElement {
    /// Arc length of its first node and its own, m.
    pub(in crate::model::fem) start: f64,
    pub(in crate::model::fem) ds: f64,
    /// The stretch between stations in which it lies.
    pub(in crate::model::fem) stretch: usize,
}

/// A cable with bending stiffness.
#[derive(Clone, Debug)]
pub struct Beam {
    pub(in crate::model::fem) layout: StationLayout,
    pub(in crate::model::fem) material: Material,
    pub(in crate::model::fem) bending: f64,
    pub(super) ends: Vec<SpanEnds>,
    pub(in crate::model::fem) bars: Vec<BeamElement>,
    pub(in crate::model::fem) angles: Vec<f64>,
    /// Prescribed angles: which, and its value, rad.
    clamps: Vec<(usize, f64)>,
    /// Tension force at the start of each span, N.
    pub(super) forces: Vec<Vec2>,
    /// Newton steps taken.
    pub steps: usize,
    /// Largest unbalanced force left, N.
    pub residual: f64,
}

/// The outcome of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamOutcome {
    /// A stable equilibrium.
    Stable,
    /// An unstable equilibrium.
    Unstable,
    /// No equilibrium was found.
    Failed,
}

/// The quadratic shape functions at `x` from 0 to 1.
fn shapes(x: f64) -> [f64; 3] {
    [(1.0 - x) * (1.0 - 2.0 * x), 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)]
}

/// The values of a bar at a Gauss point.
pub(in crate::model::fem) struct GaussPoint {
    pub(in crate::model::fem) shapes: [f64; 3],
    /// Its part of the rest length, m.
    pub(in crate::model::fem) length: f64,
    /// The tangent.
    pub(in crate::model::fem) tangent: Vec2,
    /// Force along the tangent and across it, N.
    pub(in crate::model::fem) along: f64,
    pub(in crate::model::fem) across: f64,
    /// Stretch τ.
    pub(in crate::model::fem) tau: f64,
}

/// The equations of a beam, beside the second derivatives H by the angles.
struct BeamEquations {
    /// Derivatives of the energy by the angles, N m: g.
    gradient: Vec<f64>,
    /// Derivatives of the closure gaps by the angles, a column for each force component, m: B.
    columns: Vec<Vec<f64>>,
    /// Derivatives of the gaps by the forces, m/N: C.
    compliance: DMatrix<f64>,
    /// Closure gaps of the spans, m.
    gap: Vec<f64>,
}

impl Beam {
    /// Makes the bars and angles from a solved flexible cable, with as many bars in each stretch as
    /// `network.layout` has. `body` is its weight and wind, N/m.
    #[must_use]
    pub fn new(network: &PulleyNetwork, bending: f64, body: Vec2) -> Self {
        let layout = network.layout.clone();
        let mut beam = Self {
            bars: Vec::new(),
            angles: Vec::new(),
            clamps: Vec::new(),
            forces: network.spans.iter().map(|s| s.force).collect(),
            ends: network.ends.clone(),
            layout,
            material: network.material,
            bending,
            steps: 0,
            residual: 0.0,
        };
        let weight = network.material.body.norm();
        for k in 0..beam.layout.stations.len().saturating_sub(1) {
            let (station, next) = (&beam.layout.stations[k], &beam.layout.stations[k + 1]);
            let (start, length) = (station.arc_length, next.arc_length - station.arc_length);
            // λ = √(EI/T), limited by its own weight where T goes to zero (λ³ = EI/w), and by the
            // stretch.
            let least = (bending / (length * length)).max((bending * weight * weight).cbrt());
            let layer = |force: Vec2| (bending / force.norm().max(least)).sqrt();
            let layers = [layer(network.forces[k][1]), layer(network.forces[k + 1][0])];
            let nodes = places(layers, length, station.element_count);
            beam.bars.extend(nodes.windows(2).map(|p| BeamElement {
                start: start + p[0],
                ds: p[1] - p[0],
                stretch: k,
            }));
        }
        beam.start_as_flexible();
        beam.material.body = body;
        beam
    }

    /// Sets the angles of the flexible cable, and those of the clamps.
    fn start_as_flexible(&mut self) {
        let starts = self.stretch_starts();
        let n = self.bars.len();
        self.angles = vec![0.0; 2 * n + 1];
        let mut last = 0.0;
        for (e, bar) in self.bars.iter().enumerate() {
            let f = self.force(bar, 0.5, &starts);
            last = nearest_turn(f.y.atan2(f.x), last);
            self.angles[2 * e + 1] = last;
        }
        for v in 0..=n {
            let (a, b) = (2 * v.max(1) - 1, (2 * v + 1).min(2 * n - 1));
            self.angles[2 * v] = 0.5 * (self.angles[a] + self.angles[b]);
        }
        self.turn_to_clamps();
    }

    /// Prescribes each clamp's angle, with the whole turns for which the bar beside it turns least.
    pub(super) fn turn_to_clamps(&mut self) {
        let n = self.bars.len();
        self.clamps.clear();
        for (k, station) in self.layout.stations.iter().enumerate() {
            if let Some(angle) = station.clamp {
                let v = self.bars.iter().position(|b| b.stretch == k).unwrap_or(n);
                let beside = (2 * v + 1).min(2 * n - 1);
                let angle = nearest_turn(angle, self.angles[beside]);
                self.clamps.push((2 * v, angle));
                self.angles[2 * v] = angle;
            }
        }
    }

    /// Turn of the cable from its first clamp to its last, rad.
    pub(super) fn winding(&self) -> f64 {
        self.clamps.last().map_or(0.0, |z| z.1) - self.clamps.first().map_or(0.0, |a| a.1)
    }

    /// Lays the cable along a route (points, m) if that winds otherwise between the clamps than the
    /// flexible cable does: a stiff cable keeps its loops.
    #[must_use]
    pub fn wound_as(mut self, route: &[Vec2]) -> Self {
        let flexible = (self.angles.clone(), self.clamps.clone(), self.winding());
        let legs: Vec<Vec2> = route.windows(2).map(|p| p[1] - p[0]).filter(|d| d.norm() > 0.0).collect();
        let whole: f64 = legs.iter().map(|d| d.norm()).sum();
        let (mut leg, mut way, mut last) = (0, 0.0, 0.0);
        for k in 0..self.angles.len() {
            let bar = self.bars[(k / 2).min(self.bars.len() - 1)];
            let s = bar.start + 0.5 * bar.ds * (k - 2 * (k / 2).min(self.bars.len() - 1)) as f64;
            while leg + 1 < legs.len() && way + legs[leg].norm() < s / self.layout.length * whole {
                way += legs[leg].norm();
                leg += 1;
            }
            let Some(along) = legs.get(leg) else { return self };
            last = nearest_turn(along.y.atan2(along.x), last);
            self.angles[k] = last;
        }
        self.turn_to_clamps();
        if (self.winding() - flexible.2).abs() < std::f64::consts::PI {
            (self.angles, self.clamps) = (flexible.0, flexible.1);
        }
        self
    }

    /// Returns the same cable with every bar halved, at the present shape.
    #[must_use]
    pub fn halved(&self) -> Self {
        let mut fine = self.clone();
        fine.bars = self
            .bars
            .iter()
            .flat_map(|b| {
                [
                    BeamElement { ds: 0.5 * b.ds, ..*b },
                    BeamElement { start: b.start + 0.5 * b.ds, ds: 0.5 * b.ds, ..*b },
                ]
            })
            .collect();
        fine.angles = vec![self.angles[0]];
        for e in 0..self.bars.len() {
            fine.angles.extend([0.25, 0.5, 0.75, 1.0].map(|x| self.angle(e, x)));
        }
        for (place, _) in &mut fine.clamps {
            *place *= 2;
        }
        for station in &mut fine.layout.stations {
            station.element_count *= 2;
        }
        fine
    }

    /// EI/L²: the scale of the forces of bending alone, N.
    #[must_use]
    pub fn bending_force(&self) -> f64 {
        self.bending / (self.layout.length * self.layout.length)
    }

    /// Number of bars.
    #[must_use]
    pub fn bars(&self) -> usize {
        self.bars.len()
    }

    /// The angle in bar `e` at `x` from 0 to 1, rad.
    pub(in crate::model::fem) fn angle(&self, e: usize, x: f64) -> f64 {
        dot(&shapes(x), &self.angles[2 * e..2 * e + 3])
    }

    /// Tension forces just before and just after every station, N.
    #[must_use]
    pub fn station_forces(&self) -> Vec<[Vec2; 2]> {
        let stations = &self.layout.stations;
        let mut out = vec![[Vec2::zeros(); 2]; stations.len()];
        let starts = self.stretch_starts();
        for k in 0..stations.len().saturating_sub(1) {
            out[k][1] = starts[k];
            out[k + 1][0] = starts[k] - self.material.body * (stations[k + 1].arc_length - stations[k].arc_length);
        }
        out
    }

    /// Tension force just after each station, N: in hanging ends from the loads, in spans from F₀.
    pub(in crate::model::fem) fn stretch_starts(&self) -> Vec<Vec2> {
        let stations = &self.layout.stations;
        let body = self.material.body;
        let last_anchor = stations.iter().rposition(Station::anchors).unwrap_or(0);
        let mut out = vec![Vec2::zeros(); stations.len()];
        let mut force = Vec2::zeros();
        for k in 0..stations.len() {
            if let Some(i) = self.ends.iter().position(|e| e.first == k) {
                force = self.forces[i];
            } else if k == last_anchor {
                let loads: Vec2 = stations[k + 1..].iter().map(|s| s.load).sum();
                force = loads + body * (self.layout.length - stations[k].arc_length);
            } else {
                force -= stations[k].load;
            }
            out[k] = force;
            if let Some(next) = stations.get(k + 1) {
                force -= body * (next.arc_length - stations[k].arc_length);
            }
        }
        out
    }

    /// The force in a bar at `x` from 0 to 1, N.
    pub(in crate::model::fem) fn force(&self, bar: &BeamElement, x: f64, starts: &[Vec2]) -> Vec2 {
        starts[bar.stretch]
            - self.material.body * (bar.start + x * bar.ds - self.layout.stations[bar.stretch].arc_length)
    }

    /// Length of bar `e` without tension, at the temperature of the scene, m.
    pub(in crate::model::fem) fn thermal_length(&self, e: usize) -> f64 {
        self.material.thermal_stretch * self.bars[e].ds
    }

    /// Bar `e` at its Gauss points.
    pub(in crate::model::fem) fn samples(&self, e: usize, starts: &[Vec2]) -> [GaussPoint; 3] {
        GAUSS_3.map(|(x, weight)| {
            let angle = self.angle(e, x);
            let t = Vec2::new(angle.cos(), angle.sin());
            let f = self.force(&self.bars[e], x, starts);
            let along = f.dot(&t);
            GaussPoint {
                shapes: shapes(x),
                length: weight * self.thermal_length(e),
                tangent: t,
                along,
                across: f.dot(&perp(t)),
                tau: along / self.material.axial_stiffness,
            }
        })
    }

    /// Finds the equilibrium at the whole bending stiffness.
    pub fn solve(&mut self) -> BeamOutcome {
        let start = (self.angles.clone(), self.forces.clone());
        let mut outcome = self.newton(self.bending);
        if outcome == BeamOutcome::Stable {
            return outcome;
        }
        // Continue from a softer cable: `part` of the bending stiffness was reached last, `factor`
        // is the next rise.
        (self.angles, self.forces) = start;
        let (mut part, mut factor): (f64, f64) = (FIRST_STIFFNESS_FRACTION, FIRST_RISE);
        let mut saved = (self.angles.clone(), self.forces.clone());
        for _ in 0..MAX_TRIES {
            let next = (part * factor).min(1.0);
            outcome = self.newton(self.bending * next);
            if outcome == BeamOutcome::Stable {
                if next >= 1.0 {
                    return outcome;
                }
                (part, factor) = (next, factor * RISE_GROWTH);
                saved = (self.angles.clone(), self.forces.clone());
            } else {
                (self.angles, self.forces) = saved.clone();
                factor = factor.sqrt().max(MIN_RISE);
            }
        }
        outcome
    }

    /// Solves by Newton's method at one bending stiffness (N·m²): the angles by elimination of H,
    /// the forces of the spans by its Schur complement.
    pub(super) fn newton(&mut self, bending: f64) -> BeamOutcome {
        let n = self.angles.len();
        let Ok(mut factor) = BandFactor::new(n, 2) else { return BeamOutcome::Failed };
        let mut h = BandMatrix::new(n, 2);
        let mut before = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let BeamEquations { gradient: g, columns: b, compliance: c, gap } = self.assemble(bending, &mut h);
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
                return BeamOutcome::Failed;
            };
            let step: Vec<f64> =
                (0..n).map(|e| -hg[e] - (0..m).map(|j| solved[j][e] * force_step[j]).sum::<f64>()).collect();
            let turn = step.iter().fold(0.0, |a: f64, s| if s.abs() <= a { a } else { s.abs() });
            if !turn.is_finite() {
                return BeamOutcome::Failed;
            }
            let scale = if turn > LONGEST_TURN { LONGEST_TURN / turn } else { 1.0 };
            for (a, s) in self.angles.iter_mut().zip(&step) {
                *a += scale * s;
            }
            // A cable that is only bent has no tension: then EI/L² is the scale of its forces.
            let least = self.material.smoothing + self.bending_force();
            let mut change = 0.0;
            for (i, f) in self.forces.iter_mut().enumerate() {
                let d = Vec2::new(force_step[2 * i], force_step[2 * i + 1]) * scale;
                *f += d;
                let part = d.norm() / (f.norm() + least);
                change = larger(change, part);
                self.residual = d.norm();
            }
            self.steps += 1;
            let size = turn.max(change);
            if size <= STEP_TOLERANCE
                || (size <= STALLED_TOLERANCES * STEP_TOLERANCE && size > STALLED_STEP_FRACTION * before)
            {
                return if negative == down { BeamOutcome::Stable } else { BeamOutcome::Unstable };
            }
            before = size;
        }
        BeamOutcome::Failed
    }

    /// Assembles the equations at the present angles and forces with a bending stiffness (N·m²),
    /// and H into `h`.
    fn assemble(&self, bending: f64, h: &mut BandMatrix) -> BeamEquations {
        let (n, m) = (self.angles.len(), 2 * self.ends.len());
        let (mut g, mut b, mut c) = (vec![0.0; n], vec![vec![0.0; n]; m], DMatrix::zeros(m, m));
        let mut gap = vec![0.0; m];
        h.clear();
        for (i, &SpanEnds { first, last }) in self.ends.iter().enumerate() {
            let points = (self.layout.stations[first].point(1), self.layout.stations[last].point(0));
            if let (Some(a), Some(z)) = points {
                gap[2 * i] -= z.x - a.x;
                gap[2 * i + 1] -= z.y - a.y;
            }
        }
        let (ea, starts) = (self.material.axial_stiffness, self.stretch_starts());
        for (e, bar) in self.bars.iter().enumerate() {
            let span = self.ends.iter().position(|ends| ends.first <= bar.stretch && bar.stretch < ends.last);
            let stiff = bending / (3.0 * self.thermal_length(e));
            for r in 0..3 {
                g[2 * e + r] += stiff * dot(&BEND_STIFFNESS_INTEGRALS[r], &self.angles[2 * e..2 * e + 3]);
                for s in r..3 {
                    h.add(2 * e + r, 2 * e + s, stiff * BEND_STIFFNESS_INTEGRALS[r][s]);
                }
            }
            for p in self.samples(e, &starts) {
                let (stretched, turning) = (1.0 + p.tau, p.along * (1.0 + p.tau) - p.across * p.across / ea);
                for r in 0..3 {
                    g[2 * e + r] -= p.length * p.across * stretched * p.shapes[r];
                    for s in r..3 {
                        h.add(2 * e + r, 2 * e + s, p.length * turning * p.shapes[r] * p.shapes[s]);
                    }
                }
                let Some(i) = span else { continue };
                let chord = p.tangent * (p.length * stretched);
                let turned = -(perp(p.tangent) * stretched + p.tangent * (p.across / ea)) * p.length;
                for r in 0..2 {
                    gap[2 * i + r] += chord[r];
                    for a in 0..3 {
                        b[2 * i + r][2 * e + a] += turned[r] * p.shapes[a];
                    }
                    for s in 0..2 {
                        c[(2 * i + r, 2 * i + s)] += p.length / ea * p.tangent[r] * p.tangent[s];
                    }
                }
            }
        }
        for &(k, _) in &self.clamps {
            h.pin(k);
            g[k] = 0.0;
            for column in &mut b {
                column[k] = 0.0;
            }
        }
        BeamEquations { gradient: g, columns: b, compliance: c, gap }
    }

    /// The stations.
    #[must_use]
    pub fn layout(&self) -> &StationLayout {
        &self.layout
    }
}

pub(in crate::model::fem) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `angle` plus the whole turns that bring it nearest to `to`, rad.
pub(in crate::model::fem) fn nearest_turn(angle: f64, to: f64) -> f64 {
    angle + ((to - angle) / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_and_their_bending_are_those_of_the_same_parabolas() {
        // 3l ∫φₐ'φ_b' by differences of the shapes at the Gauss points, exact for products of
        // slopes.
        let slope = |x: f64| {
            let (a, b) = (shapes(x - 0.5), shapes(x + 0.5));
            [0, 1, 2].map(|i| b[i] - a[i])
        };
        for a in 0..3 {
            for b in 0..3 {
                let sum: f64 = GAUSS_3.iter().map(|&(x, w)| 3.0 * w * slope(x)[a] * slope(x)[b]).sum();
                assert!((sum - BEND_STIFFNESS_INTEGRALS[a][b]).abs() < 1e-12, "{a} {b}: {sum}");
            }
        }
    }
}
