//! Stations are supports and point loads in order of arc length, with the elements between them.
//!
//! A station either anchors the cable (held, or a pulley it slides through) or carries a load on a
//! free point. The elements between two stations follow them when the arc length at a pulley
//! changes, so a moving pulley needs no new mesh: nodes are at the stations and at fixed fractions
//! between them.

use crate::math::Vec2;
use crate::model::fem::mesh::bars_between;
use crate::problem::Problem;
use crate::scene::{PulleySide, SupportKind};

/// The way in which a station holds the cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restraint {
    /// The cable is free.
    Free,
    /// The cable is fixed at a point, m.
    Fixed(Vec2),
    /// The cable slides through a pulley.
    Pulley(Wheel),
}

/// A pulley.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    /// Centre, m.
    pub center: Vec2,
    /// Radius of the cable's centre line, m; 0 = a point.
    pub radius: f64,
    /// Coulomb friction coefficient.
    pub friction: f64,
    /// Side of the wheel on which the cable runs.
    pub side: PulleySide,
    /// Unit vectors from the centre to where the cable meets and leaves the wheel.
    pub contact: [Vec2; 2],
}

/// A support or a point load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Its arc length, m (for a wheel: of the point where the cable meets it).
    pub arc_length: f64,
    /// Material on the wheel, m.
    pub material_on_wheel: f64,
    /// The way in which it holds the cable.
    pub restraint: Restraint,
    /// Dead load, N.
    pub load: Vec2,
    /// Index of the support; None for a point load.
    pub support: Option<usize>,
    /// Direction of a clamp, rad.
    pub clamp: Option<f64>,
    /// Number of elements from here to the next station.
    pub element_count: usize,
}

impl Station {
    /// Arc length at which the cable leaves the station, m.
    #[must_use]
    pub fn leaves(&self) -> f64 {
        self.arc_length + self.material_on_wheel
    }

    /// True if it holds the cable in place.
    #[must_use]
    pub fn anchors(&self) -> bool {
        self.restraint != Restraint::Free
    }

    /// Points where the cable arrives (`0`) and leaves (`1`), m; None for a free point.
    #[must_use]
    pub fn point(&self, side: usize) -> Option<Vec2> {
        match self.restraint {
            Restraint::Free => None,
            Restraint::Fixed(p) => Some(p),
            Restraint::Pulley(w) => Some(w.center + w.contact[side.min(1)] * w.radius),
        }
    }
}

/// The stations at both ends of a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpanEnds {
    /// Index of the station at its start.
    pub first: usize,
    /// Index of the station at its end.
    pub last: usize,
}

/// The stations of one cable at one time; the first and the last are at its ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StationLayout {
    /// In order of arc length.
    pub stations: Vec<Station>,
    /// Cable length, m.
    pub length: f64,
}

impl StationLayout {
    /// Makes the stations at a time (s). `slid` gives the arc length at each support where it is
    /// known (pulleys after the first answer); for the others the cable's material is spread evenly
    /// along the way through its supports.
    #[must_use]
    pub fn new(problem: &Problem, time_s: f64, dragged: &[Option<Vec2>], slid: &[Option<f64>]) -> Self {
        let gravity =
            if problem.linear_density > 0.0 { problem.weight / problem.linear_density } else { Vec2::zeros() };
        let arcs_of_route = arcs_along_route(problem, time_s, dragged);
        let mut stations: Vec<Station> = Vec::with_capacity(problem.supports.len() + problem.loads.len());
        for (k, support) in problem.supports.iter().enumerate() {
            let at = place(problem, k, time_s, dragged);
            let end = k == 0 || k + 1 == problem.supports.len();
            let restraint = match (support.kind, at) {
                (_, None) | (SupportKind::Load | SupportKind::Free, _) => Restraint::Free,
                (SupportKind::Pulley, Some(center)) => Restraint::Pulley(Wheel {
                    center,
                    radius: support.wheel_radius,
                    friction: support.friction,
                    side: support.side,
                    contact: [Vec2::zeros(); 2],
                }),
                (_, Some(p)) => Restraint::Fixed(p),
            };
            if restraint == Restraint::Free && support.kind == SupportKind::Pulley && !end {
                continue; // the cable has been released from it
            }
            let known = support.arc_length.or(slid.get(k).copied().flatten());
            let released = at.is_none() && !matches!(support.kind, SupportKind::Load | SupportKind::Free);
            stations.push(Station {
                arc_length: known.unwrap_or(arcs_of_route.get(k).copied().unwrap_or(0.0)),
                material_on_wheel: 0.0,
                restraint,
                load: support.force.at(time_s) + gravity * support.mass,
                support: Some(k),
                clamp: if released { None } else { support.angle },
                element_count: 0,
            });
        }
        for load in &problem.loads {
            let at = stations.partition_point(|s| s.arc_length <= load.arc_length).clamp(1, stations.len().max(1));
            let force = load.force.at(time_s);
            match stations.get_mut(at - 1) {
                Some(s) if s.arc_length >= load.arc_length && !matches!(s.restraint, Restraint::Pulley(_)) => {
                    s.load += force
                }
                _ => stations.insert(at.min(stations.len()), point_load(load.arc_length, force)),
            }
        }
        // A load exactly at the end belongs to the end.
        while let [.., end, load] = stations.as_mut_slice() {
            if load.support.is_some() {
                break;
            }
            end.load += load.load;
            stations.pop();
        }
        Self { stations, length: problem.length }
    }

    /// Gives each stretch between stations its share of about `segments` elements.
    pub fn cut(&mut self, segments: usize) {
        for k in 1..self.stations.len() {
            let stretch = self.stations[k].arc_length - self.stations[k - 1].leaves();
            self.stations[k - 1].element_count = bars_between(stretch, self.length, segments);
        }
    }

