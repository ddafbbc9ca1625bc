//! Changes are what a converged run may need: contacts released, joined, met, made.
//!
//! R a contact whose interval has turned round is let go; M two contacts of one chain are one; L
//! one that pulls is parted (`lift`); P where a span runs into an obstacle the neighbouring contact
//! is drawn out to it, or a new one begins at a point. After each the strand is solved again, until
//! nothing fires.

use crate::contact::swept_corners::{self, Corner};
use crate::contact::{Gap, World};
use crate::math::{Vec2, cross, perp, smaller};
use crate::model::spans::boundary::capstan::Track;
use crate::model::spans::boundary::curve::{ChainRange, Curve, SUPPORT_CONTACT_DISTANCE_M};
use crate::model::spans::boundary::friction_memory::{Ends, Knot, Mode, TensionProfile};
use crate::model::spans::contact::kink_load;
use crate::model::spans::contact::load_landing;
use crate::model::spans::contact::point_load;
use crate::model::spans::contact::release_below;
use crate::model::spans::contact::slack_pocket;
use crate::model::spans::failure::Failure;
use crate::model::spans::newton;
use crate::model::spans::newton::{Solved, Work};
use crate::model::spans::run::{CableRun, Contact, Course, Next, Tie};
use crate::model::spans::verify::penetration;
use crate::model::spans::verify::penetration::Penetration;
use crate::model::spans::verify::tunnelling;

/// Extent (m or rad) by which the interval of a contact has turned round when it is released:
/// rounding of what touches in a point.
const RELEASE_OVERLAP: f64 = 1e-10;

/// Depth inside an obstacle from which it is met, of the strand: points nearer than that are one.
const DEPTH_FRACTION: f64 = 1e-9;

/// Part of p by which an end of a contact may be off the end of an arc and be taken to be there:
/// Newton's steps go beyond it by less.
const ARC_END_FRACTION: f64 = 1e-8;

/// Solves a strand, events and all.
///
/// `came`: the shape it comes from, of a rest that is sought far away; what lies between is met.
pub(in crate::model::spans) fn solve(
    strand: &mut CableRun,
    course: &mut Course,
    world: &World,
    corners: &[Corner],
    came: Option<&[Vec2]>,
    work: &mut Work,
) -> Result<Solved, Failure> {
    let tuned = course.settings.changes;
    let (mut sum, mut caught) = (Solved::default(), 0);
    for _ in 0..tuned.max_changes {
        point_load::join(strand, course)?;
        let found = match newton::solve(strand, course, work) {
            Ok(found) => found,
            Err(stall) => {
                sum.iterations += stall.iterations;
                if grow(strand, course) || kink_load::enter(strand, course) {
                    continue;
                }
                caught += 1;
                if caught <= tuned.max_load_releases && (shed(strand, course)? || point_load::catch(strand, course)) {
                    continue;
                }
                if let Some(support) = lifted(strand, course) {
                    return Err(Failure::OffWheel { support });
                }
                let s = strand.material(stall.at).0;
                return Err(Failure::Stalled { iterations: sum.iterations, residual: stall.residual, s });
            }
        };
        sum.iterations += found.iterations;
        sum.residual = found.residual;
        // Tunnelled corners are checked before penetrations: they tell on which side of an obstacle
        // the cable belongs.
        let changed = release(strand, course)?
            || join(strand, course)
            || release_below::part(strand, course)
            || kink_load::enter(strand, course)
            || point_load::settle(strand, course)?
            || slack_pocket::open(strand, course)
            || match came {
                Some(came) => passed(strand, course, corners, came, work)?,
                None => false,
            }
            || meet(strand, course, world, if came.is_some() { Sought::Rest } else { Sought::Step })?;
        if !changed {
            // Other contacts may press the cable on to its wheel again: it is off when nothing else
            // changes.
            return lifted(strand, course).map_or(Ok(sum), |support| Err(Failure::OffWheel { support }));
        }
    }
    Err(Failure::Restless { s: strand.from })
}

