//! This module assembles the unknowns of a section, its equations, and their derivatives.

use crate::linalg::PivotingBand;
use crate::math::{Vec2, cross, larger};
use crate::model::spans::boundary::{BoundaryPoint, CachedPiece, ContactPath, Mode};
use crate::model::spans::contact::{equations, load_balance, point_load};
use crate::model::spans::section::{CableSection, Contact, EndCondition, SolveContext};

/// A row involves the unknowns of its contact and of both spans beside it: four on either side.
type Band = PivotingBand<4, 13>;

fn count(section: &CableSection) -> usize {
    6 * section.contacts.len() + 2
}

pub(super) fn gather(section: &CableSection, out: &mut Vec<f64>) {
    out.resize(count(section), 0.0);
    let mut blocks = out.chunks_exact_mut(6);
    for ((k, c), block) in section.contacts.iter().enumerate().zip(&mut blocks) {
        let (g, s) = (section.forces[k], c.ends.material);
        block.copy_from_slice(&[g.x, g.y, slot(section, k, 0), s[0], slot(section, k, 1), s[1]]);
    }
    if let ([x, y], Some(g)) = (blocks.into_remainder(), section.forces.last()) {
        (*x, *y) = (g.x, g.y);
    }
}

/// True if the tension of that side of contact j is an unknown of its own.
pub(super) fn has_tension_unknown(section: &CableSection, j: usize, side: usize) -> bool {
    let outer = if side == 0 { j == 0 } else { j + 1 == section.contacts.len() };
    outer && matches!(section.end_conditions[side], EndCondition::Lies(_))
}

/// Marks the ends of contact j that are held on the boundary.
pub(super) fn pinned(section: &CableSection, j: usize) -> [bool; 2] {
    [0, 1].map(|side| has_tension_unknown(section, j, side) || section.is_pinned(j, side))
}

/// True if that side of contact j is a lying end of the section.
fn is_end(section: &CableSection, j: usize, side: usize) -> bool {
    let outer = if side == 0 { j == 0 } else { j + 1 == section.contacts.len() };
    outer && !section.end_conditions[side].has_span()
}

fn slot(section: &CableSection, j: usize, side: usize) -> f64 {
    let e = &section.contacts[j].ends;
    if has_tension_unknown(section, j, side) { e.tension[side] } else { e.place[side] }
}

pub(super) fn scatter(section: &mut CableSection, context: &SolveContext, x: &[f64]) {
    for k in 0..section.spans() {
        let x = &x[6 * k..];
        section.forces[k] = Vec2::new(x[0], x[1]);
        if k < section.contacts.len() {
            for side in 0..2 {
                let (slot, s) = (x[2 + 2 * side], x[3 + 2 * side]);
                let (own, marked) = (has_tension_unknown(section, k, side), section.has_load_material(k, side));
                let c = &mut section.contacts[k];
                let e = &mut c.ends;
                // The material of a load is exact, to the last digit.
                if !marked {
                    e.material[side] = s;
                }
                if own {
                    e.tension[side] = slot;
                } else {
                    e.place[side] = slot;
                }
            }
        }
    }
    section.update_end_tensions(context);
}

/// The equations of a section at a state.
#[derive(Clone, Debug, Default)]
pub(super) struct System {
    pub residual: Vec<f64>,
    /// The Jacobian.
    pub band: Band,
    /// The places of both ends of each contact, and the first with its piece.
    pub end_points: Vec<([BoundaryPoint; 2], CachedPiece)>,
}

/// Assembles the equations of a section at its present state, and finds the stick zone of each
/// contact.
pub(super) fn assemble(section: &mut CableSection, context: &SolveContext, system: &mut System) {
    let n = count(section);
    system.residual.clear();
    system.residual.resize(n, 0.0);
    system.band.reset(n);
    system.end_points.clear();
    let seen = |c: &Contact| CachedPiece::of_ends(&context.curves[c.curve], c.chain_range, &context.law, c.ends.place);
    system.end_points.extend(section.contacts.iter().map(seen));
    for k in 0..section.spans() {
        span_rows(section, context, k, system);
        if k < section.contacts.len() {
            contact_rows(section, context, k, system);
        }
    }
}

