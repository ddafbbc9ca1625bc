//! This module reads nodes and support reactions from a solved network.

use crate::math::{Vec2, cross, larger, perp};
use crate::model::arc_nodes;
use crate::model::fem::free::pulley_balance::PulleyNetwork;
use crate::model::fem::free::pulley_state::PointOnWheel;
use crate::model::fem::free::span::elements;
use crate::model::fem::free::stations::{Restraint, SpanEnds, Station, StationLayout};
use crate::model::fem::free::wheel_arcs;
use crate::problem::Problem;
use crate::solution::{Node, SupportReaction};

/// Difference of arc lengths within which a point is at a place, relative to the arc length:
/// round-off. Smaller: the point after it is taken; larger: the point before it.
const SAME_POINT_FRACTION: f64 = 1e-9;

/// A point of the cable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolutionPoint {
    /// Arc length, m.
    pub arc_length: f64,
    /// Its position, m.
    pub at: Vec2,
    /// Tension, N: the larger one of those on both sides, which is the one that breaks the cable.
    /// Negative where a stiff cable is compressed.
    pub tension: f64,
    /// d(angle)/d(arc length), 1/m.
    pub curvature: f64,
    /// Internal force just after it (at the end of the cable just before it), N.
    pub force: Vec2,
}

impl SolutionPoint {
    /// This point as a node of an answer.
    #[must_use]
    pub fn node(&self, problem: &Problem) -> Node {
        let tension_n = self.tension;
        let area = std::f64::consts::PI * problem.radius * problem.radius;
        Node {
            arc_length_m: self.arc_length,
            x_m: self.at.x,
            y_m: self.at.y,
            tension_n,
            strain: tension_n / problem.axial_stiffness,
            stress_pa: tension_n / area,
            curvature_per_m: self.curvature,
            force_n: [self.force.x, self.force.y],
            ..Node::default()
        }
    }
}

/// Appends all points of a solved network in order of arc length to `out`; `cable_radius` is in m.
pub fn points(network: &PulleyNetwork, cable_radius: f64, out: &mut Vec<SolutionPoint>) {
    out.clear();
    let layout = &network.layout;
    let Some((first, last)) = layout.anchored() else { return };
    let end = layout.stations.len() - 1;
    if first > 0 {
        let force = -layout.stations[0].load;
        let mut reach = Vec2::zeros();
        elements(&network.material, layout, SpanEnds { first: 0, last: first }, force, |ds, f| {
            reach += network.material.respond(ds, f).chord
        });
        let anchor = layout.stations[first].point(0).unwrap_or_default();
        run(network, SpanEnds { first: 0, last: first }, anchor - reach, force, out);
    }
    for (&ends, span) in network.ends.iter().zip(&network.spans) {
        let start = layout.stations[ends.first].point(1).unwrap_or_default();
        anchor(network, ends.first, cable_radius, out);
        run(network, ends, start, span.force, out);
    }
    anchor(network, last, cable_radius, out);
    if last < end {
        let start = layout.stations[last].point(1).unwrap_or_default();
        run(network, SpanEnds { first: last, last: end }, start, network.forces[last][1], out);
        let load = layout.stations[end].load;
        let tip = out.last().map_or(start, |p| p.at) + last_chord(network, end);
        out.push(SolutionPoint {
            arc_length: layout.length,
            at: tip,
            tension: load.norm(),
            curvature: 0.0,
            force: load,
        });
    }
}

/// Chord of the last element of a hanging end.
fn last_chord(network: &PulleyNetwork, end: usize) -> Vec2 {
    let (station, tip) = (&network.layout.stations[end - 1], &network.layout.stations[end]);
    let ds = (tip.arc_length - station.leaves()) / station.element_count as f64;
    network.material.respond(ds, tip.load + network.material.body * (0.5 * ds)).chord
}

/// Curvature of a perfectly flexible cable: dF/ds = −q turns F by cross(F, −q)/|F|².
fn free_curvature(force: Vec2, body: Vec2, smoothing: f64) -> f64 {
    -cross(force, body) / (force.norm_squared() + smoothing * smoothing)
}

/// Appends the points between two stations, and the first station itself if it does not anchor.
fn run(
    network: &PulleyNetwork,
    SpanEnds { first, last }: SpanEnds,
    start: Vec2,
    force: Vec2,
    out: &mut Vec<SolutionPoint>,
) {
    let (layout, material) = (&network.layout, &network.material);
    let (mut at, mut force) = (start, force);
    for k in first..last {
        let station = &layout.stations[k];
        let before = force;
        if k > first {
            force -= station.load;
        }
        let ds = (layout.stations[k + 1].arc_length - station.leaves()) / station.element_count as f64;
        let drop = material.body * ds;
        for e in 0..station.element_count {
            let f = force - drop * e as f64;
            if e > 0 || !station.anchors() {
                let before = if e == 0 { before } else { f };
                let curvature = free_curvature(f, material.body, material.smoothing);
                out.push(SolutionPoint {
                    arc_length: station.leaves() + ds * e as f64,
                    at,
                    tension: larger(before.norm(), f.norm()),
                    curvature,
                    force: f,
                });
            }
            at += material.respond(ds, f - drop * 0.5).chord;
        }
        force -= drop * station.element_count as f64;
    }
}