/// R: lets go of what no longer presses.
fn release(strand: &mut CableRun, course: &mut Course) -> Result<bool, Failure> {
    let turned = |c: &Contact| c.ends.p[1] - c.ends.p[0];
    let worst = (0..strand.contacts.len())
        .filter(|&j| !is_round_wheel(&strand.contacts[j], course))
        .min_by(|&a, &b| turned(&strand.contacts[a]).total_cmp(&turned(&strand.contacts[b])));
    let Some(j) = worst.filter(|&j| turned(&strand.contacts[j]) < -RELEASE_OVERLAP) else {
        return Ok(false);
    };
    let_go(strand, course, j)
}

/// True if a contact is a wheel, which has a side; an eye has none.
fn is_round_wheel(c: &Contact, course: &Course) -> bool {
    c.wheel.is_some() && course.track(c).place(c.ends.p[0]).stretch > 0.0
}

/// The wheel that the cable has turned round on most: it would have to pull there.
fn lifted(strand: &CableRun, course: &Course) -> Option<usize> {
    let wheels = strand.contacts.iter().filter(|c| is_round_wheel(c, course));
    let turned = |c: &&Contact| c.ends.p[1] - c.ends.p[0];
    wheels.min_by(|a, b| turned(a).total_cmp(&turned(b))).filter(|c| turned(c) < -RELEASE_OVERLAP)?.wheel
}

/// S: lets go of what has shrunk to next to nothing beside a load, whose weight a span that turned
/// round past it would count; whether there was any.
fn shed(strand: &mut CableRun, course: &mut Course) -> Result<bool, Failure> {
    let least = course.settings.changes.shed_length_fraction * (strand.to - strand.from);
    let small = |c: &Contact| !c.is_load() && c.ends.s[1] - c.ends.s[0] < least;
    let beside = |j: usize| strand.is_joined(j, 0) || strand.is_joined(j, 1);
    let Some(j) = (0..strand.contacts.len()).find(|&j| small(&strand.contacts[j]) && beside(j)) else {
        return Ok(false);
    };
    let_go(strand, course, j)
}

fn let_go(strand: &mut CableRun, course: &mut Course, j: usize) -> Result<bool, Failure> {
    if let Some(support) = strand.contacts[j].wheel {
        if is_round_wheel(&strand.contacts[j], course) {
            return Err(Failure::OffWheel { support });
        }
        turn_eye(&mut strand.contacts[j]);
        return Ok(true);
    }
    let contact = strand.contacts.remove(j);
    let m = strand.contacts.len();
    if let Some(before) = j.checked_sub(1).and_then(|i| strand.contacts.get_mut(i)) {
        before.next.end_pocket();
    }
    // Beside a load there was no span; now there is the one that was on the other side.
    let before = j.checked_sub(1).is_some_and(|i| strand.contacts[i].next.part());
    if before || contact.next == Next::Joined {
        let (k, other) = if contact.next == Next::Joined { (j + 1, j) } else { (j, j + 1) };
        let ends = (other == 0 && !strand.ties[0].has_span()) || (other > m && !strand.ties[1].has_span());
        if ends {
            return Err(Failure::LoadLies { s: contact.ends.s[0] });
        }
        strand.forces.remove(k);
        strand.resolve_span(course, j);
        return Ok(true);
    }
    // An end that rested on this contact becomes a fixed or a free end.
    for side in 0..2 {
        let outer = if side == 0 { j == 0 } else { j == m };
        if outer && !strand.ties[side].has_span() {
            strand.ties[side] = match strand.ties[side] {
                Tie::Lies(p) => Tie::Held(course.track(&contact).place(p).at),
                Tie::Loose(force) => Tie::Hangs(force),
                other => other,
            };
            strand.forces.remove(if side == 0 { 0 } else { m + 1 });
            if strand.contacts.is_empty() && strand.forces.len() > 1 {
                strand.forces.truncate(1);
            }
            strand.resolve_span(course, if side == 0 { 0 } else { m });
            return Ok(true);
        }
    }
    strand.forces.remove(j);
    strand.resolve_span(course, j);
    Ok(true)
}

