//! This module reads the nodes of a solved stiff cable: places, tensions, moments and curvatures.

use crate::math::{GAUSS_3, Vec2, larger, perp};
use crate::model::fem::free::beam::equilibrium::{BEND_STIFFNESS_INTEGRALS, Beam, dot};
use crate::model::fem::free::results::SolutionPoint;
use crate::model::fem::free::stations::Station;
use crate::numerics::bisect;

/// The points at which a cable is read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PointDensity {
    /// Its nodes.
    Nodes,
    /// Its nodes, and as many points between them as straight lines need to draw it.
    Drawn,
}

/// Greatest distance of the cable from the straight line between two points, as a fraction of its
/// length. Larger: places read between points are off by as much (with the nodes alone by 1e-3 of a
/// span); smaller: thousands of points.
const MAX_CHORD_DISTANCE_FRACTION: f64 = 1e-5;
/// Maximum number of parts of a bar. Smaller: a bar of a coarse given mesh shows corners; larger:
/// more points than can be seen.
const MOST_PARTS: f64 = 32.0;
/// Least distance of two points in a bar, as a fraction of it. Smaller: lines of no length; larger:
/// the greatest tension is read beside its place.
const PLACE_SPACING: f64 = 1e-6;
/// Number of halvings that locate the greatest tension: its error is the square of the interval
/// that is left.
const PEAK_HALVINGS: usize = 30;

/// Of two curvatures or moments the sharper.
fn greater(before: f64, after: f64) -> f64 {
    if before.abs() > after.abs() { before } else { after }
}

impl Beam {
    /// Moments that balance bar `e` at both nodes, N·m.
    fn moments(&self, e: usize, starts: &[Vec2]) -> [f64; 2] {
        let stiff = self.bending / (3.0 * self.thermal_length(e));
        let mut pull = [0, 2].map(|r| stiff * dot(&BEND_STIFFNESS_INTEGRALS[r], &self.angles[2 * e..2 * e + 3]));
        for p in self.samples(e, starts) {
            for (pull, shape) in pull.iter_mut().zip([p.shapes[0], p.shapes[2]]) {
                *pull -= p.length * p.across * (1.0 + p.tau) * shape;
            }
        }
        [-pull[0], pull[1]]
    }

    /// Curvatures just before and just after node `v`, 1/m, which differ at a clamp between two
    /// bars. At a station they follow from the moment that balances the bar beside it, elsewhere
    /// from the slope of the quartic through the angles of both bars.
    fn curvatures(&self, v: usize, starts: &[Vec2]) -> [f64; 2] {
        let (before, after) = (v.checked_sub(1).and_then(|e| self.bars.get(e)), self.bars.get(v));
        if let (Some(a), Some(b)) = (before, after)
            && a.stretch == b.stretch
        {
            let places = [-a.ds, -0.5 * a.ds, 0.0, 0.5 * b.ds, b.ds];
            return [slope_at_zero(&places, &self.angles[2 * v - 2..2 * v + 3]); 2];
        }
        let per_moment = self.material.thermal_stretch / self.bending;
        let left = if before.is_some() { self.moments(v - 1, starts)[1] } else { 0.0 };
        let right = if after.is_some() { self.moments(v, starts)[0] } else { 0.0 };
        let station = before.and_then(|b| self.layout.stations.get(b.stretch + 1));
        match station.filter(|_| after.is_some()).and_then(|s| s.clamp) {
            Some(_) => [per_moment * left, per_moment * right],
            None => [per_moment * greater(left, right); 2],
        }
    }

    /// The greatest tension, at nodes or between them, N.
    #[must_use]
    pub fn greatest_tension(&self) -> f64 {
        self.drawn_points().iter().map(|p| p.tension).reduce(larger).unwrap_or(0.0)
    }

    /// All nodes.
    #[must_use]
    pub fn node_points(&self) -> Vec<SolutionPoint> {
        self.points(PointDensity::Nodes)
    }

    /// All nodes, with as many points between them as straight lines need to draw the cable.
    #[must_use]
    pub fn drawn_points(&self) -> Vec<SolutionPoint> {
        self.points(PointDensity::Drawn)
    }

    /// The points of the answer, from end to end.
    fn points(&self, density: PointDensity) -> Vec<SolutionPoint> {
        let n = self.bars.len();
        let (starts, forces) = (self.stretch_starts(), self.station_forces());
        let curvatures: Vec<[f64; 2]> = (0..=n).map(|v| self.curvatures(v, &starts)).collect();
        let chord =
            |e: usize| self.samples(e, &starts).iter().map(|p| p.tangent * (p.length * (1.0 + p.tau))).sum::<Vec2>();
        let first = self.layout.stations.iter().position(Station::anchors).unwrap_or(0);
        let anchor = self.layout.stations[first].point(0).unwrap_or_default();
        let mut at = (0..n).filter(|&e| self.bars[e].stretch < first).fold(anchor, |p, e| p - chord(e));
        let mut out = Vec::with_capacity(n + 1);
        for v in 0..=n {
            let t = self.tangent(self.angles[2 * v]);
            let stretch = self.bars.get(v).map_or(self.layout.stations.len() - 1, |b| b.stretch);
            let at_stop = v == n || v == 0 || self.bars[v - 1].stretch != stretch;
            let inside = self.bars.get(v).map_or(Vec2::zeros(), |b| self.force(b, 0.0, &starts));
            let [before, after] = if at_stop { forces[stretch] } else { [inside; 2] };
            let arc_length = self.bars.get(v).map_or(self.layout.length, |b| b.start);
            if at_stop && let Some(p) = self.layout.stations[stretch].point(0) {
                at = p;
            }
            // There is no cable beyond an end.
            let tension = if v == 0 {
                after.dot(&t)
            } else if v == n {
                before.dot(&t)
            } else {
                larger(before.dot(&t), after.dot(&t))
            };
            let force = if v == n { before } else { after };
            let [bent_before, bent_after] = curvatures[v];
            out.push(SolutionPoint { arc_length, at, tension, curvature: greater(bent_before, bent_after), force });
            if v < n {
                if density == PointDensity::Drawn {
                    self.between(v, at, [curvatures[v][1], curvatures[v + 1][0]], &starts, &mut out);
                }
                at += chord(v);
            }
        }
        out
    }

