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

/// Writes the unknowns of a section to `out`: forces of the spans, ends and material of the
/// contacts.
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

/// Sets the unknowns of a section to `x`.
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
pub(super) struct SectionEquations {
    pub residual: Vec<f64>,
    /// The Jacobian.
    pub band: Band,
    /// The places of both ends of each contact, and the first with its piece.
    pub end_points: Vec<([BoundaryPoint; 2], CachedPiece)>,
}

/// Assembles the equations of a section at its present state, and finds the stick zone of each
/// contact.
pub(super) fn assemble(section: &mut CableSection, context: &SolveContext, system: &mut SectionEquations) {
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
pub(super) fn renew(section: &mut CableSection, context: &SolveContext, j: usize, system: &mut SectionEquations) {
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

/// Adds the two rows of span k.
fn span_rows(section: &CableSection, context: &SolveContext, k: usize, system: &mut SectionEquations) {
    if k > 0 && section.is_joined(k, 0) {
        joined_rows(section, context, k, system);
    } else if let Some(force) = known_force(section, context, k) {
        known_force_rows(section, context, k, force, system);
    } else {
        chord_rows(section, context, k, system);
    }
}

/// Adds the rows between two contacts without a span: both are at one place, and the tension is
/// stored in the place of the force.
fn joined_rows(section: &CableSection, context: &SolveContext, k: usize, system: &mut SectionEquations) {
    let (row, scale) = (6 * k, scale(section));
    let (r, band) = (&mut system.residual, &mut system.band);
    r[row] = (section.contacts[k - 1].ends.place[1] - section.contacts[k].ends.place[0]) * scale;
    band.add(row, row - 2, scale);
    band.add(row, row + 2, -scale);
    let size = 1.0 / larger(section.forces[k].x.abs(), MIN_FORCE_LENGTH_M * context.law.load.norm());
    r[row + 1] = section.forces[k].y * size;
    band.add(row + 1, row + 1, size);
}

/// The force of span k if no equation of its shape determines it: of one that hangs free, or of
/// none at a lying end.
fn known_force(section: &CableSection, context: &SolveContext, k: usize) -> Option<Vec2> {
    let hangs = |side: usize| matches!(section.end_conditions[side], EndCondition::Hangs(_));
    if !section.has_span(k) {
        Some(section.forces[k])
    } else if k == 0 && hangs(0) {
        section.hanging(context, 0)
    } else if k == section.contacts.len() && hangs(1) {
        section.hanging(context, 1)
    } else {
        None
    }
}

/// Adds the rows of span `k` whose force is known (N).
fn known_force_rows(
    section: &CableSection,
    context: &SolveContext,
    k: usize,
    force: Vec2,
    system: &mut SectionEquations,
) {
    let (row, band) = (6 * k, &mut system.band);
    let d = section.forces[k] - force;
    let size = 1.0 / (force.norm() + context.law.load.norm() * (section.to - section.from)).max(f64::MIN_POSITIVE);
    (system.residual[row], system.residual[row + 1]) = (d.x * size, d.y * size);
    band.add(row, row, size);
    band.add(row + 1, row + 1, size);
}

/// Adds the rows that let span k reach from one of its ends to the other.
fn chord_rows(section: &CableSection, context: &SolveContext, k: usize, system: &mut SectionEquations) {
    let (row, scale) = (6 * k, scale(section));
    let (r, band) = (&mut system.residual, &mut system.band);
    let before = k.checked_sub(1).map(|j| &system.end_points[j].0[1]);
    let after = system.end_points.get(k).map(|s| &s.0[0]);
    let support_place = |t: &EndCondition| if let EndCondition::Fixed(at) = t { Some(*at) } else { None };
    let start_at = before.map_or_else(|| support_place(&section.end_conditions[0]), |s| Some(s.at));
    let end_at = after.map_or_else(|| support_place(&section.end_conditions[1]), |s| Some(s.at));
    let (Some(a), Some(b)) = (start_at, end_at) else { return };
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
fn load_rows(section: &CableSection, context: &SolveContext, j: usize, system: &mut SectionEquations) {
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
        r[row + 1] = (p - point_load::place_before(c)) * scale;
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

/// One end of a contact: its row of tangency and its part of the two rows of material.
struct ContactEnd {
    /// Index of the contact.
    contact: usize,
    side: usize,
    /// Derivatives of the two rows of material by the place, the material and the tension of this
    /// end.
    by: [[f64; 3]; 2],
}

impl ContactEnd {
    fn tangency_row(&self) -> usize {
        6 * self.contact + 2 + 3 * self.side
    }

    fn material_row(&self, i: usize) -> usize {
        6 * self.contact + 3 + i
    }

    /// The column of its place, or of its tension if that is an unknown of its own.
    fn place_column(&self) -> usize {
        6 * self.contact + 2 + 2 * self.side
    }

    fn material_column(&self) -> usize {
        self.place_column() + 1
    }

    /// The first column of the force of the span beyond it.
    fn force_column(&self) -> usize {
        6 * (self.contact + self.side)
    }

    /// Adds the row of tangency, or that which replaces it, and its columns to the rows of
    /// material.
    fn add_to(&self, section: &CableSection, context: &SolveContext, system: &mut SectionEquations) {
        let (b, scale, by) = (&mut system.band, scale(section), &self.by);
        let (p, s) = (self.place_column(), self.material_column());
        if section.in_pocket(self.contact, self.side) {
            // It is held in the kink without tension, and its material is the unknown.
            b.add(self.tangency_row(), p, 1.0);
            for i in 0..2 {
                b.add(self.material_row(i), s, by[i][1]);
            }
        } else if section.is_joined(self.contact, self.side) {
            b.add(self.tangency_row(), s, scale);
            for i in 0..2 {
                b.add(self.material_row(i), p, by[i][0]);
                b.add(self.material_row(i), s, by[i][1]);
                b.add(self.material_row(i), self.force_column(), by[i][2]);
            }
        } else if is_end(section, self.contact, self.side) {
            let end = if self.side == 0 { section.from } else { section.to };
            let material = section.contacts[self.contact].ends.material[self.side];
            system.residual[self.tangency_row()] = (material - end) * scale;
            b.add(self.tangency_row(), s, scale);
            // A free end has a known tension and an unknown place; a held end has a known place and
            // an unknown tension.
            let of = if has_tension_unknown(section, self.contact, self.side) { 2 } else { 0 };
            for i in 0..2 {
                b.add(self.material_row(i), p, by[i][of]);
                b.add(self.material_row(i), s, by[i][1]);
            }
        } else if let Some(force) = section.force_at_contact(context, self.contact, self.side) {
            self.add_tangency(force, context.law.load, system);
        }
    }

    /// Adds the row of tangency to the span beyond it, which has the force (N) there, and its
    /// columns to the rows of material.
    fn add_tangency(&self, force: Vec2, load: Vec2, system: &mut SectionEquations) {
        let (r, b) = (&mut system.residual, &mut system.band);
        let place = &system.end_points[self.contact].0[self.side];
        let (p, s, g) = (self.place_column(), self.material_column(), self.force_column());
        let row = self.tangency_row();
        let t = force.norm();
        r[row] = cross(force, place.tangent) / t;
        // A force that points backwards is not tangent, and Newton's method must not converge to
        // it.
        if force.dot(&place.tangent) < 0.0 {
            r[row] += 2.0 * r[row].signum();
        }
        let u = force / t;
        // This is d(F × t)/T at constant size of F.
        let across = Vec2::new(place.tangent.y, -place.tangent.x) / t;
        b.add(row, g, across.x);
        b.add(row, g + 1, across.y);
        b.add(row, s, -across.dot(&load));
        b.add(row, p, place.turn * u.dot(&place.tangent));
        for (i, by) in self.by.iter().enumerate() {
            b.add(self.material_row(i), p, by[0]);
            b.add(self.material_row(i), s, by[1] - by[2] * u.dot(&load));
            b.add(self.material_row(i), g, by[2] * u.x);
            b.add(self.material_row(i), g + 1, by[2] * u.y);
        }
    }
}

/// Adds the four rows of contact j: tangency at both ends, and two of its material.
fn contact_rows(section: &mut CableSection, context: &SolveContext, j: usize, system: &mut SectionEquations) {
    if section.contacts[j].is_load() {
        return load_rows(section, context, j, system);
    }
    let (end_points, cached_piece) = &system.end_points[j];
    let c = &section.contacts[j];
    let contact_path = ContactPath { cached_piece: Some(*cached_piece), ..context.contact_path(c) };
    let (rows, stick_zone) =
        equations::rows(&contact_path, &c.history, &c.ends, end_points, c.mode, pinned(section, j));
    section.contacts[j].stick_zone = stick_zone;
    let [t1, t2] = section.contacts[j].ends.tension.map(f64::abs);
    let tension = larger(larger(t1, t2), MIN_FORCE_LENGTH_M * context.law.load.norm());
    let size = rows.of_tension.map(|of| if of { 1.0 / tension } else { scale(section) });
    for i in 0..2 {
        system.residual[6 * j + 3 + i] = rows.residual[i] * size[i];
    }
    for side in 0..2 {
        let by = [0, 1].map(|i| [0, 1, 2].map(|of| rows.by[i][3 * side + of] * size[i]));
        ContactEnd { contact: j, side, by }.add_to(section, context, system);
    }
}
