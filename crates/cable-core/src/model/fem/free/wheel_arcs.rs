//! This module finds the arcs of a cable on the wheels of its pulleys.
//!
//! The cable is tangent to a wheel at the points where it meets and leaves it. These contact points
//! follow from the forces of the neighbouring spans in a few rounds; each round reduces the error
//! by the ratio of radius to span. Along the arc, with t the direction and n the outward normal,
//! dT = −q·t ds ± μ (T dα − q·n ds): the capstan law with the weight on the wheel.

use crate::math::{Vec2, cross, larger, perp};
use crate::model::fem::free::element::{Material, turn_between};
use crate::model::fem::free::pulley_balance::{PulleyFailure, PulleyNetwork};
use crate::model::fem::free::stations::{Restraint, Wheel};
use crate::problem::wheel_passage::{TURN_ROUNDING, angle_near, facing, turn_through_centre};
use crate::scene::PulleySide;

/// Number of steps of the integration round a wheel.
const WHEEL_STEPS: usize = 16;
/// Tangent of the first tilt of the contact points from the top of a wheel, or from its bottom if
/// the cable runs below it; the wrap (rad) is then about twice as much. Smaller: at 0 the arc has
/// no length and no side; larger: more rounds for wheels with little wrap. A choice, tuned on no
/// campaign.
const FIRST_TILT: f64 = 0.05;
/// Maximum number of rounds that find where a cable meets and leaves its wheels; each reduces the
/// error by the ratio of radius to span.
const WHEEL_ROUNDS: usize = 80;
/// Rounds of wheels end when no contact point moves by more than this angle, rad.
const CONTACT_ANGLE_TOLERANCE: f64 = 1e-12;
/// As above if round-off allows no better.
const CONTACT_ANGLE_LIMIT: f64 = 1e-8;

