//! This module solves the catenaries between pulleys for given material points σ at the pulleys.
//!
//! With the σ given every stretch is one convex problem (see [`Chain`]), so σ are the only
//! unknowns. The energy of the whole has the gradient (ψ = T + T²/2EA, a after the pulley, b
//! before, p₂ − p₁ across its wheel)
//!
//! ```text
//! ∂E/∂σ = (1 + αΔT)(ψ(T_a) − ψ(T_b)) + b·(p₂ − p₁)
//! ```
//!
//! and each end force changes with σ through the chain's compliance K, λ = (1 + αΔT)(1 + T/EA):
//! dF_a = K⁻¹(λ_a t_a dσ_a − λ_b t_b dσ_b) − b dσ_a, dF_b the same with − b dσ_b. For frictionless
//! pulleys E is minimised, so the equilibrium is stable; pulleys with friction add ln(T_a/T_b) =
//! m·turn, solved by Newton's method. Material passes through points fixed in space, after S.
//! Sueda, G. L. Jones, D. I. W. Levin and D. K. Pai, "Large-scale dynamic simulation of highly
//! constrained strands", *ACM Transactions on Graphics* 30 (2011) 39.

use super::supports_and_loads::{SupportLayout, SupportNode, angle_of};
use super::wheel::traverse_wheel;
use crate::catenary::{Chain, ChainForce};
use crate::math::{Vec2, cross, larger};
use crate::problem::Problem;
use crate::problem::wheel_passage::angle_near;

/// Change of the tension by which the slope of a wheel is read, as a fraction of the tension.
/// Smaller: round-off; larger: the error of a one-sided difference.
const DIFFERENCE_FRACTION: f64 = 1e-6;

/// State of a pulley.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PulleyMode {
    /// Friction holds: σ stays.
    Stick,
    /// Slides with this m = ±μ (0: smooth): ln(T_a/T_b) = m·turn.
    Slip(f64),
}

/// Form of the balance of forces at the pulleys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BalanceForm {
    /// Derivative of the energy, with a symmetric matrix: only without friction.
    Energy,
    /// Logarithm of the slip law.
    SlipLaw,
}

/// The arcs of all wheels after a round of turning them to the cable.
pub(super) struct TurnedArcs {
    pub arcs: Vec<WheelArc>,
    /// Largest error of an angle before it, rad.
    pub error_rad: f64,
    /// A wheel that the cable would leave.
    pub lifted: Option<usize>,
}

impl BalanceForm {
    /// The form for pulleys in these modes.
    pub fn of(modes: &[PulleyMode]) -> Self {
        let is_smooth = modes.iter().all(|m| matches!(m, PulleyMode::Stick | PulleyMode::Slip(0.0)));
        if is_smooth { Self::Energy } else { Self::SlipLaw }
    }
}

/// One pulley's wheel as it stands (all zero for a point).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WheelArc {
    /// Angle of the cable where it arrives, rad.
    pub arrive: f64,
    /// Turn of the cable on it, rad, ≥ 0.
    pub turn: f64,
    /// Angle (rad) of the cable at the mark, the point of the wheel where σ is counted: it is fixed
    /// to the wheel, so a moving tangent point does not move material.
    pub mark: f64,
    /// Unstretched material on the arc, m.
    pub material: f64,
}

/// An end of a cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CableEnd {
    Start,
    End,
}

impl WheelArc {
    /// Material from where the cable arrives to the mark, and from there to where it leaves, m.
    pub fn split(&self, facing: f64) -> (f64, f64) {
        let share = if self.turn > 0.0 { facing * (self.arrive - self.mark) / self.turn } else { 0.5 };
        (share * self.material, (1.0 - share) * self.material)
    }
}

/// A stretch between holds, or a dangling end, with derivatives of its end forces by its end
/// material points.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpanSolution {
    pub from: f64,
    pub to: f64,
    pub start: Vec2,
    pub end: Vec2,
    /// Energy, N·m.
    energy: f64,
    /// ∂(start, end)/∂(from, to).
    d_start: [Vec2; 2],
    d_end: [Vec2; 2],
    pub iterations: usize,
}

/// Everything fixed while σ is sought.
pub(super) struct SlidingProblem<'a> {
    pub problem: &'a Problem,
    pub layout: &'a SupportLayout,
    pub arcs: &'a [WheelArc],
}

/// A state of all stretches.
#[derive(Clone, Debug)]
pub(super) struct SpanSolutions {
    /// n + 1 of them; the first and last are None where the end is held.
    pub all: Vec<Option<SpanSolution>>,
    pub energy: f64,
    pub iterations: usize,
}

