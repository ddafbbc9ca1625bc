//! This module lays a chain along a curve, with a node at each support and load.

use crate::math::{Vec2, larger};
use crate::model::fem::elastica::chain::{BarChain, ChainClamp, ChainInput, ClampedSide};
use crate::model::fem::elastica::reference_curve::ReferenceCurve;
use crate::model::fem::first_shape::push_chain_out;
use crate::model::fem::free::place as support_place;
use crate::scene::SupportKind;

/// The whole load over the pull that is assumed at a bend, which says how fine the mesh is. Larger:
/// bends count as wider, and the mesh is coarser; smaller: it is finer than they need. A choice,
/// tuned on no campaign.
const BEND_PULL_DIVISOR: f64 = 3.0;
/// Least pull, N, that keeps a cable without load from a division by zero. Larger than any pull of
/// a scene: coarse meshes; smaller: it is no number.
const LEAST_PULL_N: f64 = 1e-300;

/// Number of bars in the bend beside a contact, whose length is √(EI/T) with T a third of the
/// weight. The whole cable gets at least `LEAST_BARS` and at most `MOST_BARS`.
const BARS_IN_BEND: f64 = 3.0;
/// See `BARS_IN_BEND`.
const LEAST_BARS: f64 = 150.0;
/// See `BARS_IN_BEND`.
const MOST_BARS: f64 = 500.0;

/// Relative growth of a bar's rest length in a step, until it reaches its unstretched length.
pub(super) const PAY_OUT_RATE: f64 = 0.03;

/// Shortest rest length with which a bar begins, as a fraction of its unstretched length.
const FIRST_LENGTH_FRACTION: f64 = 0.05;

/// Clearance to which the first shape is pushed out of obstacles, as a fraction of the cable's
/// radius.
const FIRST_CLEARANCE_FRACTION: f64 = 1e-3;

/// Distance below which two places of the cable are one (round-off), as a fraction of its length.
const SAME_PLACE_FRACTION: f64 = 1e-9;

/// A point of the cable where a support or a load acts.
struct MeshStation {
    /// Arc length, m.
    arc: f64,
    /// The place where a support holds it, m.
    position: Option<Vec2>,
    /// Direction in which it is clamped, rad.
    angle: Option<f64>,
    /// Dead load, N.
    force: Vec2,
}

/// All stations in order along the cable; None if one is a pulley.
fn stations(chain_input: ChainInput<'_>) -> Option<Vec<MeshStation>> {
    let ChainInput { problem, time_s, dragged, .. } = chain_input;
    let gravity = if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
    let last = problem.supports.len().checked_sub(1)?;
    let mut stations = Vec::new();
    for (k, s) in problem.supports.iter().enumerate() {
        if s.kind == SupportKind::Pulley {
            return None;
        }
        let at = support_place(problem, k, time_s, dragged);
        let loaded = matches!(s.kind, SupportKind::Load | SupportKind::Free) || at.is_none();
        let arc = if k == 0 {
            0.0
        } else if k == last {
            problem.length
        } else {
            s.arc_length?
        };
        stations.push(MeshStation {
            arc,
            position: at.filter(|_| !loaded),
            angle: s.angle.filter(|_| s.kind == SupportKind::Clamped && !loaded),
            force: if loaded { s.force.at(time_s) + gravity * s.mass } else { Vec2::zeros() },
        });
    }
    for l in &problem.loads {
        stations.push(MeshStation { arc: l.arc_length, position: None, angle: None, force: l.force.at(time_s) });
    }
    stations.sort_by(|a, b| a.arc.total_cmp(&b.arc));
    Some(stations)
}

