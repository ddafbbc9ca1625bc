//! This module makes the first guess of a section: contacts where the shortest path of its route
//! bends, and material spread evenly along the route.

use crate::contact::World;
use crate::math::{Vec2, cross, smaller};
use crate::model::spans::boundary::{ChainRange, Ends, Mode, TensionProfile};
use crate::model::spans::contact::LIFT_FRACTION;
use crate::model::spans::initial::material_distribution::{measure, spread};
use crate::model::spans::initial::route::{RoutePolyline, section_route};
use crate::model::spans::initial::shortest_path::PathCorner;
use crate::model::spans::initial::{shortest_path, tightening};
use crate::model::spans::section::{BoundaryConditions, CableSection, Contact, EndCondition, SolveContext};
use crate::model::spans::section_layout::{SectionBounds, SectionLayout, SectionPulley};
use crate::problem::wheel_passage::{angle_near, turn_through_centre};

/// A body that the cable bends round.
#[derive(Clone, Debug)]
struct RouteWrap {
    curve: usize,
    chain_range: ChainRange,
    /// First and last piece.
    pieces: [i64; 2],
    wheel: Option<usize>,
    /// Its first and last point along the route, m.
    way: [f64; 2],
    /// Turn of the taut string there, rad; unused at a wheel.
    turn: f64,
}

/// The section laid along its route, and the points of the route. None if the taut string of the
/// route is not found.
pub(in crate::model::spans) fn section_along_route(
    layout: &SectionLayout,
    index: usize,
    context: &SolveContext,
    instant: &BoundaryConditions,
) -> Option<(CableSection, Vec<Vec2>)> {
    let part = layout.sections.get(index)?;
    let way = section_route(layout, part, instant);
    let section = FirstGuess { layout, part, context, instant, way: &way }.section()?;
    Some((section, way.points))
}

/// The given quantities of a section's first guess.
#[derive(Clone, Copy)]
struct FirstGuess<'a> {
    layout: &'a SectionLayout,
    part: &'a SectionBounds,
    context: &'a SolveContext,
    instant: &'a BoundaryConditions,
    way: &'a RoutePolyline,
}

/// The part of a route along which a string is pulled taut, by the indices of the route's points at
/// which it begins and ends.
#[derive(Clone, Copy)]
struct TautString {
    first: usize,
    last: usize,
}

