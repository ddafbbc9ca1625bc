//! The first guess of a stiff cable comes from the answer for a flexible one, by continuation in
//! its stiffness.

use crate::contact::Gap;
use crate::math::{Vec2, cross, perp};
use crate::model::fem::elastica::boundary_value::{
    ANGLE, ARC, Contact, Elastica, End, Joint, LENGTH, MOMENT, MOST_WORK, Owner, Piece, STATES, force, tangent,
};
use crate::model::fem::elastica::flexible_answer::{Curve, mobilised};
use crate::model::fem::elastica::relax::{Chain, ContactPair};
use crate::model::fem::free::beam::mesh::places;
use crate::model::fem::free::stations::place as support_place;
use crate::model::fem::mesh::sliding_node::round_of;
use crate::problem::Problem;
use crate::scene::{PulleySide, SupportKind};
use crate::solution::CableSolution;

/// Elements of a free piece to begin with, and of one that lies. Fewer: Newton starts outside of
/// where it converges; more: costs.
const FREE_ELEMENTS: usize = 32;
/// See `FREE_ELEMENTS`.
const LYING_ELEMENTS: usize = 8;

/// Layer λ that the way up in EI begins with, in parts of the shortest free piece. Larger: its
/// first guess, a flexible cable with layers, is too rough; smaller: more steps.
const FIRST_LAYER: f64 = 0.05;

/// Part of an element over which the slope of a state is compared with itself. Smaller: rounding;
/// larger: its square is seen.
const DIFFERENCE: f64 = 1e-2;

/// Factor of the first rise of EI; it grows where that is easy and shrinks where it is not.
const FIRST_RISE: f64 = 4.0;

/// Tries of rising. A rise from 1e-6 of EI by fours takes 10.
const MAX_RISES: usize = 60;

/// Part of the cable's radius that a node of the flexible answer may be off what it lies on.
const CONTACT_DISTANCE_FRACTION: f64 = 1e-3;

/// Part of an arc that is given up where two contacts leave no cable between them.
const SURRENDERED_ARC_FRACTION: f64 = 0.25;

/// A state of the cable between two arc lengths (m).
#[derive(Clone, Copy, Debug)]
struct Event {
    from: f64,
    to: f64,
    joint: Joint,
}

/// The contact that a gap at `x` with direction `t` speaks of; None at what no cable can lie on.
pub(super) fn contact_at(problem: &Problem, gap: &Gap, x: Vec2, t: Vec2) -> Option<Contact> {
    let sense = if gap.normal.dot(&perp(t)) > 0.0 { -1.0 } else { 1.0 };
    let owner = Owner::Obstacle(gap.obstacle);
    let line = Contact {
        owner,
        at: x - gap.normal * gap.gap_m,
        radius: None,
        normal: gap.normal,
        sense,
        mobilised: 0.0,
        slips: false,
    };
    if gap.feature.is_multiple_of(2) {
        return Some(line);
    }
    let (center, radius) = round_of(problem.world.geometry(), gap.feature, 0.0, 0.0)?;
    Some(Contact { at: center, radius: Some(radius), ..line })
}

impl Elastica {
    /// A first guess: the cable of an answer for a flexible one, at rest at a time (s); None where
    /// the scene or the answer has what this knows nothing of.
    pub fn from_flexible(
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        answer: &CableSolution,
    ) -> Option<Self> {
        Self::guess(problem, time_s, dragged, answer, None, None)
    }

    /// The same from the answer of a mesh for the cable as stiff as it is; `bar`: the length of its
    /// bars, m, over which it knows where contacts are.
    pub fn from_mesh(
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        answer: &CableSolution,
        bar: f64,
    ) -> Option<Self> {
        Self::guess(problem, time_s, dragged, answer, Some(bar), None)
    }

    /// The same from a chain of bars at rest.
    pub(super) fn from_chain(chain: &Chain<'_>, dragged: &[Option<Vec2>]) -> Option<Self> {
        let contacts = chain.lay.map_or_else(Vec::new, |l| l.contacts.clone());
        let answer = CableSolution { nodes: chain.nodes(), contacts, ..CableSolution::default() };
        Self::guess(chain.problem, chain.time_s, dragged, &answer, Some(chain.bar), Some(&chain.pushes()))
    }

