//! This module reads the answer out of the model's state.

use crate::contact::Gap;
use crate::energy::bending::turn;
use crate::math::{Vec2, angle, larger, perp};
use crate::model::arc_nodes;
use crate::model::mass_spring::dynamics::impacts::CONTACT_SKIN;
use crate::model::mass_spring::pulleys::pulley::Pulley;
use crate::model::mass_spring::{MassSpringModel, Touch};
use crate::solution::{Assumptions, CableSolution, ContactReport, ContactSample, ContactState, Node, SupportReaction};
use crate::state::State;

/// Tensions of both sides of a point that are the same to this part make one node.
const TENSION_JUMP_TOLERANCE: f64 = 1e-9;

/// Below this speed (m/s) a held node does not rub.
const RESTING_SPEED: f64 = 1e-9;

impl MassSpringModel {
    /// Reads the present state.
    pub(in crate::model::mass_spring) fn answer(&self) -> CableSolution {
        let answer = CableSolution {
            name: self.problem.cable.name.clone(),
            nodes: self.nodes(),
            supports: (0..self.chain.node_of.len()).map(|k| self.reaction(k)).collect(),
            assumptions: Assumptions {
                bending_stiffness_n_m2: self.problem.bending_stiffness,
                inertia: self.chain.v.iter().any(|v| v.norm_squared() > 0.0),
                ..Assumptions::default()
            },
            momentum: self.momentum_account(),
            contacts: self.wraps().into_iter().map(|(contact, _)| contact).collect(),
            ..CableSolution::default()
        };
        let error_estimate = self.report.errors.relative(&answer).or_else(|| self.uncertain());
        CableSolution { error_estimate, errors: self.report.errors, ..answer }
    }

    pub(in crate::model::mass_spring) fn element_force(&self, e: usize) -> Vec2 {
        if self.at_pulley(e) {
            return self.reach(e).direction * self.chain.tension[e];
        }
        let d = self.chain.x[e + 1] - self.chain.x[e];
        let length = d.norm();
        if length > 0.0 { d * (self.chain.tension[e] / length) } else { Vec2::zeros() }
    }

    /// The nodes; a pulley is two, where the cable arrives and leaves, and a wheel some more in
    /// between.
    fn nodes(&self) -> Vec<Node> {
        let mut out = Vec::with_capacity(self.chain.x.len() + 2 * self.wheels.pulleys.len());
        for i in 0..self.chain.x.len() {
            match self.pulley_of(i) {
                None => out.push(self.node(i)),
                Some(p) => self.wheel_nodes(*p, &mut out),
            }
        }
        out
    }

    /// Internal force where the bar `e` beside a pulley meets it, N: that of its middle and the
    /// load on the way, `side` −1 before the pulley and 1 beyond it; the bar's end lies `arc` (m)
    /// on the wheel.
    fn beside_pulley(&self, e: usize, side: f64, arc: f64) -> Vec2 {
        let way = self.chain.span[e] - 0.5 * self.chain.share[e] - arc / self.problem.thermal_stretch;
        self.bar_force(e) + self.problem.body_force(self.clock.time_s) * (side * way)
    }

