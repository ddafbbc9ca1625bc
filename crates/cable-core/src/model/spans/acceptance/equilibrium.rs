//! This check does not use the solver: it computes lengths by quadrature of the law of the free
//! cable, the balance of each contact from its ends, and the friction cone along it. `clearance`
//! checks that nothing is inside an obstacle.

use crate::error::EquilibriumFault;
use crate::math::{GAUSS_5, Vec2, bounded, cross};
use crate::model::spans::boundary::{ContactPath, SlideResult};
use crate::model::spans::contact::{load_balance, point_load, slack_pocket};
use crate::model::spans::results::{end_force, loose, obstacle_force, wheel_force};
use crate::model::spans::section::{CableEquilibrium, CableSection, Contact, EndCondition, Failure, SolveContext};
use crate::model::spans::section_layout::SectionLayout;

/// Tension that is none, N: what round-off leaves where the greatest tension is nearly zero.
/// Smaller: cables of a few milligrams are refused; larger: compression of such cables passes.
const FORCE_ROUNDING_N: f64 = 1e-9;

/// Relative error with which equations of length, tension and angle must hold. The solver stops at
/// 1e-11.
const BALANCE_TOLERANCE: f64 = 1e-7;
/// Compression that counts as round-off, as a fraction of the greatest tension.
const COMPRESSION_ROUNDING: f64 = 1e-9;
/// Distance (m or rad) by which a contact may end beyond its chain (round-off).
const CHAIN_END_TOLERANCE: f64 = 1e-9;
/// Number of points of a contact that are checked if its load has changed.
const SAMPLES: usize = 8;
/// Force across the load below which a span hangs in one line, as a fraction of its load.
const FOLD_FORCE_FRACTION: f64 = 1e-12;
/// Panels of a span beside its fold.
const TAUT_PANELS: usize = 4;
/// Distance of a fold from its span, in lengths of the span, from which one panel leaves an error
/// of 1e-12.
const ONE_PANEL_FOLD_DISTANCE: f64 = 4.0;
/// Length of a panel of the quadrature of a span, in v; 5 Gauss points in each leave an error of
/// 1e-12.
const PANEL_LENGTH: f64 = 0.5;

/// Returns an error unless the solution satisfies equilibrium. The caller keeps the stick zones
/// with which the contacts were solved.
pub(in crate::model::spans) fn verify(section: &CableSection, context: &SolveContext) -> Result<(), Failure> {
    let mut before = section.from;
    let greatest = section
        .contacts
        .iter()
        .flat_map(|c| c.ends.tension)
        .chain(
            (0..section.spans())
                .filter(|&k| section.has_span(k))
                .map(|k| section.force(context, k, section.material(k).0).norm()),
        )
        .fold(0.0f64, |m, t| if t > m { t } else { m });
    for k in 0..section.spans() {
        let (from, to) = section.material(k);
        let long = section.to - section.from;
        // A pocket with a smaller shortage is not opened.
        if !(from >= before - BALANCE_TOLERANCE * long && to >= from - slack_pocket::POCKET_SHORTAGE_FRACTION * long) {
            return Err(Failure::Unsound { what: EquilibriumFault::MaterialOrder, s: from, at: Vec2::zeros() });
        }
        before = to;
        if section.has_span(k) {
            span(section, context, k)?;
        }
        if k < section.contacts.len() {
            contact(section, context, k, greatest)?;
        }
    }
    Ok(())
}

/// Checks that the reported forces of supports and contacts balance weight and loads: an error that
/// no part of the equilibrium shows by itself appears here.
pub(in crate::model::spans) fn balanced(
    layout: &SectionLayout,
    cable_equilibrium: &CableEquilibrium,
) -> Result<(), Failure> {
    let (left, size) = unbalanced(layout, cable_equilibrium);
    if left.norm() <= BALANCE_TOLERANCE * size {
        return Ok(());
    }
    let section = cable_equilibrium.sections.first();
    let at = section.and_then(|s| s.span_ends(&cable_equilibrium.context, 0)[0]).unwrap_or_default();
    Err(Failure::Unsound { what: EquilibriumFault::Unbalanced, s: 0.0, at })
}

