//! One function a law, over one cable.
//!
//! With F(s) the internal force, b the load per metre and d the force of obstacles on a piece of cable from s₁ to s₂,
//! F(s₂) − F(s₁) + b (s₂ − s₁) + Σ P + d = 0, with P the point forces on it. So d follows from what the answer says of the cable alone,
//! and must be nothing in the air, and within the cone about the normals of what touches the piece elsewhere. Beyond its ends
//! the cable has no internal force.

use super::supports::{self, Hold, Role};
use super::surroundings::{Neighbours, Surroundings};
use super::tolerance::{
    ASIDE, BALANCE, COMPRESSION, CONE, DEPTH_DIAMETERS, DEPTH_M, FOLD, LEAST_STRAIN, LENGTH, LUMPED, MATERIAL, MOMENT,
    REACH_DIAMETERS, REACH_M, REPORTED, SAME_NORMAL, TURN,
};
use super::{Balance, Depth, Finding, Law, Verification};
use crate::math::{Vec2, cross, larger, vec2};
use crate::scene::{Cable, Scene, View};
use crate::solution::{CableSolution, ContactReport, Node, SupportReaction};

/// One cable with what there is to know of it.
pub(super) struct Subject<'a> {
    surroundings: &'a Surroundings,
    scene: &'a Scene,
    pub cable: &'a Cable,
    pub answer: &'a CableSolution,
    /// Time, s.
    time_s: f64,
    /// What its supports do to it.
    pub holds: Vec<Hold<'a>>,
    /// Weight and wind, N/m.
    body: Vec2,
    /// 1 + αΔT.
    pub thermal: f64,
    /// Greatest of the forces, N: what a residual is compared with.
    scale: f64,
}

/// A force on a point of the cable, N.
struct PointForce {
    arc_length: f64,
    force: Vec2,
}

/// How far the way of a piece is from what it should be, how far it may, and its material beyond its way, m.
#[derive(Clone, Copy, Debug)]
struct Lengths {
    value: f64,
    limit: f64,
    folded: f64,
}

/// A piece of the cable between nodes, its ends counted in.
#[derive(Clone, Debug, Default)]
struct Piece {
    /// First and last node.
    nodes: [usize; 2],
    /// What obstacles must do to it, N.
    contact: Vec2,
}

pub(super) fn check(found: &mut Verification, mut subject: Subject<'_>, depth: Depth) {
    let (cable, answer) = (subject.cable, subject.answer);
    found.ask(Law::Finite);
    if let Some(finding) = subject.not_finite() {
        found.report(finding);
        return;
    }
    subject.scale = subject.forces_scale();
    if !subject.material(found) {
        return;
    }
    let near = subject.near();
    subject.penetration(found, &near);
    subject.reported_contacts(found);
    if answer.assumptions.inertia || !answer.breaks.is_empty() {
        let why = if answer.breaks.is_empty() { "it moves" } else { "it is broken" };
        found.not_checked.push(format!("balance and length of `{}`: {why}", cable.name));
    } else {
        subject.supports(found);
        subject.balance(found, &near);
        subject.length(found, &near);
        if answer.assumptions.bending_stiffness_n_m2 > 0.0 {
            subject.moments(found);
            subject.stability(found, &near);
        } else {
            subject.tension(found);
            subject.pulleys(found);
            subject.compression(found);
        }
    }
    if cable.self_contact && depth == Depth::Full {
        subject.self_contact(found);
    } else if cable.self_contact {
        found.not_checked.push(format!("contact of `{}` with itself", cable.name));
    }
}

impl<'a> Subject<'a> {
    /// The answer for a cable of a scene at a time, s.
    pub fn new(
        surroundings: &'a Surroundings,
        scene: &'a Scene,
        cable: &'a Cable,
        answer: &'a CableSolution,
        time_s: f64,
    ) -> Self {
        let env = &scene.environment;
        let weight = match scene.view {
            View::Elevation => Vec2::new(0.0, -cable.linear_density_kg_per_m * env.gravity_m_per_s2),
            View::Plan => Vec2::zeros(),
        };
        let wind = series(Some(env.wind_n_per_m), &env.wind_times_s, &env.winds_n_per_m, time_s);
        let thermal = 1.0 + cable.thermal_expansion_per_k * env.temperature_change_k;
        let holds = supports::holds(cable, answer, time_s);
        Self { surroundings, scene, cable, answer, time_s, holds, body: weight + wind, thermal, scale: 0.0 }
    }
}

