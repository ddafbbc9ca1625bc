//! This module computes one piece of cable under a uniform load as a function of the force at its
//! start.
//!
//! In the frame whose second axis points against the load (load per length w ≥ 0) the force along
//! the piece is F(s) = (h, v + w s), s from 0 to l, T = |F|. With ε = 1/EA:
//!
//! ```text
//! energy  φ  = ∫ T + ε T²/2 ds                                   (complementary, convex in (h, v))
//! x = ∂φ/∂h  = h (ε l + q),            q = ∫ ds/T = (asinh(v_b/h) − asinh(v_a/h))/w
//! z = ∂φ/∂v  = ε l (v_a + v_b)/2 + l σ,                          σ = (v_a + v_b)/(T_a + T_b)
//! Hessian    = ε l I + ∫ (I − t tᵀ)/T ds = ε l I + [q − c, k; k, c],
//!         c  = (v_b/T_b − v_a/T_a)/w,  k = −h l σ/(T_a T_b)
//! ```
//!
//! Each is written in a form without cancellation, from T_b − T_a = w l σ. With r = w l/(T_a +
//! T_b), which goes from taut (r → 0) to folded (r → 1),
//!
//! ```text
//! asinh(v_b/h) − asinh(v_a/h) = 2 atanh r
//! v_b T_b − v_a T_a           = w l (T_b + v_a σ)
//! v_b T_a − v_a T_b           = w l (T_a − v_a σ) = w l (T_b − v_b σ)
//! q₀ − c                      = l (v_a + v_b)(v_a T_b + v_b T_a)/((T_a + T_b)² T_a T_b),   q₀ = 2 l/(T_a + T_b)
//! ```
//!
//! Nothing divides by w, so a weightless piece is no special case.

use crate::numerics::{ARMIJO_FRACTION, backtrack};

/// Least tension of the guess of a plumb slack span, in units of the weight. Smaller: the guess has
/// no horizontal force at all, and the first step overshoots; larger: more steps.
const LEAST_PLUMB_GUESS: f64 = 0.05;
/// Least square of the parameter λ of a slack guess. Smaller: a taut span begins at an infinite
/// tension; larger: nearly taut spans begin too slack.
const LEAST_GUESS_SQUARE: f64 = 1e-8;

/// Above this r the area tangent loses digits to 1 − r and logarithms are used. At 0.3 the
/// logarithms would lose as many to their difference; anything between 0.5 and 0.9 gives the same
/// results to 2e-16.
const LOG_FORM_FROM: f64 = 0.7;
/// Below this r the series of atanh(r)/r to r¹⁴ is exact to round-off: the next term is r¹⁶/17.
const SERIES_FORM_BELOW: f64 = 0.1;
/// Smallest force that is distinguished from zero (relative to the caller's unit): keeps logarithms
/// finite at a fold.
const MIN_FORCE: f64 = 1e-300;

/// The piece: load per length, length, 1/EA, in any consistent units.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChainPiece {
    /// Load per length, ≥ 0.
    pub w: f64,
    /// Length.
    pub l: f64,
    /// 1/EA.
    pub eps: f64,
}

/// φ, its gradient and its Hessian.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DualEnergy {
    pub phi: f64,
    pub x: f64,
    pub z: f64,
    pub k11: f64,
    pub k12: f64,
    pub k22: f64,
}

/// √(h² + v²), kept off zero.
#[inline]
fn tension(h: f64, v: f64) -> f64 {
    let t = (h * h + v * v).sqrt();
    if t < MIN_FORCE { MIN_FORCE } else { t }
}

/// A piece and its derivatives under a force at its start.
struct EndForces {
    va: f64,
    vb: f64,
    ta: f64,
    tb: f64,
    /// σ.
    sigma: f64,
    /// The values q₀ and q − q₀.
    q: (f64, f64),
}

impl EndForces {
    #[inline]
    fn q(&self) -> f64 {
        self.q.0 + self.q.1
    }
}

