//! Each law of mechanics is one function over one cable.
//!
//! With F(s) the internal force, b the load per metre and d the force of obstacles on a piece of
//! cable from s₁ to s₂, F(s₂) − F(s₁) + b (s₂ − s₁) + Σ P + d = 0, with P the point forces on it.
//! So d follows from what the answer says of the cable alone, and must be nothing in the air, and
//! within the cone about the normals of what touches the piece elsewhere. Beyond its ends the cable
//! has no internal force.

use super::supports::{self, Role, SupportHold};
use super::surroundings::{NearestFeature, Neighbours, Surroundings};
use super::tolerance::{
    BALANCE_FRACTION, COMPRESSION, CONE_EXCESS, CONTACT_SHIFT_DIAMETERS, DEPTH_DIAMETERS, DEPTH_LENGTHS, DEPTH_M,
    FOLD_TURN, LENGTH, LUMPED_WEIGHT_TURN, MATERIAL_TOLERANCE, MIN_STRAIN, MOMENT, MOMENTUM, NORMAL_TOLERANCE,
    REACH_DIAMETERS, REACH_M, REPORTED_BALANCE, TURN,
};
use super::{Balance, Depth, Finding, Law, NotChecked, Verification};
use crate::math::{Vec2, cross, larger, smaller, vec2};
use crate::scene::{Cable, Scene, View};
use crate::solution::{CableSolution, ContactReport, Node, SupportReaction};

/// One cable with what there is to know of it.
pub(super) struct CheckedCable<'a> {
    surroundings: &'a Surroundings<'a>,
    scene: &'a Scene,
    pub cable: &'a Cable,
    pub answer: &'a CableSolution,
    /// The actions of its supports on it.
    pub holds: Vec<SupportHold<'a>>,
    /// Centre, radius of the centre line and friction of the wheels that lead the cable now.
    pub wheels: Vec<(Vec2, f64, f64)>,
    /// Supports and loads. Wheels are among the obstacles.
    points: Vec<AppliedForce>,
    /// Weight and wind, N/m.
    body: Vec2,
    /// 1 + αΔT.
    pub thermal: f64,
    /// Greatest of the forces, N: what a residual is compared with.
    scale: f64,
}

/// A force on a point of the cable, N.
struct AppliedForce {
    arc_length: f64,
    force: Vec2,
}

/// The cable from a node to the next.
#[derive(Clone, Copy, Debug)]
struct CheckedBar<'a> {
    /// Index of the first node.
    k: usize,
    from: &'a Node,
    to: &'a Node,
    /// Arc length, m.
    length: f64,
    /// From node to node, m.
    way: Vec2,
    /// Sizes of the internal forces of its nodes, N.
    forces: [f64; 2],
}

/// Difference of a piece's way from what it should be, its tolerance, and the material beyond its
/// way, m.
#[derive(Clone, Copy, Debug)]
struct Lengths {
    value: f64,
    limit: f64,
    folded: f64,
}

/// A piece of the cable between nodes, its ends counted in.
#[derive(Clone, Debug, Default)]
struct CheckedPiece {
    /// First and last node.
    nodes: [usize; 2],
    /// The force that obstacles must exert on it, N.
    contact: Vec2,
}

pub(super) fn check(found: &mut Verification, mut subject: CheckedCable<'_>, depth: Depth) {
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
        let cable = cable.name.clone();
        found.not_checked.push(match answer.breaks.is_empty() {
            true => NotChecked::MovingBalance { cable },
            false => NotChecked::BrokenBalance { cable },
        });
        subject.momentum(found);
    } else {
        subject.supports(found);
        subject.balance(found, &near);
        if answer.assumptions.bending_stiffness_n_m2 > 0.0 {
            subject.stiff(found);
            subject.stability(found, &near);
        } else {
            subject.flexible(found, &near);
            subject.pulleys(found);
        }
    }
    if cable.self_contact && depth == Depth::Full {
        subject.self_contact(found);
    } else if cable.self_contact {
        found.not_checked.push(NotChecked::SelfContact { cable: cable.name.clone() });
    }
}

impl<'a> CheckedCable<'a> {
    /// The answer for a cable of a scene at a time, s.
    pub fn new(
        surroundings: &'a Surroundings<'a>,
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
        let led = |hold: &SupportHold<'_>| match hold.role {
            Role::Wheel { radius } => Some((hold.at, radius, hold.support.friction.unwrap_or(0.0))),
            _ => None,
        };
        let wheels = holds.iter().filter_map(led).collect();
        let points = point_forces(scene, cable, &holds, time_s);
        Self { surroundings, scene, cable, answer, holds, wheels, points, body: weight + wind, thermal, scale: 0.0 }
    }
}

