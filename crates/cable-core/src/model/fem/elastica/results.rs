//! This module writes a solved elastica as an answer, with its error estimates.

use crate::math::{Vec2, larger, perp};
use crate::model::fem::elastica::boundary_value::{
    ANGLE, ARC, ContactSurface, Elastica, ElasticaPiece, End, Joint, LENGTH, MOMENT, Owner, STATES, force, place,
    tangent, tension,
};
use crate::numerics::bisect;
use crate::problem::Problem;
use crate::solution::ErrorEstimates;
use crate::solution::{
    Assumptions, CableSolution, ContactReport, ContactSample, ContactState, Cost, Node, SupportReaction,
};

/// Difference of arc lengths within which two nodes are the joint of two pieces, as a fraction of
/// the cable's length: round-off. Smaller: a joint has two nodes; larger: short pieces lose theirs.
const SAME_POINT_FRACTION: f64 = 1e-12;
/// The error of a method of the fourth order is its change by halved elements over this, 2⁴ − 1.
const FOURTH_ORDER_DIVISOR: f64 = 15.0;

/// Maximum number of nodes of a piece in an answer.
const MOST_PARTS: f64 = 400.0;

/// Distance by which the straight line between two nodes may leave the cable: a fraction of its
/// diameter, and a length in m.
const MAX_CHORD_DISTANCE: [f64; 2] = [0.01, 5e-4];

/// Distance of the last node before the end of a piece in contact, as a fraction of the piece.
const END_NODE_OFFSET: f64 = 1e-6;

/// Least distance of two nodes of an answer, as a fraction of an element.
const NODE_SPACING_FRACTION: f64 = 1e-3;

/// Number of halvings of an element that locate its greatest tension: the error of that tension is
/// the square of the interval that is left.
const PEAK_HALVINGS: usize = 24;

/// Error that may be left after the elements are halved, as a fraction of the change by halving:
/// 1/15 by the fourth order, and twice that because the last elements beside a contact may not have
/// reached this order.
const HALVING_ERROR_FRACTION: f64 = 2.0 / 15.0;

/// Excess of the straight line between two nodes over its arc, of the square of the turn of the
/// arc, above which elements are halved: as much as a chord is shorter. Smaller: more elements than
/// the shape needs; larger: ways are drawn that are no way of the cable.
const CHORD_EXCESS: f64 = 1.0 / 24.0;

/// Round-off of the straight line between two nodes, of the length of the cable.
const STRAIGHT_LINE_ROUNDING_FRACTION: f64 = 1e-9;

/// Maximum number of elements of all pieces together after refinement.
const MOST_ELEMENTS: usize = 4000;

/// Raises the bending stiffness of the elastica to that of the cable and refines its elements.
/// Returns the answer with its error, and None if the continuation fails.
pub fn stiffen_and_refine(mut elastica: Elastica, problem: &Problem, tolerance: f64) -> Option<(CableSolution, Cost)> {
    if !elastica.stiffen(problem) {
        return None;
    }
    let (estimate, errors) = refine(&mut elastica, problem, tolerance)?;
    let (iterations, residual_n) = elastica.cost();
    let answer = CableSolution { error_estimate: Some(estimate), errors, ..solution(&elastica, problem) };
    Some((answer, Cost { iterations, residual_n, ..Cost::default() }))
}