impl ChainPiece {
    /// Tensions at both ends for the horizontal force `h` and the vertical force at the start `va`,
    /// with the series or logarithm that suits the sag.
    #[inline]
    fn end_forces(&self, h: f64, va: f64) -> EndForces {
        let vb = va + self.w * self.l;
        let (ta, tb) = (tension(h, va), tension(h, vb));
        let inverse = 1.0 / (ta + tb);
        let r = self.w * self.l * inverse;
        let first = 2.0 * self.l * inverse;
        let more = if r <= SERIES_FORM_BELOW {
            let s = r * r;
            let more = 1.0 / 9.0 + s * (1.0 / 11.0 + s * (1.0 / 13.0 + s / 15.0));
            first * s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * more)))
        } else if r <= LOG_FORM_FROM {
            (2.0 * r / (1.0 - r)).ln_1p() / self.w - first
        } else {
            // r > 0.7 leaves |v_a| + |v_b| < 1.43 w l: at most one of the sums below is small,
            // never both.
            let a = if h.abs() < MIN_FORCE { MIN_FORCE } else { h.abs() };
            let log = if va >= 0.0 {
                ((tb + vb) / (ta + va)).ln()
            } else if vb <= 0.0 {
                ((ta - va) / (tb - vb)).ln()
            } else {
                ((tb + vb) / a).ln() + ((ta - va) / a).ln()
            };
            log / self.w - first
        };
        EndForces { va, vb, ta, tb, sigma: (va + vb) * inverse, q: (first, more) }
    }

    /// Displacement from start to end in the frame of the load.
    #[inline]
    pub fn displacement(&self, h: f64, va: f64) -> (f64, f64) {
        let p = self.end_forces(h, va);
        (h * (self.eps * self.l + p.q()), self.l * (0.5 * self.eps * (p.va + p.vb) + p.sigma))
    }

    /// ∫ T ds = ½ (l (T_b + v_a σ) + h² q).
    #[inline]
    fn pull(&self, h: f64, p: &EndForces) -> f64 {
        0.5 * (self.l * (p.tb + p.va * p.sigma) + h * h * p.q())
    }

    /// Stretched length l + ε ∫ T ds.
    pub fn stretched(&self, h: f64, va: f64) -> f64 {
        self.l + self.eps * self.pull(h, &self.end_forces(h, va))
    }

    /// ∫ T² ds = l (h² + (v_a² + v_a v_b + v_b²)/3).
    #[inline]
    fn squared(&self, h: f64, va: f64) -> f64 {
        let vb = va + self.w * self.l;
        self.l * (h * h + (va * va + va * vb + vb * vb) / 3.0)
    }

    /// φ, gradient, Hessian.
    #[inline]
    pub fn energy(&self, h: f64, va: f64) -> DualEnergy {
        let p = self.end_forces(h, va);
        let el = self.eps * self.l;
        let EndForces { va, vb, ta, tb, sigma, .. } = p;
        let both = self.l / (ta * tb);
        // T_a − v_a σ, all of its terms positive: with T − |v| = h²/(T + |v|) where the signs are
        // equal.
        let level = if va >= 0.0 {
            let (a, b) = (1.0 / (ta + va), 1.0 / (tb + vb));
            h * h * (a + va * (a + b) / (ta + tb))
        } else if vb <= 0.0 {
            let (a, b) = (1.0 / (ta - va), 1.0 / (tb - vb));
            h * h * (b - vb * (a + b) / (ta + tb))
        } else if sigma >= 0.0 {
            ta - va * sigma
        } else {
            tb - vb * sigma
        };
        let rest = (va * tb + vb * ta) / (ta + tb);
        DualEnergy {
            phi: self.pull(h, &p) + 0.5 * self.eps * self.squared(h, va),
            x: h * (el + p.q()),
            z: self.l * (0.5 * self.eps * (va + vb) + sigma),
            k11: el + (both * sigma * rest + p.q.1),
            k12: -h * sigma * both,
            k22: el + both * level,
        }
    }
}