/// A point pulley may be passed on either side.
fn turn_eye(c: &mut Contact) {
    // Its boundary in the other sense: p → −p.
    c.curve ^= 1;
    c.ends.p = [-c.ends.p[0], -c.ends.p[1]];
    let s = 0.5 * (c.ends.s[0] + c.ends.s[1]);
    let knot = |k: usize| Knot { coordinate: c.ends.p[k], arc_length: s, tension: c.ends.t[k], mobilised: 0.0 };
    // Nothing is left between: it holds what it has.
    let held = c.history.knots().first().map_or(s, |k| k.arc_length);
    c.history = TensionProfile::new(Knot { arc_length: held, ..knot(0) }, Knot { arc_length: held, ..knot(1) });
    if let Mode::Slide(m) = c.mode
        && m != 0.0
    {
        c.mode = Mode::Hold;
    }
}

/// M: two contacts of one chain, one after the other, are one.
fn join(strand: &mut CableRun, course: &Course) -> bool {
    for j in 1..strand.contacts.len() {
        let (a, b) = (&strand.contacts[j - 1], &strand.contacts[j]);
        let loads = a.is_load() || b.is_load();
        let apart =
            |track: &Track<'_>| track.curve.is_round() && release_below::hangs_between(track, a.ends.p[1], b.ends.p[0]);
        if a.curve == b.curve
            && a.chain_range == b.chain_range
            && a.wheel.is_none()
            && !loads
            && b.ends.p[1] >= a.ends.p[0]
            && !apart(&course.track(a))
        {
            let b = strand.contacts.remove(j);
            strand.forces.remove(j);
            let a = &mut strand.contacts[j - 1];
            a.history.append(&course.track(&b), &b.history);
            a.smooth &= b.smooth;
            a.next = b.next;
            (a.ends.p[1], a.ends.s[1], a.ends.t[1]) = (b.ends.p[1], b.ends.s[1], b.ends.t[1]);
            if let (Mode::Slide(m), Mode::Hold) = (a.mode, b.mode)
                && m != 0.0
            {
                a.mode = Mode::Hold;
            }
            return true;
        }
    }
    false
}

/// P: meets the deepest obstacle of each span.
fn meet(strand: &mut CableRun, course: &Course, world: &World, sought: Sought) -> Result<bool, Failure> {
    if world.is_empty() {
        return Ok(false);
    }
    let deep = DEPTH_FRACTION * (strand.to - strand.from);
    let mut any = false;
    // From the last span, so that those before keep their number.
    for k in (0..strand.spans()).rev() {
        if let Some(landing) = load_landing::find(strand, course, world, k, deep) {
            load_landing::touch(strand, course, k, &landing)?;
            any = true;
            continue;
        }
        if let Some(hit) = penetration::deepest(strand, course, world, k, deep) {
            touch(strand, course, k, &hit, sought)?;
            any = true;
        }
    }
    Ok(any)
}

/// Lays the cable on a corner it has passed through on its way.
fn passed(
    strand: &mut CableRun,
    course: &Course,
    corners: &[Corner],
    came: &[Vec2],
    work: &mut Work,
) -> Result<bool, Failure> {
    let mut shape = Vec::new();
    tunnelling::shape(strand, course, &mut shape);
    let Some(corner) = swept_corners::through(corners, came, &shape, &mut work.turns) else { return Ok(false) };
    let mut best: Option<(f64, usize, f64, Vec2, Vec2)> = None;
    let points = course.settings.changes.corner_search_points;
    for k in (0..strand.spans()).filter(|&k| strand.has_span(k)) {
        strand.shapes(course, k, |s0, at, c| {
            for i in 1..points {
                let s = c.span().length * i as f64 / points as f64;
                let p = at + c.position_at(s);
                let d = (p - corner.at).norm();
                if best.is_none_or(|b| d < b.0) {
                    best = Some((d, k, s0 + s, p, c.force_at(s)));
                }
            }
        });
    }
    let Some((_, k, s, at, force)) = best else { return Ok(false) };
    let tangent = force / force.norm();
    // It must come to lie on the other side of the cable: on its left now, it shall be on its
    // right.
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
    touch(
        strand,
        course,
        k,
        &Penetration { arc_length: s, at: corner.at, tangent, gap, body: corner.body },
        Sought::Rest,
    )?;
    Ok(true)
}