    /// The contacts of a chain.
    fn chain_contacts(
        &mut self,
        problem: &Problem,
        answer: &CableSolution,
        curve: &Curve<'_>,
        bar: f64,
        pushes: &[ContactPair],
        events: &mut Vec<Event>,
    ) {
        let mut done = vec![false; pushes.len()];
        for i in 0..pushes.len() {
            if done[i] {
                continue;
            }
            let a = &pushes[i];
            let (mut to, mut sum, mut first) = (a.arc, a.push, a.push * a.arc);
            for j in i + 1..pushes.len() {
                let b = &pushes[j];
                if b.arc - to > 2.5 * bar {
                    break;
                }
                if !done[j] && b.gap.feature == a.gap.feature && b.gap.obstacle == a.gap.obstacle {
                    done[j] = true;
                    to = b.arc;
                    sum += b.push;
                    first += b.push * b.arc;
                }
            }
            let long = to - a.arc > 2.5 * bar;
            let s = if long { 0.5 * (a.arc + to) } else { first / sum };
            let angle = curve.angle(s, [s - bar, s + bar]);
            let t = Vec2::new(angle.cos(), angle.sin());
            let x = curve.at(a.arc).0;
            let Some(mut contact) = contact_at(problem, &a.gap, x, t) else { continue };
            self.mobilise(problem, answer, &mut contact, s);
            let k = self.contacts.len();
            self.contacts.push(contact);
            let [from, to] = if long { [a.arc, to] } else { [s, s] };
            events.push(Event { from, to, joint: if long { Joint::Begin(k) } else { Joint::ContactPair(k) } });
        }
    }

    fn guess(
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        answer: &CableSolution,
        bar: Option<f64>,
        pushes: Option<&[ContactPair]>,
    ) -> Option<Self> {
        let alone = problem.outline.is_none() && problem.floor_friction.is_none() && !problem.cable.self_contact;
        if !alone || answer.nodes.len() < 2 || !answer.breaks.is_empty() {
            return None;
        }
        let curve = Curve::new(&answer.nodes);
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        let mut events = Vec::new();
        let last = problem.supports.len().checked_sub(1)?;
        let mut ends = [End::Loaded(Vec2::zeros()); 2];
        for (k, s) in problem.supports.iter().enumerate() {
            let at = support_place(problem, k, time_s, dragged);
            let loaded = matches!(s.kind, SupportKind::Load | SupportKind::Free) || at.is_none();
            let load = s.force.at(time_s) + gravity * s.mass;
            let angle = s.angle.filter(|_| s.kind == SupportKind::Clamped);
            let held = at.filter(|_| !loaded);
            if k == 0 || k == last {
                if s.kind == SupportKind::Pulley {
                    return None;
                }
                ends[usize::from(k > 0)] = held.map_or(End::Loaded(load), |p| End::Held(p, angle));
            } else if s.kind != SupportKind::Pulley {
                let arc = s.arc_length?;
                let joint = held.map_or(Joint::Load(Some(k), arc, load), |p| Joint::Held(k, arc, p, angle));
                events.push(Event { from: arc, to: arc, joint });
            }
        }
        for load in &problem.loads {
            let (s, force) = (load.arc_length, load.force.at(time_s));
            match ends.iter_mut().zip([0.0, problem.length]).find(|(_, at)| (s - at).abs() <= 1e-9 * problem.length) {
                Some((End::Loaded(f), _)) => *f += force,
                Some(_) => {}
                None => events.push(Event { from: s, to: s, joint: Joint::Load(None, s, force) }),
            }
        }
        let whole = problem.force_scale();
        let mut this = Self {
            axial_stiffness: problem.axial_stiffness,
            bending: problem.bending_stiffness,
            thermal_stretch: problem.thermal_stretch,
            body: problem.body_force(time_s),
            length: problem.length,
            scale: answer.nodes.iter().map(|n| n.tension_n).fold(whole, |m, t| if t > m { t } else { m }),
            pieces: Vec::new(),
            joints: Vec::new(),
            ends,
            contacts: Vec::new(),
            steps: 0,
            work: 0,
            residual: 0.0,
            shrinking: None,
        };
        match bar {
            Some(bar) if pushes.is_some() => {
                this.chain_contacts(problem, answer, &curve, bar, pushes.unwrap_or_default(), &mut events);
            }
            None => this.find_contacts(problem, time_s, dragged, answer, &curve, &mut events),
            Some(bar) => this.read_contacts(problem, answer, &curve, bar, &mut events),
        }
        events.sort_by(|a, b| a.from.total_cmp(&b.from));
        if bar.is_none() {
            this.begin_softly(&events);
        }
        this.lay(&curve, &mut events)?;
        match bar {
            None => this.bend_layers()?,
            Some(_) => this.bend_as(&curve)?,
        }
        Some(this)
    }

