//! This module computes the two equations of a contact for its material, with their derivatives.
//!
//! A contact with a stick zone between fronts at p_l and p_r, and A the sliding material between
//! end and front, obeys
//!
//! ```text
//! s₁ + A₁ − s_old(p_l) = 0,      s₂ − A₂ − s_old(p_r) = 0
//! ```
//!
//! A contact that slides completely with m obeys s₂ − s₁ − A = 0 and T₂ = the tension that the law
//! gives from T₁. Moving an end by dp at constant end tension is equivalent to changing the tension
//! there by −T'(p) dp, so every derivative by p follows from the one by tension. At a front both
//! stretches have the same tension, so moving the front has no first-order effect.

use crate::math::larger;
use crate::model::spans::boundary::{BoundaryPoint, ContactPath, Ends, Mode, SlipFront, StickZone, TensionProfile};

/// Distance inside a contact at which the slope of its old tensions is read, as a fraction of its
/// length. Smaller: round-off puts it outside; larger: the slope of the next stretch.
const INNER_PLACE_FRACTION: f64 = 1e-9;
/// Material that still slides, as a fraction of the gap, below which the root of a slip front is
/// replaced by its tangent. Smaller: the slope of the root overflows; larger: Newton's method takes
/// more steps at the start of a slip.
const FLAT_ROOT_FRACTION: f64 = 1e-3;

/// Residuals and their derivatives by (p₁, s₁, T₁, p₂, s₂, T₂).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::model::spans) struct ContactEquations {
    pub residual: [f64; 2],
    pub by: [[f64; 6]; 2],
    /// True if a row is of tensions (N), not of material (m).
    pub of_tension: [bool; 2],
}

/// The rows of a contact in a mode, and its stick zone if it has one.
///
/// `pinned` marks ends that are held on the boundary, so that their tension is an unknown of its
/// own; `end_points` are the places of its ends.
pub(in crate::model::spans) fn rows(
    contact_path: &ContactPath<'_>,
    history: &TensionProfile,
    e: &Ends,
    end_points: &[BoundaryPoint; 2],
    mode: Mode,
    pinned: [bool; 2],
) -> (ContactEquations, Option<StickZone>) {
    // A lifted contact, which Newton's method may try, counts as a point without friction.
    let lifted = e.place[1] < e.place[0];
    match if lifted { Mode::Slip(0.0) } else { mode } {
        Mode::Slip(m) if contact_path.floored && !lifted => (drawn(contact_path, e, end_points, m), None),
        Mode::Slip(m) => (sliding(contact_path, history, e, end_points, m), None),
        Mode::Stick => {
            let stick_zone = history.find_stick_zone(contact_path, e);
            let (mut out, fronts) = match stick_zone {
                // Beyond the friction cone the rows of sticking continue smoothly: the mode
                // changes, not the rows.
                StickZone::Between(fronts) | StickZone::Beyond(_, fronts) => {
                    (sticking_equations(contact_path, e, end_points, &fronts), fronts)
                }
                StickZone::Meet(fronts) => {
                    let mut out = sticking_equations(contact_path, e, end_points, &fronts);
                    meeting(&mut out, contact_path, history, e, end_points, &fronts);
                    (out, fronts)
                }
            };
            for side in 0..2 {
                if pinned[side] {
                    pin(&mut out, contact_path, history, e, side, &fronts[side]);
                }
            }
            (out, Some(stick_zone))
        }
    }
}

/// Makes the row of an end that is held on the boundary linear in its tension.
///
/// Near the old tension a change x moves the material φ = ∓ k x|x|, k = 1/(2·D·EA·τ), with D the
/// difference of the slopes of tension at the front. This is flat at x = 0, where Newton's method
/// starts; its root √|φ| is linear. If the end has not moved, x = 0 and there is nothing to solve.
fn pin(
    out: &mut ContactEquations,
    contact_path: &ContactPath<'_>,
    history: &TensionProfile,
    e: &Ends,
    side: usize,
    front: &SlipFront,
) {
    let (old_t, old_s) = history.at(contact_path, e.place[side]);
    let gap = e.material[side] - old_s;
    let x = e.tension[side] - old_t;
    out.of_tension[side] = true;
    if gap.abs() <= END_MOVE_TOLERANCE * (e.material[0].abs() + e.material[1].abs()) {
        out.residual[side] = x;
        out.by[side] = [0.0; 6];
        out.by[side][3 * side + 2] = 1.0;
        return;
    }
    let size = e.material[0].abs() + e.material[1].abs();
    let law = &contact_path.law;
    let place = contact_path.place(e.place[side]);
    let sign = if side == 0 { -1.0 } else { 1.0 };
    let target = -sign * gap;
    // The sign of the required change of tension decides the direction of sliding there.
    let m = front.mobilised.abs() * if (target > 0.0) == (side == 0) { -1.0 } else { 1.0 };
    let inner = e.place[side] + (e.place[1 - side] - e.place[side]) * INNER_PLACE_FRACTION;
    let drop = (law.slope(&place, old_t, m) - history.slope(contact_path, inner)).abs() / place.stretch;
    if drop <= SLOPE_DIFFERENCE_FRACTION * law.load.norm() {
        // It continues to slide as before: the material follows the tension along the whole old
        // sliding zone, smoothly, which the unchanged tension does not yet show.
        out.of_tension[side] = false;
        if x == 0.0 {
            let nudged = old_t + DIFFERENCE_STEP * (old_t.abs() + law.load.norm() * size) * target.signum();
            let way = history.front(contact_path, e.place[side], nudged, e.place[1 - side]).way;
            out.by[side][3 * side + 2] = way.material_by_tension;
        }
        return;
    }
    let k = place.stretch / (2.0 * drop * law.stiffness * law.thermal);
    let solved = out.residual[side].abs() <= MATERIAL_ROUNDING_FRACTION * size;
    let phi = sign * (out.residual[side] - gap);
    let root = |v: f64| v.signum() * v.abs().sqrt();
    let flat = phi.abs() <= FLAT_ROOT_FRACTION * gap.abs();
    let value = if flat { x * k.sqrt() } else { root(phi) };
    // The root of round-off is much larger than round-off.
    out.residual[side] = if solved { 0.0 } else { (value - root(target)) / k.sqrt() };
    let factor = sign / (2.0 * phi.abs().sqrt() * k.sqrt());
    for (i, by) in out.by[side].iter_mut().enumerate() {
        *by = if i == 3 * side + 2 {
            if flat { 1.0 } else { *by * factor }
        } else if flat || i == 3 * side + 1 {
            0.0
        } else {
            *by * factor
        };
    }
}