/// The equilibrium that is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sought {
    /// A rest: contacts found on the way have not rubbed.
    Rest,
    /// The end of a step in time.
    Step,
}

/// Lays span k down where it hit.
fn touch(strand: &mut CableRun, course: &Course, k: usize, hit: &Penetration, sought: Sought) -> Result<(), Failure> {
    let impossible = Failure::ContactImpossible { s: hit.arc_length, at: hit.at };
    let back = hit.gap.normal.dot(&perp(hit.tangent)) < 0.0;
    let curve_index = 2 * hit.body + usize::from(back);
    let Some(curve) = course.curves.get(curve_index) else { return Err(impossible) };
    let load = course.law.load;
    // In a kink there is nothing but its edges.
    let kink = || [1, 3].into_iter().find_map(|back| curve.piece_of(hit.gap.feature.checked_sub(back)?, hit.at));
    let Some(i) = curve.piece_of(hit.gap.feature, hit.at).or_else(kink) else { return Err(impossible) };
    // Of a wall or an underside the cable goes round the corner that is nearer.
    let found = curve.chain(i, load).or_else(|| curve.chain(curve.corner_beside(i, hit.at)?, load));
    let Some((i, chain_range)) = found else { return Err(impossible) };
    let edge = curve.place_on(i, 0.0).turn == 0.0;
    let p = if edge { curve.project(i, hit.at) } else { curve.with_tangent(i, hit.tangent) };
    let ends = strand.ends_of(course, k);
    let force = strand.force(course, k, hit.arc_length).norm();
    let same =
        |c: &Contact| c.curve == curve_index && c.chain_range == chain_range && c.wheel.is_none() && !c.is_load();
    let end = |j: Option<usize>, side: usize| {
        j.and_then(|j| strand.contacts.get(j)).filter(|c| same(c)).map(|c| c.ends.p[side])
    };
    let p = match end(k.checked_sub(1), 1).or_else(|| end(Some(k), 0)).filter(|_| curve.is_round()) {
        Some(end) => release_below::nearest_turn(p, end),
        None => p,
    };
    // Below a post it goes on over the bottom only where its tension bears it there.
    let bears = |c: &Contact, (from, to): (f64, f64)| {
        let track = course.track(c);
        let mut bears = true;
        track.bottoms(from, to, |p| bears &= track.law.press(&track.place(p), force) >= 0.0);
        bears || !curve.is_round()
    };
    if let Some(c) = k
        .checked_sub(1)
        .and_then(|j| strand.contacts.get_mut(j))
        .filter(|c| same(c) && p > c.ends.p[1] && bears(c, (c.ends.p[1], p)))
    {
        let p = beyond_edges(curve, chain_range, p, 1, ends[1], None);
        (c.ends.p[1], c.ends.s[1], c.ends.t[1]) = (p, hit.arc_length, force);
        return Ok(());
    }
    if let Some(c) = strand.contacts.get_mut(k).filter(|c| same(c) && p < c.ends.p[0] && bears(c, (p, c.ends.p[0]))) {
        let p = beyond_edges(curve, chain_range, p, 0, ends[0], None);
        (c.ends.p[0], c.ends.s[0], c.ends.t[0]) = (p, hit.arc_length, force);
        return Ok(());
    }
    let mut contact = Contact {
        curve: curve_index,
        chain_range,
        ends: Ends { p: [p, p], s: [hit.arc_length, hit.arc_length], t: [force, force] },
        mode: if curve.friction > 0.0 && sought == Sought::Step { Mode::Hold } else { Mode::Slide(0.0) },
        history: TensionProfile::default(),
        wheel: None,
        flips: 0,
        held: None,
        next: Next::Span,
        load: None,
        smooth: sought == Sought::Rest,
    };
    let track = course.track(&contact);
    let mut held_ends = [None, None];
    for side in 0..2 {
        let outer = if side == 0 { k == 0 } else { k == strand.contacts.len() };
        if let (true, Tie::Held(at)) = (outer, strand.ties[side])
            && let Some(end) = curve.on_chain(chain_range, at, SUPPORT_CONTACT_DISTANCE_M)
            && (if side == 0 { end <= p } else { end >= p })
        {
            let s = if side == 0 { strand.from } else { strand.to };
            held_ends[side] = Some(end);
            (contact.ends.p[side], contact.ends.s[side]) = (end, s);
            // From the end that is held: so much is laid from there to the other.
            let laid = track.slide(end, p, force, 0.0).material;
            if held_ends[1 - side].is_none() {
                contact.ends.s[1 - side] = s + laid;
            }
        }
    }
    let knot = |side: usize| Knot {
        coordinate: contact.ends.p[side],
        arc_length: contact.ends.s[side],
        tension: force,
        mobilised: 0.0,
    };
    contact.history = TensionProfile::new(knot(0), knot(1));
    let g = strand.forces[k];
    strand.contacts.insert(k, contact);
    strand.forces.insert(k, g);
    for side in 0..2 {
        if let Some(p) = held_ends[side] {
            strand.ties[side] = Tie::Lies(p);
        }
    }
    if sought == Sought::Rest {
        lead(strand, course, k);
    }
    Ok(())
}

