//! This module derives the quantities that the laws need of a cable from its scene and its answer
//! alone.

use super::support_hold::{Role, SupportHold, series, support_holds};
use super::surroundings::{Neighbours, Surroundings, nearest};
use super::tolerance::{LENGTH, MATERIAL_TOLERANCE, MIN_STRAIN, REACH_DIAMETERS, REACH_M};
use crate::math::{Vec2, larger, vec2};
use crate::scene::{Cable, Scene, View};
use crate::solution::{CableSolution, Node};
use crate::verification_report::{Finding, Law};

/// A wheel that leads the cable.
#[derive(Clone, Copy, Debug)]
pub(super) struct CheckedWheel {
    /// Centre, m.
    pub center: Vec2,
    /// Radius of the cable's centre line, m.
    pub radius: f64,
    /// Coulomb friction coefficient.
    pub friction: f64,
}

/// One cable with these quantities.
pub(super) struct CheckedCable<'a> {
    pub surroundings: &'a Surroundings<'a>,
    pub scene: &'a Scene,
    pub cable: &'a Cable,
    pub answer: &'a CableSolution,
    /// The actions of its supports on it.
    pub holds: Vec<SupportHold<'a>>,
    /// The wheels that lead the cable now.
    pub wheels: Vec<CheckedWheel>,
    /// Supports and loads. Wheels are among the obstacles.
    pub points: Vec<AppliedForce>,
    /// Weight and wind, N/m.
    pub body: Vec2,
    /// 1 + αΔT.
    pub thermal: f64,
    /// Greatest of the forces, N, with which residuals are compared.
    pub scale: f64,
}

/// A force on a point of the cable, N.
pub(super) struct AppliedForce {
    pub arc_length: f64,
    pub force: Vec2,
}

/// The cable from a node to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct CheckedBar<'a> {
    /// Index of the first node.
    pub index: usize,
    pub from: &'a Node,
    pub to: &'a Node,
    /// Arc length, m.
    pub length: f64,
    /// From node to node, m.
    pub way: Vec2,
    /// Sizes of the internal forces of its nodes, N.
    pub forces: [f64; 2],
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
        let holds = support_holds(cable, answer, time_s);
        let led = |hold: &SupportHold<'_>| match hold.role {
            Role::Wheel { radius } => {
                let friction = hold.support.friction.unwrap_or(0.0);
                Some(CheckedWheel { center: hold.at, radius, friction })
            }
            _ => None,
        };
        let wheels = holds.iter().filter_map(led).collect();
        let points = point_forces(scene, cable, &holds, time_s);
        let body = weight + wind;
        let mut checked = Self { surroundings, scene, cable, answer, holds, wheels, points, body, thermal, scale: 0.0 };
        checked.scale = checked.forces_scale();
        checked
    }
}