    /// Appends the points inside bar `e`, which begins at `at`, so that the cable leaves the
    /// straight line between two of them by `MAX_CHORD_DISTANCE_FRACTION` at most.
    fn between(&self, e: usize, mut at: Vec2, curvatures: [f64; 2], starts: &[Vec2], out: &mut Vec<SolutionPoint>) {
        let (bar, angles) = (&self.bars[e], &self.angles[2 * e..2 * e + 3]);
        let half_turn = larger((angles[1] - angles[0]).abs(), (angles[2] - angles[1]).abs());
        // A sagitta κl²/8 with κ of the half that turns more.
        let off = 0.25 * half_turn * bar.ds;
        let parts = (off / (MAX_CHORD_DISTANCE_FRACTION * self.layout.length)).sqrt().ceil().clamp(1.0, MOST_PARTS);
        let mut places: Vec<f64> = (1..parts as usize).map(|k| k as f64 / parts).collect();
        let clear = |x: &f64| places.iter().chain(&[0.0, 1.0]).all(|y| (x - y).abs() > PLACE_SPACING);
        places.extend(self.peak(e, starts).filter(clear));
        places.sort_by(f64::total_cmp);
        places.push(1.0);
        let per_moment = self.material.thermal_stretch / self.bending;
        let (first, mut from, mut bent) = (out.len(), 0.0, 0.0);
        for x in places {
            let step = x - from;
            for (part, weight) in GAUSS_3 {
                let x = from + part * step;
                let (t, force) = (self.tangent(self.angle(e, x)), self.force(bar, x, starts));
                let length =
                    weight * step * self.thermal_length(e) * (1.0 + force.dot(&t) / self.material.axial_stiffness);
                at += t * length;
                bent -= per_moment * force.dot(&perp(t)) * length;
            }
            let force = self.force(bar, x, starts);
            let tension = force.dot(&self.tangent(self.angle(e, x)));
            out.push(SolutionPoint { arc_length: bar.start + x * bar.ds, at, force, tension, curvature: bent });
            from = x;
        }
        // The shear gives the change of curvature along the bar, and its nodes give the values at
        // both ends.
        out.pop();
        let left = curvatures[1] - curvatures[0] - bent;
        for point in &mut out[first..] {
            point.curvature += curvatures[0] + left * (point.arc_length - bar.start) / bar.ds;
        }
    }

    /// The place in bar `e`, from 0 to 1, of the greatest tension, if it is at neither of its
    /// nodes.
    fn peak(&self, e: usize, starts: &[Vec2]) -> Option<f64> {
        let (bar, a) = (&self.bars[e], &self.angles[2 * e..2 * e + 3]);
        let rises = |x: f64| {
            let t = self.tangent(self.angle(e, x));
            let turn = dot(&[4.0 * x - 3.0, 4.0 - 8.0 * x, 4.0 * x - 1.0], a);
            self.force(bar, x, starts).dot(&perp(t)) * turn - self.material.body.dot(&t) * bar.ds > 0.0
        };
        (rises(0.0) && !rises(1.0)).then(|| bisect([0.0, 1.0], PEAK_HALVINGS, rises)[0])
    }

    fn tangent(&self, angle: f64) -> Vec2 {
        Vec2::new(angle.cos(), angle.sin())
    }
}

/// The slope at 0 of the polynomial through `values` at `places`, of which one is 0.
fn slope_at_zero(places: &[f64; 5], values: &[f64]) -> f64 {
    let zero = places.iter().position(|&x| x == 0.0).unwrap_or(0);
    let here = values.get(zero).copied().unwrap_or(f64::NAN);
    let mut slope = 0.0;
    for (i, (&x, &y)) in places.iter().zip(values).enumerate().filter(|(i, _)| *i != zero) {
        // Lagrange: φᵢ'(0) = (1/xᵢ) Π (0 − xⱼ)/(xᵢ − xⱼ) over the others, which sum to 0 with that
        // of 0 itself.
        let others = places.iter().enumerate().filter(|(j, _)| *j != i && *j != zero);
        slope += (y - here) / x * others.map(|(_, &z)| z / (z - x)).product::<f64>();
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_of_a_quartic_is_exact() {
        let f = |x: f64| 3.0 + x * (2.0 - x * (1.0 + x * (4.0 - 5.0 * x)));
        let places = [-0.7, -0.35, 0.0, 0.2, 0.4];
        assert!((slope_at_zero(&places, &places.map(f)) - 2.0).abs() < 1e-12);
    }
}
