//! The system of a run has its unknowns, its equations, and their derivatives.

use crate::math::{Vec2, cross, larger};
use crate::model::spans::boundary::capstan::Track;
use crate::model::spans::boundary::curve::Place;
use crate::model::spans::boundary::friction_memory::Mode;
use crate::model::spans::boundary::segment_cursor::Pivot;
use crate::model::spans::contact::equations;
use crate::model::spans::contact::load_balance::load_balance;
use crate::model::spans::contact::point_load;
use crate::model::spans::numerics::band_lu::Band;
use crate::model::spans::run::{CableRun, Contact, Course, Tie};

fn count(strand: &CableRun) -> usize {
    6 * strand.contacts.len() + 2
}

pub(super) fn gather(strand: &CableRun, out: &mut Vec<f64>) {
    out.resize(count(strand), 0.0);
    let mut blocks = out.chunks_exact_mut(6);
    for ((k, c), block) in strand.contacts.iter().enumerate().zip(&mut blocks) {
        let (g, s) = (strand.forces[k], c.ends.s);
        block.copy_from_slice(&[g.x, g.y, slot(strand, k, 0), s[0], slot(strand, k, 1), s[1]]);
    }
    if let ([x, y], Some(g)) = (blocks.into_remainder(), strand.forces.last()) {
        (*x, *y) = (g.x, g.y);
    }
}

/// True if the tension of that side of contact j is an unknown of its own.
pub(super) fn has_tension_unknown(strand: &CableRun, j: usize, side: usize) -> bool {
    let outer = if side == 0 { j == 0 } else { j + 1 == strand.contacts.len() };
    outer && matches!(strand.ties[side], Tie::Lies(_))
}

/// True for the ends of contact j that are held on the boundary.
pub(super) fn pinned(strand: &CableRun, j: usize) -> [bool; 2] {
    [0, 1].map(|side| has_tension_unknown(strand, j, side) || strand.is_pinned(j, side))
}

/// True if that side of contact j is an end of the strand that lies.
fn is_end(strand: &CableRun, j: usize, side: usize) -> bool {
    let outer = if side == 0 { j == 0 } else { j + 1 == strand.contacts.len() };
    outer && !strand.ties[side].has_span()
}

fn slot(strand: &CableRun, j: usize, side: usize) -> f64 {
    let e = &strand.contacts[j].ends;
    if has_tension_unknown(strand, j, side) { e.t[side] } else { e.p[side] }
}

pub(super) fn scatter(strand: &mut CableRun, course: &Course, x: &[f64]) {
    for k in 0..strand.spans() {
        let x = &x[6 * k..];
        strand.forces[k] = Vec2::new(x[0], x[1]);
        if k < strand.contacts.len() {
            for side in 0..2 {
                let (slot, s) = (x[2 + 2 * side], x[3 + 2 * side]);
                let (own, marked) = (has_tension_unknown(strand, k, side), strand.is_marked(k, side));
                let c = &mut strand.contacts[k];
                let e = &mut c.ends;
                // The material of a load is what it is, to the last digit.
                if !marked {
                    e.s[side] = s;
                }
                if own {
                    e.t[side] = slot;
                } else {
                    e.p[side] = slot;
                }
            }
        }
    }
    strand.take_tensions(course);
}

/// The equations of a strand at a state.
#[derive(Clone, Debug, Default)]
pub(super) struct System {
    pub residual: Vec<f64>,
    /// The Jacobian.
    pub band: Band,
    /// The places of both ends of each contact, and the first with its piece.
    pub spots: Vec<([Place; 2], Pivot)>,
}

/// Works out the equations of a strand where it is, and where each of its contacts sticks.
pub(super) fn assemble(strand: &mut CableRun, course: &Course, system: &mut System) {
    let n = count(strand);
    system.residual.clear();
    system.residual.resize(n, 0.0);
    system.band.reset(n);
    system.spots.clear();
    let seen = |c: &Contact| Pivot::of_ends(&course.curves[c.curve], c.chain_range, &course.law, c.ends.p);
    system.spots.extend(strand.contacts.iter().map(seen));
    for k in 0..strand.spans() {
        span_rows(strand, course, k, system);
        if k < strand.contacts.len() {
            contact_rows(strand, course, k, system);
        }
    }
}