    /// Tension along the arc grows exponentially from one end to the other.
    fn wheel_nodes(&self, p: Pulley, out: &mut Vec<Node>) {
        let [s0, s1] = self.on_wheel_from_to(&p);
        let (b, a) = (self.reach(p.node - 1), self.reach(p.node));
        let jump = (p.tension[1] - p.tension[0]).abs() > TENSION_JUMP_TOLERANCE * p.tension[0];
        let count = arc_nodes::parts(p.radius, p.turn, self.problem.radius);
        let strain = |f: f64| self.tension_round(&p, f) / self.problem.axial_stiffness;
        let material = arc_nodes::material(count, strain);
        for k in usize::from(p.radius == 0.0 && !jump)..=count {
            let share = k.checked_sub(1).and_then(|k| material.get(k)).copied().unwrap_or(0.0);
            let f = k as f64 / count as f64;
            let (along, tension_n) = (p.radius * p.turn * f, self.tension_round(&p, f));
            let angle = p.mark + p.facing * (p.arc[0] - along) / p.radius;
            let (sin, cos) = angle.sin_cos();
            let t = match (p.radius > 0.0, k == count) {
                (true, _) => Vec2::new(cos, sin),
                (false, true) => a.direction,
                (false, false) => b.direction,
            };
            let at = if p.radius > 0.0 {
                self.chain.x[p.node] + perp(t) * (p.facing * p.radius)
            } else {
                self.chain.x[p.node]
            };
            let v = self.chain.v[p.node]
                - if k == 0 {
                    b.direction
                } else if k == count {
                    a.direction
                } else {
                    t
                } * p.rate;
            out.push(Node {
                arc_length_m: s0 + (s1 - s0) * share,
                x_m: at.x,
                y_m: at.y,
                vx_m_per_s: v.x,
                vy_m_per_s: v.y,
                tension_n,
                strain: tension_n / self.problem.axial_stiffness,
                stress_pa: tension_n / self.problem.cable.area_m2(),
                curvature_per_m: if p.radius > 0.0 { -p.facing / p.radius } else { 0.0 },
                force_n: match k {
                    0 => self.beside_pulley(p.node - 1, -1.0, p.arc[0]),
                    k if k == count => self.beside_pulley(p.node, 1.0, p.arc[1]),
                    _ => t * tension_n,
                }
                .into(),
                ..Node::default()
            });
        }
    }

    fn tension_round(&self, p: &Pulley, f: f64) -> f64 {
        let [before, after] = p.tension;
        if before > 0.0 && after > 0.0 { before * (after / before).powf(f) } else { before + (after - before) * f }
    }

    /// Material where the cable arrives at a pulley and leaves it, m.
    pub(in crate::model::mass_spring) fn on_wheel_from_to(&self, p: &Pulley) -> [f64; 2] {
        let (s, thermal) = (self.chain.s[p.node], self.problem.thermal_stretch);
        [s - p.arc[0] / thermal, s + p.arc[1] / thermal]
    }

    /// Positions and velocities as every model reads them.
    pub(in crate::model::mass_spring) fn present(&self) -> State {
        let nodes = self.nodes();
        State {
            time_s: self.clock.time_s,
            arc_length_m: nodes.iter().map(|n| n.arc_length_m).collect(),
            position_m: nodes.iter().map(|n| Vec2::new(n.x_m, n.y_m)).collect(),
            velocity_m_per_s: nodes.iter().map(|n| Vec2::new(n.vx_m_per_s, n.vy_m_per_s)).collect(),
            in_motion: false,
        }
    }

    /// Returns where the supports sit on a shape, m: a pulley at the material nearest to it, in
    /// order.
    pub(in crate::model::mass_spring) fn slid_in(&self, shape: &State) -> Vec<f64> {
        let scale = self.problem.length / shape.arc_length_m.last().copied().unwrap_or(1.0);
        let mut least = 0.0;
        let mut out = vec![0.0; self.problem.supports.len()];
        for (k, s) in self.problem.supports.iter().enumerate() {
            out[k] = match (s.arc_length, s.position_at(shape.time_s)) {
                (Some(known), _) => known,
                (None, Some((at, _))) => {
                    let at = self.drives.drag[k].unwrap_or(at);
                    let off = |j: &usize| (shape.position_m[*j] - at).norm();
                    let later = (0..shape.position_m.len()).filter(|&j| shape.arc_length_m[j] * scale > least);
                    // Of several nodes as near the middle one counts: they are those on the wheel.
                    let nearest = later.clone().map(|j| off(&j)).fold(f64::INFINITY, f64::min);
                    let near: Vec<usize> = later.filter(|j| off(j) <= nearest + 1e-6 * self.chain.even).collect();
                    near.get(near.len() / 2).map_or(least, |&j| shape.arc_length_m[j] * scale)
                }
                (None, None) => least,
            };
            least = out[k];
        }
        out
    }