impl FirstGuess<'_> {
    /// The section laid along the route; None if its string is not found, or one of its spans has
    /// no solution.
    fn section(&self) -> Option<CableSection> {
        let Self { layout, part, context, instant, way, .. } = *self;
        if !(way.total() > 0.0) {
            return single_span(part, instant);
        }
        let end_conditions = [0, 1].map(|side| match part.supports[side] {
            Some(k) => EndCondition::Fixed(instant.places[k]),
            None => EndCondition::Hangs(layout.end_force(instant, part.material[side])),
        });
        let end_contacts = self.lying_ends(end_conditions);
        let mut material = SpreadAlongRoute::of(self, end_conditions, &end_contacts);
        let [from, to] = part.material;
        let mut section = CableSection { from, to, end_conditions, ..CableSection::default() };
        if let [Some(a), Some(b)] = &end_contacts {
            if a.count + b.count > way.points.len() && a.curve == b.curve && a.chain_range == b.chain_range {
                return Some(section_on_one_boundary(section, context, [a, b], material.tension));
            }
            // A span from one lying stretch to the next needs some tension.
            let least = layout.settings.initial.laid_tension_weights * context.law.load.norm() * (to - from);
            if !(material.tension > least) {
                material.tension = least;
            }
        }
        let first = end_contacts[0].as_ref().map_or(0, |h| h.inner_point(way));
        let last = end_contacts[1].as_ref().map_or(way.points.len() - 1, |h| h.inner_point(way));
        if first > last {
            return None;
        }
        section.contacts = self.bends(TautString { first, last }, &material)?;
        let join = if first == last { half_kink_span(context, &end_contacts, material.tension) } else { 0.0 };
        for end_contact in end_contacts.iter().flatten() {
            let contact = self.lying_end_contact(end_contact, join, &material);
            section.contacts.insert(if end_contact.side == 0 { 0 } else { section.contacts.len() }, contact);
            section.end_conditions[end_contact.side] =
                resting_end_condition(end_conditions[end_contact.side], end_contact.coordinates[end_contact.side]);
        }
        section.forces = vec![Vec2::zeros(); section.contacts.len() + 1];
        if join == 0.0 && material.has_free_end() {
            measure(&mut section, context, material.loose, material.stretch);
        }
        spread(&mut section, context);
        solve_spans(&mut section, context)?;
        if self.strains_unevenly(&material) && end_contacts.iter().all(Option::is_none) && !material.has_free_end() {
            tightening::equalise_tensions(&mut section, context);
        }
        Some(section)
    }

    /// The contact at a lying end of the section; `join` is the length of the boundary (m) that it
    /// leaves to a span beyond it.
    fn lying_end_contact(&self, end_contact: &EndContact, join: f64, material: &SpreadAlongRoute) -> Contact {
        let [from, to] = self.part.material;
        let [first, last] = end_contact.coordinates;
        let inner = material.at(self.way.along[end_contact.inner_point(self.way)]);
        let join = smaller(join, 0.5 * (last - first));
        let (p, s) = if end_contact.side == 0 {
            ([first, last - join], [from, inner - join])
        } else {
            ([first + join, last], [inner + join, to])
        };
        contact(self.context, end_contact.curve, end_contact.chain_range, p, s, material.tension)
    }

    /// True if the material that is spread evenly along the route has uneven tensions: if the route
    /// is longer than the cable, or if none is drawn, so that it leads straight from support to
    /// support, but round a wheel from tangent to tangent.
    fn strains_unevenly(&self, material: &SpreadAlongRoute) -> bool {
        let problem = &self.layout.problem;
        let wheel = |q: &SectionPulley| problem.supports.get(q.support).is_some_and(|s| s.wheel_radius > 0.0);
        material.slack > self.layout.settings.initial.route_excess_fraction
            || problem.route.len() < 2 && self.part.pulleys.iter().any(wheel)
    }

    /// The ends that lie on a boundary; an end that a load lifts does not.
    fn lying_ends(&self, end_conditions: [EndCondition; 2]) -> [Option<EndContact>; 2] {
        let Self { layout, part, context, way, .. } = *self;
        let tuned = &layout.settings.initial;
        [0, 1].map(|side| {
            let near = if part.supports[side].is_none() {
                [tuned.falling_end_radii; 2]
            } else {
                [tuned.lying_end_radii, tuned.route_contact_radii]
            };
            let near = near.map(|n| n * layout.problem.radius);
            end_contact_on(context, &layout.problem.world, near, &way.points, side).filter(|h| {
                match end_conditions[side] {
                    EndCondition::Hangs(force) => {
                        let place = context.curves[h.curve].place(h.coordinates[side], h.chain_range);
                        force.dot(&place.normal) <= LIFT_FRACTION * force.norm()
                    }
                    _ => true,
                }
            })
        })
    }

    /// Contacts where the taut string of the route bends; None if the string is not found.
    fn bends(&self, string: TautString, material: &SpreadAlongRoute) -> Option<Vec<Contact>> {
        let Self { context, way, .. } = *self;
        let mut wraps = self.wraps(string)?;
        let mut contacts = Vec::with_capacity(wraps.len() + 2);
        let rounds =
            extend_to_neighbouring_corners(context, &mut wraps, [way.points[string.first], way.points[string.last]]);
        for (k, wrap) in wraps.iter().enumerate() {
            let arrive = tangent(rounds[k][1], rounds[k + 1][0]);
            let leave = tangent(rounds[k + 1][1], rounds[k + 2][0]);
            let curve = &context.curves[wrap.curve];
            // The turn at a wheel is known from the rounds beside it; an eye turns the cable either
            // way.
            let turn = match (wrap.wheel, rounds[k + 1][0]) {
                (Some(_), Round { centre, radius, sense }) if radius > 0.0 => {
                    turn_through_centre(sense, centre - rounds[k][1].centre, rounds[k + 2][0].centre - centre)
                }
                _ => wrap.turn,
            };
            let p1 = curve.with_tangent(wrap.pieces[0], arrive);
            let p2 = curve.with_tangent(wrap.pieces[1], leave);
            // The turn of the string is adjusted to the tangents.
            let p2 = if curve.is_round() { p1 + angle_near(p2 - p1, turn) } else { p2 };
            // An eye has no side of its own: the cable passes it on the side on which the string
            // bends.
            let eye = wrap.wheel.is_some() && curve.place(p1, wrap.chain_range).stretch == 0.0;
            let (index, [p1, p2]) = if eye && p2 < p1 { (wrap.curve ^ 1, [-p1, -p2]) } else { (wrap.curve, [p1, p2]) };
            let curve = &context.curves[index];
            // A wrap that the string passes without a bend touches in one point.
            let [p1, p2] = if p2 > p1 { [p1, p2] } else { [0.5 * (p1 + p2); 2] };
            let half = 0.5 * curve.length(p1, p2, wrap.chain_range) / context.law.stretch(material.tension);
            // Round a post the string's points are not those of the cable: its ends are taken from
            // the route itself.
            let seen = |p: f64, w: f64| {
                let place = curve.place(p, wrap.chain_range);
                if curve.is_round() {
                    way.close(place.at, w, context.settings.initial.post_approach_radii * place.stretch)
                } else {
                    w
                }
            };
            let s = material.at(0.5 * (seen(p1, wrap.way[0]) + seen(p2, wrap.way[1])));
            let mut c = contact(context, index, wrap.chain_range, [p1, p2], [s - half, s + half], material.tension);
            c.wheel = wrap.wheel;
            contacts.push(c);
        }
        Some(contacts)
    }

    /// The bodies that the string bends round, with the pulleys; posts are represented by rings of
    /// points.
    fn wraps(&self, TautString { first, last }: TautString) -> Option<Vec<RouteWrap>> {
        let Self { layout, part, context, instant, way } = *self;
        let world = &layout.problem.world;
        let corners = shortest_path::corners(world);
        let mut out: Vec<RouteWrap> = Vec::new();
        let mut reached = way.along[first];
        let mut begin = (way.points[first], first);
        for k in 0..=part.pulleys.len() {
            let pulley: Option<&SectionPulley> = part.pulleys.get(k);
            let (stop, w) = match pulley {
                Some(q) => {
                    let at = instant.places[q.support];
                    (at, way.nearest(at, reached, Some(last.saturating_sub(1))))
                }
                None => (way.points[last], way.along[last]),
            };
            let leg = if pulley.is_some() { way.leg(w) } else { last.saturating_sub(1) };
            let mut route = vec![begin.0];
            for i in begin.1 + 1..=leg.min(way.points.len() - 1) {
                route.push(way.points[i]);
            }
            route.push(stop);
            let bends = shortest_path::taut_string(&route, &corners)?;
            for (j, b) in bends.iter().enumerate() {
                reached = way.nearest(b.corner.at, reached, Some(begin.1 + b.leg));
                let before = j.checked_sub(1).and_then(|i| bends.get(i)).map_or(begin.0, |a| a.corner.at);
                let after = bends.get(j + 1).map_or(stop, |a| a.corner.at);
                let (u, v) = (b.corner.at - before, after - b.corner.at);
                add_bend(&mut out, context, b, reached, cross(u, v).atan2(u.dot(&v)).abs())?;
            }
            if let Some(q) = pulley {
                let curve = q.curve + usize::from(q.facing < 0.0);
                let chain_range = ChainRange { first: 0, last: 0 };
                // The route may be drawn round it: these are its first and last points there.
                let radius = context.curves[curve].place(0.0, chain_range).stretch;
                let near = way.distance(stop, w) + context.settings.initial.wheel_route_radii * radius;
                let round = way.stretch_within(stop, w, near);
                out.push(RouteWrap {
                    curve,
                    chain_range,
                    pieces: [0, 0],
                    wheel: Some(q.support),
                    way: round,
                    turn: 0.0,
                });
                (begin, reached) = ((stop, leg), w);
            }
        }
        Some(out)
    }
}