    /// The contacts that the answer of a mesh reports.
    fn read_contacts(
        &mut self,
        problem: &Problem,
        answer: &CableSolution,
        curve: &Curve<'_>,
        bar: f64,
        events: &mut Vec<Event>,
    ) {
        for report in &answer.contacts {
            let [from, to] = report.extent_m();
            let s = report.arc_length_m;
            let angle = curve.angle(s, [s - bar, s + bar]);
            let x = Vec2::new(report.x_m, report.y_m);
            // The middle of a wrap lies off its round.
            let gap =
                problem.world.signed_gap(x, bar).filter(|g| problem.world.obstacle_name(g.obstacle) == report.obstacle);
            let t = Vec2::new(angle.cos(), angle.sin());
            let Some(mut contact) = gap.and_then(|g| contact_at(problem, &g, x, t)) else { continue };
            self.mobilise(problem, answer, &mut contact, s);
            let k = self.contacts.len();
            self.contacts.push(contact);
            let long = to - from > 3.0 * bar;
            // A stretch that lies to the end of the cable lies there whole.
            let to = if long && self.length - to < bar { self.length } else { to };
            let from = if long && from < bar { 0.0 } else { from };
            let [from, to] = if long { [from, to] } else { [s, s] };
            events.push(Event { from, to, joint: if long { Joint::Begin(k) } else { Joint::ContactPair(k) } });
        }
    }

    /// Gives all nodes the bends and forces of the answer of a mesh.
    fn bend_as(&mut self, curve: &Curve<'_>) -> Option<()> {
        use crate::model::fem::free::beam::equilibrium::nearest_turn;
        for (which, u) in
            [(0, self.pieces.first()?.nodes.first()?[ANGLE]), (1, self.pieces.last()?.nodes.last()?[ANGLE])]
        {
            if let End::Held(_, Some(angle)) = &mut self.ends[which] {
                *angle = nearest_turn(*angle, u);
            }
        }
        for k in 0..self.joints.len() {
            let u = *self.pieces[k].nodes.last()?;
            if let Joint::Held(_, _, _, Some(angle)) = &mut self.joints[k] {
                *angle = nearest_turn(*angle, u[ANGLE]);
            }
        }
        for piece in self.pieces.iter_mut().filter(|p| p.contact.is_none()) {
            for u in &mut piece.nodes {
                let k = curve.chord(u[ARC]);
                let (a, b) = (&curve.nodes[k], &curve.nodes[k + 1]);
                let d = b.arc_length_m - a.arc_length_m;
                let f = if d > 0.0 { ((u[ARC] - a.arc_length_m) / d).clamp(0.0, 1.0) } else { 0.5 };
                let bend = a.curvature_per_m + (b.curvature_per_m - a.curvature_per_m) * f;
                u[MOMENT] = self.bending * bend / self.thermal_stretch;
            }
            // Shear, from how the moment changes.
            for i in 0..piece.nodes.len() {
                let (a, b) = (piece.nodes[i.saturating_sub(1)], piece.nodes[(i + 1).min(piece.nodes.len() - 1)]);
                let d = b[ARC] - a[ARC];
                let shear = if d > 0.0 { -(b[MOMENT] - a[MOMENT]) / d } else { 0.0 };
                let u = &mut piece.nodes[i];
                let f = force(u) + perp(tangent(u)) * shear;
                (u[4], u[5]) = (f.x, f.y);
            }
        }
        Some(())
    }