impl SlidingProblem<'_> {
    /// The span of material between two arc lengths, m.
    pub fn chain(&self, from: f64, to: f64) -> Chain<'_> {
        Chain {
            from,
            to,
            weight: self.layout.weight,
            axial_stiffness: self.problem.axial_stiffness,
            thermal_stretch: self.problem.thermal_stretch,
            loads: &self.layout.loads,
        }
    }

    fn psi(&self, t: f64) -> f64 {
        self.problem.thermal_stretch * (t + 0.5 * t * t / self.problem.axial_stiffness)
    }

    /// Points where the cable arrives at an anchor and leaves it, m.
    pub fn touches(&self, k: usize) -> (Vec2, Vec2) {
        let (a, arc): (&SupportNode, &WheelArc) = (&self.layout.anchors[k], &self.arcs[k]);
        if a.radius == 0.0 { (a.at, a.at) } else { (a.touch(arc.arrive), a.touch(arc.arrive - a.facing * arc.turn)) }
    }

    /// Solves every stretch for given σ. None where a stretch has no material, or no answer.
    pub fn stretches(&self, sigma: &[f64], near: Option<&SpanSolutions>) -> Option<SpanSolutions> {
        let n = sigma.len();
        let mut out = SpanSolutions { all: Vec::with_capacity(n + 1), energy: 0.0, iterations: 0 };
        for i in 0..=n {
            let split = |k: usize| self.arcs[k].split(self.layout.anchors[k].facing);
            let from = if i == 0 { 0.0 } else { sigma[i - 1] + split(i - 1).1 };
            let to = if i == n { self.problem.length } else { sigma[i] - split(i).0 };
            let near = near.and_then(|s| s.all.get(i).copied().flatten()).map(|s| s.start);
            let stretch = if i == 0 && !self.layout.free[0] || i == n && !self.layout.free[1] {
                None
            } else if !(to > from) {
                return None;
            } else if i == 0 {
                Some(self.dangling(from, to, CableEnd::Start))
            } else if i == n {
                Some(self.dangling(from, to, CableEnd::End))
            } else {
                let (a, b) = (self.touches(i - 1).1, self.touches(i).0);
                Some(self.stretch(from, to, a, b, near)?)
            };
            if let Some(s) = &stretch {
                if !(s.start.iter().chain(s.end.iter()).all(|v| v.is_finite())) {
                    return None;
                }
                out.energy += s.energy;
                out.iterations += s.iterations;
            }
            out.all.push(stretch);
        }
        Some(out)
    }

    /// A stretch between two anchors.
    fn stretch(&self, from: f64, to: f64, a: Vec2, b: Vec2, near: Option<Vec2>) -> Option<SpanSolution> {
        let chain = self.chain(from, to);
        let f: ChainForce = match chain.solve(b - a, near) {
            Ok(f) => f,
            Err(_) => chain.solve(b - a, None).ok()?,
        };
        let stiffness = f.compliance.try_inverse()?;
        let stretch = |force: Vec2| {
            let t = force.norm();
            force * (self.problem.thermal_stretch * (1.0 / t + 1.0 / self.problem.axial_stiffness))
        };
        let (by_from, by_to) = (stiffness * stretch(f.start), stiffness * -stretch(f.end));
        let b_load = self.layout.weight;
        Some(SpanSolution {
            from,
            to,
            start: f.start,
            end: f.end,
            energy: f.end.dot(&(b - a)) - f.complementary - self.layout.load_between(from, to).dot(&a),
            d_start: [by_from - b_load, by_to],
            d_end: [by_from, by_to - b_load],
            iterations: f.iterations,
        })
    }

    /// A dangling start or end: its force is known, F = ∓(loads beyond).
    fn dangling(&self, from: f64, to: f64, end: CableEnd) -> SpanSolution {
        let start = end == CableEnd::Start;
        let load = self.layout.load_between(from, to);
        let b = self.layout.weight;
        let p = if start { self.touches(0).0 } else { self.touches(self.arcs.len() - 1).1 };
        let chain = self.chain(from, to);
        let dead = self.layout.end_force[usize::from(!start)];
        let (f0, f1) = if start { (-dead, -dead - load) } else { (dead + load, dead) };
        // ∫ψ of each catenary in it.
        let complementary: f64 = chain.complementary(f0);
        let zero = Vec2::zeros();
        SpanSolution {
            from,
            to,
            start: f0,
            end: f1,
            energy: -complementary - (load + dead).dot(&p),
            d_start: if start { [zero, zero] } else { [-b, zero] },
            d_end: if start { [zero, -b] } else { [zero, zero] },
            iterations: 0,
        }
    }

    /// Forces before and after anchor k, N.
    pub fn forces(s: &SpanSolutions, k: usize) -> (Option<Vec2>, Option<Vec2>) {
        let side = |i: usize| s.all.get(i).copied().flatten();
        (side(k).map(|s| s.end), side(k + 1).map(|s| s.start))
    }

    /// Returns the turn of the cable at a pulley, rad.
    pub fn turn(&self, k: usize, before: Vec2, after: Vec2) -> f64 {
        if self.layout.anchors[k].radius > 0.0 {
            self.arcs[k].turn
        } else {
            cross(before, after).atan2(before.dot(&after)).abs()
        }
    }

    /// ln of the ratio of the tension after the pulley to the tension that the wheel gives from the
    /// tension before it with friction m, and its derivatives by ln T_b and by ln T_a.
    pub fn excess(&self, k: usize, before: Vec2, after: Vec2, m: f64) -> (f64, f64) {
        let a = &self.layout.anchors[k];
        let (tb, ta) = (before.norm(), after.norm());
        let turn = self.turn(k, before, after);
        let chain = self.chain(0.0, 1.0);
        let arrive = self.arcs[k].arrive;
        let passed = traverse_wheel(&chain, a, tb, arrive, turn, m).tension;
        let slope = if a.radius > 0.0 {
            let d = DIFFERENCE_FRACTION * tb;
            (traverse_wheel(&chain, a, tb + d, arrive, turn, m).tension - passed) / d * tb / passed
        } else {
            1.0
        };
        ((ta / passed).ln(), slope)
    }

    /// Residual of a slipping pulley and its derivatives by σ of the pulley before, itself, and the
    /// one after.
    pub fn row(&self, s: &SpanSolutions, k: usize, m: f64, form: BalanceForm) -> Option<(f64, [f64; 3])> {
        let (b, a) = (s.all.get(k).copied().flatten()?, s.all.get(k + 1).copied().flatten()?);
        let (fb, fa) = (b.end, a.start);
        let (tb, ta) = (fb.norm(), fa.norm());
        // dF_b by (σ_{k−1}, σ_k), dF_a by (σ_k, σ_{k+1}).
        if form == BalanceForm::Energy {
            let e = |t: f64| self.problem.thermal_stretch * (1.0 + t / self.problem.axial_stiffness);
            let (p1, p2) = self.touches(k);
            let r = self.psi(ta) - self.psi(tb) + self.layout.weight.dot(&(p2 - p1));
            let db = |d: Vec2| e(tb) * fb.dot(&d) / tb;
            let da = |d: Vec2| e(ta) * fa.dot(&d) / ta;
            return Some((r, [-db(b.d_end[0]), da(a.d_start[0]) - db(b.d_end[1]), da(a.d_start[1])]));
        }
        let (r, slope) = self.excess(k, fb, fa, m);
        // A point's turn follows the forces: d(turn) = sign·(dθ_a − dθ_b).
        let sign = if self.layout.anchors[k].radius > 0.0 { 0.0 } else { cross(fb, fa).signum() };
        let db = |d: Vec2| slope * fb.dot(&d) / (tb * tb) - m * sign * cross(fb, d) / (tb * tb);
        let da = |d: Vec2| fa.dot(&d) / (ta * ta) - m * sign * cross(fa, d) / (ta * ta);
        Some((r, [-db(b.d_end[0]), da(a.d_start[0]) - db(b.d_end[1]), da(a.d_start[1])]))
    }

    /// Turns each wheel's arc to the directions of the spans, with the mobilised friction `m`.
    pub fn turn_arcs(&self, s: &SpanSolutions, m: impl Fn(usize) -> f64) -> TurnedArcs {
        let (mut worst, mut lifted) = (0.0f64, None);
        let least = self.layout.settings.least_touch_gain;
        let mut out = Vec::with_capacity(self.arcs.len());
        for (k, (a, arc)) in self.layout.anchors.iter().zip(self.arcs).enumerate() {
            let (Some(fb), Some(fa), true) = (Self::forces(s, k).0, Self::forces(s, k).1, a.radius > 0.0) else {
                out.push(*arc);
                continue;
            };
            let leave = arc.arrive - a.facing * arc.turn;
            // Moving the touch point by R dφ along the cable with the material on it turns the
            // cable there by κR dφ: Newton divides by 1 + κR (κ < 0 where cable and wheel bend the
            // same way).
            let step = |force: Vec2, at: f64| {
                let off = angle_near(angle_of(force), at) - at;
                let t = force.norm();
                let lambda = self.problem.thermal_stretch * (1.0 + t / self.problem.axial_stiffness);
                let gain = 1.0 - a.facing * cross(force, self.layout.weight) / (t * t * lambda) * a.radius;
                (off.abs(), off / if gain > least { gain } else { least })
            };
            let ((off1, step1), (off2, step2)) = (step(fb, arc.arrive), step(fa, leave));
            for off in [off1, off2] {
                worst = larger(worst, off);
            }
            let (mut arrive, leave) = (arc.arrive + step1, leave + step2);
            let mut turn = a.facing * (arrive - leave);
            if !(turn >= 0.0) {
                lifted = Some(k);
                arrive = 0.5 * (arrive + leave);
                turn = 0.0;
            }
            let passed = traverse_wheel(&self.chain(0.0, 1.0), a, fb.norm(), arrive, turn, m(k));
            let change = (passed.material - arc.material).abs() / a.radius;
            worst = larger(worst, change);
            out.push(WheelArc { arrive, turn, material: passed.material, ..*arc });
        }
        TurnedArcs { arcs: out, error_rad: worst, lifted }
    }
}
