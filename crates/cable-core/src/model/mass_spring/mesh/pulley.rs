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
//! so an element is a spring of that length with rest length λ(s₂ − s₁), even if it winds round
//! wheels, and the energy is exact. The material obeys ṡ = u with the mass of the half elements
//! beside it and of the arc, m u̇ = λ(Θ_b − Θ_a) + q·(c_b − c_a) + friction, Θ = T + T²/2EA, c the
//! middle of the straight part; friction holds within the capstan's cone |T_b − T_a| ≤
//! tanh(μφ/2)(T_b + T_a), taken where the cable touches the wheel. Material sliding through a fixed
//! point in space is after S. Sueda, G. L. Jones, D. I. W. Levin, D. K. Pai, "Large-scale dynamic
//! simulation of highly constrained strands", ACM Transactions on Graphics 30 (2011); they share
//! masses consistently, here they are lumped.

use crate::math::{Vec2, perp};
use crate::problem::Problem;
use crate::problem::wheel_passage::{facing, turn_through_centre};
use crate::scene::SupportKind;

part! {
    /// The pulleys that the cable runs over.
    #[derive(Default)]
    Wheels {
        /// The pulleys, in order along the cable.
        pulleys: Vec<Pulley>,
        /// Index of the pulley at each node, if there is one.
        at_node: Vec<Option<usize>>,
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
    pub sense: f64,
    /// Angle of the cable's direction at the mark, rad.
    pub mark_angle: f64,
    /// σ̇, m/s: a positive speed takes material from behind (greater arc length).
    pub sliding_speed: f64,
    /// Generalised force on σ but for friction, N.
    pub sliding_force: f64,
    /// Mass that slides, of half of the straight parts beside the wheel and of the arc, kg.
    pub mass: f64,
    /// Tension where the cable arrives and leaves, N.
    pub tension: [f64; 2],
    /// Turn of the cable, rad.
    pub turn: f64,
    /// Arc before and after the mark, m.
    pub arc: [f64; 2],
    /// σ from which friction is measured at rest, m.
    pub anchor: f64,
    /// Greatest force that friction holds there, N.
    pub friction_limit: f64,
}

/// Geometry of an element: its straight part and the arcs on the wheels at its ends.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::model::mass_spring) struct ElementGeometry {
    /// Ends of the straight part, m.
    pub start: Vec2,
    pub end: Vec2,
    /// Its direction.
    pub direction: Vec2,
    /// Its length, m.
    pub straight: f64,
    /// Length with the arcs to the marks, m.
    pub length: f64,
    /// Arc at the end and at the start, m.
    pub arc: [f64; 2],
    /// Middle of the straight part, m.
    pub middle: Vec2,
    /// Moment of the arcs, their length times their centroid, m².
    pub arc_moment: Vec2,
}

/// An angle in (−π, π].
pub(in crate::model::mass_spring) fn principal_angle(angle: f64) -> f64 {
    let tau = std::f64::consts::TAU;
    angle - tau * (angle / tau).round()
}

pub(in crate::model::mass_spring) fn angle_of(v: Vec2) -> f64 {
    v.y.atan2(v.x)
}

impl Pulley {
    /// The pulleys of a cable, at its first node until [`Self::place_on`].
    pub(in crate::model::mass_spring) fn all(p: &Problem) -> Vec<Self> {
        let at = |k: usize| p.supports.get(k).and_then(|s| s.position_at(0.0)).map(|a| a.0);
        let down = p.body_force(0.0).try_normalize(0.0).unwrap_or(Vec2::new(0.0, -1.0));
        (0..p.supports.len())
            .filter(|&k| p.supports[k].kind == SupportKind::Pulley)
            .filter_map(|k| {
                let (s, here) = (&p.supports[k], at(k)?);
                let before = (0..k).rev().find_map(at).map_or(-down, |b| here - b);
                let after = (k + 1..p.supports.len()).find_map(at).map_or(down, |a| a - here);
                let sense = facing(s.side, before + after);
                let bend = sense * turn_through_centre(sense, before, after);
                Some(Self {
                    support: k,
                    node: 0,
                    radius: s.wheel_radius,
                    friction: s.friction,
                    sense,
                    mark_angle: angle_of(before) - 0.5 * bend,
                    sliding_speed: 0.0,
                    sliding_force: 0.0,
                    mass: 0.0,
                    tension: [0.0; 2],
                    turn: 0.0,
                    arc: [0.0; 2],
                    anchor: 0.0,
                    friction_limit: 0.0,
                })
            })
            .collect()
    }

    /// Centroid of the arc between the mark and where the cable has the direction `angle`, round
    /// `center`.
    fn middle_of_arc(&self, center: Vec2, angle: f64) -> Vec2 {
        let half = 0.5 * principal_angle(angle - self.mark_angle);
        let (sin, cos) = (self.mark_angle + half).sin_cos();
        let flat = if half == 0.0 { 1.0 } else { half.sin() / half };
        center + Vec2::new(-sin, cos) * (self.sense * self.radius * flat)
    }