    /// The stretches of the answer's nodes that lie on something, as contacts and events.
    fn find_contacts(
        &mut self,
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        answer: &CableSolution,
        curve: &Curve<'_>,
        events: &mut Vec<Event>,
    ) {
        let within = CONTACT_DISTANCE_FRACTION * problem.radius + 1e-9 * problem.length;
        let nodes = &answer.nodes;
        let along = |i: usize| {
            let side = |k: usize| curve.angles.get(k).map_or(Vec2::zeros(), |a| Vec2::new(a.cos(), a.sin()));
            side(i) + if i > 0 { side(i - 1) } else { Vec2::zeros() }
        };
        let mut open: Option<(Contact, f64, f64)> = None;
        let mut found = Vec::new();
        for (i, n) in nodes.iter().enumerate() {
            let gap = problem.world.signed_gap(n.at(), within).filter(|g| g.gap_m <= within);
            let on = gap
                .and_then(|g| contact_at(problem, &g, n.at(), along(i)))
                .or_else(|| self.pulley_at(problem, time_s, dragged, n.at(), along(i), within));
            match (&mut open, on) {
                (Some((c, _, to)), Some(new))
                    if c.owner == new.owner
                        && c.radius == new.radius
                        && (c.radius.is_some() && c.at == new.at
                            || c.radius.is_none() && (c.normal - new.normal).norm() < 1e-9) =>
                {
                    *to = n.arc_length_m;
                }
                (_, new) => {
                    found.extend(open.take());
                    open = new.map(|c| (c, n.arc_length_m, n.arc_length_m));
                }
            }
        }
        found.extend(open);
        for (mut contact, from, to) in found {
            let inner = to > 1e-9 * self.length && from < (1.0 - 1e-9) * self.length;
            if !inner {
                continue;
            }
            self.mobilise(problem, answer, &mut contact, 0.5 * (from + to));
            let k = self.contacts.len();
            self.contacts.push(contact);
            events.push(Event { from, to, joint: if to > from { Joint::Begin(k) } else { Joint::ContactPair(k) } });
        }
    }

    /// The pulley that a place is at, as a contact.
    fn pulley_at(
        &self,
        problem: &Problem,
        time_s: f64,
        dragged: &[Option<Vec2>],
        x: Vec2,
        t: Vec2,
        within: f64,
    ) -> Option<Contact> {
        let pulleys = problem.supports.iter().enumerate().filter(|(_, s)| s.kind == SupportKind::Pulley);
        for (k, s) in pulleys {
            let Some(center) = support_place(problem, k, time_s, dragged) else { continue };
            if ((x - center).norm() - s.wheel_radius).abs() > within {
                continue;
            }
            let d = x - center;
            let up = if s.side == PulleySide::Over { Vec2::y() } else { -Vec2::y() };
            let normal = if d.norm() > 0.5 * s.wheel_radius && s.wheel_radius > 0.0 { d / d.norm() } else { up };
            let sense = if normal.dot(&perp(t)) > 0.0 { -1.0 } else { 1.0 };
            return Some(Contact {
                owner: Owner::Pulley(k),
                at: center,
                radius: Some(s.wheel_radius),
                normal,
                sense,
                mobilised: 0.0,
                slips: false,
            });
        }
        None
    }

    /// Part of its friction that a contact mobilises, as when the cable was laid as a flexible one;
    /// all of it where it slipped.
    fn mobilise(&self, problem: &Problem, answer: &CableSolution, contact: &mut Contact, s: f64) {
        match contact.owner {
            Owner::Obstacle(obstacle) => {
                (contact.mobilised, contact.slips) = mobilised(problem, answer, obstacle, s);
            }
            Owner::Pulley(k) => {
                let (Some(support), Some(r)) = (problem.supports.get(k), answer.supports.get(k)) else { return };
                let (Some(a), Some(b)) = (r.tension_before_n, r.tension_after_n) else { return };
                if support.friction > 0.0 && a > 0.0 && b > 0.0 {
                    // Rubbing wheels hold or slip as a whole: to which the greater part of e^{μφ}
                    // is nearer is not told.
                    let turn =
                        (Vec2::new(r.reaction_x_n, r.reaction_y_n).norm() / (a + b)).clamp(0.0, 1.0).asin() * 2.0;
                    let part = if turn > 0.0 { (a / b).ln() / turn } else { 0.0 };
                    contact.mobilised = part.clamp(-support.friction, support.friction);
                    contact.slips = part.abs() >= 0.999 * support.friction;
                }
            }
        }
    }

    /// The stiffness that the way up begins with.
    fn begin_softly(&mut self, events: &[Event]) {
        let (mut last, mut shortest) = (0.0, self.length);
        for e in events {
            let free = e.from - last;
            if free > 1e-6 * self.length && free < shortest {
                shortest = free;
            }
            last = e.to;
        }
        let layer = FIRST_LAYER * shortest;
        let soft = self.scale * layer * layer;
        if soft < self.bending {
            self.bending = soft;
        }
    }

