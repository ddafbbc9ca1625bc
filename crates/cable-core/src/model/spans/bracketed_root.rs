//! This method finds the bracketed root of a function of one variable with a known derivative.

/// Accuracy of a root, as a fraction of the searched interval (round-off).
const ROOT_TOLERANCE_FRACTION: f64 = 1e-15;
/// Relative difference of tensions that counts as round-off. Smaller: where old and new tension
/// nearly coincide the search bisects within round-off. Larger: the material is off by this
/// fraction of the strain.
pub(in crate::model::spans) const TENSION_ROUNDING: f64 = 1e-14;
/// Maximum number of rounds of such a search: bisection alone takes 52.
const MAX_ROUNDS: usize = 100;

/// Finds the root at which f falls from above zero at `a` to zero or below at `b`, by Newton's
/// method from the secant, kept inside the bracket. `f` returns value and derivative; `floor` is a
/// value that counts as round-off. The values at a and b and a place near the root are given if
/// known.
pub(in crate::model::spans) fn crossing(
    a: f64,
    b: f64,
    floor: f64,
    ends: Option<(f64, f64)>,
    f: impl Fn(f64) -> (f64, f64),
) -> f64 {
    let (mut x0, mut x1) = (a, b);
    let (f0, f1) = ends.unwrap_or_else(|| (f(a).0, f(b).0));
    if !(f0 > floor) {
        return a;
    }
    if f1.abs() <= floor {
        return b;
    }
    let rounding = ROOT_TOLERANCE_FRACTION * (a.abs() + b.abs());
    let (mut x, mut before) = (a + (b - a) * (f0 / (f0 - f1)), f64::INFINITY);
    for _ in 0..MAX_ROUNDS {
        let (value, slope) = f(x);
        if value.abs() <= floor || (x1 - x0).abs() <= rounding {
            return x;
        }
        if value > 0.0 {
            x0 = x;
        } else {
            x1 = x;
        }
        let next = x - value / slope;
        let inside = (next - x0) * (next - x1) < 0.0;
        // If a step does not halve the value, Newton's method is not yet in its region of
        // convergence.
        let step = if inside && value.abs() < 0.5 * before { next } else { 0.5 * (x0 + x1) };
        before = value.abs();
        if (step - x).abs() <= rounding {
            return step;
        }
        x = step;
    }
    x
}
