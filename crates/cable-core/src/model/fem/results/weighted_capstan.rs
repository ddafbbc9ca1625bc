//! This module computes the tension along a round from the tensions at its ends, with friction and
//! weight all along it.
//!
//! With b the load per metre, t the direction of the cable, n the outward normal, g the radius over
//! the stretch and m the evenly mobilised friction coefficient, the tension T obeys
//!
//! ```text
//! dT/dψ = mT − g (b·t + m b·n),      dt/dψ = −n,      dn/dψ = t
//! T = α b·t + β b·n + C e^{mψ},      α = 2gm/(1+m²),   β = g(m²−1)/(1+m²)
//! ```
//!
//! where m is chosen so that T has the given values at both ends. At an angle h at one point, a
//! cable with the tension a before it presses with a sin h and has a (cos h + m sin h) after it.
//! If |m| is at most the friction coefficient, every piece of the round is within its friction
//! cone. (L. Euler, "Remarques sur l'effet du frottement dans l'équilibre", Mémoires de l'académie
//! des sciences de Berlin 18, 1769, with weight.)

use crate::math::larger;
use crate::numerics::bisect;

/// Doublings of the coefficient in the search for an upper bound: beyond that no friction connects
/// the two tensions.
const DOUBLINGS: i32 = 12;
/// Halvings of the interval of the coefficient.
const HALVINGS: usize = 60;
/// Number of parts of the turn between which the cable must press on the round.
const PRESSED_PARTS: u32 = 8;
/// Force away from the round that counts as round-off, as a fraction of the greater tension.
const LIFT_ROUNDING: f64 = 1e-9;
/// Greatest error of the tension at the end of the turn, as a fraction of the greater tension. If
/// weight alone would use up the tension, the tension depends so steeply on the coefficient that no
/// f64 gives the end value.
const END_TOLERANCE: f64 = 1e-6;

/// The tension of a cable along a round that carries its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct WeightedCapstan {
    /// Tension at the start of the arc, just after the point at which the cable meets the round, N.
    start: f64,
    /// Mobilised friction coefficient; positive if it makes the tension grow.
    mobilised: f64,
    /// g b·t and g b·n at its start, N.
    load: [f64; 2],
}

impl WeightedCapstan {
    /// The tension between two tensions (N) over a turn (rad), with g b·t and g b·n at its start
    /// (N); the cable begins and ends the turn with an angle (rad) at a point. None if no friction
    /// connects the two tensions, or only with a round that would have to pull the cable.
    pub fn between([before, after]: [f64; 2], turn: f64, load: [f64; 2], kinks: [f64; 2]) -> Option<Self> {
        let [(sin0, cos0), (sin1, cos1)] = kinks.map(f64::sin_cos);
        let with = |mobilised: f64| Self { start: before * (cos0 + mobilised * sin0), mobilised, load };
        let (sin, cos) = turn.sin_cos();
        let excess = |m: f64| with(m).at_turn(turn, sin, cos) - after * (cos1 - m * sin1);
        let lacks = |m: f64| excess(m) < 0.0;
        let bound = (0..=DOUBLINGS).map(|k| f64::powi(2.0, k) / turn);
        let range = if lacks(0.0) {
            [0.0, bound.into_iter().find(|m| !lacks(*m))?]
        } else {
            [-bound.into_iter().find(|m| lacks(-*m))?, 0.0]
        };
        let [low, high] = bisect(range, HALVINGS, lacks);
        let (mobilised, scale) = (0.5 * (low + high), larger(before, after));
        let leads_there = excess(mobilised).abs() <= END_TOLERANCE * scale;
        Some(with(mobilised)).filter(|found| leads_there && found.presses(turn, LIFT_ROUNDING * scale))
    }

    /// True if the cable presses on the round all along a turn (rad), or is pulled off by at most
    /// `rounding` (N).
    fn presses(&self, turn: f64, rounding: f64) -> bool {
        let [along, outward] = self.load;
        (0..=PRESSED_PARTS).all(|k| {
            let turned = turn * f64::from(k) / f64::from(PRESSED_PARTS);
            let (sin, cos) = turned.sin_cos();
            self.at(turned) - (outward * cos + along * sin) >= -rounding
        })
    }

    /// The tension after a turn (rad), N.
    pub fn at(&self, turned: f64) -> f64 {
        let (sin, cos) = turned.sin_cos();
        self.at_turn(turned, sin, cos)
    }