    /// λ beside a place with a tension, m; where that goes to zero the weight takes over.
    fn layer(&self, pull: f64) -> f64 {
        let w = self.body.norm();
        let least = (self.bending / (self.length * self.length)).max((self.bending * w * w).cbrt());
        (self.bending / pull.max(least)).sqrt()
    }

    /// Makes the pieces and joints, and lays their nodes along the curve of the flexible cable with
    /// layers at their ends.
    fn lay(&mut self, curve: &Curve<'_>, events: &mut Vec<Event>) -> Option<()> {
        let length = self.length;
        // Contacts too short for the stiffness are points.
        for e in events.iter_mut() {
            if let Joint::Begin(k) = e.joint {
                let c = self.contacts[k];
                let turn = (curve.angle(e.from, [0.0, e.from]) - curve.angle(e.to, [e.to, length])).abs();
                let pull = curve.at(0.5 * (e.from + e.to)).1;
                let point = match c.radius {
                    Some(r) => 1.0 - (0.5 * turn).min(std::f64::consts::PI).cos() < self.bending / (2.0 * pull * r * r),
                    None => {
                        e.to - e.from < 4.0 * self.layer(pull) && e.to < (1.0 - 1e-9) * length && e.from > 1e-9 * length
                    }
                };
                if point {
                    let middle = 0.5 * (e.from + e.to);
                    *e = Event { from: middle, to: middle, joint: Joint::ContactPair(k) };
                }
            }
        }
        // Between two rounds the layers lift a cable off a line by λ/2 times their turn, its weight
        // sags by wl²/8T.
        let lifted = |i: usize| {
            let Joint::Begin(k) = events[i].joint else { return false };
            let beside = |j: Option<usize>| {
                let e = events.get(j?)?;
                let (Joint::Begin(k) | Joint::ContactPair(k)) = e.joint else { return None };
                self.contacts[k].radius?;
                Some((curve.angle(e.from, [0.0, e.from]) - curve.angle(e.to, [e.to, length])).abs())
            };
            let (Some(a), Some(b)) = (beside(i.checked_sub(1)), beside(Some(i + 1))) else { return false };
            let (l, pull) = (events[i].to - events[i].from, curve.at(0.5 * (events[i].from + events[i].to)).1);
            self.contacts[k].radius.is_none()
                && self.body.norm() * l * l / (8.0 * pull) < 0.25 * self.layer(pull) * (a + b)
        };
        let kept: Vec<bool> = (0..events.len()).map(|i| !lifted(i)).collect();
        let mut keep = kept.iter();
        events.retain(|_| keep.next().copied().unwrap_or(true));
        // Some cable between any two.
        for i in 1..events.len() {
            let need = 0.5 * self.layer(curve.at(events[i].from).1);
            let lack = need - (events[i].from - events[i - 1].to);
            if lack > 0.0 {
                let spare = |e: &Event| (SURRENDERED_ARC_FRACTION * (e.to - e.from)).min(0.5 * lack);
                let (a, b) = (spare(&events[i - 1]), spare(&events[i]));
                events[i - 1].to -= a;
                events[i].from += b;
            }
            if !(events[i].from - events[i - 1].to > 1e-9 * length) {
                return None;
            }
        }
        let mut free_from = 0.0;
        for (i, e) in events.iter().enumerate() {
            let begins = i == 0 && e.from <= 1e-9 * length && matches!(e.joint, Joint::Begin(_));
            let ends = i + 1 == events.len() && e.to >= (1.0 - 1e-9) * length && matches!(e.joint, Joint::Begin(_));
            if !begins {
                self.pieces.push(self.piece(curve, None, [free_from, e.from]));
                self.joints.push(e.joint);
            }
            if let Joint::Begin(k) = e.joint {
                self.pieces.push(self.piece(curve, Some(k), [e.from, e.to]));
                if ends {
                    return Some(());
                }
                self.joints.push(Joint::End(k));
            }
            free_from = e.to;
        }
        if !(length - free_from > 1e-9 * length) {
            return None;
        }
        self.pieces.push(self.piece(curve, None, [free_from, length]));
        Some(())
    }

