//! The governor plans the speed of the vehicle with an acceleration that has no jumps.
//!
//! The acceleration a is at most A and changes at most by J a second: a double-S profile (L.
//! Biagiotti and C. Melchiorri, "Trajectory Planning for Automatic Machines and Robots", Springer,
//! 2008, section 3.4). It is not laid out beforehand but chosen anew in every step from how the
//! vehicle is, because cable and ground may hold it up.
//!
//! In a step of h the acceleration goes evenly from a to a', so the speed grows by h (a + a')/2.
//! Two choices of a' are known. The one that comes to the commanded speed u as soon as possible and
//! ends there with an acceleration of 0 is, with e = u − v − ha/2 > 0,
//! ```text
//! a'²/2J + ha'/2 = e,    a' ≤ A,    a' ≤ e/h
//! ```
//! and the last limit ends it in two steps. The one that comes to a stand as soon as possible is
//! the same with u = 0. Where there is a place to stop at, the greatest acceleration between these
//! two is taken after which the vehicle can still stop there.
//!
//! To stop, a falls to −p and rises again to 0. The speed that this takes is p²/J − a²/2J = v, thus
//! ```text
//! p² = Jv + a²/2,    p ≤ A
//! ```
//! and where A is less, the vehicle slows down evenly in between.

use crate::math::{bounded, larger, smaller};
use crate::numerics::bisect;

/// Greatest acceleration that the governor asks for, m/s². If it is larger, the tracks slip at
/// every start; if it is smaller, driving by hand feels dead.
pub(super) const MAX_ACCELERATION: f64 = 1.0;

/// Greatest change of the acceleration, m/s³. Of the swing of period T that a jump excites, a ramp
/// of duration A/J leaves at most T J/(π A). If J is larger, the cable ripples whenever the robot
/// starts or stops; if it is smaller, the robot answers a hand late. In the opening scene, with
/// swings of 0.07 and 0.45 s, the ripple of the tension is 8.3 N without limit, 3.0 N with 3, and
/// 1.7 N with 1.5 m/s³.
pub(super) const MAX_JERK: f64 = 2.0;

/// A speed this near to the planned one is that one, m/s. If it is larger, a pull that slows the
/// vehicle down counts as braking; if it is smaller, rounding does.
const PLAN_TOLERANCE_M_PER_S: f64 = 1e-6;

/// A difference of speeds that is due to rounding, m/s.
const ROUNDING_M_PER_S: f64 = 1e-12;

/// Halvings of the interval of accelerations. With fewer the vehicle stops short of its place; more
/// are below rounding.
const HALVINGS: usize = 40;

/// A motion that the governor has planned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlannedMotion {
    /// Speed, m/s.
    pub speed: f64,
    /// Acceleration, m/s².
    pub acceleration: f64,
}

/// The order to the governor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SpeedOrder {
    /// Commanded speed, m/s.
    pub speed: f64,
    /// Distance to the place where the vehicle stops, m, signed as the speed; None by hand.
    pub left: Option<f64>,
}

impl PlannedMotion {
    /// Returns the motion to ask for at the end of a step of `h` (s).
    pub fn next(self, order: SpeedOrder, h: f64) -> Self {
        let acceleration = self.next_acceleration(order, h);
        let end = self.then(acceleration, h);
        // A speed at the level of rounding counts as zero: the vehicle stands or moves uniformly.
        let [off, change] = [end.speed - order.speed, end.acceleration * h].map(f64::abs);
        if off < ROUNDING_M_PER_S && change < ROUNDING_M_PER_S {
            return Self { speed: order.speed, acceleration: 0.0 };
        }
        end
    }

    /// Returns the motion from which the governor continues after a step of `h` (s) that led from
    /// one speed (m/s) to another. A deceleration that the governor did not ask for is no planned
    /// acceleration.
    pub fn after_hindrance(self, h: f64, [from, to]: [f64; 2]) -> Self {
        let planned = self.acceleration;
        let acceleration = if (to - self.speed).abs() < PLAN_TOLERANCE_M_PER_S {
            planned
        } else {
            bounded((to - from) / h, smaller(planned, 0.0), larger(planned, 0.0))
        };
        Self { acceleration, ..self }
    }

    /// Returns the motion after a step in which the acceleration goes to another one.
    fn then(self, acceleration: f64, h: f64) -> Self {
        Self { speed: self.speed + 0.5 * h * (self.acceleration + acceleration), acceleration }
    }