impl PulleyNetwork {
    /// ln(T_after/T_before) round a wheel, passed `clockwise` (+1) or the other way (−1), with
    /// friction pulling along (`sign` +1) or against.
    pub(in crate::model::fem) fn log_tension_ratio(
        &self,
        wheel: &Wheel,
        before: Vec2,
        clockwise: f64,
        sign: f64,
    ) -> f64 {
        let m = &self.material;
        let [meets, leaves] = wheel.contact;
        let turn = arc(meets, leaves, clockwise);
        let start = meets.y.atan2(meets.x);
        let slope = |alpha: f64, tension: f64| {
            let angle = start - clockwise * alpha;
            let n = Vec2::new(angle.cos(), angle.sin());
            let t = perp(n) * -clockwise;
            let ds = wheel.radius / (m.thermal_stretch * (1.0 + tension / m.axial_stiffness));
            -m.body.dot(&t) * ds + sign * wheel.friction * (tension - m.body.dot(&n) * ds)
        };
        let (first, h) = (before.norm(), turn / WHEEL_STEPS as f64);
        let mut tension = first;
        for k in 0..WHEEL_STEPS {
            let a = h * k as f64;
            let k1 = slope(a, tension);
            let k2 = slope(a + 0.5 * h, tension + 0.5 * h * k1);
            let k3 = slope(a + 0.5 * h, tension + 0.5 * h * k2);
            let k4 = slope(a + h, tension + h * k3);
            tension += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        (tension / first).ln()
    }

    /// +1 if the cable runs clockwise round the wheel at a station, −1 otherwise, judged by the
    /// anchors before and after it.
    pub(in crate::model::fem) fn clockwise_at(&self, station: usize, wheel: &Wheel) -> f64 {
        let [arrive, leave] = self.layout.anchors_beside(station).map(Option::unwrap_or_default);
        facing(wheel.side, arrive + leave)
    }

    /// Sets the first contact points, for straight cables.
    pub(in crate::model::fem) fn meet_wheels_straight(&mut self) {
        for k in self.pulleys() {
            let Some(mut wheel) = self.wheel(k) else { continue };
            if wheel.radius > 0.0 {
                let clockwise = self.clockwise_at(k, &wheel);
                let up = Vec2::new(0.0, if wheel.side == PulleySide::Over { 1.0 } else { -1.0 });
                let tilt = perp(up) * clockwise * if wheel.side == PulleySide::Over { FIRST_TILT } else { -FIRST_TILT };
                wheel.contact = [(up + tilt).normalize(), (up - tilt).normalize()];
                self.layout.stations[k].restraint = Restraint::Pulley(wheel);
            }
        }
    }

    /// Balances the pulleys until contact points and forces agree.
    pub(in crate::model::fem) fn balance_on_wheels(&mut self) -> Result<(), PulleyFailure> {
        for round in 1..=WHEEL_ROUNDS {
            self.balance()?;
            let (moved, lifted) = self.update_wheel_contacts();
            match lifted {
                Some(k) if moved <= CONTACT_ANGLE_TOLERANCE || round == WHEEL_ROUNDS => {
                    return Err(PulleyFailure::LeavesWheel(k));
                }
                None if moved <= CONTACT_ANGLE_TOLERANCE => break,
                None if round == WHEEL_ROUNDS && !(moved <= CONTACT_ANGLE_LIMIT) => {
                    return Err(PulleyFailure::Unbalanced(self.pulleys().first().copied().unwrap_or(0), self.residual));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Moves the contact points to where the forces are tangent; returns the largest move, rad, and
    /// a wheel that the cable would leave at these forces. During the iteration that may be
    /// temporary (a span that is still too slack hangs clear of the wheel's side), so such a cable
    /// is left in contact at one point between the two directions.
    fn update_wheel_contacts(&mut self) -> (f64, Option<usize>) {
        let (mut largest, mut lifted) = (0.0, None);
        for k in self.pulleys() {
            let Some(mut wheel) = self.wheel(k).filter(|w| w.radius > 0.0) else { continue };
            let [before, after] = self.forces[k];
            let clockwise = self.clockwise_at(k, &wheel);
            let mut contact = [perp(before) * (clockwise / before.norm()), perp(after) * (clockwise / after.norm())];
            // Without an anchor beyond it, the force gives the direction.
            let [arrive, leave] = self.layout.anchors_beside(k);
            let through_centre = turn_through_centre(clockwise, arrive.unwrap_or(before), leave.unwrap_or(after));
            let mut turn = angle_near(arc(contact[0], contact[1], clockwise), through_centre);
            if turn < -TURN_ROUNDING {
                let between = contact[0] + contact[1];
                contact = [between / between.norm(); 2];
                (turn, lifted) = (0.0, Some(k));
            }
            let moved = (0..2).map(|i| (contact[i] - wheel.contact[i]).norm()).sum::<f64>();
            largest = larger(largest, moved);
            wheel.contact = contact;
            // Simpson's mean over the arc.
            let tension = [0.0, 0.5, 1.0].map(|f| tension(&wheel, &self.material, [before, after], f));
            let tension = (tension[0] + 4.0 * tension[1] + tension[2]) / 6.0;
            let material_on_wheel =
                wheel.radius * turn / (self.material.thermal_stretch * (1.0 + tension / self.material.axial_stiffness));
            let station = &mut self.layout.stations[k];
            station.arc_length -= 0.5 * (material_on_wheel - station.material_on_wheel);
            station.material_on_wheel = material_on_wheel;
            station.restraint = Restraint::Pulley(wheel);
        }
        (largest, lifted)
    }
}

/// The angle the cable turns through on a wheel between two contact directions, 0 to 2π.
fn arc(meets: Vec2, leaves: Vec2, clockwise: f64) -> f64 {
    let turn = -clockwise * turn_between(meets, leaves);
    if turn < -TURN_ROUNDING { turn + std::f64::consts::TAU } else { turn }
}

/// The angle through which the contact point goes round a wheel, positive counter-clockwise, rad.
#[must_use]
pub fn turn(wheel: &Wheel, before: Vec2) -> f64 {
    let [meets, leaves] = wheel.contact;
    let clockwise = cross(meets, before) < 0.0;
    let turn = turn_between(meets, leaves);
    if clockwise && turn > TURN_ROUNDING {
        turn - std::f64::consts::TAU
    } else if !clockwise && turn < -TURN_ROUNDING {
        turn + std::f64::consts::TAU
    } else {
        turn
    }
}

/// Relative change of tension by friction over a wheel below which the change is taken as linear
/// along the arc: the difference is of second order, and no quotient of two small numbers is
/// formed.
const EVEN_FRICTION_FRACTION: f64 = 1e-6;

/// Tension at a fraction of the arc, N: weight and wind from the first contact on, and friction.
#[must_use]
pub fn tension(wheel: &Wheel, material: &Material, [before, after]: [Vec2; 2], fraction: f64) -> f64 {
    let (first, last) = (before.norm(), after.norm());
    let stretch = material.thermal_stretch * (1.0 + 0.5 * (first + last) / material.axial_stiffness);
    let start = wheel.contact[0].y.atan2(wheel.contact[0].x);
    let angle = start + fraction * turn(wheel, before);
    let carried = |n: Vec2| material.body.dot(&(n - wheel.contact[0])) * wheel.radius / stretch;
    let rubbed = last - first + carried(wheel.contact[1]);
    // Coulomb friction grows in proportion to the tension: T e^{mφ}.
    let whole = (first + rubbed) / first;
    let even = !(whole > 0.0 && whole.is_finite() && (whole - 1.0).abs() > EVEN_FRICTION_FRACTION);
    let share = if even { fraction } else { (whole.powf(fraction) - 1.0) / (whole - 1.0) };
    first - carried(Vec2::new(angle.cos(), angle.sin())) + share * rubbed
}
