//! This module finds the active set of an elastica: its contacts, and for each whether it is a
//! point or a stretch.

use crate::contact::Gap;
use crate::math::{Vec2, perp};
use crate::model::fem::elastica::boundary_value::{
    ANGLE, ARC, ContactSurface, Elastica, ElasticaPiece, Joint, LENGTH, MOMENT, MOST_WORK, Owner, STATES, force, place,
    tangent,
};
use crate::model::fem::elastica::guess::contacts_of_answer::contact_at;
use crate::numerics::bisect;
use crate::problem::Problem;

/// Depth to which a cable may lie in an obstacle, as a fraction of its radius: the error of the
/// shape inside an element.
const OVERLAP_TOLERANCE: f64 = 1e-3;

/// Number of elements of a new stretch of contact.
const STRETCH_ELEMENTS: usize = 8;

/// First length of a new stretch of contact, as a fraction of its radius or of the shorter free
/// piece beside it. Newton's method finds the right length; if the first one is far too long, the
/// stretch turns over on the way.
const NEW_STRETCH_FRACTION: f64 = 0.05;

/// Length below which a stretch of contact becomes a point, as a fraction of the radius of the
/// round (of the cable where the contact is a line).
const SHORTEST_STRETCH_FRACTION: f64 = 1e-4;

/// Tolerance of the contact law: relative excess of the cable's curvature over that of the round it
/// touches, and pull at a contact as a fraction of the scene's forces.
const CONTACT_CURVATURE_TOLERANCE: f64 = 1e-7;

/// The same tolerance for a contact that was a stretch and became a point. At the limit both states
/// are solutions, and without this hysteresis the contact would alternate for ever.
const POINT_CURVATURE_TOLERANCE: f64 = 1e-3;

/// Nodes of a stretch on its edge with which it can end before the corner. Fewer: what is left of
/// it has no length; more: a short stretch beyond a corner is refused.
const LEAST_NODES_ON_EDGE: usize = 4;

/// Halvings of the bar in which a stretch leaves its edge: to less than a thousandth of it.
const CORNER_HALVINGS: usize = 10;

/// An end of a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StretchEnd {
    First,
    Last,
}

/// True if nothing is where the cable is said to lie.
fn is_clear(problem: &Problem, x: Vec2) -> bool {
    let near = OVERLAP_TOLERANCE * problem.radius;
    problem.world.signed_gap(x, near).is_none_or(|gap| gap.gap_m > near)
}

/// The two free pieces into which a node cuts a piece.
fn split(piece: &ElasticaPiece, node: usize) -> (ElasticaPiece, ElasticaPiece) {
    let cut = piece.grid[node];
    let part = |nodes: &[[f64; STATES]], grid: &[f64], from: f64, to: f64| ElasticaPiece {
        contact: None,
        grid: grid.iter().map(|g| (g - from) / (to - from)).collect(),
        nodes: nodes
            .iter()
            .map(|u| {
                let mut u = *u;
                u[LENGTH] *= to - from;
                u
            })
            .collect(),
    };
    (
        part(&piece.nodes[..=node], &piece.grid[..=node], 0.0, cut),
        part(&piece.nodes[node..], &piece.grid[node..], cut, 1.0),
    )
}

/// A place of a free piece that is inside an obstacle.
#[derive(Clone, Copy)]
struct Overlap {
    piece: usize,
    /// The inner node of the piece that is nearest to it.
    node: usize,
    gap: Gap,
}

impl Elastica {
    /// Finds the right set of contacts and solves with it; returns false if none is found.
    pub(super) fn settle(&mut self, problem: &Problem) -> bool {
        // Contacts that were stretches and became points.
        let mut points = Vec::new();
        // Each change of the set costs work; 1 to 4 changes are usual.
        while self.work <= MOST_WORK {
            let saved = self.clone();
            let solved = self.newton();
            if let Some(k) = self.shrinking.take().or_else(|| self.shortest_stretch(problem)) {
                points.extend(self.pieces[k].contact);
                if !solved {
                    *self = Self { steps: self.steps, work: self.work, ..saved };
                }
                self.make_point(k);
            } else if !solved {
                if !self.lift_off_lines(&saved) {
                    return false;
                }
            } else if !self.leave_ends_of_lines(problem) {
                match self.change_one_contact(problem, &points) {
                    Some(true) => {}
                    Some(false) => return true,
                    None => return false,
                }
            }
        }
        false
    }