/// Equations of a sliding contact. A cable that runs away is followed with a drag η: T₂ less the
/// tension that the law gives from T₁ is η times the slip, η (s_old(p₁) − s₁).
fn sliding(
    contact_path: &ContactPath<'_>,
    history: &TensionProfile,
    e: &Ends,
    [a, b]: &[BoundaryPoint; 2],
    m: f64,
) -> ContactEquations {
    let way = contact_path.slide(e.place[0], e.place[1], e.tension[0], m);
    let slope = contact_path.law.slope(a, e.tension[0], m);
    let (mut drag_force, mut drag_by_place) = (0.0, 0.0);
    if contact_path.drag > 0.0 {
        let (t, s) = history.at(contact_path, e.place[0]);
        drag_force = contact_path.drag * (s - e.material[0]);
        drag_by_place = contact_path.drag * a.stretch / contact_path.law.stretch(t);
    }
    ContactEquations {
        residual: [e.material[1] - e.material[0] - way.material, e.tension[1] - way.tension - drag_force],
        by: [
            [
                a.stretch / contact_path.law.stretch(e.tension[0]) + way.material_by_tension * slope,
                -1.0,
                -way.material_by_tension,
                -b.stretch / contact_path.law.stretch(way.tension),
                1.0,
                0.0,
            ],
            [
                way.by_tension * slope - drag_by_place,
                contact_path.drag,
                -way.by_tension,
                -contact_path.law.slope(b, way.tension, m),
                0.0,
                1.0,
            ],
        ],
        of_tension: [false, true],
    }
}

/// Equations with fully mobilised friction, or without friction: from the drawn end the tension
/// falls by the law, at most to zero.
fn drawn(contact_path: &ContactPath<'_>, e: &Ends, end_points: &[BoundaryPoint; 2], m: f64) -> ContactEquations {
    let from = e.drawn_side(m);
    let to = 1 - from;
    let (way, _) = contact_path.slide_floored(e.place[from], e.place[to], e.tension[from], m);
    let (start, end) = (&end_points[from], &end_points[to]);
    let slope = contact_path.law.slope(start, e.tension[from], m);
    let falls = if way.by_tension == 0.0 { 0.0 } else { contact_path.law.slope(end, way.tension, m) };
    let mut rows = ContactEquations { of_tension: [false, true], ..ContactEquations::default() };
    rows.residual = [e.material[to] - e.material[from] - way.material, e.tension[to] - way.tension];
    let [lengths, tensions] = &mut rows.by;
    lengths[3 * from] = start.stretch / contact_path.law.stretch(e.tension[from]) + way.material_by_tension * slope;
    lengths[3 * from + 1] = -1.0;
    lengths[3 * from + 2] = -way.material_by_tension;
    lengths[3 * to] = -end.stretch / contact_path.law.stretch(way.tension);
    lengths[3 * to + 1] = 1.0;
    tensions[3 * from] = way.by_tension * slope;
    tensions[3 * from + 2] = -way.by_tension;
    tensions[3 * to] = -falls;
    tensions[3 * to + 2] = 1.0;
    rows
}

/// The two equations of a contact that sticks between its slip fronts.
fn sticking_equations(
    contact_path: &ContactPath<'_>,
    e: &Ends,
    end_points: &[BoundaryPoint; 2],
    fronts: &[SlipFront; 2],
) -> ContactEquations {
    let law = &contact_path.law;
    let mut out = ContactEquations::default();
    for k in 0..2 {
        let (f, place) = (&fronts[k], &end_points[k]);
        out.residual[k] = e.material[k] + f.way.material - f.old;
        let slope = law.slope(place, e.tension[k], f.mobilised);
        let by_t = f.way.material_by_tension;
        out.by[k][3 * k] = -place.stretch / law.stretch(e.tension[k]) - by_t * slope;
        out.by[k][3 * k + 1] = 1.0;
        out.by[k][3 * k + 2] = by_t;
    }
    out
}