    /// The same with the sine and cosine of the turn.
    fn at_turn(&self, turned: f64, sin: f64, cos: f64) -> f64 {
        let (m, [along, outward]) = (self.mobilised, self.load);
        let square = 1.0 + m * m;
        let [alpha, beta] = [2.0 * m / square, (m * m - 1.0) / square];
        let weight = alpha * (along * cos - outward * sin) + beta * (outward * cos + along * sin);
        weight + (self.start - alpha * along - beta * outward) * (m * turned).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrates the differential equation by the Runge–Kutta method.
    fn integrated(start: f64, m: f64, turn: f64, [along, outward]: [f64; 2]) -> f64 {
        const STEPS: usize = 400;
        let h = turn / STEPS as f64;
        let slope = |angle: f64, tension: f64| {
            let (sin, cos) = angle.sin_cos();
            m * tension - (along * cos - outward * sin) - m * (outward * cos + along * sin)
        };
        (0..STEPS).fold(start, |tension, k| {
            let angle = k as f64 * h;
            let k1 = slope(angle, tension);
            let k2 = slope(angle + 0.5 * h, tension + 0.5 * h * k1);
            let k3 = slope(angle + 0.5 * h, tension + 0.5 * h * k2);
            let k4 = slope(angle + h, tension + h * k3);
            tension + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        })
    }

    #[test]
    fn the_closed_form_obeys_the_law_and_leads_from_end_to_end() {
        for (start, end, turn, load) in [
            (10.0, 14.0, 1.0, [0.0; 2]),
            (1.58, 1.008, 0.78, [1.5, -1.5]),
            (1.0, 2.5, 2.0, [-2.0, -0.5]),
            (3.0, 0.2, 0.5, [0.3, -2.0]),
        ] {
            let found = WeightedCapstan::between([start, end], turn, load, [0.0; 2]).expect("friction leads there");
            assert!((found.at(turn) - end).abs() < 1e-12 * start, "{found:?}");
            let by_steps = integrated(start, found.mobilised, turn, load);
            assert!((by_steps - end).abs() < 1e-8 * start, "{by_steps} against {end}");
        }
        let weightless = WeightedCapstan::between([10.0, 14.0], 1.0, [0.0; 2], [0.0; 2]).expect("friction leads there");
        assert!((weightless.mobilised - 1.4f64.ln()).abs() < 1e-14);
    }

    /// At an angle the cable has the same friction coefficient as along the round.
    #[test]
    fn a_kink_at_either_end_takes_its_part_of_the_friction() {
        let (before, after, kinks) = (6.0, 9.0, [0.2f64, 0.3]);
        let found = WeightedCapstan::between([before, after], 0.8, [0.5, -1.0], kinks).expect("friction leads there");
        let [first, last] = [0.0, 0.8].map(|turned| found.at(turned));
        // These are the tangential and normal forces at both angles.
        let rubs = [first - before * kinks[0].cos(), after * kinks[1].cos() - last];
        let presses = [before * kinks[0].sin(), after * kinks[1].sin()];
        for (rubs, presses) in rubs.into_iter().zip(presses) {
            assert!((rubs - found.mobilised * presses).abs() < 1e-12 * after, "{rubs} N, {presses} N");
        }
        let by_steps = integrated(first, found.mobilised, 0.8, [0.5, -1.0]);
        assert!((by_steps - last).abs() < 1e-8 * last, "{by_steps} against {last}");
    }

    /// A cable thrown round a post had -inf N there, because friction was assumed where the cable
    /// is pulled off.
    #[test]
    fn issue_016_no_friction_comes_from_where_the_cable_is_drawn_off() {
        // A coefficient of 19 connects the two through -2e9 N.
        assert!(WeightedCapstan::between([1.2, 7.0], 3.0, [2.0, 1.0], [0.0, 0.3]).is_none());
        assert!(WeightedCapstan::between([2.5, 7.0], 1.5, [0.0, 2.0], [0.0; 2]).is_some());
    }

    /// A cable that was whirled round a post had 4e11 N there in one frame: the coefficient lay
    /// between two adjacent f64 numbers, of which one gave -1e15 N and the other 1e15 N.
    #[test]
    fn issue_016_no_friction_leads_where_no_number_does() {
        let found = WeightedCapstan::between([0.770_385, 9.574_502_6], 1.042_254, [2.935_798, 0.685_06], [0.0; 2]);
        assert!(found.is_none(), "{found:?}");
    }

    #[test]
    fn issue_015_a_tension_that_weight_alone_would_use_up_does_not_bulge_between_the_ends() {
        // The cable goes down a pipe from 45° to the horizontal: weight alone would leave 0.1 N of
        // 1.58 N, and the cable continues with 1 N.
        let found = WeightedCapstan::between([1.58, 1.008], 0.78, [1.5, -1.5], [0.0; 2]).expect("friction leads there");
        // A factor on the tension that weight alone leaves gave 3.04 N in between.
        let most = (0..=20).map(|k| found.at(0.039 * f64::from(k))).fold(0.0, f64::max);
        assert!((most - 1.5843).abs() < 1e-4, "{most} N");
        assert!((found.mobilised - 0.5333).abs() < 1e-4, "{}", found.mobilised);
    }
}