/// From p, where a contact ends on a side, on to the corner behind each edge that the way to the
/// far end of the span there leads into: along an edge nothing turns, and Newton's method does not
/// find across it.
///
/// `leans`: the way that the span takes there, where it is known better than by its far end.
fn beyond_edges(
    curve: &Curve,
    chain_range: ChainRange,
    mut p: f64,
    side: usize,
    far: Option<Vec2>,
    mut leans: Option<Vec2>,
) -> f64 {
    let (step, forward) = if side == 0 { (-1, -1.0) } else { (1, 1.0) };
    let Some(far) = far else { return p };
    let inside = |i: i64| i >= chain_range.first && i <= chain_range.last;
    let mut i = curve.locate(p, chain_range);
    for _ in chain_range.first..=chain_range.last {
        let edge = if curve.is_arc(i) { i + step } else { i };
        let arc = edge + step;
        if !inside(edge) || !inside(arc) || curve.is_arc(edge) || !curve.is_arc(arc) {
            break;
        }
        let way = leans.unwrap_or_else(|| (far - curve.place(p, chain_range).at) * forward);
        // An arc leads on to its edge where it does not come to run along the way.
        if curve.is_arc(i) && curve.beyond_arc(i, way) != step {
            break;
        }
        let place = curve.place_on(edge, 0.0);
        let corner = curve.place_on(arc, if side == 0 { curve.piece(arc).extent } else { 0.0 }).at;
        // On beyond the end of the edge, and below it there.
        let on = (far - corner) * forward;
        let below = leans.take().map_or(far - corner, |way| way * forward);
        if below.dot(&place.normal) >= 0.0 || on.dot(&place.tangent) <= 0.0 {
            break;
        }
        // On the arc itself: at its border with the edge before it, it counts as that edge, along
        // which nothing turns.
        let border = curve.end(arc) - ARC_END_FRACTION * curve.piece(arc).extent;
        (p, i) = (smaller(curve.with_tangent(arc, on), border), arc);
    }
    p
}