/// As [`assemble`], where nothing but the mode of contact j has changed since.
pub(super) fn renew(strand: &mut CableRun, course: &Course, j: usize, system: &mut System) {
    if strand.contacts[j].is_load() {
        // A contact that is joined to it is held or let go with it.
        return assemble(strand, course, system);
    }
    for row in 6 * j + 2..6 * j + 6 {
        system.residual[row] = 0.0;
        system.band.clear(row);
    }
    contact_rows(strand, course, j, system);
}

/// Lengths in hundredths of the strand.
fn scale(strand: &CableRun) -> f64 {
    100.0 / (strand.to - strand.from)
}

fn span_rows(strand: &CableRun, course: &Course, k: usize, system: &mut System) {
    let (row, scale) = (6 * k, scale(strand));
    let (r, band) = (&mut system.residual, &mut system.band);
    let m = strand.contacts.len();
    if k > 0 && strand.is_joined(k, 0) {
        // One place; the tension stands where the force would.
        r[row] = (strand.contacts[k - 1].ends.p[1] - strand.contacts[k].ends.p[0]) * scale;
        band.add(row, row - 2, scale);
        band.add(row, row + 2, -scale);
        let size = 1.0 / larger(strand.forces[k].x.abs(), 1e-9 * course.law.load.norm());
        r[row + 1] = strand.forces[k].y * size;
        band.add(row + 1, row + 1, size);
        return;
    }
    let known = if !strand.has_span(k) {
        Some(strand.forces[k])
    } else if k == 0 && matches!(strand.ties[0], Tie::Hangs(_)) {
        strand.hanging(course, 0)
    } else if k == m && matches!(strand.ties[1], Tie::Hangs(_)) {
        strand.hanging(course, 1)
    } else {
        None
    };
    if let Some(g) = known {
        let d = strand.forces[k] - g;
        let size = 1.0 / (g.norm() + course.law.load.norm() * (strand.to - strand.from)).max(f64::MIN_POSITIVE);
        (r[row], r[row + 1]) = (d.x * size, d.y * size);
        band.add(row, row, size);
        band.add(row + 1, row + 1, size);
        return;
    }
    let before = k.checked_sub(1).map(|j| &system.spots[j].0[1]);
    let after = system.spots.get(k).map(|s| &s.0[0]);
    let held = |t: &Tie| if let Tie::Held(at) = t { Some(*at) } else { None };
    let ends = (
        before.map_or_else(|| held(&strand.ties[0]), |s| Some(s.at)),
        after.map_or_else(|| held(&strand.ties[1]), |s| Some(s.at)),
    );
    let (Some(a), Some(b)) = ends else { return };
    let (from, to) = strand.material(k);
    let (start, end) = (strand.force(course, k, from), strand.force(course, k, to));
    let (way, compliance) = course.chain(from, to).reach(start);
    let d = (way - (b - a)) * scale;
    (r[row], r[row + 1]) = (d.x, d.y);
    for i in 0..2 {
        for j in 0..2 {
            band.add(row + i, row + j, compliance[(i, j)] * scale);
        }
    }
    let mut add = |column: usize, v: Vec2| {
        band.add(row, column, v.x * scale);
        band.add(row + 1, column, v.y * scale);
    };
    if let Some(place) = before {
        if !has_tension_unknown(strand, k - 1, 1) {
            add(row - 2, place.tangent * place.stretch);
        }
        add(row - 1, -course.rate(start));
    }
    if let Some(place) = after {
        add(row + 2, -place.tangent * place.stretch);
        add(row + 3, course.rate(end));
    }
}

/// The rows of a load that lies, see `point_load`.
fn load_rows(strand: &CableRun, course: &Course, j: usize, system: &mut System) {
    let (r, b, scale) = (&mut system.residual, &mut system.band, scale(strand));
    let (c, place) = (&strand.contacts[j], &system.spots[j].0[0]);
    let (row, p) = (6 * j + 2, c.ends.p[0]);
    // Its material stays as it is, and both of its ends are one.
    b.add(row, row + 1, scale);
    b.add(row + 3, row + 3, scale);
    r[row + 2] = (c.ends.p[1] - p) * scale;
    b.add(row + 2, row + 2, scale);
    b.add(row + 2, row, -scale);
    let Mode::Slide(m) = c.mode else {
        r[row + 1] = (p - point_load::held_at(c)) * scale;
        b.add(row + 1, row, scale);
        return;
    };
    let load_balance = load_balance(strand, course, j);
    let size = 1.0 / larger(load_balance.size, 1e-9 * course.law.load.norm());
    let across = load_balance.tangent + load_balance.normal * m;
    r[row + 1] = load_balance.sum.dot(&across) * size;
    if place.turn != 0.0 {
        b.add(row + 1, row, load_balance.fixed.dot(&(load_balance.tangent * m - load_balance.normal)) * size);
    }
    for (side, sign) in [(0, -size), (1, size)] {
        let g = 6 * (j + side);
        if strand.has_span(j + side) {
            b.add(row + 1, g, sign * across.x);
            b.add(row + 1, g + 1, sign * across.y);
        } else if strand.is_joined(j, side) {
            b.add(row + 1, g, sign);
        }
    }
}