/// Halves the elements until the forces change by less than the fraction `tolerance` of the
/// greatest tension and no chord is longer than its arc, or until the next halving fails. Returns
/// the answer's error relative to the greatest tension, and None if the first halving fails: then
/// nothing is known of the error.
pub fn refine(elastica: &mut Elastica, problem: &Problem, tolerance: f64) -> Option<(f64, ErrorEstimates)> {
    let mut known = None;
    loop {
        let mut fine = elastica.halved();
        fine.regrid();
        if !fine.settle(problem) || !fine.is_sound() {
            return known;
        }
        let (mut change, mut largest): (f64, f64) = (0.0, 0.0);
        if fine.joints == elastica.joints {
            for (a, b) in elastica.pieces.iter().zip(&fine.pieces) {
                for (u, v) in [(a.nodes.first(), b.nodes.first()), (a.nodes.last(), b.nodes.last())] {
                    let (Some(u), Some(v)) = (u, v) else { return None };
                    change = larger(change, (force(u) - force(v)).norm());
                    largest = larger(largest, force(v).norm());
                }
            }
        } else {
            change = f64::INFINITY;
        }
        let estimate = if largest > 0.0 { change / (FOURTH_ORDER_DIVISOR * largest) } else { change };
        let coarse = std::mem::replace(elastica, fine);
        let count: usize = elastica.pieces.iter().map(|p| p.nodes.len()).sum();
        let answer = solution(elastica, problem);
        let rounding = ErrorEstimates::rounding(&answer, problem);
        let errors = ErrorEstimates::between(&solution(&coarse, problem), &answer).times(HALVING_ERROR_FRACTION);
        let relative = estimate + rounding.relative(&answer)?;
        known = relative.is_finite().then_some((relative, errors.plus(&rounding)));
        let resolved = estimate <= tolerance && chords_fit(elastica, problem, &answer);
        if resolved || count > MOST_ELEMENTS {
            return known;
        }
    }
}

/// Returns whether no straight line between two nodes of the answer of an elastica is longer than
/// the arc of which it is the chord: within elements that turn far it is, by up to 0.2 %, while the
/// forces at their ends are right.
fn chords_fit(elastica: &Elastica, problem: &Problem, answer: &CableSolution) -> bool {
    answer.nodes.windows(2).all(|pair| {
        let [a, b] = [&pair[0], &pair[1]];
        let (material, pull) = (b.arc_length_m - a.arc_length_m, 0.5 * (a.tension_n + b.tension_n));
        let turn = larger(a.curvature_per_m.abs(), b.curvature_per_m.abs()) * material;
        let change = (b.tension_n - a.tension_n).abs() / problem.axial_stiffness;
        let arc = elastica.thermal_stretch * material * (1.0 + pull / problem.axial_stiffness);
        (b.at() - a.at()).norm() - arc
            <= (CHORD_EXCESS * turn * turn + change) * material + STRAIGHT_LINE_ROUNDING_FRACTION * elastica.length
    })
}

/// The answer of an elastica.
pub fn solution(elastica: &Elastica, problem: &Problem) -> CableSolution {
    let nodes = nodes(elastica, problem);
    CableSolution {
        name: problem.cable.name.clone(),
        supports: supports(elastica, problem, &nodes),
        contacts: contact_reports(elastica, problem),
        nodes: nodes.into(),
        assumptions: Assumptions { bending_stiffness_n_m2: elastica.bending, ..Assumptions::default() },
        ..CableSolution::default()
    }
}

/// The nodes of all pieces; pieces that meet share one.
fn nodes(elastica: &Elastica, problem: &Problem) -> Vec<Node> {
    let mut out: Vec<Node> = Vec::new();
    let area = problem.cable.area_m2();
    for (k, piece) in elastica.pieces.iter().enumerate() {
        let before = k.checked_sub(1).and_then(|j| elastica.joints.get(j));
        let clamped = matches!(before, Some(Joint::Held { angle: Some(_), .. }));
        for u in drawn(elastica, problem, piece) {
            let t = tension(&u);
            let node = Node {
                arc_length_m: u[ARC],
                x_m: u[0],
                y_m: u[1],
                tension_n: t,
                strain: t / problem.axial_stiffness,
                stress_pa: t / area,
                curvature_per_m: elastica.thermal_stretch * u[MOMENT] / elastica.bending,
                force_n: force(&u).into(),
                ..Node::default()
            };
            match out.last_mut() {
                // At the joint of two pieces, the greater tension and the force of the second piece
                // count, and the sharper of two bends between which a clamp is.
                Some(l) if node.arc_length_m <= l.arc_length_m + SAME_POINT_FRACTION * elastica.length => {
                    let bends = [l.curvature_per_m, node.curvature_per_m];
                    if node.tension_n > l.tension_n {
                        *l = node;
                    }
                    l.force_n = node.force_n;
                    if clamped {
                        l.curvature_per_m = if bends[0].abs() > bends[1].abs() { bends[0] } else { bends[1] };
                    }
                }
                _ => out.push(node),
            }
        }
    }
    if let Some(first) = out.first_mut() {
        first.arc_length_m = 0.0;
    }
    if let Some(last) = out.last_mut() {
        last.arc_length_m = elastica.length;
    }
    out
}