impl Subject<'_> {
    /// Greatest of the forces, N.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Weight and wind, N/m.
    pub fn load_per_metre(&self) -> Vec2 {
        self.body
    }

    /// Where the scene's loads are on the cable, m.
    pub fn scene_loads(&self) -> Vec<f64> {
        self.scene.loads.iter().filter(|l| l.cable == self.cable.name).map(|l| l.arc_length_m).collect()
    }

    pub fn finding(&self, law: Law, node: usize, (value, limit): (f64, f64)) -> Finding {
        let n = self.answer.nodes.get(node).or(self.answer.nodes.last()).copied().unwrap_or_default();
        Finding {
            law,
            cable: self.cable.name.clone(),
            arc_length_m: n.arc_length_m,
            at_m: [n.x_m, n.y_m],
            with: String::new(),
            value,
            limit,
        }
    }

    fn not_finite(&self) -> Option<Finding> {
        let all = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let node = |n: &Node| {
            all(&[n.arc_length_m, n.x_m, n.y_m, n.vx_m_per_s, n.vy_m_per_s, n.tension_n])
                && all(&[n.strain, n.stress_pa, n.curvature_per_m, n.force_n[0], n.force_n[1]])
        };
        let support = |s: &SupportReaction| {
            all(&[s.x_m, s.y_m, s.reaction_x_n, s.reaction_y_n, s.arc_length_m])
                && all(&[s.tension_before_n.unwrap_or(0.0), s.tension_after_n.unwrap_or(0.0)])
        };
        let contact = |c: &ContactReport| {
            all(&[c.x_m, c.y_m, c.arc_length_m, c.normal_n, c.friction_n, c.turn_deg, c.force_n[0], c.force_n[1]])
                && all(&[c.tension_before_n, c.tension_after_n, c.begins_m, c.ends_m])
        };
        let bad = |k: usize, with: &str| {
            let mut finding = self.finding(Law::Finite, k, (f64::INFINITY, 0.0));
            with.clone_into(&mut finding.with);
            finding
        };
        let a = self.answer;
        if a.nodes.len() < 2 {
            return Some(bad(0, "nodes"));
        }
        if let Some(k) = a.nodes.iter().position(|n| !node(n)) {
            return Some(bad(k, ""));
        }
        if let Some(s) = a.supports.iter().find(|s| !support(s)) {
            return Some(bad(0, &s.name));
        }
        a.contacts.iter().find(|c| !contact(c)).map(|c| bad(0, &c.obstacle))
    }

    /// The greatest force on or in the cable, N; of one without any the least that anybody would read.
    fn forces_scale(&self) -> f64 {
        let tension = self.answer.nodes.iter().map(|n| n.force().norm()).fold(0.0, larger);
        let loads = self.point_forces().iter().map(|p| p.force.norm()).fold(0.0, larger);
        let load = self.body.norm() * self.cable.length_m;
        larger(larger(tension, loads), larger(load, LEAST_STRAIN * self.cable.axial_stiffness_n))
    }

    /// Supports and loads. Wheels are among the obstacles.
    fn point_forces(&self) -> Vec<PointForce> {
        let mut out = Vec::new();
        for hold in &self.holds {
            let force = match hold.role {
                Role::Load => hold.dead_load(self.scene, self.time_s),
                Role::Held | Role::Pulley => hold.force(),
                Role::Wheel { .. } | Role::Released => continue,
            };
            out.push(PointForce { arc_length: hold.arc_length, force });
        }
        for l in self.scene.loads.iter().filter(|l| l.cable == self.cable.name) {
            let force = series(l.force_n, &l.times_s, &l.forces_n, self.time_s);
            out.push(PointForce { arc_length: l.arc_length_m, force });
        }
        out
    }

    /// Forces of what is no obstacle of the scene (the robot, the cable itself), as they are reported.
    fn foreign(&self) -> impl Iterator<Item = PointForce> {
        let foreign = self.answer.contacts.iter().filter(|c| self.surroundings.find(&c.obstacle).is_none());
        foreign.flat_map(|c| &c.samples).map(|s| PointForce { arc_length: s.arc_length_m, force: vec2(s.force_n) })
    }

    /// Wheels that lead the cable now: centre, radius of the centre line and friction.
    pub fn wheels(&self) -> impl Iterator<Item = (Vec2, f64, f64)> {
        self.holds.iter().filter_map(|hold| match hold.role {
            Role::Wheel { radius } => Some((hold.at, radius, hold.support.friction.unwrap_or(0.0))),
            _ => None,
        })
    }

    /// Whether the nodes run along the material: without that nothing else can be asked.
    fn material(&self, found: &mut Verification) -> bool {
        found.ask(Law::Material);
        let before = found.findings.len();
        let nodes = &self.answer.nodes;
        let limit = MATERIAL * self.cable.length_m;
        let first = nodes.first().map_or(f64::NAN, |n| n.arc_length_m.abs());
        let last = nodes.last().map_or(f64::NAN, |n| (n.arc_length_m - self.cable.length_m).abs());
        for (node, value) in [(0, first), (nodes.len() - 1, last)] {
            if !(value <= limit) {
                found.report(self.finding(Law::Material, node, (value, limit)));
            }
        }
        for (k, pair) in nodes.windows(2).enumerate() {
            let back = pair[0].arc_length_m - pair[1].arc_length_m;
            if !(back <= limit) {
                found.report(self.finding(Law::Material, k + 1, (back, limit)));
            }
        }
        found.findings.len() == before
    }

    /// Distance of the centre line from a surface at which they may push, m.
    pub fn reach(&self) -> f64 {
        0.5 * self.cable.diameter_m + larger(REACH_M, REACH_DIAMETERS * self.cable.diameter_m)
    }

    /// What is near the line from each node to the next.
    fn near(&self) -> Neighbours {
        let reach = self.reach();
        let bars = self.answer.nodes.windows(2).map(|pair| [pair[0].at(), pair[1].at()]);
        Neighbours::new(self.surroundings, bars, reach)
    }

    fn penetration(&self, found: &mut Verification, near: &Neighbours) {
        found.ask(Law::Penetration);
        let radius = 0.5 * self.cable.diameter_m;
        let allowed = (DEPTH_DIAMETERS * self.cable.diameter_m).min(DEPTH_M);
        let nodes = &self.answer.nodes;
        // Where the scene itself holds the axis on a surface, the cable is as deep there as it is thick.
        let held = self.held_at();
        let on_surface = MATERIAL * self.cable.length_m;
        for (k, n) in nodes.iter().enumerate() {
            // From a bar that nothing is near it is as far inside as the node before.
            if k > 0 && near.of(k - 1).is_empty() {
                continue;
            }
            if let Some((body, depth)) = self.surroundings.inside(n.at()) {
                if depth <= on_surface && held.contains(&n.at()) {
                    continue;
                }
                let mut finding = self.finding(Law::Penetration, k, (depth + radius, allowed));
                self.surroundings.name(body).clone_into(&mut finding.with);
                found.report(finding);
            }
        }
        // Between the pieces of a broken cable there is none.
        let is_cable = |k: usize| !near.of(k).is_empty() && !self.answer.breaks.contains(&(k + 1));
        for (k, pair) in nodes.windows(2).enumerate().filter(|(k, _)| is_cable(*k)) {
            // Between two nodes the cable is drawn straight where it is round.
            let way = (pair[1].at() - pair[0].at()).norm();
            let sagitta = pair.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, larger) * way * way / 8.0;
            for n in near.of(k) {
                let value = radius - n.distance;
                let end = n.at == pair[0].at() || n.at == pair[1].at();
                let given = if held.contains(&n.at) { radius } else { 0.0 };
                let limit = allowed + given + if end { 0.0 } else { sagitta };
                if !(value <= limit) {
                    let mut finding = self.finding(Law::Penetration, k, (value, limit));
                    self.surroundings.name(n.body).clone_into(&mut finding.with);
                    finding.at_m = n.at.into();
                    found.report(finding);
                }
            }
        }
    }

    /// Where supports hold the cable by its axis, m.
    fn held_at(&self) -> Vec<Vec2> {
        self.holds.iter().filter(|h| h.role == Role::Held).map(|h| h.at).collect()
    }

    /// Contacts as they are reported: they push, within their cone.
    fn reported_contacts(&self, found: &mut Verification) {
        found.ask(Law::Push);
        found.ask(Law::Friction);
        let noise = BALANCE * self.scale;
        for c in &self.answer.contacts {
            let friction = match self.surroundings.find(&c.obstacle) {
                Some(body) => self.surroundings.friction(body, self.cable.friction),
                None => self.cable.friction,
            };
            let node = self.answer.nodes.partition_point(|n| n.arc_length_m < c.arc_length_m);
            let mut tell = |law: Law, value: f64, limit: f64| {
                if !(value <= limit) {
                    let mut finding = self.finding(law, node, (value, limit));
                    finding.with.clone_from(&c.obstacle);
                    found.report(finding);
                }
            };
            tell(Law::Push, -c.normal_n, noise);
            tell(Law::Friction, c.friction_n.abs() - friction * c.normal_n, CONE * c.normal_n.abs() + noise);
        }
    }

    /// The pieces from node to node. What acts at a node belongs to the piece that ends there, as internal forces are those just
    /// beyond nodes.
    fn pieces(&self, points: &[PointForce]) -> Vec<Piece> {
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        let same = MATERIAL * self.cable.length_m;
        let foreign: Vec<PointForce> = self.foreign().collect();
        let mut known = vec![Vec2::zeros(); nodes.len()];
        for p in points.iter().chain(&foreign) {
            // The last of the nodes at that material, and never before the first piece.
            let k = nodes.partition_point(|n| n.arc_length_m <= p.arc_length + same).clamp(2, nodes.len()) - 1;
            known[k] += p.force;
        }
        // Forces of bodies that the scene does not hold still are known to a node's neighbourhood only.
        let cut = |k: usize| {
            let [before, after] = [k - 1, (k + 1).min(last)].map(|k| nodes[k].arc_length_m);
            // Nodes of one material point are one: where the cable turns round a point, it is not said what it does there.
            nodes[k + 1].arc_length_m - nodes[k].arc_length_m > same
                && foreign.iter().all(|p| !(p.arc_length >= before - same && p.arc_length <= after + same))
        };
        let mut out = Vec::with_capacity(nodes.len());
        let (mut from, mut acts) = (0, Vec2::zeros());
        for to in 1..=last {
            acts += known[to];
            if to < last && !cut(to) {
                continue;
            }
            let [a, b] = [from, to].map(|k| &nodes[k]);
            // Beyond the ends of the cable there is nothing.
            let before = if from == 0 { Vec2::zeros() } else { a.force() };
            let after = if to == last { Vec2::zeros() } else { b.force() };
            let own = self.body * (b.arc_length_m - a.arc_length_m);
            out.push(Piece { nodes: [from, to], contact: -(after - before) - own - acts });
            (from, acts) = (to, Vec2::zeros());
        }
        out
    }

    fn balance(&self, found: &mut Verification, near: &Neighbours) {
        found.ask(Law::Balance);
        let points = self.point_forces();
        let limit = BALANCE * self.scale;
        let mut sums = Balance { scale_n: larger(found.balance.scale_n, self.scale), ..found.balance };
        let (mut adrift, mut beyond, mut pressed, mut lumped) = (Vec2::zeros(), 0.0, 0.0, 0.0);
        let (mut contacts, mut wheels, mut worst) = (Vec2::zeros(), Vec2::zeros(), (0.0, 0));
        let mut rays = Vec::new();
        for piece in self.pieces(&points) {
            let turns = self.rays(near, &piece, &mut rays);
            let excess = if rays.is_empty() && !self.floor_rubs() {
                // In the air residuals add up: each may be small and the sum not.
                adrift += piece.contact;
                let size = larger(adrift.norm(), piece.contact.norm());
                sums.residual_n = larger(sums.residual_n, size);
                if !(size <= limit) {
                    found.report(self.finding(Law::Balance, piece.nodes[0], (size, limit)));
                }
                continue;
            } else {
                adrift = Vec2::zeros();
                self.floor_excess(&piece, outside_cone(piece.contact, &rays))
            };
            if self.on_wheel(&piece) {
                wheels += piece.contact
            } else {
                contacts += piece.contact
            }
            beyond += excess;
            pressed += piece.contact.norm();
            lumped += if turns { self.lumped_friction(&piece) } else { 0.0 };
            if excess > worst.0 || excess.is_nan() {
                worst = (excess, piece.nodes[0]);
            }
        }
        sums.residual_n = larger(sums.residual_n, beyond);
        let allowed = limit + CONE * pressed + lumped;
        if !(beyond <= allowed) {
            let mut finding = self.finding(Law::Friction, worst.1, (beyond, allowed));
            let here = near.of(worst.1).first();
            self.surroundings.name(here.map_or(usize::MAX, |n| n.body)).clone_into(&mut finding.with);
            found.report(finding);
        }
        self.sums(found, sums, (&points, contacts, wheels));
    }

    /// What is reported of contacts and wheels adds up to what the cable asks for.
    fn sums(
        &self,
        found: &mut Verification,
        mut sums: Balance,
        (points, contacts, wheels): (&[PointForce], Vec2, Vec2),
    ) {
        let limit = BALANCE * self.scale;
        let known_here = |c: &&ContactReport| self.surroundings.find(&c.obstacle).is_some();
        let reported: Vec2 = self.answer.contacts.iter().filter(known_here).map(|c| vec2(c.force_n)).sum::<Vec2>()
            + self.foreign().map(|p| p.force).sum::<Vec2>();
        let led: Vec2 = self.holds.iter().filter(|h| matches!(h.role, Role::Wheel { .. })).map(Hold::force).sum();
        let known: Vec2 = points.iter().map(|p| p.force).sum();
        let weight = self.body * self.cable.length_m;
        let whole = known + weight + led + reported;
        let off = if self.floor_rubs() { (wheels - led).norm() } else { whole.norm() };
        sums.residual_n = larger(sums.residual_n, off);
        let limit = if self.answer.contacts.is_empty() { limit } else { REPORTED * self.scale };
        if !(off <= limit) {
            let mut finding = self.finding(Law::Balance, 0, (off, limit));
            "the whole cable".clone_into(&mut finding.with);
            found.report(finding);
        }
        let add = |to: &mut [f64; 2], v: Vec2| *to = [to[0] + v.x, to[1] + v.y];
        let supports: Vec2 = self.support_forces();
        add(&mut sums.loads_n, known - supports + weight);
        add(&mut sums.supports_n, supports + led);
        add(&mut sums.contacts_n, contacts);
        found.balance = sums;
    }

    /// Forces of supports on the cable that are neither dead loads nor wheels, N.
    fn support_forces(&self) -> Vec2 {
        self.holds.iter().filter(|h| matches!(h.role, Role::Held | Role::Pulley)).map(Hold::force).sum()
    }

    /// Whether a floor rubs on the whole cable.
    fn floor_rubs(&self) -> bool {
        self.scene.view == View::Plan && self.cable.friction > 0.0
    }

    /// What is beyond the floor's friction, too, N.
    fn floor_excess(&self, piece: &Piece, excess: f64) -> f64 {
        if !self.floor_rubs() {
            return excess;
        }
        let weight = self.cable.linear_density_kg_per_m * self.scene.environment.gravity_m_per_s2;
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        // What rubs at a node is of half of both pieces beside it, and at an end of the cable of the half there too.
        let [a, b] = piece.nodes.map(|k| nodes[k].arc_length_m);
        let next = nodes[(piece.nodes[1] + 1).min(last)].arc_length_m;
        let half = if piece.nodes[0] == 0 { 0.5 * (b - a) } else { 0.0 };
        let share = larger(b - a, 0.5 * (next - a) + half);
        larger(excess - self.cable.friction * weight * share, 0.0)
    }

    fn on_wheel(&self, piece: &Piece) -> bool {
        self.wheels().any(|(center, radius, _)| piece.nodes.iter().any(|&k| self.is_led(k, center, radius)))
    }

    /// Friction that a bar's own weight may add or hide where the ground turns, N: the bar carries it to its ends, where it turns the
    /// cable by weight over tension, and so presses as no edge does.
    fn lumped_friction(&self, piece: &Piece) -> f64 {
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        let [from, to] = [piece.nodes[0].saturating_sub(1), (piece.nodes[1] + 1).min(last)];
        let weight = self.body.norm() * (nodes[to].arc_length_m - nodes[from].arc_length_m);
        let force = larger(nodes[piece.nodes[0]].force().norm(), nodes[piece.nodes[1]].force().norm());
        let turn = if weight < force { weight / force } else { 1.0 };
        LUMPED * self.greatest_friction() * weight * turn
    }

    /// The greatest friction coefficient that the cable may meet.
    fn greatest_friction(&self) -> f64 {
        self.scene.obstacles.iter().map(|o| o.friction.unwrap_or(self.cable.friction)).fold(0.0, larger)
    }

    /// Gathers unit vectors that bound the friction cones of all that touches a piece, its neighbours counted in: a force that is
    /// known at nodes only is known to a node's neighbourhood. Returns whether their normals differ, as at a corner.
    fn rays(&self, near: &Neighbours, piece: &Piece, out: &mut Vec<Vec2>) -> bool {
        out.clear();
        let (mut first, mut turns, mut before) = (None, false, (Vec2::zeros(), 0.0));
        let mut add = |normal: Vec2, friction: f64| {
            if normal == Vec2::zeros() || (normal, friction) == before {
                return;
            }
            before = (normal, friction);
            turns |= cross(*first.get_or_insert(normal), normal).abs() > SAME_NORMAL;
            let along = Vec2::new(normal.y, -normal.x) * friction;
            let shorten = 1.0 / (1.0 + friction * friction).sqrt();
            for ray in [(normal + along) * shorten, (normal - along) * shorten] {
                if out.iter().all(|r: &Vec2| (r - ray).norm_squared() > 1e-20) {
                    out.push(ray);
                }
            }
        };
        let [from, to] = piece.nodes;
        for n in near.around(from, to) {
            add(n.normal, self.surroundings.friction(n.body, self.cable.friction));
        }
        for (center, radius, friction) in self.wheels() {
            for k in (from..=to).filter(|&k| self.is_led(k, center, radius)) {
                add((self.answer.nodes[k].at() - center).try_normalize(0.0).unwrap_or_default(), friction);
            }
        }
        turns
    }

    /// The tension of a flexible cable is the size of the force in it: at a node one of those between just before and just beyond it.
    fn tension(&self, found: &mut Verification) {
        found.ask(Law::Tension);
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        for (k, n) in nodes.iter().enumerate() {
            // `fem` reads it off the middles of the bars beside a node, half of whose weight is in between.
            let beside = nodes[(k + 1).min(last)].arc_length_m - nodes[k.saturating_sub(1)].arc_length_m;
            let limit = REPORTED * self.scale + LUMPED * self.body.norm() * beside;
            let after = n.force();
            // Most nodes have it from the piece that begins there.
            if (n.tension_n - after.norm()).abs() <= limit {
                continue;
            }
            let before = k.checked_sub(1).map_or(after, |j| self.forces_at_end(j)[1]);
            let most = larger(before.norm(), after.norm());
            let least = super::surroundings::distance(before, after, Vec2::zeros(), Vec2::zeros());
            let value = larger(n.tension_n - most, least - n.tension_n);
            if !(value <= limit) {
                found.report(self.finding(Law::Tension, k, (value, limit)));
            }
        }
    }

    /// A flexible cable pulls along its way.
    fn compression(&self, found: &mut Verification) {
        found.ask(Law::Compression);
        let limit = COMPRESSION * self.scale;
        for k in 0..self.answer.nodes.len() - 1 {
            let [a, b] = [&self.answer.nodes[k], &self.answer.nodes[k + 1]];
            // Nodes of one material point have no way between them.
            if b.arc_length_m - a.arc_length_m <= MATERIAL * self.cable.length_m {
                continue;
            }
            let way = b.at() - a.at();
            let pulls = self.forces_at_end(k).map(|end| (a.force() + end).dot(&way));
            let most = larger(pulls[0], pulls[1]);
            let pushes = if most < 0.0 { -0.5 * most / way.norm() } else { 0.0 };
            let value = larger(pushes, larger(-a.tension_n, -b.tension_n));
            if !(value <= limit) {
                found.report(self.finding(Law::Compression, k, (value, limit)));
            }
        }
    }

    /// Internal force at the end of the piece from node k, N: as what touches it is spread along it, and as it is all at the end.
    pub fn forces_at_end(&self, k: usize) -> [Vec2; 2] {
        let [a, b] = [&self.answer.nodes[k], &self.answer.nodes[k + 1]];
        [b.force(), a.force() - self.body * (b.arc_length_m - a.arc_length_m)]
    }

    /// The way from each node to the next is what its material and force make of it.
    fn length(&self, found: &mut Verification, near: &Neighbours) {
        found.ask(Law::Length);
        let stiff = self.answer.assumptions.bending_stiffness_n_m2 > 0.0;
        for k in 0..self.answer.nodes.len() - 1 {
            let off = |l: &Lengths| l.value / l.limit;
            let best = if stiff {
                self.stiff_length(k)
            } else {
                let touches = self.touches(near, k);
                let [spread, at_end] = self.forces_at_end(k);
                let spread = self.flexible_length(k, spread, touches);
                if spread.value <= spread.limit && spread.folded == 0.0 {
                    continue;
                }
                let at_end = self.flexible_length(k, at_end, touches);
                if off(&at_end) < off(&spread) { at_end } else { spread }
            };
            found.folded_m += best.folded;
            if !(best.value <= best.limit) {
                found.report(self.finding(Law::Length, k, (best.value, best.limit)));
            }
        }
    }

    /// The piece from node k of a flexible cable, whose internal force is `end` (N) at its end.
    fn flexible_length(&self, k: usize, end: Vec2, touches: bool) -> Lengths {
        let [a, b] = [&self.answer.nodes[k], &self.answer.nodes[k + 1]];
        let (compliance, start) = (1.0 / self.cable.axial_stiffness_n, a.force());
        let material = self.thermal * (b.arc_length_m - a.arc_length_m);
        let slack = LENGTH * material + MATERIAL * self.cable.length_m;
        let way = b.at() - a.at();
        let aside = if touches { ASIDE * self.cable.diameter_m } else { 0.0 };
        let [p, q] = [start.norm(), end.norm()];
        let least = if p < q { p } else { q };
        let turn = (end - start).norm() / least;
        // A force no greater than what is let pass unbalanced has no direction, and may be none.
        if turn < FOLD && least > BALANCE * self.scale {
            // Simpson's rule for ∫ F/|F| (1 + |F|/EA) ds with F linear in s.
            let rate = |f: Vec2| f * (1.0 / f.norm() + compliance);
            let exact = (rate(start) + rate((start + end) * 0.5) * 4.0 + rate(end)) * (material / 6.0);
            // Weight that a bar carries beyond its straight part turns it by as much.
            let bar = self.answer.nodes[(k + 2).min(self.answer.nodes.len() - 1)].arc_length_m
                - self.answer.nodes[k.saturating_sub(1)].arc_length_m;
            let lumped = if touches { LUMPED * self.body.norm() * bar / larger(p, q) } else { 0.0 };
            let limit = slack + aside + (TURN * turn * turn + lumped) * material;
            return Lengths { value: (way - exact).norm(), limit, folded: 0.0 };
        }
        let stretched = material * (1.0 + larger(p, q) * compliance);
        let slack = slack + aside;
        Lengths { value: way.norm() - stretched, limit: slack, folded: larger(stretched - way.norm(), 0.0) }
    }

    /// Whether something touches a piece or a neighbour.
    pub fn touches(&self, near: &Neighbours, k: usize) -> bool {
        let led = || [k, k + 1].iter().any(|&k| self.wheels().any(|w| self.is_led(k, w.0, w.1)));
        !near.around(k, k + 1).is_empty() || led()
    }

    /// Whether a node is on a wheel.
    pub fn is_led(&self, node: usize, center: Vec2, radius: f64) -> bool {
        let reach = self.reach() - 0.5 * self.cable.diameter_m;
        (self.answer.nodes[node].at() - center).norm() <= radius + reach
    }

    /// The piece from node k of a stiff cable: its way is an arc.
    fn stiff_length(&self, k: usize) -> Lengths {
        let [a, b] = [&self.answer.nodes[k], &self.answer.nodes[k + 1]];
        let material = self.thermal * (b.arc_length_m - a.arc_length_m);
        let bend = larger(a.curvature_per_m.abs(), b.curvature_per_m.abs()) * material;
        let pull = 0.5 * (a.tension_n + b.tension_n);
        let change = (b.tension_n - a.tension_n).abs() + self.body.norm() * material;
        let stretched = material * (1.0 + pull / self.cable.axial_stiffness_n);
        let slack = LENGTH * material + MATERIAL * self.cable.length_m;
        let limit = slack + (TURN * bend * bend + change / self.cable.axial_stiffness_n) * material;
        Lengths { value: ((b.at() - a.at()).norm() - stretched).abs(), limit, folded: 0.0 }
    }

    /// With M the bending moment, M' + t × F = 0.
    fn moments(&self, found: &mut Verification) {
        found.ask(Law::Moment);
        let stiffness = self.answer.assumptions.bending_stiffness_n_m2 / self.thermal;
        let nodes = &self.answer.nodes;
        let greatest = nodes.iter().map(|n| (stiffness * n.curvature_per_m).abs()).fold(0.0, larger);
        let noise = BALANCE * self.scale * 0.5 * self.cable.diameter_m;
        for (k, pair) in nodes.windows(2).enumerate() {
            let way = pair[1].at() - pair[0].at();
            // A bar that is longer than the bend beside a clamp or a contact, √(EI/T), cannot show it.
            if way.norm_squared() * pair[0].force().norm() > self.answer.assumptions.bending_stiffness_n_m2 {
                continue;
            }
            let change = stiffness * (pair[1].curvature_per_m - pair[0].curvature_per_m);
            let off = self.forces_at_end(k).map(|end| (change + cross(way, (pair[0].force() + end) * 0.5)).abs());
            let (value, limit) = (if off[1] < off[0] { off[1] } else { off[0] }, MOMENT * greatest + noise);
            if !(value <= limit) {
                found.report(self.finding(Law::Moment, k, (value, limit)));
            }
        }
    }

    /// Every bar against every other that is further along the cable than it is thick.
    fn self_contact(&self, found: &mut Verification) {
        found.ask(Law::SelfContact);
        let nodes = &self.answer.nodes;
        let thick = self.cable.diameter_m;
        let limit = (DEPTH_DIAMETERS * thick).min(DEPTH_M);
        let edge = |k: usize| (nodes[k].at(), nodes[k + 1].at());
        for i in 0..nodes.len() - 1 {
            for j in i + 1..nodes.len() - 1 {
                let apart = nodes[j].arc_length_m - nodes[i + 1].arc_length_m;
                if apart < 2.0 * std::f64::consts::PI * thick {
                    continue;
                }
                let ((a, b), (c, d)) = (edge(i), edge(j));
                let value = thick - super::surroundings::distance(a, b, c, d);
                if !(value <= limit) {
                    found.report(self.finding(Law::SelfContact, i, (value, limit)));
                }
            }
        }
    }
}

