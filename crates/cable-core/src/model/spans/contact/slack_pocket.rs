//! This module handles pockets: slack cable in a concave kink.
//!
//! A cable under tension bridges a kink of δ by a span that is tangent to both its edges; its size
//! is proportional to its tension, x = T tan(δ/2)/w on each edge. With more cable the span shrinks
//! to nothing: the cable lies in the kink without tension, and the surplus lies there loose. Such
//! a *pocket* is two ends of contacts held in the kink, T = 0 on both, with the surplus material
//! between them, surplus = s₁ − s₂ ≥ 0. When the surplus is used up, the cable forms a span across
//! the kink again. The transition is continuous: T → 0 as surplus → 0.
//!
//! The surplus is a heap in the kink with the weight B = −b·surplus, and the weight of dead loads
//! in it. The two edges carry it by pressure alone, N₁n₁ + N₂n₂ = −B, if −B is between their
//! normals; else the one edge on which it lies carries it within its friction cone. A heap that
//! neither carries slides down (see [`heap`]).
//!
//! A span that replaces a surplus of −e is an arc tangent to both edges at the distance x from the
//! kink. It is δ x/tan(δ/2) long, so e = x (2 − δ/tan(δ/2)), with the tension w x/tan(δ/2).

use crate::math::{Vec2, cross};
use crate::model::spans::section::{CableSection, Connection, Contact, SolveContext};

/// Shortage of material from which a pocket opens, as a fraction of the section. Smaller: round-off
/// opens it. Larger: the cable there is too short by as much.
pub(in crate::model::spans) const POCKET_SHORTAGE_FRACTION: f64 = 1e-11;
/// Distance (m) of the ends of two chains within which they form one kink.
const KINK_DISTANCE_M: f64 = 1e-9;
/// Excess over the friction cone of a heap's edge that counts as round-off, as a fraction of the
/// heap's weight.
const HEAP_CONE_ROUNDING: f64 = 1e-9;

/// The coordinates p at which the ends of the contacts before and after span k would lie in a kink,
/// and its turn, rad.
fn kink(section: &CableSection, context: &SolveContext, k: usize) -> Option<([f64; 2], f64)> {
    let (a, b) = (section.contacts.get(k.checked_sub(1)?)?, section.contacts.get(k)?);
    if a.curve != b.curve || a.wheel.is_some() || b.wheel.is_some() || a.is_load() || b.is_load() {
        return None;
    }
    let curve = &context.curves[a.curve];
    let p = [curve.end(a.chain_range.last), curve.origin(b.chain_range.first)];
    let (u, v) = (curve.place(p[0], a.chain_range), curve.place(p[1], b.chain_range));
    let turn = cross(u.tangent, v.tangent).atan2(u.tangent.dot(&v.tangent)).abs();
    ((u.at - v.at).norm() <= KINK_DISTANCE_M && turn > 0.0 && p[0] >= a.ends.place[0] && p[1] <= b.ends.place[1])
        .then_some((p, turn))
}

/// Lists spans that may become pockets, with the least tension first.
pub(in crate::model::spans) fn candidates(section: &CableSection, context: &SolveContext, out: &mut Vec<(f64, usize)>) {
    out.clear();
    let most = context.settings.changes.pocket_tension_fraction * context.law.load.norm() * (section.to - section.from);
    for k in (0..section.spans()).filter(|&k| section.has_span(k)) {
        let tension = section.force(context, k, section.material(k).0).norm();
        if tension < most && kink(section, context, k).is_some() {
            out.push((tension, k));
        }
    }
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
}

/// Lays span k into its kink.
pub(in crate::model::spans) fn fill(section: &mut CableSection, context: &SolveContext, k: usize) {
    let Some((p, _)) = kink(section, context, k) else { return };
    let stretch = context.law.stretch(0.0);
    for (side, p) in p.into_iter().enumerate() {
        let c = &mut section.contacts[k - 1 + side];
        let end = 1 - side;
        c.ends.material[end] += (p - c.ends.place[end]) / stretch;
        (c.ends.place[end], c.ends.tension[end]) = (p, 0.0);
    }
    section.contacts[k - 1].next = Connection::Pocket;
    section.forces[k] = Vec2::zeros();
}