/// The reactions of all supports, in their order.
fn supports(elastica: &Elastica, problem: &Problem, nodes: &[Node]) -> Vec<SupportReaction> {
    let ends = |k: usize| {
        (elastica.pieces.get(k).and_then(|p| p.nodes.last()), elastica.pieces.get(k + 1).and_then(|p| p.nodes.first()))
    };
    let last = problem.supports.len() - 1;
    let mut out = Vec::with_capacity(last + 1);
    for (k, s) in problem.supports.iter().enumerate() {
        let mut r = SupportReaction { name: s.name.clone(), ..SupportReaction::default() };
        let mut put = |f: Vec2, x: Vec2, arc: f64| {
            (r.reaction_x_n, r.reaction_y_n, r.x_m, r.y_m, r.arc_length_m) = (f.x, f.y, x.x, x.y, arc);
        };
        if k == 0 || k == last {
            let which = usize::from(k > 0);
            let (u, node) = if which == 0 {
                (elastica.pieces.first().and_then(|p| p.nodes.first()), nodes.first())
            } else {
                (elastica.pieces.last().and_then(|p| p.nodes.last()), nodes.last())
            };
            if let (Some(u), Some(node)) = (u, node) {
                let f = match elastica.ends[which] {
                    End::Held(..) => force(u) * if which == 0 { 1.0 } else { -1.0 },
                    End::Loaded(load) => -load,
                };
                put(f, node.at(), node.arc_length_m);
            }
        } else {
            for (j, joint) in elastica.joints.iter().enumerate() {
                let (Some(a), Some(b)) = ends(j) else { continue };
                match *joint {
                    Joint::Held { support, .. } if support == k => put(force(b) - force(a), place(b), b[ARC]),
                    Joint::Load { support: Some(support), force, .. } if support == k => put(-force, place(b), b[ARC]),
                    _ => {}
                }
            }
        }
        let pulley = |c: usize| elastica.contacts.get(c).is_some_and(|c| c.owner == Owner::Pulley(k));
        let begins = elastica
            .joints
            .iter()
            .position(|j| matches!(j, Joint::PointContact(c) | Joint::ContactBegin(c) if pulley(*c)));
        let stops = elastica
            .joints
            .iter()
            .rposition(|j| matches!(j, Joint::PointContact(c) | Joint::ContactEnd(c) if pulley(*c)));
        if let (Some(i), Some(j)) = (begins, stops)
            && let ((Some(a), _), (_, Some(b))) = (ends(i), ends(j))
        {
            let on = elastica.body * (b[ARC] - a[ARC]);
            let at = s.at.unwrap_or_default();
            put(force(b) - force(a) + on, at, 0.5 * (a[ARC] + b[ARC]));
            (r.tension_before_n, r.tension_after_n) = (Some(tension(a)), Some(tension(b)));
        }
        out.push(r);
    }
    out
}

fn contact_reports(elastica: &Elastica, problem: &Problem) -> Vec<ContactReport> {
    let joints = elastica.joints.iter().enumerate();
    let at_joints = joints.filter_map(|(j, joint)| contact_report(elastica, problem, j, *joint));
    report_of_whole(elastica, problem).into_iter().chain(at_joints).collect()
}