/// Appends the point of an anchor, or the points round its wheel.
fn anchor(network: &PulleyNetwork, k: usize, cable_radius: f64, out: &mut Vec<SolutionPoint>) {
    let station = &network.layout.stations[k];
    let [before, after] = network.forces[k];
    let (Some(meets), Some(leaves)) = (station.point(0), station.point(1)) else { return };
    match station.restraint {
        Restraint::Pulley(wheel) if wheel.radius > 0.0 && station.material_on_wheel > 0.0 => {
            let tangent = |point: Vec2, arc_length: f64, force: Vec2, curvature: f64| SolutionPoint {
                arc_length,
                at: point,
                tension: force.norm(),
                curvature,
                force,
            };
            let turn = wheel_arcs::turn(&wheel, before);
            let curvature = turn / station.material_on_wheel;
            out.push(tangent(meets, station.arc_length, before, curvature));
            let count = arc_nodes::parts(wheel.radius, turn, cable_radius);
            let start = wheel.contact[0].y.atan2(wheel.contact[0].x);
            let tension = |f: f64| wheel_arcs::tension(&wheel, &network.material, [before, after], f);
            let material = arc_nodes::material(count, |f| tension(f) / network.material.axial_stiffness);
            for (i, share) in (1..count).zip(material) {
                let f = i as f64 / count as f64;
                let n = Vec2::new((start + turn * f).cos(), (start + turn * f).sin());
                let point = remembered_point(network, k, f).unwrap_or_else(|| PointOnWheel {
                    normal: n,
                    arc_length: station.arc_length + station.material_on_wheel * share,
                    tension: tension(f),
                });
                let force = perp(point.normal) * (turn.signum() * point.tension);
                out.push(tangent(wheel.center + point.normal * wheel.radius, point.arc_length, force, curvature));
            }
            out.push(tangent(leaves, station.leaves(), after, curvature));
        }
        _ => {
            let side = if after.norm_squared() > 0.0 { after } else { before };
            let curvature = free_curvature(side, network.material.body, network.material.smoothing);
            out.push(SolutionPoint {
                arc_length: station.arc_length,
                at: meets,
                tension: larger(before.norm(), after.norm()),
                curvature,
                force: if k + 1 == network.layout.stations.len() { before } else { after },
            });
        }
    }
}

/// The cable at a fraction of the arc of a wheel, if its friction remembers it.
fn remembered_point(network: &PulleyNetwork, station: usize, fraction: f64) -> Option<PointOnWheel> {
    let k = network.pulleys().iter().position(|&k| k == station)?;
    network.pulley_states.get(k)?.on_arc(&network.cable_properties(), fraction)
}

/// Force of the cable on a station, N: the tensions on both sides, the load that acts there, and
/// the weight of the cable on its wheel.
#[must_use]
pub fn reaction(station: &Station, [before, after]: [Vec2; 2], body: Vec2) -> Vec2 {
    match station.restraint {
        Restraint::Free => -station.load,
        _ => after - before + station.load + body * station.material_on_wheel,
    }
}

/// The reactions of all supports, in the scene's order.
#[must_use]
pub fn reactions(
    problem: &Problem,
    layout: &StationLayout,
    forces: &[[Vec2; 2]],
    body: Vec2,
    points: &[SolutionPoint],
) -> Vec<SupportReaction> {
    let mut out = Vec::with_capacity(problem.supports.len());
    for (k, support) in problem.supports.iter().enumerate() {
        let Some((index, station)) = layout.stations.iter().enumerate().find(|(_, s)| s.support == Some(k)) else {
            let at = support.at.unwrap_or_default();
            out.push(SupportReaction {
                name: support.name.clone(),
                x_m: at.x,
                y_m: at.y,
                ..SupportReaction::default()
            });
            continue;
        };
        let middle = station.arc_length + 0.5 * station.material_on_wheel;
        let at = match station.restraint {
            Restraint::Fixed(p) => p,
            Restraint::Pulley(w) => w.center,
            Restraint::Free => position_at(points, middle),
        };
        let force = reaction(station, forces[index], body);
        let pulley = matches!(station.restraint, Restraint::Pulley(_));
        out.push(SupportReaction {
            name: support.name.clone(),
            x_m: at.x,
            y_m: at.y,
            reaction_x_n: force.x,
            reaction_y_n: force.y,
            arc_length_m: middle,
            tension_before_n: pulley.then(|| forces[index][0].norm()),
            tension_after_n: pulley.then(|| forces[index][1].norm()),
            hand: None,
        });
    }
    out
}

fn position_at(points: &[SolutionPoint], arc_length: f64) -> Vec2 {
    let k = points.partition_point(|p| p.arc_length < arc_length - SAME_POINT_FRACTION * arc_length.abs());
    points.get(k).or(points.last()).map_or(Vec2::zeros(), |p| p.at)
}