    /// Goes back to the guess `from` with less contact on lines between free pieces: a stretch
    /// becomes a point, and a point opens. A cable that bends round obstacles before and behind a
    /// line is often lifted off it; if it is not, the cable meets the line again. Returns whether
    /// there was any such contact.
    fn lift_off_lines(&mut self, from: &Self) -> bool {
        let line = |k: usize| from.contacts.get(k).is_some_and(|c| c.radius.is_none());
        let inner = |k: usize| k > 0 && k + 1 < from.pieces.len();
        let stretch = (0..from.pieces.len()).find(|&k| inner(k) && from.pieces[k].contact.is_some_and(line));
        let point = from.joints.iter().position(|j| matches!(j, Joint::PointContact(k) if line(*k)));
        if stretch.is_none() && point.is_none() {
            return false;
        }
        *self = Self { steps: self.steps, work: self.work, ..from.clone() };
        if let Some(k) = stretch {
            let Some(contact) = self.pieces[k].contact else { return false };
            let middle = self.pieces[k].nodes.len() / 2;
            let (before, after) = split(&self.pieces[k], middle);
            self.pieces.splice(k..=k, [before, after]);
            self.joints.insert(k, Joint::PointContact(contact));
            self.release(k + 1);
            self.release(k - 1);
        } else if let Some(j) = point {
            self.release(j);
        }
        true
    }

    /// Lifts the cable off a line where the edge along which the line runs has ended: a point
    /// beyond the end opens, a stretch that lies wholly beyond it, too, and one that lies beyond it
    /// in part ends before the corner, over which the cable goes on. Returns whether there was one.
    fn leave_ends_of_lines(&mut self, problem: &Problem) -> bool {
        let line =
            |k: usize| self.contacts.get(k).is_some_and(|c| c.radius.is_none() && !matches!(c.owner, Owner::Pulley(_)));
        let is_clear = |u: &[f64; STATES]| is_clear(problem, place(u));
        let inner = |k: usize| k > 0 && k + 1 < self.pieces.len();
        let lies_beyond = |p: &ElasticaPiece| p.contact.is_some_and(line) && p.nodes.iter().all(is_clear);
        if let Some(k) = (0..self.pieces.len()).find(|&k| inner(k) && lies_beyond(&self.pieces[k])) {
            self.make_point(k);
            self.release(k - 1);
            return true;
        }
        let point = self.joints.iter().zip(&self.pieces).position(|(joint, before)| {
            matches!(joint, Joint::PointContact(k) if line(*k)) && before.nodes.last().is_some_and(is_clear)
        });
        if let Some(j) = point {
            self.release(j);
            return true;
        }
        let ends_beyond = |k: usize, end: StretchEnd| {
            let piece = &self.pieces[k];
            let mut nodes: Vec<&[f64; STATES]> = piece.nodes.iter().collect();
            if end == StretchEnd::First {
                nodes.reverse();
            }
            let on_edge = nodes.iter().take_while(|u| !is_clear(u)).count();
            let is_long_enough = on_edge >= LEAST_NODES_ON_EDGE && on_edge < nodes.len();
            (is_long_enough && piece.contact.is_some_and(line)).then_some((k, end, on_edge))
        };
        let inner = (0..self.pieces.len()).filter(|&k| inner(k));
        let found = inner.flat_map(|k| [StretchEnd::First, StretchEnd::Last].map(|end| (k, end)));
        let found = found.filter_map(|(k, end)| ends_beyond(k, end)).next();
        found.is_some_and(|(k, end, on_edge)| self.end_before_corner(problem, k, end, on_edge).is_some())
    }