/// The contact that begins at joint `j`, or with which the cable begins there; None if there is
/// none.
fn contact_report(elastica: &Elastica, problem: &Problem, j: usize, joint: Joint) -> Option<ContactReport> {
    let (k, stretch) = match joint {
        Joint::PointContact(k) => (k, None),
        Joint::ContactBegin(k) => (k, elastica.pieces.get(j + 1)),
        // The cable begins with this stretch.
        Joint::ContactEnd(k) if j == 0 => (k, elastica.pieces.first()),
        _ => return None,
    };
    let c = elastica.contacts.get(k)?;
    let Owner::Obstacle(obstacle) = c.owner else { return None };
    let (Some(a), Some(b)) = (elastica.pieces[j].nodes.last(), elastica.pieces[j + 1].nodes.first()) else {
        return None;
    };
    let mut r = ContactReport {
        obstacle: problem.world.obstacle_name(obstacle).to_owned(),
        normal_n: elastica.push(j),
        tension_before_n: tension(a),
        tension_after_n: tension(b),
        begins_m: a[ARC],
        ends_m: b[ARC],
        state: if c.slips || c.mobilised == 0.0 { ContactState::Slip } else { ContactState::Stick },
        ..ContactReport::default()
    };
    let mut samples = joint_samples(elastica, problem, j, joint, stretch);
    let tip = match (joint, stretch) {
        (Joint::ContactEnd(_), Some(p)) => p.nodes.first().map(|u| (0, u)),
        (Joint::ContactBegin(_), Some(p)) if j + 2 == elastica.pieces.len() => p.nodes.last().map(|u| (1, u)),
        _ => None,
    };
    if let Some((which, u)) = tip {
        let push = elastica.tip_push(which, c, u);
        let force = perp(tangent(u)) * (-c.sense * push) + tangent(u) * (c.mobilised * push);
        r.normal_n += push;
        samples.insert(if which == 0 { 0 } else { samples.len() }, ContactSample::new(u[ARC], force));
    }
    r.set_samples(samples);
    let (mut middle, mut normal) = (place(a), perp(tangent(a)) * -c.sense);
    if let Some(p) = stretch {
        r.normal_n += pressed_along(elastica, c, p);
        let (Some(first), Some(last)) = (p.nodes.first(), p.nodes.last()) else { return None };
        if let (Joint::ContactBegin(_), Some(next)) = (joint, elastica.pieces.get(j + 2).and_then(|p| p.nodes.first()))
        {
            r.normal_n += elastica.push(j + 1);
            r.tension_after_n = tension(next);
        } else if joint == Joint::ContactBegin(k) {
            r.tension_after_n = tension(last);
        } else {
            r.tension_before_n = tension(first);
        }
        (r.begins_m, r.ends_m) = (first[ARC], last[ARC]);
        r.turn_deg = (last[ANGLE] - first[ANGLE]).to_degrees();
        let u = elastica.state_in(p, 0.5);
        (middle, normal) = (place(&u), perp(tangent(&u)) * -c.sense);
    }
    r.friction_n = c.mobilised * r.normal_n;
    r.arc_length_m = 0.5 * (r.begins_m + r.ends_m);
    (r.x_m, r.y_m, r.normal) = (middle.x, middle.y, [normal.x, normal.y]);
    Some(r)
}

/// Samples of the contact force at joint `j`, and along the stretch beside it with its other end.
fn joint_samples(
    elastica: &Elastica,
    problem: &Problem,
    j: usize,
    joint: Joint,
    stretch: Option<&ElasticaPiece>,
) -> Vec<ContactSample> {
    let (Some(a), Some(b)) = (elastica.pieces[j].nodes.last(), elastica.pieces[j + 1].nodes.first()) else {
        return Vec::new();
    };
    let mut samples = vec![ContactSample::new(a[ARC], force(a) - force(b))];
    if let (Joint::ContactEnd(_), Some(p)) = (joint, stretch) {
        // The point force follows the stretch.
        samples = along(elastica, problem, p);
        samples.push(ContactSample::new(a[ARC], force(a) - force(b)));
    } else if let Some(p) = stretch {
        samples.extend(along(elastica, problem, p));
        if let (Some(last), Some(next)) = (p.nodes.last(), elastica.pieces.get(j + 2).and_then(|p| p.nodes.first())) {
            samples.push(ContactSample::new(last[ARC], force(last) - force(next)));
        }
    }
    samples
}

/// Force along the normal of a contact on the piece that lies on it, N.
fn pressed_along(elastica: &Elastica, contact: &ContactSurface, piece: &ElasticaPiece) -> f64 {
    let Some(first) = piece.nodes.first() else { return 0.0 };
    let of_element = |(u, g): (&[[f64; STATES]], &[f64])| {
        let half = elastica.state_in(piece, 0.5 * (g[0] + g[1]));
        let [from, middle, to] = [&u[0], &half, &u[1]].map(|u| elastica.pressure(contact, u));
        (from + 4.0 * middle + to) * first[LENGTH] * (g[1] - g[0]) / 6.0
    };
    piece.nodes.windows(2).zip(piece.grid.windows(2)).map(of_element).sum()
}