impl CheckedCable<'_> {
    /// Arc lengths of the scene's loads on the cable, m.
    pub fn scene_loads(&self) -> impl Iterator<Item = f64> {
        self.scene.loads.iter().filter(|l| l.cable == self.cable.name).map(|l| l.arc_length_m)
    }

    /// First and last node on each pulley that carries a load: on the way over one a load has no
    /// node of its own, and the forces there are known as a whole only.
    pub fn loaded_rounds(&self) -> Vec<[usize; 2]> {
        let nodes = &self.answer.nodes;
        let same = MATERIAL_TOLERANCE * self.cable.length_m;
        let mut out = Vec::new();
        for s in self.scene_loads() {
            let after = nodes.partition_point(|n| n.arc_length_m < s - same);
            if after == 0 || nodes.get(after).is_none_or(|n| n.arc_length_m <= s + same) {
                continue;
            }
            let [from, to] = [after - 1, after].map(|k| nodes[k].arc_length_m);
            let meets = |begins: f64, ends: f64| begins <= to + same && ends >= from - same;
            let eyes = self.holds.iter().filter(|hold| matches!(hold.role, Role::Pulley));
            let eyes = eyes.map(|hold| [hold.arc_length; 2]);
            let wheels = self.wheels.iter().filter_map(|&CheckedWheel { center, radius, .. }| {
                let on = |k: &usize| self.is_on_wheel(*k, center, radius);
                let first = (0..after).rev().take_while(on).last().or((after..nodes.len()).find(on))?;
                let last = (after..nodes.len()).take_while(on).last().or((0..after).rev().find(on))?;
                Some([first, last].map(|k| nodes[k].arc_length_m))
            });
            let round = eyes.chain(wheels).find(|[begins, ends]| meets(*begins, *ends));
            out.extend(round.map(|[begins, ends]| {
                let first = nodes.partition_point(|n| n.arc_length_m < begins - same);
                let last = nodes.partition_point(|n| n.arc_length_m <= ends + same);
                // Known forces count at the node before them.
                [first.min(after - 1), (last - 1).max(after - 1)]
            }));
        }
        out
    }

    /// A violation at a node, with the value found and the greatest allowed in the unit of the law.
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

    /// The greatest force on or in the cable, N; for a cable without forces a least readable one.
    fn forces_scale(&self) -> f64 {
        let square = self.answer.nodes.iter().map(|n| n.force().norm_squared()).fold(0.0, f64::max);
        let loads = self.points.iter().map(|p| p.force.norm()).fold(0.0, larger);
        let load = self.body.norm() * self.cable.length_m;
        larger(larger(square.sqrt(), loads), larger(load, MIN_STRAIN * self.cable.axial_stiffness_n))
    }

    /// Arc length (m) and mass (kg) of the lumps at supports.
    pub fn lumps(&self) -> impl Iterator<Item = (f64, f64)> {
        self.holds.iter().filter_map(|h| Some((h.arc_length, h.support.mass_kg?)))
    }

    /// Reported forces of contacts with the cable itself, which is no obstacle of the scene.
    pub fn self_contact_forces(&self) -> impl Iterator<Item = AppliedForce> {
        let self_contact_forces = self.answer.contacts.iter().filter(|c| self.surroundings.find(&c.obstacle).is_none());
        self_contact_forces
            .flat_map(|c| &c.samples)
            .map(|s| AppliedForce { arc_length: s.arc_length_m, force: vec2(s.force_n) })
    }

    /// Distance of the centre line from a surface within which contacts may push, m.
    pub fn reach(&self) -> f64 {
        0.5 * self.cable.diameter_m + larger(REACH_M, REACH_DIAMETERS * self.cable.diameter_m)
    }

    /// Returns the obstacles near the line from each node to the next.
    pub fn neighbours(&self) -> Neighbours {
        let reach = self.reach();
        Neighbours::new(self.surroundings, self.answer.nodes.iter().map(Node::at), reach)
    }

    /// Returns the points at which supports hold the cable by its axis, m.
    pub fn support_places(&self) -> Vec<Vec2> {
        self.holds.iter().filter(|h| h.role == Role::Held).map(|h| h.at).collect()
    }

    /// Returns whether a floor has friction with the whole cable.
    pub fn floor_rubs(&self) -> bool {
        self.scene.view == View::Plan && self.cable.friction > 0.0
    }

    /// Returns the greatest distributed load on the cable, N/m: weight and wind, and in plan view
    /// the floor's friction.
    pub fn spread_load(&self) -> f64 {
        self.body.norm() + self.floor_friction_n_per_m()
    }

    /// Returns the greatest friction of the floor of a plan view on the cable, N/m; 0 without one.
    pub fn floor_friction_n_per_m(&self) -> f64 {
        if !self.floor_rubs() {
            return 0.0;
        }
        self.cable.friction * self.cable.linear_density_kg_per_m * self.scene.environment.gravity_m_per_s2
    }

    /// Internal force just before a node that is not the first, N, with all contact forces of the
    /// bar before it at its end.
    pub fn force_before(&self, node: usize) -> Vec2 {
        let [a, b] = [&self.answer.nodes[node - 1], &self.answer.nodes[node]];
        a.force() - self.body * (b.arc_length_m - a.arc_length_m)
    }

    /// From each node to the next.
    pub fn bars(&self) -> impl Iterator<Item = CheckedBar<'_>> {
        let mut first = self.answer.nodes[0].force().norm();
        self.answer.nodes.windows(2).enumerate().map(move |(k, pair)| {
            let [from, to] = [&pair[0], &pair[1]];
            let forces = [first, to.force().norm()];
            first = forces[1];
            CheckedBar {
                index: k,
                from,
                to,
                length: to.arc_length_m - from.arc_length_m,
                way: to.at() - from.at(),
                forces,
            }
        })
    }

    /// Internal force at the end of a bar, N: with its contact forces spread along it, and with all
    /// of them at the end.
    pub fn forces_at_end(&self, bar: &CheckedBar<'_>) -> [Vec2; 2] {
        [bar.to.force(), bar.from.force() - self.body * bar.length]
    }

    /// Returns whether something touches a piece or a neighbour.
    pub fn touches(&self, near: &Neighbours, k: usize) -> bool {
        !near.around(k, k + 1).is_empty() || self.is_at_wheel(k)
    }

    /// Returns whether an end of the bar from node k to the next is on a wheel.
    pub fn is_at_wheel(&self, k: usize) -> bool {
        self.wheels.iter().any(|w| [k, k + 1].iter().any(|&k| self.is_on_wheel(k, w.center, w.radius)))
    }

    /// Returns whether a node is on a wheel.
    pub fn is_on_wheel(&self, node: usize, center: Vec2, radius: f64) -> bool {
        let reach = self.reach() - 0.5 * self.cable.diameter_m;
        (self.answer.nodes[node].at() - center).norm() <= radius + reach
    }

    /// Returns the point of the bar from node k to the next that is nearest to the centre of a
    /// wheel, m, if it is on the wheel.
    pub fn touches_wheel(&self, k: usize, center: Vec2, radius: f64) -> Option<Vec2> {
        let [from, to] = [k, k + 1].map(|k| self.answer.nodes[k].at());
        let at = nearest(center, from, to);
        let reach = self.reach() - 0.5 * self.cable.diameter_m;
        ((at - center).norm() <= radius + reach).then_some(at)
    }

    /// Weight and wind of the cable from node k to the next and of its neighbours, N.
    pub fn weight_beside(&self, k: usize) -> f64 {
        let nodes = &self.answer.nodes;
        let [from, to] = [k.saturating_sub(1), (k + 2).min(nodes.len() - 1)].map(|k| nodes[k].arc_length_m);
        self.body.norm() * (to - from)
    }

    /// Round-off (m) of the path of so much material, m.
    pub fn length_rounding(&self, material: f64) -> f64 {
        LENGTH * material + MATERIAL_TOLERANCE * self.cable.length_m
    }
}

/// Supports and loads on a cable at a time, s.
fn point_forces(scene: &Scene, cable: &Cable, holds: &[SupportHold<'_>], time_s: f64) -> Vec<AppliedForce> {
    let places = holds.iter().filter_map(|hold| {
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
    places.chain(loads).collect()
}