/// How far a force is outside the convex cone of some rays (unit vectors), N.
fn outside_cone(force: Vec2, rays: &[Vec2]) -> f64 {
    let size = force.norm();
    if size == 0.0 {
        return 0.0;
    }
    let mut least = size;
    for (k, a) in rays.iter().enumerate() {
        let along = force.dot(a);
        if along > 0.0 {
            least = least.min((force - a * along).norm());
        }
        for b in rays.iter().skip(k + 1) {
            let wide = cross(*a, *b);
            // force = αa + βb with both not negative.
            if wide != 0.0 && cross(force, *b) / wide >= 0.0 && cross(*a, force) / wide >= 0.0 {
                return 0.0;
            }
        }
    }
    least
}

/// A vector as a function of time: the constant, or linear between its times.
pub(super) fn series(constant: Option<[f64; 2]>, times: &[f64], values: &[[f64; 2]], time_s: f64) -> Vec2 {
    if times.is_empty() {
        return constant.map_or_else(Vec2::zeros, vec2);
    }
    let k = times.partition_point(|&t| t <= time_s);
    match (k.checked_sub(1).and_then(|i| values.get(i)), values.get(k)) {
        (Some(a), Some(b)) => {
            let f = (time_s - times[k - 1]) / (times[k] - times[k - 1]);
            vec2(*a) + (vec2(*b) - vec2(*a)) * f
        }
        (Some(v), None) | (None, Some(v)) => vec2(*v),
        (None, None) => Vec2::zeros(),
    }
}