    /// Puts the pulley on a node, from whose arc length (m) friction at rest is measured.
    pub(in crate::model::mass_spring) fn place_on(&mut self, node: usize, arc_length: f64) {
        (self.node, self.anchor) = (node, arc_length);
    }

    /// Material where the cable arrives at the wheel and leaves it, m, with the `nodes` at these
    /// arc lengths (m).
    pub(in crate::model::mass_spring) fn material_on_wheel(&self, nodes: &[f64], thermal_stretch: f64) -> [f64; 2] {
        let s = nodes[self.node];
        [s - self.arc[0] / thermal_stretch, s + self.arc[1] / thermal_stretch]
    }

    /// Tension at a fraction of the arc, N.
    pub(in crate::model::mass_spring) fn tension_at(&self, fraction: f64) -> f64 {
        let [before, after] = self.tension;
        if before > 0.0 && after > 0.0 {
            before * (after / before).powf(fraction)
        } else {
            before + (after - before) * fraction
        }
    }

    /// Greatest ratio of |T_b − T_a| to T_b + T_a that friction holds.
    pub(in crate::model::mass_spring) fn friction_ratio(&self) -> f64 {
        (0.5 * self.friction * self.turn.abs()).tanh()
    }
}

impl Wheels {
    /// Pulleys at their nodes, of a chain of `nodes` nodes.
    pub(in crate::model::mass_spring) fn new(pulleys: Vec<Pulley>, nodes: usize) -> Self {
        let mut wheels = Self { pulleys, at_node: vec![None; nodes] };
        wheels.index();
        wheels
    }

    /// Rebuilds the index of pulleys by node.
    pub(in crate::model::mass_spring) fn index(&mut self) {
        self.at_node.fill(None);
        for (k, p) in self.pulleys.iter().enumerate() {
            self.at_node[p.node] = Some(k);
        }
    }

    /// The pulley at a node.
    pub(in crate::model::mass_spring) fn at(&self, node: usize) -> Option<&Pulley> {
        self.at_node.get(node).copied().flatten().and_then(|k| self.pulleys.get(k))
    }

    /// True if an end of element `e` is on a pulley.
    pub(in crate::model::mass_spring) fn is_beside(&self, e: usize) -> bool {
        self.at_node[e].is_some() || self.at_node[e + 1].is_some()
    }

    /// True if an end of element `e` is on a wheel with a radius.
    pub(in crate::model::mass_spring) fn is_on_wheel(&self, e: usize) -> bool {
        [e, e + 1].iter().any(|&n| self.at(n).is_some_and(|p| p.radius > 0.0))
    }

    /// Geometry of element `e` with the nodes at `x` (m).
    pub(in crate::model::mass_spring) fn element(&self, e: usize, x: &[Vec2]) -> ElementGeometry {
        let (a, b) = (x[e], x[e + 1]);
        let wheel = |node: usize| self.at(node).filter(|p| p.radius > 0.0);
        let (first, second) = (wheel(e), wheel(e + 1));
        let d = b - a;
        if first.is_none() && second.is_none() {
            let length = d.norm();
            let direction = if length > 0.0 { d / length } else { Vec2::zeros() };
            let middle = (a + b) * 0.5;
            return ElementGeometry {
                start: a,
                end: b,
                direction,
                straight: length,
                length,
                middle,
                ..ElementGeometry::default()
            };
        }
        let bent = |p: Option<&Pulley>| p.map_or(0.0, |p| p.radius * p.sense);
        let (r1, r2) = (bent(first), bent(second));
        let (rho, square) = (r2 - r1, d.norm_squared());
        let left = square - rho * rho;
        let straight = if left > 0.0 { left.sqrt() } else { 0.0 };
        let direction = ((d * straight + perp(d) * rho) / square).try_normalize(0.0).unwrap_or_default();
        let angle = angle_of(direction);
        let arc = [
            second.map_or(0.0, |p| r2 * principal_angle(angle - p.mark_angle)),
            first.map_or(0.0, |p| r1 * principal_angle(p.mark_angle - angle)),
        ];
        let n = perp(direction);
        let (start, end, length) = (a + n * r1, b + n * r2, straight + arc[0] + arc[1]);
        let arc_moment = second.map_or_else(Vec2::zeros, |p| p.middle_of_arc(b, angle) * arc[0])
            + first.map_or_else(Vec2::zeros, |p| p.middle_of_arc(a, angle) * arc[1]);
        ElementGeometry { start, end, direction, straight, length, arc, middle: (start + end) * 0.5, arc_moment }
    }
}