    /// The spans: runs of stations from one anchor to the next.
    pub fn spans(&self) -> impl Iterator<Item = SpanEnds> + '_ {
        let anchors = self.stations.iter().enumerate().filter(|(_, s)| s.anchors()).map(|(k, _)| k);
        anchors.clone().zip(anchors.skip(1)).map(|(first, last)| SpanEnds { first, last })
    }

    /// The first and last anchor.
    #[must_use]
    pub fn anchored(&self) -> Option<(usize, usize)> {
        let first = self.stations.iter().position(Station::anchors)?;
        let last = self.stations.iter().rposition(Station::anchors)?;
        Some((first, last))
    }

    /// The vectors to a station from the anchor before it and on to the anchor after it, if there
    /// are any.
    #[must_use]
    pub fn anchors_beside(&self, station: usize) -> [Option<Vec2>; 2] {
        let near = |k: usize| match self.stations[k].restraint {
            Restraint::Free => None,
            Restraint::Fixed(p) => Some(p),
            Restraint::Pulley(w) => Some(w.center),
        };
        let here = near(station).unwrap_or_default();
        let before = (0..station).rev().find_map(near);
        let after = (station + 1..self.stations.len()).find_map(near);
        [before.map(|b| here - b), after.map(|a| a - here)]
    }
}

/// The station of a load (N) between supports.
fn point_load(arc_length: f64, load: Vec2) -> Station {
    Station {
        arc_length,
        material_on_wheel: 0.0,
        restraint: Restraint::Free,
        load,
        support: None,
        clamp: None,
        element_count: 0,
    }
}

/// Position of a support at a time, m: where it is dragged by hand, or else by its motion.
#[must_use]
pub fn place(problem: &Problem, support: usize, time_s: f64, dragged: &[Option<Vec2>]) -> Option<Vec2> {
    let own = problem.supports.get(support)?.position_at(time_s)?.0;
    Some(dragged.get(support).copied().flatten().unwrap_or(own))
}

/// Least fraction of the cable that is left to a hanging end if the way to the last support is
/// longer than the cable. Any value in (0, 1) will do, because a search starts from it.
const LEAST_TAIL: f64 = 0.05;

/// Arc length at every support with the material spread evenly along the route, or along the
/// straight way if there is no route. Hanging ends get the material that the way between the outer
/// anchors leaves.
fn arcs_along_route(problem: &Problem, time_s: f64, dragged: &[Option<Vec2>]) -> Vec<f64> {
    let count = problem.supports.len();
    let places: Vec<Option<Vec2>> = (0..count).map(|k| place(problem, k, time_s, dragged)).collect();
    if problem.route.len() > 1 {
        let way = way_along(&problem.route);
        let whole = way.last().copied().unwrap_or(1.0);
        return places
            .iter()
            .map(|p| p.map_or(0.0, |p| problem.length * nearest(&problem.route, &way, p) / whole))
            .collect();
    }
    // Distance along the way from support to support; a free support is skipped.
    let (mut way, mut last) = (vec![0.0; count], None);
    for k in 0..count {
        way[k] = if k > 0 { way[k - 1] } else { 0.0 };
        if let Some(p) = places[k] {
            if let Some(q) = last {
                way[k] += (p - q as Vec2).norm();
            }
            last = Some(p);
        }
    }
    let known: Vec<(usize, f64)> = problem
        .supports
        .iter()
        .enumerate()
        .filter(|(k, s)| s.arc_length.is_some() && places[*k].is_some())
        .filter_map(|(k, s)| s.arc_length.map(|a| (k, a)))
        .collect();
    let whole = way.last().copied().unwrap_or(0.0);
    let tail =
        |room: f64, way: f64| if way < (1.0 - LEAST_TAIL) * room { 1.0 } else { (1.0 - LEAST_TAIL) * room / way };
    (0..count)
        .map(|k| {
            let before = known.iter().rev().find(|(j, _)| *j <= k);
            let after = known.iter().find(|(j, _)| *j >= k);
            match (before, after) {
                (Some(&(a, sa)), Some(&(b, sb))) if way[b] > way[a] => {
                    sa + (sb - sa) * (way[k] - way[a]) / (way[b] - way[a])
                }
                (Some(&(_, sa)), Some(_)) => sa,
                (Some(&(a, sa)), None) => sa + (way[k] - way[a]) * tail(problem.length - sa, whole - way[a]),
                (None, Some(&(b, sb))) => sb - (way[b] - way[k]) * tail(sb, way[b]),
                (None, None) => {
                    let scale = tail(problem.length, whole);
                    0.5 * (problem.length - whole * scale) + way[k] * scale
                }
            }
        })
        .collect()
}

/// Distance of each point along their line, m.
fn way_along(points: &[Vec2]) -> Vec<f64> {
    let mut way = vec![0.0];
    let mut sum = 0.0;
    for p in points.windows(2) {
        sum += (p[1] - p[0]).norm();
        way.push(sum);
    }
    way
}

/// Distance along a line of the point nearest to `p`, m.
pub(in crate::model::fem) fn nearest(line: &[Vec2], way: &[f64], p: Vec2) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    for (k, pair) in line.windows(2).enumerate() {
        let d = pair[1] - pair[0];
        let square = d.norm_squared();
        let f = if square > 0.0 { ((p - pair[0]).dot(&d) / square).clamp(0.0, 1.0) } else { 0.0 };
        let distance = (pair[0] + d * f - p).norm();
        if distance < best.0 {
            best = (distance, way[k] + f * (way[k + 1] - way[k]));
        }
    }
    best.1
}
