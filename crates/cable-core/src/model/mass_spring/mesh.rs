//! The mesh has nodes, masses and the first shape.

use std::sync::Arc;

use crate::math::{Vec2, bounded};
use crate::model::Settings;
use crate::model::mass_spring::pulleys::pulley::Pulley;
use crate::model::mass_spring::{Clock, ContactMemory, MassSpringModel, Report, Rollback, SupportDrives, Wheels};
use crate::problem::Problem;
use crate::state::State;

/// Elements where neither scene nor settings say: fewer is visibly angular, more makes sub-steps
/// shorter and dearer.
const DEFAULT_SEGMENTS: usize = 60;
/// Nodes of another model are taken if they are nowhere nearer than this, of the even length: less
/// makes sub-steps short.
const LEAST_SPACING: f64 = 0.2;
/// Least damping ratio of the fastest axial mode. Without any, springs that go slack and taut near
/// the stability limit pump energy into violent motion (a cable dropped into its supports gained 11
/// kJ in 4 s); the first mode of N elements gets π/2N of it, and motion across the cable nothing.
/// More damps what is seen.
const MIN_MODE_DAMPING: f64 = 0.1;
/// Most of the cable that the way to the last support gets when it is longer: the rest hangs, the
/// first balance decides.
const LONGEST_WAY: f64 = 0.95;
/// Greatest damping ratio of the fastest mode: more shortens the stable step without changing what
/// is seen.
const MAX_MODE_DAMPING: f64 = 1.0;

part! {
    /// The masses, and the springs between them.
    Chain {
        /// Arc length of each node, m.
        s: Vec<f64>,
        /// Unstretched length of each element at the present temperature, m.
        rest: Vec<f64>,
        /// Arc length of each element at rest temperature, m: weight and wind go with it.
        span: Vec<f64>,
        /// Arc length of the straight part of each element (all of it but what lies on a wheel), m.
        share: Vec<f64>,
        /// Length of an element where they are even, m.
        even: f64,
        /// Mass of each node, kg.
        mass: Vec<f64>,
        /// Lumped mass at each node, kg.
        lump: Vec<f64>,
        /// Node of each support.
        node_of: Vec<usize>,
        /// Node of each load.
        load_node: Vec<usize>,
        /// Position of each node, m.
        x: Vec<Vec2>,
        /// Velocity of each node, m/s.
        v: Vec<Vec2>,
        /// Force on each node but that of supports and contacts, N.
        f: Vec<Vec2>,
        /// Tension of each element, N.
        tension: Vec<f64>,
        /// Time constant of the material's loss, s.
        damping_time_s: f64,
    }
}

impl MassSpringModel {
    /// Puts a node at each support and load, the others evenly between them. `slid` is where each
    /// support sits, m.
    pub(super) fn mesh(problem: Arc<Problem>, settings: Settings, slid: &[f64]) -> Self {
        Self::mesh_on(problem, settings, slid, None)
    }