/// Adds terms if the fronts meet: the meeting point moves with both tensions, and the old tension
/// there differs from the new one.
fn meeting(
    out: &mut ContactEquations,
    contact_path: &ContactPath<'_>,
    history: &TensionProfile,
    e: &Ends,
    end_points: &[BoundaryPoint; 2],
    fronts: &[SlipFront; 2],
) {
    let law = &contact_path.law;
    let place = contact_path.place(fronts[0].coordinate);
    let t = fronts[0].way.tension;
    let old = history.at(contact_path, fronts[0].coordinate).0;
    let gain = place.stretch * (1.0 / law.stretch(t) - 1.0 / law.stretch(old));
    let closing = law.slope(&place, t, fronts[0].mobilised) - law.slope(&place, t, fronts[1].mobilised);
    if closing == 0.0 {
        return;
    }
    for k in 0..2 {
        let sign = if k == 0 { -1.0 } else { 1.0 };
        let moved = gain * sign * fronts[k].way.by_tension / closing;
        let slope = law.slope(&end_points[k], e.tension[k], fronts[k].mobilised);
        for row in &mut out.by {
            row[3 * k + 2] += moved;
            row[3 * k] -= moved * slope;
        }
    }
}

/// The next mode: a sticking contact beyond its friction cone slides; one that would slide the
/// wrong way sticks.
///
/// `held` is its stick zone; `patience` is the multiple of round-off by which the mode must be
/// wrong, 1 while changes cost nothing.
pub(in crate::model::spans) fn next_mode(
    contact_path: &ContactPath<'_>,
    history: &TensionProfile,
    e: &Ends,
    stick_zone: Option<StickZone>,
    mode: Mode,
    pinned: [bool; 2],
    patience: f64,
) -> Mode {
    let friction = contact_path.friction;
    let (cone, stuck) = (CONE_ROUNDING * patience, STICK_ROUNDING * patience);
    if friction <= 0.0 || e.place[1] < e.place[0] {
        return if friction <= 0.0 { Mode::Slip(0.0) } else { mode };
    }
    match mode {
        Mode::Stick => match stick_zone.unwrap_or_else(|| history.find_stick_zone(contact_path, e)) {
            StickZone::Beyond(m, _) => {
                // Round-off at the edge of the friction cone is not sliding.
                let reached = contact_path.slide(e.place[0], e.place[1], e.tension[0], m).tension;
                if (e.tension[1] - reached).abs() > cone * e.tension[1].abs() { Mode::Slip(m) } else { mode }
            }
            _ => mode,
        },
        Mode::Slip(m) => {
            for side in (0..2).filter(|&side| pinned[side]) {
                let (old_t, old_s) = history.at(contact_path, e.place[side]);
                if (e.material[side] - old_s).abs() <= END_MOVE_TOLERANCE * (e.material[0].abs() + e.material[1].abs())
                {
                    // The more the rest slides away from a point that does not move, the greater
                    // the tension there.
                    let drawn = (e.tension[side] - old_t) * m * if side == 0 { 1.0 } else { -1.0 };
                    let rounding = cone * friction * larger(e.tension[0].abs(), e.tension[1].abs());
                    return if drawn < -rounding { Mode::Stick } else { mode };
                }
            }
            // With m = +μ material moves along p, so s < s_old at every p. The slip is least where
            // the tension has its old value: before that place one strain is greater, after it the
            // other.
            let (old, _) = history.at(contact_path, e.place[0]);
            let least = if (old - e.tension[0]) * m > 0.0 {
                history.front(contact_path, e.place[0], e.tension[0], e.place[1]).coordinate
            } else {
                e.place[0]
            };
            let s = e.material[0] + contact_path.slide(e.place[0], least, e.tension[0], m).material;
            let slid = s - history.at(contact_path, least).1;
            if m * slid > 0.0 && slid.abs() > stuck * (s.abs() + e.material[1].abs()) { Mode::Stick } else { mode }
        }
    }
}

/// Relative excess of a tension over the friction cone that counts as round-off. Smaller: chatter
/// by round-off; larger: creep.
const CONE_ROUNDING: f64 = 1e-13;
/// Relative round-off of the material coordinate.
const MATERIAL_ROUNDING_FRACTION: f64 = 1e-15;
/// Relative step of a tension for a difference quotient.
const DIFFERENCE_STEP: f64 = 1e-6;
/// Difference of slopes of tension below which they are equal, as a fraction of the load.
const SLOPE_DIFFERENCE_FRACTION: f64 = 1e-6;
/// Relative difference of the material coordinate below which an end held on the boundary has not
/// moved.
const END_MOVE_TOLERANCE: f64 = 1e-14;
/// Relative difference of the material coordinate that is round-off and not slip.
const STICK_ROUNDING: f64 = 1e-15;