/// The contact of a cable that lies on one surface from end to end; None if it does not.
fn report_of_whole(elastica: &Elastica, problem: &Problem) -> Option<ContactReport> {
    let [piece] = elastica.pieces.as_slice() else { return None };
    let contact = elastica.contacts.get(piece.contact?)?;
    let Owner::Obstacle(obstacle) = contact.owner else { return None };
    let (first, last, middle) = (piece.nodes.first()?, piece.nodes.last()?, elastica.state_in(piece, 0.5));
    let (at, normal) = (place(&middle), perp(tangent(&middle)) * -contact.sense);
    let normal_n = pressed_along(elastica, contact, piece);
    let mut report = ContactReport {
        obstacle: problem.world.obstacle_name(obstacle).to_owned(),
        normal_n,
        friction_n: contact.mobilised * normal_n,
        tension_before_n: tension(first),
        tension_after_n: tension(last),
        begins_m: first[ARC],
        ends_m: last[ARC],
        arc_length_m: 0.5 * (first[ARC] + last[ARC]),
        turn_deg: (last[ANGLE] - first[ANGLE]).to_degrees(),
        x_m: at.x,
        y_m: at.y,
        normal: normal.into(),
        state: if contact.slips || contact.mobilised == 0.0 { ContactState::Slip } else { ContactState::Stick },
        ..ContactReport::default()
    };
    report.set_samples(along(elastica, problem, piece));
    Some(report)
}

/// The states of a piece at as many places as straight lines need to draw it.
fn drawn(elastica: &Elastica, problem: &Problem, piece: &ElasticaPiece) -> Vec<[f64; STATES]> {
    let flat = (MAX_CHORD_DISTANCE[0] * 2.0 * problem.radius).min(MAX_CHORD_DISTANCE[1]);
    let mut out: Vec<[f64; STATES]> = piece.nodes.first().copied().into_iter().collect();
    for (pair, g) in piece.nodes.windows(2).zip(piece.grid.windows(2)) {
        let (a, b) = (&pair[0], &pair[1]);
        // The sagitta is the length times the turn over 8.
        let off = (b[ANGLE] - a[ANGLE]).abs() * (b[ARC] - a[ARC]) / 8.0;
        let parts = (off / flat).sqrt().ceil().clamp(1.0, MOST_PARTS) as usize;
        let mut places: Vec<f64> = (1..parts).map(|i| g[0] + i as f64 / parts as f64 * (g[1] - g[0])).collect();
        let apart = NODE_SPACING_FRACTION * (g[1] - g[0]);
        let clear = |x: &f64| places.iter().chain(g).all(|y| (x - y).abs() > apart);
        places.extend(peak(elastica, piece, [g[0], g[1]]).filter(clear));
        places.sort_by(f64::total_cmp);
        out.extend(places.into_iter().map(|x| elastica.state_in(piece, x)));
        // A node just before the end separates the distributed force from the point force at the
        // end.
        if piece.contact.is_some() && g[1] >= 1.0 {
            out.push(elastica.state_in(piece, 1.0 - END_NODE_OFFSET));
        }
        out.push(*b);
    }
    out
}

/// The place of the greatest tension between two places of a piece, if it is at neither. The nodes
/// alone would miss part of it, which grows with the square of their distance.
fn peak(elastica: &Elastica, piece: &ElasticaPiece, [from, to]: [f64; 2]) -> Option<f64> {
    let rises = |x: f64| {
        let u = elastica.state_in(piece, x);
        let (t, by) = (tangent(&u), elastica.slope(piece.contact, &u));
        Vec2::new(by[4], by[5]).dot(&t) + force(&u).dot(&perp(t)) * by[ANGLE] > 0.0
    };
    if !rises(from) || rises(to) {
        return None;
    }
    Some(bisect([from, to], PEAK_HALVINGS, rises)[0])
}

/// Samples of the contact force along a piece that lies on its contact.
fn along(elastica: &Elastica, problem: &Problem, piece: &ElasticaPiece) -> Vec<ContactSample> {
    let of = |pair: &[[f64; STATES]]| {
        let (a, b) = (&pair[0], &pair[1]);
        let on = force(a) - force(b) - elastica.body * (b[ARC] - a[ARC]);
        ContactSample::new(0.5 * (a[ARC] + b[ARC]), on)
    };
    drawn(elastica, problem, piece).windows(2).map(of).collect()
}
