//! This module finds loads and ends of the cable that come down onto a boundary, and lays them down
//! there; `point_load` has their laws.

use crate::contact::{Gap, World};
use crate::math::{Vec2, larger, perp};
use crate::model::spans::boundary::{Breakpoint, Ends, Mode, TensionProfile};
use crate::model::spans::contact::LIFT_FRACTION;
use crate::model::spans::section::{
    CableSection, Connection, Contact, EndCondition, Failure, RestingLoad, SolveContext,
};

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
    let impossible = Failure::ContactImpossible { s: l.arc_length, at: l.at };
    let drawn = match l.tip.map(|side| section.end_conditions[side]) {
        Some(EndCondition::Hangs(force)) => force,
        _ => Vec2::zeros(),
    };
    let pressed = l.tip.is_none() || drawn.dot(&l.gap.normal) < -LIFT_FRACTION * drawn.norm();
    // An end that nothing presses down slides on with its load, or forms a heap.
    let load = context.law.load;
    let down = load - l.gap.normal * load.dot(&l.gap.normal);
    let along = if pressed { l.along } else { down * if l.tip == Some(0) { -1.0 } else { 1.0 } };
    let index = 2 * l.body + usize::from(l.gap.normal.dot(&perp(along)) < 0.0);
    let Some(curve) = context.curves.get(index) else { return Err(impossible) };
    // A kink has no piece of its own, only its edges.
    let kink = || [1, 3].into_iter().find_map(|back| curve.piece_of(l.gap.feature.checked_sub(back)?, l.at));
    let found = curve.piece_of(l.gap.feature, l.at).or_else(kink).and_then(|i| curve.chain(i, load));
    let Some((i, chain_range)) = found else { return Err(impossible) };
    let p = curve.project(i, l.at);
    let tension = section.force(context, k, l.arc_length).norm();
    let breakpoint =
        |p: f64, s: f64, tension: f64| Breakpoint { coordinate: p, arc_length: s, tension, mobilised: 0.0 };
    let mut c = Contact {
        curve: index,
        chain_range,
        ends: Ends { place: [p; 2], material: [l.arc_length, l.arc_length.next_up()], tension: [tension; 2] },
        mode: Mode::Slip(0.0),
        held: None,
        history: TensionProfile::new(breakpoint(p, l.arc_length, tension), breakpoint(p, l.arc_length, tension)),
        wheel: None,
        mode_changes: 0,
        next: Connection::Span,
        load: Some(RestingLoad::default()),
        smooth: true,
    };
    let Some(side) = l.tip else {
        let g = section.forces[k];
        section.contacts.insert(k, c);
        section.forces.insert(k + 1, g);
        return Ok(());
    };
    c.ends.material = [l.arc_length; 2];
    if !pressed {
        let place = curve.place(p, chain_range);
        let (press, pull) = (-load.dot(&place.normal), load.dot(&place.tangent).abs());
        let rate = pull - curve.friction * press;
        if !(rate > 0.0) {
            return Err(Failure::Compressed { s: l.arc_length, at: l.at, tension: 0.0 });
        }
        // This length hangs below the surface, and is laid along it.
        let hangs = if l.along.norm() > 0.0 { l.along } else { load };
        let steep = hangs.dot(&place.normal).abs() / hangs.norm();
        let below = -l.gap.gap_m / larger(steep, 0.1);
        let sign = if side == 0 { -1.0 } else { 1.0 };
        let (inner, tension) = (1 - side, rate * below);
        (c.load, c.smooth) = (None, false);
        c.ends.place[side] += sign * below;
        c.ends.material[inner] -= sign * below;
        (c.ends.tension[side], c.ends.tension[inner]) = (0.0, tension);
        c.mode = Mode::Slip(sign * curve.friction);
        let e = c.ends;
        c.history = TensionProfile::new(
            breakpoint(e.place[0], e.material[0], e.tension[0]),
            breakpoint(e.place[1], e.material[1], e.tension[1]),
        );
        section.forces[k] = place.tangent * tension + context.load_between(section.from, e.material[inner]);
    }
    section.end_conditions[side] = EndCondition::Loose(drawn);
    section.contacts.insert(k, c);
    section.forces.insert(k + side, Vec2::zeros());
    Ok(())
}