    /// The same with nodes at given arc lengths (m), if there are any.
    pub(super) fn mesh_on(problem: Arc<Problem>, settings: Settings, slid: &[f64], own: Option<Vec<f64>>) -> Self {
        let wanted = settings.segments.or(problem.cable.segments).unwrap_or(DEFAULT_SEGMENTS).max(1);
        let mut pulleys = Pulley::all(&problem);
        let seats = apart(&problem, slid, LEAST_SPACING * problem.length / wanted as f64);
        let sits = |k: usize| seats.get(k).copied().unwrap_or(0.0);
        let mut marks: Vec<f64> = problem.supports.iter().filter_map(|s| s.arc_length).collect();
        marks.extend(pulleys.iter().map(|p| sits(p.support)));
        marks.extend(problem.loads.iter().map(|l| l.arc_length));
        marks.extend([0.0, problem.length]);
        marks.sort_by(f64::total_cmp);
        marks.dedup_by(|b, a| (*b - *a).abs() <= 1e-9 * problem.length);
        let mut s = vec![0.0];
        for w in marks.windows(2) {
            let is_pulley = |m: f64| pulleys.iter().any(|p| (sits(p.support) - m).abs() <= 1e-9 * problem.length);
            // Beside a pulley there is always a node that moves.
            let least = if is_pulley(w[0]) || is_pulley(w[1]) { 2.0 } else { 1.0 };
            let count = ((w[1] - w[0]) / problem.length * wanted as f64).round().max(least);
            s.extend((1..=count as usize).map(|k| w[0] + (w[1] - w[0]) * k as f64 / count));
        }
        let s = own.unwrap_or(s);
        let span: Vec<f64> = s.windows(2).map(|w| w[1] - w[0]).collect();
        let rest: Vec<f64> = span.iter().map(|d| d * problem.thermal_stretch).collect();
        let mut mass = vec![0.0; s.len()];
        for (e, d) in span.iter().enumerate() {
            mass[e] += 0.5 * d * problem.linear_density;
            mass[e + 1] += 0.5 * d * problem.linear_density;
        }
        let nearest = |at: f64| {
            let k = s.partition_point(|&v| v < at).min(s.len() - 1);
            if k > 0 && at - s[k - 1] < s[k] - at { k - 1 } else { k }
        };
        let node_of: Vec<usize> = (0..problem.supports.len()).map(|k| nearest(sits(k))).collect();
        let mut lump = vec![0.0; s.len()];
        for (p, &k) in problem.supports.iter().zip(&node_of) {
            mass[k] += p.mass;
            lump[k] += p.mass;
        }
        let mut pulley_at = vec![None; s.len()];
        for (k, p) in pulleys.iter_mut().enumerate() {
            let node = node_of[p.support];
            p.sit(node, s[node]);
            pulley_at[p.node] = Some(k);
        }
        let load_node = problem.loads.iter().map(|l| nearest(l.arc_length)).collect();
        let x = first_shape(&problem, &s, &node_of);
        let (n, ne, ns) = (s.len(), span.len(), node_of.len());
        let damping_time_s = damping_time(&problem, &rest);
        let chain = Chain {
            v: vec![Vec2::zeros(); n],
            f: vec![Vec2::zeros(); n],
            tension: vec![0.0; ne],
            even: problem.length / wanted as f64,
            share: span.clone(),
            lump,
            s,
            rest,
            span,
            mass,
            node_of,
            load_node,
            x,
            damping_time_s,
        };
        let drives = SupportDrives {
            held: vec![false; n],
            held_acceleration: vec![Vec2::zeros(); n],
            drag: vec![None; ns],
            followers: vec![None; ns],
            pulled: vec![false; ns],
            hands: vec![None; ns],
            ..SupportDrives::default()
        };
        let contacts = ContactMemory {
            clearance: vec![0.0; ne],
            touches: Vec::with_capacity(2 * ne),
            gaps: Vec::with_capacity(16),
            ..ContactMemory::default()
        };
        let mut model = Self {
            problem,
            settings,
            clock: Clock::default(),
            chain,
            drives,
            contacts,
            wheels: Wheels { pulleys, pulley_at },
            report: Report::default(),
            laid: false,
            kept: Rollback::default(),
        };
        model.place_supports();
        model.tidy();
        model.forces();
        model
    }

    /// The nodes of a shape, if they will do: resampled, its elements would cut the corners that
    /// they lie round.
    pub(super) fn nodes_of(&self, shape: &State) -> Option<Vec<f64>> {
        let s = &shape.arc_length_m;
        let fits = |wanted: f64| s.iter().any(|v| (v - wanted).abs() <= 1e-9 * self.problem.length);
        let supports = self.problem.supports.iter().filter_map(|p| p.arc_length);
        let marks = supports.chain(self.problem.loads.iter().map(|l| l.arc_length)).chain([0.0, self.problem.length]);
        let apart = s.windows(2).all(|w| w[1] - w[0] >= LEAST_SPACING * self.chain.even);
        let wanted = self.problem.length / self.chain.even;
        let many = (0.5 * wanted..=2.0 * wanted).contains(&(s.len() as f64));
        let plain = self.wheels.pulleys.is_empty() && !self.problem.world.is_empty();
        (plain && apart && many && marks.into_iter().all(fits)).then(|| s.clone())
    }

    /// Brings the elements beside pulleys near the even length.
    pub(super) fn tidy(&mut self) {
        self.measure();
        for _ in 0..self.chain.x.len() {
            if !self.remesh() {
                break;
            }
        }
    }
}

/// Returns where each support sits (m): as given, and what slides kept `least` (m), or its share of
/// what room there is, from what it could run onto. Material lies on both sides of a pulley,
/// however near to a support it stands.
fn apart(p: &Problem, slid: &[f64], least: f64) -> Vec<f64> {
    let mut out: Vec<f64> =
        (0..p.supports.len()).map(|k| p.supports[k].arc_length.or(slid.get(k).copied()).unwrap_or(f64::NAN)).collect();
    let slides: Vec<bool> = p.supports.iter().map(|s| s.arc_length.is_none()).collect();
    let mut k = 0;
    while k < out.len() {
        let count = slides[k..].iter().take_while(|s| **s).count();
        let low = if k > 0 { out[k - 1] } else { 0.0 };
        let high = out.get(k + count).copied().unwrap_or(p.length);
        let room = least.min(0.5 * (high - low) / (count + 1) as f64);
        for i in 0..count {
            let (floor, ceiling) = (low + room * (i + 1) as f64, high - room * (count - i) as f64);
            let floor = if i > 0 { floor.max(out[k + i - 1] + room) } else { floor };
            let even = low + (high - low) * (i + 1) as f64 / (count + 1) as f64;
            let here = if out[k + i].is_finite() { out[k + i] } else { even };
            out[k + i] = here.min(ceiling).max(floor);
        }
        k += count + 1;
    }
    out
}