fn contact_rows(strand: &mut CableRun, course: &Course, j: usize, system: &mut System) {
    if strand.contacts[j].is_load() {
        return load_rows(strand, course, j, system);
    }
    let (r, b, (spots, pivot), scale) = (&mut system.residual, &mut system.band, &system.spots[j], scale(strand));
    let c = &strand.contacts[j];
    let track = Track { pivot: Some(*pivot), ..course.track(c) };
    let row = 6 * j + 2;
    let (rows, held) = equations::rows(&track, &c.history, &c.ends, spots, c.mode, pinned(strand, j));
    strand.contacts[j].held = held;
    let c = &strand.contacts[j];
    let tension = larger(larger(c.ends.t[0].abs(), c.ends.t[1].abs()), 1e-9 * course.law.load.norm());
    let size = rows.of_tension.map(|of| if of { 1.0 / tension } else { scale });
    for i in 0..2 {
        r[row + 1 + i] = rows.residual[i] * size[i];
    }
    for side in 0..2 {
        let tangency = row + 3 * side;
        let (p_column, s_column) = (row + 2 * side, row + 2 * side + 1);
        let by = |i: usize, of: usize| rows.by[i][3 * side + of] * size[i];
        if strand.in_pocket(j, side) {
            // Held in the kink without tension: its material is what follows.
            b.add(tangency, p_column, 1.0);
            for i in 0..2 {
                b.add(row + 1 + i, s_column, by(i, 1));
            }
            continue;
        }
        if strand.is_joined(j, side) {
            b.add(tangency, s_column, scale);
            let g = 6 * (j + side);
            for i in 0..2 {
                b.add(row + 1 + i, p_column, by(i, 0));
                b.add(row + 1 + i, s_column, by(i, 1));
                b.add(row + 1 + i, g, by(i, 2));
            }
            continue;
        }
        if is_end(strand, j, side) {
            let s = if side == 0 { strand.from } else { strand.to };
            r[tangency] = (c.ends.s[side] - s) * scale;
            b.add(tangency, s_column, scale);
            // A free end has no tension and finds its place; a held one has a place and finds its
            // tension.
            let of = if has_tension_unknown(strand, j, side) { 2 } else { 0 };
            for i in 0..2 {
                b.add(row + 1 + i, p_column, by(i, of));
                b.add(row + 1 + i, s_column, by(i, 1));
            }
            continue;
        }
        let Some(force) = strand.force_at_contact(course, j, side) else { continue };
        let place = &spots[side];
        let t = force.norm();
        r[tangency] = cross(force, place.tangent) / t;
        // Pointing back is not tangent: keep Newton from it.
        if force.dot(&place.tangent) < 0.0 {
            r[tangency] += 2.0 * r[tangency].signum();
        }
        let (load, u, g) = (course.law.load, force / t, 6 * (j + side));
        // d(F × t)/T with F's own size held.
        let across = Vec2::new(place.tangent.y, -place.tangent.x) / t;
        b.add(tangency, g, across.x);
        b.add(tangency, g + 1, across.y);
        b.add(tangency, s_column, -across.dot(&load));
        b.add(tangency, p_column, place.turn * u.dot(&place.tangent));
        for i in 0..2 {
            b.add(row + 1 + i, p_column, by(i, 0));
            b.add(row + 1 + i, s_column, by(i, 1) - by(i, 2) * u.dot(&load));
            b.add(row + 1 + i, g, by(i, 2) * u.x);
            b.add(row + 1 + i, g + 1, by(i, 2) * u.y);
        }
    }
}