/// As [`assemble`], if only the mode of contact j has changed since.
pub(super) fn renew(section: &mut CableSection, context: &SolveContext, j: usize, system: &mut System) {
    if section.contacts[j].is_load() {
        // A contact that is joined to it sticks or slides with it.
        return assemble(section, context, system);
    }
    for row in 6 * j + 2..6 * j + 6 {
        system.residual[row] = 0.0;
        system.band.clear(row);
    }
    contact_rows(section, context, j, system);
}

/// Factor of relative lengths in residuals: lengths in hundredths of the section, and tensions
/// relative to the greatest, then stop an iteration at the same size. Smaller: shapes are less
/// accurate than tensions; larger: tensions are less accurate. A choice, tuned on no campaign.
const LENGTH_UNITS: f64 = 100.0;

/// Length of cable (m) whose load is the least force by which residuals of forces are divided.
/// Smaller: contacts almost without tension never converge; larger: their friction is less
/// accurate.
const MIN_FORCE_LENGTH_M: f64 = 1e-9;

/// Factor that converts lengths (m) to hundredths of the section.
fn scale(section: &CableSection) -> f64 {
    LENGTH_UNITS / (section.to - section.from)
}

fn span_rows(section: &CableSection, context: &SolveContext, k: usize, system: &mut System) {
    let (row, scale) = (6 * k, scale(section));
    let (r, band) = (&mut system.residual, &mut system.band);
    let m = section.contacts.len();
    if k > 0 && section.is_joined(k, 0) {
        // Both are at one place; the tension is stored in the place of the force.
        r[row] = (section.contacts[k - 1].ends.place[1] - section.contacts[k].ends.place[0]) * scale;
        band.add(row, row - 2, scale);
        band.add(row, row + 2, -scale);
        let size = 1.0 / larger(section.forces[k].x.abs(), MIN_FORCE_LENGTH_M * context.law.load.norm());
        r[row + 1] = section.forces[k].y * size;
        band.add(row + 1, row + 1, size);
        return;
    }
    let known = if !section.has_span(k) {
        Some(section.forces[k])
    } else if k == 0 && matches!(section.end_conditions[0], EndCondition::Hangs(_)) {
        section.hanging(context, 0)
    } else if k == m && matches!(section.end_conditions[1], EndCondition::Hangs(_)) {
        section.hanging(context, 1)
    } else {
        None
    };
    if let Some(g) = known {
        let d = section.forces[k] - g;
        let size = 1.0 / (g.norm() + context.law.load.norm() * (section.to - section.from)).max(f64::MIN_POSITIVE);
        (r[row], r[row + 1]) = (d.x * size, d.y * size);
        band.add(row, row, size);
        band.add(row + 1, row + 1, size);
        return;
    }
    let before = k.checked_sub(1).map(|j| &system.end_points[j].0[1]);
    let after = system.end_points.get(k).map(|s| &s.0[0]);
    let held = |t: &EndCondition| if let EndCondition::Fixed(at) = t { Some(*at) } else { None };
    let ends = (
        before.map_or_else(|| held(&section.end_conditions[0]), |s| Some(s.at)),
        after.map_or_else(|| held(&section.end_conditions[1]), |s| Some(s.at)),
    );
    let (Some(a), Some(b)) = ends else { return };
    let (from, to) = section.material(k);
    let (start, end) = (section.force(context, k, from), section.force(context, k, to));
    let (way, compliance) = context.chain(from, to).reach(start);
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
        if !has_tension_unknown(section, k - 1, 1) {
            add(row - 2, place.tangent * place.stretch);
        }
        add(row - 1, -context.rate(start));
    }
    if let Some(place) = after {
        add(row + 2, -place.tangent * place.stretch);
        add(row + 3, context.rate(end));
    }
}