/// The sum of all reported forces on the cable, and their size, N.
fn unbalanced(layout: &SectionLayout, cable_equilibrium: &CableEquilibrium) -> (Vec2, f64) {
    let (p, context) = (&layout.problem, &cable_equilibrium.context);
    let mut sum = context.law.load * p.length;
    let mut size = sum.norm();
    for load in &context.loads {
        sum += load.force;
        size += load.force.norm();
    }
    let mut add = |force: Vec2| {
        sum += force;
        size += force.norm();
    };
    for (section, part) in cable_equilibrium.sections.iter().zip(&layout.sections) {
        for side in 0..2 {
            if part.supports[side].is_some() {
                add(end_force(cable_equilibrium, section, side) * if side == 0 { -1.0 } else { 1.0 });
            }
        }
        if let Some(loose) = &section.loose {
            add(loose.obstacle_force(context));
        }
        for (j, c) in section.contacts.iter().enumerate() {
            add(match (c.wheel, c.is_load()) {
                (Some(_), _) => -wheel_force(context, section, j).0,
                (None, true) => -load_balance(section, context, j).sum,
                (None, false) => obstacle_force(&context.contact_path(c), c),
            });
            if let (Some([from, to]), None) = (loose(section, j), c.wheel) {
                add(-context.load_between(from, to));
            }
        }
    }
    (sum, size)
}

/// Checks that the span closes.
fn span(section: &CableSection, context: &SolveContext, k: usize) -> Result<(), Failure> {
    let (from, to) = section.material(k);
    if let [Some(a), Some(b)] = section.span_ends(context, k) {
        let (mut at, mut before) = (a, from);
        let loads = context.loads.iter().map(|l| l.arc_length).filter(|s| *s > from && *s < to);
        for next in loads.chain(std::iter::once(to)) {
            at += way(section, context, k, [before, next]);
            before = next;
        }
        if !((at - b).norm() <= BALANCE_TOLERANCE * (section.to - section.from)) {
            return Err(Failure::Unsound { what: EquilibriumFault::SpanOpen, s: from, at });
        }
    }
    Ok(())
}

/// The chord of a catenary by quadrature of f(F) = τ(F/T + F/EA).
///
/// With b along the load, H the part of F across it and s* where F is across it, s = s* + (H/b)
/// sinh v makes T = H cosh v: smooth however sharp the cable folds. Straight up and down (H = 0)
/// the integral is split at the fold.
fn way(section: &CableSection, context: &SolveContext, k: usize, [from, to]: [f64; 2]) -> Vec2 {
    // The force is evaluated inside the piece, because a load at its start acts before it.
    let start = section.force(context, k, 0.5 * (from + to)) + context.law.load * (0.5 * (to - from));
    let force = |s: f64| start - context.law.load * (s - from);
    let b = context.law.load.norm();
    let across = if b > 0.0 { cross(start, context.law.load).abs() / b } else { 0.0 };
    if !(across > FOLD_FORCE_FRACTION * b * (to - from)) {
        let fold = if b > 0.0 { bounded(from + start.dot(&context.law.load) / (b * b), from, to) } else { to };
        let straight =
            |a: f64, c: f64| if c > a { context.rate(force(0.5 * (a + c))) * (c - a) } else { Vec2::zeros() };
        return straight(from, fold) + straight(fold, to);
    }
    let middle = from + start.dot(&context.law.load) / (b * b);
    // T² = H² + b² (s − s*)² is smooth far from s* ± i H/b.
    let far = (0.5 * (from + to) - middle).hypot(across / b);
    if middle < 2.0 * from - to || middle > 2.0 * to - from || far > ONE_PANEL_FOLD_DISTANCE * (to - from) {
        let panels = if far > ONE_PANEL_FOLD_DISTANCE * (to - from) { 1 } else { TAUT_PANELS };
        let h = (to - from) / panels as f64;
        let points = (0..panels).flat_map(|j| GAUSS_5.map(|(u, weight)| (from + (j as f64 + u) * h, weight * h)));
        return points.fold(Vec2::zeros(), |sum, (s, weight)| sum + context.rate(force(s)) * weight);
    }
    let (v0, v1) = ((b * (from - middle) / across).asinh(), (b * (to - middle) / across).asinh());
    let panels = ((v1 - v0) / PANEL_LENGTH).ceil().max(1.0);
    let h = (v1 - v0) / panels;
    let mut sum = Vec2::zeros();
    for j in 0..panels as usize {
        for (u, weight) in GAUSS_5 {
            let v = v0 + (j as f64 + u) * h;
            sum += context.rate(force(middle + across / b * v.sinh())) * (weight * h * across / b * v.cosh());
        }
    }
    sum
}

