//! This module finds loads and ends of the cable that come down onto a boundary, and lays them down
//! there; `point_load` has their laws.

use crate::contact::{Gap, World};
use crate::math::{Vec2, larger, perp};
use crate::model::spans::boundary::{Ends, Mode, TensionProfile};
use crate::model::spans::contact::LIFT_FRACTION;
use crate::model::spans::section::{CableSection, Contact, EndCondition, Failure, RestingLoad, SolveContext};

/// Least cosine between a load and the normal of the boundary on which it lands, by which its gap
/// is divided. Smaller: a load beside a wall lands ten times its gap away and farther; larger:
/// loads on steep boundaries land short. A choice, tuned on no campaign.
const LEAST_LANDING_COSINE: f64 = 0.1;

/// A load of span k, or the tip of it, that is deeper than `deep` (m) inside an obstacle.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::spans) struct Landing {
    arc_length: f64,
    at: Vec2,
    /// Approximate direction of the cable there, of any length.
    along: Vec2,
    gap: Gap,
    body: usize,
    /// The end of the section, if it is one.
    tip: Option<usize>,
}

/// The deepest point of span k inside an obstacle.
pub(in crate::model::spans) fn find(
    section: &CableSection,
    context: &SolveContext,
    world: &World,
    k: usize,
    deep: f64,
) -> Option<Landing> {
    let hangs = [k == 0, k == section.contacts.len()];
    let (from, to) = section.material(k);
    let inner = context.loads.iter().any(|l| l.arc_length > from && l.arc_length < to);
    let tip = |side: usize| hangs[side] && matches!(section.end_conditions[side], EndCondition::Hangs(_));
    if !section.has_span(k) || !(inner || tip(0) || tip(1)) {
        return None;
    }
    let mut worst: Option<Landing> = None;
    let look = |s: f64, at: Vec2, along: Vec2, tip: Option<usize>, worst: &mut Option<Landing>| {
        let Some(gap) = world.signed_gap(at, section.to - section.from).filter(|g| g.gap_m < -deep) else { return };
        let Some(body) = world.geometry().bodies().iter().position(|b| b.obstacle == gap.obstacle) else { return };
        if worst.is_none_or(|w| gap.gap_m < w.gap.gap_m) {
            *worst = Some(Landing { arc_length: s, at, along, gap, body, tip });
        }
    };
    let mut before: Option<Vec2> = None;
    section.shapes(context, k, |s0, at, shape| {
        let (start, end) = (shape.start_force(), shape.end_force());
        match before.take() {
            Some(force) => look(s0, at, force / force.norm() + start / start.norm(), None, &mut worst),
            None if tip(0) => look(s0, at, start, Some(0), &mut worst),
            None => {}
        }
        before = Some(end);
        if tip(1) && s0 + shape.span().length >= to {
            look(to, at + shape.span().chord, end, Some(1), &mut worst);
        }
    });
    worst
}

/// Lays down the load or end of span k that has landed.
pub(in crate::model::spans) fn touch(
    section: &mut CableSection,
    context: &SolveContext,
    k: usize,
    l: &Landing,
) -> Result<(), Failure> {
    let drawn = match l.tip.map(|side| section.end_conditions[side]) {
        Some(EndCondition::Hangs(force)) => force,
        _ => Vec2::zeros(),
    };
    let pressed = l.tip.is_none() || drawn.dot(&l.gap.normal) < -LIFT_FRACTION * drawn.norm();
    // An end that nothing presses down slides on with its load, or forms a heap.
    let load = context.law.load;
    let down = load - l.gap.normal * load.dot(&l.gap.normal);
    let along = if pressed { l.along } else { down * if l.tip == Some(0) { -1.0 } else { 1.0 } };
    let tension = section.force(context, k, l.arc_length).norm();
    let Some(mut c) = load_contact(context, l, along, tension) else {
        return Err(Failure::ContactImpossible { s: l.arc_length, at: l.at });
    };
    if let Some(side) = l.tip {
        c.ends.material = [l.arc_length; 2];
        if !pressed {
            land_hanging_length(&mut c, context, l, side)?;
            let inner = c.ends.breakpoint(1 - side);
            let tangent = context.curves[c.curve].place(inner.coordinate, c.chain_range).tangent;
            section.forces[k] = tangent * inner.tension + context.load_between(section.from, inner.arc_length);
        }
        section.end_conditions[side] = EndCondition::Loose(drawn);
        section.forces.insert(k + side, Vec2::zeros());
    } else {
        section.forces.insert(k + 1, section.forces[k]);
    }
    section.contacts.insert(k, c);
    Ok(())
}

/// The contact of a load that has landed, on the side of the boundary on which the cable goes
/// `along` it; None if the boundary has no place for it.
fn load_contact(context: &SolveContext, l: &Landing, along: Vec2, tension: f64) -> Option<Contact> {
    let index = 2 * l.body + usize::from(l.gap.normal.dot(&perp(along)) < 0.0);
    let curve = context.curves.get(index)?;
    // A kink has no piece of its own, only its edges.
    let kink = || [1, 3].into_iter().find_map(|back| curve.piece_of(l.gap.feature.checked_sub(back)?, l.at));
    let piece = curve.piece_of(l.gap.feature, l.at).or_else(kink)?;
    let (i, chain_range) = curve.chain(piece, context.law.load)?;
    let p = curve.project(i, l.at);
    let ends = Ends { place: [p; 2], material: [l.arc_length, l.arc_length.next_up()], tension: [tension; 2] };
    Some(Contact {
        history: TensionProfile::of_ends(&ends),
        load: Some(RestingLoad::default()),
        smooth: true,
        ..Contact::new(index, chain_range, ends, Mode::Slip(0.0))
    })
}

/// Lays the length that hangs below the surface along it: an end that nothing presses down slides.
fn land_hanging_length(c: &mut Contact, context: &SolveContext, l: &Landing, side: usize) -> Result<(), Failure> {
    let (curve, load, inner) = (&context.curves[c.curve], context.law.load, 1 - side);
    let place = curve.place(c.ends.place[inner], c.chain_range);
    let (press, pull) = (-load.dot(&place.normal), load.dot(&place.tangent).abs());
    let rate = pull - curve.friction * press;
    if !(rate > 0.0) {
        return Err(Failure::Compressed { s: l.arc_length, at: l.at, tension: 0.0 });
    }
    let hangs = if l.along.norm() > 0.0 { l.along } else { load };
    let steep = hangs.dot(&place.normal).abs() / hangs.norm();
    let below = -l.gap.gap_m / larger(steep, LEAST_LANDING_COSINE);
    let sign = if side == 0 { -1.0 } else { 1.0 };
    (c.load, c.smooth) = (None, false);
    c.ends.place[side] += sign * below;
    c.ends.material[inner] -= sign * below;
    (c.ends.tension[side], c.ends.tension[inner]) = (0.0, rate * below);
    c.mode = Mode::Slip(sign * curve.friction);
    c.history = TensionProfile::of_ends(&c.ends);
    Ok(())
}
