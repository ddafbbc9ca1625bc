//! A pulley is a node fixed in space whose material slides through it.
//!
//! The node holds the centre x of the wheel and the material coordinate σ at a *mark* fixed on the
//! wheel. The elements beside it run to where they touch the wheel and on along the arc to the
//! mark. With R the radius of the centre line, f its sense (+1 clockwise), θ the angle of the free
//! part and θₘ that of the tangent at the mark:
//!
//! ```text
//! d = L t + i(R₁f₁ − R₂f₂) t   (complex)   ⇒   t = (L d + ρ perp d)/|d|²,   ρ = R₂f₂ − R₁f₁,   L = √(d² − ρ²)
//! length = L + R₁f₁ (θₘ₁ − θ) + R₂f₂ (θ − θₘ₂),      ∂length/∂(ends) = ∓t
//! ```
//!
//! so an element is a spring of that length with rest length λ(s₂ − s₁), whatever it winds round,
//! and the energy is exact. The material obeys ṡ = u with the mass of the half elements beside it
//! and of the arc, m u̇ = λ(Θ_b − Θ_a) + q·(c_b − c_a) + friction, Θ = T + T²/2EA, c the middle of
//! the straight part; friction holds within the capstan's cone |T_b − T_a| ≤ tanh(μφ/2)(T_b + T_a),
//! taken where the cable touches the wheel. Material sliding through a fixed point in space is
//! after S. Sueda, G. L. Jones, D. I. W. Levin, D. K. Pai, "Large-scale dynamic simulation of
//! highly constrained strands", ACM Transactions on Graphics 30 (2011); they share masses
//! consistently, here they are lumped.

use crate::math::{Vec2, cross, perp};
use crate::model::mass_spring::MassSpringModel;
use crate::problem::Problem;
use crate::scene::{PulleySide, SupportKind};

/// Tension over the weight of half an element below which the direction of the force there says
/// nothing.
const DIRECTION_TENSION_RATIO: f64 = 4.0;

part! {
    /// The pulleys.
    Wheels {
        /// In order along the cable.
        pulleys: Vec<Pulley>,
        /// Index of the pulley at each node, if there is one.
        pulley_at: Vec<Option<usize>>,
    }
}

/// One pulley.
#[derive(Clone, Copy, Debug)]
pub(in crate::model::mass_spring) struct Pulley {
    /// Index of its support.
    pub support: usize,
    /// Its node.
    pub node: usize,
    /// Radius of the cable's centre line, m; 0 = a point.
    pub radius: f64,
    /// Coulomb friction.
    pub friction: f64,
    /// +1 where the cable runs clockwise, −1 the other way.
    pub facing: f64,
    /// Angle of the cable's direction at the mark, rad.
    pub mark: f64,
    /// σ̇, m/s: positive takes material from behind (greater arc length).
    pub rate: f64,
    /// Generalised force on σ but for friction, N.
    pub drive: f64,
    /// What slides: half of the free parts beside it and the arc, kg.
    pub mass: f64,
    /// Tension where the cable arrives and leaves, N.
    pub tension: [f64; 2],
    /// How far the cable turns, rad.
    pub turn: f64,
    /// Arc before and after the mark, m.
    pub arc: [f64; 2],
    /// σ from which friction is measured at rest, m, and the most it holds there, N.
    pub anchor: f64,
    pub hold: f64,
}

/// An element as it lies.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct Reach {
    /// Ends of the straight part, m.
    pub start: Vec2,
    pub end: Vec2,
    /// Its direction.
    pub direction: Vec2,
    /// Its length, m.
    pub free: f64,
    /// Length with the arcs to the marks, m.
    pub length: f64,
    /// Arc at the end and at the start, m.
    pub arc: [f64; 2],
    /// Middle of the straight part, m.
    pub middle: Vec2,
    /// Moment of the arcs, their length times their centroid, m².
    pub hung: Vec2,
}