    fn piece(&self, curve: &Curve<'_>, contact: Option<usize>, [from, to]: [f64; 2]) -> Piece {
        let l = to - from;
        let count = if contact.is_some() { LYING_ELEMENTS } else { FREE_ELEMENTS };
        let layers = [from, to].map(|s| self.layer(curve.at(s).1));
        let grid: Vec<f64> = if contact.is_some() {
            (0..=count).map(|i| i as f64 / count as f64).collect()
        } else {
            places(layers, l, count).iter().map(|s| s / l).collect()
        };
        let node = |x: &f64| {
            let s = from + x * l;
            let (at, pull) = curve.at(s);
            let angle = curve.angle(s, [from, to]);
            let f = Vec2::new(angle.cos(), angle.sin()) * pull;
            let moment = contact.and_then(|k| self.contacts.get(k)).map_or(0.0, |c| self.bending * c.curvature());
            [at.x, at.y, angle, moment, f.x, f.y, s, l]
        };
        Piece { contact, nodes: grid.iter().map(node).collect(), grid }
    }

    /// Adds the layers at the ends of free pieces, θ ∓ Δ e^{−s/λ}, and counts the angles of clamps
    /// on from their neighbours.
    fn bend_layers(&mut self) -> Option<()> {
        use crate::model::fem::free::beam::equilibrium::nearest_turn;
        let count = self.pieces.len();
        let end = |p: &Piece, which: usize| if which == 0 { p.nodes.first() } else { p.nodes.last() }.copied();
        let mut turns = vec![[0.0; 2]; count];
        let mut bends = vec![[0.0; 2]; count];
        for which in 0..2 {
            let k = if which == 0 { 0 } else { count - 1 };
            let u = end(&self.pieces[k], which)?;
            if let End::Held(_, Some(angle)) = &mut self.ends[which] {
                *angle = nearest_turn(*angle, u[ANGLE]);
                turns[k][which] = *angle - u[ANGLE];
            }
        }
        for k in 0..self.joints.len() {
            let (a, b) = (end(&self.pieces[k], 1)?, end(&self.pieces[k + 1], 0)?);
            match &mut self.joints[k] {
                Joint::Begin(c) => bends[k][1] = self.contacts[*c].curvature(),
                Joint::End(c) => bends[k + 1][0] = self.contacts[*c].curvature(),
                Joint::Held(_, _, _, Some(angle)) => {
                    *angle = nearest_turn(*angle, a[ANGLE]);
                    turns[k][1] = *angle - a[ANGLE];
                    turns[k + 1][0] = *angle - b[ANGLE];
                }
                Joint::ContactPair(c) if self.contacts[*c].is_point() => {
                    // The side on which a point is passed is that to which the cable turns.
                    let turn = cross(tangent(&a), tangent(&b));
                    self.contacts[*c].sense = if turn < 0.0 { -1.0 } else { 1.0 };
                    let middle = 0.5 * (a[ANGLE] + b[ANGLE]);
                    (turns[k][1], turns[k + 1][0]) = (middle - a[ANGLE], middle - b[ANGLE]);
                }
                _ => {
                    let middle = 0.5 * (a[ANGLE] + b[ANGLE]);
                    (turns[k][1], turns[k + 1][0]) = (middle - a[ANGLE], middle - b[ANGLE]);
                }
            }
        }
        for k in 0..count {
            if self.pieces[k].contact.is_some() {
                continue;
            }
            let (first, last) = (end(&self.pieces[k], 0)?, end(&self.pieces[k], 1)?);
            let layers = [first, last].map(|u| self.layer(force(&u).norm()));
            let ei = self.bending;
            for u in &mut self.pieces[k].nodes {
                let fade = [(u[ARC] - first[ARC]) / layers[0], (last[ARC] - u[ARC]) / layers[1]].map(|x| (-x).exp());
                u[ANGLE] += turns[k][0] * fade[0] + turns[k][1] * fade[1];
                u[MOMENT] += ei * (-turns[k][0] / layers[0] + bends[k][0]) * fade[0];
                u[MOMENT] += ei * (turns[k][1] / layers[1] + bends[k][1]) * fade[1];
            }
        }
        Some(())
    }

