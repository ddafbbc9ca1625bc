//! This module reads nodes and support reactions out of a solved network.

use crate::math::{Vec2, cross, larger, perp};
use crate::model::arc_nodes;
use crate::model::fem::free::pulley_balance::Network;
use crate::model::fem::free::span::elements;
use crate::model::fem::free::stations::{Hold, Layout, SpanEnds, Stop};
use crate::model::fem::free::wheel_arcs;
use crate::problem::Problem;
use crate::solution::{Node, SupportReaction};

/// A point of the cable.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Arc length, m.
    pub arc_length: f64,
    /// Its position, m.
    pub at: Vec2,
    /// Tension, N: the larger of those beside it, the one that breaks the cable. A stiff cable may
    /// push: less than zero.
    pub tension: f64,
    /// d(angle)/d(arc length), 1/m.
    pub curvature: f64,
    /// Internal force just beyond it, at the end of the cable just before it, N.
    pub force: Vec2,
}

impl Point {
    /// As an answer holds it.
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

/// All points of a solved network in order of arc length, of a cable of a radius (m), appended to
/// `out`.
pub fn points(network: &Network, cable_radius: f64, out: &mut Vec<Point>) {
    out.clear();
    let layout = &network.layout;
    let Some((first, last)) = layout.anchored() else { return };
    let end = layout.stops.len() - 1;
    if first > 0 {
        let force = -layout.stops[0].load;
        let mut reach = Vec2::zeros();
        elements(&network.material, layout, SpanEnds { first: 0, last: first }, force, |ds, f| {
            reach += network.material.respond(ds, f).chord
        });
        let anchor = layout.stops[first].point(0).unwrap_or_default();
        run(network, SpanEnds { first: 0, last: first }, anchor - reach, force, out);
    }
    for (&ends, span) in network.ends.iter().zip(&network.spans) {
        let start = layout.stops[ends.first].point(1).unwrap_or_default();
        anchor(network, ends.first, cable_radius, out);
        run(network, ends, start, span.force, out);
    }
    anchor(network, last, cable_radius, out);
    if last < end {
        let start = layout.stops[last].point(1).unwrap_or_default();
        run(network, SpanEnds { first: last, last: end }, start, network.forces[last][1], out);
        let load = layout.stops[end].load;
        let tip = out.last().map_or(start, |p| p.at) + last_chord(network, end);
        out.push(Point { arc_length: layout.length, at: tip, tension: load.norm(), curvature: 0.0, force: load });
    }
}

/// Chord of the last element of a hanging end.
fn last_chord(network: &Network, end: usize) -> Vec2 {
    let (stop, tip) = (&network.layout.stops[end - 1], &network.layout.stops[end]);
    let ds = (tip.arc_length - stop.leaves()) / stop.cells as f64;
    network.material.respond(ds, tip.load + network.material.body * (0.5 * ds)).chord
}

/// Curvature of a perfectly flexible cable: dF/ds = −q turns F by cross(F, −q)/|F|².
fn free_curvature(force: Vec2, body: Vec2, smoothing: f64) -> f64 {
    -cross(force, body) / (force.norm_squared() + smoothing * smoothing)
}

/// The points between two stops; of the two only the first, and only where it does not anchor.
fn run(network: &Network, SpanEnds { first, last }: SpanEnds, start: Vec2, force: Vec2, out: &mut Vec<Point>) {
    let (layout, material) = (&network.layout, &network.material);
    let (mut at, mut force) = (start, force);
    for k in first..last {
        let stop = &layout.stops[k];
        let before = force;
        if k > first {
            force -= stop.load;
        }
        let ds = (layout.stops[k + 1].arc_length - stop.leaves()) / stop.cells as f64;
        let drop = material.body * ds;
        for e in 0..stop.cells {
            let f = force - drop * e as f64;
            if e > 0 || !stop.anchors() {
                let before = if e == 0 { before } else { f };
                let curvature = free_curvature(f, material.body, material.smoothing);
                out.push(Point {
                    arc_length: stop.leaves() + ds * e as f64,
                    at,
                    tension: larger(before.norm(), f.norm()),
                    curvature,
                    force: f,
                });
            }
            at += material.respond(ds, f - drop * 0.5).chord;
        }
        force -= drop * stop.cells as f64;
    }
}

/// The points at an anchor: one, or those round a wheel.
fn anchor(network: &Network, k: usize, cable_radius: f64, out: &mut Vec<Point>) {
    let stop = &network.layout.stops[k];
    let [before, after] = network.forces[k];
    let (Some(meets), Some(leaves)) = (stop.point(0), stop.point(1)) else { return };
    match stop.hold {
        Hold::Pulley(wheel) if wheel.radius > 0.0 && stop.lap > 0.0 => {
            let tangent = |point: Vec2, arc_length: f64, force: Vec2, curvature: f64| Point {
                arc_length,
                at: point,
                tension: force.norm(),
                curvature,
                force,
            };
            let turn = wheel_arcs::turn(&wheel, before);
            let curvature = turn / stop.lap;
            out.push(tangent(meets, stop.arc_length, before, curvature));
            let count = arc_nodes::parts(wheel.radius, turn, cable_radius);
            let start = wheel.contact[0].y.atan2(wheel.contact[0].x);
            let tension = |f: f64| wheel_arcs::tension(&wheel, &network.material, [before, after], f);
            let material = arc_nodes::material(count, |f| tension(f) / network.material.axial_stiffness);
            for (i, share) in (1..count).zip(material) {
                let f = i as f64 / count as f64;
                let n = Vec2::new((start + turn * f).cos(), (start + turn * f).sin());
                let (n, arc_length, tension) =
                    remembered(network, k, f).unwrap_or_else(|| (n, stop.arc_length + stop.lap * share, tension(f)));
                let force = perp(n) * (turn.signum() * tension);
                out.push(tangent(wheel.center + n * wheel.radius, arc_length, force, curvature));
            }
            out.push(tangent(leaves, stop.leaves(), after, curvature));
        }
        _ => {
            let side = if after.norm_squared() > 0.0 { after } else { before };
            let curvature = free_curvature(side, network.material.body, network.material.smoothing);
            out.push(Point {
                arc_length: stop.arc_length,
                at: meets,
                tension: larger(before.norm(), after.norm()),
                curvature,
                force: if k + 1 == network.layout.stops.len() { before } else { after },
            });
        }
    }
}

/// Outward normal, arc length (m) and tension (N) at a fraction of the arc of a wheel whose
/// friction remembers them.
fn remembered(network: &Network, stop: usize, fraction: f64) -> Option<(Vec2, f64, f64)> {
    let k = network.pulleys().iter().position(|&k| k == stop)?;
    let (tension, normal, material) = network.pulley_states.get(k)?.on_arc(&network.on_wheel(), fraction)?;
    Some((normal, material, tension))
}

/// Force of the cable on a stop, N: it is pulled back along the cable before it and on along the
/// cable after it, and carries the load that acts there, and the cable on its wheel.
#[must_use]
pub fn reaction(stop: &Stop, [before, after]: [Vec2; 2], body: Vec2) -> Vec2 {
    match stop.hold {
        Hold::Free => -stop.load,
        _ => after - before + stop.load + body * stop.lap,
    }
}

/// The reactions of all supports, in the scene's order.
#[must_use]
pub fn reactions(
    problem: &Problem,
    layout: &Layout,
    forces: &[[Vec2; 2]],
    body: Vec2,
    points: &[Point],
) -> Vec<SupportReaction> {
    let mut out = Vec::with_capacity(problem.supports.len());
    for (k, support) in problem.supports.iter().enumerate() {
        let Some((index, stop)) = layout.stops.iter().enumerate().find(|(_, s)| s.support == Some(k)) else {
            let at = support.at.unwrap_or_default();
            out.push(SupportReaction {
                name: support.name.clone(),
                x_m: at.x,
                y_m: at.y,
                ..SupportReaction::default()
            });
            continue;
        };
        let middle = stop.arc_length + 0.5 * stop.lap;
        let at = match stop.hold {
            Hold::Fixed(p) => p,
            Hold::Pulley(w) => w.center,
            Hold::Free => position_at(points, middle),
        };
        let force = reaction(stop, forces[index], body);
        let pulley = matches!(stop.hold, Hold::Pulley(_));
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

fn position_at(points: &[Point], arc_length: f64) -> Vec2 {
    let k = points.partition_point(|p| p.arc_length < arc_length - 1e-9 * arc_length.abs());
    points.get(k).or(points.last()).map_or(Vec2::zeros(), |p| p.at)
}