    /// Acceleration for the next `h` seconds (m/s²): the greatest with which the vehicle can still
    /// stop at the place ordered.
    fn next_acceleration(self, order: SpeedOrder, h: f64) -> f64 {
        let fastest = self.toward(order.speed, h);
        let Some(left) = order.left else { return fastest };
        // Seen in the direction of the place.
        let sense = left.signum();
        let ahead = Self { speed: self.speed * sense, acceleration: self.acceleration * sense };
        let stops_in_time = |a: f64| {
            let end = ahead.then(a, h);
            0.5 * h * (ahead.speed + end.speed) + end.stopping_distance() <= left.abs()
        };
        let [slow, fast] = [self.toward(0.0, h) * sense, fastest * sense];
        if stops_in_time(fast) || !stops_in_time(slow) {
            return if stops_in_time(fast) { fast } else { slow } * sense;
        }
        bisect([slow, fast], HALVINGS, stops_in_time)[0] * sense
    }

    /// Returns the acceleration that comes to a speed as soon as possible, m/s².
    fn toward(self, speed: f64, h: f64) -> f64 {
        let change = MAX_JERK * h;
        let left = speed - self.speed - 0.5 * h * self.acceleration;
        let ramp = (0.25 * change * change + 2.0 * MAX_JERK * left.abs()).sqrt() - 0.5 * change;
        let wanted = [left.abs() / h, MAX_ACCELERATION].into_iter().fold(ramp, smaller);
        bounded(wanted.copysign(left), self.acceleration - change, self.acceleration + change)
    }

    /// Returns the distance in which the vehicle stops, m.
    fn stopping_distance(self) -> f64 {
        let Self { speed: v, acceleration: a } = self;
        let peak = larger(MAX_JERK * v + 0.5 * a * a, 0.0).sqrt();
        let peak = smaller(larger(peak, -a), MAX_ACCELERATION);
        let onset = larger((a + peak) / MAX_JERK, 0.0);
        let begun = v + onset * (a - 0.5 * MAX_JERK * onset);
        let way = onset * (v + onset * (0.5 * a - MAX_JERK * onset / 6.0));
        let even = larger((begun - 0.5 * peak * peak / MAX_JERK) / MAX_ACCELERATION, 0.0);
        let even = if peak < MAX_ACCELERATION { 0.0 } else { even };
        let way = way + even * (begun - 0.5 * MAX_ACCELERATION * even);
        let ended = begun - MAX_ACCELERATION * even;
        let release = peak / MAX_JERK;
        way + release * (ended - release * (0.5 * peak - MAX_JERK * release / 6.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Drives to a place at 1 m, and one step after the other to a stand.
    fn drive(h: f64, speed: f64) -> Vec<(f64, PlannedMotion)> {
        let (mut x, mut now, mut out) = (0.0, PlannedMotion::default(), Vec::new());
        for _ in 0..(12.0 / h) as usize {
            let left = 1.0 - x;
            let order = SpeedOrder { speed: speed * f64::signum(left), left: Some(left) };
            let order = if left.abs() > 1e-3 { order } else { SpeedOrder::default() };
            let next = now.next(order, h);
            x += 0.5 * h * (now.speed + next.speed);
            now = next;
            out.push((x, now));
        }
        out
    }

    #[test]
    fn it_stops_at_its_place_with_limited_jerk() {
        for (h, speed) in [(1.0 / 240.0, 0.3), (1.0 / 240.0, 0.6), (1.0 / 240.0, 3.0), (1.0 / 960.0, 0.6), (0.02, 0.6)]
        {
            let run = drive(h, speed);
            let mut before = PlannedMotion::default();
            for (x, now) in &run {
                assert!((now.acceleration - before.acceleration).abs() <= MAX_JERK * h * (1.0 + 1e-6), "{now:?}");
                assert!(now.acceleration.abs() <= MAX_ACCELERATION * (1.0 + 1e-9), "{now:?}");
                assert!(now.speed <= speed * (1.0 + 1e-3) && now.speed > -1e-3, "{now:?}");
                assert!(*x < 1.0 + 1e-3, "{x}");
                before = *now;
            }
            let (x, end) = run.last().unwrap();
            assert!((x - 1.0).abs() < 1e-3 && end.speed == 0.0, "{x} {end:?}");
        }
    }

    #[test]
    fn the_stopping_distance_is_that_of_small_steps() {
        for (speed, acceleration) in [(0.1, 0.0), (0.6, 0.0), (0.6, 1.0), (0.02, 0.3), (2.0, -0.5), (0.0, 0.7)] {
            let (mut now, h, mut way) = (PlannedMotion { speed, acceleration }, 1e-5, 0.0);
            let exact = now.stopping_distance();
            for _ in 0..1_000_000 {
                let next = now.next(SpeedOrder::default(), h);
                way += 0.5 * h * (now.speed + next.speed);
                now = next;
            }
            assert!(now.speed.abs() < 1e-12 && (way - exact).abs() < 1e-4, "{speed} {acceleration}: {way} {exact}");
        }
    }
}