    /// Tension at a node: inside, the mean of its elements' force vectors; at an end, the force
    /// there, half an element's weight and inertia beyond the middle of the last element.
    fn node(&self, i: usize) -> Node {
        let tension_n = match (i.checked_sub(1), i < self.chain.rest.len()) {
            (Some(e), true) => ((self.element_force(e) + self.element_force(i)) * 0.5).norm(),
            _ if self.drives.held[i] => self.end_tension(i),
            (Some(e), false) => self.free_end_tension(i, e),
            (None, _) => self.free_end_tension(i, 0),
        };
        let curvature_per_m = self.node_curvature(i);
        Node {
            arc_length_m: self.chain.s[i],
            x_m: self.chain.x[i].x,
            y_m: self.chain.x[i].y,
            vx_m_per_s: self.chain.v[i].x,
            vy_m_per_s: self.chain.v[i].y,
            tension_n,
            strain: tension_n / self.problem.axial_stiffness,
            stress_pa: tension_n / self.problem.cable.area_m2(),
            curvature_per_m,
            force_n: self.internal_force(i).into(),
            ..Node::default()
        }
    }

    /// Tension at a node as a gauge takes it in every sub-step, N: the mean of the elements beside
    /// it, of a pulley the greater of both sides, of a held end what holds it, ground beside it
    /// left out.
    pub(in crate::model::mass_spring) fn gauged(&self, i: usize) -> f64 {
        let e = match i.checked_sub(1) {
            Some(e) if i < self.chain.rest.len() => {
                return match self.pulley_of(i) {
                    Some(p) => larger(p.tension[0], p.tension[1]),
                    None => 0.5 * (self.chain.tension[e] + self.chain.tension[i]),
                };
            }
            before => before.unwrap_or(0),
        };
        if !self.drives.held[i] {
            return self.chain.tension[e];
        }
        let force = self.on_all_that_holds(i);
        if self.problem.bending_stiffness > 0.0 { force.dot(&self.reach(e).direction).abs() } else { force.norm() }
    }

    /// The same where forces are not summed up: of an end that of its element.
    pub(in crate::model::mass_spring) fn gauged_inside(&self, i: usize) -> f64 {
        match (i, self.chain.rest.len()) {
            (0, _) => self.chain.tension.first().copied().unwrap_or(0.0),
            (i, n) if i == n => self.chain.tension.last().copied().unwrap_or(0.0),
            _ => self.gauged(i),
        }
    }

    /// Internal force just beyond a node, at the end of the cable just before it, N: that of the
    /// bar's middle and half of its load.
    fn internal_force(&self, i: usize) -> Vec2 {
        match (i, i < self.chain.rest.len()) {
            (0, _) => self.end_force(i),
            (_, true) => self.bar_force(i) + self.problem.body_force(self.clock.time_s) * (0.5 * self.chain.share[i]),
            (_, false) => -self.end_force(i),
        }
    }

    /// Force of the cable on what holds or loads an end, N.
    fn end_force(&self, i: usize) -> Vec2 {
        match self.chain.node_of.iter().position(|&n| n == i) {
            Some(k) if !self.drives.held[i] => -self.problem.hung_on(k, self.clock.time_s),
            _ => self.on_support(i),
        }
    }

    /// Force of an element, its shear with it, N.
    fn bar_force(&self, e: usize) -> Vec2 {
        let pull = self.element_force(e);
        let d = self.chain.x[e + 1] - self.chain.x[e];
        if !(self.problem.bending_stiffness > 0.0 && d.norm_squared() > 0.0) {
            return pull;
        }
        let moment = |i: usize| self.problem.bending_stiffness * self.node_curvature(i) / self.problem.thermal_stretch;
        pull + perp(d) * ((moment(e) - moment(e + 1)) / d.norm_squared())
    }

    fn node_curvature(&self, i: usize) -> f64 {
        match (i.checked_sub(1), self.chain.x.get(i + 1)) {
            (Some(e), Some(next)) => {
                let (a, b) = (self.chain.x[i] - self.chain.x[e], next - self.chain.x[i]);
                angle(a, b) / (0.5 * (self.chain.span[e] + self.chain.span[i]))
            }
            (None, Some(next)) => self.clamp_curvature(i, 0, *next - self.chain.x[i]),
            (Some(e), None) => -self.clamp_curvature(i, e, self.chain.x[i] - self.chain.x[e]),
            (None, None) => 0.0,
        }
    }

    /// Tension at a held end: the whole force of a flexible cable, without the shear of a stiff
    /// one.
    fn end_tension(&self, i: usize) -> f64 {
        let force = self.on_support(i);
        if !(self.problem.bending_stiffness > 0.0) {
            return force.norm();
        }
        let along = self.clamp_at(i).unwrap_or_else(|| self.reach(i.min(self.chain.rest.len() - 1)).direction);
        force.dot(&along).abs()
    }