/// The material of a section spread along its route: evenly if both ends are held; otherwise from
/// the held end, with the strain of the force that draws the free one.
struct SpreadAlongRoute {
    material: [f64; 2],
    /// Length of the route, m.
    total: f64,
    /// True for free ends.
    loose: [bool; 2],
    /// Stretched length of a metre of material under the force that draws the free end.
    stretch: f64,
    /// Strain with which the material is as long as the route; negative if it is longer.
    slack: f64,
    /// The tension with which it is first laid, N.
    tension: f64,
}

impl SpreadAlongRoute {
    /// The spread of a guess's material, with the tension that its length or its free end gives.
    fn of(guess: &FirstGuess<'_>, end_conditions: [EndCondition; 2], end_contacts: &[Option<EndContact>; 2]) -> Self {
        let FirstGuess { part, context, instant, way, .. } = *guess;
        let ([from, to], total) = (part.material, way.total());
        let loose = part.supports.map(|support| support.is_none());
        let drawn = |side: usize| match (&end_contacts[side], end_conditions[side]) {
            (None, EndCondition::Hangs(force)) => (force + context.law.load * tail(part, instant, way, side)).norm(),
            _ => 0.0,
        };
        let drawn = if loose[0] && (!loose[1] || drawn(0) < drawn(1)) { drawn(0) } else { drawn(1) };
        let slack = total / ((to - from) * context.law.thermal) - 1.0;
        let tension = if loose.contains(&true) {
            drawn
        } else if slack > 0.0 {
            slack * context.law.stiffness
        } else {
            0.0
        };
        Self { material: part.material, total, loose, stretch: context.law.stretch(drawn), slack, tension }
    }