/// Moves the contacts beside span k over their edges to what has been laid down in it.
fn lead(strand: &mut CableRun, course: &Course, k: usize) {
    for (j, side) in [(k.checked_sub(1), 1), (Some(k + 1), 0)] {
        if let Some(j) = j.filter(|&j| strand.contacts.get(j).is_some_and(|c| c.wheel.is_none() && !c.is_load())) {
            lead_end(strand, course, j, side, None);
        }
    }
}

/// Leads an end of contact j over edges; whether there was one.
fn lead_end(strand: &mut CableRun, course: &Course, j: usize, side: usize, leans: Option<Vec2>) -> bool {
    let far = strand.ends_of(course, j + side)[side];
    let c = &mut strand.contacts[j];
    let p = beyond_edges(&course.curves[c.curve], c.chain_range, c.ends.p[side], side, far, leans);
    if p == c.ends.p[side] {
        return false;
    }
    let way = course.curves[c.curve].length(c.ends.p[side], p, c.chain_range) / course.law.stretch(c.ends.t[side]);
    (c.ends.p[side], c.ends.s[side]) = (p, c.ends.s[side] + way);
    true
}

/// Takes an end of contact j that lies at the start of an arc, seen along the contact, back over
/// the edge before it where its span leaves that edge; whether it did.
fn lift_end(strand: &mut CableRun, course: &Course, j: usize, side: usize) -> bool {
    let Some(far) = strand.ends_of(course, j + side)[side] else { return false };
    let c = &mut strand.contacts[j];
    let (curve, p) = (&course.curves[c.curve], c.ends.p[side]);
    let (back, forward) = if side == 0 { (1, -1.0) } else { (-1, 1.0) };
    let i = curve.locate(p, c.chain_range);
    let arc = if curve.is_arc(i) { i } else { i - back };
    let (edge, near) = (arc + back, arc + 2 * back);
    let inside = |i: i64| i >= c.chain_range.first && i <= c.chain_range.last;
    let way = (far - curve.place(p, c.chain_range).at) * forward;
    if ![arc, edge, near].into_iter().all(inside) || curve.is_arc(edge) || !curve.is_arc(arc) || !curve.is_arc(near) {
        return false;
    }
    if curve.beyond_arc(arc, way) != back {
        return false;
    }
    let q = curve.with_tangent(near, way);
    let other = c.ends.p[1 - side];
    let q = if (q - other) * forward > 0.0 { q } else { other };
    let moved = curve.length(p, q, c.chain_range) / course.law.stretch(c.ends.t[side]);
    (c.ends.p[side], c.ends.s[side]) = (q, c.ends.s[side] + moved);
    moved != 0.0
}

/// G: contacts that came to the end of an arc, with their span turned on into the edge behind it,
/// go on to the corner at the edge's far end, those that came to its start, with their span lifted
/// off the edge before it, back to the near one; whether there was one. A stiff taut cable turns by
/// w/T a metre along an edge: next to nothing.
fn grow(strand: &mut CableRun, course: &Course) -> bool {
    let mut any = false;
    for j in 0..strand.contacts.len() {
        for side in 0..2 {
            let c = &strand.contacts[j];
            let curve = &course.curves[c.curve];
            let p = c.ends.p[side];
            let i = curve.locate(p, c.chain_range);
            let border = |q: f64| (p - q).abs() <= ARC_END_FRACTION * (1.0 + p.abs());
            if c.wheel.is_none()
                && !c.is_load()
                && strand.has_span(j + side)
                && (border(curve.origin(i)) || border(curve.end(i)))
            {
                let s = strand.contacts[j].ends.s[side];
                let leans = strand.force(course, j + side, s).try_normalize(0.0);
                any |= lead_end(strand, course, j, side, None)
                    || lift_end(strand, course, j, side)
                    || lead_end(strand, course, j, side, leans);
            }
        }
    }
    any
}