    /// Up to the whole stiffness; false where that is not reached.
    pub fn stiffen(&mut self, problem: &Problem) -> bool {
        let whole = problem.bending_stiffness;
        if !self.settle(problem) {
            return false;
        }
        let mut factor = FIRST_RISE;
        for _ in 0..MAX_RISES {
            if self.bending >= whole {
                return true;
            }
            if self.work > MOST_WORK {
                return false;
            }
            let saved = self.clone();
            let next = self.bending * factor;
            self.bending = if next > 0.999 * whole { whole } else { next };
            // Bending moments of lies grow with the stiffness, those of layers with its root: the
            // first is exact.
            self.regrid();
            if self.settle(problem) {
                factor = (factor * 1.5).min(10.0);
            } else {
                let (steps, work) = (self.steps, self.work);
                *self = saved;
                (self.steps, self.work) = (steps, work);
                factor = factor.sqrt();
                if factor < 1.001 {
                    return false;
                }
            }
        }
        false
    }

    /// Every node at a place of a piece, on Hermite's quintic between its nodes: as exact there as
    /// the nodes are (the cubic is off by 3e-7 m where a cable is bent to 1 m within 10 elements).
    pub(super) fn read(&self, piece: &Piece, x: f64) -> [f64; STATES] {
        let e = piece.grid.partition_point(|g| *g <= x).clamp(1, piece.grid.len() - 1) - 1;
        let (a, b) = (&piece.nodes[e], &piece.nodes[e + 1]);
        let h = piece.grid[e + 1] - piece.grid[e];
        let z = ((x - piece.grid[e]) / h).clamp(0.0, 1.0);
        let [(fa, ga), (fb, gb)] = [a, b].map(|u| {
            let f = self.slope(piece.contact, u);
            (f, self.second_slope(piece.contact, u, &f, h))
        });
        let (z2, z3) = (z * z, z * z * z);
        let (z4, z5) = (z2 * z2, z2 * z3);
        std::array::from_fn(|i| {
            a[i] * (1.0 - 10.0 * z3 + 15.0 * z4 - 6.0 * z5)
                + b[i] * (10.0 * z3 - 15.0 * z4 + 6.0 * z5)
                + h * (fa[i] * (z - 6.0 * z3 + 8.0 * z4 - 3.0 * z5) + fb[i] * (-4.0 * z3 + 7.0 * z4 - 3.0 * z5))
                + 0.5 * h * h * (ga[i] * (z2 - 3.0 * z3 + 3.0 * z4 - z5) + gb[i] * (z3 - 2.0 * z4 + z5))
        })
    }

    /// Change of the slope `f` of a state along a piece, by central differences over a part of an
    /// element of length `h`.
    fn second_slope(&self, contact: Option<usize>, u: &[f64; STATES], f: &[f64; STATES], h: f64) -> [f64; STATES] {
        let step = DIFFERENCE * h;
        let [back, on] = [-step, step].map(|by| self.slope(contact, &std::array::from_fn(|i| u[i] + by * f[i])));
        std::array::from_fn(|i| (on[i] - back[i]) / (2.0 * step))
    }

    /// New nodes where the present layers ask for them, on the present curve.
    pub(super) fn regrid(&mut self) {
        let make = |piece: &Piece| {
            let (Some(first), Some(last)) = (piece.nodes.first(), piece.nodes.last()) else { return piece.clone() };
            let l = first[LENGTH];
            if piece.contact.is_some() {
                return piece.clone();
            }
            let layers = [first, last].map(|u| self.layer(force(u).norm()));
            let count = piece.grid.len() - 1;
            let mut grid: Vec<f64> = places(layers, l, count).iter().map(|s| s / l).collect();
            grid[count] = 1.0;
            let mut nodes: Vec<[f64; STATES]> = grid.iter().map(|&x| self.read(piece, x)).collect();
            for u in &mut nodes {
                u[LENGTH] = l;
            }
            Piece { contact: None, grid, nodes }
        };
        self.pieces = self.pieces.iter().map(make).collect();
    }

    /// The same with every element halved.
    #[must_use]
    pub fn halved(&self) -> Self {
        let halve = |piece: &Piece| {
            let mut grid = Vec::with_capacity(2 * piece.grid.len());
            for g in piece.grid.windows(2) {
                grid.extend([g[0], 0.5 * (g[0] + g[1])]);
            }
            grid.extend(piece.grid.last());
            let mut nodes: Vec<[f64; STATES]> = grid.iter().map(|&x| self.read(piece, x)).collect();
            for (k, u) in piece.nodes.iter().enumerate() {
                nodes[2 * k] = *u;
            }
            Piece { contact: piece.contact, grid, nodes }
        };
        Self { pieces: self.pieces.iter().map(halve).collect(), ..self.clone() }
    }
}