    fn has_free_end(&self) -> bool {
        self.loose.contains(&true)
    }

    /// The material at a length of the route, m.
    fn at(&self, w: f64) -> f64 {
        let [from, to] = self.material;
        match self.loose {
            [true, false] => to - (self.total - w) / self.stretch,
            [false, true] => from + w / self.stretch,
            _ => from + (to - from) * w / self.total,
        }
    }
}

/// Solves the forces of spans whose ends and material are known; None if one has no solution.
pub(in crate::model::spans) fn solve_spans(section: &mut CableSection, context: &SolveContext) -> Option<()> {
    for k in 0..section.spans() {
        if section.has_span(k) {
            section.forces[k] = section.solve_span(context, k)?;
        }
    }
    section.update_end_tensions(context);
    Some(())
}

/// A section that lies on one boundary from end to end.
fn section_on_one_boundary(
    mut section: CableSection,
    context: &SolveContext,
    [a, b]: [&EndContact; 2],
    tension: f64,
) -> CableSection {
    let mut c = contact(
        context,
        a.curve,
        a.chain_range,
        [a.coordinates[0], b.coordinates[1]],
        [section.from, section.to],
        tension,
    );
    c.wheel = None;
    section.end_conditions = [0, 1].map(|side| {
        resting_end_condition(section.end_conditions[side], if side == 0 { a.coordinates[0] } else { b.coordinates[1] })
    });
    section.contacts.push(c);
    section.forces = vec![Vec2::zeros(); 2];
    spread(&mut section, context);
    for side in 0..2 {
        if matches!(section.end_conditions[side], EndCondition::Lies(_)) {
            let c = &mut section.contacts[0];
            let contact_path = context.contact_path(c);
            c.ends.tension[side] = c.history.at(&contact_path, c.ends.place[side]).0;
        }
    }
    section
}

/// Half of the length (m) of the span that joins two stretches which meet at a kink of δ (rad): the
/// tension T over the weight w per length gives its length Tδ/w. 0 if there is only one stretch.
fn half_kink_span(context: &SolveContext, end_contacts: &[Option<EndContact>; 2], tension: f64) -> f64 {
    match end_contacts {
        [Some(a), Some(b)] => {
            let before = context.curves[a.curve].place(a.coordinates[1], a.chain_range).tangent;
            let after = context.curves[b.curve].place(b.coordinates[0], b.chain_range).tangent;
            let kink = cross(before, after).atan2(before.dot(&after)).abs();
            0.5 * tension * kink / context.law.load.norm()
        }
        _ => 0.0,
    }
}