impl CheckedCable<'_> {
    /// Greatest of the forces, N.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Weight and wind, N/m.
    pub(crate) fn load_per_metre(&self) -> Vec2 {
        self.body
    }

    /// Returns where the scene's loads are on the cable, m.
    pub(crate) fn scene_loads(&self) -> Vec<f64> {
        self.scene.loads.iter().filter(|l| l.cable == self.cable.name).map(|l| l.arc_length_m).collect()
    }

    pub fn finding(&self, law: Law, node: usize, value: f64, limit: f64) -> Finding {
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
        // Without a branch for each number.
        let all = |values: &[f64]| values.iter().fold(true, |all, v| all & v.is_finite());
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
            let mut finding = self.finding(Law::Finite, k, f64::INFINITY, 0.0);
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

    /// The greatest force on or in the cable, N; of one without any the least that anybody would
    /// read.
    fn forces_scale(&self) -> f64 {
        let square = self.answer.nodes.iter().map(|n| n.force().norm_squared()).fold(0.0, f64::max);
        let loads = self.points.iter().map(|p| p.force.norm()).fold(0.0, larger);
        let load = self.body.norm() * self.cable.length_m;
        larger(larger(square.sqrt(), loads), larger(load, MIN_STRAIN * self.cable.axial_stiffness_n))
    }

    /// Forces of what is no obstacle of the scene (the cable itself), as they are reported.
    fn foreign(&self) -> impl Iterator<Item = AppliedForce> {
        let foreign = self.answer.contacts.iter().filter(|c| self.surroundings.find(&c.obstacle).is_none());
        foreign.flat_map(|c| &c.samples).map(|s| AppliedForce { arc_length: s.arc_length_m, force: vec2(s.force_n) })
    }

    /// Returns whether the nodes run along the material: without that nothing else can be asked.
    fn material(&self, found: &mut Verification) -> bool {
        found.ask(Law::Material);
        let before = found.findings.len();
        let nodes = &self.answer.nodes;
        let limit = MATERIAL_TOLERANCE * self.cable.length_m;
        let first = nodes.first().map_or(f64::NAN, |n| n.arc_length_m.abs());
        let last = nodes.last().map_or(f64::NAN, |n| (n.arc_length_m - self.cable.length_m).abs());
        for (node, value) in [(0, first), (nodes.len() - 1, last)] {
            if !(value <= limit) {
                found.report(self.finding(Law::Material, node, value, limit));
            }
        }
        for (k, pair) in nodes.windows(2).enumerate() {
            let back = pair[0].arc_length_m - pair[1].arc_length_m;
            if !(back <= limit) {
                found.report(self.finding(Law::Material, k + 1, back, limit));
            }
        }
        found.findings.len() == before
    }

    /// Distance of the centre line from a surface at which they may push, m.
    pub fn reach(&self) -> f64 {
        0.5 * self.cable.diameter_m + larger(REACH_M, REACH_DIAMETERS * self.cable.diameter_m)
    }

    /// Returns what is near the line from each node to the next.
    fn near(&self) -> Neighbours {
        let reach = self.reach();
        Neighbours::new(self.surroundings, self.answer.nodes.iter().map(Node::at), reach)
    }

    fn penetration(&self, found: &mut Verification, near: &Neighbours) {
        found.ask(Law::Penetration);
        let radius = 0.5 * self.cable.diameter_m;
        let to_scale = larger(DEPTH_M, DEPTH_LENGTHS * self.cable.length_m);
        let allowed = (DEPTH_DIAMETERS * self.cable.diameter_m).min(to_scale);
        let nodes = &self.answer.nodes;
        // Where the scene itself holds the axis on a surface, the cable is as deep there as it is
        // thick.
        let held = self.held_at();
        let on_surface = MATERIAL_TOLERANCE * self.cable.length_m;
        for (k, n) in nodes.iter().enumerate() {
            // From a bar that nothing is near it is as far inside as the node before.
            if k > 0 && near.of(k - 1).is_empty() {
                continue;
            }
            if let Some((body, depth)) = self.surroundings.inside(n.at()) {
                if depth <= on_surface && held.contains(&n.at()) {
                    continue;
                }
                let mut finding = self.finding(Law::Penetration, k, depth + radius, allowed);
                self.surroundings.name(body).clone_into(&mut finding.with);
                found.report(finding);
            }
        }
        // Between the pieces of a broken cable there is none.
        let is_cable = |k: usize| !near.of(k).is_empty() && !self.answer.breaks.contains(&(k + 1));
        for k in (0..nodes.len() - 1).filter(|k| is_cable(*k)) {
            // Between two nodes the cable is drawn straight where it is round.
            let pair = &nodes[k..=k + 1];
            let way = (pair[1].at() - pair[0].at()).norm();
            let bend = pair.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, larger);
            let sagitta = smaller(bend * way * way / 8.0, DEPTH_LENGTHS * self.cable.length_m);
            for n in near.of(k) {
                let value = radius - n.distance;
                let end = n.at == pair[0].at() || n.at == pair[1].at();
                let given = if held.contains(&n.at) { radius } else { 0.0 };
                let limit = allowed + given + if end { 0.0 } else { sagitta };
                if !(value <= limit) {
                    let mut finding = self.finding(Law::Penetration, k, value, limit);
                    self.surroundings.name(n.body).clone_into(&mut finding.with);
                    finding.at_m = n.at.into();
                    found.report(finding);
                }
            }
        }
    }

    /// Returns where supports hold the cable by its axis, m.
    fn held_at(&self) -> Vec<Vec2> {
        self.holds.iter().filter(|h| h.role == Role::Held).map(|h| h.at).collect()
    }

    /// Contacts as they are reported: they push, within their cone.
    fn reported_contacts(&self, found: &mut Verification) {
        found.ask(Law::Push);
        found.ask(Law::Friction);
        let noise = BALANCE_FRACTION * self.scale;
        for c in &self.answer.contacts {
            let friction = match self.surroundings.find(&c.obstacle) {
                Some(body) => self.surroundings.friction(body, self.cable.friction),
                None => self.cable.friction,
            };
            let node = self.answer.nodes.partition_point(|n| n.arc_length_m < c.arc_length_m);
            let mut tell = |law: Law, value: f64, limit: f64| {
                if !(value <= limit) {
                    let mut finding = self.finding(law, node, value, limit);
                    finding.with.clone_from(&c.obstacle);
                    found.report(finding);
                }
            };
            tell(Law::Push, -c.normal_n, noise);
            tell(Law::Friction, c.friction_n.abs() - friction * c.normal_n, CONE_EXCESS * c.normal_n.abs() + noise);
        }
    }

    /// The pieces from node to node. What acts at a node belongs to the piece that ends there, as
    /// internal forces are those just beyond nodes.
    fn pieces(&self) -> impl Iterator<Item = CheckedPiece> {
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        let same = MATERIAL_TOLERANCE * self.cable.length_m;
        let foreign: Vec<AppliedForce> = self.foreign().collect();
        // The last of the nodes at that material, and never before the first piece.
        let node = |s: f64| nodes.partition_point(|n| n.arc_length_m <= s + same).clamp(2, nodes.len()) - 1;
        let mut known: Vec<_> = self.points.iter().chain(&foreign).map(|p| (node(p.arc_length), p.force)).collect();
        known.sort_by_key(|p| p.0);
        let mut known = known.into_iter().peekable();
        // Forces of bodies that the scene does not hold still are known to a node's neighbourhood
        // only.
        let cut = move |k: usize| {
            let [before, after] = [k - 1, (k + 1).min(last)].map(|k| nodes[k].arc_length_m);
            // Nodes of one material point are one: where the cable turns round a point, it is not
            // said what it does there.
            nodes[k + 1].arc_length_m - nodes[k].arc_length_m > same
                && foreign.iter().all(|p| !(p.arc_length >= before - same && p.arc_length <= after + same))
        };
        let mut from = 0;
        std::iter::from_fn(move || {
            if from == last {
                return None;
            }
            let to = (from + 1..last).find(|&k| cut(k)).unwrap_or(last);
            let [a, b] = [from, to].map(|k| &nodes[k]);
            // Beyond the ends of the cable there is nothing.
            let before = if from == 0 { Vec2::zeros() } else { a.force() };
            let after = if to == last { Vec2::zeros() } else { b.force() };
            let mut contact = before - after - self.body * (b.arc_length_m - a.arc_length_m);
            while let Some((_, force)) = known.next_if(|p| p.0 <= to) {
                contact -= force;
            }
            let piece = CheckedPiece { nodes: [from, to], contact };
            from = to;
            Some(piece)
        })
    }

    fn balance(&self, found: &mut Verification, near: &Neighbours) {
        found.ask(Law::Balance);
        let limit = BALANCE_FRACTION * self.scale;
        let mut sums = Balance { scale_n: larger(found.balance.scale_n, self.scale), ..found.balance };
        let (mut adrift, mut beyond, mut pressed, mut in_air) = (Vec2::zeros(), 0.0, 0.0, 0.0);
        let (mut contacts, mut wheels, mut worst) = (Vec2::zeros(), Vec2::zeros(), (0.0, 0));
        let mut rays = Vec::new();
        for piece in self.pieces() {
            let Some(excess) = self.excess(near, &piece, &mut rays) else {
                // In the air residuals add up: each may be small and the sum not.
                adrift += piece.contact;
                for square in [adrift.norm_squared(), piece.contact.norm_squared()] {
                    in_air = f64::max(in_air, square);
                    if !(square <= limit * limit) {
                        found.report(self.finding(Law::Balance, piece.nodes[0], square.sqrt(), limit));
                    }
                }
                continue;
            };
            adrift = Vec2::zeros();
            if self.on_wheel(&piece) {
                wheels += piece.contact
            } else {
                contacts += piece.contact
            }
            beyond += excess;
            pressed += piece.contact.norm();
            if excess > worst.0 || excess.is_nan() {
                worst = (excess, piece.nodes[0]);
            }
        }
        sums.residual_n = larger(larger(sums.residual_n, in_air.sqrt()), beyond);
        let allowed = limit + CONE_EXCESS * pressed;
        // Small sums may be hidden by all bends together, larger ones by the bend where they are.
        let [at_bends, apart] = if beyond <= allowed { [0.0; 2] } else { self.lumped_friction(near) };
        let hidden = smaller(at_bends, REPORTED_BALANCE * self.scale);
        if !(beyond <= allowed + hidden) && !(apart <= allowed) {
            let mut finding = self.finding(Law::Friction, worst.1, beyond, allowed);
            let here = near.of(worst.1).first();
            here.map_or("", |n| self.surroundings.name(n.body)).clone_into(&mut finding.with);
            found.report(finding);
        }
        self.sums(found, sums, [contacts, wheels]);
    }

    /// Returns what obstacles and the floor would do to a piece beyond what their friction allows,
    /// N; None where nothing touches it.
    fn excess(&self, near: &Neighbours, piece: &CheckedPiece, rays: &mut Vec<Vec2>) -> Option<f64> {
        let within = |n: &NearestFeature| {
            let pushes = piece.contact.dot(&n.normal);
            let friction = self.surroundings.friction(n.body, self.cable.friction);
            pushes > 0.0 && cross(n.normal, piece.contact).abs() <= friction * pushes
        };
        // Most pieces need no more than one of the things that touch them.
        if near.around(piece.nodes[0], piece.nodes[1]).iter().any(within) {
            return Some(0.0);
        }
        self.rays(near, piece, rays);
        let touches = !rays.is_empty() || self.floor_rubs();
        touches.then(|| self.floor_excess(piece, outside_cone(piece.contact, rays)))
    }

    /// Checks that the reported forces of contacts and wheels add up to those the cable needs.
    fn sums(&self, found: &mut Verification, mut sums: Balance, [contacts, wheels]: [Vec2; 2]) {
        let limit = BALANCE_FRACTION * self.scale;
        let known_here = |c: &&ContactReport| self.surroundings.find(&c.obstacle).is_some();
        let reported: Vec2 = self.answer.contacts.iter().filter(known_here).map(|c| vec2(c.force_n)).sum::<Vec2>()
            + self.foreign().map(|p| p.force).sum::<Vec2>();
        let led: Vec2 =
            self.holds.iter().filter(|h| matches!(h.role, Role::Wheel { .. })).map(SupportHold::force).sum();
        let known: Vec2 = self.points.iter().map(|p| p.force).sum();
        let weight = self.body * self.cable.length_m;
        let whole = known + weight + led + reported;
        let off = if self.floor_rubs() { (wheels - led).norm() } else { whole.norm() };
        sums.residual_n = larger(sums.residual_n, off);
        let limit = if self.answer.contacts.is_empty() { limit } else { REPORTED_BALANCE * self.scale };
        if !(off <= limit) {
            let mut finding = self.finding(Law::Balance, 0, off, limit);
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
        self.holds.iter().filter(|h| matches!(h.role, Role::Held | Role::Pulley)).map(SupportHold::force).sum()
    }

    /// Returns whether a floor rubs on the whole cable.
    fn floor_rubs(&self) -> bool {
        self.scene.view == View::Plan && self.cable.friction > 0.0
    }

    /// Returns what may act on each metre of the cable without touching it at a place, N/m: weight
    /// and wind, and in plan view the floor's friction.
    fn spread_load(&self) -> f64 {
        if !self.floor_rubs() {
            return self.body.norm();
        }
        let weight = self.cable.linear_density_kg_per_m * self.scene.environment.gravity_m_per_s2;
        self.body.norm() + self.cable.friction * weight
    }

    /// Returns what is beyond the floor's friction, too, N.
    fn floor_excess(&self, piece: &CheckedPiece, excess: f64) -> f64 {
        if !self.floor_rubs() {
            return excess;
        }
        let weight = self.cable.linear_density_kg_per_m * self.scene.environment.gravity_m_per_s2;
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        // Friction at a node is of half of both pieces beside it, and at an end of the cable of the
        // half there too.
        let [a, b] = piece.nodes.map(|k| nodes[k].arc_length_m);
        let next = nodes[(piece.nodes[1] + 1).min(last)].arc_length_m;
        let half = if piece.nodes[0] == 0 { 0.5 * (b - a) } else { 0.0 };
        let share = larger(b - a, 0.5 * (next - a) + half);
        larger(excess - self.cable.friction * weight * share, 0.0)
    }

    fn on_wheel(&self, piece: &CheckedPiece) -> bool {
        self.wheels.iter().any(|&(center, radius, _)| piece.nodes.iter().any(|&k| self.is_led(k, center, radius)))
    }

    /// Friction (N) that the bars' own weight may add or hide where the ground turns, all of it,
    /// and what pieces ask of obstacles beyond their cones when each is let off with its own: a bar
    /// carries its weight to its ends, where it turns the cable by weight over tension, and so
    /// presses as no edge does.
    fn lumped_friction(&self, near: &Neighbours) -> [f64; 2] {
        let nodes = &self.answer.nodes;
        let last = nodes.len() - 1;
        let (mut rays, mut sums) = (Vec::new(), [0.0; 2]);
        for piece in self.pieces() {
            let excess = self.excess(near, &piece, &mut rays).unwrap_or(0.0);
            let [from, to] = [piece.nodes[0].saturating_sub(1), (piece.nodes[1] + 1).min(last)];
            // Material that lies in folds is beside the way, and turns nothing.
            let way: f64 = nodes[from..=to].windows(2).map(|pair| (pair[1].at() - pair[0].at()).norm()).sum();
            let weight = self.body.norm() * smaller(nodes[to].arc_length_m - nodes[from].arc_length_m, way);
            let force = larger(nodes[piece.nodes[0]].force().norm(), nodes[piece.nodes[1]].force().norm());
            let turn = if weight < force { weight / force } else { 1.0 };
            let lumped = if self.rays(near, &piece, &mut rays) { weight * turn } else { 0.0 };
            let hidden = LUMPED_WEIGHT_TURN * self.greatest_friction() * lumped;
            sums = [sums[0] + hidden, sums[1] + larger(excess - hidden, 0.0)];
        }
        sums
    }

    /// The greatest friction coefficient that the cable may meet.
    fn greatest_friction(&self) -> f64 {
        self.scene.obstacles.iter().map(|o| o.friction.unwrap_or(self.cable.friction)).fold(0.0, larger)
    }

    /// Gathers unit vectors that bound the friction cones of all that touches a piece, its
    /// neighbours counted in: a force that is known at nodes only is known to a node's
    /// neighbourhood. Returns whether their normals differ, as at a corner.
    fn rays(&self, near: &Neighbours, piece: &CheckedPiece, out: &mut Vec<Vec2>) -> bool {
        out.clear();
        let (mut first, mut turns, mut before) = (None, false, (Vec2::zeros(), 0.0));
        let mut add = |normal: Vec2, friction: f64| {
            if normal == Vec2::zeros() || (normal, friction) == before {
                return;
            }
            before = (normal, friction);
            turns |= cross(*first.get_or_insert(normal), normal).abs() > NORMAL_TOLERANCE;
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
        for &(center, radius, friction) in &self.wheels {
            for k in (from..=to).filter(|&k| self.is_led(k, center, radius)) {
                add((self.answer.nodes[k].at() - center).try_normalize(0.0).unwrap_or_default(), friction);
            }
        }
        turns
    }

    /// The laws of a flexible cable from node to node: its tension is the force in it, it pulls
    /// along its way, and its way is its material.
    fn flexible(&self, found: &mut Verification, near: &Neighbours) {
        [Law::Length, Law::Tension, Law::Compression].into_iter().for_each(|law| found.ask(law));
        let mut before = None;
        for bar in self.bars() {
            self.tension(found, before, &bar);
            self.compression(found, &bar);
            self.flexible_length(found, near, &bar);
            before = Some(bar);
        }
        if let Some(bar) = before {
            let (k, from, forces) = (bar.k + 1, bar.to, [bar.forces[1]; 2]);
            self.tension(found, before, &CheckedBar { k, from, forces, length: 0.0, way: Vec2::zeros(), ..bar });
        }
    }

    /// From each node to the next.
    fn bars(&self) -> impl Iterator<Item = CheckedBar<'_>> {
        let mut first = self.answer.nodes[0].force().norm();
        self.answer.nodes.windows(2).enumerate().map(move |(k, pair)| {
            let [from, to] = [&pair[0], &pair[1]];
            let forces = [first, to.force().norm()];
            first = forces[1];
            CheckedBar { k, from, to, length: to.arc_length_m - from.arc_length_m, way: to.at() - from.at(), forces }
        })
    }

    /// The tension of a flexible cable is the size of the force in it: at the node between two bars
    /// one of those between just before and just beyond it.
    fn tension(&self, found: &mut Verification, before: Option<CheckedBar<'_>>, bar: &CheckedBar<'_>) {
        let tension = bar.from.tension_n;
        let limit = REPORTED_BALANCE * self.scale;
        // Most nodes have it from the bar that begins there.
        if (tension - bar.forces[0]).abs() <= limit {
            return;
        }
        // `fem` reads it off the middles of the bars beside a node: half of their weight, or of the
        // floor's friction on them, is in between.
        let beside = bar.length + before.map_or(0.0, |b| b.length);
        let limit = limit + LUMPED_WEIGHT_TURN * self.spread_load() * beside;
        let after = bar.from.force();
        let before = before.map_or(after, |_| self.force_before(bar.k));
        let most = larger(before.norm(), bar.forces[0]);
        let least = super::surroundings::distance(before, after, Vec2::zeros(), Vec2::zeros());
        let value = larger(tension - most, least - tension);
        if !(value <= limit) {
            found.report(self.finding(Law::Tension, bar.k, value, limit));
        }
    }

    /// Momentum changes by the impulses of what acts, and weight gives what its mass does.
    fn momentum(&self, found: &mut Verification) {
        let Some(account) = &self.answer.momentum else { return };
        found.ask(Law::Momentum);
        let impulses = account.impulses_n_s().map(vec2);
        let [before, after] = [account.before_kg_m_per_s, account.after_kg_m_per_s].map(vec2);
        let sum: Vec2 = impulses.iter().sum();
        let largest = impulses.iter().map(|i| i.norm()).fold((after - before).norm(), larger);
        let value = (after - before - sum).norm();
        let limit = MOMENTUM * largest;
        if !(value <= limit) {
            found.report(self.finding(Law::Momentum, 0, value, limit));
        }
    }

    /// A flexible cable pulls along its way.
    fn compression(&self, found: &mut Verification, bar: &CheckedBar<'_>) {
        // Nodes of one material point have no way between them.
        if bar.length <= MATERIAL_TOLERANCE * self.cable.length_m {
            return;
        }
        let pulls = self.forces_at_end(bar).map(|end| (bar.from.force() + end).dot(&bar.way));
        let most = if pulls[0] >= 0.0 { pulls[0] } else { larger(pulls[0], pulls[1]) };
        let least = smaller(bar.from.tension_n, bar.to.tension_n);
        if most >= 0.0 && least >= 0.0 {
            return;
        }
        let pushes = if most < 0.0 { -0.5 * most / bar.way.norm() } else { 0.0 };
        let (value, limit) = (larger(pushes, -least), COMPRESSION * self.scale);
        if !(value <= limit) {
            found.report(self.finding(Law::Compression, bar.k, value, limit));
        }
    }

    /// Internal force at the end of a bar, N: as what touches it is spread along it, and as it is
    /// all at the end.
    fn forces_at_end(&self, bar: &CheckedBar<'_>) -> [Vec2; 2] {
        [bar.to.force(), bar.from.force() - self.body * bar.length]
    }

    /// Internal force just before a node that is not the first, as what touches the bar before it
    /// is all at its end, N.
    pub(crate) fn force_before(&self, node: usize) -> Vec2 {
        let [a, b] = [&self.answer.nodes[node - 1], &self.answer.nodes[node]];
        a.force() - self.body * (b.arc_length_m - a.arc_length_m)
    }

    /// The way of a bar is what its material and force make of it.
    fn flexible_length(&self, found: &mut Verification, near: &Neighbours, bar: &CheckedBar<'_>) {
        let touches = self.touches(near, bar.k);
        let [spread, at_end] = self.forces_at_end(bar);
        let spread = self.strained(bar, spread, bar.forces[1], touches);
        if spread.is_some_and(|(off, limit)| off.norm_squared() <= limit * limit) {
            return;
        }
        let lengths = |strained: Option<(Vec2, f64)>, q: f64| match strained {
            Some((off, limit)) => Lengths { value: off.norm(), limit, folded: 0.0 },
            None => self.folded(bar, q, touches),
        };
        let spread = lengths(spread, bar.forces[1]);
        if spread.value <= spread.limit && spread.folded == 0.0 {
            return;
        }
        let at_end = lengths(self.strained(bar, at_end, at_end.norm(), touches), at_end.norm());
        let off = |l: &Lengths| l.value / l.limit;
        self.tell_length(found, bar, if off(&at_end) < off(&spread) { at_end } else { spread });
    }

    fn tell_length(&self, found: &mut Verification, bar: &CheckedBar<'_>, lengths: Lengths) {
        found.folded_m += lengths.folded;
        if !(lengths.value <= lengths.limit) {
            found.report(self.finding(Law::Length, bar.k, lengths.value, lengths.limit));
        }
    }

    /// Rounding (m) of the way of so much material, m.
    fn length_rounding(&self, material: f64) -> f64 {
        LENGTH * material + MATERIAL_TOLERANCE * self.cable.length_m
    }

    /// The most (m) by which a way may be from what it should be by rounding, and beside what
    /// touches.
    fn length_slack(&self, material: f64, touches: bool) -> f64 {
        let aside = if touches { CONTACT_SHIFT_DIAMETERS * self.cable.diameter_m } else { 0.0 };
        self.length_rounding(material) + aside
    }

    /// Returns how far the way of a bar of a flexible cable, whose internal force is `end` (N) of
    /// size `q` (N) at its end, is from what it should be, and how far it may, m; None where the
    /// force has no direction.
    #[inline]
    fn strained(&self, bar: &CheckedBar<'_>, end: Vec2, q: f64, touches: bool) -> Option<(Vec2, f64)> {
        let (compliance, start, p) = (1.0 / self.cable.axial_stiffness_n, bar.from.force(), bar.forces[0]);
        let (least, most) = if p < q { (p, q) } else { (q, p) };
        let turn = (end - start).norm_squared() / (least * least);
        // A force no greater than what is let pass unbalanced has no direction, and may be none.
        if !(turn < FOLD_TURN * FOLD_TURN && least > BALANCE_FRACTION * self.scale) {
            return None;
        }
        // Simpson's rule for ∫ F/|F| (1 + |F|/EA) ds with F linear in s.
        let middle = (start + end) * 0.5;
        let rates = start * (1.0 / p + compliance)
            + middle * (4.0 * (1.0 / middle.norm() + compliance))
            + end * (1.0 / q + compliance);
        let material = self.thermal * bar.length;
        // Weight that a bar carries beyond its straight part turns it by as much.
        let lumped = if touches { LUMPED_WEIGHT_TURN * self.weight_beside(bar.k) / most } else { 0.0 };
        let limit = self.length_slack(material, touches) + (TURN * turn + lumped) * material;
        Some((bar.way - rates * (material / 6.0), limit))
    }

    /// A bar whose force, of size `q` (N) at its end, has no direction: it is no longer than its
    /// material.
    fn folded(&self, bar: &CheckedBar<'_>, q: f64, touches: bool) -> Lengths {
        let material = self.thermal * bar.length;
        let stretched = material * (1.0 + larger(bar.forces[0], q) / self.cable.axial_stiffness_n);
        let (way, limit) = (bar.way.norm(), self.length_slack(material, touches));
        Lengths { value: way - stretched, limit, folded: larger(stretched - way, 0.0) }
    }

    /// Weight and wind of the cable from node k to the next and of its neighbours, N.
    fn weight_beside(&self, k: usize) -> f64 {
        let nodes = &self.answer.nodes;
        let [from, to] = [k.saturating_sub(1), (k + 2).min(nodes.len() - 1)].map(|k| nodes[k].arc_length_m);
        self.body.norm() * (to - from)
    }

    /// Returns whether something touches a piece or a neighbour.
    pub fn touches(&self, near: &Neighbours, k: usize) -> bool {
        let led = || self.wheels.iter().any(|w| [k, k + 1].iter().any(|&k| self.is_led(k, w.0, w.1)));
        !near.around(k, k + 1).is_empty() || led()
    }

    /// Returns whether a node is on a wheel.
    pub(crate) fn is_led(&self, node: usize, center: Vec2, radius: f64) -> bool {
        let reach = self.reach() - 0.5 * self.cable.diameter_m;
        (self.answer.nodes[node].at() - center).norm() <= radius + reach
    }

    /// The laws of a stiff cable from node to node: its way is an arc of its material, and with M
    /// the bending moment, M' + t × F = 0.
    fn stiff(&self, found: &mut Verification) {
        [Law::Length, Law::Moment].into_iter().for_each(|law| found.ask(law));
        let stiffness = self.answer.assumptions.bending_stiffness_n_m2 / self.thermal;
        let greatest = self.answer.nodes.iter().map(|n| n.curvature_per_m.abs()).fold(0.0, larger) * stiffness;
        let limit = MOMENT * greatest + BALANCE_FRACTION * self.scale * 0.5 * self.cable.diameter_m;
        for bar in self.bars() {
            self.tell_length(found, &bar, self.stiff_length(&bar));
            // A bar that is longer than the bend beside a clamp or a contact, √(EI/T), cannot show
            // it.
            if bar.way.norm_squared() * bar.forces[0] > self.answer.assumptions.bending_stiffness_n_m2 {
                continue;
            }
            let change = stiffness * (bar.to.curvature_per_m - bar.from.curvature_per_m);
            let off = self.forces_at_end(&bar).map(|end| cross(bar.way, (bar.from.force() + end) * 0.5) + change);
            let value = smaller(off[0].abs(), off[1].abs());
            if !(value <= limit) {
                found.report(self.finding(Law::Moment, bar.k, value, limit));
            }
        }
    }

    /// The way of a bar of a stiff cable is an arc.
    fn stiff_length(&self, bar: &CheckedBar<'_>) -> Lengths {
        let (a, b) = (bar.from, bar.to);
        let material = self.thermal * bar.length;
        let bend = larger(a.curvature_per_m.abs(), b.curvature_per_m.abs()) * material;
        let pull = 0.5 * (a.tension_n + b.tension_n);
        let change = (b.tension_n - a.tension_n).abs() + self.body.norm() * material;
        let stretched = material * (1.0 + pull / self.cable.axial_stiffness_n);
        let limit =
            self.length_rounding(material) + (TURN * bend * bend + change / self.cable.axial_stiffness_n) * material;
        Lengths { value: (bar.way.norm() - stretched).abs(), limit, folded: 0.0 }
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
                    found.report(self.finding(Law::SelfContact, i, value, limit));
                }
            }
        }
    }
}

/// Returns how far a force is outside the convex cone of some rays (unit vectors), N.
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

/// Supports and loads on a cable at a time, s.
fn point_forces(scene: &Scene, cable: &Cable, holds: &[SupportHold<'_>], time_s: f64) -> Vec<AppliedForce> {
    let held = holds.iter().filter_map(|hold| {
        let force = match hold.role {
            Role::Load => hold.dead_load(scene, time_s),
            Role::Held | Role::Pulley => hold.force(),
            Role::Wheel { .. } | Role::Clear { .. } | Role::Released => return None,
        };
        Some(AppliedForce { arc_length: hold.arc_length, force })
    });
    let loads = scene.loads.iter().filter(|l| l.cable == cable.name).map(|l| {
        let force = series(l.force_n, &l.times_s, &l.forces_n, time_s);
        AppliedForce { arc_length: l.arc_length_m, force }
    });
    held.chain(loads).collect()
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