/// An angle in (−π, π].
pub(in crate::model::mass_spring) fn wrap(angle: f64) -> f64 {
    let tau = std::f64::consts::TAU;
    angle - tau * (angle / tau).round()
}

pub(in crate::model::mass_spring) fn angle_of(v: Vec2) -> f64 {
    v.y.atan2(v.x)
}

impl Pulley {
    /// The pulleys of a cable, at its first node until [`Self::sit`]; `way` gives the direction in
    /// which the cable comes and goes.
    pub(in crate::model::mass_spring) fn all(p: &Problem) -> Vec<Self> {
        let at = |k: usize| p.supports.get(k).and_then(|s| s.position_at(0.0)).map(|a| a.0);
        let down = p.body_force(0.0).try_normalize(0.0).unwrap_or(Vec2::new(0.0, -1.0));
        (0..p.supports.len())
            .filter(|&k| p.supports[k].kind == SupportKind::Pulley)
            .filter_map(|k| {
                let (s, here) = (&p.supports[k], at(k)?);
                let before = (0..k).rev().find_map(at).map_or(-down, |b| here - b);
                let after = (k + 1..p.supports.len()).find_map(at).map_or(down, |a| a - here);
                let right = if (before + after).x < 0.0 { -1.0 } else { 1.0 };
                let facing = if s.side == PulleySide::Over { right } else { -right };
                let bend = wrap(angle_of(before) - angle_of(after));
                let bend = if facing * bend < -0.5 * std::f64::consts::PI {
                    bend + facing * std::f64::consts::TAU
                } else {
                    bend
                };
                Some(Self {
                    support: k,
                    node: 0,
                    radius: s.wheel_radius,
                    friction: s.friction,
                    facing,
                    mark: angle_of(before) - 0.5 * bend,
                    rate: 0.0,
                    drive: 0.0,
                    mass: 0.0,
                    tension: [0.0; 2],
                    turn: 0.0,
                    arc: [0.0; 2],
                    anchor: 0.0,
                    hold: 0.0,
                })
            })
            .collect()
    }

    /// Centroid of the arc between the mark and where the cable has the direction `angle`, round
    /// `center`.
    fn middle_of_arc(&self, center: Vec2, angle: f64) -> Vec2 {
        let half = 0.5 * wrap(angle - self.mark);
        let (sin, cos) = (self.mark + half).sin_cos();
        let flat = if half == 0.0 { 1.0 } else { half.sin() / half };
        center + Vec2::new(-sin, cos) * (self.facing * self.radius * flat)
    }

    /// Puts it on a node, whose arc length (m) friction at rest is measured from.
    pub(in crate::model::mass_spring) fn sit(&mut self, node: usize, arc_length: f64) {
        (self.node, self.anchor) = (node, arc_length);
    }

    /// Greatest |T_b − T_a| over T_b + T_a that friction holds.
    pub(in crate::model::mass_spring) fn grip(&self) -> f64 {
        (0.5 * self.friction * self.turn.abs()).tanh()
    }
}

impl MassSpringModel {
    pub(in crate::model::mass_spring) fn pulley_of(&self, node: usize) -> Option<&Pulley> {
        self.wheels.pulley_at.get(node).copied().flatten().and_then(|k| self.wheels.pulleys.get(k))
    }