/// A section whose ends are in one place: a single span.
fn single_span(part: &SectionBounds, instant: &BoundaryConditions) -> Option<CableSection> {
    let [a, b] = part.supports;
    let [from, to] = part.material;
    let end_conditions = [EndCondition::Fixed(instant.places[a?]), EndCondition::Fixed(instant.places[b?])];
    part.pulleys.is_empty().then(|| CableSection {
        from,
        to,
        end_conditions,
        contacts: Vec::new(),
        forces: vec![Vec2::zeros()],
        loose: None,
    })
}

/// Length of a route from a hanging end to its highest point, which is about the first point that
/// holds it, m.
fn tail(part: &SectionBounds, instant: &BoundaryConditions, way: &RoutePolyline, side: usize) -> f64 {
    let up = -instant.load;
    let high = |k: &usize| way.points[*k].dot(&up);
    // If there are several, the nearest to that end counts.
    let higher = |best: usize, k: usize| if high(&k) > high(&best) { k } else { best };
    let top = match side {
        0 => (0..way.points.len()).reduce(higher),
        _ => (0..way.points.len()).rev().reduce(higher),
    };
    let top = top.unwrap_or(0);
    let length = if side == 0 { way.along[top] } else { way.total() - way.along[top] };
    let whole = part.material[1] - part.material[0];
    if length < whole { length } else { whole }
}

/// The end condition of an end that lies at the boundary coordinate p.
fn resting_end_condition(end: EndCondition, p: f64) -> EndCondition {
    match end {
        EndCondition::Fixed(_) => EndCondition::Lies(p),
        EndCondition::Hangs(force) => EndCondition::Loose(force),
        other => other,
    }
}

/// A contact between two boundary coordinates with material from `s[0]` to `s[1]` (m) under one
/// tension (N); it sticks where there is friction.
fn contact(
    context: &SolveContext,
    curve: usize,
    chain_range: ChainRange,
    p: [f64; 2],
    s: [f64; 2],
    tension: f64,
) -> Contact {
    let ends = Ends { place: p, material: s, tension: [tension; 2] };
    let mode = if context.curves[curve].friction > 0.0 { Mode::Stick } else { Mode::Slip(0.0) };
    let mut contact = Contact::new(curve, chain_range, ends, mode);
    contact.history = TensionProfile::of_ends(&contact.ends);
    contact
}

/// An end of a route that lies on a boundary.
struct EndContact {
    /// 0 for the start of the route, 1 for its end.
    side: usize,
    curve: usize,
    chain_range: ChainRange,
    coordinates: [f64; 2],
    /// Number of points of the route that lie, with the end.
    count: usize,
}

impl EndContact {
    /// Index of the last point of the route that lies, counted from the end.
    fn inner_point(&self, way: &RoutePolyline) -> usize {
        if self.side == 0 { self.count - 1 } else { way.points.len() - self.count }
    }
}

/// The contact of an end of a route (side 0 or 1): its outermost points on one chain, within the
/// distances `near` (m) for the end and for the others. None if the end does not lie.
fn end_contact_on(
    context: &SolveContext,
    world: &World,
    near: [f64; 2],
    points: &[Vec2],
    side: usize,
) -> Option<EndContact> {
    let n = points.len();
    let point = |k: usize| points[if side == 0 { k } else { n - 1 - k }];
    let gap = world.signed_gap(point(0), 2.0 * near[0]).filter(|g| g.gap_m.abs() <= near[0])?;
    let body = world.geometry().bodies().iter().position(|b| b.obstacle == gap.obstacle)?;
    let travel = (point(1) - point(0)) * if side == 0 { 1.0 } else { -1.0 };
    // n = σ perp t.
    let back = cross(travel, gap.normal) < 0.0;
    let curve_index = 2 * body + usize::from(back);
    let curve = context.curves.get(curve_index)?;
    let i = curve.piece_of(gap.feature, point(0))?;
    let (_, chain_range) = curve.chain(i, context.law.load)?;
    let on: Vec<f64> = (0..n).map_while(|k| curve.on_chain(chain_range, point(k), near[k.min(1)])).collect();
    let (first, last) = (*on.first()?, *on.last()?);
    let p = if side == 0 { [first, last] } else { [last, first] };
    (on.len() > 1 && p[1] > p[0]).then_some(EndContact {
        side,
        curve: curve_index,
        chain_range,
        coordinates: p,
        count: on.len(),
    })
}