    /// Lets stretch `k`, which lies beyond the corner of its line at one end but for `on_edge` of
    /// its nodes, end half-way to the corner, and touch that in a point.
    fn end_before_corner(&mut self, problem: &Problem, k: usize, end: StretchEnd, on_edge: usize) -> Option<()> {
        let piece = &self.pieces[k];
        let (count, on_line) = (piece.nodes.len(), piece.contact?);
        let line = *self.contacts.get(on_line)?;
        let cuts = |first: usize, second: usize| {
            let (before, rest) = split(piece, first);
            let (middle, after) = split(&rest, second - first);
            [before, middle, after]
        };
        // The node before the corner, the one beyond it, and where the piece is cut.
        let (on, beyond, [mut a, b, mut c]) = match end {
            StretchEnd::Last => (on_edge - 1, on_edge, cuts(on_edge / 2, on_edge - 1)),
            StretchEnd::First => {
                let on = count - on_edge;
                (on, on - 1, cuts(on, count - 1 - on_edge / 2))
            }
        };
        // Just beyond the corner nothing else is nearer.
        let [from, to] = [on, beyond].map(|i| place(&piece.nodes[i]));
        let is_on_edge = |part: f64| !is_clear(problem, from + (to - from) * part);
        let [_, part] = bisect([0.0, 1.0], CORNER_HALVINGS, is_on_edge);
        let x = from + (to - from) * part;
        let gap = problem.world.signed_gap(x, self.length)?;
        let corner = contact_at(problem, &gap, x, tangent(&piece.nodes[on])).filter(|c| c.radius.is_some())?;
        let corner = ContactSurface { mobilised: line.mobilised, slips: line.slips, sense: line.sense, ..corner };
        let touches_corner = Joint::PointContact(self.contacts.len());
        self.contacts.push(corner);
        // The free piece there takes over the part beyond the corner.
        let (joints, merged) = match end {
            StretchEnd::Last => {
                a.contact = Some(on_line);
                ([Joint::ContactEnd(on_line), touches_corner], k + 2)
            }
            StretchEnd::First => {
                c.contact = Some(on_line);
                ([touches_corner, Joint::ContactBegin(on_line)], k - 1)
            }
        };
        self.pieces.splice(k..=k, [a, b, c]);
        self.joints.splice(k..k, joints);
        self.release(merged);
        Some(())
    }

    /// The first stretch of contact between free pieces that is too short to be a stretch.
    fn shortest_stretch(&self, problem: &Problem) -> Option<usize> {
        let short = |p: &ElasticaPiece| {
            let c = p.contact.and_then(|k| self.contacts.get(k));
            c.is_some_and(|c| p.nodes[0][LENGTH] < SHORTEST_STRETCH_FRACTION * c.radius.unwrap_or(problem.radius))
        };
        let inner = |k: usize| k > 0 && k + 1 < self.pieces.len();
        (0..self.pieces.len()).find(|&k| inner(k) && short(&self.pieces[k]))
    }

    /// Turns the stretch of contact `k` into a point contact.
    fn make_point(&mut self, k: usize) {
        let Some(contact) = self.pieces[k].contact else { return };
        self.pieces.remove(k);
        self.joints.remove(k);
        self.joints[k - 1] = Joint::PointContact(contact);
    }

    /// Turns a point contact into a stretch.
    fn make_stretch(&mut self, joint: usize, contact: usize) {
        let (before, after) = (&self.pieces[joint], &self.pieces[joint + 1]);
        let (Some(mut u), Some(v)) = (before.nodes.last().copied(), after.nodes.first().copied()) else { return };
        let beside = before.nodes[0][LENGTH].min(v[LENGTH]);
        let c = self.contacts[contact];
        let room = c.radius.filter(|r| *r < beside).unwrap_or(beside);
        let over = c.sense * (u[MOMENT] / self.bending - c.curvature()) * room;
        let l = room * if over < NEW_STRETCH_FRACTION { over } else { NEW_STRETCH_FRACTION };
        let t = tangent(&u);
        let f = t * (0.5 * (force(&u) + force(&v)).dot(&t));
        (u[4], u[5], u[LENGTH]) = (f.x, f.y, l);
        u[MOMENT] = self.bending * c.curvature();
        let start = u[6] - 0.5 * l;
        let nodes = (0..=STRETCH_ELEMENTS).map(|i| {
            let way = l * i as f64 / STRETCH_ELEMENTS as f64;
            let mut node = u;
            node[6] = start + way;
            let off = t * (way - 0.5 * l);
            (node[0], node[1]) = (u[0] + off.x, u[1] + off.y);
            node[2] += c.curvature() * (way - 0.5 * l);
            node
        });
        let piece = ElasticaPiece {
            contact: Some(contact),
            nodes: nodes.collect(),
            grid: (0..=STRETCH_ELEMENTS).map(|i| i as f64 / STRETCH_ELEMENTS as f64).collect(),
        };
        self.pieces.insert(joint + 1, piece);
        self.joints[joint] = Joint::ContactBegin(contact);
        self.joints.insert(joint + 1, Joint::ContactEnd(contact));
    }

    /// Force of the contact at a joint along its normal, N.
    pub(super) fn push(&self, joint: usize) -> f64 {
        let (Joint::PointContact(k) | Joint::ContactBegin(k) | Joint::ContactEnd(k)) = self.joints[joint] else {
            return 0.0;
        };
        let ends = (self.pieces[joint].nodes.last(), self.pieces[joint + 1].nodes.first());
        let (Some(a), Some(b)) = ends else { return 0.0 };
        let normal = perp(tangent(a)) * -self.contacts[k].sense;
        -(force(b) - force(a)).dot(&normal)
    }

