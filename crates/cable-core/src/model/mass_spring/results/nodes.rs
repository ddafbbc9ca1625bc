//! This module computes positions, tensions and internal forces at the nodes, and the forces on
//! supports.

use crate::energy::bending::turn;
use crate::math::{Vec2, angle, larger, perp};
use crate::model::arc_nodes;
use crate::model::hand::Hand;
use crate::model::mass_spring::forces::{bending, nodal, reactions, tension};
use crate::model::mass_spring::mesh::{Mesh, Pulley};
use crate::solution::{Node, SupportReaction};

/// Distance within which a load is at a node, as a fraction of the cable's length: round-off.
/// Smaller: its jump of tension is averaged away; larger: nodes beside it count as loaded.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// Relative difference of the tensions on both sides of a point up to which they make one node.
const TENSION_JUMP_TOLERANCE: f64 = 1e-9;

/// A side of a pulley.
#[derive(Clone, Copy)]
enum StrandSide {
    Before,
    Beyond,
}

/// Reads nodes and reactions from a mesh at a time.
#[derive(Clone, Copy)]
pub(in crate::model::mass_spring) struct NodeReader<'a> {
    pub mesh: &'a Mesh,
    pub time_s: f64,
}

impl NodeReader<'_> {
    /// The nodes; a pulley has two, where the cable arrives and leaves, and a wheel some more
    /// between them.
    pub(in crate::model::mass_spring) fn nodes(&self) -> Vec<Node> {
        let mut out = Vec::with_capacity(self.mesh.position.len() + 2 * self.mesh.wheels.pulleys.len());
        for i in 0..self.mesh.position.len() {
            match self.mesh.wheels.at(i) {
                None => out.push(self.node(i)),
                Some(p) => self.wheel_nodes(*p, &mut out),
            }
        }
        out
    }

    /// Internal force at the end of element `e` on a wheel, N: the force in its middle and the load
    /// from there to the end, which lies `arc` (m) on the wheel.
    fn beside_pulley(&self, e: usize, side: StrandSide, arc: f64) -> Vec2 {
        let path = self.mesh.material_length[e] - 0.5 * self.mesh.straight_length[e] - arc / self.mesh.thermal_stretch;
        let sign = match side {
            StrandSide::Before => -1.0,
            StrandSide::Beyond => 1.0,
        };
        self.element_force(e) + self.mesh.problem.body_force(self.time_s) * (sign * path)
    }

    /// Adds the nodes on a wheel: the tension grows exponentially from one end of the arc to the
    /// other.
    fn wheel_nodes(&self, p: Pulley, out: &mut Vec<Node>) {
        let [s0, s1] = p.material_on_wheel(&self.mesh.arc_length, self.mesh.thermal_stretch);
        let (b, a) = (self.mesh.element(p.node - 1), self.mesh.element(p.node));
        let jump = (p.tension[1] - p.tension[0]).abs() > TENSION_JUMP_TOLERANCE * p.tension[0];
        let count = arc_nodes::parts(p.radius, p.turn, self.mesh.problem.radius);
        let by_branches = self.branch_tension(p.node);
        let strain = |f: f64| (p.tension_at(f) - by_branches) / self.mesh.problem.axial_stiffness;
        let material = arc_nodes::material(count, strain);
        for k in usize::from(p.radius == 0.0 && !jump)..=count {
            let share = k.checked_sub(1).and_then(|k| material.get(k)).copied().unwrap_or(0.0);
            let f = k as f64 / count as f64;
            let (along, tension_n) = (p.radius * p.turn * f, p.tension_at(f));
            let angle = p.mark_angle + p.sense * (p.arc[0] - along) / p.radius;
            let (sin, cos) = angle.sin_cos();
            let t = match (p.radius > 0.0, k == count) {
                (true, _) => Vec2::new(cos, sin),
                (false, true) => a.direction,
                (false, false) => b.direction,
            };
            let at = if p.radius > 0.0 {
                self.mesh.position[p.node] + perp(t) * (p.sense * p.radius)
            } else {
                self.mesh.position[p.node]
            };
            let v = self.mesh.velocity[p.node]
                - if k == 0 {
                    b.direction
                } else if k == count {
                    a.direction
                } else {
                    t
                } * p.sliding_speed;
            out.push(Node {
                arc_length_m: s0 + (s1 - s0) * share,
                x_m: at.x,
                y_m: at.y,
                vx_m_per_s: v.x,
                vy_m_per_s: v.y,
                tension_n,
                strain: strain(f),
                stress_pa: tension_n / self.mesh.problem.cable.area_m2(),
                curvature_per_m: if p.radius > 0.0 { -p.sense / p.radius } else { 0.0 },
                force_n: match k {
                    0 => self.beside_pulley(p.node - 1, StrandSide::Before, p.arc[0]),
                    k if k == count => self.beside_pulley(p.node, StrandSide::Beyond, p.arc[1]),
                    _ => t * tension_n,
                }
                .into(),
                ..Node::default()
            });
        }
    }

    /// Tension at a node: inside, the mean of its elements' force vectors, and the larger of those
    /// just before and just beyond it where a support or a point load acts; at an end, the force
    /// there, half an element's weight and inertia beyond the middle of the last element.
    fn node(&self, i: usize) -> Node {
        let direction = |e: usize| self.mesh.element(e).direction;
        // A stiff cable may be compressed.
        let is_stiff = self.mesh.bending_stiffness > 0.0;
        let signed = |force: Vec2, along: Vec2| match along.try_normalize(0.0).filter(|_| is_stiff) {
            Some(along) => force.dot(&along),
            None => force.norm(),
        };
        let tension_n = match (i.checked_sub(1), i < self.mesh.rest_length.len()) {
            (Some(e), true) if self.bears_point_force(i) => {
                let load = self.mesh.problem.body_force(self.time_s);
                let half = |e: usize| load * (0.5 * self.mesh.straight_length[e]);
                let [before, beyond] = [e, i].map(|e| nodal::spring_force(self.mesh, e));
                larger(signed(before - half(e), direction(e)), signed(beyond + half(i), direction(i)))
            }
            (Some(e), true) => {
                let force = (nodal::spring_force(self.mesh, e) + nodal::spring_force(self.mesh, i)) * 0.5;
                signed(force, direction(e) + direction(i))
            }
            _ if self.mesh.supported[i] => self.end_tension(i),
            (Some(e), false) => self.free_end_tension(i, e),
            (None, _) => self.free_end_tension(i, 0),
        };
        let curvature_per_m = self.node_curvature(i);
        Node {
            arc_length_m: self.mesh.arc_length[i],
            x_m: self.mesh.position[i].x,
            y_m: self.mesh.position[i].y,
            vx_m_per_s: self.mesh.velocity[i].x,
            vy_m_per_s: self.mesh.velocity[i].y,
            tension_n,
            strain: (tension_n - self.branch_tension(i)) / self.mesh.problem.axial_stiffness,
            stress_pa: tension_n / self.mesh.problem.cable.area_m2(),
            curvature_per_m,
            force_n: self.internal_force(i).into(),
            ..Node::default()
        }
    }

    /// Tension that relaxation branches add to that of the strain at a node, N: the mean of the
    /// springs beside it.
    fn branch_tension(&self, i: usize) -> f64 {
        let beside = i.saturating_sub(1)..(i + 1).min(self.mesh.tension.len());
        let count = beside.len() as f64;
        let of = |e: usize| if self.mesh.tension[e] > 0.0 { self.mesh.spring_memory.branch_force(e) } else { 0.0 };
        beside.map(of).sum::<f64>() / count
    }

    /// True if a support or a point load acts on a node.
    fn bears_point_force(&self, i: usize) -> bool {
        let here = |s: f64| (s - self.mesh.arc_length[i]).abs() <= SAME_POINT_FRACTION * self.mesh.problem.length;
        self.mesh.support_node.contains(&i) || self.mesh.problem.loads.iter().any(|l| here(l.arc_length))
    }

    /// Internal force just beyond a node, at the end of the cable just before it, N: that in the
    /// middle of the element and half of its load.
    fn internal_force(&self, i: usize) -> Vec2 {
        match (i, i < self.mesh.rest_length.len()) {
            (0, _) => self.end_force(i),
            (_, true) => {
                self.element_force(i) + self.mesh.problem.body_force(self.time_s) * (0.5 * self.mesh.straight_length[i])
            }
            (_, false) => -self.end_force(i),
        }
    }

    /// Force of the cable on the support or load at an end, N.
    fn end_force(&self, i: usize) -> Vec2 {
        match self.mesh.support_node.iter().position(|&n| n == i) {
            Some(k) if !self.mesh.supported[i] => -self.mesh.problem.hung_on(k, self.time_s),
            _ => reactions::of_support(self.mesh, i),
        }
    }

    /// Force in the middle of an element, with its shear, N.
    fn element_force(&self, e: usize) -> Vec2 {
        let pull = nodal::spring_force(self.mesh, e);
        let d = self.mesh.position[e + 1] - self.mesh.position[e];
        if !(self.mesh.bending_stiffness > 0.0 && d.norm_squared() > 0.0) {
            return pull;
        }
        let stiffness = self.mesh.bending_stiffness / self.mesh.thermal_stretch;
        let moment = |i: usize| stiffness * self.node_curvature(i) + self.branch_moment(i, e);
        pull + perp(d) * ((moment(e) - moment(e + 1)) / d.norm_squared())
    }

    /// Moment in the relaxation branches of the bend at a node, on the side of element `e`, N·m.
    fn branch_moment(&self, i: usize, e: usize) -> f64 {
        let clamped = bending::clamp_at(self.mesh, i).is_some();
        let slot = if clamped && e == i { 2 * i + 1 } else { 2 * i };
        self.mesh.bend_memory.branch_force(slot)
    }

    fn node_curvature(&self, i: usize) -> f64 {
        match (i.checked_sub(1), self.mesh.position.get(i + 1)) {
            (Some(e), Some(next)) => {
                let (a, b) = (self.mesh.position[i] - self.mesh.position[e], next - self.mesh.position[i]);
                angle(a, b) / (0.5 * (self.mesh.material_length[e] + self.mesh.material_length[i]))
            }
            (None, Some(next)) => self.clamp_curvature(i, 0, *next - self.mesh.position[i]),
            (Some(e), None) => -self.clamp_curvature(i, e, self.mesh.position[i] - self.mesh.position[e]),
            (None, None) => 0.0,
        }
    }

    /// Tension at a held end: the whole force of a flexible cable, without the shear of a stiff
    /// one.
    fn end_tension(&self, i: usize) -> f64 {
        let force = reactions::of_support(self.mesh, i);
        if !(self.mesh.bending_stiffness > 0.0) {
            return force.norm();
        }
        let along = bending::clamp_at(self.mesh, i)
            .unwrap_or_else(|| self.mesh.element(i.min(self.mesh.rest_length.len() - 1)).direction);
        tension::along_end(i, force, along)
    }

    /// Tension just inside a free end: the load there; with a point mass, whose inertia pulls as
    /// well, the tension of its element `e`.
    fn free_end_tension(&self, i: usize, e: usize) -> f64 {
        let support =
            self.mesh.support_node.iter().position(|&n| n == i).filter(|&k| self.mesh.problem.supports[k].mass == 0.0);
        let tension = self.mesh.tension.get(e).copied().unwrap_or(0.0);
        let along = |force: Vec2| match self.mesh.bending_stiffness > 0.0 {
            true => tension::along_end(i, -force, self.mesh.element(e).direction),
            false => force.norm(),
        };
        let hung = support.map_or(tension, |k| along(self.mesh.problem.hung_on(k, self.time_s)));
        // On the ground a part of the load presses there.
        if self.mesh.problem.world.signed_gap(self.mesh.position[i], self.mesh.tuning.impact.skin_m).is_some()
            && hung > tension
        {
            tension
        } else {
            hung
        }
    }

    /// Curvature between a clamp at an end and the middle of its element `e`, which has the
    /// direction `d`; 0 without a clamp.
    fn clamp_curvature(&self, i: usize, e: usize, d: Vec2) -> f64 {
        let clamp = bending::clamp_at(self.mesh, i).filter(|_| self.mesh.bending_stiffness > 0.0);
        clamp.map_or(0.0, |c| turn(c, d) / (0.5 * self.mesh.material_length[e]))
    }

    /// Force of the cable on support `k`, which a `hand` may drag.
    pub(in crate::model::mass_spring) fn reaction(&self, k: usize, hand: Option<Hand>) -> SupportReaction {
        let i = self.mesh.support_node[k];
        let pulley = self.mesh.wheels.at(i);
        let force = if self.mesh.supported[i] {
            reactions::of_support(self.mesh, i)
        } else {
            // The reaction of a dead load is minus the load.
            -self.mesh.problem.hung_on(k, self.time_s)
        };
        SupportReaction {
            name: self.mesh.problem.supports[k].name.clone(),
            x_m: self.mesh.position[i].x,
            y_m: self.mesh.position[i].y,
            reaction_x_n: force.x,
            reaction_y_n: force.y,
            arc_length_m: pulley.map_or(self.mesh.arc_length[i], |p| {
                p.material_on_wheel(&self.mesh.arc_length, self.mesh.thermal_stretch).iter().sum::<f64>() * 0.5
            }),
            tension_before_n: pulley.map(|p| p.tension[0]),
            tension_after_n: pulley.map(|p| p.tension[1]),
            hand: hand.map(|hand| hand.report(-force)),
        }
    }
}