/// Adds the rows of a load that lies on a boundary, see `point_load`.
fn load_rows(section: &CableSection, context: &SolveContext, j: usize, system: &mut System) {
    let (r, b, scale) = (&mut system.residual, &mut system.band, scale(section));
    let (c, place) = (&section.contacts[j], &system.end_points[j].0[0]);
    let (row, p) = (6 * j + 2, c.ends.place[0]);
    // Its material is constant, and both of its ends coincide.
    b.add(row, row + 1, scale);
    b.add(row + 3, row + 3, scale);
    r[row + 2] = (c.ends.place[1] - p) * scale;
    b.add(row + 2, row + 2, scale);
    b.add(row + 2, row, -scale);
    let Mode::Slip(m) = c.mode else {
        r[row + 1] = (p - point_load::held_at(c)) * scale;
        b.add(row + 1, row, scale);
        return;
    };
    let load_balance = load_balance(section, context, j);
    let size = 1.0 / larger(load_balance.size, MIN_FORCE_LENGTH_M * context.law.load.norm());
    let across = load_balance.tangent + load_balance.normal * m;
    r[row + 1] = load_balance.sum.dot(&across) * size;
    if place.turn != 0.0 {
        b.add(row + 1, row, load_balance.fixed.dot(&(load_balance.tangent * m - load_balance.normal)) * size);
    }
    for (side, sign) in [(0, -size), (1, size)] {
        let g = 6 * (j + side);
        if section.has_span(j + side) {
            b.add(row + 1, g, sign * across.x);
            b.add(row + 1, g + 1, sign * across.y);
        } else if section.is_joined(j, side) {
            b.add(row + 1, g, sign);
        }
    }
}

fn contact_rows(section: &mut CableSection, context: &SolveContext, j: usize, system: &mut System) {
    if section.contacts[j].is_load() {
        return load_rows(section, context, j, system);
    }
    let (r, b, (end_points, cached_piece), scale) =
        (&mut system.residual, &mut system.band, &system.end_points[j], scale(section));
    let c = &section.contacts[j];
    let contact_path = ContactPath { cached_piece: Some(*cached_piece), ..context.contact_path(c) };
    let row = 6 * j + 2;
    let (rows, held) = equations::rows(&contact_path, &c.history, &c.ends, end_points, c.mode, pinned(section, j));
    section.contacts[j].held = held;
    let c = &section.contacts[j];
    let tension =
        larger(larger(c.ends.tension[0].abs(), c.ends.tension[1].abs()), MIN_FORCE_LENGTH_M * context.law.load.norm());
    let size = rows.of_tension.map(|of| if of { 1.0 / tension } else { scale });
    for i in 0..2 {
        r[row + 1 + i] = rows.residual[i] * size[i];
    }
    for side in 0..2 {
        let tangency = row + 3 * side;
        let (p_column, s_column) = (row + 2 * side, row + 2 * side + 1);
        let by = |i: usize, of: usize| rows.by[i][3 * side + of] * size[i];
        if section.in_pocket(j, side) {
            // It is held in the kink without tension, and its material is the unknown.
            b.add(tangency, p_column, 1.0);
            for i in 0..2 {
                b.add(row + 1 + i, s_column, by(i, 1));
            }
            continue;
        }
        if section.is_joined(j, side) {
            b.add(tangency, s_column, scale);
            let g = 6 * (j + side);
            for i in 0..2 {
                b.add(row + 1 + i, p_column, by(i, 0));
                b.add(row + 1 + i, s_column, by(i, 1));
                b.add(row + 1 + i, g, by(i, 2));
            }
            continue;
        }
        if is_end(section, j, side) {
            let s = if side == 0 { section.from } else { section.to };
            r[tangency] = (c.ends.material[side] - s) * scale;
            b.add(tangency, s_column, scale);
            // A free end has a known tension and an unknown place; a held end has a known place and
            // an unknown tension.
            let of = if has_tension_unknown(section, j, side) { 2 } else { 0 };
            for i in 0..2 {
                b.add(row + 1 + i, p_column, by(i, of));
                b.add(row + 1 + i, s_column, by(i, 1));
            }
            continue;
        }
        let Some(force) = section.force_at_contact(context, j, side) else { continue };
        let place = &end_points[side];
        let t = force.norm();
        r[tangency] = cross(force, place.tangent) / t;
        // A force that points backwards is not tangent, and Newton's method must not converge to
        // it.
        if force.dot(&place.tangent) < 0.0 {
            r[tangency] += 2.0 * r[tangency].signum();
        }
        let (load, u, g) = (context.law.load, force / t, 6 * (j + side));
        // This is d(F × t)/T at constant size of F.
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
