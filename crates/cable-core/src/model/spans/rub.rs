//! A contact's two equations for its material, with their derivatives.
//!
//! Where some of it sticks, at the fronts p_l and p_r, with A the material between end and front as it slides:
//!
//! ```text
//! s₁ + A₁ − s_old(p_l) = 0,      s₂ − A₂ − s_old(p_r) = 0
//! ```
//!
//! Where all of it slides with m: s₂ − s₁ − A = 0 and T₂ = the tension the law makes of T₁. Moving an end by dp under the
//! same end tension is the same as a tension there changed by −T'(p) dp, so every derivative by p follows from the one by
//! tension. At a front both stretches have the same tension, so that moving it changes nothing.

use super::history::{Ends, Front, Held, History, Mode};
use super::law::Track;

/// Residuals and their derivatives by (p₁, s₁, T₁, p₂, s₂, T₂).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Rows {
    pub residual: [f64; 2],
    pub by: [[f64; 6]; 2],
    /// Whether the second row is of tensions (N), not of material (m).
    pub of_tension: bool,
}

/// The rows of a contact in a mode.
pub(super) fn rows(track: &Track<'_>, history: &History, e: &Ends, mode: Mode, friction: f64) -> Rows {
    // Lifted (Newton looks there): a point without friction.
    let mode = if e.p[1] < e.p[0] { Mode::Slide(0.0) } else { mode };
    match mode {
        Mode::Slide(m) => sliding(track, e, m),
        Mode::Hold => match history.hold(track, e, friction) {
            // Beyond its cone the rows of sticking go on smoothly: the mode is changed, not the rows.
            Held::Between(fronts) | Held::Beyond(_, fronts) => holding(track, history, e, fronts, false),
            Held::Meet(fronts) => holding(track, history, e, fronts, true),
        },
    }
}

fn sliding(track: &Track<'_>, e: &Ends, m: f64) -> Rows {
    let way = track.slide(e.p[0], e.p[1], e.t[0], m);
    let (a, b) = (track.place(e.p[0]), track.place(e.p[1]));
    let slope = track.law.slope(&a, e.t[0], m);
    Rows {
        residual: [e.s[1] - e.s[0] - way.material, e.t[1] - way.tension],
        by: [
            [
                a.stretch / track.law.stretch(e.t[0]) + way.material_by_tension * slope,
                -1.0,
                -way.material_by_tension,
                -b.stretch / track.law.stretch(way.tension),
                1.0,
                0.0,
            ],
            [way.by_tension * slope, 0.0, -way.by_tension, -track.law.slope(&b, way.tension, m), 0.0, 1.0],
        ],
        of_tension: true,
    }
}

fn holding(track: &Track<'_>, history: &History, e: &Ends, fronts: [Front; 2], meet: bool) -> Rows {
    let law = &track.law;
    let mut out = Rows::default();
    for k in 0..2 {
        let (f, place) = (fronts[k], track.place(e.p[k]));
        let old = history.at(track, f.p).1;
        out.residual[k] = e.s[k] + f.way.material - old;
        let slope = law.slope(&place, e.t[k], f.m);
        let by_t = f.way.material_by_tension;
        out.by[k][3 * k] = -place.stretch / law.stretch(e.t[k]) - by_t * slope;
        out.by[k][3 * k + 1] = 1.0;
        out.by[k][3 * k + 2] = by_t;
    }
    if meet {
        // The meeting point moves with both tensions; there the old tension differs from the new one.
        let place = track.place(fronts[0].p);
        let t = fronts[0].way.tension;
        let old = history.at(track, fronts[0].p).0;
        let gain = place.stretch * (1.0 / law.stretch(t) - 1.0 / law.stretch(old));
        let closing = law.slope(&place, t, fronts[0].m) - law.slope(&place, t, fronts[1].m);
        if closing != 0.0 {
            for k in 0..2 {
                let sign = if k == 0 { -1.0 } else { 1.0 };
                let moved = gain * sign * fronts[k].way.by_tension / closing;
                let slope = law.slope(&track.place(e.p[k]), e.t[k], fronts[k].m);
                for row in &mut out.by {
                    row[3 * k + 2] += moved;
                    row[3 * k] -= moved * slope;
                }
            }
        }
    }
    out
}

/// The mode to go on with: a contact that holds beyond its cone slides; one that would slide the wrong way holds.
pub(super) fn next_mode(track: &Track<'_>, history: &History, e: &Ends, mode: Mode, friction: f64) -> Mode {
    if friction <= 0.0 || e.p[1] < e.p[0] {
        return if friction <= 0.0 { Mode::Slide(0.0) } else { mode };
    }
    match mode {
        Mode::Hold => match history.hold(track, e, friction) {
            Held::Beyond(m, _) => {
                // Rounding at the edge of the cone is not sliding.
                let reached = track.slide(e.p[0], e.p[1], e.t[0], m).tension;
                if (e.t[1] - reached).abs() > CONE * e.t[1].abs() { Mode::Slide(m) } else { mode }
            }
            _ => mode,
        },
        Mode::Slide(m) => {
            // With m = +μ material goes on along p, so there is less of it than was, s < s_old, at every p. The slip is
            // least where the tension is what it was: before it the one stretch is the greater, after it the other.
            let (old, _) = history.at(track, e.p[0]);
            let least = if (old - e.t[0]) * m > 0.0 {
                history.front(track, (e.p[0], e.t[0]), e.p[1], friction).p
            } else {
                e.p[0]
            };
            let s = e.s[0] + track.slide(e.p[0], least, e.t[0], m).material;
            let slid = s - history.at(track, least).1;
            if m * slid > 0.0 && slid.abs() > STUCK * (s.abs() + e.s[1].abs()) { Mode::Hold } else { mode }
        }
    }
}

/// Part of a tension by which the cone of friction may be left. Smaller: chatter of rounding; larger: creep.
const CONE: f64 = 1e-13;
/// Part of the material coordinate that is no movement: rounding.
const STUCK: f64 = 1e-15;
