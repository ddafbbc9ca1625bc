//! The friction of pulleys remembers where it held the cable. This module starts that memory from a
//! balance, from the answer of another model or from that of another mesh, and updates it.

use crate::math::{larger, perp};
use crate::model::fem::free::pulley_balance::PulleyNetwork;
use crate::model::fem::free::pulley_state::{FrictionState, PointFriction, PulleyState};
use crate::model::fem::free::stations::Restraint;
use crate::model::spans::contact::{CableProperties, WheelEnds, WheelFriction};
use crate::solution::CableSolution;

/// Angle (rad) by which the end of a wheel's arc may lie before its start by round-off. Smaller: an
/// arc of no length becomes a whole turn; larger: the end of a nearly whole turn is its start.
const ANGLE_ROUNDING_RAD: f64 = 1e-6;

/// Distance from a wheel within which a node of an answer lies on it, as a fraction of its radius.
const WHEEL_DISTANCE_RADII: f64 = 1e-9;

impl PulleyNetwork {
    /// The properties of the cable that the law of wheels needs.
    pub fn cable_properties(&self) -> CableProperties {
        let m = &self.material;
        CableProperties { load: m.body, thermal: m.thermal_stretch, stiffness: m.axial_stiffness }
    }

    /// True if a pulley has friction, and so a memory.
    pub fn rubs(&self) -> bool {
        self.layout.stations.iter().any(|s| matches!(s.restraint, Restraint::Pulley(w) if w.friction > 0.0))
    }

    /// Begins the memory of every pulley with the balance found; on each wheel friction is shared
    /// evenly.
    pub fn remember(&mut self) {
        let on = self.cable_properties();
        self.pulley_states = Vec::new();
        for k in self.pulleys() {
            let Some(mut pulley) = self.blank(k) else { continue };
            let [before, after] = self.forces[k];
            if let FrictionState::Wheel(w) = &mut pulley.friction {
                let first = w.angle(before, 0.0);
                let last = w.angle(after, first);
                let last =
                    if last < first - ANGLE_ROUNDING_RAD { last + std::f64::consts::TAU } else { larger(last, first) };
                pulley.angles = [first, last];
                let ends = [[first, pulley.material[0], before.norm()], [last, pulley.material[1], after.norm()]];
                w.begin(&on, &ends);
            }
            self.pulley_states.push(pulley);
        }
    }

    /// Begins the memory of every pulley with an answer of another model; false if that does not
    /// hold enough.
    pub fn remember_answer(&mut self, answer: &CableSolution) -> bool {
        let on = self.cable_properties();
        let mut found = Vec::new();
        for k in self.pulleys() {
            let (Some(mut pulley), Some(wheel)) = (self.blank(k), self.wheel(k)) else { return false };
            let Some(said) = pulley.support.and_then(|i| answer.supports.get(i)) else { return false };
            match &mut pulley.friction {
                FrictionState::Wheel(w) => {
                    let mut points: Vec<[f64; 3]> = Vec::new();
                    for node in &answer.nodes {
                        let out = node.at() - wheel.center;
                        let near = (out.norm() - wheel.radius).abs() <= WHEEL_DISTANCE_RADII * wheel.radius;
                        let along = perp(out) * -self.clockwise_at(k, &wheel);
                        let last = points.last().map_or(w.angle(along, 0.0), |p| p[0]);
                        if near && node.tension_n > 0.0 {
                            points.push([w.angle(along, last), node.arc_length_m, node.tension_n]);
                        }
                    }
                    let (Some(a), Some(b)) = (points.first().copied(), points.last().copied()) else { return false };
                    if b[0] < a[0] {
                        return false;
                    }
                    w.begin(&on, &points);
                    (pulley.angles, pulley.material) = ([a[0], b[0]], [a[1], b[1]]);
                }
                FrictionState::Point { resting_place, .. } => {
                    *resting_place = said.arc_length_m;
                    pulley.material = [*resting_place; 2];
                }
            }
            found.push(pulley);
        }
        self.pulley_states = found;
        true
    }

    /// A pulley without memory yet, at the place that the layout gives it.
    fn blank(&self, k: usize) -> Option<PulleyState> {
        let wheel = self.wheel(k)?;
        let station = &self.layout.stations[k];
        let friction = if wheel.radius > 0.0 {
            FrictionState::Wheel(WheelFriction::new(wheel.radius, wheel.friction, self.clockwise_at(k, &wheel)))
        } else {
            let mode = if wheel.friction > 0.0 { PointFriction::Holds } else { PointFriction::Slides(0.0) };
            FrictionState::Point { friction: wheel.friction, mode, resting_place: station.arc_length }
        };
        Some(PulleyState {
            support: station.support,
            friction,
            angles: [0.0; 2],
            material: [station.arc_length, station.leaves()],
        })
    }

    /// Takes over the friction memory of another network; returns false if it does not have the
    /// same pulleys.
    pub fn remember_from(&mut self, other: &Self) -> bool {
        let support = |n: &Self, k: usize| n.layout.stations[k].support;
        let own: Vec<Option<usize>> = self.pulleys().into_iter().map(|k| support(self, k)).collect();
        let same = own.len() == other.pulley_states.len()
            && own.iter().zip(&other.pulley_states).all(|(a, b)| *a == b.support);
        if same {
            self.pulley_states.clone_from(&other.pulley_states);
        }
        same
    }

    /// Stores the state after a step in the friction memory.
    pub fn commit_friction(&mut self) {
        let on = self.cable_properties();
        let mut pulley_states = std::mem::take(&mut self.pulley_states);
        for (k, r) in self.pulleys().into_iter().zip(&mut pulley_states) {
            let ends = self.ends_at(k, r);
            match &mut r.friction {
                FrictionState::Wheel(w) => w.commit(&on, &ends),
                FrictionState::Point { resting_place, .. } => *resting_place = r.material[0],
            }
        }
        self.pulley_states = pulley_states;
    }

    /// The ends of the cable on a wheel, from its friction memory.
    pub(super) fn ends_at(&self, k: usize, r: &PulleyState) -> WheelEnds {
        WheelEnds { place: r.angles, material: r.material, tension: self.forces[k].map(|f| f.norm()) }
    }
}