/// The force of an edge on the heap in a pocket.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::model::spans) struct BearingContact {
    /// The contact whose edge it is.
    pub contact: usize,
    /// Normal of the edge, and its direction of growing arc length.
    pub normal: Vec2,
    pub tangent: Vec2,
    /// Force on the cable along the normal, N.
    pub press: f64,
    /// Force on the cable along the tangent, N.
    pub friction: f64,
}

/// The edges that carry the heap between contacts k − 1 and k; None if none can, so that it slides.
pub(in crate::model::spans) fn heap(
    section: &CableSection,
    context: &SolveContext,
    k: usize,
) -> Option<[BearingContact; 2]> {
    let (a, b) = (&section.contacts[k - 1], &section.contacts[k]);
    let edge = |c: &Contact, contact: usize, end: usize| {
        let place = context.contact_path(c).place(c.ends.place[end]);
        BearingContact { contact, normal: place.normal, tangent: place.tangent, press: 0.0, friction: 0.0 }
    };
    let mut borne = [edge(a, k - 1, 1), edge(b, k, 0)];
    // Material within round-off of zero has no weight.
    if b.ends.material[0] <= a.ends.material[1] {
        return Some(borne);
    }
    let load = -context.load_between(a.ends.material[1], b.ends.material[0]);
    let both = cross(borne[0].normal, borne[1].normal);
    let press = [cross(load, borne[1].normal) / both, cross(borne[0].normal, load) / both];
    if press.iter().all(|n| *n >= 0.0) {
        (borne[0].press, borne[1].press) = (press[0], press[1]);
        return Some(borne);
    }
    let side = usize::from(!(press[1] < 0.0));
    let edge = &mut borne[side];
    (edge.press, edge.friction) = (load.dot(&edge.normal), load.dot(&edge.tangent));
    let most = context.friction([a, b][side]) * edge.press + HEAP_CONE_ROUNDING * load.norm();
    (edge.press >= 0.0 && edge.friction.abs() <= most).then_some(borne)
}

/// Opens the pocket with the greatest shortage of material into a span; returns whether there was
/// one.
pub(in crate::model::spans) fn open(section: &mut CableSection, context: &SolveContext) -> bool {
    let surplus = |k: usize| section.contacts[k].ends.material[0] - section.contacts[k - 1].ends.material[1];
    let pockets = (1..section.contacts.len()).filter(|&k| section.contacts[k - 1].next == Connection::Pocket);
    let Some(k) = pockets.min_by(|&a, &b| surplus(a).total_cmp(&surplus(b))) else { return false };
    let short = -surplus(k);
    if !(short > POCKET_SHORTAGE_FRACTION * (section.to - section.from)) {
        return false;
    }
    let Some((_, turn)) = kink(section, context, k) else { return false };
    let extent = |j: usize| section.contacts[j].ends.place[1] - section.contacts[j].ends.place[0];
    let half = (0.5 * turn).tan();
    let (mut x, stretch) = (short / (2.0 - turn / half), context.law.stretch(0.0));
    for j in [k - 1, k] {
        let most = context.settings.changes.kink_span_fraction * extent(j);
        x = if x < most { x } else { most };
    }
    let normal = context.contact_path(&section.contacts[k]).place(section.contacts[k].ends.place[0]).normal;
    let tension = (context.law.load.dot(&normal)).abs() * x / half;
    for side in 0..2 {
        let c = &mut section.contacts[k - 1 + side];
        let (end, sign) = (1 - side, if side == 0 { -1.0 } else { 1.0 });
        c.ends.place[end] += sign * x;
        c.ends.material[end] += sign * x / stretch;
        c.ends.tension[end] = tension;
    }
    section.contacts[k - 1].next = Connection::Span;
    if let Some(g) = section.solve_span(context, k) {
        section.forces[k] = g;
    }
    true
}