    /// Returns how element `e` lies at positions `x`.
    pub(in crate::model::mass_spring) fn reach_at(&self, e: usize, x: &[Vec2]) -> Reach {
        let (a, b) = (x[e], x[e + 1]);
        let wheel = |node: usize| self.pulley_of(node).filter(|p| p.radius > 0.0);
        let (first, second) = (wheel(e), wheel(e + 1));
        let d = b - a;
        if first.is_none() && second.is_none() {
            let length = d.norm();
            let direction = if length > 0.0 { d / length } else { Vec2::zeros() };
            let middle = (a + b) * 0.5;
            return Reach { start: a, end: b, direction, free: length, length, middle, ..Reach::default() };
        }
        let bent = |p: Option<&Pulley>| p.map_or(0.0, |p| p.radius * p.facing);
        let (r1, r2) = (bent(first), bent(second));
        let (rho, square) = (r2 - r1, d.norm_squared());
        let left = square - rho * rho;
        let free = if left > 0.0 { left.sqrt() } else { 0.0 };
        let direction = ((d * free + perp(d) * rho) / square).try_normalize(0.0).unwrap_or_default();
        let angle = angle_of(direction);
        let arcs =
            [second.map_or(0.0, |p| r2 * wrap(angle - p.mark)), first.map_or(0.0, |p| r1 * wrap(p.mark - angle))];
        let n = perp(direction);
        let (start, end, length) = (a + n * r1, b + n * r2, free + arcs[0] + arcs[1]);
        let hung = second.map_or_else(Vec2::zeros, |p| p.middle_of_arc(b, angle) * arcs[0])
            + first.map_or_else(Vec2::zeros, |p| p.middle_of_arc(a, angle) * arcs[1]);
        Reach { start, end, direction, free, length, arc: arcs, middle: (start + end) * 0.5, hung }
    }

    /// Returns how element `e` lies now.
    pub(in crate::model::mass_spring) fn reach(&self, e: usize) -> Reach {
        self.reach_at(e, &self.chain.x)
    }

    /// Returns whether an end of the element is on a pulley.
    pub(in crate::model::mass_spring) fn at_pulley(&self, e: usize) -> bool {
        self.wheels.pulley_at[e].is_some() || self.wheels.pulley_at[e + 1].is_some()
    }

    /// Returns whether an end of the element is on a wheel with a radius.
    pub(in crate::model::mass_spring) fn on_wheel(&self, e: usize) -> bool {
        [e, e + 1].iter().any(|&n| self.pulley_of(n).is_some_and(|p| p.radius > 0.0))
    }

    /// Spans, rest lengths and masses of what lies beside pulleys, after σ or the wheels moved.
    pub(in crate::model::mass_spring) fn weigh(&mut self) {
        let x = std::mem::take(&mut self.chain.x);
        self.weigh_at(&x);
        self.chain.x = x;
    }