/// Checks that a contact presses, has no compression, keeps the friction cone, and that the spans
/// leave it along its tangent.
fn contact(section: &CableSection, context: &SolveContext, j: usize, greatest: f64) -> Result<(), Failure> {
    let c = &section.contacts[j];
    let (contact_path, e) = (context.contact_path(c).with_cached_piece(c.ends.place[0]), &c.ends);
    let unsound = |what: EquilibriumFault, p: f64, s: f64| Failure::Unsound { what, s, at: contact_path.place(p).at };
    let (first, last) = (contact_path.curve.origin(c.chain_range.first), contact_path.curve.end(c.chain_range.last));
    if !(contact_path.curve.is_round()
        || e.place[0] >= first - CHAIN_END_TOLERANCE && e.place[1] <= last + CHAIN_END_TOLERANCE)
    {
        return Err(unsound(EquilibriumFault::ContactBeyondBoundary, e.place[0], e.material[0]));
    }
    if c.is_load() {
        return point_load::verify(section, context, j);
    }
    for side in 0..2 {
        if let Some(force) = section.force_at_contact(context, j, side) {
            let tangent = contact_path.place(e.place[side]).tangent;
            if !(cross(force, tangent).abs() <= BALANCE_TOLERANCE * force.norm() && force.dot(&tangent) > 0.0) {
                return Err(unsound(EquilibriumFault::SpanNotTangent, e.place[side], e.material[side]));
            }
        } else if section.in_pocket(j, side) {
            if e.tension[side] != 0.0 {
                return Err(unsound(EquilibriumFault::SlackUnderTension, e.place[side], e.material[side]));
            }
            if side == 1 && slack_pocket::heap(section, context, j + 1).is_none() {
                return Err(unsound(EquilibriumFault::LooseCableSlides, e.place[side], e.material[side]));
            }
        } else if section.is_joined(j, side) {
            // The load beside it is checked by itself.
        } else if let EndCondition::Loose(force) = section.end_conditions[side] {
            let lifts = force.dot(&contact_path.place(e.place[side]).normal);
            if !((e.tension[side] - context.pull(c, side, force)).abs() <= BALANCE_TOLERANCE * greatest
                && lifts <= BALANCE_TOLERANCE * force.norm())
            {
                return Err(unsound(EquilibriumFault::EndTension, e.place[side], e.material[side]));
            }
        }
        if !(e.tension[side] >= -COMPRESSION_ROUNDING * greatest - FORCE_ROUNDING_N) {
            return Err(Failure::Compressed {
                s: e.material[side],
                at: contact_path.place(e.place[side]).at,
                tension: e.tension[side],
            });
        }
    }
    if let Some(l) = context
        .loads
        .iter()
        .find(|l| l.arc_length > e.material[0] && l.arc_length < e.material[1] && l.force.norm() > 0.0)
    {
        return Err(Failure::LoadInContact { s: l.arc_length });
    }
    along(&contact_path, c, greatest, section.to - section.from)
}

/// Material that may be missing along a contact, as a fraction of the section's length. Smaller:
/// contacts made from the nodes of another model, whose material is known only to the distance of
/// those nodes, are refused; larger: folds are lost (8 cm of 20 m were).
const LOST_MATERIAL_FRACTION: f64 = 1e-4;