    /// Changes one contact that violates the contact law. Returns whether there was one, and None
    /// if no change can mend it.
    fn change_one_contact(&mut self, problem: &Problem, points: &[usize]) -> Option<bool> {
        if self.change_one_point_contact(problem, points)? {
            return Some(true);
        }
        let size = self.force_size();
        // Look for a stretch that would have to pull where it begins or ends.
        for j in 0..self.joints.len() {
            let (Joint::ContactBegin(k) | Joint::ContactEnd(k)) = self.joints[j] else { continue };
            let pulley = matches!(self.contacts[k].owner, Owner::Pulley(_));
            if !pulley && self.push(j) < -CONTACT_CURVATURE_TOLERANCE * size {
                return None;
            }
        }
        // Look for a stretch that would have to pull somewhere along it, or that lies inside
        // another obstacle.
        for k in 0..self.pieces.len() {
            let Some(c) = self.pieces[k].contact.and_then(|c| self.contacts.get(c)) else { continue };
            let pulley = matches!(c.owner, Owner::Pulley(_));
            for u in &self.pieces[k].nodes {
                let deeper = !pulley && self.deeper_contact(problem, c, place(u), tangent(u)).is_some();
                if deeper || (!pulley && self.pressure(c, u) * self.length < -CONTACT_CURVATURE_TOLERANCE * size) {
                    return None;
                }
            }
        }
        // Look for an end that its load lifts off its contact.
        let tips = [
            (0, self.pieces.first().map(|p| (p, p.nodes.first()))),
            (1, self.pieces.last().map(|p| (p, p.nodes.last()))),
        ];
        for (which, tip) in tips {
            let Some((piece, Some(u))) = tip else { continue };
            let contact = piece.contact.and_then(|c| self.contacts.get(c));
            if contact.is_some_and(|c| self.tip_push(which, c, u) < -CONTACT_CURVATURE_TOLERANCE * size) {
                return None;
            }
        }
        self.add_deepest_contact(problem)
    }

    /// The force relative to which one counts as zero, N.
    fn force_size(&self) -> f64 {
        self.scale + self.bending / (self.length * self.length)
    }

    /// Changes one contact in a point that pulls, that is bent more than what it touches, or that
    /// lies inside another obstacle. Returns as [`Self::change_one_contact`].
    fn change_one_point_contact(&mut self, problem: &Problem, points: &[usize]) -> Option<bool> {
        let size = self.force_size();
        for j in 0..self.joints.len() {
            let Joint::PointContact(k) = self.joints[j] else { continue };
            let c = self.contacts[k];
            let u = *self.pieces[j].nodes.last()?;
            let pulley = matches!(c.owner, Owner::Pulley(_));
            if !pulley && self.push(j) < -CONTACT_CURVATURE_TOLERANCE * size {
                self.release(j);
                return Some(true);
            }
            if c.is_point() {
                continue;
            }
            let bent = c.sense * (u[MOMENT] / self.bending - c.curvature());
            let least = 1.0 / self.length;
            let limit = if c.curvature().abs() > least { c.curvature().abs() } else { least };
            let slack = if points.contains(&k) { POINT_CURVATURE_TOLERANCE } else { CONTACT_CURVATURE_TOLERANCE };
            if bent > slack * limit {
                self.make_stretch(j, k);
                return Some(true);
            }
            if !pulley && let Some(other) = self.deeper_contact(problem, &c, place(&u), tangent(&u)) {
                self.contacts[k] = other;
                return Some(true);
            }
        }
        Some(false)
    }

    /// Distance of the centre line from an obstacle in contact, m.
    fn contact_distance(&self, problem: &Problem, gap: &crate::contact::Gap) -> f64 {
        problem.world.geometry().body_of(gap.feature).map_or(problem.radius, |b| b.offset)
    }

    /// Opens a point contact: the pieces beside it become one.
    fn release(&mut self, joint: usize) {
        let after = self.pieces.remove(joint + 1);
        self.joints.remove(joint);
        self.pieces[joint].contact = None;
        let before = &mut self.pieces[joint];
        let (a, b) = (before.nodes[0][LENGTH], after.nodes[0][LENGTH]);
        let whole = a + b;
        let mut grid: Vec<f64> = before.grid.iter().map(|g| g * a / whole).collect();
        grid.extend(after.grid.iter().skip(1).map(|g| (a + g * b) / whole));
        before.grid = grid;
        before.nodes.extend(after.nodes.iter().skip(1));
        for u in &mut before.nodes {
            u[LENGTH] = whole;
        }
    }