impl<'a> BarChain<'a> {
    /// The chain along a curve, pushed out of obstacles. None if the scene has things that a chain
    /// does not model (pulleys, a robot, a rough floor, self-contact), or if the curve runs through
    /// an obstacle.
    pub(super) fn along_curve(
        chain_input: ChainInput<'a>,
        curve: &ReferenceCurve<'_>,
        refinement: f64,
    ) -> Option<Self> {
        let ChainInput { problem, time_s, .. } = chain_input;
        if !problem.knows_obstacles_at(time_s) || problem.floor_friction.is_some() || problem.cable.self_contact {
            return None;
        }
        let stations = stations(chain_input)?;
        let scale = problem.force_scale();
        let bend = (problem.bending_stiffness / larger(scale / BEND_PULL_DIVISOR, LEAST_PULL_N)).sqrt();
        let count = (BARS_IN_BEND * problem.length / bend).clamp(LEAST_BARS, MOST_BARS) * refinement;
        let mut chain = Self {
            chain_input,
            body: problem.body_force(time_s),
            arc: vec![0.0],
            positions: Vec::new(),
            rest: Vec::new(),
            unstretched: Vec::new(),
            tension: Vec::new(),
            fixity: Vec::new(),
            clamps: Vec::new(),
            load: Vec::new(),
            contacts: Vec::new(),
            scale,
            bar: problem.length / count,
            steps: 0,
            refinement,
        };
        chain.place_nodes(&stations, curve);
        chain.apply_stations(stations);
        chain.add_bars(curve);
        push_chain_out(
            problem,
            &chain.fixity,
            &|_, _| false,
            &mut chain.positions,
            FIRST_CLEARANCE_FRACTION * problem.radius,
        );
        chain.is_clear_enough(&chain.positions).then_some(chain)
    }

    /// Divides the cable between stations into even bars.
    fn place_nodes(&mut self, stations: &[MeshStation], curve: &ReferenceCurve<'_>) {
        for pair in stations.windows(2) {
            let (from, to) = (pair[0].arc, pair[1].arc);
            if to - from > SAME_PLACE_FRACTION * self.chain_input.problem.length {
                let n = ((to - from) / self.bar).ceil().max(2.0);
                self.arc.extend((1..=n as usize).map(|i| from + (to - from) * i as f64 / n));
            }
        }
        let n = self.arc.len();
        self.positions = self.arc.iter().map(|&s| curve.position_at(s)).collect();
        self.fixity = vec![false; n];
        self.load = vec![Vec2::zeros(); n];
    }

    /// Gives the nodes at the stations their position, their clamps and their force.
    fn apply_stations(&mut self, stations: Vec<MeshStation>) {
        let n = self.arc.len();
        for station in stations {
            let same = SAME_PLACE_FRACTION * self.chain_input.problem.length;
            let k = self.arc.partition_point(|a| *a < station.arc - same).min(n - 1);
            if let Some(at) = station.position {
                self.positions[k] = at;
                self.fixity[k] = true;
            }
            if let Some(angle) = station.angle {
                let direction = Vec2::new(angle.cos(), angle.sin());
                if k > 0 {
                    self.clamps.push(ChainClamp { node: k, side: ClampedSide::Before, direction });
                }
                if k + 1 < n {
                    self.clamps.push(ChainClamp { node: k, side: ClampedSide::After, direction });
                }
            }
            self.load[k] += station.force;
        }
    }

    /// Adds the bars with their tension and weight. Where the curve is shorter than the material of
    /// a bar, the bar begins as short as the curve.
    fn add_bars(&mut self, curve: &ReferenceCurve<'_>) {
        let problem = self.chain_input.problem;
        for e in 0..self.arc.len() - 1 {
            let ds = self.arc[e + 1] - self.arc[e];
            let chord = (self.positions[e + 1] - self.positions[e]).norm();
            let unstretched = problem.thermal_stretch * ds;
            self.unstretched.push(unstretched);
            let tension = curve.tension_at(0.5 * (self.arc[e] + self.arc[e + 1]));
            let stretched = unstretched * (1.0 + tension / problem.axial_stiffness);
            self.rest.push(if chord < (1.0 - PAY_OUT_RATE) * stretched {
                larger(chord, FIRST_LENGTH_FRACTION * unstretched)
            } else {
                unstretched
            });
            self.tension.push(tension);
            for k in [e, e + 1] {
                self.load[k] += self.body * (0.5 * ds);
            }
        }
    }
}