/// Adds a bend, at the length `w` (m) of the route with a `turn` (rad), to the last wrap if it
/// continues that, else as a new wrap. None if no boundary has the corner.
fn add_bend(out: &mut Vec<RouteWrap>, context: &SolveContext, b: &PathCorner, w: f64, turn: f64) -> Option<()> {
    let curve_index = 2 * b.corner.body + usize::from(b.sense < 0.0);
    let curve = context.curves.get(curve_index)?;
    let i = curve.piece_of(b.corner.feature, b.corner.at)?;
    let (i, chain_range) = curve.chain(i, context.law.load)?;
    if let Some(last) = out.last_mut()
        && last.wheel.is_none()
        && last.curve == curve_index
        && (curve.is_round() || (last.chain_range == chain_range && i >= last.pieces[1]))
    {
        (last.pieces[1], last.way[1]) = (i, w);
        last.turn += turn;
        return Some(());
    }
    out.push(RouteWrap { curve: curve_index, chain_range, pieces: [i, i], wheel: None, way: [w, w], turn });
    Some(())
}

/// Extends each wrap to a neighbouring corner if the string reaches or leaves it through the edge
/// between the two; returns the rounds of all wraps.
///
/// A string without thickness just passes such a corner, whereas a cable with a radius bends round
/// it: along the edge the direction is constant, so Newton's method cannot move an end across it.
fn extend_to_neighbouring_corners(context: &SolveContext, wraps: &mut [RouteWrap], ends: [Vec2; 2]) -> Vec<[Round; 2]> {
    let mut found = rounds(context, wraps, ends[0], ends[1]);
    // The loop terminates: every pass but the last extends a wrap within its chain.
    loop {
        let mut changed = false;
        for (k, wrap) in wraps.iter_mut().enumerate() {
            let curve = &context.curves[wrap.curve];
            let arrive = tangent(found[k][1], found[k + 1][0]);
            let leave = tangent(found[k + 1][1], found[k + 2][0]);
            let (first, last) = (wrap.pieces[0] - 2, wrap.pieces[1] + 2);
            if curve.beyond_arc(wrap.pieces[0], arrive) < 0 && first >= wrap.chain_range.first && curve.is_arc(first) {
                wrap.pieces[0] = first;
                changed = true;
            }
            if curve.beyond_arc(wrap.pieces[1], leave) > 0 && last <= wrap.chain_range.last && curve.is_arc(last) {
                wrap.pieces[1] = last;
                changed = true;
            }
        }
        if !changed {
            break;
        }
        found = rounds(context, wraps, ends[0], ends[1]);
    }
    found
}

/// A circle on which a string turns, or a point if its radius is 0.
#[derive(Clone, Copy)]
struct Round {
    centre: Vec2,
    /// Radius, m.
    radius: f64,
    /// 1 or −1: the side on which the string passes it, as in
    /// [`crate::model::spans::boundary::Curve`].
    sense: f64,
}

impl Round {
    fn point(at: Vec2) -> Self {
        Self { centre: at, radius: 0.0, sense: 1.0 }
    }
}

/// The circles on which the string arrives at each wrap and leaves it; points at both ends.
fn rounds(context: &SolveContext, wraps: &[RouteWrap], start: Vec2, end: Vec2) -> Vec<[Round; 2]> {
    let mut out = vec![[Round::point(start); 2]];
    for s in wraps {
        let curve = &context.curves[s.curve];
        out.push(s.pieces.map(|i| {
            let place = curve.place_on(i, 0.0);
            let radius = place.stretch;
            Round { centre: place.at - place.normal * radius, radius, sense: curve.sense }
        }));
    }
    out.push([Round::point(end); 2]);
    out
}

/// Direction of the line that touches two circles: with n = σ perp t, (C₂ − C₁)·perp t = σ₁r₁ −
/// σ₂r₂.
fn tangent(a: Round, b: Round) -> Vec2 {
    let d = b.centre - a.centre;
    let distance = d.norm();
    if distance == 0.0 {
        return Vec2::x();
    }
    let tilt = ((b.sense * b.radius - a.sense * a.radius) / distance).clamp(-1.0, 1.0).asin();
    let (sin, cos) = tilt.sin_cos();
    Vec2::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y) / distance
}