    /// Another contact whose obstacle contains the place `x` on contact `c`, if there is one.
    fn deeper_contact(&self, problem: &Problem, c: &ContactSurface, x: Vec2, t: Vec2) -> Option<ContactSurface> {
        let deep = OVERLAP_TOLERANCE * problem.radius;
        let gap = problem.world.signed_gap(x, 0.0).filter(|g| g.gap_m < -deep)?;
        let other = contact_at(problem, &gap, x, t)?;
        Some(ContactSurface { mobilised: c.mobilised, slips: c.slips, sense: c.sense, ..other })
    }

    /// The friction that a new contact in a piece mobilises, and whether it slips: the values of
    /// the flexible cable if that lay there, else the mean of the contacts before and after it.
    fn friction_of_new(&self, new: &ContactSurface, piece: usize, coefficient: f64) -> (f64, bool) {
        let far = |c: &&ContactSurface| (c.at - new.at).norm();
        let on_it = self.contacts.iter().filter(|c| c.is_same_surface(new));
        if let Some(known) = on_it.min_by(|a, b| far(a).total_cmp(&far(b))) {
            return (known.mobilised, known.slips);
        }
        let contact_of = |joint: &Joint| match joint {
            Joint::PointContact(k) | Joint::ContactBegin(k) | Joint::ContactEnd(k) => self.contacts.get(*k),
            Joint::Held { .. } | Joint::Load { .. } => None,
        };
        let before = self.joints.iter().take(piece).rev().find_map(contact_of);
        let after = self.joints.iter().skip(piece).find_map(contact_of);
        let beside: Vec<&ContactSurface> = before.into_iter().chain(after).collect();
        if beside.is_empty() {
            return (0.0, false);
        }
        let mean = beside.iter().map(|c| c.mobilised).sum::<f64>() / beside.len() as f64;
        (mean.clamp(-coefficient, coefficient), beside.iter().all(|c| c.slips))
    }

    /// Adds a point contact where free pieces are deepest inside an obstacle. Returns whether any
    /// piece is inside one, and None if that piece has no node at which it can be divided.
    fn add_deepest_contact(&mut self, problem: &Problem) -> Option<bool> {
        let deep = OVERLAP_TOLERANCE * problem.radius;
        let mut deepest: Option<Overlap> = None;
        let world = &problem.world;
        for (k, piece) in self.pieces.iter().enumerate().filter(|(_, p)| p.contact.is_none()) {
            let mut measure = |x: Vec2, i: usize| {
                let Some(gap) = world.signed_gap(x, self.length) else { return };
                if gap.gap_m < -deep && deepest.is_none_or(|d| gap.gap_m < d.gap.gap_m) {
                    deepest = Some(Overlap { piece: k, node: i, gap });
                }
            };
            let last = piece.nodes.len() - 1;
            for i in 0..last {
                let (a, b) = (&piece.nodes[i], &piece.nodes[i + 1]);
                if i > 0 {
                    measure(place(a), i);
                }
                // Between two nodes the cable may run into a corner or round that contains neither
                // of them.
                let bulge = (b[ANGLE] - a[ANGLE]).abs() * (b[ARC] - a[ARC]);
                let (from, to) = (piece.grid[i], piece.grid[i + 1]);
                world.geometry().segment_pairs(place(a), place(b), bulge, &mut |p| {
                    let at = self.state_in(piece, from + (to - from) * p.gap.fraction);
                    let nearer = if p.gap.fraction < 0.5 { i } else { i + 1 };
                    // Take the nearest inner node; a piece of one element has none.
                    measure(place(&at), nearer.min(last - 1).max(1));
                });
            }
        }
        let Some(Overlap { piece: k, node: i, gap }) = deepest else { return Some(false) };
        if i + 1 >= self.pieces[k].nodes.len() {
            return None;
        }
        let u = self.pieces[k].nodes[i];
        // The line of a flat contact goes through where the gap was measured.
        let x = gap.point + gap.normal * (gap.gap_m + self.contact_distance(problem, &gap));
        let mut contact = contact_at(problem, &gap, x, tangent(&u))?;
        if gap.friction > 0.0 {
            (contact.mobilised, contact.slips) = self.friction_of_new(&contact, k, gap.friction);
        }
        self.contacts.push(contact);
        let (before, after) = split(&self.pieces[k], i);
        self.pieces.splice(k..=k, [before, after]);
        self.joints.insert(k, Joint::PointContact(self.contacts.len() - 1));
        Some(true)
    }
}
