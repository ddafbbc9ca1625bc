//! This module lays a span that runs into an obstacle down on it.

use crate::contact::swept_corners::{self, ImpassableCorner};
use crate::contact::{Gap, World};
use crate::math::{Vec2, cross, perp};
use crate::model::spans::acceptance::tunnelling;
use crate::model::spans::boundary::{ChainRange, Ends, Mode, SUPPORT_CONTACT_DISTANCE_M, TensionProfile};
use crate::model::spans::changes::edge_crossing::{beyond_edges, move_neighbours_over_edges};
use crate::model::spans::changes::load_landing;
use crate::model::spans::changes::obstacle_search::{Penetration, deepest};
use crate::model::spans::contact::release_below;
use crate::model::spans::newton::Workspace;
use crate::model::spans::section::{CableSection, Contact, EndCondition, Failure, SolveContext};

/// Depth inside an obstacle from which a span touches it, as a fraction of the section.
const DEPTH_FRACTION: f64 = 1e-9;

/// The purpose of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SolvePurpose {
    /// A first equilibrium is sought: contacts found meanwhile are frictionless.
    FirstEquilibrium,
    /// A step in time is followed.
    Step,
}

/// Lays each span down on the obstacle in which it is deepest; returns whether there was any.
pub(super) fn touch_obstacles(
    section: &mut CableSection,
    context: &SolveContext,
    world: &World,
    purpose: SolvePurpose,
) -> Result<bool, Failure> {
    if world.is_empty() {
        return Ok(false);
    }
    let deep = DEPTH_FRACTION * (section.to - section.from);
    let mut any = false;
    // The loop starts at the last span, so that the earlier ones keep their indices.
    for k in (0..section.spans()).rev() {
        if let Some(landing) = load_landing::find(section, context, world, k, deep) {
            load_landing::touch(section, context, k, &landing)?;
            any = true;
            continue;
        }
        if let Some(hit) = deepest(section, context, world, k, deep) {
            land_span(section, context, k, &hit, purpose)?;
            any = true;
        }
    }
    Ok(any)
}

/// The point of a section that is nearest to a corner.
#[derive(Clone, Copy, Debug)]
struct NearestPoint {
    /// Distance from the corner, m.
    distance: f64,
    span: usize,
    /// Arc length, m.
    arc_length: f64,
    at: Vec2,
    /// Force in the cable, N.
    force: Vec2,
}

/// Lays the cable on a corner through which it has passed since its route; returns whether there
/// was one.
pub(super) fn touch_passed_corner(
    section: &mut CableSection,
    context: &SolveContext,
    corners: &[ImpassableCorner],
    route: &[Vec2],
    workspace: &mut Workspace,
) -> Result<bool, Failure> {
    let mut shape = Vec::new();
    tunnelling::shape(section, context, &mut shape);
    let Some(corner) = swept_corners::through(corners, route, &shape, &mut workspace.turns) else { return Ok(false) };
    let mut nearest: Option<NearestPoint> = None;
    let points = context.settings.changes.corner_search_points;
    for k in (0..section.spans()).filter(|&k| section.has_span(k)) {
        section.shapes(context, k, |s0, at, c| {
            for i in 1..points {
                let s = c.span().length * i as f64 / points as f64;
                let p = at + c.position_at(s);
                let d = (p - corner.at).norm();
                if nearest.is_none_or(|n| d < n.distance) {
                    nearest =
                        Some(NearestPoint { distance: d, span: k, arc_length: s0 + s, at: p, force: c.force_at(s) });
                }
            }
        });
    }
    let Some(NearestPoint { span: k, arc_length: s, at, force, .. }) = nearest else { return Ok(false) };
    let tangent = force / force.norm();
    // The corner is on the wrong side of the cable: the contact pushes it to the other one.
    let normal = perp(tangent) * cross(tangent, corner.at - at).signum();
    let gap = Gap {
        gap_m: -(corner.at - at).norm(),
        normal,
        point: corner.at,
        fraction: 0.0,
        friction: 0.0,
        obstacle: 0,
        feature: corner.feature,
    };
    land_span(
        section,
        context,
        k,
        &Penetration { arc_length: s, at: corner.at, tangent, gap, body: corner.body },
        SolvePurpose::FirstEquilibrium,
    )?;
    Ok(true)
}