    /// Tension just inside a free end: what hangs there; with a lump, whose inertia pulls as well,
    /// that of its element `e`.
    fn free_end_tension(&self, i: usize, e: usize) -> f64 {
        let support = self.chain.node_of.iter().position(|&n| n == i).filter(|&k| self.problem.supports[k].mass == 0.0);
        let tension = self.chain.tension.get(e).copied().unwrap_or(0.0);
        let hung = support.map_or(tension, |k| self.problem.hung_on(k, self.clock.time_s).norm());
        // On the ground a part of it presses there.
        if self.problem.world.signed_gap(self.chain.x[i], CONTACT_SKIN).is_some() && hung > tension {
            tension
        } else {
            hung
        }
    }

    /// From a clamp at an end to the middle of its element `e`, which lies along `d`; 0 where
    /// nothing is clamped.
    fn clamp_curvature(&self, i: usize, e: usize, d: Vec2) -> f64 {
        let clamp = self.clamp_at(i).filter(|_| self.problem.bending_stiffness > 0.0);
        clamp.map_or(0.0, |c| turn(c, d) / (0.5 * self.chain.span[e]))
    }

    /// Force of the cable on all that holds node `i`, N: its support, and ground under it.
    fn on_all_that_holds(&self, i: usize) -> Vec2 {
        self.chain.f[i] - self.drives.held_acceleration[i] * self.chain.mass[i]
    }

    /// Force of the cable on the support that holds node `i`, N. Ground under the node carries its
    /// share of the weight and rubs on it: without that a drag comes out half an element's friction
    /// short.
    pub(in crate::model::mass_spring) fn on_support(&self, i: usize) -> Vec2 {
        let force = self.on_all_that_holds(i);
        if let Some(p) = self.pulley_of(i) {
            // Material that turns round it pulls less by its momentum.
            let turned = self.reach(i).direction - self.reach(i - 1).direction;
            return force - turned * (self.problem.linear_density * p.rate * p.rate);
        }
        force + self.under_end(i).map_or(Vec2::zeros(), |under| under.force)
    }

    /// The force of ground under a held end on the cable. At rest the ground can hold
    /// what the cable pulls along it, but the support is there for that.
    fn under_end(&self, i: usize) -> Option<Under> {
        let force = self.on_all_that_holds(i);
        let gap = self.problem.world.signed_gap(self.chain.x[i], CONTACT_SKIN)?;
        let pressed = -force.dot(&gap.normal);
        if !(pressed > 0.0) {
            return None;
        }
        let along = self.chain.v[i] - gap.normal * self.chain.v[i].dot(&gap.normal);
        let rubbing = along.try_normalize(RESTING_SPEED).unwrap_or_default() * (gap.friction * pressed);
        Some(Under { gap, pressed, force: gap.normal * pressed - rubbing })
    }

    /// The same as touches, impulses over `h` (s), of the first end and of the last.
    fn under_ends(&self, h: f64) -> [Option<Touch>; 2] {
        let last = self.chain.rest.len();
        [(0, 0, 0.0), (last, last - 1, 1.0)].map(|(i, element, fraction)| {
            if !self.drives.held[i] || self.pulley_of(i).is_some() {
                return None;
            }
            let under = self.under_end(i)?;
            let n = under.gap.normal;
            let friction = under.force.dot(&self.along_ground(element, n)) * h;
            let gap = Gap { fraction, ..under.gap };
            Some(Touch { element, gap, normal: under.pressed * h, friction, slips: friction != 0.0 })
        })
    }

    fn reaction(&self, k: usize) -> SupportReaction {
        let i = self.chain.node_of[k];
        let pulley = self.pulley_of(i);
        let force = if self.drives.held[i] {
            self.on_support(i)
        } else {
            // A dead load is what hangs there: the cable pulls it the other way.
            -self.problem.hung_on(k, self.clock.time_s)
        };
        SupportReaction {
            name: self.problem.supports[k].name.clone(),
            x_m: self.chain.x[i].x,
            y_m: self.chain.x[i].y,
            reaction_x_n: force.x,
            reaction_y_n: force.y,
            arc_length_m: pulley.map_or(self.chain.s[i], |p| self.on_wheel_from_to(p).iter().sum::<f64>() * 0.5),
            tension_before_n: pulley.map(|p| p.tension[0]),
            tension_after_n: pulley.map(|p| p.tension[1]),
            hand: self.drives.hands[k].map(|hand| hand.report(-force)),
        }
    }