/// Maximum number of Newton iterations: the widest tested grid needs 14, and a failure is not cured
/// by more.
const MAX_ITERATIONS: usize = 60;
/// Maximum number of halvings of one step: 2⁻⁴⁰ of a Newton step is round-off.
const MAX_HALVINGS: usize = 40;
/// Predicted decrease, as a fraction of the energy, below which it is lost in round-off, and a
/// smaller gradient counts as progress instead. Smaller: the search stalls a few digits short.
/// Larger: a step that climbs may pass.
const ENERGY_NOISE: f64 = 1e-10;
/// Least ratio of a force that must stay positive to its value before a step. Smaller is no faster.
const MIN_FORCE_RATIO: f64 = 0.1;
/// Wanted closure error, relative to the lengths involved.
const CLOSURE_TOLERANCE: f64 = 4.0 * f64::EPSILON;
/// Relative closure error that is accepted if round-off allows no better (stiff, nearly taut
/// spans).
const ACCEPTED_CLOSURE: f64 = 1e-11;

/// The result of a Newton iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minimum {
    /// Force at the start, frame of the load.
    pub h: f64,
    /// Force at the start, frame of the load.
    pub v: f64,
    /// Iterations.
    pub iterations: usize,
    /// Remaining closure error, in the unit of the lengths.
    pub closure: f64,
    /// True if the closure is acceptable.
    pub converged: bool,
}

/// The sign of a horizontal force, if it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HorizontalForce {
    /// It may have either sign.
    Any,
    /// It is positive: a single span whose ends are apart sideways.
    Positive,
}

/// Minimises φ(h, v) − (h, v)·`chord` by Newton with Armijo's line search.
///
/// `lengths` is the scale of lengths (for round-off).
pub(super) fn minimise(
    energy: impl Fn(f64, f64) -> DualEnergy,
    chord: [f64; 2],
    start: [f64; 2],
    lengths: f64,
    sign: HorizontalForce,
) -> Minimum {
    let [mut h, mut v] = start;
    let mut e = energy(h, v);
    let (mut gx, mut gz) = (e.x - chord[0], e.z - chord[1]);
    let mut iterations = 0;
    loop {
        let closure = gx.abs() + gz.abs();
        let end = move |converged| Minimum { h, v, iterations, closure, converged };
        if closure <= CLOSURE_TOLERANCE * lengths {
            return end(true);
        }
        let det = e.k11 * e.k22 - e.k12 * e.k12;
        let (ph, pv) = ((e.k12 * gz - e.k22 * gx) / det, (e.k12 * gx - e.k11 * gz) / det);
        if iterations == MAX_ITERATIONS || !(ph.is_finite() && pv.is_finite()) {
            return end(closure <= ACCEPTED_CLOSURE * lengths);
        }
        iterations += 1;
        let slope = gx * ph + gz * pv;
        let value = e.phi - h * chord[0] - v * chord[1];
        let changes_sign = sign == HorizontalForce::Positive && h + ph < MIN_FORCE_RATIO * h;
        let longest = if changes_sign { (1.0 - MIN_FORCE_RATIO) * h / -ph } else { 1.0 };
        let next = backtrack(longest, MAX_HALVINGS, |alpha| {
            let (hn, vn) = (h + alpha * ph, v + alpha * pv);
            let en = energy(hn, vn);
            let (gxn, gzn) = (en.x - chord[0], en.z - chord[1]);
            let decrease = en.phi - hn * chord[0] - vn * chord[1] - value;
            let in_noise = -slope * alpha <= ENERGY_NOISE * (e.phi.abs() + value.abs());
            if decrease <= ARMIJO_FRACTION * alpha * slope || (in_noise && gxn.abs() + gzn.abs() < closure) {
                return Some(Some((hn, vn, en, gxn, gzn)));
            }
            // Halving a Newton step reduces any gradient above round-off.
            let is_exhausted = in_noise && closure <= ACCEPTED_CLOSURE * lengths;
            is_exhausted.then_some(None)
        });
        match next.flatten() {
            Some(next) => (h, v, e, gx, gz) = next,
            None => return end(closure <= ACCEPTED_CLOSURE * lengths),
        }
    }
}