/// Checks that along a contact friction keeps its cone, and that there is no compression and no
/// pull on the obstacle. Between two breakpoints the mobilised friction is constant, so a check at
/// the breakpoints suffices. No material of the section's `length` (m) may be lost between two
/// breakpoints, or between the ends and the first and last of them.
fn along(contact_path: &ContactPath<'_>, c: &Contact, greatest: f64, length: f64) -> Result<(), Failure> {
    let friction = contact_path.friction_of_loose;
    let room = BALANCE_TOLERANCE * (greatest + FORCE_ROUNDING_N);
    let lost = |found: f64, expected: f64| !((found - expected).abs() <= LOST_MATERIAL_FRACTION * length);
    if let (0.0, [first, .., last]) = (contact_path.drag, c.history.breakpoints())
        && (lost(first.arc_length, c.ends.material[0]) || lost(last.arc_length, c.ends.material[1]))
    {
        return Err(Failure::Unsound {
            what: EquilibriumFault::MaterialAtContactEnd,
            s: first.arc_length,
            at: contact_path.place(first.coordinate).at,
        });
    }
    for pair in c.history.breakpoints().windows(2) {
        let (breakpoint, next) = (&pair[0], &pair[1]);
        let (mut p, mut t, mut s) = (breakpoint.coordinate, breakpoint.tension, breakpoint.arc_length);
        let unsound = |what: EquilibriumFault| {
            Err(Failure::Unsound { what, s: breakpoint.arc_length, at: contact_path.place(breakpoint.coordinate).at })
        };
        while p < next.coordinate {
            let q = contact_path.next_border(p, next.coordinate);
            let whole = contact_path.slide(p, q, t, breakpoint.mobilised);
            let look = |x: f64, way: SlideResult| {
                let place = contact_path.place(x);
                if !(way.tension >= -COMPRESSION_ROUNDING * greatest - FORCE_ROUNDING_N) {
                    return Err(Failure::Compressed { s: s + way.material, at: place.at, tension: way.tension });
                }
                if !(contact_path.law.press(&place, way.tension) >= -room) {
                    return unsound(EquilibriumFault::ContactPulls);
                }
                Ok(())
            };
            if !firm(contact_path, p, q, t, breakpoint.mobilised) {
                let mut found = look(q, whole);
                contact_path.minimum_candidates(p, q, breakpoint.mobilised, |x| {
                    found = found.clone().and_then(|()| look(x, contact_path.slide(p, x, t, breakpoint.mobilised)))
                });
                found?;
            }
            (p, t, s) = (q, whole.tension, s + whole.material);
        }
        // While it slides under a drag, it is not an answer yet.
        if contact_path.drag > 0.0 {
            continue;
        }
        if !(breakpoint.mobilised.abs() <= friction * (1.0 + BALANCE_TOLERANCE)) {
            return unsound(EquilibriumFault::FrictionBeyondCone);
        }
        if lost(s, next.arc_length) {
            return unsound(EquilibriumFault::MaterialAlongContact);
        }
        if !((t - next.tension).abs() <= room) {
            return sampled(contact_path, c, friction, room);
        }
    }
    Ok(())
}

/// True if tension and pressure cannot vanish on a short distance round an arc: dT/dp > −|m|T −
/// 2cb, and N ds/dp > T − cb.
fn firm(contact_path: &ContactPath<'_>, p: f64, q: f64, t: f64, m: f64) -> bool {
    let place = contact_path.place(p);
    let load = place.stretch * contact_path.law.load.norm() / contact_path.law.thermal;
    place.turn != 0.0
        && contact_path.law.stiffness > 0.0
        && t - (q - p) * (m.abs() * t + 2.0 * load) > load
        && m.abs() <= 1.0
}

/// Checks the friction cone from point to point if the load has changed since cable was laid: in a
/// stick zone friction must take up the change.
fn sampled(contact_path: &ContactPath<'_>, c: &Contact, friction: f64, room: f64) -> Result<(), Failure> {
    let past = &c.history;
    let [first, last] = c.ends.place;
    let (mut p, mut t) = (first, past.at(contact_path, first).0);
    for i in 1..=SAMPLES {
        let q = first + (last - first) * i as f64 / SAMPLES as f64;
        let (next, s) = past.at(contact_path, q);
        let (low, high) =
            (contact_path.slide(p, q, t, -friction).tension, contact_path.slide(p, q, t, friction).tension);
        if !(next >= low - room && next <= high + room) {
            return Err(Failure::Unsound {
                what: EquilibriumFault::FrictionBeyondCone,
                s,
                at: contact_path.place(q).at,
            });
        }
        (p, t) = (q, next);
    }
    Ok(())
}