    /// Contacts, and how uncertain each leaves tension. Neighbouring ones with the same obstacle
    /// are one.
    pub(in crate::model::mass_spring) fn wraps(&self) -> Vec<(ContactReport, f64)> {
        let h = if self.report.cost.inner_step_s > 0.0 { self.report.cost.inner_step_s } else { 1.0 };
        let mut out: Vec<(ContactReport, [usize; 2], f64)> = Vec::new();
        let mut last: Option<(usize, usize)> = None;
        let [first, end] = self.under_ends(h);
        for t in first.iter().chain(&self.contacts.touches).chain(&end).filter(|t| t.normal > 0.0) {
            let (obstacle, e) = (t.gap.obstacle, t.element);
            let nodes = [e + usize::from(t.gap.fraction == 1.0), e + usize::from(t.gap.fraction > 0.0)];
            match (last, out.last_mut()) {
                (Some((o, before)), Some((r, range, _))) if o == obstacle && e <= before + 1 => {
                    range[1] = nodes[1];
                    self.add(r, t, h);
                }
                _ => {
                    let mut r = ContactReport {
                        obstacle: self.problem.world.obstacle_name(obstacle).to_owned(),
                        tension_before_n: self.chain.tension[e.saturating_sub(1)],
                        ..ContactReport::default()
                    };
                    self.add(&mut r, t, h);
                    out.push((r, nodes, t.gap.friction));
                }
            }
            last = Some((obstacle, e));
        }
        let finish = |(mut r, range, mu): (ContactReport, [usize; 2], f64)| {
            let wrap = self.wrap(range, mu);
            r.turn_deg = wrap.turn.to_degrees();
            let at = self.chain.s.partition_point(|&s| s <= r.arc_length_m).clamp(1, self.chain.x.len() - 1) - 1;
            let p = self.chain.x[at]
                + (self.chain.x[at + 1] - self.chain.x[at])
                    * ((r.arc_length_m - self.chain.s[at]) / self.chain.span[at]);
            (r.x_m, r.y_m) = (p.x, p.y);
            [r.begins_m, r.ends_m] = range.map(|i| self.chain.s.get(i).copied().unwrap_or(r.arc_length_m));
            (r, wrap.uncertain)
        };
        out.into_iter().map(finish).collect()
    }

    /// Direction of growing arc length along ground with a normal, at an element.
    fn along_ground(&self, e: usize, n: Vec2) -> Vec2 {
        let along = -perp(n);
        if along.dot(&(self.chain.x[e + 1] - self.chain.x[e])) < 0.0 { -along } else { along }
    }

    fn add(&self, r: &mut ContactReport, t: &Touch, h: f64) {
        let e = t.element;
        let at = self.chain.s[e] + self.chain.span[e] * t.gap.fraction;
        // The middle, weighted by force.
        let n = t.gap.normal;
        let force = (n * t.normal + self.along_ground(e, n) * t.friction) / h;
        r.force_n = [r.force_n[0] + force.x, r.force_n[1] + force.y];
        r.samples.push(ContactSample::new(at, force));
        let before = r.normal_n;
        r.normal_n += t.normal / h;
        r.arc_length_m = (r.arc_length_m * before + at * (t.normal / h)) / r.normal_n;
        r.friction_n += t.friction / h;
        r.normal = [t.gap.normal.x, t.gap.normal.y];
        r.tension_after_n = self.chain.tension[(e + 1).min(self.chain.tension.len() - 1)];
        if t.slips || before == 0.0 {
            r.state = if t.slips { ContactState::Slip } else { ContactState::Stick };
        }
    }
}

/// Ground under a held end.
struct Under {
    gap: Gap,
    /// Normal force, N.
    pressed: f64,
    /// On the cable, friction with it, N.
    force: Vec2,
}