/// First guess of the horizontal and the vertical force at the start of a single piece, in units of
/// its weight; `eps` is weight over EA. Lengths are in units of the piece: its chord has dx ≥ 0.
pub(super) fn guess([dx, dz]: [f64; 2], eps: f64) -> (f64, f64) {
    let chord = (dx * dx + dz * dz).sqrt();
    let t = parabola_tension([dx, chord], eps);
    if t > LEAST_PARABOLA_TENSION_WEIGHTS {
        return (t * dx / chord, t * dz / chord - 0.5);
    }
    // Slack: the inextensible catenary of the length the hanging cable has, √(l² − z²) = 2a
    // sinh(x/2a), λ = x/2a from sinh λ/λ = y.
    let l = 1.0 + SLACK_GUESS_STRAIN * eps;
    let z = dz / l;
    if dx <= f64::MIN_POSITIVE || z.abs() >= 1.0 {
        return (t.max(LEAST_PLUMB_GUESS) * dx / chord.max(f64::MIN_POSITIVE), vertical(dz, eps));
    }
    let y = ((1.0 - z) * (1.0 + z)).sqrt() * l / dx;
    let lambda = if y < MAX_SERIES_SLACK_RATIO {
        (6.0 * (y - 1.0)).max(LEAST_GUESS_SQUARE).sqrt()
    } else {
        let ln = (2.0 * y).ln();
        ln + ln.ln()
    };
    (0.5 * dx / (lambda + 0.5 * eps * dx), 0.5 * (z / lambda.tanh() - 1.0))
}

/// Tension of a nearly taut piece as [`guess`] has it, in units of its weight: elastic stretch and
/// the excess of a flat parabola make up the difference of length and chord c, εT = (c − 1) +
/// p²/24T², with p the load across the chord. It has one positive root, found by Newton's method
/// from above.
fn parabola_tension([dx, chord]: [f64; 2], eps: f64) -> f64 {
    let p2 = if chord > 0.0 { (dx / chord) * (dx / chord) / 24.0 } else { 0.0 };
    let slack = 1.0 - chord;
    let mut t = if slack > 0.0 {
        let rigid = (p2 / slack).sqrt();
        if eps > 0.0 { rigid.min((p2 / eps).cbrt()) } else { rigid }
    } else if eps > 0.0 {
        -slack / eps + (p2 / eps).cbrt()
    } else {
        (p2 / (24.0 * f64::EPSILON)).sqrt()
    };
    if eps > 0.0 {
        for _ in 0..PARABOLA_ITERATIONS {
            let slope = (3.0 * eps * t + 2.0 * slack) * t;
            if slope > 0.0 {
                t -= ((eps * t + slack) * t * t - p2) / slope;
            }
        }
    }
    t
}

/// Newton steps for the tension of a flat parabola. A choice, tuned on nothing: the guess need not
/// be exact.
const PARABOLA_ITERATIONS: usize = 4;
/// Ratio y = sinh λ/λ of a slack guess above which λ is that of large λ, ln 2y + ln ln 2y, and
/// below which it is that of the series 1 + λ²/6. A choice, tuned on nothing.
const MAX_SERIES_SLACK_RATIO: f64 = 3.0;
/// Above this tension (in units of the weight) a span is guessed as a flat parabola. Between 0.3
/// and 2 the mean number of iterations over the grid changes by less than one.
const LEAST_PARABOLA_TENSION_WEIGHTS: f64 = 0.6;
/// Mean tension of a slack span in units of its weight, for its stretched length.
const SLACK_GUESS_STRAIN: f64 = 0.3;

/// Vertical force at the start of a piece of unit weight and length hanging in one vertical line.
pub(super) fn vertical(dz: f64, eps: f64) -> f64 {
    let folded = dz / (2.0 + eps);
    if folded.abs() <= 0.5 {
        folded - 0.5
    } else if dz > 0.0 {
        (dz - 1.0) / eps - 0.5
    } else {
        (dz + 1.0) / eps - 0.5
    }
}