    /// The same with the nodes at `x`.
    pub(in crate::model::mass_spring) fn weigh_at(&mut self, x: &[Vec2]) {
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            for e in [i - 1, i] {
                self.chain.span[e] = self.chain.s[e + 1] - self.chain.s[e];
                self.chain.rest[e] = self.chain.span[e] * self.problem.thermal_stretch;
            }
        }
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            for e in [i - 1, i] {
                let r = self.reach_at(e, x);
                // What lies on a wheel is taken as if unstretched: σ then moves the straight part
                // alone.
                self.chain.share[e] = self.chain.span[e] - (r.arc[0] + r.arc[1]) / self.problem.thermal_stretch;
            }
        }
        let density = self.problem.linear_density;
        for k in 0..self.wheels.pulleys.len() {
            let i = self.wheels.pulleys[k].node;
            for n in [i - 1, i, i + 1] {
                self.chain.mass[n] = density * self.half_share(n) + self.chain.lump[n];
            }
            let whole = self.chain.span[i - 1] + self.chain.span[i];
            let on_wheel = whole - self.chain.share[i - 1] - self.chain.share[i];
            self.chain.mass[i] += density * on_wheel;
            self.wheels.pulleys[k].mass = density * (self.half_share(i) + on_wheel);
        }
    }

    /// Half of the free parts beside a node, m of arc length.
    pub(in crate::model::mass_spring) fn half_share(&self, n: usize) -> f64 {
        let before = if n > 0 { self.chain.share[n - 1] } else { 0.0 };
        0.5 * (before + self.chain.share.get(n).copied().unwrap_or(0.0))
    }

    /// Tensions beside pulley `k`, its turn, and the force on its material at positions `x`.
    /// `tension` is of each element.
    pub(in crate::model::mass_spring) fn load_pulley(&mut self, k: usize, body: Vec2) {
        let i = self.wheels.pulleys[k].node;
        let (b, a) = (self.reach(i - 1), self.reach(i));
        let (tb, ta) = (self.chain.tension[i - 1], self.chain.tension[i]);
        // Half a free part's weight lies between the middle of an element and the wheel: that also
        // turns the cable a little, and moves where it touches.
        let touch = |r: &Reach, tension: f64, half: Vec2| {
            let force = r.direction * tension + half;
            let size = force.norm();
            (size, if size > DIRECTION_TENSION_RATIO * half.norm() { force / size } else { r.direction })
        };
        let (before, from) = touch(&b, tb, body * (-0.5 * self.chain.share[i - 1]));
        let (after, to) = touch(&a, ta, body * (0.5 * self.chain.share[i]));
        let center = self.chain.x[i];
        let p = &mut self.wheels.pulleys[k];
        if p.radius > 0.0 {
            p.arc = [wrap(angle_of(from) - p.mark), wrap(p.mark - angle_of(to))].map(|a| a * p.facing * p.radius);
            let at = |t: Vec2| center + perp(t) * (p.facing * p.radius);
            p.tension = [before - body.dot(&(at(from) - b.end)), after - body.dot(&(at(to) - a.start))];
            p.turn = (p.arc[0] + p.arc[1]) / p.radius;
        } else {
            p.tension = [before, after];
            p.turn = cross(from, to).atan2(from.dot(&to));
        }
        let ea = self.problem.axial_stiffness;
        let theta = |t: f64| t * (1.0 + 0.5 * t / ea);
        p.drive = self.problem.thermal_stretch * (theta(tb) - theta(ta)) + body.dot(&(b.middle - a.middle));
    }

    /// The sliding of one sub-step of `h`, pushed for a time `kick` (s): friction stops it within
    /// the capstan's cone.
    pub(in crate::model::mass_spring) fn slide(&mut self, [kick, h]: [f64; 2]) {
        let (least, thermal) = (self.least_span(), self.problem.thermal_stretch);
        for k in 0..self.wheels.pulleys.len() {
            let p = &mut self.wheels.pulleys[k];
            let push = p.rate + p.drive * kick / p.mass;
            let most = thermal * p.grip() * (p.tension[0] + p.tension[1]) * kick / p.mass;
            p.rate = if push.abs() <= most { 0.0 } else { push - most * push.signum() };
            // What is joined to the cable does not run through.
            let (i, rate) = (p.node, p.rate);
            let blocked = rate < 0.0 && self.chain.share[i - 1] < least || rate > 0.0 && self.chain.share[i] < least;
            if blocked {
                self.wheels.pulleys[k].rate = 0.0;
            }
            self.carry(k, self.wheels.pulleys[k].rate * h);
        }
        if !self.wheels.pulleys.is_empty() {
            self.weigh();
        }
    }

    /// Material `ds` comes to the side before the pulley: the nodes that get it take its momentum
    /// with it.
    fn carry(&mut self, k: usize, ds: f64) {
        let (i, u) = (self.wheels.pulleys[k].node, self.wheels.pulleys[k].rate);
        self.chain.s[i] += ds;
        let gained = 0.5 * self.problem.linear_density * ds.abs();
        let (node, e) = if ds > 0.0 { (i - 1, i - 1) } else { (i + 1, i) };
        let direction = self.reach(e).direction;
        let arriving = (self.chain.v[node] + self.chain.v[i] - direction * u) * 0.5;
        if !self.drives.held[node] {
            let m = self.chain.mass[node];
            self.chain.v[node] = (self.chain.v[node] * m + arriving * gained) / (m + gained);
        }
    }
}