/// Lays span k down where it is deepest in an obstacle: the contact beside it is extended to there,
/// or a new one is made.
fn land_span(
    section: &mut CableSection,
    context: &SolveContext,
    k: usize,
    hit: &Penetration,
    purpose: SolvePurpose,
) -> Result<(), Failure> {
    let impossible = Failure::ContactImpossible { s: hit.arc_length, at: hit.at };
    let back = hit.gap.normal.dot(&perp(hit.tangent)) < 0.0;
    let curve_index = 2 * hit.body + usize::from(back);
    let Some(curve) = context.curves.get(curve_index) else { return Err(impossible) };
    let load = context.law.load;
    // The feature of a kink has no piece of its own: its edges have.
    let kink = || [1, 3].into_iter().find_map(|back| curve.piece_of(hit.gap.feature.checked_sub(back)?, hit.at));
    let Some(i) = curve.piece_of(hit.gap.feature, hit.at).or_else(kink) else { return Err(impossible) };
    // A cable cannot lie on a wall or an underside, so it goes round the nearer corner.
    let found = curve.chain(i, load).or_else(|| curve.chain(curve.corner_beside(i, hit.at)?, load));
    let Some((i, chain_range)) = found else { return Err(impossible) };
    let edge = curve.place_on(i, 0.0).turn == 0.0;
    let p = if edge { curve.project(i, hit.at) } else { curve.with_tangent(i, hit.tangent) };
    let ends = section.span_ends(context, k);
    let force = section.force(context, k, hit.arc_length).norm();
    let same =
        |c: &Contact| c.curve == curve_index && c.chain_range == chain_range && c.wheel.is_none() && !c.is_load();
    let end = |j: Option<usize>, side: usize| {
        j.and_then(|j| section.contacts.get(j)).filter(|c| same(c)).map(|c| c.ends.place[side])
    };
    let p = match end(k.checked_sub(1), 1).or_else(|| end(Some(k), 0)).filter(|_| curve.is_round()) {
        Some(end) => release_below::nearest_turn(p, end),
        None => p,
    };
    // A contact on the underside of a post continues over its bottom only if tension presses it on.
    let bears = |c: &Contact, (from, to): (f64, f64)| {
        let contact_path = context.contact_path(c);
        let mut bears = true;
        contact_path.bottoms(from, to, |p| bears &= contact_path.law.press(&contact_path.place(p), force) >= 0.0);
        bears || !curve.is_round()
    };
    if let Some(c) = k
        .checked_sub(1)
        .and_then(|j| section.contacts.get_mut(j))
        .filter(|c| same(c) && p > c.ends.place[1] && bears(c, (c.ends.place[1], p)))
    {
        let p = beyond_edges(curve, chain_range, p, 1, ends[1], None);
        (c.ends.place[1], c.ends.material[1], c.ends.tension[1]) = (p, hit.arc_length, force);
        return Ok(());
    }
    if let Some(c) =
        section.contacts.get_mut(k).filter(|c| same(c) && p < c.ends.place[0] && bears(c, (p, c.ends.place[0])))
    {
        let p = beyond_edges(curve, chain_range, p, 0, ends[0], None);
        (c.ends.place[0], c.ends.material[0], c.ends.tension[0]) = (p, hit.arc_length, force);
        return Ok(());
    }
    let new = NewContact { curve_index, chain_range, place: p, force };
    insert_contact(section, context, k, hit, new, purpose);
    Ok(())
}

/// A contact to be made.
#[derive(Clone, Copy, Debug)]
struct NewContact {
    curve_index: usize,
    chain_range: ChainRange,
    /// Its boundary coordinate.
    place: f64,
    /// Tension there, N.
    force: f64,
}

/// Inserts a contact at a point of span k. If the held end of the cable lies on the same chain, the
/// contact is extended to it.
fn insert_contact(
    section: &mut CableSection,
    context: &SolveContext,
    k: usize,
    hit: &Penetration,
    new: NewContact,
    purpose: SolvePurpose,
) {
    let NewContact { curve_index, chain_range, place: p, force } = new;
    let curve = &context.curves[curve_index];
    let ends = Ends { place: [p, p], material: [hit.arc_length, hit.arc_length], tension: [force, force] };
    let mode = if curve.friction > 0.0 && purpose == SolvePurpose::Step { Mode::Stick } else { Mode::Slip(0.0) };
    let mut contact = Contact::new(curve_index, chain_range, ends, mode);
    contact.smooth = purpose == SolvePurpose::FirstEquilibrium;
    let contact_path = context.contact_path(&contact);
    let mut held_ends = [None, None];
    for side in 0..2 {
        let outer = if side == 0 { k == 0 } else { k == section.contacts.len() };
        if let (true, EndCondition::Fixed(at)) = (outer, section.end_conditions[side])
            && let Some(end) = curve.on_chain(chain_range, at, SUPPORT_CONTACT_DISTANCE_M)
            && (if side == 0 { end <= p } else { end >= p })
        {
            let s = if side == 0 { section.from } else { section.to };
            held_ends[side] = Some(end);
            (contact.ends.place[side], contact.ends.material[side]) = (end, s);
            // This is the length that is laid from the held end to the other.
            let material = contact_path.slide(end, p, force, 0.0).material;
            if held_ends[1 - side].is_none() {
                contact.ends.material[1 - side] = s + material;
            }
        }
    }
    contact.history = TensionProfile::of_ends(&contact.ends);
    let g = section.forces[k];
    section.contacts.insert(k, contact);
    section.forces.insert(k, g);
    for side in 0..2 {
        if let Some(p) = held_ends[side] {
            section.end_conditions[side] = EndCondition::Lies(p);
        }
    }
    if purpose == SolvePurpose::FirstEquilibrium {
        move_neighbours_over_edges(section, context, k);
    }
}