/// Damping ζ of the first axial mode, ω₁ = π/L·√(EA/ρ): strain-rate force EA·τ·ε̇ with τ = 2ζ/ω₁.
/// Mode k then has ζ_k = ζ·ω_k/ω₁, which for the fastest one is kept between [`MIN_MODE_DAMPING`]
/// and [`MAX_MODE_DAMPING`].
fn damping_time(p: &Problem, rest: &[f64]) -> f64 {
    let c = (p.axial_stiffness / p.linear_density).sqrt();
    let first = std::f64::consts::PI / p.damped_length * c;
    let shortest = rest.iter().copied().fold(f64::INFINITY, f64::min);
    let fastest = 2.0 * c / shortest;
    let own = 2.0 * p.cable.damping_ratio / first;
    bounded(own, 2.0 * MIN_MODE_DAMPING / fastest, 2.0 * MAX_MODE_DAMPING / fastest)
}

/// Returns where each support sits on the cable before anything is known, m: material even along
/// the straight way between those whose place is given; a hanging end gets what the way leaves.
pub(super) fn lay_supports(p: &Problem) -> Vec<f64> {
    let count = p.supports.len();
    let mut way = vec![0.0; count];
    let mut last: Option<Vec2> = None;
    for k in 0..count {
        way[k] = if k > 0 { way[k - 1] } else { 0.0 };
        if let Some((at, _)) = p.supports[k].position_at(0.0) {
            way[k] += last.map_or(0.0, |l| (at - l).norm());
            last = Some(at);
        }
    }
    let known = |k: usize| p.supports[k].arc_length.filter(|_| p.supports[k].at.is_some());
    let whole = way.last().copied().unwrap_or(0.0);
    let fits = |room: f64, way: f64| if way < LONGEST_WAY * room { 1.0 } else { LONGEST_WAY * room / way };
    (0..count)
        .map(|k| {
            if let Some(s) = p.supports[k].arc_length {
                return s;
            }
            let before = (0..k).rev().find_map(|j| known(j).map(|s| (way[j], s)));
            let after = (k + 1..count).find_map(|j| known(j).map(|s| (way[j], s)));
            match (before, after) {
                (Some((wa, sa)), Some((wb, sb))) if wb > wa => sa + (sb - sa) * (way[k] - wa) / (wb - wa),
                (Some((wa, sa)), _) => sa + (way[k] - wa) * fits(p.length - sa, whole - wa),
                (None, Some((wb, sb))) => sb - (wb - way[k]) * fits(sb, wb),
                (None, None) => {
                    let scale = fits(p.length, whole);
                    0.5 * (p.length - whole * scale) + way[k] * scale
                }
            }
        })
        .collect()
}

/// Along the route, material spread evenly; without one, straight from support to support. A free
/// end goes on in the direction of gravity.
fn first_shape(p: &Problem, s: &[f64], node_of: &[usize]) -> Vec<Vec2> {
    if p.route.len() >= 2 {
        let mut along = vec![0.0];
        for w in p.route.windows(2) {
            along.push(along[along.len() - 1] + (w[1] - w[0]).norm());
        }
        let scale = along[along.len() - 1] / p.length;
        let route = crate::State { arc_length_m: along, position_m: p.route.clone(), ..crate::State::default() };
        return s.iter().map(|v| route.position_at(v * scale).unwrap_or_default()).collect();
    }
    let held: Vec<(f64, Vec2)> =
        p.supports.iter().zip(node_of).filter_map(|(u, &k)| u.at.map(|at| (s[k], at))).collect();
    let down = p.body_force(0.0).try_normalize(0.0).unwrap_or(Vec2::new(0.0, -1.0));
    s.iter()
        .map(|&v| {
            let k = held.partition_point(|h| h.0 < v);
            match (k.checked_sub(1).and_then(|i| held.get(i)), held.get(k)) {
                (Some(a), Some(b)) => a.1 + (b.1 - a.1) * ((v - a.0) / (b.0 - a.0)),
                (Some(a), None) => a.1 + down * (v - a.0),
                (None, Some(b)) => b.1 + down * (b.0 - v),
                (None, None) => down * v,
            }
        })
        .collect()
}
